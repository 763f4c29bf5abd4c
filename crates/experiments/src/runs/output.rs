//! Numbers in the output of a run: from `summary.json` or a column of `statistics.csv`.

use fretwork_observe::quantity::find;
use fretwork_scene::source::nearest;
use serde_json::Value;
use std::path::Path;

/// Location of a number.
#[derive(Clone, Debug, PartialEq)]
enum NumberLocation {
    /// A path in `summary.json`.
    Summary(Vec<String>),
    /// A column of the statistics, and its reduction to a number.
    Column(String, Reduction),
}

/// Reduction of a column to a number.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Reduction {
    /// The mean over the last half of the rows.
    Mean,
    /// The largest value.
    Max,
    /// The smallest value.
    Min,
    /// The last value.
    Last,
}

/// Name of a number in the output of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputName {
    /// Name, as requested: a path in `summary.json` (`wear.Qs`), or `statistics.COLUMN` with
    /// `:mean` of the last half of the rows, `:max`, `:min` or `:last`.
    pub name: String,
    place: NumberLocation,
}

impl OutputName {
    /// Parses a name.
    ///
    /// # Errors
    /// Returns what is wrong with it, as the end of a sentence.
    pub fn parse(name: &str) -> Result<Self, String> {
        let name = name.trim();
        if name.is_empty() {
            return Err("the name is missing".into());
        }
        let place = match name.strip_prefix("statistics.") {
            Some(column) => {
                let (column, take) = match column.rsplit_once(':') {
                    None => (column, Reduction::Mean),
                    Some((c, "mean")) => (c, Reduction::Mean),
                    Some((c, "max")) => (c, Reduction::Max),
                    Some((c, "min")) => (c, Reduction::Min),
                    Some((c, "last")) => (c, Reduction::Last),
                    Some((_, other)) => {
                        return Err(format!("`:{other}` is not one of :mean, :max, :min, :last"));
                    }
                };
                NumberLocation::Column(column.to_owned(), take)
            }
            None => NumberLocation::Summary(name.split('.').map(str::to_owned).collect()),
        };
        Ok(Self {
            name: name.to_owned(),
            place,
        })
    }

    /// Returns its column of the statistics, if it is one.
    pub fn column_name(&self) -> Option<&str> {
        match &self.place {
            NumberLocation::Summary(_) => None,
            NumberLocation::Column(name, _) => Some(name),
        }
    }

    /// Returns its value in the folder of a run; `None` if the run has none (null).
    pub fn read(&self, summary: &Value, folder: &Path) -> Option<f64> {
        match &self.place {
            NumberLocation::Summary(path) => {
                let found = find(summary, &path.join("."))?;
                found.as_f64().filter(|x| x.is_finite())
            }
            NumberLocation::Column(name, take) => {
                let values = column(&folder.join("statistics.csv"), name)?;
                let found = match take {
                    Reduction::Last => values.last().copied(),
                    Reduction::Max => values.iter().copied().reduce(f64::max),
                    Reduction::Min => values.iter().copied().reduce(f64::min),
                    Reduction::Mean => {
                        let half = &values[values.len() / 2..];
                        Some(half.iter().sum::<f64>() / half.len() as f64)
                    }
                };
                found.filter(|x| x.is_finite())
            }
        }
    }

    /// Returns the error message for the name of a group.
    pub(super) fn is_group(&self) -> String {
        format!(
            "it is not a number but a group; name one of its entries, as {}.NAME",
            self.name
        )
    }

    /// Returns the error message for an output that a case does not have, with the nearest existing
    /// one, of those that are listed and others.
    pub(super) fn unknown(
        &self,
        names: &[String],
        others: &[String],
        prefix: &str,
        wanted: &str,
    ) -> String {
        let all = || names.iter().chain(others).map(String::as_str);
        let close = nearest(wanted, all())
            .or_else(|| {
                // Only the last component is compared, since parents may have been omitted.
                let last = |n: &&str| n.rsplit('.').next() == wanted.rsplit('.').next();
                all().find(last)
            })
            .map_or(String::new(), |c| format!(" did you mean `{prefix}{c}`?"));
        format!(
            "a run of this case has no such output;{close} {}",
            listed(names, prefix)
        )
    }
}

/// Lists the existing outputs.
pub(super) fn listed(names: &[String], prefix: &str) -> String {
    let more = if prefix.is_empty() {
        ", and statistics.COLUMN of statistics.csv (:mean of the last half, :max, :min, :last)"
    } else {
        ""
    };
    if names.is_empty() {
        return format!("it has none of this kind{more}");
    }
    format!("there are {}{more}", names.join(", "))
}

/// Returns the names of the columns, without units.
fn header(path: &Path) -> Vec<String> {
    let Ok(mut reader) = csv::Reader::from_path(path) else {
        return Vec::new();
    };
    let bare = |h: &str| h.split(" [").next().unwrap_or(h).to_owned();
    reader
        .headers()
        .map(|h| h.iter().map(bare).collect())
        .unwrap_or_default()
}

/// Returns the unit of a column of a table of statistics, `1` for pure numbers; `None` without such
/// a column.
pub fn column_unit(path: &Path, name: &str) -> Option<String> {
    let mut reader = csv::Reader::from_path(path).ok()?;
    let headings = reader.headers().ok()?.clone();
    headings
        .iter()
        .find_map(|heading| match heading.split_once(" [") {
            Some((bare, unit)) => (bare == name).then(|| unit.trim_end_matches(']').to_owned()),
            None => (heading == name).then(|| "1".to_owned()),
        })
}

/// Returns the values of a column; only complete rows are read, since the table may still be
/// written to.
pub fn column(path: &Path, name: &str) -> Option<Vec<f64>> {
    let place = header(path).iter().position(|n| n == name)?;
    let mut reader = csv::ReaderBuilder::new().from_path(path).ok()?;
    let rows = reader.records().map_while(Result::ok);
    let values: Vec<f64> = rows.map_while(|r| r.get(place)?.parse().ok()).collect();
    (!values.is_empty()).then_some(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_numbers_in_a_summary() {
        let summary: Value = serde_json::from_str(
            r#"{"friction_coefficient": 0.3, "wear": {"Qs": 2.0, "Qe": null}, "cycles": [{"work": 4.0}]}"#,
        )
        .unwrap();
        let none = Path::new("/nowhere");
        let read = |name: &str| OutputName::parse(name).unwrap().read(&summary, none);
        assert_eq!(read("wear.Qs"), Some(2.0));
        assert_eq!(read("cycles.0.work"), Some(4.0));
        assert_eq!(read("wear.Qe"), None);
    }

    #[test]
    fn an_unknown_name_gets_the_nearest() {
        let names = ["friction_coefficient", "wear.Qs"].map(str::to_owned);
        for (wanted, near) in [("frction_coefficient", 0), ("Qs", 1)] {
            let output = OutputName::parse(wanted).unwrap();
            let said = output.unknown(&names, &[], "", wanted);
            assert!(
                said.contains(&format!("did you mean `{}`?", names[near])),
                "{said}"
            );
        }
    }
}
