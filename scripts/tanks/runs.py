# SPDX-License-Identifier: BSD-3-Clause
"""Runs the program, one run after the other; of each a file with its signals and a note stay. What is there already is not run again."""
import csv
import json
import os
import shutil
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
from cases import Run
from events import Signals


def note_of(out: Path, run: Run) -> dict | None:
    """What is known of a run that ended; None: none, or of another case."""
    try:
        note = json.loads((out / f"{run.name}.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return note if note["case"] == run.key else None


def columns(path: Path) -> dict[str, np.ndarray]:
    """Columns of a CSV file by their names without units."""
    with open(path, encoding="utf-8") as file:
        names = [name.split("[")[0] for name in next(csv.reader(file))]
        return dict(zip(names, np.loadtxt(file, delimiter=",", ndmin=2).T))


def keep(folder: Path, path: Path) -> int:
    """Signals of the folder of a run in one file. Returns the most pockets of gas at a time."""
    trace, steps = columns(folder / "trace.csv"), columns(folder / "steps.csv")
    use = trace["dt"] > 0
    sensors = {name: y[use].astype(np.float32) for name, y in trace.items() if name[:4] in ("left", "righ") or name in ("P1", "P2", "P3")}
    crossing = np.interp(trace["t"][use], steps["t"], steps["crossing_time"]).astype(np.float32)
    np.savez_compressed(path, t=trace["t"][use], dt=trace["dt"][use], crossing=crossing, **sensors)
    return int(trace["pockets"].max()) if "pockets" in trace else 0


def signals(out: Path, run: Run) -> Signals | None:
    path = out / f"{run.name}.npz"
    if not path.exists():
        return None
    with np.load(path) as data:
        p = {name: data[name].astype(float) for name in data.files if name not in ("t", "dt", "crossing")}
        return Signals(data["t"], data["dt"], data["crossing"].astype(float), p)


def execute(program: Path, out: Path, run: Run) -> None:
    folder, case = out / run.name, out / f"{run.name}.yaml"
    shutil.rmtree(folder, ignore_errors=True)
    case.write_text(run.case(), encoding="utf-8")
    before, begin = os.times(), time.monotonic()
    command = [str(program), "run", str(case), "-q", "-o", str(folder)]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    after = os.times()
    if done.returncode in (-2, 130):
        raise KeyboardInterrupt
    cpu = after.children_user + after.children_system - before.children_user - before.children_system
    note = {"case": run.key, "exit": done.returncode, "message": " ".join(done.stdout.split())[-300:], "cpu_s": round(cpu, 2),
            "wall_s": round(time.monotonic() - begin, 1), "steps": 0}
    if (folder / "trace.csv").exists() and (folder / "steps.csv").exists():
        note["pockets"] = keep(folder, out / f"{run.name}.npz")
        with np.load(out / f"{run.name}.npz") as data:
            note["steps"] = len(data["t"])
    elif done.returncode == 0:
        sys.exit(f"{run.name}: the run left no trace.csv")
    (out / f"{run.name}.json").write_text(json.dumps(note, indent=1) + "\n", encoding="utf-8")
    shutil.rmtree(folder, ignore_errors=True)
    print(f"{run.name}: exit {done.returncode}, {note['steps']} steps, {note['cpu_s']:.1f} s of CPU {note['message'][:150]}", flush=True)


def share(out: Path, run: Run) -> bool:
    """Without a pocket a run with `gas.pocket` has the bytes of one without it, so it is both."""
    if run.variant != "void":
        return False
    other = replace(run, variant="pocket")
    note = note_of(out, other)
    if not note or note["exit"] != 0 or note.get("pockets", 1) != 0:
        return False
    shutil.copyfile(out / f"{other.name}.npz", out / f"{run.name}.npz")
    note |= {"case": run.key, "cpu_s": 0, "same_as": other.name}
    (out / f"{run.name}.json").write_text(json.dumps(note, indent=1) + "\n", encoding="utf-8")
    print(f"{run.name}: no pocket in {other.name}, the same", flush=True)
    return True


def run_all(program: Path, out: Path, wanted: list[Run], seconds: float) -> None:
    """Run what is not there, as long as `seconds` of the clock have not passed."""
    out.mkdir(parents=True, exist_ok=True)
    end = time.monotonic() + seconds
    for run in wanted:
        if note_of(out, run) or share(out, run):
            continue
        if time.monotonic() > end:
            print("the time is over; call again to go on")
            return
        execute(program, out, run)
