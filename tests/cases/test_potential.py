#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The reference of the validation, scripts/validation/potential.py: a linear standing wave, and volume, energy and crests of a steep one.
usage: tests/cases/test_potential.py FOLDER_OF_THE_SCRIPTS; exit code 77 without numpy."""
import sys
from math import cos, cosh, pi, sin, sqrt, tanh

sys.path.insert(0, sys.argv[1])
try:
    import numpy as np
except ImportError:
    print("skipped: python3 has no numpy")
    sys.exit(77)
import potential  # noqa: E402
from evaluate import HIGH_FILL_CRESTS  # noqa: E402
from theory import G, WATER  # noqa: E402

failures = 0


def near(name, value, wanted, error):
    global failures
    if not abs(value - wanted) <= error:
        print(f"FAILED: {name} is {value:.6g}, not {wanted:.6g} +- {error:.2g}")
        failures += 1


def nothing(t):
    return 0.0


def standing_wave():
    """A period of a wave of 0.1 mm in a tank of 1 x 0.5 m, and its pressure at the wall."""
    a, k, depth = 1e-4, pi, 0.5
    period = 2 * pi / sqrt(G * k * tanh(k * depth))
    tank = potential.Tank(1.0, depth, nothing, nothing, points=16)
    tank.y = depth + a * np.cos(k * tank.x)
    for _ in range(200):
        tank.step(period / 200)
    near("height after a period", (tank.y[0] - depth) / a, 1, 2e-3)
    near("height at the other wall", (tank.y[-1] - depth) / a, -1, 2e-3)
    wave = (tank.left_wall_pressures([0.1])[0] - WATER * G * (depth - 0.1)) / (WATER * G * a)
    near("its pressure", wave, cosh(0.1 * k) / cosh(depth * k), 2e-3)


def steep_wave():
    """x = -5 mm (1 - cos 6.85 t) of the tank of 0.6 x 0.3 m. The work of the walls is -a times the momentum in the tank."""
    a, w, dt = 5e-3, 6.85, 0.005
    tank = potential.Tank(0.6, 0.3, lambda t: -a * w * sin(w * t), lambda t: -a * w * w * cos(w * t), 32)
    work, momentum, heights = 0.0, tank.bulk()[1], []
    while tank.t < 5.1:
        tank.step(dt)
        before, momentum = momentum, tank.bulk()[1]
        work -= tank.acceleration(tank.t - 0.5 * dt) * dt * 0.5 * (before + momentum)
        heights.append((tank.t, np.interp(0.58, tank.x, tank.y) - 0.3))
    near("volume", tank.volume(), 0.6 * 0.3, 1e-5)
    kinetic, momentum, potential_energy = tank.bulk()
    near("energy less work [J/m]", kinetic + potential_energy - work, 0, 0.02)
    t, y = np.array(heights).T
    for at, crest in HIGH_FILL_CRESTS:  # by 28 modes, another program
        near(f"crest at {at} s", y[abs(t - at) < 0.1].max(), crest, 3e-4)


standing_wave()
steep_wave()
sys.exit(failures > 0)
