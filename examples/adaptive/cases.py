"""Three parts: their mesh, what holds and what pulls them, and where the largest stress is looked for."""
import numpy as np

PULL = 100.0


class Case:
    def __init__(self, name, what, fixed, pulled, traction, peak, layers, singular=None, mesh=None):
        self.name, self.what = name, what
        self.fixed = fixed  # (kind, id, directions)
        self.pulled, self.traction = pulled, traction
        self.peak = peak  # the surface with the stress that is asked for
        self.layers = layers  # the surface or curve that one would refine without a computation
        self.singular = singular  # a curve at which stresses have no bound: the reference is finer there
        self.mesh = mesh  # None: that in models/

    def start(self, session, models):
        session.import_cad(models / f"{self.name}.brep")
        if self.mesh:
            session.take(*self.mesh())
        else:
            session.import_mesh(models / f"{self.name}.msh")


def coarse_plate():
    """The quarter of a plate with a hole in 128 hexes that know nothing of the hole: 8 around, 8 outwards, 2 layers."""
    angles = np.radians(np.linspace(0, 90, 9))
    inner = 10 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    side = np.linspace(0, 1, 5)[:, None]
    corner = np.array([50.0, 40.0])
    outer = np.concatenate([(1 - side) * [50, 0] + side * corner, ((1 - side) * corner + side * [0, 40])[1:]])
    way = np.linspace(0, 1, 9)[:, None, None]
    flat = (1 - way) * inner + way * outer  # (outwards, around, 2)
    points = np.concatenate([np.concatenate([flat, np.full((9, 9, 1), z)], axis=2).reshape(-1, 3) for z in (0, 2.5, 5)])
    at = lambda i, j, k: k * 81 + i * 9 + j
    hexes = [[at(i + a, j + b, k + c) for a, b, c in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))]
             for k in range(2) for i in range(8) for j in range(8)]
    return points, np.array(hexes)


X, Y, Z = 0, 1, 2
CASES = {c.name: c for c in [
    Case("plate_quarter", "a quarter of a plate with a hole, pulled", [("surface", 1, [X]), ("surface", 7, [Y]), ("vertex", 1, [Z])],
         6, (PULL, 0, 0), 5, "surface 5", mesh=coarse_plate),
    Case("bracket", "bracket on its foot, pulled up in its bore", [("surface", 3, [X, Y, Z])], 6, (0, 0, PULL), 6, "surface 6", singular="curve 22"),
    Case("l_block", "L, pulled along one leg", [("surface", 1, [X]), ("surface", 2, [Y]), ("surface", 5, [Z])],
         6, (PULL, 0, 0), None, "curve 18", singular="curve 18"),
]}
