# SPDX-License-Identifier: BSD-3-Clause
"""Linear and weakly nonlinear waves in a rectangular tank, still water."""
from math import cos, cosh, pi, sqrt, tanh

import numpy as np

G, WATER, VISCOSITY = 9.81, 1000.0, 1e-6  # [m/s2], [kg/m3], kinematic [m2/s]


def natural(k, h):
    """Angular frequency of a linear wave of number k over depth h."""
    return sqrt(G * k * tanh(k * h))


def standing_wave(k, h, a):
    """Angular frequency of a standing wave of amplitude a to third order at k h = pi/2."""
    return natural(k, h) * (1 - 0.0973 * (k * a) ** 2)


def viscous_decay(k, t):
    """Amplitude of a standing wave relative to its first, deep water, free of walls."""
    return np.exp(-2 * VISCOSITY * k * k * t)


class Surge:
    """Linear response to x = -a (1 - cos w t) of a tank of length L, depth h, at rest before."""

    def __init__(self, length, depth, amplitude, omega):
        self.length, self.depth, self.amplitude, self.omega = length, depth, amplitude, omega

    def acceleration(self, t):
        return -self.amplitude * self.omega**2 * np.cos(self.omega * t)

    def modes(self, t, count):
        """Wave number and coefficient of every odd mode cos(k x)."""
        for n in range(1, count, 2):
            k = n * pi / self.length
            wn = natural(k, self.depth)
            force = -4 / (n * pi) * tanh(k * self.depth) * self.amplitude * self.omega**2
            yield n, k, force / (wn**2 - self.omega**2) * (np.cos(self.omega * t) - np.cos(wn * t))

    def elevation(self, t, x):
        return sum(b * cos(k * x) for _, k, b in self.modes(t, 60))

    def left_wall_pressure(self, t, y):
        a = self.acceleration(t)
        p = WATER * (G * (self.depth - y) + a * self.length / 2)
        for n, k, b in self.modes(t, 200):
            p = p - WATER * (4 * self.length / (n * pi) ** 2 * a - G * b) * cosh(k * y) / cosh(k * self.depth)
        return p
