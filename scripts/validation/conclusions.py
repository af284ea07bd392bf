# SPDX-License-Identifier: BSD-3-Clause
"""The conclusions of Wen, Zhao & Wan 2022, each with a number and a verdict: what is measured for docs/paper-cases.md.

Every function takes a Book, which finds runs, and yields Checks."""
import csv
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

import evaluate as e
import frames as fr
import measures as m
import phases as ph
from theory import G, WATER

CONFIRMED, NOT_CONFIRMED, NOT_RUN = "confirmed", "not confirmed", "not run"
STANDING, TRAVELLING, SECOND, RUN_UP = 2.75, 4.80, 6.10, 7.85  # what is seen when in the shallow tank [s]
REACH = 0.15  # of these times [s]
SHALLOW, WIDTH = 0.03, 0.6  # depth of the shallow tank, its length [m]
SAME_UNTIL, SAME = 2.2, 1.5  # profiles are the same up to this time [s], within so many spacings
FILM, BREAKING_LENGTH = 3, 1.3  # at the walls, where films run down [dp]; the tank [m]
CUSHIONED = 1.2  # largest pressure without air / with air
IMPACTS = Path(__file__).resolve().parents[2] / "docs/records/impacts.csv"  # of several runs, by scripts/impacts --tanks w22
BREAKING_DEPTH, LEAST_IMPACT = 0.18, 3.0  # [m]; mean over 5 ms of an impact, in rho g times the depth


@dataclass
class Check:
    """One conclusion: what the paper says, what is computed, whether that agrees (None: not run), and why not."""
    says: str
    found: str
    holds: bool | None
    because: str = ""

    def verdict(self):
        if self.holds is None:
            return NOT_RUN
        if self.holds:
            return CONFIRMED
        return f"{NOT_CONFIRMED}, because {self.because}" if self.because else NOT_CONFIRMED


class Book:
    """Finds what was run: (case, model) at a spacing; without a spacing the finest."""

    def __init__(self, page):
        self.refs, self.runs = page.refs, {}
        for name, found in page.results.items():
            self.runs[name, None] = [o for o, _ in found]
        for o in page.others:
            self.runs.setdefault((o.run.case, o.run.other_model), []).append(o)

    def all(self, case, model=None):
        return self.runs.get((case, model), [])

    def get(self, case, model=None, dp=None):
        return next((o for o in reversed(self.all(case, model)) if dp is None or o.dp == dp), None)

    def pair(self, one, two):
        """Runs of two cases at the finest spacing of both; what there is if there is none."""
        both = {o.dp for o in self.all(one)} & {o.dp for o in self.all(two)}
        dp = min(both, default=None)
        return self.get(one, None, dp), self.get(two, None, dp)


def ended(o):
    s = o.summary
    return f"reaches its end, {s['t_end']:.3g} s" if o.complete else f"{s['status']} at {s['t_end']:.2g} s"


def how_it_ended(o):
    return f"dp {o.dp:g}: {ended(o)}, up to {o.summary['max_speed']:.2g} m/s"


def missing(*says):
    return [Check(text, "", None) for text in says]


# ---- two fluids at rest ----------------------------------------------------------------------------------------------

def holds_still(o):
    """At rest to the end: no particle beyond the interface, pressures right."""
    use, errors = o.t > 0.5, []
    for i, y in enumerate((0.25, 0.5, 0.75)):
        exact = ph.LIGHT * G * ph.LAYER + ph.HEAVY * G * (ph.LAYER - y)
        errors.append(abs(o[f"P{i + 1}"][use].mean() - exact) / (ph.HEAVY * G * ph.LAYER) if use.any() else np.nan)
    trespass = o.summary["trespass"]
    return o.complete and trespass < o.dp and max(errors) < 0.02, max(errors), trespass


def still_check(o, says, because):
    good, error, trespass = holds_still(o)
    found = how_it_ended(o)
    if o.complete:
        found += f"; pressures within {100 * error:.2f} % of rho g h, furthest beyond the interface {trespass / o.dp:+.2f} dp"
    return Check(says, found, bool(good), because)


def static(book):
    throws = "IMPS, the code for one phase, does not stand 1000 : 1: it throws the light fluid up and blows up"
    when = "... at 0.03 s, falls back at 0.08 s, blows up at 0.2 s"
    holds = "MMPS holds"
    paper, imps, mmps, literal = (book.get("static_two_fluid", model) for model in ("imps.paper", "imps", None, "mmps.paper"))
    if paper:
        yield Check(f"`imps.paper`: {throws}", how_it_ended(paper), not paper.complete and paper.t[-1] < 0.3)
        yield Check(f"`imps.paper`: {when}", f"the light fluid is thrown up at {paper.t[-1]:.2g} s and the run is over", bool(0.03 < paper.t[-1] < 0.3),
                    "it happens within a few steps, whatever their length")
    else:
        yield from missing(f"`imps.paper`: {throws}", f"`imps.paper`: {when}")
    if imps:
        yield Check(f"`imps`: {throws}", how_it_ended(imps), not imps.complete,
                    "its source and gradient are those of mmps: pairs have the mean density of both particles")
    if mmps:
        yield still_check(mmps, f"`mmps`: {holds}", "")
    if literal:
        yield still_check(literal, f"`mmps.paper`: {holds}", "the stabilising term of (18) rearranges the lattice at rest, and nothing damps the motion")


# ---- Rayleigh-Taylor ---------------------------------------------------------------------------------------------------

def tips_error(o, times):
    return max(max(abs(o.at("ytop", t) - top), abs(o.at("ybot", t) - bottom)) for t, top, bottom in ph.TIPS if t in times)


def rayleigh_taylor(book):
    limits = "the tips are within 0.03 m to 3 s and 0.06 m to 5 s"
    for name, says, model, because in (
            ("mmps", f"MMPS follows the reference: {limits}", None, "fingers that are a few spacings wide are not resolved"),
            ("mmps.paper", "the same", "mmps.paper", "the light finger rises too fast and is cut off from below at this spacing"),
            ("imps", "the same (not in the paper)", "imps", "fingers that are a few spacings wide are not resolved")):
        o = book.get("rayleigh_taylor_flow", model) or book.get("rayleigh_taylor", model)
        if not o:
            yield from missing(f"`{name}`: {says}")
        elif not o.complete:
            yield Check(f"`{name}`: {says}", how_it_ended(o), False, "the literal equations do not last that long")
        else:
            early, late = tips_error(o, (1, 2, 3)), tips_error(o, (4, 5))
            yield Check(f"`{name}`: {says}", f"dp {o.dp:g}: {early:.3f} m and {late:.3f} m", bool(early <= 0.03 and late <= 0.06), because)


# ---- half-full tank ----------------------------------------------------------------------------------------------------

def together(one, two, name, window):
    """A series of two runs at the times of both, smoothed."""
    n = min(len(one.t), len(two.t))
    return one.t[:n], m.running_mean(one.t[:n], one[name][:n], window), m.running_mean(one.t[:n], two[name][:n], window)


def water_above(o):
    """Pressure of the half spacing of water that the model with gas has above the upper row."""
    return WATER * G * o.dp / 2


def high_fill(book):
    one, two = book.pair("high_fill_late", "high_fill_late_air")
    says = ("IMPS and MMPS agree about the pressure P1: within 2 % up to 5 s", "P1 has two humps a period from 3 s on, with both",
            "IMPS and MMPS agree about the elevation up to 5 s: within a tenth of the crests", "... and differ after 5 s")
    if not one or not two:
        yield from missing(*says)
        return
    t, p, q = together(one, two, "P1", 0.02)
    use = (t > 0.2) & (t < 5)
    apart = 100 * np.abs((q - water_above(two)) / p - 1)[use]
    yield Check(says[0], f"dp {one.dp:g}, 20 ms means: {apart.max():.1f} % at {t[use][np.argmax(apart)]:.2f} s, {np.sqrt((apart**2).mean()):.2f} % rms",
                bool(apart.max() <= 2), "the troughs of P1 are less deep with air, by as much as the wave is lower; the humps agree")
    dips = [m.dip(t, y, *humps) for y in (p, q) for humps in ((3.30, 3.60), (4.21, 4.55))]
    yield Check(says[1], "dips between the humps at 3.3 and 4.2 s: imps {:.0f} and {:.0f} Pa, mmps {:.0f} and {:.0f} Pa".format(*dips), min(dips) > 0)
    t, p, q = together(one, two, "eta_right", 0.02)
    rms = [float(np.sqrt(((p - q)[(t > lo) & (t < hi)] ** 2).mean())) for lo, hi in ((0.2, 5), (5, 8))]
    crest = p[t < 5].max()
    text = "rms difference {:.1f} mm to 5 s, {:.1f} mm from 5 to 8 s".format(*(1e3 * r for r in rms))
    yield Check(says[2], f"{text}; highest crest to 5 s {1e3 * crest:.0f} mm", rms[0] <= 0.1 * crest)
    yield Check(says[3], text, rms[1] > 2 * rms[0])


# ---- shallow tank ------------------------------------------------------------------------------------------------------

class Surface:
    """Heights of the liquid over place and time, from the frames of a run: `h` smoothed over 50 mm, and `left` as it is beside the left wall."""

    def __init__(self, folder, dp, columns=60):
        self.folder, self.dp = folder, dp
        rows = [(t, *fr.heights(fr.Frame(t, path), dp, columns)) for t, path in fr.times(folder)]
        self.x, self.t = rows[0][1], np.array([row[0] for row in rows])
        self.left = np.array([row[2][0] for row in rows])
        self.h = np.array([m.running_mean(self.x, row[2], 5 * WIDTH / columns) for row in rows])

    def crests(self, i, least=0.1 * SHALLOW):
        """Places of the maxima of one frame that stand out by `least` on both sides."""
        h, found = self.h[i], []
        for k in range(len(h)):
            if (k > 0 and h[k - 1] > h[k]) or (k + 1 < len(h) and h[k + 1] >= h[k]):
                continue
            sides = []
            for part in (h[:k][::-1], h[k + 1:]):
                higher = np.flatnonzero(part > h[k])
                reach = part[:higher[0]] if len(higher) else part
                sides.append(h[k] - reach.min() if len(reach) else np.inf)
            if min(sides) >= least:
                found.append(k)
        return self.x[found]

    def inner(self, i, margin=0.06):
        return [x for x in self.crests(i) if margin < x < WIDTH - margin]

    def frames(self, near):
        return np.flatnonzero(np.abs(self.t - near) <= REACH + 1e-9)


def standing(s):
    """Frames about 2.75 s without a crest between the walls."""
    there = [i for i in s.frames(STANDING) if not s.inner(i) and np.ptp(s.h[i]) > 0.1 * SHALLOW]
    i = min(there, key=lambda i: abs(s.t[i] - STANDING), default=None)
    if i is None:
        return False, "crests between the walls"
    side = "right" if s.h[i][-1] > s.h[i][0] else "left"
    return True, f"{s.t[i]:.2f} s: one slope, {1e3 * np.ptp(s.h[i]):.0f} mm, high at the {side} wall"


def travelling(s):
    """A single crest about 4.80 s, and its speed."""
    track = [(s.t[i], s.inner(i)[0]) for i in s.frames(TRAVELLING) if len(s.inner(i)) == 1]
    if len(track) < 3:
        return False, "no single crest between the walls"
    t, x = np.array(track).T
    speed = np.polyfit(t, x, 1)[0]
    return abs(speed) > 0.3, f"{t[0]:.2f}-{t[-1]:.2f} s: a crest from x = {x[0]:.2f} to {x[-1]:.2f} m, {speed:+.2f} m/s"


def second(s):
    """Frames about 6.10 s with two crests at once."""
    there = [i for i in s.frames(SECOND) if len(s.crests(i)) >= 2 and s.inner(i)]
    i = min(there, key=lambda i: abs(s.t[i] - SECOND), default=None)
    if i is None:
        return False, "one crest only"
    return True, f"{s.t[i]:.2f} s: crests at x = {', '.join(f'{x:.2f}' for x in s.crests(i))} m"


def run_up(s):
    """A time about 7.85 s at which the liquid stands highest at the left wall, higher than before and after."""
    there = [i for i in s.frames(RUN_UP) if s.left[i] == s.left[max(0, i - 2):i + 3].max() and s.left[i] > 1.5 * SHALLOW]
    if not there:
        return False, "no run-up"
    i = max(there, key=lambda i: s.left[i])
    return True, f"{s.t[i]:.2f} s: {1e3 * s.left[i]:.0f} mm at the left wall, {s.left[i] / SHALLOW:.1f} times the depth"


def breaks(s):
    """An outline that overhangs by a spacing or more in the left half about 7.85 s."""
    there = [(fr.overhang(fr.outline(fr.near(s.folder, s.t[i]), s.dp), WIDTH / 2), s.t[i]) for i in s.frames(RUN_UP)]
    most, t = max(there, default=(0.0, np.nan))
    return most >= s.dp, f"outlines overhang by {most / s.dp:.1f} dp at most, at {t:.2f} s"


@cache
def surface(folder, dp):
    return Surface(folder, dp)


def low_fill(book):
    says = {standing: "2.75 s: a standing wave", travelling: "4.80 s: a travelling crest", second: "6.10 s: a second crest",
            run_up: "7.85 s: run-up at the left wall", breaks: "... where it breaks"}
    runs = [(name, o, surface(o.folder, o.dp)) for name, o in (("imps", book.get("low_fill_flow")), ("mmps", book.get("low_fill_flow_air")))
            if o and fr.times(o.folder)]
    for measure, text in says.items():
        if not runs:
            yield from missing(text)
        for name, o, heights in runs:
            good, found = measure(heights)
            yield Check(f"`{name}`: {text}", f"dp {o.dp:g}: {found}", bool(good), "six particles of depth do not resolve that" if measure is breaks else "")


# ---- breaking wave -----------------------------------------------------------------------------------------------------

@cache
def outlines_apart(one, two):
    """Of the outlines of two runs in frames of the same time, in spacings: [(t, greatest distance, greatest off the walls,
    95 % of those)]."""
    rows, other = [], fr.times(two.folder)
    for t, path in fr.times(one.folder):
        u, path_two = min(other, key=lambda entry: abs(entry[0] - t))
        if t < 0.05 or abs(u - t) > 0.006:
            continue
        lines = [fr.points(fr.outline(fr.Frame(t, p), one.dp), one.dp / 2) for p in (path, path_two)]
        x, d = fr.apart(*lines)
        off = (x > FILM * one.dp) & (x < BREAKING_LENGTH - FILM * one.dp)
        rows.append((t, d.max() / one.dp, d[off].max() / one.dp, np.percentile(d[off], 95) / one.dp))
    return np.array(rows)


def breaking_profiles(book):
    for dp in (0.02, 0.01):
        one, two = book.get("breaking_start", None, dp), book.get("breaking_start_air", None, dp)
        says = f"IMPS and MMPS have the same profiles up to {SAME_UNTIL} s, within {SAME} dp, off the walls (dp {dp:g})"
        if not one or not two or not fr.times(one.folder) or not fr.times(two.folder):
            yield from missing(says)
            continue
        rows = outlines_apart(one, two)
        early = rows[rows[:, 0] < SAME_UNTIL + 0.02]
        worst, first = early[np.argmax(early[:, 2])], early[early[:, 2] > SAME]
        yield Check(says, f"greatest distance {worst[2]:.2f} dp at {worst[0]:.1f} s, 95 % of the outline within {early[:, 3].max():.2f} dp"
                    + (f"; beyond {SAME} dp from {first[0, 0]:.1f} s" if len(first) else "")
                    + f" (in the {FILM} dp beside the walls, where films run down: {early[:, 1].max():.1f} dp)", not len(first),
                    "run-up and breaking crests differ by a few particles, see the picture; the greatest distance is "
                    f"{1e3 * worst[2] * dp:.0f} mm here")


def breaking_cavity(book):
    for name, case, fate, filled in (("imps", "breaking_start", "IMPS fills the cavity", True), ("mmps", "breaking_start_air", "MMPS keeps it, cushioned", False)):
        o, says = book.get(case), f"`{name}`: the wave overturns and closes a cavity at 2.3 s"
        if not o:
            yield from missing(says, f"`{name}`: {fate}")
            continue
        figures = {f.name: f.value for f in e.cavity(o)}
        closes = figures["cavity, closes"]
        if not np.isfinite(closes):
            first = (o.t > 1.8) & (o.t < 2.9)
            largest = o["air_volume"][first].max() / o.dp**2
            yield Check(says, f"dp {o.dp:g}: no more than {largest:.0f} dp2 closed in, first impact at {impact(o)}", False,
                        "a cavity counts from 10 dp2 on that last 20 ms, and whether this one does depends on the run" if largest > 10 else
                        "the crest is too thick to overturn at this spacing")
            yield Check(f"`{name}`: {fate}", "no cavity that lasts", False)
            continue
        left, least = 1e4 * o["air_volume"][-1], figures["cavity, least / largest volume within 0.12 s"]
        yield Check(says, f"dp {o.dp:g}: closes at {closes:.2f} s, first impact at {impact(o)}", abs(closes - e.CLOSING) <= 0.1,
                    "it overturns 0.2 s later; the front meets the wall at the same time with every spacing and model")
        yield Check(f"`{name}`: {fate}", f"{figures['cavity, largest volume']:.1f} cm2, within 0.12 s no less than {100 * least:.0f} % of it, at 3 s {left:.1f} cm2",
                    bool(least < 0.2 if filled else least > 0.5), "the gas breaks up into smaller pockets while the jet carries it up the wall")


def impact(o):
    onsets, _ = e.impacts(o.t, m.running_mean(o.t, o["P1"], 0.002), e.BREAKING_PERIOD)
    return f"{onsets[0]:.3f} s" if onsets else "no time"


def first_impacts(model, dp):
    """Largest mean over 5 ms of the first impact of each run of a model, in rho g times the depth."""
    found = {}
    with open(IMPACTS, encoding="utf-8") as file:
        for r in csv.DictReader(file):
            if (r["tank"], int(r["rows"])) != ("w22", round(BREAKING_DEPTH / dp)) or model not in r["model"].split(" = ") or float(r["p5"]) < LEAST_IMPACT:
                continue
            found[r["repeat"]] = min(found.get(r["repeat"], (np.inf, 0)), (float(r["t/T"]), float(r["p5"])))
    return np.array([p for _, p in found.values()])


def cushioned_by(model, dp):
    """Ratio of the mean first impacts, void over the model, its band of 90 % by resampling, and the share of pairs above CUSHIONED."""
    void, gas, draw = first_impacts("void", dp), first_impacts(model, dp), np.random.default_rng(1)
    if len(void) < 3 or len(gas) < 3:
        return None
    means = [draw.choice(void, len(void)).mean() / draw.choice(gas, len(gas)).mean() for _ in range(1000)]
    share = np.mean(void[:, None] > CUSHIONED * gas[None, :])
    return len(void), len(gas), void.mean() / gas.mean(), *np.percentile(means, (5, 95)), share


def breaking_pressures(book):
    """By several runs of each: single ones differ by more than what is judged."""
    for dp in (0.02, 0.01, 0.005):
        says = f"air cushions: the largest pressure of IMPS is more than {CUSHIONED} times that of MMPS (first impact, dp {dp:g})"
        if not (found := cushioned_by("mmps", dp)):
            yield from missing(says)
            continue
        void, gas, ratio, low, high, share = found
        yield Check(says, f"ratio of the means over 5 ms {ratio:.2f}, band of 90 % {low:.2f} to {high:.2f}, {void} and {gas} runs; above {CUSHIONED} in {100 * share:.0f} % of the pairs of runs",
                    bool(low > CUSHIONED), "without air the first impact falls with the spacing, with air it does not" if high < CUSHIONED else "the runs scatter too much to tell")


def breaking(book):
    yield from breaking_profiles(book)
    yield from breaking_cavity(book)
    yield from breaking_pressures(book)
