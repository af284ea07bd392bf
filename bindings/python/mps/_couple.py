# SPDX-License-Identifier: BSD-3-Clause
"""Coupling of the tank to a body that another program computes: mps/couple.h."""
from __future__ import annotations

from collections.abc import Callable, Mapping
from ctypes import POINTER, byref
from typing import TYPE_CHECKING, Any

from . import _numbers as N
from . import _structs as T
from ._library import c
from ._motion import degree
from ._records import Record, make, reals

if TYPE_CHECKING:
    from .simulation import Simulation


class Coupling:
    """Functions of mps/couple.h."""

    handle: Any
    if TYPE_CHECKING:
        check: Callable[[int], int]

    def pose_to(self, t_end: float, poses: Mapping[str, Any]) -> None:
        """Move the tank from its present pose to this one, where it is at t_end: {"x": (value, rate, accel)} or {"x": value}."""
        state = make(T.mps_motion_state)
        for name, given in poses.items():
            k = degree(name)
            if isinstance(given, float):
                state.value[k] = given
                continue
            values = list(given) if hasattr(given, "__len__") else [given]
            for array, value in zip((state.value, state.rate, state.accel), values):
                array[k] = value
        self.check(c.mps_motion_pose_set(self.handle, t_end, byref(state)))

    def watch_load(self, mass: bool = False) -> None:
        """The next steps find out the load of the liquid; mass: its added mass too."""
        self.check(c.mps_load_watch(self.handle, N.MPS_LOAD_MASS if mass else N.MPS_LOAD_FORCE))

    def load(self, centre: Any = None) -> Record:
        """Load on the tank in the last step: mps_load, with mass as a matrix [6, 6]. About the centre of rotation unless given."""
        load = make(T.mps_load)
        self.check(c.mps_load_get(self.handle, None if centre is None else reals(centre, 3), byref(load)))
        return Record(load, mass=(6, 6))

    def snapshot(self) -> Snapshot:
        """The present state in memory; restore() comes back to it, as often as wanted."""
        return Snapshot(self).take()  # type: ignore[arg-type]


class Snapshot:
    """State of a simulation in memory. The simulation must outlive it."""

    def __init__(self, sim: Simulation) -> None:
        self._sim, self._snapshot = sim, POINTER(T.mps_snapshot)()
        sim.check(c.mps_snapshot_create(sim.handle, byref(self._snapshot)))

    def take(self) -> Snapshot:
        """Copy the present state into it, in place of what it holds."""
        self._sim.check(c.mps_snapshot_take(self._snapshot))
        return self

    def restore(self) -> None:
        """Give the simulation the state that it holds."""
        self._sim.check(c.mps_snapshot_restore(self._snapshot))

    def close(self) -> None:
        """Give back its memory."""
        if self._snapshot and self._sim.handle is not None:
            c.mps_snapshot_destroy(self._snapshot)
        self._snapshot = POINTER(T.mps_snapshot)()

    def __enter__(self) -> Snapshot:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        if getattr(self, "_snapshot", None):
            self.close()
