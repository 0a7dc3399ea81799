#!/usr/bin/env bash
# The adapters for UniVRM on stand-ins of its classes: springs, colliders and viewpoints of the new avatar against what the
# example program writes for the same file. Ends with how many passed and failed.
#
# SUPERDEFORM_LIBRARY     the built library (default: target/release/libsuperdeform.so, else target/debug/...)
# SUPERDEFORM_EXAMPLE     the built example program (default: the one beside the library); nothing can be compared without
# SUPERDEFORM_MODELS      a folder of more characters (default ../shared/models): godette.vrm
# SUPERDEFORM_ASSEMBLIES  where build.sh has put the assemblies (default: built anew)
# SUPERDEFORM_OUT         where everything goes (default target/unity/vrm)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
library=${SUPERDEFORM_LIBRARY:-}
for profile in release debug; do
  [[ -z $library && -e target/$profile/libsuperdeform.so ]] && library=target/$profile/libsuperdeform.so
done
[[ -n $library ]] || { echo "no libsuperdeform.so in target: build it, or set SUPERDEFORM_LIBRARY"; exit 1; }
example=${SUPERDEFORM_EXAMPLE:-$(dirname "$library")/examples/superdeform}
models=${SUPERDEFORM_MODELS:-../shared/models}
mkdir -p "${SUPERDEFORM_OUT:=target/unity/vrm}"
out=$(realpath "$SUPERDEFORM_OUT")
tests=unity/Tests~
if [[ ! -x $example ]]; then
  echo "skipped: no example program beside $library, so there is nothing to compare with"
  echo "0 passed, 0 failed"
  exit
fi

assemblies=${SUPERDEFORM_ASSEMBLIES:-}
if [[ -z $assemblies ]]; then
  assemblies=$out/assemblies
  bash "$tests/build.sh" "$assemblies"
fi
cp "$assemblies"/*.dll "$out"
nunit=$(pkg-config --variable=Libraries nunit 2>/dev/null | tr ' ' '\n' | grep 'nunit.framework.dll' || true)
[[ -e $nunit ]] || nunit=$(find /usr/lib/cli /usr/lib/mono -name nunit.framework.dll 2>/dev/null | sort | tail -n 1)
cp "$nunit" "$out"
mkdir -p "$out/library"
cp "$library" "$out/library/libsuperdeform.so"

# deform NAME: the file's springs as lines, and those of the example program's result.
deform() {
  python3 "$tests/Vrm/springs.py" list "$out/$1.vrm" >"$out/$1.txt"
  "$example" "$out/$1.vrm" --heads 1.8 --quiet -o "$out/$1_sd.vrm"
  python3 "$tests/Vrm/springs.py" list "$out/$1_sd.vrm" >"$out/$1_sd.txt"
}
python3 "$tests/Vrm/springs.py" fixture tests/data/kaykit_rogue.glb "$out/rogue.vrm"
deform rogue
rm -f "$out/godette.vrm"
if [[ -e $models/godette.vrm ]]; then
  cp "$models/godette.vrm" "$out/godette.vrm"
  deform godette
fi

references=()
for name in SuperDeform UnityEngine UnityEditor SuperDeform.Editor SuperDeform.Editor.Vrm0 SuperDeform.Editor.Vrm1 VRM VRM10 \
  nunit.framework; do
  references+=("-r:$out/$name.dll")
done
mcs -nologo -langversion:7.2 -debug -target:library -nowarn:649 -out:"$out/SuperDeform.Tests.Vrm.dll" "${references[@]}" \
  "$tests"/Glb/*.cs "$tests"/Vrm/*.cs
export LD_LIBRARY_PATH=$out/library SUPERDEFORM_VRM=$out
nunit-console -nologo -nodots -noshadow -nothread -domain=None -process=Single -xml="$out/result.xml" \
  "$out/SuperDeform.Tests.Vrm.dll" >"$out/nunit.log" 2>&1 || true
if [[ $(cat "$out/nunit.log") =~ Tests\ run:\ ([0-9]+),\ Errors:\ ([0-9]+),\ Failures:\ ([0-9]+) ]]; then
  wrong=$((BASH_REMATCH[2] + BASH_REMATCH[3]))
  right=$((BASH_REMATCH[1] - wrong))
  ((wrong == 0)) || cat "$out/nunit.log"
  grep -A 99 '^Tests not run' "$out/nunit.log" | grep -E '^[0-9]+\)' | sed 's/^/skipped: /' || true
  echo "$right passed, $wrong failed"
  ((wrong == 0))
else
  cat "$out/nunit.log"
  exit 1
fi
