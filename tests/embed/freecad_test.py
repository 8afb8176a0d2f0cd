"""Run by freecadcmd: a document with the bracket and its mesh goes through the macro, face and edge picked by name; what
comes back is the mesh that the same command makes without FreeCAD. Prints 'freecad: fine' at its end: freecadcmd's own
status says nothing."""

import os
import sys
import traceback

import numpy as np

ROOT = os.environ["HEXTWIST_SOURCE"]
sys.path.insert(0, os.path.join(ROOT, "examples/adapters/freecad"))

import FreeCAD  # noqa: E402
import Part  # noqa: E402

import hextwist  # noqa: E402
import refine_part as macro  # noqa: E402


def main():
    alone = hextwist.Session()
    alone.import_cad(os.path.join(ROOT, "models/bracket.brep"))
    alone.import_mesh(os.path.join(ROOT, "models/bracket.msh"))
    document = FreeCAD.newDocument("bracket")
    part = document.addObject("Part::Feature", "Bracket")
    part.Shape = Part.read(os.path.join(ROOT, "models/bracket.brep"))
    document.addObject("Fem::FemMeshObject", "Mesh").FemMesh = macro.fem_mesh_of(alone.mesh)
    document.recompute()
    path = os.path.join(os.environ["HEXTWIST_OUTPUT"], "freecad.FCStd")
    document.saveAs(path)
    FreeCAD.closeDocument("bracket")

    document = FreeCAD.openDocument(path)
    part, mesh = macro.parts_of(document)
    # Faces and edges by FreeCAD's numbers are surfaces and curves by ours.
    for kind, shapes, measure in (("surface", part.Shape.Faces, "Area"), ("curve", part.Shape.Edges, "Length")):
        assert len(shapes) == alone.mesh.n_entities(kind)
        for i, shape in enumerate(shapes, 1):
            assert abs(alone.mesh.entity(kind, i)["measure"] - getattr(shape, measure)) < 1e-6, (kind, i)
    session = macro.refine(document, ["Face6", "Edge5"], "numsplit 1")
    alone.cmd("refine hex in surface 6 curve 5")
    assert np.allclose(session.mesh.points, alone.mesh.points, rtol=0, atol=1e-9)
    assert np.array_equal(session.mesh.hexes, alone.mesh.hexes)
    document.save()
    FreeCAD.closeDocument(document.Name)
    document = FreeCAD.openDocument(path)
    fem = macro.parts_of(document)[1].FemMesh
    assert fem.VolumeCount == alone.mesh.n_hexes and fem.NodeCount == alone.mesh.n_nodes
    # FreeCAD's own writer of Abaqus files knows which way round a hex is.
    notices = []
    judge = hextwist.Session(notice=notices.append)
    written = os.path.join(os.environ["HEXTWIST_OUTPUT"], "freecad.inp")
    fem.write(written)
    judge.import_mesh(written)
    assert not any("inside out" in line for line in notices), notices
    assert abs(judge.mesh.quality("volume").sum() / alone.mesh.quality("volume").sum() - 1) < 1e-6
    again = macro.session_of(macro.parts_of(document)[0].Shape, fem)
    assert again.mesh.n_hexes == alone.mesh.n_hexes
    try:
        macro.refine(document, ["Face99"])
        raise AssertionError("a face that does not exist was refined")
    except hextwist.Error as error:
        assert "99" in str(error)
    print("freecad: fine")


try:
    main()
except BaseException:
    traceback.print_exc()
sys.stdout.flush()
os._exit(0)
