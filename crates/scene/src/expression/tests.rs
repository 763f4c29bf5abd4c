//! Values, dimensions and errors of expressions.

use super::*;

/// The value and the unit of an expression of amounts.
fn of(text: &str, names: &[(&str, f64, &str)]) -> Result<(f64, String), String> {
    let words: Vec<&str> = names.iter().map(|n| n.0).collect();
    let expression = Expression::parse(text, &words).map_err(|e| e.to_string())?;
    let value = |k: usize| Amount::of(names[k].1, names[k].2).ok();
    let amount = expression.amount(&value).map_err(|e| e.to_string())?;
    Ok((amount.value, amount.measure.in_words()))
}

fn plain(text: &str) -> f64 {
    Expression::of_numbers(text, &["a", "b"])
        .unwrap_or_else(|e| panic!("{text}: {e}"))
        .value(&[Some(3.0), Some(0.5)])
        .unwrap()
}

#[test]
fn values_are_those_of_arithmetic() {
    for (text, value) in [
        ("1 + 2 * a", 7.0),
        ("(1 + 2) * a", 9.0),
        ("a - 1 - 1", 1.0),
        ("a / 2 / 3", 0.5),
        ("2 ^ a ^ b", 2f64.powf(3f64.powf(0.5))),
        // A sign binds less strongly than a power, also in front of an exponent.
        ("-a^2", -9.0),
        ("2^-1", 0.5),
        ("--a", 3.0),
        ("2e-5*a", 2e-5 * 3.0),
        (".5 + 1.", 1.5),
        ("1_000", 1000.0),
        ("sqrt(a^2)", 3.0),
        ("min(a, b) + max(a, 4)", 4.5),
        ("sin(pi / 6)", (std::f64::consts::PI / 6.0).sin()),
        ("PI", std::f64::consts::PI),
        ("ln(exp(b))", 0.5),
        ("atan2(1, 1)", std::f64::consts::FRAC_PI_4),
        ("{a} * {b}", 1.5),
    ] {
        assert_eq!(plain(text), value, "{text}");
    }
    let halved = Expression::of_numbers("b / 2", &["a", "b"]).unwrap();
    assert_eq!(halved.value(&[None, Some(1.0)]), Some(0.5));
    assert_eq!(halved.value(&[Some(1.0), None]), None);
    assert_eq!(halved.needs(), [1]);
    let pole = Expression::of_numbers("1 / a", &["a"]).unwrap();
    assert_eq!(pole.value(&[Some(0.0)]), None);
}

#[test]
fn amounts_have_the_dimensions_of_their_calculation() {
    let names = [
        ("p0", 1.12, "GPa"),
        ("L", 2.0, "mm"),
        ("rho", 7.85, "t/m^3"),
        // Names that are units too.
        ("g", 10.0, "m/s^2"),
        ("h", 4.0, "mm"),
    ];
    for (text, value, unit) in [
        ("5 kg * g", 50.0, "in `N`"),
        ("2 * g / h", 5000.0, "in `s^-2`"),
        ("20 N / h", 5000.0, "in `N/m`"),
        ("p0 * 2 N/m", 2.24e9, "in `kg^2 m^-1 s^-4`"),
        ("p0 * L", 1.12e9 * 2e-3, "in `N/m`"),
        ("L / 2 + 1 mm", 2e-3, "in `m`"),
        ("sqrt(p0 / rho)", (1.12e9f64 / 7850.0).sqrt(), "in `m/s`"),
        ("2 N/mm", 2000.0, "in `N/m`"),
        ("0.02 kJ/m^2", 20.0, "in `N/m`"),
        ("3e-5 mm^3/(N m)", 3e-14, "in `1/Pa`"),
        ("2 Pa s / (4 s)", 0.5, "in `Pa`"),
        ("2 mm^2", 2e-6, "in `m^2`"),
        ("40 % * L", 0.8e-3, "in `m`"),
        ("tan(45 deg)", 1.0, "a pure number"),
        ("60 rpm * L", 2.0 * std::f64::consts::PI * 2e-3, "in `m/s`"),
        ("max(L, 3 mm)", 3e-3, "in `m`"),
        ("L^(1/3) * L^(2/3)", 2e-3, "in `m`"),
    ] {
        let (found, words) = of(text, &names).unwrap_or_else(|e| panic!("{text}: {e}"));
        assert!((found / value - 1.0).abs() < 1e-14, "{text}: {found}");
        assert_eq!(words, unit, "{text}");
    }
}

#[test]
fn errors_say_what_is_wrong_and_where() {
    let names = [
        ("p0", 1.0, "GPa"),
        ("length", 2.0, "mm"),
        ("n", 3.0, ""),
        ("m", 2.0, "kg"),
    ];
    for (text, at, words) in [
        (
            "p0 + length",
            "p0 + length",
            "`p0` is in `Pa`, and `length` is in `m`: they cannot be added",
        ),
        ("1 - length", "1 - length", "subtracted"),
        (
            "n ^ length",
            "n ^ length",
            "the exponent `length` is in `m`",
        ),
        (
            "2 * sin(length)",
            "length",
            "`length` is in `m`, and `sin` takes an angle",
        ),
        ("exp(n * p0)", "n * p0", "`exp` takes a pure number"),
        (
            "min(p0, length)",
            "length",
            "two values of the same dimension",
        ),
        ("2 * lenght", "lenght", "did you mean `length`?"),
        ("p0 / 2 N/s", "s", "as in `a / (2 N/m)`"),
        ("p0 / 2 N/(s K)", "s K", "as in `a / (2 N/m)`"),
        ("2 m", "m", "`m` is a name of this file and a unit"),
        ("5 N/m", "m", "`m` is a name of this file and a unit"),
        ("p0 * 5 N*m", "m", "`m` is a name of this file and a unit"),
        (
            "sqr(n)",
            "sqr",
            "there is no function `sqr`; did you mean `sqrt`?",
        ),
        ("2 mmm", "mmm", "`mmm` is not a known unit"),
        ("2 * s", "s", "a unit stands after a number, `1 s`"),
        ("2*s", "s", "a unit stands after a number, `1 s`"),
        ("n * kg", "kg", "a unit stands after a number, `1 kg`"),
        ("n *", "*", "a value is missing at the end"),
        ("", "", "an expression is missing"),
        ("(n", "(", "this `(` is not closed by `)`"),
        ("n)", ")", "this `)` closes nothing"),
        ("n n", "n", "an operator such as `*` is missing"),
        ("2 n", "n", "an operator such as `*` is missing"),
        ("1,5 * n", ",", "a decimal comma"),
        ("* n", "*", "a value is missing before this `*`"),
        ("max(n)", "max(n)", "`max` takes 2 values, and there are 1"),
        ("sin", "sin", "its values stand in parentheses"),
        (
            "n / (n - n)",
            "n / (n - n)",
            "is inf, which is no finite number",
        ),
    ] {
        let expression = Expression::parse(text, &names.map(|n| n.0));
        let value = |k: usize| Amount::of(names[k].1, names[k].2).ok();
        let wrong = expression.and_then(|e| e.amount(&value)).unwrap_err();
        let said = wrong.to_string();
        assert!(said.contains(words), "{text}: {said}");
        assert_eq!(&text[wrong.span.clone()], at, "{text}: {said}");
    }
    let numbers = Expression::of_numbers("2 mm * a", &["a"]).unwrap_err();
    assert!(numbers.message.contains("have no units"), "{numbers}");
    let deep = "(".repeat(1 << 10);
    assert!(of(&deep, &[]).unwrap_err().contains("levels deep"));
    let signs = "-".repeat(1 << 10);
    assert!(of(&signs, &[]).unwrap_err().contains("levels deep"));
    let long = "1+".repeat(1 << 20);
    assert!(of(&long, &[]).unwrap_err().contains("4096"));
    // Any text is answered, also one cut at any place.
    let all = "min(2 mm^2/(N m), {p0}) ^ -1.5e3 * \u{b0}π * sqrt(n²)";
    for (end, _) in all.char_indices() {
        let _ = of(&all[..end], &names);
        let _ = of(&all[end..], &names);
    }
}
