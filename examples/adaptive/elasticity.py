"""Linear elasticity on hexes of eight nodes: a job for CalculiX, what it answers, and integrals over hexes."""
import os
import re
import subprocess

import numpy as np

YOUNG, POISSON = 210000.0, 0.3

# Corners and Gauss points of the unit cube from -1 to 1, in the order of CalculiX.
CORNERS = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], float)
GAUSS = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]) / np.sqrt(3)
SHAPES = np.prod(1 + GAUSS[:, None, :] * CORNERS[None], axis=2) / 8  # (points, corners)
SLOPES = np.stack([CORNERS[None, :, k] / 8 * np.prod([1 + GAUSS[:, None, i] * CORNERS[None, :, i] for i in range(3) if i != k], axis=0)
                   for k in range(3)], axis=2)  # (points, corners, directions)

# Strains of stresses xx, yy, zz, xy, xz, yz; shear strains count twice in the energy.
COMPLIANCE = np.zeros((6, 6))
COMPLIANCE[:3, :3] = -POISSON / YOUNG
COMPLIANCE[range(3), range(3)] = 1 / YOUNG
COMPLIANCE[range(3, 6), range(3, 6)] = 2 * (1 + POISSON) / YOUNG


def volumes_at_points(corners):
    """What each Gauss point counts: (hexes, 8)."""
    return np.linalg.det(np.einsum("pck,hcd->hpkd", SLOPES, corners))


def forces_of_traction(points, quads, traction):
    """Nodal forces, (nodes, 3), of a traction on quads of four nodes, or eight: corners, then the middles of the sides behind each."""
    forces = np.zeros_like(points)
    at = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [0, -1], [1, 0], [0, 1], [-1, 0]], float)

    def shapes(u, v):
        a, b = 1 + u * at[:4, 0], 1 + v * at[:4, 1]
        if quads.shape[1] == 4:
            return a * b / 4
        sides = [(1 - u * u) * (1 + v * y) / 2 if x == 0 else (1 + u * x) * (1 - v * v) / 2 for x, y in at[4:]]
        return np.concatenate([a * b * (a + b - 3) / 4, sides])

    step = 1e-4  # the shapes are quadratic: differences are exact
    for u, wu in zip(np.sqrt(0.6) * np.array([-1, 0, 1]), (5 / 9, 8 / 9, 5 / 9)):
        for v, wv in zip(np.sqrt(0.6) * np.array([-1, 0, 1]), (5 / 9, 8 / 9, 5 / 9)):
            du, dv = (shapes(u + step, v) - shapes(u - step, v)) / (2 * step), (shapes(u, v + step) - shapes(u, v - step)) / (2 * step)
            p = points[quads]
            area = np.linalg.norm(np.cross(np.einsum("c,qck->qk", du, p), np.einsum("c,qck->qk", dv, p)), axis=1)
            parts = (wu * wv * area)[:, None] * shapes(u, v)
            for c in range(quads.shape[1]):
                np.add.at(forces, quads[:, c], parts[:, c, None] * np.asarray(traction, float))
    return forces


def job(fixed, forces):
    """Cards behind those of a mesh with the sets NALL and EALL. fixed: pairs (node, direction), forces: (nodes, 3), from 0."""
    lines = ["*MATERIAL, NAME=M", "*ELASTIC", f"{YOUNG}, {POISSON}", "*SOLID SECTION, ELSET=EALL, MATERIAL=M", "*STEP", "*STATIC", "*BOUNDARY"]
    lines += [f"{n + 1}, {k + 1}, {k + 1}" for n, k in sorted(fixed)]
    lines += ["*CLOAD"] + [f"{n + 1}, {k + 1}, {forces[n, k]:.12e}" for n, k in zip(*np.nonzero(forces))]
    lines += ["*NODE PRINT, NSET=NALL", "U", "*EL PRINT, ELSET=EALL", "S", "*END STEP"]
    return "\n".join(lines) + "\n"


def mesh_cards(points, hexes):
    kind = "C3D8" if hexes.shape[1] == 8 else "C3D20R"
    lines = ["*NODE, NSET=NALL"] + [f"{i}, {x:.14g}, {y:.14g}, {z:.14g}" for i, (x, y, z) in enumerate(points, 1)]
    lines += [f"*ELEMENT, TYPE={kind}, ELSET=EALL"]
    for i, h in enumerate(hexes + 1, 1):
        lines += [f"{i}, " + ", ".join(map(str, h[:10])) + ("," if len(h) > 10 else "")]
        lines += [", ".join(map(str, h[10:]))] if len(h) > 10 else []
    return "\n".join(lines) + "\n"


def calculix(cards, folder):
    """Runs CalculiX in a folder: displacements (nodes, 3) and stresses at Gauss points (elements, points, 6)."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "job.inp").write_text(cards)
    (folder / "job.dat").unlink(missing_ok=True)
    environment = dict(os.environ, OMP_NUM_THREADS=os.environ.get("OMP_NUM_THREADS", "2"))
    done = subprocess.run(["ccx", "-i", "job"], cwd=folder, capture_output=True, text=True, env=environment)
    if done.returncode != 0 or "nonpositive" in done.stdout or "ERROR" in done.stdout:
        raise RuntimeError(f"CalculiX failed in {folder}:\n{done.stdout[-600:]}")
    parts = re.split(r"\n *(displacements|stresses)[^\n]*\n", (folder / "job.dat").read_text())
    tables = {name: np.fromstring(text.replace("D", "E"), sep=" ") for name, text in zip(parts[1::2], parts[2::2])}
    u = tables["displacements"].reshape(-1, 4)
    s = tables["stresses"].reshape(-1, 8)
    return u[np.argsort(u[:, 0]), 1:], s[np.lexsort((s[:, 1], s[:, 0])), 2:].reshape(int(s[:, 0].max()), -1, 6)
