# SPDX-License-Identifier: BSD-3-Clause
"""Impacts in the signals of a run, and their figures.

A signal is the pressure of each step, without a mean. Its impulse J is a line between the ends of the steps, so a mean over any time is
exact: (J(t) - J(t - T))/T. Events are those of docs/explanations/impact_statistics.md: threshold and window."""
from dataclasses import dataclass

import numpy as np

MEANS = (0.001, 0.005, 0.020)  # [s] in a tank of 1 m
IMPULSE = 0.060  # [s] the largest impulse of so long a time: contact and what follows, whichever of several pulses begins the event
THRESHOLD = 1.5  # of rho g depth, of the mean over MEANS[1]
WINDOW = 0.2  # of the period of the motion
RHO, G = 1000.0, 9.81


@dataclass(frozen=True)
class Signals:
    """Steps of a run: their ends and lengths [s], crossing time [s], and pressures [Pa] by name of the sensor."""
    t: np.ndarray
    dt: np.ndarray
    crossing: np.ndarray
    p: dict[str, np.ndarray]


@dataclass(frozen=True)
class Event:
    """Peaks of the MEANS and of the impulse in rho g depth (times the time of a tank of 1 m); largest of the sensors of a wall."""
    wall: str
    t: float  # begin [s] / period of the motion
    crossing: float  # dp/u at the begin [s], in the time of a tank of 1 m
    peaks: tuple[float, ...]
    impulse: float
    panel: tuple[float, ...]  # peaks and impulse of the panel; empty without one
    resolved: float  # peak of the mean over dp/u, the default of sensors
    rises: tuple[float, ...]  # of that peak and of those of the MEANS, as triangles, in dp/u


class Impulse:
    """J of one sensor."""

    def __init__(self, s: Signals, name: str):
        self.t = np.concatenate([[s.t[0] - s.dt[0]], s.t])
        self.j = np.concatenate([[0.0], np.cumsum(s.p[name] * s.dt)])

    def at(self, t: np.ndarray) -> np.ndarray:
        return np.interp(t, self.t, self.j)

    def mean(self, end: np.ndarray, length: float | np.ndarray) -> np.ndarray:
        return (self.at(end) - self.at(end - length)) / length

    def largest_mean(self, lo: float, hi: float, length: float) -> float:
        """Over windows within lo .. hi; the mean is largest where one end of its window is the end of a step."""
        ends = self.t[(self.t >= lo) & (self.t <= hi)]
        ends = np.concatenate([ends[ends - length >= lo], ends[ends + length <= hi] + length, [hi]])
        return float(self.mean(ends, length).max())


def highest(s: Signals, sensors: list[Impulse], lo: float, hi: float, length: float | np.ndarray) -> tuple[float, float]:
    """Highest mean over a time, at the ends of steps [Pa], and its rise: twice the time from half of it to it, over dp/u. The page of a run
    has the same rise."""
    part = (s.t >= lo) & (s.t <= hi)
    peak, rise = -np.inf, np.nan
    for j in sensors:
        y = j.mean(s.t, length)
        top = int(np.argmax(np.where(part, y, -np.inf)))
        if y[top] <= peak:
            continue
        peak, below = float(y[top]), np.flatnonzero(y[:top] < y[top] / 2)
        if len(below):
            k = int(below[-1])
            half = s.t[k] + (s.t[k + 1] - s.t[k]) * (peak / 2 - y[k]) / (y[k + 1] - y[k])
            rise = 2 * (s.t[top] - half) / s.crossing[top]
    return peak, float(rise)


def intervals(t: np.ndarray, y: np.ndarray, threshold: float, window: float, after: float) -> list[tuple[float, float]]:
    """Begins and ends of the events of a signal; those that have not ended in the record, or have no time `after` their begin in it, are left out."""
    above = y >= threshold
    up = np.flatnonzero(above[1:] & ~above[:-1]) + 1
    down = np.flatnonzero(~above[1:] & above[:-1]) + 1
    down = down[down > up[0]] if len(up) else down[:0]
    found: list[tuple[float, float]] = []
    for k, first in enumerate(up):
        last = t[down[k]] if k < len(down) else np.inf
        if found and t[first] - found[-1][1] < window:
            found[-1] = (found[-1][0], last)
        else:
            found.append((t[first], last))
    return [e for e in found if max(e[0] + after, e[1]) < t[-1]]


def find(s: Signals, walls: tuple[str, ...], depth: float, period: float, time_scale: float) -> list[Event]:
    """Events at all walls, in the order of their begins."""
    scale, means = RHO * G * depth, [m * time_scale for m in MEANS]
    events = []
    for wall in walls:
        names = [n for n in s.p if n.startswith(wall) and n[len(wall):].lstrip("_").isdigit()]
        sensors = [Impulse(s, n) for n in names]
        panels = [Impulse(s, n) for n in s.p if n == f"{wall}_panel"]
        signal = np.max([j.mean(s.t, means[1]) for j in sensors], axis=0)
        for begin, end in intervals(s.t, signal, THRESHOLD * scale, WINDOW * period, IMPULSE * time_scale):
            lo = begin - means[1]

            def figures(of: list[Impulse]) -> list[float]:
                if not of:
                    return []
                peaks = [max(j.largest_mean(lo, max(end, lo + m), m) for j in of) for m in means]
                whole = IMPULSE * time_scale
                most = max(j.largest_mean(lo, max(end, lo + whole), whole) for j in of)
                return [x / scale for x in peaks] + [most / scale * IMPULSE]

            *peaks, impulse = figures(sensors)
            tops = [highest(s, sensors, lo, max(end, lo + np.max(m)), m) for m in (s.crossing, *means)]
            crossing = float(np.interp(begin, s.t, s.crossing)) / time_scale
            events.append(Event(wall, begin / period, crossing, tuple(peaks), impulse, tuple(figures(panels)), tops[0][0] / scale,
                                tuple(top[1] for top in tops)))
    return sorted(events, key=lambda e: e.t)
