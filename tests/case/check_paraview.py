#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Run the paraview.py of a run with a stand-in for ParaView that keeps what is asked of it, and compare this with the frames and
with summary.json.
usage: check_paraview.py FOLDER_OF_A_RUN [SHIFT_X SHIFT_Y of the tank in all frames, m]"""
import json
import re
import runpy
import sys
import types
from pathlib import Path
from typing import Any


class Proxy:
    """An object of ParaView: a name, and the properties that are set."""

    def __init__(self, kind: str, **properties: Any) -> None:
        self.__dict__.update(properties, kind=kind)

    def UpdateAnimationUsingDataTimeSteps(self) -> None:
        self.timed = True

    def GoToLast(self) -> None:
        self.at_last = True

    def SetRepresentationType(self, name: str) -> None:
        self.representation = name


made: list[Proxy] = []


def keep(kind: str, **properties: Any) -> Proxy:
    made.append(Proxy(kind, **properties))
    return made[-1]


def of(kind: str) -> list[Proxy]:
    return [one for one in made if one.kind == kind]


def color_by(shown: Proxy, array: tuple[str, str], separate: bool = False) -> None:
    shown.array, shown.separate = array, separate


def stand_in() -> None:
    """The modules that the script imports, with the functions that it calls and no other."""
    simple = types.ModuleType("paraview.simple")
    view, scene = keep("view"), keep("scene")
    functions = {
        "PVDReader": lambda **p: keep("reader", **p),
        "GetAnimationScene": lambda: scene,
        "GetActiveViewOrCreate": lambda kind: view,
        "Threshold": lambda **p: keep("threshold", **p),
        "Show": lambda source, view: keep("shown", source=source),
        "ColorBy": color_by,
        "GetColorTransferFunction": lambda array, shown, separate=False: keep("table", array=array, shown=shown),
        "GetScalarBar": lambda table, view: keep("bar", table=table),
        "AnnotateTimeFilter": lambda **p: keep("clock", **p),
        "Hide": lambda source, view: keep("hidden", source=source),
        "Render": lambda: keep("rendered"),
        "_DisableFirstRenderCameraReset": lambda: None,
    }
    vars(simple).update(functions, __all__=[name for name in functions if name[0] != "_"])
    package = types.ModuleType("paraview")
    package.simple = simple
    sys.modules.update({"paraview": package, "paraview.simple": simple})


def check(what: str, right: bool, *values: Any) -> None:
    if not right:
        sys.exit(f"{what}: {values}")


def arrays_of(frame: Path) -> set[str]:
    head = frame.read_bytes().split(b"<AppendedData")[0].decode()
    counts = set(re.findall(r'NumberOf(?:Points|Verts)="(\d+)"', head))
    check("a vertex for each point, which Threshold needs", len(counts) == 1, counts)
    return set(re.findall(r'<DataArray [^>]*Name="(\w+)"', head.split("<PointData>")[1].split("</PointData>")[0]))


def main() -> None:
    folder = Path(sys.argv[1]).resolve()
    summary = json.loads((folder / "summary.json").read_text())
    series = re.findall(r'timestep="([^"]*)".*?file="([^"]*)"', (folder / "frames.pvd").read_text())
    stand_in()
    runpy.run_path(str(folder / "paraview.py"))
    check("frames", Path(of("reader")[0].FileName).samefile(folder / "frames.pvd"), of("reader")[0].FileName)
    check("times", of("scene")[0].timed and of("scene")[0].at_last and float(series[-1][0]) > 0, series)
    arrays = arrays_of(folder / series[-1][1])
    used = [one.Scalars[1] for one in of("threshold")] + [one.array for one in of("table")]
    check("arrays", set(used) == {"kind", "phase", "pressure"} and set(used) <= arrays, used, arrays)
    kinds = [(one.Scalars[1], (one.LowerThreshold + one.UpperThreshold) / 2, one.UpperThreshold - one.LowerThreshold)
             for one in of("threshold")]
    phases = len(summary["phases"])
    check("particles", kinds == [("kind", 1, 1), ("kind", 0, 1)] + [("phase", k, 1) for k in range(phases)], kinds)
    spheres = [one for one in of("shown") if getattr(one, "representation", "") == "Point Gaussian"]
    check("spheres", len(spheres) == 1 + phases, len(spheres))
    for one in spheres[1:]:
        check("diameter dp", abs(2 * one.GaussianRadius / summary["dp"] - 1) < 1e-6, one.GaussianRadius)
        check("colour", one.array == ("POINTS", "pressure") and one.separate, one.array)
    for one in of("table"):
        lo, hi = one.RGBPoints[0], one.RGBPoints[-4]
        wanted = summary["pressure_scale"]
        check("colour scale", abs(lo - wanted[0]) + abs(hi - wanted[1]) < 1e-6 * hi, lo, hi)
        check("the scale stays", one.AutomaticRescaleRangeMode == "Never")
        check("colours", all(0 <= c <= 1 for k, c in enumerate(one.RGBPoints) if k % 4), one.RGBPoints)
    view = of("view")[0]
    size = [summary[f"tank_size_{axis}"] for axis in "xy"]
    check("camera", 2 * view.CameraParallelScale >= max(size[1], size[0] / 1.7), view.CameraParallelScale)
    middle = [summary[f"tank_lo_{axis}"] + summary[f"tank_size_{axis}"] / 2 + float(shift)
              for axis, shift in zip("xy", sys.argv[2:4] or [0, 0])]
    check("middle", all(abs(a - b) < summary["dp"] for a, b in zip(view.CameraFocalPoint, middle)), view.CameraFocalPoint, middle)
    check("rendered", len(of("rendered")) == 1)


main()
