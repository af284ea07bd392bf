# SPDX-License-Identifier: BSD-3-Clause
"""Command line; see scripts/validate."""
import argparse
import sys
from pathlib import Path

import paper
from cases import LEVELS, find, runs
from page import Page, cell
from results import GOOD, PASS, References
from runs import Runner, say

ROOT = Path(__file__).resolve().parent.parent.parent


def arguments():
    p = argparse.ArgumentParser(prog="scripts/validate", description="Run the validation cases, compare them, write docs/validation.md, docs/validation/, docs/paper-cases.md and docs/plots.")
    p.add_argument("--no-install", action="store_true", help="do not install missing packages")
    p.add_argument("--data", metavar="DIR", help="folder with reference/ and theory/: series to compare with")
    p.add_argument("--jobs", type=int, default=1, metavar="N", help="runs at a time, each on one thread (1)")
    p.add_argument("--out", default=str(ROOT / "build/validation"), metavar="DIR", help="folder for the runs (build/validation)")
    p.add_argument("--only", metavar="CASE,CASE", help="these cases, also impact_*; the page is written from all that are there")
    p.add_argument("--resolutions", choices=LEVELS, default="standard", help="up to which spacing (standard)")
    p.add_argument("--build", default=str(ROOT / "build/release"), metavar="DIR", help="a build with mps and the drivers")
    p.add_argument("--no-run", action="store_true", help="evaluate what is there")
    p.add_argument("--docs", default=str(ROOT / "docs"), metavar="DIR", help="folder of the pages and plots (docs)")
    p.add_argument("--no-page", action="store_true", help="print the figures, write no page")
    p.add_argument("--again", action="store_true", help="run also what is there already")
    p.add_argument("--list", action="store_true", help="list the runs and stop")
    options = p.parse_args()
    if options.jobs < 1:
        p.error(f"--jobs {options.jobs}: at least 1")
    try:
        options.cases = find(options.only.split(",") if options.only else None)
    except ValueError as error:
        p.error(f"--only: {error}")
    if options.data and not Path(options.data).is_dir():
        p.error(f"--data: no folder {options.data}")
    return options


def show(page, cases):
    for case in cases:
        for outcome, figures in page.results[case.name]:
            say(f"\n{outcome.run.name}")
            for figure in figures:
                say(f"  {figure.name:58s} {cell(figure)}")


def worse_than_expected(page, cases):
    """Figures of the coarsest spacing that once reached their limits and do not any more."""
    for case in cases:
        for outcome, figures in page.results[case.name]:
            if outcome.dp != next(iter(case.spacings)) or outcome.run.cfl is not None:
                continue
            if not outcome.complete:
                yield f"{outcome.run.name}: {outcome.summary['status']}"
            verdicts = {figure.name: figure.verdict for figure in figures}
            for name in case.expected:
                if verdicts.get(name) not in (GOOD, PASS):
                    yield f"{outcome.run.name}: {name}: {verdicts.get(name) or 'missing'}"


def main():
    options = arguments()
    wanted = runs(options.cases, options.resolutions)
    runner = Runner(options.build, options.out, options.jobs, options.again)
    if options.list:
        for run in wanted:
            say(f"{run.name:34s} {run.level:9s} {run.minutes:6.1f} min  {' '.join(runner.command(run))}")
        say(f"{sum(run.minutes for run in wanted):.0f} CPU minutes")
        return 0
    if not options.no_run:
        runner.run_all(wanted)
    cases = find(None) if not options.no_page else options.cases
    page = Page(runner, cases, References(options.data))
    show(page, options.cases)
    if not options.no_page:
        page.write(Path(options.docs))
        paper.write(page, Path(options.docs))
        say(f"\nwrote {options.docs}/validation.md, validation/, paper-cases.md and plots")
    worse = list(worse_than_expected(page, options.cases))
    for text in worse:
        say(f"WORSE {text}")
    failed = [] if options.no_run else [run.name for run in wanted if not runner.note(run)]
    for name in failed:
        say(f"NOT THERE {name}")
    return 1 if worse or failed else 0


sys.exit(main())
