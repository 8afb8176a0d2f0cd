"""A plate with a hole, made and meshed by Gmsh and refined at the hole: plate.py OUTPUT.msh"""

import math
import sys

import gmsh

import hextwist.gmsh


def make_plate(width, height, thickness, radius):
    """Four sweeps of four-sided faces around the hole; returns the surfaces of the hole."""
    occ = gmsh.model.occ
    centre = occ.addPoint(0, 0, 0)
    signs = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    inner = [occ.addPoint(x * radius / math.sqrt(2), y * radius / math.sqrt(2), 0) for x, y in signs]
    outer = [occ.addPoint(x * width / 2, y * height / 2, 0) for x, y in signs]
    arcs = [occ.addCircleArc(inner[i], centre, inner[(i + 1) % 4]) for i in range(4)]
    rims = [occ.addLine(outer[i], outer[(i + 1) % 4]) for i in range(4)]
    spokes = [occ.addLine(inner[i], outer[i]) for i in range(4)]
    loops = [occ.addCurveLoop([arcs[i], spokes[(i + 1) % 4], -rims[i], -spokes[i]]) for i in range(4)]
    occ.extrude([(2, occ.addPlaneSurface([loop])) for loop in loops], 0, 0, thickness, [2], recombine=True)
    occ.remove([(0, centre)])
    occ.synchronize()
    return [tag for _, tag in gmsh.model.getEntities(2) if gmsh.model.getType(2, tag) == "Cylinder"]


def main(output):
    gmsh.initialize()
    gmsh.option.setNumber("General.Verbosity", 2)
    hole = make_plate(100, 60, 10, 15)
    for dim, tag in gmsh.model.getEntities():
        if dim == 1:
            gmsh.model.mesh.setTransfiniteCurve(tag, 9)
        elif dim == 2:
            gmsh.model.mesh.setTransfiniteSurface(tag)
            gmsh.model.mesh.setRecombine(2, tag)
        elif dim == 3:
            gmsh.model.mesh.setTransfiniteVolume(tag)
    gmsh.model.mesh.generate(3)
    gmsh.model.setPhysicalName(2, gmsh.model.addPhysicalGroup(2, hole), "hole")

    # Surfaces by their tags in Gmsh, or by the physical group, which is a side set here.
    hextwist.gmsh.refine("surface " + " ".join(map(str, hole)) + " size 1.5 bias 1.5", output=print)
    hextwist.gmsh.refine("smooth hex in face in sideset 'hole'", output=print)
    gmsh.write(output)
    gmsh.finalize()


if __name__ == "__main__":
    main(*sys.argv[1:])
