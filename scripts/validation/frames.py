# SPDX-License-Identifier: BSD-3-Clause
"""Frames of a run: where the particles are, the outline of the liquid, how far two outlines are apart."""
import re
from pathlib import Path

import numpy as np

TYPES = {"Float32": "<f4", "Float64": "<f8", "UInt8": "u1", "Int32": "<i4", "Int64": "<i8"}
FLUID, WALL, DUMMY = 0, 1, 2
WIDTH = 1.0  # of the kernel that smooths the liquid, in spacings
ARRAY = re.compile(r'<DataArray type="(\w+)" Name="(\w+)" NumberOfComponents="(\d+)" format="appended" offset="(\d+)"')


class Frame:
    """Positions [n][2], kind, phase and pressure of one .vtp file."""

    def __init__(self, t, path):
        self.t = t
        raw = Path(path).read_bytes()
        start = raw.index(b'<AppendedData encoding="raw">')
        begin = raw.index(b"_", start + 20) + 1
        arrays = {}
        for kind, name, width, offset in ARRAY.findall(raw[:start].decode()):
            at = begin + int(offset)
            size = int(np.frombuffer(raw, "<u8", 1, at)[0])
            values = np.frombuffer(raw[at + 8:at + 8 + size], TYPES[kind])
            arrays[name] = values.reshape(-1, int(width)) if width != "1" else values
        self.x, self.kind, self.phase, self.p = arrays["position"][:, :2].astype(float), arrays["kind"], arrays["phase"], arrays["pressure"]

    def particles(self, phase):
        return self.x[(self.kind == FLUID) & (self.phase == phase)]

    def walls(self):
        """Lower and upper corner of the box on which the walls stand."""
        wall = self.x[self.kind == WALL]
        return wall.min(axis=0), wall.max(axis=0)


def times(folder):
    """[(t, path)] of all frames of a run."""
    index = Path(folder) / "frames.pvd"
    if not index.exists():
        return []
    found = re.findall(r'timestep="([^"]+)"[^>]*file="([^"]+)"', index.read_text())
    return [(float(t), Path(folder) / file) for t, file in found]


def near(folder, t, reach=0.03):
    """The frame closest to a time, or None."""
    best = min(times(folder), key=lambda entry: abs(entry[0] - t), default=None)
    return Frame(*best) if best and abs(best[0] - t) <= reach else None


def liquid(frame, dp):
    """Share of liquid on a grid of half spacings about the tank, x and y of its points. Walls mirror what is before them, so that full rows
    count as full along them; the face of a wall is half a spacing before its particles."""
    (x0, y0), (x1, y1) = frame.walls()
    drops = frame.particles(0) - (x0, y0)
    width, height = x1 - x0, y1 - y0
    mirrored = [drops]
    for axis, end in ((0, width), (1, height)):
        every = np.concatenate(mirrored)
        for face in (0.5 * dp, end - 0.5 * dp):
            beyond = every[np.abs(every[:, axis] - face) < 4 * dp].copy()
            beyond[:, axis] = 2 * face - beyond[:, axis]
            mirrored.append(beyond)
    step, reach = dp / 2, 5
    shape = (int(round(height / step)) + 1, int(round(width / step)) + 1)
    field = np.zeros(shape)
    drops = np.concatenate(mirrored)
    cell = np.rint(drops / step).astype(int)
    for j in range(-reach, reach + 1):
        for i in range(-reach, reach + 1):
            at = cell + (i, j)
            inside = (at >= 0).all(axis=1) & (at[:, 0] < shape[1]) & (at[:, 1] < shape[0])
            r2 = ((at[inside] * step - drops[inside]) ** 2).sum(axis=1)
            np.add.at(field, (at[inside, 1], at[inside, 0]), np.exp(-r2 / (WIDTH * dp) ** 2) / (np.pi * WIDTH**2))
    return field, x0 + step * np.arange(shape[1]), y0 + step * np.arange(shape[0])


def outline(frame, dp, least=12):
    """Lines on which the share of liquid is one half, [n][2] each, x from the left wall and y from the floor; none shorter than `least` dp,
    which leaves out drops."""
    import contourpy  # comes with matplotlib
    (x0, y0), _ = frame.walls()
    field, x, y = liquid(frame, dp)
    lines = contourpy.contour_generator(x - x0, y - y0, field).lines(0.5)
    return [line for line in lines if np.hypot(*np.diff(line, axis=0).T).sum() > least * dp]


def points(lines, step):
    """Points of lines, about `step` apart."""
    result = []
    for line in lines:
        way = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
        at = np.linspace(0, way[-1], max(2, int(way[-1] / step)))
        result.append(np.column_stack([np.interp(at, way, line[:, 0]), np.interp(at, way, line[:, 1])]))
    return np.concatenate(result) if result else np.zeros((0, 2))


def apart(one, two):
    """Of two sets of points: x of all of them and how far each is from the other set."""
    if not len(one) or not len(two):
        return np.array([np.nan]), np.array([np.nan])
    distance = np.hypot(one[:, None, 0] - two[None, :, 0], one[:, None, 1] - two[None, :, 1])
    return np.concatenate([one[:, 0], two[:, 0]]), np.concatenate([distance.min(axis=1), distance.min(axis=0)])


def overhang(lines, until=np.inf):
    """How far outlines turn back along x [m], left of `until`: a wave that breaks."""
    most = 0.0
    for line in lines:
        x = line[:, 0] if line[-1, 0] > line[0, 0] else line[::-1, 0]
        most = max(most, (np.maximum.accumulate(x) - x)[x < until].max(initial=0.0))
    return most


def heights(frame, dp, columns=120):
    """Depth of the liquid at places between the walls, drops left out: highest point of the outline there, less half a spacing, which is the
    height of the highest row."""
    p = points(outline(frame, dp), dp / 4)
    (x0, _), (x1, _) = frame.walls()
    edges = np.linspace(0.5 * dp, x1 - x0 - 0.5 * dp, columns + 1)
    which = np.digitize(p[:, 0], edges) - 1
    depth = np.full(columns, np.nan)
    for i in range(columns):
        here = p[which == i, 1]
        depth[i] = here.max() - dp / 2 if len(here) else np.nan
    middle = (edges[1:] + edges[:-1]) / 2
    known = np.isfinite(depth)
    return middle, np.interp(middle, middle[known], depth[known]) if known.any() else depth
