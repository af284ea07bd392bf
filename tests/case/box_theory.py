# SPDX-License-Identifier: BSD-3-Clause
"""Liquid of a rectangular tank in 2-D by linear theory, as masses on springs (Graham & Rodriguez 1952; Abramson, NASA SP-106, 1966).

Odd modes n of a box with length L and depth h, k = n pi/L: m_n = 8 m tanh(k h)/(n^3 pi^3 h/L), w_n^2 = g k tanh(k h), height above the floor
h (1 - tanh(k h/2)/(k h/2)). Loads are about the middle of the floor, axes of the lab, turns counterclockwise.
"""
from math import pi, sqrt, tanh

MODES = range(1, 400, 2)


class Box:
    def __init__(self, length, depth, density=1000.0, gravity=9.81):
        self.g, self.mass = gravity, density * length * depth
        self.modes = []
        for n in MODES:
            k = n * pi / length
            share = 8 * tanh(k * depth) / (pi * n) ** 3 * length / depth
            height = depth * (1 - tanh(k * depth / 2) / (k * depth / 2))
            self.modes.append((share * self.mass, gravity * k * tanh(k * depth), height))
        self.rest = self.mass - sum(m for m, _, _ in self.modes)
        self.rest_height = (self.mass * depth / 2 - sum(m * z for m, _, z in self.modes)) / self.rest
        a, b = max(length, depth), min(length, depth)
        series = sum(tanh(n * pi * a / 2 / b) / n**5 for n in range(1, 99, 2))
        torsion = a * b**3 * (1 / 3 - 64 / pi**5 * b / a * series)
        closed = density * (length * depth * (length**2 + depth**2) / 12 - torsion)
        self.rest_inertia = closed - self.rest * (self.rest_height - depth / 2) ** 2
        self.rest_inertia -= sum(m * (z - depth / 2) ** 2 for m, _, z in self.modes)
        self.omega1 = sqrt(self.modes[0][1])

    def load(self, omega, motion, damping=0.0, tuned=1.0):
        """Complex force along x and moment by a unit shift ("surge") or turn ("roll"), times e^(i omega t).
        damping: share of the critical one, of the first mode; tuned: its frequency over that of theory."""
        s, turn = omega**2, motion == "roll"
        force = -s * self.rest * self.rest_height - self.rest * self.g if turn else s * self.rest
        moment = s * (self.rest_inertia + self.rest * self.rest_height**2) + self.rest * self.g * self.rest_height
        if not turn:
            moment = -s * self.rest * self.rest_height
        for i, (m, w2, z) in enumerate(self.modes):
            if i == 0:
                w2 *= tuned**2
            spring = w2 + (2j * damping * sqrt(w2) * omega if i == 0 else 0)
            way = (-(s * z + self.g) if turn else s) / (spring - s)
            force += m * spring * way
            moment += -m * (z * spring + self.g) * way
        if turn:
            force += self.mass * self.g  # from axes of the tank to those of the lab
        return complex(force), complex(moment)

    def restoring(self):
        return -self.load(1e-6, "roll")[1].real

    def added(self, omega, load, motion):
        """A without restoring."""
        value = self.load(omega, motion)[load == "roll"].real
        if load == motion == "roll":
            value += self.restoring()
        return value / omega**2
