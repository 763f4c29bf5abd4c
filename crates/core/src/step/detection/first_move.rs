//! Bodies that pass through others in the move before detection, which no previous step has
//! checked.

use crate::contact::detect;
use crate::geometry::space::{Space, VectorLike};
use crate::step::{Scheme, Simulation};

/// Relative change of a surface's spin from which it counts as a jump.
const TURNS: f64 = 0.01;

/// Reports tunnelling during the first half move. Each step checks the paths of the bodies between
/// two detections at its final velocities; this misses the very first move and the velocity added
/// by a jump of an imposed motion. `before` holds the velocities and spins of the driven bodies
/// before their jumps.
pub(in crate::step) fn watch_first_move<S: Space>(
    s: &mut Simulation<S>,
    before: &[(S::Vector, S::Spin)],
) {
    let Scheme { h, theta } = s.options.scheme;
    let length = (1.0 - theta) * h;
    if s.state.steps == 0 || velocities_jump(s, before, length) {
        let jumps = s.state.steps > 0;
        report(s, length, jumps);
    }
}

/// Reports penetrations in a move of this length (s), unless all bodies are slow and `always` is
/// false.
fn report<S: Space>(s: &mut Simulation<S>, length: f64, always: bool) {
    let (network, bodies) = (&mut s.state.network, &s.state.bodies);
    let scene = detect::CollisionScene::new(&s.shapes, bodies, &s.table);
    let velocity = |b: usize| (bodies.velocity[b], bodies.spin[b]);
    if always || !detect::is_calm(network, &scene, velocity, length, false) {
        detect::report_first_move(network, &scene, s.state.time, length);
    }
}

/// Reports penetrations and passages in the move before detection if a process has applied an
/// impulse.
pub(in crate::step) fn watch_push<S: Space>(s: &mut Simulation<S>) {
    let Scheme { h, theta } = s.options.scheme;
    if s.workspace.pushed {
        report(s, (1.0 - theta) * h, false);
    }
}

/// Returns whether the jumps of imposed velocities give a body a large displacement within a time
/// (s).
fn velocities_jump<S: Space>(
    s: &Simulation<S>,
    before: &[(S::Vector, S::Spin)],
    time: f64,
) -> bool {
    let bodies = &s.state.bodies;
    let mut driven = bodies.driven.iter().zip(before);
    driven.any(|(driven, (v, w))| {
        let b = driven.body as usize;
        let jump = (bodies.velocity[b] - *v).norm();
        let turn = (bodies.spin[b] - *w).norm();
        let lever = s.state.network.extents.lever(b);
        let surfaces = s.shapes.surfaces.iter();
        // The extent of the surface is unknown.
        let sweeps = turn > TURNS * bodies.spin[b].norm().max(w.norm())
            && surfaces.filter(|s| s.body as usize == b).any(|s| {
                !s.shape
                    .is_unchanged_by(&S::unrotate_spin(&bodies.rotation[b], &bodies.spin[b]))
            });
        time * (jump + turn * lever) > s.state.network.fast || sweeps
    })
}
