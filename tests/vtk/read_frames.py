#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""VTK's own reader of frames: a vertex for each particle, and a threshold that keeps the particles it should. usage: read_frames.py write_frames

Exit code 77, a skipped test, without VTK (Debian: python3-vtk9)."""
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    from vtkmodules.vtkCommonDataModel import vtkDataObject
    from vtkmodules.vtkFiltersCore import vtkThreshold
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLPPolyDataReader
except ImportError as error:
    print(f"skipped: no VTK for {sys.executable} ({error}); Debian's package is python3-vtk9")
    sys.exit(77)


def check(what, got, wanted):
    if got != wanted:
        sys.exit(f"{what}: {got} instead of {wanted}")


def threshold(reader, name, value):
    keep = vtkThreshold()
    keep.SetInputConnection(reader.GetOutputPort())
    keep.SetInputArrayToProcess(0, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, name)
    keep.SetLowerThreshold(value - 0.5)
    keep.SetUpperThreshold(value + 0.5)
    keep.Update()
    return keep.GetOutput()


with tempfile.TemporaryDirectory() as folder:
    done = subprocess.run([sys.argv[1], folder], stdout=subprocess.PIPE, text=True, check=True)
    fluid, wall = (int(word) for word in done.stdout.split())
    frames = sorted(Path(folder).glob("cells/*.vtp")) + sorted(Path(folder).glob("pieces/*.pvtp"))
    check("frames", len(frames), 4)
    for frame in frames:
        reader = vtkXMLPolyDataReader() if frame.suffix == ".vtp" else vtkXMLPPolyDataReader()
        reader.SetFileName(str(frame))
        reader.Update()
        data = reader.GetOutput()
        check(f"{frame.name}: points", data.GetNumberOfPoints(), fluid + wall)
        check(f"{frame.name}: vertices", data.GetNumberOfVerts(), fluid + wall)
        part = data.GetPointData().GetArray("part")
        names = data.GetFieldData().GetAbstractArray("part_names")
        check(f"{frame.name}: names of parts", [names.GetValue(k) for k in range(names.GetNumberOfValues())],
              [f"tank.{axis}{end}" for axis in "xyz" for end in "01"])
        wanted = {"tank.x0": (0, 0), "tank.x1": (0, 0.6), "tank.y0": (1, 0), "tank.y1": (1, 0.5), "tank.z0": (2, 0), "tank.z1": (2, 0.4)}
        for k in range(data.GetNumberOfPoints()):
            number = int(part.GetValue(k))
            if number < 0:
                continue
            axis, place = wanted[names.GetValue(number)]
            if abs(data.GetPoint(k)[axis] - place) > 1e-5:
                sys.exit(f"{frame.name}: a particle of {names.GetValue(number)} at {data.GetPoint(k)}")
        check(f"{frame.name}: particles without a part", sum(part.GetValue(k) < 0 for k in range(data.GetNumberOfPoints())), fluid)
        check(f"{frame.name}: wall_pressure", data.GetPointData().HasArray("wall_pressure"), 1)
        check(f"{frame.name}: points of a cell", {data.GetCell(k).GetNumberOfPoints() for k in range(data.GetNumberOfCells())}, {1})
        for kind, count in ((0, fluid), (1, wall)):
            kept = threshold(reader, "kind", kind)
            check(f"{frame.name}: cells of kind {kind}", kept.GetNumberOfCells(), count)
            check(f"{frame.name}: points of kind {kind}", kept.GetNumberOfPoints(), count)
print(f"VTK reads {fluid + wall} particles, a cell each")
