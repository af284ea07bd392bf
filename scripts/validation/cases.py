# SPDX-License-Identifier: BSD-3-Clause
"""The cases: which driver or case file with which options at which spacings, and how it is evaluated."""
from dataclasses import dataclass
from fnmatch import fnmatch
from typing import Callable

import evaluate as e
import impacts as im
import phases as ph

LEVELS = ("coarse", "standard", "fine")


@dataclass(frozen=True)
class Run:
    """One run. `minutes`: CPU minutes on one core of about 2.5 GHz, to plan with."""
    case: str
    program: str
    dp: float
    level: str
    minutes: float
    options: tuple = ()
    suffix: str = ""
    cfl: float | None = None
    other_model: str | None = None  # literal equations, or a model that is not meant for the case

    @property
    def of_mps(self):
        return self.program.endswith(".yaml")

    @property
    def name(self):
        return f"{self.case}-{self.dp:g}{self.suffix}" + ("" if self.cfl is None else f"-cfl{self.cfl:g}")


@dataclass(frozen=True)
class Case:
    """`program`: a driver with its options, or a file of cases/ that `mps` runs with values path=value.
    `spacings`: dp -> CPU minutes, coarsest first: of level coarse, standard, fine.
    `expected`: figures that reached their limit at the coarsest dp, with some margin, and must continue to do so.
    `cfl`: lengths of the step tried at one dp, too.
    `others`: models tried at the coarsest dp to see how far they get; of a case file model -> what else it needs.
    `paper`: made for docs/paper-cases.md alone, with frames."""
    name: str
    program: str
    spacings: dict
    evaluate: Callable
    options: tuple = ()
    levels: tuple = LEVELS
    others: tuple | dict = ("imps.paper",)
    expected: tuple = ()
    paper: bool = False
    cfl: tuple = ()
    cfl_dp: float = 0

    def runs(self):
        for (dp, minutes), level in zip(self.spacings.items(), self.levels):
            yield Run(self.name, self.program, dp, level, minutes, self.options)
        for cfl in self.cfl:
            minutes = self.spacings[self.cfl_dp] * max(1, 0.3 / cfl)
            yield Run(self.name, self.program, self.cfl_dp, "standard", minutes, (*self.options, "--cfl", f"{cfl:g}"), cfl=cfl)
        for model in self.others:
            dp, minutes = next(iter(self.spacings.items()))
            suffix = "-paper" if model == "imps.paper" else f"-{model}"
            change = (f"model={model}", *self.others[model]) if isinstance(self.others, dict) else ("--model", model)
            yield Run(self.name, self.program, dp, "standard", minutes, (*self.options, *change), suffix, other_model=model)


def options(text):
    return tuple(text.split())


STILL = ("P1, mean error [% of rho g h]", "P2, mean error [% of rho g h]", "P3, mean error [% of rho g h]", "P1..P3, largest rms [% of rho g h]",
         "level [% of the depth]")
HIGH_FILL = ("crest 1", "crest 1, time", "crest 2", "crest 2, time", "P1, peak at 0.58 s", "P1, peak at 1.50 s", "P1, peak at 2.40 s",
             "P1, peak at 3.30 s", "P1, peak at 3.60 s", "P1, peak at 4.21 s", "P1, dip between 3.30 and 3.60 s (20 ms mean)")
SURGE = ("crest 1", "crest 1, time", "crest 2, time", "crest 3", "crest 3, time", "crest 4", "crest 4, time")
WAVE = tuple(f"{figure}, {place}{unit}" for place in ("crests at the wall", "centre of mass")
             for figure, unit in (("frequency", ""), ("amplitude after 5 periods / viscous", ""), ("growth a period", " [%]")))
BAFFLE = ("line of the spectrum at gauge a", "line of the spectrum at gauge c", "amplitude at gauge a / unbaffled", "amplitude at gauge c / unbaffled",
          "volume error [%]")
TWO_PHASES = ("mmps.paper", "imps", "imps.paper")
ONE_PHASE = ("imps", "imps.paper")  # they have no gas and no tension, and their walls have no slip
BUBBLE = {"mmps.paper": ("use=reference.lid",),
          **dict.fromkeys(ONE_PHASE, ("remove=[]", "use=[reference.lid, tension.csf]", "settings={tension.sigma: 24.5 N/m}"))}
DROP = {"mmps.paper": (), **dict.fromkeys(ONE_PHASE, ("use=tension.csf",))}
CUSHION = {"mmps.paper": (), **dict.fromkeys(ONE_PHASE, ("use=gas.compressible", "settings={gas.sound: 340 m/s}"))}
STEPS = (0.05, 0.1, 0.2, 0.5)
LOW_FILL, START = "--t-end 10 --frames 200 --pictures 2.75,4.8,6.1,7.85", "--t-end 3 --frames 30"

CASES = [
    Case("static_tank", "static_tank", {0.02: 0.15, 0.01: 1, 0.005: 6}, e.static_tank, expected=STILL),
    Case("static_tank_3d", "static_tank", {0.03: 0.5, 0.02: 2, 0.015: 6}, e.static_tank_3d, options("--dim 3"), expected=STILL),
    Case("standing_wave", "standing_wave.yaml", {0.02: 0.5, 0.01: 3, 0.005: 20}, e.standing_wave, ("run.until=6.1 s",),
         others={"imps.paper": ()}, expected=WAVE),
    Case("small_surge", "sloshing_high_fill", {0.02: 0.1, 0.01: 0.5, 0.005: 4}, e.small_surge, options("--amplitude 5e-4 --t-end 3"),
         others=()),
    Case("sloshing_high_fill", "sloshing_high_fill", {0.02: 0.2, 0.01: 1, 0.005: 6}, e.high_fill, expected=HIGH_FILL),
    Case("sloshing_surge", "sloshing_surge", {0.0125: 0.6, 0.008: 2, 0.004: 20}, e.surge, expected=SURGE),
    Case("surge_counts", "sloshing_surge", {0.004: 0.1}, e.surge_counts, options("--whole-rows --t-end 1e-4"), others=(),
         expected=("fluid particles", "wall and dummy particles")),
    Case("sloshing_low_fill", "sloshing_low_fill", {0.005: 1, 0.00375: 2.5, 0.0025: 9}, e.low_fill, options("--pictures 2.75,4.8,6.1,7.85"),
         expected=("run-up at the left wall, time of the largest P1",)),
    Case("sloshing_breaking", "sloshing_breaking", {0.02: 0.5, 0.01: 5, 0.005: 50}, e.breaking, options("--t-end 8 --pictures 2.2,2.3,2.4,2.5")),
    Case("sloshing_baffle_2d", "sloshing_baffle_2d", {0.012: 0.5, 0.008: 1.5, 0.006: 3}, e.baffle_2d, options("--t-end 10"), expected=BAFFLE),
    Case("sloshing_baffle_3d", "sloshing_baffle_3d", {0.02: 6, 0.01: 80}, e.baffle_3d, options("--t-end 3"), ("coarse", "fine"),
         expected=("time reached",)),
    Case("baffle_3d_counts", "sloshing_baffle_3d", {0.005: 3}, e.baffle_3d_counts, options("--paper-baffle --t-end 1e-5"), ("standard",), ()),
    Case("static_two_fluid", "static_two_fluid", {0.02: 2, 0.01: 15}, ph.static_two_fluid, others=TWO_PHASES),
    Case("rayleigh_taylor", "rayleigh_taylor", {0.025: 0.5, 0.0125: 3, 0.01: 6}, ph.rayleigh_taylor, others=TWO_PHASES),
    Case("rising_bubble", "rising_bubble.yaml", {0.025: 0.5, 0.02: 1, 0.0125: 4}, ph.rising_bubble, others=BUBBLE),
    Case("rising_bubble_2", "rising_bubble_2.yaml", {0.02: 2, 0.0125: 8}, ph.rising_bubble_2, levels=("standard", "fine"), others=()),
    Case("droplet", "droplet.yaml", {5e-4: 0.5, 3.5e-4: 1, 2.5e-4: 3}, ph.droplet, others=DROP),
    Case("droplet_oscillation", "droplet_oscillation.yaml", {5e-4: 0.5, 3.5e-4: 1, 2.5e-4: 3}, ph.droplet_oscillation, others=DROP),
    Case("air_cushion", "air_cushion.yaml", {0.02: 0.1, 0.01: 0.3, 0.005: 1}, ph.air_cushion, others=CUSHION),
    Case("high_fill_air", "sloshing_high_fill", {0.02: 1, 0.01: 5}, ph.high_fill_air, options("--model mmps"), others=("mmps.paper",)),
    Case("low_fill_air", "sloshing_low_fill", {0.00375: 40}, e.low_fill, options("--model mmps --pictures 2.75,4.8,6.1,7.85"), ("fine",), ()),
    Case("breaking_air", "sloshing_breaking", {0.02: 3, 0.01: 25, 0.005: 200}, ph.breaking_air, options("--model mmps --t-end 8 --pictures 2.2,2.3,2.4,2.5"),
         others=("mmps.paper",)),
    Case("breaking_air_3d", "sloshing_breaking", {0.02: 15}, ph.breaking_air_3d,
         options("--model mmps --dim 3 --t-end 3 --pictures 2.2,2.4,2.6,2.8"), ("standard",), ()),
    Case("rayleigh_taylor_flow", "rayleigh_taylor", {0.0125: 3}, ph.rayleigh_taylor, options("--frames 5"), ("standard",), ("imps",), paper=True),
    Case("high_fill_late", "sloshing_high_fill", {0.01: 1}, e.late, options("--t-end 8 --frames 80"), ("standard",), (), paper=True),
    Case("high_fill_late_air", "sloshing_high_fill", {0.01: 1.5}, e.late, options("--model mmps --t-end 8 --frames 80"), ("standard",), (), paper=True),
    Case("low_fill_flow", "sloshing_low_fill", {0.01: 0.3, 0.005: 1}, e.low_fill, options(LOW_FILL), ("standard",) * 2, (), paper=True),
    Case("low_fill_flow_air", "sloshing_low_fill", {0.01: 1.5, 0.005: 10}, e.low_fill, options(f"--model mmps {LOW_FILL}"), ("standard",) * 2,
         ("mmps.paper",), paper=True),
    Case("breaking_start", "sloshing_breaking", {0.02: 0.2, 0.01: 1}, e.breaking_start, options(START), ("standard",) * 2, (), paper=True),
    Case("breaking_start_air", "sloshing_breaking", {0.02: 0.5, 0.01: 4}, e.breaking_start, options(f"--model mmps {START}"), ("standard",) * 2, (),
         paper=True),
    Case("dam_break", "dam_break", {0.02: 0.1, 0.01: 0.4, 0.005: 5}, e.dam_break),
    Case("dam_break_3d", "dam_break", {0.03: 0.3, 0.02: 1, 0.015: 3}, e.dam_break, options("--dim 3")),
    Case("impact_flat", "impact", {0.05: 0.02, 0.025: 0.1, 0.0125: 0.4}, im.flat, options("--case flat"), others=(), cfl=STEPS, cfl_dp=0.025),
    Case("impact_flat_3d", "impact", {0.05: 0.1, 0.025: 0.4}, im.flat, options("--case flat --dim 3"), others=()),
    *(Case(f"impact_film_{n}", "impact", {0.01: 0.02}, im.film, options(f"--case film --rows {n}"), others=(), cfl=STEPS, cfl_dp=0.01) for n in (1, 2, 3, 4)),
    *(Case(f"impact_wedge_{n}", "impact", {0.01: 0.3, 0.005: 2, 0.0025: 15}, im.wedge, options(f"--case wedge --deadrise {n}"), others=())
      for n in (20, 30, 40)),
    Case("impact_jet", "impact", {0.05: 0.1, 0.025: 1}, im.jet, options("--case jet"), others=(), cfl=STEPS, cfl_dp=0.05),
    Case("impact_column", "impact", {0.05: 0.02, 0.025: 0.02, 0.0125: 0.1}, im.column, options("--case column"), others=(), cfl=STEPS, cfl_dp=0.025,
         expected=("largest pressure before contact", "rebound / U", "pressure at rest")),
    Case("impact_floor", "impact", {0.025: 0.02, 0.0125: 0.1}, im.leaving_floor, options("--case floor"), others=(), cfl=STEPS, cfl_dp=0.025),
    Case("impact_box", "impact", {0.04: 0.02, 0.02: 0.1, 0.01: 0.5}, im.box, options("--case box"), others=()),
    Case("impact_box_3d", "impact", {0.04: 0.3, 0.032: 0.5, 0.02: 3}, im.box, options("--case box --dim 3"), others=()),
    Case("long_surge", "sloshing_surge", {0.01: 14}, e.long_surge, options("--t-end 60 --probe-dt 0.002"), ("fine",), ()),
    Case("long_breaking", "sloshing_breaking", {0.01: 15}, e.long_breaking, options("--t-end 20 --probe-dt 0.002"), ("fine",), ()),
]


def find(names):
    """Cases by name or pattern (impact_*), all for None; ValueError with what there is."""
    if names is None:
        return CASES
    known = [case.name for case in CASES]
    wrong = [name for name in names if not any(fnmatch(k, name) for k in known)]
    if wrong:
        raise ValueError(f"no case {', '.join(wrong)}; there are {', '.join(known)}")
    return [case for name in names for case in CASES if fnmatch(case.name, name)]


def runs(cases, level):
    """Runs up to a level of resolution."""
    allowed = LEVELS[:LEVELS.index(level) + 1]
    return [run for case in cases for run in case.runs() if run.level in allowed]
