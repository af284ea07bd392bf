# SPDX-License-Identifier: BSD-3-Clause
"""Measures of time series: crests, running means, noise, errors against a reference, frequencies, order of convergence."""
import numpy as np


def running_median(t, y, width):
    """Median over `width` about each time."""
    half = max(1, int(round(0.5 * width / (t[1] - t[0]))))
    padded = np.pad(y, half, mode="edge")
    return np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1), axis=1)


def running_mean(t, y, window):
    """Mean over a centred window [s]; the ends are means over what is there of it."""
    n = max(1, int(round(window / (t[1] - t[0]))))
    ones = np.ones(min(n, len(y)))
    return np.convolve(y, ones, "same") / np.convolve(np.ones(len(y)), ones, "same")


def crest(t, y, near, reach=0.25, half=15):
    """Time and height of the highest point within `near` +- `reach`, by a parabola through `half` rows on both sides."""
    inside = np.abs(t - near) <= reach
    if t[-1] < near + reach / 2 or not inside.any():
        return np.nan, np.nan
    i = int(np.argmax(np.where(inside, y, -np.inf)))
    lo, hi = max(0, i - half), min(len(t), i + half + 1)
    a, b, _ = np.polyfit(t[lo:hi] - t[i], y[lo:hi], 2)
    if a >= 0 or abs(b / (2 * a)) > t[hi - 1] - t[lo]:
        return t[i], y[i]
    return t[i] - b / (2 * a), np.polyval(np.polyfit(t[lo:hi] - t[i], y[lo:hi], 2), -b / (2 * a))


def peak(t, y, near, reach):
    """Largest value within `near` +- `reach`."""
    inside = np.abs(t - near) <= reach
    return y[inside].max() if t[-1] >= near + reach and inside.any() else np.nan


def largest(y):
    return y.max() if len(y) else np.nan


def dip(t, y, first, second):
    """How far y falls between two peaks, below the lower of them."""
    one, two = peak(t, y, first, 0.1), peak(t, y, second, 0.1)
    between = (t >= first) & (t <= second)
    return min(one, two) - y[between].min() if np.isfinite(one + two) else np.nan


def noise(t, y, window=0.005, begin=0.2):
    """Root mean square of what a running mean takes away, after `begin`."""
    use = (t > begin) & (t < t[-1] - window)
    return np.sqrt(np.mean((y - running_mean(t, y, window))[use] ** 2)) if use.any() else np.nan


def nrms(t, y, t_ref, y_ref, begin, end):
    """rms(y - reference) / rms(reference - its mean) between two times."""
    use = (t >= begin) & (t <= end)
    ref = np.interp(t, t_ref, y_ref)[use]
    if t[-1] < end - 0.01 or not use.any():
        return np.nan
    return np.sqrt(np.mean((y[use] - ref) ** 2)) / ref.std()


def ratio(y, ref):
    """Least-squares factor between two series without their means."""
    y, ref = y - y.mean(), ref - ref.mean()
    return float(np.sum(y * ref) / np.sum(ref * ref))


def harmonic(t, y, omega):
    """Amplitude of one frequency, with mean and trend taken out."""
    a = np.column_stack([np.cos(omega * t), np.sin(omega * t), np.ones_like(t), t])
    c = np.linalg.lstsq(a, y, rcond=None)[0]
    return float(np.hypot(c[0], c[1]))


def line(t, y, lo, hi):
    """Angular frequency between two bounds at which the windowed spectrum has its maximum."""
    window = np.hanning(len(t)) * (y - y.mean())
    best = np.linspace(lo, hi, 401)
    for _ in range(2):
        power = [abs(np.sum(window * np.exp(-1j * w * t))) for w in best]
        i = int(np.argmax(power))
        best = np.linspace(best[max(0, i - 1)], best[min(len(best) - 1, i + 1)], 101)
    return float(best[int(np.argmax([abs(np.sum(window * np.exp(-1j * w * t))) for w in best]))])


def growing_wave(t, y, omega, others):
    """Frequency, first amplitude and its growth [1/s] of a cosine, beside its second harmonic and waves of frequency `others`.

    The frequency is the one for which the quadrature part does not drift."""
    def fit(w):
        waves = [f(v * t) for v in (2 * w, *others) for f in (np.cos, np.sin)]
        a = np.column_stack([np.cos(w * t), np.sin(w * t), np.cos(w * t) * t, np.sin(w * t) * t, np.ones_like(t), *waves])
        return np.linalg.lstsq(a, y, rcond=None)[0]
    lo, hi = 0.96 * omega, 1.04 * omega
    for _ in range(40):
        mid = (lo + hi) / 2
        # y ~ cos((w + d) t) has the drift -d t sin(w t): negative below the right frequency is positive d
        lo, hi = (mid, hi) if fit(mid)[3] < 0 else (lo, mid)
    c = fit(lo)
    return lo, float(np.hypot(c[0], c[1])), float(c[2] / c[0])


def damped_wave(t, y, omega):
    """Frequency and growth [1/s] of one wave of any phase about a constant, by least squares, the frequency within a third of `omega`."""
    def rest(w, g):
        e = np.exp(g * t)
        a = np.column_stack([e * np.cos(w * t), e * np.sin(w * t), np.ones_like(t)])
        return np.sum((y - a @ np.linalg.lstsq(a, y, rcond=None)[0]) ** 2)
    w, g, reach_w, reach_g = omega, 0.0, omega / 3, omega / 3
    for _ in range(12):
        trials = [(rest(a, b), a, b) for a in np.linspace(w - reach_w, w + reach_w, 13) for b in np.linspace(g - reach_g, g + reach_g, 7)]
        _, w, g = min(trials)
        reach_w, reach_g = reach_w / 3, reach_g / 2
    return float(w), float(g)


def repeat_time(t, y, lo, hi):
    """Shift between lo and hi [s] at which a series is most like itself."""
    step = t[1] - t[0]
    shifts = np.arange(int(lo / step), min(int(hi / step), len(y) - 10))
    if len(shifts) < 3:
        return np.nan
    y = y - y.mean()
    like = np.array([np.corrcoef(y[n:], y[:-n])[0, 1] for n in shifts])
    return float(shifts[int(np.argmax(like))] * step)


def band_share(t, y, low, high):
    """Share of rows between two curves."""
    return float(np.mean((y > low) & (y < high))) if len(t) else np.nan


def order(dps, errors):
    """Slope of log |error| over log dp, by least squares; None from fewer than two resolutions."""
    pairs = [(d, abs(e)) for d, e in zip(dps, errors) if e is not None and np.isfinite(e) and e != 0]
    if len(pairs) < 2:
        return None
    x, y = np.log([p[0] for p in pairs]), np.log([p[1] for p in pairs])
    return float(np.polyfit(x, y, 1)[0])
