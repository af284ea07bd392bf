# SPDX-License-Identifier: BSD-3-Clause
"""What is measured in the cases of several phases, from one run."""
from math import pi, sqrt

import numpy as np

import evaluate as e
import measures as m
from results import absent, at_least, below, bounded, difference, fact, relative
from theory import G, WATER

# Volume of fluid, 256 x 512 cells: (t, highest, lowest point of the interface)
TIPS = [(1, 1.229, 0.767), (2, 1.392, 0.566), (3, 1.558, 0.337), (4, 1.702, 0.159), (5, 1.828, 0.093)]
TIPS_SERIES = "reference/rt_re420_vof_tips.csv", (0, 3, 4)
# Hysing et al. 2009, both cases: height at 3 s, largest speed, least circularity; columns t, circularity, height, speed
BUBBLE_HEIGHT, BUBBLE_SPEED, BUBBLE_CIRCULARITY, BUBBLE_2_SPEED = 1.081, 0.2417, 0.901, 0.2502
BUBBLE_SERIES = "reference/hysing_c{}g3l4.txt"
SIGMA, AIR, SOUND = 7.27e-2, 1.29, 340.0
CUSHION, SLUG = 0.2, 0.2
LAYER, HEAVY, LIGHT = 0.75, 1000.0, 1.0


def static_two_fluid(o, refs):
    use, scale = o.t > 0.5, HEAVY * G * LAYER
    figures, rms = [], 0
    for i, y in enumerate((0.25, 0.5, 0.75)):
        p, exact = o[f"P{i + 1}"][use], LIGHT * G * LAYER + HEAVY * G * (LAYER - y)
        figures.append(bounded(f"P{i + 1}, mean error [% of rho g h]", 100 * (p.mean() - exact) / scale if use.any() else np.nan, "{:+.2f}", 0.5, 2))
        rms = max(rms, 100 * p.std() / scale if use.any() else np.nan)
    ke, late, early = o["ke"], o.t > o.t[-1] - 1, (o.t > 0.5) & (o.t < 1.5)
    before = ke[early].mean() if early.any() else np.nan
    return figures + [bounded("P1..P3, largest rms [% of rho g h]", rms, "{:.2f}", 2, 2),
                      below("furthest beyond the interface [dp]", o.summary["trespass"] / o.dp, "{:+.2f}", 1),
                      fact("kinetic energy, .5-1.5 s", before, "{:.1e} J/m"),
                      below("kinetic energy, last second / .5-1.5 s", ke[late].mean() / before, "{:.2g}", 1)]


def rayleigh_taylor(o, refs):
    errors = {t: max(abs(o.at("ytop", t) - top), abs(o.at("ybot", t) - bottom)) for t, top, bottom in TIPS}
    figures = [difference(f"{name} at {tip[0]} s", o.at(name, tip[0]), tip[i], "{:.3f} m", "{:+.3f} m") for tip in TIPS for i, name in ((1, "ytop"), (2, "ybot"))]
    figures += [bounded("tips, largest error at 1, 2, 3 s", max(errors[t] for t in (1, 2, 3)), "{:.3f} m", 0.015, 0.03),
                bounded("tips, largest error at 4, 5 s", max(errors[4], errors[5]), "{:.3f} m", 0.03, 0.06)]
    ref = refs.series(*TIPS_SERIES)
    for i, name in enumerate(("ytop", "ybot"), 1):
        label = f"{name}, largest error at all times to 3 s"
        early = o.t <= 3
        figures.append(absent(label) if ref is None else fact(label, np.abs(o[name] - np.interp(o.t, ref[0], ref[i]))[early].max(), "{:.3f} m"))
    strays = o.summary.get("strays")
    return figures + [below("particles astray in the other fluid at the end", np.nan if strays is None else strays, "{:.0f}", 0),
                      below("particles lost", o.summary["particles_lost"], "{:.0f}", 0)]


def bubble(o, refs, number, until):
    """Differences from the series of the benchmark."""
    ref = refs.series(BUBBLE_SERIES.format(number), (0, 2, 3, 4))
    for i, name, text in ((2, "yc", "height"), (3, "v", "rise velocity"), (1, "circularity", "circularity")):
        label = f"{text}, NRMS to {until:g} s [%]"
        yield absent(label) if ref is None else fact(label, 100 * m.nrms(o.t, o[name], ref[0], ref[i], 0.02, until), "{:.1f}")


def rising_bubble(o, refs):
    v = m.running_mean(o.t, o["v"], 0.02)
    round_ = m.running_mean(o.t, o["circularity"], 0.02)
    fastest, roundness = int(np.argmax(v)), round_.min() if o.t[-1] > 2.5 else np.nan
    return [relative("height of the centre at 3 s", o.at("yc", 3), BUBBLE_HEIGHT, "{:.4f} m", 1, 2),
            relative("largest rise velocity", v[fastest], BUBBLE_SPEED, "{:.4f} m/s", 1.5, 3),
            difference("at", o.t[fastest], 0.924, "{:.3f} s", "{:+.3f} s"),
            difference("least circularity", roundness, BUBBLE_CIRCULARITY, "{:.3f}", "{:+.3f}", 0.02, 0.02),
            fact("circularity at the start", o["circularity"][0], "{:.3f}"),
            *bubble(o, refs, 1, 3)]


def rising_bubble_2(o, refs):
    v, early = m.running_mean(o.t, o["v"], 0.02), o.t < 1.2
    return [relative("first maximum of the rise velocity", m.largest(v[early]), BUBBLE_2_SPEED, "{:.4f} m/s"), *bubble(o, refs, 2, 2)]


def drop_radius(o):
    """Of the circle with the drop's second moment at the start, when it is cut from a lattice."""
    return o["rx"][0]


def droplet(o, refs):
    late = o.t > o.t[-1] / 2
    jump = SIGMA / drop_radius(o)
    return [relative("pressure jump, second half", o["dp"][late].mean(), jump, "{:.2f} Pa", 2, 5),
            bounded("its rms [% of sigma/R]", 100 * o["dp"][late].std() / jump, "{:.1f}"),
            fact("largest speed [m/s]", o.summary["max_speed"], "{:.3g}"),
            fact("kinetic energy at the end / surface energy", o["ke"][-1] / (2 * pi * drop_radius(o) * SIGMA), "{:.1e}")]


def droplet_oscillation(o, refs):
    omega = sqrt(6 * SIGMA / ((WATER + AIR) * drop_radius(o) ** 3))
    if o.t[-1] < 2 * pi / omega * 1.5:
        return [absent("period")]
    w, growth = m.damped_wave(o.t, o["rx"], omega)
    period = 2 * pi / omega
    viscous = -4 * 1e-6 / drop_radius(o) ** 2
    return [relative("period", 1e3 * 2 * pi / w, 1e3 * period, "{:.2f} ms", 3, 3),
            fact("growth a period", 100 * growth * period, "{:+.1f} %"),
            fact("growth a period by the viscosity of the water alone", 100 * viscous * period, "{:+.1f} %")]


def air_cushion(o, refs):
    stiffness = AIR * SOUND**2
    omega, shorter = sqrt(stiffness / (WATER * SLUG * CUSHION)), WATER * G * SLUG / stiffness
    if o.t[-1] < 2 * pi / omega * 4:
        return [absent("frequency")]
    w, growth = m.damped_wave(o.t, o["x_slug"], omega)
    whole = int(o.t[-1] * omega / (2 * pi)) * 2 * pi / omega  # periods, so that the mean is that of the rest
    return [relative("frequency", w / (2 * pi), omega / (2 * pi), "{:.3f} Hz", 2, 5),
            relative("dH/H", -o["x_slug"][o.t <= whole].mean() / CUSHION, shorter, "{:.5f}", 10, 10),
            fact("growth a period", 100 * growth * 2 * pi / omega, "{:+.1f} %")]


def high_fill_air(o, refs):
    lower = WATER * G * (o.level(0.3) + o.dp / 2 - 0.3)  # the interface is half a spacing above the upper row of the water
    o.column["P1"] = o["P1"] - lower
    figures, other = e.high_fill(o, refs), o.beside("sloshing_high_fill")
    label = "P1, largest difference from imps, 20 ms mean [%]"
    if other is None:
        return figures + [absent(label)]
    n = min(len(o.t), len(other.t))
    one, two = (m.running_mean(o.t[:n], x["P1"][:n], 0.02) for x in (o, other))
    use = (o.t[:n] > 0.2) & (o.t[:n] < 5)
    return figures + [bounded(label, 100 * np.abs(one / two - 1)[use].max() if use.any() else np.nan, "{:.1f}", 2, 2)]


def breaking_air(o, refs):
    figures, other = e.breaking(o, refs), o.beside("sloshing_breaking")
    label = "largest P1 of imps / of mmps, 2 ms mean"
    if other is None:
        return figures + [absent(label)]
    one, two = (m.largest(m.running_mean(x.t, x["P1"], 0.002)[x.t > 0.1]) for x in (other, o))
    return figures + [at_least(label, one / two, "{:.2f}", 1.2, 1.2)]


def breaking_air_3d(o, refs):
    figures = [at_least("time reached", float(o.t[-1]), "{:.2f} s", 3 - 1e-6, 3 - 1e-6),
               bounded("volume error [%]", 100 * o.summary["volume_error"], "{:+.2f}", 1, 1)]
    figures += [fact(f"{name}, largest after a 2 ms mean", m.largest(m.running_mean(o.t, o[name], 0.002)[o.t > 0.1]), "{:.0f} Pa")
                for name in ("P1", "P2", "P3")]
    flat, label = o.beside("breaking_air"), "height at the right wall to 2.2 s, largest difference from 2-D"
    if flat is None:
        return figures + [absent(label)]
    use = o.t < 2.2
    apart = m.running_mean(o.t, o["eta_right"], 0.02) - np.interp(o.t, flat.t, m.running_mean(flat.t, flat["eta_right"], 0.02))
    return figures + [fact(label, 1e3 * np.abs(apart[use]).max(), "{:.0f} mm")]
