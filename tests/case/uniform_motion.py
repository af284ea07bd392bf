#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Nothing depends on a uniform motion: a run whose tank oscillates in surge while it moves at 82 m/s
(100 m/s in 3-D, along two axes) with 'start: tank' has the steps, sensors, averages, checks of the
page and warnings of the run without this speed, with and without air.

usage: uniform_motion.py PROGRAM
"""
import csv
import json
import math
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

# numbers with the velocity of the observer: of the tank, of the liquid, works
OF_FRAME = re.compile(r"surge|sway|x_tank|ke|wall_work_|shift\[|added")
NEAR = 1e-9  # of the largest value of a quantity; the solution is to 1e-11
SOLVER = re.compile(r"ppe_")  # a residual near its limit may need another iteration
problems = []


def check(good, text):
    if not good:
        problems.append(text)


def write_case(name, dim, model, speed):
    with open(f"{name}.csv", "w", encoding="ascii") as file:
        file.write("time[s],surge[m],sway[m],heave[m]\n" if dim == 3 else "time[s],surge[m],heave[m]\n")
        for k in range(60):
            t = k / 100
            values = [speed[0] * t + 0.02 * math.sin(5 * t), *([speed[1] * t] if dim == 3 else []), 0.005 * math.sin(4 * t)]
            file.write(",".join(f"{v:.17g}" for v in [t, *values]) + "\n")
    z = " 0.1" if dim == 3 else ""
    air = ", {air: rest}" if model == "mmps" else ""
    axes = ", axes: 'x forward, y port, z up'" if dim == 3 else ""
    Path(f"{name}.yaml").write_text(f"""mps: 1
title: a tank
dim: {dim}
dp: {50 if dim == 3 else 25} mm
model: {model}
tank: {{size: 0.6 0.4{" 0.2" if dim == 3 else ""} m}}
fill: [{{water: {{depth: 50 %}}}}{air}]
motion: {{file: {name}.csv, start: tank{axes}}}
sensors:
  P: {{wall: 0 0.1{z} m}}
  Q: {{wall: 0.6 0.15{z} m}}
  F: {{force: tank}}
  eta: {{gauge: {"0.06 0.11 m" if dim == 3 else "1 dp"}}}
run: {{until: 0.2 s, threads: 1, tolerance: 1e-11, divergence: 0}}
output: {{frames: 2}}
""", encoding="ascii")


def run(program, name, *case):
    """Exit code, warnings, tables, summary and checks of the page."""
    write_case(name, *case)
    done = subprocess.run([program, "run", f"{name}.yaml", "-o", name], check=False, capture_output=True, text=True)
    tables = {}
    for table in ("probes.csv", "steps.csv"):
        with open(f"{name}/{table}", encoding="ascii") as file:
            head, *rows = csv.reader(file)
        tables[table] = dict(zip(head, zip(*[[float(v) for v in row] for row in rows])))
    page = Path(f"{name}/report.html").read_text(encoding="utf-8")
    lights = [re.sub(r"<[^>]*>|\s+", " ", light) for light in re.findall(r'<li class="light .*?</li>', page, re.S)]
    warnings = [line for line in done.stderr.splitlines() if "warning" in line]
    return done.returncode, warnings, tables, json.loads(Path(f"{name}/summary.json").read_text(encoding="utf-8")), lights


def quantity(name):
    """Columns of one scale: components of a force or moment, terms of the energy."""
    return re.sub(r".*\[J", "[J", re.sub(r"_m?[xyz]\[", "[", name))


def same_columns(text, rest, fast):
    check(list(rest) == list(fast), f"{text}: columns")
    names = [name for name in rest if not OF_FRAME.match(name) and not SOLVER.match(name)]
    largest = {}
    for name in names:
        most = max(abs(v) for v in rest[name])
        largest[quantity(name)] = max(largest.get(quantity(name), 0), most)
    for name in names:
        check(len(rest[name]) == len(fast[name]), f"{text}: {name}: {len(rest[name])} and {len(fast[name])} rows")
        far, most = max(abs(a - b) for a, b in zip(rest[name], fast[name])), largest[quantity(name)]
        check(far <= NEAR * most, f"{text}: {name} differs by {far:g} of {most:g}")


def same_runs(program, dim, model):
    text, speed = f"{model}, {dim}-D", (60, 80) if dim == 3 else (82,)
    rest = run(program, f"{model}{dim}_rest", dim, model, (0, 0))
    fast = run(program, f"{model}{dim}_fast", dim, model, speed)
    check(rest[0] == fast[0] == 0, f"{text}: exit {rest[0]}, {fast[0]}")
    check([w.replace("rest", "fast") for w in rest[1]] == fast[1], f"{text}: warnings: {rest[1]}, {fast[1]}")
    for table, columns in rest[2].items():
        check(len(columns["t[s]"]) > 25, f"{text}: {table}: {len(columns['t[s]'])} rows")
        same_columns(f"{text}, {table}", columns, fast[2][table])
    surge = fast[2]["probes.csv"]["surge[m]"][-1] - rest[2]["probes.csv"]["surge[m]"][-1]
    check(abs(surge - 0.2 * speed[0]) < 1e-9, f"{text}: the tank has moved by {surge} m")
    for key in ("sensor_average_least", "sensor_average_most"):
        far = abs(rest[3][key] - fast[3][key])
        check(far <= NEAR * rest[3]["sensor_average_most"], f"{text}: {key}: {rest[3][key]}, {fast[3][key]}")
    check(rest[3]["steps"] == fast[3]["steps"], f"{text}: {rest[3]['steps']} and {fast[3]['steps']} steps")
    check(len(rest[4]) == len(fast[4]) == 6, f"{text}: {len(rest[4])} and {len(fast[4])} checks of the page")
    for a, b in zip(rest[4], fast[4]):
        check(a == b, f"{text}: on the page:\n  {a}\n  {b}")


def main():
    program = str(Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for dim in (2, 3):
            for model in ("imps", "mmps"):
                same_runs(program, dim, model)
        os.chdir("/")
    print("\n".join(problems) if problems else "a uniform motion changes nothing")
    return 1 if problems else 0


sys.exit(main())
