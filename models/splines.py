"""Clamped uniform B-splines: interpolation, evaluation, and exact integrals over surfaces made of them."""
import gmsh
import numpy as np


class Spline:
    """Clamped B-spline on [0, 1] of a degree with n_spans equal spans."""

    def __init__(self, degree, n_spans):
        self.degree = degree
        self.n = n_spans + degree
        self.breaks = np.linspace(0, 1, n_spans + 1)
        self.multiplicities = [degree + 1] + [1] * (n_spans - 1) + [degree + 1]
        self.knots = np.repeat(self.breaks, self.multiplicities)

    def greville(self):
        return np.array([self.knots[i + 1:i + 1 + self.degree].mean() for i in range(self.n)])

    def basis(self, t, degree=None):
        """(len(t), n) values of the basis functions (of a lower degree: n + difference of them)."""
        degree = self.degree if degree is None else degree
        t, k = np.asarray(t, float)[:, None], self.knots
        last = np.flatnonzero(k[:-1] < k[1:])[-1]
        values = ((t >= k[:-1]) & ((t < k[1:]) | ((np.arange(len(k) - 1) == last) & (t <= k[1:])))).astype(float)
        for d in range(1, degree + 1):
            width = np.where(k[d:] > k[:-d], k[d:] - k[:-d], np.inf)
            values = ((t - k[:-d - 1]) / width[:-1] * values[:, :-1] + (k[d + 1:] - t) / width[1:] * values[:, 1:])
        return values

    def slope(self, t):
        d = self.degree
        lower, k = self.basis(t, d - 1), self.knots
        width = np.where(k[d:] > k[:-d], k[d:] - k[:-d], np.inf)
        return d * (lower[:, :-1] / width[:-1] - lower[:, 1:] / width[1:])

    def interpolating(self, values_at):
        """Control values of the spline through values_at(t) at the Greville points."""
        t = self.greville()
        return np.linalg.solve(self.basis(t), values_at(t))

    def gauss(self, n=10):
        """Points and weights over all spans."""
        x, w = np.polynomial.legendre.leggauss(n)
        low, step = self.breaks[:-1, None], np.diff(self.breaks)[:, None]
        return (low + step * (x + 1) / 2).ravel(), (step * w / 2).ravel()


def occ_surface(u, v, control):
    """B-spline surface of Gmsh with control points control[i, j]."""
    points = [gmsh.model.occ.addPoint(*control[i, j]) for j in range(v.n) for i in range(u.n)]
    tag = gmsh.model.occ.addBSplineSurface(points, u.n, -1, u.degree, v.degree, [], list(u.breaks), list(v.breaks),
                                           u.multiplicities, v.multiplicities)
    gmsh.model.occ.remove([(0, point) for point in points])
    return tag


def measures(u, v, control):
    """Area, and the part of the enclosed volume that the divergence theorem puts on this surface (its sign follows
    the normal u x v). The volume is exact to rounding: the integrand is a polynomial on every span."""
    (s, ws), (t, wt) = u.gauss(), v.gauss()
    evaluate = lambda a, b: np.einsum("ik,jl,klc->ijc", a, b, control)
    normal = np.cross(evaluate(u.slope(s), v.basis(t)), evaluate(u.basis(s), v.slope(t)))
    weight = ws[:, None] * wt
    flux = (evaluate(u.basis(s), v.basis(t)) * normal).sum(axis=2) / 3
    return float((weight * np.linalg.norm(normal, axis=2)).sum()), float((weight * flux).sum())
