#!/usr/bin/env bash
# Stands before rustc: what is under test counts its branches for libFuzzer, what it is built on does not.
for argument in "$@"; do
  case $argument in
    superdeform | superdeform_host | superdeform_fuzz | abi | glb | meshes | gltf | gltf_json)
      exec "$@" -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=3 \
        -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table
      ;;
  esac
done
exec "$@"
