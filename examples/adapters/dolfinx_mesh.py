"""DOLFINx and hextwist: dolfinx_mesh.py [CAD MESH]. One process; DOLFINx 0.5.

A mesh goes over with tags of cells (volumes of the CAD) and facets (its surfaces), is refined where a function is steep, and
comes back; the function goes along by the prolongation matrix."""

import sys

import dolfinx
import numpy as np
import ufl
from dolfinx.fem import Constant, Function, FunctionSpace, assemble_scalar, form
from mpi4py import MPI

import hextwist

TO_VTK = [0, 1, 3, 2, 4, 5, 7, 6]  # DOLFINx numbers corners as hextwist's bit_hexes


def to_dolfinx(mesh):
    """A dolfinx mesh of a hextwist.Mesh, with cell tags (volumes) and facet tags (surfaces)."""
    element = ufl.Mesh(ufl.VectorElement("Lagrange", "hexahedron", 1))
    domain = dolfinx.mesh.create_mesh(MPI.COMM_SELF, mesh.bit_hexes.astype(np.int64), np.array(mesh.points), element)
    cells = np.arange(mesh.n_hexes, dtype=np.int32)
    volumes = mesh.hex_volumes[domain.topology.original_cell_index]
    domain.topology.create_connectivity(2, 3)
    domain.topology.create_connectivity(2, 0)
    domain.topology.create_connectivity(3, 2)
    facets = np.arange(domain.topology.index_map(2).size_local, dtype=np.int32)
    nodes = dolfinx.cpp.mesh.entities_to_geometry(domain._mesh, 2, facets, False)
    surfaces = mesh.surfaces_of(np.array(domain.geometry.input_global_indices)[nodes])
    on = surfaces > 0
    return (domain, dolfinx.mesh.meshtags(domain, 3, cells, volumes.astype(np.int32)),
            dolfinx.mesh.meshtags(domain, 2, facets[on], surfaces[on]))


def take(session, domain, cell_tags, facet_tags):
    """Makes a dolfinx mesh of hexes, with tags as above, the mesh of the session, on its CAD."""
    hexes = domain.geometry.dofmap.array.reshape(-1, 8)[:, TO_VTK]
    volumes = np.zeros(len(hexes), dtype=np.int32)
    volumes[cell_tags.indices] = cell_tags.values
    domain.topology.create_connectivity(2, 3)
    domain.topology.create_connectivity(3, 2)
    quads = dolfinx.cpp.mesh.entities_to_geometry(domain._mesh, 2, facet_tags.indices, False)[:, [0, 1, 3, 2]]
    session.take(domain.geometry.x, hexes, hex_volumes=volumes, surface_quads=quads, quad_surfaces=facet_tags.values)


def nodal_values(function, mesh):
    """A function of first order, by the nodes of the hextwist.Mesh that its own was made of."""
    domain = function.function_space.mesh
    values = np.zeros(mesh.n_nodes)
    nodes = np.array(domain.geometry.input_global_indices)[domain.geometry.dofmap.array]
    values[nodes] = function.x.array[function.function_space.dofmap.list.array]
    return values


def function_of(values, domain):
    """The other way round."""
    function = Function(FunctionSpace(domain, ("CG", 1)))
    nodes = np.array(domain.geometry.input_global_indices)[domain.geometry.dofmap.array]
    function.x.array[function.function_space.dofmap.list.array] = values[nodes]
    return function


def main(cad=None, mesh=None):
    session = hextwist.Session(notice=lambda line: print("note:", line))
    if cad:
        session.import_cad(cad)
        session.import_mesh(mesh)
    else:
        session.cmd("create brick x 3 y 3 z 3 interval 3 3 3")
    take(session, *to_dolfinx(session.mesh))  # there and back
    before = session.mesh
    domain, _, _ = to_dolfinx(before)
    u = Function(FunctionSpace(domain, ("CG", 1)))
    u.interpolate(lambda x: 2 * x[0] - x[1] + 3 * x[2] + 1)
    values = nodal_values(u, before)
    origin = session.adapt(np.arange(before.n_hexes) % 7 == 0)
    after = session.mesh
    data, columns, first = before.prolongation(after, origin)
    moved = np.add.reduceat(data * values[columns], first[:-1])
    domain, cell_tags, facet_tags = to_dolfinx(after)
    v = function_of(moved, domain)
    x = ufl.SpatialCoordinate(domain)
    off = assemble_scalar(form(abs(v - (2 * x[0] - x[1] + 3 * x[2] + 1)) * ufl.dx))
    volume = assemble_scalar(form(Constant(domain, 1.0) * ufl.dx))
    assert off < 1e-9 * volume, off
    assert abs(volume / after.quality("volume").sum() - 1) < 1e-9, volume
    assert set(facet_tags.values) == set(after.quad_surfaces) and len(cell_tags.values) == after.n_hexes
    print(f"{before.n_hexes} -> {after.n_hexes} hexes, {len(facet_tags.values)} facets tagged; a linear function off by {off:.1e}")


if __name__ == "__main__":
    main(*sys.argv[1:])
