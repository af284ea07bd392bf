#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Mutated folders of runs: files of a finished run are damaged, exchanged, emptied or replaced by what is no regular file. The program
mps and mps.Run of the Python package read each folder: no crash, no finding of a sanitizer, no hang, and an error names what it is about.
usage: folders.py PROGRAM [--library BUILD] [--seed N] [--count N | --seconds N] [--keep DIR]
--library: build folder whose libraries mps.Run loads; without it or without numpy only the program reads. --keep: folders of findings
go there. A seed gives the same mutations for the same build."""
from __future__ import annotations

import argparse
import collections
import os
import random
import re
import resource
import select
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

LIMIT = 60  # seconds of one reader
MEMORY = 6 << 30  # address space; a sanitizer needs more
CASE = """mps: 1
dp: 50 mm
tank: {size: 0.6 0.4 m}
fill: [{water: {depth: 0.2 m}}]
motion: {surge: {amplitude: 5 mm, period: 1 s}}
sensors: {P: {wall: 0 0.1 m}, eta: {gauge: 0.3 m}}
reference: {P: {times: 0.01 0.02 s, values: 1 1.1 kPa}}
collect: [P.max]
impacts: {threshold: 1 Pa}
run: {until: 0.04 s}
output: {frames: 2, page: 0.5 MB, pictures: 0.01 s}
"""
# {run}: the mutated folder; {file}: a mutated file; {other}: a folder that is as the run left it
VERBS = (["info", "{file}"], ["compare", "{run}", "{other}"], ["compare", "{other}", "{run}"], ["compare", "{run}"], ["stats", "{run}"],
         ["collect", "{run}", "-o", "{run}/../table.csv"], ["report", "{run}"],
         ["resume", "{run}", "-q", "-j1", "--set", "run.until=0.042 s", "--set", "output.page=0 MB"])
SELDOM = (".png", ".py")  # the readers do not parse them
NUMBERS = (b"nan", b"inf", b"-1", b"0", b"1e308", b"-1e-320", b"99999999999999999999", b"2147483648", b'"x"', b"null", b"[]", b"{}", b"")


def bytes_(r: random.Random, data: bytes) -> bytes:
    out = bytearray(data)
    for _ in range(r.randint(1, 8)):
        if out:
            out[r.randrange(len(out))] = r.choice((0, 10, 34, 44, 60, 91, 123, 255, r.randrange(256)))
    return bytes(out)


def number(r: random.Random, data: bytes) -> bytes:
    found = list(re.finditer(rb"-?\d[\d.e+-]*", data[:1 << 20]))
    if not found:
        return bytes_(r, data)
    one = r.choice(found)
    return data[:one.start()] + r.choice(NUMBERS) + data[one.end():]


def piece(r: random.Random, data: bytes) -> bytes:
    """A piece is removed, doubled or moved."""
    a, b = sorted(r.randrange(len(data) + 1) for _ in range(2))
    to = r.randrange(len(data) + 1)
    return r.choice((data[:a] + data[b:], data[:b] + data[a:], data[:to] + data[a:b] + data[to:]))


def line(r: random.Random, data: bytes) -> bytes:
    lines = data.split(b"\n")
    k = r.randrange(len(lines))
    other = lines[r.randrange(len(lines))]
    return b"\n".join(r.choice((lines[:k] + lines[k + 1:], [*lines[:k], other, *lines[k:]], [*lines[:k], b"x" * 100000])))


CONTENT = {"bytes": bytes_, "number": number, "piece": piece, "line": line, "cut": lambda r, d: d[:r.randrange(len(d) + 1)],
           "noise": lambda r, d: r.randbytes(r.randrange(5000)), "empty": lambda r, d: b"",
           "more": lambda r, d: d + r.randbytes(r.randrange(300))}


def huge(r: random.Random, path: Path, files: list[Path]) -> None:
    os.truncate(path, 1 << r.choice((25, 33, 40)))  # without blocks on the disk


def swap(r: random.Random, path: Path, files: list[Path]) -> None:
    shutil.copy(r.choice(files), path.with_suffix(".swap"))
    path.with_suffix(".swap").replace(path)


def gone(r: random.Random, path: Path, files: list[Path]) -> None:
    path.unlink()


def pipe(r: random.Random, path: Path, files: list[Path]) -> None:
    path.unlink()
    os.mkfifo(path)


def folder(r: random.Random, path: Path, files: list[Path]) -> None:
    path.unlink()
    path.mkdir()


def link(r: random.Random, path: Path, files: list[Path]) -> None:
    path.unlink()
    path.symlink_to(r.choice(("/dev/zero", "/etc/passwd", path.name, "nothing", ".")))


WHOLE = {f.__name__: f for f in (huge, swap, gone, pipe, folder, link)}


def mutate(r: random.Random, run: Path) -> tuple[str, Path]:
    """Mutate one to three files. @return the first kind, a mutated file"""
    files = sorted(p for p in run.rglob("*") if p.is_file() and not p.is_symlink())
    groups: dict[str, list[Path]] = {}  # as often a checkpoint as one of many frames
    for path in files:
        groups.setdefault("seldom" if path.suffix in SELDOM else path.suffix, []).append(path)
    names = [one for name, group in groups.items() for one in [group] * (1 if name == "seldom" else 3)]
    chosen = list(dict.fromkeys(r.choice(r.choice(names)) for _ in range(r.choice((1, 1, 1, 2, 3)))))
    kinds = [r.choice([*CONTENT, *CONTENT, *WHOLE]) for _ in chosen]
    for path, kind in zip(chosen, kinds):
        others = [p for p in files if p not in chosen]
        if kind in CONTENT:
            path.write_bytes(CONTENT[kind](r, path.read_bytes()))
        else:
            WHOLE[kind](r, path, others)
    return kinds[0], chosen[0]


# ---- readers

class Reader:
    """A process that reads folders by mps.Run, with one answer for each: "" or what is wrong."""

    def __init__(self, build: Path) -> None:
        self.build, self.process = build, None

    def start(self) -> None:
        env = os.environ | {"PYTHONPATH": str(Path(__file__).parents[2] / "bindings/python"), "MPS_LIBRARY_PATH": str(self.build.resolve()),
                            "PYTHONDONTWRITEBYTECODE": "1"}
        runtime = os.environ.get("SANITIZER_RUNTIME")
        if runtime:
            env |= {"LD_PRELOAD": runtime, "ASAN_OPTIONS": "detect_leaks=0"}
        self.process = subprocess.Popen([sys.executable, __file__, "--reader"], env=env, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, text=True)

    def read(self, run: Path) -> str:
        if self.process is None:
            self.start()
        assert self.process and self.process.stdin and self.process.stdout and self.process.stderr
        self.process.stdin.write(f"{run}\n")
        self.process.stdin.flush()
        ready, _, _ = select.select([self.process.stdout], [], [], LIMIT)
        answer = self.process.stdout.readline() if ready else ""
        if answer:
            return answer[:-1]
        why = "hangs" if not ready else "dies"
        self.process.kill()
        _, log = self.process.communicate()
        self.process = None
        return f"mps.Run {why}: {log[-3000:]}"

    def end(self) -> None:
        if self.process:
            self.process.communicate()


def uses(run: Path) -> list[object]:
    """What a user of mps.Run does with a folder, as functions."""
    import mps
    import numpy as np

    def frames() -> None:
        series = mps.Run(run).frames
        for frame in series:
            for name in frame:
                assert frame[name].shape[0] == frame.n
            assert frame.part_names is not None and isinstance(frame.t, float) and repr(frame)
        np.asarray(series.t)

    def tables() -> None:
        one = mps.Run(run)
        for table in (one.columns, one.momentum, one.steps):
            assert len({len(v) for v in dict(table).values()}) < 2 and repr(table) and table.units.keys() == set(table)

    return [frames, tables, lambda: repr(mps.Run(run)), lambda: mps.Run(run).status, lambda: mps.Run(run).summary,
            lambda: mps.Run(run).about, lambda: mps.Run(run).inputs, lambda: mps.Run(run).messages, lambda: mps.Run(run).case.text,
            lambda: mps.Run(run).impacts("P"),
            lambda: mps.Run(run).columns["P"], lambda: mps.Sweep(run.parent).parameters]


def reader() -> int:
    import warnings

    import mps
    warnings.simplefilter("ignore")
    for name in sys.stdin:
        run, wrong = Path(name.strip()), ""
        for k, use in enumerate(uses(run)):
            try:
                use()  # type: ignore[operator]
            except mps.Error as e:
                if run.name not in str(e):
                    wrong += f"mps.Run, use {k}: the error does not name the folder: {e}; "
            except BaseException as e:
                wrong += f"mps.Run, use {k}: {type(e).__name__}: {e}; "
        print(" ".join(wrong.split()), flush=True)
    return 0


def verb(program: Path, words: list[str], run: Path, asan: bool) -> str:
    """"" or what is wrong."""
    def limits() -> None:
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        if not asan:
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))

    env = os.environ | {"ASAN_OPTIONS": "exitcode=99:allocator_may_return_null=1", "UBSAN_OPTIONS": "print_stacktrace=1", "LC_ALL": "C"}
    call = f"mps {' '.join(words)}"
    try:
        done = subprocess.run([program, *words], capture_output=True, timeout=LIMIT, env=env, preexec_fn=limits, cwd=run.parent)
    except subprocess.TimeoutExpired:
        return f"{call}: hangs"
    log = done.stderr.decode("utf-8", "replace")
    if done.returncode not in range(10) or "runtime error:" in log or "Sanitizer" in log:
        return f"{call}: exit {done.returncode}: {log[-6000:]}"
    if done.returncode and run.name not in log and "001" not in log:
        return f"{call}: the error does not name the folder or a file: {log[-500:]}"
    return ""


# ---- the campaign

def finished(program: Path, place: Path, asan: bool) -> tuple[Path, Path]:
    """Two finished runs."""
    (place / "case.yaml").write_text(CASE)
    for name in ("good", "other"):
        wrong = verb(program, ["run", "case.yaml", "-q", "-j1", "-o", name], place / name, asan)
        if wrong or not (place / name / "summary.json").exists():
            sys.exit(f"the run failed: {wrong}")
    return place / "good", place / "other"


def attack(o: argparse.Namespace, seed: int, good: Path, other: Path, run: Path, reads: Reader | None) -> tuple[str, list[str]]:
    """One mutated folder, by all readers. @return kind, findings"""
    r = random.Random(seed)
    shutil.rmtree(run.parent, ignore_errors=True)
    shutil.copytree(good, run)
    kind, file = mutate(r, run)
    if o.keep:
        shutil.rmtree(o.keep / "last", ignore_errors=True)
        subprocess.run(["cp", "-a", "--sparse=always", run, o.keep / "last"], check=False)
    names = {"run": run, "file": file, "other": other}
    wrong = [verb(o.program, [w.format(**names) for w in words], run, o.asan) for words in VERBS[:-1]]
    wrong += [reads.read(run)] if reads else []
    wrong.append(verb(o.program, [w.format(**names) for w in VERBS[-1]], run, o.asan))
    wrong = [w for w in wrong if w]
    if o.keep and wrong:
        (o.keep / "last").rename(o.keep / str(seed))
    return f"{kind} {file.suffix}", wrong


def numpy() -> bool:
    return subprocess.run([sys.executable, "-c", "import numpy"], capture_output=True, check=False).returncode == 0


def main() -> int:
    p = argparse.ArgumentParser(description="Mutated folders of runs.")
    p.add_argument("program", type=Path)
    p.add_argument("--library", type=Path, metavar="BUILD")
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--count", type=int, default=20)
    p.add_argument("--seconds", type=float)
    p.add_argument("--keep", type=Path, metavar="DIR")
    o = p.parse_args()
    o.program = o.program.resolve()
    o.asan = b"__asan_init" in o.program.read_bytes()
    reads = Reader(o.library) if o.library and numpy() else None
    if o.keep:
        o.keep.mkdir(parents=True, exist_ok=True)
    count, failed, kinds, begin = 0, 0, collections.Counter[str](), time.monotonic()
    with tempfile.TemporaryDirectory() as place:
        good, other = finished(o.program, Path(place), o.asan)
        while count < o.count if o.seconds is None else time.monotonic() - begin < o.seconds:
            kind, wrong = attack(o, o.seed + count, good, other, Path(place) / "set" / "001", reads)
            for one in wrong:
                print(f"FAILED: seed {o.seed + count}, {kind}: {one}", flush=True)
            count, failed = count + 1, failed + bool(wrong)
            kinds[kind] += 1
        if reads:
            reads.end()
    readers = f"{len(VERBS)} commands" + (" and mps.Run" if reads else "")
    print(f"{count} mutated folders, each read by {readers}, {failed} with findings: " +
          ", ".join(f"{kind} {n}" for kind, n in sorted(kinds.items())))
    return failed > 0


if __name__ == "__main__":
    sys.exit(reader() if sys.argv[1:] == ["--reader"] else main())
