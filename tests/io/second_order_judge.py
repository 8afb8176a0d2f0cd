# What other programs make of second-order meshes: the volume of each file, by their own readers and their own elements.
# Arguments: PROGRAM FILE...; prints of each volume, smallest determinant at the Gauss points, nodes per hex.
import sys

import numpy

program, files = sys.argv[1], sys.argv[2:]
points = [0.5 - 15**0.5 / 10, 0.5, 0.5 + 15**0.5 / 10]
weights = [5 / 18, 8 / 18, 5 / 18]
places = [(i, j, k) for i in range(3) for j in range(3) for k in range(3)]


def report(nodes, derivatives):
    """nodes: hex x node x 3; derivatives: place x 3 x node."""
    volume, least = 0.0, numpy.inf
    for (i, j, k), d in zip(places, derivatives):
        determinant = numpy.linalg.det(numpy.einsum("an,cnx->cax", d, nodes))
        volume += weights[i] * weights[j] * weights[k] * determinant.sum()
        least = min(least, determinant.min())
    print(repr(float(volume)), repr(float(least)), nodes.shape[1])


def by_vtk(file):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    if file.endswith(".e"):
        reader = vtk.vtkExodusIIReader()
        reader.SetFileName(file)
        reader.Update()
        grid = reader.GetOutput().GetBlock(0).GetBlock(0)
    else:
        reader = vtk.vtkXMLUnstructuredGridReader()
        reader.SetFileName(file)
        reader.Update()
        grid = reader.GetOutput()
    cell = grid.GetCell(0)
    n = cell.GetNumberOfPoints()
    derivatives = []
    for i, j, k in places:
        d = [0.0] * (3 * n)
        cell.InterpolateDerivs([points[i], points[j], points[k]], d)
        derivatives.append(numpy.array(d).reshape(3, n))
    connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, n)
    report(vtk_to_numpy(grid.GetPoints().GetData())[connectivity].astype(float), derivatives)


def by_gmsh(file):
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(file)
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    place_of = {int(tag): i for i, tag in enumerate(tags)}
    coordinates = coordinates.reshape(-1, 3)
    types, _, nodes = gmsh.model.mesh.getElements(3)
    assert len(types) == 1, types
    n = gmsh.model.mesh.getElementProperties(types[0])[3]
    local = [2 * x - 1 for i, j, k in places for x in (points[i], points[j], points[k])]
    _, values, _ = gmsh.model.mesh.getBasisFunctions(types[0], local, "GradLagrange")
    derivatives = 2 * numpy.array(values).reshape(len(places), n, 3).transpose(0, 2, 1)
    report(coordinates[[place_of[int(t)] for t in nodes[0]]].reshape(-1, n, 3), derivatives)
    # Quads and lines are of the same order.
    for dim, kind in ((2, {8: 3, 20: 16, 27: 10}[n]), (1, 1 if n == 8 else 8)):
        for entity in gmsh.model.getEntities(dim):
            found = gmsh.model.mesh.getElements(*entity)[0]
            assert list(found) in ([], [kind]), (file, entity, found)
    gmsh.finalize()


for file in files:
    by_vtk(file) if program == "vtk" else by_gmsh(file)
