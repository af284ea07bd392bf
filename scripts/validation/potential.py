# SPDX-License-Identifier: BSD-3-Clause
"""Fully nonlinear potential flow in a rectangular tank that surges, by boundary integrals.

The surface is a row of points that move with the liquid (mixed Eulerian-Lagrangian). In the tank, with its acceleration a along x,
    d(phi)/dt = |grad phi|^2/2 - g (y - depth) - a x   at a point of the surface,   no flow through walls and floor.
Mirrored at the left wall and at the floor the flow is periodic over two lengths, and w = u - i v is analytic between the surface and its
image. With z(xi) along the surface, f = w dz/dxi = d(phi + i psi)/dxi, k = pi/(2 length) and z0 on the surface, Cauchy's integral is
    i pi f0 = dz0/dxi ( -PV int f k cot k(z - z0) dxi + int conj(f) k cot k(conj(z) - z0) dxi ).
Its imaginary part is an equation of the second kind for d(psi)/dxi. Sums over points of equal xi are spectrally accurate.

x in the forcing is a sum of `modes` cosines: x itself has a kink at the walls, where the exact flow is singular at the contact line.
tests/cases/test_potential.py checks linear waves, volume and energy."""
from functools import lru_cache
from math import cos, pi, sin

import numpy as np

from theory import G, WATER

REGRID = 5  # steps from one even spacing of the points to the next


class Tank:
    """Liquid at rest in the lab at t = 0, when the tank begins to move with velocity(t). Points 0 .. `points` go from the left wall to the right."""

    def __init__(self, length, depth, velocity, acceleration, points=40, modes=24):
        self.length, self.depth, self.velocity, self.acceleration = length, depth, velocity, acceleration
        self.points, self.k, self.t, self.count = points, pi / (2 * length), 0.0, 0
        self.odd = np.arange(1, modes + 1, 2)
        self.x = length * np.arange(points + 1) / points
        self.y = np.full(points + 1, float(depth))
        self.phi = -velocity(0) * self.smooth_x(self.x)

    def smooth_x(self, x):
        cosines = np.cos(np.outer(x, self.odd) * pi / self.length) / self.odd**2
        return self.length / 2 - 4 * self.length / pi**2 * cosines.sum(axis=1)

    def even(self, f):
        """With its mirror image: a period."""
        return np.concatenate([f, f[-2:0:-1]])

    def grid(self):
        """x of points at equal distances, over a period."""
        return self.length * np.arange(2 * self.points) / self.points

    def whole_x(self, x):
        return np.concatenate([x, 2 * self.length - x[-2:0:-1]])

    def slope(self, f):
        """Derivative of a periodic function of xi."""
        spectrum = np.fft.rfft(f) * 1j * pi / self.points * np.arange(self.points + 1)
        spectrum[-1] = 0
        return np.fft.irfft(spectrum, 2 * self.points)

    def kernels(self, x, y):
        """z and its derivative, and both kernels times that of the target (row), with the limit of the first on the diagonal."""
        along, up = self.whole_x(x), self.even(y)
        z = along + 1j * up
        first = self.slope(along - self.grid()) + self.length / self.points + 1j * self.slope(up)
        second = self.slope(first.real - self.length / self.points) + 1j * self.slope(first.imag)
        apart = z[None, :] - z[:, None]
        np.fill_diagonal(apart, self.length)
        direct = self.k / np.tan(self.k * apart) * first[:, None]
        np.fill_diagonal(direct, -0.5 * second / first)
        image = self.k / np.tan(self.k * (np.conj(z)[None, :] - z[:, None])) * first[:, None]
        return z, first, direct, image

    def conjugate(self, kernels, f):
        """Derivatives by xi of a harmonic function f, given on the surface, and of its conjugate."""
        _, _, direct, image = kernels
        df = self.slope(self.even(f))
        known = (direct.real - image.real) @ df + self.slope(df)
        return df, np.linalg.solve(pi * np.eye(len(df)) + direct.imag + image.imag, known)

    def rates(self, t, x, y, phi):
        kernels = self.kernels(x, y)
        df, dpsi = self.conjugate(kernels, phi)
        w = ((df + 1j * dpsi) / kernels[1])[: self.points + 1]
        w[0], w[-1] = 1j * w[0].imag, 1j * w[-1].imag
        return w.real, -w.imag, 0.5 * np.abs(w) ** 2 + self.force(t, x, y)

    def force(self, t, x, y):
        """Potential of gravity and of the tank's acceleration at the surface, with the sign of d(phi)/dt."""
        return -G * (y - self.depth) - self.acceleration(t) * self.smooth_x(x)

    def filtered(self, f):
        """Without the shortest waves, which the nonlinear terms would fold back."""
        spectrum = np.fft.rfft(f) * np.exp(-0.5 * (np.arange(self.points + 1) / self.points) ** 12)
        return np.fft.irfft(spectrum, 2 * self.points)

    def state(self):
        """Periodic functions of xi that say all: x less its mean slope, y, phi."""
        return self.whole_x(self.x) - self.grid(), self.even(self.y), self.even(self.phi)

    def regrid(self):
        """Points at equal distances along the surface again, by their Fourier series."""
        n = self.points
        fine = np.linspace(0, n, 16 * n + 1)
        wave = np.exp(1j * pi / n * np.outer(fine, np.arange(-n + 1, n)))
        spectra = [np.fft.fftshift(np.fft.fft(f))[1:] / (2 * n) for f in self.state()]
        x, y = ((wave @ s).real for s in spectra[:2])
        steps = np.hypot(np.diff(x + self.length * fine / n), np.diff(y))
        length = np.concatenate([[0], np.cumsum(steps)])
        xi = np.interp(np.linspace(0, length[-1], n + 1), length, fine)
        wave = np.exp(1j * pi / n * np.outer(xi, np.arange(-n + 1, n)))
        self.x, self.y, self.phi = ((wave @ s).real for s in spectra)
        self.x += self.length * xi / n
        self.x[0], self.x[-1] = 0, self.length

    def step(self, dt):
        """Runge-Kutta of fourth order."""
        if self.count % REGRID == 0:
            self.regrid()
        start, k = (self.x, self.y, self.phi), []
        for c in (0, 0.5, 0.5, 1):
            k.append(self.rates(self.t + c * dt, *(s + c * dt * r for s, r in zip(start, k[-1])) if k else start))
        self.x, self.y, self.phi = (s + dt / 6 * (a + 2 * b + 2 * c + d) for s, a, b, c, d in zip(start, *k))
        x, y, phi = (self.filtered(f)[: self.points + 1] for f in self.state())
        self.x, self.y, self.phi = x + self.grid()[: self.points + 1], y, phi
        self.t, self.count = self.t + dt, self.count + 1
        if not np.abs(self.y - self.depth).max() < 2 * self.depth:
            raise FloatingPointError(f"potential flow: the surface breaks up at t = {self.t:.3f} s; use shorter steps or fewer points")

    def integral(self, f):
        """Over xi, from wall to wall."""
        return f[: self.points + 1].sum() - 0.5 * (f[0] + f[self.points])

    def volume(self):
        """[m2]"""
        z, first, _, _ = self.kernels(self.x, self.y)
        return self.integral(z.imag * first.real)

    def bulk(self):
        """Kinetic energy [J/m] and momentum along x [kg/s a metre of width] relative to the tank, and potential energy above the still level.
        Momentum is the flux through the surface, -d(psi), times x."""
        kernels = self.kernels(self.x, self.y)
        z, first, _, _ = kernels
        _, dpsi = self.conjugate(kernels, self.phi)
        return (-0.5 * WATER * self.integral(self.even(self.phi) * dpsi), -WATER * self.integral(z.real * dpsi),
                0.5 * WATER * G * self.integral((z.imag - self.depth) ** 2 * first.real))

    def lab_energy(self):
        """Kinetic and potential energy in the lab, less that at rest [J/m]."""
        kinetic, momentum, potential = self.bulk()
        v = self.velocity(self.t)
        return kinetic + potential + v * momentum + 0.5 * WATER * self.length * self.depth * v * v

    def left_wall_pressures(self, heights):
        """[Pa] at heights above the floor, from phi and d(phi)/dt there by Cauchy's integral."""
        kernels = self.kernels(self.x, self.y)
        z, first, _, _ = kernels
        df, dpsi = self.conjugate(kernels, self.phi)
        f = df + 1j * dpsi
        rate = -0.5 * np.abs(f / first)[: self.points + 1] ** 2 + self.force(self.t, self.x, self.y)
        _, dpsi = self.conjugate(kernels, rate)
        spectrum = np.fft.rfft(dpsi)
        spectrum[1:] /= 1j * pi / self.points * np.arange(1, self.points + 1)
        spectrum[0] = 0
        whole = (self.even(rate) + 1j * np.fft.irfft(spectrum, 2 * self.points)) * first
        pressures = []
        for y in heights:
            direct, image = self.k / np.tan(self.k * (z - 1j * y)), self.k / np.tan(self.k * (np.conj(z) - 1j * y))
            of_rate, w = (np.sum(np.conj(g) * image - g * direct) / (2j * pi) for g in (whole, f))
            pressures.append(-WATER * (of_rate.real + 0.5 * abs(w) ** 2 + G * (y - self.depth)))
        return pressures


class Flow:
    """Series of a tank to the time `end`: t [s]; x and y [m] of the surface; p [Pa] at the left wall, one row a height; energy [J/m] of the liquid
    in the lab, less that at rest."""

    def __init__(self, tank, end, dt, sensors):
        rows = []
        while tank.t < end - 0.5 * dt:
            tank.step(dt)
            rows.append((tank.t, tank.x, tank.y - tank.depth, tank.left_wall_pressures(sensors), tank.lab_energy()))
        self.t, self.x, self.y, pressures, self.energy = (np.array(column) for column in zip(*rows))
        self.p = pressures.T

    def height(self, x):
        """Above the still level, at a place."""
        return np.array([np.interp(x, *row) for row in zip(self.x, self.y)])


@lru_cache
def half_full(amplitude, end):
    """The tank of 0.6 m with 0.3 m of water, x = -amplitude (1 - cos 6.85 t); P1."""
    w = 6.85
    tank = Tank(0.6, 0.3, lambda t: -amplitude * w * sin(w * t), lambda t: -amplitude * w * w * cos(w * t), 32)
    return Flow(tank, end, 0.005, [0.02])


@lru_cache
def surge_tank():
    """The tank of 0.8 m with 0.25 m of water, x = 0.02 m sin 6.469 t; P1 to P3."""
    a, w = 0.02, 6.469
    tank = Tank(0.8, 0.25, lambda t: a * w * cos(w * t), lambda t: -a * w * w * sin(w * t), 48)
    return Flow(tank, 4.6, 0.003, [0.05, 0.10, 0.15])
