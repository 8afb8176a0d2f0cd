"""The sheets of an all-hex mesh (all hexes between two opposite sides, and on to theirs) and which of them to cut.

A sheet that is cut costs no transition, leaves angles as they are and refines in one direction only: where the solution varies
in one direction, or the edge of a singularity is straight, that is what it takes."""
import numpy as np

import elasticity

ALONG = np.array([[(0, 1), (3, 2), (4, 5), (7, 6)], [(0, 3), (1, 2), (4, 7), (5, 6)], [(0, 4), (1, 5), (2, 6), (3, 7)]])


def sheets(hexes):
    """Per hex and direction the number of the sheet that is cut there, and per sheet one of its edges: two nodes."""
    ends = np.sort(hexes[:, ALONG].reshape(-1, 2), axis=1)  # hexes, directions, 4 edges
    edges, index = np.unique(ends, axis=0, return_inverse=True)
    index = index.reshape(-1, 4)
    label = np.arange(len(edges))
    while True:  # the smallest label spreads: opposite edges, and labels of labels
        least = label[index].min(axis=1)
        before = label.copy()
        np.minimum.at(label, index.ravel(), np.repeat(least, 4))
        label = label[label]
        if (label == before).all():
            break
    names, label = np.unique(label, return_inverse=True)
    return label[index[:, 0]].reshape(-1, 3), edges[names]


def errors_along(points, hexes, stresses, smooth):
    """The square of each hex's error in parts: what varies along its first, second and third direction."""
    weights = elasticity.volumes_at_points(points[hexes])
    off = np.einsum("pc,hcs->hps", elasticity.SHAPES, smooth[hexes]) - stresses
    off = off.reshape(len(hexes), 2, 2, 2, 6)  # third, second, first direction
    parts = []
    for axis in (3, 2, 1):
        odd = ((off - np.flip(off, axis)) / 2).reshape(len(hexes), 8, 6)
        parts.append(np.einsum("hp,hps,st,hpt->h", weights, odd, elasticity.COMPLIANCE, odd))
    return np.stack(parts, axis=1)


def errors_of_shape(mesh, smooth):
    """The same of straight edges on a curved boundary: the energy in what lies between the edges and the CAD."""
    parts = np.zeros((len(mesh.hexes), 3))
    for surface in np.unique(mesh.quad_surfaces):
        chosen = mesh.quad_surfaces == surface
        quads, hexes = mesh.surface_quads[chosen], mesh.surface_sides[chosen, 0]
        p = mesh.points[quads]
        area = np.linalg.norm(np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1]), axis=1) / 2
        density = np.einsum("qcs,st,qct->q", smooth[quads], elasticity.COMPLIANCE, smooth[quads]) / 4
        middles = (p + np.roll(p, -1, axis=1)) / 2
        off = mesh.closest("surface", int(surface), middles.reshape(-1, 3))[2].reshape(-1, 4)
        corners = mesh.hexes[hexes]
        for side in range(4):
            ends = np.sort(quads[:, [side, (side + 1) % 4]], axis=1)
            for k in range(3):
                along = (np.sort(corners[:, ALONG[k]], axis=2) == ends[:, None]).all(axis=2).any(axis=1)
                np.add.at(parts[:, k], hexes[along], (density * area * off[:, side])[along] / 3)  # two thirds, two edges
    return parts


def sheets_to_cut(hexes, parts, share):
    """Edges, one a sheet, of those sheets that gain most for each new hex, until they have this share of all that can be gained."""
    sheet, edges = sheets(hexes)
    gain = np.bincount(sheet.ravel(), parts.ravel(), len(edges))
    cost = np.bincount(sheet.ravel(), minlength=len(edges))
    order = np.argsort(-gain / cost)
    n = np.searchsorted(np.cumsum(gain[order]), share * gain.sum()) + 1
    return edges[order[:n]]
