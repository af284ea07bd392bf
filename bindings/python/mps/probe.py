# SPDX-License-Identifier: BSD-3-Clause
"""Sensors of a simulation."""
from __future__ import annotations

from ctypes import POINTER, byref, c_double, c_int64
from typing import TYPE_CHECKING

import numpy as np

from ._library import c
from ._records import Record, make, record
from ._structs import mps_probe_info

if TYPE_CHECKING:
    from .simulation import Simulation


class Probe:
    """A sensor that was added to a simulation."""

    def __init__(self, sim: Simulation, number: int) -> None:
        self._sim, self.number = sim, number

    @property
    def size(self) -> int:
        """Number of its values."""
        return c.mps_probe_size(self._sim.handle, self.number)

    @property
    def info(self) -> Record:
        """Its description, and the face that it reads: mps_probe_info."""
        info = make(mps_probe_info)
        self._sim.check(c.mps_probe_info_get(self._sim.handle, self.number, byref(info)))
        return record(info)

    def read(self) -> np.ndarray:
        """Its present values, [size]; with an average the mean up to now."""
        values = (c_double * max(self.size, 1))()
        self._sim.check(c.mps_probe_read(self._sim.handle, self.number, values))
        return np.array(values)

    @property
    def value(self) -> float:
        """The first present value."""
        return float(self.read()[0])

    def series(self) -> tuple[np.ndarray, np.ndarray]:
        """Times [n] and values [n, size] of the samples that its `rate` kept, as copies."""
        count, t, values = c_int64(), POINTER(c_double)(), POINTER(c_double)()
        self._sim.check(c.mps_probe_series(self._sim.handle, self.number, byref(count), byref(t), byref(values)))
        n, size = count.value, self.size
        if n == 0:
            return np.empty(0), np.empty((0, size))
        return (np.ctypeslib.as_array(t, (n,)).copy(), np.ctypeslib.as_array(values, (n, size)).copy())

    def clear(self) -> None:
        """Remove the samples so far."""
        self._sim.check(c.mps_probe_series_clear(self._sim.handle, self.number))

    def remove(self) -> None:
        """Remove the sensor."""
        self._sim.check(c.mps_probe_remove(self._sim.handle, self.number))
