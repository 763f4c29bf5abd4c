//! The interface as used by a host: columns, sizes, messages, panics.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "a test fails by a panic"
)]
use fretwork_law::abi::*;
use fretwork_law::{
    ContactLaw, DamageLaw, Friction, Intact, Law, Parameters, Site, Variable, WearLaw, ffi,
    parameters,
};
use std::ffi::{CStr, c_char};
use std::mem::offset_of;
use std::ptr::null;

parameters! {
    /// A law that does what a test requests.
    pub struct Toy {
        mode: "" = 0.0, 0.0, 9.0, "0 plain, 1 not a number, 2 panics, 3 refused";
    }
}

impl Law for Toy {
    const NAME: &'static str = "toy";
    const DOC: &'static str = "for tests";
    const REFERENCE: &'static str = "none";
    const VARIABLES: &'static [Variable] =
        &[Variable::new(c"slid", c"m", c"slip so far").written()];
    fn validate(&self) -> Result<(), String> {
        match self.mode == 3.0 {
            true => Err("mode 3 is refused: é".into()),
            false => Ok(()),
        }
    }
}

impl ContactLaw for Toy {
    fn friction(&self, site: &Site, state: &[f64]) -> Friction {
        Friction {
            mu: site.gap + site.damage + state[0],
            restitution_n: site.theta,
            ..Friction::default()
        }
    }
}

impl DamageLaw for Toy {
    fn grow(&self, site: &Site, _: &Intact, state: &mut [f64]) -> f64 {
        state[0] += 1.0;
        let here = site.gap == 2.0;
        assert!(!(self.mode == 2.0 && here), "no law for gap {}", site.gap);
        if self.mode == 1.0 && here {
            f64::NAN
        } else {
            0.5
        }
    }
}

impl WearLaw for Toy {
    fn volume(&self, site: &Site, state: &mut [f64]) -> f64 {
        state[0] = f64::INFINITY;
        site.slip * site.friction_work
    }
}

fn zero() -> FwBatch {
    // SAFETY: zeros are valid numbers and null pointers.
    let mut batch: FwBatch = unsafe { std::mem::zeroed() };
    batch.size = size_of::<FwBatch>();
    batch
}

/// Calls a function with a message of `capacity` bytes; returns status, contact and text.
fn call(capacity: usize, body: impl FnOnce(*mut FwMessage) -> i32) -> (i32, i64, String) {
    let mut text = vec![1 as c_char; capacity];
    let mut message = FwMessage {
        size: size_of::<FwMessage>(),
        text: text.as_mut_ptr(),
        capacity,
        contact: -1,
    };
    let status = body(&mut message);
    let said = match status {
        STATUS_OK => String::new(),
        // SAFETY: every message ends in a zero byte.
        _ => unsafe { CStr::from_ptr(text.as_ptr()) }
            .to_str()
            .expect("UTF-8")
            .to_owned(),
    };
    (status, message.contact, said)
}

#[test]
fn null_columns_read_as_zero_and_outputs_may_be_null() {
    let (gap, mode, mut mu) = ([1.0, 2.0], [0.0], [9.0; 2]);
    let mut batch = zero();
    (batch.n, batch.theta) = (2, 0.5);
    (batch.gap, batch.parameters) = (gap.as_ptr(), mode.as_ptr());
    batch.out_friction = mu.as_mut_ptr();
    // SAFETY: columns have two values or are null.
    let answer = call(80, |m| unsafe { ffi::contact_prepare::<Toy>(&batch, m) });
    assert_eq!((answer.0, mu), (STATUS_OK, [1.0, 2.0]));
}

/// With an older host, what is beyond its size is not read, whatever the bytes are.
#[test]
fn nothing_is_read_beyond_the_size() {
    let (gap, wild, mode, mut mu) = ([1.0], [7.0], [0.0], [9.0]);
    let mut batch = zero();
    batch.n = 1;
    (batch.gap, batch.parameters) = (gap.as_ptr(), mode.as_ptr());
    batch.damage = wild.as_ptr();
    batch.out_friction = mu.as_mut_ptr();
    batch.size = offset_of!(FwBatch, damage) + 4;
    // SAFETY: columns have one value or are null.
    let run = |b: &FwBatch| call(80, |m| unsafe { ffi::contact_prepare::<Toy>(b, m) }).0;
    assert_eq!(run(&batch), STATUS_OK);
    assert_eq!(mu, [9.0], "the output lies beyond the size");
    batch.size = size_of::<FwBatch>() + 64;
    assert_eq!((run(&batch), mu), (STATUS_OK, [8.0]), "a newer host");
    batch.size = 16;
    assert_eq!(run(&batch), STATUS_ERROR);
    batch.size = size_of::<FwBatch>();
    batch.parameters = null();
    assert_eq!(run(&batch), STATUS_ERROR);
    // SAFETY: the null pointer is what is tested.
    let none = call(80, |m| unsafe { ffi::contact_prepare::<Toy>(null(), m) });
    assert_eq!(none.0, STATUS_ERROR);
}

#[test]
fn state_moves_in_a_commit_and_faults_name_the_contact() {
    let (gap, slid, mut after, mut damage) = ([0.0, 2.0, 0.0], [1.0, 5.0, 9.0], [0.0; 3], [0.0; 3]);
    let (columns, next) = ([slid.as_ptr()], [after.as_mut_ptr()]);
    let mut run = |mode: f64| {
        let mut batch = zero();
        (batch.n, batch.h) = (3, 1e-6);
        (batch.gap, batch.parameters) = (gap.as_ptr(), &raw const mode);
        (batch.state, batch.state_next) = (columns.as_ptr(), next.as_ptr());
        batch.out_damage = damage.as_mut_ptr();
        // SAFETY: columns have three values or are null.
        call(60, |m| unsafe { ffi::damage_commit::<Toy>(&batch, m) })
    };
    assert_eq!(run(0.0).0, STATUS_OK);
    let nan = run(1.0);
    assert_eq!((nan.0, nan.1), (STATUS_ERROR, 1));
    assert!(nan.2.contains("out_damage"), "{}", nan.2);
    let panicked = run(2.0);
    assert_eq!((panicked.0, panicked.1), (STATUS_PANIC, 1));
    assert!(panicked.2.contains("no law for gap 2"), "{}", panicked.2);
    assert_eq!((after, damage[2]), ([2.0, 6.0, 10.0], 0.5));
}

#[test]
fn infinite_state_is_a_fault() {
    let mode = 0.0;
    let mut batch = zero();
    (batch.n, batch.parameters) = (1, &raw const mode);
    // SAFETY: columns are null.
    let answer = call(200, |m| unsafe { ffi::wear_commit::<Toy>(&batch, m) });
    assert_eq!((answer.0, answer.1), (STATUS_ERROR, 0));
    assert!(answer.2.contains("`slid`"), "{}", answer.2);
}

#[test]
fn a_refusal_is_cut_between_characters() {
    let mode = 3.0;
    let run = |capacity| {
        // SAFETY: there is one value for the one parameter.
        call(capacity, |m| unsafe {
            ffi::validate::<Toy>(&raw const mode, m)
        })
    };
    assert_eq!(
        run(80),
        (STATUS_BAD_PARAMETER, -1, "mode 3 is refused: é".into())
    );
    assert_eq!(run(21).2, "mode 3 is refused: ");
}

#[test]
fn the_schema_is_what_was_written() {
    assert_eq!(
        (Toy::FIELDS.len(), Toy::VERSION),
        (1, env!("CARGO_PKG_VERSION"))
    );
    // SAFETY: the macro ends its texts.
    let name = unsafe { CStr::from_ptr(Toy::FIELDS[0].name) };
    assert_eq!(name, c"mode");
}
