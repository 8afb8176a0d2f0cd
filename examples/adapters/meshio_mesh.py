"""meshio and hextwist: a mesh of any format that meshio reads, refined, as a meshio.Mesh again: meshio_mesh.py [OUT [IN [COMMANDS]]]

Blocks come from, and go to, the cell data "block"; nodal and hex fields are point and cell data. Node and side sets, which
meshio's mesh has no place for, stay in the session."""

import sys

import meshio
import numpy as np

import hextwist


def take(session, mesh):
    """Makes a meshio.Mesh the mesh of the session. Cells other than hexes with 8 nodes are left out, volumes are refused."""
    for cells in mesh.cells:
        if cells.type != "hexahedron" and cells.dim == 3:
            raise ValueError(f"{len(cells)} cells are of type {cells.type}, not hexahedron")
    kept = [i for i, cells in enumerate(mesh.cells) if cells.type == "hexahedron"]
    if not kept:
        raise ValueError("there are no cells of type hexahedron")
    hexes = np.concatenate([mesh.cells[i].data for i in kept])
    data = {name: np.concatenate([np.asarray(values[i]) for i in kept]) for name, values in mesh.cell_data.items()}
    block = data.pop("block", None)
    blocks = {} if block is None else {int(k): np.flatnonzero(block == k).astype(np.int32) for k in np.unique(block) if k > 0}
    points = np.zeros((len(mesh.points), 3))
    points[:, : mesh.points.shape[1]] = mesh.points
    session.take(points, hexes.astype(np.int32), blocks=blocks, node_fields=dict(mesh.point_data), hex_fields=data)


def give(mesh):
    """A hextwist.Mesh as a meshio.Mesh. Of a hex in several blocks the last counts; 0: in none."""
    block = np.zeros(mesh.n_hexes, dtype=np.int32)
    for group in mesh.blocks.values():
        block[group.members] = group.id
    cell_data = {name: [np.array(values)] for name, values in mesh.hex_fields.items()}
    return meshio.Mesh(np.array(mesh.points), [("hexahedron", np.array(mesh.hexes))],
                       point_data={name: np.array(values) for name, values in mesh.node_fields.items()},
                       cell_data={**cell_data, "block": [block]})


def main(target="refined.vtu", source=None, commands="refine hex 1"):
    session = hextwist.Session(notice=lambda line: print("note:", line))
    if source:
        take(session, meshio.read(source))
    else:
        session.cmd("create brick x 3 y 3 z 3 interval 3 3 3; block 7 hex 1 to 9")
        session.set_field("height", session.mesh.points[:, 2])
        take(session, give(session.mesh))  # there and back
    before = session.mesh
    session.cmd(commands)
    meshio.write(target, give(session.mesh))
    back = meshio.read(target)  # what was written is what there is
    assert np.array_equal(back.cells_dict["hexahedron"], session.mesh.hexes)
    assert np.allclose(back.points, session.mesh.points, rtol=0, atol=1e-12)
    assert set(back.point_data) == set(session.mesh.node_fields)
    print(f"{before.n_hexes} -> {session.mesh.n_hexes} hexes, written to {target}")


if __name__ == "__main__":
    main(*sys.argv[1:])
