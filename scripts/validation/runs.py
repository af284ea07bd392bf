# SPDX-License-Identifier: BSD-3-Clause
"""Run the drivers, several at a time, and keep what is there already."""
import fcntl
import hashlib
import json
import shutil
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from results import Outcome

USAGE, DIVERGED, INTERRUPTED = 2, 3, 130
LONG = 5  # minutes, from which on a run leaves checkpoints
CHECKPOINTS = ["--checkpoint", "0.1"]


def say(text):
    print(text, flush=True)


class Runner:
    """Runs go into `out`/<name of the run>; run.json there is written last and says what was run."""

    def __init__(self, examples, out, jobs, again):
        self.examples, self.out, self.jobs, self.again = Path(examples), Path(out), jobs, again
        self.lock, self.done, self.stop = threading.Lock(), 0, False
        self.prints = {}

    def folder(self, run):
        return self.out / run.name

    def command(self, run):
        return [run.driver, "--dp", f"{run.dp:g}", "--threads", "1", "--frames", "0", "--no-report", "--quiet", *run.options]

    def binary(self, driver):
        """Fingerprint of a driver and of the library beside it; None without them."""
        if driver not in self.prints:
            path = self.examples / driver
            files = [path, *sorted(self.examples.parent.glob("libmps.so.?"))]
            self.prints[driver] = hashlib.sha256(b"".join(f.read_bytes() for f in files)).hexdigest()[:16] if path.exists() else None
        return self.prints[driver]

    def note(self, run):
        try:
            return json.loads((self.folder(run) / "run.json").read_text())
        except (OSError, ValueError):
            return None

    def fresh(self, run):
        """There is a result of the same command and the same program."""
        note = self.note(run)
        return bool(note) and note["command"] == self.command(run) and note["binary"] == self.binary(run.driver)

    def outcome(self, run):
        """What a run left, also an older one; None if there is nothing to read."""
        note = self.note(run)
        if not note or note["command"] != self.command(run):
            return None
        try:
            outcome = Outcome(run, self.folder(run))
        except (OSError, ValueError, KeyError) as error:
            say(f"{run.name}: cannot read its outputs: {error}")
            return None
        outcome.current = self.binary(run.driver) in (None, note["binary"])
        return outcome

    def execute(self, run, count):
        if self.stop:
            return
        with self.lock:
            self.done += 1
            say(f"[{self.done}/{count}] {run.name}: about {run.minutes:g} CPU minutes ...")
        folder = self.folder(run)
        begin, command = time.monotonic(), self.command(run) + self.begin(run)
        with open(folder / "run.log", "w", encoding="utf-8") as log:
            code = subprocess.call([str(self.examples / command[0]), *command[1:], "--out", str(folder)], stdout=log, stderr=log)
        seconds = time.monotonic() - begin
        self.finish(run, code, seconds)

    def begin(self, run):
        """Make the folder of a run, or find it with a checkpoint of the same command and program. Returns the options for that."""
        folder = self.folder(run)
        begun = {"command": self.command(run), "binary": self.binary(run.driver)}
        try:
            same = json.loads((folder / "begun.json").read_text()) == begun
        except (OSError, ValueError):
            same = False
        if same and (folder / "checkpoint.mps").exists() and not (folder / "run.json").exists():
            say(f"{run.name}: goes on from its checkpoint")
            return [*CHECKPOINTS, "--resume"]
        if folder.exists():
            shutil.rmtree(folder)
        folder.mkdir(parents=True)
        (folder / "begun.json").write_text(json.dumps(begun) + "\n")
        return CHECKPOINTS if run.minutes >= LONG else []

    def finish(self, run, code, seconds):
        folder = self.folder(run)
        tail = (folder / "run.log").read_text(errors="replace").strip().splitlines()[-1:]
        if code not in (0, DIVERGED):
            self.stop = self.stop or code in (INTERRUPTED, -2)
            say(f"{run.name}: exit {code}: {' '.join(tail)}")
            if code == USAGE:  # perhaps a checkpoint that does not fit its files: the next time from the beginning
                (folder / "begun.json").unlink(missing_ok=True)
            return
        note = {"command": self.command(run), "binary": self.binary(run.driver), "exit": code, "wall_s": round(seconds, 1),
                "when": time.strftime("%Y-%m-%d"), "message": " ".join(tail) if code else ""}
        (folder / "run.json").write_text(json.dumps(note, indent=1) + "\n")
        say(f"{run.name}: {'done' if code == 0 else 'diverged: ' + note['message']} after {seconds:.0f} s")

    def run_all(self, wanted):
        """Run what is not there yet, short ones first."""
        self.out.mkdir(parents=True, exist_ok=True)
        lock = open(self.out / "lock", "w", encoding="utf-8")  # held until the program ends
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            sys.exit(f"another scripts/validate is running into {self.out}")
        todo = [run for run in wanted if self.again or not self.fresh(run)]
        say(f"{len(wanted)} runs, {len(wanted) - len(todo)} of them there already, about {sum(r.minutes for r in todo):.0f} CPU minutes to go")
        try:
            with ThreadPoolExecutor(self.jobs) as pool:
                list(pool.map(lambda run: self.execute(run, len(todo)), sorted(todo, key=lambda run: run.minutes)))
        except KeyboardInterrupt:
            self.stop = True
        if self.stop:
            sys.exit("interrupted; what is done is kept")
