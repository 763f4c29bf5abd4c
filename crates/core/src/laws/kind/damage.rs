//! Damage laws: how a bond weakens. They receive traction and energy of the undamaged bond, see
//! `laws::bonds`.

use super::{CertificateSpec, CheckSet, Domain, Kind, KindSpec, Output, commit_record, templates};
use crate::laws::error::LawError;
use crate::laws::function::Call;
use crate::laws::interface::Interface;
use crate::laws::outputs::Outputs;
use crate::laws::outputs::Range::Share;
use fretwork_abi::FLAG_OPENING;

/// The entry of the registry.
pub static SPEC: KindSpec = KindSpec {
    word: "damage",
    code: fretwork_abi::KIND_DAMAGE,
    doc: "growth of damage",
    functions: &[Call::Commit],
    domain: Domain::Bonds,
    outputs,
    fits,
    commit: crate::commit_hook!(commit_record),
    certificate: CertificateSpec {
        // The partners have the two forms of the stored energy, with (1 - D) and (1 - D)^2.
        partners: &[
            &[(Kind::COHESION, "elastic-bond")],
            &[(Kind::COHESION, "mac")],
        ],
        checks: CheckSet::Bond,
    },
    templates: templates!("damage"),
};

fn outputs(out: &mut Outputs, call: Call) -> Vec<Output<'_>> {
    match call {
        Call::Commit => vec![Output::ranged(("out_damage", &mut out.damage, Share))],
        _ => Vec::new(),
    }
}

/// A damage law needs a cohesion law that has an opening.
fn fits(law: &Interface) -> Result<(), LawError> {
    let Some(damage) = law.damage() else {
        return Ok(());
    };
    let reason = match law.cohesion() {
        None => format!(
            "the damage law `{}` of interface `{}` has no cohesion to damage; give the interface a cohesion law",
            damage.plugin.name, law.name
        ),
        Some(c) if !c.has(FLAG_OPENING) || c.plugin.degradation <= 0.0 => format!(
            "the cohesion law `{}` of interface `{}` has no opening that the damage law `{}` could follow; choose another cohesion or drop the damage",
            c.plugin.name, law.name, damage.plugin.name
        ),
        Some(_) => return Ok(()),
    };
    Err(LawError::Incompatible { reason })
}
