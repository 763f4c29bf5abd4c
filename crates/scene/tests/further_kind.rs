//! A further kind of interface law, defined here as one entry of the registry; no other code names
//! it. It observes contacts and records the work of friction; scenes with it give the same bits as
//! without it.

#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use fretwork_abi as abi;
use fretwork_core::certify::certify;
use fretwork_core::geometry::space::{Space, VectorLike};
use fretwork_core::in_dimension;
use fretwork_core::laws::SlotCommit;
use fretwork_core::laws::kind::{CertificateSpec, CheckSet, Domain, commit_record};
use fretwork_core::laws::kind::{fits_always, no_outputs};
use fretwork_core::laws::{BuiltInLaws, Call, Kind, KindSpec, LawError, LoadedLaw, SearchPath};
use fretwork_core::step::Simulation;
use fretwork_scene::load;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

/// Number of batches and contacts that laws of the kind received.
static BATCHES: AtomicUsize = AtomicUsize::new(0);
static CONTACTS: AtomicUsize = AtomicUsize::new(0);

/// The kind.
static RECORD: KindSpec = KindSpec {
    word: "record",
    code: 105,
    doc: "what a contact went through",
    functions: &[Call::Commit],
    domain: Domain::All,
    outputs: no_outputs,
    fits: fits_always,
    commit: fretwork_core::commit_hook!(counted),
    certificate: CertificateSpec {
        partners: &[&[(Kind::CONTACT, "coulomb")]],
        checks: CheckSet::Contact,
    },
    templates: None,
};

fn counted<S: Space>(slot: &mut SlotCommit<'_, S>) -> Result<(), LawError> {
    BATCHES.fetch_add(1, Relaxed);
    CONTACTS.fetch_add(slot.contacts().len(), Relaxed);
    commit_record(slot)
}

/// Adds the friction work of the step to the only variable.
unsafe extern "C" fn add_work(batch: *const abi::FwBatch, _: *mut abi::FwMessage) -> i32 {
    // SAFETY: the host passes complete batches; columns have `n` values.
    unsafe {
        let batch = &*batch;
        let (state, next) = (*batch.state, *batch.state_next);
        for k in 0..batch.n {
            *next.add(k) = *state.add(k) + *batch.friction_work.add(k);
            let seen = [batch.opening_n, batch.impulse_n, batch.velocity_n];
            let finite = seen.iter().all(|column| (*column.add(k)).is_finite());
            if !(finite && (*next.add(k)).is_finite() && batch.h > 0.0 && batch.h.is_finite()) {
                return abi::STATUS_ERROR;
            }
        }
    }
    abi::STATUS_OK
}

/// Returns a law of the kind, with one variable.
fn law() -> &'static abi::LinkedLaw {
    let text = |t: &'static std::ffi::CStr| t.as_ptr();
    let work: &'static abi::FwField = Box::leak(Box::new(abi::FwField {
        name: text(c"work"),
        unit: text(c"J"),
        doc: text(c"work of friction"),
        default: 0.0,
        minimum: f64::NEG_INFINITY,
        maximum: f64::INFINITY,
        flags: 0,
    }));
    let table = abi::FwPlugin {
        size: size_of::<abi::FwPlugin>(),
        abi_major: abi::ABI_MAJOR,
        abi_minor: abi::ABI_MINOR,
        kind: RECORD.code,
        reserved: 0,
        flags: 0,
        name: text(c"work-sum"),
        version: text(c"1.0"),
        doc: text(c"adds up the work of friction"),
        reference: text(c"none"),
        n_parameters: 0,
        parameters: std::ptr::null(),
        n_variables: 1,
        variables: work,
        degradation: 0.0,
        validate: None,
        initialise: None,
        prepare: None,
        solve_local: None,
        commit: Some(add_work),
        energy: None,
        fracture_energy: None,
    };
    // SAFETY: the table points to static or leaked data, and its function follows the interface.
    Box::leak(Box::new(unsafe { abi::LinkedLaw::new(table) }))
}

fn path() -> SearchPath {
    Kind::register(&RECORD).unwrap();
    let mut tables = fretwork_laws::plugins();
    tables.push(law());
    SearchPath::new(&[]).with_built_in(BuiltInLaws::new(tables))
}

/// Returns all bits of the state after a number of steps, and the largest difference between the
/// record and the host's own account, relative to the largest work.
fn run<S: Space>(s: &mut Simulation<S>, steps: u32) -> (Vec<u64>, f64) {
    for _ in 0..steps {
        s.step().unwrap();
    }
    let mut bits = Vec::new();
    let mut push = |v: &S::Vector| bits.extend((0..S::D).map(|k| v[k].to_bits()));
    s.state.bodies.position.iter().for_each(&mut push);
    s.state.bodies.velocity.iter().for_each(&mut push);
    s.state
        .network
        .contacts
        .iter()
        .for_each(|c| push(&c.impulse));
    for memory in &s.state.network.memory {
        // A slot of a contact with variables and without a bond belongs to the record.
        let intact = memory.bonds.iter().filter(|b| b.intact());
        bits.extend(intact.map(|b| b.damage.to_bits()));
    }
    let e = s.state.energy;
    bits.extend([e.residual, s.state.network.worn.values().sum()].map(f64::to_bits));
    let kind = Kind::register(&RECORD).unwrap();
    let (mut off, mut most) = (0.0f64, 0.0f64);
    for contact in &s.state.network.contacts {
        let law = &s.laws[contact.law as usize];
        let (Some(record), Some(slot)) = (law.law(kind), contact.memory()) else {
            continue;
        };
        // Work against rotation is not work of slip.
        if contact.moment != S::Spin::zero() {
            continue;
        }
        let own =
            s.state.network.memory[contact.law as usize].variables[record.first_variable][slot];
        off = off.max((own - contact.friction_work).abs());
        most = most.max(contact.friction_work.abs());
    }
    (bits, if most > 0.0 { off / most } else { off })
}

fn case(name: &str, sets: &[String], steps: u32) -> (Vec<u64>, f64) {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let loaded = load(&folder.join(format!("{name}.ron")), sets);
    let built = loaded.and_then(|l| l.build(&path()));
    let mut built = built.unwrap_or_else(|e| panic!("{name}: {e}"));
    in_dimension!(&mut built.simulation, |s| run(s, steps))
}

#[test]
fn a_fifth_slot_that_watches_changes_no_bit() {
    let interfaces = [
        ("verification/worn_slide_3d", 100),
        ("verification/healing", 200),
        ("verification/bond_fatigue", 100),
        ("verification/slide_to_stop", 200),
        ("collapse", 120),
    ];
    path();
    for (name, steps) in interfaces {
        let (plain, _) = case(name, &[], steps);
        let before = (BATCHES.load(Relaxed), CONTACTS.load(Relaxed));
        let sets = ["interfaces.0.record=work-sum".to_owned()];
        let (with, off) = case(name, &sets, steps);
        assert!(plain.len() > 4 && plain == with, "{name}: other bits");
        assert!(BATCHES.load(Relaxed) > before.0, "{name}: never called");
        assert!(CONTACTS.load(Relaxed) > before.1, "{name}: no contacts");
        assert!(off < 1e-12, "{name}: the record is off by {off:e}");
    }
}

#[test]
fn its_laws_are_found_validated_and_certified_as_any_other() {
    let path = path();
    let kind = Kind::from_word("record").unwrap();
    assert_eq!(Kind::from_code(105), Some(kind));
    assert_eq!(Kind::all().last(), Some(&kind));
    let plugin = path.find(kind, "work-sum").unwrap();
    let certificate = certify(&plugin, &[], None, &path).unwrap();
    assert!(certificate.certified(), "{:#?}", certificate.lines);

    // The text of a case has the slot, and errors in it are reported as elsewhere.
    let sets = ["interfaces.0.record=work-sun".to_owned()];
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let loaded = load(&folder.join("collapse.ron"), &sets).unwrap();
    let error = loaded.build(&path).err().unwrap().to_string();
    assert!(
        error.contains("there is no record law named `work-sun`"),
        "{error}"
    );
    let sets = ["interfaces.0.recorf=work-sum".to_owned()];
    let error = load(&folder.join("collapse.ron"), &sets).err().unwrap();
    assert!(
        error.to_string().contains("did you mean `record`"),
        "{error}"
    );
    // An interface has at most one law of each kind.
    let law = |kind, name| LoadedLaw::with_defaults(path.find(kind, name).unwrap());
    let one = || law(Kind::CONTACT, "coulomb");
    let two = fretwork_core::laws::Interface::new("two", [one(), one()]);
    assert!(two.unwrap_err().to_string().contains("two contact laws"));
    let none = fretwork_core::laws::Interface::new("none", [law(kind, "work-sum")]);
    assert!(none.unwrap_err().to_string().contains("has no contact law"));
}

#[test]
fn a_word_or_code_has_one_kind() {
    path();
    static WORD: KindSpec = KindSpec {
        code: 106,
        word: "wear",
        ..SAME
    };
    static CODE: KindSpec = KindSpec {
        code: 4,
        word: "other",
        ..SAME
    };
    static EARLY: KindSpec = KindSpec {
        code: -3,
        word: "early",
        ..SAME
    };
    static BONDS: KindSpec = KindSpec {
        code: 108,
        word: "onbonds",
        domain: Domain::ByOpening,
        ..SAME
    };
    static NAME: KindSpec = KindSpec {
        code: 107,
        word: "Heat 1",
        ..SAME
    };
    const SAME: KindSpec = KindSpec {
        word: "",
        code: 0,
        doc: "",
        functions: &[],
        domain: Domain::Near,
        outputs: no_outputs,
        fits: fits_always,
        commit: fretwork_core::commit_hook!(commit_record),
        certificate: RECORD_CERTIFICATE,
        templates: None,
    };
    const RECORD_CERTIFICATE: CertificateSpec = CertificateSpec {
        partners: &[&[]],
        checks: CheckSet::Contact,
    };
    for wrong in [&WORD, &CODE, &EARLY, &BONDS, &NAME] {
        let error = Kind::register(wrong).unwrap_err().to_string();
        assert!(error.contains("kind"), "{error}");
    }
    assert_eq!(Kind::all().len(), 6);
}
