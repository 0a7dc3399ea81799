#!/usr/bin/env bash
# compare.sh CLI COMPARE EXAMPLE TARGET REFERENCE YOUTH: the host in C++ and the one in Rust make the same of one character,
# and everything that is not reshaped comes out of the host in C++ as it went in.
set -euo pipefail
cli=$1 compare=$2 example=$3 target=$4 reference=$5 youth=$6
for file in "$target" "$example"; do
  [[ -e $file ]] || { echo "skipped: $file is not there"; exit 77; }
done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
name=$(basename "$target")
"$example" --quiet --youth "$youth" "$target" "$reference" -o "$scratch/rust_$name"
"$cli" "$target" "$reference" "$scratch/cpp_$name" 2>/dev/null
printf '%-42s' "$name"
# No two decoders of JPEG give the same pixels, and by these irises are measured.
tolerance=1e-6
if grep -qa image/jpeg "$target"; then tolerance=1e-4; fi
# Where a rig is made the two differ in last digits (1e-8 without profiles), and by these a profile's ray that runs along an
# edge meets it or not: as much as tests/laws allows.
if ! grep -qa '"skins"' "$target"; then tolerance=5e-5; fi
"$compare" "$scratch/rust_$name" "$scratch/cpp_$name" "$tolerance"
# The comparison sees a difference where there is one.
"$example" --quiet --heads 1.8 "$target" -o "$scratch/other_$name"
if "$compare" "$scratch/other_$name" "$scratch/cpp_$name" 1e-2 >/dev/null 2>&1; then
  echo "1.8 heads are the same"
  exit 1
fi
if command -v python3 >/dev/null; then
  python3 "$(dirname "${BASH_SOURCE[0]}")/kept.py" "$target" "$scratch/cpp_$name" "$scratch/rust_$name"
fi
