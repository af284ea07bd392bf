#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compare fits of the library with those of scipy, and of R's package evd where it is installed.

usage: compare_fits.py PRINT_FITS

Both search with a general optimiser: what they find must not be likelier than it, nor far from it.
Exit code 77: no scipy, so nothing was compared.
"""
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import numpy as np
    import scipy
    from scipy import optimize, stats
except ImportError as missing:
    print(f"skipped: {missing}; install python3-scipy")
    sys.exit(77)

CASES = [("weibull", 0.8), ("weibull", 1.0), ("weibull", 2.5), ("pareto", 0.3), ("pareto", 0.05), ("pareto", -0.2)]
SIZES = (30, 100, 1000)
SHAPE, SCALE = 1e-6, 1e-6  # their searches by simplices find about 7 digits
LIKELIHOOD = 1e-12         # of the sum, by rounding
EVD = """suppressMessages(library(evd))
x <- scan("{peaks}", quiet = TRUE)
f <- suppressWarnings(fpot(x, 0, start = list(scale = {scale}, shape = {shape}), std.err = FALSE, method = "Nelder-Mead",
                           control = list(reltol = 1e-15, maxit = 20000)))
cat(sprintf("%d %.17g %.17g %.17g\\n", f$convergence == "successful", f$estimate["scale"], f$estimate["shape"], -f$deviance / 2))
"""


def ours(program, peaks, u, number):
    text = "\n".join(f"{x:.17g}" for x in (u, number, *peaks))
    out = subprocess.run([program], input=text, check=True, stdout=subprocess.PIPE, text=True).stdout
    rows = [[float(x) for x in line.split()] for line in out.splitlines()]
    return {"weibull": rows[0], "pareto": rows[1]}


def scipys(kind, excess):
    """(scale, shape, logarithm of the likelihood)"""
    def precise(func, x0, args=(), disp=0):
        return optimize.fmin(func, x0, args=args, disp=disp, xtol=1e-10, ftol=1e-12, maxiter=20000, maxfun=20000)

    distribution = stats.weibull_min if kind == "weibull" else stats.genpareto
    start = (1.0,) if kind == "weibull" else (0.01,)
    shape, _, scale = distribution.fit(excess, *start, floc=0, scale=excess.mean(), optimizer=precise)
    return scale, shape, distribution.logpdf(excess, shape, 0, scale).sum()


def evds(excess, start):
    """As scipys(); None: R did not converge. In units of the mean, from a start 20 % off: BFGS on values in Pa stops early."""
    unit = excess.mean()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "peaks.txt"
        path.write_text("\n".join(f"{x:.17g}" for x in excess / unit))
        script = EVD.format(peaks=path, scale=1.2 * start[2] / unit, shape=0.8 * start[3])
        out = subprocess.run(["Rscript", "-e", script], check=True, stdout=subprocess.PIPE, text=True).stdout
    converged, scale, shape, likelihood = (float(x) for x in out.split())
    return (scale * unit, shape, likelihood - len(excess) * np.log(unit)) if converged else None


def has_evd():
    if not shutil.which("Rscript"):
        return False
    return subprocess.run(["Rscript", "-e", "library(evd)"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0


def check(name, mine, other, problems):
    scale, shape, likelihood = other
    if likelihood > mine[4] + LIKELIHOOD * abs(mine[4]):
        problems.append(f"{name}: likelihood {likelihood:.9g}, ours {mine[4]:.9g}")
    if abs(scale - mine[2]) > SCALE * mine[2] or abs(shape - mine[3]) > SHAPE:
        problems.append(f"{name}: scale {scale:.6g}, shape {shape:.6g}; ours {mine[2]:.6g}, {mine[3]:.6g}")
    return abs(scale / mine[2] - 1), abs(shape - mine[3])


def main():
    program, problems, worst, count, evd = sys.argv[1], [], {}, 0, has_evd()
    print(f"scipy {scipy.__version__}; " + ("evd" if evd else "no evd: R's part is left out"))
    for case, (kind, shape) in enumerate(CASES):
        for size in SIZES:
            random = np.random.default_rng(100 * case + size)
            q, u = random.random(size), 40000.0
            excess = 5000 * ((-np.log(q)) ** (1 / shape) if kind == "weibull" else (q ** -shape - 1) / shape)
            peaks = u + excess
            excess = peaks - u
            fits = ours(program, peaks, u, size)
            for fitted in ("weibull", "pareto"):
                mine, name = fits[fitted], f"{fitted} of {size} peaks of {kind} {shape}"
                if mine[1] != 2:  # no largest likelihood: nothing to compare
                    print(f"{name}: state {mine[1]:.0f}")
                    continue
                others = {"scipy": scipys(fitted, excess)}
                if evd and fitted == "pareto":
                    others["evd"] = evds(excess, mine)
                for by, other in others.items():
                    if other is None:
                        problems.append(f"{by}, {name}: did not converge")
                        continue
                    worst[by] = tuple(map(max, worst.get(by, (0, 0)), check(f"{by}, {name}", mine, other, problems)))
                    count += 1
            quantile = stats.genpareto.isf(1 / size, fits["pareto"][3], u, fits["pareto"][2])
            if abs(quantile - fits["pareto"][5]) > 1e-9 * quantile:
                problems.append(f"value of {size} peaks of {kind} {shape}: {quantile}, ours {fits['pareto'][5]}")
    for by, (scale, shape) in worst.items():
        print(f"{by}: scales within {scale:.2g}, shapes within {shape:.2g}")
    print("\n".join(problems) if problems else f"{count} fits agree")
    return 1 if problems else 0


sys.exit(main())
