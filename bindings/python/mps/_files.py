# SPDX-License-Identifier: BSD-3-Clause
"""Files in the folder of a run, which may come from others. Opening a FIFO without a writer would block for ever, reading a device would
never end: only regular files are opened."""
from __future__ import annotations

import os
import stat
from pathlib import Path
from typing import BinaryIO

from . import _numbers as N
from . import errors

_KINDS = ((stat.S_ISDIR, "it is a folder"), (stat.S_ISFIFO, "it is a pipe (FIFO)"), (stat.S_ISSOCK, "it is a socket"),
          (stat.S_ISCHR, "it is a device"), (stat.S_ISBLK, "it is a device"))
TEXT = 1 << 28  # most bytes of a text


def _refused(path: Path, why: str) -> errors.Error:
    return errors.error(N.MPS_E_IO, f"{path}: {why}")


def _check(path: Path, mode: int) -> None:
    if not stat.S_ISREG(mode):
        raise _refused(path, next((why for is_kind, why in _KINDS if is_kind(mode)), "it has no bytes") + ", no regular file")


def open_regular(path: Path) -> BinaryIO:
    """A regular file, for reading; links are followed. FileError: it is another one, or cannot be opened."""
    try:
        _check(path, os.stat(path).st_mode)
        file = open(path, "rb", opener=lambda name, flags: os.open(name, flags | os.O_NONBLOCK | os.O_NOCTTY))
        try:
            _check(path, os.fstat(file.fileno()).st_mode)
        except BaseException:
            file.close()
            raise
        return file
    except errors.Error:
        raise
    except OSError as e:
        raise _refused(path, e.strerror or str(e)) from None


def text_of(data: bytes, path: Path) -> str:
    """UTF-8 as text. FileError: it is none."""
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        raise _refused(path, "it is no text in UTF-8") from None


def read_text(path: Path) -> str:
    """The whole of a regular file. FileError: also for one that is no text, or larger than a text of a run."""
    with open_regular(path) as file:
        size = os.fstat(file.fileno()).st_size
        if size > TEXT:
            raise _refused(path, f"{size} bytes are more than {TEXT} of a text")
        return text_of(file.read(), path)
