# SPDX-License-Identifier: BSD-3-Clause
"""Errors of libmps as exceptions. Their text is that of the library: what failed, which value, what is allowed."""
from __future__ import annotations

import re

from . import _structs
from ._numbers import STATUSES


class Error(Exception):
    """A call failed; the state is as before."""

    status = 0


class ArgumentError(Error, ValueError):
    """A value is out of its range."""


class MemoryFull(Error, MemoryError):
    """An allocation failed."""


class BusyError(Error):
    """An array is in use, or the call is not allowed in a callback."""


class UnknownName(Error, KeyError):
    """No model, solver, field or part has this name."""

    def __str__(self) -> str:  # KeyError quotes its text
        return str(self.args[0]) if self.args else ""


class StateError(Error):
    """The call is not allowed now."""


class Diverged(Error, ArithmeticError):
    """A value became NaN or left every physical range."""


class ParticleLost(Error):
    """A particle left the domain or is behind a wall."""


class SolverError(Error, ArithmeticError):
    """The pressure solver broke down."""


class PluginError(Error):
    """A model or a function of yours failed; its own exception is the cause of this one."""


class FileError(Error, OSError):
    """A file could not be read or written."""


class VersionError(Error):
    """A struct or a file comes from a newer version."""


class RanksError(Error):
    """Another rank failed, or the communication between ranks."""


class NotConverged(UserWarning):
    """A step was done, but the pressure residual stayed above its tolerance."""


_KINDS: dict[str, type[Error]] = {
    "MPS_E_ARG": ArgumentError, "MPS_E_NOMEM": MemoryFull, "MPS_E_BUSY": BusyError, "MPS_E_NAME": UnknownName,
    "MPS_E_STATE": StateError, "MPS_E_DIVERGED": Diverged, "MPS_E_LOST": ParticleLost, "MPS_E_SOLVER": SolverError,
    "MPS_E_PLUGIN": PluginError, "MPS_E_IO": FileError, "MPS_E_VERSION": VersionError, "MPS_E_RANKS": RanksError,
}
_NAMES = {number: name for name, (number, _) in STATUSES.items()}

# Functions of C that texts of the library name, without mps_, in this package.
PYTHON = {
    "baffle_add": "baffle()", "body_get": "body_report", "body_set": "body()", "channel_info_get": "catalogue()",
    "case_open": "Case()", "checkpoint_read": "restore()", "checkpoint_write": "checkpoint()", "energy_get": "energy",
    "field_add": "add_field()", "fill_add": "fill()", "fill_box_add": "fill_box()", "fill_level_add": "fill_level()",
    "frames_close": "Frames.close()", "frames_open": "frames()", "frames_write": "Frames.write()", "kernel_find": "Cloud()",
    "lattice_get": "lattice", "lease_begin": "read() or write()", "lease_end": "Lease.close()", "load_get": "load()",
    "load_watch": "watch_load()", "model_get": "get()", "model_info_get": "catalogue()", "model_register": "use()",
    "model_remove": "remove()", "model_set": "set()", "model_use": "use()", "momentum_get": "momentum",
    "motion_callback_set": "move_by()", "motion_centre_set": "motion_centre()", "motion_clear": "stop()",
    "motion_harmonics_set": "move_harmonic()", "motion_pose_set": "pose_to()", "motion_state_at": "pose_at()", "motion_state_get": "pose",
    "motion_table_set": "move_table()", "motion_to_lab": "to_lab()", "neighbours_build": "Cloud()",
    "neighbours_create": "Cloud()", "neighbours_stencil_get": "Cloud()", "op_correction": "Cloud.correction()",
    "op_volume_deviation": "Cloud.volume_deviation()", "particles_add": "add_particles()",
    "particles_remove": "remove_particles()", "phase_set": "phase()", "plate_add": "plate()", "preset_use": "preset()",
    "probe_add": "probe()", "probe_info_get": "Probe.info", "probe_read": "Probe.read()", "probe_remove": "Probe.remove()",
    "probe_series": "Probe.series()", "probe_series_clear": "Probe.clear()", "run": "run()", "sim_create": "Simulation()",
    "sim_destroy": "close()", "snapshot_create": "snapshot()", "snapshot_destroy": "Snapshot.close()",
    "snapshot_restore": "Snapshot.restore()", "snapshot_take": "Snapshot.take()", "solid_add": "solid()",
    "solver_limits_set": "solver()", "solver_use": "solver()", "step": "step()", "stl_add": "stl()", "tank_add": "tank()",
    "tension_set": "tension()", "threads_set": "threads()", "time_control_set": "time_control()",
}


# What texts of jobs and cases call options of programs.
_OPTIONS = {"set": "set", "out": "folder", "resume": "resume=True", "overwrite": "overwrite=True", "checkpoint": "output.checkpoint",
            "allow-plugins": 'plugins="all"', "plugin FILE": "plugin=[FILE]", "plugin": "plugin"}


def _word(found: re.Match[str]) -> str:
    """A function with its brackets, a member of a struct, or an option; a file may have the name
    of a function or a struct."""
    if found["function"]:
        return PYTHON.get(found["function"], found[0])
    if found["struct"]:
        entries = getattr(getattr(_structs, found["struct"], None), "_fields_", ())
        return found["entry"] if found["entry"] in [f[0] for f in entries] else found[0]
    return _OPTIONS[found["option"]] if found["option"] else ""


_WORDS = re.compile(r"\bmps_(?P<function>\w+)\(\)|\b(?P<struct>mps_\w+)\.(?P<entry>\w+)|, or in another folder with --out\b| with --out\b|"
                    r"(?<![\w-])--(?P<option>set|out|resume|overwrite|checkpoint|allow-plugins|plugin FILE|plugin)\b|\bconfig\.(?=\w+ is )")


def in_python(text: str) -> str:
    """A text of the library in the terms of this package: its functions, members as keywords,
    options as arguments. Functions without a counterpart (models in C, ranks, devices) stay
    unchanged."""
    return _WORDS.sub(_word, text)


def error(status: int, text: str = "") -> Error:
    """The exception of a status. Default text: the meaning of the status."""
    name = _NAMES.get(status, "")
    e = _KINDS.get(name, Error)(in_python(text) or STATUSES.get(name, (status, f"status {status}"))[1])
    e.status = status
    return e
