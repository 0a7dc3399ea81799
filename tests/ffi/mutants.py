#!/usr/bin/env python3
"""Faults that somebody could make in src/ffi, and whether a test notices each.

    python3 tests/ffi/mutants.py [NUMBER...]

Builds a copy of the sources, in target/mutants, that has all faults, of which SUPERDEFORM_MUTANT switches on one; runs for
each the test that must fail then, and all of these without a fault, where they must pass. Takes a build of its own (ten
minutes of the processor), so no usual run does this: it is for changes of src/ffi and of the tests named here.
Ends with how many were caught; exit code 1 where one was not.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WORK = ROOT / "target" / "mutants"
COPY = WORK / "source"

# What is wrong; the file in src/ffi; what stands there, once; what stands there instead, MUTANT being true where this one is
# switched on; the test that must fail: a host of cpp_tests, or a test of tests/ffi.rs.
MUTANTS = [
    ("arrays are read as packed", "arrays.rs",
     "start.is_null(), count, stride, size_of::<T>())?;",
     "start.is_null(), count, if MUTANT { 0 } else { stride }, size_of::<T>())?;",
     "calls"),
    ("repair is off by default", "options.rs", "repair: options.repair as u32,",
     "repair: if MUTANT { 0 } else { options.repair as u32 },", "calls"),
    ("inverse binds are of the old rest", "deformer/mod.rs", "rest.w_axis = at.extend(1.0);",
     "if !MUTANT { rest.w_axis = at.extend(1.0); }", "calls"),
    ("a host's jobs are not used", "jobs.rs", "parallel::set_jobs(jobs.map(",
     "parallel::set_jobs(jobs.filter(|_| !MUTANT).map(", "calls"),
    ("the target's figure is the result's", "deformer/mod.rs", "SDEF_FIGURE_TARGET => figure_of(&report.target),",
     "SDEF_FIGURE_TARGET => figure_of(if MUTANT { &report.result } else { &report.target }),", "calls"),
    ("one element more than there is room for", "arrays.rs",
     "return Ok(Self::none());\n        }\n        if capacity < count {",
     "return Ok(Self::none());\n        }\n        if capacity + usize::from(MUTANT) < count {", "lifecycle"),
    ("a destroyed handle is found", "handles.rs",
     "let entry = table.slots.get(slot).filter(|entry| entry.generation == generation)?;",
     "let entry = table.slots.get(slot).filter(|entry| MUTANT || entry.generation == generation)?;", "lifecycle"),
    ("structs of one array have any sizes", "arrays.rs", "if own as usize != size {",
     "if own as usize != size && !MUTANT {", "lifecycle"),
    ("Jacobians are given row by row", "deformer/mod.rs", "|point| point.jacobian.to_cols_array()",
     "|point| if MUTANT { point.jacobian.transpose() } else { point.jacobian }.to_cols_array()", "contract"),
    ("a report stays after a change", "deformer/deformer_state.rs", "self.report = OnceLock::new();",
     "if !MUTANT { self.report = OnceLock::new(); }", "contract"),
    ("memory is not asked for", "memory.rs", "let mut held = reserve(bytes);",
     "if MUTANT {\n        return work();\n    }\n    let mut held = reserve(bytes);", "memory"),
    ("a rig's number of threads is ignored", "options.rs", "thread_count: given.thread_count as usize,\n        ..RigOptions",
     "thread_count: if MUTANT { 0 } else { given.thread_count as usize },\n        ..RigOptions", "no_threads"),
    ("limits are ignored", "options.rs", 'limits: switch("limits", given.limits)?,',
     'limits: switch("limits", given.limits)? || MUTANT,', "options_that_are_set_later_give_what_a_new_deformer_gives"),
    ("a height of 0 is none", "options.rs", "Some(0.0) => Height::Keep,",
     "Some(0.0) => if MUTANT { Height::Style } else { Height::Keep },",
     "options_that_are_set_later_give_what_a_new_deformer_gives"),
    # What they are over does not matter: weights are made to sum up to 1.
    ("of weights of 16 bits 8 are read", "character/read.rs", "at.cast::<u16>().add(column).read_unaligned()) /",
     "if MUTANT { u16::from(*at.add(column)) } else { at.cast::<u16>().add(column).read_unaligned() }) /",
     "strides_and_types_change_nothing"),
    ("the stride of rest matrices is ignored", "character/read.rs", "count, given.rest_stride)",
     "count, if MUTANT { 0 } else { given.rest_stride })", "every_mistake_gets_its_status_and_a_sentence"),
    ("what a newer host sets is dropped", "arrays.rs", ".find(|&at| is_set(at)) {",
     ".find(|&at| is_set(at) && !MUTANT) {", "fields"),
    ("rig_left_handed is ignored", "options.rs", 'switch("rig_left_handed", given.rig_left_handed)?',
     'switch("rig_left_handed", given.rig_left_handed)? && !MUTANT', "fields"),
    ("uv_stride is ignored", "character/read.rs", "given.uv_stride)", "if MUTANT { 0 } else { given.uv_stride })", "fields"),
    ("luminance_stride is ignored", "character/read.rs", "given.luminance_stride)",
     "if MUTANT { 0 } else { given.luminance_stride })", "fields"),
    ("an image's row_stride is ignored", "character/read.rs", "given.row_stride,",
     "if MUTANT { 0 } else { given.row_stride },", "fields"),
    ("the stride of a morph target's normals is ignored", "character/mod.rs", "given.normals, given.normal_stride)",
     "given.normals, if MUTANT { 0 } else { given.normal_stride })", "fields"),
    ("the half height of eyes is dropped", "character/read.rs",
     "let SdefFaceHints { half_width, half_height, .. } = *given;",
     "let SdefFaceHints { half_width, half_height, .. } = *given;\n        let half_height = if MUTANT { 0.0 } else { half_height };",
     "fields"),
    ("what a collider yields is not told", "deformer/colliders.rs", "yielded: mapped.yielded,",
     "yielded: if MUTANT { 0.0 } else { mapped.yielded },", "fields"),
]

SWITCH = """
/// True where the fault `number` is switched on.
pub fn mutant(number: u32) -> bool {
    static NUMBER: std::sync::OnceLock<Option<u32>> = std::sync::OnceLock::new();
    *NUMBER.get_or_init(|| std::env::var("SUPERDEFORM_MUTANT").ok()?.parse().ok()) == Some(number)
}
"""


def run(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, **options)


def copied():
    """The files of the repository, as they are now, with all faults in them."""
    listed = run("git", "ls-files", "-co", "--exclude-standard", "-z", cwd=ROOT, capture_output=True, text=True).stdout
    shutil.rmtree(COPY, ignore_errors=True)
    for name in filter(None, listed.split("\0")):
        if (ROOT / name).is_file():
            (COPY / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, COPY / name)
    # A source file that is older than what was built of it is not built again.
    for number, (what, file, old, new, _) in enumerate(MUTANTS, 1):
        path = COPY / "src" / "ffi" / file
        text = path.read_text()
        if text.count(old) != 1:
            sys.exit(f"{number} ({what}) finds its place {text.count(old)} times in src/ffi/{file}: bring it up to date")
        path.write_text(text.replace(old, new.replace("MUTANT", f"crate::ffi::mutant({number})")))
    with open(COPY / "src" / "ffi" / "mod.rs", "a") as file:
        file.write(SWITCH)


def built():
    """How each test is run, by its name."""
    cargo = ["cargo", "--locked", "--target-dir", WORK / "target"]
    environment = {**os.environ, "CARGO_INCREMENTAL": "0", "RUSTFLAGS": "--cap-lints=warn"}
    build = [cargo[0], "build", *cargo[1:], "--package", "superdeform-capi"]
    run(*build, cwd=COPY, env=environment)
    test = [cargo[0], "test", *cargo[1:], "--package", "superdeform", "--test", "ffi", "--no-run", "--message-format=json"]
    said = run(*test, cwd=COPY, env=environment, stdout=subprocess.PIPE, text=True).stdout
    messages = [json.loads(line) for line in said.splitlines() if line.startswith("{")]
    rust = next(m["executable"] for m in messages if m.get("executable") and m["target"]["name"] == "ffi")
    hosts = sorted({test for *_, test in MUTANTS if (COPY / "cpp_tests" / f"{test}.c").exists() or
                    (COPY / "cpp_tests" / f"{test}.cpp").exists()})
    folder = WORK / "hosts"
    configure = ["cmake", "-S", COPY, "-B", folder, "-DCMAKE_BUILD_TYPE=Debug", "-DSUPERDEFORM_GLTF=OFF"]
    library = WORK / "target" / "debug" / "libsuperdeform.so"
    run(*configure, f"-DSUPERDEFORM_LIBRARY={library}", stdout=subprocess.DEVNULL)
    run("cmake", "--build", folder, "--target", *hosts, stdout=subprocess.DEVNULL)
    commands = {host: [folder / "cpp_tests" / host] for host in hosts}
    for *_, test in MUTANTS:
        # Tests of modules have these before their names.
        commands.setdefault(test, [rust, "--test-threads=1", test])
    return commands


def passes(command, number):
    environment = {**os.environ, "SUPERDEFORM_MUTANT": str(number)}
    try:
        done = subprocess.run([str(word) for word in command], env=environment, cwd=COPY, timeout=600,
                              capture_output=True, text=True)
    except subprocess.TimeoutExpired:
        return False
    # A filter that finds no test would pass.
    return done.returncode == 0 and "running 0 tests" not in done.stdout


def main():
    wanted = [int(word) for word in sys.argv[1:]] or range(1, len(MUTANTS) + 1)
    copied()
    commands = built()
    sound = {test: passes(command, 0) for test, command in commands.items()}
    for test in (test for test, passed in sound.items() if not passed):
        print(f"FAILED without a fault: {test}")
    caught = 0
    for number in wanted:
        what, *_, test = MUTANTS[number - 1]
        is_caught = sound[test] and not passes(commands[test], number)
        caught += is_caught
        print(f"{number:2} {'caught' if is_caught else 'MISSED'} by {test}: {what}", flush=True)
    print(f"{caught} of {len(wanted)} caught")
    sys.exit(0 if caught == len(wanted) else 1)


main()
