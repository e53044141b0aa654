#!/bin/sh
# Packs the built program and its data for tests/bench/gpu_session.sh. GPU_BUNDLE is a tool that packs a program with its
# shared libraries: GPU_BUNDLE OUT PROGRAM... Usage: tests/bench/bundle.sh BUILD_DIR OUT [TEST_PROGRAM...]
set -eu
build=$1 out=$2
shift 2
"${GPU_BUNDLE:?names the tool that packs a program with its libraries}" "$out" "$build/petrichor" "$@"
data=$out/share/petrichor
mkdir -p "$data/content"
for made in city.glb streaks.exr; do cp "$build/content/$made" "$data/content/"; done
cp content/ladders.csv "$data/content/"
find scripts engine systems \( -name '*.lua' -o -name '*.glsl' -o -name '*.h' \) -exec cp --parents {} "$data" \;
