//! A parameter that a trade varies, with its levels.

use crate::factor::{AS_IN_THE_CASE, Level};

/// Effect of a parameter on cost and error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterEffect {
    /// Time step: smaller is finer, and the cost is inversely proportional.
    Step,
    /// Tolerance: smaller is finer.
    Tolerance,
    /// Levels without an order.
    Choice,
    /// Levels from `--vary`: the first level is that of the reference.
    Listed,
    /// Forms of the case, from the one with the fewest assumptions: the first is that of the
    /// reference, and costs are probed one by one.
    Form,
}

/// A varied parameter. Levels of a step or tolerance are ordered from the finest to the coarsest.
#[derive(Clone, Debug, PartialEq)]
pub struct Varied {
    /// Name of the parameter.
    pub name: String,
    /// Effect on cost and error.
    pub effect: ParameterEffect,
    /// Levels, at least one.
    pub levels: Vec<Level>,
    /// Index of the case's own level.
    pub own: usize,
    /// Index of the reference's level.
    pub reference: usize,
    /// Levels that are left out, with the reasons.
    pub left_out: Vec<(String, String)>,
}

impl Varied {
    /// Creates a parameter whose reference has the first level; if the number of the case's own
    /// level is not given, a level without changes is added.
    pub fn new(
        name: &str,
        effect: ParameterEffect,
        mut levels: Vec<Level>,
        own: Option<usize>,
    ) -> Self {
        let own = own.unwrap_or_else(|| {
            levels.push(Level::named(AS_IN_THE_CASE, Vec::new()));
            levels.len() - 1
        });
        Self {
            name: name.to_owned(),
            effect,
            levels,
            own,
            reference: 0,
            left_out: Vec::new(),
        }
    }

    /// Returns whether its levels have an order, so that the reference may have a coarser one.
    pub fn is_ordered(&self) -> bool {
        matches!(
            self.effect,
            ParameterEffect::Step | ParameterEffect::Tolerance | ParameterEffect::Form
        )
    }

    /// Whether the reference has a finer level than the case.
    pub fn may_be_coarser(&self) -> bool {
        self.is_ordered() && self.reference < self.own
    }
}
