//! Units of numbers: conversions, and what is refused.

use super::*;

#[test]
fn usual_units_have_the_bits_of_the_number_in_si() {
    for (value, given, wanted, si) in [
        (600.0, "MPa", "Pa", 6e8),
        (2.1, "GPa", "Pa", 2.1e9),
        (3.0, "um", "m", 3e-6),
        (3.0, "\u{b5}m", "m", 3e-6),
        (3.0, "\u{3bc}m", "m", 3e-6),
        (0.7, "mm", "m", 0.7e-3),
        (9.0, "nm", "m", 9e-9),
        (1.3, "kJ/m^2", "J/m^2", 1.3e3),
        (1.3, "kJ/m\u{b2}", "J/m^2", 1.3e3),
        (1.0, "MJ/m^2", "J/m^2", 1e6),
        (30.0, "N/mm", "J/m^2", 3e4),
        (4.7, "N/mm", "N/m", 4.7e3),
        (7.0, "mm/s", "m/s", 7e-3),
        (7.85, "g/cm^3", "kg/m^3", 7850.0),
        (1.2, "t/m^3", "kg/m^3", 1200.0),
        (12.0, "GPa/mm", "Pa/m", 12e12),
        (3e-13, "1/kPa", "1/Pa", 3e-16),
        (3e-5, "mm^3/J", "m^3/J", 3e-14),
        (3e-5, "mm^3/(N m)", "m^3/J", 3e-14),
        (3e-5, "mm3/(N m)", "m^3/J", 3e-14),
        (7.85, "g/cm3", "kg/m^3", 7850.0),
        (1.3, "kJ/m2", "J/m^2", 1.3e3),
        (2.0, "mPa s", "Pa s", 2e-3),
        (5.0, "J s/m^2", "J s/m^2", 5.0),
        (5.0, "kg/s", "J s/m^2", 5.0),
        (40.0, "%", "", 0.4),
        (0.4, "", "", 0.4),
        (0.4, "1", "", 0.4),
        (6.0, "", "Pa", 6.0),
        (2.0, "kHz", "Hz", 2e3),
    ] {
        let found = convert(value, given, wanted).unwrap_or_else(|e| panic!("{given}: {e:?}"));
        assert_eq!(
            found.to_bits(),
            f64::to_bits(si),
            "{value} {given}: {found:e}"
        );
    }
    let angle = convert(30.0, "deg", "rad").map(|a| a - std::f64::consts::FRAC_PI_6);
    assert!(angle.clone().is_ok_and(|d| d.abs() < 2e-16), "{angle:?}");
}

#[test]
fn other_dimensions_are_refused_by_both_names() {
    for (given, wanted, base) in [
        (
            "MJ/m^3",
            "J/m^2",
            "(kg m^-1 s^-2) does not measure the same as `J/m^2` (kg s^-2)",
        ),
        (
            "MPa",
            "Pa/m",
            "(kg m^-1 s^-2) does not measure the same as `Pa/m` (kg m^-2 s^-2)",
        ),
        ("um", "", "(m) does not measure the same as a pure number"),
        // A radian is not a friction coefficient, and a cycle differs from a radian by 2 pi.
        (
            "deg",
            "",
            "(an angle) does not measure the same as a pure number",
        ),
        (
            "rad/s",
            "Hz",
            "(an angle s^-1) does not measure the same as `Hz` (s^-1)",
        ),
        ("rpm", "1/s", "(an angle s^-1)"),
        (
            "%",
            "rad",
            "(a pure number) does not measure the same as `rad` (an angle)",
        ),
        (
            "HBW",
            "Pa",
            "is a scale of hardness, and the unit here is `Pa`",
        ),
    ] {
        match convert(1.0, given, wanted) {
            Err(error) => {
                assert!(error.message.contains(base), "{error:?}");
                assert!(
                    error.message.starts_with(&format!("`{given}`")),
                    "{error:?}"
                );
            }
            Ok(_) => panic!("{given} passes for {wanted}"),
        }
    }
    let fits = convert(1.0, "MJ/m^3", "J/m^2")
        .err()
        .and_then(|e| e.expected);
    assert_eq!(
        fits.as_deref(),
        Some("`J/m^2`, `N/m`, `N/mm`, `kN/m`, `kJ/m^2`, `MJ/m^2`")
    );
}

#[test]
fn unknown_units_come_with_the_nearest() {
    for (given, near) in [
        ("Mpa", Some("MPa")),
        ("kJ/m^2x", None),
        ("GPas", None),
        ("kj/m^2", Some("kJ/m^2")),
        ("furlongs/fortnite", None),
        ("newtonn", None),
    ] {
        let Err(error) = known(given) else { continue };
        assert!(error.message.contains("unit"), "{error:?}");
        if near.is_some() {
            assert_eq!(error.nearest.as_deref(), near, "{error:?}");
        }
    }
    for (given, near) in [
        ("Mm", Some("mm")),
        ("N/Mm", Some("N/mm")),
        ("kg/Mm3", Some("kg/mm3")),
        ("Gm", None),
        ("N/megametre", None),
    ] {
        let error = known(given).err();
        let error = error.unwrap_or_else(|| panic!("{given} passes"));
        assert!(error.message.contains("a millimetre is `mm`"), "{error:?}");
        assert_eq!(error.nearest.as_deref(), near, "{error:?}");
    }
    for bad in [
        "Mpa",
        "kj/m^2",
        "3 MPa",
        "MPa)",
        "degC",
        "m^",
        "\u{1b}[31m",
        "m/0",
    ] {
        assert!(known(bad).is_err(), "{bad:?} passes");
    }
    for good in [
        "HBW",
        "HV 10",
        "HBW 10/3000",
        "HRC",
        "J s/m^2",
        "-",
        "W/(m K)",
        "\u{b0}",
    ] {
        assert!(known(good).is_ok(), "{good:?} is refused");
    }
}

#[test]
fn names_have_plurals_and_symbols_do_not() {
    for name in [
        "metres", "newtons", "bars", "hours", "seconds", "ms", "us", "s", "rad/s",
    ] {
        assert!(known(name).is_ok(), "{name}");
    }
    for (plural, near) in [
        ("mss", "ms"),
        ("Ns", "N"),
        ("kNs/m", "kN/m"),
        ("MPas", "MPa"),
    ] {
        let error = known(plural).err();
        let error = error.unwrap_or_else(|| panic!("{plural} passes"));
        assert_eq!(error.nearest.as_deref(), Some(near), "{error:?}");
    }
}

#[test]
fn values_have_a_symbol_in_si() {
    for (value, given, si, symbol) in [
        (5.0, "um", 5e-6, "m"),
        (1.0, "kPa", 1e3, "Pa"),
        (30.0, "%", 0.3, ""),
        (2.0, "1/kPa", 2e-3, "1/Pa"),
        (3e-5, "mm^3/(N m)", 3e-14, "1/Pa"),
        (0.3, "", 0.3, ""),
        (2.0, "kg m/s", 2.0, "kg m s^-1"),
        (1.0, "rad/s", 1.0, "rad s^-1"),
    ] {
        assert_eq!(in_si(value, given), Ok((si, symbol.to_owned())), "{given}");
    }
    assert!(in_si(260.0, "HBW").is_err() && in_si(1.0, "foo").is_err());
}

#[test]
fn what_is_no_unit_is_told_in_words_of_a_user() {
    for bad in [
        "3 MPa", "MPa)", "m^", "m/0", "mm4/N", "m2.5", "(m", "m^2.5", "m^999",
    ] {
        let said = read(bad).err().map(|e| e.message).unwrap_or_default();
        assert!(said.contains("unit"), "{bad}: {said}");
        assert!(
            !said.contains("Number(") && !said.contains("token"),
            "{said}"
        );
    }
}

#[test]
fn all_usual_units_are_known() {
    for name in USUAL {
        assert!(read(name).is_ok(), "{name}");
    }
}
