//! Smallest wear particle. Its runs and tables are made by `validation/smallest_particle.py`, since pieces of bonded grains are found in
//! states and not in the numbers of a study; its text has the tables.

use crate::comparison::{Comparison, Results};
use crate::row::{Row, Verdict};

pub const COMPARISON: Comparison = Comparison {
    name: "smallest_particle",
    title: "Smallest wear particle",
    studies: &[],
    published: true,
    show: |_| {
        let mut results = Results::default();
        results.rows.push(Row::statement(
            "size of the junction beyond which a particle comes off",
            "grows with γ E/σ²; tables below",
            None,
            "in proportion to γ E/σ²",
            Some(Verdict::Undecided),
        ));
        Ok(results)
    },
};
