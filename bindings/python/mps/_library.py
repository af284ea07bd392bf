# SPDX-License-Identifier: BSD-3-Clause
"""Load libmps and libmps_case, check that they match these bindings, and set the types of their
functions."""
from __future__ import annotations

import ctypes
import os
from pathlib import Path
from typing import Any

from . import _structs as structs
from ._functions import FUNCTIONS
from ._layouts import LAYOUTS
from ._numbers import MPS_VERSION_MAJOR, MPS_VERSION_STRING


def _candidates(name: str) -> list[str]:
    """Search path of a library: MPS_LIBRARY_PATH, this package, the system."""
    file = f"lib{name}.so.{MPS_VERSION_MAJOR}"
    folders = [Path(p) for p in os.environ.get("MPS_LIBRARY_PATH", "").split(":") if p] + [Path(__file__).parent / "lib"]
    return [str(folder / file) for folder in folders if (folder / file).exists()] + [file]


def _load(name: str) -> ctypes.CDLL:
    last: OSError | None = None
    for path in _candidates(name):
        try:
            return ctypes.CDLL(path)
        except OSError as e:
            last = last or e
    raise ImportError(f"lib{name}.so.{MPS_VERSION_MAJOR} is not found or does not load: {last}. Install libmps, or name its folder "
                      "in MPS_LIBRARY_PATH.")


class Library:
    """The functions of libmps and libmps_case: `c.mps_step(...)`. They return what C returns."""

    def __init__(self) -> None:
        self._loaded = {"mps": _load("mps")}
        self.version = self._check()

    def __getattr__(self, name: str) -> Any:
        if name not in FUNCTIONS:
            raise AttributeError(f"libmps has no function '{name}'")
        library, result, arguments = FUNCTIONS[name]
        if library not in self._loaded:
            self._loaded[library] = _load(library)
        try:
            function = getattr(self._loaded[library], name)
        except AttributeError:
            raise ImportError(f"lib{library} {self.version} has no {name}(): it is older than these bindings, {MPS_VERSION_STRING}") from None
        function.restype, function.argtypes = result, arguments
        setattr(self, name, function)
        return function

    def _check(self) -> str:
        version = self.__dict__["version"] = self.mps_version(None, None, None).decode()
        if version.split(".")[0] != str(MPS_VERSION_MAJOR):
            raise ImportError(f"libmps is of version {version}; these bindings are for {MPS_VERSION_MAJOR}")
        for name, (size, offsets) in LAYOUTS.items():
            kind = getattr(structs, name)
            if ctypes.sizeof(kind) != size or [getattr(kind, f[0]).offset for f in kind._fields_] != offsets:
                raise ImportError(f"{name} is laid out in another way on this machine than where these bindings were made")
            self._check_size(name, kind, size)
        return version

    def _check_size(self, name: str, kind: type[ctypes.Structure], size: int) -> None:
        """The library accepts a struct of this size; it refuses an unknown size."""
        if f"{name}_init" not in FUNCTIONS or FUNCTIONS[f"{name}_init"][0] != "mps":
            return
        one = kind()
        init = self._loaded["mps"][f"{name}_init"]  # of its own, without types of arguments
        if init(ctypes.byref(one), ctypes.c_size_t(size)) != 0 or one.struct_size != size:
            raise ImportError(f"libmps {self.version} does not take a {name} of {size} bytes; these bindings are for {MPS_VERSION_STRING}")


c = Library()
