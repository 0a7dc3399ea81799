#!/usr/bin/env bash
# Puts the npm package together and packs it: bash pack.sh WASM FOLDER. The tarball lies in FOLDER.
set -euo pipefail
wasm=$(realpath "$1")
folder=$(realpath -m "$2")
cd "$(dirname "${BASH_SOURCE[0]}")"
rm -rf "$folder"
mkdir -p "$folder/package"
cp package.json README.md index.d.ts ./*.js ../src/engine.js ../../LICENSE-MIT ../../LICENSE-APACHE "$folder/package"
cp "$wasm" "$folder/package/superdeform.wasm"
python3 ../../.ci/bill.py page notices wasm32-unknown-unknown >"$folder/package/third-party-notices.md"
cd "$folder/package"
npm pack --silent --pack-destination "$folder"
