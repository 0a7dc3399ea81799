#!/usr/bin/env bash
# package.sh BUILD CMAKE CHARACTER.obj: installs what BUILD holds into a temporary folder, and lets other projects there find it: by
# CMake (shared and static) and by pkg-config, all after the folder was moved.
set -euo pipefail
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$1
cmake=$2
character=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$cmake" --install "$build" --prefix "$scratch/first" >/dev/null
mv "$scratch/first" "$scratch/moved"
prefix=$scratch/moved
# Stripped, and with licences.
if readelf -S "$(find "$prefix" -name libsuperdeform.so)" "$(find "$prefix" -name libsuperdeform.a)" | grep -q '\.debug_'; then
  echo "what was installed has lines for debuggers"
  exit 1
fi
for file in LICENSE-MIT LICENSE-APACHE third-party-notices.md; do
  [[ -s $(find "$prefix" -name $file) ]] || { echo "$file was not installed"; exit 1; }
done
mkdir "$scratch/project"
cp "$source/examples/minimal.c" "$scratch/project"
cat >"$scratch/project/hello.cpp" <<'END'
#include <superdeform.hpp>
#include <cstdio>
int main() {
  std::puts(superdeform::Style::from_text("sd3") ? "found" : "lost");
  return superdeform::live_handles() == 0 ? 0 : 1;
}
END
cat >"$scratch/project/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.20)
project(consumer LANGUAGES C CXX)
find_package(superdeform 1.0 REQUIRED)
foreach(kind superdeform static)
  add_executable(minimal_${kind} minimal.c)
  target_link_libraries(minimal_${kind} PRIVATE superdeform::${kind})
  add_executable(hello_${kind} hello.cpp)
  target_compile_features(hello_${kind} PRIVATE cxx_std_17)
  target_link_libraries(hello_${kind} PRIVATE superdeform::${kind})
endforeach()
add_library(plugin MODULE plugin.c)
target_link_libraries(plugin PRIVATE superdeform::static)
END
cat >"$scratch/project/plugin.c" <<'END'
#include <superdeform.h>
uint32_t plugin_version(void) { return sdef_abi_version(); }
END
"$cmake" -S "$scratch/project" -B "$scratch/build" -DCMAKE_PREFIX_PATH="$prefix" >"$scratch/log" || { cat "$scratch/log"; exit 1; }
"$cmake" --build "$scratch/build" >"$scratch/log" || { cat "$scratch/log"; exit 1; }
# deforms PROGRAM: minimal.c, built as PROGRAM, gives as many lines as it got, and others.
deforms() {
  "$1" <"$character" >"$scratch/after.obj"
  [[ $(wc -l <"$scratch/after.obj") == $(wc -l <"$character") ]] && ! cmp -s "$character" "$scratch/after.obj" && return
  echo "$1 has not deformed the character"
  return 1
}
for kind in superdeform static; do
  deforms "$scratch/build/minimal_$kind"
  said=$("$scratch/build/hello_$kind")
  [[ $said == found ]]
done
# A plugin exports what is its own.
exported=$(nm -D --defined-only "$(find "$scratch/build" -name 'libplugin*')" | awk '{ print $NF }')
[[ $exported == plugin_version ]] || { echo "a plugin exports $(wc -w <<<"$exported") functions:" $exported; exit 1; }
# The one needs the shared library, the other does not.
readelf -d "$scratch/build/minimal_superdeform" | grep -q 'NEEDED.*\[libsuperdeform.so\]'
needs_no_library() {
  if readelf -d "$1" | grep -q superdeform; then
    echo "$1 needs the shared library"
    exit 1
  fi
}
needs_no_library "$scratch/build/minimal_static"
if command -v pkg-config >/dev/null; then
  pc=$(dirname "$(find "$prefix" -name superdeform.pc)")
  export PKG_CONFIG_PATH=$pc
  flags=$(pkg-config --cflags --libs superdeform)
  libdir=$(pkg-config --variable=libdir superdeform)
  # shellcheck disable=SC2086
  ${CC:-cc} -std=c99 "$scratch/project/minimal.c" $flags -o "$scratch/by_pkg_config"
  LD_LIBRARY_PATH=$libdir deforms "$scratch/by_pkg_config"
  # shellcheck disable=SC2046
  ${CC:-cc} -std=c99 "$scratch/project/minimal.c" $(pkg-config --cflags --libs --static superdeform-static) \
    -o "$scratch/static_by_pkg_config"
  deforms "$scratch/static_by_pkg_config"
  needs_no_library "$scratch/static_by_pkg_config"
else
  echo "skipped: no pkg-config here"
fi
