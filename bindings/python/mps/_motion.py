# SPDX-License-Identifier: BSD-3-Clause
"""Motion of the tank of a simulation."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from ctypes import byref, c_double, c_int32
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _numbers as N
from . import _structs as T
from . import errors
from ._library import c
from ._records import Calls, Record, copied, make, real, reals, record

DEGREES = {"x": N.MPS_MOVE_X, "y": N.MPS_MOVE_Y, "z": N.MPS_MOVE_Z, "rotate_x": N.MPS_ROTATE_X, "rotate_y": N.MPS_ROTATE_Y,
           "rotate_z": N.MPS_ROTATE_Z}


def degree(name: str) -> int:
    """Index of a degree of freedom."""
    if name not in DEGREES:
        raise errors.UnknownName(f"no degree of freedom '{name}'; there are {', '.join(DEGREES)}")
    return DEGREES[name]


class State:
    """Pose of a tank with its derivatives, for functions that move it: by name of the degree of
    freedom, in m and rad.

        def swing(t, state):
            state.set("rotate_z", 0.1 * sin(5 * t), 0.5 * cos(5 * t), -2.5 * sin(5 * t))"""

    def __init__(self, struct: Any) -> None:
        self.struct = struct

    def set(self, name: str, value: float, rate: float, accel: float) -> None:
        """Value, first and second derivative of a degree of freedom."""
        k = degree(name)
        self.struct.value[k], self.struct.rate[k], self.struct.accel[k] = value, rate, accel


class Motion:
    """Functions of mps/motion.h."""

    handle: Any
    dim: int
    _calls: Calls
    if TYPE_CHECKING:
        check: Callable[[int], int]

    def motion_centre(self, centre: Any, with_tank: bool = False) -> None:
        """Centre of rotation [m]; with_tank: the liquid begins with the velocity of the tank."""
        self.check(c.mps_motion_centre_set(self.handle, reals(centre, 3), N.MPS_START_WITH_TANK if with_tank else N.MPS_START_AT_REST))

    def move_harmonic(self, *harmonics: Mapping[str, Any], **one: Any) -> None:
        """Harmonic motion: value = amplitude sin(omega t + phase), as move_harmonic(dof="rotate_z", amplitude=0.07, omega=5, ramp=2), or the
        sum of several: move_harmonic({"dof": "x", ...}, {"dof": "y", ...}). dof: x, y, z [m], rotate_x, rotate_y, rotate_z [rad]; the other
        keywords are members of mps_harmonic."""
        harmonics += (one,) if one else ()
        if not harmonics:
            raise errors.error(N.MPS_E_ARG, "move_harmonic(dof='x', amplitude=0.02, omega=5.0): no motion is given; stop() ends one")
        all_ = (T.mps_harmonic * len(harmonics))()
        for k, given in enumerate(harmonics):
            all_[k] = make(T.mps_harmonic, {**given, "dof": degree(given.get("dof", "x"))}, "harmonic")
        self.check(c.mps_motion_harmonics_set(self.handle, len(harmonics), all_))

    def move_table(self, t: Sequence[float], columns: Mapping[str, Sequence[float]] | None = None, **more: Sequence[float]) -> None:
        """Motion from a table: times [s] and a column for each degree of freedom [m, rad], move_table(t, x=[...],
        rotate_z=[...]) or a dict of them;
        between rows a spline."""
        columns = {**(columns or {}), **more}
        if not columns:
            raise errors.error(N.MPS_E_ARG, "move_table(t, x=[...]): no column is given")
        dofs = (c_int32 * len(columns))(*[degree(name) for name in columns])
        lengths = {len(column) for column in columns.values()} | {len(t)}
        if len(lengths) != 1:
            raise errors.ArgumentError(f"a table has columns of one length, not of {sorted(lengths)}")
        values = np.stack([np.asarray(v, dtype=float) for v in columns.values()], axis=1)
        self.check(c.mps_motion_table_set(self.handle, len(t), reals(t), len(columns), dofs, reals(values)))

    def move_by(self, function: Callable[[float, State], None]) -> None:
        """Motion by a function of yours, function(t, state), a smooth function of t alone; see State."""
        def call(_user: Any, t: float, state: Any) -> int:
            own = copied(state.contents)  # yours may keep its State, the library's memory ends with the call
            function(t, State(own))
            state[0] = own
            return 0

        kept = T.mps_motion_fn(self._calls.guard(call, 1))
        self.check(c.mps_motion_callback_set(self.handle, kept, None))
        self._calls.kept["motion"] = kept

    def stop(self) -> None:
        """Remove the motion."""
        self.check(c.mps_motion_clear(self.handle))

    @property
    def pose(self) -> Record:
        """Present values, rates and accelerations of the six degrees of freedom."""
        state = make(T.mps_motion_state)
        self.check(c.mps_motion_state_get(self.handle, byref(state)))
        return record(state)

    def pose_at(self, t: float) -> Record:
        """Values, rates and accelerations of the prescribed motion at a time [s]."""
        state = make(T.mps_motion_state)
        self.check(c.mps_motion_state_at(self.handle, real("t", t), byref(state)))
        return record(state)

    def to_lab(self, point: Any) -> tuple[np.ndarray, np.ndarray]:
        """Position in the lab frame of a point of the tank, and its velocity."""
        lab, velocity = (c_double * 3)(), (c_double * 3)()
        self.check(c.mps_motion_to_lab(self.handle, reals(point, 3), lab, velocity))
        return np.array(lab)[: self.dim], np.array(velocity)[: self.dim]
