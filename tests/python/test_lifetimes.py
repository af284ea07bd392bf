# SPDX-License-Identifier: BSD-3-Clause
"""Lifetimes: each object with each call after it, or what it belongs to, was closed, within callbacks, in any order of the collector,
copied, pickled, in a process that was forked off. Nothing crashes; what is not allowed raises, with a text that says why."""
from __future__ import annotations

import copy
import gc
import itertools
import os
import pickle
import tempfile
import unittest
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mps
import numpy as np
from test_case import TANK

ARGUMENTS: dict[str, tuple[Any, ...]] = {
    "add_field": ("mine",), "add_particles": ([(0.3, 0.5)],), "baffle": ("b", (0.2, 0), (0.2, 0.2)), "body": ("x", 50.0), "check": (-1,),
    "checkpoint": ("state",), "count": (), "failure": (-1,), "fill": (lambda x: False,), "fill_box": ((0, 0), (0.1, 0.1)),
    "fill_level": ((0, 0), (0.1, 0.1)), "frames": (".",), "get": ("collision", "distance"), "motion_centre": ((0, 0),), "move_by": (lambda t, s: None,),
    "move_harmonic": ({"dof": "x"},), "move_table": ([0, 1], {"x": [0, 1]}), "phase": (), "plate": ("p", (0.1, 0.1), (0.1, 0)),
    "pose_at": (0.5,), "pose_to": (1.0, {"x": 0.1}), "preset": ("imps",), "probe": ("gauge", (0.1, 0)), "read": ("position",), "remove": ("tension",),
    "remove_particles": ([1],), "restore": ("state",), "run": (1.0,), "set": ("collision", "distance", 0.5), "solid": (lambda x: 1.0, (0, 0), (1, 1)),
    "solver": ("sundials.pcg",), "stl": ("none.stl",), "tank": ((1, 1),), "tension": (0, 1, 0.1), "threads": (1,), "to_lab": ((0, 0),),
    "use": ("gas.pocket",), "write": ("velocity",), "build": ("other",), "sweep": ("swept",), "parse": ("mps: 1",), "divergence": (np.zeros((9, 2)),),
    "Case.check": (), "Case.run": ("other",), "Job.run": (), "Snapshot.restore": (), "Probe.read": (), "Probe.remove": (), "Frames.write": (),
    "gradient": (np.zeros(9),), "laplacian": (np.zeros(9),),
}
QUIET = {"close", "closed", "drop", "adopt", "parse"}  # allowed on what is closed
LASTING = {"array", "number", "folder", "case", "simulation", "x", "dim", "n"}  # own values of Python


def still() -> mps.Simulation:
    sim = mps.Simulation(dp=0.1, log=lambda *_: None)
    sim.tank(size=(1.0, 0.6))
    sim.fill_level(lo=(0, 0), hi=(1.0, 0.3))
    return sim


def calls(one: Any) -> list[tuple[str, Callable[[], Any]]]:
    """Each public call and value of an object."""
    found = []
    for name in dir(type(one)) + [n for n in vars(one) if n not in dir(type(one))]:
        if name.startswith("_"):
            continue

        def call(name: str = name) -> Any:
            value = getattr(one, name)
            given = ARGUMENTS.get(f"{type(one).__name__}.{name}", ARGUMENTS.get(name, ()))
            return value(*given) if callable(value) and name not in LASTING else value

        found.append((name, call))
    return found


CHILDREN: dict[str, Callable[[mps.Simulation], Any]] = {
    "frames": lambda sim: sim.frames("."), "snapshot": lambda sim: sim.snapshot(), "reads": lambda sim: sim.read("position"),
    "writes": lambda sim: sim.write("velocity"), "probe": lambda sim: sim.probe("wall_pressure", at=(0, 0.1), rate=100)}


class Lifetimes(unittest.TestCase):
    def setUp(self) -> None:
        self.home, self.folder = os.getcwd(), tempfile.TemporaryDirectory()
        os.chdir(self.folder.name)
        catch = warnings.catch_warnings()
        catch.__enter__()
        warnings.simplefilter("ignore")
        self.addCleanup(lambda: (catch.__exit__(None, None, None), os.chdir(self.home), self.folder.cleanup()))

    def closed(self, one: Any, why: str) -> None:
        """Each call of a closed object raises an error."""
        asked = 0
        for name, call in calls(one):
            if name in QUIET | LASTING:
                continue
            with self.subTest(kind=type(one).__name__, call=name), self.assertRaisesRegex(mps.StateError, why):
                call()
            asked += 1
        self.assertGreater(asked, 0)
        self.assertIn("mps", repr(one))
        if hasattr(one, "close"):
            one.close()
            one.close()
            self.assertTrue(one.closed)

    def test_simulation(self) -> None:
        sim = still()
        sim.close()
        self.closed(sim, "the simulation is closed")
        for expression in (lambda: sim["velocity"], lambda: sim.__setitem__("velocity", 0), lambda: dict(mps.catalogue(sim)), lambda: mps.Snapshot(sim)):
            self.assertRaisesRegex(mps.StateError, "closed", expression)

    def test_children(self) -> None:
        """A child after its simulation was closed, and after it was closed alone."""
        for name, make in CHILDREN.items():
            sim = still()
            sim.step()
            child = make(sim)
            array = child.array if hasattr(child, "array") else None
            sim.close()
            if name in ("reads", "writes"):
                self.assertEqual(len(array), len(child.array))
                self.assertTrue(np.isfinite(array).all())
                if name == "writes":
                    self.assertRaisesRegex(mps.StateError, "simulation is closed", child.close)
                child.close()
                self.assertTrue(child.closed)
                continue
            self.closed(child, "simulation is closed")
            if hasattr(child, "close"):
                alone = still()
                child = make(alone)
                child.close()
                self.closed(child, "closed")
                alone.step()

    def test_block_that_closes(self) -> None:
        sim = still()
        with self.assertRaisesRegex(mps.StateError, "simulation is closed"), sim.write("velocity"):
            sim.close()
        sim = still()
        with sim.read("velocity") as u:
            sim.close()
        self.assertEqual(u.sum(), 0.0)
        with still() as sim, sim.frames(".") as frames, sim.snapshot() as state:
            frames.write()
            sim.close()
        self.assertTrue(frames.closed and state.closed)

    def test_collected(self) -> None:
        """Objects go in any order, alone and in a cycle that the collector finalises as it likes."""
        for order in itertools.permutations(range(4)):
            sim = still()
            all_: list[Any] = [sim, sim.frames("."), sim.snapshot(), sim.read("position")]
            del sim
            for k in order:
                all_[k] = None
        sim = still()
        ring: list[Any] = [sim, *[make(sim) for make in list(CHILDREN.values())[:3]]]
        ring.append(ring)
        case = mps.Case(TANK)
        job = case.build("job", say=None)
        knot: list[Any] = [job.simulation.snapshot(), job, case, job.simulation]
        knot.append(knot)
        del ring, knot, sim, case, job
        gc.collect()
        sim = still()
        seen = [sim.read("velocity"), sim.snapshot()]
        del sim
        self.assertTrue(not seen[1].closed)  # a child keeps its simulation
        seen[1].take()

    def test_within_callbacks(self) -> None:
        """Closing a running object is refused in the monitor, a motion, a log, a model, a body, a
        fill and a solid; the run continues."""
        sim = still()
        refused: list[str] = []

        def closes(*_: Any) -> Any:
            try:
                sim.close()
            except mps.BusyError as e:
                refused.append(str(e))
            return 0.0

        class Closes(mps.Model):
            name, help = "mine.closes", "closes the simulation"

            @mps.verb(mps.MPS_FORCE, velocity=mps.MPS_USE_READ)
            def push(self, s: mps.Stage) -> None:
                closes()

        def by(what: str, call: Callable[[], Any]) -> None:
            refused.clear()
            call()
            self.assertTrue(refused and "cannot be closed within a call" in refused[0], what)
            self.assertFalse(sim.closed)

        by("monitor", lambda: sim.run(sim.t + 1e-3, closes))
        sim.use(Closes())
        by("model", sim.step)
        sim.remove("mine")
        sim.move_by(lambda t, state: (closes(), state.set("x", 0.0, 0.0, 0.0)))
        by("motion", sim.step)
        sim.stop()
        sim.body("x", mass=10.0, load=lambda t, state: (closes(), [0.0] * 6)[1])
        by("load", sim.step)
        by("fill", lambda: sim.fill(lambda x: closes() == 0.0))
        sim = mps.Simulation(dp=0.05, log=lambda *_: closes())
        by("log", lambda: sim.tank(size=(1.02, 0.6)))
        by("solid", lambda: sim.solid(lambda x: closes() or float(np.hypot(*(x - 0.3)) - 0.1), (0.1, 0.1), (0.5, 0.5), name="ball"))
        sim.close()
        with self.assertRaises(mps.BusyError):
            still().run(1.0, lambda s, info: s.close())

    def test_job(self) -> None:
        case = mps.Case(TANK, set={"run.until": "0.02 s"})
        job = case.build("a", say=None)
        snapshot, sensors = job.simulation.snapshot(), job.simulation.read("kind")
        case.close()
        for one in (case, job, job.simulation, snapshot):
            self.closed(one, "closed")
        self.assertGreater(len(sensors.array), 0)
        said: list[str] = []
        begun = False
        case = mps.Case(TANK, set={"run.until": "0.02 s"})

        def say(_kind: int, _what: str) -> None:
            for one in (job, case, job.simulation) if begun and not said else ():
                self.assertRaises(mps.BusyError, one.close)
            said.append("")

        job = case.build("b", say=None)
        job.close()
        job = case.build("b", say=say, overwrite=True)
        said.clear()
        begun = True
        job.run()
        self.assertTrue(said)
        self.assertRaisesRegex(mps.StateError, "has run", job.run)
        job.simulation.close()
        self.closed(job.simulation, "simulation is closed")
        cloud = mps.Cloud(np.stack(np.meshgrid(range(3), range(3)), -1).reshape(-1, 2) * 0.1, 0.1)
        cloud.close()
        self.closed(cloud, "the cloud is closed")

    def test_copies(self) -> None:
        sim = still()
        info = sim.step()
        case = mps.Case(TANK)
        held: list[Any] = [sim, case, case.build("copies", say=None), mps.Cloud(np.zeros((1, 2)), 0.1), *[make(sim) for make in CHILDREN.values()]]
        for one in held:
            for how in (copy.copy, copy.deepcopy, pickle.dumps):
                if isinstance(one, mps.Probe) and how is copy.copy:
                    continue  # the same sensor of the same simulation
                with self.subTest(kind=type(one).__name__, how=how.__name__), self.assertRaisesRegex(TypeError, "cannot be copied or pickled"):
                    how(one)
        for again in (copy.copy(info), copy.deepcopy(info), pickle.loads(pickle.dumps(info))):
            self.assertEqual((again.t, again.limit, repr(again)), (info.t, info.limit, repr(info)))
        momentum = pickle.loads(pickle.dumps(sim.momentum))
        np.testing.assert_array_equal(momentum.total, sim.momentum.total)

    def test_kept_after_callbacks(self) -> None:
        """What a callback gets may be kept."""
        sim = still()
        kept: list[Any] = []

        class Keeps(mps.Model):
            name, help = "mine.keeps", "keeps its stage"

            @mps.verb(mps.MPS_FORCE, velocity=mps.MPS_USE_READ, acceleration=mps.MPS_USE_CHANGE)
            def push(self, s: mps.Stage) -> None:
                kept.extend([s, s.x, s["velocity"], s["acceleration"], s.near])

        def swing(t: float, state: mps.State) -> None:
            kept.append(state)
            state.set("x", 1e-3 * t, 1e-3, 0.0)

        sim.use(Keeps())
        sim.use("gas.pocket")
        sim.move_by(swing)
        sim.step()
        sim.close()
        for one in kept:
            if isinstance(one, mps.Stage):
                for ask in (lambda: one["velocity"], lambda: one.id, lambda: one.far, lambda: one.limit_step(1.0)):
                    self.assertRaisesRegex(mps.StateError, "ends with its verb", ask)
            elif isinstance(one, mps.State):
                one.set("x", 1.0, 2.0, 3.0)
            elif isinstance(one, np.ndarray):
                self.assertTrue(np.isfinite(one).all())

    def test_model_again(self) -> None:
        """The library keeps pointers to a model: another one of its name does not take them away."""
        class Fixed(mps.Model):
            name, help = "mine.fixed", "holds the liquid"

            @mps.verb(mps.MPS_FORCE, acceleration=mps.MPS_USE_CHANGE)
            def push(self, s: mps.Stage) -> None:
                s["acceleration"][...] = 0

        class Derived(Fixed):
            name = "mine.derived"

        sim, one = still(), Fixed()
        sim.use(one)
        sim.use(one)
        for _ in range(3):
            self.assertRaisesRegex(mps.ArgumentError, "taken", sim.use, Fixed())
        gc.collect()
        sim.step()
        sim.use(Derived())
        sim.step()
        self.assertIn("mine.derived", sim.models)

    def test_forked(self) -> None:
        """A process that was forked off ends without the threads of its parent."""
        sim = mps.Simulation(dp=0.1, threads=2, log=lambda *_: None)
        sim.tank(size=(1.0, 0.6))
        sim.fill_level(lo=(0, 0), hi=(1.0, 0.3))
        sim.step()
        child = os.fork()
        if child == 0:
            sim.close()
            os._exit(7 if sim.closed else 8)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 7)
        sim.step()

    def test_unfinished_objects(self) -> None:
        """One whose __init__ failed, or never ran."""
        self.assertRaises(mps.ArgumentError, mps.Simulation, dp=-1)
        self.assertRaises(mps.ArgumentError, mps.Cloud, np.zeros((4, 4)), 0.1)
        self.assertRaises(mps.Error, mps.Case, Path("none.yaml"))
        for kind in (mps.Simulation, mps.Frames, mps.Snapshot, mps.Case, mps.Job, mps.Cloud, mps.Lease):
            kind.__new__(kind).close()
        gc.collect()


if __name__ == "__main__":
    unittest.main()
