//! Cases from their text.

use std::path::Path;

use super::{Case, key_units};
use crate::quantity;
use crate::source::{InputError, Names, Node, Place, Source, ValueKind, Wanted};

// These functions are compiled in this crate only: the deserializers of a case are half of its
// code, and a generic call in another crate would compile them again.
impl Case {
    /// Reads the case that a text is, see [`Source::parse`]; numbers may have units, see
    /// [`Case::convert_units`].
    ///
    /// # Errors
    /// The text is no case, or a unit does not fit; the error names file, line and column.
    #[inline(never)]
    pub fn read(source: &Source) -> Result<Self, InputError> {
        if !source.has_quantities() {
            return source.parse();
        }
        let mut converted = source.clone();
        Self::convert_units(&mut converted)?;
        converted.parse()
    }

    /// Replaces numbers with units in the text of a case, `step: 10 us`, and expressions in names
    /// of its `let`, `"${p0 * L}"`, by numbers in SI units, and those of parameters of laws by
    /// `(value: 10, unit: "us")`.
    ///
    /// # Errors
    /// A unit or name is unknown, or of another dimension than the number; the error names file,
    /// line and column.
    pub fn convert_units(source: &mut Source) -> Result<(), InputError> {
        let written = source.tree().find(source.text(), &["dimension".to_owned()]);
        let text = |node: &Node| source.text()[node.span.clone()].to_owned();
        // Units of other numbers depend on it, so that its error comes first.
        let wrong = match written.as_ref().map(|node| (&node.kind, text(node))) {
            Ok((ValueKind::Text, _)) => Some("the dimension is no text or expression".to_owned()),
            Ok((ValueKind::Number, number))
                if quantity::number(&number).is_some_and(|d| d != 2.0 && d != 3.0) =>
            {
                Some(format!("dimension {number} is not possible"))
            }
            _ => None,
        };
        if let Some(message) = wrong {
            return Err(source.error_at("dimension", message).expected("2 or 3"));
        }
        let plane = written.is_ok_and(|node| quantity::number(&text(node)) == Some(2.0));
        let dimension = if plane { 2 } else { 3 };
        source.replace_quantities(|place: &Place<'_>| {
            let names = place.names;
            let of_interface = names.first().is_some_and(|n| n == "interfaces");
            if of_interface && names.iter().any(|n| n == "parameters") {
                return Wanted::Pair;
            }
            let of_material = names.first().is_some_and(|n| n == "materials");
            if of_material && names.last().is_some_and(|n| n == "value") {
                return Wanted::Pair;
            }
            match key_units::of_element(names, place.index, dimension) {
                Some(unit) => Wanted::In(unit),
                None => Wanted::NoNumber,
            }
        })
    }

    /// Reads the file of a case, see [`Source::read_as`].
    ///
    /// # Errors
    /// The file cannot be read, or is no JSON or YAML where its name says so.
    #[inline(never)]
    pub fn source(path: &Path) -> Result<Source, InputError> {
        Source::read_as::<Self>(path)
    }

    /// Wraps the text of a case, see [`Source::text_as`].
    ///
    /// # Errors
    /// The text is no JSON or YAML where its name says so.
    #[inline(never)]
    pub fn source_of_text(name: &str, text: &str) -> Result<Source, InputError> {
        Source::text_as::<Self>(name, text)
    }

    /// Changes a value of the text of a case, see [`Source::set`].
    ///
    /// # Errors
    /// The argument is malformed, or a case has no such key.
    #[inline(never)]
    pub fn set(source: &mut Source, argument: &str) -> Result<(), InputError> {
        source.set::<Self>(argument)
    }

    /// The names that may stand below a path of a case, see [`Source::names`].
    #[inline(never)]
    pub fn names(source: &Source, path: &str) -> Option<Names> {
        source.names::<Self>(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Node;

    const PLANE: &str = r#"(
    name: "a lid", dimension: 2, time: (step: 1e-5, end: 0.2),
    periodic: (x: 4e-3), gravity: [0, -9.81],
    materials: {"steel": "rail_steel_r260"},
    interfaces: [(name: "dry", between: ("steel", "steel"), contact: "coulomb", parameters: (contact: {"mu": 0.3}))],
    bodies: [(
        name: "lid", material: "steel", shapes: [HalfSpace(normal: (0, 1))], mass: 2.0, position: [0, 1e-3],
        dofs: (x: Displacement(Table([(0, 0), (1e-3, 5e-6)])), y: Force(-500e3)),
    )],
    phases: [(name: "load", until: After(0.05)), (name: "slide")],
    output: (checkpoint: Seconds(60)),
)"#;

    fn read(text: &str, sets: &[&str]) -> Result<Case, InputError> {
        let mut source = Source::from_text("case.ron", text);
        for set in sets {
            Case::set(&mut source, set)?;
        }
        Case::read(&source)
    }

    /// The text with each of these values written in another way.
    fn with(changes: &[(&str, &str)]) -> String {
        changes.iter().fold(PLANE.to_owned(), |text, (old, new)| {
            assert_eq!(text.matches(old).count(), 1, "{old}");
            text.replace(old, new)
        })
    }

    #[test]
    fn numbers_with_units_have_the_bits_of_the_numbers_in_si() {
        let text = with(&[
            ("step: 1e-5", "step: 10us"),
            ("end: 0.2", "end: 200 ms"),
            ("x: 4e-3", "x: 4 mm"),
            ("[0, -9.81]", "[0 m/s^2, -9.81 m/s\u{b2}]"),
            ("mass: 2.0", "mass: 2000 g/m"),
            ("[0, 1e-3]", "[0 um, 1000\u{b5}m]"),
            ("[(0, 0), (1e-3, 5e-6)]", "[(0 s, 0 um), (1 ms, 5 um)]"),
            ("Force(-500e3)", "Force(-500000 N/m)"),
            ("After(0.05)", "After(50ms)"),
            ("Seconds(60)", "Seconds(1 min)"),
        ]);
        let mut plain = read(PLANE, &[]).unwrap();
        assert_eq!(read(&text, &[]).unwrap(), plain);
        // A parameter of a law keeps its unit until its law is known.
        let percent = read(&with(&[("\"mu\": 0.3", "\"mu\": 30 %")]), &[]).unwrap();
        let mu = percent.interfaces[0].parameters.iter().next().unwrap().1["mu"].clone();
        assert_eq!((mu.value, mu.unit.as_deref()), (30.0, Some("%")));
        // The same holds for changes of the command line, also for a function of time.
        plain.time.step = 2e-5;
        let sets = ["time.step=20 us", "bodies.lid.dofs.y=Force(-500000N/m)"];
        assert_eq!(read(PLANE, &sets).unwrap(), plain);
        let named = read(PLANE, &["name=10 us", "materials.steel=3m_steel"]).unwrap();
        assert_eq!(
            (named.name.as_str(), named.materials["steel"].as_str()),
            ("10 us", "3m_steel")
        );
    }

    /// Line and column of the mark before the token at fault, and the error of the text.
    fn refused(changes: &[(&str, &str)]) -> InputError {
        let marked = with(changes);
        let before = &marked[..marked.find('|').unwrap()];
        let column = before.rsplit('\n').next().unwrap().chars().count() + 1;
        let place = (before.matches('\n').count() + 1, column);
        let error = read(&marked.replace('|', ""), &[]).unwrap_err();
        assert_eq!(error.position(), Some(place), "{error}");
        error
    }

    #[test]
    fn a_unit_of_another_kind_is_refused_at_its_place_with_both_names() {
        for (old, new, words) in [
            (
                "step: 1e-5",
                "step: 10 |um",
                "`time.step` is a time, and `um` (m) does not measure the same as `s` (s)",
            ),
            (
                "step: 1e-5",
                "step: 10 |usq",
                "`time.step` is a time, and `usq` is not a known unit",
            ),
            (
                "Force(-500e3)",
                "Force(-500|kN)",
                "`bodies.lid.dofs.y` is a force per depth, and `kN`",
            ),
            ("x: 4e-3", "x: 4 |ms", "`periodic.x` is a length"),
            ("(1e-3, 5e-6)", "(1e-3 |mm, 5e-6)", "is a time"),
            (
                "end: 0.2",
                "end: 0.2, theta: 0.5 |m",
                "`time.theta` is a pure number, and `m` (m)",
            ),
        ] {
            let error = refused(&[(old, new)]);
            assert!(error.message.contains(words), "{error}");
        }
        let error = read(PLANE, &["time.step=3 km"]).unwrap_err();
        assert_eq!(error.set(), Some("time.step=3 km"));
    }

    #[test]
    fn errors_after_a_unit_keep_their_places() {
        let known = ("step: 1e-5, end: 0.2", "step: 10 us, end: 200 ms, |thta: 1");
        refused(&[known]);
        refused(&[
            ("mass: 2.0", "mass: 2 kg/m"),
            ("Force(-500e3)", "Force(|x)"),
        ]);
    }

    /// The numbers of a value, in the order of the text.
    fn numbers(node: &Node, out: &mut Vec<std::ops::Range<usize>>) {
        match &node.kind {
            ValueKind::Number => out.push(node.span.clone()),
            ValueKind::Group(group) => {
                group.entries.iter().for_each(|e| numbers(&e.value, out));
            }
            _ => {}
        }
    }

    fn cases(folder: &Path, out: &mut Vec<std::path::PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap().flatten() {
            let path = entry.path();
            if path.is_dir() {
                cases(&path, out);
            } else if path.extension().is_some_and(|e| e == "ron") {
                out.push(path);
            }
        }
    }

    /// Each number of the shipped cases may have a unit, since the unit of its key is known.
    #[test]
    fn every_number_of_the_shipped_cases_has_a_unit() {
        let mut files = Vec::new();
        cases(
            &Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases"),
            &mut files,
        );
        let mut read = 0;
        for file in files {
            let Ok(source) = Source::read(&file) else {
                continue;
            };
            let Ok(case) = Case::read(&source) else {
                continue;
            };
            let mut text = source.text().to_owned();
            let mut spans = Vec::new();
            numbers(source.tree().root.as_ref().unwrap(), &mut spans);
            for span in spans.iter().rev() {
                text.insert_str(span.end, " kg");
            }
            let mut source = Source::from_text(&file, text);
            let marked = source.replace_quantities(|place| {
                let law = place.names.iter().any(|n| n == "parameters");
                let unit = key_units::of_element(place.names, place.index, case.dimension as usize);
                assert!(
                    law || unit.is_some(),
                    "{}: {:?}",
                    file.display(),
                    place.names
                );
                Wanted::NoNumber
            });
            marked.unwrap();
            read += 1;
        }
        assert!(read > 50, "{read} cases");
    }
}
