//! Units of the numbers that a run leaves.

use super::output::{OutputName, column_unit};
use fretwork_observe::quantity::Catalogue;
use std::path::Path;

/// Returns the SI unit of a quantity by the files of a run, `1` for pure numbers; empty where the
/// run does not have it.
pub fn unit_of(quantity: &OutputName, catalogue: &Catalogue, folder: &Path) -> String {
    let unit = match quantity.column_name() {
        Some(column) => column_unit(&folder.join("statistics.csv"), column),
        None => catalogue
            .entry(&quantity.name)
            .and_then(|entry| entry.unit.clone()),
    };
    unit.unwrap_or_default()
}

/// The unit for a heading, in which pure numbers have none.
pub fn heading(unit: &str) -> &str {
    if unit == "1" { "" } else { unit }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn units_are_those_that_the_run_says() {
        let entry = |path, unit| json!({"path": path, "unit": unit, "doc": "", "role": "detail", "topic": "run", "label": ""});
        let summary = json!({"quantities": [
            entry("spins.*.rate", "1/s"), entry("spins.0.rate", "kg/s"), entry("ratio", "1"),
        ]});
        let catalogue = Catalogue::of(&summary);
        let of = |name| {
            unit_of(
                &OutputName::parse(name).unwrap(),
                &catalogue,
                Path::new("/nowhere"),
            )
        };
        assert_eq!(of("spins.0.rate"), "kg/s");
        assert_eq!(of("spins.17.rate"), "1/s");
        assert_eq!((of("ratio"), heading(&of("ratio"))), ("1".to_owned(), ""));
        assert_eq!(of("spins.rate"), "");
    }
}
