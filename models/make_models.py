#!/usr/bin/python3
"""Makes the CAD and the meshes in this folder, models.json, and the table of models in README.md.

    models/make_models.py [NAME...]      (Debian 12: apt install python3-gmsh python3-numpy)

The shapes and their exact volumes and areas are in shapes.py. Each is built with OpenCASCADE through Gmsh, written as
.brep and .step, read back from the .brep (so that Gmsh's tags are the .brep's own numbering), and a hex mesh that was
made beside it is put exactly on it. Everything stated in models.json is measured or checked here. Running this again
with the same Gmsh (4.8.4) gives the same files.
"""
import json
import os
import pathlib
import re
import sys

import gmsh
import numpy as np

import hexes
import on_cad
import shapes

HERE = pathlib.Path(__file__).resolve().parent
DIMENSIONS = ["node_sets", "node_sets", "side_sets", "blocks"]


def quietly(function, *arguments):
    """Calls it with standard output shut: OpenCASCADE's STEP writer talks."""
    sys.stdout.flush()
    out, null = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, 1)
    try:
        function(*arguments)
    finally:
        os.dup2(out, 1)


def write_cad(model):
    """Writes .brep and .step, and makes the .brep the current CAD."""
    brep, step = HERE / f"{model.name}.brep", HERE / f"{model.name}.step"
    gmsh.model.occ.synchronize()
    gmsh.write(str(brep))
    quietly(gmsh.write, str(step))
    # What changes from run to run: the time, and how many files the process has written. That becomes the part's name.
    text = re.sub(r"'\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d'", "'2000-01-01T00:00:00'", step.read_text())
    step.write_text(re.sub(r"Open CASCADE STEP translator 7\.6 \d+", model.name, text))
    gmsh.clear()
    gmsh.model.occ.importShapes(str(brep))
    gmsh.model.occ.synchronize()


def check_measures(model):
    for dim, exact in ((3, model.volume), (2, model.area)):
        measured = sum(gmsh.model.occ.getMass(*entity) for entity in gmsh.model.getEntities(dim))
        assert abs(measured / exact - 1) < model.measure_error, f"{model.name}: {measured} is not {exact}"


def add_groups(model):
    names = {key: [] for key in DIMENSIONS}
    for number, (dim, name, wanted) in enumerate(model.groups, 1):
        tags = [tag for _, tag in gmsh.model.getEntities(dim) if wanted(*on_cad.box(dim, tag))]
        assert tags, f"{model.name}: group {name} is empty"
        gmsh.model.addPhysicalGroup(dim, tags, number)
        gmsh.model.setPhysicalName(dim, number, name)
        names[DIMENSIONS[dim]].append(name)
    return names


def make(model):
    gmsh.clear()
    mesh = model.mesh()
    gmsh.clear()
    model.cad()
    write_cad(model)
    check_measures(model)
    groups = add_groups(model)
    path = HERE / f"{model.name}.msh"
    points = on_cad.write(path, mesh, model.binary)
    quality = hexes.scaled_jacobian(points, mesh[1])
    count = [len(gmsh.model.getEntities(dim)) for dim in range(4)]
    row = {"name": model.name, "cad": [f"{model.name}.brep", f"{model.name}.step"], "mesh": f"{model.name}.msh",
           "exercises": model.exercises, "volume": model.volume, "area": model.area, "exact": model.exact,
           "solids": count[3], "faces": count[2], "edges": count[1], "vertices": count[0],
           "hexes": len(mesh[1]), "nodes": len(points), "mesh_volume": round(hexes.volume(points, mesh[1]), 6),
           "min_scaled_jacobian": round(float(quality.min()), 4), "splines": model.splines,
           "measure_error": model.measure_error} | groups
    print(f"{model.name:16} {row['hexes']:5} hexes  volume {row['volume']:.9g} (mesh {row['mesh_volume']:.9g})  "
          f"min scaled Jacobian {row['min_scaled_jacobian']}")
    return row


def table(rows):
    lines = ["| model | hexes | what it exercises | exact volume | exact area | min. scaled Jacobian |",
             "|---|---|---|---|---|---|"]
    for row in rows:
        lines.append(f"| {row['name']} | {row['hexes']} | {row['exercises']} | {row['volume']:.8g} | {row['area']:.8g} "
                     f"| {row['min_scaled_jacobian']:.2f} |")
    return "\n".join(lines)


def main(names):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    table_file = HERE / "models.json"
    rows = {row["name"]: row for row in json.loads(table_file.read_text())} if table_file.exists() else {}
    for model in shapes.all_models():
        if not names or model.name in names:
            rows[model.name] = make(model)
    rows = [rows[model.name] for model in shapes.all_models() if model.name in rows]
    table_file.write_text("[\n" + ",\n".join(json.dumps(row) for row in rows) + "\n]\n")
    readme = HERE.parent / "README.md"
    if readme.exists():
        text = re.sub(r"(<!-- models: .*? -->\n).*?(<!-- end of models -->)",
                      lambda match: match[1] + table(rows) + "\n" + match[2], readme.read_text(), flags=re.S)
        readme.write_text(text)


if __name__ == "__main__":
    main(sys.argv[1:])
