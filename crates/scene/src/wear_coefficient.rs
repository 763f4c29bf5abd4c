//! Wear coefficients from Archard's K and the hardness of the materials, so that the coefficient
//! follows the material.
//!
//! A wear law with a parameter `k` (1/Pa) or `alpha` (m^3/J) may be given the pure number `K`
//! instead. V = K F s/H (J. F. Archard 1953) with the hardness H of the softer material, hence k =
//! K/H; in sliding with friction E_d = mu F s, hence alpha = K/(mu H) (S. Fouvry, P. Kapsa, L.
//! Vincent 1996: alpha = k/mu).

use super::material::Sourced;
use super::quantity;
use super::units;

/// Name of the pure number.
pub const NAME: &str = "K";

/// Parameters of wear laws that are derived from K, with their units.
const DERIVED: [(&str, &str); 2] = [("k", "1/Pa"), ("alpha", "m^3/J")];

/// A coefficient that was derived.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct WearCoefficient {
    /// Interface.
    pub interface: String,
    /// Wear law.
    pub law: String,
    /// The parameter of the law.
    pub parameter: String,
    /// Value in `unit`.
    pub value: f64,
    /// Unit, `1/Pa` or `m^3/J`.
    pub unit: String,
    /// Archard's coefficient, a pure number.
    pub dimensionless: f64,
    /// Hardness of the softer material (Pa).
    pub hardness: f64,
    /// The softer material, by its name in the case.
    pub softer: String,
    /// Friction coefficient of the contact law, where it was used.
    pub friction: Option<f64>,
    /// Derivation as a sentence.
    pub derivation: String,
}

/// Returns the parameter that follows from `K`, if the law with these parameters (name, unit) has
/// one, and no parameter named `K`.
pub fn parameter<'a>(
    mut fields: impl Iterator<Item = (&'a str, &'a str)> + Clone,
) -> Option<(&'static str, &'static str)> {
    if fields.clone().any(|(name, _)| name == NAME) {
        return None;
    }
    fields.find_map(|field| DERIVED.into_iter().find(|d| *d == field))
}

/// A material of an interface: its name in the case, and its hardness if its file gives one.
pub type MaterialHardness<'a> = (&'a str, Option<&'a Sourced>);

/// Law and parameter to which the coefficient belongs.
#[derive(Clone, Copy, Debug)]
pub struct CoefficientParameter<'a> {
    /// Interface.
    pub interface: &'a str,
    /// Wear law.
    pub law: &'a str,
    /// The parameter and its unit, as [`parameter`] returns them.
    pub parameter: (&'a str, &'a str),
}

/// Derives the coefficient from K (a pure number) and the two materials; `friction` is `mu` of the
/// contact law.
///
/// # Errors
/// Returns a sentence: no material has a hardness, its scale is no pressure, or a required friction
/// coefficient is missing.
pub fn derive(
    place: CoefficientParameter<'_>,
    dimensionless: f64,
    sides: &[MaterialHardness<'_>; 2],
    friction: Option<f64>,
) -> Result<WearCoefficient, String> {
    let CoefficientParameter {
        interface,
        law,
        parameter: (parameter, unit),
    } = place;
    if !(0.0..=1.0).contains(&dimensionless) {
        return Err(format!(
            "`{NAME}` of the wear law `{law}` is {dimensionless}; it is a pure number between 0 and 1, the volume worn over load times sliding distance, times the hardness"
        ));
    }
    let mut hardnesses = Vec::new();
    for (name, sourced) in sides {
        if let Some(sourced) = sourced {
            let value = quantity::hardness_in_pascal(sourced.value, &sourced.unit)
                .filter(|h| h.is_finite() && *h > 0.0)
                .ok_or_else(|| {
                    format!(
                        "`{parameter}` of the wear law `{law}` is {NAME} over a hardness, and that of `{name}`, {} {}, is no pressure; give it in HBW, HV, HK or Pa",
                        sourced.value, sourced.unit
                    )
                })?;
            hardnesses.push((value, *name, *sourced));
        }
    }
    let Some((hardness, softer, given)) = hardnesses
        .iter()
        .copied()
        .min_by(|a, b| a.0.total_cmp(&b.0))
    else {
        return Err(format!(
            "the wear law `{law}` is given `{NAME}`, for which one of its materials needs a hardness, and neither `{}` nor `{}` has one",
            sides[0].0, sides[1].0
        ));
    };
    let (formula, friction) = match parameter {
        "alpha" => match friction.filter(|mu| *mu > 0.0) {
            Some(mu) => (format!("{NAME}/(mu H), mu = {mu}"), Some(mu)),
            None => {
                return Err(format!(
                    "`{parameter}` of the wear law `{law}` is {NAME} over friction coefficient times hardness, and the contact law of the interface has no `mu` above zero; give `{parameter}` itself"
                ));
            }
        },
        _ => (format!("{NAME}/H"), None),
    };
    let value = dimensionless / hardness / friction.unwrap_or(1.0);
    let which = match (sides[0].0 == sides[1].0, hardnesses.len()) {
        (true, _) => "",
        (false, 2) => ", the softer material",
        _ => ", the only one of the two with a hardness",
    };
    let scale = match units::hardness(&given.unit) {
        Some(scale) => format!(" ({} {scale})", given.value),
        None => String::new(),
    };
    Ok(WearCoefficient {
        derivation: format!(
            "{parameter} = {value:.4e} {unit} = {formula}, {NAME} = {dimensionless:e}, H = {hardness:.4e} Pa{scale} of `{softer}`{which}"
        ),
        interface: interface.to_owned(),
        law: law.to_owned(),
        parameter: parameter.to_owned(),
        value,
        unit: unit.to_owned(),
        dimensionless,
        hardness,
        softer: softer.to_owned(),
        friction,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hardness(value: f64, unit: &str) -> Sourced {
        Sourced {
            value,
            unit: unit.to_owned(),
            range: None,
            motion: None,
            source: "test".to_owned(),
        }
    }

    const ARCHARD: CoefficientParameter<'_> = CoefficientParameter {
        interface: "a",
        law: "archard",
        parameter: ("k", "1/Pa"),
    };
    const ENERGY: CoefficientParameter<'_> = CoefficientParameter {
        parameter: ("alpha", "m^3/J"),
        law: "dissipated-energy",
        ..ARCHARD
    };

    /// 260 HBW are 260 kgf/mm², 2.5497 GPa: V = K F s/H by hand.
    #[test]
    fn the_softer_material_wears() {
        let (rail, oxide) = (hardness(260.0, "HBW"), hardness(8.7, "GPa"));
        let sides = [("rail", Some(&rail)), ("oxide", Some(&oxide))];
        let got = derive(ARCHARD, 3e-4, &sides, None).unwrap();
        assert_eq!(got.softer, "rail");
        assert!((got.hardness - 260.0 * 9.80665e6).abs() < 1.0);
        assert!((got.value / (3e-4 / 2.549_729e9) - 1.0).abs() < 1e-9);
        // Twice the hardness gives half the wear.
        let hard = hardness(520.0, "HV 10");
        let sides = [("rail", Some(&hard)), ("oxide", Some(&oxide))];
        let half = derive(ARCHARD, 3e-4, &sides, None).unwrap().value;
        assert!((half / got.value - 0.5).abs() < 1e-15);
        let sides = [("rail", Some(&rail)), ("oxide", None)];
        assert_eq!(
            derive(ARCHARD, 3e-4, &sides, None).unwrap().value,
            got.value
        );
        let energy = derive(ENERGY, 3e-4, &sides, Some(0.4)).unwrap().value;
        assert!((energy * 0.4 / got.value - 1.0).abs() < 1e-15);
    }

    #[test]
    fn what_does_not_follow_is_refused() {
        let hard = hardness(50.0, "HRC");
        let soft = hardness(260.0, "HBW");
        let none = [("rail", None), ("oxide", None)];
        let message = |place, k, sides: &[MaterialHardness<'_>; 2], mu| {
            derive(place, k, sides, mu).unwrap_err()
        };
        assert!(message(ARCHARD, 3e-4, &none, None).contains("neither `rail` nor `oxide`"));
        let sides = [("rail", Some(&hard)), ("oxide", Some(&soft))];
        assert!(message(ARCHARD, 3e-4, &sides, None).contains("50 HRC, is no pressure"));
        let sides = [("rail", Some(&soft)), ("oxide", None)];
        assert!(message(ARCHARD, 2.0, &sides, None).contains("between 0 and 1"));
        assert!(message(ENERGY, 1e-4, &sides, None).contains("no `mu`"));
        assert!(message(ENERGY, 1e-4, &sides, Some(0.0)).contains("no `mu`"));
    }

    #[test]
    fn a_law_with_its_own_name_keeps_it() {
        let fields = [("k", "1/Pa")];
        assert_eq!(parameter(fields.into_iter()), Some(fields[0]));
        assert_eq!(parameter([("k", "1/Pa"), ("K", "")].into_iter()), None);
        assert_eq!(parameter([("k", "Pa")].into_iter()), None);
    }
}
