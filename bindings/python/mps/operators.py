# SPDX-License-Identifier: BSD-3-Clause
"""Operators of the method on any cloud of particles: mps/operators.h. Fields are [n] or [n, dim]."""
from __future__ import annotations

from ctypes import POINTER, byref, c_double
from typing import Any

import numpy as np

from . import _numbers as N
from . import _structs as T
from . import errors
from ._held import Held, Owner
from ._library import c
from ._records import make, pointer, text
from .model import Pairs, pairs_of


def lattice_constants(dim: int, dp: float, re: float, kernel: str = "improved") -> tuple[float, float]:
    """n0 and lambda [m2] of a full square or cubic lattice; re in m."""
    one, n0, lam = _kernel(kernel), c_double(), c_double()
    status = c.mps_lattice_constants(byref(one), dim, dp, re, byref(n0), byref(lam))
    if status < 0:
        raise errors.error(status, f"dim {dim}, dp {dp:g} m, re {re:g} m: dim is 2 or 3, dp > 0, and re is above dp and finite")
    return n0.value, lam.value


def _kernel(name: str) -> Any:
    one = make(T.mps_kernel)
    status = c.mps_kernel_find(name.encode(), byref(one))
    if status < 0:
        raise errors.error(status, f"no kernel '{name}'; there are improved, original")
    return one


class Cloud(Owner):
    """Particles at x [n, dim] with their neighbours within re_near and re_far [m]; 2.1 dp and 3.1 dp unless given."""

    def __init__(self, x: Any, dp: float, re_near: float = 0.0, re_far: float = 0.0, kernel: str = "improved") -> None:
        self._x = self.x = np.array(x, dtype=float, order="C")  # the library borrows its memory
        self.x.flags.writeable = False
        if self.x.ndim != 2 or self.x.shape[1] not in (2, 3):
            raise errors.ArgumentError(f"x has the shape {self.x.shape}; (n, 2) and (n, 3) are allowed")
        self.dim, self.n = self.x.shape[1], len(self.x)
        list_ = POINTER(T.mps_neighbours)()
        status = c.mps_neighbours_create(self.dim, dp, None, byref(list_))
        if status < 0:
            raise errors.error(status, f"dp is {dp:g} m: must be > 0 and finite" if status == N.MPS_E_ARG else "")
        self._held = Held("cloud", list_, c.mps_neighbours_destroy)
        near = re_near or 2.1 * dp
        self._check(c.mps_neighbours_build(self._held.pointer, self.n, pointer(self._x), near, re_far or max(near, 3.1 * dp)))
        self._kernel = _kernel(kernel)
        self._stencils = {which: self._stencil(which) for which in (N.MPS_NEAR, N.MPS_FAR)}

    def _check(self, status: int) -> None:
        if status < 0:
            raise errors.error(status, text(c.mps_neighbours_error(self._held.pointer)))

    def _stencil(self, which: int) -> Any:
        stencil = make(T.mps_stencil)
        self._check(c.mps_neighbours_stencil_get(self._held.pointer, which, byref(self._kernel), byref(stencil)))
        return stencil

    def pairs(self, far: bool = False) -> Pairs:
        """All pairs."""
        return pairs_of(self._of(far))

    def _of(self, far: bool) -> Any:
        """A stencil, which points to the library's list; refused if that is closed."""
        _ = self._held.pointer
        return self._stencils[int(far)]

    def _field(self, values: Any, numbers: int, name: str) -> np.ndarray:
        array = np.ascontiguousarray(values, dtype=float)
        if array.size != self.n * numbers:
            raise errors.ArgumentError(f"{name}: {array.size} numbers; {self.n} x {numbers} are allowed")
        return array

    def _apply(self, name: str, numbers: int, *given: np.ndarray, far: bool = False) -> np.ndarray:
        out = np.empty((self.n,) if numbers == 1 else (self.n, numbers))
        self._check(getattr(c, name)(byref(self._of(far)), *[pointer(g) for g in given], pointer(out)))
        return out

    def number_density(self, far: bool = False) -> np.ndarray:
        """n_i = sum_j W."""
        return self._apply("mps_op_number_density", 1, far=far)

    def volume_deviation(self) -> np.ndarray:
        """Relative excess of the density of particles."""
        return self._apply("mps_op_volume_deviation", 1, far=True)

    def gradient(self, f: Any, b: np.ndarray | None = None, conservative: bool = False) -> np.ndarray:
        """Gradient of a scalar [n, dim]; with b of correction() exact for linear fields."""
        f = self._field(f, 1, "f")
        if b is not None:
            return self._apply("mps_op_gradient_corrected", self.dim, self._field(b, self.dim**2, "b"), f)
        return self._apply("mps_op_gradient_conservative" if conservative else "mps_op_gradient", self.dim, f)

    def divergence(self, u: Any, b: np.ndarray | None = None) -> np.ndarray:
        """Divergence of a vector field [n]."""
        u = self._field(u, self.dim, "u")
        if b is not None:
            return self._apply("mps_op_divergence_corrected", 1, self._field(b, self.dim**2, "b"), u)
        return self._apply("mps_op_divergence", 1, u)

    def laplacian(self, f: Any) -> np.ndarray:
        """Laplacian of a scalar [n] or a vector field [n, dim], with the pairs within re_far."""
        values = np.asarray(f, dtype=float)
        if values.ndim == 2:
            return self._apply("mps_op_laplacian_vector", self.dim, self._field(values, self.dim, "f"), far=True)
        return self._apply("mps_op_laplacian", 1, self._field(values, 1, "f"), far=True)

    def asymmetry(self) -> np.ndarray:
        """Vectors that point out of the fluid [n, dim]."""
        return self._apply("mps_op_asymmetry", self.dim)

    def correction(self, floor: float = 0.2) -> np.ndarray:
        """B of the corrected operators [n, dim*dim]."""
        out = np.empty((self.n, self.dim**2))
        self._check(c.mps_op_correction(byref(self._of(False)), floor, pointer(out)))
        return out
