//! The interface of two bodies whose friction and wear coefficients are given.

use super::{Question, comment};
use std::fmt::Write as _;

/// Returns the interface between two materials; a wear coefficient is explained by `law`.
pub(super) fn interface(
    question: &Question,
    names: [&str; 2],
    law: &str,
) -> Result<String, String> {
    let mu = question.friction()?;
    let wear = question.wear()?;
    let mut text = String::from("    interfaces: [(\n        name: \"contact\",\n");
    let _ = writeln!(
        text,
        "        between: (\"{}\", \"{}\"),\n        contact: \"coulomb\",",
        names[0], names[1]
    );
    if wear.is_some() {
        text += &comment(8, law);
        text += "        wear: \"archard\",\n";
    }
    if question.given("friction").is_none() {
        text += &comment(
            8,
            "not given, and chosen: dry metals have 0.3 to 1; take that of your pair, or of a run with debris",
        );
    }
    let wear = wear.map_or(String::new(), |wear| format!(", wear: {wear}"));
    let _ = writeln!(
        text,
        "        parameters: (contact: {{\"mu\": {mu}}}{wear}),\n    )],"
    );
    Ok(text)
}
