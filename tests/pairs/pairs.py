#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Features of a case in pairs: each draw is a small case with one level of each feature, run twice.

The first run is plain: one thread, one process, the host, the locale C, without an interruption. The second has the
drawn threads, ranks, device, locale and interruption, alone or as one of two equal runs of a sweep. Draws follow from
the seed; each next draw is, of some random ones, that which has most pairs of levels that no draw had before.

Invariants: `mps check` and `mps run` agree; both runs have the same bytes of probes, momentum, frames and checkpoint; the
volume stays; at rest the force on the tank is the weight; both make report.html and `mps stats` reads the folder. An FMU
of the case has the pressures of the run. Walls of tanks are looked at in tanks.py.

Exit code 1: an invariant is violated. 77: no python3 with ctypes, or the program is missing.
"""
import argparse
import csv
import ctypes
import filecmp
import itertools
import json
import math
import os
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zipfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
GRAVITY, DENSITY = 9.81, 1000.0
DT, STEPS = 0.002, 8
REST = 0.05  # of the weight, eight steps after the start
CANDIDATES = 40

FEATURES = {
    "dim": (2, 3),
    "outline": ("size", "odd_size", "chamfer", "polygon", "cylinder", "sphere", "stl"),
    "solids": ("none", "box", "plate", "holes", "prism", "ball"),
    "model": ("imps", "mmps", "imps.paper", "walls", "pocket"),
    "motion": ("rest", "surge", "roll", "table", "moving", "body"),
    "sensors": ("one", "all"),
    "pictures": ("end", "quarters"),
    "threads": (1, 2),
    "ranks": (1, 2),
    "device": ("host", "cuda"),
    "locale": ("C", "comma"),
    "resume": ("no", "yes"),
    "door": ("run", "sweep", "fmu"),
}


def allowed(draw, levels):
    """What the program refuses with a reason, or this machine lacks, is no pair."""
    d = draw
    if any(d[name] not in levels[name] for name in d):
        return False
    if d["outline"] == "stl" and d["dim"] == 2:
        return False
    if d["model"] == "imps.paper" and (d["motion"] == "body" or d["door"] == "fmu"):
        return False  # no added mass
    if d["dim"] == 2 and d["solids"] == "holes" and d["outline"] in ("cylinder", "sphere"):
        return False
    if d["door"] == "fmu":  # the importer computes the body; one process, without an interruption
        return d["motion"] in ("rest", "surge") and d["ranks"] == 1 and d["device"] == "host" and d["resume"] == "no"
    if d["door"] == "sweep":  # has no ranks of its own
        return d["ranks"] == 1 and d["resume"] == "no"
    return True


def pairs_of(draw):
    return {(a, draw[a], b, draw[b]) for a, b in itertools.combinations(FEATURES, 2)}


def plan(seed, runs, levels):
    """The draws of a seed, and the pairs that are possible."""
    dice = random.Random(seed)
    seen, draws = set(), []
    # 3-D, starts of MPI and of a device, pictures and the two runs of a sweep cost most
    rare = {"dim": 0.7, "device": 0.05, "ranks": 0.1, "pictures": 0.1, "door": 0.5}
    while len(draws) < runs:
        best, gain = None, -1
        tried = 0
        while tried < CANDIDATES:
            draw = {name: dice.choice(FEATURES[name]) for name in FEATURES}
            for name, share in rare.items():
                if dice.random() > share:
                    draw[name] = FEATURES[name][0]
            if not allowed(draw, levels):
                continue
            tried += 1
            new = len(pairs_of(draw) - seen)
            if new > gain:
                best, gain = draw, new
        draw = best | {"seed": dice.randrange(10**9)}
        seen |= pairs_of(best)
        draws.append(draw)
    return draws, seen


# ---- the case of a draw ----


def prism_stl(path, outline, width):
    """A prism along z: two fans and the sides, from outside; in metres."""
    n = len(outline)
    low, high = [(*p, 0.0) for p in outline], [(*p, width) for p in outline]
    triangles = []
    for k in range(n):
        m = (k + 1) % n
        triangles += [(low[k], low[m], high[m]), (low[k], high[m], high[k])]
        if 0 < k < n - 1:
            triangles += [(low[0], low[m], low[k]), (high[0], high[k], high[m])]
    with open(path, "wb") as file:
        file.write(b"\0" * 80 + struct.pack("<I", len(triangles)))
        for triangle in triangles:
            file.write(struct.pack("<12fH", 0, 0, 0, *itertools.chain(*triangle), 0))


def metres(*values):
    return " ".join(f"{v:.9g}" for v in values) + " m"


class Case:
    """The text of a case, its volume of liquid if this is exact, and its natural size."""

    def __init__(self, draw, folder):
        self.draw, self.folder = draw, folder
        dice = self.dice = random.Random(draw["seed"])
        self.dim = draw["dim"]
        self.dp = 0.025 if self.dim == 2 else 0.04
        cells = (dice.randint(12, 18), dice.randint(10, 14), dice.randint(6, 8))
        part = dice.uniform(-0.45, 0.45) if draw["outline"] != "size" else 0.0
        self.length, self.height, self.width = ((c + part) * self.dp for c in cells)
        self.level = dice.uniform(0.35, 0.6) * self.height
        self.at = (0.0, 0.0, 0.0) if dice.random() < 0.5 else tuple(dice.uniform(-1, 1) for _ in range(3))
        self.lines = ["mps: 1", f"dim: {self.dim}", f"dp: {self.dp * 1e3:g} mm"]
        self.outline()
        self.solids()
        self.model()
        self.motion()
        self.sensors()
        self.run()
        self.path = folder / "case.yaml"
        self.path.write_text("\n".join(self.lines) + "\n")

    def point(self, x, y, z=None):
        """A point of the tank, by shares of its box."""
        z = 0.5 if z is None else z
        p = [self.lo[0] + x * self.length, self.lo[1] + y * self.height, self.lo[2] + z * self.width]
        return metres(*p[: self.dim])

    def outline(self):
        kind = self.draw["outline"]
        self.lo = self.at
        L, H, W = self.length, self.height, self.width
        x, y, z = self.at
        size = metres(*(L, H, W)[: self.dim])
        at = metres(*self.at[: self.dim])
        corners = [(x, y), (x + L, y), (x + L, y + H), (x + 0.2 * L, y + H), (x, y + 0.8 * H)]
        if kind in ("size", "odd_size"):
            tank = f"size: {size}, at: {at}"
        elif kind == "chamfer":
            tank = f"size: {size}, at: {at}, chamfer: {{bottom: {metres(2.3 * self.dp)}, top: {metres(2.6 * self.dp)}}}"
        elif kind == "polygon":
            tank = "polygon: [" + ", ".join(metres(*p) for p in corners) + "]"
            if self.dim == 3:
                tank += f", width: {metres(W)}"
                self.lo = (x, y, 0.0)
        elif kind == "stl":
            prism_stl(self.folder / "tank.stl", [(a - x, b - y) for a, b in corners], W)
            tank = f"stl: tank.stl, unit: m, shift: {at}"
        else:
            R = 0.5 * (H if self.dim == 2 else max(H, 9 * self.dp))
            self.height, self.lo = 2 * R, None
            if kind == "sphere" or self.dim == 2:
                tank = f"{kind}: {{radius: {metres(R)}}}"
                self.length = self.width = 2 * R
                self.lo = (0.0, 0.0, -R)
            else:
                tank = f"cylinder: {{radius: {metres(R)}, length: {metres(L)}}}"
                self.width, self.lo = 2 * R, (0.0, 0.0, -R)
            self.level = 0.5 * self.height
        self.lines.append(f"tank: {{{tank}}}")

    def solids(self):
        kind, p, dp = self.draw["solids"], self.point, self.dp
        if kind == "none":
            return
        low = [self.lo[k] + (0.4 * self.length, 0.2 * self.height, 0.3 * self.width)[k] for k in range(3)]
        high = [low[0] + 3.3 * dp, low[1] + 2.7 * dp, low[2] + 3.1 * dp]
        if kind == "box":
            solid = f"box: [{metres(*low[: self.dim])}, {metres(*high[: self.dim])}]"
        elif kind in ("plate", "holes"):
            ends = [p(0.5, 0.15), p(0.5, 0.85)]
            if self.dim == 3:  # the first corner is between the others
                ends = [p(0.5, 0.15, 0.2), p(0.5, 0.85, 0.2), p(0.5, 0.15, 0.8)]
            solid = f"plate: [{', '.join(ends)}]"
            if kind == "holes":
                solid += f", holes: {{pitch: {metres(0.7 * self.height)}, open: 50 %}}"
        elif kind == "prism":
            a, b = low[0], low[1]
            solid = "prism: [" + ", ".join(metres(*c) for c in ((a, b), (a + 4 * dp, b), (a + 2 * dp, b + 3 * dp))) + "]"
            if self.dim == 3:
                solid += f", between: {metres(low[2], high[2])}"
        else:
            centre = [self.lo[0] + 0.5 * self.length, self.lo[1] + 0.4 * self.height, self.lo[2] + 0.5 * self.width]
            solid = f"sphere: {{centre: {metres(*centre[: self.dim])}, radius: {metres(2.2 * dp)}}}"
        self.lines.append(f"solids: {{s: {{{solid}}}}}")

    def model(self):
        kind = self.draw["model"]
        self.lines.append(f"fill: [{{water: {{depth: {metres(self.level)}}}}}{', {air: rest}' if kind == 'mmps' else ''}]")
        if kind in ("mmps", "imps.paper"):
            self.lines.append(f"model: {kind}")
        elif kind == "walls":
            self.lines.append("use: [friction.history, layer.history]" if self.dim == 2 else "use: [layer.history]")
            if self.dim == 2:
                self.lines.append("settings: {friction.width: 0.1 m}")
        elif kind == "pocket":
            self.lines.append("use: [gas.pocket]")

    def motion(self):
        kind, centre = self.draw["motion"], self.point(0.5, 0.3)
        roll = "roll" if self.dim == 3 or self.dice.random() < 0.7 else "surge"
        if kind == "rest":
            if self.draw["door"] == "fmu":  # an FMU has the centre of the motion
                self.lines.append(f"motion: {{centre: {centre}, surge: {{amplitude: 0 m, omega: 1 rad/s}}}}")
        elif kind in ("surge", "roll"):
            amplitude = "5 mm" if kind == "surge" else "3 deg"
            self.lines.append(f"motion: {{centre: {centre}, {kind}: {{amplitude: {amplitude}, period: 0.7 s}}}}")
        elif kind in ("table", "moving"):
            rows = [f"{k * 0.01:g},{0.004 * math.sin(9 * k * 0.01):.9g},{2 * math.sin(7 * k * 0.01):.9g}" for k in range(40)]
            (self.folder / "m.csv").write_text("time[s],surge[m],roll[deg]\n" + "\n".join(rows) + "\n")
            start = ", start: tank" if kind == "moving" else ""
            axes = ", axes: 'x forward, y port, z up'" if self.dim == 3 else ""
            self.lines.append(f"motion: {{centre: {centre}, file: m.csv{start}{axes}}}")
        else:
            inertia = "4 4 4" if self.dim == 3 else "4"
            self.lines.append(
                f"body: {{centre: {centre}, mass: 60 kg, inertia: {inertia} kg m2, {roll}: "
                + ("{period: 0.9 s, damping: 5 %}" if roll == "roll" else "{stiffness: 2 kN/m}") + "}"
            )

    def sensors(self):
        p = self.point
        self.lines += ["sensors:", f"  P: {{pressure: {p(0.5, 0.12)}, average: 0 s}}", "  F: {force: all, average: 0 s}"]
        if self.draw["sensors"] == "all":
            gauge = self.lo[0] + 0.25 * self.length
            across = f" {self.lo[2] + 0.5 * self.width:.9g}" if self.dim == 3 else ""
            self.lines += [f"  eta: {{gauge: {gauge:.9g}{across} m}}", "  n: {measure: strays}"]
            if self.draw["motion"] != "rest":  # its degrees name the columns
                self.lines.append("  load: {load: momentum}")

    def run(self):
        self.lines.append(f"run: {{until: {DT * STEPS:g} s, dt: {DT * 1e3:g} ms, checkpoint: 1 s}}")
        late = ", pictures: 1 s" if self.draw["pictures"] == "end" else ""  # after the end of the run
        self.lines.append(f"output: {{frames: 2, page: 2 MB{late}}}")


# ---- runs ----


class Failure(Exception):
    pass


class Machine:
    def __init__(self, o):
        self.o = o
        self.env = {k: v for k, v in os.environ.items() if not k.startswith("LC_")} | {"LC_ALL": "C"}

    def call(self, words, code=0, folder=None, env=None, words_before=()):
        done = subprocess.run([*words_before, str(self.o.program), *map(str, words)], cwd=folder, env=self.env | (env or {}),
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=600)
        if done.returncode != code:
            raise Failure(f"{' '.join(map(str, words))}: exit {done.returncode}: {done.stdout.strip()[-400:]}")
        return done.stdout

    def ways(self, draw):
        """Words before the program, options, environment of the second run."""
        before, options, env = [], ["-j", draw["threads"], "-q"], {}
        if draw["ranks"] > 1:
            before = [str(HERE.parent / "mpi" / "run"), self.o.mpirun, str(draw["ranks"])]
            env["MPI_STARTS"] = "1"
            options.append("--mpi")
        if draw["device"] == "cuda":
            standin, plugin, kernels = self.o.device
            options += ["--device", "cuda"]
            env |= {"LD_LIBRARY_PATH": f"{standin}:{plugin}", "STANDIN_KERNELS": kernels}
        if draw["locale"] == "comma":
            # the program alone, not what starts its ranks, is a host that has called setlocale()
            before += ["env", f"LOCPATH={self.o.locales[0]}", f"LD_PRELOAD={self.o.locales[1]}"]
        return before, options, env


def second(machine, draw, folder):
    """The run of the drawn ways; returns its folder."""
    before, options, env = machine.ways(draw)
    if draw["door"] == "sweep":
        (folder / "two.yaml").write_text("mps: 1\nbase: case.yaml\nsweep: {title: [one, two]}\n")
        machine.call(["sweep", "two.yaml", "-o", "sweep", *options], folder=folder, env=env, words_before=before)
        runs = [p.parent for p in sorted((folder / "sweep").glob("*/probes.csv"))]
        if len(runs) != 2:
            raise Failure(f"the sweep has {len(runs)} runs of 2")
        compare(*runs, False)
        return runs[0]
    if draw["resume"] == "yes":
        dice = random.Random(draw["seed"])
        half = DT * dice.randint(1, STEPS - 1)
        parts = [(before, options, env), (before, options, env)]
        if draw["ranks"] > 1:  # one part is enough: a checkpoint of ranks is that of one process
            parts[dice.randrange(2)] = machine.ways(draw | {"ranks": 1})
        for (before, options, env), verb, until in zip(parts, (["run", "case.yaml", "-o", "second"], ["resume", "second"]),
                                                       (half, DT * STEPS)):
            machine.call([*verb, "--set", f"run.until={until:g} s", *options], folder=folder, env=env, words_before=before)
            if not (folder / "second/checkpoint.mps").exists():
                raise Failure("no checkpoint at the end of a part")
    else:
        machine.call(["run", "case.yaml", "-o", "second", *options], folder=folder, env=env, words_before=before)
    return folder / "second"


def compare(first, other, resumed):
    check_page(other)
    for name in ("probes.csv", "momentum.csv", "checkpoint.mps"):
        if (first / name).exists() and not filecmp.cmp(first / name, other / name, shallow=False):
            raise Failure(f"other bytes of {name}")
    if resumed:  # frames by time: a run to half the time has other times of frames
        return
    frames = sorted(p.name for p in (first / "frames").iterdir())
    if frames != sorted(p.name for p in (other / "frames").iterdir()):
        raise Failure("other frames")
    for name in frames:
        if not filecmp.cmp(first / "frames" / name, other / "frames" / name, shallow=False):
            raise Failure(f"other bytes of {name}")


def columns(folder):
    with open(folder / "probes.csv", newline="") as file:
        rows = list(csv.reader(file))
    return {name.split("[")[0].strip(): [float(r[k]) for r in rows[1:]] for k, name in enumerate(rows[0])}


def check_page(folder):
    if "</html>" not in (folder / "report.html").read_text():
        raise Failure(f"{folder.name}/report.html has no end")


def invariants(case, folder, told):
    draw, summary, column = case.draw, json.loads((folder / "summary.json").read_text()), columns(folder)
    if summary["status"] != "ok" or summary["particles_lost"] != 0:
        raise Failure(f"status {summary['status']}, {summary['particles_lost']} particles lost")
    if not all(math.isfinite(v) for values in column.values() for v in values):
        raise Failure("a value is not finite")
    if draw["model"] != "imps.paper" and abs(column["volume_error"][-1]) > 0.02:
        raise Failure(f"error of volume {column['volume_error'][-1]:.3g}")
    check_page(folder)
    coarse = "warning" in told or draw["outline"] in ("cylinder", "sphere")  # it settles in more steps
    if draw["motion"] == "rest" and draw["model"] in ("imps", "walls", "pocket") and not coarse:
        vertical = column["F_y"]
        volume = float(re.search(r"fill of phase 0: \S+ m[23] of (\S+) m[23] requested", told).group(1))
        weight = DENSITY * volume * GRAVITY
        off = re.search(r"half a spacing, ([0-9.e+-]+) % at the bottom", told)  # few rows, or one that is not whole
        if abs(-vertical[-1] / weight - 1) > max(REST, float(off.group(1)) / 100 if off else 0):
            raise Failure(f"force {vertical[-1]:.5g} N, weight {weight:.5g} N")


# ---- an FMU ----


class Importer:
    """FMI 3.0 by ctypes, as far as this test needs it."""

    LOG = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p)

    def __init__(self, fmu, folder):
        with zipfile.ZipFile(fmu) as z:
            z.extractall(folder)
        self.message = ""
        self.log = self.LOG(self.heard)
        text = (folder / "modelDescription.xml").read_text()
        token = text.split('instantiationToken="')[1].split('"')[0]
        self.sensor = {name: int(part.split('valueReference="')[1].split('"')[0]) for name, part in
                       ((p.split('name="sensor.')[1].split('"')[0], p) for p in text.split("<Float64")[1:] if 'name="sensor.' in p)}
        library = next(folder.glob("binaries/*/*.so"))
        self.of = ctypes.CDLL(str(library))
        self.of.fmi3InstantiateCoSimulation.restype = ctypes.c_void_p
        self.of.fmi3InstantiateCoSimulation.argtypes = [ctypes.c_char_p, ctypes.c_char_p, ctypes.c_char_p] + [ctypes.c_bool] * 4 + [
            ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p, self.LOG, ctypes.c_void_p]
        self.it = self.of.fmi3InstantiateCoSimulation(b"tank", token.encode(), f"{folder / 'resources'}/".encode(), False, True,
                                                      False, False, None, 0, None, self.log, None)
        if not self.it:
            raise Failure(f"FMU: no instance: {self.message}")

    def heard(self, _, __, ___, text):
        self.message = text.decode(errors="replace")

    def call(self, name, *arguments):
        function = getattr(self.of, name)
        code = function(ctypes.c_void_p(self.it), *arguments)
        if code > 1:
            raise Failure(f"{name}: {code}: {self.message}")

    def start(self):
        self.call("fmi3EnterInitializationMode", ctypes.c_bool(False), ctypes.c_double(0), ctypes.c_double(0), ctypes.c_bool(False),
                  ctypes.c_double(0))
        self.call("fmi3ExitInitializationMode")

    def put(self, reference, value):
        self.call("fmi3SetFloat64", (ctypes.c_uint32 * 1)(reference), ctypes.c_size_t(1), (ctypes.c_double * 1)(value), ctypes.c_size_t(1))

    def step(self, t, dt):
        flags, last = [ctypes.c_bool() for _ in range(3)], ctypes.c_double()
        self.call("fmi3DoStep", ctypes.c_double(t), ctypes.c_double(dt), ctypes.c_bool(False), *map(ctypes.byref, flags),
                  ctypes.byref(last))

    def get(self, name):
        value = (ctypes.c_double * 1)()
        self.call("fmi3GetFloat64", (ctypes.c_uint32 * 1)(self.sensor[name]), ctypes.c_size_t(1), value, ctypes.c_size_t(1))
        return value[0]

    def close(self):
        self.of.fmi3FreeInstance(ctypes.c_void_p(self.it))


def fmu(machine, case, folder):
    """The FMU of a case, moved as the case moves, reads the pressure of the run."""
    _, options, env = machine.ways(case.draw)
    machine.call(["fmu", "case.yaml", "-q", "-o", "tank.fmu"], folder=folder, env=env)
    tank = Importer(folder / "tank.fmu", folder / "fmu")
    omega = 2 * math.pi / 0.7 if case.draw["motion"] == "surge" else 0
    amplitude = 0.005
    column = columns(folder / "first")
    try:
        tank.start()
        for k in range(1, STEPS + 1):
            t = k * DT
            for kind, value in ((1, amplitude * math.sin(omega * t)), (2, amplitude * omega * math.cos(omega * t)),
                                (3, -amplitude * omega**2 * math.sin(omega * t))):
                tank.put(16 * kind, value)
            tank.step((k - 1) * DT, DT)
        value = tank.get("P")
    finally:
        tank.close()
    if abs(value - column["P"][-1]) > 0.02 * max(abs(column["P"][-1]), DENSITY * GRAVITY * case.dp):
        raise Failure(f"the FMU has {value:.6g} Pa, the run {column['P'][-1]:.6g} Pa")


def one(machine, number, draw):
    """Text of what is wrong, or nothing."""
    with tempfile.TemporaryDirectory(prefix="pairs_", dir=machine.o.work) as name:
        folder = Path(name)
        case = Case(draw, folder)
        try:
            told = machine.call(["check", "case.yaml"], folder=folder)
            machine.call(["run", "case.yaml", "-o", "first", "-j", "1", "-q"], folder=folder)
            invariants(case, folder / "first", told)
            machine.call(["stats", "first"], folder=folder)
            if draw["door"] == "fmu":
                fmu(machine, case, folder)
            else:
                compare(folder / "first", second(machine, draw, folder), draw["resume"] == "yes")
        except (Failure, subprocess.TimeoutExpired, OSError, KeyError, ValueError) as e:
            if machine.o.keep:
                shutil.copytree(folder, Path(machine.o.keep) / str(number), dirs_exist_ok=True)
            return f"{number}: {draw}\n    {type(e).__name__}: {e}"
    return None


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("program", type=Path, help="mps")
    p.add_argument("--runs", type=int, default=200, metavar="N", help="draws (200)")
    p.add_argument("--seed", type=int, default=1, help="of the draws (1)")
    p.add_argument("--only", type=int, metavar="K", help="draw K of the seed alone")
    p.add_argument("--jobs", type=int, default=1, metavar="N", help="draws at the same time (1)")
    p.add_argument("--mpirun", help="starts ranks; without it, draws have one")
    p.add_argument("--device", nargs=3, metavar=("STANDIN", "PLUGIN", "KERNELS"), help="as tests/cuda/test_cases.sh takes them")
    p.add_argument("--locales", nargs=2, metavar=("DIR", "LIBRARY"), help="LOCPATH that has de_DE.UTF-8; comma.c as a library")
    p.add_argument("--work", metavar="DIR", help="for folders of runs; default: the system's")
    p.add_argument("--keep", metavar="DIR", help="folders of failed draws are copied to here")
    o = p.parse_args()
    o.program = o.program.resolve()
    o.device = o.device and [str(Path(p).resolve()) for p in o.device]  # runs are in folders of their own
    o.locales = o.locales and [str(Path(p).resolve()) for p in o.locales]
    if not o.program.exists():
        sys.exit(77)
    machine = Machine(o)
    levels = {name: list(values) for name, values in FEATURES.items()}
    if not o.mpirun or subprocess.run([HERE.parent / "mpi" / "run", o.mpirun, "2", "true"], capture_output=True).returncode:
        levels["ranks"] = [1]
    if not o.device:
        levels["device"] = ["host"]
    if not o.locales:
        levels["locale"] = ["C"]
    draws, seen = plan(o.seed, o.runs, levels)
    chosen = [(k, d) for k, d in enumerate(draws) if o.only is None or k == o.only]
    with ThreadPoolExecutor(o.jobs) as pool:
        wrong = [text for text in pool.map(lambda kd: one(machine, *kd), chosen) if text]
    print("\n".join(wrong))
    print(f"{len(chosen)} draws of seed {o.seed}, {len(seen)} pairs of levels, {len(wrong)} draws with a fault")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
