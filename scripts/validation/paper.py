# SPDX-License-Identifier: BSD-3-Clause
"""docs/paper-cases.md and its pictures: the conclusions of Wen, Zhao & Wan 2022 one by one, and which model gets how far in which case."""
import re
from pathlib import Path

import numpy as np

import conclusions as c
import evaluate as e
import frames as fr
import measures as m
import phases as ph
import plots
import theory
from page import PAPER, items, table
from plots import Panel

MODELS = ("imps", "imps.paper", "mmps", "mmps.paper")
# row of the table -> model -> (case, the other model in it), or why there is none
CASES = {
    "two fluids at rest, 1000 : 1": dict.fromkeys(MODELS, "static_two_fluid"),
    "Rayleigh-Taylor, 1.8 : 1": dict.fromkeys(MODELS, "rayleigh_taylor"),
    "drop at rest, 775 : 1": dict.fromkeys(MODELS, "droplet"),
    "drop that oscillates": dict.fromkeys(MODELS, "droplet_oscillation"),
    "rising bubble, 10 : 1": dict.fromkeys(MODELS, "rising_bubble"),
    "slug on an air cushion, 775 : 1": dict.fromkeys(MODELS, "air_cushion"),
    "half-full tank (5.1)": {"imps": "sloshing_high_fill", "imps.paper": "sloshing_high_fill", "mmps": "high_fill_air", "mmps.paper": "high_fill_air"},
    "shallow tank (5.2)": {"imps": "low_fill_flow", "imps.paper": "sloshing_low_fill", "mmps": "low_fill_flow_air", "mmps.paper": "low_fill_flow_air"},
    "breaking wave (5.3)": {"imps": "sloshing_breaking", "imps.paper": "sloshing_breaking", "mmps": "breaking_air", "mmps.paper": "breaking_air"},
}
OWN = {case: "mmps" if rows["mmps"] == case else "imps" for rows in CASES.values() for case in rows.values()}  # the model a case is made for


def of_models(book, **names):
    """(name, outcome) of runs that are there: name=(case, model)."""
    return [(name.replace("_", "."), o) for name, at in names.items() if (o := book.get(*at))]


def ran(book, case, model):
    """How far a model got, at each spacing."""
    texts = []
    for o in book.all(case, None if OWN[case] == model else model):
        s = o.summary
        if o.complete:
            texts.append(f"{s['t_end']:.3g} s, its end (dp {o.dp:g})")
        else:
            texts.append(f"**{s['t_end']:.3g} s**, {s['status']} (dp {o.dp:g})")
    return "<br>".join(texts) if texts else "not run"


def models_table(book):
    return table(["case", *(f"`{model}`" for model in MODELS)], [[name, *(ran(book, rows[model], model) for model in MODELS)] for name, rows in CASES.items()])


def failures_table(book):
    rows = []
    for name, cases in CASES.items():
        for model in MODELS:
            for o in book.all(cases[model], None if OWN[cases[model]] == model else model):
                if not o.complete:
                    message = re.sub(r"\s+", " ", o.summary["error"] or "").replace("|", "/")
                    rows.append((f"{name}, `{model}`, dp {o.dp:g}", message))
    return items(rows) if rows else "None."


# ---- pictures --------------------------------------------------------------------------------------------------------

def overlay(panel, runs, values, references=()):
    for name, o in runs:
        panel.curve(name, o.t, values(o))
    for label, t, y in references:
        panel.reference(label, t, y)
    return panel


def static_figures(book, folder):
    at = [("imps.paper", book.get("static_two_fluid", "imps.paper")), ("imps", book.get("static_two_fluid", "imps")), ("mmps", book.get("static_two_fluid")),
          ("mmps.paper", book.get("static_two_fluid", "mmps.paper"))]
    runs = [(f"{name}, dp {o.dp:g}", o) for name, o in at if o]
    exact = theory.G * (ph.LIGHT * ph.LAYER + ph.HEAVY * 0.25)
    longer = [(name, o) for name, o in runs if len(o.t) > 20]
    panels = [overlay(Panel("P2, 0.5 m above the floor, less the exact one", "Pa", y_limits=(-500, 500)), longer, lambda o: o["P2"] - exact),
              overlay(Panel("kinetic energy", "J/m", logarithmic=True, y_limits=(1e-6, 1e4)), longer, lambda o: o["ke"])]
    if plots.save(folder / "paper_static.svg", panels):
        yield "paper_static.svg"
    ends = [o.folder / "picture_end.png" for _, o in runs]
    if plots.pictures(folder / "paper_static_flow.png", ends, columns=4, width=310):
        yield "paper_static_flow.png"


def interface_lines(refs, t):
    """Segments of the reference's interface, or none."""
    path = refs.folder / f"reference/rt_interface_t{t}.dat" if refs.folder else None
    if not path or not path.exists():
        return []
    blocks = [block.split() for block in path.read_text().split("\n\n")]
    return [np.array(block, float).reshape(-1, 2) for block in blocks if len(block) == 4]


def taylor_figures(book, folder):
    at = of_models(book, mmps=("rayleigh_taylor_flow", None), imps=("rayleigh_taylor_flow", "imps"), mmps_paper=("rayleigh_taylor", "mmps.paper"))
    runs, ref, panels = [(f"{name}, dp {o.dp:g}", o) for name, o in at], book.refs.series(*ph.TIPS_SERIES), []
    for i, (name, text) in enumerate((("ytop", "highest"), ("ybot", "lowest")), 1):
        panel = overlay(Panel(f"{text} point of the interface", "m"), runs, lambda o, name=name: o[name], [] if ref is None else [("volume of fluid", ref[0], ref[i])])
        if ref is None:
            panel.marks("volume of fluid", [tip[0] for tip in ph.TIPS], [tip[i] for tip in ph.TIPS])
        panels.append(panel)
    if runs and plots.save(folder / "paper_taylor.svg", panels):
        yield "paper_taylor.svg"
    row = [(f"{name}, {t} s", fr.near(o.folder, t), o.dp, interface_lines(book.refs, t)) for name, o in at if name == "mmps" for t in (1, 2, 3, 5)]
    if plots.flow(folder / "paper_taylor_flow.png", [row] if row else [], (0, 2)):
        yield "paper_taylor_flow.png"


def side_by_side(book, folder, file, cases, at, window, one_row=False):
    """Frames of a case without and with gas beside each other, one row a time or all in one; over the second the outline of the first."""
    one, two = book.pair(*cases)
    rows = []
    for t in at:
        a, b = (fr.near(o.folder, t) if o else None for o in (one, two))
        rows.append([(f"{name}, {t:.2f} s", frame, o.dp, lines) for name, o, frame, lines in (
            ("imps", one, a, ()), ("mmps; line: imps", two, b, fr.outline(a, one.dp) if a else ())) if o])
    if plots.flow(folder / file, [sum(rows, [])] if one_row else rows, window):
        yield file


def high_fill_figures(book, folder):
    runs = of_models(book, imps=("high_fill_late", None), mmps=("high_fill_late_air", None))
    p = overlay(Panel("P1, 20 ms mean", "Pa"), runs, lambda o: m.running_mean(o.t, o["P1"], 0.02) - (c.water_above(o) if "air" in o.run.case else 0))
    eta = overlay(Panel("height 0.02 m from the right wall, 20 ms mean", "m"), runs, lambda o: m.running_mean(o.t, o["eta_right"], 0.02))
    for panel, points in ((p, e.HIGH_FILL_PEAKS), (eta, e.HIGH_FILL_CRESTS)):
        panel.marks("FNPF", *zip(*points))
    if runs and plots.save(folder / "paper_high_fill.svg", [p, eta]):
        yield "paper_high_fill.svg"
    yield from side_by_side(book, folder, "paper_high_fill_flow.png", ("high_fill_late", "high_fill_late_air"), (4.8, 6.8), (0, 0.6), True)


def low_fill_figures(book, folder):
    yield from side_by_side(book, folder, "paper_low_fill_flow.png", ("low_fill_flow", "low_fill_flow_air"), (2.75, 4.80, 6.10, 7.85), (0, 0.12))
    panels = []
    for name, o in of_models(book, imps=("low_fill_flow", None), mmps=("low_fill_flow_air", None)):
        if fr.times(o.folder):
            s = c.surface(o.folder, o.dp)
            panels.append((f"{name}, dp {o.dp:g}", s.x, s.t, 1e3 * s.h, (c.STANDING, c.TRAVELLING, c.SECOND, c.RUN_UP)))
    if plots.maps(folder / "paper_low_fill_waves.png", panels, "depth [mm]"):
        yield "paper_low_fill_waves.png"


def breaking_figures(book, folder):
    distance = Panel("greatest distance between the outlines of imps and mmps off the walls", "dp", y_limits=(0, 8))
    for dp in (0.02, 0.01):
        one, two = book.get("breaking_start", None, dp), book.get("breaking_start_air", None, dp)
        if one and two and fr.times(one.folder) and fr.times(two.folder):
            rows = c.outlines_apart(one, two)
            distance.curve(f"dp {dp:g}", rows[:, 0], rows[:, 2]).curve(f"dp {dp:g}, 95 % of them", rows[:, 0], rows[:, 3])
    distance.reference(f"{c.SAME} dp", [0, c.SAME_UNTIL], [c.SAME] * 2)
    if plots.save(folder / "paper_breaking_profiles.svg", [distance]):
        yield "paper_breaking_profiles.svg"
    yield from side_by_side(book, folder, "paper_breaking_flow.png", ("breaking_start", "breaking_start_air"), (1.9, 2.2, 2.3, 2.4, 2.5, 2.6), (0, 0.55))
    runs = [(f"{name}, dp {o.dp:g}", o) for name, case in (("imps", "breaking_start"), ("mmps", "breaking_start_air")) for o in book.all(case)]
    panels = [overlay(Panel(f"{p}, 2 ms mean", "Pa"), runs, lambda o, p=p: np.where(o.t > 0.05, m.running_mean(o.t, o[p], 0.002), np.nan)) for p in ("P1", "P3")]
    panels.append(overlay(Panel("air that is closed in", "cm2"), runs, lambda o: 1e4 * o["air_volume"]))
    if runs and plots.save(folder / "paper_breaking.svg", panels):
        yield "paper_breaking.svg"


SECTIONS = {"static": (c.static, static_figures), "rayleigh_taylor": (c.rayleigh_taylor, taylor_figures), "high_fill": (c.high_fill, high_fill_figures),
            "low_fill": (c.low_fill, low_fill_figures), "breaking": (c.breaking, breaking_figures)}
TITLES = {"static": "Two fluids at rest", "rayleigh_taylor": "Rayleigh-Taylor instability", "high_fill": "Half-full tank", "low_fill": "Shallow tank",
          "breaking": "Breaking wave"}


def checks_list(checks):
    """Numbered: the verdict, what the paper says, what is computed, why it differs."""
    lines = []
    for number, check in enumerate(checks, 1):
        verdict, _, because = check.verdict().partition(", because ")
        lines.append(f"{number}. **{verdict.capitalize()}**: {check.says}.\n   Computed: {check.found or '-'}." + (f"\n   Reason: {because}." if because else ""))
    return "\n".join(lines)


def overview(found):
    rows = []
    for name, checks in found.items():
        verdicts = [check.verdict().split(",")[0] for check in checks]
        rows.append([f"[{TITLES[name]}](#{TITLES[name].lower().replace(' ', '-')})"] + [verdicts.count(v) or "" for v in (c.CONFIRMED, c.NOT_CONFIRMED, c.NOT_RUN)])
    return table(["case", c.CONFIRMED, c.NOT_CONFIRMED, c.NOT_RUN], rows)


def write(page, docs):
    """docs/paper-cases.md from the text of paper-cases.md.in."""
    folder, book = docs / "plots", c.Book(page)
    found = {name: list(checks(book)) for name, (checks, _) in SECTIONS.items()}

    def section(match):
        name = match.group(1)
        images = [f"![{name.replace('_', ' ')}](plots/{file})" for file in SECTIONS[name][1](book, folder)]
        return "\n\n".join([checks_list(found[name]), *images])

    text = PAPER.read_text(encoding="utf-8")
    here = {case for rows in CASES.values() for case in rows.values()} | page.paper
    used = [o for runs in book.runs.values() for o in runs if o.run.case in here]
    older = sum(not o.current for o in used)
    text = text.replace("@older@", f"{older} of {len(used)} runs are of drivers that have been built anew since.\n\n" if older else "")
    text = text.replace("@overview@", overview(found)).replace("@models@", models_table(book)).replace("@failures@", failures_table(book))
    text = re.sub(r"@section (\w+)@", section, text)
    (docs / "paper-cases.md").write_text(text, encoding="utf-8")
