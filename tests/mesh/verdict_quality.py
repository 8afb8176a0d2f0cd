# Shape and scaled Jacobian by Verdict, for hexes as lines of 24 numbers (corners in VTK order) on standard input.
import sys

import vtk

points = vtk.vtkPoints()
points.SetDataTypeToDouble()
grid = vtk.vtkUnstructuredGrid()
for line in sys.stdin:
    x = [float(word) for word in line.split()]
    corners = vtk.vtkIdList()
    for i in range(8):
        corners.InsertNextId(points.InsertNextPoint(x[3 * i:3 * i + 3]))
    grid.InsertNextCell(vtk.VTK_HEXAHEDRON, corners)
grid.SetPoints(points)


def measure(name):
    quality = vtk.vtkMeshQuality()
    quality.SetInputData(grid)
    getattr(quality, "SetHexQualityMeasureTo" + name)()
    quality.Update()
    return quality.GetOutput().GetCellData().GetArray("Quality")


columns = [measure(name) for name in ("Shape", "ScaledJacobian")]
for i in range(grid.GetNumberOfCells()):
    print(*("%.17g" % column.GetValue(i) for column in columns))
