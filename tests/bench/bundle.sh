#!/bin/sh
# Packs the built program and its data for tests/bench/gpu_session.sh. GPU_BUNDLE is a tool that packs a program with its
# shared libraries: GPU_BUNDLE OUT PROGRAM. Usage: tests/bench/bundle.sh BUILD_DIR OUT
set -eu
"${GPU_BUNDLE:?names the tool that packs a program with its libraries}" "$2" "$1/petrichor"
data=$2/share/petrichor
mkdir -p "$data/content"
for made in city.glb streaks.exr; do cp "$1/content/$made" "$data/content/"; done
cp content/ladders.csv "$data/content/"
find scripts engine systems \( -name '*.lua' -o -name '*.glsl' -o -name '*.h' \) -exec cp --parents {} "$data" \;
