# SPDX-License-Identifier: BSD-3-Clause
"""The tank of coupled_box.py as a rigid body of the library: 50 kg/m, free to move along x, released
with a tilted surface. The library solves its motion together with the liquid. Linear theory:
7.510 rad/s for this tank, 5.389 rad/s for a fixed tank."""
import math

import mps
import numpy as np

M, DT = 50.0, 2e-3  # mass [kg/m], step [s]
sim = mps.Simulation(dp=0.02)
sim.tank(size=(0.8, 0.5))
sim.fill(lambda x: x[1] < 0.25 + 0.04 * (x[0] - 0.4))
sim.time_control(dt=DT)
sim.body("x", mass=M)
t, velocity = [], []
while sim.t < 4.0:
    sim.run(sim.t + 5 * DT)
    t.append(sim.t)
    velocity.append(sim.body_report.velocity[0])
v = np.array(velocity)
up = np.flatnonzero((v[:-1] < 0) & (v[1:] >= 0))
cross = [t[k] - v[k] * (t[k + 1] - t[k]) / (v[k + 1] - v[k]) for k in up]
print(f"{2 * math.pi * (len(cross) - 1) / (cross[-1] - cross[0]):.3f} rad/s, largest speed {np.abs(v).max():.3f} m/s, "
      f"momentum of tank and particles {M * v[-1] + sim.momentum.total[0]:.3f} kg m/s of {M * np.abs(v).max():.2f}")
