//! Test whether the seed of a case changes its scene.

use crate::load;
use fretwork_core::laws::SearchPath;
use fretwork_scene::{Built, LoadedCase};

use crate::Error;
use std::fmt::Write;

/// Returns whether another seed gives another scene; also true if another seed gives no scene.
///
/// # Errors
/// The case does not take a seed.
pub fn seed_matters(
    loaded: &LoadedCase,
    scene: &Built,
    search: &SearchPath,
) -> Result<bool, Error> {
    let other_seed = format!("seed={}", loaded.case.seed.wrapping_add(1));
    let sets = [loaded.source.sets(), &[other_seed]].concat();
    let other = load(&loaded.path, &sets)?;
    Ok(match other.build(search) {
        Ok(other) => drawn(&other) != drawn(scene),
        Err(_) => true,
    })
}

/// Returns a hash of the positions, shapes and velocities, which a seed may change.
fn drawn(built: &Built) -> u64 {
    let mut hash = Hasher(0xcbf2_9ce4_8422_2325);
    // Writing to the hash never fails.
    let _ = built.simulation.describe_shapes(&mut hash);
    let bodies = built.simulation.bodies();
    let _ = write!(hash, "{:?}{:?}", bodies.position, bodies.velocity);
    hash.0
}

/// FNV-1a hash of everything written to it, so that a scene need not be formatted to a string.
struct Hasher(u64);

impl Write for Hasher {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        for byte in text.bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
        Ok(())
    }
}
