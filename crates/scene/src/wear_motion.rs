//! Motions in which wear coefficients of files were measured, beside the motion of a case.

use super::build::LoadedCase;
use super::case::InterfaceSpec;
use super::input_ranges::parameters_of;
use super::material::{InterfaceParameters, MeasuredMotion};
use super::processes::FrictionTest;
use super::wear_coefficient;
use fretwork_core::laws::Kind;
use fretwork_core::view::RunView;
use std::collections::BTreeMap;

/// A coefficient that a case uses in another motion than that in which it was measured.
struct Misplaced {
    file: String,
    law: String,
    parameter: String,
    measured: MeasuredMotion,
    /// Coefficients of the file that were measured in the motion of the case, with their laws.
    others: Vec<(String, String)>,
    /// Interfaces that use it.
    interfaces: Vec<String>,
}

/// Returns a sentence for each coefficient of wear in a file that was measured in another motion
/// than that of the friction test of a case; none for a case without a friction test.
pub fn measured_otherwise(loaded: &LoadedCase, s: &dyn RunView) -> Vec<String> {
    let case = &loaded.case;
    let Some(test) = FrictionTest::of(case, s) else {
        return Vec::new();
    };
    let reciprocates = test.clock.period.is_some();
    let library = loaded.material_library();
    let mut found: Vec<Misplaced> = Vec::new();
    for spec in &case.interfaces {
        let read = |file: &str| Some(library.read(file).ok()?.text().to_owned());
        let Some((file, parameters)) = parameters_of(case, spec, read) else {
            continue;
        };
        for (law, parameter, measured) in used(spec, &parameters) {
            if measured.is_fretting() == reciprocates {
                continue;
            }
            let same =
                |m: &&mut Misplaced| m.file == file && m.law == law && m.parameter == parameter;
            match found.iter_mut().find(same) {
                Some(known) => known.interfaces.push(spec.name.clone()),
                None => found.push(Misplaced {
                    file: file.clone(),
                    law: law.to_owned(),
                    parameter: parameter.to_owned(),
                    measured,
                    others: fitting(&parameters, reciprocates),
                    interfaces: vec![spec.name.clone()],
                }),
            }
        }
    }
    found.iter().map(|m| m.sentence(reciprocates)).collect()
}

/// Returns the coefficients of the file that an interface uses, with the law and the motion: those
/// that the case does not replace.
fn used<'a>(
    spec: &'a InterfaceSpec,
    parameters: &'a InterfaceParameters,
) -> Vec<(&'a str, &'a str, MeasuredMotion)> {
    let Some(law) = spec.law(Kind::WEAR) else {
        return Vec::new();
    };
    let given = parameters
        .slots
        .get(Kind::WEAR)
        .and_then(|laws| laws.get(law));
    let own = spec.parameters.get(Kind::WEAR);
    let replaced = |name: &str| {
        own.is_some_and(|own| {
            own.contains_key(name) || (name == wear_coefficient::NAME && !own.is_empty())
        })
    };
    let numbers = given.into_iter().flatten();
    let kept = numbers.filter(|(name, _)| !replaced(name));
    kept.filter_map(|(name, number)| Some((law, name.as_str(), number.motion?)))
        .collect()
}

/// Returns the wear coefficients of a file, with their laws, that fit to a motion to and fro or in
/// one direction.
fn fitting(parameters: &InterfaceParameters, reciprocates: bool) -> Vec<(String, String)> {
    let none = BTreeMap::new();
    let laws = parameters.slots.get(Kind::WEAR).unwrap_or(&none);
    let all = laws.iter().flat_map(|(law, numbers)| {
        let fits = move |m: MeasuredMotion| m.is_fretting() == reciprocates;
        let numbers = numbers
            .iter()
            .filter(move |(_, n)| n.motion.is_some_and(fits));
        numbers.map(move |(name, _)| (name.clone(), law.clone()))
    });
    all.collect()
}

impl Misplaced {
    fn sentence(&self, reciprocates: bool) -> String {
        let (moves, wanted) = match reciprocates {
            true => ("to and fro", "fretting"),
            false => ("in one direction", "sliding or rolling"),
        };
        let others = self.others.iter();
        let others: Vec<String> = others.map(|(p, law)| format!("`{p}` of `{law}`")).collect();
        let file = format!("materials/{}.ron", self.file);
        let instead = match others.is_empty() {
            true => format!("{file} has none of {wanted}: give one with its source"),
            false => format!("for {wanted} {file} has {}", others.join(", ")),
        };
        format!(
            "`{}` of the wear law `{}` ({}) was measured in {}, and this case moves {moves}; {instead}",
            self.parameter,
            self.law,
            self.interfaces.join(", "),
            self.measured.name(),
        )
    }
}
