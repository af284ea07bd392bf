# SPDX-License-Identifier: BSD-3-Clause
"""One frame of particles, from a file for ParaView that the library wrote: .vtp, or .pvtp with a piece of each rank."""
from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from . import _numbers as N
from . import errors
from ._files import open_regular, read_text

_TYPES = {"Float32": "<f4", "Float64": "<f8", "UInt8": "u1", "Int8": "i1", "Int32": "<i4", "Int64": "<i8", "UInt32": "<u4", "UInt64": "<u8"}
_HEAD = 1 << 22  # most bytes before the data
_MARK = b'<AppendedData encoding="raw">\n_'
_ARRAY = re.compile(r"<DataArray ([^>]*)>")


def _damaged(path: Path, why: str) -> errors.Error:
    return errors.error(N.MPS_E_IO, f"{path}: no frame of libmps: {why}")


def _count(word: str) -> int:
    """A number of a header, -1: none."""
    return int(word) if re.fullmatch(r"\d{1,15}", word) else -1


class _Piece:
    """A .vtp with appended raw data: its arrays by name, and the texts of its header. Arrays are read when they are used."""

    def __init__(self, path: Path) -> None:
        self.path = path
        with open_regular(path) as file:
            head, mark, _ = file.read(_HEAD).partition(_MARK)
            self._begin, self._size = len(head) + len(mark), os.fstat(file.fileno()).st_size
        self.head = head.decode("utf-8", "replace")
        points = re.search(r'NumberOfPoints="(\d{1,18})"', self.head)
        if not mark or points is None or 'header_type="UInt64"' not in self.head or 'byte_order="LittleEndian"' not in self.head:
            raise _damaged(path, "PolyData of little-endian byte order with appended raw data is wanted")
        self.points = int(points[1])
        inside = self.head.partition("<Points>")[2].partition("<Verts>")[0] or self.head
        found = (dict(re.findall(r'(\w+)="([^"]*)"', m)) for m in _ARRAY.findall(inside))
        self.arrays = {one["Name"]: one for one in found if "Name" in one}

    def array(self, name: str) -> np.ndarray:
        one = self.arrays.get(name, {})
        kind, width, begin = _TYPES.get(one.get("type", "")), _count(one.get("NumberOfComponents", "1")), _count(one.get("offset", ""))
        begin += self._begin
        if kind is None or width < 1 or begin < self._begin or begin + 8 > self._size:
            raise _damaged(self.path, f"the array '{name}' has no data")
        count = self.points * width
        wanted = count * np.dtype(kind).itemsize
        with open_regular(self.path) as file:
            file.seek(begin)
            if int.from_bytes(file.read(8), "little") != wanted or begin + 8 + wanted > self._size:
                raise _damaged(self.path, f"the array '{name}' is cut short")
            data = file.read(wanted)
        if len(data) != wanted:
            raise _damaged(self.path, f"the array '{name}' is cut short")
        values = np.frombuffer(data, kind, count).astype(np.dtype(kind).newbyteorder("="))
        return values if width == 1 else values.reshape(self.points, width)

    def parts(self) -> list[str]:
        found = re.search(r'Name="part_names"[^>]*>([\d ]*)<', self.head)
        words = found[1].split() if found else []
        if any(_count(word) not in range(256) for word in words):
            raise _damaged(self.path, "the names of the parts are no bytes")
        return bytes(map(int, words)).decode("utf-8", "replace").split("\0")[:-1]

    def time(self) -> float:
        found = re.search(r'Name="TimeValue"[^>]*>([^<]*)<', self.head)
        try:
            return float(found[1]) if found else float("nan")
        except ValueError:
            raise _damaged(self.path, "the time is no number") from None


class Frame(Mapping[str, np.ndarray]):
    """Arrays of the particles of one frame, by name: frame["position"] [n, 3] m, frame["velocity"] [n, 3] m/s, "wall_pressure" [n] Pa,
    "kind", "phase", "part", "id" [n], and fields of yours. In 2-D the third component is 0. The file is read when an array is first used."""

    def __init__(self, path: str | Path, t: float | None = None) -> None:
        self.path, self._t = Path(path), t

    @cached_property
    def _pieces(self) -> list[_Piece]:
        if self.path.suffix != ".pvtp":
            return [_Piece(self.path)]
        names = re.findall(r'<Piece Source="([^"]*)"', read_text(self.path))
        if not names:
            raise _damaged(self.path, "it names no pieces")
        return [_Piece(self.path.parent / name) for name in names]

    @property
    def t(self) -> float:
        """Time [s]."""
        return self._pieces[0].time() if self._t is None else self._t

    @property
    def n(self) -> int:
        """Number of particles."""
        return sum(piece.points for piece in self._pieces)

    @property
    def fluid(self) -> np.ndarray:
        """[n] True for fluid."""
        return self["kind"] == N.MPS_FLUID  # type: ignore[no-any-return]

    @property
    def part_names(self) -> list[str]:
        """Names of the solids, by the numbers of "part"."""
        return self._pieces[0].parts()

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._pieces[0].arrays:
            raise errors.error(N.MPS_E_NAME, f"{self.path}: no array '{name}'; there are {', '.join(self)}")
        return np.concatenate([piece.array(name) for piece in self._pieces])

    def __iter__(self) -> Iterator[Any]:
        return iter(self._pieces[0].arrays)

    def __len__(self) -> int:
        return len(self._pieces[0].arrays)

    def __contains__(self, name: object) -> bool:
        return name in self._pieces[0].arrays

    def __repr__(self) -> str:
        return f"<mps.Frame {self.path}: t = {self.t:g} s, {self.n} particles, {', '.join(self)}>"
