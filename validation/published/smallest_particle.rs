//! Smallest wear particle. Its runs are made by `validation/smallest_particle.py`, since pieces of
//! bonded grains are found in states and not in the numbers of a study; it leaves the outcomes in a
//! table.

use crate::comparison::{Comparison, Failure, Results, folder};
use crate::row::{Row, Verdict};
use std::path::Path;

pub const COMPARISON: Comparison = Comparison {
    name: "smallest_particle",
    title: "Smallest wear particle",
    studies: &[],
    published: true,
    show: |_| show(),
};

/// Size of the junction in grains, ductility ratio, and whether a particle came off.
type Run = (f64, f64, bool);

fn show() -> Result<Results, Failure> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = folder(root, COMPARISON.name).join("table.csv");
    let mut reader = csv::Reader::from_path(&path)
        .map_err(|_| "its runs are not there: see the commands above")?;
    let runs: Vec<(f64, f64, u32, String)> = reader.deserialize().collect::<Result<_, _>>()?;
    let runs: Vec<Run> = runs
        .iter()
        .map(|(size, ratio, _, outcome)| (*size, *ratio, outcome == "particle"))
        .collect();
    let count = |keep: &dyn Fn(&Run) -> bool| {
        let kept = runs.iter().filter(|r| keep(r));
        (kept.clone().filter(|r| r.2).count(), kept.count())
    };
    let large = count(&|r| r.0 >= 8.0 * r.1);
    let small = count(&|r| r.0 <= 0.25 * r.1);
    let text = |(some, all): (usize, usize)| format!("{some} of {all}");
    let mut results = Results::default();
    results.rows.push(Row::statement(
        "runs with a particle at D ≥ 8 R d, and at D ≤ R d/4, R = w k/s²",
        format!("{}, and {}", text(large), text(small)),
        None,
        "all, and none",
        Some(
            match large.1 * small.1 > 0 && large.0 == large.1 && small.0 == 0 {
                true => Verdict::Agrees,
                false => Verdict::Differs,
            },
        ),
    ));
    let change = growth(&runs, 8.0, 16.0);
    results.rows.push(Row::statement(
        "share of runs with a particle at D = 16 d less that at D = 8 d, means over the same R",
        format!("{:+.2} ± {:.2}", change.0, change.1),
        None,
        "rises",
        Some(match change {
            (rise, half) if rise > half => Verdict::Agrees,
            (rise, half) if rise < -half => Verdict::Differs,
            _ => Verdict::Undecided,
        }),
    ));
    Ok(results)
}

/// Mean over the ratios of both sizes of the difference of shares with a particle, and half its
/// interval of 95 %, with the variance of a share p of n runs of (k + 1)(n - k + 1)/((n + 2)^2 (n +
/// 3)), which is not 0 where all runs are alike.
fn growth(runs: &[Run], from: f64, to: f64) -> (f64, f64) {
    let of = |size: f64, ratio: f64| {
        let own = runs.iter().filter(|r| r.0 == size && r.1 == ratio);
        let all = own.clone().count() as f64;
        let some = own.filter(|r| r.2).count() as f64;
        let variance = (some + 1.0) * (all - some + 1.0) / ((all + 2.0).powi(2) * (all + 3.0));
        (all > 0.0).then_some((some / all, variance))
    };
    let mut ratios: Vec<f64> = runs.iter().map(|r| r.1).collect();
    ratios.sort_by(f64::total_cmp);
    ratios.dedup();
    let pairs = ratios.iter().filter_map(|r| of(from, *r).zip(of(to, *r)));
    let (mut sum, mut variance, mut count) = (0.0, 0.0, 0.0);
    for (a, b) in pairs {
        sum += b.0 - a.0;
        variance += a.1 + b.1;
        count += 1.0;
    }
    (sum / count, 1.96 * f64::sqrt(variance) / count)
}
