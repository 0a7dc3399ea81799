#!/usr/bin/env bash
# Builds the targets with AddressSanitizer and the coverage that libFuzzer reads; prints the folder they are in.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
host=$(rustc -vV | sed -n 's/^host: //p')
# The sanitizer's run time comes with the stable toolchain, but the switch for it is unstable.
export RUSTC_BOOTSTRAP=1
export RUSTFLAGS="-Zsanitizer=address --cfg fuzzing"
export RUSTC_WRAPPER=$PWD/instrument.sh
# A named target keeps build scripts and macros free of all this.
cargo build --quiet --locked --release --target "$host" "$@"
echo "$PWD/target/$host/release"
