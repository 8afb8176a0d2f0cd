# What other programs make of our files: arguments READER FILE; prints, one a line, "name value...".
#   volume, nodes, hexes, nodes per hex (all readers); "block ID COUNT" of cells and "field NAME FIRST LAST" where they have that.
import sys

import numpy

reader, file = sys.argv[1], sys.argv[2]

# Trilinear and triquadratic hexes by their own shape functions, corners and middles in VTK's order.
places = numpy.array(
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    + [(0.5, 0, 0), (1, 0.5, 0), (0.5, 1, 0), (0, 0.5, 0), (0.5, 0, 1), (1, 0.5, 1), (0.5, 1, 1), (0, 0.5, 1)]
    + [(0, 0, 0.5), (1, 0, 0.5), (1, 1, 0.5), (0, 1, 0.5)]
    + [(0, 0.5, 0.5), (1, 0.5, 0.5), (0.5, 0, 0.5), (0.5, 1, 0.5), (0.5, 0.5, 0), (0.5, 0.5, 1), (0.5, 0.5, 0.5)]
)


def monomials(n, x):
    """The polynomials that a hex of n nodes has, and their derivatives, at points x."""
    if n == 8:
        powers = [(i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    elif n == 27:
        powers = [(i, j, k) for i in (0, 1, 2) for j in (0, 1, 2) for k in (0, 1, 2)]
    else:  # serendipity: superlinear degree 2
        powers = [p for p in ((i, j, k) for i in (0, 1, 2) for j in (0, 1, 2) for k in (0, 1, 2)) if sorted(p)[1] < 2]
    value = numpy.array([numpy.prod(x ** numpy.array(p), axis=1) for p in powers]).T
    slope = []
    for axis in range(3):
        columns = []
        for p in powers:
            lower = list(p)
            factor = lower[axis]
            lower[axis] = max(0, factor - 1)
            columns.append(factor * numpy.prod(x ** numpy.array(lower), axis=1))
        slope.append(numpy.array(columns).T)
    return value, numpy.array(slope)


def volume(points, cells):
    n = cells.shape[1]
    coefficients = numpy.linalg.inv(monomials(n, places[:n].astype(float))[0])
    gauss = [0.5 - 15**0.5 / 10, 0.5, 0.5 + 15**0.5 / 10]
    weights = [5 / 18, 8 / 18, 5 / 18]
    total = 0.0
    for i in range(3):
        for j in range(3):
            for k in range(3):
                slope = monomials(n, numpy.array([[gauss[i], gauss[j], gauss[k]]]))[1][:, 0, :] @ coefficients
                jacobian = numpy.einsum("an,cnx->cax", slope, points[cells])
                total += weights[i] * weights[j] * weights[k] * numpy.linalg.det(jacobian).sum()
    return float(total)


def report(points, cells, blocks=None, fields=()):
    print("nodes", len(points))
    print("hexes", len(cells), cells.shape[1])
    print("volume", repr(volume(numpy.asarray(points, dtype=float), numpy.asarray(cells))))
    if blocks is not None:
        for number in numpy.unique(blocks):
            print("block", int(number), int((blocks == number).sum()))
    for name, values in fields:
        flat = numpy.asarray(values).reshape(-1)
        print("field", name.replace(" ", "_"), repr(float(flat[0])), repr(float(flat[-1])))


def by_vtk(grid):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    n = grid.GetCell(0).GetNumberOfPoints()
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, n)
    data = {}
    for part in (grid.GetPointData(), grid.GetCellData()):
        for a in range(part.GetNumberOfArrays()):
            data[part.GetArrayName(a)] = vtk_to_numpy(part.GetArray(a))
    report(vtk_to_numpy(grid.GetPoints().GetData()), cells, data.get("block"), sorted(data.items()))


if reader == "vtkhdf":
    from vtkmodules.vtkIOHDF import vtkHDFReader

    r = vtkHDFReader()
    r.SetFileName(file)
    r.Update()
    by_vtk(r.GetOutput())
elif reader == "vtkcgns":
    from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet
    from vtkmodules.vtkIOCGNSReader import vtkCGNSReader

    r = vtkCGNSReader()
    r.SetFileName(file)
    r.UpdateInformation()
    r.EnableAllBases()
    r.EnableAllPointArrays()
    r.EnableAllCellArrays()
    r.Update()
    by_vtk(r.GetOutput().GetBlock(0).GetBlock(0))
elif reader == "h5cgns":
    # The layout of CGNS in HDF5 read by hand.
    import h5py

    with h5py.File(file, "r") as f:
        zone = f["hextwist/mesh"]
        points = numpy.array([zone["GridCoordinates/Coordinate" + a + "/ data"][()] for a in "XYZ"]).T
        kinds = {17: 8, 18: 20, 19: 27}
        cells = []
        for name, section in sorted(zone.items(), key=lambda item: item[0]):
            if section.attrs.get("label", b"").rstrip(b"\0 ") != b"Elements_t":
                continue
            kind = int(section[" data"][0])
            if kind not in kinds:
                continue
            n = kinds[kind]
            nodes = section["ElementConnectivity/ data"][()].reshape(-1, n) - 1
            # The SIDS go round pillars before the upper ring, and faces z- y- x+ y+ x- z+.
            place = list(range(8)) + [8, 9, 10, 11] + [16, 17, 18, 19] + [12, 13, 14, 15] + [24, 22, 21, 23, 20, 25, 26]
            cells.append(nodes[:, place[:n]])
            print("section", name.replace(" ", "_"), len(nodes))
        report(points, numpy.concatenate(cells))
        for name, condition in zone.get("ZoneBC", {}).items():
            if condition.attrs.get("label", b"").rstrip(b"\0 ") != b"BC_t":
                continue
            if "PointList" in condition:
                count = condition["PointList/ data"].size
            else:
                ends = condition["PointRange/ data"][()].reshape(-1)
                count = int(ends[1] - ends[0] + 1)
            where = bytes(condition["GridLocation/ data"][()].astype(numpy.uint8)).decode()
            print("condition", name.replace(" ", "_"), where, count)
elif reader == "meshio":
    import meshio

    mesh = meshio.read(file)
    kinds = {"hexahedron", "hexahedron20", "hexahedron27"}
    found = [block.data for block in mesh.cells if block.type in kinds]
    blocks = mesh.cell_data.get("block")
    fields = [(name, values) for name, values in mesh.point_data.items()]
    fields += [(name, numpy.concatenate(values)) for name, values in mesh.cell_data.items()]
    if found:
        report(mesh.points, numpy.concatenate(found), None if blocks is None else numpy.concatenate(blocks), sorted(fields))
    else:  # sides
        for block in mesh.cells:
            print("cells", block.type, len(block.data))
        numbers = numpy.concatenate(mesh.cell_data["sideset"])
        for number in numpy.unique(numbers):
            print("sideset", int(number), int((numbers == number).sum()))
elif reader == "mfem":
    # MFEM's mesh format as its documentation and source have it, read without any library.
    text = open(file).read().split("\n")
    assert text[0] in ("MFEM mesh v1.0", "MFEM mesh v1.3"), text[0]
    words = " ".join(line for line in text[1:] if not line.startswith("#")).split()
    at = 0

    def word():
        global at
        at += 1
        return words[at - 1]

    def expect(what):
        found = word()
        assert found == what, (found, what)

    def names():
        # Quoted names hold blanks.
        global at
        result = {}
        for _ in range(int(word())):
            name = word()
            while not (len(name) > 1 and name.endswith('"') and not name.endswith('\\"')):
                name += " " + word()
            result[name[1:-1]] = [int(word()) for _ in range(int(word()))]
        return result

    def elements(kind, n):
        result = []
        for _ in range(int(word())):
            attribute, geometry = int(word()), int(word())
            assert geometry == kind and attribute > 0
            result.append([attribute] + [int(word()) for _ in range(n)])
        return numpy.array(result)

    expect("dimension")
    expect("3")
    expect("elements")
    hexes = elements(5, 8)
    sets, sides = {}, {}
    if text[0].endswith("1.3"):
        expect("attribute_sets")
        sets = names()
    expect("boundary")
    quads = elements(3, 4)
    if text[0].endswith("1.3"):
        expect("bdr_attribute_sets")
        sides = names()
    expect("vertices")
    n = int(word())
    if word() == "nodes":
        for expected in "FiniteElementSpace FiniteElementCollection: H1_3D_P2 VDim: 3 Ordering: 1".split():
            expect(expected)
        # Edges and faces are numbered as the elements name them first.
        edge_of, face_of = {}, {}
        local_edges = [(0, 1), (1, 2), (3, 2), (0, 3), (4, 5), (5, 6), (7, 6), (4, 7), (0, 4), (1, 5), (2, 6), (3, 7)]
        local_faces = [(3, 2, 1, 0), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7)]
        of_edges = [[edge_of.setdefault(tuple(sorted(h[list(e)])), len(edge_of)) for e in local_edges] for h in hexes[:, 1:]]
        of_faces = [[face_of.setdefault(tuple(sorted(h[list(q)])), len(face_of)) for q in local_faces] for h in hexes[:, 1:]]
        n_edges, n_faces = len(edge_of), len(face_of)
        total = n + n_edges + n_faces + len(hexes)
        points = numpy.array([float(word()) for _ in range(3 * total)]).reshape(-1, 3)
        edges, faces = numpy.array(of_edges) + n, numpy.array(of_faces) + n + n_edges
        cells = numpy.concatenate(
            [
                hexes[:, 1:],
                edges,  # as VTK has them
                faces[:, [4, 2, 1, 3, 0, 5]],
                (n + n_edges + n_faces + numpy.arange(len(hexes))).reshape(-1, 1),
            ],
            axis=1,
        )
    else:
        points = numpy.array([float(word()) for _ in range(3 * n)]).reshape(-1, 3)
        cells = hexes[:, 1:]
    report(points, cells, hexes[:, 0])
    print("quads", len(quads))
    for name, attributes in sets.items():
        print("set", name.replace(" ", "_"), int(numpy.isin(hexes[:, 0], attributes).sum()))
    for name, attributes in sides.items():
        print("sides", name.replace(" ", "_"), int(numpy.isin(quads[:, 0], attributes).sum()))
else:
    sys.exit("unknown reader " + reader)
