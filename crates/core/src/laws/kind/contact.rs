//! Contact laws: friction, restitution, rolling. Their outputs enter the local form of each
//! contact, see `laws::prepare`.

use super::{
    CertificateSpec, CheckSet, Domain, KindSpec, Output, commit_record, fits_always, templates,
};
use crate::laws::function::Call;
use crate::laws::outputs::Outputs;
use crate::laws::outputs::Range::{NotNegative, Share, Signed};

/// The entry of the registry.
pub static SPEC: KindSpec = KindSpec {
    word: "contact",
    code: fretwork_abi::KIND_CONTACT,
    doc: "friction, restitution, rolling",
    functions: &[Call::Prepare],
    domain: Domain::All,
    outputs,
    fits: fits_always,
    commit: crate::commit_hook!(commit_record),
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
    let mut columns: Vec<_> = [
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
    .into();
    let [force_n, force_t1, force_t2] = &mut out.contact_force;
    if force_n.is_empty() {
        return columns;
    }
    let springs = [
        ("out_contact_force_n", force_n),
        ("out_contact_stiffness_n", &mut out.contact_stiffness_n),
        ("out_contact_stiffness_t", &mut out.contact_stiffness_t),
        ("out_contact_unloading_t", &mut out.contact_unloading_t),
        ("out_energy", &mut out.contact_energy_t),
        ("out_contact_damping_n", &mut out.contact_damping_n),
        ("out_contact_damping_t", &mut out.contact_damping_t),
    ];
    columns.extend(springs.map(|(name, values)| Output::ranged((name, values, NotNegative))));
    let tangential = [
        ("out_contact_force_t1", force_t1),
        ("out_contact_force_t2", force_t2),
    ];
    columns.extend(tangential.map(Output::finite));
    columns
}
