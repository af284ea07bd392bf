# SPDX-License-Identifier: BSD-3-Clause
"""From keywords to structs of C, and from structs to plain values."""
from __future__ import annotations

import ctypes
import functools
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


_defaults: dict[type[ctypes.Structure], ctypes.Structure] = {}


def _default(kind: type[S]) -> S:
    """A struct with the defaults of the library, which is asked once."""
    found = _defaults.get(kind)
    if found is None:
        found = one = kind()
        init = f"{kind.__name__}_init"
        try:
            getattr(c, init)(ctypes.byref(one), ctypes.sizeof(kind))
        except AttributeError:
            if hasattr(one, "struct_size"):
                one.struct_size = ctypes.sizeof(kind)
        _defaults[kind] = one
    return kind.from_buffer_copy(found)  # type: ignore[return-value]


def copied(struct: S) -> S:
    """A copy of a struct that belongs to the library."""
    return type(struct).from_buffer_copy(struct)


def make(kind: type[S], given: dict[str, Any] | None = None, what: str = "") -> S:
    """A struct with its defaults, and with the entries that are given."""
    one = _default(kind)
    if given:
        names = _entries(kind)
        for name, value in given.items():
            if name not in names:
                raise errors.ArgumentError(f"{what or kind.__name__}: unknown entry '{name}'; allowed are {', '.join(names)}")
            _assign(one, name, value)
    return one


@functools.cache
def _entries(kind: type[ctypes.Structure]) -> dict[str, bool]:
    """Names of the entries that mean something, and whether each is a text that lives elsewhere."""
    return {f[0]: f[1] is ctypes.c_char_p for f in kind._fields_ if f[0] not in ("struct_size", "reserved")}


_NUMBERS = {ctypes.c_double: np.float64, ctypes.c_float: np.float32, ctypes.c_int32: np.int32, ctypes.c_int64: np.int64,
            ctypes.c_uint32: np.uint32, ctypes.c_uint8: np.uint8}


class Record:
    """Values of a struct, by name; arrays are those of numpy. An entry is read when it is asked for: a program that looks at a few entries in
    each step does not pay for all. record() makes one."""

    _struct: ctypes.Structure

    def __getattr__(self, name: str) -> Any:
        struct = self.__dict__.get("_struct")  # a copy that is being made has none
        raise AttributeError(f"no entry '{name}'; there are {', '.join(_entries(type(struct)) if struct is not None else ())}")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *_entries(type(self._struct))]

    def __iter__(self) -> Iterator[tuple[str, Any]]:
        return iter([(name, getattr(self, name)) for name in _entries(type(self._struct))])

    def __repr__(self) -> str:
        return "\n".join(f"{name}: {value}" for name, value in self)


class _Entry:
    """An entry of a record until it is asked for: then the record has its value, and Python looks there first. It must not define __set__."""

    def __init__(self, name: str) -> None:
        self.name = name

    def read(self, struct: ctypes.Structure) -> Any:
        value = getattr(struct, self.name)
        return text(value.value) if isinstance(value, ctypes.Array) and value._type_ is ctypes.c_char else value

    def __get__(self, one: Record | None, _kind: type | None = None) -> Any:
        if one is None:
            return self
        value = one.__dict__[self.name] = self.read(one._struct)
        return value


class _Numbers(_Entry):
    """An entry that is an array of numbers, in the memory of the struct."""

    def __init__(self, name: str, place: int, kind: Any, shape: tuple[int, ...]) -> None:
        super().__init__(name)
        self.place, self.kind, self.shape = place, kind, shape

    def __get__(self, one: Record | None, _kind: type | None = None) -> Any:
        if one is None:
            return self
        value = one.__dict__[self.name] = np.ndarray(self.shape, self.kind, one._struct, self.place)
        return value


def _entry(kind: type[ctypes.Structure], name: str, held: Any, shape: tuple[int, ...] | None) -> _Entry:
    if not (isinstance(held, type) and issubclass(held, ctypes.Array) and held._type_ in _NUMBERS):
        return _Entry(name)
    return _Numbers(name, getattr(kind, name).offset, np.dtype(_NUMBERS[held._type_]), shape or (held._length_,))


_SHAPES = {("mps_load", "mass"): (6, 6), ("mps_body_report", "mass"): (6, 6)}
_kinds: dict[type[ctypes.Structure], tuple[type[Record], list[str]]] = {}


def _kind(kind: type[ctypes.Structure]) -> tuple[type[Record], list[str]]:
    """Class of the records of a struct, and its texts that live elsewhere."""
    entries = {f[0]: _entry(kind, f[0], f[1], _SHAPES.get((kind.__name__, f[0]))) for f in kind._fields_ if f[0] in _entries(kind)}
    found = _kinds[kind] = type("Record", (Record,), entries), [name for name, elsewhere in _entries(kind).items() if elsewhere]
    return found


def record(struct: ctypes.Structure) -> Record:
    """The record of a struct, which is the record's own from now on: copy one that is not."""
    kind = type(struct)
    made, texts = _kinds.get(kind) or _kind(kind)
    one = made()
    one._struct = struct
    for name in texts:  # the library may free them
        one.__dict__[name] = text(getattr(struct, name))
    return one


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
