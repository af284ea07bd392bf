#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Rename private words in identifiers, files and folders: rename_table.py says what becomes what.

usage: scripts/rename/rename.py [TREE]

Running it again changes nothing. Deleted before the release.
"""
import fnmatch
import functools
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import rename_table as table

TREE = Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
C_FILE = re.compile(r"\.(c|h|hpp|cpp|inc)$")
TEXT_FILE = re.compile(r"\.(c|h|hpp|cpp|inc|py|md|txt|cmake|sh|in|map|f90|yaml|js|mjs|known|supp|toml|css|svg|json)$|(^|/)[^./]+$")
WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
PIECE = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'', re.S)
KERNEL = re.compile(r"^(mpsk_)?([a-z0-9_]+?)__([a-z0-9_]+?)(_[23])?$")
FILE_NAME = re.compile(r"([a-z_]+\\\.[ch])\(\?!\\w\)$")  # at the end of a pattern of table.PATHS
LOOP = re.compile(r'"(\w+)\.c"(,\s*)"(\w+)"')
problems: list[str] = []


def git(*words: str) -> str:
    return subprocess.run(["git", *words], cwd=TREE, check=True, capture_output=True, text=True).stdout


def left_alone(path: str) -> bool:
    return any(fnmatch.fnmatch(path, p) for p in table.LEFT_ALONE)


def move_files() -> None:
    for old, new in table.moves(git("ls-files").splitlines()):
        if (TREE / old).exists() and not (TREE / new).exists():
            (TREE / new).parent.mkdir(parents=True, exist_ok=True)
            git("mv", old, new)


PATTERNS = [(re.compile(p), r) for p, r in table.PATTERNS]


@functools.cache
def global_name(word: str) -> str:
    if word in table.NAMES:
        return table.NAMES[word]
    if word[:3].lower() == "mps":
        for pattern, new in PATTERNS:
            found = pattern.match(word)
            if found:
                return found.expand(new)
    return word


LOCAL = [(files.split(), names, [(re.compile(p), r) for p, r in patterns]) for files, names, patterns in table.LOCAL]
cache: dict[str, list] = {}


def rules_of(path: str) -> list:
    if path not in cache:
        cache[path] = [(n, p) for files, n, p in LOCAL if any(fnmatch.fnmatch(path, f) for f in files)]
    return cache[path]


@functools.cache
def local_name(path: str, word: str) -> str:
    for names, patterns in rules_of(path):
        if word in names:
            return names[word]
        for pattern, new in patterns:
            found = pattern.match(word)
            if found:
                return found.expand(new)
    return word


def kernel_name(word: str, units: dict[str, tuple[str, str]]) -> str:
    """unit__loop, as kernels of devices and their tests have it."""
    m = KERNEL.match(word)
    if not m or m.group(2) not in units:
        return word
    stem, path = units[m.group(2)]
    return f"{m.group(1) or ''}{stem}__{local_name(path, m.group(3))}{m.group(4) or ''}"


def rename_code(path: str, text: str) -> str:
    """Names of the tokens outside of comments and strings; in comments those with an underscore, or in back quotes."""
    parts, at = [], 0

    def code(piece: str) -> str:
        return WORD.sub(lambda m: local_name(path, m.group()), piece)

    for m in PIECE.finditer(text):
        parts.append(code(text[at:m.start()]))
        piece = m.group()
        if piece[0] == "/":
            piece = WORD.sub(lambda w: local_name(path, w.group()) if "_" in w.group() else w.group(), piece)
            piece = re.sub(r"`[^`\n]+`", lambda w: code(w.group()), piece)
        parts.append(piece)
        at = m.end()
    parts.append(code(text[at:]))
    return "".join(parts)


def code_words(text: str) -> set[str]:
    return set(WORD.findall(PIECE.sub(" ", text)))


def edited(path: str, text: str, edits: list[tuple[str, str, str]]) -> str:
    for files, pattern, replacement in edits:
        if any(fnmatch.fnmatch(path, f) for f in files.split()):
            text = re.sub(pattern, replacement, text, flags=re.M)
    return text


def edit(path: str, text: str, units: dict[str, tuple[str, str]]) -> str:
    before = code_words(text) if C_FILE.search(path) else set()
    new = text
    for old, sentence in table.TEXTS:
        new = new.replace(old, sentence)
    for pattern, replacement, files in table.PATHS:
        name = FILE_NAME.search(pattern)
        if name and name.group(1).replace("\\.", ".") not in new:
            continue  # most files name none of them
        if not files or any(fnmatch.fnmatch(path, f) for f in files):
            new = re.sub(pattern, replacement, new)

    def word(m: re.Match) -> str:
        name = global_name(m.group())
        return kernel_name(name, units) if name == m.group() and "__" in name else name

    def loop(m: re.Match) -> str:
        unit = units.get(m.group(1))
        return m.group(0)[:m.start(3) - m.start(0)] + local_name(unit[1], m.group(3)) + '"' if unit else m.group(0)

    new = edited(path, WORD.sub(word, new), table.EARLY)
    if path.startswith("tests/"):
        new = LOOP.sub(loop, new)
    if C_FILE.search(path):
        new = rename_code(path, new)
    new = edited(path, new, table.EDITS)
    if fnmatch.fnmatch(path, "tests/abi/symbols*.txt"):
        new = "".join(sorted(new.splitlines(keepends=True)))
    if before and new != text:
        for w in sorted(before):
            target = global_name(w)
            if target == w:
                target = local_name(path, w)
            if target != w and target in before and (path, target) not in table.MERGED and target not in table.MERGED_NAMES:
                problems.append(f"{path}: {w} -> {target}, which the file has already")
    return new


def main() -> int:
    old_stems = {Path(o).stem: Path(n).stem for o, n in table.moves(table.MOVED_UNITS)}
    move_files()
    files = [f for f in git("ls-files").splitlines() if TEXT_FILE.search(f) and not left_alone(f) and (TREE / f).is_file()]
    units = {}
    for f in files:
        if f.startswith("src/") and f.endswith(".c"):
            units[Path(f).stem] = (Path(f).stem, f)
    for old, new in old_stems.items():
        if new in units:
            units[old] = units[new]
    changed = 0
    for f in files:
        try:
            text = (TREE / f).read_text()
        except UnicodeDecodeError:
            continue
        new = edit(f, text, units)
        if new != text:
            (TREE / f).write_text(new)
            changed += 1
    for f, text in table.REQUIRED:
        if text not in (TREE / f).read_text():
            problems.append(f"{f}: has not {text!r}: an edit of rename_table.py found other text")
    print("\n".join(problems + [f"{changed} files changed"]))
    print("then: scripts/format; python3 bindings/make; tests/abi/make_layout; commit; tests/abi/freeze HEAD --replace; commit")
    return 0


sys.exit(main())
