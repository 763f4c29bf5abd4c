//! Contact laws: friction, restitution, rolling. The host takes their answers into the local form of each contact, see
//! `laws::prepare`.

use super::{
    CertificateSpec, CheckSet, Domain, KindSpec, Output, commit_state, fits_always, templates,
};
use crate::laws::columns::Outputs;
use crate::laws::library::Call;
use crate::laws::range::Range::{NotNegative, Share, Signed};

/// The entry of the registry.
pub static SPEC: KindSpec = KindSpec {
    word: "contact",
    code: fretwork_abi::KIND_CONTACT,
    doc: "friction, restitution, rolling",
    functions: &[Call::Prepare],
    domain: Domain::All,
    outputs,
    fits: fits_always,
    commit: crate::commit_hook!(commit_state),
    certificate: CertificateSpec {
        partners: &[&[]],
        checks: CheckSet::Contact,
    },
    templates: templates!("contact"),
};

fn outputs(out: &mut Outputs, call: Call) -> Vec<Output<'_>> {
    if call != Call::Prepare {
        return Vec::new();
    }
    [
        ("out_friction", &mut out.friction, NotNegative),
        ("out_restitution_n", &mut out.restitution_n, Share),
        ("out_restitution_t", &mut out.restitution_t, Signed),
        ("out_rolling", &mut out.rolling, NotNegative),
        ("out_spinning", &mut out.spinning, NotNegative),
        (
            "out_tension_strength",
            &mut out.tension_strength,
            NotNegative,
        ),
        ("out_shear_cohesion", &mut out.shear_cohesion, NotNegative),
    ]
    .map(Output::ranged)
    .into()
}
