//! The settings of a study: one value of each factor.

use super::spec::{DesignSpec, StudyFile};
use crate::Error;
use crate::factor::{Factor, Level};
use crate::table::csv;
use fretwork_math::design::grid::full_factorial;
use fretwork_math::design::latin_hypercube::latin_hypercube;
use fretwork_math::design::saltelli::saltelli;
use fretwork_math::design::sobol::sobol;
use fretwork_scene::InputError;
use std::collections::HashMap;

/// One value of each factor.
pub type Setting = Vec<Level>;

/// Returns the settings of a design in their order; `own` is the value of a factor in the case.
/// Rows of a table may add factors: columns that are keys.
///
/// # Errors
/// A range has no levels in a design of levels, a design has too many points, or a table does not
/// fit.
pub fn settings(
    read: &StudyFile,
    factors: &mut Vec<Factor>,
    own: impl Fn(&Factor) -> Level,
) -> Result<Vec<Setting>, Error> {
    let places = |rows: Vec<Vec<f64>>, factors: &[Factor]| -> Vec<Setting> {
        let row = |row: Vec<f64>| factors.iter().zip(row).map(|(f, x)| f.at(x)).collect();
        rows.into_iter().map(row).collect()
    };
    let refused = |e: &dyn std::fmt::Display| read.source.error_at("design", e.to_string());
    let count = factors.len();
    Ok(match &read.spec.design {
        DesignSpec::Grid => {
            let levels = levels(read, factors)?;
            let counts: Vec<usize> = levels.iter().map(Vec::len).collect();
            let rows = full_factorial(&counts).map_err(|e| refused(&e))?;
            let row = |row: Vec<usize>| levels.iter().zip(row).map(|(l, k)| l[k].clone()).collect();
            rows.into_iter().map(row).collect()
        }
        DesignSpec::OneAtATime => {
            let own = factors.iter().map(own).collect();
            one_at_a_time(own, &levels(read, factors)?)
        }
        DesignSpec::LatinHypercube { points, seed } => {
            places(latin_hypercube(*points as usize, count, *seed), factors)
        }
        DesignSpec::Sobol { points, seed } => {
            let rows = sobol(*points as usize, count, *seed);
            places(rows.map_err(|e| refused(&e))?, factors)
        }
        DesignSpec::Sensitivity { points, seed } => {
            let rows = saltelli(*points as usize, count, *seed);
            places(rows.map_err(|e| refused(&e))?, factors)
        }
        DesignSpec::Table { file } => table(&read.beside(file), factors)?,
    })
}

/// The levels of all factors.
fn levels(read: &StudyFile, factors: &[Factor]) -> Result<Vec<Vec<Level>>, InputError> {
    let each = factors.iter().enumerate().map(|(k, factor)| {
        factor.levels().ok_or_else(|| {
            read.source.error_at(
                &format!("factors.{k}"),
                format!("the range `{}` has no levels, which a grid is made of; add `levels: 5`, or take another design", factor.name),
            )
        })
    });
    each.collect()
}

/// Returns the case itself, then each level of each factor separately.
fn one_at_a_time(base: Setting, levels: &[Vec<Level>]) -> Vec<Setting> {
    let mut all = vec![base.clone()];
    for (k, values) in levels.iter().enumerate() {
        for value in values {
            let mut setting = base.clone();
            setting[k] = value.clone();
            all.push(setting);
        }
    }
    all
}

/// Returns the rows of a file: a column is a factor by its name, or a key.
fn table(path: &std::path::Path, factors: &mut Vec<Factor>) -> Result<Vec<Setting>, Error> {
    let csv::Texts {
        headings: names,
        rows,
    } = csv::read(path)?;
    let refused = |why: String| Error::Usage(format!("{}: {why}", path.display()));
    if rows.is_empty() {
        let why = "it has no points; expected a heading and one row for each point";
        return Err(refused(why.to_owned()));
    }
    if let Some(missing) = factors.iter().find(|f| !names.contains(&f.name)) {
        return Err(refused(format!(
            "there is no column `{}`, which is a factor of the study; there are {}",
            missing.name,
            names.join(", ")
        )));
    }
    let known = std::mem::take(factors);
    for (k, name) in names.iter().enumerate() {
        if names[..k].contains(name) {
            return Err(refused(format!("there are two columns `{name}`")));
        }
        let column = || {
            let mut values: Vec<String> = rows.iter().map(|r| r[k].clone()).collect();
            values.sort();
            values.dedup();
            values
        };
        let of_spec = known.iter().find(|f| f.name == *name).cloned();
        factors.push(of_spec.unwrap_or_else(|| Factor::of_column(name, column())));
    }
    let mut all = Vec::new();
    // Equal numbers of a column are one level, in the spelling of the first.
    let mut spelled: HashMap<(usize, u64), Level> = HashMap::new();
    for (line, row) in rows.iter().enumerate() {
        let values = factors
            .iter()
            .zip(row)
            .enumerate()
            .map(|(k, (factor, text))| {
                let named = factor.named(text);
                let value = named.map_err(|why| refused(format!("point {}: {why}", line + 1)))?;
                // Minus zero equals zero.
                let bits = value.number.map(|x| (x + 0.0).to_bits());
                Ok(match bits {
                    Some(bits) => spelled.entry((k, bits)).or_insert(value).clone(),
                    None => value,
                })
            });
        all.push(values.collect::<Result<Setting, Error>>()?);
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_at_a_time_changes_one_factor_of_the_case() {
        let factor = |key| Factor::of_column(key, vec!["1".into(), "2".into()]);
        let levels = [factor("a"), factor("b")].map(|f| f.levels().unwrap());
        let own = Level {
            label: "3".into(),
            number: Some(3.0),
            sets: Vec::new(),
        };
        let sets: Vec<Vec<String>> = one_at_a_time(vec![own.clone(), own], &levels)
            .iter()
            .map(|s| s.iter().flat_map(|v| v.sets.clone()).collect())
            .collect();
        assert_eq!(
            sets,
            [vec![], vec!["a=1"], vec!["a=2"], vec!["b=1"], vec!["b=2"]]
        );
    }
}
