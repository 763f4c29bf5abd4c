//! Units of the numbers that a run leaves.

use super::quantity::{Quantity, column_unit};
use serde_json::Value;
use std::path::Path;

/// SI unit of a quantity, from the summary and the statistics of a run that has it; empty for pure numbers (docs/outputs.md).
pub fn unit_of(quantity: &Quantity, summary: &Value, folder: &Path) -> String {
    if let Some(column) = quantity.column_name() {
        return column_unit(&folder.join("statistics.csv"), column).unwrap_or_default();
    }
    let path: Vec<&str> = quantity.name.split('.').collect();
    let plane = summary["dimension"] == 2;
    let either = |solid: &str, flat: &str| if plane { flat } else { solid }.to_owned();
    match path.as_slice() {
        ["measures", name] => summary["measure_units"][*name]
            .as_str()
            .unwrap_or_default()
            .to_owned(),
        ["energy", ..] | ["cycles", _, "work"] | ["fretting", "energy"] => either("J", "J/m"),
        ["cycles", _, "normal_force" | "tangential_amplitude"] => either("N", "N/m"),
        ["cycles", _, "path" | "amplitude" | "sliding"] => "m".to_owned(),
        ["cycles", _, "wear_volume"] | ["fretting", "wear_volume"] => either("m3", "m3/m"),
        ["wear", "Qs" | "Qi" | "Qe" | "Qw"] => summary["wear"]["unit"]
            .as_str()
            .unwrap_or_default()
            .to_owned(),
        ["wear", "volume_first_bodies" | "volume_third_body"] => either("m3", "m3/m"),
        ["wear", "load_path"] => either("N m", "N"),
        ["scars", _, "depth" | "middle"] => "m".to_owned(),
        ["time" | "cpu_seconds" | "wall_seconds"] => "s".to_owned(),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn units_are_those_of_the_dimension() {
        let summary = json!({"dimension": 2, "measure_units": {"bulk_rate": "1/s"}, "wear": {"unit": "kg/(m s)"}});
        let of = |name| {
            unit_of(
                &Quantity::parse(name).unwrap(),
                &summary,
                Path::new("/nowhere"),
            )
        };
        assert_eq!(of("energy.friction"), "J/m");
        assert_eq!(of("measures.bulk_rate"), "1/s");
        assert_eq!(of("cycles.1.work"), "J/m");
        assert_eq!(of("wear.Qs"), "kg/(m s)");
        assert_eq!(of("friction_coefficient"), "");
    }
}
