//! How often a run says how far it is, and how soon it can be stopped.

#[path = "common/people.rs"]
mod people;

use people::Person;
use std::sync::Arc;
use std::time::Instant;
use superdeform::{
    Character, Deformer, ErrorKind, Options, Progress, Result, Rig, RigOptions, Style, Weights,
};

fn dressed() -> Arc<Character> {
    Arc::new(Person { skirt: true, ..Person::adult() }.build())
}

fn bare() -> Character {
    let mut character = Person { blended: true, ..Person::adult() }.build();
    character.skeleton = Default::default();
    character.humanoid = Default::default();
    character.meshes.iter_mut().for_each(|mesh| mesh.weights = Weights::default());
    character
}

fn rig(progress: &mut Progress) -> Result<()> {
    Rig::with_progress(&bare(), &RigOptions::default(), progress).map(|_| ())
}

fn create(progress: &mut Progress) -> Result<()> {
    Deformer::with_progress(dressed(), &Style::Heads(2.5), &Options::default(), progress).map(|_| ())
}

type Call = fn(&mut Progress) -> Result<()>;

const CALLS: [(&str, Call); 2] = [("rig", rig), ("create", create)];

/// What a run reports, and after how many seconds.
fn reports(call: Call) -> Vec<(f32, f64)> {
    let mut reports = Vec::new();
    let start = Instant::now();
    let mut report = |fraction| {
        reports.push((fraction, start.elapsed().as_secs_f64()));
        true
    };
    call(&mut Progress::new(&mut report)).unwrap();
    reports
}

#[test]
fn a_run_reports_twenty_times_and_never_leaps() {
    for (name, call) in CALLS {
        let fractions: Vec<f32> = reports(call).into_iter().map(|(fraction, _)| fraction).collect();
        assert!(fractions.len() >= 20, "{name}: {} reports", fractions.len());
        assert_eq!((fractions[0], fractions[fractions.len() - 1]), (0.0, 1.0), "{name}");
        let steps: Vec<f32> = fractions.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(steps.iter().all(|step| (0.0..0.1001).contains(step)), "{name}: {fractions:?}");
    }
}

#[test]
fn a_run_can_be_stopped_at_every_report() {
    for (name, call) in CALLS {
        let count = reports(call).len();
        for stop_at in (0..count).step_by(5) {
            let mut calls = 0;
            let mut stop = |_| {
                calls += 1;
                calls <= stop_at
            };
            let error = call(&mut Progress::new(&mut stop)).unwrap_err();
            assert_eq!((error.kind, calls), (ErrorKind::Cancelled, stop_at + 1), "{name}");
        }
    }
}

#[test]
#[ignore = "measures time: run it alone, on a machine that does nothing else"]
fn no_silence_is_longer_than_a_tenth_of_a_run() {
    for (name, call) in CALLS {
        let reports = reports(call);
        let all = reports.last().unwrap().1;
        for pair in reports.windows(2) {
            println!(
                "{name}: {:.3} to {:.3}: {:.3} of the time",
                pair[0].0,
                pair[1].0,
                (pair[1].1 - pair[0].1) / all
            );
        }
        let longest = reports.windows(2).map(|pair| pair[1].1 - pair[0].1).fold(0.0, f64::max) / all;
        assert!(longest <= 0.1, "{name}: {longest:.2} of the time without a report");
    }
}
