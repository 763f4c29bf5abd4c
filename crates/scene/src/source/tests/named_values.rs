//! Named values and expressions in cases: values, dimensions, errors with their places.

use super::*;
use crate::{Case, load_text};

const CASE: &str = r#"(
    name: "a lid", dimension: 2, time: (step: "${T / 1000}", end: "${T}"),
    let: {
        "p0": "1.12 GPa", "L": 2 mm, "T": "${4 * L / c}", "c": 3.2e3 m/s,
        "n": 12, "rho": "7.85 g/cm^3", "phi": 20 deg,
    },
    materials: {
        "steel": "rail_steel_r260",
        "own": (doc: "own", density: (value: "${rho}", source: "s")),
    },
    interfaces: [(name: "dry", between: ("steel", "steel"), contact: "coulomb",
        parameters: (contact: {"mu": "${tan(phi)}"}, cohesion: {"k_n": "${p0 / L}"}))],
    bodies: [(
        name: "lid", material: "steel", shapes: [HalfSpace(normal: (0, 1))], mass: "${rho * L * L}",
        position: [0, "${max(L, 1 mm) + 1 um}"], dofs: (y: Force(Ramp(from: 0, to: "${-p0 * L}", start: 0, end: 1))),
    )],
    output: (frames: "${n}"),
)"#;

fn read(text: &str, sets: &[&str]) -> Result<Case, InputError> {
    let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
    load_text("case.ron", text, "".as_ref(), &sets).map(|loaded| loaded.case)
}

/// The number of a law's parameter with its unit.
fn parameter(case: &Case, name: &str) -> (f64, Option<String>) {
    let mut slots = case.interfaces[0].parameters.iter();
    let found = slots.find_map(|(_, all)| all.get(name)).unwrap();
    (found.value, found.unit.clone())
}

#[test]
fn expressions_are_the_numbers_that_they_give() {
    let case = read(CASE, &[]).unwrap();
    let period = 4.0 * 2e-3 / 3.2e3;
    assert_eq!((case.time.end, case.time.step), (period, period / 1000.0));
    assert_eq!(case.bodies[0].mass, Some(7850.0 * 2e-3 * 2e-3));
    assert_eq!(case.bodies[0].position, [0.0, 2e-3 + 1e-6]);
    assert_eq!(case.output.frames, 12);
    let stiffness = parameter(&case, "k_n");
    assert_eq!(stiffness, (1.12e9 / 2e-3, Some("Pa/m".to_owned())));
    let (friction, unit) = parameter(&case, "mu");
    assert!((friction - 20f64.to_radians().tan()).abs() < 1e-15);
    assert_eq!(unit.as_deref(), Some("1"));
    let own = case.materials.own().next().unwrap().1;
    assert_eq!(own.density(), Ok(7850.0));
    let force = format!("{:?}", case.bodies[0].dofs.y);
    assert!(force.contains("-2240000.0"), "{force}");
    // The case holds values only: written and read, it is the same.
    assert!(case.named_values.is_empty());
    assert_eq!(read(&case.to_ron().unwrap(), &[]).unwrap(), case);
    // A name has the bits of the number that stands for it.
    let direct = CASE.replace("\"${T}\"", "\"${2 * T / 2}\"");
    assert_eq!(read(&direct, &[]).unwrap(), case);
}

#[test]
fn the_text_of_the_user_is_kept() {
    let loaded = load_text("case.ron", CASE, "".as_ref(), &["let.n=3".to_owned()]).unwrap();
    assert_eq!(
        loaded.source.written(),
        CASE.replace("\"n\": 12", "\"n\": 3")
    );
    assert!(!loaded.source.text().contains("let"));
    // What is kept is a case, the same one.
    assert_eq!(read(loaded.source.written(), &[]).unwrap(), loaded.case);
}

#[test]
fn set_changes_names_and_expressions() {
    let of = |sets: &[&str]| read(CASE, sets).unwrap();
    assert_eq!(of(&["let.L=4 mm"]).bodies[0].position[1], 4e-3 + 1e-6);
    assert_eq!(
        of(&["let.p0=2 * 1 GPa"]).bodies[0].mass,
        of(&[]).bodies[0].mass
    );
    assert_eq!(of(&["time.end=${2 * T}"]).time.end, 2.0 * of(&[]).time.end);
    assert_eq!(of(&["time.end=3 ms"]).time.end, 3e-3);
    // The expressions of `n` and `p0` are gone, and the names are not: a study may do so.
    let sets = ["output.frames=3", "bodies.lid.dofs.y=Force(3)"];
    assert_eq!(of(&sets).output.frames, 3);
    let wrong = read(CASE, &["let.L=4 m/s"]).unwrap_err();
    assert!(wrong.message.contains("`time.step` is a time"), "{wrong}");
}

#[test]
fn mistakes_are_errors_at_their_places() {
    // A bar stands before the place of the error.
    for (old, new, words) in [
        (
            "/ 1000}\", end: \"${T}",
            "/ 1000}\", end: |\"${L}",
            "`time.end` is a time, in `s`, and `L` is in `m`",
        ),
        (
            "\"${n}\"",
            "|\"${L}\"",
            "`output.frames` is a pure number, and `L` is in `m`",
        ),
        (
            "\"${-p0 * L}\"",
            "|\"${-p0}\"",
            "is a force per depth, in `N/m`, and `-p0` is in `Pa`",
        ),
        (
            "\"${T / 1000}\"",
            "\"${|Tt / 1000}\"",
            "`Tt` in `Tt / 1000` is not known; there are p0, L, T, c",
        ),
        ("\"${T / 1000}\"", "\"${T / 1000 + |len}\"", "`len` in"),
        ("\"${4 * L / c}\"", "\"${4 * |Lc / c}\"", "`Lc` in"),
        (
            "\"${4 * L / c}\"",
            "\"${|4 * L + c}\"",
            "they cannot be added",
        ),
        (
            "\"L\": 2 mm",
            "\"L\": 2 mm, |\"M\": 3 kg",
            "`M` is not used by any expression",
        ),
        (
            "\"L\": 2 mm",
            "|\"L\": \"T * 1 m/s\"",
            "values follow from each other in a circle: `L` from `T` from `L`",
        ),
        (
            "\"L\": 2 mm",
            "|\"L\": \"2 * L\"",
            "the value of `L` follows from itself",
        ),
        (
            "\"L\": 2 mm",
            "\"L\": 2 mm, |\"L\": 3 mm",
            "the key `L` is given twice",
        ),
        (
            "\"L\": 2 mm",
            "\"g\": 9.81 m/s^2, \"L\": \"2 m/s^2 * 1 s^2 + 3 |g\"",
            "`g` is a name of this file and a unit",
        ),
        (
            "\"L\": 2 mm",
            "\"L\": 2 mm, |\"sin\": 3",
            "`sin` is a function",
        ),
        (
            "\"L\": 2 mm",
            "\"L\": 2 mm, |\"a b\": 3",
            "`a b` cannot be a name",
        ),
        (
            "\"L\": 2 mm",
            "\"L\": |[2]",
            "the value of `L` is no amount",
        ),
        (
            "\"1.12 GPa\"",
            "\"1.12 |GPaa\"",
            "`GPaa` is not a known unit",
        ),
        (
            "\"${n}\"",
            "|\"n: ${n}\"",
            "an expression is the whole text of a number",
        ),
        ("\"${n}\"", "|${n}", "an expression stands in quotes"),
        ("dimension: 2", "dimension: |\"${n}\"", "expected 2 or 3"),
    ] {
        assert_eq!(CASE.matches(old).count(), 1, "{old}");
        let marked = CASE.replace(old, new);
        let before = &marked[..marked.find('|').unwrap()];
        let column = before.rsplit('\n').next().unwrap().chars().count() + 1;
        let place = (before.matches('\n').count() + 1, column);
        let error = read(&marked.replace('|', ""), &[]).unwrap_err();
        assert!(error.to_string().contains(words), "{new}: {error}");
        assert_eq!(error.position(), Some(place), "{new}: {error}");
    }
    let list = read("(name: \"a\", let: [1 m], dimension: 2)", &[]).unwrap_err();
    assert!(list.message.contains("`let` is no map of names"), "{list}");
    // Where the law wants another dimension, the law says so at the expression.
    let sum = read(&CASE.replace("\"${tan(phi)}\"", "\"${phi}\""), &[]).unwrap();
    assert_eq!(parameter(&sum, "mu").1.as_deref(), Some("rad"));
}

#[test]
fn a_name_that_is_set_is_there() {
    for (set, words) in [
        ("let.l=1 mm", "did you mean `L`?"),
        ("let.new=3", "`new` is not used by any expression"),
        ("time.end=${2 * h}", "`h`"),
        ("time.end=${2*h}", "`h`"),
        ("name=${L}", "`name` takes no expression"),
    ] {
        let error = read(CASE, &[set]).unwrap_err().to_string();
        assert!(error.contains(words), "{set}: {error}");
    }
    let named = CASE.replace("\"a lid\"", "\"a lid ${L}\"");
    let error = read(&named, &[]).unwrap_err();
    assert!(
        error.message.contains("`name` takes no expression"),
        "{error}"
    );
}

#[test]
fn an_open_bracket_is_the_error_and_not_what_follows() {
    let open = CASE.replacen("dofs: (y:", "dofs: y:", 1);
    let error = read(&open, &[]).unwrap_err();
    let line = CASE.lines().position(|l| l.contains("dofs:")).unwrap() + 1;
    assert!(error.position().unwrap().0 >= line, "{error}");
    let whole = CASE.strip_suffix(')').unwrap();
    let error = read(whole, &[]).unwrap_err();
    assert!(error.message.contains("never closed"), "{error}");
}

#[derive(Debug, serde::Deserialize)]
struct Counted {
    cells: u32,
    both: (u16, u16),
    load: crate::material::NumberSpec,
}

#[test]
fn files_that_pair_numbers_with_units_count_by_expressions_too() {
    for (name, text) in [
        (
            "a.ron",
            "(let: {\"n\": 4, \"P\": 2 kN}, cells: \"${2 * n}\", both: (\"${n}\", 3), load: \"${P / 2}\")",
        ),
        (
            "a.yaml",
            "let: {n: 4, P: 2 kN}\ncells: ${2 * n}\nboth: [\"${n}\", 3]\nload: ${P / 2}\n",
        ),
        (
            "a.json",
            r#"{"$schema": "b.json", "let": {"n": 4, "P": "2 kN"}, "cells": "${2 * n}", "both": ["${n}", 3], "load": "${P / 2}"}"#,
        ),
    ] {
        let mut source = Source::text_as::<Counted>(name, text).unwrap();
        source.pair_quantities().unwrap();
        let found: Counted = source.parse().unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!((found.cells, found.both), (8, (4, 3)), "{name}");
        assert_eq!(
            (found.load.value, found.load.unit.as_deref()),
            (1000.0, Some("N")),
            "{name}"
        );
    }
}
