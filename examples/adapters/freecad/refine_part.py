"""A macro for FreeCAD 0.20: refines the hexes of a document's mesh that touch picked faces and edges of its part.

In FreeCAD, with a part and a mesh of it in the document: pick faces and edges, run the macro. Without its window:

    freecadcmd refine_part.py --pass DOCUMENT.FCStd OUT.FCStd "Face6 Edge5" [OPTIONS OF REFINE]

Faces and edges of a part have the numbers of hextwist's surfaces and curves: both come from the order of its shapes."""

import os
import sys
import tempfile

import Fem
import FreeCAD
import numpy as np

import hextwist


def parts_of(document):
    """The part and its mesh: the first of each."""
    shapes = [each for each in document.Objects if hasattr(each, "Shape") and each.Shape.Solids]
    meshes = [each for each in document.Objects if each.isDerivedFrom("Fem::FemMeshObject")]
    if not shapes or not meshes:
        raise ValueError(f"{document.Name}: a part with a solid and a mesh of it are wanted")
    return shapes[0], meshes[0]


def session_of(shape, mesh):
    """A session with the shape as its CAD and the hexes of the mesh."""
    session = hextwist.Session(notice=lambda line: FreeCAD.Console.PrintMessage(f"note: {line}\n"))
    with tempfile.TemporaryDirectory() as folder:
        shape.exportBrep(os.path.join(folder, "part.brep"))
        session.import_cad(os.path.join(folder, "part.brep"))
    ids = np.array(sorted(mesh.Nodes))
    points = np.array([tuple(mesh.Nodes[i]) for i in ids])
    hexes = [mesh.getElementNodes(volume) for volume in mesh.Volumes]
    if any(len(nodes) != 8 for nodes in hexes):
        raise ValueError("the mesh has volumes that are not hexes with 8 nodes")
    # FreeCAD, as SMESH, turns a hex the other way round than VTK.
    session.take(points, np.searchsorted(ids, hexes)[:, [0, 3, 2, 1, 4, 7, 6, 5]].astype(np.int32))
    return session


def fem_mesh_of(mesh):
    """A hextwist.Mesh for FreeCAD: ids of nodes and hexes are those of commands."""
    made = Fem.FemMesh()
    for point, i in zip(mesh.points, mesh.node_ids):
        made.addNode(*map(float, point), int(i))
    for nodes, i in zip(mesh.node_ids[mesh.hexes[:, [0, 3, 2, 1, 4, 7, 6, 5]]], mesh.hex_ids):
        made.addVolume([int(node) for node in nodes], int(i))
    return made


def refine(document, picked, options=""):
    """picked: names such as "Face6" and "Edge5". The mesh of the document becomes the refined one. Returns its session."""
    part, mesh = parts_of(document)
    session = session_of(part.Shape, mesh.FemMesh)
    ids = {kind: " ".join(name[len(prefix):] for name in picked if name.startswith(prefix))
           for prefix, kind in (("Face", "surface"), ("Edge", "curve"), ("Vertex", "vertex"))}
    target = " ".join(f"{kind} {list_}" for kind, list_ in ids.items() if list_)
    session.cmd(f"refine hex in {target} {options}")
    mesh.FemMesh = fem_mesh_of(session.mesh)
    return session


def main():
    if FreeCAD.GuiUp:
        import FreeCADGui

        picked = [name for each in FreeCADGui.Selection.getSelectionEx() for name in each.SubElementNames]
        refine(FreeCAD.ActiveDocument, picked)
        return
    source, target, picked, *options = sys.argv[sys.argv.index("--pass") + 1:]
    document = FreeCAD.openDocument(source)
    session = refine(document, picked.split(), " ".join(options))
    document.saveAs(target)
    print(f"{session.mesh.n_hexes} hexes in {target}")


if __name__ == "__main__" or "--pass" in sys.argv:  # freecadcmd imports what it is to run
    main()
