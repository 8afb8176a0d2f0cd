# What is in mesh files of formats that no program here reads, by parsers of their own: they know the public descriptions
# of the formats and nothing of the library. Arguments: FILE...; prints of each its hexes, volume, smallest determinant at
# the Gauss points and nodes per hex, then a line for each group: its members and their volume or area.
#
# Sources: LS-DYNA Keyword User's Manual; ANSYS Programmer's Reference, "CDB"; Nek5000's documentation, "Mesh file";
# SPECFEM3D Cartesian's User Manual, "Mesh Generation"; "The LibMeshb library" (HexahedraQ2Ordering).
import os
import re
import struct
import sys

import numpy

ROOT = 0.6**0.5
GAUSS = [(-ROOT, 5 / 9), (0.0, 8 / 9), (ROOT, 5 / 9)]
CORNERS = [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)]
# Places of middle nodes in the reference hex, as each format has them behind the corners.
LOWER, UPPER, PILLARS = [(0, 1), (1, 2), (2, 3), (3, 0)], [(4, 5), (5, 6), (6, 7), (7, 4)], [(0, 4), (1, 5), (2, 6), (3, 7)]


def places(groups):
    return CORNERS + [tuple(numpy.mean([CORNERS[c] for c in group], axis=0)) for group in groups]


RINGS_PILLARS = places(LOWER + UPPER + PILLARS)
SPECFEM = places(LOWER + PILLARS + UPPER
                 + [(0, 1, 2, 3), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (4, 5, 6, 7), tuple(range(8))])


def shape(nodes, at):
    """Derivatives of the shape functions of an element with these nodes: 3 x nodes. Solved, not tabulated."""
    if len(nodes) == 20:  # serendipity
        powers = [(i, j, k) for i in range(3) for j in range(3) for k in range(3) if (i == 2) + (j == 2) + (k == 2) < 2]
    else:
        n = 2 if len(nodes) == 8 else 3
        powers = [(i, j, k) for i in range(n) for j in range(n) for k in range(n)]
    assert len(powers) == len(nodes)
    value = numpy.array([[x**i * y**j * z**k for i, j, k in powers] for x, y, z in nodes])
    x, y, z = at

    def d(x, i):
        return 0.0 if i == 0 else i * x ** (i - 1)

    derivative = numpy.array([[d(x, i) * y**j * z**k for i, j, k in powers], [x**i * d(y, j) * z**k for i, j, k in powers],
                              [x**i * y**j * d(z, k) for i, j, k in powers]])
    return derivative @ numpy.linalg.inv(value)


def volumes(points, nodes):
    """Per hex its volume and its smallest determinant. points: hex x node x 3."""
    volume, least = numpy.zeros(len(points)), numpy.full(len(points), numpy.inf)
    for a, u in GAUSS:
        for b, v in GAUSS:
            for c, w in GAUSS:
                determinant = numpy.linalg.det(numpy.einsum("an,hnx->hax", shape(nodes, (a, b, c)), points))
                volume += u * v * w * determinant
                least = numpy.minimum(least, determinant)
    return volume, least


def area(corners):
    """Of quads, by their corners: side x 4 x 3."""
    total = 0.0
    for a, u in GAUSS:
        for b, v in GAUSS:
            du = numpy.array([-(1 - b), 1 - b, 1 + b, -(1 + b)]) / 4
            dv = numpy.array([-(1 - a), -(1 + a), 1 + a, 1 - a]) / 4
            total += u * v * numpy.linalg.norm(numpy.cross(numpy.einsum("n,snx->sx", du, corners),
                                                           numpy.einsum("n,snx->sx", dv, corners)), axis=1).sum()
    return total


def report(points, hexes, nodes, blocks, side_sets, node_sets):
    """points: id -> place; hexes: id -> node ids; blocks: name -> hex ids; side_sets: name -> corner ids of sides."""
    ids = sorted(hexes)
    volume, least = volumes(numpy.array([[points[n] for n in hexes[h]] for h in ids]), nodes)
    of_hex = dict(zip(ids, volume))
    print("hexes", len(ids), repr(float(volume.sum())), repr(float(least.min())), len(nodes))
    for name in sorted(blocks):
        print("block", name, len(blocks[name]), repr(float(sum(of_hex[h] for h in blocks[name]))))
    for name in sorted(side_sets):
        quads = numpy.array([[points[n] for n in side] for side in side_sets[name]]).reshape(-1, 4, 3)
        print("sideset", name, len(quads), repr(float(area(quads))))
    for name in sorted(node_sets):
        assert all(n in points for n in node_sets[name])
        print("nodeset", name, len(set(node_sets[name])), 0.0)


def fields(line, width):
    line = line.rstrip("\n")
    return [line[i:i + width].strip() for i in range(0, len(line), width)]


def lsdyna(file):
    sections, title = [], None
    for line in open(file):
        if line.startswith("$"):
            continue
        if line.startswith("*"):
            sections.append((line[1:].strip(), []))
        else:
            sections[-1][1].append(line)
    assert sections[0][0] == "KEYWORD" and sections[-1][0] == "END"
    points, hexes, part_of, parts, blocks, side_sets, node_sets, n_nodes = {}, {}, {}, {}, {}, {}, {}, 8
    for name, lines in sections:
        title = ""
        if name.endswith("_TITLE"):
            title, lines, name = lines[0].strip(), lines[1:], name[:-6]
        if name == "NODE":
            for line in lines:
                assert len(line.rstrip("\n")) <= 8 + 3 * 16
                points[int(line[:8])] = [float(line[8 + 16 * i:24 + 16 * i]) for i in range(3)]
        elif name == "PART":
            numbers = fields(lines[1], 10)
            parts[int(numbers[0])] = lines[0].strip()
        elif name == "ELEMENT_SOLID":
            for line in lines:
                numbers = [int(n) for n in fields(line, 8)]
                assert len(numbers) == 10
                hexes[numbers[0]], part_of[numbers[0]] = numbers[2:], numbers[1]
        elif name == "ELEMENT_SOLID_H20":
            n_nodes = 20
            for i in range(0, len(lines), 3):
                head, nodes = [int(n) for n in fields(lines[i], 8)], [int(n) for n in fields(lines[i + 1], 8) + fields(lines[i + 2], 8)]
                assert len(head) == 2 and len(nodes) == 20
                hexes[head[0]], part_of[head[0]] = nodes, head[1]
        elif name in ("SET_NODE_LIST", "SET_SOLID"):
            members = [int(n) for line in lines[1:] for n in fields(line, 10)]
            (node_sets if name == "SET_NODE_LIST" else blocks)[title or lines[0].split()[0]] = members
        elif name == "SET_SEGMENT":
            side_sets[title or lines[0].split()[0]] = [[int(n) for n in fields(line, 10)][:4] for line in lines[1:]]
    for part, part_title in parts.items():
        members = [h for h in hexes if part_of[h] == part]
        if members and (part_title or str(part)) not in blocks:
            blocks[part_title or str(part)] = members
    report(points, hexes, RINGS_PILLARS[:n_nodes], blocks, side_sets, node_sets)


def ansys(file):
    lines = iter(open(file))
    points, hexes, quads, types, blocks, side_sets, node_sets, n_nodes = {}, {}, {}, {}, {}, {}, {}, 8
    for line in lines:
        words = [word.strip() for word in line.split(",")]
        if words[0] == "ET":
            types[int(words[1])] = int(words[2])
        elif words[0] == "NBLOCK":
            integers, width, real = (int(n) for n in re.match(r"\((\d)i(\d+),6e(\d+)", next(lines)).groups())
            count = int(words[4])
            for line in lines:
                if line.startswith("N,"):
                    break
                first = integers * width
                points[int(line[:width])] = [float(line[first + real * i:first + real * (i + 1)]) for i in range(3)]
            assert len(points) == count
        elif words[0] == "EBLOCK":
            assert words[1] == "19" and words[2] == "SOLID"
            columns, width = (int(n) for n in re.match(r"\((\d+)i(\d+)\)", next(lines)).groups())
            for line in lines:
                if line.strip() == "-1":
                    break
                numbers = [int(n) for n in fields(line, width)]
                assert len(numbers) <= columns
                n = numbers[8]
                nodes = numbers[11:]
                if len(nodes) < n:
                    nodes += [int(k) for k in fields(next(lines), width)]
                assert len(nodes) == n
                if types[numbers[1]] in (185, 186):
                    hexes[numbers[10]], n_nodes = nodes, n
                else:
                    quads[numbers[10]] = nodes[:4]
        elif words[0] == "CMBLOCK":
            count, (columns, width) = int(words[3]), (int(n) for n in re.match(r"\((\d)i(\d+)\)", next(lines)).groups())
            numbers = []
            while len(numbers) < count:
                numbers += [int(n) for n in fields(next(lines), width)]
            members = []
            for number in numbers:
                if number < 0:
                    members += range(members[-1] + 1, -number + 1)
                else:
                    members.append(number)
            if words[2].startswith("NODE"):
                node_sets[words[1]] = members
            elif members[0] in hexes:
                blocks[words[1]] = members
            else:
                side_sets[words[1]] = [quads[q] for q in members]
    report(points, hexes, RINGS_PILLARS[:n_nodes], blocks, side_sets, node_sets)


def nek(file):
    data = open(file, "rb").read()
    head = data[:80].decode("ascii")
    assert head.startswith("#v003") and struct.unpack_from("<f", data, 80)[0] == numpy.float32(6.54321)
    n, dimension, fluid = int(head[5:14]), int(head[14:17]), int(head[17:26])
    assert dimension == 3
    at, points, hexes, blocks = 84, {}, {}, {}
    number_of = {}
    for e in range(1, n + 1):
        group, *numbers = struct.unpack_from("<25d", data, at)
        at += 200
        nodes = []
        for place in zip(numbers[:8], numbers[8:16], numbers[16:]):
            nodes.append(number_of.setdefault(place, len(number_of)))
            points[nodes[-1]] = list(place)
        hexes[e] = nodes
        blocks.setdefault("%d" % group, []).append(e)
    blocks.pop("0", None)

    def entries():
        nonlocal at
        count, = struct.unpack_from("<d", data, at)
        at += 8
        for _ in range(int(count)):
            yield struct.unpack_from("<7d", data, at) + (data[at + 56:at + 59].decode("ascii").strip(),)
            at += 64

    bent = list(entries())
    nodes = CORNERS
    if bent:
        nodes = RINGS_PILLARS
        ends = LOWER + UPPER + PILLARS
        for e in hexes:
            for a, b in ends:
                points[("m", e, a, b)] = [(x + y) / 2 for x, y in zip(points[hexes[e][a]], points[hexes[e][b]])]
        for e, edge, x, y, z, _, _, code in bent:
            assert code == "m"
            points[("m", int(e)) + ends[int(edge) - 1]] = [x, y, z]
        for e in hexes:
            hexes[e] = hexes[e] + [("m", e, a, b) for a, b in ends]
    sides = [(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7), (0, 1, 2, 3), (4, 5, 6, 7)]
    side_sets = {}
    while at < len(data):
        side_sets = {}  # of the last field, which has those of solid elements too
        for e, side, _, _, _, _, number, code in entries():
            name = "%d" % number if code in ("MSH", "EXO") else code
            side_sets.setdefault(name, []).append([hexes[int(e)][c] for c in sides[int(side) - 1]])
    report(points, hexes, nodes, blocks, side_sets, {})


def specfem(file):
    folder = os.path.dirname(file)

    def rows(name):
        with open(os.path.join(folder, name)) as text:
            return [line.split() for line in text if line.strip()]

    listed = rows("nodes_coords_file")
    points = {int(row[0]): [float(x) for x in row[1:]] for row in listed[1:]}
    assert sorted(points) == list(range(1, int(listed[0][0]) + 1))
    listed = rows("mesh_file")
    hexes = {int(row[0]): [int(n) for n in row[1:]] for row in listed[1:]}
    assert sorted(hexes) == list(range(1, int(listed[0][0]) + 1))
    width = len(hexes[1])
    blocks = {}
    for element, material in rows("materials_file"):
        blocks.setdefault(material, []).append(int(element))
    known = [int(row[1]) for row in rows("nummaterial_velocity_file")]
    assert sorted(k for k in known if k > 0) == list(range(1, sum(k > 0 for k in known) + 1))
    assert all(int(material) in known for material in blocks)
    side_sets = {}
    for side in ("xmin", "xmax", "ymin", "ymax", "bottom"):
        side_sets["absorbing_surface_file_" + side] = rows("absorbing_surface_file_" + side)
    side_sets["free_or_absorbing_surface_file_zmax"] = rows("free_or_absorbing_surface_file_zmax")
    for name, listed in side_sets.items():
        assert int(listed[0][0]) == len(listed) - 1
        side_sets[name] = []
        for row in listed[1:]:
            nodes = [int(n) for n in row[1:]]
            assert len(nodes) == (4 if width == 8 else 9) and set(nodes) <= set(hexes[int(row[0])])
            side_sets[name].append(nodes[:4])
    report(points, hexes, SPECFEM[:width], blocks, {name: sides for name, sides in side_sets.items() if sides}, {})


def medit(file):
    words = " ".join(line for line in open(file) if not line.startswith("#")).split()
    sections, at = {}, 0
    widths = {"Vertices": 4, "EdgesP2": 4, "QuadrilateralsQ2": 10, "HexahedraQ2": 28, "Corners": 1,
              "EdgesP2Ordering": 1, "QuadrilateralsQ2Ordering": 2, "HexahedraQ2Ordering": 3}
    while words[at] != "End":
        name = words[at]
        if name in ("MeshVersionFormatted", "Dimension"):
            at += 2
            continue
        count, width = int(words[at + 1]), widths[name]
        sections[name] = numpy.array([float(x) for x in words[at + 2:at + 2 + count * width]]).reshape(count, width)
        at += 2 + count * width
    points = {i + 1: list(row[:3]) for i, row in enumerate(sections["Vertices"])}
    hexes = {i + 1: [int(n) for n in row[:27]] for i, row in enumerate(sections["HexahedraQ2"])}
    blocks, side_sets = {}, {}
    for i, row in enumerate(sections["HexahedraQ2"]):
        blocks.setdefault("%d" % row[27], []).append(i + 1)
    order = [tuple(place) for place in sections["QuadrilateralsQ2Ordering"].astype(int)]
    corners = [order.index(place) for place in ((0, 0), (2, 0), (2, 2), (0, 2))]
    for row in sections.get("QuadrilateralsQ2", []):
        side_sets.setdefault("%d" % row[9], []).append([int(row[c]) for c in corners])
    blocks.pop("0", None), side_sets.pop("0", None)
    report(points, hexes, sections["HexahedraQ2Ordering"] - 1, blocks, side_sets, {})


for path in sys.argv[1:]:
    {".k": lsdyna, ".key": lsdyna, ".cdb": ansys, ".re2": nek, ".specfem": specfem, ".mesh": medit}[os.path.splitext(path)[1]](path)
    print("end")
