#!/usr/bin/env bash
# The headers compile without a warning in every language and with every compiler that is here; which are not is printed.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
warnings="-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wundef -Werror -fsyntax-only -Iinclude"
failed=0
count=0
# compiles COMPILER STANDARD LANGUAGE HEADER
compiles() {
  count=$((count + 1))
  if ! echo "#include \"$4\"" | "$1" "-std=$2" $warnings -x "$3" -; then
    echo "$4 with $1 -std=$2: FAILED"
    failed=1
  fi
}
is_here() {
  command -v "$1" >/dev/null && return
  echo "skipped: no $1 here"
  return 1
}
for compiler in gcc clang x86_64-w64-mingw32-gcc; do
  is_here $compiler || continue
  for standard in c99 c11 c17; do compiles $compiler $standard c superdeform.h; done
done
for compiler in g++ clang++ x86_64-w64-mingw32-g++; do
  is_here $compiler || continue
  for standard in c++11 c++14 c++17 c++20; do compiles $compiler $standard c++ superdeform.h; done
  for standard in c++17 c++20; do compiles $compiler $standard c++ superdeform.hpp; done
done
echo "$count combinations"
((count > 0)) && exit $failed
