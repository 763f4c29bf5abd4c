//! Figure of the tribological circuit: cumulative flows against time, and the mass in the contact.

use super::history;
use crate::chart::{Axis, Series};
use crate::output::Output;

/// Returns the charts from the columns of the statistics; `window` is the interval of the mean
/// flows (s).
pub(crate) fn charts(window: [f64; 2]) -> Output {
    let flows = [
        ("source, Qs", "source"),
        ("ejected, Qe", "ejected"),
        ("came back, Qr", "recirculated"),
        ("lost, Qw", "lost"),
        ("tied again, Qa", "attached"),
    ];
    let mass = |name| Axis::of_rows(name);
    let passed = history("Mass that passed since the start", mass("mass m"), &flows);
    let contact = history("Third body in the contact", mass("mass M"), &[("M", "M")])
        .with(Series::place("means from here on", window[0]));
    Output::figure("circuit", [passed, contact], 2)
}
