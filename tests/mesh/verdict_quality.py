# Qualities by Verdict, for hexes as lines of 24 numbers (corners in VTK order) on standard input. First line: the
# version of VTK and the names of the columns.
import sys

import vtk


def grid_of(hexes):
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    grid = vtk.vtkUnstructuredGrid()
    for x in hexes:
        corners = vtk.vtkIdList()
        for i in range(8):
            corners.InsertNextId(points.InsertNextPoint(x[i]))
        grid.InsertNextCell(vtk.VTK_HEXAHEDRON, corners)
    grid.SetPoints(points)
    return grid


def measure(name, hexes):
    quality = vtk.vtkMeshQuality()
    quality.SetInputData(grid_of(hexes))
    getattr(quality, "SetHexQualityMeasureTo" + name)()
    quality.Update()
    values = quality.GetOutput().GetCellData().GetArray("Quality")
    return [values.GetValue(i) for i in range(len(hexes))]


def edge_ratio(hexes):
    # Verdict looks for the longest edge among the first six only. Turned and turned over, each edge is among them once.
    turns = ((0, 1, 2, 3, 4, 5, 6, 7), (4, 5, 6, 7, 0, 1, 2, 3), (0, 3, 7, 4, 1, 2, 6, 5), (1, 2, 6, 5, 0, 3, 7, 4))
    return [max(values) for values in zip(*(measure("EdgeRatio", [[x[i] for i in turn] for x in hexes]) for turn in turns))]


hexes = []
for line in sys.stdin:
    x = [float(word) for word in line.split()]
    hexes.append([x[3 * i:3 * i + 3] for i in range(8)])
names = ("Shape", "ScaledJacobian", "Condition", "MaxAspectFrobenius", "Skew", "Stretch", "Taper", "MaxEdgeRatios",
         "Diagonal", "RelativeSizeSquared", "Shear", "Oddy", "Distortion", "Volume", "Jacobian", "Dimension")
columns = [measure(name, hexes) for name in names] + [edge_ratio(hexes)]
print("%d.%d" % (vtk.vtkVersion.GetVTKMajorVersion(), vtk.vtkVersion.GetVTKMinorVersion()), *names, "EdgeRatio")
for row in zip(*columns):
    print(*("%.17g" % value for value in row))
