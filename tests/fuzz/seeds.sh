#!/usr/bin/env bash
# seeds.sh PROGRAM FOLDER: small files of every kind to start from, a folder for each target.
set -euo pipefail
program=$(readlink -f "$1") source=$(cd "$(dirname "$0")/../.." && pwd)
mkdir -p "$2" && cd "$2"
mkdir -p gmsh abaqus medit mfem vtk vtu exodus nastran unv lsdyna ansys nek cad_text grammar engine

rich='create brick x 2 interval 1 2 1; block 1 hex 1 name "a"; block 2 hex 2; nodeset 3 surface 1 name "b"; sideset 4 surface 2 name "c"'
for brick in 'create brick x 1 interval 1; block 7 volume 1' "$rich" "$rich; refine vertex 1"; do
  name=$(printf %s "$brick" | cksum | cut -d' ' -f1)
  "$program" -c "$brick; export gmsh 'gmsh/$name.t41.msh' text overwrite; export gmsh 'gmsh/$name.b41.msh' overwrite
    export gmsh 'gmsh/$name.t22.msh' text version 2.2 overwrite; export gmsh 'gmsh/$name.b22.msh' version 2.2 overwrite
    export vtk 'vtu/$name.b.vtu' overwrite; export vtk 'vtu/$name.t.vtu' text overwrite; export abaqus 'abaqus/$name.inp' overwrite
    export medit 'medit/$name.mesh' overwrite; export medit 'medit/$name.2.mesh' order 2 overwrite
    export lsdyna 'lsdyna/$name.k' overwrite; export lsdyna 'lsdyna/$name.2.k' order 2 overwrite
    export ansys 'ansys/$name.cdb' overwrite; export ansys 'ansys/$name.2.cdb' order 2 overwrite
    export nek 'nek/$name.re2' overwrite; export nek 'nek/$name.2.re2' order 2 overwrite
    export mfem 'mfem/$name.mfem' overwrite; export mfem 'mfem/$name.2.mfem' order 2 overwrite
    export nastran 'nastran/$name.bdf' overwrite; export nastran 'nastran/$name.2.bdf' order 2 overwrite
    export unv 'unv/$name.unv' overwrite; export unv 'unv/$name.2.unv' order 2 overwrite; export exodus 'exodus/$name.e' overwrite" > /dev/null
done
for form in ASCII BINARY; do
  python3 - "$form" > "vtk/$form.vtk" <<'PY'
import struct, sys
text = sys.argv[1] == "ASCII"
out = sys.stdout.buffer
points = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
def put(code, values):
    out.write((" ".join(map(str, values)) if text else struct.pack(">%d%s" % (len(values), code), *values).decode("latin1")).encode("latin1") + b"\n")
out.write(b"# vtk DataFile Version 3.0\nseed\n%s\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n" % sys.argv[1].encode())
put("d", [float(c) for p in points for c in p])
out.write(b"CELLS 1 9\n"); put("i", [8, 0, 1, 3, 2, 4, 5, 7, 6])
out.write(b"CELL_TYPES 1\n"); put("i", [12])
out.write(b"POINT_DATA 8\nSCALARS u double 1\nLOOKUP_TABLE default\n"); put("d", [0.5] * 8)
PY
done
cat > abaqus/parts.inp <<'INP'
*PART, NAME=P
*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 1, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 1, 0, 1
7, 1, 1, 1
8, 0, 1, 1
*ELEMENT, TYPE=C3D8, ELSET=E
1, 1, 2, 3, 4, 5, 6, 7, 8
*NSET, NSET=N, GENERATE
1, 8, 2
*SURFACE, NAME=S
E, S1
*END PART
*ASSEMBLY, NAME=A
*INSTANCE, NAME=I, PART=P
1, 0, 0
*END INSTANCE
*END ASSEMBLY
*BOUNDARY
I.N, 1, 3
INP
cp "$source"/models/l_block.{brep,step} "$source"/models/cylinder.{brep,step} cad_text
for journal in "$source"/tests/journals/*/*.jou; do cp "$journal" "grammar/$(basename "$(dirname "$journal")")"; done

# Words that mean something: the texts in the sources of each reader.
words() { grep -ohE '"[^"\\]{2,24}"' "${@:2}" | LC_ALL=C grep -v '[^ -~]' | sort -u > "$1.words" || true; }
for format in gmsh abaqus medit mfem exodus nastran unv lsdyna ansys nek; do words $format "$source/io/$format"/*.cpp; done
words vtk "$source"/io/vtk/*.cpp && cp vtk.words vtu.words
words cad_text "$source"/geom/occ/cad_text.cpp
words grammar "$source"/command/*.cpp
echo '"\x00"' > engine.words
printf '\1\5\0\0\1\1\5\2\0\0\3\2\5\1\7\1\2\3\4\0\1\1\1\6\3' > engine/a
