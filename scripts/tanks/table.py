# SPDX-License-Identifier: BSD-3-Clause
"""The events of all runs as a table in a file, and what follows from it: scatter, convergence, ratios of models.

Events of different runs of a tank are the same impact if they are at the same wall at nearly the same time. Only impacts that all runs
of a comparison have are compared, and only those that are high in the median of the runs without gas."""
import csv
from collections import defaultdict
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import events as ev
import numpy as np
from cases import BREAKING, Run
from runs import note_of, signals

FIGURES = ("mean over dp/u", "peak 1 ms", "peak 5 ms", "peak 20 ms", "impulse of 60 ms", "panel, peak 5 ms", "panel, peak 20 ms",
           "panel, impulse of 60 ms")
COLUMNS = ("tank", "model", "rows", "repeat", "wall", "t/T", "dp/u", "rise", "rise1", "rise5", "rise20", "p", "p1", "p5", "p20", "I",
           "panel5", "panel20", "panelI")
BOTH = "void = pocket"  # model of a run without a pocket
FIVE = 2  # of FIGURES: peak 5 ms
SAME = 0.12  # of the period: events of one impact follow each other within this time, all runs together
LEAST = 3.0  # rho g depth: median of the 5 ms peaks without gas of an impact that counts
RESAMPLES = 1000


@dataclass(frozen=True)
class Row:
    """An event of a run; figures in rho g depth and, of impulses, rho g depth times 1 ms; times in ms of a tank of 1 m."""
    tank: str
    model: str
    rows: int
    repeat: int
    wall: str
    t: float  # in periods of the motion
    crossing: float
    rises: tuple[float, ...]  # of the peaks of the means, in dp/u: FIGURES[:4]
    figures: tuple[float, ...]  # of FIGURES; nan: none


def collect(out: Path, wanted: Iterable[Run]) -> tuple[list[Row], list[tuple[str, ...]]]:
    """Events of all runs that are there, and the runs that have none: failed ones, with why."""
    rows, failed = [], []
    for run in wanted:
        note = note_of(out, run)
        if note is None:
            continue
        s = signals(out, run)
        if note["exit"] != 0 or s is None:
            failed.append((run.tank.name, run.variant, str(run.rows), str(run.repeat + 1), note["message"]))
        if s is None:
            continue
        for e in ev.find(s, run.tank.walls, run.tank.depth, run.tank.forced_period, run.tank.time_scale):
            panel = (e.panel[1], e.panel[2], 1e3 * e.panel[3]) if e.panel else (np.nan,) * 3
            figures = (e.resolved, *e.peaks, 1e3 * e.impulse, *panel)
            rows.append(Row(run.tank.name, run.variant, run.rows, run.repeat + 1, e.wall, e.t, 1e3 * e.crossing, e.rises, figures))
    return rows, failed


def write(path: Path, rows: list[Row]) -> None:
    """The events that count, one line a run that is of both models."""
    counting = {r for repeats in groups(rows).values() for r in repeats if r.tank != BREAKING} | {r for r in rows if r.tank == BREAKING}
    void = {replace(r, model=BOTH) for r in counting if r.model == "void"}
    with open(path, "w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(COLUMNS)
        for r in rows:
            both = replace(r, model=BOTH) in void and replace(r, model="pocket") in counting
            if r not in counting or (both and r.model == "pocket"):
                continue
            out.writerow([r.tank, BOTH if both else r.model, r.rows, r.repeat, r.wall, f"{r.t:.2f}", f"{r.crossing:.1f}",
                          *(number(x, 2) for x in r.rises), *(number(x, 3) for x in r.figures)])


def number(x: float, digits: int) -> str:
    return "" if np.isnan(x) else f"{x:.{digits}g}"


def read(path: Path) -> list[Row]:
    with open(path, encoding="utf-8", newline="") as file:
        lines = list(csv.DictReader(file))

    def row(d: dict[str, str], model: str) -> Row:
        x = [float(d[c]) if d[c] else np.nan for c in COLUMNS[7:]]
        t, crossing = float(d["t/T"]), float(d["dp/u"])
        return Row(d["tank"], model, int(d["rows"]), int(d["repeat"]), d["wall"], t, crossing, tuple(x[:4]), tuple(x[4:]))

    return [row(d, model) for d in lines for model in (("void", "pocket") if d["model"] == BOTH else (d["model"],))]


# ---- impacts -----------------------------------------------------------------------------------------------------------

Group = tuple[str, int, str, int]  # tank, number of the impact, model, rows


def groups(rows: list[Row]) -> dict[tuple[str, int], list[Row]]:
    """Events by tank and number of the impact."""
    found: dict[tuple[str, int], list[Row]] = {}
    for tank in sorted({r.tank for r in rows}):
        number = 0
        for wall in sorted({r.wall for r in rows if r.tank == tank}):
            here = sorted((r for r in rows if (r.tank, r.wall) == (tank, wall)), key=lambda r: r.t)
            breaks = [i for i in range(1, len(here)) if here[i].t - here[i - 1].t > SAME]
            for part in np.split(np.arange(len(here)), breaks):
                same = [here[i] for i in part]
                number += 1
                void = [r.figures[FIVE] for r in same if r.model == "void"]
                if void and np.median(void) >= LEAST:
                    found[(tank, number)] = same
    return found


def impacts(rows: list[Row]) -> dict[Group, dict[int, Row]]:
    """Events by impact, model and rows: one of each repeat, the highest where there are two."""
    found: dict[Group, dict[int, Row]] = {}
    for (tank, number), same in groups(rows).items():
        for r in same:
            repeats = found.setdefault((tank, number, r.model, r.rows), {})
            if r.repeat not in repeats or repeats[r.repeat].figures[FIVE] < r.figures[FIVE]:
                repeats[r.repeat] = r
    return found


def values(repeats: dict[int, Row], k: int) -> np.ndarray:
    return np.array([r.figures[k] for r in repeats.values()])


def mean(repeats: dict[int, Row], k: int) -> float:
    """Geometric mean of the repeats: ratios of it do not depend on which is above the line."""
    return float(np.exp(np.mean(np.log(values(repeats, k)))))


def all_values(found: dict[Group, dict[int, Row]], model: str, rows: int, k: int) -> list[np.ndarray]:
    """Of each impact that two repeats or more have: a figure of the repeats."""
    return [values(r, k) for (_, _, m, n), r in found.items() if (m, n) == (model, rows) and len(r) > 1]


def ratios(found: dict[Group, dict[int, Row]], above: tuple[str, int], below: tuple[str, int], k: int) -> np.ndarray:
    """Means of each impact with one model and spacing over those with another; of the repeats that both have."""
    out = []
    for (tank, number, model, rows), r in found.items():
        other = found.get((tank, number, *below), {})
        both = r.keys() & other.keys()
        if (model, rows) == above and both:
            out.append(mean({n: r[n] for n in both}, k) / mean({n: other[n] for n in both}, k))
    return np.array(out)


def band(x: np.ndarray) -> tuple[float, float]:
    """90 % of the median, by resampling with a fixed seed."""
    if len(x) < 2:
        return np.nan, np.nan
    drawn = np.random.default_rng(1).choice(x, (RESAMPLES, len(x)))
    lo, hi = np.percentile(np.median(drawn, axis=1), (5, 95))
    return float(lo), float(hi)


Part = tuple[float, float, int, float, float]  # from, to, peaks, standard deviation, largest over least that one of ten exceeds


def deviation(of_impacts: list[np.ndarray]) -> float:
    """Standard deviation of the logarithm between repeats: of all impacts together, each about its own mean."""
    return float(np.sqrt(np.mean([np.var(np.log(x), ddof=1) for x in of_impacts]))) if of_impacts else np.nan


def spread_of(of_impacts: list[np.ndarray]) -> float:
    """Largest over least of three repeats that one impact of ten exceeds."""
    f = [x.max() / x.min() for x in of_impacts if len(x) == 3]
    return float(np.percentile(f, 90)) if f else np.nan


def parts(x: list[float], of_impacts: list[np.ndarray], edges: tuple[float, ...]) -> list[Part]:
    rows = []
    for lo, hi in zip(edges, edges[1:]):
        part = [y for at, y in zip(x, of_impacts) if lo <= at < hi]
        rows.append((lo, hi, len(part), deviation(part), spread_of(part)))
    return rows


def repeated(found: dict[Group, dict[int, Row]], model: str) -> list[dict[int, Row]]:
    """Impacts of a model that two repeats or more have, at all spacings."""
    return [r for (_, _, m, _), r in found.items() if m == model and len(r) > 1]


def by_mean_time(found: dict[Group, dict[int, Row]], model: str, edges: tuple[float, ...]) -> list[Part]:
    """Scatter of peaks over fixed times, by this time over dp/u."""
    pairs = [(1e3 * t / float(np.mean([x.crossing for x in r.values()])), values(r, k)) for r in repeated(found, model)
             for k, t in enumerate(ev.MEANS, 1)]
    return parts([x for x, _ in pairs], [y for _, y in pairs], edges)


def by_rise(found: dict[Group, dict[int, Row]], model: str, edges: tuple[float, ...]) -> list[Part]:
    """Scatter of the peaks of all means by the median of their rises in dp/u, which a page knows whatever the mean is."""
    pairs = [(float(np.median([x.rises[k] for x in r.values()])), values(r, k)) for r in repeated(found, model) for k in range(4)]
    return parts([x for x, _ in pairs], [y for _, y in pairs], edges)


def runs_of(rows: list[Row], take: Callable[[list[float]], float], model: str, count: int, k: int) -> dict[str, list[float]]:
    """A figure of each run, e.g. the largest of its events, by tank."""
    by_run: dict[tuple[str, int], list[float]] = defaultdict(list)
    for r in rows:
        if (r.model, r.rows) == (model, count) and r.tank != BREAKING:
            by_run[(r.tank, r.repeat)].append(r.figures[k])
    found: dict[str, list[float]] = defaultdict(list)
    for (tank, _), x in by_run.items():
        found[tank].append(take(x))
    return found


def deviation_of_runs(of_runs: dict[str, list[float]]) -> float:
    return deviation([np.array(x) for x in of_runs.values() if len(x) > 1])
