# SPDX-License-Identifier: BSD-3-Clause
"""What a run left behind, what is compared with it, and a figure with its verdict."""
import json
import re
from dataclasses import asdict, dataclass
from math import isfinite
from pathlib import Path

import numpy as np

GOOD, PASS, MISSED, NO_REFERENCE = "good", "pass", "not reached", "reference not given"


@dataclass
class Figure:
    """One measured value. `error` is what the limits are about; its unit is in `error_form`."""
    name: str
    value: float
    form: str = "{:.3g}"
    reference: float | None = None
    error: float | None = None
    error_form: str = ""
    verdict: str = ""

    def text(self):
        if isinstance(self.value, float) and not isfinite(self.value):
            return "not reached" if self.verdict else "-"
        text = self.form.format(self.value)
        if self.error is not None and self.error_form:
            text += f" ({self.error_form.format(self.error)})"
        return f"{text} {self.verdict}".strip()


def judge(error, good, fair):
    if fair is None:
        return ""
    if not isfinite(error):
        return MISSED
    return GOOD if abs(error) <= good else PASS if abs(error) <= fair else MISSED


def relative(name, value, reference, form, good=None, fair=None):
    """Error in per cent of the reference."""
    error = 100 * (value / reference - 1)
    return Figure(name, value, form, reference, error, "{:+.1f} %" if fair is None or fair > 1 else "{:+.2f} %", judge(error, good, fair))


def difference(name, value, reference, form, error_form, good=None, fair=None, scale=1.0):
    """Error as a difference, times `scale`."""
    error = scale * (value - reference)
    return Figure(name, value, form, reference, error, error_form, judge(error, None if good is None else scale * good, None if fair is None else scale * fair))


def bounded(name, value, form, good=None, fair=None):
    """A value that is itself an error, so that it has an order too."""
    return Figure(name, value, form, None, value, "", judge(value, good, fair))


def at_least(name, value, form, good, fair):
    verdict = MISSED if not isfinite(value) else GOOD if value >= good else PASS if value >= fair else MISSED
    return Figure(name, value, form, verdict=verdict)


def below(name, value, form, limit):
    return Figure(name, value, form, verdict=judge(value, limit, limit))


def fact(name, value, form):
    return Figure(name, value, form)


def absent(name):
    return Figure(name, float("nan"), verdict="", form=NO_REFERENCE)


class References:
    """Series to compare with, from a folder with reference/ and theory/; without it every series is None."""

    def __init__(self, folder):
        self.folder = Path(folder) if folder else None

    def series(self, name, columns):
        """Columns by number of a CSV file with one header line, or of a .txt file with blanks and none; or None."""
        path = self.folder / name if self.folder else None
        if not path or not path.exists():
            return None
        comma = path.suffix == ".csv"
        rows = np.genfromtxt(path, delimiter="," if comma else None, skip_header=int(comma))[:, columns]
        return rows[np.isfinite(rows).all(axis=1)].T


class Outcome:
    """A finished or failed run: its summary and series. Columns are read by name without the unit."""

    def __init__(self, run, folder):
        self.run, self.folder = run, Path(folder)
        self.dp = run.dp
        self.note = json.loads((self.folder / "run.json").read_text())
        self.summary = json.loads((self.folder / "summary.json").read_text())
        with open(self.folder / "probes.csv", encoding="utf-8") as file:
            names = [name.split("[")[0] for name in file.readline().strip().split(",")]
            rows = np.loadtxt(file, delimiter=",", ndmin=2)
        self.column = dict(zip(names, rows.T))
        self.t = self.column["t"]
        self.undo_lag()

    def averages(self):
        """Time [s] over which the sensors average, at the rows of probes.csv."""
        if self.summary.get("sensor_average") == "given":
            return np.full(len(self.t), float(self.summary.get("sensor_average_most") or 0))
        path = self.folder / "steps.csv"
        if not path.exists():
            return np.zeros(len(self.t))
        with open(path, encoding="utf-8") as file:
            names = [name.split("[")[0] for name in file.readline().strip().split(",")]
            if "crossing_time" not in names:  # an older build
                return np.zeros(len(self.t))
            t, average = np.loadtxt(file, delimiter=",", ndmin=2, usecols=(0, names.index("crossing_time"))).T
        return np.interp(self.t, t, average)

    def undo_lag(self):
        """A sensor shows the mean of the last `average` seconds, which belongs to the middle of them: wall pressures P1, P2, .. earlier by half."""
        half = 0.5 * self.averages()
        for name in self.column:
            if re.fullmatch(r"P\d+", name) and half.any():
                self.column[name] = np.interp(self.t, self.t - half, self.column[name])

    def __getitem__(self, name):
        return self.column[name]

    def beside(self, case):
        """The run of another case at the same spacing, if it is there."""
        try:
            return Outcome(self.run, self.folder.parent / f"{case}-{self.dp:g}")
        except (OSError, ValueError, KeyError):
            return None

    def at(self, name, t):
        """A column at one time, not a number after the end."""
        return float(np.interp(t, self.t, self[name])) if self.t[-1] > t - 1e-9 else np.nan

    def level(self, depth):
        """Still level as placed: whole layers where the driver does not say."""
        return self.summary.get("still_level") or np.floor(depth / self.dp + 1e-6) * self.dp

    @property
    def complete(self):
        return self.summary["status"] == "ok"


def to_json(figures):
    return [asdict(f) for f in figures]
