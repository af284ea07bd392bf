# SPDX-License-Identifier: BSD-3-Clause
"""Case files: mps/case.h. A case is a file, a text in YAML, or a dict with the same keys."""
from __future__ import annotations

import ctypes
import json
import sys
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from ctypes import POINTER, byref, c_char_p, c_void_p
from pathlib import Path
from typing import Any

from . import _numbers as N
from . import _structs as T
from . import errors
from ._held import Held, Owner
from ._library import c
from ._records import Calls, Record, coded, make, record, text
from .results import Run, Sweep
from .simulation import Simulation

Say = Callable[[int, str], None]
_OPTIONS = ("overwrite", "resume", "quiet")
_PLUGINS = {"none": N.MPS_CASE_PLUGINS_NONE, "files": N.MPS_CASE_PLUGINS_FILES, "all": N.MPS_CASE_PLUGINS_ALL}


class CaseError(errors.ArgumentError):
    """A case has errors; the text lists all of them, with their positions."""


def _show(_kind: int, what: str) -> None:
    print(what, end="" if what.endswith(("\n", "\r")) else "\n", file=sys.stderr)


def _is_text(source: str) -> bool:
    """Whether it is the text of a case: it has lines, or the first key of each case."""
    return "\n" in source or source.lstrip().startswith(("mps:", "{"))


class Case(Owner):
    """A case that was read, as a file, a text in YAML, or a dict with the same keys; `set` sets values by
    their paths, and has precedence:

        mps.Case("surge.yaml", set={"dp": "8 mm", "run.until": "2 s"})
        mps.Case("mps: 1\\ndp: 1 cm\\n...")             # a str with a line end, or that begins with "mps:"
        mps.Case({"mps": 1, "dp": "1 cm", "tank": {"size": "1 0.6 m"}, ...})

    Plug-ins are programs that run with all rights of this one. plugins="none" loads none: the case can be read, not built; "files" loads
    those that case files, `set` and `plugin` name; "all" also those that a page, a text or a dict names. plugin=["drag.so"] adds files, or
    replaces plug-ins of the same name. Without `plugins`: "files" where `plugin` is given, else "none". They are unloaded
    when the case is closed, after all that was built from it.

    CaseError: it has errors; the text has all of them. Keys: docs/reference/case-keys.md, or `mps list keys`."""

    _instead = "; Case(case.text) reads it again"

    def __init__(self, source: str | Path | Mapping[str, Any], set: Mapping[str, Any] | None = None, plugins: str | None = None,
                 plugin: Sequence[str | Path] = ()) -> None:
        if isinstance(source, Mapping):
            self._open("case", json.dumps(source), set, plugins, plugin)
        elif isinstance(source, str) and _is_text(source):
            self._open("case", source, set, plugins, plugin)
        elif isinstance(source, (str, Path)):
            self._open(str(source), None, set, plugins, plugin)
        else:
            raise errors.error(N.MPS_E_ARG, f"a case is a file, a text or a dict, not {type(source).__name__}")

    @classmethod
    def parse(cls, yaml: str, name: str = "case", set: Mapping[str, Any] | None = None, plugins: str | None = None,
              plugin: Sequence[str | Path] = ()) -> Case:
        """A case from a text with a name for messages; files in it are named relative to the folder of `name`."""
        case = cls.__new__(cls)
        case._open(name, yaml, set, plugins, plugin)
        return case

    def _open(self, name: str, yaml: str | None, set: Mapping[str, Any] | None, plugins: str | None, plugin: Sequence[str | Path]) -> None:
        """Read a text, or without one the file of the name."""
        if isinstance(plugin, (str, Path)):
            raise errors.error(N.MPS_E_ARG, "plugin: a list of files is wanted, e.g. ['drag.so']")
        plugins = plugins if plugins is not None else "files" if plugin else "none"
        if plugins not in _PLUGINS:
            raise errors.error(N.MPS_E_ARG, f"plugins is '{plugins}': allowed are {', '.join(_PLUGINS)}")
        pointer = POINTER(T.mps_case)()
        self._set, self._loads = dict(set or {}), plugins != "none"
        sets, files = [f"{path}={value}".encode() for path, value in self._set.items()], [coded(str(file)) for file in plugin]
        options, data = make(T.mps_case_options), None if yaml is None else yaml.encode()
        options.load, options.set_count, options.plugin_count = _PLUGINS[plugins], len(sets), len(files)
        options.set, options.plugin = (c_char_p * max(len(sets), 1))(*sets), (c_char_p * max(len(files), 1))(*files)
        options.text, options.size = data, len(data or b"")
        status = c.mps_case_open(coded(name), byref(options), byref(pointer))
        if pointer:
            self._held = Held("case", pointer, c.mps_case_destroy)
        self._check(status)

    def _check(self, status: int, otherwise: str = "") -> None:
        if status >= 0:
            return
        if not self._held.closed and any(not m.warning for m in self.messages):
            raise CaseError(self._all_messages())
        raise errors.error(status, otherwise)

    def _all_messages(self) -> str:
        size = c.mps_case_messages_write(self._held.pointer, None, 0) + 1
        buffer = ctypes.create_string_buffer(size)
        c.mps_case_messages_write(self._held.pointer, buffer, size)
        return errors.in_python(text(buffer.value).rstrip())

    def __repr__(self) -> str:
        return "<mps.Case, closed>" if self.closed else f"<mps.Case, {c.mps_case_runs(self._held.pointer)} run(s)>\n{self.text}"

    @property
    def messages(self) -> list[Record]:
        """Errors and warnings: file, line, column, text."""
        found = []
        for k in range(c.mps_case_message_count(self._held.pointer)):
            message = make(T.mps_case_message)
            c.mps_case_message_get(self._held.pointer, k, byref(message))
            found.append(record(message))
        return found

    @property
    def text(self) -> str:
        """The case as run, in YAML, with absolute file names."""
        return text(c.mps_case_text(self._held.pointer))

    def check(self) -> str:
        """A summary of the case as `mps check` prints it: particles, volumes, periods, motion,
        cost."""
        found, sketch = POINTER(ctypes.c_char)(), POINTER(ctypes.c_char)()
        with self._held as case:
            self._check(c.mps_case_check(case, byref(found), byref(sketch)))
        try:
            return text(ctypes.cast(found, c_char_p).value)
        finally:
            for block in (found, sketch):
                _free(ctypes.cast(block, c_void_p))

    def build(self, folder: str | Path, say: Say | None = _show, **options: Any) -> Job:
        """The simulation of the case with its job, to change it, to step it yourself, or to run it; options as run().

            with case.build("out") as job:
                job.simulation.use(MyModel())
                job.run()"""
        swept = [path for path in _swept(self) if path not in self._set]
        if swept:
            raise errors.error(N.MPS_E_STATE, f"the case has a 'sweep' of {c.mps_case_runs(self._held.pointer)} runs: sweep(folder) runs all; "
                                              f"Case(..., set=...) with a value for each of {', '.join(swept)} is one of them")
        return Job(self, folder, say, options)

    def run(self, folder: str | Path, say: Say | None = _show, **options: Any) -> Run:
        """Run the case into a folder, and return its results.

        overwrite=True: remove an earlier run from it; resume=True: continue from its checkpoint; quiet=True: no progress, and no messages but
        of failures. say(kind, text) gets messages (MPS_JOB_MESSAGE) and progress (MPS_JOB_PROGRESS), which go to
        stderr by default; None: nothing.
        Ctrl-C stops after a step: resume=True continues. A case with a `sweep` is refused: see sweep()."""
        with self.build(folder, say, **options) as job:
            return job.run()

    def sweep(self, folder: str | Path, jobs: int = 1, say: Say | None = _show, overwrite: bool = False, quiet: bool = False) -> Sweep:
        """Run all combinations of `sweep` into folders 001, 002 ... of a folder, as `mps sweep` does, `jobs` of them at a time. A run that
        ended well is kept, a stopped one continues, so that a second call does the missing runs; the
        run of another case in
        such a folder is refused unless overwrite=True. All runs are tried; then the first failure is raised. Ctrl-C stops all after a step.
        Threads of each run: run.threads of the case; default: one if jobs > 1."""
        all_, source = sweep(self), self.text
        if not all_[0]:
            raise errors.error(N.MPS_E_STATE, "the case has no 'sweep': run(folder) runs it")
        if jobs < 1:
            raise errors.error(N.MPS_E_ARG, f"jobs is {jobs}: 1 or more are allowed")
        threads = {"run.threads": 1} if jobs > 1 and "\n  threads:" not in source else {}
        running, lock, stopped = [], threading.Lock(), threading.Event()

        def one(k: int) -> None:
            name = Path(folder) / f"{k + 1:03d}"
            with Case.parse(source, "case", {**threads, **self._set, **all_[k]}, "all" if self._loads else "none") as case:
                options = {} if overwrite or stopped.is_set() else _continues(case, name)
                if options is None or stopped.is_set():
                    return
                if say is not None:
                    say(N.MPS_JOB_MESSAGE, f"{name}: " + ", ".join(f"{path} {value}" for path, value in all_[k].items()))
                with case.build(name, say, quiet=quiet, **{"overwrite": overwrite, **options}) as job:
                    with lock:
                        running.append(job)
                    try:
                        job.run()
                    finally:
                        with lock:
                            running.remove(job)

        with ThreadPoolExecutor(jobs) as pool:
            futures = [pool.submit(one, k) for k in range(len(all_))]
            try:
                failed = [future.exception() for future in futures]
            except BaseException:
                stopped.set()
                with lock:
                    for job in running:
                        job.stop()
                raise
        for k, failure in enumerate(failed):
            if failure is not None:
                failure.args = (f"{Path(folder) / f'{k + 1:03d}'}: {failure}",)
                raise failure
        return Sweep(folder)


def _continues(case: Case, folder: Path) -> dict[str, bool] | None:
    """Options of run() that continue the run of a case in a folder, None: it is complete."""
    if not (folder / "case.yaml").exists():
        return {}
    with Case(folder / "case.yaml") as earlier:
        if _without_threads(case.text) != _without_threads(earlier.text):
            raise errors.error(N.MPS_E_STATE, "there is a run of another case; overwrite=True removes it, or choose another folder")
    if Run(folder).status == "ok":
        return None
    resume = (folder / "checkpoint.mps").exists()
    return {"resume": resume, "overwrite": not resume}  # killed, or failed: what is there is no use


def _without_threads(text_: str) -> list[str]:
    """A case without its threads, on which results do not depend."""
    return [line for line in text_.splitlines() if not line.startswith("  threads: ")]


_libc = ctypes.CDLL(None)
_free = _libc.free
_free.argtypes, _free.restype = [c_void_p], None


class Job(Owner):
    """A case that was built: `simulation`, and the files of its run. The case owns it; close()
    unlocks the folder."""

    def __init__(self, case: Case, folder: str | Path, say: Say | None, options: Mapping[str, Any]) -> None:
        self.case, self.folder = case, Path(folder)
        self._calls, self._messages, self._ran = Calls(), [], False  # type: ignore[var-annotated]
        for name in options:
            if name not in _OPTIONS:
                raise errors.error(N.MPS_E_ARG, f"run: unknown option '{name}'; allowed are {', '.join(_OPTIONS)}, say")
        error = ctypes.create_string_buffer(1024)
        config = make(T.mps_job_config, {"folder": str(folder), "command": " ".join(sys.argv),
                                         "signals": threading.current_thread() is threading.main_thread(), **options}, "run")
        config.error, config.error_size = ctypes.cast(error, POINTER(ctypes.c_char)), len(error)
        self._say = config.print = T.mps_job_print_fn(self._calls.guard(lambda _u, kind, what: self._told(say, kind, errors.in_python(text(what))), None))
        job, sim = POINTER(T.mps_job)(), POINTER(T.mps_sim)()
        with case._held as pointer:
            status = c.mps_case_job(pointer, byref(config), byref(job), byref(sim))
        case._check(status, text(error.value))
        self._held = Held("job", (job, sim), _destroy, case._held, self._calls)
        self.simulation = Simulation.adopt(sim, self)

    def _told(self, say: Say | None, kind: int, what: str) -> None:
        if kind == N.MPS_JOB_MESSAGE:
            self._messages.append(what.rstrip("\n"))
        if say is not None:
            say(kind, what)

    def __repr__(self) -> str:
        return f"<mps.Job in {self.folder}: {'closed' if self.closed else repr(self.simulation)}>"

    def run(self) -> Run:
        """Step to the end with all outputs, once."""
        with self._held as (job, sim), self.simulation._held:
            if self._ran:
                raise errors.error(N.MPS_E_STATE, "the job has run: build() makes another one, with overwrite=True or resume=True")
            self._ran = True
            code = c.mps_job_run(job, sim)
            what = text(c.mps_job_error(job)) or text(c.mps_sim_error(sim))
        if code == N.MPS_EXIT_INTERRUPTED and self._calls.failed is None:
            raise KeyboardInterrupt
        failed = [e for e in (self.simulation._calls.taken(), self._calls.taken()) if e is not None]
        if code not in (N.MPS_EXIT_OK, N.MPS_EXIT_INTERRUPTED):
            kind = errors.PluginError if failed else errors.Diverged if code == N.MPS_EXIT_DIVERGED else errors.Error
            raise kind(errors.in_python(what or f"the run ended with {code}")) from (failed[0] if failed else None)
        if failed:
            raise failed[0]
        return Run(self.folder, self._messages)

    def stop(self) -> None:
        """Stop the run after its step, with a checkpoint; for another thread or a callback. run() raises KeyboardInterrupt."""
        c.mps_job_stop(self._held.pointer[0])


def _destroy(both: tuple[Any, Any]) -> None:
    job, sim = both
    c.mps_sim_destroy(sim)
    c.mps_job_destroy(job)


def _swept(case: Case) -> Iterator[str]:
    """Paths of the sweep of a case."""
    for which in range(c.mps_case_sweep_count(case._held.pointer)):
        yield _setting(case, 0, which)[0]


def _setting(case: Case, run: int, which: int) -> tuple[str, str]:
    buffer = ctypes.create_string_buffer(4096)
    case._check(c.mps_case_sweep_get(case._held.pointer, run, which, buffer, len(buffer)))
    path, _, value = text(buffer.value).partition("=")
    return path, value


def sweep(case: Case) -> list[dict[str, str]]:
    """What each run of a case with `sweep` sets, for Case(..., set=...); [{}] of a case without."""
    paths = range(c.mps_case_sweep_count(case._held.pointer))
    return [dict(_setting(case, run, which) for which in paths) for run in range(c.mps_case_runs(case._held.pointer))]
