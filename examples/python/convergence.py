"""Refine where it matters, again and again, as an adaptive analysis does: convergence.py part.brep part.msh out.vtu

The "error" here is made up: large near vertex 1. A solver would compute it, hex by hex."""

import sys

import numpy as np

import hextwist


def main(cad, mesh, output):
    session = hextwist.Session(notice=lambda line: print("note:", line))
    session.import_cad(cad)
    session.import_mesh(mesh)
    corner = np.array(session.mesh.entity("vertex", 1)["box"][0])
    for step in range(3):
        mesh = session.mesh
        middles = mesh.points[mesh.hexes].mean(axis=1)
        sizes = np.abs(np.linalg.det(mesh.points[mesh.hexes[:, [1, 3, 4]]] - mesh.points[mesh.hexes[:, :1]]))
        error = sizes / (1 + np.linalg.norm(middles - corner, axis=1)) ** 2
        flags = error >= np.quantile(error, 0.98)
        origin = session.adapt(flags)
        # What a solver knew per hex goes over to the children: solution = solution[origin]
        print(f"step {step + 1}: {flags.sum()} of {mesh.n_hexes} hexes cut, {len(origin)} now, "
              f"smallest shape {session.mesh.quality('shape').min():.3f}")
    session.export_mesh(output)


if __name__ == "__main__":
    try:
        main(*sys.argv[1:])
    except hextwist.Error as error:
        sys.exit(str(error))
