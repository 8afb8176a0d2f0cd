#!/usr/bin/env bash
# Draws the pictures of README and docs with the program itself: docs/pictures.sh PROGRAM [PYTHON_PACKAGES]
# Those of the front that moves in three steps need the Python package: they stay as they are without that folder.
# docs/pictures.sh --list: the names of all figures that './dev pictures' makes, and nothing is drawn.
set -euo pipefail
[ "${1:-}" != --list ] && is_list='' || is_list=yes
[ "$is_list" ] || program=$(realpath "${1:?usage: docs/pictures.sh PROGRAM [PYTHON_PACKAGES], or --list}")
python=${2:+$(realpath "$2")}
example=$(cd "$(dirname "${BASH_SOURCE[0]}")/../examples/python" && pwd)/moving_front.py
models=$(cd "$(dirname "${BASH_SOURCE[0]}")/../models" && pwd)
mkdir -p "$(dirname "${BASH_SOURCE[0]}")/pictures"
cd "$(dirname "${BASH_SOURCE[0]}")/pictures"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

hextwist() {
  if [ "$is_list" ]; then
    grep -o "to '[^']*'" <<<"$*" | sed "s|to '\(.*\)'|docs/pictures/\1|" || true
  else
    "$program" "$@" >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
  fi
}

# one_hex CORNER...: a mesh of one hex, nearly a unit cube. The edges longer than 0.998 are those to be cut,
# as marks of hexes around would ask for. Corners as in MEDIT: around the bottom, then around the top.
one_hex() {
  { echo 'MeshVersionFormatted 2 Dimension 3 Vertices 8'
    printf '%s 0\n' "$@"
    echo 'Hexahedra 1 1 2 3 4 5 6 7 8 1 End'; } >"$work/hex.mesh"
}
cut_and() { hextwist "$work/hex.mesh" -c "refine sheet edge all greater_than 0.998; $1"; }

# The patterns of a face, seen from above; nothing else of the hex is cut.
face() {
  one_hex '.05 .05 .1' '.95 .05 .1' '.95 .95 .1' '.05 .95 .1' "${@:2}"
  cut_and "draw from 0 0 1 pixels 240 240 legend off to 'face_$1.png' overwrite"
}
one_hex '0 0 0' '1 0 0' '1 1 0' '0 1 0' '0 0 1' '1 0 1' '1 1 1' '0 1 1'
hextwist "$work/hex.mesh" -c "draw from 0 0 1 pixels 240 240 legend off to 'face_none.png' overwrite"
face one '0 0 1' '1 0 1' '.998 .995 1' '.002 .995 1'
face two '0 0 1' '1 0 1' '1 .995 1' '0 .995 1'
face four '0 0 1' '1 0 1' '1 1 1' '0 1 1'
face L '0 0 1' '1 0 1' '.995 .995 1' '0 1 1'
face U '0 0 1' '1 0 1' '.998 1 1' '.002 1 1'

# The templates of the paper: eight, four and two marked nodes.
template() { cut_and "draw pixels 320 300 legend off to 'template_$1.png' overwrite"; }
one_hex '0 0 0' '1 0 0' '1 1 0' '0 1 0' '0 0 1' '1 0 1' '1 1 1' '0 1 1'
template a
one_hex '.002 .002 .005' '.997 .002 .005' '.997 .997 .005' '.002 .997 .005' '0 0 1' '1 0 1' '1 1 1' '0 1 1'
template b
one_hex '.002 .002 .005' '.997 .002 .005' '.997 .997 .005' '.002 .997 .005' '0 0 1' '1 0 1' '.997 .997 1' '.002 .997 1'
template c

# Concave ones: six marked nodes (two L, one full face) and seven (three L, three full faces).
one_hex '0 0 0' '1 0 0' '1 1 0' '0.003 0.997 .003' '0 0 1' '1 0 1' '1 1 1' '0.003 .997 1'
template six
one_hex '0 0 0' '1 0 0' '1 1 0' '0 1 0' '0 0 1' '.997 .003 .997' '1 1 1' '0 1 1'
template seven

# The same opened: the smaller hex in the middle and the frustums under the bottom, the back and the left side.
middle='x_coord > 0.4 and x_coord < 0.6 and y_coord > 0.4 and y_coord < 0.6 and z_coord > 0.4 and z_coord < 0.6'
cut_and "reset block; block 1 hex with $middle
  block 2 hex with z_coord < x_coord and z_coord < y_coord and z_coord < 1 - x_coord and z_coord < 1 - y_coord
  block 3 hex with y_coord > x_coord and y_coord > z_coord and y_coord > 1 - x_coord and y_coord > 1 - z_coord
  block 4 hex with x_coord < y_coord and x_coord < z_coord and x_coord < 1 - y_coord and x_coord < 1 - z_coord
  draw block 1 to 4 pixels 320 300 legend off to 'template_seven_open.png' overwrite"

# The frustum under a face with an L.
one_hex '.3 .3 .7' '.7 .3 .7' '.7 .7 .7' '.3 .7 .7' '0 0 1' '1 0 1' '.995 .995 1' '0 1 1'
cut_and "draw from 1 -1 0.5 pixels 320 200 legend off to 'frustum.png' overwrite"

# Whose nodes the new ones are: those of edges, of faces, of the hex.
keys() {
  one_hex '0 0 0' '1 0 0' '1 1 0' '0 1 0' '0 0 1' '1 0 1' '1 1 1' '0 1 1'
  cut_and "draw node $2 pixels 440 420 legend off to 'keys_$1.png' overwrite"
}
keys edges '9 to 32'
keys faces '33 to 56'
keys hex '57 to 64'

# One hex of a brick, and what is around it: the upper layer taken off.
blocks='reset block; block 1 hex 14; block 2 hex in face in hex 14; block 3 hex in edge in hex 14'
hextwist -c "create brick x 3 interval 3; $blocks; refine hex 14;
  draw hex with z_coord < 0.2 from 1 -1 1.2 pixels 400 340 legend off to 'around_one.png' overwrite"

# A level: marks, and what comes of them.
cylinder='create cylinder radius 2 height 2 interval 3'
hextwist -c "$cylinder; draw edge in hex in curve 1 pixels 400 340 legend off to 'level_marks.png' overwrite
  refine curve 1 depth 1; draw pixels 400 340 legend off to 'level_done.png' overwrite"

# Enclosing: one, two, four marked nodes.
enclose() { hextwist -c "create brick x 1 interval 1; refine $2 method parallel; draw pixels 320 300 legend off to 'enclose_$1.png' overwrite"; }
enclose c 'node 6'
enclose b 'edge 5'
enclose a 'face 4'

# A patch: the hexes at a target and the rings around.
rings='reset block; block 1 hex in vertex 1; block 2 hex in node in hex in block 1; block 3 hex in node in hex in block 2; block 4 hex in node in hex in block 3'
hextwist --cad "$models/plate_hole.brep" "$models/plate_hole.msh" -c "$rings; draw pixels 480 340 legend off to 'patch.png' overwrite"

# The README: the bracket before and after, and a front that moves through a pipe.
bracket=(--cad "$models/bracket.brep" "$models/bracket.msh")
hextwist "${bracket[@]}" -c "draw pixels 420 400 legend off to 'bracket_before.png' overwrite"
hextwist "${bracket[@]}" -c "refine surface 6 depth 1; refine curve 22 depth 1; refine vertex 9 depth 1; draw pixels 420 400 legend off to 'bracket_after.png' overwrite"
[ "$is_list" ] || rm -f front.gif
front=''
for x in -40 -34 -28 -22 -16 -10 -4 2 8 14 20 26 32 38; do
  front+="refine hex with x_coord > $((x - 5)) and x_coord < $((x + 5)) graded
    reset block; block 1 hex all; block 1 remove hex in field 'level' above 0.5; block 2 hex in field 'level' above 0.5
    draw from 0.5 -1 0.6 pixels 420 320 legend off to 'front.gif' append; undo 5
    "
done
hextwist --cad "$models/pipe_tee.brep" "$models/pipe_tee.msh" -c "$front"

# A look inside, with what pictures may say in words.
hextwist "${bracket[@]}" -c "refine curve 22 depth 1; refine vertex 9 depth 1
  draw quality shape clip y title 'bracket, cut at y = 0' label surface pixels 640 480 to 'words.png' overwrite"

if [ "$is_list" ]; then
  printf 'docs/pictures/%s\n' front_0.png front_1.png front_2.png adaptive.png
  echo docs/smoothing.svg
elif [ -n "$python" ]; then PYTHONPATH=$python /usr/bin/python3 "$example" 2 3 front.png >/dev/null; fi
