#!/usr/bin/env bash
# compare.sh CLI COMPARE EXAMPLE TARGET REFERENCE: the host in C++ and the one in Rust make the same of one character.
set -euo pipefail
cli=$1 compare=$2 example=$3 target=$4 reference=$5
for file in "$target" "$example"; do
  [[ -e $file ]] || { echo "skipped: $file is not there"; exit 77; }
done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
name=$(basename "$target")
"$example" --quiet "$target" "$reference" -o "$scratch/rust_$name" --picture "$scratch/p.png" --report "$scratch/r.json" 2>/dev/null ||
  "$example" --quiet "$target" "$reference" -o "$scratch/rust_$name"
"$cli" "$target" "$reference" "$scratch/cpp_$name"
ls -l "$scratch" | awk '{print $5, $9}'
"$compare" "$scratch/rust_$name" "$scratch/cpp_$name" 1e-6
