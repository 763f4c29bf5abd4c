//! Doubts about the numbers of a material: what no solid of its class has, what contradicts other
//! numbers, and what is incomplete.

use super::{Material, MaterialClass, PROPERTIES, Sourced, any_solid, unit_of};
use crate::source::{ValidationError, nearest};
use crate::units;

/// Factors of units that are forgotten or exchanged, with their names.
const SCALES: [(&str, f64); 6] = [
    ("kPa", 1e3),
    ("MPa", 1e6),
    ("GPa", 1e9),
    ("g/cm^3", 1e3),
    ("J/(g K)", 1e3),
    ("um/(m K)", 1e-6),
];

/// Lorenz number of metals (W ohm/K^2) by the law of Wiedemann and Franz (C. Kittel, Introduction
/// to Solid State Physics, chapter 6), and temperature of the properties (K).
const LORENZ: (f64, f64) = (2.44e-8, 293.0);

/// Conductivity of heat times resistivity over that of the law: from alloys at room temperature, in
/// which phonons conduct as well, to metals below their Debye temperature.
const LORENZ_RATIO: (f64, f64) = (0.5, 3.0);

/// Density times heat capacity of dense solids (J/(m^3 K)): M. F. Ashby, Materials Selection in
/// Mechanical Design, chart of conductivity and diffusivity, about which solids scatter by a factor
/// of two; the bounds are twice as wide.
const VOLUMETRIC_HEAT: (f64, f64) = (0.5e6, 8e6);

/// Hardness over yield stress: H = 3 Y (D. Tabor, The Hardness of Metals, 1951) of metals, less
/// where the elastic strains are large (K. L. Johnson, J. Mech. Phys. Solids 18 (1970) 115-126).
const TABOR: (f64, f64) = (1.0, 8.0);

/// Largest hardness over young: an elastic cone of the indenter's angle bears no more.
const HARDNESS_OF_YOUNG: f64 = 0.25;

/// Returns what is implausible in a material whose numbers can be read, each with the path of the
/// number: `properties.young.value`. `name` is that of its file, which tells the class if the
/// material has none.
pub fn doubts(material: &Material, name: &str) -> Vec<ValidationError> {
    let mut out = Vec::new();
    let class = material.class_or_described(name);
    if material.doc.trim().is_empty() {
        out.push(ValidationError::new(
            "doc",
            "`doc` is empty: say what it is",
        ));
    }
    let all = std::iter::once(("density", &material.density));
    let properties = material.properties.iter();
    for (name, given) in all.chain(properties.map(|(name, given)| (name.as_str(), given))) {
        let path = match name {
            "density" => name.to_owned(),
            name => format!("properties.{name}"),
        };
        incomplete(name, given, &path, &mut out);
        let bounds = class.map_or_else(any_solid, MaterialClass::bounds);
        if let Some((_, bounds)) = bounds.iter().find(|b| b.0 == name) {
            outside((name, given), *bounds, class, &path, &mut out);
        }
    }
    contradictions(material, class, &mut out);
    out
}

fn incomplete(name: &str, given: &Sourced, path: &str, out: &mut Vec<ValidationError>) {
    if given.source.trim().is_empty() {
        let message = format!("`{name}` has no source: name the paper, standard or data sheet");
        out.push(ValidationError::new(format!("{path}.source"), message));
    }
    let unit = match name {
        "density" => Some("kg/m^3"),
        "hardness" => Some("Pa"),
        name => unit_of(name),
    };
    match unit {
        Some(unit) if !unit.is_empty() && given.unit.trim().is_empty() => {
            let message = format!("`{name}` has no unit, and is read in {unit}");
            let fault = ValidationError::new(path, message);
            out.push(fault.expected(format!("`unit: \"{unit}\"`, or another of its kind")));
        }
        None => {
            let known = PROPERTIES.iter().map(|p| p.0).chain(["hardness"]);
            if let Some(near) = nearest(name, known) {
                let message = format!("no law and no command knows the property `{name}`");
                out.push(ValidationError::new(path, message).nearest(Some(near)));
            }
        }
        Some(_) => {}
    }
}

/// The value of a number in SI units, a hardness as a pressure.
fn in_si(name: &str, given: &Sourced) -> Option<f64> {
    match name {
        "density" => given.in_unit("kg/m^3").ok(),
        "hardness" => crate::quantity::hardness_in_pascal(given.value, &given.unit),
        name => given.in_unit(unit_of(name)?).ok(),
    }
}

fn outside(
    (name, given): (&str, &Sourced),
    (low, high): (f64, f64),
    class: Option<MaterialClass>,
    path: &str,
    out: &mut Vec<ValidationError>,
) {
    let Some(value) = in_si(name, given) else {
        return;
    };
    if low <= value && value <= high {
        return;
    }
    let unit = match name {
        "density" => "kg/m^3",
        "hardness" => "Pa",
        name => unit_of(name).unwrap_or_default(),
    };
    let of = class.map_or("a solid", MaterialClass::name);
    let [value_text, low_text, high_text] = [value, low, high].map(short);
    let with_unit = format!("{value_text} {unit}");
    let message = format!(
        "`{name}` is {}; {of} has {low_text} to {high_text}{}{unit}",
        with_unit.trim_end(),
        if unit.is_empty() { "" } else { " " },
    );
    let mut fault = ValidationError::new(format!("{path}.value"), message);
    let fits = |scale: &&(&str, f64)| {
        let (name, factor) = **scale;
        let number = given.value * factor;
        units::convert(1.0, name, unit).is_ok() && low <= number && number <= high
    };
    if let Some((unit, _)) = SCALES.iter().find(fits) {
        fault = fault.expected(format!("{} {unit}, if that is meant", short(given.value)));
    } else if class.is_some() {
        fault = fault.expected("another number, or another `class`");
    }
    out.push(fault);
}

fn contradictions(
    material: &Material,
    class: Option<MaterialClass>,
    out: &mut Vec<ValidationError>,
) {
    let value = |name: &str| material.property(name).filter(|x| x.is_finite());
    let mut add = |name: &str, message: String| {
        let path = format!("properties.{name}.value");
        out.push(ValidationError::new(path, message));
    };
    let within = |x: f64, (low, high): (f64, f64)| low <= x && x <= high;
    if let (Some(hardness), Some(young)) = (value("hardness"), value("young"))
        && hardness > HARDNESS_OF_YOUNG * young
    {
        let share = short(hardness / young);
        let message = format!("`hardness` is {share} of `young`; solids have less than 0.25");
        add("hardness", message);
    }
    if let (Some(hardness), Some(stress)) = (value("hardness"), value("yield_stress"))
        && class.is_some_and(MaterialClass::is_metal)
        && !within(hardness / stress, TABOR)
    {
        let ratio = short(hardness / stress);
        let message = format!("`hardness` is {ratio} times `yield_stress`; metals have about 3");
        add("hardness", message);
    }
    if let (Some(stress), Some(strength)) = (value("yield_stress"), value("tensile_strength"))
        && stress > 1.05 * strength
    {
        add(
            "yield_stress",
            "`yield_stress` is above `tensile_strength`".to_owned(),
        );
    }
    if let (Some(young), Some(poisson)) = (value("young"), value("poisson")) {
        for (name, other) in [
            ("shear_modulus", 0.5 * young / (1.0 + poisson)),
            ("bulk_modulus", young / (3.0 * (1.0 - 2.0 * poisson))),
        ] {
            if let Some(given) = value(name)
                && !within(given / other, (0.8, 1.25))
            {
                let other = short(other);
                let message = format!(
                    "`{name}` is {} Pa; `young` and `poisson` give {other} Pa",
                    short(given)
                );
                add(name, message);
            }
        }
    }
    let density = material.density.in_unit("kg/m^3").ok();
    if let (Some(density), Some(capacity)) = (density, value("heat_capacity"))
        && !within(density * capacity, VOLUMETRIC_HEAT)
        && density > 700.0
    {
        let product = short(density * capacity);
        let message = format!(
            "`heat_capacity` times `density` is {product} J/(m^3 K); dense solids have 1e6 to 4e6"
        );
        add("heat_capacity", message);
    }
    if let (Some(conductivity), Some(resistivity)) = (value("conductivity"), value("resistivity"))
        && class.is_some_and(MaterialClass::is_metal)
    {
        let ratio = conductivity * resistivity / LORENZ.0 / LORENZ.1;
        if !within(ratio, LORENZ_RATIO) {
            let ratio = short(ratio);
            let message = format!(
                "`conductivity` times `resistivity` is {ratio} times that of the law of Wiedemann \
                 and Franz, of which metals have 0.5 to 3"
            );
            add("conductivity", message);
        }
    }
}

/// A number with three digits.
fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    match rounded.abs() {
        size if size == 0.0 || (1e-3..1e4).contains(&size) => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::MaterialLibrary;
    use crate::source::Source;

    /// The doubts about a steel in whose text a part is replaced, as `path: message`.
    fn of(from: &str, to: &str) -> Vec<String> {
        const STEEL: &str = r#"(doc: "a steel", density: (value: 7850.0, unit: "kg/m^3", source: "s"),
            properties: {
                "young": (value: 210e9, unit: "Pa", source: "s"),
                "poisson": (value: 0.3, source: "s"),
                "hardness": (value: 260.0, unit: "HBW", source: "s"),
                "conductivity": (value: 50.0, unit: "W/(m K)", source: "s"),
            })"#;
        assert!(STEEL.contains(from));
        let text = STEEL.replacen(from, to, 1);
        let material: Material = Source::from_text("own.ron", text).parse().unwrap();
        let all = doubts(&material, "own").into_iter();
        all.map(|d| {
            format!(
                "{}: {} {}",
                d.path,
                d.message,
                d.expected.unwrap_or_default()
            )
        })
        .collect()
    }

    #[test]
    fn usual_errors_are_doubted_where_they_are() {
        assert_eq!(of("a steel", "a steel"), [""; 0]);
        for (from, to, path, words) in [
            (
                "210e9, unit: \"Pa\"",
                "210.0, unit: \"Pa\"",
                "properties.young.value",
                "210 GPa, if",
            ),
            (
                "210e9, unit: \"Pa\"",
                "210e9",
                "properties.young",
                "no unit",
            ),
            ("0.3", "0.6", "properties.poisson.value", "0.24 to 0.35"),
            ("7850.0", "7.85", "density.value", "7.85 g/cm^3, if"),
            (
                "260.0, unit: \"HBW\"",
                "260.0, unit: \"GPa\"",
                "properties.hardness.value",
                "of `young`",
            ),
            (
                "value: 50.0",
                "value: 0.0",
                "properties.conductivity.value",
                "steel has 10 to 85",
            ),
            ("\"young\"", "\"yuong\"", "properties.yuong", "no law"),
            (
                "source: \"s\"),\n",
                "source: \" \"),\n",
                "density.source",
                "has no source",
            ),
            (
                "\"conductivity\": (value: 50.0, unit: \"W/(m K)\"",
                "\"yield_stress\": (value: 30.0, unit: \"GPa\"",
                "properties.hardness.value",
                "`yield_stress`",
            ),
            (
                "\"conductivity\": (value: 50.0, unit: \"W/(m K)\"",
                "\"shear_modulus\": (value: 210.0, unit: \"GPa\"",
                "properties.shear_modulus.value",
                "give 8.08e10",
            ),
        ] {
            let found = of(from, to);
            let place = format!("{path}: ");
            assert!(
                found
                    .iter()
                    .any(|d| d.starts_with(&place) && d.contains(words)),
                "{to}: {found:?}"
            );
        }
    }

    #[test]
    fn no_shipped_material_is_doubted() {
        for listed in MaterialLibrary::shipped().list() {
            let material = listed.material.unwrap_or_else(|e| panic!("{e}"));
            let tests = ["benchmark_", "verification_", "contact_"];
            let of_tests = tests.iter().any(|prefix| listed.name.starts_with(prefix));
            assert!(material.class.is_some() || of_tests, "{}", listed.name);
            let found = doubts(&material, &listed.name);
            assert!(found.is_empty(), "{}: {found:#?}", listed.name);
            assert!(material.density().is_ok());
        }
    }
}
