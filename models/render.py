#!/usr/bin/python3
"""Draws a refined mesh: models/render.py MESH.vtu PICTURE.png [--camera X,Y,Z] [--up X,Y,Z] [--cut A,B,C,D]

Skin with its edges, coloured by the shape of each hex (1 ideal, 0 flat). --cut takes away the hexes whose centre
has A x + B y + C z > D, whole hexes, so that the inside can be seen.
Debian 12: apt install python3-vtk9 xvfb xauth; run it under xvfb-run where there is no display.
"""
import argparse
import sys

import vtk


def numbers(text):
    return [float(word) for word in text.split(",")]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("picture")
    parser.add_argument("--camera", type=numbers, default=[1, -1, 0.7], help="direction to look from")
    parser.add_argument("--up", type=numbers, default=[0, 0, 1])
    parser.add_argument("--cut", type=numbers)
    parser.add_argument("--zoom", type=float, default=1.0)
    parser.add_argument("--size", type=numbers, default=[960, 860])
    return parser.parse_args()


def read(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    if not grid.GetNumberOfCells():
        sys.exit(f"{path}: no cells")
    return grid


def shape_array(grid):
    """The file's own values where it has them, else computed."""
    if grid.GetCellData().HasArray("shape"):
        return grid
    quality = vtk.vtkMeshQuality()
    quality.SetInputData(grid)
    quality.SetHexQualityMeasureToShape()
    quality.Update()
    quality.GetOutput().GetCellData().GetArray("Quality").SetName("shape")
    return quality.GetOutput()


def kept(grid, plane):
    """Hexes whose centre is not beyond the plane."""
    a, b, c, d = plane
    ids = vtk.vtkIdList()
    for cell in range(grid.GetNumberOfCells()):
        low_high = grid.GetCell(cell).GetBounds()
        x, y, z = ((low_high[2 * i] + low_high[2 * i + 1]) / 2 for i in range(3))
        if a * x + b * y + c * z <= d:
            ids.InsertNextId(cell)
    extract = vtk.vtkExtractCells()
    extract.SetInputData(grid)
    extract.SetCellList(ids)
    extract.Update()
    return extract.GetOutput()


def colours():
    table = vtk.vtkColorTransferFunction()
    table.SetColorSpaceToLab()
    for value, rgb in ((0.0, (0.55, 0.10, 0.15)), (0.35, (0.90, 0.45, 0.25)), (0.6, (0.98, 0.85, 0.55)),
                       (0.8, (0.66, 0.84, 0.86)), (1.0, (0.33, 0.60, 0.78))):
        table.AddRGBPoint(value, *rgb)
    return table


def skin_actor(grid, table):
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(grid)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(surface.GetOutputPort())
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray("shape")
    mapper.SetLookupTable(table)
    mapper.UseLookupTableScalarRangeOn()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.EdgeVisibilityOn()
    look.SetEdgeColor(0.12, 0.14, 0.18)
    look.SetLineWidth(0.8)
    look.SetInterpolationToFlat()
    look.SetAmbient(0.3)
    look.SetDiffuse(0.75)
    return actor


def legend(table):
    bar = vtk.vtkScalarBarActor()
    bar.SetLookupTable(table)
    bar.SetTitle("shape\n")
    bar.SetUnconstrainedFontSize(True)
    bar.SetNumberOfLabels(5)
    bar.SetLabelFormat("%.2f")
    bar.SetOrientationToVertical()
    bar.SetPosition(0.86, 0.08)
    bar.SetWidth(0.07)
    bar.SetHeight(0.4)
    for text in (bar.GetTitleTextProperty(), bar.GetLabelTextProperty()):
        text.SetColor(0.1, 0.1, 0.12)
        text.ItalicOff()
        text.SetFontSize(20)
        text.BoldOff()
        text.ShadowOff()
    return bar


def main():
    options = arguments()
    grid = shape_array(read(options.mesh))
    if options.cut:
        grid = kept(grid, options.cut)
    table = colours()
    renderer = vtk.vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AddActor(skin_actor(grid, table))
    renderer.AddActor2D(legend(table))
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(0, 0, 0)
    camera.SetPosition(*options.camera)
    camera.SetViewUp(*options.up)
    camera.SetViewAngle(22)
    renderer.ResetCamera()
    camera.Zoom(options.zoom)
    lights = vtk.vtkLightKit()
    lights.SetKeyLightAngle(60, -15)
    lights.SetKeyLightIntensity(0.85)
    lights.SetKeyToFillRatio(2.2)
    lights.AddLightsToRenderer(renderer)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(*map(int, options.size))
    window.AddRenderer(renderer)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(options.picture)
    writer.SetCompressionLevel(9)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


if __name__ == "__main__":
    main()
