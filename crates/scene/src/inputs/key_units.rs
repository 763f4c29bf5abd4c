//! Units of the keys of a case, by the names on their path.

use fretwork_core::unit::{AREA, CURRENT, FORCE, HEAT_CAPACITY, INERTIA, MASS, MOMENT, POWER};

/// Keys that have the same unit on any path.
const ANYWHERE: [(&str, &str); 29] = [
    ("step", "s"),
    ("end", "s"),
    ("start", "s"),
    ("until", "s"),
    ("vanishes", "s"),
    ("healing", "s"),
    ("held", "s"),
    ("at_most", "s"),
    ("period", "s"),
    ("gravity", "m/s^2"),
    ("frequency", "Hz"),
    ("phase", "rad"),
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
    ("young", "Pa"),
    ("turned", "rad"),
];

/// Keys of shapes and samples.
const OF_SHAPES: [(&str, &str); 12] = [
    ("height", "m"),
    ("size", "m"),
    ("at", "m"),
    ("hole", "m"),
    ("balls", "m"),
    ("from", "m"),
    ("to", "m"),
    ("thickness", "m"),
    ("block", "m"),
    ("centre", "m"),
    ("span", "rad"),
    ("heights", "m"),
];

/// Returns the SI unit of the key at a path of names, with the names of variants between them;
/// empty for pure numbers, texts, and parameters of laws, whose unit is that of their law.
pub(super) fn of(named: &[String], dimension: usize) -> &'static str {
    let has = |name: &str| named.iter().any(|n| n == name);
    let Some(last) = named.last().map(String::as_str) else {
        return "";
    };
    if has("parameters") || has("jump") || has("accuracy") || has("uncertainty") {
        return "";
    }
    if named.first().is_some_and(|n| n == "heat") {
        return heat(last, named, dimension);
    }
    // A variant that contains its value directly, `bonds: At(0.024)`, is itself the last name.
    match last {
        "mass" => return MASS.symbol(dimension),
        "inertia" => return INERTIA.symbol(dimension),
        "x" | "y" | "z" if has("periodic") => return "m",
        "At" if has("bonds") => return "s",
        "Seconds" if has("checkpoint") => return "s",
        "Time" | "After" if has("until") => return "s",
        _ => {}
    }
    let drive = drive(named, dimension);
    if matches!(
        last,
        "amplitude"
            | "offset"
            | "value"
            | "Constant"
            | "Displacement"
            | "Velocity"
            | "Force"
            | "Pressure"
    ) || (matches!(last, "from" | "to") && has("Ramp"))
    {
        return drive;
    }
    let shapes = ["shapes", "grains", "wears", "scars"];
    let find = |table: &[(&str, &'static str)]| {
        let found = table.iter().find(|(name, _)| *name == last);
        found.map(|(_, unit)| *unit)
    };
    if shapes.iter().any(|s| has(s))
        && let Some(unit) = find(&OF_SHAPES)
    {
        return unit;
    }
    find(&ANYWHERE).unwrap_or_default()
}

/// Returns the units of the keys of heat.
fn heat(last: &str, named: &[String], dimension: usize) -> &'static str {
    let has = |name: &str| named.iter().any(|n| n == name);
    match last {
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
        _ if has("grains") => "K",
        _ => "",
    }
}

/// Returns the unit of a function of time that drives a degree of freedom, or gravity.
fn drive(named: &[String], dimension: usize) -> &'static str {
    let last_of = |names: &[&str]| named.iter().rposition(|n| names.contains(&n.as_str()));
    if let Some(k) = last_of(&["Turned", "Scaled", "Axes"]) {
        return match named[k].as_str() {
            "Turned" => "rad",
            "Axes" => "m/s^2",
            _ => "",
        };
    }
    let Some(k) = last_of(&["Displacement", "Velocity", "Force", "Pressure"]) else {
        return "";
    };
    let turns = last_of(&["rx", "ry", "rz"]).is_some();
    match (named[k].as_str(), turns) {
        ("Displacement", false) => "m",
        ("Displacement", true) => "rad",
        ("Velocity", false) => "m/s",
        ("Velocity", true) => "rad/s",
        ("Force", false) => FORCE.symbol(dimension),
        ("Force", true) => MOMENT.symbol(dimension),
        _ => "Pa",
    }
}
