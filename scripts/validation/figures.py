# SPDX-License-Identifier: BSD-3-Clause
"""Which plots and pictures belong to which case. Every function takes the outcomes of a case, coarse to fine, and yields (file, panels)."""
from math import pi

import numpy as np

import evaluate as e
import measures as m
import phases as ph
import potential
import theory
from plots import Panel


def named(o):
    return f"dp {o.dp:g}"


def smooth(o, name, window=0.005):
    return m.running_mean(o.t, o[name], window)


def overlay(title, unit, outcomes, name, window=None, factor=1.0, begin=0.0, **axes):
    """One column of all runs in one panel, without what is before `begin`: a jump of the walls' velocity is a blow."""
    panel = Panel(title, unit, **axes)
    for o in outcomes:
        use = o.t >= begin
        panel.curve(named(o), o.t[use], factor * (smooth(o, name, window) if window else o[name])[use])
    return panel


def marks(panel, label, points, symbol="o"):
    t, y = zip(*points)
    return panel.marks(label, t, y, symbol)


def still_water(outcomes, depth, name):
    panel = Panel("pressure 0.05 m above the floor, less hydrostatic", "Pa")
    for o in outcomes:
        panel.curve(named(o), o.t, o["P1"] - theory.WATER * theory.G * (o.level(depth) - 0.05))
    yield f"{name}.svg", [panel, overlay("kinetic energy", "J", outcomes, "ke", logarithmic=True, y_limits=(1e-9, 1e-1))]


def static_tank(outcomes, refs):
    yield from still_water(outcomes, 0.25, "static_tank")


def static_tank_3d(outcomes, refs):
    yield from still_water(outcomes, 0.2, "static_tank_3d")


def standing_wave(outcomes, refs):
    panel = overlay("height at the left wall", "mm", outcomes, "eta_left", factor=1e3)
    t = np.linspace(0, 5.92, 300)
    w = theory.standing_wave(pi, 0.5, 0.02)
    energy = Panel("kinetic and potential energy, change", "J/m")
    for o in outcomes:
        energy.curve(named(o), o.t, o["ke"] + o["pe"] - o["ke"][0] - o["pe"][0])
    yield "standing_wave.svg", [panel.reference("first harmonic, viscous", t, 20 * np.cos(w * t) * theory.viscous_decay(pi, t)), energy]


def small_surge(outcomes, refs):
    flow = potential.half_full(5e-4, 3.0)
    eta = overlay("height 0.02 m from the right wall", "mm", outcomes, "eta_right", factor=1e3)
    p = overlay("P1, 5 ms mean", "Pa", outcomes, "P1", 0.005, y_limits=(2715, 2775))
    yield "small_surge.svg", [eta.reference("FNPF", flow.t, 1e3 * flow.height(0.58)), p.reference("FNPF", flow.t, flow.p[0])]


def high_fill(outcomes, refs, name="high_fill"):
    eta, p = overlay("height 0.02 m from the right wall", "m", outcomes, "eta_right"), overlay("P1, 5 ms mean", "Pa", outcomes, "P1", 0.005)
    marks(eta, "FNPF", e.HIGH_FILL_CRESTS)
    marks(p, "FNPF", e.HIGH_FILL_PEAKS)
    yield f"{name}.svg", [eta, p]


def surge(outcomes, refs):
    panels = [overlay(f"height at the {side} wall", "m", outcomes, f"eta_{side}", 0.005) for side in ("left", "right")]
    o, flow = outcomes[-1], potential.surge_tank()
    panels[0].reference("FNPF", flow.t, flow.height(o.dp))
    panels[1].reference("FNPF", flow.t, flow.height(0.8 - o.dp))
    yield "surge_elevation.svg", panels
    pressures = [overlay(f"P{i}, {0.05 * i:.2f} m above the floor, 5 ms mean", "Pa", outcomes, f"P{i}", 0.005, begin=0.05) for i in (1, 3, 5)]
    for panel, row in zip(pressures, (0, 2)):
        panel.reference("FNPF", flow.t, flow.p[row])
    yield "surge_pressure.svg", pressures
    budget = Panel(f"energy since the start, dp {o.dp:g}", "J/m").curve("kinetic + potential", o.t, o["ke"] + o["pe"] - o["ke"][0] - o["pe"][0])
    budget.reference("FNPF", flow.t, flow.energy)
    for name in ("wall_work_momentum", "viscous", "numerical"):
        budget.curve(name.replace("_", " "), o.t, o[name])
    yield "surge_energy.svg", [budget]


def low_fill(outcomes, refs, name="low_fill"):
    yield f"{name}.svg", [overlay("height 0.02 m from the right wall, 20 ms mean", "m", outcomes, "eta_right", 0.02),
                           overlay("P1, 20 ms mean", "Pa", outcomes, "P1", 0.02)]


def breaking(outcomes, refs, name="breaking"):
    volume = Panel("volume of the liquid, change", "%")
    for o in outcomes:
        volume.curve(named(o), o.t, 100 * o["volume_error"])
    yield f"{name}.svg", [overlay(f"{p}, 2 ms mean", "Pa", outcomes, p, 0.002, begin=0.05) for p in ("P1", "P2", "P3")] + [
        overlay("cavities", "cm2", outcomes, "air_volume", factor=1e4), volume]


def baffle_2d(outcomes, refs):
    yield "baffle_2d.svg", [overlay(f"gauge {x}, {place}", "m", outcomes, f"eta_{x}", 0.01)
                            for x, place in (("a", "left"), ("b", "above the baffle"), ("c", "right"))]


def baffle_3d(outcomes, refs):
    yield "baffle_3d.svg", [overlay(f"gauge {x}, {place}", "m", outcomes, f"eta_{x}", 0.01) for x, place in (("a", "left"), ("c", "right"))]


def dam_panels(outcomes, refs):
    x_label, scale = "t* = t sqrt(g/H)", e.DAM_DENSITY * theory.G * e.DAM_H
    one, two = Panel("P1, 3 mm up, mean over dp/u", "p*", x_label, (-0.3, 4)), Panel("P2, 15 mm up, 5 ms mean", "p*", x_label, (-0.3, 3))
    front = Panel("front", "m", "t* = t sqrt(g/H)")
    band = refs.series("reference/lobovsky_h300_pressure_percentiles.csv", (0, 1, 2, 3))
    if band is not None:
        two.band("2.5-97.5 % of 100 experiments", band[0], band[1], band[3])
        two.reference("their median", band[0], band[2])
    for o in outcomes:
        t = o.t * np.sqrt(theory.G / e.DAM_H)
        one.curve(named(o), t, o["P1"] / scale)
        two.curve(named(o), t, smooth(o, "P2") / scale)
        front.curve(named(o), t[t < 3], o["front"][t < 3])
    return [one, two, front]


def dam_break(outcomes, refs):
    yield "dam_break.svg", dam_panels(outcomes, refs)


def dam_break_3d(outcomes, refs):
    yield "dam_break_3d.svg", dam_panels(outcomes, refs)[:2]


def long_run(outcomes, refs, name):
    o = outcomes[-1]
    energy = Panel("energy since the start", "J/m").curve("kinetic", o.t, o["ke"]).curve("potential", o.t, o["pe"] - o["pe"][0])
    yield f"{name}.svg", [overlay("height at the left wall, 5 ms mean", "m", outcomes, "eta_left", 0.005), energy]


def static_two_fluid(outcomes, refs):
    panels = []
    for i, y in enumerate((0.25, 0.5, 0.75), 1):
        panel = Panel(f"pressure {y} m above the floor, less the exact one", "Pa")
        for o in outcomes:
            panel.curve(named(o), o.t, o[f"P{i}"] - theory.G * (ph.LIGHT * ph.LAYER + ph.HEAVY * (ph.LAYER - y)))
        panels.append(panel)
    yield "static_two_fluid.svg", [*panels, overlay("kinetic energy", "J/m", outcomes, "ke", logarithmic=True)]


def rayleigh_taylor(outcomes, refs):
    ref, panels = refs.series(*ph.TIPS_SERIES), []
    for i, (name, text) in enumerate((("ytop", "highest"), ("ybot", "lowest")), 1):
        panel = overlay(f"{text} point of the interface", "m", outcomes, name)
        if ref is not None:
            panels.append(panel.reference("volume of fluid", ref[0], ref[i]))
        else:
            panels.append(marks(panel, "volume of fluid", [(tip[0], tip[i]) for tip in ph.TIPS]))
    yield "rayleigh_taylor.svg", panels


def rising_bubble(outcomes, refs, number=1):
    ref, panels = refs.series(ph.BUBBLE_SERIES.format(number), (0, 2, 3, 4)), []
    for i, name, text, unit in ((2, "yc", "height of the centre", "m"), (3, "v", "rise velocity", "m/s"), (1, "circularity", "circularity", "")):
        panel = overlay(text, unit, outcomes, name)
        if ref is not None:
            panel.reference("Hysing et al. 2009", ref[0], ref[i])
        panels.append(panel)
    yield f"rising_bubble{'' if number == 1 else f'_{number}'}.svg", panels


def droplet(outcomes, refs):
    panel = overlay("pressure jump", "Pa", outcomes, "dp", y_limits=(0, 30))
    t = outcomes[-1].t[[0, -1]]
    yield "droplet.svg", [panel.reference("sigma/R", t, [ph.SIGMA / ph.drop_radius(outcomes[-1])] * 2)]


def droplet_oscillation(outcomes, refs):
    yield "droplet_oscillation.svg", [overlay("half axis along x", "mm", outcomes, "rx", factor=1e3)]


def air_cushion(outcomes, refs):
    yield "air_cushion.svg", [overlay("displacement of the slug", "mm", outcomes, "x_slug", factor=1e3)]


PLOTS = {"static_tank": static_tank, "static_tank_3d": static_tank_3d, "standing_wave": standing_wave, "small_surge": small_surge,
         "sloshing_high_fill": high_fill, "sloshing_surge": surge, "sloshing_low_fill": low_fill, "sloshing_breaking": breaking,
         "sloshing_baffle_2d": baffle_2d, "sloshing_baffle_3d": baffle_3d, "dam_break": dam_break, "dam_break_3d": dam_break_3d,
         "static_two_fluid": static_two_fluid, "rayleigh_taylor": rayleigh_taylor, "rising_bubble": rising_bubble,
         "rising_bubble_2": lambda o, r: rising_bubble(o, r, 2), "droplet": droplet, "droplet_oscillation": droplet_oscillation,
         "air_cushion": air_cushion, "high_fill_air": lambda o, r: high_fill(o, r, "high_fill_air"),
         "low_fill_air": lambda o, r: low_fill(o, r, "low_fill_air"), "breaking_air": lambda o, r: breaking(o, r, "breaking_air"),
         "breaking_air_3d": lambda o, r: breaking(o, r, "breaking_air_3d"),
         "long_surge": lambda o, r: long_run(o, r, "long_surge"), "long_breaking": lambda o, r: long_run(o, r, "long_breaking")}

# case -> file, the driver's pictures in it, of the finest run, and perhaps how much of their height from the floor is shown
PICTURES = {"sloshing_surge": ("surge_flow.png", (2, 3)), "sloshing_low_fill": ("low_fill_flow.png", (1, 2, 3, 4), 0.25),
            "sloshing_breaking": ("breaking_flow.png", (1, 2, 3, 4)), "sloshing_baffle_2d": ("baffle_2d_flow.png", (1, 2)),
            "sloshing_baffle_3d": ("baffle_3d_flow.png", (1, 2)), "dam_break": ("dam_break_flow.png", (1, 2, 3, "end")),
            "rayleigh_taylor": ("rayleigh_taylor_flow.png", (1, 2, 3, "end")), "rising_bubble": ("rising_bubble_flow.png", (1, 2, 3, "end")),
            "low_fill_air": ("low_fill_air_flow.png", (1, 2, 3, 4), 0.25), "breaking_air": ("breaking_air_flow.png", (1, 2, 3, 4)),
            "breaking_air_3d": ("breaking_air_3d_flow.png", (1, 2, 3, 4))}
