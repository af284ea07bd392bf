# SPDX-License-Identifier: BSD-3-Clause
"""The public headers as ctypes, for python/mps."""
from __future__ import annotations

from pathlib import Path

from interface import CASE, Callback, Interface, Member, Type, layouts

HERE = Path(__file__).resolve().parent
PACKAGE = HERE / "python/mps"
SCALARS = {"int": "c_int", "int32_t": "c_int32", "mps_status": "c_int32", "uint32_t": "c_uint32", "int64_t": "c_int64",
           "uint64_t": "c_uint64", "size_t": "c_size_t", "double": "c_double", "float": "c_float", "uint8_t": "c_uint8",
           "char": "c_char"}


def ctype(t: Type, callbacks: set[str]) -> str:
    if t.function:
        return prototype(t.function, callbacks)
    pointers = t.pointers
    if t.base == "void":
        inner, pointers = ("None", 0) if pointers == 0 else ("c_void_p", pointers - 1)
    elif t.base == "char" and pointers and t.const:
        inner, pointers = "c_char_p", pointers - 1
    else:
        inner = SCALARS.get(t.base, t.base)
    for _ in range(pointers):
        inner = f"POINTER({inner})"
    return inner


def prototype(c: Callback, callbacks: set[str]) -> str:
    result = ctype(c.result, callbacks)
    if result.startswith("c_char_p"):
        result = "c_void_p"  # ctypes cannot return texts from callbacks
    return f"CFUNCTYPE({', '.join([result] + [ctype(a.type, callbacks) for a in c.arguments])})"


def shape(m: Member, all_: Interface) -> str:
    text = ""
    for size in reversed(m.shape):
        text += f" * {int(all_.numbers.get(size, 0)) or int(size)}"
    return text


def packed(words: list[str], begin: str = "    ", width: int = 132) -> list[str]:
    """Words, each followed by a comma, in lines."""
    lines = [begin]
    for word in words:
        if len(lines[-1]) + len(word) + 2 > width and lines[-1].strip():
            lines.append(begin)
        lines[-1] += word + ", "
    return [line.rstrip() for line in lines]


HEAD = ["# SPDX-License-Identifier: BSD-3-Clause", '"""{}, from the public headers of libmps. Written by bindings/make; do not edit."""',
        "from __future__ import annotations", ""]


def head(what: str) -> list[str]:
    return [line.format(what) for line in HEAD]


def numbers(all_: Interface) -> list[str]:
    out = head("Numbers") + [f"{name} = {value!r}" for name, value in all_.numbers.items()]
    out += ["", "# name: number, meaning", "STATUSES = {"]
    return out + [f'    "{name}": ({value}, {meaning!r}),' for name, (value, meaning) in all_.statuses.items()] + ["}"]


CTYPES = ["from ctypes import (CFUNCTYPE, POINTER, Structure, c_char, c_char_p, c_double, c_float, c_int, c_int32, c_int64,",
          "                    c_size_t, c_uint8, c_uint32, c_uint64, c_void_p)", ""]


def types(all_: Interface, names: set[str]) -> list[str]:
    """Structs without members, because these may point to other structs, and callbacks."""
    out = head("Names of structs, callbacks") + CTYPES + [""]
    for name in all_.opaque + [s.name for s in all_.structs]:
        out += [f"class {name}(Structure): ..."]
    return out + [""] + [f"{c.name} = {prototype(c, names)}" for c in all_.callbacks]


def structs(all_: Interface, names: set[str]) -> list[str]:
    out = head("Members of structs") + CTYPES + ["from ._types import *  # noqa: F403", ""]
    for s in all_.structs:
        out += [f"{s.name}._fields_ = ["] + packed([f'("{m.name}", {ctype(m.type, names)}{shape(m, all_)})' for m in s.members]) + ["]"]
    return out


def layout(all_: Interface) -> list[str]:
    out = head("Layouts") + ["# name: bytes, offsets of the members, as the compiler of C has them", "LAYOUTS = {"]
    for name, (size, offsets) in layouts(all_.structs).items():
        out.append(f'    "{name}": ({size}, {list(offsets.values())}),')
    return out + ["}"]


def functions(all_: Interface, names: set[str]) -> list[str]:
    out = head("Functions") + ["from ctypes import POINTER, c_char, c_char_p, c_double, c_int, c_int32, c_int64, c_size_t, c_uint8, c_void_p", "",
                               "from ._structs import *  # noqa: F403", "", "# name: library, result, arguments", "FUNCTIONS = {"]
    for f in all_.functions:
        arguments = ", ".join(ctype(a.type, names) for a in f.arguments)
        out.append(f'    "{f.name}": ("{"mps_case" if f.header in CASE else "mps"}", {ctype(f.result, names)}, [{arguments}]),')
    return out + ["}"]


def files(all_: Interface) -> dict[Path, str]:
    """The files and their texts."""
    names = {c.name for c in all_.callbacks}
    parts = {"_numbers.py": numbers(all_), "_types.py": types(all_, names), "_structs.py": structs(all_, names),
             "_layouts.py": layout(all_), "_functions.py": functions(all_, names)}
    return {PACKAGE / name: "\n".join(lines) + "\n" for name, lines in parts.items()}
