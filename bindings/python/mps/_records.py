# SPDX-License-Identifier: BSD-3-Clause
"""Converts keywords to C structs, and structs to plain values."""
from __future__ import annotations

import ctypes
import functools
import operator
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

import numpy as np

from . import errors
from ._library import c
from ._numbers import MPS_E_ARG

S = TypeVar("S", bound=ctypes.Structure)


def text(value: bytes | None) -> str:
    return value.decode(errors="replace") if value is not None else ""


def coded(value: str | None) -> bytes | None:
    """A text or a path for C; names of files may have bytes that are not UTF-8."""
    if value is None:
        return None
    data = str(value).encode("utf-8", "surrogateescape")
    if b"\0" in data:
        raise errors.error(MPS_E_ARG, f"{value!r} has a character 0, which ends a text of C")
    return data


def whole(name: str, value: Any, bits: int = 32) -> int:
    """A whole number in the range of a C integer; ctypes would wrap others around."""
    try:
        number = operator.index(value)
    except TypeError:
        raise errors.error(MPS_E_ARG, f"{name}: {value!r} is no whole number") from None
    if not -(1 << (bits - 1)) <= number < 1 << (bits - 1):
        raise errors.error(MPS_E_ARG, f"{name}: {number} does not fit into {bits} bits")
    return number


def real(name: str, value: Any) -> float:
    """A number."""
    if isinstance(value, (str, bytes)) or not hasattr(value, "__float__") and not hasattr(value, "__index__"):
        raise errors.error(MPS_E_ARG, f"{name}: {value!r} is no number")
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError) as e:
        raise errors.error(MPS_E_ARG, f"{name}: {value!r} is no number: {e}") from None


def reals(values: Any, least: int = 0) -> ctypes.Array[ctypes.c_double]:
    """A C array, padded with zeros to a minimum length."""
    flat = np.asarray(values, dtype=float).reshape(-1)
    return (ctypes.c_double * max(len(flat), least))(*flat)


def pointer(array: np.ndarray | None, kind: Any = ctypes.c_double) -> Any:
    """Pointer to the data of a numpy array, which it keeps alive."""
    return None if array is None else array.ctypes.data_as(ctypes.POINTER(kind))


_UNSIGNED = (ctypes.c_uint8, ctypes.c_uint32, ctypes.c_uint64, ctypes.c_size_t)
_BITS = {kind: 8 * ctypes.sizeof(kind) for kind in (ctypes.c_int, ctypes.c_int32, ctypes.c_int64, *_UNSIGNED)}


def _unsigned(name: str, value: Any, bits: int) -> int:
    number = whole(name, value, bits + 1)
    if number < 0:
        raise errors.error(MPS_E_ARG, f"{name}: {number}: must be >= 0")
    return number


def _assign(struct: ctypes.Structure, name: str, value: Any) -> None:
    kind = dict((f[0], f[1]) for f in struct._fields_)[name]
    if isinstance(value, str) and kind is ctypes.c_char_p:
        value = coded(value)
    elif isinstance(kind, type) and issubclass(kind, ctypes.Array):
        row = getattr(struct, name)
        numbers = np.asarray(value, dtype=float).reshape(-1)
        if len(numbers) > len(row):
            raise errors.ArgumentError(f"{name}: {len(numbers)} numbers, at most {len(row)} are allowed")
        for k, number in enumerate(numbers):
            row[k] = number
        return
    elif kind in _BITS:
        value = whole(name, value, _BITS[kind]) if kind not in _UNSIGNED else _unsigned(name, value, _BITS[kind])
    elif kind in (ctypes.c_double, ctypes.c_float):
        value = real(name, value)
    try:
        setattr(struct, name, value)
    except (TypeError, ctypes.ArgumentError) as e:
        raise errors.ArgumentError(f"{name}: {value!r} is not allowed: {e}") from None


_defaults: dict[type[ctypes.Structure], ctypes.Structure] = {}


def _default(kind: type[S]) -> S:
    """A struct with the defaults of the library, which are read once."""
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
    """A copy of a struct that the library owns."""
    return type(struct).from_buffer_copy(struct)


def make(kind: type[S], given: dict[str, Any] | None = None, what: str = "") -> S:
    """A struct with its defaults and the given members."""
    one = _default(kind)
    if given:
        names = _entries(kind)
        for name, value in given.items():
            if name not in names:
                raise errors.ArgumentError(f"{what or kind.__name__}: unknown entry '{name}'; allowed are {', '.join(names)}")
            _assign(one, name, value)
    return one


# Entries of the layer below: sizes, functions with their first arguments, buffers of errors.
_OWN = {"struct_size", "reserved", "error", "error_size", "log", "log_user", "print", "print_user", "user"}


@functools.cache
def _entries(kind: type[ctypes.Structure]) -> dict[str, bool]:
    """Names of the members that users see, and whether each is a pointer to a text."""
    return {f[0]: f[1] is ctypes.c_char_p for f in kind._fields_ if f[0] not in _OWN}


_NUMBERS = {ctypes.c_double: np.float64, ctypes.c_float: np.float32, ctypes.c_int32: np.int32, ctypes.c_int64: np.int64,
            ctypes.c_uint32: np.uint32, ctypes.c_uint8: np.uint8}


class Record:
    """Values of a struct, by name; arrays are those of numpy. A member is read at its first access:
    a program that reads a few members in each step does not pay for all. record() makes one."""

    _struct: ctypes.Structure

    def _names(self) -> list[str]:
        struct = self.__dict__.get("_struct")  # one that was copied or unpickled has values alone
        return list(_entries(type(struct)) if struct is not None else self.__dict__)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"no entry '{name}'; there are {', '.join(self._names())}")

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._names()]

    def __iter__(self) -> Iterator[tuple[str, Any]]:
        return iter([(name, getattr(self, name)) for name in self._names()])

    def __reduce__(self) -> Any:
        return _revived, ({name: np.copy(value) if isinstance(value, np.ndarray) else value for name, value in self},)

    def __repr__(self) -> str:
        return "\n".join(f"{name}: {value}" for name, value in self)


def _revived(values: dict[str, Any]) -> Record:
    """A record of values, from a copy or a pickle of one."""
    one = Record()
    one.__dict__.update(values)
    return one


class _Entry:
    """A member of a record until its first access: the value is then stored in the record, which
    Python searches first. It must not define __set__."""

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
    """A member that is an array of numbers, in the memory of the struct."""

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
    """Class of the records of a struct, and its pointers to texts."""
    entries = {f[0]: _entry(kind, f[0], f[1], _SHAPES.get((kind.__name__, f[0]))) for f in kind._fields_ if f[0] in _entries(kind)}
    found = _kinds[kind] = type("Record", (Record,), entries), [name for name, elsewhere in _entries(kind).items() if elsewhere]
    return found


def record(struct: ctypes.Structure) -> Record:
    """The record of a struct, whose ownership it takes: copy a struct that is shared."""
    kind = type(struct)
    made, texts = _kinds.get(kind) or _kind(kind)
    one = made()
    one._struct = struct
    for name in texts:  # the library may free them
        one.__dict__[name] = text(getattr(struct, name))
    return one


class Calls:
    """Python functions that the library calls. An exception in one ends the call of the library
    and is raised after it."""

    def __init__(self) -> None:
        self.kept: dict[str, Any] = {}
        self.failed: BaseException | None = None
        self.running = 0

    def guard(self, function: Callable[..., Any], otherwise: Any) -> Callable[..., Any]:
        def call(*arguments: Any) -> Any:
            if self.failed is not None:
                return otherwise
            self.running += 1
            try:
                return function(*arguments)
            except BaseException as e:  # noqa: BLE001: also KeyboardInterrupt
                self.failed = e
                return otherwise
            finally:
                self.running -= 1

        return call

    def taken(self) -> BaseException | None:
        failed, self.failed = self.failed, None
        return failed
