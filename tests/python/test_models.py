# SPDX-License-Identifier: BSD-3-Clause
"""Models written in Python, and the operators on a cloud."""
from __future__ import annotations

import unittest

import mps
import numpy as np


class Drag(mps.Model):
    name = "porous.drag"
    help = "drag of a porous block"
    settings = [mps.Setting("rate", "1/s", "of the velocity", 0.0, 0.0, 1e4)]

    @mps.verb(mps.MPS_FORCE, velocity=mps.MPS_USE_READ, acceleration=mps.MPS_USE_CHANGE)
    def push(self, s: mps.Stage) -> None:
        s["acceleration"][s.fluid] -= s.setting["rate"] * s["velocity"][s.fluid]


class Mean(mps.Model):
    """The mean velocity of the neighbours, as a channel."""

    name = "mean.velocity"
    help = "mean velocity of the neighbours"
    channels = [mps.Channel("mean_velocity", "m/s", "mean of the neighbours", mps.MPS_VECTOR, mps.MPS_LIFE_PARTICLE)]

    @mps.verb(mps.MPS_PREPARE, velocity=mps.MPS_USE_NEIGHBOURS, mean_velocity=mps.MPS_USE_WRITE)
    def average(self, s: mps.Stage) -> None:
        p = s.near
        u = s["velocity"]
        total = p.sum(p.w[:, None] * u[p.j], s.n)
        s["mean_velocity"][...] = total / np.maximum(p.sum(p.w, s.n), 1e-300)[:, None]


class Wrong(mps.Model):
    name = "wrong.model"
    help = "fails"

    @mps.verb(mps.MPS_FORCE, velocity=mps.MPS_USE_READ)
    def fail(self, s: mps.Stage) -> None:
        raise ValueError("100 % wrong")


class Reader(mps.Model):
    name = "wrong.reader"
    help = "writes what it only reads"

    @mps.verb(mps.MPS_FORCE, velocity=mps.MPS_USE_READ)
    def fail(self, s: mps.Stage) -> None:
        s["velocity"][0] = 1


def column() -> mps.Simulation:
    sim = mps.Simulation(dp=0.05, gravity=(0, 0, 0))
    sim.tank(size=(1.0, 0.5))
    sim.fill_box((0.3, 0.1), (0.7, 0.4))
    sim.time_control(dt=1e-3)
    return sim


class Models(unittest.TestCase):
    def test_drag(self) -> None:
        """A block of liquid that nothing else slows down: u(t) = u(0) (1 - rate dt)^n, over what it keeps without drag."""
        kept = []
        for rate in (0.0, 20.0):
            sim = column()
            sim.use(Drag(), rate=rate)
            self.assertEqual(sim.get("porous", "rate"), rate)
            with sim.write("velocity") as u:
                u[sim.fluid] = (0.0, 0.2)
            for _ in range(20):
                sim.step()
            kept.append(sim["velocity"][sim.fluid, 1].mean())
        self.assertAlmostEqual(kept[1] / kept[0] / (1 - 20 * 1e-3) ** 20, 1, delta=2e-3)

    def test_channel_and_pairs(self) -> None:
        sim = column()
        sim.use(Mean())
        with sim.write("velocity") as u:
            u[sim.fluid] = (0.0, 0.1)
        sim.step()
        inner = sim.fluid & (abs(sim["position"][:, 0] - 0.5) < 0.06) & (abs(sim["position"][:, 1] - 0.25) < 0.06)
        self.assertGreater(inner.sum(), 0)
        np.testing.assert_allclose(sim["mean_velocity"][inner], [[0.0, 0.1]] * int(inner.sum()), atol=1e-9)

    def test_failing(self) -> None:
        sim = column()
        sim.use(Wrong())
        with self.assertRaisesRegex(mps.PluginError, "100 % wrong") as caught:
            sim.step()
        self.assertIsInstance(caught.exception.__cause__, ValueError)
        sim.remove("wrong")
        sim.step()
        sim.use(Reader())
        with self.assertRaises(mps.PluginError):
            sim.step()
        with self.assertRaises(mps.UnknownName):
            sim.use("no.model")


class Operators(unittest.TestCase):
    def setUp(self) -> None:
        k = np.arange(12) * 0.1
        self.x = np.stack(np.meshgrid(k, k), -1).reshape(-1, 2)
        self.cloud = mps.Cloud(self.x, 0.1)

    def test_linear_fields(self) -> None:
        b = self.cloud.correction()
        np.testing.assert_allclose(self.cloud.gradient(self.x @ [3.0, -2.0], b), [[3.0, -2.0]] * len(self.x), atol=1e-11)
        np.testing.assert_allclose(self.cloud.divergence(self.x * [1.0, 4.0], b), 5.0, atol=1e-11)

    def test_sums(self) -> None:
        p = self.cloud.pairs()
        np.testing.assert_allclose(p.sum(p.w, self.cloud.n), self.cloud.number_density(), rtol=1e-12)
        n0, lam = mps.lattice_constants(2, 0.1, 0.21)
        self.assertAlmostEqual(self.cloud.number_density().max(), n0, places=9)
        self.assertGreater(lam, 0)
        middle = np.abs(self.x - 0.55).max(axis=1) < 0.1
        lap = self.cloud.laplacian((self.x**2).sum(axis=1))
        np.testing.assert_allclose(lap[middle], 4.0, rtol=1e-9)

    def test_errors(self) -> None:
        with self.assertRaisesRegex(mps.ArgumentError, "numbers"):
            self.cloud.gradient([1.0, 2.0])
        with self.assertRaisesRegex(mps.ArgumentError, "shape"):
            mps.Cloud(np.zeros((4, 4)), 0.1)
        with self.assertRaises(mps.Error):
            mps.Cloud(self.x, -1)
        with self.assertRaisesRegex(mps.UnknownName, "improved"):
            mps.lattice_constants(2, 0.1, 0.2, "gauss")


if __name__ == "__main__":
    unittest.main()
