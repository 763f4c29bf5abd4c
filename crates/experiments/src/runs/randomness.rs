//! Whether the seed of a case changes its scene.

use crate::load;
use fretwork_core::geometry::space::Space;
use fretwork_core::laws::SearchPath;
use fretwork_scene::build::Built;
use fretwork_scene::{Loaded, Scene};

use crate::Error;

/// Whether another seed gives another scene; it does if it gives none.
///
/// # Errors
/// The case does not take a seed.
pub fn seed_matters(loaded: &Loaded, scene: &Scene, search: &SearchPath) -> Result<bool, Error> {
    let other_seed = format!("seed={}", loaded.case.seed.wrapping_add(1));
    let sets = [loaded.source.sets(), &[other_seed]].concat();
    let other = load(&loaded.path, &sets)?;
    Ok(match other.build(search) {
        Ok(other) => drawn(&other) != drawn(scene),
        Err(_) => true,
    })
}

/// Hash of the positions, shapes and velocities, which a seed may change.
fn drawn(scene: &Scene) -> u64 {
    match scene {
        Scene::Dim2(built) => drawn_in(built),
        Scene::Dim3(built) => drawn_in(built),
    }
}

fn drawn_in<S: Space>(built: &Built<S>) -> u64 {
    let s = &built.simulation;
    let bodies = &s.state.bodies;
    let mut hash = Hasher(0xcbf2_9ce4_8422_2325);
    let written = format_args!("{:?}{:?}{:?}", s.shapes, bodies.position, bodies.velocity);
    // Writing to the hash never fails.
    let _ = std::fmt::Write::write_fmt(&mut hash, written);
    hash.0
}

/// FNV-1a hash of everything written to it, so that a scene need not be formatted to a string.
struct Hasher(u64);

impl std::fmt::Write for Hasher {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        for byte in text.bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
        Ok(())
    }
}
