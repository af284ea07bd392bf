# SPDX-License-Identifier: BSD-3-Clause
"""Coupling of the tank to a rigid body, computed by another program (mps/couple.h) or by the
library (mps/body.h)."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from ctypes import POINTER, byref
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _numbers as N
from . import _structs as T
from . import errors
from ._held import Held, Owner
from ._library import c
from ._motion import degree
from ._records import Calls, Record, copied, make, real, reals, record

if TYPE_CHECKING:
    from .simulation import Simulation


def _six(given: Any) -> list[float]:
    """Numbers along the six degrees of freedom."""
    if not isinstance(given, Mapping):
        numbers = [float(value) for value in given]
        if len(numbers) != 6:
            raise errors.ArgumentError(f"{len(numbers)} numbers for six degrees of freedom")
        return numbers
    out = [0.0] * 6
    for name, value in given.items():
        out[degree(name)] = float(value)
    return out


def _matrix(given: Any) -> Any:
    """A matrix of the six degrees of freedom from its diagonal by name, or as it is."""
    if given is None or isinstance(given, Mapping):
        return np.diag(_six(given or {}))
    numbers = np.asarray(given, dtype=float)
    if numbers.shape != (6, 6):
        raise errors.ArgumentError(f"a matrix of the degrees of freedom is [6, 6], not {list(numbers.shape)}")
    return numbers


class Coupling:
    """Functions of mps/couple.h and mps/body.h."""

    handle: Any
    _calls: Calls
    if TYPE_CHECKING:
        check: Callable[[int], int]

    def pose_to(self, t_end: float, poses: Mapping[str, Any] | None = None, **more: Any) -> None:
        """Move the tank from its present pose to this one, where it is at t_end: pose_to(t_end, x=(value, rate, accel)) or x=value, in m and
        rad, or a dict of them."""
        state = make(T.mps_motion_state)
        for name, given in {**(poses or {}), **more}.items():
            k = degree(name)
            if isinstance(given, float):
                state.value[k] = given
                continue
            values = list(given) if hasattr(given, "__len__") else [given]
            for array, value in zip((state.value, state.rate, state.accel), values):
                array[k] = value
        self.check(c.mps_motion_pose_set(self.handle, real("t_end", t_end), byref(state)))

    def watch_load(self, mass: bool = False) -> None:
        """The next steps compute the load of the liquid; mass: also its added mass."""
        self.check(c.mps_load_watch(self.handle, N.MPS_LOAD_MASS if mass else N.MPS_LOAD_FORCE))

    def load(self, centre: Any = None) -> Record:
        """Load on the tank in the last step: mps_load, with mass as a matrix [6, 6]. Default
        point: the centre of rotation."""
        load = make(T.mps_load)
        self.check(c.mps_load_get(self.handle, None if centre is None else reals(centre, 3), byref(load)))
        return record(load)

    def body(self, free: str | Sequence[str], mass: float = 0.0, *, inertia: Any = 0.0, centre_of_mass: Any = (0.0, 0.0, 0.0),
             stiffness: Any = None, damping: Any = None, equilibrium: Mapping[str, float] | None = None, gravity: bool = True,
             load: Callable[[float, Record], Any] | None = None) -> None:
        """A rigid body carries the tank; steps solve it together with the liquid: mps_body.

        free: degrees of freedom, e.g. "x" or ("x", "rotate_z"). mass without the liquid, inertia about centre_of_mass: one about z, or [3, 3].
        stiffness, damping: {"rotate_z": 1e4} for single degrees of freedom, or [6, 6]. equilibrium: where
        the springs have no load.
        load(t, state): other loads, as {"x": force, "rotate_z": moment} or six numbers; state has value, rate and accel [6].

            sim.body("x", mass=50.0)
            sim.run(4.0)
            sim.body_report.pose[0]"""
        one = make(T.mps_body, {"mass": mass, "centre_of_mass": centre_of_mass, "gravity": gravity, "stiffness": _matrix(stiffness),
                                "damping": _matrix(damping), "equilibrium": _six(equilibrium or {})}, "body")
        one.free = sum({1 << degree(name) for name in ([free] if isinstance(free, str) else free)})
        numbers = np.asarray(inertia, dtype=float).reshape(-1)
        if len(numbers) not in (1, 9):
            raise errors.ArgumentError(f"inertia: {len(numbers)} numbers; one about z, or [3, 3]")
        for k, number in enumerate(numbers):
            one.inertia[k if len(numbers) == 9 else 8] = number

        def call(_user: Any, t: float, state: Any, out: Any) -> int:
            for k, value in enumerate(_six(load(t, record(copied(state.contents))))):  # type: ignore[misc]
                out[k] = value
            return 0

        kept = None
        if load is not None:
            kept = one.load = T.mps_body_load_fn(self._calls.guard(call, 1))
        self.check(c.mps_body_set(self.handle, byref(one)))
        self._calls.kept["body"] = kept

    @property
    def body_report(self) -> Record:
        """The body in the last step: mps_body_report, with mass as a matrix [6, 6]."""
        report = make(T.mps_body_report)
        self.check(c.mps_body_get(self.handle, byref(report)))
        return record(report)

    def snapshot(self) -> Snapshot:
        """Save the present state in memory; restore() returns to it any number of times."""
        return Snapshot(self).take()  # type: ignore[arg-type]


class Snapshot(Owner):
    """State of a simulation in memory; the simulation owns it."""

    def __init__(self, sim: Simulation) -> None:
        self._sim, snapshot = sim, POINTER(T.mps_snapshot)()
        sim.check(c.mps_snapshot_create(sim.handle, byref(snapshot)))
        self._held = Held("snapshot", snapshot, c.mps_snapshot_destroy, sim._held)

    def take(self) -> Snapshot:
        """Replace the saved state by the present one."""
        with self._held as snapshot:
            self._sim.check(c.mps_snapshot_take(snapshot))
        return self

    def restore(self) -> None:
        """Set the simulation to the saved state."""
        with self._held as snapshot:
            self._sim.check(c.mps_snapshot_restore(snapshot))
