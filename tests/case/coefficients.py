#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""mps coefficients: A(w) and B(w) of a rectangular tank against linear theory, its tables, an interrupted series, refusals.
usage: coefficients.py PROGRAM [--long]"""
import csv
import os
import subprocess
import sys
import tempfile

from box_theory import Box

program, long = os.path.realpath(sys.argv[1]), "--long" in sys.argv
failures = []


def check(good, text):
    print("ok    " if good else "FAILED", text)
    if not good:
        failures.append(text)


def run(*arguments, code=0, text=""):
    done = subprocess.run([program, *arguments], capture_output=True, text=True)
    said = done.stdout + done.stderr
    check(done.returncode == code and text in said, f"{' '.join(arguments)}: exit {done.returncode}, wanted {code} and '{text}'")
    if done.returncode != code or text not in said:
        print(said[-2000:])
    return said


def write_case(name, dp, depth):
    with open(name, "w", encoding="ascii") as out:
        out.write(f"mps: 1\ndp: {dp}\ntank: {{size: 0.8 0.5 m}}\nfill: [{{water: {{depth: {depth} m}}}}]\n"
                  "motion: {centre: 0.4 0 m, surge: {amplitude: 9 mm, period: 1 T1}}\nrun: {until: 1 s}\n"
                  "output: {frames: 1, page: 0 MB}\n")


def read(folder):
    with open(f"{folder}/coefficients.csv", encoding="ascii") as table:
        rows = [{k.split("[")[0]: float(v) for k, v in row.items()} for row in csv.DictReader(table)]
    check(all(a["omega"] < b["omega"] for a, b in zip(rows, rows[1:])), "frequencies ascend")
    return rows


def compare(rows, tank, load, motion, most, column=""):
    """A within `most` of theory, as a share of it or of the mass that is never in a wave, whichever is larger; B near 0."""
    for row in rows:
        w, name = row["omega"], f"{load}_{motion}"
        exact = tank.added(w, load, motion)
        scale = max(abs(exact), abs(tank.added(1e3, load, motion)))
        error = (row[f"A_{name}{column}"] - exact) / scale
        b = row[f"B_{name}"] / (w * scale)
        check(abs(error) < most, f"A_{name}{column} at {w / tank.omega1:.2f} w1: {100 * error:+.2f} %, at most {100 * most:g}")
        check(abs(b) < most, f"B_{name}/(w A) at {w / tank.omega1:.2f} w1: {100 * b:+.2f} %, at most {100 * most:g}")


def quick():
    write_case("box.yaml", "40 mm", 0.24)
    few = ("--period", "1 1.666666667 T1", "--periods", "4", "-j", "1")
    run("coefficients", "box.yaml", "--degrees", "roll sweet heave", code=2, text="--degrees: 'sweet': no degree")
    run("coefficients", "box.yaml", "--degrees", "roll roll", code=2, text="named twice")
    run("coefficients", "box.yaml", "--omega", "5 rad/s", "--period", "1 s", code=2, text="not both")
    run("coefficients", "box.yaml", "--period", "1.2 kg", code=2, text="time")
    run("coefficients", "box.yaml", "--amplitude", "2 s", code=2, text="--amplitude: surge: '2 s'")
    with open("voyage.csv", "w", encoding="ascii") as out:
        out.write("time[s],surge[m]\n0,0\n1,0.1\n")
    run("coefficients", "box.yaml", "--set", "motion={file: voyage.csv}", code=2, text="--degrees")
    run("coefficients", "box.yaml", *few, "-o", "out", text="coefficients.dat")
    rows, tank = read("out"), Box(0.8, 0.24)
    check(len(rows) == 2 and abs(rows[0]["omega"] / tank.omega1 - 0.6) < 1e-6, "0.6 w1 before w1")
    compare(rows[:1], tank, "surge", "surge", 0.02)
    compare(rows[:1], tank, "surge", "surge", 0.04, "_walls")
    check(0 < rows[0]["A_surge_surge_band"] < 0.05 * rows[0]["A_surge_surge"], "the band is small")
    check(rows[0]["C_surge_surge"] == 0, "a shift has no restoring")
    with open("out/coefficients.dat", encoding="ascii") as table:
        plain = [line.split() for line in table]
    check([p[1:3] for p in plain] == 2 * [["1", "1"], ["3", "1"], ["4", "1"]], "load and motion of the plain table")
    check(abs(float(plain[0][3]) / rows[0]["A_surge_surge"] - 1) < 1e-6, "A of the plain table")
    run("coefficients", "box.yaml", *few, "-o", "out", text="is done already")
    os.mkdir("o'clock")  # the tilt of a turn has its table there
    run("coefficients", "box.yaml", "--degrees", "roll", "--period", "0.3 s", "--periods", "1", "-j", "1", "-q", "-o", "o'clock/out", text="; C -")
    # without a run, here that of the first period, the row of the other one remains
    with open("out/001/trace.csv", encoding="ascii") as whole:
        kept = whole.read()
    with open("out/001/trace.csv", "w", encoding="ascii") as cut:
        cut.write(kept.split("\n")[0] + "\n")
    said = run("coefficients", "box.yaml", *few, "-o", "out", code=1, text="out/001: trace.csv has no steps")
    check(said.count(f"\n{rows[0]['omega']:10.5g} ") == 3 and f"\n{rows[1]['omega']:10.5g} " not in said, "a line of each load, none of the run")
    check(read("out") == rows[:1], "a row without the other run")
    with open("out/001/trace.csv", "w", encoding="ascii") as whole:
        whole.write(kept)
    run("coefficients", "box.yaml", *few, "-o", "out", "--amplitude", "3 mm", code=2, text="another case")


def thorough():
    for dp, most in (("20 mm", 0.06), ("10 mm", 0.03)):
        name = dp.replace(" ", "")
        write_case(f"{name}.yaml", dp, 0.25)
        run("coefficients", f"{name}.yaml", "--degrees", "surge roll" if dp == "20 mm" else "surge", "--period",
            "0.714285714 0.833333333 1.25 1.666666667 T1", "-o", name)
        rows, tank = read(name), Box(0.8, 0.25)
        compare(rows, tank, "surge", "surge", most)
        if dp == "20 mm":
            for load, motion in (("roll", "surge"), ("surge", "roll"), ("roll", "roll")):
                compare(rows, tank, load, motion, most)
            error = rows[0]["C_roll_roll"] / tank.restoring() - 1
            check(abs(error) < 0.01, f"C: {100 * error:+.2f} %, at most 1")


sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    thorough() if long else quick()
    os.chdir("/")
sys.exit(1 if failures else 0)
