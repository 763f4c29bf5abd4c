//! The curve of a run, from its statistics.

use super::branches::laid_out;
use super::spec::{AlongSpec, ModelSpec, RowsSpec};
use crate::table::csv::without_unit;
use fretwork_scene::expression::{Expression, ExpressionError};
use std::path::Path;

/// The name of the length of a step in expressions (s).
const TIME_STEP: &str = "time_step";

/// Suffix of the name of a column for its value in the first row that is used.
const START: &str = "_start";

/// A curve as expressions in columns.
#[derive(Clone, Debug)]
pub struct Model {
    x: Expression,
    y: Expression,
    columns: Vec<String>,
    rows: RowsSpec,
    smooth: usize,
    along: AlongSpec,
    /// Largest distance of the measured abscissae from 0.
    reach: f64,
}

impl Model {
    /// Creates the model of a case whose statistics have these columns.
    ///
    /// # Errors
    /// Returns which of its expressions is invalid (`x`, `y` or `rows`), and why.
    pub fn new(spec: &ModelSpec, columns: &[String]) -> Result<Self, (&'static str, String)> {
        let starts = columns.iter().map(|c| format!("{c}{START}"));
        let names = columns.iter().cloned().chain(starts);
        let names: Vec<String> = names.chain([TIME_STEP.to_owned()]).collect();
        let known = |why: ExpressionError| match why.message.split_once("; there are ") {
            Some((why, _)) => format!(
                "{why}; there are {}, each with {START} for its value in the first row, and {TIME_STEP}",
                columns.join(", ")
            ),
            None => why.to_string(),
        };
        if spec.rows == RowsSpec::LastCycle && !columns.iter().any(|c| c == "cycle") {
            return Err((
                "rows",
                "the case has no friction test with cycles".to_owned(),
            ));
        }
        Ok(Self {
            x: Expression::of_numbers(&spec.x, &names).map_err(|why| ("x", known(why)))?,
            y: Expression::of_numbers(&spec.y, &names).map_err(|why| ("y", known(why)))?,
            columns: columns.to_vec(),
            rows: spec.rows,
            smooth: usize::from(spec.smooth),
            along: spec.along,
            reach: 0.0,
        })
    }

    /// Returns this model for a measured curve whose coordinates extend up to `reach` from 0.
    pub fn reaching(self, reach: f64) -> Self {
        Self { reach, ..self }
    }

    /// Returns increasing abscissae, and values, from the table of statistics of a run with this
    /// step (s).
    ///
    /// # Errors
    /// Returns why there is no curve, as a sentence.
    pub fn curve(&self, statistics: &Path, time_step: f64) -> Result<(Vec<f64>, Vec<f64>), String> {
        let rows = self.read(statistics)?;
        let first = rows
            .first()
            .ok_or("no row of the statistics lies in the part that is used")?;
        let starts = first.clone();
        let values = |row: &Vec<f64>| -> Vec<Option<f64>> {
            row.iter()
                .chain(&starts)
                .chain([&time_step])
                .map(|v| v.is_finite().then_some(*v))
                .collect()
        };
        let mut xs = Vec::new();
        let mut ys = Vec::new();
        for row in &rows {
            let values = values(row);
            if let (Some(x), Some(y)) = (self.x.value(&values), self.y.value(&values)) {
                xs.push(x);
                ys.push(y);
            }
        }
        let mut branches = vec![0; xs.len()];
        if self.along == AlongSpec::Branches {
            (xs, branches) = laid_out(&xs, self.reach);
        }
        // Values are not smoothed across a turning point, where a loop is steepest.
        let mut rest = ys.as_slice();
        let mut ys = Vec::with_capacity(xs.len());
        for branch in branches.chunk_by(|a, b| a == b) {
            let (own, after) = rest.split_at(branch.len());
            ys.extend(smoothed(own, self.smooth));
            rest = after;
        }
        // Only points that advance are kept: small steps back are noise of the motion.
        let mut curve = (Vec::new(), Vec::new());
        for (x, y) in xs.into_iter().zip(ys) {
            if curve.0.last().is_none_or(|last| x > *last) {
                curve.0.push(x);
                curve.1.push(y);
            }
        }
        match curve.0.len() {
            0 => Err("its expressions have no finite value in any row".to_owned()),
            _ => {
                continue_ends(&mut curve.0);
                continue_ends(&mut curve.1);
                Ok(curve)
            }
        }
    }

    /// Reads the rows of the columns in the order of the names.
    fn read(&self, statistics: &Path) -> Result<Vec<Vec<f64>>, String> {
        let missing = |e: &dyn std::fmt::Display| format!("{}: {e}", statistics.display());
        let mut reader = csv::Reader::from_path(statistics).map_err(|e| missing(&e))?;
        let headings = reader.headers().map_err(|e| missing(&e))?;
        let names: Vec<&str> = headings.iter().map(without_unit).collect();
        let places: Vec<Option<usize>> = self
            .columns
            .iter()
            .map(|c| names.iter().position(|n| n == c))
            .collect();
        let place = |name: &str| self.columns.iter().position(|c| c == name);
        let (time, cycle) = (place("time"), place("cycle"));
        let mut rows: Vec<Vec<f64>> = Vec::new();
        for record in reader.records().map_while(Result::ok) {
            let number = |p: &Option<usize>| {
                p.and_then(|k| record.get(k)?.parse().ok())
                    .unwrap_or(f64::NAN)
            };
            rows.push(places.iter().map(number).collect());
        }
        let at = |row: &Vec<f64>, place: Option<usize>| place.map_or(f64::NAN, |k| row[k]);
        match self.rows {
            RowsSpec::All => {}
            RowsSpec::From(from) => rows.retain(|r| at(r, time) >= from),
            RowsSpec::Between(from, to) => rows.retain(|r| (from..=to).contains(&at(r, time))),
            RowsSpec::LastCycle => {
                let last = rows.iter().map(|r| at(r, cycle)).fold(0.0, f64::max);
                // The last cycle may be incomplete.
                let count = |c: f64| rows.iter().filter(|r| at(r, cycle) == c).count();
                let whole = if count(last) * 20 >= count(last - 1.0) * 19 {
                    last
                } else {
                    last - 1.0
                };
                rows.retain(|r| at(r, cycle) == whole);
            }
        }
        Ok(rows)
    }
}

/// Extends a list at both ends by the difference of its last two entries: rows are between the ends
/// of a run, one interval apart.
fn continue_ends(list: &mut Vec<f64>) {
    if let [first, second, ..] = list[..] {
        list.insert(0, 2.0 * first - second);
    }
    if let [.., before, last] = list[..] {
        list.push(2.0 * last - before);
    }
}

/// Returns means over an odd number of neighbours, fewer at the ends.
fn smoothed(values: &[f64], width: usize) -> Vec<f64> {
    let mean = |k: usize| {
        let reach = (width / 2).min(k).min(values.len() - 1 - k);
        let near = &values[k - reach..=k + reach];
        near.iter().sum::<f64>() / near.len() as f64
    };
    (0..values.len()).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_made_of_columns() {
        let path = std::env::temp_dir().join(format!("fretwork-model-{}.csv", std::process::id()));
        let text =
            "step,time [s],delta [m],Q [N]\n1,0.1,5.0,1\n2,0.2,6.0,2\n3,0.3,5.5,9\n4,0.4,8.0,4\n";
        std::fs::write(&path, text).unwrap();
        let columns: Vec<String> = ["step", "time", "delta", "Q"].map(str::to_owned).to_vec();
        let spec = |x: &str, rows| ModelSpec {
            x: x.into(),
            y: "Q / 2".into(),
            rows,
            smooth: 1,
            along: AlongSpec::Abscissa,
        };
        let of = |x: &str, rows| {
            let model = Model::new(&spec(x, rows), &columns).unwrap();
            model.curve(&path, 0.25)
        };
        let curve = of("delta - delta_start", RowsSpec::From(0.15)).unwrap();
        assert_eq!(curve, (vec![-2.0, 0.0, 2.0, 4.0], vec![0.0, 1.0, 2.0, 3.0]));
        assert_eq!(
            of("delta - 4 * time_step", RowsSpec::From(0.15)).unwrap().0,
            [3.0, 5.0, 7.0, 9.0]
        );
        assert!(of("delta", RowsSpec::From(9.0)).is_err());
        let (key, message) = Model::new(&spec("dlta", RowsSpec::All), &columns).unwrap_err();
        assert!(
            key == "x" && message.contains("`dlta`") && message.contains("delta, Q"),
            "{message}"
        );
        // A loop of constant friction keeps its shape when it is smoothed: the turning points are
        // left out.
        std::fs::write(&path, "step,time [s],delta [m],Q [N]\n1,0.1,0.0,2\n2,0.2,1.0,2\n3,0.3,2.0,2\n4,0.4,1.0,-2\n5,0.5,0.0,-2\n").unwrap();
        let loops = ModelSpec {
            smooth: 3,
            along: AlongSpec::Branches,
            ..spec("delta", RowsSpec::All)
        };
        let curve = Model::new(&loops, &columns).unwrap().reaching(2.0);
        let (_, ys) = curve.curve(&path, 0.25).unwrap();
        assert!(ys.iter().all(|y| y.abs() == 1.0), "{ys:?}");
        std::fs::remove_file(&path).unwrap();
        assert_eq!(smoothed(&[1.0, 2.0, 6.0, 4.0], 3), [1.0, 3.0, 4.0, 4.0]);
    }
}
