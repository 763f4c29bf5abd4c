//! A kind of law whose keyword is a field of an interface is refused where a case is read or
//! written. This binary contains this test alone, since a registered kind stays for the lifetime of
//! the program.

#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use fretwork_core::laws::kind::{CertificateSpec, CheckSet, Domain, commit_record};
use fretwork_core::laws::kind::{fits_always, no_outputs};
use fretwork_core::laws::{Kind, KindSpec};
use fretwork_scene::load;
use std::path::Path;

/// An interface has a field `healing`: a time.
static HEALING: KindSpec = KindSpec {
    word: "healing",
    code: 106,
    doc: "how bonds form again",
    functions: &[],
    domain: Domain::Near,
    outputs: no_outputs,
    fits: fits_always,
    commit: fretwork_core::commit_hook!(commit_record),
    certificate: CertificateSpec {
        partners: &[&[]],
        checks: CheckSet::Contact,
    },
    templates: None,
};

#[test]
fn a_kind_with_the_name_of_a_field_of_interfaces_is_refused() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/verification/healing.ron");
    let loaded = load(&path, &[]).unwrap_or_else(|e| panic!("{e}"));
    assert!(loaded.case.interfaces.iter().any(|i| i.healing.is_some()));
    assert!(ron::to_string(&loaded.case).is_ok());

    Kind::register(&HEALING).unwrap();
    let wanted = "the registered kind of law `healing` (code 106) has the name of the field `healing`; \
                  register it with another word";
    let error = load(&path, &[]).err().unwrap().to_string();
    assert!(error.contains(wanted), "{error}");
    let error = ron::to_string(&loaded.case).unwrap_err().to_string();
    assert!(error.contains(wanted), "{error}");
}
