# SPDX-License-Identifier: BSD-3-Clause
"""Results of runs: columns, frames, impacts, sweeps; folders that are unfinished or damaged; a locale with a comma."""
from __future__ import annotations

import locale
import os
import re
import shutil
import stat
import subprocess
import tempfile
import threading
import unittest
from pathlib import Path

import mps
import numpy as np
from test_case import TANK

PIECE = """<?xml version="1.0"?>
<VTKFile type="PPolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<PPolyData><Piece Source="one.vtp"/>
<Piece Source="two.vtp"/></PPolyData></VTKFile>
"""


# One category is enough, and needs no package of locales.
COMMA = """comment_char %
escape_char /
LC_NUMERIC
decimal_point "<U002C>"
thousands_sep "<U002E>"
grouping 3;3
END LC_NUMERIC
"""


class Results(unittest.TestCase):
    place: tempfile.TemporaryDirectory[str]
    run_: mps.Run

    @classmethod
    def setUpClass(cls) -> None:
        cls.place = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.place.name)
        cls.run_ = mps.Case(TANK).run(cls.folder / "a", say=None)

    @classmethod
    def tearDownClass(cls) -> None:
        cls.place.cleanup()

    def copied(self, name: str) -> Path:
        return Path(shutil.copytree(self.folder / "a", self.folder / name))

    def test_columns(self) -> None:
        run = mps.Run(self.folder / "a")
        with open(run.folder / "probes.csv") as file:
            names = file.readline().strip().split(",")
        reference = np.loadtxt(run.folder / "probes.csv", delimiter=",", skiprows=1)
        self.assertEqual([f"{n}[{u}]" if u else n for n, u in run.columns.units.items()], names)
        self.assertEqual(len(run.columns), len(names))
        for k, (name, values) in enumerate(dict(run.columns).items()):
            np.testing.assert_array_equal(values, reference[:, k], err_msg=name)
        for order in (["P1", "t", "ke", "pe"], ["t", "t", "x_tank"]):
            again = mps.Run(run.folder)
            for name in order:
                np.testing.assert_array_equal(again.columns[name], run.columns[name])
        self.assertEqual(run.columns.units["P1"], "Pa")
        self.assertAlmostEqual(run.steps["t"][-1], 0.2)
        self.assertIn("momentum_x", run.momentum)
        self.assertNotIn("P2", run.columns)
        self.assertIn("Wall pressure", run.about["P1"])
        with self.assertRaisesRegex(mps.UnknownName, "no column 'P2'; there are t, .*P1, "):
            run.columns["P2"]
        with self.assertRaisesRegex(mps.FileError, "trace.csv: No such file"):
            run.trace["t"]

    def test_summary_and_case(self) -> None:
        run = self.run_
        self.assertEqual((run.status, run.summary["status"], run.inputs["dp"]), ("ok", "ok", "40 mm"))
        self.assertTrue(any("outputs in" in message for message in run.messages))
        self.assertEqual(mps.Run(run.folder).messages, [])
        self.assertEqual(run.case.text, mps.Case(TANK).text)
        self.assertIn(f"ok, {len(run.columns)} columns, {len(run.frames)} frames", repr(run))

    def test_frames(self) -> None:
        frames = self.run_.frames
        self.assertEqual((frames[0].t, len(frames[1:])), (0.0, len(list((self.folder / "a" / "frames").glob("*.vtp"))) - 1))
        np.testing.assert_allclose(frames.t[[0, -1]], [0.0, 0.2])
        last = frames.at(1e9)
        self.assertEqual(last.path, frames[-1].path)
        self.assertEqual((last["position"].shape, last["velocity"].dtype, last["id"].dtype), ((last.n, 3), np.float32, np.int64))
        self.assertEqual(np.count_nonzero(last.fluid), self.run_.summary["n_fluid"])
        self.assertEqual([last.part_names[k] for k in np.unique(last["part"][~last.fluid])], ["tank.x0", "tank.x1", "tank.y0", "tank.y1"])
        self.assertAlmostEqual(mps.Frame(last.path).t, 0.2)
        self.assertIn("wall_pressure", last)
        with self.assertRaisesRegex(mps.UnknownName, "no array 'p'; there are position, velocity"):
            last["p"]

    def test_peaks(self) -> None:
        """The pressure that rises as the tank begins to move, without the jerk of its start."""
        run = mps.Case(TANK, set={"output.peaks": 1, "run.until": "0.5 s"}).run(self.folder / "peaks", say=None)
        names = sorted(p.name for p in (self.folder / "peaks" / "peaks").glob("*.vtp"))
        self.assertGreater(len(names), 0)
        self.assertEqual(sorted(frame.path.name for frame in run.peaks), names)
        late = run.columns["t"] > 0.05
        highest = run.columns["t"][late][run.columns["P1"][late].argmax()]
        self.assertLess(np.abs(run.peaks.t - highest).min(), 0.01)
        self.assertTrue((np.diff(run.peaks.t) > 0).all())
        self.assertNotIn(run.peaks[0].path, [frame.path for frame in run.frames])
        self.assertEqual(len(mps.Run(self.folder / "a").peaks[0:0]), 0)

    def test_frames_are_the_state(self) -> None:
        """All particles of the library, and those of pieces, which ranks write."""
        with mps.Simulation(dp=0.1, dim=3) as sim:
            sim.tank(size=(0.6, 0.5, 0.4))
            sim.fill_level(lo=(0, 0, 0), hi=(0.6, 0.3, 0.4))
            sim.add_field("mine", 2)
            sim["mine"] = sim["position"][:, :2]
            sim.step()
            with sim.frames(str(self.folder), "own", mps.MPS_FRAMES_FLUID + mps.MPS_FRAMES_WALL + mps.MPS_FRAMES_DUMMY) as own:
                own.write()
            frame = mps.Frame(self.folder / "own" / "own_000000.vtp")
            order, written = np.argsort(sim["id"]), np.argsort(frame["id"])
            for name in ("position", "velocity", "kind", "mine"):
                np.testing.assert_allclose(frame[name][written], sim[name][order], rtol=1e-6, atol=1e-7, err_msg=name)
            self.assertAlmostEqual(frame.t, sim.t)
        for name in ("one", "two"):
            shutil.copy(frame.path, self.folder / f"{name}.vtp")
        (self.folder / "both.pvtp").write_text(PIECE)
        both = mps.Frame(self.folder / "both.pvtp")
        self.assertEqual((both.n, both["position"].shape), (2 * frame.n, (2 * frame.n, 3)))

    def test_damaged_frames(self) -> None:
        data = self.run_.frames[0].path.read_bytes()
        bad = self.folder / "bad.vtp"
        for part in (b"", data[:100], data[:len(data) // 2], data.replace(b'"Float32"', b'"Float99"'), data.replace(b'offset="0"', b'offset="99999999"'),
                     data.replace(b"raw", b"base64"), data.replace(b'NumberOfPoints="', b'NumberOfPoints="9'), b"\xff" * 500):
            bad.write_bytes(part)
            with self.assertRaisesRegex(mps.FileError, "bad.vtp: no frame of libmps: "):
                for name in ("position", "id"):
                    mps.Frame(bad)[name]
        (self.folder / "bad.pvtp").write_text("<x/>")
        with self.assertRaisesRegex(mps.FileError, "names no pieces"):
            _ = mps.Frame(self.folder / "bad.pvtp").n
        with self.assertRaisesRegex(mps.FileError, "No such file"):
            _ = mps.Frame(self.folder / "none.vtp").n

    def test_no_regular_files(self) -> None:
        """What is no regular file is refused by its name; a FIFO does not block."""
        run = self.copied("odd")
        (run / "both.pvtp").write_text(PIECE)
        uses = {"summary.json": lambda: mps.Run(run).inputs, "probes.csv": lambda: mps.Run(run).columns["P1"],
                "steps.csv": lambda: dict(mps.Run(run).steps), "frames.pvd": lambda: len(mps.Run(run).frames),
                "frames/frames_000000.vtp": lambda: mps.Run(run).frames[0]["position"], "both.pvtp": lambda: mps.Frame(run / "both.pvtp").n}
        kinds = {"a pipe .FIFO.": os.mkfifo, "a folder": os.mkdir, "a device": lambda path: path.symlink_to("/dev/zero"),
                 "a socket": lambda path: os.mknod(path, stat.S_IFSOCK | 0o600)}
        for name, use in uses.items():
            path, kept = run / name, (run / name).read_bytes()
            for why, make in kinds.items():
                path.unlink(missing_ok=True)
                make(path)
                with self.subTest(name, why=why), self.assertRaisesRegex(mps.FileError, f"{name}: it is {why}, no regular file"):
                    use()
                (path.rmdir if path.is_dir() else path.unlink)()
            path.write_bytes(kept)
            if name != "both.pvtp":  # whose pieces are not there
                use()

    def test_damaged_texts(self) -> None:
        """A damaged text is an error with the name of its file."""
        run = self.copied("damaged")
        cases = [("summary.json", b"{", "no JSON"), ("summary.json", b"[" * 100000, "no JSON"), ("summary.json", b"[1]", "no keys"),
                 ("summary.json", b"\xff", "no text in UTF-8"), ("summary.json", b'{"inputs": 3}', "'inputs' is no list"),
                 ("summary.json", b'{"inputs": [{"key": "dp"}]}', "'inputs' is no list"), ("probes.csv", b"\xfft\n", "no text in UTF-8"),
                 ("frames.pvd", b"\xff", "no text in UTF-8"),
                 ("frames.pvd", b'<DataSet timestep="x" file="a"/>', "could not convert")]
        for name, data, why in cases:
            kept = (run / name).read_bytes()
            (run / name).write_bytes(data)
            with self.subTest(data[:30]), self.assertRaisesRegex(mps.FileError, f"{name}: .*{why}"):
                _ = (mps.Run(run).inputs, dict(mps.Run(run).columns), mps.Run(run).frames.t)
            (run / name).write_bytes(kept)
        with open(run / "summary.json", "r+b") as file:
            file.truncate(1 << 40)
        with self.assertRaisesRegex(mps.FileError, "summary.json: 1099511627776 bytes are more than"):
            _ = mps.Run(run).summary
        (run / "summary.json").write_text("{}")
        with self.assertRaisesRegex(mps.FileError, "summary.json: .*has no 'status'"):
            _ = mps.Run(run).status
        whole = self.run_.frames[0].path.read_bytes()
        for name, word, why in (("TimeValue", b"x", "the time is no number"), ("part_names", b"999", "the names of the parts are")):
            damaged = re.sub(rb'(Name="%s"[^>]*>)[^<]*<' % name.encode(), rb"\g<1>" + word + b"<", whole)
            (run / "odd.vtp").write_bytes(damaged)
            with self.subTest(name), self.assertRaisesRegex(mps.FileError, f"odd.vtp: no frame of libmps: {why}"):
                _ = (mps.Frame(run / "odd.vtp").t, mps.Frame(run / "odd.vtp").part_names)

    def test_impacts(self) -> None:
        folder = self.copied("impacts")
        t = np.arange(0, 8, 1e-3)
        p = 100.0 + 2e3 * np.exp(-(((t % 2) - 1) / 0.02) ** 2) * (1 + t)
        np.savetxt(folder / "probes.csv", np.stack([t, p], axis=1), delimiter=",", header="t[s],P1[Pa]", comments="")
        run = mps.Run(folder)
        found = run.impacts("P1", threshold="1 kPa", until=7.9, from_=0.1, window=0.1)
        self.assertEqual(len(found), 4)
        np.testing.assert_allclose([e.t for e in found], [1, 3, 5, 7], atol=2e-3)
        self.assertAlmostEqual(found[-1].peak / 16.1e3, 1, delta=1e-2)
        self.assertEqual((found.info.threshold, found.weibull.state), (1e3, mps.MPS_FIT_FEW))
        self.assertEqual(len(run.impacts("P1", threshold=1e6)), 0)
        with self.assertRaisesRegex(mps.ArgumentError, "probes.csv: column 'P1': p.3. is inf"):
            (folder / "probes.csv").write_text("t[s],P1[Pa]\n0,1\n1,1\n2,1\n3,inf\n4,1\n")
            mps.Run(folder).impacts("P1")
        with self.assertRaisesRegex(mps.ArgumentError, "a pressure is wanted"):
            run.impacts("P1", threshold="1 kg")
        with self.assertRaisesRegex(mps.ArgumentError, "unknown entry 'treshold'; allowed are .*threshold"):
            run.impacts("P1", treshold=1.0)

    def test_unfinished(self) -> None:
        folder = self.copied("killed")
        (folder / "summary.json").unlink()  # which a run writes when it ends
        with open(folder / "probes.csv", "a") as file:
            file.write("0.3,17")
        run = mps.Run(folder)
        rows = len(run.columns["t"])
        self.assertEqual((run.status, rows, len(run.frames)), ("unfinished", len(self.run_.columns["t"]), len(self.run_.frames)))
        with self.assertRaisesRegex(mps.FileError, "the run is unfinished"):
            _ = run.summary
        with open(folder / "probes.csv", "a") as file:
            file.write("," * (len(run.columns) - 3) + "\n")
        self.assertEqual(len(run.columns["t"]), rows)
        run.columns.refresh()
        with self.assertRaisesRegex(mps.FileError, f"probes.csv:{rows + 2}: "):
            run.columns["t"]
        (folder / "probes.csv").unlink()
        self.assertIn("unfinished, no columns", repr(mps.Run(folder)))
        self.assertIn("no such file", repr(mps.Run(folder).columns))
        with self.assertRaisesRegex(mps.FileError, "no folder of a run"):
            mps.Run(self.folder)

    def test_sweep(self) -> None:
        given = {**TANK, "run": {"until": "0.02 s"}, "sweep": {"fill.water.depth": "0.1 0.2 m", "motion.surge.omega": "5 6 rad/s"}}
        case = mps.Case(given)
        with self.assertRaisesRegex(mps.StateError, r"'sweep' of 4 runs: sweep\(folder\).*fill.water.depth, motion.surge.omega"):
            case.run(self.folder / "one")
        with self.assertRaisesRegex(mps.StateError, "no 'sweep': run"):
            mps.Case(TANK).sweep(self.folder / "one")
        said: list[str] = []
        swept = case.sweep(self.folder / "swept", jobs=2, say=lambda _k, text: said.append(text))
        self.assertEqual([run.folder.name for run in swept], ["001", "002", "003", "004"])
        self.assertEqual([values for _, values in swept.items()], mps.sweep(case))
        self.assertTrue(any("003: fill.water.depth 0.2 m, motion.surge.omega 5 rad/s" in text for text in said))
        alone = mps.Case(given, set=mps.sweep(case)[2]).run(self.folder / "three", say=None)
        np.testing.assert_array_equal(alone.columns["P1"], swept[2].columns["P1"])
        times = [(run.folder / "summary.json").stat().st_mtime_ns for run in swept]
        shutil.rmtree(self.folder / "swept" / "002")
        again = case.sweep(self.folder / "swept", say=None)  # what is missing
        self.assertEqual([(run.folder / "summary.json").stat().st_mtime_ns == t for run, t in zip(again, times)], [True, False, True, True])
        self.assertEqual([run.status for run in again], ["ok"] * 4)
        with self.assertRaisesRegex(mps.StateError, "swept/001: there is a run of another case; overwrite=True"):
            mps.Case(given, set={"dp": "0.05 m"}).sweep(self.folder / "swept", say=None)
        with self.assertRaisesRegex(mps.FileError, "no folder of a sweep"):
            mps.Sweep(self.folder / "a")

    def test_sweep_that_fails(self) -> None:
        """All runs are tried, then the first failure is raised."""
        case = mps.Case({**TANK, "run": {"until": "0.02 s"}, "sweep": {"motion.surge.amplitude": ["900 km", "20 mm"]}})
        for _ in range(2):  # what failed is run again
            with self.assertRaisesRegex(mps.Diverged, "^.*fails/001: "):
                case.sweep(self.folder / "fails", say=None)
        self.assertEqual([run.status for run in mps.Sweep(self.folder / "fails")][1:], ["ok"])

    def test_sweep_that_is_stopped(self) -> None:
        """A second call continues what was stopped, and has the bytes of a sweep that was not."""
        case = mps.Case({**TANK, "run": {"until": "0.1 s"}, "sweep": {"motion.surge.omega": "5 6 rad/s"}})
        jobs: list[mps.Job] = []

        def say(_kind: int, _text: str) -> None:
            if jobs:
                jobs[0].stop()

        with mps.Case(case.text, set=mps.sweep(case)[0]).build(self.folder / "stopped" / "001", say) as job:
            jobs.append(job)
            self.assertRaises(KeyboardInterrupt, job.run)
        run = mps.Run(self.folder / "stopped" / "001")
        self.assertNotEqual(run.status, "ok")
        self.assertLess(run.columns["t"][-1], 0.09)
        stopped, whole = case.sweep(self.folder / "stopped", jobs=2, say=None), case.sweep(self.folder / "whole", say=None)
        self.assertGreater(stopped[0].summary["t_resumed"], 0.0)
        for a, b in zip(stopped, whole):
            np.testing.assert_array_equal(a.columns["P1"], b.columns["P1"])

    def test_threads(self) -> None:
        """A case and a simulation in each of two threads."""
        found: list[bytes] = []

        def one(name: str) -> None:
            found.append(mps.Case(TANK).run(self.folder / name, say=None).columns["P1"].tobytes())

        threads = [threading.Thread(target=one, args=(f"thread{k}",)) for k in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(found, [self.run_.columns["P1"].tobytes()] * 2)


class Comma(unittest.TestCase):
    """The host has a locale with a decimal comma."""

    def setUp(self) -> None:
        self.place = tempfile.TemporaryDirectory()
        self.addCleanup(self.place.cleanup)
        self.addCleanup(locale.setlocale, locale.LC_ALL, "C")
        if shutil.which("localedef") is None:
            self.skipTest("no localedef, which is a part of the C library")
        source = Path(self.place.name) / "comma.source"
        source.write_text(COMMA)
        subprocess.run(["localedef", "-c", "-i", source, "-f", "ANSI_X3.4-1968", f"{self.place.name}/comma"], capture_output=True, check=False)
        before = os.environ.get("LOCPATH")
        os.environ["LOCPATH"] = self.place.name
        self.addCleanup(lambda: os.environ.pop("LOCPATH") if before is None else os.environ.__setitem__("LOCPATH", before))
        locale.setlocale(locale.LC_ALL, "comma")
        self.assertEqual(locale.localeconv()["decimal_point"], ",")

    def test_same_bytes(self) -> None:
        folder = Path(self.place.name)
        run = mps.Case(TANK, set={"run.until": "0.05 s", "dp": "0.04 m"}).run(folder / "comma", say=None)
        found = (run.columns["P1"], run.frames[-1]["position"], run.summary["dp"], run.impacts("P1", threshold="1.5 kPa").info.threshold)
        self.assertEqual(locale.localeconv()["decimal_point"], ",")
        locale.setlocale(locale.LC_ALL, "C")
        point = mps.Case(TANK, set={"run.until": "0.05 s", "dp": "0.04 m"}).run(folder / "point", say=None)
        expected = (point.columns["P1"], point.frames[-1]["position"], point.summary["dp"], 1500.0)
        for a, b in zip(found, expected):
            np.testing.assert_array_equal(a, b)
        for name in ("probes.csv", "steps.csv", "momentum.csv", "frames.pvd", "case.yaml"):
            self.assertEqual((folder / "comma" / name).read_bytes(), (folder / "point" / name).read_bytes(), name)

    def test_errors(self) -> None:
        with self.assertRaisesRegex(mps.ArgumentError, "0.5"):
            mps.Case({**TANK, "tank": {"size": "0.5 -0.5 m"}})
        with mps.Simulation(dp=0.05) as sim, self.assertRaisesRegex(mps.ArgumentError, r"-1\b"):
            sim.step(-1.0)


if __name__ == "__main__":
    unittest.main()
