# SPDX-License-Identifier: BSD-3-Clause
"""A tank that rolls, from Python: pressure at the wall and height of the surface, with plots if
matplotlib is installed.
usage: python3 tank.py [seconds]"""
from __future__ import annotations

import sys

import mps
import numpy as np

DEPTH, LENGTH = 0.3, 1.0


def build(dp: float) -> tuple[mps.Simulation, dict[str, mps.Probe]]:
    sim = mps.Simulation(dp=dp)
    sim.tank(size=(LENGTH, 0.8))
    sim.fill_level(lo=(0, 0), hi=(LENGTH, DEPTH))
    sim.motion_centre((LENGTH / 2, 0))
    k = np.pi / LENGTH
    omega = np.sqrt(9.81 * k * np.tanh(k * DEPTH))  # the first natural frequency
    sim.move_harmonic({"dof": "rotate_z", "amplitude": 0.05, "omega": omega, "ramp": 2 * np.pi / omega})
    sensors = {"P": sim.probe("wall_pressure", at=(0, 0.2), rate=200),
               "eta": sim.probe("gauge", at=(dp, 0), rate=200)}
    return sim, sensors


def plot(sim: mps.Simulation, sensors: dict[str, mps.Probe]) -> None:
    try:
        import matplotlib.pyplot as plt
    except ImportError:
        print("no plots: matplotlib is not installed")
        return
    figure, (left, above, below) = plt.subplots(1, 3, figsize=(14, 4), layout="constrained")
    fluid = sim.fluid
    with sim.read("position") as x, sim.read("pressure") as p:
        dots = left.scatter(*x[fluid].T, c=p[fluid] / 1e3, s=4)
    figure.colorbar(dots, ax=left, label="pressure [kPa]")
    left.set(aspect="equal", xlabel="x [m]", ylabel="y [m]", title=f"t = {sim.t:.2f} s")
    t, p = sensors["P"].series()
    above.plot(t, p[:, 0] / 1e3)
    above.set(xlabel="t [s]", ylabel="pressure [kPa]")
    t, eta = sensors["eta"].series()
    below.plot(t, 1e3 * (eta[:, 0] - DEPTH))
    below.set(xlabel="t [s]", ylabel="height at the left wall [mm]")
    figure.savefig("tank.png", dpi=100)
    print("tank.png")


def main() -> None:
    sim, sensors = build(dp=0.02)
    end = float(sys.argv[1]) if len(sys.argv) > 1 else 4.0
    told = -1

    def progress(s: mps.Simulation, info: mps.Record) -> None:
        nonlocal told
        if int(info.t) > told:
            told = int(info.t)
            print(f"t = {info.t:.2f} s, kinetic energy {s.energy.kinetic:.2f} J/m")

    sim.run(end, progress)
    t, p = sensors["P"].series()
    print(f"largest pressure {p.max() / 1e3:.2f} kPa at {t[p[:, 0].argmax()]:.2f} s")
    plot(sim, sensors)


if __name__ == "__main__":
    main()
