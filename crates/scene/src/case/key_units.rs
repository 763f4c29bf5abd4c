//! Units of the numbers of a case, by the names on their path.

use fretwork_core::unit::{
    AREA, CURRENT, ENERGY, FORCE, HEAT_CAPACITY, INERTIA, MASS, MOMENT, POWER,
};

/// Keys that have the same unit on any path that [`of`] does not treat before.
const ANYWHERE: [(&str, &str); 52] = [
    ("step", "s"),
    ("end", "s"),
    ("start", "s"),
    ("until", "s"),
    ("vanishes", "s"),
    ("healing", "s"),
    ("held", "s"),
    ("at_most", "s"),
    ("period", "s"),
    ("lost_after", "s"),
    ("finest_step", "s"),
    ("largest_step", "s"),
    ("stiffness", "s"),
    ("gravity", "m/s^2"),
    ("velocity", "m/s"),
    ("rolling", "m/s"),
    ("spin", "rad/s"),
    ("frequency", "Hz"),
    ("phase", "rad"),
    ("turned", "rad"),
    ("angle", "rad"),
    ("span", "rad"),
    ("position", "m"),
    ("alert", "m"),
    ("skin", "m"),
    ("bonds_within", "m"),
    ("rms", "m"),
    ("longest", "m"),
    ("shortest", "m"),
    ("radius", "m"),
    ("gap", "m"),
    ("low", "m"),
    ("high", "m"),
    ("rounding", "m"),
    ("spacing", "m"),
    ("window", "m"),
    ("layers", "m"),
    ("height", "m"),
    ("heights", "m"),
    ("size", "m"),
    ("at", "m"),
    ("hole", "m"),
    ("balls", "m"),
    ("Balls", "m"),
    ("from", "m"),
    ("to", "m"),
    ("fine", "m"),
    ("thickness", "m"),
    ("block", "m"),
    ("centre", "m"),
    ("depth", "m"),
    ("young", "Pa"),
];

/// Keys of pure numbers, counts among them, on any path that [`of`] does not treat before.
const PURE: [&str; 53] = [
    "dimension",
    "seed",
    "theta",
    "inertia_scaling",
    "tolerance",
    "max_iterations",
    "test_every",
    "relaxation",
    "correction",
    "projection",
    "area_factor",
    "normal",
    "inclination",
    "hurst",
    "growth",
    "ratio",
    "scale",
    "exponent",
    "count",
    "rounds",
    "rows",
    "columns",
    "blocks",
    "axis",
    "about",
    "along",
    "across",
    "every",
    "bins",
    "slices",
    "times",
    "share",
    "effort",
    "accuracy",
    "finest_tolerance",
    "repeats",
    "steps",
    "Steps",
    "Number",
    "elements",
    "frames",
    "views",
    "width",
    "shear",
    "fclib",
    "clock",
    "friction",
    "impact",
    "viscous",
    "adhesion",
    "fracture",
    "regular",
    "frame",
];

/// Returns the SI unit of the numbers at a path of names, with the names of variants between them:
/// empty for pure numbers, `None` where there are texts only, or where the unit is that of the
/// parameter of a law.
pub(crate) fn of(named: &[String], dimension: usize) -> Option<&'static str> {
    let has = |name: &str| named.iter().any(|n| n == name);
    let last = named.last().map(String::as_str)?;
    let first = named.first().map(String::as_str);
    let above = |k: usize| named.len().checked_sub(k + 1).map(|k| named[k].as_str());
    match first {
        Some("heat") => return heat(last, named, dimension),
        Some("interfaces") if has("parameters") => return None,
        Some("jump") => return Some(""),
        _ => {}
    }
    // A variant that contains its value directly, `bonds: At(0.024)`, is itself the last name.
    match last {
        "mass" if has("damping") => return Some("1/s"),
        "mass" => return Some(MASS.symbol(dimension)),
        "inertia" => return Some(INERTIA.symbol(dimension)),
        "energy" if has("AtRest") => return Some(ENERGY.symbol(dimension)),
        "x" | "y" | "z" if above(1) == Some("periodic") => return Some("m"),
        "x" | "y" | "z" if matches!(above(1), Some("Wave" | "Summit")) => return Some("m"),
        "At" if has("bonds") => return Some("s"),
        "Seconds" if has("checkpoint") => return Some("s"),
        "Time" | "After" if has("until") => return Some("s"),
        "amplitude" if above(1) == Some("Wave") => return Some("m"),
        // The unit of the lengths in a file.
        "scale" if matches!(above(1), Some("Gmsh" | "Heights")) => return Some("m"),
        // Numbers of points, beside the shapes whose points are places.
        "points" if matches!(above(1), Some("RoughProfile" | "HeightField")) => return Some(""),
        "points" => return Some("m"),
        // Names of a phase, and of a side.
        "from" if matches!(above(1), Some("repeat" | "coarsen")) => return None,
        "above" if has("Band") => return Some(""),
        "above" => return Some("m"),
        // Friction coefficients by interface.
        _ if first == Some("phases") && above(1) == Some("friction") => return Some(""),
        _ => {}
    }
    if matches!(
        last,
        "amplitude"
            | "offset"
            | "value"
            | "Constant"
            | "Table"
            | "Displacement"
            | "Velocity"
            | "Force"
            | "Pressure"
            | "Scaled"
            | "Axes"
            | "rolling"
    ) || (last == "angle" && has("Turned"))
        || (matches!(last, "from" | "to") && has("Ramp"))
    {
        return drive(named, dimension);
    }
    let found = ANYWHERE.iter().find(|(name, _)| *name == last);
    found
        .map(|(_, unit)| *unit)
        .or_else(|| PURE.contains(&last).then_some(""))
}

impl super::Case {
    /// Returns the SI unit of the number at a path of fields, keys, indices and variants: empty for
    /// pure numbers, `None` where there are texts, or the unit is that of the parameter of a law.
    pub fn unit_at(path: &[String], dimension: usize) -> Option<&'static str> {
        let index = |name: &String| name.parse::<usize>().ok();
        let names: Vec<String> = path
            .iter()
            .filter(|n| index(n).is_none())
            .cloned()
            .collect();
        of_element(&names, path.last().and_then(index), dimension)
    }
}

/// Returns the unit of a number in a group without names that is the value at a path of names, such
/// as the time of a point of a table; elsewhere that [`of`] its path.
pub(crate) fn of_element(
    named: &[String],
    place: Option<usize>,
    dimension: usize,
) -> Option<&'static str> {
    match (named.last().map(String::as_str), place) {
        (Some("Table"), Some(0)) => Some("s"),
        (Some("regular"), Some(1)) => Some("m"),
        _ => of(named, dimension),
    }
}

/// Returns the units of the keys of heat.
fn heat(last: &str, named: &[String], dimension: usize) -> Option<&'static str> {
    let has = |name: &str| named.iter().any(|n| n == name);
    Some(match last {
        "initial" | "temperature" | "ambient" => "K",
        "coefficient" => "W/(m^2 K)",
        "area" => AREA.symbol(dimension),
        "depth" | "spacing" | "over" => "m",
        "power" => POWER.symbol(dimension),
        "capacity" => HEAT_CAPACITY.symbol(dimension),
        "start" => "s",
        "flash" => "Pa",
        "Voltage" | "limit" => "V",
        "current" => CURRENT.symbol(dimension),
        "x" | "y" | "z" => "",
        _ if has("grains") || has("fixed") => "K",
        _ if has("flux") => "W/m^2",
        _ => return PURE.contains(&last).then_some(""),
    })
}

/// Returns the unit of a function of time that drives a degree of freedom, a rolling surface, or
/// gravity.
fn drive(named: &[String], dimension: usize) -> Option<&'static str> {
    let last_of = |names: &[&str]| named.iter().rposition(|n| names.contains(&n.as_str()));
    if let Some(k) = last_of(&["Turned", "Scaled", "Axes", "rolling"]) {
        return Some(match named[k].as_str() {
            "Turned" => "rad",
            "Axes" => "m/s^2",
            "rolling" => "m/s",
            _ => "",
        });
    }
    let k = last_of(&["Displacement", "Velocity", "Force", "Pressure"])?;
    let turns = last_of(&["rx", "ry", "rz"]).is_some();
    Some(match (named[k].as_str(), turns) {
        ("Displacement", false) => "m",
        ("Displacement", true) => "rad",
        ("Velocity", false) => "m/s",
        ("Velocity", true) => "rad/s",
        ("Force", false) => FORCE.symbol(dimension),
        ("Force", true) => MOMENT.symbol(dimension),
        _ => "Pa",
    })
}
