#!/usr/bin/env python3
"""The patch test: a linear displacement of the boundary is one of the inside, on refined meshes, in CalculiX.

    patch_test.py PROGRAM MODELS FOLDER [SEED]

30 meshes of C3D8 and 10 of C3D20, refined at random places of the shipped models, many of them several times. On each all
nodes of the skin are moved by u = A x with a random A; the others have to follow, and every element has to have the same
stress. Prints a line per mesh; the exit status is 1 when one is off by more than 1e-5 of the largest displacement."""
import json
import pathlib
import random
import re
import subprocess
import sys

program, models, folder = (pathlib.Path(p).resolve() for p in sys.argv[1:4])
seed = int(sys.argv[4]) if len(sys.argv) > 4 else 1
before = {row["name"]: row["hexes"] for row in json.loads((models / "models.json").read_text())}
names = ["l_block", "bracket", "cylinder", "sphere", "notched_cube", "plate_quarter", "curved_plate", "cam"]
tolerance = 1e-5
largest = 6000  # hexes


def refinement(chance):
    """A few commands; those that a mesh does not have the entity for are left out by the one who runs them."""
    kinds = ["hex {}", "curve {}", "surface {}", "vertex {}", "hex {} depth 1", "surface {} depth 1", "volume 1", "curve {} smooth"]
    return [("refine " + chance.choice(kinds)).format(chance.randint(1, 9)) for _ in range(chance.randint(1, 3))]


def numbers(line):
    return [float(x.replace("D", "E")) for x in line.split(",") if x.strip()]


def read_mesh(text):
    """Nodes by id, the ids of the set SKIN, and how many lines elements take."""
    nodes, skin, section, n_lines = {}, [], "", 0
    for line in text.splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            section = line.upper()
        elif section.startswith("*NODE"):
            row = numbers(line)
            nodes[int(row[0])] = row[1:4]
        elif section.startswith("*ELEMENT"):
            n_lines += 1
        elif section == "*NSET, NSET=SKIN":
            skin += [int(x) for x in line.split(",") if x.strip()]
    return nodes, skin, n_lines


def run(name, commands, order, chance):
    """Whether the test is passed, and how many nodes were free; None where nothing was refined, or too much."""
    work = folder / f"{name}_{order}_{chance.randint(0, 10**9)}"
    work.mkdir(parents=True, exist_ok=True)
    mesh = work / "mesh.inp"
    arguments = [program, "--cad", models / f"{name}.brep", models / f"{name}.msh", "--keep-going", "-c",
                 "; ".join([*commands, 'nodeset 900 surface all name "SKIN"', f"export abaqus '{mesh}' order {order} overwrite"])]
    subprocess.run(arguments, capture_output=True, text=True)
    if not mesh.exists():
        sys.exit(f"{name}: {commands}: no mesh was written")
    text = mesh.read_text()
    nodes, skin, n_lines = read_mesh(text)
    if not before[name] < n_lines / order < largest:  # a hex of 20 nodes takes two lines
        return None
    a = [[chance.uniform(-1e-3, 1e-3) for _ in range(3)] for _ in range(3)]
    wanted = {n: [sum(a[i][k] * p[k] for k in range(3)) for i in range(3)] for n, p in nodes.items()}
    moved = "".join(f"{n}, {i + 1}, {i + 1}, {wanted[n][i]:.12e}\n" for n in skin for i in range(3))
    (work / "job.inp").write_text(
        "*INCLUDE, INPUT=mesh.inp\n*MATERIAL, NAME=M\n*ELASTIC\n210000, 0.3\n*SOLID SECTION, ELSET=EALL, MATERIAL=M\n"
        f"*STEP\n*STATIC\n*BOUNDARY\n{moved}*NODE PRINT, NSET=NALL\nU\n*EL PRINT, ELSET=EALL\nS\n*END STEP\n")
    solved = subprocess.run(["ccx", "-i", "job"], cwd=work, capture_output=True, text=True)
    if solved.returncode != 0 or "nonpositive" in solved.stdout:
        sys.exit(f"{name}: {commands}: CalculiX: {solved.stdout[-400:]}")
    most = max(abs(x) for u in wanted.values() for x in u)
    off, stresses, section = 0.0, [], ""
    for line in (work / "job.dat").read_text().splitlines():
        words = line.split()
        if re.match(r" *(displacements|stresses)", line):
            section = words[0]
        elif section == "displacements" and len(words) == 4:
            off = max(off, *(abs(float(x) - w) for x, w in zip(words[1:], wanted[int(words[0])])))
        elif section == "stresses" and len(words) == 8:
            stresses.append([float(x) for x in words[2:]])
    scale = max(abs(x) for x in stresses[0])
    spread = max(max(column) - min(column) for column in zip(*stresses)) / scale
    inside = len(nodes) - len(skin)
    good = off <= tolerance * most and spread <= 100 * tolerance
    print(f"{'ok  ' if good else 'OFF '} C3D{8 if order == 1 else 20} {name:14} {len(nodes):7} nodes, {inside:6} inside, displacements off by "
          f"{off / most:.1e}, stresses by {spread:.1e}: {'; '.join(commands)}", flush=True)
    return good, inside


def main():
    chance = random.Random(seed)
    print(f"seed {seed}")
    results = []
    for order, count in ((1, 30), (2, 10)):
        for i in range(count):
            result = None
            while result is None:
                result = run(names[i % len(names)], refinement(chance), order, chance)
            results.append(result)
    n_bad = sum(not good for good, _ in results)
    print(f"{len(results)} meshes, {sum(inside for _, inside in results)} free nodes, {n_bad} off")
    return 1 if n_bad else 0


if __name__ == "__main__":
    sys.exit(main())
