# SPDX-License-Identifier: BSD-3-Clause
"""One frame of particles, from a file for ParaView that the library wrote: .vtp, or .pvtp with a piece of each rank."""
from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from . import _numbers as N
from . import errors

_TYPES = {"Float32": "<f4", "Float64": "<f8", "UInt8": "u1", "Int8": "i1", "Int32": "<i4", "Int64": "<i8", "UInt32": "<u4", "UInt64": "<u8"}
_ARRAY = re.compile(r"<DataArray ([^>]*)>")


def _damaged(path: Path, why: str) -> errors.Error:
    return errors.error(N.MPS_E_IO, f"{path}: no frame of libmps: {why}")


class _Piece:
    """A .vtp with appended raw data: its arrays by name, and the texts of its header."""

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            data = path.read_bytes()
        except OSError as e:
            raise errors.error(N.MPS_E_IO, f"{path}: {e.strerror}") from None
        head, mark, self._raw = data.partition(b'<AppendedData encoding="raw">\n_')
        self.head = head.decode("utf-8", "replace")
        points = re.search(r'NumberOfPoints="(\d+)"', self.head)
        if not mark or points is None or 'header_type="UInt64"' not in self.head or 'byte_order="LittleEndian"' not in self.head:
            raise _damaged(path, "PolyData of little-endian byte order with appended raw data is wanted")
        self.points = int(points[1])
        inside = self.head[self.head.index("<Points>"):self.head.index("<Verts>")] if "<Verts>" in self.head else self.head
        self.arrays = {one["Name"]: one for one in (dict(re.findall(r'(\w+)="([^"]*)"', m)) for m in _ARRAY.findall(inside))}

    def array(self, name: str) -> np.ndarray:
        one = self.arrays[name]
        kind, width, begin = _TYPES.get(one.get("type", "")), int(one.get("NumberOfComponents", 1)), int(one.get("offset", -1))
        if kind is None or begin < 0 or begin + 8 > len(self._raw):
            raise _damaged(self.path, f"the array '{name}' has no data")
        size = int.from_bytes(self._raw[begin:begin + 8], "little")
        count = self.points * width
        if size != count * np.dtype(kind).itemsize or begin + 8 + size > len(self._raw):
            raise _damaged(self.path, f"the array '{name}' is cut short")
        values = np.frombuffer(self._raw, kind, count, begin + 8).astype(np.dtype(kind).newbyteorder("="))
        return values if width == 1 else values.reshape(self.points, width)

    def parts(self) -> list[str]:
        found = re.search(r'Name="part_names"[^>]*>([\d ]*)<', self.head)
        text = bytes(int(word) for word in found[1].split()) if found else b""
        return text.decode("utf-8", "replace").split("\0")[:-1]

    def time(self) -> float:
        found = re.search(r'Name="TimeValue"[^>]*>([^<]*)<', self.head)
        return float(found[1]) if found else float("nan")


class Frame(Mapping[str, np.ndarray]):
    """Arrays of the particles of one frame, by name: frame["position"] [n, 3] m, frame["velocity"] [n, 3] m/s, "wall_pressure" [n] Pa,
    "kind", "phase", "part", "id" [n], and fields of yours. In 2-D the third component is 0. The file is read when an array is first used."""

    def __init__(self, path: str | Path, t: float | None = None) -> None:
        self.path, self._t = Path(path), t

    @cached_property
    def _pieces(self) -> list[_Piece]:
        if self.path.suffix != ".pvtp":
            return [_Piece(self.path)]
        try:
            names = re.findall(r'<Piece Source="([^"]*)"', self.path.read_text(encoding="utf-8"))
        except (OSError, UnicodeDecodeError) as e:
            raise _damaged(self.path, str(e)) from None
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
