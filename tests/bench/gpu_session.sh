#!/bin/sh
# The GPU figures of docs/performance.md, on a machine that has only a driver: the built program and its libraries in
# BUNDLE (bin, lib, run), the data beside it. One call, minutes: tests/bench/gpu_session.sh BUNDLE OUT
set -u
bundle=$(cd "$1" && pwd)
run="$bundle/run petrichor"
out=$2
export PETRICHOR_DATA="$bundle/share/petrichor"
$run info | sed -n '/^Device/,/^$/p'
for case in "38000000 1280x720" "5000000 1280x1024" "200000 1280x720"; do
  set -- $case
  $run bench rain --drops "$1" --size "$2" --frames 120
done
film=scripts/cinematics/first_rain.lua
for rain in 50 0; do
  $run render $film --size 1280x720 --frames 200:230 --set emitter.rain_mm_per_hour=$rain --out "$out/rain$rain%04d.png" --stats "$out/city$rain.json"
  cat "$out/city$rain.json"
done
rm -f "$out"/rain*02[0-2][1-9].png "$out"/rain*0220.png
for rate in 0.5 10 100; do $run measure rain --rate $rate; done
