"""Are the tests able to fail? Flips one token at a time in the core and sees whether a test notices.

    mutate.py BUILD [--count 300] [--seed N] [--rows FILE] [--part 0/2]

BUILD is a build folder of a copy of the tree that this script may change (./dev mutate makes both). The core here:
template tables, closing of marks, gradation of levels, numbering. A flip that does not compile is no flip, another takes
its place. One row per flip: killed or survived, by which program, where, what. Survivors are printed at the end; rows
that are there already are kept, so that a run can be gone on with. Several copies of the tree, each with its part of the flips
and rows of its own, share the work of one seed.
"""

import argparse
import pathlib
import random
import re
import subprocess
import sys
import time

CORE = [
    "refine/templates/*.cpp",
    "refine/plans/*.cpp",
    "refine/levels/*.cpp",
    "refine/marks.cpp",
    "refine/split.cpp",
    "refine/lineage.cpp",
    "refine/carry.cpp",
]
# These make tables once and for all, by hand: what they found is in the .inc files.
NOT = ["refine/templates/optimize_enclosing.cpp", "refine/templates/optimize_trisecting.cpp"]

FLIPS = [
    (r"(?<![<>=!&|+\-*/^ ]) < (?=[\w(])", [" <= ", " > "]),
    (r" <= ", [" < "]),
    (r" > (?=[\w(])", [" >= ", " < "]),
    (r" >= ", [" > "]),
    (r" == ", [" != "]),
    (r" != ", [" == "]),
    (r" && ", [" || "]),
    (r" \|\| ", [" && "]),
    (r" \+ ", [" - "]),
    (r" - ", [" + "]),
    (r" \^ ", [" & ", " | "]),
    (r" & ", [" | "]),
    (r" \| ", [" & "]),
    (r" << ", [" >> "]),
    (r" >> ", [" << "]),
    (r"\+\+(?=\w)", ["--"]),
    (r"\btrue\b", ["false"]),
    (r"\bfalse\b", ["true"]),
    (r"std::min\b", ["std::max"]),
    (r"std::max\b", ["std::min"]),
    (r"(?<![\w.\"'])(\d+)(?![\w.\"'])", [1, -1]),  # a number: one more, one less
]
# Which tests are asked, the quick ones first and none that take long for one of a kind: a flip that nobody notices costs
# them all. The last ones work on whole sessions.
LATER = "trisect_table.*:trisect_counts.*:Levels/LevelsWalk.*:Levels.m*:*front*"
TESTS = [
    ("test_refine", f"-Slow*:*million*:{LATER}"),
    ("test_refine", f"{LATER}:-Slow*"),
    ("test_patch", "-Slow*:real/*:patch.requests*models*:patch.requests*cad*:Fields.linear*"),
    ("test_sizing", "-Slow*:parts/*:meshes/*teaport*:meshes/*swivel*:Lift*:size_mix.a_second*"),
    ("test_session", "SessionLevels.*:Transfer.*:PatchedSession.*:Undo*-SessionLevels.whole*:*front*:SessionLevels.the_combination*"),
]


def places(root):
    """Every flip there is: (file, offset, length, replacement)."""
    found = []
    for pattern in CORE:
        for file in sorted(root.glob(pattern)):
            name = str(file.relative_to(root))
            if name in NOT:
                continue
            text = file.read_text()
            offset = 0
            for line in text.splitlines(keepends=True):
                code = line.split("//")[0]
                skip = code.lstrip().startswith(("#", "static_assert", "assert", "template", "using", "throw"))
                if not skip and '"' not in code:
                    for regex, others in FLIPS:
                        for match in re.finditer(regex, code):
                            for other in others:
                                new = str(int(match.group(1)) + other) if isinstance(other, int) else other
                                if not new.startswith("-") or not isinstance(other, int):
                                    found.append((name, offset + match.start(), len(match.group(0)), new))
                offset += len(line)
    return found


def run(command, seconds, **options):
    try:
        return subprocess.run(command, timeout=seconds, capture_output=True, text=True, check=False, **options).returncode
    except subprocess.TimeoutExpired:
        return "time"


def judge(build, limits):
    """Who kills what is built now. limits: seconds per program, a fair multiple of what it took unflipped; empty at first."""
    for program, only in TESTS:
        room = program.removeprefix("test_")
        # The first time all is built, however long that takes.
        if run(["cmake", "--build", build, "--target", program], 900 if limits else None) != 0:
            return "no program" if program == TESTS[0][0] else "killed by the compiler"
        test = pathlib.Path(build) / "tests" / room / program
        begin = time.time()
        # A flipped loop may take all memory before it takes all time.
        fenced = ["prlimit", "--as=8000000000", test.resolve(), f"--gtest_filter={only}", "--gtest_fail_fast", "--gtest_brief=1"]
        if run(fenced, limits.get((program, only), 900), cwd=test.parent) != 0:
            return f"killed by {program}"
        limits.setdefault((program, only), 20 + 4 * (time.time() - begin))
    return "survived"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build")
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seed", type=int, default=int(time.time()))
    parser.add_argument("--minutes", type=float, default=1e9)
    parser.add_argument("--rows", default="mutate.tsv")
    parser.add_argument("--part", default="0/1", help="K/N: of the flips in their order by chance each N-th, from K on")
    options = parser.parse_args()
    root = pathlib.Path(__file__).resolve().parents[2]
    rows_file = pathlib.Path(options.rows)
    rows = [line.split("\t") for line in rows_file.read_text().splitlines()] if rows_file.exists() else []
    limits = {}
    verdict = judge(options.build, limits)
    if verdict != "survived":
        sys.exit(f"before anything is flipped: {verdict}")
    all_places = places(root)
    print(f"{len(all_places)} flips, seed {options.seed}")
    random.Random(options.seed).shuffle(all_places)
    part, parts = map(int, options.part.split("/"))
    all_places = all_places[part::parts]
    # By file within every twenty: two flips of one file cost one compilation less.
    all_places = [place for begin in range(0, len(all_places), 20) for place in sorted(all_places[begin : begin + 20])]
    done = {(row[1], row[2], row[4]) for row in rows}
    end = time.time() + 60 * options.minutes
    for name, offset, length, new in all_places:
        if len(rows) >= options.count or time.time() > end:
            break
        file = root / name
        text = file.read_text()
        line = text.count("\n", 0, offset) + 1
        place = f"{line}:{offset - text.rfind(chr(10), 0, offset)}"
        if (name, place, new.strip()) in done:
            continue
        try:
            file.write_text(text[:offset] + new + text[offset + length :])
            verdict = judge(options.build, limits)
        finally:
            file.write_text(text)
        if verdict == "no program":
            continue
        rows.append([verdict, name, place, text[offset : offset + length].strip(), new.strip(), text.splitlines()[line - 1].strip()])
        with rows_file.open("a") as out:
            out.write("\t".join(rows[-1]) + "\n")
    survivors = [row for row in rows if row[0] == "survived"]
    print(f"{len(rows)} flips, {len(rows) - len(survivors)} killed, {len(survivors)} survived")
    for _, name, place, old, new, line in survivors:
        print(f"  {name}:{place}  {old} -> {new}   {line}")


if __name__ == "__main__":
    main()
