//! Love-Weber stress of the contacts.

use fretwork_core::view::RunView;
use nalgebra::Vector3;

/// Returns the Love-Weber stress of the free grains (Pa), sum f (x) l over their contacts divided
/// by a volume, positive in compression; row: axis of the force, column: axis of the branch.
///
/// f is the mean force of the last step; l points from a grain's centre to the contact: to the face
/// of a wall, or to the middle of the gap to another grain. At rest the stress equals that on the
/// walls.
pub fn love_weber(run: &dyn RunView, volume: f64) -> [[f64; 3]; 3] {
    let mut moment = [[0.0; 3]; 3];
    let dimension = run.dimension();
    each_moment(run, |_, force, branch| {
        for (a, row) in moment.iter_mut().enumerate().take(dimension) {
            for (b, value) in row.iter_mut().enumerate().take(dimension) {
                *value += force[a] * branch[b] / volume;
            }
        }
    });
    moment
}

/// Calls a function for each contact of each free grain, with the body, the mean force of the last
/// step (N; N/m in 2D) and the branch (m), signed such that their product is positive in
/// compression.
pub fn each_moment(run: &dyn RunView, mut take: impl FnMut(usize, &Vector3<f64>, &Vector3<f64>)) {
    let free = run.grain_flags();
    let h = run.options().scheme.h;
    run.visit_contacts(&mut |contact| {
        let members = contact.bodies.map(|b| free[b as usize]);
        let share = if members == [true, true] { 0.5 } else { 1.0 };
        for (side, sign) in [(0, -1.0), (1, 1.0)] {
            if !members[side] {
                continue;
            }
            let normal = Vector3::from(contact.normal);
            let arm = Vector3::from(contact.arms[side]) + normal * (sign * share * contact.gap);
            let force = Vector3::from(contact.impulse) * (sign / h);
            take(contact.bodies[side] as usize, &force, &arm);
        }
    });
}

/// Returns the mean pressure, and the sine of the mobilised friction angle, (s1 - s2)/(s1 + s2),
/// with the principal stresses in the plane of the first two axes; the sine is zero without
/// pressure.
pub fn plane_invariants(stress: &[[f64; 3]; 3]) -> (f64, f64) {
    let mean = 0.5 * (stress[0][0] + stress[1][1]);
    let half = 0.5 * (stress[0][0] - stress[1][1]);
    let shear = 0.5 * (stress[0][1] + stress[1][0]);
    let sine = if mean > 0.0 {
        half.hypot(shear) / mean
    } else {
        0.0
    };
    (mean, sine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariants_do_not_depend_on_the_axes() {
        // Principal stresses 3 and 1 Pa, rotated by an angle: p = 2, sin phi = 1/2.
        for angle in [0.0f64, 0.4, 1.1] {
            let (s, c) = angle.sin_cos();
            let mut turned = [[0.0; 3]; 3];
            turned[0][0] = 3.0 * c * c + s * s;
            turned[1][1] = 3.0 * s * s + c * c;
            turned[0][1] = 2.0 * s * c;
            turned[1][0] = 2.0 * s * c;
            let (p, sine) = plane_invariants(&turned);
            assert!((p - 2.0).abs() < 1e-12 && (sine - 0.5).abs() < 1e-12);
        }
    }
}
