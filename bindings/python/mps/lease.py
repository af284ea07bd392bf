# SPDX-License-Identifier: BSD-3-Clause
"""Arrays of particles, as arrays of numpy in the library's own memory."""
from __future__ import annotations

from ctypes import byref
from typing import TYPE_CHECKING

import numpy as np

from ._library import c
from ._numbers import MPS_READ, MPS_WRITE
from ._records import make
from ._structs import mps_lease

if TYPE_CHECKING:
    from .simulation import Simulation


class Lease:
    """An array of the library, without a copy; it must not be used after the lease has ended. Used as a context:

        with sim.write("velocity") as u:
            u[sim.fluid] = 0

    An exception, or a value that is not finite, brings back the values before."""

    def __init__(self, sim: Simulation, field: str, write: bool) -> None:
        self._sim, self._lease = sim, make(mps_lease)
        sim.check(c.mps_lease_begin(sim.handle, field.encode(), MPS_WRITE if write else MPS_READ, byref(self._lease)))
        self._open = True
        self.array = self._view(write)
        self._before = self.array.copy() if write else None

    def _view(self, write: bool) -> np.ndarray:
        lease = self._lease
        start = [lease.data, lease.integers, lease.ids][lease.type]
        shape = (lease.count,) if lease.stride == 1 else (lease.count, lease.stride)
        if lease.count == 0:
            return np.empty(shape, dtype=[np.float64, np.int32, np.int64][lease.type])
        view = np.ctypeslib.as_array(start, shape)
        view.flags.writeable = write
        return view

    def _end(self) -> int:
        status = c.mps_lease_end(self._sim.handle, byref(self._lease))
        self._open = status != 0
        return status

    def close(self) -> None:
        """End the lease. Where a written value is not allowed, the array gets its values before, and the call fails."""
        if self._open and (status := self._end()) != 0:
            failure = self._sim.failure(status)
            self.drop()
            raise failure

    def drop(self) -> None:
        """End the lease with the values before."""
        if self._open:
            if self._before is not None:
                self.array[...] = self._before
            self._end()

    def __enter__(self) -> np.ndarray:
        return self.array

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is None:
            self.close()
        else:
            self.drop()
