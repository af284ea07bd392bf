# SPDX-License-Identifier: BSD-3-Clause
"""Tables of docs/explanations/impacts.md and docs/validation/sloshing_air.md, and the plot of the first."""
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np
import table as tb
from cases import BREAKING, VARIANTS

EDGES = (0.0, 0.5, 1.0, 2.5, np.inf)  # of the time of a mean over dp/u
AIR = 1.2  # pressures with air are lower by this factor, by the paper
FEW = 4
RISES = (0.0, 1.0, 1.5, np.inf)  # of a peak, in dp/u

Found = dict[tb.Group, dict[int, tb.Row]]


def line(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cells) + " |"


def head(cells: Iterable[str]) -> list[str]:
    names = list(cells)
    return [line(names), "|" + "---|" * len(names)]


def middle(x: np.ndarray) -> str:
    """Median, and its band of 90 %."""
    lo, hi = tb.band(x)
    return "-" if np.isnan(lo) else f"{np.median(x):.2f} ({lo:.2f}-{hi:.2f})"


def there(found: Found, model: str, rows: int) -> bool:
    """Enough impacts for a column."""
    return len(tb.all_values(found, model, rows, 0)) > FEW


def counts(found: Found, rows: list[tb.Row], spacings: list[int], all_models: list[str]) -> list[str]:
    lines = head(["model", "rows", "runs", "impacts", "in tanks"])
    for model in all_models:
        for count in spacings:
            here = {key for key, r in found.items() if key[2:] == (model, count) and len(r) > 1}
            runs = {(r.tank, r.repeat) for r in rows if (r.model, r.rows) == (model, count)}
            if runs:
                lines.append(line([model, str(count), str(len(runs)), str(len(here)), str(len({key[0] for key in here}))]))
    return lines


def scatter(found: Found, spacings: list[int], all_models: list[str]) -> list[str]:
    """Standard deviation between repeats, and the largest over the least of them that one impact of ten exceeds."""
    columns = [(m, n) for m in all_models for n in spacings if there(found, m, n)]
    lines = head(["standard deviation, largest / least", *(f"{m} {n}" for m, n in columns)])
    for k, name in enumerate(tb.FIGURES):
        f = [tb.all_values(found, m, n, k) for m, n in columns]
        lines.append(line([name, *(f"{100 * tb.deviation(x):.0f} %, {tb.spread_of(x):.1f}" for x in f)]))
    return lines


def convergence(found: Found, spacings: list[int], all_models: list[str]) -> list[str]:
    pairs = [(m, a, b) for m in all_models for i, b in enumerate(spacings) for a in spacings[i + 1:]]
    pairs = [(m, a, b) for m, a, b in pairs if len(tb.ratios(found, (m, a), (m, b), 0)) > FEW]
    lines = head(["fine / coarse", *(f"{m} {a}/{b}" for m, a, b in pairs)])
    for k, name in enumerate(tb.FIGURES):
        lines.append(line([name, *(middle(tb.ratios(found, (m, a), (m, b), k)) for m, a, b in pairs)]))
    return lines


def models(found: Found, spacings: list[int], all_models: list[str]) -> list[str]:
    pairs = [(m, n) for m in all_models if m != "void" for n in spacings if len(tb.ratios(found, (m, n), ("void", n), 0)) > FEW]
    lines = head(["with gas / void", *(f"{m} {n}" for m, n in pairs)])
    for k, name in enumerate(tb.FIGURES):
        lines.append(line([name, *(middle(tb.ratios(found, (m, n), ("void", n), k)) for m, n in pairs)]))
    return lines


def pockets(found: Found, spacings: list[int]) -> list[str]:
    """Impacts that a pocket changes, and whether by more than chance: two runs of chance differ by sqrt(2) of the deviation."""
    lines = head(["gas.pocket / void", "impacts", "that differ", "geometric mean", "standard deviation", "by chance"])
    for n in spacings:
        for k in (tb.FIVE, tb.FIVE + 1, tb.FIVE + 2):
            x = tb.ratios(found, ("pocket", n), ("void", n), k)
            other = x[np.abs(x - 1) > 1e-3]
            chance = 2**0.5 * tb.deviation([y for m in spacings for y in tb.all_values(found, "void", m, k)])
            if len(x):
                log = np.log(other)
                cells = [f"{np.exp(log.mean()):.2f}", f"{100 * log.std(ddof=1):.0f} %"] if len(log) > 1 else ["-", "-"]
                lines.append(line([f"{n} rows, {tb.FIGURES[k]}", str(len(x)), str(len(other)), *cells, f"{100 * chance:.0f} %"]))
    return lines


def of_parts(what: str, find: Callable[[str], list[tb.Part]], all_models: list[str]) -> list[str]:
    lines = head(["model", what, "peaks", "standard deviation", "largest / least: one of ten exceeds"])
    for model in all_models:
        for lo, hi, count, deviation, high in find(model):
            if count > 1:
                lines.append(line([model, f"{lo:g} to {hi:g}", str(count), f"{100 * deviation:.0f} %", f"{high:.1f}"]))
    return lines


def by_time(found: Found, all_models: list[str]) -> list[str]:
    return of_parts("mean over, in dp/u", lambda model: tb.by_mean_time(found, model, EDGES), all_models)


def by_rise(found: Found, all_models: list[str]) -> list[str]:
    return of_parts("rise, in dp/u", lambda model: tb.by_rise(found, model, RISES), all_models)


def of_runs(rows: list[tb.Row], spacings: list[int], all_models: list[str]) -> list[str]:
    columns = [(m, n) for m in all_models for n in spacings if len(tb.runs_of(rows, max, m, n, 0)) > FEW]
    lines = head(["standard deviation", *(f"{m} {n}" for m, n in columns)])
    for k, name in enumerate(tb.FIGURES[:5]):
        for what, take in (("largest of a run", max), ("mean of a run", lambda x: float(np.mean(x)))):
            f = [tb.deviation_of_runs(tb.runs_of(rows, take, m, n, k)) for m, n in columns]
            lines.append(line([f"{name}, {what}", *("-" if np.isnan(x) else f"{100 * x:.0f} %" for x in f)]))
    return lines


def first_peaks(rows: list[tb.Row], model: str, count: int) -> dict[int, tuple[float, ...]]:
    """Figures of the first impact of the breaking wave, by repeat."""
    found: dict[int, tb.Row] = {}
    for r in rows:
        if (r.tank, r.model, r.rows) == (BREAKING, model, count) and r.figures[tb.FIVE] >= tb.LEAST:
            if r.repeat not in found or r.t < found[r.repeat].t:
                found[r.repeat] = r
    return {repeat: r.figures for repeat, r in found.items()}


def paper(rows: list[tb.Row], depth: float) -> list[str]:
    """Means and deviations of the runs; ratios of the means with bands of 90 %, and pairs of runs whose ratio is above AIR."""
    lines = head(["dp [m]", "model", "runs", *tb.FIGURES[:5]])
    for count in sorted({r.rows for r in rows if r.tank == BREAKING}):
        void = np.array(list(first_peaks(rows, "void", count).values()))
        for model in VARIANTS:
            x = np.array(list(first_peaks(rows, model, count).values()))
            if len(x) < 2:
                continue
            cells = [f"{np.mean(x[:, k]):.3g} +- {np.std(x[:, k], ddof=1):.2g}" for k in range(5)]
            lines.append(line([f"{depth / count:.3g}", model, str(len(x)), *cells]))
            if model != "void" and len(void) > 1:
                lines.append(line([f"{depth / count:.3g}", f"void / {model}", "", *(of_means(void[:, k], x[:, k]) for k in range(5))]))
                share = [np.mean(void[:, k][:, None] > AIR * x[:, k][None, :]) for k in range(5)]
                lines.append(line([f"{depth / count:.3g}", f"pairs above {AIR}", "", *(f"{100 * y:.0f} %" for y in share)]))
    return lines


def of_means(above: np.ndarray, below: np.ndarray) -> str:
    drawn = np.random.default_rng(1)
    pick = [drawn.choice(above, len(above)).mean() / drawn.choice(below, len(below)).mean() for _ in range(tb.RESAMPLES)]
    lo, hi = np.percentile(pick, (5, 95))
    return f"{above.mean() / below.mean():.2f} ({lo:.2f}-{hi:.2f})"


COLOURS = {"void": ("#a9c4e4", "#4c78a8", "#1f3f66"), "pocket": ("#b7dbae", "#54a24b", "#2a5a24"),
           "mmps": ("#fbc99a", "#f58518", "#9c4f05")}  # coarse to fine
LABELS = ("dp/u", "1 ms", "5 ms", "20 ms", "impulse\n60 ms", "panel\n5 ms", "panel\n20 ms", "panel\nimpulse\n60 ms")  # of FIGURES


def draw(panel: Any, columns: list[tuple[str, str, list[tuple[float, float, float]]]], title: str) -> None:
    """Values with bands, (value, lower, upper), of each figure, side by side for all columns (label, colour, values)."""
    for i, (label, colour, of_figures) in enumerate(columns):
        x = np.arange(len(of_figures)) + 0.7 * ((i + 0.5) / len(columns) - 0.5)
        y, lo, hi = np.array(of_figures).T
        panel.errorbar(x, y, (y - lo, hi - y), fmt="o", color=colour, markersize=4, linewidth=1.2, label=label)
    panel.set_xticks(range(len(LABELS)), LABELS)
    panel.set_title(title, loc="left", fontsize=9)
    panel.grid(axis="y", color="#e4e4e4", linewidth=0.6)
    panel.spines[["top", "right"]].set_visible(False)
    panel.legend(frameon=False, fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))


def write_plot(path: Path, rows: list[tb.Row]) -> None:
    """Scatter, convergence and what gas changes, of each figure."""
    import matplotlib
    matplotlib.use("svg")
    import matplotlib.pyplot as plt
    plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "libmps", "font.family": ["DejaVu Sans"], "font.size": 9})
    tanks = [r for r in rows if r.tank != BREAKING]
    found, spacings = tb.impacts(tanks), sorted({r.rows for r in tanks})
    figures = range(len(tb.FIGURES))

    def column(label: str, colour: str, of_figure: Callable[[int], np.ndarray]) -> tuple[str, str, list[tuple[float, float, float]]]:
        return label, colour, [(float(np.median(x)), *tb.band(x)) for x in map(of_figure, figures)]

    def scatter_of(model: str, n: int) -> list[tuple[float, float, float]]:
        return [(100 * d, 100 * d, 100 * d) for d in (tb.deviation(tb.all_values(found, model, n, k)) for k in figures)]

    shown = [(m, n, COLOURS[m][i]) for m in ("void", "mmps") for i, n in enumerate(spacings) if there(found, m, n)]
    first = [(f"{m}, {n} rows", colour, scatter_of(m, n)) for m, n, colour in shown]
    second = [column(f"{m}, {a} / {b} rows", COLOURS[m][i + 1], lambda k, m=m, a=a, b=b: tb.ratios(found, (m, a), (m, b), k))
              for m in ("void", "mmps") for i, (a, b) in enumerate(zip(spacings[1:], spacings))
              if len(tb.ratios(found, (m, a), (m, b), 0)) > FEW]
    third = [column(f"{m} / void, {n} rows", COLOURS[m][i], lambda k, m=m, n=n: tb.ratios(found, (m, n), ("void", n), k))
             for m in ("pocket", "mmps") for i, n in enumerate(spacings) if len(tb.ratios(found, (m, n), ("void", n), 0)) > FEW]
    titled = ((first, "standard deviation of one run [%]"), (second, "fine / coarse: median, band of 90 %"), (third, "with gas / void"))
    panels = [p for p in titled if p[0]]
    figure, axes = plt.subplots(len(panels), 1, figsize=(8.6, 2.3 * len(panels)), squeeze=False)
    for (columns, title), panel in zip(panels, axes[:, 0]):
        draw(panel, columns, title)
        if "/" in title:
            panel.axhline(1, color="#333333", linewidth=0.7)
        else:
            panel.set_ylim(0, None)
    figure.tight_layout(pad=0.6)
    figure.savefig(path, metadata={"Date": None, "Creator": None})


def write(rows: list[tb.Row], failed: list[tuple[str, ...]], depth: float) -> None:
    """All tables, to the terminal."""
    tanks = [r for r in rows if r.tank != BREAKING]
    spacings, found = sorted({r.rows for r in tanks}), tb.impacts(tanks)
    all_models = [m for m in VARIANTS if any(r.model == m for r in tanks)]
    tables = {
        "Impacts": counts(found, tanks, spacings, all_models),
        "Scatter: standard deviation, and largest / least that one of ten exceeds": scatter(found, spacings, all_models),
        "Scatter of runs": of_runs(tanks, spacings, all_models),
        "Scatter of single peaks by the time of their mean": by_time(found, all_models),
        "Scatter of the peaks of all means by their rise": by_rise(found, all_models),
        "Convergence: median of the impacts, band of 90 %": convergence(found, spacings, all_models),
        "Models": models(found, spacings, all_models),
        "Pockets": pockets(found, spacings),
        "Breaking wave of the paper, first impact, rho g depth and ms": paper(rows, depth),
        "Failed": [" ".join(f) for f in failed]}
    for title, lines in tables.items():
        print(f"\n{title}\n")
        print("\n".join(lines))
