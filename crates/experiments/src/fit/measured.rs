//! Measured curves from tables of text.

use super::branches::laid_out;
use super::spec::{AlongSpec, MeasuredSpec, SigmaSpec};
use crate::Error;
use fretwork_math::fit::residuals::Measurement;
use fretwork_scene::InputError;
use fretwork_scene::measured::{Heading, MeasuredTable};
use std::path::Path;

/// Returns the heading of a column; the name alone if the file cannot be read.
fn found(path: &Path, column: &str) -> Heading {
    let own = MeasuredTable::read(path).ok().and_then(|table| {
        let place = table.column(column)?;
        table.headings.get(place).cloned()
    });
    own.unwrap_or_else(|| Heading {
        text: column.to_owned(),
        name: column.to_owned(),
        unit: String::new(),
    })
}

/// Returns the heading of a column with its unit, `stress [MPa]`; the name alone if the file cannot
/// be read.
pub fn heading(path: &Path, column: &str) -> String {
    found(path, column).text
}

/// Returns the unit in the heading of a column, `MPa` in `stress [MPa]`; empty if there is none.
pub fn unit(path: &Path, column: &str) -> String {
    found(path, column).unit
}

/// Reads a measured curve, and its largest distance from 0, which determines the distance of
/// branches.
///
/// # Errors
/// A file, column or number is missing.
pub fn curve(
    name: &str,
    spec: &MeasuredSpec,
    path: &Path,
    along: AlongSpec,
) -> Result<(Measurement, f64), Error> {
    let fail = |why: String| Error::Usage(format!("{}: {why}", path.display()));
    let wrong = |e: InputError| Error::Usage(e.with_line());
    let table = MeasuredTable::read(path).map_err(wrong)?;
    let place = |column: &str| table.required(column).map_err(wrong);
    let (x, y) = (place(&spec.x)?, place(&spec.y)?);
    let sigma = match &spec.sigma {
        SigmaSpec::Column(column) => Some(place(column)?),
        _ => None,
    };
    let mut rows: Vec<[f64; 3]> = Vec::new();
    for row in 0..table.rows() {
        let number = |column: usize| table.value(row, column).map_err(wrong);
        let row = [number(x)?, number(y)?, sigma.map_or(Ok(0.0), number)?];
        if spec
            .within
            .is_none_or(|(low, high)| (low..=high).contains(&row[0]))
        {
            rows.push(row);
        }
    }
    if rows.is_empty() {
        return Err(fail(
            "no point lies within the range that is used".to_owned(),
        ));
    }
    let largest = rows.iter().fold(0.0f64, |m, r| m.max(r[1].abs()));
    let sigma = |row: &[f64; 3]| match spec.sigma {
        SigmaSpec::Column(_) => row[2],
        SigmaSpec::Value(value) => value,
        SigmaSpec::OfLargest(share) => share * largest,
    };
    let mut abscissae: Vec<f64> = rows.iter().map(|r| r[0]).collect();
    let reach = abscissae.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    if along == AlongSpec::Branches {
        abscissae = laid_out(&abscissae, reach).0;
    }
    Ok((
        Measurement {
            name: name.to_owned(),
            x: abscissae,
            y: rows.iter().map(|r| r[1]).collect(),
            sigma: rows.iter().map(sigma).collect(),
            weight: 1.0,
        },
        reach,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_read_with_its_uncertainty() {
        let path =
            std::env::temp_dir().join(format!("fretwork-measured-{}.csv", std::process::id()));
        let text = "# a shear test\nu [mm]; tau (MPa); s\n0; 0; 1\n0,1; 50; 2\n0,2; -80; 3\n";
        std::fs::write(&path, text).unwrap();
        assert_eq!(heading(&path, "tau"), "tau (MPa)");
        assert_eq!(heading(&path, "s"), "s");
        assert_eq!(
            (unit(&path, "tau"), unit(&path, "s")),
            ("MPa".to_owned(), String::new())
        );
        let spec = |y: &str, sigma| MeasuredSpec {
            file: path.clone(),
            x: "u".into(),
            y: y.into(),
            sigma,
            within: Some((0.05, 1.0)),
        };
        let of = |y: &str, sigma| curve("shear", &spec(y, sigma), &path, AlongSpec::Abscissa);
        let (tau, reach) = of("tau", SigmaSpec::Column("s".into())).unwrap();
        assert_eq!(reach, 0.2);
        assert_eq!(
            (tau.x, tau.y, tau.sigma),
            (vec![0.1, 0.2], vec![50.0, -80.0], vec![2.0, 3.0])
        );
        assert_eq!(
            of("tau", SigmaSpec::OfLargest(0.1)).unwrap().0.sigma,
            [8.0, 8.0]
        );
        let message = of("sigma", SigmaSpec::Value(1.0)).unwrap_err().to_string();
        assert!(
            message.contains("no column `sigma`; there are u, tau, s"),
            "{message}"
        );
        std::fs::remove_file(&path).unwrap();
    }
}
