"""VTK measuring, writing and reading a million hexes. Prints "name CPU-seconds hexes"."""
import os
import sys
import time

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray


def cube(n):
    line = np.arange(n + 1, dtype=float)
    z, y, x = np.meshgrid(line, line, line, indexing="ij")
    points = vtk.vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1), deep=True))
    i = np.arange(n)
    k, j, i = (a.ravel() for a in np.meshgrid(i, i, i, indexing="ij"))
    first = i + (n + 1) * (j + (n + 1) * k)
    row, layer = n + 1, (n + 1) ** 2
    corners = [0, 1, 1 + row, row, layer, 1 + layer, 1 + row + layer, row + layer]
    cells = np.stack([np.full(n**3, 8)] + [first + c for c in corners], axis=1)
    array = vtk.vtkCellArray()
    array.SetCells(n**3, numpy_to_vtkIdTypeArray(cells.ravel().astype(np.int64), deep=True))
    grid = vtk.vtkUnstructuredGrid()
    grid.SetPoints(points)
    grid.SetCells(vtk.VTK_HEXAHEDRON, array)
    return grid


def report(name, action, n):
    best = np.inf
    for _ in range(3):
        start = time.process_time()
        action()
        best = min(best, time.process_time() - start)
    print(name, best, n, flush=True)


def main(folder):
    vtk.vtkSMPTools.Initialize(1)
    grid = cube(100)
    n = grid.GetNumberOfCells()

    def measure(choose):
        quality = vtk.vtkMeshQuality()
        quality.SetInputData(grid)
        choose(quality)
        quality.Update()

    report("vtk_shape", lambda: measure(vtk.vtkMeshQuality.SetHexQualityMeasureToShape), n)
    report("vtk_scaled_jacobian", lambda: measure(vtk.vtkMeshQuality.SetHexQualityMeasureToScaledJacobian), n)

    file = os.path.join(folder, "peer.vtu")

    def write():
        writer = vtk.vtkXMLUnstructuredGridWriter()
        writer.SetFileName(file)
        writer.SetInputData(grid)
        writer.SetDataModeToAppended()
        writer.EncodeAppendedDataOff()
        writer.SetCompressorTypeToNone()
        writer.Write()

    def read():
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(file)
        reader.Update()

    report("vtk_write", write, n)
    report("vtk_read", read, n)
    os.remove(file)


main(sys.argv[1])
