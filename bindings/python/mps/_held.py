# SPDX-License-Identifier: BSD-3-Clause
"""Ownership and release of objects of the library."""
from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from . import errors
from ._numbers import MPS_E_BUSY, MPS_E_STATE

if TYPE_CHECKING:
    from types import TracebackType

    from ._records import Calls


class Held:
    """An object of the library. It keeps the objects that need it, and frees them before itself, in whatever order Python's garbage
    collector finalises the objects that users see. `with held as pointer:` is a call during which it cannot be freed."""

    def __init__(self, what: str, pointer: Any, free: Callable[[Any], object], parent: Held | None = None, calls: Calls | None = None) -> None:
        self.what, self._pointer, self._free, self._parent, self._calls = what, pointer, free, parent, calls
        self._children: dict[int, Held] = {}
        self._running = 0
        self._process = os.getpid()
        if parent is not None:
            parent._children[id(self)] = self

    @property
    def pointer(self) -> Any:
        if self._pointer is None:
            why = f"the {self.what} is closed"
            if self._parent is not None and self._parent.closed:
                why += f", because the {self._parent.what} is closed"
            raise errors.error(MPS_E_STATE, why)
        return self._pointer

    @property
    def closed(self) -> bool:
        return self._pointer is None

    @property
    def busy(self) -> bool:
        """Whether a running call of the library uses it or an object that depends on it."""
        return bool(self._running or (self._calls is not None and self._calls.running) or any(h.busy for h in list(self._children.values())))

    def __enter__(self) -> Any:
        pointer = self.pointer
        self._running += 1
        return pointer

    def __exit__(self, *_: object) -> None:
        self._running -= 1

    def forget(self) -> Any:
        """Another call has freed it."""
        pointer, self._pointer = self._pointer, None
        if self._parent is not None:
            self._parent._children.pop(id(self), None)
        return pointer

    def close(self) -> None:
        """Free it once. A forked process does not free: its parent owns the memory and the
        threads."""
        if self._pointer is None:
            return
        if self.busy:
            raise errors.error(MPS_E_BUSY, f"the {self.what} cannot be closed within a call that uses it: return from your function first; a "
                                           "monitor that returns True stops the run")
        for child in list(self._children.values()):
            child.close()
        pointer = self.forget()
        if self._process == os.getpid():
            self._free(pointer)


O = TypeVar("O", bound="Owner")


class Owner:
    """Base class of owners of an object of the library: a context manager that closes it. It
    cannot be copied or pickled, because both copies would free the object. After close() every
    call raises StateError."""

    _held = Held("object", None, lambda _: None)
    _instead = ""

    def close(self) -> None:
        """Free it and its dependent objects; a second call has no effect. BusyError: a running
        call uses it, e.g. in a monitor."""
        self._held.close()

    @property
    def closed(self) -> bool:
        """Whether it is closed, alone or with its owner."""
        return self._held.closed

    def __enter__(self: O) -> O:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None) -> None:
        self.close()

    def __del__(self) -> None:
        self._held.close()

    def __reduce_ex__(self, protocol: Any) -> Any:
        raise TypeError(f"a {type(self).__name__} cannot be copied or pickled: it holds an object of the library{self._instead}")
