# SPDX-License-Identifier: BSD-3-Clause
"""The blocks of the tutorials in Python run in their order, for a shorter time, as a new user would paste them. A block whose packages
(matplotlib, pandas, VTK) are not installed is left out."""
from __future__ import annotations

import contextlib
import importlib.util
import io
import os
import re
import tempfile
import unittest
from pathlib import Path

import mps

TUTORIALS = Path(__file__).resolve().parent.parent.parent / "docs/tutorials"
SHORTER = [(r"until: 4 s", "until: 0.3 s"), (r"\"(\d) s\"", r'"0.0\1 s"'), (r"sim\.run\(4\.0\)", "sim.run(0.05)"), ("dp: 20 mm", "dp: 40 mm"),
           ("dp=0.02", "dp=0.04"), ("sim.t \\+ 0.1", "sim.t + 0.01")]


class Tutorials(unittest.TestCase):
    def run_page(self, name: str, told: dict[str, object]) -> int:
        blocks = re.findall(r"```python\n(.*?)```", (TUTORIALS / name).read_text(), re.S)
        for k, block in enumerate(blocks):
            needed = {m.split(".")[0] for m in re.findall(r"^(?:import|from) ([\w.]+)", block, re.M)}
            if all(importlib.util.find_spec(module) for module in needed):
                for pattern, shorter in SHORTER:
                    block = re.sub(pattern, shorter, block)
                with self.subTest(block=k, begins=block.partition("\n")[0]), contextlib.redirect_stdout(io.StringIO()):
                    exec(compile(block, f"{name}, block {k}", "exec"), told)
        return len(blocks)

    def test_python(self) -> None:
        home = os.getcwd()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            os.environ.setdefault("MPLBACKEND", "Agg")
            try:
                self.assertGreater(self.run_page("python.md", {}), 8)
                self.assertLess(abs(mps.Run("out").columns["t"][-1] - 0.3), 1e-9)
                self.assertGreater(self.run_page("post_processing.md", {}), 1)
            finally:
                os.chdir(home)


if __name__ == "__main__":
    unittest.main()
