# SPDX-License-Identifier: BSD-3-Clause
"""Tanks, and the runs of them: a case file and a command each."""
import csv
import math
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
CASES = HERE.parent.parent / "cases"
G = 9.81
SPREAD = 0.005  # of dp and of the time steps between repeats, as of `mps repeat`
HEIGHTS = (1.0, 1.3, 1.6)  # of the sensors on each wall, in depths
PANEL = (0.8, 1.6)  # lower and upper end of the panel, in depths
VARIANTS = ("void", "pocket", "mmps")
BREAKING = "w22"  # the breaking wave of Wen, Zhao & Wan 2022, section 5.3
BREAKING_DEPTH, BREAKING_PERIOD, BREAKING_UNTIL = 0.18, 1 / 0.496, 3.0


@dataclass(frozen=True)
class Tank:
    """A box that is moved near its first natural period. Lengths in m."""
    name: str
    length: float
    depth: float
    height: float
    motion: str  # roll [deg], surge [share of the length]
    amplitude: float
    period: float  # in T1
    chamfer: float  # at the floor, in depths; 0: none
    until: float  # in T1

    @property
    def first_period(self) -> float:
        k = math.pi / self.length
        return 2 * math.pi / math.sqrt(G * k * math.tanh(k * self.depth))

    @property
    def time_scale(self) -> float:
        """By Froude, of a tank of 1 m."""
        return math.sqrt(self.length)

    @property
    def forced_period(self) -> float:
        return self.period * self.first_period

    @property
    def walls(self) -> tuple[str, ...]:
        return ("left", "right")

    @property
    def repeats(self) -> int:
        return 3


@dataclass(frozen=True)
class Breaking(Tank):
    """The breaking wave of the paper: its first impact, at the sensors P1 to P3; times as they are."""

    @property
    def time_scale(self) -> float:
        return 1.0

    @property
    def forced_period(self) -> float:
        return BREAKING_PERIOD

    @property
    def walls(self) -> tuple[str, ...]:
        return ("P",)

    @property
    def repeats(self) -> int:
        return 10


def tanks() -> list[Tank]:
    with open(HERE / "tanks.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    found = []
    for row in rows:
        length = float(row["length"])
        depth = length / float(row["length/depth"])
        found.append(Tank(row["tank"], length, depth, depth * float(row["height/depth"]), row["motion"], float(row["amplitude"]),
                          float(row["period/T1"]), float(row["chamfer"]), float(row["until/T1"])))
    return found


def breaking() -> Breaking:
    return Breaking(BREAKING, 1.3, BREAKING_DEPTH, 0.9, "surge", 0.1 / 1.3, 1, 0, 1)


@dataclass(frozen=True)
class Run:
    """One run: rows of particles over the depth, model, number of the repeat from 0."""
    tank: Tank
    rows: int
    variant: str
    repeat: int

    @property
    def name(self) -> str:
        return f"{self.tank.name}_{self.variant}_{self.rows}_{self.repeat + 1}"

    @property
    def factor(self) -> float:
        return 1 + SPREAD * (2 * self.repeat / (self.tank.repeats - 1) - 1)

    @property
    def key(self) -> str:
        """The case without the place of this folder: a result is of this run if it has the same."""
        return self.case().replace(f"{HERE}/", "").replace(f"{CASES}/", "")

    def case(self) -> str:
        """Text of the case file."""
        tank, dp = self.tank, self.tank.depth / self.rows * self.factor
        lines = ["mps: 1"]
        if isinstance(tank, Breaking):
            lines += [f"base: {CASES}/sloshing_breaking.yaml"]
            lines += ["sensors:"] if self.variant == "pocket" else []
            lines += [f"run: {{until: {BREAKING_UNTIL} s, average: 0 s, threads: 1, step_factor: {self.factor:.6g}}}"]
        else:
            lines += [f"base: {HERE}/base.yaml", f"title: tank {tank.name}", tank_text(tank), motion_text(tank)]
            lines += ["sensors:", *sensors_text(tank)]
            lines += [f"run: {{until: {tank.until:g} T1, average: 0 s, threads: 1, step_factor: {self.factor:.6g}}}"]
        if self.variant == "pocket":
            lines.insert(lines.index("sensors:") + 1, "  pockets: {measure: pockets}")
        lines += [f"dp: {dp:.9g} m", "output: {frames: 0, page: 0 MB, rate: 100 Hz, trace: yes}"]
        air = ", {air: rest}" if self.variant == "mmps" else ""
        lines += [f"fill: [{{water: {{depth: {tank.depth:.9g} m}}}}{air}]"]
        lines += {"void": [], "pocket": ["use: [gas.pocket]"], "mmps": ["model: mmps"]}[self.variant]
        return "\n".join(lines) + "\n"


def tank_text(tank: Tank) -> str:
    chamfer = f", chamfer: {{bottom: {tank.chamfer * tank.depth:.9g} m}}" if tank.chamfer else ""
    return f"tank: {{size: {tank.length:.9g} {tank.height:.9g} m{chamfer}}}"


def motion_text(tank: Tank) -> str:
    if tank.motion == "roll":
        return (f"motion: {{centre: {tank.length / 2:.9g} 0 m, forward: z, "
                f"roll: {{amplitude: {tank.amplitude:g} deg, period: {tank.period:g} T1, ramp: 0.25}}}}")
    return (f"motion: {{surge: {{amplitude: {tank.amplitude * tank.length:.9g} m, period: {tank.period:g} T1, ramp: 0.25}}}}")


def sensors_text(tank: Tank) -> list[str]:
    lines = []
    for wall, x in (("left", 0.0), ("right", tank.length)):
        lines += [f"  {wall}_{i + 1}: {{wall: {x:.9g} {y * tank.depth:.9g} m}}" for i, y in enumerate(HEIGHTS)]
        lines += [f"  {wall}_panel: {{panel: [{x:.9g} {PANEL[0] * tank.depth:.9g} m, {x:.9g} {PANEL[1] * tank.depth:.9g} m]}}"]
    return lines
