#!/usr/bin/env bash
# Refines the shipped bracket and shows what came out: models/demo.sh PROGRAM [FOLDER FOR THE RESULTS]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$(realpath "${1:?usage: models/demo.sh PROGRAM [FOLDER]}")
cd "${2:-.}"

commands='
  quality volume all shape
  refine surface 6 depth 1   # all hexes that touch the bore
  refine curve 22 depth 1    # the concave corner of the L
  refine vertex 9 depth 1    # a corner of the foot
  quality volume all shape
  export vtk "hextwist-demo.vtu" overwrite
  export gmsh "hextwist-demo.msh" overwrite
  draw to "hextwist-demo.png" overwrite
'
echo "hextwist --cad models/bracket.brep models/bracket.msh -c '$commands' --json hextwist-demo.json"
echo
"$program" --cad "$here/bracket.brep" "$here/bracket.msh" -c "$commands" --json hextwist-demo.json
"$program" view hextwist-demo.msh --cad "$here/bracket.brep" --before "$here/bracket.msh" -o hextwist-demo.html &&
  page="  hextwist-demo.html   the viewer, for any browser: pick, cut, colour; click 'Before' for the mesh as it was" ||
  page="  (hextwist-demo.html is not there, for the reason above)"

cat <<DONE

The refined bracket is in
$page
  hextwist-demo.png    a picture
  hextwist-demo.vtu    for ParaView:  paraview hextwist-demo.vtu   (show "Surface With Edges", colour by shape)
  hextwist-demo.msh    for Gmsh:      gmsh hextwist-demo.msh
  hextwist-demo.json   what each command did: counts, quality, distance from the CAD, seconds

The program is $program.  To find it by its name:
  export PATH="$(dirname "$program"):\$PATH"      or: ./dev install
DONE
