//! Means of plane shear from a time on, with the error of averaging and the strains before and
//! during it.

use crate::quantity::Unit;
use crate::quantity::unit::{ONE, PASCAL};
use crate::steady::{BLOCKS, MeanFlow, of_blocks};

const PER_SECOND: Unit = Unit::of("1/s");

const HALF_WIDTH: &str = "half-width of the 95 % interval of the mean, by blocks of time";

/// Name, unit and explanation of each number of plane shear.
pub(super) const RESULTS: [(&str, Unit, &str); 13] = [
    ("rate", PER_SECOND, "mean shear rate"),
    ("p", PASCAL, "mean normal stress"),
    ("mu", ONE, "friction of the mean stresses"),
    ("phi", ONE, "mean solid fraction"),
    ("I", ONE, "inertial number of the mean rate and stress"),
    (
        "p_kinetic",
        PASCAL,
        "part of the normal stress that motion carries",
    ),
    (
        "tau_kinetic",
        PASCAL,
        "part of the shear stress that motion carries",
    ),
    ("strain_before", ONE, "shear strain before the means"),
    ("strain", ONE, "shear strain during the means"),
    ("p_half_width", PASCAL, HALF_WIDTH),
    ("mu_half_width", ONE, HALF_WIDTH),
    ("phi_half_width", ONE, HALF_WIDTH),
    ("I_half_width", ONE, HALF_WIDTH),
];

/// Means from a time on. Signs of rate and shear stress are those of the columns.
#[derive(Clone, Debug)]
pub(super) struct Means {
    rate: f64,
    p: f64,
    phi: f64,
    kinetic: [f64; 2],
    /// Friction and inertial number of the mean stresses and rate.
    mu: f64,
    inertial: f64,
    /// Means over blocks of equal time: p, mu, phi, I; `None` without enough rows.
    blocks: Option<[MeanFlow; 4]>,
    /// Strain before the time, and from it on.
    strain: [f64; 2],
}

impl Means {
    /// Computes the means from the columns rate, p, tau and phi, and the kinetic parts of p and
    /// tau, whose rows are means over the time since the row before. `inertial` is the inertial
    /// number at a rate and a pressure. `None` without rows after `start`.
    pub fn new(
        time: &[f64],
        columns: &[Vec<f64>; 4],
        kinetic: &[Vec<f64>; 2],
        start: f64,
        inertial: impl Fn(f64, f64) -> f64,
    ) -> Option<Self> {
        let end = *time.last()?;
        let rows = || (1..time.len()).map(|k| (k, time[k] - time[k - 1]));
        // A row that began before the time, except by round-off, is not part of the mean.
        let counts = |k: usize| time[k - 1] >= start - 1e-6 * (time[k] - time[k - 1]);
        let total = |values: &[f64], of: &dyn Fn(usize) -> bool| {
            let due = rows().filter(|(k, _)| of(*k));
            let sums = due.map(|(k, h)| (values[k] * h, h));
            sums.fold((0.0, 0.0), |a, b| (a.0 + b.0, a.1 + b.1))
        };
        let mean = |values: &[f64], of: &dyn Fn(usize) -> bool| {
            let (sum, weight) = total(values, of);
            (weight > 0.0).then(|| sum / weight)
        };
        let of_all = |values: &[f64]| mean(values, &counts);
        let [rate, p, tau, phi] = [0, 1, 2, 3].map(|k| of_all(&columns[k]));
        let (rate, p, tau, phi) = (rate?, p?, tau?, phi?);
        if p <= 0.0 {
            return None;
        }
        let first = rows().find(|(k, _)| counts(*k)).map(|(k, _)| time[k - 1])?;
        let block = |k: usize| {
            let middle = 0.5 * (time[k] + time[k - 1]);
            ((middle - first) / (end - first) * BLOCKS as f64) as usize
        };
        let (mu, number) = (tau.abs() / p, inertial(rate, p));
        let mut blocks = [const { Vec::new() }; 4];
        for b in 0..BLOCKS {
            let here = |k: usize| counts(k) && block(k) == b;
            if rows().filter(|(k, _)| here(*k)).count() < 2 {
                break;
            }
            let of = |k: usize| mean(&columns[k], &here);
            let (Some(r), Some(q), Some(t), Some(f)) = (of(0), of(1), of(2), of(3)) else {
                break;
            };
            // Ratios are expanded to first order in the deviations from the means, so that the mean
            // of the blocks is the value above.
            blocks[0].push(q);
            blocks[1].push(mu + (t * tau.signum() - mu * q) / p);
            blocks[2].push(f);
            let rise = if rate == 0.0 { 0.0 } else { r / rate - 1.0 };
            blocks[3].push(number * (1.0 + rise - 0.5 * (q / p - 1.0)));
        }
        let full = blocks.iter().all(|b| b.len() == BLOCKS);
        let flows = blocks.map(|b| of_blocks(&b).unwrap_or_default());
        let strain = |of: &dyn Fn(usize) -> bool| total(&columns[0], of).0.abs();
        Some(Self {
            rate,
            p,
            phi,
            kinetic: [of_all(&kinetic[0])?, of_all(&kinetic[1])?],
            mu,
            inertial: number,
            blocks: full.then_some(flows),
            strain: [strain(&|k| !counts(k)), strain(&counts)],
        })
    }

    /// Returns the values of [`RESULTS`]; `None` where there are too few rows for an interval.
    pub fn values(&self) -> [Option<f64>; RESULTS.len()] {
        let half_width = |k: usize| self.blocks.as_ref().map(|flows| flows[k].half_width);
        [
            Some(self.rate),
            Some(self.p),
            Some(self.mu),
            Some(self.phi),
            Some(self.inertial),
            Some(self.kinetic[0]),
            Some(self.kinetic[1]),
            Some(self.strain[0]),
            Some(self.strain[1]),
            half_width(0),
            half_width(1),
            half_width(2),
            half_width(3),
        ]
    }

    /// Returns a description of the reliability of the means.
    pub fn describe(&self) -> String {
        let [before, during] = self.strain;
        let strains = format!("strain {before:.2} before the mean, {during:.2} in it");
        let Some([_, mu, phi, inertial]) = &self.blocks else {
            return format!("{strains}; too few rows for intervals of the means");
        };
        let trends = [("mu", mu), ("phi", phi), ("I", inertial)];
        let moving: Vec<&str> = trends.iter().filter(|t| !t.1.steady).map(|t| t.0).collect();
        let steady = if moving.is_empty() {
            "no trend".to_owned()
        } else {
            format!("a trend in {}: set a later start", moving.join(" and "))
        };
        format!(
            "mu {:.4} +- {:.4}, phi {:.4} +- {:.4} at I {:.4} +- {:.4} (95 %, {BLOCKS} blocks, correlation of neighbours {:+.1}), {strains}, {steady}",
            self.mu,
            mu.half_width,
            self.phi,
            phi.half_width,
            self.inertial,
            inertial.half_width,
            mu.correlation,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratios_are_of_means_that_rows_of_any_length_give() {
        // From 1 s on rows of 0.1 and 0.3 s alternate: p 100 and 300 Pa, tau 50 and 90 Pa, so that
        // p = 250, tau = 80 Pa.
        let mut time = vec![0.0, 1.0];
        let mut columns = [
            vec![0.0, 7.0],
            vec![0.0, 1e6],
            vec![0.0, -1e6],
            vec![0.0, 0.1],
        ];
        let mut last = 1.0;
        for k in 0..40 {
            let long = k % 2 == 1;
            last += if long { 0.3 } else { 0.1 };
            time.push(last);
            let row = if long {
                [2.0, 300.0, 90.0, 0.8]
            } else {
                [2.0, 100.0, 50.0, 0.8]
            };
            (0..4).for_each(|c| columns[c].push(row[c]));
        }
        let kinetic = [vec![1.0; time.len()], vec![0.5; time.len()]];
        let inertial = |rate: f64, p: f64| rate * (4.0 / p).sqrt();
        let means = Means::new(&time, &columns, &kinetic, 1.0, inertial).unwrap();
        let value = |name: &str| {
            let place = RESULTS.iter().position(|result| result.0 == name).unwrap();
            means.values()[place].unwrap()
        };
        assert!((value("p") - 250.0).abs() < 1e-9 && (value("mu") - 0.32).abs() < 1e-12);
        assert!((value("I") - 2.0 * (4.0f64 / 250.0).sqrt()).abs() < 1e-12);
        assert!(
            (value("strain_before") - 7.0).abs() < 1e-9 && (value("strain") - 16.0).abs() < 1e-9
        );
        // Each block has two rows of each kind, so that there is no scatter.
        assert!(value("mu_half_width") < 1e-12 && value("p_half_width") < 1e-9);
        assert!(Means::new(&time, &columns, &kinetic, 99.0, inertial).is_none());
    }

    #[test]
    fn a_drift_is_a_trend_in_what_drifts() {
        let time: Vec<f64> = (0..=100).map(f64::from).collect();
        let tau = time.iter().map(|t| 30.0 + 0.05 * t).collect();
        let wave = |a: f64| {
            time.iter()
                .map(|t| a * (1.0 + 0.01 * (1.7 * t).sin()))
                .collect()
        };
        let columns = [wave(2.0), wave(100.0), tau, wave(0.8)];
        let kinetic = [wave(1.0), wave(1.0)];
        let means = Means::new(&time, &columns, &kinetic, 20.0, |r, p| r / p.sqrt()).unwrap();
        let said = means.describe();
        assert!(said.ends_with("a trend in mu: set a later start"), "{said}");
        assert!(said.contains("strain 40."), "{said}");
    }
}
