#!/usr/bin/env bash
# run.sh BUILD: what other programs take for what the benchmarks do, to BUILD/peers.txt. One thread each.
set -euo pipefail
peers="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
build=$1
mkdir -p "$build/peers"
export OMP_NUM_THREADS=1 DEAL_II_NUM_THREADS=1
: > "$build/peers.txt"
/usr/bin/python3 "$peers/vtk_peer.py" "$build/peers" | tee -a "$build/peers.txt"
/usr/bin/python3 "$peers/gmsh_peer.py" "$build/peers" | tee -a "$build/peers.txt"
cmake -S "$peers" -B "$build/peers" -G Ninja --log-level=WARNING -DCMAKE_BUILD_TYPE=Release
cmake --build "$build/peers"
"$build/peers/peer_dealii" | tee -a "$build/peers.txt"
