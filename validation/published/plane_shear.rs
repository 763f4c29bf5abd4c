//! Disks in plane shear: friction and solid fraction by the inertial number, with and without
//! friction between grains.

use crate::comparison::{Comparison, Failure, Inputs, Results, markdown};
use crate::row::{Finer, Reference, Row};
use crate::sample::{Estimate, difference};
use crate::table::Setting;
use fretwork::view::{Axis, Chart, Series, Style};

pub const COMPARISON: Comparison = Comparison {
    name: "plane_shear",
    title: "Plane shear of disks",
    studies: &["plane_shear", "plane_shear_walls"],
    published: false,
    show,
};

const MU: &str = "measures.bulk_mu";
const I: &str = "measures.bulk_I";
const PHI: &str = "measures.bulk_phi";
const CORE_MU: &str = "measures.core_mu";
const CORE_I: &str = "measures.core_I";
const COLUMNS: [&str; 11] = [
    "mu",
    "velocity",
    "start",
    "step",
    "tolerance",
    "restitution",
    MU,
    I,
    PHI,
    CORE_MU,
    CORE_I,
];
const TOLERANCE: f64 = 1e-3;

/// mu = a + b/(1 + c/I)
struct Law([f64; 3]);

impl Law {
    fn at(&self, i: f64) -> f64 {
        let [a, b, c] = self.0;
        a + b / (1.0 + c / i)
    }
}

fn show(inputs: &Inputs) -> Result<Results, Failure> {
    let table = inputs.table("plane_shear", &COLUMNS)?;
    let known = |name: &str| inputs.published.value(name);
    let rough = Law([known("dem_a")?, known("dem_b")?, known("dem_c")?]);
    let smooth = Law([known("smooth_a")?, known("smooth_b")?, known("smooth_c")?]);
    let (phi_0, phi_1) = (known("dem_phi_0")?, known("dem_phi_1")?);
    let (cruz_0, cruz_1) = (known("cruz_mu_0")?, known("cruz_mu_1")?);
    let settings = table.settings(|_| true);
    // The first row of a flow is the point of the figure.
    let first = |s: &Setting| {
        settings
            .iter()
            .find(|o| same_flow(o, s))
            .map(Setting::index)
    };
    let (case, others): (Vec<&Setting>, Vec<&Setting>) =
        settings.iter().partition(|s| first(s) == Some(s.index()));
    let law_of = |s: &Setting| {
        if s.factor("mu") > 0.0 {
            &rough
        } else {
            &smooth
        }
    };
    // Differences from the DEM are taken at the inertial number of each run.
    let off_mu = |s: &Setting| s.over(|r| r.number(MU) - law_of(s).at(r.number(I)));
    let off_phi = |s: &Setting| s.over(|r| r.number(PHI) - phi_0 - phi_1 * r.number(I));
    // The relative change at the point that was repeated is used for all points of that friction.
    let finer = |s: &Setting, off: &dyn Fn(&Setting) -> Estimate, column: &str| -> Option<Finer> {
        let same_grains = |o: &&&Setting| o.factor("mu") == s.factor("mu") && is_fine(o);
        let fine = others.iter().find(same_grains)?;
        let coarse = settings
            .iter()
            .find(|o| !is_fine(o) && same_flow(o, fine) && same_conditions(o, fine))?;
        let by = s.mean(column).mean / coarse.mean(column).mean;
        let same = same_flow(s, fine) && same_conditions(s, fine);
        Some(Finer {
            change: difference(off(fine), off(coarse)).scaled(by),
            difference: same.then(|| off(fine)),
        })
    };

    let mut results = Results::default();
    let mut cells = Vec::new();
    for setting in &case {
        let (mu, i) = (setting.mean(MU), setting.mean(I));
        let friction = setting.factor("mu");
        let law = law_of(setting);
        let off = off_mu(setting);
        let core = setting.over(|r| r.number(CORE_MU) - law.at(r.number(CORE_I)));
        let expected = law.at(i.mean);
        let reference = |value: f64| Reference {
            value,
            range: 0.0,
            digits: 3,
        };
        let named = |what: &str| format!("{what} at I = {:.3}, grains with µ = {friction}", i.mean);
        results.rows.push(Row::number(
            named("friction"),
            mu,
            off,
            finer(setting, &off_mu, MU),
            &reference(expected),
        ));
        let phi = setting.mean(PHI);
        let mut line = vec![
            format!("{friction}"),
            i.text(4),
            mu.text(4),
            format!("{expected:.4}"),
            off.percent(expected),
            core.percent(expected),
        ];
        if friction > 0.0 {
            let solid = phi_0 + phi_1 * i.mean;
            results.rows.push(Row::number(
                named("solid fraction"),
                phi,
                off_phi(setting),
                finer(setting, &off_phi, PHI),
                &reference(solid),
            ));
            line.extend([
                format!("{:.3}", cruz_0 + cruz_1 * i.mean),
                phi.text(4),
                format!("{solid:.4}"),
            ]);
        } else {
            line.extend(["-".to_owned(), phi.text(4), "-".to_owned()]);
        }
        cells.push(line);
    }
    results.points = markdown(
        &[
            "µ of grains",
            "I",
            "friction",
            "DEM",
            "difference",
            "difference, middle of the layer",
            "da Cruz",
            "solid fraction",
            "DEM",
        ],
        &cells,
    );
    let mut cells = Vec::new();
    for setting in &others {
        // Each row is compared with the row that differs in one setting only.
        let differs = |s: &Setting| {
            let other = |name: &str| s.factor(name) != setting.factor(name);
            [
                is_fine(s) != is_fine(setting),
                other("start"),
                other("restitution"),
            ]
        };
        let near =
            |s: &&Setting| same_flow(s, setting) && differs(s).iter().filter(|d| **d).count() == 1;
        let Some(partner) = settings.iter().find(near) else {
            continue;
        };
        let value = |name: &str| format!("{}, not {}", setting.factor(name), partner.factor(name));
        let changed = match differs(partner) {
            [true, ..] => "half the step, a tenth of the tolerance".to_owned(),
            [_, true, _] => format!("start of the means, s: {}", value("start")),
            _ => format!("restitution {}", value("restitution")),
        };
        let law = law_of(setting);
        let d = difference(off_mu(setting), off_mu(partner));
        cells.push(vec![
            format!("{}", setting.factor("mu")),
            setting.mean(I).text(4),
            changed,
            setting.mean(MU).text(4),
            d.percent(law.at(setting.mean(I).mean)),
            setting.mean(PHI).text(4),
        ]);
    }
    results.points += "\nThe same points with other settings; the change is that of the difference from the DEM:\n\n";
    results.points += &markdown(
        &[
            "µ of grains",
            "I",
            "changed",
            "friction",
            "change",
            "solid fraction",
        ],
        &cells,
    );

    if inputs.tables.contains_key("plane_shear_walls") {
        let straight = inputs.table("plane_shear_walls", &[MU, I, PHI])?;
        let mut cells = Vec::new();
        for setting in straight.settings(|_| true) {
            let off = setting.over(|r| r.number(MU) - rough.at(r.number(I)));
            let i = setting.mean(I);
            cells.push(vec![
                i.text(4),
                setting.mean(MU).text(4),
                off.percent(rough.at(i.mean)),
                setting.mean(PHI).text(4),
            ]);
        }
        results.points += "\nBetween straight rows of equal disks, µ = 0.4 between grains:\n\n";
        results.points += &markdown(
            &["I", "friction", "difference from the DEM", "solid fraction"],
            &cells,
        );
    }
    let drawn = |mu: f64, column: &str| {
        let of: Vec<&Setting> = case
            .iter()
            .copied()
            .filter(|s| s.factor("mu") == mu)
            .collect();
        let points = of
            .iter()
            .map(|s| (s.mean(I).mean, s.mean(column).mean))
            .collect();
        let bars = of
            .iter()
            .map(|s| (s.mean(column).low(), s.mean(column).high()))
            .collect();
        Series::new(format!("ours, µ = {mu} between grains"), points)
            .style(Style::Markers)
            .intervals(bars)
    };
    let along = |f: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> {
        (0..=60)
            .map(|k| 0.004 * (60.0f64).powf(f64::from(k) / 60.0))
            .map(|i| (i, f(i)))
            .collect()
    };
    let at = |name: &str, i: f64| inputs.published.value(name).map(|v| (i, v));
    let smooth_points = vec![
        at("smooth_0.01", 0.01)?,
        at("smooth_0.03", 0.03)?,
        at("smooth_0.10", 0.10)?,
    ];
    let x = || Axis::new("inertial number I", "").log();
    let friction = Chart::new("Friction", x(), Axis::new("friction coefficient τ/p", ""))
        .with(drawn(0.4, MU).coloured(0, 114, 178))
        .with(drawn(0.0, MU).coloured(0, 158, 115))
        .with(Series::new("independent DEM", along(&|i| rough.at(i))).coloured(213, 94, 0))
        .with(
            Series::new("independent DEM, µ = 0", smooth_points)
                .style(Style::LineMarkers)
                .coloured(204, 121, 167),
        )
        .with(
            Series::new("da Cruz et al. 2005", along(&|i| cruz_0 + cruz_1 * i))
                .style(Style::Dashed)
                .coloured(90, 90, 90),
        );
    let solid = Chart::new("Solid fraction", x(), Axis::new("solid fraction φ", ""))
        .with(drawn(0.4, PHI).coloured(0, 114, 178))
        .with(drawn(0.0, PHI).coloured(0, 158, 115))
        .with(Series::new("independent DEM", along(&|i| phi_0 + phi_1 * i)).coloured(213, 94, 0));
    results.charts = vec![friction, solid];
    Ok(results)
}

/// Whether two settings agree in friction and velocity of the wall.
fn same_flow(a: &Setting, b: &Setting) -> bool {
    ["mu", "velocity"]
        .iter()
        .all(|name| a.factor(name) == b.factor(name))
}

/// Whether two settings agree in the start of the means and in restitution.
fn same_conditions(a: &Setting, b: &Setting) -> bool {
    ["start", "restitution"]
        .iter()
        .all(|name| a.factor(name) == b.factor(name))
}

fn is_fine(s: &Setting) -> bool {
    s.factor("tolerance") < TOLERANCE
}
