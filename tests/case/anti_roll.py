#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Bodies of case files: a tank on a spring and a ship section with an anti-roll tank against linear theory, loads of a table, what is refused.
usage: anti_roll.py PROGRAM [--long]"""
import csv
import math
import os
import subprocess
import sys
import tempfile

from box_theory import Box

program, long = os.path.realpath(sys.argv[1]), "--long" in sys.argv
cases = os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "cases")
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


def columns(path):
    with open(path, encoding="ascii") as table:
        rows = list(csv.DictReader(table))
    return {k.split("[")[0]: [float(row[k]) for row in rows] for k in rows[0]}


def harmonic(c, name, omega, begin):
    """Amplitude of a column by least squares."""
    rows = [(t, v) for t, v in zip(c["t"], c[name]) if t >= begin]
    n = [[0.0] * 4 for _ in range(3)]
    for t, v in rows:
        f = (1, math.cos(omega * t), math.sin(omega * t))
        for i in range(3):
            n[i][3] += f[i] * v
            for j in range(3):
                n[i][j] += f[i] * f[j]
    for i in range(3):
        for j in range(i + 1, 3):
            k = n[j][i] / n[i][i]
            n[j] = [a - k * b for a, b in zip(n[j], n[i])]
    x = [0.0] * 3
    for i in (2, 1, 0):
        x[i] = (n[i][3] - sum(n[i][j] * x[j] for j in range(i + 1, 3))) / n[i][i]
    return math.hypot(x[1], x[2])


def response(tank, omega, motion, mass, stiffness, damping, load, own=(0.0, 1.0)):
    """Amplitude of a body with the liquid (own: its damping and its frequency over that of theory), and without it."""
    body = stiffness - omega**2 * mass + 1j * omega * damping
    liquid = tank.load(omega, motion, *own)[motion == "roll"]
    return abs(load / (body - liquid)), abs(load / body)


RIG = """mps: 1
dp: 40 mm
tank: {size: 0.8 0.4 m}
fill: [{water: {depth: 0.08 m}}]
body:
  centre: 0.4 0 m
  forward: z
  mass: 1 t
  inertia: 100 t m2
  gravity: no
  roll: {period: 1 s, friction: 10 kN m}
  load: {file: push.csv, columns: {roll: M}}
run: {until: 6.5 s}
output: {frames: 1, page: 0 MB}
"""


def rig():
    """The axis of a test rig has dry friction M, a drive pushes by a table. Free of the drive, the amplitude falls by 2 M/k each half
    period, and the rig stops where |k phi| < M. The liquid is light; then it is not."""
    with open("rig.yaml", "w", encoding="ascii") as out:
        out.write(RIG)
    with open("push.csv", "w", encoding="ascii") as out:
        out.write("t[s],M[kN m]\n0,0\n0.3,120\n0.5,120\n0.501,0\n6.5,0\n")
    run("run", "rig.yaml", "-q", "-j", "1", "-o", "rig")
    c = columns("rig/probes.csv")
    band = math.degrees(10e3 / (100e3 * (2 * math.pi) ** 2))
    rate, begin = c["body_rate_roll"], c["t"].index(next(t for t in c["t"] if t > 0.51))
    turns = [c["roll"][k] for k in range(begin, len(rate)) if rate[k - 1] != 0 and rate[k - 1] * rate[k] <= 0]
    check(len(turns) == 10, f"{len(turns)} turning points, 10 until it stops")
    falls = [abs(a) - abs(b) for a, b in zip(turns[:-2], turns[1:-1])]
    worst = max(abs(fall / (2 * band) - 1) for fall in falls)
    check(worst < 0.005, f"each half period takes 2 M/k = {2 * band:.4f} deg within {100 * worst:.2f} %, at most 0.5")
    check(set(rate[-200:]) == {0.0} and abs(c["roll"][-1]) < band, f"it stands at {c['roll'][-1]:.3f} deg, within M/k = {band:.3f} deg")
    check(abs(abs(turns[0]) - 9 * 2 * band - abs(c["roll"][-1])) < 0.1 * band, "it stands where the last half period ends")
    lost = 0.5 * 100e3 * (2 * math.pi) ** 2 * math.radians(turns[0]) ** 2
    rubbed = c["body_rubbed"][-1] - c["body_rubbed"][begin]
    check(abs(rubbed / lost - 1) < 0.02, f"friction takes {rubbed:.0f} J/m of {lost:.0f} J/m in the spring")
    # half of the tank is water, which has a moment; half of the friction holds, the double moves
    for push, moves in ((0.5, False), (2, True)):
        with open("push.csv", "w", encoding="ascii") as out:
            out.write(f"t[s],M[N m]\n0,0\n0.2,{push * 80}\n0.6,{push * 80}\n")
        run("run", "rig.yaml", "-q", "-j", "1", "-o", f"push{push}", "--set", "fill.water.depth=0.2 m", "--set", "body.inertia=20 kg m2", "--set",
            "body.roll.friction=80 N m", "--set", "run.until=0.6 s")
        c = columns(f"push{push}/probes.csv")
        check(any(c["body_rate_roll"]) == moves, f"{push} times the friction: {max(c['roll']):.3g} deg")
        check(max(map(abs, c["body_friction_roll"])) < 80 * (1 + 1e-9), "friction within its limit")


SPRING = """mps: 1
dp: 40 mm
tank: {size: 0.8 0.5 m}
fill: [{water: {depth: 0.24 m}}]
body:
  mass: 500 kg
  surge: {period: 1 T1, damping: 20 %, load: {amplitude: 50 N, period: 1.666666667 T1, ramp: 3 T1}}
run: {until: 10 T1}
output: {frames: 1, page: 0 MB}
"""


def quick():
    with open("spring.yaml", "w", encoding="ascii") as out:
        out.write(SPRING)
    run("check", "spring.yaml", text="with the moving liquid, by linear theory")
    run("run", "spring.yaml", "-q", "-j", "1", "-o", "spring")
    tank = Box(0.8, 0.24)
    omega, stiffness = 0.6 * tank.omega1, 500 * tank.omega1**2
    wet, dry = response(tank, omega, "surge", 500, stiffness, 0.4 * 500 * tank.omega1, 50)
    found = harmonic(columns("spring/probes.csv"), "surge", omega, 5 * 2 * math.pi / tank.omega1)
    check(abs(wet / dry - 1) > 0.1, f"the liquid matters: {wet / dry:.3f} of the response without it")
    check(abs(found / wet - 1) < 0.04, f"tank on a spring: {100 * (found / wet - 1):+.2f} % of theory, at most 4")
    # the same load from a table, linear between its rows
    with open("load.csv", "w", encoding="ascii") as out:
        out.write("time[ms],push[kN]\n" + "".join(f"{k},{0.05 * math.sin(omega * k * 1e-3):.12f}\n" for k in range(601)))
    short = ("--set", "run.until=0.5 s", "-q", "-j", "1")
    run("run", "spring.yaml", *short, "--set", "body.surge.load.ramp=0 s", "-o", "a")
    run("run", "spring.yaml", *short, "--set", "body.surge={period: 1 T1, damping: 20 %}", "--set",
        "body.load={file: load.csv, columns: {surge: push}}", "-o", "b")
    a, b = (columns(f"{name}/probes.csv")["surge"][-1] for name in "ab")
    check(a != 0 and abs(b / a - 1) < 1e-4, f"table and harmonic: {b / a - 1:.1e}")
    # a free tank: M + m0 + sum m_n/(1 - w^2/w_n^2) = 0 has w = 7.003 rad/s for M = 100 kg, 8.372
    # for 2 kg
    for mass, omega in ((100, 7.003), (2, 8.372)):
        said = run("check", "spring.yaml", "--set", "fill.water.depth=0.25 m", "--set", f"body={{mass: {mass} kg, surge: {{stiffness: 0.1 N/m}}}}",
                   text="with the moving liquid, by linear theory")
        period = float(said.split("with the moving liquid, by linear theory")[1].split(" and ")[1].split()[0])
        check(abs(period * omega / (2 * math.pi) - 1) < 2e-4, f"{mass} kg: {2 * math.pi / period:.4f} rad/s, {omega} by theory")
    run("check", "spring.yaml", "--set", "fill.water.depth=0.25 m", "--set",
        "body={mass: 1 kg, centre: 0.4 0 m, inertia: 10 kg m2, roll: {stiffness: 600 N m/rad}}", text="it falls over: it needs 663.8 N m/rad/m")
    run("check", "spring.yaml", "--set", "body={mass: 1 kg, surge: {stiffness: -5 N/m}}", text="with the moving liquid: nothing restores")
    said = run("check", "spring.yaml")
    check("surge: mass 500 kg/m, restoring" in said and "N/m/m, damping" in said and "N s/m/m\n" in said, "2-D: units per metre of width")
    check("Velocity of the body, surge: of its centre, axes of the lab\n" in said, "columns of a shift are not about the centre")
    refused("body.surge.period=0 s", "body.surge.period")
    refused("body.heave={period: 1 s, stiffness: 1 N/m}", "exclude each other")
    refused("body={mass: 1 kg}", "no degree is free")
    refused("body={mass: 0 kg, surge: {period: 1 s}}", "needs a mass")
    refused("body={mass: 1 kg, surge: {damping: 5 %}}", "a share needs")
    refused("body={mass: 1 kg, inertia: 1 2 3 kg m2, roll: {stiffness: 1 N m/rad}}", "in 2-D it is one number")
    refused("body={mass: 1 kg, pitch: {stiffness: 1 N m/rad}}", "body.pitch: moves nothing in the plane")
    refused("body={mass: 1 kg, roll: {stiffness: 1 N/m}}", "body.roll.stiffness")
    refused("body.load={file: load.csv, columns: {heave: push}}", "heave is not free")
    refused("body.surge.load={amplitude: 1 N}", "omega")
    refused("body={mass: -1 kg, surge: {stiffness: 1 N/m}}", "body.mass")
    refused("body={mass: 1 kg, forward: y, surge: {stiffness: 1 N/m}}", "body.forward")
    refused("body={mass: 1 kg, order: roll pitch, surge: {stiffness: 1 N/m}}", "body.order")
    refused("body={mass: 1 kg, surge: {stiffness: 1 N/m, damping: -1 N s/m}}", "body.surge.damping")
    refused("body.load={file: none.csv, columns: {surge: push}}", "none.csv")
    refused("body.load={file: load.csv, columns: {surge: pull}}", "pull")
    refused("body.load={file: load.csv}", "body.load")
    with open("three.yaml", "w", encoding="ascii") as out:
        out.write(THREE)
    for inertia, why in (("1 2", "in 3-D it is three numbers"), ("1 1 1 2 0 0", "negative moment"), ("1 1 1 -0.9 -0.9 -0.9", "about some axis")):
        run("check", "three.yaml", "--set", f"body.inertia={inertia} kg m2", code=2, text=why)
    run("check", "spring.yaml", "--set", "motion={surge: {amplitude: 1 mm, period: 1 s}}", text="1 harmonic")


def refused(text, why):
    run("check", "spring.yaml", "--set", "run.until=0.5 s", "--set", text, code=2, text=why)


def decay():
    """Frequency over that of theory and share of critical damping of the first wave in the tank of the section, by its own decay."""
    tank = Box(0.8, 0.25)
    T1 = 2 * math.pi / tank.omega1
    with open("decay.yaml", "w", encoding="ascii") as out:
        out.write("mps: 1\ndp: 20 mm\ntank: {size: 0.8 0.5 m}\nfill: [{water: {depth: 0.25 m, start: {standing_wave: 5 mm}}}]\n"
                  "sensors: {eta: {gauge: 1 dp}}\nrun: {until: 12 T1}\noutput: {frames: 1, page: 0 MB}\n")
    run("run", "decay.yaml", "-q", "-o", "decay")
    c = columns("decay/probes.csv")
    best = max((harmonic(window(c, T1, 9 * T1), "eta", f * tank.omega1, 0), f) for f in (0.98 + 0.0005 * k for k in range(81)))
    early = harmonic(window(c, T1, 5 * T1), "eta", best[1] * tank.omega1, 0)
    late = harmonic(window(c, 7 * T1, 11 * T1), "eta", best[1] * tank.omega1, 0)
    return math.log(early / late) / (6 * T1 * tank.omega1), best[1]


def window(c, begin, end):
    kept = [i for i, t in enumerate(c["t"]) if begin <= t <= end]
    return {k: [v[i] for i in kept] for k, v in c.items()}


THREE = """mps: 1
dim: 3
dp: 40 mm
tank: {size: 0.8 0.5 0.32 m}
fill: [{water: {depth: 0.24 m}}]
body:
  centre: 0.4 0 0.16 m
  mass: 160 kg
  inertia: 10 20 20 kg m2
  gravity: no
  surge: {period: 1 T1, damping: 20 %, load: {amplitude: 15 N, period: 1.666666667 T1, ramp: 3 T1}}
run: {until: 10 T1}
output: {frames: 1, page: 0 MB}
"""


def three():
    """The tank on a spring in 3-D: the wave is that of 2-D."""
    with open("three.yaml", "w", encoding="ascii") as out:
        out.write(THREE)
    run("run", "three.yaml", "-q", "-j", "1", "-o", "three")
    tank = Box(0.8, 0.24)
    omega, mass = 0.6 * tank.omega1, 160 / 0.32
    wet, dry = response(tank, omega, "surge", mass, mass * tank.omega1**2, 0.4 * mass * tank.omega1, 15 / 0.32)
    found = harmonic(columns("three/probes.csv"), "surge", omega, 5 * 2 * math.pi / tank.omega1)
    check(abs(wet / dry - 1) > 0.1, f"the liquid matters: {wet / dry:.3f} of the response without it")
    check(abs(found / wet - 1) < 0.03, f"tank on a spring in 3-D: {100 * (found / wet - 1):+.2f} % of theory, at most 3")


RATIOS = (0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3)


def ship():
    tank = Box(0.8, 0.25)
    own = decay()
    print(f"the run's own wave: damping {100 * own[0]:.3f} % of critical, frequency {own[1]:.4f} of theory")
    check(0 <= own[0] < 0.02 and abs(own[1] - 1) < 0.02, "the free wave is that of the tank")
    with open("response.yaml", "w", encoding="ascii") as out:
        out.write(f"mps: 1\nbase: {os.path.join(cases, 'anti_roll_tank.yaml')}\nset: {{output.frames: 1, output.page: 0 MB}}\n"
                  f"sweep: {{body.roll.load.period: {' '.join(f'{1 / r:.9g}' for r in RATIOS)} T1}}\ncollect: [roll.harmonic]\n")
    run("sweep", "response.yaml", "-o", "ship")
    compare_ship("ship", tank, own[0])


def compare_ship(folder, tank, damping):
    """Against linear theory with the run's own damping. At w1 theory has next to no roll: there the error is one of the roll without liquid."""
    with open(f"{folder}/sweep.csv", encoding="ascii") as table:
        found = [float(row["roll.harmonic[deg]"]) for row in csv.DictReader(table)]
    inertia, w1 = 100, tank.omega1
    for ratio, degrees in zip(RATIOS, found):
        wet, dry = (math.degrees(a) for a in response(tank, ratio * w1, "roll", inertia, inertia * w1**2, 0.2 * inertia * w1, 3, (damping, 1)))
        error = (degrees - wet) / (dry if ratio == 1 else wet)
        check(abs(error) < 0.05, f"{ratio:.1f} w1: roll {degrees:.4f} deg, theory {wet:.4f}, without liquid {dry:.4f}: {100 * error:+.2f} %, at most 5")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        if long:
            three()
            ship()
        else:
            quick()
            rig()
        os.chdir("/")
    sys.exit(1 if failures else 0)
