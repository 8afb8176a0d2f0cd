"""Writes a text .msh 4.1 as files that hextwist reads but does not write: same_formats.py MODEL.msh

gmsh22.msh, gmsh22_binary.msh: with entity tags; legacy.vtk, legacy_binary.vtk: with the fields "error" of hexes and
"wished" of nodes; inside_out.vtk; inverted.vtk: an inner node lies behind its neighbour.
"""
import struct
import sys
from collections import Counter

sections = {}
for line in open(sys.argv[1]):
    if line.startswith("$End"):
        continue
    if line.startswith("$"):
        lines = sections.setdefault(line[1:].strip(), [])
    else:
        lines.append(line.split())

# physical group of an entity: {(dim, tag): group}
entities = iter(sections["Entities"])
groups = {}
for dim, n in enumerate(map(int, next(entities))):
    for _ in range(n):
        words = next(entities)
        at = 4 if dim == 0 else 7
        groups[dim, int(words[0])] = int(words[at + 1]) if int(words[at]) else 0

points = {}
lines = iter(sections["Nodes"])
for _ in range(int(next(lines)[0])):
    n = int(next(lines)[3])
    ids = [int(next(lines)[0]) for _ in range(n)]
    points.update((id, [float(x) for x in next(lines)[:3]]) for id in ids)

elements = []  # (id, type, group, entity, nodes)
lines = iter(sections["Elements"])
for _ in range(int(next(lines)[0])):
    dim, tag, kind, n = map(int, next(lines))
    for _ in range(n):
        id, *nodes = map(int, next(lines))
        elements.append((id, kind, groups[dim, tag], tag, nodes))
elements.sort()

names = "".join("$%s\n%s$End%s\n" % (s, "".join(" ".join(l) + "\n" for l in sections[s]), s)
                for s in ["PhysicalNames"] if s in sections)
with open("gmsh22.msh", "w") as out:
    out.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{names}$Nodes\n{len(points)}\n")
    for id, x in points.items():
        out.write("%d %r %r %r\n" % (id, *x))
    out.write(f"$EndNodes\n$Elements\n{len(elements)}\n")
    for id, kind, group, tag, nodes in elements:
        out.write(f"{id} {kind} 2 {group} {tag} {' '.join(map(str, nodes))}\n")
    out.write("$EndElements\n")
with open("gmsh22_binary.msh", "wb") as out:
    out.write(b"$MeshFormat\n2.2 1 8\n" + struct.pack("<i", 1) + b"\n$EndMeshFormat\n" + names.encode())
    out.write(b"$Nodes\n%d\n" % len(points))
    for id, x in points.items():
        out.write(struct.pack("<i3d", id, *x))
    out.write(b"\n$EndNodes\n$Elements\n%d\n" % len(elements))
    for id, kind, group, tag, nodes in elements:
        out.write(struct.pack("<6i", kind, 1, 2, id, group, tag) + struct.pack("<%di" % len(nodes), *nodes))
    out.write(b"\n$EndElements\n")

index = {id: i for i, id in enumerate(points)}
x = list(points.values())
hexes = [[index[node] for node in nodes] for _, kind, _, _, nodes in elements if kind == 5]


def write_vtk(file, x, hexes, binary=False):
    def put(kind, values):  # big-endian
        values = list(values)
        out.write(struct.pack(f">{len(values)}{kind}", *values) if binary else " ".join(map(repr, values)).encode())
        out.write(b"\n")

    def text(line):
        out.write(line.encode() + b"\n")

    with open(file, "wb") as out:
        text(f"# vtk DataFile Version 3.0\nmesh\n{'BINARY' if binary else 'ASCII'}\nDATASET UNSTRUCTURED_GRID")
        text(f"POINTS {len(x)} double")
        put("d", (c for p in x for c in p))
        text(f"CELLS {len(hexes)} {9 * len(hexes)}")
        put("i", (i for h in hexes for i in [8, *h]))
        text(f"CELL_TYPES {len(hexes)}")
        put("i", [12] * len(hexes))
        text(f"CELL_DATA {len(hexes)}\nSCALARS error double 1\nLOOKUP_TABLE default")
        put("d", (1 / (1 + 0.1 * sum(abs(a - b) for a, b in zip(x[h[0]], x[0]))) for h in hexes))
        text(f"POINT_DATA {len(x)}\nSCALARS wished double 1\nLOOKUP_TABLE default")
        put("d", (1.6 + 0.06 * sum(map(abs, p)) for p in x))


write_vtk("legacy.vtk", x, hexes)
write_vtk("legacy_binary.vtk", x, hexes, binary=True)
write_vtk("inside_out.vtk", x, [h[4:] + h[:4] for h in hexes])
# A node in eight hexes that is none of any quad lies inside.
outer = {index[node] for _, kind, _, _, nodes in elements if kind != 5 for node in nodes}
count = Counter(i for h in hexes for i in h)
inner = next(i for i in range(len(x)) if count[i] == 8 and i not in outer)
cube = next(h for h in hexes if h[0] == inner or h[6] == inner)
beside = cube[1] if cube[0] == inner else cube[5]
moved = list(x)
moved[inner] = [a + 1.3 * (b - a) for a, b in zip(x[inner], x[beside])]
write_vtk("inverted.vtk", moved, hexes)
