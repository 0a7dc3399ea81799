#!/usr/bin/env bash
# Builds and runs MemoryBench on mono. memory.sh OUT [VERTICES [SHAPES [SHARE]]]
# OUT: the folder with the assemblies that build.sh made. SUPERDEFORM_LIBRARY: the built library, a release one.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
out=$(realpath "$1")
shift
library=$(realpath "${SUPERDEFORM_LIBRARY:-$here/../../../target/release/libsuperdeform.so}")
mcs -nologo -langversion:7.2 -optimize -out:"$out/MemoryBench.exe" -r:"$out/SuperDeform.dll" -r:"$out/UnityEngine.dll" \
  -r:"$out/UnityEditor.dll" -r:"$out/SuperDeform.Editor.dll" "$here/MemoryBench.cs" "$here/../Headless/WindowFigure.cs"
LD_LIBRARY_PATH=$(dirname "$library") mono "$out/MemoryBench.exe" "$@"
