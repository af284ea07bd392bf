# SPDX-License-Identifier: BSD-3-Clause
"""The tables of docs/validation.md and docs/validation/errors.md: what a user can rely on, within what, at which resolution."""
import re

import numpy as np

# Quantity, case, figures of it, number of rows of particles over what depth or height [m]
ROWS = [
    ("pressure of liquid at rest, of rho g h", "static_tank", r"P\d, mean error", 0.25),
    ("pressure of liquid at rest, 3-D", "static_tank_3d", r"P\d, mean error", 0.2),
    ("frequency of a standing wave", "standing_wave", r"frequency", 0.5),
    ("growth of a standing wave, a period", "standing_wave", r"growth a period", 0.5),
    ("sloshing: crests 1 to 5, up to 0.4 of the depth", "sloshing_high_fill", r"crest \d$", 0.3),
    ("pressure maxima at the wall of that tank", "sloshing_high_fill", r"P1, peak", 0.3),
    ("sloshing: crests 1 to 3, up to 0.7 of the depth", "sloshing_surge", r"crest [123]$", 0.25),
    ("sloshing: crest 4, which breaks at the wall", "sloshing_surge", r"crest 4$", 0.25),
    ("sloshing: energy of that wave, of its largest value", "sloshing_surge", r"energy, largest error", 0.25),
    ("small waves: elevation", "small_surge", r"eta_right, NRMS \[", 0.3),
    ("small waves: wall pressure about its mean", "small_surge", r"P1, NRMS \[", 0.3),
    ("impulse of a flat impact at the bottom", "impact_flat", r"impulse at the bottom", 1),
    ("impulse of a flat impact, mean of the wall", "impact_flat", r"impulse, mean", 1),
    ("stagnation pressure of a jet, mean", "impact_jet", r"stagnation pressure", 1),
    ("largest pressure on a wedge of 30 degrees", "impact_wedge_30", r"largest Cp, sensor of 4 dp", 0.2),
    ("first peak of a dam break, mean over dp/u", "dam_break", r"P1, largest to t\* = 3.2 \(mean over dp", 0.3),
    ("first peak of a dam break, mean over 8 ms", "dam_break", r"P1, largest to t\* = 3.2 \(mean over 8 ms", 0.3),
]


def worst(figures, pattern):
    """Largest error [%] of the figures whose name begins so; None without any."""
    errors = [abs(f.error) for f in figures if re.match(pattern, f.name) and f.error is not None]
    return max(errors) if errors and np.all(np.isfinite(errors)) else None


def rows(results):
    """One row a quantity: its name, rows of particles and largest error at each spacing, coarsest first."""
    for text, case, pattern, depth in ROWS:
        plain = [(o, figures) for o, figures in results.get(case, []) if o.run.cfl is None][:3]
        if not plain:
            continue
        counts = ", ".join(f"{depth / o.dp:.0f}" for o, _ in plain)
        errors = [worst(figures, pattern) for _, figures in plain]
        cells = ["-" if e is None else f"{e:.1f} %" if e >= 0.05 else "< 0.1 %" for e in errors]
        yield [text, f"`{case}`", counts, *cells, *[""] * (3 - len(cells))]


TRUST, CARE = 5, 15  # largest error [%] of what can be trusted, and of what needs care

FIRST = ["figure", "rows of particles", "largest error", "trust it"]


def first(rows):
    """From the rows below: the finest spacing, in words."""
    for text, _, counts, *cells in rows:
        known = [cell for cell in cells if cell]
        error = known[-1]
        size = 0 if error.startswith("<") else float(error.split()[0]) if error != "-" else None
        word = "-" if size is None else "yes" if size <= TRUST else "with care" if size <= CARE else "no"
        yield [text, counts.split(", ")[-1], error, word]


HEAD = ["error of", "case", "rows of particles", "coarse", "standard", "fine"]
