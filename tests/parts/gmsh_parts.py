"""Gmsh on the other side of split meshes.

    gmsh_parts.py divide WHOLE N NAME   NAME_1.msh, ... by Gmsh itself, with what lies between partitions, and with ghosts
    gmsh_parts.py count PART ...        what Gmsh finds in parts: nodes by id, hexes, hexes of each volume group, partitions
"""

import sys

import gmsh

gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
if sys.argv[1] == "divide":
    whole, n, name = sys.argv[2], int(sys.argv[3]), sys.argv[4]
    for ghosts in (0, 1):
        for binary in (0, 1):
            gmsh.clear()
            gmsh.open(whole)
            gmsh.option.setNumber("Mesh.PartitionCreateTopology", 1)
            gmsh.option.setNumber("Mesh.PartitionCreateGhostCells", ghosts)
            gmsh.option.setNumber("Mesh.PartitionSplitMeshFiles", 1)
            gmsh.option.setNumber("Mesh.Binary", binary)
            gmsh.model.mesh.partition(n)
            gmsh.write("%s%d%d.msh" % (name, ghosts, binary))
else:
    gmsh.open(sys.argv[2])
    for part in sys.argv[3:]:
        gmsh.merge(part)
    nodes, hexes = set(gmsh.model.mesh.getNodes()[0]), []
    for tags in gmsh.model.mesh.getElements(3)[1]:
        hexes += list(tags)
    beside = []
    for dim in range(3):
        for tags in gmsh.model.mesh.getElements(dim)[1]:
            beside += list(tags)
    print(len(nodes), len(hexes), len(set(hexes)), len(beside), len(set(beside)))
    for _, group in sorted(gmsh.model.getPhysicalGroups(3)):
        n = 0
        for entity in gmsh.model.getEntitiesForPhysicalGroup(3, group):
            n += sum(len(tags) for tags in gmsh.model.mesh.getElements(3, entity)[1])
        print(group, n)
    partitions = set()
    for dim, entity in gmsh.model.getEntities(3):
        if gmsh.model.mesh.getElements(dim, entity)[1]:
            partitions.add(tuple(gmsh.model.getPartitions(dim, entity)))
    print(*sorted(p for one in partitions for p in one))
