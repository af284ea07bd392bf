# SPDX-License-Identifier: BSD-3-Clause
"""Run the drivers and mps, several at a time, and keep what is there already."""
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
CHECKPOINTS = {False: ["--checkpoint", "0.1"], True: ["--set", "run.checkpoint=0.1 s"]}  # of a driver, of mps
CASES = Path(__file__).resolve().parent.parent.parent / "cases"


def say(text):
    print(text, flush=True)


class Runner:
    """Runs go into `out`/<name of the run>; run.json there is written last and says what was run."""

    def __init__(self, build, out, jobs, again):
        self.build, self.out, self.jobs, self.again = Path(build), Path(out), jobs, again
        self.lock, self.done, self.stop = threading.Lock(), 0, False
        self.prints = {}

    def folder(self, run):
        return self.out / run.name

    def command(self, run):
        if run.of_mps:
            values = (f"dp={run.dp:g} m", "output.frames=0", "output.page=0 MB", *run.options)
            return ["mps", "run", f"cases/{run.program}", *(word for value in values for word in ("--set", value)), "-j", "1", "--quiet"]
        return [run.program, "--dp", f"{run.dp:g}", "--threads", "1", "--frames", "0", "--no-report", "--quiet", *run.options]

    def path(self, program):
        return self.build / ("apps/mps/mps" if program.endswith(".yaml") else f"examples/{program}")

    def words(self, run):
        """The command with the paths of its files."""
        command = self.command(run)
        return [str(self.path(run.program)), *(["run", str(CASES / run.program), *command[3:]] if run.of_mps else command[1:])]

    def binary(self, program):
        """Fingerprint of a driver, or of mps and a case, and of the library beside it; None without them."""
        if program not in self.prints:
            path, case = self.path(program), [CASES / program] if program.endswith(".yaml") else []
            files = [path, *case, *sorted(self.build.glob("libmps*.so.?" if case else "libmps.so.?"))]
            self.prints[program] = hashlib.sha256(b"".join(f.read_bytes() for f in files)).hexdigest()[:16] if path.exists() else None
        return self.prints[program]

    def note(self, run):
        try:
            return json.loads((self.folder(run) / "run.json").read_text())
        except (OSError, ValueError):
            return None

    def fresh(self, run):
        """There is a result of the same command and the same program."""
        note = self.note(run)
        return bool(note) and note["command"] == self.command(run) and note["binary"] == self.binary(run.program)

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
        outcome.current = self.binary(run.program) in (None, note["binary"])
        return outcome

    def execute(self, run, count):
        if self.stop:
            return
        with self.lock:
            self.done += 1
            say(f"[{self.done}/{count}] {run.name}: about {run.minutes:g} CPU minutes ...")
        folder = self.folder(run)
        begin, command = time.monotonic(), self.words(run) + self.begin(run)
        with open(folder / "run.log", "w", encoding="utf-8") as log:
            code = subprocess.call([*command, "--out", str(folder)], stdout=log, stderr=log)
        seconds = time.monotonic() - begin
        self.finish(run, code, seconds)

    def begin(self, run):
        """Make the folder of a run, or find it with a checkpoint of the same command and program. Returns the options for that."""
        folder = self.folder(run)
        begun = {"command": self.command(run), "binary": self.binary(run.program)}
        try:
            same = json.loads((folder / "begun.json").read_text()) == begun
        except (OSError, ValueError):
            same = False
        if same and (folder / "checkpoint.mps").exists() and not (folder / "run.json").exists():
            say(f"{run.name}: continues from its checkpoint")
            return [*CHECKPOINTS[run.of_mps], "--resume"]
        if folder.exists():
            shutil.rmtree(folder)
        folder.mkdir(parents=True)
        (folder / "begun.json").write_text(json.dumps(begun) + "\n")
        return CHECKPOINTS[run.of_mps] if run.minutes >= LONG else []

    def finish(self, run, code, seconds):
        folder = self.folder(run)
        tail = (folder / "run.log").read_text(errors="replace").strip().splitlines()[-1:]
        if code not in (0, DIVERGED):
            self.stop = self.stop or code in (INTERRUPTED, -2)
            say(f"{run.name}: exit {code}: {' '.join(tail)}")
            if code == USAGE:  # perhaps a checkpoint that does not fit its files: the next time from the beginning
                (folder / "begun.json").unlink(missing_ok=True)
            return
        note = {"command": self.command(run), "binary": self.binary(run.program), "exit": code, "wall_s": round(seconds, 1),
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
