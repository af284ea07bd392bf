# SPDX-License-Identifier: BSD-3-Clause
"""A tank of 50 kg/m that is free to move along x, released with a tilted surface: two-way coupling
with the added mass of the liquid. Linear theory: 7.510 rad/s for this tank, 5.389 rad/s for a fixed
tank. In each step (M + A) a = F0, the load is F0 - A a."""
import math

import mps
import numpy as np

M, DT = 50.0, 2e-3  # mass [kg/m], step [s]
sim = mps.Simulation(dp=0.02)
sim.tank(size=(0.8, 0.5))
sim.fill(lambda x: x[1] < 0.25 + 0.04 * (x[0] - 0.4))
sim.time_control(dt=DT)
sim.watch_load(mass=True)
x = v = a = 0.0
before = sim.snapshot()
t, velocity = [], []
while sim.t < 4.0:
    before.take()
    # the load is linear in a: two trials are enough unless liquid separates from a wall
    for _ in range(4):
        sim.pose_to(sim.t + DT, {"x": x + (v + a * DT) * DT})
        sim.step(DT)
        load = sim.load()
        right = float(load.rest[0]) / (M + float(load.mass[0, 0]))
        if abs(right - a) < 1e-4:
            break
        before.restore()
        a = right
    v += a * DT
    x += v * DT
    t.append(sim.t)
    velocity.append(v)
up = [k for k in range(1, len(t)) if velocity[k - 1] < 0 <= velocity[k]]
total = M * v + sim.momentum.total[0]
print(f"{2 * math.pi * (len(up) - 1) / (t[up[-1]] - t[up[0]]):.3f} rad/s, largest speed {np.abs(velocity).max():.3f} m/s, "
      f"momentum of tank and particles {total:.3f} kg m/s of {M * np.abs(velocity).max():.2f}")
