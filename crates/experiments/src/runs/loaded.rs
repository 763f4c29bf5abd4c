//! The time at which a case is under its load: for an estimate of the cost of its steps.

use fretwork_core::bodies::Dof;
use fretwork_core::laws::BondRule;
use fretwork_scene::case::Case;
use fretwork_scene::phases::drives_of;

/// Share of the largest force, or of the largest imposed speed, from which a body counts as loaded.
const FULL: f64 = 0.9;
/// Earliest and latest time that is returned, as shares of the run: grains that are loose at the
/// start need time to come together.
const SHARES: [f64; 2] = [0.3, 0.6];
/// Number of samples of a force over the run.
const SAMPLES: u32 = 1000;

/// Returns a time (s) at which imposed forces and speeds are near their largest, bonds are made and
/// tests are under way, as far as that is within the first part of the run.
pub(super) fn loaded_at(case: &Case) -> f64 {
    let end = case.time.end;
    let drives = case.bodies.iter().flat_map(|body| drives_of(case, body));
    let loads = drives.flat_map(|(_, dof)| [full(end, &dof, force), full(end, &dof, speed)]);
    let bonds = case.interfaces.iter().map(|i| match i.bonds {
        BondRule::At(time) => time,
        BondRule::Start | BondRule::Never => 0.0,
    });
    let test = case.friction.as_ref().map(|test| test.start);
    let biaxial = case.biaxial.as_ref().map(|test| test.start);
    let latest = loads.chain(bonds).chain(test).chain(biaxial);
    let latest = latest.fold(0.0, f64::max);
    latest.clamp(SHARES[0] * end, SHARES[1] * end)
}

/// Magnitude of the force that a drive imposes.
fn force(drive: &Dof, t: f64) -> f64 {
    match drive {
        Dof::Force(f) => f.value(t).abs(),
        Dof::Pressure { value, .. } => value.value(t).abs(),
        _ => 0.0,
    }
}

/// Magnitude of the speed that a drive imposes.
fn speed(drive: &Dof, t: f64) -> f64 {
    drive.imposed_velocity(t).map_or(0.0, f64::abs)
}

/// Returns the first time up to `end` at which what the drives of a body impose is near its
/// largest; 0 where they impose nothing.
fn full(end: f64, dof: &Dof, imposed: fn(&Dof, f64) -> f64) -> f64 {
    let at = |k: u32| {
        let t = end * f64::from(k) / f64::from(SAMPLES);
        let each = dof.drives().map(|drive| imposed(drive, t));
        (t, each.fold(0.0, f64::max))
    };
    let most = (0..=SAMPLES).map(|k| at(k).1).fold(0.0, f64::max);
    let full = |(_, value): &(f64, f64)| *value > 0.0 && *value >= FULL * most;
    (0..=SAMPLES).map(at).find(full).map_or(0.0, |(t, _)| t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load;
    use std::path::Path;

    #[test]
    fn a_case_is_loaded_after_its_ramps_and_when_its_bonds_are_made() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
        let of = |sets: &[&str]| {
            let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
            let loaded = load(&folder.join("wheel_rail_fretting.ron"), &sets);
            loaded_at(&loaded.unwrap_or_else(|e| panic!("{e}")).case)
        };
        // Three tenths of 0.175 s; the load is full at 0.022 s, bonds are made at 0.024 s, the
        // friction test starts at 0.025 s.
        assert!((of(&[]) - 0.3 * 0.175).abs() < 1e-9);
        assert!((of(&["time.end=0.05"]) - 0.025).abs() < 1e-4);
        assert!((of(&["time.end=0.03"]) - 0.6 * 0.03).abs() < 1e-9);
        // Compression at 0.1 m/s is reached at 0.5 s of 1.2 s; 0.9 of it after 0.49 s.
        let biaxial = load(&folder.join("biaxial.ron"), &[]).unwrap_or_else(|e| panic!("{e}"));
        assert!((loaded_at(&biaxial.case) - 0.49).abs() < 2e-3);
    }
}
