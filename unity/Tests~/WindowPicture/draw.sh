#!/usr/bin/env bash
# Draws the pictures of the window that stand in Documentation~ anew. draw.sh OUT [FOLDER]
# OUT: the folder with the assemblies that build.sh made. SUPERDEFORM_LIBRARY: the built library.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."
export SUPERDEFORM_REPOSITORY=$PWD
out=$(realpath "$1")
folder=$(realpath "${2:-unity/Documentation~}")
library=$(realpath "${SUPERDEFORM_LIBRARY:-target/release/libsuperdeform.so}")
nunit=$(find /usr/lib/cli /usr/lib/mono -name nunit.framework.dll 2>/dev/null | sort | head -n 1)
references=()
for name in SuperDeform UnityEngine UnityEditor SuperDeform.Editor; do references+=("-r:$out/$name.dll"); done
# Under the name of the tests' assembly, which may see what is internal.
mkdir -p "$out/picture"
cp "$out"/*.dll "$out/picture/"
cp "$nunit" "$out/picture/"
mcs -nologo -langversion:7.2 -warn:0 -out:"$out/picture/SuperDeform.Editor.Tests.exe" "${references[@]}" -r:"$nunit" \
  unity/Tests~/WindowPicture/*.cs unity/Tests~/Glb/*.cs unity/Tests~/Headless/Models.cs
rm -f "$out/picture/SuperDeform.Editor.Tests.dll"
LD_LIBRARY_PATH=$(dirname "$library") SUPERDEFORM_OUT="$out/picture" mono "$out/picture/SuperDeform.Editor.Tests.exe" "$folder"
