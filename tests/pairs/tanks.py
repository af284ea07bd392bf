#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A tank of three descriptions: random boxes and chamfered tanks in 3-D by `size`, as a polygon and as an STL file.

Invariants, for each description: wall particles as many as the surface over dp2, within 10 %; at rest the force on the tank is
the weight and the pressure at the floor that of the depth, within 1 %, or what `mps check` says of few rows or one that is not
whole. Beside the tank by `size`: as many wall particles within 5 %, force and pressure within the same.

Exit code 1: an invariant is violated. 77: the program is missing.
"""
import argparse
import math
import random
import re
import sys
import tempfile
from pathlib import Path

from pairs import GRAVITY, Failure, Machine, columns, metres, prism_stl

DP = 0.04
UNTIL, FROM = 0.3, 0.15  # [s]; means at rest are taken from FROM on
WALLS, ALIKE, REST = 0.1, 0.05, 0.01


class Tank:
    """Sides of 6 to `most` dp, chamfers in every second tank; corners counterclockwise."""

    def __init__(self, dice, most):
        self.length, self.height, self.width = (dice.uniform(6, most) * DP for _ in range(3))
        least = min(self.length, self.height)
        self.chamfer = dice.uniform(0.1, 0.35) * least if dice.random() < 0.5 else 0.0
        self.level = dice.uniform(0.45, 0.8) * self.height
        self.level = max(self.level, self.chamfer + 2 * DP)
        L, H, c = self.length, self.height, self.chamfer
        self.corners = [(c, 0), (L - c, 0), (L, c), (L, H - c), (L - c, H), (c, H), (0, H - c), (0, c)] if c else [(0, 0), (L, 0), (L, H), (0, H)]

    def surface(self):
        around = sum(math.dist(a, b) for a, b in zip(self.corners, self.corners[1:] + self.corners[:1]))
        area = self.length * self.height - 2 * self.chamfer**2
        return around * self.width + 2 * area

    def mass(self):
        """Of the liquid up to the level, which is above the lower chamfers."""
        above = max(0.0, self.level - (self.height - self.chamfer))
        return 1000 * self.width * (self.length * self.level - self.chamfer**2 - above**2)

    def text(self, way, folder):
        size = metres(self.length, self.height, self.width)
        if way == "size":
            tank = f"size: {size}" + (f", chamfer: {{bottom: {metres(self.chamfer)}, top: {metres(self.chamfer)}, across: x}}" if self.chamfer else "")
        elif way == "polygon":
            tank = "polygon: [" + ", ".join(metres(*p) for p in self.corners) + f"], width: {metres(self.width)}"
        else:
            prism_stl(folder / "tank.stl", self.corners, self.width)
            tank = "stl: tank.stl, unit: m"
        x, z = 0.5 * self.length, 0.5 * self.width
        return "\n".join(
            ["mps: 1", "dim: 3", f"dp: {metres(DP)}", f"tank: {{{tank}}}", f"fill: [{{water: {{depth: {metres(self.level)}}}}}]",
             f"sensors: {{P: {{wall: {x:.9g} 0 {z:.9g} m}}, F: {{force: all}}}}", f"run: {{until: {UNTIL} s}}", "output: {frames: 0, page: 0 MB}"]) + "\n"


def number(pattern, text):
    found = re.search(pattern, text)
    return float(found.group(1)) if found else None


def measured(machine, tank, way, folder):
    """Wall particles, force over weight, pressure over that of the level, and what `mps check` allows."""
    case = folder / f"{way}.yaml"
    case.write_text(tank.text(way, folder))
    told = machine.call(["check", case.name], folder=folder)
    machine.call(["run", case.name, "-o", way, "-q", "-j", 1], folder=folder)
    column = columns(folder / way)
    late = [k for k, t in enumerate(column["t"]) if t >= FROM]
    mean = {name: sum(column[name][k] for k in late) / len(late) for name in ("P", "F_y")}
    row = number(r"half a spacing, ([0-9.e+-]+) % at the bottom", told)
    return {"walls": number(r"([0-9]+) of walls", told), "force": -mean["F_y"] / (GRAVITY * tank.mass()),
            "pressure": mean["P"] / (1000 * GRAVITY * tank.level),
            "allowed": max(REST, row / 100 if row else 0)}


def faults(machine, tank, folder, table):
    wrong, first = [], None
    cells = tank.surface() / DP**2
    for way in ("size", "polygon", "stl"):
        m = measured(machine, tank, way, folder)
        table.append((way, m["walls"] / cells, m["force"], m["pressure"], m["allowed"]))
        if abs(m["walls"] / cells - 1) > WALLS:
            wrong.append(f"{way}: {m['walls']:.0f} wall particles, surface {cells:.1f} dp2")
        for name in ("force", "pressure"):
            if abs(m[name] - 1) > m["allowed"]:
                wrong.append(f"{way}: {name} at rest {m[name]:.4f} of the exact one, allowed +-{m['allowed']:.3f}")
        first = first or m
        if abs(m["walls"] / first["walls"] - 1) > ALIKE:
            wrong.append(f"{way}: {m['walls']:.0f} wall particles, by size {first['walls']:.0f}")
        for name in ("force", "pressure"):
            if abs(m[name] - first[name]) > max(m["allowed"], first["allowed"]):
                wrong.append(f"{way}: {name} at rest {m[name]:.4f}, by size {first[name]:.4f}")
    return wrong


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("program", type=Path, help="mps")
    p.add_argument("--tanks", type=int, default=2, metavar="N", help="(2)")
    p.add_argument("--most", type=float, default=10, metavar="N", help="longest side in dp (10)")
    p.add_argument("--seed", type=int, default=1, help="of the tanks (1)")
    p.add_argument("--table", action="store_true", help="print all figures")
    o = p.parse_args()
    o.program = o.program.resolve()
    if not o.program.exists():
        sys.exit(77)
    machine, failed = Machine(o), 0
    dice = random.Random(o.seed)
    for k in range(o.tanks):
        tank, table = Tank(dice, o.most), []
        with tempfile.TemporaryDirectory(prefix="mps_tanks_") as folder:
            try:
                wrong = faults(machine, tank, Path(folder), table)
            except Failure as e:
                wrong = [str(e)]
        name = f"seed {o.seed}, tank {k}, {tank.length / DP:.2f} x {tank.height / DP:.2f} x {tank.width / DP:.2f} dp, chamfer {tank.chamfer / DP:.2f}, level {tank.level / DP:.2f}"
        for row in table if o.table or wrong else []:
            print(f"{name}: {row[0]}: walls {row[1]:.3f}, force {row[2]:.4f}, pressure {row[3]:.4f}, allowed {row[4]:.3f}")
        for text in wrong:
            print(f"{name}: {text}")
        failed += bool(wrong)
    print(f"{o.tanks} tanks of seed {o.seed}, {failed} with a fault")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
