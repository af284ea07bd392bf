# SPDX-License-Identifier: BSD-3-Clause
"""Case files: mps/case.h. A case is a file, a text in YAML, or a dict with the same keys."""
from __future__ import annotations

import csv
import ctypes
import json
import sys
import threading
from collections.abc import Callable, Mapping
from ctypes import POINTER, byref, c_char_p, c_void_p
from pathlib import Path
from typing import Any

import numpy as np

from . import _numbers as N
from . import _structs as T
from . import errors
from ._library import c
from ._records import Calls, Record, coded, make, record, text
from .simulation import Simulation


class CaseError(errors.ArgumentError):
    """A case has errors; the text has all of them, with their places."""


def _show(_kind: int, what: str) -> None:
    print(what, end="" if what.endswith(("\n", "\r")) else "\n", file=sys.stderr)


class Run:
    """The folder of a run."""

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)

    @property
    def summary(self) -> dict[str, Any]:
        """summary.json"""
        return json.loads((self.folder / "summary.json").read_text())

    @property
    def columns(self) -> dict[str, np.ndarray]:
        """Columns of probes.csv by their names without the unit; "t" is the time [s]."""
        with open(self.folder / "probes.csv", newline="") as file:
            rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
        values = np.array([[float(word) if word else np.nan for word in row] for row in rows[1:]])
        return {name.split("[")[0]: values[:, k] for k, name in enumerate(rows[0])}


class Case:
    """A case that was read. Case("surge.yaml", set={"dp": "8 mm"}), Case({"mps": 1, "dp": "1 cm", ...}), Case.parse(yaml)."""

    def __init__(self, source: str | Path | Mapping[str, Any], set: Mapping[str, Any] | None = None) -> None:
        if isinstance(source, Mapping):
            self._read_text(json.dumps(source), "case", set)
        else:
            self._open(lambda n, sets, out: c.mps_case_read(coded(str(source)), n, sets, out), set)

    @classmethod
    def parse(cls, yaml: str, name: str = "case", set: Mapping[str, Any] | None = None) -> Case:
        """A case from a text; files in it are named relative to the folder of `name`."""
        case = cls.__new__(cls)
        case._read_text(yaml, name, set)
        return case

    def _read_text(self, yaml: str, name: str, set: Mapping[str, Any] | None) -> None:
        data = yaml.encode()
        self._open(lambda n, sets, out: c.mps_case_read_text(data, len(data), name.encode(), n, sets, out), set)

    def _open(self, read: Callable[[int, Any, Any], int], set: Mapping[str, Any] | None) -> None:
        self._case = POINTER(T.mps_case)()
        sets = [f"{path}={value}".encode() for path, value in (set or {}).items()]
        status = read(len(sets), (c_char_p * max(len(sets), 1))(*sets), byref(self._case))
        self._check(status)

    def _check(self, status: int, otherwise: str = "") -> None:
        if status >= 0:
            return
        if self._case and any(not m.warning for m in self.messages):
            raise CaseError(self._all_messages())
        raise errors.error(status, otherwise)

    def _all_messages(self) -> str:
        size = c.mps_case_messages_write(self._case, None, 0) + 1
        buffer = ctypes.create_string_buffer(size)
        c.mps_case_messages_write(self._case, buffer, size)
        return text(buffer.value).rstrip()

    @property
    def messages(self) -> list[Record]:
        """Errors and warnings: file, line, column, text."""
        found = []
        for k in range(c.mps_case_message_count(self._case)):
            message = make(T.mps_case_message)
            c.mps_case_message_get(self._case, k, byref(message))
            found.append(record(message))
        return found

    @property
    def text(self) -> str:
        """The case as it is run."""
        return text(c.mps_case_text(self._case))

    def check(self) -> str:
        """What the case amounts to: particles, volumes, periods, motion, cost."""
        found, sketch = POINTER(ctypes.c_char)(), POINTER(ctypes.c_char)()
        self._check(c.mps_case_check(self._case, byref(found), byref(sketch)))
        try:
            return text(ctypes.cast(found, c_char_p).value)
        finally:
            for block in (found, sketch):
                _free(ctypes.cast(block, c_void_p))

    def build(self, folder: str | Path, **options: Any) -> Job:
        """The simulation of the case with its job, to step it yourself or to run it."""
        return Job(self, folder, options)

    def run(self, folder: str | Path, say: Callable[[int, str], None] | None = _show, **options: Any) -> Run:
        """Run the case into a folder; options of mps_job_config: overwrite, resume, quiet. say(kind, text) gets messages and
        progress, which else go to stderr; None: nothing. Ctrl-C stops after a step: resume=True continues."""
        with self.build(folder, say=say, **options) as job:
            return job.run()

    def __del__(self) -> None:
        if getattr(self, "_case", None):
            c.mps_case_destroy(self._case)


def _free(block: Any) -> None:
    libc = ctypes.CDLL(None)
    libc.free.argtypes = [c_void_p]
    libc.free(block)


class Job:
    """A case that was built: `simulation`, and the files of its run."""

    def __init__(self, case: Case, folder: str | Path, options: Mapping[str, Any]) -> None:
        self.case, self.folder = case, Path(folder)
        given = dict(options)
        say = given.pop("say", _show)
        self._calls = Calls()
        error = ctypes.create_string_buffer(1024)
        signals = threading.current_thread() is threading.main_thread()
        config = make(T.mps_job_config, {"folder": str(folder), "command": " ".join(sys.argv), "signals": signals, "quiet": say is None,
                                         **given}, "run")
        config.error, config.error_size = ctypes.cast(error, POINTER(ctypes.c_char)), len(error)
        if say is not None:
            self._say = config.say = T.mps_job_say_fn(self._calls.guard(lambda _u, kind, what: say(kind, text(what)), None))
        self._job, sim = POINTER(T.mps_job)(), POINTER(T.mps_sim)()
        case._check(c.mps_case_job(case._case, byref(config), byref(self._job), byref(sim)), text(error.value))
        self._sim = sim
        self.simulation = Simulation.adopt(sim, self)

    def run(self) -> Run:
        """Step to the end with all outputs."""
        code = c.mps_job_run(self._job, self._sim)
        if code == N.MPS_EXIT_INTERRUPTED:
            raise KeyboardInterrupt
        failed = self._calls.taken()
        if failed is not None:
            raise failed
        if code != N.MPS_EXIT_OK:
            what = text(c.mps_job_error(self._job)) or text(c.mps_sim_error(self._sim))
            raise (errors.Diverged if code == N.MPS_EXIT_DIVERGED else errors.Error)(what or f"the run ended with {code}")
        return Run(self.folder)

    def close(self) -> None:
        """Destroy simulation and job, unlock the folder."""
        if self._job:
            self.simulation.handle = None
            c.mps_sim_destroy(self._sim)
            c.mps_job_destroy(self._job)
            self._job = POINTER(T.mps_job)()

    def __enter__(self) -> Job:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        if getattr(self, "_job", None):
            self.close()


def sweep(case: Case) -> list[dict[str, str]]:
    """What each run of a case with `sweep` sets, for Case(..., set=...)."""
    runs = []
    for k in range(c.mps_case_runs(case._case)):
        sets = {}
        for which in range(c.mps_case_sweep_count(case._case)):
            buffer = ctypes.create_string_buffer(4096)
            case._check(c.mps_case_sweep_get(case._case, k, which, buffer, len(buffer)))
            path, _, value = text(buffer.value).partition("=")
            sets[path] = value
        runs.append(sets)
    return runs
