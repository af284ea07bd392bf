# SPDX-License-Identifier: BSD-3-Clause
"""Impacts in 20 rolled and surged tanks: which figure of an impact converges, which scatters, with and without trapped gas.

Runs tanks x spacings x repeats x models with `mps run` and adds their impacts to a table; what is there already is not run again.
Writes the tables of docs/explanations/impacts.md and docs/validation/sloshing_air.md to the terminal, and the plot."""
import argparse
import sys
from pathlib import Path

import report
import table
from cases import BREAKING, BREAKING_DEPTH, VARIANTS, Run, breaking, tanks
from runs import run_all

ROOT = Path(__file__).resolve().parent.parent.parent


def options() -> argparse.Namespace:
    p = argparse.ArgumentParser(prog="scripts/impacts", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", type=Path, default=ROOT / "build/release/apps/mps/mps", metavar="FILE", help="mps, built already")
    p.add_argument("--out", type=Path, default=ROOT / "out/impacts", metavar="DIR", help="folder of the runs (out/impacts)")
    p.add_argument("--rows", default="6,9,14", metavar="N,N", help="rows of particles over the depth (6,9,14)")
    p.add_argument("--variants", default="pocket,void,mmps", metavar="NAME,NAME", help="pocket, void, mmps (all, in this order)")
    p.add_argument("--tanks", metavar="N,N", help="numbers of tanks.csv; w22: breaking wave of Wen, Zhao & Wan 2022 (1 to 20)")
    p.add_argument("--repeats", type=int, default=10, metavar="N", help="at most so many runs of each (3 of a tank, 10 of w22)")
    p.add_argument("--minutes", type=float, default=1e9, metavar="M", help="begin no run after so many minutes")
    p.add_argument("--no-run", action="store_true", help="only read the table and the runs that are there")
    p.add_argument("--table", type=Path, default=ROOT / "docs/records/impacts.csv", metavar="FILE", help="all impacts (in docs/records)")
    p.add_argument("--plot", type=Path, metavar="FILE", help="draw the scatter, e.g. docs/plots/impact_scatter.svg")
    p.add_argument("--cases", type=Path, metavar="DIR", help="write the case files there and stop")
    o = p.parse_args()
    o.rows = [int(n) for n in o.rows.split(",")]
    o.variants = o.variants.split(",")
    if o.repeats < 1 or not set(o.variants) <= set(VARIANTS):
        p.error("--repeats: at least 1; --variants: " + ", ".join(VARIANTS))
    known = {tank.name: tank for tank in [*tanks(), breaking()]}
    names = o.tanks.split(",") if o.tanks else [tank.name for tank in tanks()]
    if not set(names) <= set(known):
        p.error("--tanks: " + ", ".join(known))
    o.tanks = [known[name] for name in names]
    return o


def known_runs(out: Path) -> list[Run]:
    """All runs that have a note."""
    known = {tank.name: tank for tank in [*tanks(), breaking()]}
    parts = [path.stem.split("_") for path in sorted(out.glob("*_*_*_*.json"))]
    return [Run(known[tank], int(rows), model, int(repeat) - 1) for tank, model, rows, repeat in parts]


def all_events(o: argparse.Namespace) -> tuple[list[table.Row], list[tuple[str, ...]]]:
    """The table, with the runs that are there instead of what it has of them."""
    old = table.read(o.table) if o.table.exists() else []
    runs = known_runs(o.out)
    new, failed = table.collect(o.out, runs)
    again = {(run.tank.name, run.variant, run.rows, run.repeat + 1) for run in runs}
    rows = [r for r in old if (r.tank, r.model, r.rows, r.repeat) not in again] + new
    rows.sort(key=lambda r: (r.tank == BREAKING, r.tank.zfill(2), r.rows, VARIANTS.index(r.model), r.repeat, r.t))
    return rows, failed


def main() -> int:
    o = options()
    most = min(o.repeats, max(tank.repeats for tank in o.tanks))
    wanted = [Run(tank, rows, model, repeat) for rows in o.rows for repeat in range(most) for tank in o.tanks for model in o.variants
              if repeat < tank.repeats]
    if o.cases:
        o.cases.mkdir(parents=True, exist_ok=True)
        for run in wanted:
            (o.cases / f"{run.name}.yaml").write_text(run.case(), encoding="utf-8")
        return 0
    if not o.no_run:
        run_all(o.program.resolve(), o.out, wanted, 60 * o.minutes)
    rows, failed = all_events(o)
    table.write(o.table, rows)
    report.write(table.read(o.table), failed, BREAKING_DEPTH)
    if o.plot:
        report.write_plot(o.plot, table.read(o.table))
    return 0


sys.exit(main())
