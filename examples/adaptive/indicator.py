"""Errors of a solution hex by hex (Zienkiewicz and Zhu, 1992), and the sizes or marks that follow from them."""
import numpy as np

import elasticity


def lists_of(keys, values, n):
    """The values of each key 0 .. n - 1."""
    order = np.argsort(keys, kind="stable")
    return np.split(values[order], np.cumsum(np.bincount(keys, minlength=n))[:-1])


def largest_principal(stresses):
    xx, yy, zz, xy, xz, yz = np.moveaxis(stresses, -1, 0)
    return np.linalg.eigvalsh(np.stack([xx, xy, xz, xy, yy, yz, xz, yz, zz], axis=-1).reshape(*xx.shape, 3, 3))[..., -1]


def fitted(places, values, at, quadratic):
    """Polynomials through values at places, at points: (patches, places, 3), (patches, places, 6), (patches, 3)."""
    middle = places.mean(axis=1, keepdims=True)
    axes = np.linalg.svd(places - middle, full_matrices=False)[2].transpose(0, 2, 1)  # lengths count along the patch's own axes
    x, y = (places - middle) @ axes, (at[:, None] - middle) @ axes
    scale = np.abs(x).max(axis=1, keepdims=True)
    scale = np.maximum(scale, 1e-9 * scale.max(axis=2, keepdims=True))

    def terms(x):
        squares = [x[..., i] * x[..., k] for i in range(3) for k in range(i, 3)] if quadratic else []
        return np.stack([x[..., 0], x[..., 1], x[..., 2], *squares], axis=-1)

    # Terms that a patch has too few layers for do not vary in it, and the smallest solution leaves them out.
    rows, average = terms(x / scale), values.mean(axis=1)
    mean = rows.mean(axis=1, keepdims=True)
    return average + ((terms(y / scale) - mean) @ np.linalg.pinv(rows - mean, rcond=0.03) @ (values - average[:, None]))[:, 0]


def recovered(points, hexes, stresses, on_skin, quadratic=False, nodes=None):
    """Stresses at nodes (of all, or these) by patch recovery: a polynomial fitted to the stresses where they are more accurate
    than elsewhere, in the hexes around a node; at the skin, in those around these too. That is in the middles of hexes of 8
    nodes, at the Gauss points of hexes of 20. quadratic: not linear, in larger patches: for the skin, where a linear one looks
    outwards too steeply."""
    corners = points[hexes]
    if stresses.shape[1] == len(elasticity.GAUSS) and quadratic == "gauss":
        places, values = np.einsum("pc,hck->hpk", elasticity.SHAPES, corners), stresses
    else:
        places, values = corners.mean(axis=1, keepdims=True), stresses.mean(axis=1, keepdims=True)
    around = lists_of(hexes.ravel(), np.repeat(np.arange(len(hexes)), 8), len(points))
    nodes = np.arange(len(points)) if nodes is None else np.asarray(nodes)
    wanted = 24 if quadratic is True else 12
    patches = []
    for n in nodes:
        patch = around[n]
        for _ in range(2 if quadratic is True else 1):
            if (on_skin[n] or quadratic is True) and len(patch) < wanted:
                patch = np.unique(np.concatenate([around[m] for m in np.unique(hexes[patch])]))
        patches.append(patch)
    sizes = np.array([len(p) for p in patches])
    result = np.empty((len(nodes), 6))
    for size in np.unique(sizes):
        of_size = np.nonzero(sizes == size)[0]
        for some in np.array_split(of_size, 1 + len(of_size) // 4000):
            patch = np.array([patches[i] for i in some])
            result[some] = fitted(places[patch].reshape(len(some), -1, 3), values[patch].reshape(len(some), -1, 6), points[nodes[some]],
                                  bool(quadratic))
    return result


def errors(points, hexes, stresses, smooth):
    """Energy of the difference between recovered and computed stresses, per hex; and the energy of the solution."""
    weights = elasticity.volumes_at_points(points[hexes])
    off = np.einsum("pc,hcs->hps", elasticity.SHAPES, smooth[hexes]) - stresses
    energy = lambda s: np.einsum("hp,hps,st,hpt->h", weights, s, elasticity.COMPLIANCE, s)
    return np.sqrt(energy(off)), energy(stresses).sum()


def wished_sizes(volumes, error, part):
    """Sizes with which the whole error becomes this part of what it is, with as few hexes as can be.

    That is the case where the new hexes all have the same error. It goes with size^(1 + 3/2), and there are
    (old / new size)^3 new hexes in an old one (Li and Bettess, 1995)."""
    whole = (error**2).sum()
    each = (part**2 * whole / (error**1.2).sum()) ** 2.5  # the square of it
    return np.cbrt(volumes) * (each / np.maximum(error**2, 1e-30 * whole)) ** 0.2


def marked(error, share):
    """The hexes with the largest errors that have this share of the square of the whole (Doerfler, 1996)."""
    order = np.argsort(-error)
    n = np.searchsorted(np.cumsum(error[order] ** 2), share * (error**2).sum()) + 1
    flags = np.zeros(len(error), bool)
    flags[order[:n]] = True
    return flags
