//! Bodies of finite elements compared with closed forms: impact of a bar, bending, Hertz, Cattaneo
//! and Mindlin.

mod ball_area;
mod bar;
mod bending;
mod bonds;
mod cases;
mod closed_forms;
mod elastica;
mod extremes;
mod facets;
mod fast_points;
mod forces;
mod frequency;
mod grains;
mod half_space;
mod line_contact;
mod mean_places;
mod moments;
mod newton;
mod patch;
mod point_contact;
mod profile;
mod rotation;
mod soft_grains;
mod soft_strain;
mod sphere_on_block;
mod wear;
mod wear_in_space;

use crate::extremes::bench::Sketch;
use crate::stepping::{closes, go, near};
use fretwork::bodies::{DeformedMesh, Dof, DynamicalSystem, Holder, TimeFunction};
use fretwork::elastic::generate::{
    BlockGrid, Coarsening, block, even, graded, mapped_block, mapped_grid,
};
use fretwork::elastic::{
    BodySpec, ElasticBody, Elasticity, Mesh, Rayleigh, Strain, Support, Touching,
};
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use fretwork::step::Simulation;

/// Steel of the usual benchmarks.
const STEEL: Elasticity = Elasticity {
    young: 210e9,
    poisson: 0.3,
    density: 7800.0,
};

/// Rubber, for which a few per cent of strain are small.
const RUBBER: Elasticity = Elasticity {
    young: 1e6,
    poisson: 0.3,
    density: 1000.0,
};

/// Measures of strain that follow rotations.
const LARGE: [Strain; 2] = [Strain::Corotational, Strain::NeoHookean];

/// A support of a part, with a drive along some axes.
fn support(part: &str, axes: &[Option<Dof>]) -> Support {
    Support {
        part: part.to_owned(),
        axes: axes.to_vec(),
        later: Vec::new(),
    }
}

/// Returns an undamped body at rest, without a surface that touches.
fn body<S: Space>(
    mesh: Mesh<S>,
    material: Elasticity,
    supports: &[Support],
) -> BodySpec<'_, Mesh<S>> {
    BodySpec {
        name: "specimen",
        mesh,
        material,
        strain: Strain::Small,
        damping: Rayleigh::default(),
        supports,
        touching: Touching::Nothing,
        surface_material: 0,
        velocity: [0.0; 3],
        spin: [0.0; 3],
    }
}

fn sketch(step: f64, theta: f64) -> Sketch {
    Sketch {
        step,
        theta,
        gravity: 0.0,
        solver: "tolerance: 1e-12, norm: Velocity, max_iterations: 100000,".to_owned(),
        detection: [1e-5, 1e-4],
        ..Sketch::default()
    }
}

fn scene<S: Space>(sketch: &Sketch) -> Simulation<S> {
    sketch.build::<S>().unwrap_or_else(|e| panic!("{e}"))
}

fn add<S: Space>(s: &mut Simulation<S>, spec: BodySpec<Mesh<S>>) -> usize {
    let system = ElasticBody::new(spec).unwrap_or_else(|e| panic!("{e}"));
    s.add_system(Box::new(system))
}

fn mesh<S: Space>(s: &Simulation<S>, system: usize) -> DeformedMesh<S::Vector> {
    let system = s.state.systems.get(system).unwrap();
    system.deformed_mesh().unwrap()
}

fn holder<S: Space>(s: &Simulation<S>, system: usize, part: &str, axis: usize) -> Holder {
    let held = s.state.systems.get(system).unwrap().holders();
    let found = held.into_iter().find(|h| h.part == part && h.axis == axis);
    found.unwrap()
}

/// A displacement that grows from zero to a value and stays there.
fn ramp(to: f64, end: f64) -> Option<Dof> {
    Some(Dof::Displacement(TimeFunction::Ramp {
        from: 0.0,
        to,
        start: 0.0,
        end,
    }))
}
