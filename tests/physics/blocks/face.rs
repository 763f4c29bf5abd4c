//! A bonded face that is pulled open, compared with its law's closed form, in 2D and 3D.

use super::{close, driven, scene, step};
use fretwork::geometry::space::Space;

/// Pulls the face of a case open until all its bonds, of which the number is given, are broken.
/// Checks peak, start of the damage, end and work of a law with strength 0.3 MPa and 0.5 J/m^2 over
/// the whole face (m^2; m in 2D), to which the areas of its bonds add up within a tolerance.
pub fn opens_by_its_law<S: Space>(case: &str, bonds: u64, face: f64, part: f64) {
    let (strength, energy, stiffness) = (3e5, 0.5, 1e12);
    let (first, last) = (strength / stiffness, 2.0 * energy / strength);
    let mut s = scene::<S>(case, &[]);
    let (mut peak, mut work, mut begun, mut open) = (0.0f64, 0.0, None, 0.0);
    let grip = driven(&s, "grip");
    while s.state.network.bonds_broken() < bonds {
        step(&mut s);
        assert!(open < 2.0 * last);
        let pull = -s.state.received[grip].0[S::D - 1] / s.options.scheme.h;
        let before = open;
        // From rest the grip moves by half of the displacement in the first step.
        open += 0.01 * s.options.scheme.h * if s.state.steps == 1 { 0.5 } else { 1.0 };
        work += pull * (open - before);
        peak = peak.max(pull);
        let list = &s.state.network.memory[0].bonds;
        if begun.is_none() && list.iter().any(|b| b.damage > 0.0) {
            begun = Some((pull, open));
        }
        // All points are equal: the face does not rotate.
        for b in list {
            assert!((b.opening_n - list[0].opening_n).abs() < 1e-9 * last);
        }
    }
    let (force, at) = begun.unwrap();
    println!("peak {peak:e}, damage from {force:e} at {at:e}, work {work:e}, open to {open:e}");
    assert_eq!(s.state.network.bonds_made(), bonds);
    let bonded: f64 = s.state.network.memory[0].bonds.iter().map(|b| b.area).sum();
    assert!(close(bonded, face, part), "{bonded}");
    assert!(close(peak, strength * face, 1e-3));
    assert!(close(force, strength * face, 1e-3) && close(at, first, 1e-3));
    assert!(close(open, last, 1e-3) && close(work, energy * face, 1e-3));
    assert!(close(s.state.energy.fracture, energy * face, 1e-3));
    assert!(s.state.energy.relative_residual() < 1e-12);
}
