//! Data of a kind's function at the end of a step.

use super::interface::{Interface, LoadedLaw};
use super::outputs::Outputs;
use super::step_result::{SolvedStep, Totals};
use crate::contact::Network;
use crate::geometry::space::Space;

/// The end of a step for one law of an interface that acts on contacts: the argument of a
/// [`CommitHook`](super::kind::CommitHook) after the law was called.
#[derive(Debug)]
pub struct SlotCommit<'a, S: Space> {
    /// The interface.
    pub interface: &'a Interface,
    /// The law, one of its slots.
    pub law: &'a LoadedLaw,
    /// All contacts.
    pub network: &'a mut Network<S>,
    /// Results of the solve for each contact, in the order of the network, with time and scheme.
    pub step: &'a SolvedStep<'a, S>,
    /// Energies and volumes of the step.
    pub totals: &'a mut Totals,
    pub(super) members: &'a [usize],
    pub(super) outputs: &'a Outputs,
}

impl<S: Space> SlotCommit<'_, S> {
    /// Contacts on which the law acts, as indices in the network; values of outputs are in their
    /// order.
    pub fn contacts(&self) -> &[usize] {
        self.members
    }

    /// Outputs of the law: the columns that its kind lists for a commit; the others are empty.
    pub fn outputs(&self) -> &Outputs {
        self.outputs
    }
}
