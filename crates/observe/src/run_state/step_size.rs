//! Whether the step was small enough for the motion of the bodies.

use crate::quantity::unit::{METRE, ONE, SECOND, WORD};
use crate::quantity::{Field, Schema, field};
use crate::warning::Warning;
use fretwork_core::contact::StepSizeDiagnostics;

/// First occurrence of an event.
const OCCURRENCE: [Field; 2] = [
    field("time", SECOND, "start of the step of the first occurrence"),
    field("bodies", WORD, "the bodies of the first occurrence"),
];

const fn first(name: &'static str, doc: &'static str) -> Field {
    Field {
        name,
        doc,
        schema: Schema::Part(&OCCURRENCE),
    }
}

/// Fields of the diagnostics.
pub(super) const FIELDS: [Field; 19] = [
    field(
        "late",
        ONE,
        "contacts first found with an overlap above 1 % of the reduced radius of their bodies",
    ),
    field(
        "deepest",
        ONE,
        "deepest overlap of a contact that was found late, over the reduced radius",
    ),
    first("first_late", "first contact that was found late"),
    field(
        "sunk",
        ONE,
        "contacts first found with an overlap above 1 % of the reduced radius, of bodies that do not move as far in a step",
    ),
    field(
        "deepest_sunk",
        ONE,
        "deepest overlap of a contact that was found sunk, over the reduced radius",
    ),
    first("first_sunk", "first contact that was found sunk"),
    field(
        "passed",
        ONE,
        "times that two bodies passed into or through each other within a step",
    ),
    first("first_passed", "first pair that passed"),
    field(
        "held_back",
        ONE,
        "impacts with restitution that followed another impact of the same step",
    ),
    first("first_held_back", "first impact that was held back"),
    field(
        "unwatched_steps",
        ONE,
        "steps in which a body moved farther than the neighbour list covers",
    ),
    first(
        "first_unwatched",
        "first body that moved farther than the neighbour list covers",
    ),
    field(
        "edges",
        ONE,
        "times that a sliding body was slowed by an edge that the error of the solver may have made",
    ),
    field(
        "highest_edge",
        METRE,
        "height of the highest edge that slowed a sliding body",
    ),
    field(
        "pieces",
        ONE,
        "convex pieces of the scene when an edge slowed a body last",
    ),
    first("first_edge", "first edge that slowed a sliding body"),
    first("motion_lost", "first motion that was lost to round-off"),
    field(
        "foreseen",
        ONE,
        "contacts created before the step that closes them",
    ),
    field(
        "repeated_solves",
        ONE,
        "solves repeated for contacts found from the velocities of the first solve",
    ),
];

/// Returns warnings of a step that is too large.
pub(super) fn warnings(diagnostics: &StepSizeDiagnostics) -> Vec<Warning> {
    let reasons = [
        ("TOO FAST", diagnostics.warning()),
        ("FOUND OVERLAPPING", diagnostics.sunk_warning()),
        ("MOTION LOST", diagnostics.rounding_warning()),
    ];
    let reasons = reasons.into_iter();
    let reasons = reasons.filter_map(|(of, text)| Some(Warning::serious(of, text?)));
    // The warning is serious where they are many in relation to the number of bodies.
    let edges = diagnostics.edges_warning().map(|(many, text)| match many {
        true => Warning::serious("EDGES MET", text),
        false => Warning::note("EDGES MET", text),
    });
    reasons.chain(edges).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_core::contact::Occurrence;

    /// A warning of bodies that slid into low edges is serious from one to a thousand pieces, and a
    /// note below.
    #[test]
    fn low_edges_are_a_reason_where_they_are_many() {
        let told = |edges: u64| {
            let first_edge = (edges > 0).then(|| Occurrence {
                time: 0.5,
                bodies: vec!["grain 1".to_owned(), "floor".to_owned()],
            });
            let mut diagnostics = StepSizeDiagnostics::default();
            (diagnostics.edges, diagnostics.pieces) = (edges, 5000);
            (diagnostics.highest_edge, diagnostics.first_edge) = (3e-5, first_edge);
            let list = warnings(&diagnostics);
            assert!(list.iter().all(|w| w.of == "EDGES MET"));
            list
        };
        assert!(told(0).is_empty());
        let few = told(4);
        assert!(few.len() == 1 && !few[0].serious);
        let many = told(5);
        assert!(many.len() == 1 && many[0].serious);
        assert!(
            many[0].text.starts_with("5 times a body")
                && many[0].text.contains("detection.alert of 6.0e-3 m")
        );
    }

    #[test]
    fn contacts_found_late_are_a_reason() {
        let mut diagnostics = StepSizeDiagnostics::default();
        (diagnostics.late, diagnostics.deepest) = (3, 0.2);
        let of: Vec<&str> = warnings(&diagnostics).iter().map(|w| w.of).collect();
        assert_eq!(of, ["TOO FAST"]);
    }
}
