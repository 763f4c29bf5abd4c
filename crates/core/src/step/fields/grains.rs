//! Fields of grains.

use super::Field;
use crate::contact::detect::{centre, piece_centre};
use crate::geometry::convex::Core;
use crate::geometry::space::{Space, VectorLike};
use crate::step::Simulation;

/// A ball or piece of a body, one point of the view of grains.
#[derive(Clone, Copy, Debug)]
pub struct GrainPart<S: Space> {
    /// Index of the body.
    pub body: u32,
    /// Index of the material.
    pub material: u16,
    /// Radius (m); for shapes other than balls that of the ball (2D: disk) of the same volume.
    pub radius: f64,
    /// Number of corners: of a polygon or polyhedron, 2 for a capsule, 0 for a ball.
    pub corners: u32,
    /// Centre (m).
    pub centre: S::Vector,
}

impl<S: Space> GrainPart<S> {
    /// Iterates over all balls, then all pieces, then all deformable grains.
    pub fn all(s: &Simulation<S>) -> impl Iterator<Item = Self> {
        let bodies = &s.state.bodies;
        let deforms = |body: u32| bodies.carrier(body as usize).is_some_and(|c| c.grain);
        let balls = s.shapes.balls.iter().filter(move |b| !deforms(b.body));
        let balls = balls.map(|ball| Self {
            body: ball.body,
            material: ball.material,
            radius: ball.radius,
            corners: 0,
            centre: centre(ball, &s.state.bodies),
        });
        let pieces = s.shapes.pieces.iter().map(|piece| Self {
            body: piece.body,
            material: piece.material,
            radius: piece.size,
            corners: piece.core.boundary().corners.len() as u32,
            centre: piece_centre(piece, &s.state.bodies),
        });
        let surfaces = s.shapes.surfaces.iter().filter(move |f| deforms(f.body));
        let grains = surfaces.map(|surface| Self {
            body: surface.body,
            material: surface.material,
            radius: bodies.length[surface.body as usize],
            corners: surface.shape.moving_vertices().len() as u32,
            centre: bodies.position[surface.body as usize],
        });
        balls.chain(pieces).chain(grains)
    }

    fn index(&self) -> usize {
        self.body as usize
    }
}

/// Fields that all simulations have.
pub(super) fn standard<S: Space>() -> Vec<Field<S, GrainPart<S>>> {
    let velocity = |name, axis: usize| {
        Field::number(
            name,
            "m/s",
            "velocity",
            move |s: &Simulation<S>, g: &GrainPart<S>| {
                s.state.bodies.velocity[g.index()].padded()[axis]
            },
        )
    };
    let spin = |name, axis: usize| {
        Field::number(
            name,
            "rad/s",
            "angular velocity",
            move |s: &Simulation<S>, g: &GrainPart<S>| {
                s.state.bodies.spin[g.index()].padded()[axis]
            },
        )
    };
    let mut fields = vec![
        Field::number(
            "id",
            "",
            "identity of the body",
            |s: &Simulation<S>, g: &GrainPart<S>| s.state.bodies.id[g.index()] as f64,
        ),
        Field::number(
            "radius",
            "m",
            "radius; of other shapes that of the ball (2D: disk) of the same volume",
            |_, g: &GrainPart<S>| g.radius,
        ),
        Field::number(
            "material",
            "",
            "index of the material",
            |_, g: &GrainPart<S>| f64::from(g.material),
        ),
        Field::number(
            "first_body",
            "",
            "1 for parts of a first body",
            |s: &Simulation<S>, g: &GrainPart<S>| {
                let first = s.state.bodies.driven.iter().any(|d| d.body == g.body);
                f64::from(u8::from(first))
            },
        ),
        velocity("velocity_x", 0),
        velocity("velocity_y", 1),
        velocity("velocity_z", 2),
        Field::vector(
            "velocity",
            "m/s",
            "velocity of the centre of mass of the body",
            |s: &Simulation<S>, g: &GrainPart<S>| s.state.bodies.velocity[g.index()],
        ),
        Field::number(
            "spin",
            "rad/s",
            "angular velocity, its norm in 3D",
            |s: &Simulation<S>, g: &GrainPart<S>| {
                let spin = &s.state.bodies.spin[g.index()];
                if S::D == 2 { spin[0] } else { spin.norm() }
            },
        ),
        Field::number(
            "corners",
            "",
            "corners of a polygon or polyhedron, 2 of a capsule, 0 for a ball",
            |_, g: &GrainPart<S>| f64::from(g.corners),
        ),
    ];
    if S::D == 3 {
        fields.extend([spin("spin_x", 0), spin("spin_y", 1), spin("spin_z", 2)]);
        fields.push(Field::vector(
            "angular_velocity",
            "rad/s",
            "angular velocity",
            |s: &Simulation<S>, g: &GrainPart<S>| s.state.bodies.spin[g.index()],
        ));
    }
    fields
}

/// Names of the components of an orientation in space.
pub const ORIENTATION: [&str; 4] = [
    "orientation_w",
    "orientation_x",
    "orientation_y",
    "orientation_z",
];

/// Returns orientations, for simulations with grains other than single balls.
pub fn orientation<S: Space>() -> Vec<Field<S, GrainPart<S>>> {
    let number = |name, unit, doc, k: usize| {
        Field::number(
            name,
            unit,
            doc,
            move |s: &Simulation<S>, g: &GrainPart<S>| {
                S::rotation_numbers(&s.state.bodies.rotation[g.index()])[k]
            },
        )
    };
    if S::D == 2 {
        return vec![number("angle", "rad", "orientation", 0)];
    }
    let names = ORIENTATION.into_iter().enumerate();
    names
        .map(|(k, name)| number(name, "", "orientation, a unit quaternion", k))
        .collect()
}

/// Returns whether a grain was removed, for simulations that remove grains.
pub fn removed<S: Space>() -> Field<S, GrainPart<S>> {
    Field::number(
        "removed",
        "",
        "1 for grains that were removed",
        |s: &Simulation<S>, g: &GrainPart<S>| {
            f64::from(u8::from(s.state.bodies.removed[g.index()]))
        },
    )
}
