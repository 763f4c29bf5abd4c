//! Checks for numbers that are valid individually but exceed double precision in combination:
//! masses that underflow, energies that overflow, and displacements per step lost to rounding.

use super::build::Origin;
use super::source::ValidationError;
use fretwork_core::view::RunView;

/// Displacement lost to rounding over the run, as a fraction of the alert distance, above which a
/// case is rejected.
const LOST: f64 = 2e-5;

/// Checks the masses, energies and velocities of all bodies.
///
/// # Errors
/// Returns the first one that double precision cannot represent, at its place in the case.
pub(super) fn check(s: &dyn RunView, origins: &[Origin], end: f64) -> Result<(), ValidationError> {
    let (bodies, dimension, scheme) = (s.bodies(), s.dimension(), s.options().scheme);
    let h = scheme.h;
    // Contactors of deformable bodies have no mass of their own.
    for b in (0..bodies.len()).filter(|b| bodies.carrier(*b).is_none()) {
        let refuse = |message: String| {
            let path = origins.get(b).map_or("grains".to_owned(), |o| o.path());
            Err(ValidationError::new(path, message))
        };
        let (mass, inertia) = (bodies.mass[b], bodies.inertia[b]);
        if !(mass.is_normal() && mass > 0.0 && (1.0 / mass).is_normal()) {
            return refuse(format!(
                "a mass of {mass:e} kg is outside the range of the computation; check its size and density, and their units"
            ));
        }
        if inertia != 0.0 && !(inertia.is_normal() && inertia > 0.0 && (1.0 / inertia).is_normal())
        {
            return refuse(format!(
                "a moment of inertia of {inertia:e} kg m2 is outside the range of the computation; check its size and \
                 density, and their units"
            ));
        }
        let energy = s.kinetic_energy(b);
        let motion = s.motion(b);
        if !energy.is_finite() {
            let spin = if dimension == 2 { 2.. } else { 0.. };
            return refuse(format!(
                "its kinetic energy at the start is {energy} J: velocity {:?} m/s, spin {:?} rad/s; check their units",
                &motion.velocity[..dimension],
                &motion.spin[spin]
            ));
        }
        let (x, v) = (motion.position, motion.velocity);
        let fastest = (0..dimension).max_by(|i, j| v[*i].abs().total_cmp(&v[*j].abs()));
        if let Some(k) = fastest
            && v[k] != 0.0
            && x[k] + v[k] * (scheme.theta * h) == x[k]
            && v[k].abs() * end > LOST * s.alert()
        {
            return refuse(format!(
                "at {:e} m from the origin adjacent numbers are {:.1e} m apart, and it moves {:.1e} m in a step: it would never \
                 move; put the origin nearer to the scene, or take a larger time.step",
                x[k].abs(),
                spacing(x[k]),
                v[k].abs() * h
            ));
        }
    }
    let heaviest = bodies.mass.iter().copied().fold(0.0, f64::max);
    let gravity = s.gravity().iter().fold(0.0f64, |g, x| g.max(x.abs()));
    let fall = 0.5 * heaviest * (gravity * end) * (gravity * end);
    if !(gravity.is_finite() && fall.is_finite()) {
        let message = format!(
            "under {gravity:e} m/s2 a fall over the run ends with an energy of {fall} J, which cannot be computed with"
        );
        return Err(ValidationError::new("gravity", message));
    }
    Ok(())
}

/// Returns the distance to the next larger number in magnitude.
fn spacing(x: f64) -> f64 {
    let x = x.abs();
    x.next_up() - x
}
