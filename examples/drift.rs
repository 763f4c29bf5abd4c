//! Whether a long run drifts: penetrations in the shear cell, without and with the position correction.
//!
//! `cargo run --release --example drift [-- STEPS [CASE]]` takes 100,000 steps of `cases/shear_cell_3d.ron` for each
//! share of a penetration that a step takes back, and prints the deepest penetration of the last tenth of the run in
//! radii of the smaller grain, the energy that the correction gave as a share of the work from outside, the residual
//! of the ledger and the time of a step.

use fretwork::geometry::space::{Plane, Solid, Space};
use fretwork::laws::SearchPath;
use fretwork::scene::build::Dimensional;
use fretwork::scene::load;
use std::path::{Path, PathBuf};
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let mut args = std::env::args().skip(1);
    let steps: u64 = args.next().map_or(Ok(100_000), |a| a.parse())?;
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/shear_cell_3d.ron");
    let case = args.next().map_or(own, PathBuf::from);
    println!(
        "| correction | steps | deepest / radius | mean / radius | given by the correction / work | residual / work | a step |"
    );
    println!("|---|---|---|---|---|---|---|");
    for share in ["0", "0.01", "0.1", "0.5"] {
        let loaded = load(&case, &[format!("solver.correction={share}")])?;
        if loaded.case.dimension == 2 {
            run::<Plane>(&loaded, share, steps)?;
        } else {
            run::<Solid>(&loaded, share, steps)?;
        }
    }
    Ok(())
}

/// Penetrations in radii of the smaller grain: the deepest, and the mean over closed contacts.
fn penetrations<S: Space>(s: &fretwork::step::Simulation<S>) -> (f64, f64) {
    let (mut deepest, mut sum, mut closed) = (0.0f64, 0.0, 0u32);
    for contact in s.network.contacts.iter().filter(|c| c.gap < 0.0) {
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

fn run<S: Dimensional>(
    loaded: &fretwork::scene::Loaded,
    share: &str,
    steps: u64,
) -> Result<(), Failure> {
    let mut s = loaded.build_in::<S>(&SearchPath::new(&[]))?.simulation;
    let (mut deepest, mut mean) = (0.0f64, 0.0f64);
    let clock = Instant::now();
    for step in 0..steps {
        s.step()?;
        if step >= steps - steps / 10 {
            let (most, middle) = penetrations(&s);
            deepest = deepest.max(most);
            mean = mean.max(middle);
        }
    }
    let each = clock.elapsed().as_secs_f64() / steps as f64;
    let e = &s.energy;
    let work = e.external_work.abs().max(f64::MIN_POSITIVE);
    println!(
        "| {share} | {steps} | {deepest:.1e} | {mean:.1e} | {:.1e} | {:.1e} | {:.2} ms |",
        -e.correction / work,
        e.residual / work,
        1e3 * each
    );
    Ok(())
}
