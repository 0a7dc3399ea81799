#!/usr/bin/env bash
# Compiles every assembly of the package by mono's C# 7.2 compiler, against the stand-ins of Unity's and UniVRM's classes,
# which hold nothing newer than Unity 2021.3. Ends with how many assemblies passed and failed.
#
# build.sh OUT   OUT: the folder for the assemblies
#
# SUPERDEFORM_ASSEMBLIES  another folder, where they have just been made: they are copied from there
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mkdir -p "$1"
out=$(realpath "$1")
if [[ -n ${SUPERDEFORM_ASSEMBLIES:-} && ! $SUPERDEFORM_ASSEMBLIES -ef $out ]]; then
  cp "$SUPERDEFORM_ASSEMBLIES"/* "$out"
  echo "$(find "$SUPERDEFORM_ASSEMBLIES" -name '*.dll' | wc -l) passed, 0 failed"
  exit
fi
passed=0
failed=0

# assembly NAME "REFERENCES" "FLAGS" FOLDER...: compiles all C# of the folders, warnings as errors.
assembly() {
  local name=$1 references=$2 flags=$3 sources=() arguments=()
  shift 3
  mapfile -t sources < <(find "$@" -name '*.cs' | sort)
  for reference in $references; do arguments+=("-r:$out/$reference.dll"); done
  # shellcheck disable=SC2086
  if ((${#sources[@]} > 0)) && mcs -nologo -langversion:7.2 -target:library -debug -warnaserror -out:"$out/$name.dll" \
    "${arguments[@]}" -d:UNITY_2021_3_OR_NEWER $flags "${sources[@]}"; then
    passed=$((passed + 1))
  else
    echo "FAILED: $name (${#sources[@]} sources)"
    failed=$((failed + 1))
  fi
}

assembly SuperDeform "" "-unsafe -d:UNITY_EDITOR" Runtime/*.cs
nunit=$(find /usr/lib/cli /usr/lib/mono -name nunit.framework.dll 2>/dev/null | sort | tail -n 1)
assembly SuperDeform.Tests SuperDeform "-unsafe -d:UNITY_EDITOR -d:UNITY_INCLUDE_TESTS -r:$nunit" Tests/Runtime
assembly UnityEngine "" "-unsafe -nowarn:67,108,114,169,414,649,660,661" Tests~/UnityStubs/Engine
assembly UnityEditor "UnityEngine" "-unsafe -nowarn:67,108,114,169,414,649,660,661" Tests~/UnityStubs/Editor
# As in a project without NDMF, and as in one with it.
assembly nadena.dev.ndmf.runtime UnityEngine "" Tests~/NdmfStubs/Runtime
assembly System.Collections.Immutable "" "" Tests~/NdmfStubs/Immutable
assembly nadena.dev.ndmf "nadena.dev.ndmf.runtime System.Collections.Immutable UnityEngine UnityEditor" "" Tests~/NdmfStubs/Editor
assembly SuperDeform.Avatar.Alone UnityEngine "" Runtime/Avatar
assembly SuperDeform.Avatar "nadena.dev.ndmf.runtime UnityEngine" "-d:UNITY_EDITOR -d:SUPERDEFORM_NDMF" Runtime/Avatar
editor="SuperDeform SuperDeform.Avatar nadena.dev.ndmf.runtime UnityEngine UnityEditor"
mapfile -t folders < <(find Editor -mindepth 1 -maxdepth 1 -type d ! -name 'Vrm?' ! -name Ndmf)
assembly SuperDeform.Editor "$editor" "-unsafe -d:UNITY_EDITOR" "${folders[@]}"
for version in 0 1; do
  library=$([[ $version == 0 ]] && echo VRM || echo VRM10)
  assembly "$library" UnityEngine "-nowarn:649" Tests~/UniVrmStubs/Vrm$version
  assembly SuperDeform.Editor.Vrm$version "$editor SuperDeform.Editor $library" -d:UNITY_EDITOR Editor/Vrm$version
done
assembly SuperDeform.Editor.Ndmf "$editor SuperDeform.Editor nadena.dev.ndmf System.Collections.Immutable" -d:SUPERDEFORM_NDMF Editor/Ndmf
assembly QuickStart "$editor SuperDeform.Editor" -d:UNITY_EDITOR Samples~/QuickStart

echo "$passed passed, $failed failed"
((failed == 0))
