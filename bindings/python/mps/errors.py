# SPDX-License-Identifier: BSD-3-Clause
"""Errors of libmps as exceptions. Their text is that of the library: what failed, which value, what is allowed."""
from __future__ import annotations

from ._numbers import STATUSES


class Error(Exception):
    """A call failed; the state is as before."""

    status = 0


class ArgumentError(Error, ValueError):
    """A value is out of its range."""


class MemoryFull(Error, MemoryError):
    """An allocation failed."""


class BusyError(Error):
    """An array is in use, or the call is not allowed in a callback."""


class UnknownName(Error, KeyError):
    """No model, solver, field or part has this name."""

    def __str__(self) -> str:  # KeyError quotes its text
        return str(self.args[0]) if self.args else ""


class StateError(Error):
    """The call is not allowed now."""


class Diverged(Error, ArithmeticError):
    """A value became NaN or left every physical range."""


class ParticleLost(Error):
    """A particle left the domain or is behind a wall."""


class SolverError(Error, ArithmeticError):
    """The pressure solver broke down."""


class PluginError(Error):
    """A model or a function of yours failed; its own exception is the cause of this one."""


class FileError(Error, OSError):
    """A file could not be read or written."""


class VersionError(Error):
    """A struct or a file comes from a newer version."""


class RanksError(Error):
    """Another rank failed, or the messages between ranks did."""


class NotConverged(UserWarning):
    """A step was done, but the pressure residual stayed above its tolerance."""


_KINDS: dict[str, type[Error]] = {
    "MPS_E_ARG": ArgumentError, "MPS_E_NOMEM": MemoryFull, "MPS_E_BUSY": BusyError, "MPS_E_NAME": UnknownName,
    "MPS_E_STATE": StateError, "MPS_E_DIVERGED": Diverged, "MPS_E_LOST": ParticleLost, "MPS_E_SOLVER": SolverError,
    "MPS_E_PLUGIN": PluginError, "MPS_E_IO": FileError, "MPS_E_VERSION": VersionError, "MPS_E_RANKS": RanksError,
}
_NAMES = {number: name for name, (number, _) in STATUSES.items()}


def error(status: int, text: str = "") -> Error:
    """The exception of a status. Without a text: what the status means."""
    name = _NAMES.get(status, "")
    e = _KINDS.get(name, Error)(text or STATUSES.get(name, (status, f"status {status}"))[1])
    e.status = status
    return e
