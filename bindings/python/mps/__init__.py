# SPDX-License-Identifier: BSD-3-Clause
"""libmps from Python: the moving particle semi-implicit method for violent sloshing.

    import mps

    sim = mps.Simulation(dp=0.01)
    sim.tank(size=(1.0, 0.6))
    sim.fill_level(lo=(0, 0), hi=(1.0, 0.3))
    sim.move_harmonic(dof="x", amplitude=0.02, omega=4.0)
    wall = sim.probe("wall_pressure", at=(0, 0.1), rate=1000)
    sim.run(2.0)
    t, p = wall.series()

Case files: run = mps.Case("surge.yaml").run("out"); run.columns["P1"]. Results of any run: mps.Run("out"), of a sweep: mps.Sweep("out").
Functions of C by their names: mps.c.mps_step(...), structs: mps.structs.
Values are in SI units. Numbers of the headers have their names: mps.MPS_FLUID."""
from . import _structs as structs
from ._couple import Snapshot
from ._library import c
from ._motion import State
from ._numbers import *  # noqa: F403
from ._records import Record, make
from .case import Case, CaseError, Job, sweep
from .errors import (ArgumentError, BusyError, Diverged, Error, FileError, MemoryFull, NotConverged, ParticleLost, PluginError,
                     RanksError, SolverError, StateError, UnknownName, VersionError)
from .frame import Frame
from .lease import Lease
from .model import Channel, Model, Pairs, Setting, Stage, verb
from .operators import Cloud, lattice_constants
from .probe import Probe
from .results import Impacts, Run, Sweep, Table
from .simulation import Frames, Simulation, catalogue

__version__ = c.version
__all__ = ["ArgumentError", "BusyError", "Case", "CaseError", "Channel", "Cloud", "Diverged", "Error", "FileError", "Frame",
           "Frames", "Impacts", "Job", "Lease", "MemoryFull", "Model", "NotConverged", "Pairs", "ParticleLost", "PluginError",
           "Probe", "RanksError", "Record", "Run", "Setting", "Simulation", "Snapshot", "SolverError", "Stage", "State",
           "StateError", "Sweep", "Table", "UnknownName", "VersionError", "c", "catalogue", "lattice_constants", "make",
           "structs", "sweep", "verb"]
