//! Transport laws: conductances of a contact for heat and electric current.

use super::{CertificateSpec, CheckSet, Domain, Kind, KindSpec, Output, fits_always, templates};
use crate::geometry::space::Space;
use crate::laws::error::LawError;
use crate::laws::function::Call;
use crate::laws::outputs::Outputs;
use crate::laws::outputs::Range::NotNegative;
use crate::laws::slot::SlotCommit;

/// The entry of the registry.
pub static SPEC: KindSpec = KindSpec {
    word: "transport",
    code: fretwork_abi::KIND_TRANSPORT,
    doc: "thermal and electrical conductance",
    functions: &[Call::Commit],
    domain: Domain::Near,
    outputs,
    fits: fits_always,
    commit: crate::commit_hook!(commit),
    certificate: CertificateSpec {
        partners: &[&[(Kind::CONTACT, "coulomb")]],
        checks: CheckSet::Transport,
    },
    templates: templates!("transport"),
};

fn outputs(out: &mut Outputs, call: Call) -> Vec<Output<'_>> {
    match call {
        Call::Commit => [
            ("out_conductance", &mut out.conductance, NotNegative),
            (
                "out_electric_conductance",
                &mut out.electric_conductance,
                NotNegative,
            ),
        ]
        .map(Output::ranged)
        .into(),
        _ => Vec::new(),
    }
}

/// Stores the conductances, through which the heat and the current of this step flow.
fn commit<S: Space>(slot: &mut SlotCommit<'_, S>) -> Result<(), LawError> {
    let outputs = slot.outputs;
    if let Some(thermal) = &mut slot.network.thermal {
        let columns = outputs
            .conductance
            .iter()
            .zip(&outputs.electric_conductance);
        for (at, (heat, current)) in slot.members.iter().zip(columns) {
            thermal.conductance[*at] = [*heat, *current];
        }
    }
    Ok(())
}
