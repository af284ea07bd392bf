# SPDX-License-Identifier: BSD-3-Clause
"""Coupling from Python, and random calls."""
from __future__ import annotations

import copy
import ctypes
import inspect
import os
import random
import tempfile
import unittest
import warnings
from typing import Any

import mps
import numpy as np


def full_box(dp: float = 0.05) -> mps.Simulation:
    sim = mps.Simulation(dp=dp)
    sim.tank(size=(0.8, 0.5))
    sim.fill_level(lo=(0, 0), hi=(0.8, 0.5))
    sim.time_control(dt=1e-3)
    return sim


class Coupled(unittest.TestCase):
    def test_snapshot(self) -> None:
        sim = mps.Simulation(dp=0.05)
        sim.tank(size=(1.0, 0.6))
        sim.fill_level(lo=(0, 0), hi=(1.0, 0.3))
        sim.time_control(dt=2e-3)
        for _ in range(3):
            sim.step()
        with sim.snapshot() as before:
            found = []
            for _ in range(3):
                sim.pose_to(sim.t + 4e-3, {"x": (1e-4, 0.05, 0.0)})
                sim.run(sim.t + 4e-3)
                found.append(sim["position"].tobytes())
                before.restore()
            self.assertEqual(len(set(found)), 1)
            self.assertEqual(sim.steps, 3)
        with self.assertRaises(mps.StateError):
            mps.Snapshot(sim).restore()  # nothing was taken

    def test_added_mass_of_a_full_box(self) -> None:
        """All of the liquid moves with a full box: 400 kg/m."""
        sim = full_box()
        sim.watch_load(mass=True)
        sim.pose_to(1e-3, {"x": 1e-6})
        sim.step(1e-3)
        load = sim.load()
        self.assertEqual(load.has_mass, 1)
        self.assertAlmostEqual(load.mass[0, 0] / 400, 1, delta=1e-4)
        self.assertAlmostEqual(load.mass[1, 1] / 400, 1, delta=1e-4)
        self.assertAlmostEqual(load.rest[1] / (-400 * 9.81), 1, delta=1e-3)
        with self.assertRaises(mps.ArgumentError):
            sim.load(centre=(np.nan, 0))

    def test_records(self) -> None:
        """An entry is read once, at its first access, and does not change with later steps."""
        sim = full_box()
        sim.watch_load(mass=True)
        info = sim.step(1e-3)
        load, kept = sim.load(), copy.copy(info)
        self.assertIsInstance(load, mps.Record)
        self.assertEqual((load.mass.shape, load.rest.shape, load.mass.dtype), ((6, 6), (6,), np.float64))
        self.assertIs(load.mass, load.mass)
        before = load.mass.copy()
        limit = info.limit
        sim.step(1e-3)
        np.testing.assert_array_equal(load.mass, before)
        self.assertIsInstance(limit, str)
        self.assertEqual((kept.t, kept.limit, info.t), (info.t, limit, 1e-3))
        self.assertIn("crossing_time", dir(info))
        self.assertEqual(dict(info)["step"], 1)
        self.assertFalse(hasattr(info, "struct_size"))
        with self.assertRaisesRegex(AttributeError, "no entry 'tt'; there are ppe_iterations, step, t, "):
            _ = info.tt

    def test_body(self) -> None:
        """A box of 100 kg/m on a spring, pushed: its own equation, with the load of its liquid."""
        sim, seen = full_box(), []

        def push(t: float, state: mps.Record) -> dict[str, float]:
            seen.append((t, state.value[0]))
            return {"x": 50.0}

        sim.body("x", mass=100.0, stiffness={"x": 2000.0}, gravity=False, load=push)
        sim.run(0.02)
        body = sim.body_report
        self.assertAlmostEqual(body.mass[0, 0] / 400, 1, delta=1e-4)
        self.assertAlmostEqual(body.acceleration[0], 0.1, delta=0.01)  # 50/(100 + 400)
        self.assertAlmostEqual(100 * body.acceleration[0] / (50 + body.liquid[0] + body.restoring[0]), 1, delta=1e-9)
        self.assertEqual(len(seen), sim.steps)
        self.assertEqual(body.external[0], 50.0)
        self.assertGreater(seen[-1][1], 0.0)
        other = full_box()
        other.motion_centre((0.4, 0.25))
        other.body(("x", "rotate_z"), mass=100.0, inertia=5.0, centre_of_mass=(0.4, 0.25), stiffness=np.diag([2000.0, 0, 0, 0, 0, 300.0]),
                   damping={"rotate_z": 2.0}, equilibrium={"x": 1e-3})
        other.run(0.01)
        # the spring of 2 N/m at 1 mm pulls 500 kg/m there
        self.assertAlmostEqual(other.body_report.pose[0] / (0.5 * 2.0 / 500.0 * 0.01 ** 2), 1, delta=0.1)
        self.assertEqual(other.body_report.pose[1], 0.0)

    def test_body_refused(self) -> None:
        sim = full_box()
        with self.assertRaisesRegex(mps.ArgumentError, "mass"):
            sim.body("x", mass=-1.0)
        with self.assertRaisesRegex(mps.UnknownName, "heave"):
            sim.body("heave", mass=1.0)
        with self.assertRaisesRegex(mps.ArgumentError, r"\[6, 6\]"):
            sim.body("x", mass=1.0, stiffness=np.zeros((3, 3)))
        with self.assertRaisesRegex(mps.ArgumentError, "inertia"):
            sim.body("rotate_z", inertia=(1.0, 2.0))
        with self.assertRaises(mps.StateError):
            sim.body_report  # noqa: B018: there is no body

        def fails(t: float, state: mps.Record) -> list[float]:
            raise KeyError("mine")

        sim.body("x", mass=1.0, load=fails)
        with self.assertRaises(mps.PluginError) as failed:
            sim.step()
        self.assertIsInstance(failed.exception.__cause__, KeyError)
        self.assertEqual(sim.steps, 0)
        sim.body("x", mass=1.0, load=lambda t, state: [1.0])
        with self.assertRaises(mps.PluginError) as failed:
            sim.step()
        self.assertIn("six", str(failed.exception.__cause__))
        sim.body("x", mass=100.0)
        sim.step()
        self.assertEqual(sim.steps, 1)

    def test_refused(self) -> None:
        sim = full_box()
        with self.assertRaises(mps.StateError):
            sim.load()
        with self.assertRaises(mps.ArgumentError):
            sim.pose_to(-1.0, {"x": 0.0})
        with self.assertRaises(mps.UnknownName):
            sim.pose_to(1.0, {"surge": 0.0})


class Calls(unittest.TestCase):
    """Random calls, right and wrong, of simulations and of what they return, also within callbacks: they return, or fail with an exception.
    MPS_RANDOM_CALLS of them, by default 1000; MPS_RANDOM_SEED."""

    NUMBERS = [0, 1, -1, 2, 3, 0.05, 1e-3, 1e300, -1e300, float("nan"), float("inf"), 2**31, -(2**31), 2**63]
    TEXTS = ["", "x", "position", "velocity", "id", "imps", "gas.pocket", "collision", "distance", "no such name", "a" * 4000, "%s%n", "\0", "out", "P1"]
    ALLOWED = (mps.Error, TypeError, ValueError, OverflowError, ctypes.ArgumentError, AttributeError, KeyError, IndexError, RuntimeError,
               ZeroDivisionError)

    def draw(self, r: random.Random) -> Any:
        pick = r.random()
        if pick < 0.4:
            return r.choice(self.NUMBERS)
        if pick < 0.65:
            return r.choice(self.TEXTS)
        if pick < 0.8:
            return [r.choice(self.NUMBERS) for _ in range(r.choice([0, 1, 2, 3, 4, 7]))]
        if pick < 0.9:
            return lambda *a: self.callback(r)
        return r.choice([None, {}, {"x": 0.1}, {"dof": "x", "amplitude": 0.01, "omega": 3.0}, lambda *a: 0, np.zeros((3, 2)), (0.1, 0.1), (0.3, 0.5)])

    def callback(self, r: random.Random) -> Any:
        """What a function of the user does: a call of its own, at times."""
        self.depth += 1
        try:
            if self.depth < 3 and r.random() < 0.3:
                self.one(r)
        finally:
            self.depth -= 1
        return r.choice([0, 1, True, None, 0.5, float("nan"), "text", [0.0] * 6])

    def simulation(self) -> mps.Simulation:
        sim = mps.Simulation(dp=0.1, log=lambda *_: None)
        sim.tank(size=(1.0, 0.6))
        sim.fill_level(lo=(0, 0), hi=(1.0, 0.3))
        return sim

    def arguments(self, one: Any, name: str, r: random.Random) -> list[Any]:
        places = [p for p in inspect.signature(getattr(one, name)).parameters.values() if p.kind <= p.POSITIONAL_OR_KEYWORD]
        least = sum(p.default is p.empty for p in places)
        given = [self.draw(r) for _ in range(r.randint(0, 3) if r.random() < 0.1 else r.randint(least, len(places)))]
        if isinstance(one, mps.Simulation):
            if name == "run":
                given[:1] = [one.t + 0.005]
            if name == "probe":
                given = [r.choice(["wall_pressure", "gauge", "force", "x"]), (0, 0.1)]
            if name in ("read", "write") and r.random() < 0.7:
                given = [r.choice(["position", "velocity", "id", "kind"])]
            if name == "threads":
                given = [r.choice([1, 2, 0, -1])]
            if name in ("tank", "stl", "frames", "checkpoint", "restore"):
                given = [r.choice(["out", "", "no/such"])] if name != "tank" else given[:1]
        return given

    def one(self, r: random.Random) -> None:
        """A call of one object of the pool; what it returns comes into the pool."""
        target = self.pool[0] if r.random() < 0.6 else r.choice(self.pool)
        names = [n for n in dir(target) if not n.startswith("_") and n not in ("adopt", "check", "failure", "sweep", "handle")]
        name = r.choice(names)
        if name == "close" and r.random() < 0.8:
            return
        value = getattr(target, name)
        if not callable(value) or (name == "remove" and r.random() < 0.8):
            return
        found = value(*self.arguments(target, name, r))
        if isinstance(found, (mps.Frames, mps.Snapshot, mps.Lease, mps.Probe)):
            self.pool.append(found)
            del self.pool[1:-7]

    def test_random_calls(self) -> None:
        r = random.Random(int(os.environ.get("MPS_RANDOM_SEED", "7")))
        count = int(os.environ.get("MPS_RANDOM_CALLS", "1000"))
        failed = self.depth = 0
        self.pool: list[Any] = []
        home = os.getcwd()
        with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            os.chdir(folder)
            os.mkdir("out")
            try:
                for k in range(count):
                    if k % 50 == 0 or self.pool[0].closed:
                        self.pool[:1] = [self.simulation()]
                    try:
                        self.one(r)
                    except self.ALLOWED:
                        failed += 1
            finally:
                self.pool.clear()
                os.chdir(home)
        self.assertTrue(0.3 * count < failed < 0.99 * count, failed)


if __name__ == "__main__":
    unittest.main()
