#!/usr/bin/env python3
"""Adaptive loops with CalculiX beside uniform refinement: errors against unknowns, as a table and a picture.

    main.py [--out FOLDER] [--limit UNKNOWNS] [--ways WAY,...] [CASE ...]

Each way starts from the coarse mesh of a case (cases.py) and is solved again and again: `uniform`, `levels` (wished sizes, by
adapt()), `halves` (wished sizes, one into eight where that can be), `sheets` (those that gain most) and `layers` (along the
entity that one would name without a computation)."""
import argparse
import json
import pathlib
import shutil
import sys

import numpy as np

import hextwist
import indicator
import sheets
from cases import CASES
from solution import solve

MODELS = pathlib.Path(__file__).resolve().parents[2] / "models"


def started(case):
    session = hextwist.Session()
    case.start(session, MODELS)
    return session


def uniform(case, work, limit):
    n = 1
    while True:
        session = started(case)
        if n > 1:
            session.cmd(f"refine volume all numsplit {n - 1}")
        if 3 * session.mesh.n_nodes > limit * 1.1:
            return
        yield f"in {n}" if n > 1 else "start", solve(session, case, work)
        n += 1


def layers(case, work, limit):
    for n in (2, 4, 6):
        session = started(case)
        session.cmd(f"refine {case.layers} direction layers {n} growth 1.5")
        yield f"{n} layers", solve(session, case, work)


def loop(step):
    def rounds(case, work, limit):
        session, k = started(case), 0
        while 3 * session.mesh.n_nodes <= limit / 3:
            n_hexes, solution = session.mesh.n_hexes, solve(session, case, work)
            yield f"round {k}", solution
            step(session, solution)
            k += 1
            if session.mesh.n_hexes == n_hexes:
                return
    return rounds


def by_levels(session, solution):
    """One into 27, finer and coarser, by sizes per hex."""
    session.adapt(sizes=indicator.wished_sizes(session.mesh.quality("volume"), solution.error, 0.6))


def halves(case, work, limit):
    """One into eight where sheets allow it, else one into 27: from the coarse mesh on in each round, by a nodal field of sizes."""
    session, k = started(case), 0
    while 3 * session.mesh.n_nodes <= limit / 3:
        solution = solve(session, case, work)
        yield f"round {k}", solution
        mesh = session.mesh
        size = np.log(indicator.wished_sizes(mesh.quality("volume"), solution.error, 0.6))
        count = np.bincount(mesh.hexes.ravel(), minlength=mesh.n_nodes)
        wish = np.exp(np.bincount(mesh.hexes.ravel(), np.repeat(size, 8), mesh.n_nodes) / count)
        before = hextwist.Session()
        before.take(mesh.points, mesh.hexes, node_fields={"wish": wish})
        before.cmd(f"export vtk '{work / 'wish.vtu'}' overwrite")
        n_hexes, session, k = mesh.n_hexes, started(case), k + 1
        session.cmd(f"sizing field \"wish\" file '{work / 'wish.vtu'}'; refine volume all sizing_function wish method parallel")
        if session.mesh.n_hexes == n_hexes:
            return


def by_sheets(session, solution):
    mesh = session.mesh
    for a, b in mesh.node_ids[sheets.sheets_to_cut(mesh.hexes, solution.parts, 0.25)]:
        session.cmd(f"refine sheet node {a} {b}")


WAYS = {"uniform": uniform, "levels": loop(by_levels), "halves": halves, "sheets": loop(by_sheets), "layers": layers}


def reference(case, work, limit):
    """Energy and peak with hexes of second order, on meshes made by sheets and by layers at the singular curve. Of the last two
    the second counts, and the first says how far it can be trusted."""
    session, found = started(case), []
    while True:
        solution = solve(session, case, work)
        by_sheets(session, solution)
        n = 12 * session.mesh.n_nodes
        if n > limit / 3:
            finer = hextwist.Session()
            finer.import_cad(MODELS / f"{case.name}.brep")
            finer.take(session.mesh.points, session.mesh.hexes)
            if case.singular:
                finer.cmd(f"refine {case.singular} direction layers 6 growth 2.5")
            found.append(solve(finer, case, work, order=2))
            print(f"  reference {found[-1].n_unknowns:7} unknowns of second order, energy {found[-1].energy:.4f}"
                  + (f", peak {found[-1].peak:.2f}" if found[-1].peak else ""), flush=True)
        if n > limit:
            return found


def study(case, work, limit, ways):
    rows = []
    for way in ways:
        for label, s in WAYS[way](case, work, limit):
            rows.append({"way": way, "round": label, "unknowns": s.n_unknowns, "hexes": s.n_hexes, "energy": s.energy, "peak": s.peak,
                         "estimate": s.estimate, "scaled_jacobian": s.scaled_jacobian})
            print(f"  {way:8} {label:9} {s.n_unknowns:7} unknowns, energy {s.energy:.4f}, estimated error {s.estimate:.4f}, "
                  f"scaled Jacobian {s.scaled_jacobian:.3f}" + (f", peak {s.peak:.2f}" if s.peak else ""), flush=True)
    return rows


def unknowns_of(rows, error):
    """How many unknowns a way needs for an energy error: between its rounds along straight lines in logarithms, never beyond them."""
    rows = sorted(rows, key=lambda r: r["unknowns"])
    for a, b in zip(rows, rows[1:]):
        if a["energy_error"] >= error >= b["energy_error"]:
            t = np.log(a["energy_error"] / error) / max(np.log(a["energy_error"] / b["energy_error"]), 1e-300)
            return a["unknowns"] * (b["unknowns"] / a["unknowns"]) ** t
    return None


def compared(rows, energy, peak):
    """Adds errors, and how many times as many unknowns uniform refinement needs for the same."""
    for row in rows:
        row["energy_error"] = float(np.sqrt(max(1 - row["energy"] / energy, 0)))
        row["peak_error"] = abs(row["peak"] / peak - 1) if peak else None
    even = [r for r in rows if r["way"] == "uniform"]
    for row in rows:
        same = unknowns_of(even, row["energy_error"])
        row["uniform_needs"] = same / row["unknowns"] if same else None


def table(rows):
    lines = ["| way | round | unknowns | energy error | estimated | uniform needs | peak error | smallest scaled Jacobian |", "|---|---|---|---|---|---|---|---|"]
    for r in rows:
        times = f"{r['uniform_needs']:.1f} times" if r["uniform_needs"] else "-"
        peak = f"{100 * r['peak_error']:.1f}%" if r["peak_error"] is not None else "-"
        lines.append(f"| {r['way']} | {r['round']} | {r['unknowns']} | {100 * r['energy_error']:.2f}% | {100 * r['estimate']:.2f}% | {times} | {peak} "
                     f"| {r['scaled_jacobian']:.2f} |")
    return "\n".join(lines) + "\n"


def check(out):
    """Whether sheets pay on the L, beside uniform refinement in two: the more unknowns, the more they do."""
    energy = 708.457  # second order, with layers at the edge, within 0.01: docs/adaptive.md
    rows = study(CASES["l_block"], out, 12000, ["uniform", "levels", "sheets"])
    compared(rows, energy, None)
    print(table(rows))
    even, best = (min((r for r in rows if r["way"] == way), key=lambda r: r["energy_error"]) for way in ("uniform", "sheets"))
    at_most = unknowns_of([r for r in rows if r["way"] == "sheets"], even["energy_error"])
    assert at_most and at_most <= 0.3 * even["unknowns"], f"sheets need {at_most} unknowns, uniform refinement {even['unknowns']}"
    assert best["energy_error"] < even["energy_error"]
    for row in rows:
        assert row["scaled_jacobian"] >= 0.2, row
        assert 0.7 < row["estimate"] / row["energy_error"] < 1.8, row


def plot(studies, file):
    try:
        import matplotlib
    except ImportError:
        print("no picture: python3-matplotlib is not installed")
        return
    matplotlib.use("Agg")
    from matplotlib import pyplot
    figure, axes = pyplot.subplots(2, len(studies), figsize=(5 * len(studies), 7), squeeze=False)
    for column, (name, data) in enumerate(studies.items()):
        for line, (key, label) in enumerate((("energy_error", "energy error"), ("peak_error", "error of the peak stress"))):
            axis = axes[line][column]
            axis.set(xscale="log", yscale="log", xlabel="unknowns", ylabel=label, title=name if line == 0 else "")
            axis.grid(True, which="both", alpha=0.3)
            for way in WAYS:
                points = sorted((r["unknowns"], r[key]) for r in data["rows"] if r["way"] == way and r[key])
                if points:
                    axis.plot(*zip(*points), marker="o", markersize=4, label=way, linestyle="" if way == "layers" else "-")
            if axis.lines:
                axis.legend()
            if key == "peak_error" and axis.lines:
                axis.axhline(0.01, color="grey", linestyle=":")
            elif key == "peak_error":
                axis.set_axis_off()
    figure.tight_layout()
    figure.savefig(file, dpi=80)
    print(f"wrote {file}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("build/adaptive"))
    parser.add_argument("--limit", type=int, default=40000, help="unknowns up to which uniform refinement goes; the loops end at a third of it")
    parser.add_argument("--ways", default=",".join(WAYS))
    parser.add_argument("--check", action="store_true", help="a test on the L alone, against its known energy; 77 where ccx is missing")
    parser.add_argument("--plot", type=pathlib.Path, metavar="PICTURE", help="computes nothing: draws what is in the folder --out from an earlier run")
    parser.add_argument("cases", nargs="*", metavar="CASE", help=", ".join(CASES))
    options = parser.parse_args()
    if options.plot:
        return plot(json.loads((options.out / "adaptive.json").read_text()), options.plot)
    if not shutil.which("ccx"):
        print("skipped: ccx is missing, CalculiX solves here (Debian: calculix-ccx)")
        sys.exit(77 if options.check else 1)
    options.out.mkdir(parents=True, exist_ok=True)
    if options.check:
        return check(options.out.resolve())
    studies = {}
    for name in options.cases or CASES:
        case = CASES[name]
        print(f"{name}: {case.what}", flush=True)
        work = (options.out / name).resolve()
        rows = study(case, work, options.limit, options.ways.split(","))
        found = reference(case, work, options.limit)
        compared(rows, found[-1].energy, found[-1].peak)
        studies[name] = {"rows": rows, "references": [{"unknowns": f.n_unknowns, "energy": f.energy, "peak": f.peak} for f in found]}
        (options.out / f"{name}.md").write_text(table(rows))
        print(table(rows), flush=True)
        (options.out / "adaptive.json").write_text(json.dumps(studies, indent=1))
    plot(studies, options.out / "adaptive.png")


if __name__ == "__main__":
    main()
