//! Time and scheme of a step.

/// Time and scheme of the step, as passed to plugins.
#[derive(Clone, Copy, Debug)]
pub struct StepInfo {
    /// Dimension of space.
    pub dimension: u32,
    /// Time at the start of the step (s).
    pub time: f64,
    /// Step (s).
    pub h: f64,
    /// Theta of the scheme.
    pub theta: f64,
    /// Share of an overlap that is removed in a step.
    pub correction: f64,
}
