//! Impulse per velocity of a contact: inverses of W where bodies move, and bounds where they do
//! not.

use crate::geometry::space::Space;
use crate::lanes::Lane;
use crate::solve::form::ContactForm;

/// Returns 1/w; zero where nothing moves.
#[inline(always)]
pub(super) fn inverse<L: Lane>(w: L) -> L {
    let zero = L::all(0.0);
    L::select(w.above(zero), L::all(1.0) / w, zero)
}

/// Returns 1/w_t. Where bodies can move only along the normal the slip is given, and friction
/// reaches its bound at once.
#[inline(always)]
pub(super) fn inverse_along<L: Lane>(w_t: L, w_n: L) -> L {
    const MIN_RATIO: f64 = 1e-12;
    inverse(w_t.greatest(L::all(MIN_RATIO) * w_n))
}

/// Returns 1/w_t as [`inverse_along`] does; where nothing moves at all, a shear cohesion (N s)
/// reaches its bound at a slip of 1e-12 m/s.
#[inline(always)]
pub(super) fn answer_to_slip<L: Lane>(w_t: L, w_n: L, cohesion: L) -> L {
    const MIN_SLIP: f64 = 1e-12;
    let zero = L::all(0.0);
    let moves = w_t.above(zero) | w_n.above(zero);
    L::select(moves, inverse_along(w_t, w_n), cohesion / L::all(MIN_SLIP))
}

/// Returns the shift along the normal of a contact with this W_nn. Where both bodies are held along
/// the normal, the velocity is given and the impulse of a rigid contact is undetermined: the
/// contact is then open, and only its bond, cohesion or damping acts. A compliance determines the
/// impulse.
pub(super) fn shift_along<S: Space>(contact: &ContactForm<S>, w_n: f64) -> f64 {
    if w_n + contact.compliance[0] > 0.0 {
        contact.shift_n
    } else {
        f64::INFINITY
    }
}
