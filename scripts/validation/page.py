# SPDX-License-Identifier: BSD-3-Clause
"""The pages of the validation and docs/plots/ from the runs that are there: tables and plots are put into the text of pages/**/*.md.in."""
import json
import re
from pathlib import Path

import figures as fig
import measures
import plots
import trust
from results import GOOD, MISSED, NO_REFERENCE, PASS, to_json

PAGES = Path(__file__).resolve().parent / "pages"  # laid out as docs/
PAPER = PAGES / "paper-cases.md.in"  # written by paper.py


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def items(rows):
    """What is too long for a cell: a list of (name, text)."""
    return "\n".join(f"* {name}: {text}" for name, text in rows)


def cell(figure):
    if figure is None:
        return "-"
    return NO_REFERENCE if figure.form == NO_REFERENCE else figure.text()


def column_name(outcome):
    cfl = "" if outcome.run.cfl is None else f", cfl {outcome.run.cfl:g}"
    return f"dp {outcome.dp:g}{cfl}" + ("" if outcome.current else " (older build)")


def figure_table(results):
    """Rows are figures, columns are spacings, then the observed order where there is an error."""
    names = list(dict.fromkeys(f.name for _, figures in results for f in figures))
    plain = [o.run.cfl is None for o, _ in results]
    with_order = sum(plain) > 1 and any(f.error is not None for _, figures in results for f in figures)
    rows = []
    for name in names:
        found = [next((f for f in figures if f.name == name), None) for _, figures in results]
        reference = next((f for f in found if f is not None and f.reference is not None), None)
        row = [name, reference.form.format(reference.reference) if reference else ""] + [cell(f) for f in found]
        if with_order:
            same = [(o.dp, f.error if f else None) for (o, _), f, use in zip(results, found, plain) if use]
            slope = measures.order(*zip(*same))
            row.append("" if slope is None else f"{slope:.1f}")
        rows.append(row)
    head = ["", "reference"] + [column_name(o) for o, _ in results] + (["order"] if with_order else [])
    return table(head, rows)


def run_table(outcomes):
    rows = []
    for o in outcomes:
        s = o.summary
        numerical = f"{o['numerical'][-1]:+.3g}" if "numerical" in o.column else ""
        whole = not s.get("t_resumed")  # else the times are those of its last part
        rows.append([column_name(o).split(" (")[0][3:], f"{s['n_fluid']} + {s['n_wall']} + {s['n_dummy']}", "end" if o.complete else f"{s['status']} at {s['t_end']:.3g} s",
                     s["steps"], f"{s['cpu_s']:.0f}" if whole else "", f"{1e3 * s['cpu_s'] / max(1, s['steps']):.1f}" if whole else "", f"{100 * s['volume_error']:+.2f} %",
                     s["particles_lost"], f"{s['max_speed']:.2g}", numerical])
    head = ["dp [m]", "fluid + wall + dummy", "reached", "steps", "CPU s", "ms/step", "volume error", "lost", "max speed [m/s]", "`numerical` [J/m, 3-D: J]"]
    return table(head, rows)


def command_lines(outcomes):
    plain = [o for o in outcomes if o.run.cfl is None] or outcomes
    o = plain[0]
    spacings = ", ".join(f"{o.dp:g}" for o in plain)
    if o.run.of_mps:
        return f"`mps run cases/{o.run.program}{''.join(f' --set {chr(34)}{value}{chr(34)}' for value in o.run.options)}`, dp {spacings} m"
    return f"`{' '.join((o.run.program, *o.run.options))} --dp {spacings}`"


def overview(results):
    """How many figures of each case reached which limit at its finest spacing; below the table those that did not."""
    rows, missed = [], []
    for name, found in results.items():
        if found:
            outcome, figures = found[-1]
            count = {verdict: sum(f.verdict == verdict for f in figures) for verdict in (GOOD, PASS, MISSED)}
            rows.append([name, f"{outcome.dp:g}", *count.values()])
            if count[MISSED]:
                missed.append((name, "; ".join(f.name.split(" [")[0] for f in figures if f.verdict == MISSED)))
    return table(["case", "finest dp", *(GOOD, PASS, MISSED)], rows) + "\n\nNot reached:\n\n" + items(missed)


def others_table(outcomes):
    rows, messages = [], []
    for o in outcomes:
        s = o.summary
        message = re.sub(r"\s+", " ", s["error"] or "").replace("|", "/")
        name = f"`{o.run.program.removesuffix('.yaml')}`" + (" (3-D)" if s.get("dim") == 3 else "")
        rows.append([name, o.run.other_model, f"{o.dp:g}", f"{s['t_end']:.2f} s", "end" if o.complete else s["status"]])
        if message:
            messages.append((f"{name} with {o.run.other_model}", message))
    return table(["case", "model", "dp", "ran to", "status"], rows) + "\n\nMessages:\n\n" + items(messages) if rows else "Not run."


class Page:
    """Everything that is known about the runs; `paper`: cases that are made for docs/paper-cases.md."""

    def __init__(self, runner, cases, refs):
        self.refs, self.results, self.others = refs, {}, []
        self.paper = {case.name for case in cases if case.paper}
        for case in cases:
            outcomes = [o for o in (runner.outcome(run) for run in case.runs()) if o]
            self.others += [o for o in outcomes if o.run.other_model]
            found = [(o, case.evaluate(o, refs) if len(o.t) > 1 or o.complete else [])
                     for o in sorted((o for o in outcomes if not o.run.other_model), key=lambda o: (-o.dp, o.run.cfl is None, o.run.cfl))]
            for o, figures in found:
                (o.folder / "figures.json").write_text(json.dumps(to_json(figures), indent=1, default=float) + "\n")
            self.results[case.name] = found

    def section(self, name, folder, plots_link):
        results = self.results.get(name, [])
        if not results:
            return "Not run."
        outcomes = [o for o, _ in results]
        parts = [command_lines(outcomes), figure_table(results), run_table(outcomes)]
        for picture in self.draw(name, outcomes, folder):
            parts.append(f"![{name.replace('_', ' ')}]({plots_link}/{picture})")
        return "\n\n".join(parts)

    def draw(self, name, outcomes, folder):
        complete = [o for o in outcomes if len(o.t) > 20]
        if name in fig.PLOTS and complete:
            for file, panels in fig.PLOTS[name](complete, self.refs):
                if plots.save(folder / file, panels):
                    yield file
        if name in fig.PICTURES:
            file, numbers, *part = fig.PICTURES[name]
            if plots.pictures(folder / file, [outcomes[-1].folder / f"picture_{n}.png" for n in numbers], *part):
                yield file

    def write(self, docs):
        folder = docs / "plots"
        folder.mkdir(parents=True, exist_ok=True)
        rows = list(trust.rows(self.results))
        tables = {"first": table(trust.FIRST, trust.first(rows)), "trust": table(trust.HEAD, rows),
                  "overview": overview({name: found for name, found in self.results.items() if name not in self.paper}),
                  "others": others_table([o for o in self.others if o.run.case not in self.paper])}
        for template in sorted(set(PAGES.rglob("*.md.in")) - {PAPER}):
            page = (docs / template.relative_to(PAGES)).with_suffix("")
            plots_link = "../" * len(template.relative_to(PAGES).parent.parts) + "plots"
            text = re.sub(r"@(first|trust|overview|others)@", lambda match: tables[match.group(1)], template.read_text(encoding="utf-8"))
            text = re.sub(r"@case (\w+)@", lambda match, link=plots_link: self.section(match.group(1), folder, link), text)
            page.parent.mkdir(exist_ok=True)
            page.write_text(text, encoding="utf-8")
