"""A front moves through a mesh, and the refinement with it: moving_front.py [levels [steps [picture.png]]]

The front is a sphere of radius 2.2 in a grid of 10 x 10 x 10. A solver would say which hexes need to be finer and which
may be coarser; here those are the ones that the sphere meets, and all others."""

import sys

import numpy as np

import hextwist

RADIUS = 2.2


def meets(mesh, centre):
    """Per hex: does the sphere pass between its corners?"""
    outside = (np.linalg.norm(mesh.points - centre, axis=1) > RADIUS)[mesh.hexes]
    return outside.any(axis=1) & ~outside.all(axis=1)


def follow(session, centre, levels):
    """Finer where the front is, coarser where it is not: by one level a call."""
    for _ in range(levels + 1):
        mesh = session.mesh
        level = mesh.hex_fields.get("level", np.zeros(mesh.n_hexes))
        at_front = meets(mesh, centre)
        kind, first, hexes = session.adapt_levels(np.where(at_front, level < levels, -1))
        # What a solver knew per hex goes over: same and finer copy it, coarser take the average of
        # hexes[first[h]:first[h + 1]]. (Fields of the mesh itself have done so already.)
        if (kind == 0).all():
            return


def main(levels=2, steps=10, picture=None):
    session = hextwist.Session()
    session.cmd("create brick x 10 interval 10")
    for step in range(steps):
        follow(session, np.array([-5 + 10 * step / max(1, steps - 1), -5.0, 0.3]), levels)
        mesh = session.mesh
        print(f"step {step}: {mesh.n_hexes} hexes, smallest scaled Jacobian {mesh.quality('scaled jacobian').min():.3f}")
        if picture:
            session.cmd(f"draw from 0.2 -1 0.3 pixels 500 420 to '{picture.replace('.png', f'_{step}.png')}' overwrite")
    session.cmd("coarsen hex all levels 9")
    print(f"coarsened: {session.mesh.n_hexes} hexes")


if __name__ == "__main__":
    try:
        main(*map(int, sys.argv[1:3]), *sys.argv[3:])
    except hextwist.Error as error:
        sys.exit(str(error))
