#!/usr/bin/env bash
# Refines the shipped bracket and shows what came out: models/demo.sh PROGRAM [FOLDER FOR THE RESULTS]
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
program=$(realpath "${1:?usage: models/demo.sh PROGRAM [FOLDER]}")
cd "${2:-.}"

commands='
  quality volume all shape
  refine surface 6            # everything that touches the bore
  refine curve 22             # the concave corner of the L: cut once ...
  refine vertex 6 numsplit 2  # one outer corner of the foot, twice
  quality volume all shape
  export vtk "hextwist-demo.vtu" overwrite
  export gmsh "hextwist-demo.msh" overwrite
'
echo "hextwist --cad models/bracket.step models/bracket.msh -c '$commands' --json hextwist-demo.json"
echo
"$program" --cad "$here/bracket.step" "$here/bracket.msh" -c "$commands" --json hextwist-demo.json

cat <<DONE

The refined bracket is in
  hextwist-demo.vtu    for ParaView:  paraview hextwist-demo.vtu   (show "Surface With Edges", colour by shape)
  hextwist-demo.msh    for Gmsh:      gmsh hextwist-demo.msh
  hextwist-demo.json   what each command did: counts, quality, distance from the CAD, seconds
DONE
