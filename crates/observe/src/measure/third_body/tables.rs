//! Tables of a third body: profiles by time slice, energies by pair of bodies and by bin, cluster
//! sizes.

use super::cells::{Block, Cell, MECHANISMS};
use super::clusters::Clusters;
use super::dissipation::{Dissipation, PairKind};
use crate::quantity::unit::{ENERGY, MASS};

/// Columns of the profiles, in the order of [`row`].
const PROFILE: [&str; 23] = [
    "slice",
    "from [s]",
    "to [s]",
    "depth_over_thickness",
    "depth [m]",
    "mass_depth_over_thickness",
    "velocity [m/s]",
    "velocity_over_sliding",
    "spin [rad/s]",
    "solid_fraction",
    "coordination",
    "granular_temperature [m^2/s^2]",
    "temperature [K]",
    "stress_across [Pa]",
    "stress_along [Pa]",
    "stress_shear [Pa]",
    "stress_lateral [Pa]",
    "damage_ratio",
    "friction [W/m^3]",
    "impact [W/m^3]",
    "fracture [W/m^3]",
    "viscous [W/m^3]",
    "correction [W/m^3]",
];

/// Returns the dissipated power density of a cell by mechanism (W/m^3), averaged over a block.
pub(super) fn powers(cell: &Cell, block: &Block) -> [f64; MECHANISMS.len()] {
    let volume = cell.space / block.samples.max(1) as f64;
    cell.energy.map(|e| e / (volume * block.duration()))
}

fn row(slice: usize, k: usize, cell: &Cell, block: &Block) -> Vec<f64> {
    let place = (k as f64 + 0.5) / block.bins().len() as f64;
    let stress = cell.stress();
    let mut row = vec![
        slice as f64,
        block.time[0],
        block.time[1],
        place,
        place * block.mean_thickness(),
        cell.depth(),
        cell.velocity(),
        cell.carried(),
        cell.spin / cell.mass,
        cell.solid(),
        cell.contacts / cell.grains,
        cell.granular_temperature(),
        cell.temperature(),
        stress[0],
        stress[1],
        stress[2],
        stress[3],
        cell.damage(),
    ];
    row.extend(powers(cell, block));
    row
}

/// Returns the profiles: slice 0 is the whole time, followed by the time slices; undefined values
/// are `NaN`. Temperatures in kelvin are included where grains are `heated`.
pub(super) fn profiles(whole: &Block, slices: &[Block], dimension: usize, heated: bool) -> String {
    // In 2D the stress has no lateral component.
    let shown = |k: &usize| match PROFILE[*k] {
        "stress_lateral [Pa]" => dimension == 3,
        "temperature [K]" => heated,
        _ => true,
    };
    let header = (0..PROFILE.len())
        .filter(shown)
        .map(|k| PROFILE[k].to_owned());
    let mut lines = vec![header.collect::<Vec<_>>()];
    for (slice, block) in std::iter::once(whole).chain(slices).enumerate() {
        for (k, cell) in block.bins().iter().enumerate() {
            let row = row(slice, k, cell, block);
            let kept = (0..row.len()).filter(shown);
            lines.push(kept.map(|i| format!("{:e}", row[i])).collect());
        }
    }
    joined(&lines)
}

/// Returns the energies by pair of bodies and by bin, each with its fraction of the total.
pub(super) fn energies(
    dissipation: &Dissipation,
    between: &(String, String),
    dimension: usize,
) -> String {
    let unit = ENERGY.symbol(dimension);
    let mut header = vec!["place".to_owned()];
    header.extend(
        MECHANISMS
            .iter()
            .chain(&["total"])
            .map(|m| format!("{m} [{unit}]")),
    );
    header.push("share".to_owned());
    let mut lines = vec![header];
    let total = dissipation.total();
    let mut add = |name: String, energies: &[f64]| {
        let sum: f64 = energies.iter().sum();
        let share = if total == 0.0 { 0.0 } else { sum / total };
        let mut line = vec![name];
        line.extend(
            energies
                .iter()
                .chain(&[sum, share])
                .map(|e| format!("{e:e}")),
        );
        lines.push(line);
    };
    for (place, energies) in PairKind::ALL.iter().zip(&dissipation.places) {
        add(place.name(between), energies);
    }
    for (k, energies) in dissipation.bins.iter().enumerate() {
        add(format!("bin_{}", k + 1), energies);
    }
    joined(&lines)
}

/// Returns the number of clusters of each size, and their mass without `inertia_scaling`.
pub(super) fn clusters(clusters: &Clusters, inertia_scaling: f64, dimension: usize) -> String {
    let unit = MASS.symbol(dimension);
    let mut lines = vec![vec![
        "grains".to_owned(),
        "clusters".to_owned(),
        format!("mass [{unit}]"),
    ]];
    for (size, (count, mass)) in &clusters.sizes {
        lines.push(vec![
            size.to_string(),
            count.to_string(),
            format!("{:e}", mass / inertia_scaling),
        ]);
    }
    joined(&lines)
}

fn joined(lines: &[Vec<String>]) -> String {
    lines.iter().map(|l| l.join(",") + "\n").collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mass of the clusters is the physical one, for any inertia scaling.
    #[test]
    fn masses_are_without_the_scaling_of_inertia() {
        let of = Clusters {
            sizes: [(1, (4, 2e3)), (3, (1, 1e3))].into(),
            ..Clusters::default()
        };
        let text = clusters(&of, 1e6, 2);
        assert_eq!(text, "grains,clusters,mass [kg/m]\n1,4,2e-3\n3,1,1e-3\n");
    }
}
