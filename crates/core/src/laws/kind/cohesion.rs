//! Cohesion laws: traction against opening. Laws with an opening make bonds, which
//! `laws::bonds` updates in a step; the others attract at every contact.

use super::{
    CertificateSpec, CheckSet, Domain, KindSpec, Output, commit_record, fits_always, templates,
};
use crate::laws::function::Call;
use crate::laws::outputs::Outputs;
use crate::laws::outputs::Range::{NotNegative, Share};

/// The entry of the registry.
pub static SPEC: KindSpec = KindSpec {
    word: "cohesion",
    code: fretwork_abi::KIND_COHESION,
    doc: "traction against opening",
    functions: &[Call::Prepare, Call::Energy],
    domain: Domain::ByOpening,
    outputs,
    fits: fits_always,
    commit: crate::commit_hook!(commit_record),
    certificate: CertificateSpec {
        partners: &[&[]],
        checks: CheckSet::Bond,
    },
    templates: templates!("cohesion"),
};

fn outputs(out: &mut Outputs, call: Call) -> Vec<Output<'_>> {
    match call {
        Call::Prepare => {
            let [n, t1, t2] = &mut out.traction;
            let [twist, bend_1, bend_2] = &mut out.moment;
            let ranged = [
                ("out_stiffness_n", &mut out.stiffness_n, NotNegative),
                ("out_stiffness_t", &mut out.stiffness_t, NotNegative),
                ("out_damping_n", &mut out.damping_n, NotNegative),
                ("out_damping_t", &mut out.damping_t, NotNegative),
                ("out_stiffness_twist", &mut out.stiffness_twist, NotNegative),
                ("out_stiffness_bend", &mut out.stiffness_bend, NotNegative),
                (
                    "out_tension_strength",
                    &mut out.tension_strength,
                    NotNegative,
                ),
                ("out_shear_cohesion", &mut out.shear_cohesion, NotNegative),
            ];
            let any = [
                ("out_traction_n", n),
                ("out_traction_t1", t1),
                ("out_traction_t2", t2),
                ("out_moment_n", twist),
                ("out_moment_t1", bend_1),
                ("out_moment_t2", bend_2),
            ];
            let ranged = ranged.map(Output::ranged).into_iter();
            ranged.chain(any.map(Output::finite)).collect()
        }
        Call::Energy => vec![Output::finite(("out_energy", &mut out.energy))],
        Call::Commit => vec![Output::ranged(("out_damage", &mut out.damage, Share))],
        Call::Initialise => Vec::new(),
    }
}
