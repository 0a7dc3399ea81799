#!/usr/bin/env bash
# refuses.sh CLI COMPARE DATA: what cannot be read ends in one sentence and exit code 1, and leaves no file.
set -uo pipefail
cli=$1 compare=$2 data=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failed=0
refuses() {
  local code=0
  "$cli" "$@" >"$scratch/out" 2>"$scratch/err" || code=$?
  if [[ $code != 1 || ! -s $scratch/err || -e $scratch/never.glb ]]; then
    echo "superdeform_cli $*: exit code $code"
    cat "$scratch/err"
    failed=1
  fi
}
good=$data/quaternius_female_dress.glb
head -c 5000 "$good" >"$scratch/short.glb"
echo "no model" >"$scratch/text.glb"
refuses "$scratch/absent.glb" sd3 "$scratch/never.glb"
refuses "$scratch/short.glb" sd3 "$scratch/never.glb"
refuses "$scratch/text.glb" sd3 "$scratch/never.glb"
refuses "$good" 99 "$scratch/never.glb"
refuses "$good" sd9 "$scratch/never.glb"
refuses "$good" sd3 "$scratch/no_folder/never.glb"
"$cli" >/dev/null 2>&1
[[ $? == 2 ]] || { echo "no arguments: no usage"; failed=1; }
"$cli" "$good" sd3 "$scratch/good.glb" >/dev/null && "$compare" "$scratch/good.glb" "$scratch/good.glb" >/dev/null || failed=1
exit $failed
