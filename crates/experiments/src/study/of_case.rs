//! The study of a case itself: several seeds, or points over the ranges that the sources of its
//! inputs give.

use super::spec::{StudyFile, StudySpec};
use crate::spec::{Spec, SpecFile};
use crate::{Error, load};
use fretwork_core::laws::SearchPath;
use fretwork_scene::input_ranges::{GivenRange, given_ranges};
use fretwork_scene::source::Source;
use std::fmt::Write as _;
use std::path::Path;

/// Points for each input with a range: ten are the usual number of a design for a smooth response
/// (J. L. Loeppky, J. Sacks, W. J. Welch, Technometrics 51, 2009).
const POINTS: usize = 10;
/// Ratio of the ends of a range from which its logarithm is varied.
const WIDE: f64 = 10.0;

/// Returns the study of a case with a number of seeds: at the values of the case, or over the
/// ranges of its inputs if `ranges`. `outputs` are the results that are compared, by default the
/// main ones.
///
/// # Errors
/// The case is refused, or no input of it has a range.
pub fn of_case(
    case: &Path,
    ranges: bool,
    seeds: u16,
    outputs: &[String],
    search: &SearchPath,
) -> Result<StudyFile, Error> {
    let given = match ranges {
        false => Vec::new(),
        true => {
            let loaded = load(case, &[])?;
            let built = loaded.build(search)?;
            let laws = built.simulation.view().laws();
            let given = given_ranges(&loaded.case, &built.materials, laws);
            if given.is_empty() {
                return Err(Error::Usage(format!(
                    "{}: no parameter of its laws comes from a file that gives a range with it; add `range: (low, high)` to numbers of a material or \
                     parameter file, or write a study with factors of your own (docs/study.md)",
                    case.display()
                )));
            }
            given
        }
    };
    let source = Source::from_text(case, text(case, &given, seeds, outputs));
    let spec: StudySpec = source.parse()?;
    spec.check(&source)?;
    Ok(SpecFile {
        spec,
        source,
        path: case.to_owned(),
    })
}

/// Returns the text of the study, which [`StudySpec`] describes.
fn text(case: &Path, given: &[GivenRange], seeds: u16, outputs: &[String]) -> String {
    let file = case.file_name().unwrap_or_default().to_string_lossy();
    let mut out = format!(
        "(\n    case: {file:?},\n    seeds: {seeds},\n    outputs: {outputs:?},\n    factors: [\n"
    );
    for input in given {
        let keys: Vec<String> = input.keys.iter().map(|key| format!("{key:?}")).collect();
        let [low, high] = input.range;
        let scale = match low > 0.0 && high / low >= WIDE {
            true => ", scale: Log",
            false => "",
        };
        let name = format!("{} {} {}", input.file, input.law, input.parameter);
        let _ = writeln!(
            out,
            "        Range(name: {name:?}, key: [{}], low: {low:e}, high: {high:e}{scale}),",
            keys.join(", ")
        );
    }
    out += "    ],\n";
    if !given.is_empty() {
        let points = POINTS * given.len();
        let _ = writeln!(out, "    design: LatinHypercube(points: {points}),");
    }
    out + ")\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given(parameter: &str, range: [f64; 2]) -> GivenRange {
        GivenRange {
            file: "oxide".to_owned(),
            kind: "contact".to_owned(),
            law: "coulomb".to_owned(),
            parameter: parameter.to_owned(),
            value: range[0],
            range,
            unit: String::new(),
            source: "a paper".to_owned(),
            keys: vec![
                format!("interfaces.a.parameters.contact.{parameter}"),
                format!("interfaces.b.parameters.contact.{parameter}"),
            ],
        }
    }

    #[test]
    fn a_study_over_ranges_has_a_factor_of_each_input() {
        let inputs = [given("mu", [0.1, 0.73]), given("w", [0.1, 60.0])];
        let path = Path::new("cases/a case.ron");
        let source = Source::from_text(path, text(path, &inputs, 2, &["wear.Qs".to_owned()]));
        let spec: StudySpec = source.parse().unwrap_or_else(|e| panic!("{e}"));
        spec.check(&source).unwrap();
        assert_eq!((spec.factors.len(), spec.seeds), (2, 2));
        assert_eq!(spec.outputs, ["wear.Qs"]);
        assert_eq!(spec.case, Path::new("a case.ron"));
        for (k, (low, high)) in [(0.1, 0.73), (0.1, 60.0)].into_iter().enumerate() {
            let factor = spec.factors[k].factor(&source, "factors").unwrap();
            assert_eq!(factor.keys, inputs[k].keys);
            let ends = [factor.at(0.0), factor.at(1.0)].map(|level| level.number.unwrap());
            let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-9;
            assert!(near(ends[0], low) && near(ends[1], high), "{ends:?}");
        }
        // The middle of a wide range is that of its logarithm.
        let wide = spec.factors[1].factor(&source, "factors").unwrap();
        assert!((wide.at(0.5).number.unwrap() / 6f64.sqrt() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn seeds_alone_are_a_study_of_one_setting() {
        let path = Path::new("case.ron");
        let of = |seeds| {
            let source = Source::from_text(path, text(path, &[], seeds, &[]));
            let spec: StudySpec = source.parse().unwrap();
            spec.check(&source)
        };
        assert!(of(8).is_ok());
        assert!(of(1).is_err());
    }
}
