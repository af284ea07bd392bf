#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The statistics of scripts/impacts: peaks, impulses and rises of drawn pulses, which events are one impact, scatter, and its case files.
usage: tests/cases/test_impact_events.py FOLDER_OF_THE_SCRIPTS PROGRAM FOLDER_FOR_FILES; exit code 77 without numpy."""
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, sys.argv[1])
sys.dont_write_bytecode = True
try:
    import numpy as np
except ImportError:
    print("skipped: python3 has no numpy")
    sys.exit(77)
import events  # noqa: E402
import table  # noqa: E402
from cases import VARIANTS, Run, breaking, tanks  # noqa: E402

failures = 0
SCALE = events.RHO * events.G  # depth 1 m


def near(name, value, wanted, error=1e-9):
    global failures
    if not abs(value - wanted) <= error * max(1, abs(wanted)):
        print(f"FAILED: {name} is {value:.9g}, not {wanted:.9g}")
        failures += 1


def signals(pulses, until=4.0, dt=1e-3):
    """Rectangles (wall, begin, length, pressure) on zero, in steps that do not fit the means."""
    t = np.arange(1, round(until / dt) + 1) * dt
    p = {name: np.zeros_like(t) for name in ("left_1", "left_2", "right_1", "left_panel")}
    for name, begin, length, pressure in pulses:
        p[name][(t > begin + 1e-9) & (t <= begin + length + 1e-9)] = pressure * SCALE
    return events.Signals(t, np.full_like(t, dt), np.full_like(t, 0.010), p)


def peaks():
    """A rectangle of 10 ms: mean over 20 ms is half of it, its impulse is that of all; the higher of two sensors counts."""
    s = signals([("left_1", 1.0, 0.010, 8), ("left_2", 1.0, 0.002, 20), ("left_panel", 1.0, 0.010, 3)])
    (e,) = events.find(s, ("left", "right"), 1.0, 2.0, 1.0)
    for name, value, wanted in zip(("1 ms", "5 ms", "20 ms"), e.peaks, (20, 8, 4)):
        near(f"peak over {name}", value, wanted)
    near("impulse", e.impulse, 0.080)
    near("peak of the panel over 20 ms", e.panel[2], 1.5)
    near("impulse of the panel", e.panel[3], 0.030)
    near("mean over dp/u", e.resolved, 8)
    near("its rise in dp/u", e.rises[0], 1)
    near("rise of the mean over 20 ms", e.rises[3], 1)
    near("crossing time", e.crossing, 0.010)
    near("begin", e.t, 0.501, 2e-3)


def scaled():
    """In a tank of four times the length all times are twice as long."""
    s = signals([("left_1", 1.0, 0.010, 8)])
    (e,) = events.find(s, ("left",), 1.0, 2.0, 2.0)
    near("peak over 5 ms", e.peaks[1], 8)
    near("peak over 20 ms", e.peaks[2], 2)
    near("impulse", e.impulse, 0.040)
    near("crossing time", e.crossing, 0.005)


def windows():
    """Pulses within the window are one event, later ones others; what lasts beyond the record is none."""
    early, late, last = ("left_1", 1.0, 0.02, 5), ("left_1", 1.3, 0.02, 9), ("right_1", 3.9, 0.2, 9)
    found = events.find(signals([early, late, last]), ("left", "right"), 1.0, 2.0, 1.0)
    near("events within the window", len(found), 1)
    near("peak of both", found[0].peaks[1], 9)
    found = events.find(signals([early, ("left_1", 1.6, 0.02, 9), last]), ("left", "right"), 1.0, 2.0, 1.0)
    near("events beyond the window", len(found), 2)
    near("none", len(events.find(signals([("left_1", 1.0, 0.02, 1.4)]), ("left",), 1.0, 2.0, 1.0)), 0)


def row(model, rows, repeat, t, peak, tank="1", rise=1.0):
    figures = [peak] * len(table.FIGURES)
    return table.Row(tank, model, rows, repeat, "left", t, 10.0, (rise,) * 4, tuple(figures))


def statistics(folder):
    """Repeats of 4, 6 and 9: deviation ln 1.5, largest over least 9/4; a model of half of it; a low event that does not count."""
    rows = [row("void", 10, k, 1 + 0.03 * k, 4 * 1.5**k) for k in range(3)] + [row("pocket", 10, k, 1, 2 * 1.5**k) for k in range(3)]
    rows += [row(model, 20, k, 1.05, 12 * 1.5**k, rise=3.0) for model in ("void", "pocket") for k in range(3)]
    low = [row("void", 10, k, 2, 2) for k in range(3)]
    table.write(folder / "impacts.csv", rows + low)
    again = table.read(folder / "impacts.csv")
    near("rows that come back", len(set(rows) & set(again)), len(rows))
    near("rows", len(again), len(rows))
    near("lines, one of a run of both models", len((folder / "impacts.csv").read_text().splitlines()), 1 + len(rows) - 3)
    found = table.impacts(again)
    near("impacts", len({key[:2] for key in found}), 1)
    of_void = table.all_values(found, "void", 10, 0)
    near("standard deviation", table.deviation(of_void), np.log(1.5))
    near("pocket over void", table.ratios(found, ("pocket", 10), ("void", 10), 0)[0], 0.5)
    near("fine over coarse", table.ratios(found, ("void", 20), ("void", 10), 0)[0], 3)
    parts = table.by_rise(found, "void", (0, 2, 5))
    near("peaks that rise fast", parts[0][2], 4)
    near("largest over least", parts[1][4], 2.25)
    parts = table.by_mean_time(found, "void", (0, 0.2, 1, 5))
    near("means over 1 ms, two spacings", parts[0][2], 2)
    near("deviation of the largest", table.deviation_of_runs(table.runs_of(rows, max, "void", 20, 0)), np.log(1.5))


def cases(folder):
    """The program reads each case, and repeats differ by 0.5 % of dp."""
    global failures
    for k, tank in enumerate([*tanks(), breaking()]):
        run = Run(tank, 6, VARIANTS[k % 3], 0)
        path = folder / f"{run.name}.yaml"
        path.write_text(run.case(), encoding="utf-8")
        done = subprocess.run([sys.argv[2], "check", path.name], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            print(f"FAILED: mps check {path.name}: {done.stdout}")
            failures += 1
    near("tanks", len(tanks()), 20)
    near("factor of the last repeat", Run(tank, 6, "void", tank.repeats - 1).factor, 1.005)


def main():
    folder = Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    peaks()
    scaled()
    windows()
    statistics(folder)
    cases(folder)
    return 1 if failures else 0


sys.exit(main())
