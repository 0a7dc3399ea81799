//! What `fuzz/` does, for a few seconds and without its instruments: the seeds as they are, then changed at random in a
//! sequence that is the same each time. A fault ends the process; the input that showed it is left in target/tmp/smoke.
//!
//! SUPERDEFORM_SMOKE_SECONDS: how long the seeds are changed, for all targets together (default 6).

#[allow(dead_code, unsafe_code)]
#[path = "../fuzz/lib.rs"]
mod fuzz;

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Longer inputs are cut; few seeds are longer.
const MAX_SIZE: usize = 16384;

/// splitmix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ mixed >> 31
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }
}

/// Changes, adds, removes, repeats or takes bytes from another seed.
fn mutate(data: &mut Vec<u8>, seeds: &[Vec<u8>], random: &mut Random, max_size: usize) {
    for _ in 0..1 + random.below(6) {
        let at = random.below(data.len());
        match random.below(7) {
            0 | 1 if !data.is_empty() => data[at] = random.next() as u8,
            2 if !data.is_empty() => data[at] ^= 1 << random.below(8),
            3 => {
                let new: Vec<u8> = (0..1 + random.below(8)).map(|_| random.next() as u8).collect();
                data.splice(at..at, new);
            }
            4 if !data.is_empty() => drop(data.drain(at..(at + 1 + random.below(16)).min(data.len()))),
            5 if !data.is_empty() => {
                let piece = data[at..(at + 1 + random.below(64)).min(data.len())].to_vec();
                let to = random.below(data.len());
                data.splice(to..to, piece);
            }
            _ => {
                let other = &seeds[random.below(seeds.len())];
                let from = random.below(other.len());
                let piece = other[from..(from + random.below(256)).min(other.len())].to_vec();
                data.splice(at.., piece);
            }
        }
        data.truncate(max_size);
    }
}

struct Target {
    name: &'static str,
    run: fn(&[u8]),
    input: PathBuf,
    runs: usize,
}

impl Target {
    fn new(name: &'static str, run: fn(&[u8])) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("smoke");
        fs::create_dir_all(&folder).unwrap();
        Self { name, run, input: folder.join(name), runs: 0 }
    }

    fn seeds(&self) -> Vec<Vec<u8>> {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(self.name);
        let mut files: Vec<PathBuf> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        files.iter().map(|file| fs::read(file).unwrap()).collect()
    }

    fn run(&mut self, data: &[u8]) {
        // Whatever ends the process, what did it is there.
        fs::write(&self.input, data).unwrap();
        fuzz::in_time(|| (self.run)(data));
        self.runs += 1;
    }

    /// The seeds, then for so long the seeds changed by `change`.
    fn try_for(mut self, time: Duration, mut change: impl FnMut(&mut Vec<u8>, &[Vec<u8>], &mut Random)) {
        let seeds = self.seeds();
        assert!(!seeds.is_empty());
        for seed in &seeds {
            self.run(seed);
        }
        let mut random = Random(1);
        let start = Instant::now();
        while start.elapsed() < time {
            let mut data = seeds[random.below(seeds.len())].clone();
            change(&mut data, &seeds, &mut random);
            self.run(&data);
        }
        println!("{}: {} runs", self.name, self.runs);
        fs::remove_file(&self.input).unwrap();
    }
}

/// One after the other: the handles that are alive are counted.
#[test]
fn whatever_the_bytes_the_answer_is_a_status() {
    let seconds = std::env::var("SUPERDEFORM_SMOKE_SECONDS")
        .map_or(6.0, |seconds| seconds.parse().expect("SUPERDEFORM_SMOKE_SECONDS is a number of seconds"));
    let time = Duration::from_secs_f64(seconds / 3.0);
    let plain = |data: &mut Vec<u8>, seeds: &[Vec<u8>], random: &mut Random| {
        mutate(data, seeds, random, MAX_SIZE);
    };
    fuzz::abi::start();
    Target::new("abi", fuzz::abi::run).try_for(time, plain);
    Target::new("meshes", fuzz::meshes::run).try_for(time, plain);
    Target::new("glb", fuzz::glb::run).try_for(time, |data, seeds, random| {
        let size = data.len().min(MAX_SIZE);
        data.resize(MAX_SIZE, 0);
        let seed = random.next() as u32;
        let size = fuzz::glb::mutate(data, size, MAX_SIZE, seed, &mut |data, size, max_size| {
            let mut bytes = data[..size].to_vec();
            mutate(&mut bytes, seeds, random, max_size);
            data[..bytes.len()].copy_from_slice(&bytes);
            bytes.len()
        });
        data.truncate(size);
    });
}
