#!/bin/bash
# What parts cost: time, memory, messages and bytes of several processes, and of one that goes from disk to disk.
#   parts.sh BUILD [N ...]: cubes of N hexes a side (20 40 80), each twice as fine as the one before: bytes that go with
#   surfaces become four times as many, those that go with volumes eight times.
set -euo pipefail
programs=$(cd "$1" && pwd)/app
shift
sizes=("${@:-20 40 80}")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
run=(mpirun --oversubscribe --allow-run-as-root)
printf '%-22s %9s %6s %8s %9s %12s %12s %10s %8s\n' refinement hexes parts seconds messages bytes 'MiB/process' '/arrays' 'max/avg'
for n in ${sizes[*]}; do
  "$programs/hextwist" -c "create brick x 1 interval $n $n $n" -o whole.e > /dev/null
  for command in "refine volume all" "refine surface 1 depth 1"; do
    for parts in 1 2 4 8; do
      "$programs/hextwist" split whole.e $parts --by boxes -o split.e > /dev/null
      begin=$(date +%s.%N)
      "${run[@]}" -n $parts "$programs/hextwist-mpi" split.e.$parts.0 --rings 6 -c "$command" -o fine.e > out
      end=$(date +%s.%N)
      read -r mib arrays messages bytes < <(sed -n 's/at most \([0-9]*\) MiB a process, \([0-9.]*\) times .*; sent \([0-9]*\) messages, \([0-9]*\) bytes/\1 \2 \3 \4/p' out)
      load=$(sed -n 's/the largest part has \([0-9.e+-]*\) times.*/\1/p' out | tail -1)
      hexes=$(sed -n 's/.* -> \([0-9]*\) hexes in .*/\1/p' out | tail -1)
      printf '%-22s %9s %6s %8.2f %9s %12s %12s %10s %8s\n' "${command#refine }, $n^3" "$hexes" $parts \
        "$(awk "BEGIN { print $end - $begin }")" "$messages" "$bytes" "$mib" "$arrays" "$load"
      rm -f split.e.* fine.e.*
    done
  done
  "$programs/hextwist" split whole.e 8 --by boxes -o split.e > /dev/null
  "$programs/hextwist" refine-in-parts split.e.8.0 --rings 6 -c "refine volume all" -o fine.e |
    sed -n "s/^at most/volume all, $n^3, from disk to disk in 8 parts: at most/p"
  rm -f split.e.* fine.e.* whole.e
done
