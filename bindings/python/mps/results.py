# SPDX-License-Identifier: BSD-3-Clause
"""Results of runs: columns, frames, impacts and the summary of a folder that `mps run`, a driver or Case.run() wrote."""
from __future__ import annotations

import csv
import ctypes
import json
import re
import warnings
from collections.abc import Iterator, Mapping, Sequence
from ctypes import POINTER, byref
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from . import _numbers as N
from . import _structs as T
from . import errors
from ._files import open_regular, read_text, text_of
from ._library import c
from ._records import Record, coded, make, record, text
from .frame import Frame

if TYPE_CHECKING:
    from .case import Case


def _config(sets: Mapping[str, Any] | None = None) -> tuple[Any, Any]:
    """Constants of the statistics, with the buffer of error texts."""
    config, error = make(T.mps_stats_config, dict(sets or {}), "impacts"), ctypes.create_string_buffer(1024)
    config.error, config.error_size = ctypes.cast(error, POINTER(ctypes.c_char)), len(error)
    return config, error


_LINE = 1 << 20  # most bytes of the line of names
_SINGLE = 2  # columns that are read alone: numbers cost more than lines


class Table(Mapping[str, np.ndarray]):
    """Columns of a CSV file of a run by their names without the unit, "t" first: table["P1"] is an array [rows] in SI units. Nothing is read
    before a column is used: two columns with the time one by one, then all. refresh() discards them, for a run
    in progress. An incomplete last line is ignored, because a run may be writing it. pandas.DataFrame(dict(table)) has all columns."""

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self._columns: dict[str, np.ndarray] = {}
        self._reads = 0

    @cached_property
    def _names(self) -> list[tuple[str, str]]:
        with open_regular(self.path) as file:
            line = text_of(file.readline(_LINE), self.path)
        try:
            words = next(csv.reader([line]), [])
        except csv.Error as e:
            raise errors.error(N.MPS_E_IO, f"{self.path}: {e}") from None
        return [(name, unit.rstrip("]")) for name, _, unit in (word.strip().partition("[") for word in words)]

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column, "" for none."""
        return dict(self._names)

    def _read(self, *names: str) -> dict[str, np.ndarray]:
        """Time and columns; all without names."""
        config, error = _config()
        table = POINTER(T.mps_table)()
        words = (ctypes.c_char_p * max(len(names), 1))(*[name.encode() for name in names])
        status = c.mps_table_read(byref(config), coded(str(self.path)), len(names), words, byref(table))
        if status < 0:
            raise errors.error(status, text(error.value))
        try:
            rows, found = c.mps_table_rows(table), {}
            for k in range(-1, c.mps_table_columns(table)):
                values = np.ctypeslib.as_array(c.mps_table_values(table, k), (rows,)).copy() if rows else np.empty(0)
                found[text(c.mps_table_name(table, k))] = values
            return found
        finally:
            c.mps_table_destroy(table)

    def refresh(self) -> None:
        """Read the file again when a column is next used."""
        self._columns, self._reads = {}, 0
        self.__dict__.pop("_names", None)

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._columns:
            if name not in self:
                raise errors.error(N.MPS_E_NAME, f"{self.path}: no column '{name}'; there are {', '.join(self)}")
            self._reads += 1
            if self._reads <= _SINGLE and len(self) > 1:
                time, *others = self
                self._columns.update(self._read(name if name != time else others[0]))
            else:
                self._columns = self._read()
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter([name for name, _ in self._names])

    def __len__(self) -> int:
        return len(self._names)

    def __contains__(self, name: object) -> bool:
        return any(name == known for known, _ in self._names)

    def __repr__(self) -> str:
        if not self.path.exists():
            return f"<{self.path}: no such file>"
        return f"<{self.path}: {', '.join(f'{n} [{u}]' if u else n for n, u in self._names)}>"


class FrameSeries(Sequence[Frame]):
    """Frames of a run in the order of time; each is read when it is used. run.frames[-1], run.frames.at(2.5), len(run.frames)."""

    def __init__(self, folder: Path, name: str = "frames.pvd") -> None:
        self._folder, self._name = folder, name

    @cached_property
    def _series(self) -> list[tuple[float, Path]]:
        path = self._folder / self._name
        if not path.exists():
            return []
        found = re.findall(r'<DataSet timestep="([^"]*)"[^>]* file="([^"]*)"', read_text(path))
        try:
            return sorted((float(t), self._folder / file) for t, file in found)
        except ValueError as e:
            raise errors.error(N.MPS_E_IO, f"{path}: {e}") from None

    @property
    def t(self) -> np.ndarray:
        """Times of the frames [s]."""
        return np.array([t for t, _ in self._series])

    def at(self, t: float) -> Frame:
        """The frame nearest to a time [s]."""
        if not self._series:
            raise errors.error(N.MPS_E_IO, f"{self._folder}: the run has no frames")
        return self[int(np.abs(self.t - t).argmin())]

    @overload
    def __getitem__(self, index: int) -> Frame: ...
    @overload
    def __getitem__(self, index: slice) -> list[Frame]: ...
    def __getitem__(self, index: int | slice) -> Frame | list[Frame]:
        if isinstance(index, slice):
            return [Frame(path, t) for t, path in self._series[index]]
        t, path = self._series[index]
        return Frame(path, t)

    def __len__(self) -> int:
        return len(self._series)

    def __repr__(self) -> str:
        if not self._series:
            return "<no frames>"
        return f"<{len(self)} frames, t = {self._series[0][0]:g} to {self._series[-1][0]:g} s>"


class Impacts(Sequence[Record]):
    """Impacts in one column: its events in the order of time, as records with t, peak, rise, decay, duration, impulse, unresolved."""

    def __init__(self, name: str, path: Path, config: Any, error: Any, t: np.ndarray, p: np.ndarray) -> None:
        self.name, found = name, POINTER(T.mps_impacts)()
        t, p = np.ascontiguousarray(t), np.ascontiguousarray(p)
        status = c.mps_impacts_find(byref(config), len(t), *[a.ctypes.data_as(POINTER(ctypes.c_double)) for a in (t, p)], byref(found))
        if status < 0:
            raise errors.error(status, f"{path}: column '{name}': {text(error.value)}")
        try:
            self.info = self._got(c.mps_impacts_info_get, T.mps_impacts_info, found)
            self._events = [self._got(c.mps_impacts_get, T.mps_impact, found, k) for k in range(self.info.events)]
            self.weibull, self.pareto = [self._got(c.mps_impacts_fit_get, T.mps_fit, found, k) for k in (N.MPS_FIT_WEIBULL, N.MPS_FIT_PARETO)]
        finally:
            c.mps_impacts_destroy(found)

    @staticmethod
    def _got(get: Any, kind: Any, *given: Any) -> Record:
        one = make(kind)
        status = get(*given, byref(one))
        if status < 0:
            raise errors.error(status)
        return record(one)

    @overload
    def __getitem__(self, index: int) -> Record: ...
    @overload
    def __getitem__(self, index: slice) -> list[Record]: ...
    def __getitem__(self, index: int | slice) -> Record | list[Record]:
        return self._events[index]

    def __len__(self) -> int:
        return len(self._events)

    def __repr__(self) -> str:
        highest = f", the highest {max(e.peak for e in self):g} Pa" if self._events else ""
        return f"<{self.name}: {len(self)} impacts above {self.info.threshold:g} Pa{highest}>"


class Run:
    """The folder of a run, finished or in progress: data are read at their first use.

        run = mps.Run("out")
        t, p = run.columns["t"], run.columns["P1"]   # arrays in SI units; run.columns.units["P1"]
        run.frames.at(2.5)["position"]               # [n, 3] m; run.peaks: those at peaks
        run.impacts("P1"), run.summary["steps"], run.case"""

    def __init__(self, folder: str | Path, messages: Sequence[str] = ()) -> None:
        self.folder = Path(folder)
        self._messages = list(messages)
        if not any((self.folder / name).exists() for name in ("summary.json", "probes.csv", "case.yaml")):
            raise errors.error(N.MPS_E_IO, f"{self.folder}: no folder of a run: it has none of summary.json, probes.csv and case.yaml")
        self.columns = Table(self.folder / "probes.csv")
        self.momentum = Table(self.folder / "momentum.csv")
        self.steps = Table(self.folder / "steps.csv")
        self.trace = Table(self.folder / "trace.csv")

    @property
    def status(self) -> str:
        """"ok", a failure code such as "diverged", or "unfinished": in progress, stopped or
        killed."""
        if not (self.folder / "summary.json").exists():
            return "unfinished"
        status = self.summary.get("status")
        if not isinstance(status, str):
            raise errors.error(N.MPS_E_IO, f"{self.folder / 'summary.json'}: no summary of a run: it has no 'status'")
        return status

    @property
    def summary(self) -> dict[str, Any]:
        """summary.json; its keys are explained in docs/tutorials/post_processing.md. FileError: the run has not written it yet."""
        path = self.folder / "summary.json"
        if not path.exists():
            raise errors.error(N.MPS_E_IO, f"{path}: not there: the run is unfinished; its columns and frames can be read")
        try:
            found = json.loads(read_text(path))
        except (ValueError, RecursionError) as e:
            raise errors.error(N.MPS_E_IO, f"{path}: no JSON: {e}") from None
        if not isinstance(found, dict):
            raise errors.error(N.MPS_E_IO, f"{path}: no summary of a run: it has no keys")
        return found

    def _listed(self, key: str, name: str, value: str) -> dict[str, str]:
        """A list of objects of summary.json, as {name: value}."""
        try:
            return {str(one[name]): str(one[value]) for one in self.summary[key]}
        except (KeyError, TypeError):
            why = f"'{key}' is no list with '{name}' and '{value}'"
            raise errors.error(N.MPS_E_IO, f"{self.folder / 'summary.json'}: no summary of a run: {why}") from None

    @property
    def messages(self) -> list[str]:
        """The log of Case.run(); for a folder opened later, the reason of a failure."""
        if self._messages or self.status == "unfinished":
            return list(self._messages)
        return [self.summary["error"]] if self.summary.get("error") else []

    @property
    def about(self) -> dict[str, str]:
        """Description and position of each column of `columns`."""
        return self._listed("columns", "name", "about")

    @property
    def inputs(self) -> dict[str, str]:
        """Inputs of the case by their paths, with units: {"fill.water.depth": "0.1 m"}."""
        return self._listed("inputs", "key", "value")

    @property
    def case(self) -> Case:
        """The case as run."""
        from .case import Case

        return Case(self.folder / "case.yaml")

    @property
    def frames(self) -> FrameSeries:
        """Frames of particles."""
        return FrameSeries(self.folder)

    @property
    def peaks(self) -> FrameSeries:
        """Frames at the highest peaks of each pressure, as output.peaks of the case sets them."""
        return FrameSeries(self.folder, "peaks.pvd")

    def impacts(self, column: str, **settings: Any) -> Impacts:
        """Impacts in a pressure, with the constants of the run; settings change them: threshold="6 kPa" as in a case, threshold=6e3 as in
        mps_stats_config; from_ is `from`, a Python keyword."""
        settings = {key.rstrip("_"): value for key, value in settings.items()}
        config, error = _config()
        status = c.mps_stats_config_read(coded(str(self.folder)), byref(config))
        texts = [f"impacts.{key}={value}" for key, value in settings.items() if isinstance(value, str)]
        numbers = {key: value for key, value in settings.items() if not isinstance(value, str)}
        given, _ = _config(numbers)
        for key in numbers:
            setattr(config, key, getattr(given, key))
        for one in texts:
            status = c.mps_stats_config_set(byref(config), one.encode()) if status >= 0 else status
        if status < 0:
            raise errors.error(status, text(error.value))
        return Impacts(column, self.columns.path, config, error, self.columns["t"], self.columns[column])

    def __repr__(self) -> str:
        return f"<mps.Run {self.folder}: {self.status}, {len(self.columns) if self.columns.path.exists() else 'no'} columns, {len(self.frames)} frames>"


class Sweep(Sequence[Run]):
    """Runs of a sweep, a repetition or a convergence: subfolders 001, 002 ... of a folder. `for run, values in mps.Sweep("out").items():`"""

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)
        found = sorted((p for p in self.folder.glob("[0-9]*") if re.fullmatch("[0-9]+", p.name) and p.is_dir()), key=lambda p: int(p.name))
        self._runs, failed = [], []
        for path in found:
            try:
                self._runs.append(Run(path))
            except errors.FileError:
                failed.append(path.name)
        if failed:
            warnings.warn(f"{self.folder}: no run in {', '.join(failed)}", stacklevel=2)
        if not self._runs:
            raise errors.error(N.MPS_E_IO, f"{self.folder}: no folder of a sweep: it has no runs in folders 001, 002, ...")

    @cached_property
    def parameters(self) -> list[dict[str, str]]:
        """For each run the inputs that differ between runs, with units: {"fill.water.depth":
        "0.1 m"}. {}: it is unfinished."""
        all_ = [run.inputs if (run.folder / "summary.json").exists() else {} for run in self._runs]
        known = [given for given in all_ if given]
        keys = [key for key in (known[0] if known else {}) if _is_path(key) and len({given.get(key) for given in known}) > 1]
        return [{key: given[key] for key in keys if key in given} for given in all_]

    def items(self) -> Iterator[tuple[Run, dict[str, str]]]:
        """Each run with its parameters."""
        return zip(self._runs, self.parameters)

    @overload
    def __getitem__(self, index: int) -> Run: ...
    @overload
    def __getitem__(self, index: slice) -> list[Run]: ...
    def __getitem__(self, index: int | slice) -> Run | list[Run]:
        return self._runs[index]

    def __len__(self) -> int:
        return len(self._runs)

    def __repr__(self) -> str:
        return f"<mps.Sweep {self.folder}: {len(self)} runs over {', '.join(self.parameters[0]) or 'nothing that differs'}>"


def _is_path(key: str) -> bool:
    """Whether an input is a path of a case; other inputs, such as T1, are derived."""
    return "." in key or key in ("dp", "preset", "title")
