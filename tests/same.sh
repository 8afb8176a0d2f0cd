#!/usr/bin/env bash
# Shows that two hextwist programs do the same: runs one some 550 times on small meshes and writes a line "name  checksum"
# per run, of all that comes out: what is printed, the exit status, every file. ./dev same runs it with two programs.
#
#   tests/same.sh sums PROGRAM TREE FILE              the checksums of all runs into FILE
#   tests/same.sh compare PROGRAM TREE FILE [BEFORE]  compares with the checksums in FILE: exit status 1 where runs differ.
#                                                     Outputs of these are kept, with BEFORE also those of that program.
#   tests/same.sh keep PROGRAM TREE FOLDER NAME...    what these runs print and write, into FOLDER
#
# TREE holds the models, journals and documents that the runs take. It must be the same for both programs.
set -euo pipefail
export LC_ALL=C
script=$(realpath "${BASH_SOURCE[0]}")
tests=$(dirname "$script")
differ=$(dirname "$tests")/build/same/differ

# Commands for every model in TREE/models. Elements are 2 to 5 large there; `refine volume` ends with fewer than 30000 hexes.
declare -A commands=(
  [curve]='refine curve 1; refine curve 2 numsplit 2; check'
  [curve_depth]='refine curve 2 depth 1; quality volume all shape histogram; quality volume all all'
  [surface]='refine surface 1 numsplit 2; list surface 1'
  [surface_depth]='refine surface 1 depth 1; undo; refine surface 1 2 depth 2 concave fill'
  [vertex]='refine vertex 1 depth 1 numsplit 2; refine vertex 2; check'
  [volume]='refine volume all; list; undo; refine volume 1 method parallel; quality volume all'
  [hex]='refine hex 1 to 20 method single; undo; refine hex 1 to 20 method parallel; undo; redo; refine hex 150 200'
  [combination]='refine face 1 to 9 by 4 method combination; refine edge 1 2; refine node 50 depth 0; refine node 60 depth 1'
  [size]='refine curve 2 size 1.2 bias 1.5; undo; refine surface 1 size 1.5; undo; refine vertex 1 size 0.6 depth 0'
  [sizing]='sizing function f "1.6 + 0.06*(abs(x) + abs(y) + abs(z))"; sizing function bend curvature 3 growth 1.4;
            sizing function near linear curve 2 size 1.3 growth 1.6; sizing function around interval 12 curve 2;
            sizing function least minimum f near; sizing list; refine volume 1 sizing_function least; undo;
            refine surface 1 sizing_function around bias 1.5; refine volume 1 sizing_function bend'
  [radius]='refine vertex 1 radius 7 numsplit 2; undo; refine curve 2 radius 5; undo; refine hex 40 radius 6'
  [smooth]='refine curve 2 depth 1 smooth; smooth volume all scheme laplacian iterations 5; node in surface 1 position fixed;
            volume 1 smooth scheme condition number; smooth volume 1 iterations 5; smooth hex 1 to 50 boundary fixed'
  [direction]='refine surface 1 direction thickness; undo; refine surface 1 direction layers 3 growth 1.5; undo;
               refine curve 2 direction layers 2; undo; refine face 5 direction thickness numsplit 2'
  [sheet]='list sheet all; refine sheet edge 1; undo; refine sheet intersect edge 9 factor 1.1; undo;
           refine sheet edge 30 greater_than 2; list hex in sheet 1'
  [graded]='refine hex 1 to 4 graded; refine hex in field "level" above 0.5 graded; list; quality hex in field "level" top 9 %'
  [dry_run]='record "made.jou"; refine surface all depth 1 dry_run; refine hex 1 size 0.9 dry_run; refine sheet edge 1 dry_run;
             refine hex 7; record stop; undo; playback "made.jou"'
  [groups]='block 7 hex 1 to 30 name "some"; nodeset 8 curve 2 vertex 1; sideset 9 surface 1 name "one"; sideset 9 face 3 both;
            group "mine" add curve 2 surface 1; list group all; refine curve in mine; refine hex in block 7; undo;
            delete nodeset 8; block 7 remove hex 1 to 9; list block all; list sideset all; export mesh "groups.e";
            export mesh "groups.inp"; export mesh "groups.mesh"'
  [list]='list; list model; list volume all; list surface all; list curve all; list vertex all; list block all; list nodeset all;
          list sideset all; list hex 1 to 30; list face 1 to 30; list edge 1 to 30; list node 1 to 30;
          list hex all with quality shape < 0.7; list curve with length > 9 and z_max > 1; list node (at 0 0 0 ordinal 2);
          list curve common_to surface 1 2; list surface in node 5; {n = 30}; list hex {n + 1}; list undo'
  [draw]='refine vertex 1; draw to "mesh.html"; draw surface 1 quality shape pixels 300 200 to "surface.png";
          draw sheet 1 from 1 0 0 pixels 200 150 to "sheet.png"; draw curve 2 to "curve.html"'
)

# name of a run in every line
names() {
  local model
  journals | sed 's|.*/|journal/|'
  printf '%s\n' demo readme program/{help,words,streams,check,broken} large/{brick,eight,sphere,threads}
  manual_blocks | while read -r block; do
    printf 'manual/%s/%s\n' "$block" brick "$block" cylinder
    # Sizes in the manual are for meshes as fine as those two.
    manual_block "$block" | grep -q size || echo "manual/$block/inclusion"
  done
  for model in $(models); do
    printf "%s/$model\n" "${!commands[@]}" step skin formats
    ! head -2 "$tree/models/$model.msh" | grep -aq '^4.1 0 ' || echo "foreign/$model"
  done
}

journals() { find "$tree/tests" -name journal.jou -printf '%h\n'; }
models() { (cd "$tree/models" && ls -- *.msh) | sed 's/\.msh$//'; }

# What is indented in the manual: examples, and syntax, where what the program answers must stay the same too.
manual_lines() { awk '/^    / { if (!within) ++n; within = 1; printf "%02d%s\n", n, $0; next } /./ { within = 0 }' \
  "$tree/docs/commands.md"; }
manual_blocks() { manual_lines | cut -c1-2 | uniq; }
manual_block() { manual_lines | sed -n "s/^$1    //p"; }

run() {
  local status=0
  timeout 600 hextwist "$@" >>stdout 2>>stderr </dev/null || status=$?
  echo "$status" >>status
}

take() { # MODEL...: copies, as a run may overwrite what it reads
  local model
  for model in "$@"; do cp "$tree/models/$model".{brep,step,msh} .; done
}

export_final='export mesh "final.msh" overwrite; export mesh "final.vtu" overwrite'
reading() { echo "import brep \"$1.brep\"; import mesh \"$1.msh\""; }

# Does a run in the current folder, which is empty.
perform() {
  local kind=${1%%/*} rest=${1#*/} file line status
  local model=$rest
  case $kind in
    journal)
      cp -r "$(journals | grep "/$rest\$")"/. .
      local own=() start=()
      read -ra own < <(sed -n 's/^ *"model": *//p' expect.json | tr -d '[]",') || true
      take "${own[@]}"
      # as in tests/journals/runner.cpp
      if ((${#own[@]})) && ! grep -qiE '^\s*(import|create|playback)\b' journal.jou; then start=(-c "$(reading "${own[0]}")"); fi
      run --keep-going --json report.json "${start[@]}" journal.jou -c "$export_final" ;;
    demo)
      cp -r "$tree/models" .
      models/demo.sh "$program" >stdout 2>stderr || echo $? >status ;;
    readme)
      cp -r "$tree/models" .
      grep '^hextwist ' "$tree/README.md" >lines
      while read -r line; do
        status=0
        bash -c "$line" >>stdout 2>>stderr </dev/null || status=$?
        echo "$status: $line" >>status
      done <lines ;;
    manual)
      local block=${rest%/*} start
      case ${rest#*/} in
        brick) start='create brick x 4 y 3 z 2 interval 8 6 4' ;;
        cylinder) start='create cylinder radius 2 height 4 interval 4' ;;
        inclusion) take inclusion && start=$(reading inclusion) ;;
      esac
      # files that examples read
      take bracket
      mv bracket.step part.step
      mv bracket.msh part.msh
      echo 'create brick x 5 interval 5; refine hex 63' >part.jou
      # Each refinement is taken back, or the mesh would grow with every example. What came before it can't be taken back, so
      # that one that fails leaves things as they are.
      manual_block "$block" | sed -E 's/^refine .*/set undo off\nset undo on\n&\nundo/' >manual.jou
      run --keep-going --json report.json -c "$start" manual.jou -c "$export_final" ;;
    step)  # other ids of curves and vertices than in the .brep; solids of an assembly lie apart in it
      take "$model"
      run --cad "$model.step" "$model.msh" -c 'list curve all; refine curve 1; refine surface 1 depth 1; check' -o final.vtu \
        --json report.json ;;
    skin)
      take "$model"
      run "$model.msh" -c 'list; list surface all; refine curve 1; undo; sizing function bend curvature 3;
        refine volume all sizing_function bend; undo; refine surface 1 depth 1 smooth; check' -o final.msh --json report.json
      run check "$model.msh" --json check.json ;;
    formats) formats "$model" ;;
    foreign) foreign "$model" ;;
    program) program_"$rest" ;;
    large) large_"$rest" ;;
    *)
      take "$model"
      run --keep-going --json report.json -c "$(reading "$model")" -c "${commands[$kind]}" -c "$export_final" ;;
  esac
}

# Every format that is written: from the refined model, read again with and without CAD, refined and written again.
formats() {
  local format
  take "$1"
  run --cad "$1.brep" "$1.msh" -c 'nodeset 20 curve 2; sideset 21 surface 1 name "wall"; block 22 hex 1 to 9; refine hex 5 graded
    export mesh "a.msh"; export mesh "a.e"; export mesh "a.exo"; export genesis "a.g"; export mesh "a.gen"; export mesh "a.inp"
    export mesh "a.mesh"; export mesh "a.vtu"'
  for format in msh e inp mesh vtu; do
    run --cad "$1.brep" "a.$format" -c 'list; list block all; list nodeset all; list sideset all; refine curve 2' \
      -o "b.$format" --json "$format.json"
    run "a.$format" -c 'list; refine hex 1 to 3' -o "c.$format"
    run check "b.$format" --cad "$1.brep"
    head -c "$(($(stat -c %s "a.$format") * 2 / 3))" "a.$format" >"cut.$format"
    run check "cut.$format"
  done
}

# What other programs write and hextwist only reads: Gmsh 2.2, VTK legacy, hexes inside out or inverted.
foreign() {
  local file
  take "$1"
  python3 "$tests/same_formats.py" "$1.msh"
  for file in gmsh22.msh gmsh22_binary.msh legacy.vtk legacy_binary.vtk inside_out.vtk inverted.vtk; do
    run --keep-going --cad "$1.brep" "$file" -c 'list; list block all; refine curve 2; check' -c "export mesh '$file.vtu'" --json "$file.json"
    run "$file" -c 'list; refine hex 1' -o "$file.msh"
  done
  run --cad "$1.brep" -c 'set untangle off; import mesh "inverted.vtk"'
  run --cad "$1.brep" legacy.vtk -c 'refine hex in field "error" top 5 % graded; refine node in field "wished" top 1 %; undo
    sizing field "wished"; refine volume all sizing_function; undo; refine hex in field "error" above 0.5
    sizing function f field "error" file "legacy_binary.vtk"; sizing list; export mesh "fields.e"; export mesh "fields.msh"' \
    -o fields.vtu --json fields.json
  run fields.e -c 'list; list hex with id < 30; refine hex in field "error" top 1 %' -o again.vtu
  run fields.vtu -c 'list; list hex with id < 30; refine hex in field "error" top 1 %' -o again.e
}

program_help() {
  local word
  run --version
  run --help
  run check --help
  run -c help
  for word in $(hextwist -c help | awk '/^  [a-z]+ / { print $1 }' | sort -u) range expr nonsense; do run -c "help $word"; done
}

# What is refused, with which words and exit status.
program_words() {
  local line
  take l_block cam
  run --nonsense
  run a.msh b.msh
  run l_block.msh -o final.nonsense
  run --threads -1
  run check
  run missing.msh
  run --cad missing.brep
  run --cad cam.brep l_block.msh
  run l_block.msh -c 'refine hex 1; refine hex 99999; refine hex 2' -o not_written.vtu --json report.json
  run l_block.msh -c 'refine hex 1; refine hex 99999; refine hex 2' -o not_written.vtu --json going.json --keep-going
  while read -r line; do run l_block.msh -c "$line"; done <<'LINES'
refine crve 3
refine
refine hex
refine hex all except
refine hex 1 numsplit 0
refine hex 1 numsplit 99
refine hex 1 size -1
refine hex 1 depth 1 radius 2
refine hex 1 numsplit 2 size 1
refine curve 1 sizing_function nonsense
refine volume 1 direction thickness
refine hex with quality shape <
refine hex in field "nothing" above 1
refine surface 1 sizing_function "0.1 +* x"
refine curve "unknown"
refine curve 3 to 99
sizing function f "x"; refine volume all sizing_function f
{1 / 0}
{n} {loop(3)}
export mesh "l_block.msh"
export mesh "nowhere/a.msh"
undo 9
redo
nodeset 0 curve 1
delete block 77
draw hex 1 to "a.gif"
create brick x 0
create sphere radius 1 interval 0
create brick x 1 interval 3000000
set threads many
set tolerance -1
playback "missing.jou"
smooth volume 1 scheme nonsense
webcut volume all
quality hex all nonsense
LINES
}

# Commands on standard input, several journals, their order with -c.
program_streams() {
  local status=0
  take plate_quarter
  echo 'refine curve 1' >one.jou
  printf 'refine hex 1 \\\n  to 4\n# remark\nlist; quit\nlist\n' >two.jou
  hextwist --cad plate_quarter.brep plate_quarter.msh -o piped.vtu <two.jou >stdout 2>stderr || status=$?
  echo "$status" >status
  run --cad plate_quarter.brep plate_quarter.msh one.jou -c 'list; record "made.jou"' two.jou -c 'undo' -o final.msh --json a.json
  run -c 'create brick x 2; refine crve 1' one.jou
  printf 'refine hex 1\nrefine hexx 2\n' >three.jou
  run plate_quarter.msh one.jou three.jou
}

program_check() {
  local model
  for model in $(models); do
    take "$model"
    run check "$model.msh" --cad "$model.brep" --json "$model.json"
    run check "$model.msh" --cad "$model.step"
  done
  run check cam.msh --cad bracket.brep --json wrong.json
}

# Faults in files.
program_broken() {
  local file
  take plate_quarter
  sed 's/plate_quarter/other/' plate_quarter.brep >a.brep
  head -c 1500 plate_quarter.brep >cut.brep
  head -c 9000 plate_quarter.step >cut.step
  : >empty.msh
  echo nonsense >nonsense.vtu
  cp nonsense.vtu nonsense.e
  printf '$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1 1 1\n' >short.msh
  # a tetrahedron, a node that does not exist, a node twice, a coordinate that is no number
  printf 'MeshVersionFormatted 2\nDimension 3\nVertices 4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\nTetrahedra 1\n1 2 3 4 0\nEnd\n' >tet.mesh
  printf '*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n' >missing_node.inp
  printf '*NODE\n1, 0, 0, 0\n1, 0, 0, 1\n' >twice.inp
  printf '*NODE\n1, 0, nan, 0\n' >nan.inp
  for file in empty.msh nonsense.vtu nonsense.e short.msh tet.mesh missing_node.inp twice.inp nan.inp; do run check "$file"; done
  for file in a.brep cut.brep cut.step nonsense.e; do run --cad "$file" plate_quarter.msh -c list; done
}

# Large enough for loops to be shared by threads.
large_brick() {
  run -c 'create brick x 40 interval 40; refine surface 1 depth 1; refine vertex 1 numsplit 2; refine hex 20000; undo; redo; check' \
    -o final.vtu --json report.json
}
large_eight() {
  run -c 'create brick x 30 y 20 z 20 interval 30 20 20; refine surface 3 depth 3 method parallel; smooth surface 3 iterations 3' \
    -o final.msh --json report.json
}
large_sphere() {
  run -c 'create sphere radius 9 interval 8; refine volume all; refine curve all depth 1; quality volume all all' \
    -o final.e --json report.json
}
large_threads() {
  local n
  take cam
  for n in 1 3; do
    run --threads $n --cad cam.brep cam.msh -c 'refine volume all; refine surface 3 depth 1 smooth; refine curve 2 size 0.5' \
      -o $n.vtu --json $n.json
  done
}

# Removes what differs from run to run: seconds, peak memory, the folder.
clean() {
  find . -type f \( -name stdout -o -name stderr -o -name '*.json' \) -exec sed -i -E \
    -e "s|$PWD|FOLDER|g" \
    -e 's/, [0-9.]+(e[-+]?[0-9]+)? s$/, SECONDS s/' \
    -e '/"seconds": \{/,/\}/ s/: [-+.0-9e]+(,?)$/: SECONDS\1/' \
    -e 's/("peak_memory_bytes": )[0-9]+/\1MEMORY/' {} +
}

# One run, in a folder of its own in $work.
one() {
  mkdir -p "$work/$1"
  cd "$work/$1"
  perform "$1"
  clean
  printf '%s  %s\n' "$1" "$(find . -type f -printf '%P\n' | sort | xargs -d '\n' sha256sum | sha256sum | cut -d ' ' -f 1)"
  [ -n "${keep:-}" ] || rm -r "$work/${1:?}"
}

# NAME on every line of the input; lines "name  checksum".
all() {
  mkdir -p "$work/.bin"
  ln -sf "$program" "$work/.bin/hextwist"
  PATH="$work/.bin:$PATH" xargs -P 2 -I '{}' "$script" one '{}' | sort
}

# into FILE
sums() {
  names | all >"$1.part" || { echo 'some runs could not be made' >&2; exit 2; }
  mv "$1.part" "$1"
}

action=${1:-}
if [ "$action" != one ]; then
  [[ "$action" = @(sums|compare|keep) && $# -ge 4 ]] || { sed -n '2,/^set /s/^# \{0,1\}//p' "$script" >&2; exit 2; }
  program=$(realpath "$2") tree=$(realpath "$3")
  [ -x "$program" ] || { echo "$program is no program" >&2; exit 2; }
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  export program tree work
fi
case $action in
  one) one "$2" ;;
  sums) sums "$4" ;;
  keep)
    mkdir -p "$4"
    rm -rf "$work"
    work=$(realpath "$4") keep=1
    export keep
    trap - EXIT
    printf '%s\n' "${@:5}" | all >/dev/null
    rm -r "$work/.bin" ;;
  compare)
    rm -rf "$differ"
    sums "$work/now.txt"
    mapfile -t different < <(join -a 1 -a 2 -e - -o 0,1.2,2.2 <(sort "$4") "$work/now.txt" | awk '$2 != $3 { print $1 }')
    if ! ((${#different[@]})); then
      echo "same: $(wc -l <"$work/now.txt") runs"
      exit
    fi
    "$script" keep "$program" "$tree" "$differ/now" "${different[@]}"
    [ -z "${5:-}" ] || "$script" keep "$5" "$tree" "$differ/before" "${different[@]}"
    printf '%s\n' "${different[@]}" | tee "$differ/names"
    echo "${#different[@]} of $(wc -l <"$work/now.txt") runs differ; what they print and write is in $differ"
    exit 1 ;;
esac
