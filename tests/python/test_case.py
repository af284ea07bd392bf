# SPDX-License-Identifier: BSD-3-Clause
"""Case files from Python, the layouts, and what is made from the headers."""
from __future__ import annotations

import ctypes
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
            with self.assertRaises(mps.StateError):
                mps.Case(TANK).run(f"{folder}/a", say=None)  # an earlier run is there
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
            self.assertIsNone(job.simulation.handle)

    def test_errors(self) -> None:
        with self.assertRaises(mps.CaseError) as caught:
            mps.Case.parse("mps: 1\ndp: 4\ntnk: {size: 1 1 m}\n", "mine.yaml")
        text = str(caught.exception)
        self.assertIn("mine.yaml:2:", text)
        self.assertIn("'tank'", text)
        with self.assertRaises(mps.Error):
            mps.Case("/no/such/file.yaml")

    def test_check_and_sweep(self) -> None:
        self.assertIn("particles", mps.Case(TANK).check())
        runs = mps.sweep(mps.Case({**TANK, "sweep": {"fill.water.depth": "0.1 0.2 m", "motion.surge.omega": "5 6 7 rad/s"}}))
        self.assertEqual(len(runs), 6)
        self.assertEqual(runs[1], {"fill.water.depth": "0.1 m", "motion.surge.omega": "6 rad/s"})


class Interface(unittest.TestCase):
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
