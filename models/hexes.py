"""All-hex meshes from mapped blocks and swept quads: arrays of points and 8-tuples in Gmsh's corner order.

A mesh here is (points, hexes, part): (n, 3) floats, (m, 8) ints, (m,) ints that tell the solids of an assembly apart.
"""
import numpy as np


def grid(n_u, n_v):
    """Quads of an n_u x n_v grid as (uv, quads): uv in [0,1]^2, corners counter-clockwise."""
    u, v = np.meshgrid(np.linspace(0, 1, n_u + 1), np.linspace(0, 1, n_v + 1), indexing="ij")
    at = lambda i, j: (i * (n_v + 1) + j).ravel()
    i, j = np.meshgrid(np.arange(n_u), np.arange(n_v), indexing="ij")
    quads = np.stack([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], axis=1)
    return np.stack([u.ravel(), v.ravel()], axis=1), quads


def patch(n_u, n_v, mapping):
    """Grid mapped to the plane: mapping(u, v) -> (x, y)."""
    uv, quads = grid(n_u, n_v)
    x, y = mapping(uv[:, 0], uv[:, 1])
    return np.stack([x + 0 * uv[:, 0], y + 0 * uv[:, 0]], axis=1), quads


def rectangle(n_u, n_v, x0, x1, y0, y1):
    return patch(n_u, n_v, lambda u, v: (x0 + (x1 - x0) * u, y0 + (y1 - y0) * v))


def between(n_u, n_v, inner, outer, bias=1.0):
    """Patch between two curves: u along them, v from inner to outer; bias > 1 makes it finer at the inner one."""
    def mapping(u, v):
        v = v**bias
        (xa, ya), (xb, yb) = inner(u), outer(u)
        return (1 - v) * xa + v * xb, (1 - v) * ya + v * yb
    return patch(n_u, n_v, mapping)


def arc(x, y, r, degrees0, degrees1):
    a, b = np.radians(degrees0), np.radians(degrees1)
    return lambda u: (x + r * np.cos(a + (b - a) * u), y + r * np.sin(a + (b - a) * u))


def line(a, b):
    return lambda u: (a[0] + (b[0] - a[0]) * u, a[1] + (b[1] - a[1]) * u)


def hole_in_square(n, m, x, y, r, half, bias=1.0, sides="ENWS"):
    """O-grid between a circle and the square around it: n quads along each side, m across. n even puts a node at each
    of the angles 0, 90, 180, 270 degrees, where Gmsh's cylinders have their seams."""
    return merged([between(n, m, arc(x, y, r, angle - 45, angle + 45),
                           line((x + half * np.sqrt(2) * np.cos(np.radians(angle - 45)),
                                 y + half * np.sqrt(2) * np.sin(np.radians(angle - 45))),
                                (x + half * np.sqrt(2) * np.cos(np.radians(angle + 45)),
                                 y + half * np.sqrt(2) * np.sin(np.radians(angle + 45)))), bias)
                   for side, angle in zip("ENWS", (0, 90, 180, 270)) if side in sides])


def welded(points, cells):
    """Joins points nearer than about 1e-6; unused points go."""
    keys = np.floor(points * 1e6 + 0.4142135623).astype(np.int64)
    _, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return points[first[order]], rank[inverse.ravel()][cells]


def merged(patches):
    """One quad mesh from patches that meet."""
    offsets = np.cumsum([0] + [len(p) for p, _ in patches])
    points = np.concatenate([p for p, _ in patches])
    return welded(points, np.concatenate([q + o for (_, q), o in zip(patches, offsets)]))


def swept(quads2d, n, mapping, part=0):
    """Quads (x, y) swept over n layers: mapping(x, y, w) -> (x, y, z), w in [0,1]."""
    points, quads = quads2d
    w = np.linspace(0, 1, n + 1)
    x, y, w = np.tile(points[:, 0], n + 1), np.tile(points[:, 1], n + 1), np.repeat(w, len(points))
    mapped = np.stack([c + 0 * x for c in mapping(x, y, w)], axis=1)
    hexes = np.concatenate([np.concatenate([quads + k * len(points), quads + (k + 1) * len(points)], axis=1)
                            for k in range(n)])
    return mapped, hexes, np.full(len(hexes), part)


def block(n_u, n_v, n_w, mapping, part=0):
    """Mapped cube: mapping(u, v, w) -> (x, y, z)."""
    return swept(grid(n_u, n_v), n_w, mapping, part)


def joined(meshes):
    """One conforming mesh from meshes that meet; left-handed hexes are turned."""
    offsets = np.cumsum([0] + [len(p) for p, _, _ in meshes])
    points = np.concatenate([p for p, _, _ in meshes])
    hexes = np.concatenate([h + o for (_, h, _), o in zip(meshes, offsets)])
    points, hexes = welded(points, hexes)
    left = corner_jacobians(points, hexes).mean(axis=1) < 0
    hexes[left] = hexes[left][:, [4, 5, 6, 7, 0, 1, 2, 3]]
    return points, hexes, np.concatenate([part for _, _, part in meshes])


# Neighbours of each corner in Gmsh's order, right-handed.
CORNER_NEIGHBOURS = np.array([[1, 3, 4], [2, 0, 5], [3, 1, 6], [0, 2, 7], [7, 5, 0], [4, 6, 1], [5, 7, 2], [6, 4, 3]])
# Corners of the six faces, counter-clockwise from outside.
FACES = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])


def corner_vectors(points, hexes):
    corners = points[hexes]
    return corners[:, CORNER_NEIGHBOURS] - corners[:, :, None, :]


def corner_jacobians(points, hexes):
    return np.linalg.det(corner_vectors(points, hexes))


def scaled_jacobian(points, hexes):
    """Per hex, smallest of the eight corners and the centre."""
    vectors = corner_vectors(points, hexes)
    at_corners = np.linalg.det(vectors) / np.prod(np.linalg.norm(vectors, axis=3), axis=2)
    c = points[hexes]
    axes = np.stack([c[:, [1, 2, 5, 6]].sum(1) - c[:, [0, 3, 4, 7]].sum(1),
                     c[:, [2, 3, 6, 7]].sum(1) - c[:, [0, 1, 4, 5]].sum(1),
                     c[:, [4, 5, 6, 7]].sum(1) - c[:, [0, 1, 2, 3]].sum(1)], axis=1)
    at_centre = np.linalg.det(axes) / np.prod(np.linalg.norm(axes, axis=2), axis=1)
    return np.minimum(at_corners.min(axis=1), at_centre)


def volume(points, hexes):
    """Exact for trilinear hexes: 2 x 2 x 2 Gauss points."""
    c = points[hexes]
    g = 0.5 / np.sqrt(3)
    total = 0.0
    for u in (0.5 - g, 0.5 + g):
        for v in (0.5 - g, 0.5 + g):
            for w in (0.5 - g, 0.5 + g):
                at = np.array([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v])
                du = np.array([-(1 - v), 1 - v, v, -v])
                dv = np.array([-(1 - u), -u, u, 1 - u])
                jacobian = np.stack([np.tensordot(c, np.concatenate([d * (1 - w), d * w]), ([1], [0])) for d in (du, dv)]
                                    + [np.tensordot(c, np.concatenate([-at, at]), ([1], [0]))], axis=1)
                total += np.linalg.det(jacobian).sum() / 8
    return total
