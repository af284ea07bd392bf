# SPDX-License-Identifier: BSD-3-Clause
"""What is measured in every case, from one run. Limits are those of the acceptance table; heights are above the still level as placed."""
from math import pi

import numpy as np

import measures as m
import potential
import theory
from results import absent, at_least, below, bounded, difference, fact, relative

G, WATER = theory.G, theory.WATER

# Fully nonlinear potential flow of these tanks by modes; potential.py, by boundary integrals, has the same within 0.2 mm and 6 Pa.
HIGH_FILL_CRESTS = [(1.16, 0.0244), (2.08, 0.0456), (2.99, 0.0700), (3.91, 0.0982), (4.85, 0.1303)]
HIGH_FILL_PEAKS = [(0.58, 2812), (1.50, 2869), (2.40, 2925), (3.30, 2991), (3.60, 2916), (4.21, 3071), (4.55, 3001)]
# The same for the surge tank, which 24 modes do not resolve: crests with a modal damping ratio of 0.005, kinetic and potential energy
# since the start without [J/m].
SURGE_DAMPED = [(1.11, 0.0650), (2.12, 0.1200), (3.19, 0.1585), (4.26, 0.1090)]
SURGE_CRESTS = (1.107, 2.121, 3.200, 4.290)  # times [s], without damping
SURGE_ENERGY = [(3.0, 20.5), (3.5, 18.7), (4.0, 13.2), (4.5, 7.1)]
BAFFLE_UNBAFFLED = 0.048  # amplitude at the outer gauges [m]
BAFFLE_OMEGA, BREAKING_PERIOD = 3.53, 1 / 0.496
CLOSING = 2.3  # of the cavity in the breaking wave [s]
# Lobovsky et al. 2014, 0.3 m high: median arrival at the sensor 15 mm up, first peak 3 mm up, in sqrt(H/g) and rho g H
DAM_H, DAM_DENSITY, DAM_ARRIVAL, DAM_PEAK = 0.3, 997.0, 2.46, 2.84


def still_water(o, depth):
    level = o.level(depth)
    scale, use = WATER * G * level, o.t > 0.5
    figures, rms = [], 0
    for i, y in enumerate((0.05, 0.10, 0.15)):
        p = o[f"P{i + 1}"][use]
        figures.append(bounded(f"P{i + 1}, mean error [% of rho g h]", 100 * (p.mean() - WATER * G * (level - y)) / scale if use.any() else np.nan,
                               "{:+.2f}", 0.5, 2))
        rms = max(rms, 100 * p.std() / scale if use.any() else np.nan)
    ke, late, early = o["ke"], o.t > o.t[-1] - 1, (o.t > 0.5) & (o.t < 1.5)
    return figures + [
        bounded("P1..P3, largest rms [% of rho g h]", rms, "{:.2f}", 0.5, 2),
        bounded("level [% of the depth]", 100 * o["eta_left"][use].mean() / level if use.any() else np.nan, "{:+.2f}", 1, 1),
        fact("kinetic energy, .5-1.5 s", ke[early].mean() if early.any() else np.nan, "{:.1e} J"),
        fact("kinetic energy, last second", ke[late].mean(), "{:.1e} J"),
        fact("kinetic / potential energy, last second", ke[late].mean() / o["pe"][late].mean(), "{:.1e}")]


def static_tank(o, refs):
    return still_water(o, 0.25)


def static_tank_3d(o, refs):
    return still_water(o, 0.2)


def standing_wave(o, refs):
    length, k, a, periods = 1.0, pi, 0.02, 5
    level = o.level(0.5)
    omega = theory.standing_wave(k, level, a)
    if o.t[-1] < 2 * pi / omega * 3:
        return [absent("frequency")]
    eta, period = o["eta_left"], 2 * pi / omega
    crests = [eta[0]] + [m.crest(o.t, eta, n * period)[1] for n in range(1, periods + 1)]
    w, first, growth = m.growing_wave(o.t, eta, omega, (theory.natural(2 * pi / length, level),))
    # it sees odd modes only, no second harmonic, bound or free; the crest at the left wall draws it to the left
    w_mass, _, growth_mass = m.growing_wave(o.t, -o["x_centre"], omega, ())
    viscous = theory.viscous_decay(k, periods * period)
    figures = []
    for name, frequency, rate in (("crests at the wall", w, growth), ("centre of mass", w_mass, growth_mass)):
        figures += [relative(f"frequency, {name}", frequency, omega, "{:.4f}/s", 0.2, 0.3),
                    relative(f"amplitude after 5 periods / viscous, {name}", (1 + rate * periods * period) / viscous, 1, "{:.3f}", 3, 5),
                    bounded(f"growth a period, {name} [%]", 100 * rate * period, "{:+.2f}", 0.3, 0.5)]
    figures.append(fact("first amplitude of the fit", 1e3 * first, "{:.2f} mm"))
    return figures + [fact(f"height at the left wall after {n} periods", 1e3 * c, "{:.2f} mm") for n, c in enumerate(crests)]


def small_surge(o, refs):
    tank, flow = theory.Surge(0.6, o.level(0.3), 5e-4, 6.85), potential.half_full(5e-4, 3.0)
    t, use = o.t, (o.t > 0.05) & (o.t <= 3)
    eta, p = flow.height(0.58), flow.p[0]
    p1 = m.running_mean(t, o["P1"], 0.005)
    return [bounded("eta_right, NRMS [%]", 100 * m.nrms(t, o["eta_right"], flow.t, eta, 0.05, 2.99), "{:.1f}", 2, 2),
            bounded("P1, NRMS [%]", 100 * m.nrms(t, p1, flow.t, p, 0.05, 2.99), "{:.1f}", 2, 2),
            fact("eta_right, factor to FNPF", m.ratio(o["eta_right"][use], np.interp(t, flow.t, eta)[use]), "{:.3f}"),
            fact("P1, factor to FNPF", m.ratio(p1[use], np.interp(t, flow.t, p)[use]), "{:.3f}"),
            fact("eta_right, NRMS against linear theory", 100 * m.nrms(t, o["eta_right"], t, tank.elevation(t, 0.58), 0.05, 2.99), "{:.1f} %"),
            fact("P1, NRMS against linear theory", 100 * m.nrms(t, p1, t, tank.left_wall_pressure(t, 0.02), 0.05, 2.99), "{:.1f} %"),
            bounded("P1, noise about the 5 ms mean", 100 * m.noise(t, o["P1"]) / (WATER * G * tank.depth), "{:.3f} % of rho g h")]


def crests(o, y, reference, label, limits, late):
    """Heights and times of crests. `limits`: (good, pass) of the height of each, None: no verdict; `late`: of all times."""
    figures = []
    for n, ((t_ref, y_ref), limit) in enumerate(zip(reference, limits), 1):
        t, height = m.crest(o.t, y, t_ref)
        figures.append(relative(f"crest {n}{label}", height, y_ref, "{:.4f} m", *(limit or (None, None))))
        figures.append(difference(f"crest {n}{label}, time", t, t_ref, "{:.3f} s", "{:+.0f} ms", *(late if limit else (None, None)), scale=1000))
    return figures


def noise_figures(o, names, depth):
    scale = WATER * G * o.level(depth)
    return [bounded(f"{name}, noise about the 5 ms mean", 100 * m.noise(o.t, o[name]) / scale, "{:.2f} % of rho g h") for name in names]


def high_fill(o, refs):
    t, p1 = o.t, m.running_mean(o.t, o["P1"], 0.005)
    figures = crests(o, o["eta_right"], HIGH_FILL_CRESTS, "", [(3, 5)] * 5, (0.01, 0.02))
    for t_ref, p_ref in HIGH_FILL_PEAKS:
        figures.append(relative(f"P1, peak at {t_ref:.2f} s", m.peak(t, p1, t_ref, 0.12), p_ref, "{:.0f} Pa", 0.5, 1))
    smooth = m.running_mean(t, o["P1"], 0.02)
    for one, two in ((3.30, 3.60), (4.21, 4.55)):
        figures.append(at_least(f"P1, dip between {one:.2f} and {two:.2f} s (20 ms mean)", m.dip(t, smooth, one, two), "{:.0f} Pa", 10, 1e-9))
    flow = potential.half_full(5e-3, 5.1)
    figures += [bounded("eta_right, NRMS to 5 s", 100 * m.nrms(t, o["eta_right"], flow.t, flow.height(0.58), 0.2, 5), "{:.1f} %"),
                bounded("P1, NRMS to 5 s", 100 * m.nrms(t, p1, flow.t, flow.p[0], 0.2, 5), "{:.1f} %")]
    return figures + noise_figures(o, ["P1"], 0.3)


def surge(o, refs):
    eta, flow = m.running_mean(o.t, o["eta_left"], 0.005), potential.surge_tank()
    height = flow.height(o.dp)  # where the gauge is
    exact = [m.crest(flow.t, height, t, 0.2, 5) for t in SURGE_CRESTS]
    figures = crests(o, eta, exact, "", [(3, 5)] * 3 + [(15, 15)], (0.03, 0.03))
    energy = o["ke"] + o["pe"] - o["ke"][0] - o["pe"][0]
    for text, pairs in (("", [(t, float(np.interp(t, flow.t, flow.energy))) for t, _ in SURGE_ENERGY]), (", 24 modes", SURGE_ENERGY)):
        figures += [relative(f"energy at {t:g} s{text}", float(np.interp(t, o.t, energy)) if o.t[-1] > t - 1e-9 else np.nan, e_ref, "{:.1f} J/m", 3, 5)
                    for t, e_ref in pairs]
    apart = np.abs(np.interp(flow.t, o.t, energy) - flow.energy)[flow.t < 4.5].max() if o.t[-1] > 4.5 else np.nan
    figures += [bounded("energy, largest error to 4.5 s [% of its largest value]", 100 * apart / flow.energy.max(), "{:.1f}", 5, 5),
                fact("numerical, at the end", o["numerical"][-1], "{:+.1f} J/m")]
    for i in range(3):
        p = m.running_mean(o.t, o[f"P{i + 1}"], 0.005) + WATER * G * (0.25 - o.level(0.25))
        figures.append(bounded(f"P{i + 1}, NRMS to 3.2 s", 100 * m.nrms(o.t, p, flow.t, flow.p[i], 0.2, 3.2), "{:.1f} %"))
    figures += crests(o, eta, SURGE_DAMPED, ", 20 damped modes", [None] * 4, None)
    return figures + noise_figures(o, ["P1", "P2", "P3", "P4", "P5"], 0.25)


def surge_counts(o, refs):
    s = o.summary
    return [difference("fluid particles", s["n_fluid"], 12338, "{:.0f}", "{:+.0f}", 0, 0),
            difference("wall and dummy particles", s["n_wall"] + s["n_dummy"], 1974, "{:.0f}", "{:+.0f}", 0, 0)]


def low_fill(o, refs):
    t, eta, p1 = o.t, m.running_mean(o.t, o["eta_right"], 0.02), m.running_mean(o.t, o["P1"], 0.02)
    figures = [fact(f"largest height at the right wall near {near:.2f} s, time", m.crest(t, eta, near, 0.5)[0], "{:.2f} s") for near in (2.75, 4.80, 6.10)]
    return [*figures,
            difference("run-up at the left wall, time of the largest P1", m.crest(t, p1, 7.85, 0.5)[0], 7.85, "{:.2f} s", "{:+.2f} s", 0.15, 0.15),
            *noise_figures(o, ["P1"], 0.03)]


def impacts(t, p, period, first=1.5):
    """Times at which the pressure first exceeds that of still water in every period, and of its largest value after that."""
    onsets, largest, threshold, begin = [], [], WATER * G * 0.18, first
    while (above := np.flatnonzero((t >= begin) & (p > threshold))).size:
        onsets.append(t[above[0]])
        inside = (t >= onsets[-1]) & (t < onsets[-1] + period / 2)
        largest.append(t[inside][np.argmax(p[inside])])
        begin = onsets[-1] + 0.7 * period
    return onsets, largest


def mean_interval(times):
    return np.polyfit(range(len(times)), times, 1)[0] if len(times) > 2 else np.nan


def cavity(o):
    """What the crest closes in where it meets the right wall: when it is there for good, its largest volume, and what is left of it a little
    later. Drops that fall back at the left wall close pockets at other times. A crest about to close flickers between open and closed
    within milliseconds: what does not last has no volume."""
    onsets, _ = impacts(o.t, m.running_mean(o.t, o["P1"], 0.002), BREAKING_PERIOD)
    first = abs(o.t - onsets[0]) < 0.1 if onsets else (o.t > 1.8) & (o.t < 2.9)
    t, volume = o.t[first], m.running_median(o.t, o["air_volume"], 0.02)[first]
    if not len(t) or not volume.max() > 10 * o.dp**2:
        return [difference("cavity, closes", np.nan, CLOSING, "{:.2f} s", "{:+.2f} s", 0.1, 0.1)]
    closes = t[np.argmax(volume > 0.5 * volume.max())]
    after = (o.t > closes + 0.02) & (o.t < closes + 0.12)
    late = m.running_median(o.t, o["air_volume"], 0.02)[after]
    return [difference("cavity, closes", closes, CLOSING, "{:.2f} s", "{:+.2f} s", 0.1, 0.1),
            fact("cavity, largest volume", 1e4 * volume.max(), "{:.1f} cm2"),
            fact("cavity, least / largest volume within 0.12 s", late.min() / volume.max() if len(late) else np.nan, "{:.2f}")]


def breaking(o, refs):
    t, p1 = o.t, m.running_mean(o.t, o["P1"], 0.002)
    onsets, largest = impacts(t, p1, BREAKING_PERIOD)
    late = t > 1.5
    limited = np.clip(m.running_mean(t, o["P1"], 0.02), 0, WATER * G * 0.18)  # or the largest impact decides alone
    again = m.repeat_time(t[late], limited[late], 1.5, 2.5) if t[-1] > 7 else np.nan
    figures = [relative("period of P1 up to rho g h, autocorrelation", again, BREAKING_PERIOD, "{:.3f} s", 1, 1),
               relative("mean interval of impacts, by their onset", mean_interval(onsets), BREAKING_PERIOD, "{:.3f} s", 1, 1),
               relative("mean interval of impacts, by their peak", mean_interval(largest), BREAKING_PERIOD, "{:.3f} s", 1, 1),
               fact("impacts", len(onsets), "{:.0f}"),
               fact("first impact, onset", onsets[0] if onsets else np.nan, "{:.3f} s")]
    for name in ("P1", "P2", "P3"):
        figures.append(fact(f"{name}, largest after a 2 ms mean", m.largest(m.running_mean(t, o[name], 0.002)[t > 0.1]), "{:.0f} Pa"))
    return figures + [bounded("volume, largest change [%]", 100 * np.abs(o["volume_error"]).max(), "{:.2f}"), *cavity(o)]


def breaking_start(o, refs):
    """Up to the first impact and shortly after."""
    return [fact(f"{name}, largest after a 2 ms mean", m.largest(m.running_mean(o.t, o[name], 0.002)[o.t > 0.1]), "{:.0f} Pa") for name in ("P1", "P2", "P3")
            ] + cavity(o)


def late(o, refs):
    """Beyond the time of potential flow: what two models are compared by."""
    after = o.t > 5
    return [fact("largest height after 5 s", m.largest(o["eta_right"][after]), "{:.3f} m"), fact("P1, largest after 5 s, 20 ms mean", m.largest(
        m.running_mean(o.t, o["P1"], 0.02)[after]), "{:.0f} Pa")]


def baffle_2d(o, refs):
    t, late = o.t, o.t > 2
    if t[-1] < 5:
        return [absent("forcing line")]
    a, c = (m.running_mean(t, o[name], 0.02) for name in ("eta_a", "eta_c"))
    figures = [relative(f"line of the spectrum at gauge {n}", m.line(t[late], y[late], 2, 5.5), BAFFLE_OMEGA, "{:.3f}/s", 1, 1)
               for n, y in (("a", a), ("c", c))]
    for n, y in (("a", a), ("c", c)):
        ratio = m.harmonic(t[late], y[late], BAFFLE_OMEGA) / BAFFLE_UNBAFFLED
        figures.append(below(f"amplitude at gauge {n} / unbaffled", ratio, "{:.2f}", 1))
    return figures + [bounded("volume error [%]", 100 * o.summary["volume_error"], "{:+.2f}", 1, 1)]


def baffle_3d(o, refs):
    across = m.running_mean(o.t, o["eta_a"], 0.01) - m.running_mean(o.t, o["eta_c"], 0.01)
    i = int(np.argmax(np.abs(across)))
    return [at_least("time reached", float(o.t[-1]), "{:.2f} s", 3 - 1e-6, 3 - 1e-6),
            fact("largest level difference across the baffle", float(across[i]), "{:+.3f} m"),
            fact("at", float(o.t[i]), "{:.2f} s"),
            bounded("volume error [%]", 100 * o.summary["volume_error"], "{:+.2f}")]


def baffle_3d_counts(o, refs):
    s = o.summary
    return [relative("fluid particles", s["n_fluid"], 274195, "{:.0f}", 0.1, 0.1),
            relative("all particles", s["n_fluid"] + s["n_wall"] + s["n_dummy"], 376695, "{:.0f}", 0.1, 0.1)]


def dam_break(o, refs):
    t = o.t * np.sqrt(G / DAM_H)
    scale = DAM_DENSITY * G * DAM_H
    p2, p1 = m.running_mean(o.t, o["P2"], 0.005) / scale, o["P1"] / scale  # P1 is a mean over dp/u
    arrival = t[np.argmax(p2 > 0.2)] if (p2 > 0.2).any() else np.nan
    figures = [difference("arrival at 15 mm, t*", arrival, DAM_ARRIVAL, "{:.2f}", "{:+.2f}", 0.1, 0.1),
               relative("P1, largest to t* = 3.2 (mean over dp/u), p*", p1[t < 3.2].max(), DAM_PEAK, "{:.2f}", 30, 30),
               relative("P1, largest to t* = 3.2 (mean over 8 ms), p*", m.running_mean(o.t, p1, 0.008)[t < 3.2].max(), DAM_PEAK, "{:.2f}", 30, 30),
               fact("P1, largest of all, p*", p1.max(), "{:.2f}")]
    label = "P2, share of t* > 3 inside the band"
    band = refs.series("reference/lobovsky_h300_pressure_percentiles.csv", (0, 1, 2, 3))
    if band is None:
        return figures + [absent(label)]
    low, middle, high = (np.interp(t, band[0], band[i]) for i in (1, 2, 3))
    use, wide = (t > 3) & (t < min(band[0][-1], t[-1] - 0.03)), 0.1 * np.abs(middle)
    share = 100 * m.band_share(t[use], p2[use], (low - wide)[use], (high + wide)[use])
    plateau = (t > 4) & (t < 5.5)
    return figures + [at_least(label, share, "{:.0f} %", 80, 80),
                      fact("P2, mean over t* = 4..5.5 / median", p2[plateau].mean() / middle[plateau].mean(), "{:.2f}")]


def long_breaking(o, refs):
    return long_run(o, refs, volume=1) + breaking(o, refs)


def long_surge(o, refs):
    taken = o["viscous"] + o["collision"] + o["shift"]
    return [bounded("numerical, at the end [J/m]", o["numerical"][-1], "{:+.1f}", 10, 10),
            bounded("numerical and what dissipation, collisions and shift take, at the end [J/m]", (o["numerical"] + taken)[-1], "{:+.1f}", 10, 10),
            fact("the same, largest at any time", np.abs(o["numerical"] + taken).max(), "{:.1f} J/m"), *long_run(o, refs)]


def long_run(o, refs, volume=None):
    """`volume`: limit of its error [%]."""
    wanted = float(o.run.options[o.run.options.index("--t-end") + 1])
    quarter = len(o.t) // 4
    figures = [at_least("time reached", float(o.t[-1]), "{:.1f} s", wanted - 1e-6, wanted - 1e-6),
               bounded("volume error [%]", 100 * o.summary["volume_error"], "{:+.2f}", volume, volume),
               below("particles lost [% of the liquid]", 100 * o.summary["particles_lost"] / o.summary["n_fluid"], "{:.2f}", 0.1),
               fact("potential energy, mean of the last quarter / start", o["pe"][-quarter:].mean() / o["pe"][0], "{:.4f}"),
               fact("kinetic energy, mean of the last / second quarter", o["ke"][-quarter:].mean() / o["ke"][quarter:2 * quarter].mean(), "{:.2f}"),
               fact("work of the walls", o["wall_work_momentum"][-1], "{:.1f} J/m")]
    return figures + [fact(f"of it {name}", 100 * o[name][-1] / o["wall_work_momentum"][-1], "{:.1f} %") for name in ("viscous", "collision", "shift", "numerical")]
