//! Wear laws: the volume that a contact loses in a step, from slip, force, friction work and broken
//! bonds.

use super::{CertificateSpec, CheckSet, Domain, Kind, KindSpec, Output, fits_always, templates};
use crate::contact::ContactWear;
use crate::contact::network::Key;
use crate::geometry::space::Space;
use crate::laws::error::LawError;
use crate::laws::function::Call;
use crate::laws::outputs::Outputs;
use crate::laws::outputs::Range::NotNegative;
use crate::laws::slot::SlotCommit;
use std::collections::HashSet;

/// The entry of the registry.
pub static SPEC: KindSpec = KindSpec {
    word: "wear",
    code: fretwork_abi::KIND_WEAR,
    doc: "what is removed",
    functions: &[Call::Commit],
    domain: Domain::Near,
    outputs,
    fits: fits_always,
    commit: crate::commit_hook!(commit),
    certificate: CertificateSpec {
        partners: &[&[(Kind::CONTACT, "coulomb")]],
        checks: CheckSet::Removal,
    },
    templates: templates!("wear"),
};

fn outputs(out: &mut Outputs, call: Call) -> Vec<Output<'_>> {
    match call {
        Call::Commit => vec![Output::ranged(("out_volume", &mut out.volume, NotNegative))],
        _ => Vec::new(),
    }
}

fn commit<S: Space>(slot: &mut SlotCommit<'_, S>) -> Result<(), LawError> {
    // The volume that comes from a broken bond counts once, also in a cycle that represents many.
    let network = &mut *slot.network;
    let breaks = network
        .bond_breaks
        .iter()
        .filter(|_| network.cycle_multiplier > 1.0);
    let broke: HashSet<Key> = breaks.map(|b| b.key).collect();
    for (at, worn) in slot.members.iter().zip(&slot.outputs.volume) {
        let times = if broke.contains(&network.contacts[*at].key) {
            1.0
        } else {
            network.cycle_multiplier
        };
        let volume = times * worn;
        let surface = network.contacts[*at].key.surface();
        if let Some(surface) = surface.filter(|s| !network.of_grains.contains(s)) {
            slot.totals.worn_first += volume;
            if volume > 0.0 {
                *network.worn.entry(surface).or_default() += volume;
            }
            if let (Some(losses), true) = (&mut network.losses, volume > 0.0) {
                let contact = *at as u32;
                losses.push(ContactWear { contact, volume });
            }
        } else {
            slot.totals.worn_third += volume;
        }
    }
    Ok(())
}
