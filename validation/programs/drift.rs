//! Drift of penetrations in a long run of the shear cell, with and without their correction.
//!
//! `cargo run --release --example drift [-- STEPS [SETTING...]]` takes 100,000 steps of
//! `cases/shear_cell_3d.ron` with each solver setting (`none`, `correction=0.1`, `projection=1e-4`,
//! ...) and prints, ten times per run, the deepest penetration since the last line and at its last
//! step, in radii of the smaller grain, the mean over closed contacts, the steps with a projection
//! and its iterations, the energy supplied by the correction as a fraction of the external work,
//! the residual of the ledger, and the time per step.

use fretwork::geometry::space::Dim3;
use fretwork::scene::load;
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use std::path::Path;
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

/// Default solver settings.
const SETTINGS: [&str; 3] = ["none", "correction=0.1", "projection=1e-4"];

fn main() -> Result<(), Failure> {
    let mut args = std::env::args().skip(1);
    let steps: u64 = args.next().map_or(Ok(100_000), |a| a.parse())?;
    let mut settings: Vec<String> = args.collect();
    if settings.is_empty() {
        settings.extend(SETTINGS.map(str::to_owned));
    }
    println!(
        "| setting | steps | deepest / radius | at the end | mean / radius | projected | sweeps each | given / work | residual / work | a step |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for setting in &settings {
        run(setting, steps)?;
    }
    Ok(())
}

/// Penetrations in radii of the smaller grain: the deepest, and the mean over closed contacts.
fn penetrations(s: &Simulation<Dim3>) -> (f64, f64) {
    let (mut deepest, mut sum, mut closed) = (0.0f64, 0.0, 0u32);
    for contact in s.state.network.contacts.iter().filter(|c| c.gap < 0.0) {
        let radius = |ball: u32| s.shapes.balls[ball as usize].radius;
        let mut least = radius(contact.key.candidate);
        if contact.key.surface().is_none() {
            least = least.min(radius(contact.key.antagonist));
        }
        deepest = deepest.max(-contact.gap / least);
        sum -= contact.gap / least;
        closed += 1;
    }
    (deepest, sum / f64::from(closed.max(1)))
}

fn run(setting: &str, steps: u64) -> Result<(), Failure> {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/shear_cell_3d.ron");
    let mut sets = ["solver.correction=0", "solver.projection=0"]
        .map(str::to_owned)
        .to_vec();
    if setting != "none" {
        sets.push(format!("solver.{setting}"));
    }
    let loaded = load(&case, &sets)?;
    let mut s = loaded.build_in::<Dim3>(&search_path())?;
    let part = steps.div_ceil(10);
    let (mut deepest, mut mean) = (0.0f64, 0.0f64);
    let (mut projected, mut sweeps) = (0u64, 0u64);
    let mut clock = Instant::now();
    for step in 1..=steps {
        if let Some(p) = s.step()?.projected {
            projected += 1;
            sweeps += u64::from(p.sweeps);
        }
        let (most, middle) = penetrations(&s);
        deepest = deepest.max(most);
        mean = mean.max(middle);
        if step % part != 0 && step != steps {
            continue;
        }
        let e = &s.state.energy;
        let work = e.external_work.abs().max(f64::MIN_POSITIVE);
        println!(
            "| {setting} | {step} | {deepest:.1e} | {most:.1e} | {mean:.1e} | {projected} | {} | {:.1e} | {:.1e} | {:.2} ms |",
            sweeps / projected.max(1),
            -e.correction / work,
            e.residual / work,
            1e3 * clock.elapsed().as_secs_f64() / part as f64
        );
        (deepest, mean) = (0.0, 0.0);
        (projected, sweeps) = (0, 0);
        clock = Instant::now();
    }
    Ok(())
}
