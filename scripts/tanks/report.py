# SPDX-License-Identifier: BSD-3-Clause
"""Tables of docs/explanations/impacts.md and docs/validation/sloshing_air.md, and the plot of the first."""
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
import table as tb
from cases import BREAKING, VARIANTS
from events import MEANS

EDGES = (0.0, 1.0, 2.5, np.inf)  # of the time of a mean over dp/u
AIR = 1.2  # pressures with air are lower by this factor, by the paper
FEW = 4
RISES = (0.0, 1.0, 1.5, 2.5, 5.0, np.inf)  # of a peak, in dp/u

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
    pairs = [(m, a, b) for m in all_models for i, b in enumerate(spacings) for a in spacings[i + 1:] if there(found, m, a) and there(found, m, b)]
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
    """Means and deviations of the runs; ratios of the means with bands of 90 % by resampling, and pairs of runs whose ratio is above AIR."""
    lines = head(["dp [m]", "model", "runs", *tb.FIGURES[:5]])
    for count in sorted({r.rows for r in rows if r.tank == BREAKING}):
        void = np.array(list(first_peaks(rows, "void", count).values()))
        for model in VARIANTS:
            x = np.array(list(first_peaks(rows, model, count).values()))
            if len(x) < 2:
                continue
            lines.append(line([f"{depth / count:.3g}", model, str(len(x)), *(f"{np.mean(x[:, k]):.3g} +- {np.std(x[:, k], ddof=1):.2g}" for k in range(5))]))
            if model != "void" and len(void) > 1:
                lines.append(line([f"{depth / count:.3g}", f"void / {model}", "", *(of_means(void[:, k], x[:, k]) for k in range(5))]))
                share = [np.mean(void[:, k][:, None] > AIR * x[:, k][None, :]) for k in range(5)]
                lines.append(line([f"{depth / count:.3g}", f"pairs above {AIR}", "", *(f"{100 * y:.0f} %" for y in share)]))
    return lines


def of_means(above: np.ndarray, below: np.ndarray) -> str:
    drawn = np.random.default_rng(1)
    lo, hi = np.percentile([drawn.choice(above, len(above)).mean() / drawn.choice(below, len(below)).mean() for _ in range(tb.RESAMPLES)], (5, 95))
    return f"{above.mean() / below.mean():.2f} ({lo:.2f}-{hi:.2f})"


def write_plot(path: Path, rows: list[tb.Row]) -> None:
    """Scatter of single peaks over the time of their mean in dp/u, a panel a model."""
    import matplotlib
    matplotlib.use("svg")
    import matplotlib.pyplot as plt
    plt.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "libmps", "font.family": ["DejaVu Sans"], "font.size": 9})
    found = tb.impacts([r for r in rows if r.tank != BREAKING])
    shown = [m for m in VARIANTS if tb.repeated(found, m)]
    figure, axes = plt.subplots(1, len(shown), figsize=(3.2 * len(shown) + 0.4, 2.8), sharey=True, squeeze=False)
    for model, panel in zip(shown, axes[0]):
        for k, (time, colour) in enumerate(zip(MEANS, ("#4c78a8", "#f58518", "#54a24b")), 1):
            both = [(1e3 * time / np.mean([x.crossing for x in r.values()]), tb.values(r, k).max() / tb.values(r, k).min())
                    for r in tb.repeated(found, model)]
            x, y = np.array(both).T
            panel.plot(x, y, ".", color=colour, markersize=3, label=f"mean over {1e3 * time:.0f} ms")
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.set_ylim(0.95, 6)
        panel.set_yticks([1, 1.5, 2, 3, 5], ["1", "1.5", "2", "3", "5"])
        panel.minorticks_off()
        panel.set_title(model, loc="left", fontsize=9)
        panel.set_xlabel("time of the mean / (dp/u)")
        panel.grid(color="#e4e4e4", linewidth=0.6)
    axes[0][0].set_ylabel("largest / least of the runs")
    axes[0][-1].legend(frameon=False, fontsize=8)
    figure.tight_layout(pad=0.6)
    figure.savefig(path, metadata={"Date": None, "Creator": None})


def write(rows: list[tb.Row], failed: list[tuple[str, ...]], depth: float) -> None:
    """All tables, to the terminal."""
    tanks = [r for r in rows if r.tank != BREAKING]
    spacings, found = sorted({r.rows for r in tanks}), tb.impacts(tanks)
    all_models = [m for m in VARIANTS if any(r.model == m for r in tanks)]
    for title, lines in (("Impacts", counts(found, tanks, spacings, all_models)), ("Scatter: standard deviation, and largest / least that one of ten exceeds", scatter(found, spacings, all_models)),
                         ("Scatter of runs", of_runs(tanks, spacings, all_models)),
                         ("Scatter of single peaks by the time of their mean", by_time(found, all_models)),
                         ("Scatter of the peaks of all means by their rise", by_rise(found, all_models)),
                         ("Convergence: median of the impacts, band of 90 %", convergence(found, spacings, all_models)),
                         ("Models", models(found, spacings, all_models)), ("Breaking wave of the paper, first impact, rho g depth and ms", paper(rows, depth)),
                         ("Failed", [" ".join(f) for f in failed])):
        print(f"\n{title}\n")
        print("\n".join(lines))
