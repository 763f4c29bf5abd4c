//! The time at which a case is under its load: for an estimate of the cost of its steps.

use fretwork_core::bodies::Dof;
use fretwork_core::laws::BondRule;
use fretwork_scene::case::Case;
use fretwork_scene::phases::drives_of;

/// Share of the largest force from which a body counts as loaded.
const FULL: f64 = 0.9;
/// Earliest and latest time that is returned, as shares of the run: grains that are loose at the
/// start need time to come together.
const SHARES: [f64; 2] = [0.3, 0.6];
/// Number of samples of a force over the run.
const SAMPLES: u32 = 1000;

/// Returns a time (s) at which imposed forces are near their largest, bonds are made and the
/// friction test is under way, as far as that is within the first part of the run.
pub(super) fn loaded_at(case: &Case) -> f64 {
    let end = case.time.end;
    let drives = case.bodies.iter().flat_map(|body| drives_of(case, body));
    let loads = drives.map(|(_, dof)| full_load(&dof, end));
    let bonds = case.interfaces.iter().map(|i| match i.bonds {
        BondRule::At(time) => time,
        BondRule::Start | BondRule::Never => 0.0,
    });
    let test = case.friction.as_ref().map(|test| test.start);
    let latest = loads.chain(bonds).chain(test).fold(0.0, f64::max);
    latest.clamp(SHARES[0] * end, SHARES[1] * end)
}

/// Returns the first time at which a force is near its largest; 0 without a force.
fn full_load(dof: &Dof, end: f64) -> f64 {
    let forces = |k: u32| {
        let t = end * f64::from(k) / f64::from(SAMPLES);
        let each = dof.drives().map(|drive| match drive {
            Dof::Force(f) => f.value(t).abs(),
            Dof::Pressure { value, .. } => value.value(t).abs(),
            _ => 0.0,
        });
        (t, each.fold(0.0, f64::max))
    };
    let most = (0..=SAMPLES).map(|k| forces(k).1).fold(0.0, f64::max);
    let full = |(_, force): &(f64, f64)| *force > 0.0 && *force >= FULL * most;
    (0..=SAMPLES).map(forces).find(full).map_or(0.0, |(t, _)| t)
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
        assert!((of(&["time.end=0.05"]) - 0.025).abs() < 1e-9);
        assert!((of(&["time.end=0.03"]) - 0.6 * 0.03).abs() < 1e-9);
    }
}
