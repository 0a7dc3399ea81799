#!/usr/bin/env bash
# Packs the npm package and uses it from another folder, by node and by a bundler: bash try.sh WASM.
# Ends with how many passed and failed.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
bash "$here/pack.sh" "$1" "$scratch/packed"
mkdir "$scratch/user"
cd "$scratch/user"
echo '{"type": "module", "private": true}' >package.json
npm install --silent --no-audit --no-fund --offline "$scratch"/packed/superdeform-*.tgz
cp "$here/../../tests/data/kaykit_rogue.glb" avatar.vrm
passed=0
failed=0
tried() {
  local name=$1
  shift
  if "$@"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAIL $name"
  fi
}

# The lines of the README, as they are.
sed -n '/^```js$/,/^```$/p' "$here/README.md" | grep -v '^```' >readme.js
tried "README" node readme.js
tried "result" test "$(head -c 4 avatar_sd.vrm)" = glTF
cat >refused.js <<'END'
import superdeform, { Refused } from 'superdeform';
const refused = await superdeform(new Uint8Array(9), { name: 'nine.glb' }).catch((error) => error);
if (!(refused instanceof Refused && refused.message.startsWith('nine.glb'))) throw refused;
const option = await superdeform(new Uint8Array(9), { beauty: 1 }).catch((error) => error);
if (!(option instanceof Refused)) throw option;
END
tried "refusal" node refused.js
cat >bundled.js <<'END'
import { readFile } from 'node:fs/promises';
import superdeform, { load } from 'superdeform';
import wasm from 'superdeform/superdeform.wasm';
load(wasm);
const { report } = await superdeform(await readFile('avatar.vrm'), { style: 'sd2', youth: 0.5 });
console.log(`bundled: ${report.result.heads.toFixed(2)} heads`);
END
# As for a browser, but for reading the file.
"$here/../node_modules/.bin/esbuild" bundled.js --bundle --format=esm --target=es2022 --platform=browser --external:node:fs/promises \
  --loader:.wasm=binary --outfile=out/bundle.js --log-level=error
tried "bundler" node out/bundle.js
ls -l "$scratch"/packed/*.tgz | awk '{print "the package has", $5, "bytes"}'
echo "$passed passed, $failed failed"
((failed == 0))
