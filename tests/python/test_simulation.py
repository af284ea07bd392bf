# SPDX-License-Identifier: BSD-3-Clause
"""Simulations from Python: the library's values, its errors, functions of the user."""
from __future__ import annotations

import gc
import math
import tempfile
import unittest
import warnings
from pathlib import Path

import mps
import numpy as np


def still(dp: float = 0.05, **config: object) -> mps.Simulation:
    sim = mps.Simulation(dp=dp, **config)
    sim.tank(size=(1.0, 0.6))
    sim.fill_level(lo=(0, 0), hi=(1.0, 0.3))
    return sim


class Running(unittest.TestCase):
    def test_hydrostatic(self) -> None:
        sim = still()
        wall = sim.probe("wall_pressure", at=(0, 0.1), rate=200, average=0)
        self.assertTrue(sim.run(0.2))
        t, p = wall.series()
        self.assertEqual(len(t), 41)
        self.assertAlmostEqual(sim.t, 0.2, delta=1e-12)
        self.assertAlmostEqual(p[-1, 0] / (9810 * 0.2), 1, delta=0.02)
        self.assertEqual(wall.info.part, "tank.x0")
        force = sim.probe("force", part="tank.y0", average=0)
        self.assertAlmostEqual(force.read()[1] / (-9810 * 0.3), 1, delta=0.05)
        with self.assertRaises(mps.Error):
            force.series()  # it keeps none

    def test_same_bytes_for_any_threads(self) -> None:
        found = []
        for threads in (1, 2):
            sim = still(threads=threads)
            sim.move_harmonic({"dof": "x", "amplitude": 0.05, "omega": 5.0})
            sim.run(0.2)
            found.append(sim["position"].tobytes())
        self.assertEqual(*found)

    def test_motions_agree(self) -> None:
        a, w = 0.02, 6.0
        times = np.linspace(0, 0.5, 501)

        def swing(t: float, state: mps.State) -> None:
            state.set("x", a * math.sin(w * t), a * w * math.cos(w * t), -a * w * w * math.sin(w * t))

        sims = [still() for _ in range(3)]
        sims[0].move_harmonic(dof="x", amplitude=a, omega=w)
        sims[1].move_by(swing)
        sims[2].move_table(times, x=a * np.sin(w * times))
        for sim in sims:
            sim.time_control(dt=2e-3)
            sim.run(0.3)
        ref = sims[0]["position"]
        self.assertLess(abs(sims[1]["position"] - ref).max(), 1e-9)
        self.assertLess(abs(sims[2]["position"] - ref).max(), 1e-3)
        self.assertAlmostEqual(sims[1].pose.value[0], a * math.sin(w * 0.3), places=12)
        self.assertAlmostEqual(sims[0].pose_at(0.1).value[0], a * math.sin(w * 0.1), places=12)
        lab, velocity = sims[1].to_lab((0.0, 0.1))
        self.assertAlmostEqual(lab[0], a * math.sin(w * 0.3), places=12)
        self.assertAlmostEqual(velocity[0], a * w * math.cos(w * 0.3), places=9)

    def test_monitor_and_checkpoint(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            one = still()
            path = str(Path(folder) / "state")
            seen: list[float] = []

            def watch(sim: mps.Simulation, info: mps.Record) -> bool:
                seen.append(info.t)
                if len(seen) == 5:
                    sim.checkpoint(path)
                return len(seen) == 8

            self.assertFalse(one.run(1.0, watch))
            self.assertEqual(len(seen), 8)
            two = still()
            two.restore(path)
            self.assertEqual(two.t, seen[4])
            while two.steps < one.steps:
                two.step()
            self.assertEqual(two["position"].tobytes(), one["position"].tobytes())
            with one.frames(folder) as frames:
                frames.write()
            self.assertTrue((Path(folder) / "frames.pvd").exists())

    def test_exception_in_callback(self) -> None:
        sim = still()

        def stop(_sim: mps.Simulation, _info: mps.Record) -> None:
            raise RuntimeError("mine")

        with self.assertRaisesRegex(RuntimeError, "mine"):
            sim.run(1.0, stop)
        self.assertEqual(sim.steps, 1)

        def move(t: float, _state: mps.State) -> None:
            if t > 0:
                raise ValueError("no such pose")

        sim = still()
        sim.move_by(move)
        with self.assertRaises(mps.PluginError) as caught:
            sim.step()
        self.assertIsInstance(caught.exception.__cause__, ValueError)
        self.assertEqual(sim.steps, 0)


class Setting(unittest.TestCase):
    def test_models_and_phases(self) -> None:
        sim = mps.Simulation(dp=0.05, preset="mmps")
        sim.phase(1, density=1.2, viscosity=1.8e-5)
        sim.set("gas", "sound", 300)
        self.assertEqual(sim.get("gas", "sound"), 300)
        self.assertIn("gas.compressible", sim.models)
        sim.remove("tension")
        self.assertFalse([m for m in sim.models if m.startswith("tension")])
        self.assertIn("gas.isentropic", dict(mps.catalogue(sim)))

    def test_errors(self) -> None:
        sim = still()
        with self.assertRaisesRegex(mps.UnknownName, "gas.pocket"):
            sim.use("gas.poket")
        with self.assertRaisesRegex(mps.ArgumentError, "allowed are .*open_top"):
            sim.tank(size=(1, 1), opentop=True)
        with self.assertRaisesRegex(mps.ArgumentError, "dp"):
            mps.Simulation(dp=-1)
        with self.assertRaisesRegex(mps.UnknownName, "rotate_z"):
            sim.move_harmonic({"dof": "roll"})
        with self.assertRaisesRegex(mps.ArgumentError, "unknown entry 'amplitud'; allowed are .*amplitude"):
            sim.move_harmonic(dof="x", amplitud=0.1)
        with self.assertRaisesRegex(mps.ArgumentError, "no motion is given"):
            sim.move_harmonic()
        with self.assertRaisesRegex(mps.ArgumentError, "no column is given"):
            sim.move_table([0, 1])
        for call, why in ((lambda: sim.step("x"), "dt_max: 'x' is no number"), (lambda: sim.run(None), "t_end: None is no number"),
                          (lambda: sim.threads(2**32 + 1), "threads: 4294967297 does not fit into 32 bits"),
                          (lambda: sim.phase(2**32), "phase: 4294967296 does not fit"), (lambda: sim.phase(0.5), "phase: 0.5 is no whole number"),
                          (lambda: sim.phase(0, density="heavy"), "density: 'heavy' is no number"),
                          (lambda: mps.Simulation(dp=0.05, dim=2**32 + 2), "dim: 4294967298 does not fit"), (lambda: sim.use("gas\0"), "character 0"),
                          (lambda: sim.read("velocity\0x"), "character 0"), (lambda: sim.add_field("mine", 2**40), "components: .* does not fit")):
            with self.assertRaisesRegex(mps.ArgumentError, why):
                call()
        with self.assertRaisesRegex(mps.ArgumentError, "one length"):
            sim.move_table([0, 1], {"x": [0, 1, 2]})
        with self.assertRaisesRegex(mps.ArgumentError, "at most 3"):
            sim.probe("gauge", at=(0, 0, 0, 0))
        with self.assertRaises(mps.Error) as caught:
            sim.step(-1.0)
        self.assertEqual(caught.exception.status, mps.MPS_E_ARG)

    def test_warnings_of_the_library(self) -> None:
        with self.assertWarnsRegex(UserWarning, "rounded to 1 m"):
            sim = mps.Simulation(dp=0.05)
            sim.tank(size=(1.0, 0.6))
            sim.tank(size=(1.02, 0.6), lo=(3, 0), name="second")
        said: list[str] = []
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            sim = mps.Simulation(dp=0.05, log=lambda _level, text: said.append(text))
            sim.tank(size=(1.02, 0.6))
        self.assertTrue(said)

    def test_shapes(self) -> None:
        sim = mps.Simulation(dp=0.05)
        np.testing.assert_allclose(sim.tank(size=(1.0, 0.6)), [1.0, 0.6], rtol=1e-12)
        self.assertEqual(sim.baffle("wall", (0.5, 0), (0.5, 0.3)).shape, (2, 2))
        sim.plate("blade", (0.2, 0.2), (0.2, 0.1))
        before = sim.count()

        def half(x: np.ndarray) -> bool:
            if x[0] > 0.45:
                raise ZeroDivisionError
            return x[1] < 0.1

        with self.assertRaises(ZeroDivisionError):
            sim.fill(half)
        self.assertEqual(sim.count(), before)
        n = sim.fill(lambda x: x[1] < 0.13)
        self.assertEqual(sim.count(mps.MPS_FLUID), n)
        solid = mps.Simulation(dp=0.05)
        solid.tank(size=(1.0, 1.0))
        solid.solid(lambda x: float(np.hypot(x[0] - 0.5, x[1] - 0.5) - 0.2), (0.3, 0.3), (0.7, 0.7), name="ball")
        self.assertGreater(np.count_nonzero(solid["kind"] == mps.MPS_WALL), 80)


class Arrays(unittest.TestCase):
    def test_lease(self) -> None:
        sim = still()
        with sim.read("position") as x:
            self.assertEqual(x.shape, (sim.count(), 2))
            with self.assertRaises(ValueError):
                x[0] = 1
            with self.assertRaises(mps.BusyError):
                sim.step()
        with sim.write("velocity") as u:
            u[sim.fluid] = (0.1, 0)
        self.assertAlmostEqual(sim["velocity"][sim.fluid, 0].min(), 0.1)
        before = sim["velocity"]
        with self.assertRaisesRegex(mps.ArgumentError, "finite"):
            sim["velocity"] = math.nan
        np.testing.assert_array_equal(sim["velocity"], before)
        with self.assertRaises(KeyError), sim.write("velocity") as u:
            u[:] = 7
            raise KeyError
        np.testing.assert_array_equal(sim["velocity"], before)
        sim.add_field("colour", 1)
        sim["colour"] = sim["position"][:, 0]
        sim.step()
        self.assertEqual(sim["colour"].shape, (sim.count(),))

    def test_particles(self) -> None:
        sim = still()
        n = sim.count(mps.MPS_FLUID)
        ids = sim.add_particles([(0.3, 0.5), (0.4, 0.5)], velocity=[(0, -1), (0, -1)])
        self.assertEqual(sim.count(mps.MPS_FLUID), n + 2)
        with self.assertRaises(mps.ArgumentError):
            sim.add_particles([(0.3, 0.5)])  # in the way
        with self.assertRaisesRegex(mps.ArgumentError, "rows"):
            sim.add_particles([(0.3, 0.55)], velocity=[(0, 0), (0, 0)])
        sim.remove_particles(ids)
        self.assertEqual(sim.count(mps.MPS_FLUID), n)

    def test_life(self) -> None:
        sim = still()
        sim.close()
        with still() as other:
            other.step()
        for _ in range(20):
            still()
        gc.collect()


if __name__ == "__main__":
    unittest.main()
