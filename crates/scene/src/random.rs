//! Whether a case draws random numbers, so that another seed gives another scene.

use super::case::{Case, GrainSpec, HalfSpaceProfile, MeshSpec, ProfileShape, ShapeSpec};

/// Returns whether the seed changes the scene of a case: its grains, or the roughness of surfaces.
pub fn draws(case: &Case) -> bool {
    let shapes = case.bodies.iter().flat_map(|body| &body.shapes);
    let rough_mesh = |mesh: &MeshSpec| match mesh {
        MeshSpec::Block { profile, .. } => {
            let shape = profile.as_ref().map(|p| &p.shape);
            matches!(shape, Some(ProfileShape::Rough { .. }))
        }
        MeshSpec::Gmsh { .. } => false,
    };
    let rough_cells =
        |profile: &HalfSpaceProfile| matches!(profile, HalfSpaceProfile::Rough { .. });
    case.grains.iter().any(random_grains)
        || shapes.into_iter().any(random_shape)
        || case.elastic.iter().any(|body| rough_mesh(&body.mesh))
        || case.half_spaces.iter().any(|s| rough_cells(&s.profile))
}

fn random_grains(grains: &GrainSpec) -> bool {
    match grains {
        GrainSpec::Lattice { radius, .. } => radius.0 < radius.1,
        GrainSpec::Voronoi(_) | GrainSpec::Deposit(_) => true,
        _ => false,
    }
}

fn random_shape(shape: &ShapeSpec) -> bool {
    matches!(
        shape,
        ShapeSpec::RoughProfile { .. } | ShapeSpec::HeightField { rms: Some(_), .. }
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load;
    use std::path::Path;

    #[test]
    fn samples_and_roughness_follow_from_the_seed() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
        for (name, random) in [
            ("wheel_rail_fretting", true),
            ("plane_shear", true),
            ("silo", true),
            ("block_tower", false),
            ("newton_cradle", false),
            ("cylinder_on_flat_fretting", false),
        ] {
            let loaded = load(&folder.join(format!("{name}.ron")), &[]);
            let loaded = loaded.unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(draws(&loaded.case), random, "{name}");
        }
    }
}
