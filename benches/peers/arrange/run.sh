#!/bin/sh
# Builds the programs, makes the inputs and compares all libraries on each: run.sh [FOLDER [ROUNDS]].
# Each round runs every program once; look at the least time of each.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
work=${1:-/tmp/arrange-peers}
rounds=${2:-3}
mkdir -p "$work"
export CARGO_TARGET_DIR="$work/target"
(cd "$here" && cargo build --release --quiet)
[ -x "$work/cgal" ] || g++ -O3 -march=native -DNDEBUG -std=c++17 "$here/cgal.cpp" -o "$work/cgal" -lgmp -lmpfr
peers="$CARGO_TARGET_DIR/release/arrange-peers"
"$peers" write "$work/inputs"
for input in layer-20k:20 layer-100k:10 random-2000:1; do
    file="$work/inputs/${input%:*}.txt"
    runs=${input#*:}
    for round in $(seq "$rounds"); do
        "$peers" fgm "$file" "$runs"
        "$peers" i_overlay "$file" "$runs"
        "$work/cgal" "$file" "$runs"
        python3 "$here/geos.py" "$file" "$runs" plain
        python3 "$here/geos.py" "$file" "$runs" grid
    done
done
