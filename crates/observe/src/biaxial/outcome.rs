//! Results of a biaxial test for the summary.

use crate::quantity::unit::{ONE, PASCAL, RADIAN, WORD};
use crate::quantity::{Findings, Role, Topic, values};
use crate::statistics::Table;
use serde::Serialize;

/// Axial strain over which the stress ratio is averaged before its maximum is taken as the peak,
/// since forces between rigid grains fluctuate from step to step.
const WINDOW: f64 = 5e-3;

crate::described! {
    /// Results of the test. Angles in radians; strains and stresses signed as in [`super`].
    #[derive(Clone, Debug, Default, PartialEq, Serialize)]
    pub struct BiaxialOutcome {
        /// Compacity when the test starts.
        pub compacity_start: f64 => ONE,
        /// Coordination over all grains when the test starts.
        pub coordination_start: f64 => ONE,
        /// Coordination without rattlers when the test starts.
        pub coordination_carried_start: f64 => ONE,
        /// Pressure on the walls when the test starts.
        pub pressure_start: f64 => PASCAL,
        /// Largest |p_walls - p_contacts| / p_walls at the start of the test, and during it.
        pub pressure_mismatch: [f64; 2] = values(ONE),
        /// Largest q/p: mean q over mean p in 0.5 % of axial strain.
        pub peak_ratio: f64 => ONE,
        /// Friction angle at the peak, asin(q/p).
        pub peak_angle: f64 => RADIAN,
        /// Axial strain at the peak.
        pub peak_strain: f64 => ONE,
        /// Mean q over mean p in the last third of the axial strain.
        pub residual_ratio: f64 => ONE,
        /// Friction angle of the residual ratio.
        pub residual_angle: f64 => RADIAN,
        /// Axial strain at the end.
        pub axial_strain: f64 => ONE,
        /// Volumetric strain at the end.
        pub volumetric_strain: f64 => ONE,
        /// Smallest volumetric strain: the contraction before dilation.
        pub contraction: f64 => ONE,
        /// Compacity at the end, the mean over the last third of the axial strain.
        pub compacity_end: f64 => ONE,
        /// Coordination at the end, averaged likewise.
        pub coordination_end: f64 => ONE,
        /// Mean inertial number over the test: rate of axial strain times sqrt(m/p), with m the
        /// mean mass of a grain.
        pub inertial_number: f64 => ONE,
    }
}

impl BiaxialOutcome {
    /// Evaluates the statistics, with the `start` of the test (s) and the mean mass of a grain (kg;
    /// kg/m).
    pub fn new(table: &Table, start: f64, mass: f64) -> Self {
        let time = table.column("time");
        let first = time.partition_point(|t| *t <= start * (1.0 + 1e-9));
        let at = first.saturating_sub(1);
        let column = |name: &str| table.column(name);
        let (walls, contacts) = (column("p_walls"), column("p_contacts"));
        let strain = column("axial_strain");
        let stresses = [column("sigma_axial"), column("sigma_lateral")];
        let volume = column("volumetric_strain");
        let (compacity, coordination) = (column("compacity"), column("coordination"));
        let value = |values: &[f64]| values.get(at).copied().unwrap_or(0.0);
        let mismatch = |k: usize| {
            if walls[k] > 0.0 {
                (contacts[k] / walls[k] - 1.0).abs()
            } else {
                0.0
            }
        };
        let mut out = Self {
            compacity_start: value(&compacity),
            coordination_start: value(&coordination),
            coordination_carried_start: value(&column("coordination_carried")),
            pressure_start: value(&walls),
            ..Self::default()
        };
        let Some(last) = time.len().checked_sub(1) else {
            return out;
        };
        out.pressure_mismatch[0] = mismatch(at);
        if first > last {
            return out;
        }
        out.pressure_mismatch[1] = (first..=last).map(mismatch).fold(0.0, f64::max);
        (out.axial_strain, out.volumetric_strain) = (strain[last], volume[last]);
        out.contraction = volume[first..].iter().copied().fold(0.0, f64::min);
        let course = stresses.each_ref().map(|s| &s[first..]);
        (out.peak_ratio, out.peak_strain) = peak(&strain[first..], course);
        let mean = |values: &[f64]| {
            let late = (first..=last).filter(|k| strain[*k] >= strain[last] * 2.0 / 3.0);
            let (sum, count) = late.fold((0.0, 0), |(s, n), k| (s + values[k], n + 1));
            sum / f64::from(count.max(1))
        };
        out.residual_ratio = ratio(stresses.each_ref().map(|s| mean(s)));
        out.compacity_end = mean(&compacity);
        out.coordination_end = mean(&coordination);
        out.peak_angle = out.peak_ratio.clamp(-1.0, 1.0).asin();
        out.residual_angle = out.residual_ratio.clamp(-1.0, 1.0).asin();
        let course = &walls[first..];
        let pressure = course.iter().sum::<f64>() / course.len() as f64;
        let duration = time[last] - value(&time);
        if pressure > 0.0 && duration > 0.0 {
            let rate = strain[last].abs() / duration;
            out.inertial_number = rate * (mass / pressure).sqrt();
        }
        out
    }

    /// Adds the results of the test.
    pub(super) fn report(&self, found: &mut Findings) {
        found.begin(Topic::Measures, Role::Detail);
        found.part("biaxial", self, "");
        for (name, short, label, text) in self.sentences() {
            found.edit(&format!("biaxial.{name}"), |q| {
                q.secondary(short).sentence(label, text);
            });
        }
    }

    /// Returns the quantities shown in the report, with the sentences for the terminal.
    fn sentences(&self) -> [(&'static str, &'static str, &'static str, String); 4] {
        [
            (
                "compacity_start",
                "compacity at the start",
                "at rest",
                format!(
                    "compacity {:.4}, coordination {:.3}, {:.3} without rattlers, pressure {:.4e} Pa, relative difference to that of \
                     the contacts {:.1e}",
                    self.compacity_start,
                    self.coordination_start,
                    self.coordination_carried_start,
                    self.pressure_start,
                    self.pressure_mismatch[0]
                ),
            ),
            (
                "peak_angle",
                "friction angle at the peak",
                "friction angle",
                format!(
                    "peak {:.2} degrees (q/p {:.3}) at axial strain {:.4}, residual {:.2} degrees (q/p {:.3})",
                    self.peak_angle.to_degrees(),
                    self.peak_ratio,
                    self.peak_strain,
                    self.residual_angle.to_degrees(),
                    self.residual_ratio
                ),
            ),
            (
                "volumetric_strain",
                "volumetric strain",
                "strains",
                format!(
                    "axial {:.4}, volumetric {:+.4} (minimum {:+.4}); inertial number {:.2e}",
                    self.axial_strain,
                    self.volumetric_strain,
                    self.contraction,
                    self.inertial_number
                ),
            ),
            (
                "compacity_end",
                "compacity when sheared",
                "sheared",
                format!(
                    "compacity {:.4}, coordination {:.3}",
                    self.compacity_end, self.coordination_end
                ),
            ),
        ]
    }
}

/// Marks the results that cases without a biaxial test do not have.
pub(crate) fn report_none(found: &mut Findings) {
    found.begin(Topic::Measures, Role::Detail);
    let doc = "result of a biaxial test; null without one";
    let none = found.add("biaxial", (), WORD, doc);
    none.lacks("the case has no biaxial test (`biaxial`)");
}

/// Returns the stress ratio q/p = (axial - lateral)/(axial + lateral) of mean stresses; zero
/// without pressure. Forces between rigid grains fluctuate by as much as their mean, so that a mean
/// of ratios would overweight the steps of low pressure.
fn ratio([axial, lateral]: [f64; 2]) -> f64 {
    let sum = axial + lateral;
    if sum > 0.0 {
        (axial - lateral) / sum
    } else {
        0.0
    }
}

/// Returns the largest ratio of the mean axial and lateral stresses in a window of strain, and the
/// strain at its centre; of the whole range if it is shorter.
fn peak(strain: &[f64], stresses: [&[f64]; 2]) -> (f64, f64) {
    let whole = ratio(stresses.map(|s| s.iter().sum::<f64>()));
    let mut best: Option<(f64, f64)> = None;
    let (mut low, mut sums) = (0, [0.0; 2]);
    for high in 0..strain.len() {
        sums = [0, 1].map(|k| sums[k] + stresses[k][high]);
        let mut full = false;
        while low < high && strain[high] - strain[low] > WINDOW {
            sums = [0, 1].map(|k| sums[k] - stresses[k][low]);
            low += 1;
            full = true;
        }
        let value = ratio(sums);
        if (full || low > 0) && best.is_none_or(|b| value > b.0) {
            best = Some((value, 0.5 * (strain[high] + strain[low])));
        }
    }
    best.unwrap_or((whole, strain.last().map_or(0.0, |e| 0.5 * e)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Column;

    #[test]
    fn a_lone_jump_is_no_peak() {
        let strain: Vec<f64> = (0..1000).map(|k| f64::from(k) * 1e-4).collect();
        // The ratio has a plateau of 0.4 within 0.3, and is 1 in one step with the same pressure.
        let mut q: Vec<f64> = strain
            .iter()
            .map(|e| if (e - 0.03).abs() < 5e-3 { 0.4 } else { 0.3 })
            .collect();
        q[800] = 1.0;
        let axial: Vec<f64> = q.iter().map(|q| 1.0 + q).collect();
        let lateral: Vec<f64> = q.iter().map(|q| 1.0 - q).collect();
        let (top, at) = peak(&strain, [&axial, &lateral]);
        assert!(
            (top - 0.4).abs() < 1e-9 && (at - 0.03).abs() < 5e-3,
            "{top} {at}"
        );
    }

    #[test]
    fn ratios_are_those_of_mean_stresses() {
        // Two steps alternate, q = 1 at p = 1 and q = 1 at p = 9: the mean of ratios is 0.556, the
        // ratio of means 2/10.
        let columns = [
            "time",
            "axial_strain",
            "sigma_axial",
            "sigma_lateral",
            "p_walls",
        ];
        let others = [
            "p_contacts",
            "volumetric_strain",
            "compacity",
            "coordination",
        ];
        let names = columns
            .iter()
            .chain(&others)
            .chain(&["coordination_carried"]);
        let names: Vec<Column> = names.map(|n| Column::new(*n, "", "")).collect();
        let mut table = Table::new(names, 2);
        for k in 0..1200 {
            let p = if k % 2 == 0 { 1.0 } else { 9.0 };
            let (time, rest) = (f64::from(k), [p, 0.0, 0.8, 3.0, 3.0]);
            let row = [time, 1e-4 * time, p + 1.0, p - 1.0, p];
            table.rows.extend(row.iter().chain(&rest));
        }
        let outcome = BiaxialOutcome::new(&table, 0.0, 1.0);
        assert!((outcome.residual_ratio - 0.2).abs() < 1e-9, "{outcome:?}");
        // Fifty-one steps fit into the window, at most one more of low pressure: 51/(26 + 25 * 9).
        assert!(outcome.peak_ratio >= 0.2 && outcome.peak_ratio < 51.0 / 251.0 + 1e-9);
        assert_eq!(outcome.residual_angle, outcome.residual_ratio.asin());
    }
}
