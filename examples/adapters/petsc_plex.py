"""PETSc's DMPlex and hextwist: petsc_plex.py [CAD MESH]. Serial.

The mesh becomes a DMPlex with the labels "Cell Sets" (volumes of the CAD) and "Face Sets" (its surfaces), is checked by
DMPlexCheck, refined by flags, and becomes a DMPlex again; the prolongation between the two is a Mat."""

import sys

import numpy as np
from petsc4py import PETSc

import hextwist

TO_PLEX = [0, 3, 2, 1, 4, 5, 6, 7]  # DMPlex turns the bottom of a hex so that it is seen from outside; its own inverse


def corners(plex, point):
    """The nodes of a cell or a face, as positions from 0."""
    vertices, end = plex.getDepthStratum(0)
    return [p - vertices for p in plex.getTransitiveClosure(point)[0] if vertices <= p < end]


def plex_of(mesh):
    """A DMPlex whose cells are the hexes and whose vertices, from vStart on, are the nodes, both in their order."""
    options = PETSc.Options()
    options["dm_plex_check_all"] = None  # symmetry, skeleton, faces, geometry: raises where one is wrong
    plex = PETSc.DMPlex().createFromCellList(3, mesh.hexes[:, TO_PLEX], mesh.points, comm=PETSc.COMM_SELF)
    plex.setFromOptions()
    options.delValue("dm_plex_check_all")
    cells, faces = plex.getHeightStratum(0), plex.getHeightStratum(1)
    quads = np.array([corners(plex, face) for face in range(*faces)], dtype=np.int32)
    for name, first, values in (("Cell Sets", cells[0], mesh.hex_volumes), ("Face Sets", faces[0], mesh.surfaces_of(quads))):
        plex.createLabel(name)
        for i in np.flatnonzero(values):
            plex.setLabelValue(name, first + i, int(values[i]))
    return plex


def take(session, plex):
    """Makes a DMPlex of hexes the mesh of the session, on its CAD, with what its labels say of surfaces and volumes."""
    cells = plex.getHeightStratum(0)
    hexes = np.array([corners(plex, cell) for cell in range(*cells)], dtype=np.int32)[:, TO_PLEX]
    points = plex.getCoordinatesLocal().array.reshape(-1, 3)
    quads, surfaces = [], []
    for surface in plex.getLabelIdIS("Face Sets").indices:
        for face in plex.getStratumIS("Face Sets", surface).indices:
            quads.append(corners(plex, face))
            surfaces.append(surface)
    volumes = [plex.getLabelValue("Cell Sets", cell) for cell in range(*cells)]
    session.take(points, hexes, surface_quads=np.array(quads, dtype=np.int32), hex_volumes=np.array(volumes, dtype=np.int32),
                 quad_surfaces=np.array(surfaces, dtype=np.int32))


def prolongation(before, after, origin=None):
    """Values at the nodes of one mesh to those of the other, as a sparse Mat."""
    data, columns, first = before.prolongation(after, origin)
    return PETSc.Mat().createAIJ((after.n_nodes, before.n_nodes), csr=(first.astype(PETSc.IntType), columns, data),
                                 comm=PETSc.COMM_SELF)


def main(cad=None, mesh=None):
    session = hextwist.Session(notice=lambda line: print("note:", line))
    if cad:
        session.import_cad(cad)
        session.import_mesh(mesh)
    else:
        session.cmd("create brick x 3 y 3 z 3 interval 3 3 3")
    take(session, plex_of(session.mesh))  # there and back: the same mesh
    before = session.mesh
    flags = before.quality("volume") > np.median(before.quality("volume")) * 0.999
    flags[len(flags) // 4:] = False
    origin = session.adapt(flags)
    after = session.mesh
    plex = plex_of(after)
    assert plex.getLabelSize("Face Sets") == before.n_entities("surface")
    volume = sum(plex.computeCellGeometryFVM(cell)[0] for cell in range(*plex.getHeightStratum(0)))
    assert abs(volume / after.quality("volume").sum() - 1) < 1e-3, volume  # of bent hexes PETSc's is another one
    linear = lambda points: PETSc.Vec().createWithArray(points @ [1.0, -2.0, 3.0] + 4, comm=PETSc.COMM_SELF)
    to = prolongation(before, after, origin).createVecLeft()
    prolongation(before, after, origin).mult(linear(before.points), to)
    error = np.abs(to.array - linear(after.points).array).max()
    assert error < 1e-9 * np.abs(to.array).max(), error
    print(f"{before.n_hexes} -> {after.n_hexes} hexes; DMPlexCheck finds nothing; a linear function off by {error:.1e}")


if __name__ == "__main__":
    main(*sys.argv[1:])
