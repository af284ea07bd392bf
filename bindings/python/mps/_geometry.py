# SPDX-License-Identifier: BSD-3-Clause
"""Tanks, solids, fills of a simulation."""
from __future__ import annotations

from collections.abc import Callable
from ctypes import byref, c_double, c_int64
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _structs as T
from ._library import c
from ._records import Calls, coded, make, reals, whole

if TYPE_CHECKING:
    Check = Callable[[int], int]


class Geometry:
    """Functions of mps/geometry.h. Positions are in the frame of the tank [m]; up is y."""

    handle: Any
    dim: int
    _calls: Calls
    if TYPE_CHECKING:
        check: Check

    def tank(self, size: Any, **entries: Any) -> np.ndarray:
        """A rectangular tank; members of mps_tank: lo, name, open_top, dummy_layers. Returns its
        size as built."""
        built = (c_double * 3)()
        self.check(c.mps_tank_add(self.handle, byref(make(T.mps_tank, {"size": size, **entries}, "tank")), built))
        return np.array(built)[: self.dim]

    @property
    def lattice(self) -> tuple[np.ndarray, np.ndarray]:
        """Origin and spacings of the lattice of fills."""
        lo, h = (c_double * 3)(), (c_double * 3)()
        self.check(c.mps_lattice_get(self.handle, lo, h))
        return np.array(lo)[: self.dim], np.array(h)[: self.dim]

    def baffle(self, name: str, lo: Any, hi: Any) -> np.ndarray:
        """A solid box, or a plate of one to three layers. Returns the corners as built, [2, dim]."""
        built = (c_double * 6)()
        self.check(c.mps_baffle_add(self.handle, coded(name), reals(lo, 3), reals(hi, 3), built))
        return np.array(built)[: 2 * self.dim].reshape(2, self.dim)

    def plate(self, name: str, corner: Any, edge: Any, edge2: Any = None) -> None:
        """A thin plate from a corner along an edge; in 3-D along two."""
        self.check(c.mps_plate_add(self.handle, coded(name), reals(corner, 3), reals(edge, 3), None if edge2 is None else reals(edge2, 3)))

    def solid(self, distance: Callable[[np.ndarray], float], lo: Any, hi: Any, **entries: Any) -> None:
        """A solid by its distance function: distance([dim]) in m, as in mps_solid, in the box lo
        .. hi."""
        dim = self.dim

        def call(_user: Any, x: Any) -> float:
            return float(distance(np.array(x[:dim])))

        one = make(T.mps_solid, {"lo": lo, "hi": hi, **entries}, "solid")
        one.distance = T.mps_distance_fn(self._calls.guard(call, float("nan")))
        self.check(c.mps_solid_add(self.handle, byref(one)))

    def stl(self, path: str, **entries: Any) -> np.ndarray:
        """A tank or a solid from an STL file, with members of mps_stl. Returns the corners as
        built, [2, dim]."""
        built = (c_double * 6)()
        self.check(c.mps_stl_add(self.handle, coded(str(path)), byref(make(T.mps_stl, entries, "stl")), built))
        return np.array(built)[: 2 * self.dim].reshape(2, self.dim)

    def fill_box(self, lo: Any, hi: Any, phase: int = 0) -> int:
        """Fluid in a box of the lattice. Returns the number of particles."""
        added = c_int64()
        self.check(c.mps_fill_box_add(self.handle, whole("phase", phase), reals(lo, 3), reals(hi, 3), byref(added), None))
        return added.value

    def fill_level(self, lo: Any, hi: Any, phase: int = 0) -> int:
        """Fluid in a box up to the level hi[1]. Returns the number of particles."""
        added = c_int64()
        self.check(c.mps_fill_level_add(self.handle, whole("phase", phase), reals(lo, 3), reals(hi, 3), byref(added), None))
        return added.value

    def fill(self, inside: Callable[[np.ndarray], object], phase: int = 0) -> int:
        """Fluid where inside([dim]) is true. Returns the number of particles. After an exception
        in `inside` no particle is added."""
        dim, added, first = self.dim, c_int64(), self._newest()

        def look(_user: Any, x: Any) -> int:
            return 1 if inside(np.array(x[:dim])) else 0

        function = T.mps_inside_fn(self._calls.guard(look, 0))
        status = c.mps_fill_add(self.handle, whole("phase", phase), function, None, byref(added))
        failed = self._calls.taken()
        if failed is not None:
            places = [int(i) for i in self["id"] if i > first] if status == 0 else []  # type: ignore[index]
            if places:
                c.mps_particles_remove(self.handle, len(places), (c_int64 * len(places))(*places))
            raise failed
        self.check(status)
        return added.value

    def _newest(self) -> int:
        if c.mps_particles_count(self.handle, -1) <= 0:
            return -1
        return int(self["id"].max())  # type: ignore[index]
