#!/usr/bin/env python3
"""Draws how smoothing converges, from histories that test_mesh writes (SmoothRealMesh tests):

    plot_convergence.py "title=history.csv" ... > docs/smoothing.svg

Three panels per history over node updates: smallest shape, average shape, energy (average distortion over corners).
Coloured by stage. Python's standard library is enough.
"""
import csv
import sys

COLOURS = {"start": "#555", "untangle": "#8e44ad", "shape": "#2470b3", "worst": "#c0392b", "average": "#27894b", "corners": "#d07b0a"}
PANELS = (("min", "smallest shape"), ("average", "average shape"), ("energy", "energy"))
WIDTH, HEIGHT, LEFT, TOP, GAP = 270, 150, 60, 40, 70


def panel(rows, key, label, x0, y0):
    xs = [int(row["updates"]) for row in rows]
    ys = [float(row[key]) for row in rows]
    low, high = min(ys), max(ys)
    margin = (high - low or abs(high) or 1) * 0.05
    low, high = low - margin, high + margin

    def at(i):
        return x0 + WIDTH * xs[i] / (xs[-1] or 1), y0 + HEIGHT * (1 - (ys[i] - low) / (high - low))

    out = [f'<rect x="{x0}" y="{y0}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="#aaa"/>',
           f'<text x="{x0 + WIDTH / 2}" y="{y0 - 6}" text-anchor="middle">{label}</text>',
           f'<text x="{x0 + WIDTH / 2}" y="{y0 + HEIGHT + 28}" text-anchor="middle">node updates</text>']
    for value in (ys[0], ys[-1]) if abs(ys[0] - ys[-1]) > 0.1 * (high - low) else (ys[-1],):
        y = y0 + HEIGHT * (1 - (value - low) / (high - low))
        out.append(f'<text x="{x0 - 4}" y="{y + 4:.1f}" text-anchor="end">{value:.4f}</text>')
    for x in (0, xs[-1]):
        out.append(f'<text x="{x0 + WIDTH * x / (xs[-1] or 1):.1f}" y="{y0 + HEIGHT + 14}" '
                   f'text-anchor="middle">{x}</text>')
    for i in range(1, len(rows)):
        (xa, ya), (xb, yb) = at(i - 1), at(i)
        colour = COLOURS.get(rows[i]["stage"], "#000")
        out.append(f'<path d="M{xa:.1f} {ya:.1f}L{xb:.1f} {yb:.1f}" stroke="{colour}" stroke-width="1.5"/>'
                   f'<circle cx="{xb:.1f}" cy="{yb:.1f}" r="1.6" fill="{colour}"/>')
    return out


def main():
    if len(sys.argv) < 2 or any("=" not in argument for argument in sys.argv[1:]):
        sys.exit(__doc__)
    body, stages = [], []
    for n, argument in enumerate(sys.argv[1:]):
        title, file = argument.split("=", 1)
        with open(file, encoding="utf-8") as lines:
            rows = [row for row in csv.DictReader(lines) if float(row["energy"]) < float("inf")]
        stages = list(dict.fromkeys(stages + [row["stage"] for row in rows]))
        y = TOP + n * (HEIGHT + GAP + 20) + 30
        body.append(f'<text x="{LEFT}" y="{y - 24}" font-weight="bold">{title}</text>')
        for i, (key, label) in enumerate(PANELS):
            body += panel(rows, key, label, LEFT + i * (WIDTH + GAP), y)
    width = LEFT + len(PANELS) * (WIDTH + GAP)
    height = TOP + (len(sys.argv) - 1) * (HEIGHT + GAP + 20) + 10
    print(f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
          f'font-family="sans-serif" font-size="11"><rect width="100%" height="100%" fill="#fff"/>')
    for i, stage in enumerate(stage for stage in stages if stage != "start"):
        print(f'<circle cx="{LEFT + i * 110}" cy="16" r="4" fill="{COLOURS.get(stage, "#000")}"/>'
              f'<text x="{LEFT + i * 110 + 8}" y="20">{stage}</text>')
    print("\n".join(body) + "\n</svg>")


main()
