# SPDX-License-Identifier: BSD-3-Clause
"""The public headers for users as modules of Fortran, for fortran/: headers of plug-ins are left out."""
from __future__ import annotations

from pathlib import Path

from interface import CASE, Function, Interface, Member, Struct, Type, layouts

HERE = Path(__file__).resolve().parent / "fortran"
PLUGINS = {"model.h", "stage.h", "voids.h", "reaction.h", "ppe.h", "flux.h", "exact.h", "parallel.h", "ranks.h", "device.h"}
KINDS = {"int": "integer(c_int)", "int32_t": "integer(c_int32_t)", "mps_status": "integer(c_int32_t)", "uint32_t": "integer(c_int32_t)",
         "int64_t": "integer(c_int64_t)", "size_t": "integer(c_size_t)", "double": "real(c_double)", "float": "real(c_float)",
         "uint8_t": "integer(c_int8_t)", "char": "character(kind=c_char)"}


def wrap(text: str, indent: str = "    ") -> list[str]:
    """A statement in lines of at most 130 columns."""
    lines, rest = [], indent + text
    while len(rest) > 128:
        cut = max(rest.rfind(", ", 0, 126), rest.rfind("; ", 0, 126)) + 1
        lines.append(rest[:cut] + " &")
        rest = indent + "    " + rest[cut:].lstrip()
    return lines + [rest]


def member(m: Member, all_: Interface) -> str:
    shape = ", ".join(str(all_.numbers.get(size, size)) for size in reversed(m.shape))
    if m.type.function or m.type.base.endswith("_fn"):
        kind = "type(c_funptr)"
    elif m.type.pointers:
        kind = "type(c_ptr)"
    else:
        kind = KINDS.get(m.type.base, f"type({m.type.base})")
    first = {"type(c_ptr)": " = c_null_ptr", "type(c_funptr)": " = c_null_funptr"}.get(kind, "")
    if not first and not kind.startswith("type(") and "char" not in kind:
        first = " = 0"
    return f"{kind} :: {m.name}" + (f"({shape})" if shape else "") + first


def argument(a: Member, structs: set[str]) -> str:
    t: Type = a.type
    if t.function or t.base.endswith("_fn"):
        return f"type(c_funptr), value :: {a.name}"
    if t.pointers == 0:
        return f"{KINDS[t.base]}, value :: {a.name}"
    if t.pointers == 2:
        return f"type(c_ptr) :: {a.name}"
    if t.base == "void" or (t.base not in KINDS and t.base not in structs):
        return f"type(c_ptr), value :: {a.name}"
    intent = "intent(in), " if t.const else ""
    kind = KINDS.get(t.base, f"type({t.base})")
    many = (t.const or a.name not in ONE) if t.base in KINDS else a.name in MANY
    return f"{kind}, {intent}optional :: {a.name}" + ("(*)" if many else "")


# results that are one number, not an array; structs that are an array
ONE = {"added", "dp", "dim", "t", "steps", "sigma", "id", "count", "n0", "lambda", "value", "major", "minor", "patch"}
MANY = {"harmonics"}


def function(f: Function, structs: set[str]) -> list[str]:
    result = {True: "type(c_ptr)"}.get(f.result.pointers > 0) or KINDS.get(f.result.base, "")
    kind = "subroutine" if f.result.base == "void" and not f.result.pointers else "function"
    head = f"{kind} {f.name}({', '.join(a.name for a in f.arguments)}) bind(C)" + (" result(result_)" if kind == "function" else "")
    body = ["import"] + [argument(a, structs) for a in f.arguments] + ([f"{result} :: result_"] if kind == "function" else [])
    return wrap(head, "        ") + wrap("; ".join(body + [f"end {kind}"]), "            ")


HEAD = ["! SPDX-License-Identifier: BSD-3-Clause", "! From the public headers of libmps, which explain everything; written by bindings/make, do not edit."]


def types(all_: Interface, structs: list[Struct]) -> list[str]:
    out = [*HEAD, "module mps_types", "    use, intrinsic :: iso_c_binding", "    implicit none"]
    taken = {f.name for f in all_.functions} | {s.name for s in structs}
    for name, value in all_.numbers.items():
        if isinstance(value, str) or name.lower() in taken:  # Fortran does not tell MPS_KERNEL_CUSTOM from mps_kernel_custom()
            continue
        kind = "real(c_double)" if isinstance(value, float) else "integer(c_int32_t)"
        out.append(f"    {kind}, parameter :: {name} = {value}" + ("_c_double" if isinstance(value, float) else ""))
    for s in structs:
        out += ["", f"    type, bind(C) :: {s.name}"] + wrap("; ".join(member(m, all_) for m in s.members), "        ") + [f"    end type {s.name}"]
    return out + ["end module mps_types"]


def check(structs: list[Struct]) -> list[str]:
    """Whether the Fortran compiler has the same layout of types as the C compiler."""
    out = ["", "    !> Name of the first type that this compiler lays out in another way than C, or blanks.",
           "    function mps_layout_differs() result(name)", "        character(len=32) :: name"]
    out += [f"        type({s.name}) :: {s.name}_" for s in structs] + ["        name = ' '"]
    for (name, (size, _)) in layouts(structs).items():
        out.append(f"        if (name == ' ' .and. c_sizeof({name}_) /= {size}) name = '{name}'")
    return out + ["    end function mps_layout_differs"]


def module(structs: list[Struct]) -> list[str]:
    out = [*HEAD, "module mps", "    use, intrinsic :: iso_c_binding", "    use mps_types", "    use mps_functions", "    implicit none", "contains",
           "    !> A text of C.", "    function mps_text(text) result(found)", "        type(c_ptr), intent(in) :: text",
           "        character(len=:), allocatable :: found", "        character(kind=c_char), pointer :: c(:)", "        integer :: n",
           "        found = ''", "        if (.not. c_associated(text)) return", "        call c_f_pointer(text, c, [65536])", "        n = 1",
           "        do while (c(n) /= c_null_char)", "            found = found // c(n)", "            n = n + 1", "        end do",
           "    end function mps_text", "",
           "    !> End the program with the library's text where a call failed.", "    subroutine mps_check(sim, status)",
           "        type(c_ptr), intent(in) :: sim", "        integer(c_int32_t), intent(in) :: status", "        if (status >= 0) return",
           "        if (c_associated(sim)) then", "            print '(2a)', 'libmps: ', mps_text(mps_sim_error(sim))", "        else",
           "            print '(2a)', 'libmps: ', mps_text(mps_status_text(status))", "        end if", "        error stop 1",
           "    end subroutine mps_check", "", *CLOSE]
    return out + check(structs) + ["end module mps"]


CLOSE = """\
    !> Destroy a simulation after its frames and a snapshot, and forget them: a later call with them fails with MPS_E_ARG, a second mps_close
    !> does nothing. Not allowed in a callback.
    subroutine mps_close(sim, frames, snapshot)
        type(c_ptr), intent(inout) :: sim
        type(c_ptr), intent(inout), optional :: frames, snapshot
        if (present(frames)) then
            call mps_frames_close(frames)
            frames = c_null_ptr
        end if
        if (present(snapshot)) then
            call mps_snapshot_destroy(snapshot)
            snapshot = c_null_ptr
        end if
        call mps_sim_destroy(sim)
        sim = c_null_ptr
    end subroutine mps_close""".splitlines()


def functions(all_: Interface, structs: list[Struct]) -> list[str]:
    names = {s.name for s in structs}
    out = [*HEAD, "module mps_functions", "    use, intrinsic :: iso_c_binding", "    use mps_types", "    implicit none", "    interface"]
    for f in all_.functions:
        if f.header not in PLUGINS | CASE and not f.variadic:
            out += function(f, names)
    return out + ["    end interface", "end module mps_functions"]


def files(all_: Interface) -> dict[Path, str]:
    """The files and their texts."""
    structs = [s for s in all_.structs if s.header not in (PLUGINS - {"parallel.h"}) | CASE and not s.name.startswith("mps_parallel_")]
    parts = {"mps_types.f90": types(all_, structs), "mps_functions.f90": functions(all_, structs), "mps.f90": module(structs)}
    return {HERE / name: "\n".join(lines) + "\n" for name, lines in parts.items()}
