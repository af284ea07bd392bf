# SPDX-License-Identifier: BSD-3-Clause
"""Arrays of particles as numpy arrays."""
from __future__ import annotations

from ctypes import byref
from typing import TYPE_CHECKING

import numpy as np

from ._held import Held, Owner
from ._library import c
from ._numbers import MPS_READ, MPS_WRITE
from ._records import coded, make
from ._structs import mps_lease

if TYPE_CHECKING:
    from .simulation import Simulation


class Lease(Owner):
    """The values of a field, to read or to write, as an array of numpy; meanwhile particles keep their order and no step is done.

        with sim.write("velocity") as u:
            u[sim.fluid] = 0

    The array is a copy: it can be used after the lease, and after the simulation is closed. Its
    values are written to the library at the end. After an exception, or with a value that is not allowed, the field is unchanged."""

    _instead = "; its array can be"
    _ended = True

    def __init__(self, sim: Simulation, field: str, write: bool) -> None:
        self._sim, self._field, self._write = sim, str(field), write
        handle, lease = sim.handle, make(mps_lease)
        sim.check(c.mps_lease_begin(handle, coded(self._field), MPS_WRITE if write else MPS_READ, byref(lease)))
        self._held = Held(f"lease of '{self._field}'", lease, lambda lease: c.mps_lease_end(handle, byref(lease)), sim._held)
        self._ended = False
        self.array = self._view().copy()
        self.array.flags.writeable = write

    def _view(self) -> np.ndarray:
        lease = self._held.pointer
        start = [lease.data, lease.integers, lease.ids][lease.type]
        shape = (lease.count,) if lease.stride == 1 else (lease.count, lease.stride)
        if lease.count == 0:
            return np.empty(shape, dtype=[np.float64, np.int32, np.int64][lease.type])
        return np.ctypeslib.as_array(start, shape)

    def close(self) -> None:
        """End the lease: write the values of the array to the field. If one is not allowed, the
        field keeps its values, and the call fails."""
        if self._ended:
            return
        self._ended = True
        try:
            if self._write:
                self._put()
        finally:
            self._held.close()

    def _put(self) -> None:
        view = self._view()
        before = view.copy()
        view[...] = self.array
        status = c.mps_lease_end(self._sim.handle, byref(self._held.pointer))
        if status != 0:
            failure = self._sim.failure(status)
            view[...] = before
            raise failure
        self._held.forget()

    def drop(self) -> None:
        """End the lease; the field keeps its values."""
        self._ended = True
        self._held.close()

    def __enter__(self) -> np.ndarray:  # type: ignore[override]
        return self.array

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is None:
            self.close()
        else:
            self.drop()
