//! Reasons why a diffusion problem cannot be solved.

use thiserror::Error;

/// Reason why a diffusion problem has no solution, or none was found.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum DiffusionError {
    /// A number is invalid.
    #[error("{what} of node {node} is {value:e}; expected {expected}")]
    Number {
        /// Name of the number.
        what: &'static str,
        /// The node.
        node: usize,
        /// Value of the number.
        value: f64,
        /// Valid values.
        expected: &'static str,
    },
    /// A conductance is invalid.
    #[error("the conductance between nodes {} and {} is {value:e}; it must be finite and not negative", nodes[0], nodes[1])]
    Conductance {
        /// Nodes of the edge.
        nodes: [usize; 2],
        /// Value of the conductance.
        value: f64,
    },
    /// A source into nodes from which no path leads anywhere.
    #[error(
        "{source_rate:e} flows into node {node} and the nodes joined to it, none of which has a fixed value; no steady state exists"
    )]
    NoOutlet {
        /// The first node of the component.
        node: usize,
        /// Total source.
        source_rate: f64,
    },
    /// The linear system could not be solved.
    #[error("the linear system of {nodes} nodes could not be solved: {reason}")]
    Linear {
        /// Number of unknowns.
        nodes: usize,
        /// Reason.
        reason: String,
    },
}
