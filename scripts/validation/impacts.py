# SPDX-License-Identifier: BSD-3-Clause
"""What is measured where liquid meets walls. The driver computes the figures from every step; here they meet their limits."""
import numpy as np

from results import at_least, below, bounded, fact, relative

# Deadrise -> largest Cp = p/(rho V^2/2), its height in V t above the undisturbed surface, F/(rho V^3 t) of the self-similar flow (Zhao and Faltinsen 1993)
WEDGE = {20: (17.8, 0.509, 42.5), 30: (6.93, 0.424, 14.1), 40: (3.27, 0.287, 5.48)}
SUCTION = 0.1  # that is allowed, in rho U^2, of the column in rho g h


def number(o, name):
    value = o.summary.get(name)
    return np.nan if value is None else value


def option(o, name, default):
    options = o.run.options
    return options[options.index(name) + 1] if name in options else default


def peaks(o):
    return [fact("largest pressure of a step / (rho U^2)", number(o, "peak_raw"), "{:.1f}"),
            fact("largest mean over dp/U / (rho U^2)", number(o, "peak_mean"), "{:.2f}")]


def flat(o, refs):
    """Impulses to dp/U after contact, in rho U H."""
    figures = [relative(f"impulse at {name}", number(o, f"impulse_{key}"), number(o, f"exact_{key}"), "{:.3f}", *limits)
               for key, name, limits in (("10", ".1 H", ()), ("25", ".25 H", ()), ("50", ".5 H", ()), ("75", ".75 H", ()), ("bottom", "the bottom", (5, 5)))]
    exact = number(o, "exact_mean")
    return figures + [relative("impulse, mean up to H", number(o, "impulse_mean"), exact, "{:.3f}", 5, 5),
                      relative("impulse of the wall's force", number(o, "impulse_force"), exact, "{:.3f}"),
                      relative("impulse of the fluid", number(o, "impulse_fluid"), exact, "{:.3f}", 5, 5),
                      relative("walls / fluid, to 4 dp/U", number(o, "impulse_force_late") / number(o, "impulse_fluid_late"), 1, "{:.3f}", 5, 5),
                      fact("largest force before contact / (rho U^2 H)", number(o, "force_before"), "{:.2g}"), *peaks(o)]


def film(o, refs):
    """Impulses in rho U dp h, to 4 dp/U after contact, from there to 12 dp/U, and both. Liquid of the half cells of the floor belongs to the
    walls: at first they have more of the impulse than their fraction, later less."""
    fluid, exact, half = number(o, "impulse_fluid"), number(o, "exact_fluid"), number(o, "exact_half_cell")
    walls, late_fluid, late_walls = number(o, "impulse_walls"), number(o, "late_fluid"), number(o, "late_walls")
    share = half / exact
    return [relative("impulse of the fluid", fluid, exact, "{:.2f}"),
            relative("impulse of the wall", walls, half, "{:.2f}"),
            relative("from 4 to 12 dp/U, fluid", late_fluid, number(o, "late_exact"), "{:.2f}"),
            relative("from 4 to 12 dp/U, wall", late_walls, number(o, "late_exact") * share, "{:.2f}"),
            relative("walls / (fluid and its half cells)", (walls + late_walls) / ((fluid + late_fluid) * share), 1, "{:.2f}", 15, 15),
            relative("walls / (fluid and its half cells), to 4 dp/U", walls / (fluid * share), 1, "{:.2f}"), *peaks(o)]


def wedge(o, refs):
    cp, rise, force = WEDGE[int(option(o, "--deadrise", "30"))]
    return [fact("wetted side [dp]", number(o, "wetted_dp"), "{:.0f}"),
            relative("largest Cp, sensor of 2 dp, dp/V", number(o, "cp_2dp"), cp, "{:.2f}", 10, 10),
            relative("largest Cp, sensor of 4 dp, dp/V", number(o, "cp_4dp"), cp, "{:.2f}", 10, 10),
            relative("the same, mean of the second half", number(o, "cp_4dp_mean"), cp, "{:.2f}"),
            relative("its place along the side / wetted side", number(o, "place"), 1 + rise, "{:.2f}"),
            fact("largest Cp of a step, second half", number(o, "cp_raw_largest"), "{:.1f}"),
            relative("force, slope of the second half", number(o, "force_slope"), force, "{:.2f}", 5, 5),
            relative("force over its time, mean of the second half", number(o, "force_mean"), force, "{:.2f}"),
            relative("the same, by the fluid's momentum", number(o, "force_fluid"), force, "{:.2f}"),
            relative("walls / fluid", number(o, "force_mean") / number(o, "force_fluid"), 1, "{:.3f}", 5, 5)]


def jet(o, refs):
    return [relative("stagnation pressure / (rho U^2/2)", number(o, "stagnation"), 1, "{:.3f}", 5, 5),
            fact("its least mean over dp/U", number(o, "stagnation_least"), "{:.3f}"),
            fact("its largest mean over dp/U", number(o, "stagnation_largest"), "{:.3f}"),
            relative("force of the wall / (rho U^2 b)", number(o, "force_walls"), 1, "{:.3f}", 5, 5),
            relative("force by the fluid's momentum", number(o, "force_fluid"), 1, "{:.3f}", 5, 5), *peaks(o)]


def column(o, refs):
    """Pressures in rho g h."""
    return [below("largest pressure before contact", number(o, "before"), "{:.4f}", 0.01),
            relative("impulse of the floor / exact", number(o, "impulse_walls"), 1, "{:.3f}", 5, 5),
            relative("impulse of the fluid / exact", number(o, "impulse_fluid"), 1, "{:.3f}", 5, 5),
            below("rebound / U", max(0, number(o, "rebound")), "{:.3f}", 0.02),
            relative("pressure at rest", number(o, "still"), 1, "{:.4f}", 0.5, 2),
            fact("pressure at rest, least", number(o, "still_least"), "{:.4f}"), fact("pressure at rest, largest", number(o, "still_largest"), "{:.4f}"),
            at_least("least pressure", number(o, "least"), "{:+.3f}", -SUCTION, -SUCTION), *peaks(o)]


def leaving_floor(o, refs):
    """Pressures in rho g h. The void reaches the edge of the floor. It does not reach the middle: its pressure and gap have no exact solution."""
    return [at_least("edge of the floor, least 10 ms mean", number(o, "rim_least_mean"), "{:+.3f}", -SUCTION, -SUCTION),
            fact("middle, least 10 ms mean", number(o, "middle_least_mean"), "{:+.3f}"), fact("middle, mean", number(o, "middle_mean"), "{:+.3f}"), fact("edge of the floor, mean", number(o, "rim_mean"), "{:+.3f}"),
            fact("gap / (g t^2/2)", number(o, "gap"), "{:.3f}"),
            relative("speed of the falling liquid / (g t)", number(o, "fall_fluid"), 1, "{:.3f}", 5, 5)]


def box(o, refs):
    """Means while the stream passes; least means over 2 dp/U from then to the end."""
    scale, figures = number(o, "rho_u2"), []
    for name in ("F1", "F2", "F3", "F4"):
        figures.append(fact(f"{name}, mean", 1e-3 * number(o, f"{name}_mean"), "{:+.2f} kPa"))
    for name in ("T1", "T2", "T3", "T4", "R"):
        figures.append(bounded(f"{name}, mean / (rho U^2)", number(o, f"{name}_mean") / scale, "{:+.3f}", SUCTION, SUCTION))
    for name in ("F4", "T1", "T2", "T3", "T4", "R"):
        figures.append(at_least(f"{name}, least / (rho U^2)", number(o, f"{name}_least") / scale, "{:+.3f}", -SUCTION, -SUCTION))
    unit = "N" if o.summary.get("dim") == 3 else "N/m"
    return figures + [fact("force along the stream", number(o, "force_x"), "{:.0f} " + unit), fact("lift", number(o, "force_y"), "{:.0f} " + unit)]
