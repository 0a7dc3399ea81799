#!/usr/bin/env bash
# Every function of superdeform.h is called by the test in C and by superdeform.hpp, and everything that superdeform.hpp
# offers is called by the test in C++.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
functions=$(grep -oE '^SDEF_API (SdefStatus|uint32_t|uint64_t|const char \*) ?\*?sdef_[a-z_]+\(' include/superdeform.h | grep -oE 'sdef_[a-z_]+')
count=$(wc -w <<<"$functions")
((count >= 25)) || { echo "only $count functions found in superdeform.h: has its form changed?"; exit 1; }
failed=0
for function in $functions; do
  grep -qE "\b$function\(" cpp_tests/calls.c || { echo "cpp_tests/calls.c does not call $function"; failed=1; }
  # Some go by their address.
  grep -qE "\b$function\b" include/superdeform.hpp || { echo "superdeform.hpp does not call $function"; failed=1; }
done
methods=$(sed -n '/^class Character/,/^#endif/p' include/superdeform.hpp |
  grep -oE '^ {0,2}(static |inline |void |auto |std::[a-z:_<>0-9]+ |Sdef[A-Za-z]+ |Joints |Style |std::vector<[A-Za-z]+> )+[a-z_]+\(' |
  grep -oE '[a-z_]+\($' | tr -d '(' | sort -u)
((${#methods} > 100)) || { echo "the methods of superdeform.hpp were not found"; exit 1; }
for method in $methods; do
  [[ $method == from_heads_like ]] && continue
  grep -qE "(\.|::)$method\(" cpp_tests/wrapper.cpp cpp_tests/hosts.hpp || { echo "no test in C++ calls $method"; failed=1; }
done
echo "$count functions, $(wc -w <<<"$methods") methods"
exit $failed
