# SPDX-License-Identifier: BSD-3-Clause
"""Case files from Python, the layouts, and what is made from the headers."""
from __future__ import annotations

import ctypes
import gc
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import mps
import numpy as np
from mps import _layouts, _library, _structs

ROOT = Path(__file__).resolve().parent.parent.parent
TANK = {"mps": 1, "title": "small tank", "dp": "40 mm", "tank": {"size": "0.8 0.5 m"}, "fill": [{"water": {"depth": "0.2 m"}}],
        "motion": {"surge": {"amplitude": "20 mm", "omega": "6 rad/s"}}, "sensors": {"P1": {"wall": "0 40 mm"}},
        "run": {"until": "0.2 s"}, "output": {"frames": 2}}


class Cases(unittest.TestCase):
    def test_run(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            said: list[str] = []
            run = mps.Case(TANK, set={"run.until": "0.1 s"}).run(f"{folder}/a", say=lambda _k, text: said.append(text))
            self.assertAlmostEqual(run.columns["t"][-1], 0.1, delta=1e-9)
            self.assertGreater(run.columns["P1"].max(), 0)
            self.assertTrue(any("small" in s or "case" in s for s in said))
            self.assertIn("steps", run.summary)
            with self.assertRaisesRegex(mps.StateError, "^folder .*/a: there is an earlier run .*overwrite=True") as caught:
                mps.Case(TANK).run(f"{folder}/a", say=None)
            self.assertNotIn("--", str(caught.exception))
            with self.assertRaisesRegex(mps.Error, "resume: there is no run in") as caught:
                mps.Case(TANK).run(f"{folder}/none", say=None, resume=True)
            self.assertNotIn("--", str(caught.exception))
            file = Path(folder) / "tank.yaml"
            file.write_text(mps.Case(TANK).text)
            again = mps.Case(file, set={"run.until": "0.1 s"}).run(f"{folder}/b", say=None)
            np.testing.assert_array_equal(again.columns["P1"], run.columns["P1"])

    def test_own_steps(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            with mps.Case(TANK).build(f"{folder}/a", say=None) as job:
                job.simulation.step()
                self.assertEqual(job.simulation.steps, 1)
                self.assertGreater(job.simulation.count(mps.MPS_FLUID), 50)
            self.assertTrue(job.simulation.closed)

    def test_errors(self) -> None:
        with self.assertRaises(mps.CaseError) as caught:
            mps.Case.parse("mps: 1\ndp: 4\ntnk: {size: 1 1 m}\n", "mine.yaml")
        text = str(caught.exception)
        self.assertIn("mine.yaml:2:", text)
        self.assertIn("'tank'", text)
        with self.assertRaises(mps.Error):
            mps.Case("/no/such/file.yaml")

    def test_sources(self) -> None:
        """A file, a text, a dict, each with `set`."""
        text = mps.Case(TANK).text
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "tank.yaml"
            file.write_text(text)
            for source in (text, "mps: 1\n" + text.partition("\n")[2], file, str(file), TANK):
                case = mps.Case(source, set={"dp": "50 mm"})
                self.assertIn("dp: 50 mm", case.text)
        with self.assertRaisesRegex(mps.ArgumentError, "a file, a text or a dict, not int"):
            mps.Case(5)  # type: ignore[arg-type]
        with self.assertRaisesRegex(mps.Error, "no/such"):
            mps.Case("no/such.yaml")
        with self.assertRaisesRegex(mps.CaseError, "^set dp=5 kg"):
            mps.Case(TANK, set={"dp": "5 kg"})
        with self.assertRaisesRegex(mps.ArgumentError, "unknown option 't_end'; allowed are overwrite, resume, quiet, say"):
            mps.Case(TANK).run("none", t_end=1.0)

    def test_model_on_a_case(self) -> None:
        """A model in Python on a case, and one that fails: the folder has what was written up to then."""
        class Calm(mps.Model):
            name, help = "mine.calm", "damps the liquid"
            settings = [mps.Setting("rate", "1/s", "of the velocity", 0.0, 0.0, 1e4)]

            @mps.verb(mps.MPS_FORCE, velocity=mps.MPS_USE_READ, acceleration=mps.MPS_USE_CHANGE)
            def push(self, s: mps.Stage) -> None:
                if s.setting["rate"] == 0 and s.t > 0.02:
                    raise ValueError("no rate")
                s["acceleration"][s.fluid] -= s.setting["rate"] * s["velocity"][s.fluid]

        with tempfile.TemporaryDirectory() as folder:
            ends = []
            for rate in (1.0, 200.0):
                with mps.Case(TANK).build(f"{folder}/{rate}", say=None) as job:
                    job.simulation.use(Calm(), rate=rate)
                    ends.append(job.run().columns["ke"][-1])
            self.assertLess(ends[1], 0.5 * ends[0])
            with mps.Case(TANK).build(f"{folder}/bad", say=None) as job:
                job.simulation.use(Calm())
                with self.assertRaisesRegex(mps.PluginError, "no rate") as caught:
                    job.run()
            self.assertIsInstance(caught.exception.__cause__, ValueError)
            self.assertGreater(len(mps.Run(f"{folder}/bad").columns["t"]), 10)

    def test_plugins(self) -> None:
        """A plug-in of a case acts, is loaded only on request, and lives as long as what was built from its case."""
        file = Path(os.environ.get("MPS_LIBRARY_PATH", "")) / "tests/plugins/plugin_screen.so"
        if not file.exists():
            self.skipTest("the plug-ins of the tests are not built")
        plain = {**TANK, "run": {"until": "0.05 s"}}
        drag = {**plain, "use": ["screen.uniform"], "settings": {"screen.rate": "20 1/s"}}
        named = {**drag, "plugins": [str(file)]}
        with tempfile.TemporaryDirectory() as folder:
            still = mps.Case(plain).run(f"{folder}/plain", say=None).columns["ke"]
            slowed = mps.Case(drag, plugin=[file]).run(f"{folder}/drag", say=None).columns["ke"]
            self.assertGreater(abs(slowed - still).max(), 1e-3 * still.max())
            case = mps.Case({**named, "sweep": {"settings.screen.rate": ["0 1/s", "20 1/s"]}}, plugins="all")
            for k, run in enumerate(case.sweep(f"{folder}/swept", say=None)):
                np.testing.assert_array_equal(run.columns["ke"], slowed if k else still)
            sim = mps.Case(named, plugins="all").build(f"{folder}/kept", say=None).simulation
            gc.collect()
            sim.step()
            job = mps.Case.parse(json.dumps(drag), plugin=[file]).build(f"{folder}/closed", say=None)
            job.case.close()
            self.assertTrue(job.closed and job.simulation.closed)
        case = mps.Case(named)
        with self.assertRaisesRegex(mps.CaseError, r"not loaded when the case was read; Case\(\) has an option"):
            case.check()
        with self.assertRaisesRegex(mps.CaseError, r'if you trust it, plugins="all" loads it, or give your own copy by plugin=\[FILE\]'):
            mps.Case(named, plugins="files")
        with self.assertRaisesRegex(mps.ArgumentError, "plugins is 'some': allowed are none, files, all"):
            mps.Case(plain, plugins="some")
        with self.assertRaisesRegex(mps.ArgumentError, "plugin: a list of files"):
            mps.Case(plain, plugin="drag.so")

    def test_check_and_sweep(self) -> None:
        self.assertIn("particles", mps.Case(TANK).check())
        runs = mps.sweep(mps.Case({**TANK, "sweep": {"fill.water.depth": "0.1 0.2 m", "motion.surge.omega": "5 6 7 rad/s"}}))
        self.assertEqual(len(runs), 6)
        self.assertEqual(runs[1], {"fill.water.depth": "0.1 m", "motion.surge.omega": "6 rad/s"})


class Interface(unittest.TestCase):
    def test_texts_name_python(self) -> None:
        """Functions of C that texts of the library name have names in this package, but those of models, ranks and devices."""
        from mps.errors import PYTHON, in_python

        others = ("stage_", "sim_ranks", "sim_device", "particles_collect", "parallel", "kernel_custom")
        named, called = set(), set()
        for folder in ("core", "geometry", "phase", "bc", "ppe"):
            for path in (ROOT / "src" / folder).rglob("*.c"):
                for literal in re.findall(r'"((?:[^"\\\n]|\\.)*)"', path.read_text()):
                    named |= {n for n in re.findall(r"\bmps_(\w+)\(\)", literal) if not n.startswith(others) and not n.endswith("_init")}
        for module in ("simulation", "_couple", "_motion", "_geometry", "probe", "lease", "operators"):  # any may be named by __func__
            called |= set(re.findall(r"\bc\.mps_(\w+)\(", (ROOT / f"bindings/python/mps/{module}.py").read_text()))
        self.assertGreater(len(named), 15)
        self.assertGreater(len(called), 45)
        plain = {"sim_error", "sim_shape", "sim_time", "status_text", "particles_count", "probe_size", "model_name", "lattice_constants", "neighbours_error",
                 "frames_remove"}
        self.assertEqual(sorted((named | called) - set(PYTHON) - plain), [])
        for value in PYTHON.values():
            word = value.removesuffix("()").split("() or ")[0]
            kind, _, member = word.rpartition(".")
            self.assertTrue(hasattr(getattr(mps, kind), member) if kind else hasattr(mps.Simulation, word) or hasattr(mps, word), value)
        self.assertEqual(in_python("call mps_phase_set() first, mps_body.mass is 0"), "call phase() first, mass is 0")
        self.assertEqual(in_python("config.dp is 0 m"), "dp is 0 m")
        self.assertEqual(in_python("--out a: anew with --overwrite, or in another folder with --out"), "folder a: anew with overwrite=True")
        for path in ("/a/mps_run/summary.json", "mps_case.yaml: no file", "mps_body.stl", "a--set.yaml"):
            self.assertEqual(in_python(path), path)
        with mps.Simulation(dp=0.05) as sim:
            with self.assertRaisesRegex(mps.ArgumentError, r"call phase\(\) first"):
                sim.tension(0, 1, 0.07)
            with self.assertRaisesRegex(mps.Error, r"watch_load\(\)"):
                sim.load()

    def test_all_is_documented(self) -> None:
        for name in mps.__all__:
            one = getattr(mps, name)
            if not callable(one) or name == "c":
                continue
            self.assertTrue(one.__doc__, name)
            for member, value in vars(one).items() if isinstance(one, type) else ():
                if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                    self.assertTrue(value.__doc__, f"{name}.{member}")

    def test_files_are_what_the_headers_say(self) -> None:
        subprocess.run([sys.executable, ROOT / "bindings/make", "--check"], check=True)

    def test_layout_is_checked(self) -> None:
        size, offsets = _layouts.LAYOUTS["mps_tank"]
        with mock.patch.dict(_layouts.LAYOUTS, {"mps_tank": (size, [k + 8 for k in offsets])}), self.assertRaisesRegex(ImportError, "mps_tank"):
            _library.Library()
        part = type("mps_tank", (ctypes.Structure,), {"_fields_": _structs.mps_tank._fields_[:1]})
        with mock.patch.object(_structs, "mps_tank", part), mock.patch.dict(_layouts.LAYOUTS, {"mps_tank": (4, [0])}), \
                self.assertRaisesRegex(ImportError, "does not take a mps_tank of 4 bytes"):
            _library.Library()

    def test_every_function_is_there(self) -> None:
        from mps._functions import FUNCTIONS

        for name in FUNCTIONS:
            self.assertTrue(callable(getattr(mps.c, name)), name)
        with self.assertRaises(AttributeError):
            mps.c.mps_no_such_function  # noqa: B018


if __name__ == "__main__":
    unittest.main()
