#!/usr/bin/env bash
# Tests of the Editor assembly without Unity: compiled by mono's C# 7.2 compiler against the stand-ins of Unity's classes, run
# under NUnit on mono with the real library. Ends with how many passed and failed.
#
# SUPERDEFORM_LIBRARY  the built library (default: target/release/libsuperdeform.so, else target/debug/libsuperdeform.so)
# SUPERDEFORM_EXAMPLE  the built command line (default: target/release/examples/superdeform, else target/debug/examples/superdeform);
#                      without one the comparisons with it are left out, and say so
# SUPERDEFORM_MODELS   more models (default ../shared/models); tests of models that are not there are left out, and say so
# SUPERDEFORM_OUT      where assemblies and projects go (default target/unity/headless)
# SUPERDEFORM_RUN      run only this fixture or test, such as SuperDeform.Editor.Tests.ExampleTests
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
export SUPERDEFORM_REPOSITORY=$PWD
library=${SUPERDEFORM_LIBRARY:-}
example=${SUPERDEFORM_EXAMPLE:-}
for profile in release debug; do
  [[ -z $library && -e target/$profile/libsuperdeform.so ]] && library=target/$profile/libsuperdeform.so
  [[ -z $example && -x target/$profile/examples/superdeform ]] && example=$PWD/target/$profile/examples/superdeform
done
[[ -n $library ]] || { echo "no libsuperdeform.so in target: build it, or set SUPERDEFORM_LIBRARY"; exit 1; }
export SUPERDEFORM_EXAMPLE=$example
mkdir -p "${SUPERDEFORM_OUT:=target/unity/headless}"
SUPERDEFORM_OUT=$(realpath "$SUPERDEFORM_OUT")
export SUPERDEFORM_OUT
out=$SUPERDEFORM_OUT
tests=unity/Tests~
# Not beside the assemblies: mono would find it there whatever LD_LIBRARY_PATH says.
mkdir -p "$out/library" "$out/other_library"
cp "$library" "$out/library/libsuperdeform.so"
rm -rf "$out/projects"

bash "$tests/build.sh" "$out"

# A character with a clip that sets places.
python3 "$tests/Glb/walk.py" tests/data/kaykit_rogue.glb "$out/kaykit_walk.glb"

# A library of a version that will never be.
echo 'unsigned sdef_abi_version(void) { return 0x00FF0000u; }' >"$out/other.c"
cc -shared -fPIC -o "$out/other_library/libsuperdeform.so" "$out/other.c"

nunit=$(find /usr/lib/cli /usr/lib/mono -name nunit.framework.dll 2>/dev/null | sort | head -n 1)
cp "$nunit" "$out/"
references=()
for name in SuperDeform UnityEngine UnityEditor SuperDeform.Editor VRM VRM10 SuperDeform.Editor.Vrm0 SuperDeform.Editor.Vrm1 SuperDeform.Avatar SuperDeform.Editor.Ndmf nadena.dev.ndmf.runtime nadena.dev.ndmf System.Collections.Immutable nunit.framework; do
  [[ -e $out/$name.dll ]] && references+=("-r:$out/$name.dll")
done
mapfile -t sources < <(find "$tests/Headless" "$tests/Glb" "$tests/WindowPicture" -name '*.cs' | sort)
mcs -nologo -langversion:7.2 -unsafe -debug -warn:0 -target:library -out:"$out/SuperDeform.Editor.Tests.dll" "${references[@]}" "${sources[@]}"
mcs -nologo -langversion:7.2 -debug -warn:0 -target:exe -out:"$out/ConvertOnce.exe" "${references[@]}" -r:"$out/SuperDeform.Editor.Tests.dll" "$tests/Programs/ConvertOnce.cs"

cd "$out"
export LD_LIBRARY_PATH=$out/library
status=0
nunit-console -nologo -nodots -labels ${SUPERDEFORM_RUN:+-run="$SUPERDEFORM_RUN"} -xml:"$out/result.xml" SuperDeform.Editor.Tests.dll >"$out/log" 2>&1 || status=$?
grep -v -e '^$' -e '^ProcessModel' -e '^Execution Runtime' -e 'CLR Version' "$out/log" || true
summary=$(grep -E '^Tests run: ' "$out/log" || true)
if [[ $summary =~ Tests\ run:\ ([0-9]+),\ Errors:\ ([0-9]+),\ Failures:\ ([0-9]+) ]]; then
  wrong=$((BASH_REMATCH[2] + BASH_REMATCH[3]))
  not_run=$(sed -n 's/.*Not run: \([0-9]*\).*/\1/p' "$out/log" | head -n 1)
  echo "$((BASH_REMATCH[1] - wrong)) passed, $((wrong + ${not_run:-0})) failed"
  ((wrong + ${not_run:-0} == 0))
else
  echo "NUnit ended with $status and without a summary"
  echo "0 passed, 1 failed"
  exit 1
fi
