# SPDX-License-Identifier: BSD-3-Clause
"""Read the public headers: structs, functions, callbacks, numbers. What is made from it: ctypes of Python, the module of
Fortran, the test of layouts. The headers have one form (scripts/layers, scripts/format), which this reader relies on: it
fails with the text that it does not understand."""
from __future__ import annotations

import re
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

INCLUDE = Path(__file__).resolve().parent.parent / "include"
CASE = {"case.h", "job.h", "page.h", "picture.h", "plugin.h", "series.h", "stats.h"}  # functions of libmps_case
NO_INTERFACE = {"numbers.h"}  # functions for the loops of models in C: other languages have their own


@dataclass
class Type:
    """A type of C: `const double *const *` has base double, 2 pointers, const."""

    base: str
    pointers: int = 0
    const: bool = False
    function: Callback | None = None


@dataclass
class Member:
    name: str
    type: Type
    shape: list[str] = field(default_factory=list)


@dataclass
class Struct:
    name: str
    header: str
    members: list[Member]
    help: str


@dataclass
class Callback:
    name: str
    result: Type
    arguments: list[Member]


@dataclass
class Function(Callback):
    header: str = ""
    help: str = ""
    variadic: bool = False


@dataclass
class Interface:
    numbers: dict[str, float | int | str] = field(default_factory=dict)
    statuses: dict[str, tuple[int, str]] = field(default_factory=dict)
    opaque: list[str] = field(default_factory=list)
    structs: list[Struct] = field(default_factory=list)
    callbacks: list[Callback] = field(default_factory=list)
    functions: list[Function] = field(default_factory=list)


def _headers() -> list[Path]:
    """All headers, each after the headers that it includes."""
    found: list[Path] = []

    def visit(path: Path) -> None:
        for name in re.findall(r"^#include <mps/(\w+\.h)>", path.read_text(), re.M):
            visit(INCLUDE / "mps" / name)
        if path not in found:
            found.append(path)

    for path in sorted((INCLUDE / "mps").glob("*.h")):
        visit(path)
    return found


def _declarator(text: str) -> tuple[str, str, list[str]]:
    """Type, name and shape of `const double x[3]`; the name is empty in `void`."""
    text = text.strip()
    shape = re.findall(r"\[([^\]]*)\]", text)
    text = re.sub(r"\[[^\]]*\]", "", text).strip()
    m = re.fullmatch(r"(.*?[\s*])(\w+)", text, re.S)
    return (m[1].strip(), m[2], shape) if m else (text, "", shape)


def _type(text: str) -> Type:
    words = text.replace("*", " * ").split()
    base = [w for w in words if w not in ("const", "*", "struct")]
    if len(base) != 1:
        raise ValueError(f"not a type: '{text}'")
    return Type(base[0], words.count("*"), "const" in words[: words.index(base[0]) + 2])


def _arguments(text: str) -> list[Member]:
    found = []
    for part in _split(text, ","):
        if part.strip() in ("void", "..."):
            continue
        kind, name, shape = _declarator(part)
        t = _type(kind)
        t.pointers += 1 if shape else 0
        found.append(Member(name, t))
    return found


def _split(text: str, separator: str) -> list[str]:
    """Split a text at separators outside brackets."""
    parts, depth, begin = [], 0, 0
    for k, c in enumerate(text):
        depth += (c in "({[") - (c in ")}]")
        if c == separator and depth == 0:
            parts.append(text[begin:k])
            begin = k + 1
    return [p for p in parts + [text[begin:]] if p.strip()]


def _members(body: str) -> list[Member]:
    found = []
    for part in _split(body, ";"):
        pointer = re.fullmatch(r"\s*(.*?)\(\*(\w+)\)\s*\((.*)\)\s*", part, re.S)
        if pointer:
            call = Callback("", _type(pointer[1]), _arguments(pointer[3]))
            found.append(Member(pointer[2], Type("function", 1, function=call)))
            continue
        first, *more = _split(part, ",")
        kind, name, shape = _declarator(first)
        found.append(Member(name, _type(kind), shape))
        found += [Member(n, _type(kind), s) for _, n, s in map(_declarator, more)]
    return found


def _number(text: str, known: dict[str, float | int | str]) -> float | int | str:
    text = text.strip()
    if text.startswith('"'):
        return text.strip('"')
    if text in known:
        return known[text]
    text = re.sub(r"(?<=\d)u$", "", text.strip("()"))
    return int(text, 0) if re.fullmatch(r"-?(0x)?[0-9a-fA-F]+", text) else float(text)


def _enum(body: str, all_: Interface) -> None:
    last = -1
    for part in _split(body, ","):
        name, _, value = part.partition("=")
        last = int(_number(value, all_.numbers)) if value else last + 1
        all_.numbers[name.strip()] = last


def _statement(text: str, header: str, help_: str, all_: Interface) -> None:
    text = text.strip()
    opaque = re.fullmatch(r"typedef struct (\w+) \1", text)
    struct = re.fullmatch(r"typedef struct (\w+) \{(.*)\} \1", text, re.S)
    call = re.fullmatch(r"typedef (.*?)\(\*(\w+)\)\((.*)\)", text, re.S)
    enum = re.fullmatch(r"enum \{(.*)\}", text, re.S)
    function = re.fullmatch(r"MPS_API (.*?[\s*])(\w+)\((.*)\)", text, re.S)
    if opaque:
        all_.opaque.append(opaque[1])
    elif struct:
        all_.structs.append(Struct(struct[1], header, _members(struct[2]), help_))
    elif call:
        all_.callbacks.append(Callback(call[2], _type(call[1]), _arguments(call[3])))
    elif enum and "MPS_STATUS_LIST" not in text:
        _enum(enum[1], all_)
    elif function:
        all_.functions.append(Function(function[2], _type(function[1]), _arguments(function[3]), header, help_,
                                       function[3].rstrip().endswith("...")))
    elif text.startswith("MPS_PLUGIN_EXPORT "):
        pass  # of a plug-in, not of the library
    elif text != "typedef int32_t mps_status" and not enum:
        raise ValueError(f"{header}: not understood: {text[:80]}")


def _plain(text: str) -> str:
    """A comment without its stars."""
    lines = [re.sub(r"^\s*\*? ?", "", line) for line in text.removeprefix("/**").removesuffix("*/").splitlines()]
    return "\n".join(line.rstrip() for line in lines).strip()


def _without_inline(text: str) -> str:
    """Remove the bodies of inline functions."""
    while (m := re.search(r"^static inline\b[^;{]*\{", text, re.M)) is not None:
        depth, k = 1, m.end()
        while depth:
            depth += (text[k] == "{") - (text[k] == "}")
            k += 1
        text = text[: m.start()] + text[k:]
    return text


def _read_header(path: Path, all_: Interface) -> None:
    text = path.read_text()
    for name, value, meaning in re.findall(r'X\((MPS_\w+), (-?\d+), "(.*?)"\)', text):
        all_.statuses[name] = (int(value), meaning)
        all_.numbers[name] = int(value)
    text = re.sub(r"^#define (MPS_\w+) (\(?-?[\d.]+u?\)?|\"[^\"]*\")\s*$",
                  lambda m: all_.numbers.__setitem__(m[1], _number(m[2], all_.numbers)) or "", text, flags=re.M)
    comments: list[str] = []

    def keep(m: re.Match[str]) -> str:
        if not m[0].startswith("/**") or m[0].startswith("/**<"):
            return ""
        comments.append(_plain(m[0]))
        return f"@{len(comments) - 1}@ "

    text = re.sub(r"/\*.*?\*/|//[^\n]*", keep, text, flags=re.S)
    text = re.sub(r"^#(?:[^\n]*\\\n)*[^\n]*$", "", text, flags=re.M)
    text = re.sub(r"\b(MPS_BEGIN_DECLS|MPS_END_DECLS)\b", "", text)
    for part in _split(_without_inline(text), ";"):
        marks = re.findall(r"@(\d+)@", re.split(r"\{|\bMPS_API\b|\btypedef\b", part)[0])
        clean = re.sub(r"@\d+@", "", part).strip()
        if clean:
            _statement(clean, path.name, comments[int(marks[-1])] if marks else "", all_)


def read() -> Interface:
    """The interface as declared in the headers."""
    all_ = Interface()
    for path in _headers():
        if path.name not in NO_INTERFACE:
            _read_header(path, all_)
    return all_


def layouts(structs: list[Struct], compiler: str = "cc") -> dict[str, tuple[int, dict[str, int]]]:
    """Size of each struct and offsets of its members, from the compiler."""
    lines = [f"#include <mps/{h}>" for h in sorted({s.header for s in structs})] + ["#include <stddef.h>", "#include <stdio.h>",
                                                                                "int main(void) {"]
    for s in structs:
        lines.append(f'printf("%zu", sizeof({s.name}));')
        lines += [f'printf(" %zu", offsetof({s.name}, {m.name}));' for m in s.members]
        lines.append('puts("");')
    with tempfile.TemporaryDirectory() as folder:
        source, program = Path(folder) / "a.c", Path(folder) / "a"
        source.write_text("\n".join(lines + ["return 0; }"]))
        subprocess.run([compiler, f"-I{INCLUDE}", source, "-o", program], check=True)
        out = subprocess.run([program], check=True, capture_output=True, text=True).stdout.splitlines()
    numbers = [[int(word) for word in line.split()] for line in out]
    return {s.name: (n[0], {m.name: k for m, k in zip(s.members, n[1:])}) for s, n in zip(structs, numbers)}
