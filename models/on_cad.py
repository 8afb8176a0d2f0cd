"""Puts a hex mesh on the CAD that is current in Gmsh: classifies its skin, moves it on exactly, checks, writes."""
import gmsh
import numpy as np

from hexes import FACES, corner_jacobians

NEAR = 1e-6  # relative to the model size: a node this near an entity lies on it


class Skin:
    """Faces with one hex, and faces between two parts."""

    def __init__(self, hexes, part):
        quads = hexes[:, FACES].reshape(-1, 4)
        owner = np.repeat(np.arange(len(hexes)), 6)
        order = np.lexsort(np.sort(quads, axis=1).T[::-1])
        same = np.all(np.sort(quads[order[1:]], axis=1) == np.sort(quads[order[:-1]], axis=1), axis=1)
        assert not np.any(same[1:] & same[:-1]), "a face with more than two hexes"
        keep = np.ones(len(order), bool)
        keep[1:][same] = False
        inside = np.append(same, False) & (part[owner[order]] == np.append(part[owner[order[1:]]], -1))
        keep &= ~inside
        self.quads = quads[np.sort(order[keep])]
        self.parts = part[owner[np.sort(order[keep])]]


def box(dim, tag):
    return np.array(gmsh.model.getBoundingBox(dim, tag)).reshape(2, 3)


def size():
    low, high = box(-1, -1)
    return np.linalg.norm(high - low)


def closest(dim, tag, points):
    """Closest points on the entity and distances."""
    if dim == 0:
        on = np.tile(gmsh.model.getValue(0, tag, []), (len(points), 1))
    else:
        on = np.array(gmsh.model.getClosestPoint(dim, tag, points.ravel())[0]).reshape(-1, 3)
    return on, np.linalg.norm(on - points, axis=1)


def nodes_on(dim, tag, points, nodes):
    """Those of `nodes` that lie on the entity (and in its box: Gmsh does not look at trimming)."""
    low, high = box(dim, tag)
    near, loose = NEAR * size(), 1e-3 * size()
    nodes = nodes[np.all((points[nodes] > low - loose) & (points[nodes] < high + loose), axis=1)]
    return nodes[closest(dim, tag, points[nodes])[1] < near] if len(nodes) else nodes


def degenerate(curve):
    low, high = box(1, curve)
    return np.linalg.norm(high - low) < NEAR * size()


def classify(points, hexes, part):
    """Owner (dim, tag) of every node, curve edges and surface quads of the mesh, and the nodes moved exactly on.

    part k of an assembly is the k-th volume, by tag. Every entity of the CAD must be covered by the mesh.
    """
    skin = Skin(hexes, part)
    on_skin = np.unique(skin.quads)
    tags = {dim: [tag for _, tag in gmsh.model.getEntities(dim)] for dim in range(4)}

    # Surfaces: the one that all four corners lie on; of several, the one nearest to the middle.
    surface = np.zeros(len(skin.quads), int)
    best = np.full(len(skin.quads), np.inf)
    middle = points[skin.quads].mean(axis=1)
    for tag in tags[2]:
        on = np.zeros(len(points), bool)
        on[nodes_on(2, tag, points, on_skin)] = True
        candidates = np.flatnonzero(on[skin.quads].all(axis=1))
        if len(candidates):
            distance = closest(2, tag, middle[candidates])[1]
            better = distance < best[candidates]
            surface[candidates[better]], best[candidates[better]] = tag, distance[better]
    assert surface.all(), f"{(surface == 0).sum()} skin quads on no surface, first at {middle[surface == 0][0]}"
    assert set(surface) == set(tags[2]), f"surfaces without quads: {set(tags[2]) - set(surface)}"

    # Curves: mesh edges of the skin whose ends and middle are near one that bounds the surfaces around.
    edges = np.sort(np.stack([skin.quads, np.roll(skin.quads, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    edge_surfaces = {}
    for (a, b), s in zip(edges.tolist(), np.repeat(surface, 4).tolist()):
        edge_surfaces.setdefault((a, b), set()).add(s)
    edges = np.array(sorted(edge_surfaces))
    curve_edges, moved = [], points.copy()
    node_curve = {}
    for tag in tags[1]:
        if degenerate(tag):
            continue
        bounded = set(gmsh.model.getAdjacencies(1, tag)[0].tolist())
        on = np.zeros(len(points), bool)
        on[nodes_on(1, tag, points, on_skin)] = True
        mine = edges[on[edges].all(axis=1)]
        mine = mine[[edge_surfaces[tuple(e)] <= bounded for e in mine.tolist()]]
        length = np.linalg.norm(points[mine[:, 0]] - points[mine[:, 1]], axis=1)
        mine = mine[closest(1, tag, points[mine].mean(axis=1))[1] < 0.2 * length] if len(mine) else mine
        assert len(mine), f"no mesh edge on curve {tag}"
        total = np.linalg.norm(points[mine[:, 0]] - points[mine[:, 1]], axis=1).sum()
        assert 0.97 < total / gmsh.model.occ.getMass(1, tag) < 1 + 1e-9, f"curve {tag} is not covered once"
        curve_edges += [(tag, a, b) for a, b in mine.tolist()]
        nodes = np.unique(mine)
        moved[nodes] = closest(1, tag, points[nodes])[0]
        node_curve.update(dict.fromkeys(nodes.tolist(), tag))
    curves_on = {(a, b) for _, a, b in curve_edges}
    for edge, around in edge_surfaces.items():
        assert len(around) == 1 or edge in curves_on, f"edge {edge} between surfaces {around} is on no curve"

    owner = np.zeros((len(points), 2), int)
    owner[np.unique(hexes[part == 0])] = (3, tags[3][0])
    for k in range(1, len(tags[3])):
        owner[np.unique(hexes[part == k])] = (3, tags[3][k])
    for tag in tags[2]:
        nodes = np.unique(skin.quads[surface == tag])
        owner[nodes] = (2, tag)
        nodes = np.array([n for n in nodes.tolist() if n not in node_curve], int)
        if len(nodes):
            moved[nodes] = closest(2, tag, points[nodes])[0]
    for node, tag in node_curve.items():
        owner[node] = (1, tag)
    for tag in tags[0]:
        nodes = nodes_on(0, tag, points, on_skin)
        assert len(nodes) == 1, f"vertex {tag} has {len(nodes)} nodes"
        owner[nodes[0]] = (0, tag)
        moved[nodes[0]] = gmsh.model.getValue(0, tag, [])
    assert np.abs(moved - points).max() < NEAR * size(), "the mesh is not where it was said to be"
    assert corner_jacobians(moved, hexes).min() > 0, "inverted hex"
    return moved, owner, curve_edges, list(zip(surface.tolist(), skin.quads.tolist()))


def write(path, mesh, binary):
    """Classifies the mesh on the current CAD and writes it. Returns the points as written."""
    points, hexes, part = mesh
    points, owner, curve_edges, surface_quads = classify(points, hexes, part)
    node_tag = 0
    tag_of = np.zeros(len(points), np.int64)
    for dim, tag in gmsh.model.getEntities():
        nodes = np.flatnonzero((owner[:, 0] == dim) & (owner[:, 1] == tag))
        tag_of[nodes] = node_tag + 1 + np.arange(len(nodes))
        node_tag += len(nodes)
        if len(nodes):
            gmsh.model.mesh.addNodes(dim, tag, tag_of[nodes], points[nodes].ravel())
    element = 0

    def add(dim, tag, kind, nodes):
        nonlocal element
        nodes = np.asarray(nodes)
        if len(nodes):
            gmsh.model.mesh.addElementsByType(tag, kind, element + 1 + np.arange(len(nodes)), tag_of[nodes].ravel())
            element += len(nodes)

    # Hexes first, so that they are hex 1, 2, ... in commands.
    for k, (_, tag) in enumerate(gmsh.model.getEntities(3)):
        add(3, tag, 5, hexes[part == k])
    for _, tag in gmsh.model.getEntities(0):
        add(0, tag, 15, np.flatnonzero((owner[:, 0] == 0) & (owner[:, 1] == tag))[:, None])
    for _, tag in gmsh.model.getEntities(1):
        add(1, tag, 1, [(a, b) for t, a, b in curve_edges if t == tag])
    for _, tag in gmsh.model.getEntities(2):
        add(2, tag, 3, [quad for t, quad in surface_quads if t == tag])
    gmsh.option.setNumber("Mesh.SaveAll", 1)
    gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
    gmsh.option.setNumber("Mesh.Binary", int(binary))
    gmsh.write(str(path))
    return points
