"""Gmsh refining, writing and reading a million hexes. Prints "name CPU-seconds items"."""
import os
import sys
import time

import gmsh


def box(n):
    gmsh.clear()
    gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
    gmsh.model.occ.synchronize()
    for _, curve in gmsh.model.getEntities(1):
        gmsh.model.mesh.setTransfiniteCurve(curve, n + 1)
    for _, surface in gmsh.model.getEntities(2):
        gmsh.model.mesh.setTransfiniteSurface(surface)
        gmsh.model.mesh.setRecombine(2, surface)
    for _, volume in gmsh.model.getEntities(3):
        gmsh.model.mesh.setTransfiniteVolume(volume)
    gmsh.model.mesh.generate(3)


def n_hexes():
    return sum(len(tags) for tags in gmsh.model.mesh.getElements(3)[1])


def report(name, action, prepare=lambda: None, times=3):
    """The best of so many times; prepare() is not measured."""
    best = float("inf")
    for _ in range(times):
        prepare()
        start = time.process_time()
        action()
        best = min(best, time.process_time() - start)
    print(name, best, n_hexes(), flush=True)


def main(folder):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.option.setNumber("Mesh.Binary", 1)
    file = os.path.join(folder, "peer.msh")
    box(50)
    report("gmsh_refine", gmsh.model.mesh.refine, times=1)
    box(100)
    report("gmsh_write", lambda: gmsh.write(file))
    report("gmsh_read", lambda: gmsh.open(file), prepare=gmsh.clear)
    gmsh.finalize()
    os.remove(file)


main(sys.argv[1])
