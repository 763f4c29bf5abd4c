//! Checks of every law at the plugin interface: batches, threads, memory, and invalid numbers.

use super::rig::{PRESSURE, Rig};
use super::static_memory::static_memory;
use super::{Check, CheckResult};
use crate::laws::LawError;
use crate::laws::bench::{Bench, BenchMotion, BenchOutputs, BenchState};
use std::sync::Barrier;

/// The first check: a law that fails it may corrupt the memory of all later ones.
pub const FIRST: (&str, Check) = ("columns", columns);

/// The checks after [`FIRST`], with their names.
pub const CHECKS: [(&str, Check); 8] = [
    ("range", range),
    ("batch", batch),
    ("static memory", static_memory),
    ("threads", threads),
    ("restore", restore),
    ("no hidden state", hidden),
    ("bad numbers", bad_numbers),
    ("floating point", floating_point),
];

/// The checks that depend on parameters; the others depend on the code only.
pub const OF_PARAMETERS: [(&str, Check); 2] = [CHECKS[0], CHECKS[6]];

/// Moves a batch of `n` contacts along walks, each walk used by several contacts if there are fewer
/// than `n`; returns the bits of all outputs. `turn` changes which contact takes which walk.
pub fn run_batch(
    bench: &mut Bench,
    walks: &[Vec<BenchMotion>],
    n: usize,
    turn: usize,
) -> Result<Vec<u64>, LawError> {
    let mut states: Vec<BenchState> = (0..n).map(|_| bench.fresh()).collect();
    let mut out = Vec::new();
    for step in 0..walks[0].len() {
        let walk = |k: usize| &walks[(k * (turn + 1) + turn) % walks.len()];
        let motions: Vec<BenchMotion> = (0..n).map(|k| walk(k)[step]).collect();
        out.extend(bits(&bench.step(&mut states, &motions, 1e-3)?));
    }
    Ok(out)
}

/// Checks that a law writes to its outputs only, and returns equal results for equal inputs.
fn columns(rig: &mut Rig) -> Result<CheckResult, LawError> {
    const KEPT: &str = "writes to inputs, to the state before the step, up to 256 kB outside the columns; different results for equal inputs";
    // The scale of the law is not known yet.
    let onset = rig.onset;
    for scale in [1e-9, 1e-7, 1e-5, 1e-3] {
        rig.onset = scale;
        let walks: Vec<Vec<BenchMotion>> =
            (0..17).map(|k| rig.random_walk(60 + k, 8, 0.5)).collect();
        let moved = run_batch(&mut rig.strict_bench().guarded(), &walks, 17, 0);
        rig.onset = onset;
        // Other errors are found by other checks.
        if let Err(e @ LawError::ContractViolation { .. }) = moved {
            return Err(e);
        }
    }
    Ok(CheckResult::passed("columns", 0.0, KEPT))
}

/// Checks that the law has left rounding and subnormal numbers of its caller as they are, in all
/// calls so far.
fn floating_point(rig: &mut Rig) -> Result<CheckResult, LawError> {
    const CHECK: &str = "floating point";
    let kept = "leaves rounding and subnormal numbers of its caller as they are";
    Ok(match rig.tested().plugin.disturbs_floating_point() {
        None => CheckResult::passed(CHECK, 0.0, kept),
        Some(when) => {
            let text =
                format!("it changes rounding or flushes subnormal numbers for its caller {when}");
            CheckResult::failed(CHECK, 1.0, text)
        }
    })
}

/// Checks that outputs are within their physical range; other errors are left to other checks.
fn range(rig: &mut Rig) -> Result<CheckResult, LawError> {
    let walks: Vec<Vec<BenchMotion>> = (0..17).map(|k| rig.random_walk(80 + k, 200, 0.3)).collect();
    match run_batch(&mut rig.strict_bench(), &walks, 17, 0) {
        Err(e @ LawError::OutOfRange { .. }) => Err(e),
        _ => Ok(CheckResult::passed(
            "range",
            0.0,
            "values out of range, such as a negative friction or stiffness, or a damage above one",
        )),
    }
}

/// Returns the bits of all outputs except conductances.
fn bits(answers: &[BenchOutputs]) -> Vec<u64> {
    let numbers = answers.iter().flat_map(|a| {
        let rest = [a.stored, a.damage, a.mu, a.worn];
        a.traction
            .into_iter()
            .chain(a.moment)
            .chain(a.stiffness)
            .chain(a.restitution)
            .chain(a.strength)
            .chain(a.rolling)
            .chain(rest)
    });
    numbers.map(f64::to_bits).collect()
}

/// Moves one contact along motions; returns the bits of all outputs.
fn run_one(
    bench: &mut Bench,
    state: &mut BenchState,
    motions: &[BenchMotion],
) -> Result<Vec<u64>, LawError> {
    let mut out = Vec::new();
    for motion in motions {
        out.extend(bits(&[bench.step_one(state, motion, 1e-3)?]));
    }
    Ok(out)
}

/// Moves a new contact along motions; returns the bits of all outputs.
fn run_new(bench: &mut Bench, motions: &[BenchMotion]) -> Result<Vec<u64>, LawError> {
    let mut state = bench.fresh();
    run_one(bench, &mut state, motions)
}

/// Checks that a batch of n gives the same bits as n batches of one.
fn batch(rig: &mut Rig) -> Result<CheckResult, LawError> {
    const N: usize = 17;
    let walks: Vec<Vec<BenchMotion>> = (0..N as u64)
        .map(|k| rig.random_walk(40 + k, 60, 0.3))
        .collect();
    let mut batched: Vec<BenchState> = (0..N).map(|_| rig.bench.fresh()).collect();
    let mut alone = batched.clone();
    let mut different = 0u32;
    for step in 0..60 {
        let motions: Vec<BenchMotion> = walks.iter().map(|w| w[step]).collect();
        let answers = rig.bench.step(&mut batched, &motions, 1e-3)?;
        for k in 0..N {
            let one = rig.bench.step(&mut alone[k..=k], &motions[k..=k], 1e-3)?;
            different += u32::from(bits(&one) != bits(&answers[k..=k]));
        }
    }
    Ok(CheckResult::below(
        "batch",
        f64::from(different),
        0.0,
        "results of a batch of 17 that differ from batches of one",
    ))
}

/// Checks that many threads at once get the same bits, on the same contacts and on others.
fn threads(rig: &mut Rig) -> Result<CheckResult, LawError> {
    let motions = rig.random_walk(3, 200, 0.3);
    let expected = run_new(&mut rig.bench, &motions)?;
    let mut benches: Vec<Bench> = (0..8).map(|_| rig.second_bench()).collect();
    let same: u32 = std::thread::scope(|scope| {
        let runs: Vec<_> = benches
            .iter_mut()
            .map(|bench| {
                let run = || run_new(bench, &motions).is_ok_and(|b| b == expected);
                std::thread::Builder::new().spawn_scoped(scope, run)
            })
            .collect();
        // A thread that could not be started counts as a failure.
        runs.into_iter()
            .map(|run| u32::from(!run.is_ok_and(|r| r.join().unwrap_or(false))))
            .sum()
    });
    let other = other_contacts(rig)?;
    Ok(CheckResult::below(
        "threads",
        f64::from(same + other),
        0.0,
        "of 8 concurrent threads on the same contacts and 4 on others, those that could not be started or differed from a single thread",
    ))
}

/// Returns the number of threads with different results when each has its own contacts. Each thread
/// repeats every call, so that calls overlap even if threads share one processor.
fn other_contacts(rig: &mut Rig) -> Result<u32, LawError> {
    const THREADS: usize = 4;
    const N: usize = 1024;
    let walks: Vec<Vec<BenchMotion>> = (0..61).map(|k| rig.random_walk(200 + k, 2, 0.3)).collect();
    let mut alone = Vec::new();
    for turn in 0..THREADS {
        alone.push(run_batch(&mut rig.second_bench(), &walks, N, turn)?);
    }
    let start = Barrier::new(THREADS);
    let (rig, start, walks, alone) = (&*rig, &start, &walks, &alone);
    Ok(std::thread::scope(|scope| {
        let runs: Vec<_> = (0..THREADS)
            .map(|turn| {
                let mut bench = rig.strict_bench().repeating();
                scope.spawn(move || {
                    start.wait();
                    run_batch(&mut bench, walks, N, turn).is_ok_and(|bits| bits == alone[turn])
                })
            })
            .collect();
        let runs = runs.into_iter();
        runs.map(|run| u32::from(!run.join().unwrap_or(false)))
            .sum()
    }))
}

/// Checks that a contact saved in the middle of a path and restored elsewhere continues unchanged.
fn restore(rig: &mut Rig) -> Result<CheckResult, LawError> {
    let motions = rig.random_walk(11, 200, 0.3);
    let (before, after) = motions.split_at(100);
    let mut state = rig.bench.fresh();
    run_one(&mut rig.bench, &mut state, before)?;
    let mut saved = state.clone();
    let rest = run_one(&mut rig.bench, &mut state, after)?;
    let again = run_one(&mut rig.second_bench(), &mut saved, after)?;
    let different = rest.iter().zip(&again).filter(|(a, b)| a != b).count();
    Ok(CheckResult::below(
        "restore",
        different as f64,
        0.0,
        "numbers that differ after saving and restoring a contact",
    ))
}

/// Checks that another contact's path in between has no effect.
fn hidden(rig: &mut Rig) -> Result<CheckResult, LawError> {
    let (mine, other) = (rig.random_walk(21, 150, 0.3), rig.random_walk(22, 150, 0.5));
    let alone = run_new(&mut rig.bench, &mine)?;
    let mut states = [rig.bench.fresh(), rig.bench.fresh()];
    let mut between = Vec::new();
    for (a, b) in mine.iter().zip(&other) {
        rig.bench.step_one(&mut states[1], b, 1e-3)?;
        between.extend(bits(&[rig.bench.step_one(&mut states[0], a, 1e-3)?]));
    }
    let different = alone.iter().zip(&between).filter(|(a, b)| a != b).count();
    Ok(CheckResult::below(
        "no hidden state",
        different as f64,
        0.0,
        "numbers that differ when another contact moves in between",
    ))
}

/// Checks that any input gives an error status or finite outputs.
fn bad_numbers(rig: &mut Rig) -> Result<CheckResult, LawError> {
    let bad = [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        1e300,
        -1e300,
        1e-300,
        -1.0,
        0.0,
    ];
    let mut silent = Vec::new();
    for value in bad {
        let base = BenchMotion {
            opening: [rig.onset, rig.onset, 0.0],
            gap: 0.0,
            pressure: PRESSURE,
            ..BenchMotion::default()
        };
        let opening = |k: usize| {
            let mut motion = base;
            motion.opening[k] = value;
            ("opening", motion, 0.0, 1e-3)
        };
        let (mut gap, mut impulse) = (base, base);
        (gap.gap, impulse.pressure) = (value, value);
        let cases = [
            opening(0),
            opening(1),
            opening(2),
            ("gap", gap, 0.0, 1e-3),
            ("impulse", impulse, 0.0, 1e-3),
            ("damage", base, value, 1e-3),
            ("time step", base, 0.0, value),
        ];
        for (what, motion, damage, h) in cases {
            let mut state = rig.bench.fresh();
            if rig.opens() {
                state.damage = damage;
            }
            if let Err(e) = rig.bench.step_one(&mut state, &motion, h)
                && e.is_silent()
            {
                silent.push(format!("{what} {value:e}"));
            }
        }
    }
    let text = if silent.is_empty() {
        "not finite, huge, tiny and negative inputs that gave numbers that are not finite"
            .to_owned()
    } else {
        format!(
            "inputs that gave numbers that are not finite and no status: {}",
            silent.join(", ")
        )
    };
    Ok(CheckResult::below(
        "bad numbers",
        silent.len() as f64,
        0.0,
        text,
    ))
}
