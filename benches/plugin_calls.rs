//! Cost of the plugin interface: one law in a loop and behind the interface, and its share of a
//! fretting step.
//!
//! `cargo bench --bench plugin_calls`. First the damage law of Monerie, Acary and Cangemi runs in a
//! loop over the columns; then the loop runs behind the C interface, called as a run calls it. One
//! thread.

mod support;

use fretwork::laws::{Call, Kind};
use fretwork::scene::load;
use fretwork::shipped::search_path;
use fretwork::step::Simulation;
use fretwork_abi::FwBatch;
use fretwork_law::{DamageLaw, Intact, Site};
use fretwork_laws::damage::mac::MacDamage;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

/// Smallest of several means (ns).
fn least(mut work: impl FnMut(), repeats: usize) -> f64 {
    (0..9)
        .map(|_| {
            let clock = Instant::now();
            for _ in 0..repeats {
                work();
            }
            clock.elapsed().as_secs_f64() * 1e9 / repeats as f64
        })
        .fold(f64::INFINITY, f64::min)
}

fn main() {
    support::refuse_unoptimised();
    let path = search_path();
    let plugin = path
        .find(Kind::DAMAGE, "mac")
        .unwrap_or_else(|e| panic!("{e}"));
    let parameters = [0.1, 0.0, 1e-3, 1e30];
    let law = MacDamage {
        w: parameters[0],
        b: parameters[1],
        beta_broken: parameters[2],
        opening_broken: parameters[3],
    };
    println!(
        "{:>8} {:>16} {:>16} {:>17}",
        "contacts", "compiled ns/c", "called ns/c", "interface ns/call"
    );
    let mut call = 0.0;
    for n in [1usize, 10, 100, 1000, 10_000, 100_000] {
        let energy: Vec<f64> = (0..n).map(|k| 0.2 * (k % 97) as f64 / 97.0).collect();
        let traction: Vec<f64> = energy.iter().map(|e| (2e12 * e).sqrt()).collect();
        let (zero, damage) = (vec![0.0; n], vec![0.0; n]);
        let mut out = vec![0.0; n];
        let repeats = (2_000_000 / n).max(20);
        let compiled = least(
            || {
                for k in 0..n {
                    let site = Site {
                        opening: [zero[k]; 3],
                        velocity: [zero[k]; 3],
                        damage: damage[k],
                        h: 1e-6,
                        ..Site::default()
                    };
                    let intact = Intact {
                        energy: energy[k],
                        traction: [traction[k], zero[k], 0.0],
                        degradation: 2.0,
                        ..Intact::default()
                    };
                    out[k] = law.grow(&site, &intact, &mut []);
                }
                black_box(&mut out);
            },
            repeats,
        );
        // SAFETY: zeros are valid numbers and null pointers.
        let mut batch: FwBatch = unsafe { std::mem::zeroed() };
        (batch.size, batch.n, batch.dimension) = (size_of::<FwBatch>(), n, 2);
        (batch.h, batch.theta, batch.degradation) = (1e-6, 0.5, 2.0);
        batch.parameters = parameters.as_ptr();
        for column in [
            &mut batch.opening_n,
            &mut batch.opening_t1,
            &mut batch.velocity_n,
            &mut batch.velocity_t1,
            &mut batch.intact_t1,
        ] {
            *column = zero.as_ptr();
        }
        batch.damage = damage.as_ptr();
        batch.energy_intact = energy.as_ptr();
        batch.intact_n = traction.as_ptr();
        batch.out_damage = out.as_mut_ptr();
        let loaded = least(
            || {
                // SAFETY: the columns are arrays of n numbers.
                unsafe { plugin.call(Call::Commit, black_box(&batch)) }
                    .unwrap_or_else(|e| panic!("{e}"));
            },
            repeats,
        );
        if n == 1 {
            call = loaded - compiled;
        }
        println!(
            "{n:>8} {:>16.2} {:>16.2} {:>17.0}",
            compiled / n as f64,
            loaded / n as f64,
            loaded - compiled
        );
    }
    share(call);
}

/// Fraction of a fretting step that its calls of laws spend in the interface.
fn share(call: f64) {
    let file = format!(
        "{}/cases/wheel_rail_fretting.ron",
        env!("CARGO_MANIFEST_DIR")
    );
    let loaded = load(Path::new(&file), &[]).unwrap_or_else(|e| panic!("{e}"));
    let mut s: Simulation<fretwork::geometry::space::Dim2> = loaded
        .build_in(&search_path())
        .unwrap_or_else(|e| panic!("{e}"));
    while s.state.time < 0.07 {
        s.step().unwrap_or_else(|e| panic!("{e}"));
    }
    let (clock, steps) = (Instant::now(), 100);
    let mut laws = 0.0;
    for _ in 0..steps {
        laws += s
            .step()
            .unwrap_or_else(|e| panic!("{e}"))
            .timing
            .laws
            .as_secs_f64();
    }
    let step = clock.elapsed().as_secs_f64() / f64::from(steps);
    // An interface: contact prepare; cohesion prepare twice and energy; damage commit; wear commit.
    let calls = 6.0 * s.laws.len() as f64;
    println!(
        "a fretting step takes {:.2} ms, its laws with gathering and booking {:.2} ms; {calls} calls at {call:.0} ns are {:.4} % of it",
        step * 1e3,
        laws / f64::from(steps) * 1e3,
        calls * call * 1e-9 / step * 100.0
    );
}
