//! Impact of two disks.

use super::*;

fn collision(offset: f64, mu: f64, young: f64, step: f64) -> Soft {
    let v = 0.5;
    Soft {
        step,
        mu,
        young,
        grains: disks(
            "soft",
            &[
                ball_at(&[-1.02 * R, 0.3], &[v, 0.1]),
                ball_at(&[1.02 * R, 0.3 + offset], &[-v, 0.0]),
            ],
        ),
        ..Soft::default()
    }
}

/// Momentum is conserved, and so is angular momentum except for the couple of tangential impulses
/// over the gaps; energy never grows.
#[test]
fn two_disks_collide() {
    for mu in [0.0, 0.5] {
        let mut s = collision(0.7 * R, mu, 1e6, 2e-5).build::<Dim2>();
        let (p, l) = all_momenta(&s);
        let start = energy(&s);
        let (mut before, mut most, mut met) = (start, 0.0f64, false);
        let mut deep = 0.0f64;
        for _ in 0..2000 {
            go(&mut s, 1);
            most = most.max((energy(&s) - before) / start);
            before = energy(&s);
            met |= s
                .state
                .network
                .contacts
                .iter()
                .any(|c| c.impulse.norm() > 0.0);
            deep = deep.max(deepest(&s));
        }
        let (p_end, l_end) = all_momenta(&s);
        let scale = DENSITY * PI * R * R;
        let (off, moment) = (
            (p_end - p).norm() / (0.5 * scale),
            (l_end - l)[0].abs() / (0.5 * scale * R),
        );
        println!(
            "mu {mu}: momentum off {off:e}, moment {moment:e}, energy grows {most:e}, left {}, deep {:e}",
            energy(&s) / start,
            deep / R
        );
        assert!(met && place_of(&s, 0).x < place_of(&s, 1).x);
        assert!(off < 1e-12, "{off:e}");
        // Tangential impulses act across the gap that a step closes, and exert a couple.
        assert!(moment < if mu == 0.0 { 1e-10 } else { 2e-5 }, "{moment:e}");
        // Single steps gain a little energy, which the ledger contains.
        assert!(most < 5e-5 && energy(&s) < start, "{most:e}");
        closes(&s, 1e-12);
    }
}

/// Without damping a central impact of disks that are slow compared with their waves conserves
/// nearly all energy: the velocities are exchanged.
#[test]
fn a_central_impact_is_nearly_elastic() {
    for young in [1e6, 1e8] {
        let mut s = collision(0.0, 0.0, young, 2e-6 * (1e8 / young).sqrt()).build::<Dim2>();
        let start = velocity_of(&s, 1).x - velocity_of(&s, 0).x;
        let total = s.state.energy.kinetic;
        let steps = if young > 1e7 { 1500 } else { 2000 };
        go(&mut s, steps);
        let restitution = -(velocity_of(&s, 1).x - velocity_of(&s, 0).x) / start;
        println!(
            "E {young:e}: restitution {restitution}, impact {:e}, elastic {:e}",
            s.state.energy.impact / total,
            s.state.energy.elastic / total
        );
        assert!(restitution > 0.8 && restitution < 1.0, "{restitution}");
        closes(&s, 1e-12);
    }
}
