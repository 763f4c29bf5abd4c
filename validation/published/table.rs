//! The table of a study: runs by column.

use crate::comparison::Failure;
use crate::sample::Estimate;
use std::collections::BTreeMap;
use std::path::Path;

/// One run, by the names of the columns without units.
#[derive(Clone, Debug, Default)]
pub struct Run(BTreeMap<String, String>);

impl Run {
    /// A number of a column that [`Table::require`] has checked; panics if there is none.
    pub fn number(&self, column: &str) -> f64 {
        self.optional(column)
            .unwrap_or_else(|| panic!("`{column}` has no number and was not required of its table"))
    }

    pub fn optional(&self, column: &str) -> Option<f64> {
        let number: Option<f64> = self.text(column).parse().ok();
        number.filter(|x| x.is_finite())
    }

    pub fn text(&self, column: &str) -> &str {
        self.0.get(column).map_or("", String::as_str)
    }
}

/// The runs that are done.
#[derive(Clone, Debug, Default)]
pub struct Table {
    pub runs: Vec<Run>,
    /// Number of runs of the study, including those that are not done.
    pub wanted: usize,
    /// Processor time of the runs that are done (s).
    pub seconds: f64,
    /// Versions of the program that made the runs.
    pub programs: Vec<String>,
}

impl Table {
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let mut reader = csv::Reader::from_path(path)?;
        let without_unit = |name: &str| name.split(" [").next().unwrap_or(name).to_owned();
        let names: Vec<String> = reader.headers()?.iter().map(without_unit).collect();
        let mut table = Self::default();
        for record in reader.records() {
            let record = record?;
            let cells = names.iter().cloned().zip(record.iter().map(str::to_owned));
            let run = Run(cells.collect());
            table.wanted += 1;
            if run.text("status") == "done" {
                table.seconds += run.optional("cpu_seconds").unwrap_or(0.0);
                table.runs.push(run);
            }
        }
        Ok(table)
    }

    /// Checks that each run that is done has a finite number in these columns.
    pub fn require(&self, columns: &[&str]) -> Result<(), Failure> {
        for column in columns {
            for run in &self.runs {
                if run.optional(column).is_none() {
                    let point = run.text("point");
                    return Err(format!(
                        "run {point} of its table has no number in the column `{column}`"
                    )
                    .into());
                }
            }
        }
        Ok(())
    }

    /// The runs that meet a condition, by setting, in the order of the study.
    pub fn settings(&self, condition: impl Fn(&Run) -> bool) -> Vec<Setting<'_>> {
        let mut settings: Vec<Setting> = Vec::new();
        for run in self.runs.iter().filter(|r| condition(r)) {
            match settings.last_mut() {
                Some(last) if last.runs[0].text("setting") == run.text("setting") => {
                    last.runs.push(run);
                }
                _ => settings.push(Setting { runs: vec![run] }),
            }
        }
        settings
    }

    /// The runs whose column has a text.
    pub fn named(&self, column: &str, text: &str) -> Option<Setting<'_>> {
        self.settings(|r| r.text(column) == text).into_iter().next()
    }
}

/// Runs of one setting with several seeds; at least one.
pub struct Setting<'a> {
    pub runs: Vec<&'a Run>,
}

impl Setting<'_> {
    /// Mean of a column over the seeds.
    pub fn mean(&self, column: &str) -> Estimate {
        self.over(|run| run.number(column))
    }

    /// Mean over the seeds of what is computed from each run.
    pub fn over(&self, value: impl Fn(&Run) -> f64) -> Estimate {
        let values: Vec<f64> = self.runs.iter().map(|r| value(r)).collect();
        Estimate::of(&values)
    }

    /// Number of the setting in its study.
    pub fn index(&self) -> f64 {
        self.factor("setting")
    }

    /// Returns the value of a factor, which is equal in all runs.
    pub fn factor(&self, column: &str) -> f64 {
        self.runs[0].number(column)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_that_are_not_done_do_not_count() {
        let path =
            std::env::temp_dir().join(format!("fretwork-validation-{}.csv", std::process::id()));
        let text = "setting,seed,p [Pa],status,cpu_seconds [s]\n1,1,2,done,5\n1,2,4,done,5\n2,1,9,failed,5\n2,2,,not run,\n";
        std::fs::write(&path, text).unwrap();
        let table = Table::read(&path).unwrap();
        std::fs::remove_file(path).unwrap();
        assert_eq!(
            (table.wanted, table.runs.len(), table.seconds),
            (4, 2, 10.0)
        );
        let settings = table.settings(|_| true);
        assert_eq!((settings.len(), settings[0].mean("p").mean), (1, 3.0));
        assert!(table.require(&["p"]).is_ok());
        // The tests are an absent column, and an empty cell of a run that is done.
        let refusal = |t: &Table, c: &str| t.require(&[c]).unwrap_err().to_string();
        assert!(refusal(&table, "q").contains("`q`"));
        let mut empty = table.clone();
        empty.runs[1].0.insert("p".to_owned(), String::new());
        assert!(refusal(&empty, "p").contains("`p`"));
    }
}
