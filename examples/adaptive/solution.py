"""A case solved on the mesh of a session."""
import re

import numpy as np

import elasticity
import indicator
import sheets


class Solution:
    """n_unknowns, energy (twice the work of the forces), error (per hex), parts (its square by direction), estimate, peak, scaled_jacobian."""


def second_order(session, folder):
    """Points and hexes of 20 nodes, middle nodes on the CAD; and the middle between two corners."""
    file = folder / "second_order.inp"
    session.cmd(f"export abaqus '{file}' order 2 overwrite")
    nodes, rows, section = {}, [], ""
    for line in file.read_text().splitlines():
        if line.startswith("*"):
            section = re.sub(r"[, ].*", "", line.upper())
        elif section == "*NODE":
            words = line.split(",")
            nodes[int(words[0])] = [float(w) for w in words[1:4]]
        elif section == "*ELEMENT":
            rows += [int(w) for w in line.split(",") if w.strip()]
    ids = np.array(sorted(nodes))
    hexes = np.searchsorted(ids, np.array(rows).reshape(-1, 21)[:, 1:])
    ends = np.array([(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)])
    pairs = np.sort(hexes[:, ends].reshape(-1, 2), axis=1)
    return np.array([nodes[i] for i in ids]), hexes, dict(zip(map(tuple, pairs.tolist()), hexes[:, 8:].ravel().tolist()))


def solve(session, case, folder, order=1):
    folder.mkdir(parents=True, exist_ok=True)
    mesh, points, hexes = session.mesh, session.mesh.points, session.mesh.hexes
    quads_of = {s: mesh.surface_quads[mesh.quad_surfaces == s] for s in np.unique(mesh.quad_surfaces)}
    if order == 2:
        # Corners come first, in the order of the mesh, as middle nodes have the ids behind the highest corner's.
        points, hexes, middle = second_order(session, folder)
        assert np.allclose(points[:len(mesh.points)], mesh.points)
        quads_of = {s: np.array([[*q, *(middle[tuple(sorted((q[i], q[(i + 1) % 4])))] for i in range(4))] for q in quads.tolist()])
                    for s, quads in quads_of.items()}
    index = {int(i): n for n, i in enumerate(mesh.node_ids)}
    fixed = set()
    for kind, entity, directions in case.fixed:
        nodes = np.unique(quads_of[entity]) if kind == "surface" else [index[int(i)] for i in session.nodes_of(kind, entity)]
        fixed |= {(int(n), k) for n in nodes for k in directions}
    forces = elasticity.forces_of_traction(points, quads_of[case.pulled], case.traction)
    u, stresses = elasticity.calculix(elasticity.mesh_cards(points, hexes) + elasticity.job(fixed, forces), folder)
    result = Solution()
    result.n_unknowns, result.n_hexes = 3 * len(points) - len(fixed), len(hexes)
    result.energy = float((forces * u).sum())
    result.scaled_jacobian = float(mesh.quality("scaled jacobian").min())
    corners, cells = mesh.points, hexes[:, :8]
    on_skin = mesh.node_owners[:, 0] < 3
    result.peak = None
    if case.peak:
        at_peak = np.unique(quads_of[case.peak][:, :4])
        there = indicator.recovered(corners, cells, stresses, on_skin, "gauss" if order == 2 else True, at_peak)
        result.peak = float(indicator.largest_principal(there).max())
    if order == 1:
        smooth = indicator.recovered(corners, cells, stresses, on_skin)
        result.error, energy = indicator.errors(corners, cells, stresses, smooth)
        result.parts = sheets.errors_along(corners, cells, stresses, smooth) + sheets.errors_of_shape(mesh, smooth)
        result.estimate = float(np.sqrt((result.error**2).sum() / energy))
    return result
