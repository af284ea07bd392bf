# SPDX-License-Identifier: BSD-3-Clause
"""From keywords to structs of C, and from structs to plain values."""
from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

import numpy as np

from . import errors
from ._library import c

S = TypeVar("S", bound=ctypes.Structure)


def text(value: bytes | None) -> str:
    return value.decode(errors="replace") if value is not None else ""


def coded(value: str | None) -> bytes | None:
    return None if value is None else str(value).encode()


def reals(values: Any, least: int = 0) -> ctypes.Array[ctypes.c_double]:
    """An array of C, filled up with zeros to a least length."""
    flat = np.asarray(values, dtype=float).reshape(-1)
    return (ctypes.c_double * max(len(flat), least))(*flat)


def pointer(array: np.ndarray | None, kind: Any = ctypes.c_double) -> Any:
    """The numbers of an array of numpy, which lives as long as the pointer."""
    return None if array is None else array.ctypes.data_as(ctypes.POINTER(kind))


def _assign(struct: ctypes.Structure, name: str, value: Any) -> None:
    kind = dict((f[0], f[1]) for f in struct._fields_)[name]
    if isinstance(value, str) and kind is ctypes.c_char_p:
        value = value.encode()
    elif isinstance(kind, type) and issubclass(kind, ctypes.Array):
        row = getattr(struct, name)
        numbers = np.asarray(value, dtype=float).reshape(-1)
        if len(numbers) > len(row):
            raise errors.ArgumentError(f"{name}: {len(numbers)} numbers, at most {len(row)} are allowed")
        for k, number in enumerate(numbers):
            row[k] = number
        return
    elif isinstance(value, (bool, np.integer)):
        value = int(value)
    elif isinstance(value, np.floating):
        value = float(value)
    try:
        setattr(struct, name, value)
    except (TypeError, ctypes.ArgumentError) as e:
        raise errors.ArgumentError(f"{name}: {value!r} is not allowed: {e}") from None


def make(kind: type[S], given: dict[str, Any] | None = None, what: str = "") -> S:
    """A struct with its defaults, and with the entries that are given."""
    one = kind()
    init = f"{kind.__name__}_init"
    try:
        getattr(c, init)(ctypes.byref(one), ctypes.sizeof(kind))
    except AttributeError:
        if hasattr(one, "struct_size"):
            one.struct_size = ctypes.sizeof(kind)
    names = [f[0] for f in kind._fields_ if f[0] not in ("struct_size", "reserved")]
    for name, value in (given or {}).items():
        if name not in names:
            raise errors.ArgumentError(f"{what or kind.__name__}: unknown entry '{name}'; allowed are {', '.join(names)}")
        _assign(one, name, value)
    return one


class Record:
    """Values of a struct, by name; arrays are those of numpy."""

    def __init__(self, struct: ctypes.Structure) -> None:
        for name, *_ in struct._fields_:
            value = getattr(struct, name)
            if name in ("struct_size", "reserved"):
                continue
            if isinstance(value, ctypes.Array):
                value = text(value.value) if value._type_ is ctypes.c_char else np.array(value)
            self.__dict__[name] = text(value) if isinstance(value, bytes) else value

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"no entry '{name}'; there are {', '.join(self.__dict__)}")

    def __iter__(self) -> Iterator[tuple[str, Any]]:
        return iter(self.__dict__.items())

    def __repr__(self) -> str:
        return "\n".join(f"{name}: {value}" for name, value in self)


class Calls:
    """Functions of Python that the library calls. An exception in one ends the call of the library and is raised behind it."""

    def __init__(self) -> None:
        self.kept: dict[str, Any] = {}
        self.failed: BaseException | None = None

    def guard(self, function: Callable[..., Any], otherwise: Any) -> Callable[..., Any]:
        def call(*arguments: Any) -> Any:
            if self.failed is not None:
                return otherwise
            try:
                return function(*arguments)
            except BaseException as e:  # noqa: BLE001: also KeyboardInterrupt
                self.failed = e
                return otherwise

        return call

    def taken(self) -> BaseException | None:
        failed, self.failed = self.failed, None
        return failed
