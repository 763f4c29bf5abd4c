//! Servo pressure: the force on a wall is a pressure times the current area of the sample.

use super::drive::Dof;
use super::state::Bodies;
use super::systems::{HeldAxis, Systems};
use crate::geometry::shape::Shapes;
use crate::geometry::space::Space;
use serde::{Deserialize, Serialize};

/// A plane wall perpendicular to an axis: its body, and the coordinate of its face in the body's
/// frame (m).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Face {
    body: usize,
    offset: f64,
}

/// The body or holder on which a servo acts.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ServoTarget {
    /// A driven body: index among the driven bodies, and index of the degree of freedom.
    Body(usize, usize),
    /// The holder of a part of a deformable body.
    Holder(HeldAxis),
}

impl ServoTarget {
    /// Returns the index of the degree of freedom.
    fn dof(&self) -> usize {
        match self {
            Self::Body(_, dof) => *dof,
            Self::Holder(held) => held.axis,
        }
    }
}

/// A drive that depends on the area between walls.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Servo {
    /// Body or holder on which the servo acts.
    target: ServoTarget,
    /// Index of the stage, 0 where there are no stages.
    drive: usize,
    /// Product of the periodic lengths (m, m^2).
    fixed: f64,
    /// Pairs of walls, and the axis along which they face each other.
    spans: Vec<(usize, [Face; 2])>,
}

impl Servo {
    /// Returns the body or holder on which the servo acts.
    pub(crate) fn target(&self) -> &ServoTarget {
        &self.target
    }

    /// Returns the servos of one degree of freedom, one for each stage that is a pressure.
    ///
    /// # Errors
    /// A wall is missing or not plane, or no length is defined along an axis.
    pub fn of<S: Space>(
        bodies: &Bodies<S>,
        shapes: &Shapes<S>,
        target: &ServoTarget,
        drive: &Dof,
    ) -> Result<Vec<Self>, String> {
        let mut servos = Vec::new();
        let dof = target.dof();
        for (k, drive) in drive.drives().enumerate() {
            let Dof::Pressure { between, .. } = drive else {
                continue;
            };
            if dof >= S::D {
                return Err(
                    "a pressure acts along an axis, not about one; use Force for a moment".into(),
                );
            }
            let mut servo = Self {
                target: target.clone(),
                drive: k,
                fixed: 1.0,
                spans: Vec::new(),
            };
            for (one, other) in between {
                let (axis, low) = face(bodies, shapes, one)?;
                let (same, high) = face(bodies, shapes, other)?;
                if axis != same || axis == dof {
                    return Err(format!(
                        "the walls `{one}` and `{other}` must face each other across the direction of the pressure"
                    ));
                }
                servo.spans.push((axis, [low, high]));
            }
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate().take(S::D) {
                if axis == dof || servo.spans.iter().any(|s| s.0 == axis) {
                    continue;
                }
                servo.fixed *= shapes.periodic.period[axis].ok_or_else(|| {
                    format!("a pressure needs the length along {name}: name two walls in `between`, or make {name} periodic")
                })?;
            }
            servos.push(servo);
        }
        Ok(servos)
    }

    /// Measures the area between the walls and passes it to the drive.
    pub fn measure<S: Space>(&self, bodies: &mut Bodies<S>, systems: &mut Systems<S>) {
        let mut now = self.fixed;
        for (axis, faces) in &self.spans {
            let [low, high] = faces.map(|f| bodies.position[f.body][*axis] + f.offset);
            now *= (high - low).abs();
        }
        let dof = match &self.target {
            ServoTarget::Body(place, dof) => Some(&mut bodies.driven[*place].dofs[*dof]),
            ServoTarget::Holder(held) => systems.drive_mut(held),
        };
        let Some(dof) = dof else { return };
        let drive = match dof {
            Dof::Stages(stages) => match stages.get_mut(self.drive) {
                Some(stage) => &mut stage.drive,
                None => return,
            },
            simple => simple,
        };
        if let Dof::Pressure { area, .. } = drive {
            *area = now;
        }
    }
}

/// Returns the axis to which a wall is perpendicular, and its face.
fn face<S: Space>(
    bodies: &Bodies<S>,
    shapes: &Shapes<S>,
    name: &str,
) -> Result<(usize, Face), String> {
    let driven = bodies.driven.iter().find(|d| d.name == name);
    let body = driven
        .ok_or_else(|| format!("there is no body `{name}`"))?
        .body;
    let flat = shapes.surfaces.iter().find_map(|s| {
        let normal = (s.body == body).then(|| s.shape.flat()).flatten()?;
        let axis = (0..S::D).find(|k| normal[*k].abs() > 1.0 - 1e-12)?;
        Some((
            axis,
            Face {
                body: body as usize,
                offset: s.offset[axis],
            },
        ))
    });
    flat.ok_or_else(|| format!("the wall `{name}` has no HalfSpace perpendicular to an axis"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bodies::{Driven, TimeFunction};
    use crate::geometry::periodic::Periodic;
    use crate::geometry::shape::{Carried, HalfSpace};
    use crate::geometry::space::Dim3;
    use nalgebra::Vector3;

    /// In 3D with a periodic y the force on a lid is p (right - left) period, for any motion of the
    /// walls.
    #[test]
    fn the_force_follows_the_area() {
        let mut bodies = Bodies::<Dim3>::default();
        let mut shapes = Shapes {
            balls: Vec::new(),
            pieces: Vec::new(),
            surfaces: Vec::new(),
            periodic: Periodic {
                period: [None, Some(0.5), None],
            },
        };
        let pressure = Dof::Pressure {
            value: TimeFunction::Constant(-2e3),
            between: vec![("left".into(), "right".into())],
            area: 0.0,
        };
        for (name, x, normal) in [
            ("left", 0.0, Vector3::x()),
            ("right", 0.3, -Vector3::x()),
            ("lid", 0.0, -Vector3::z()),
        ] {
            let body = bodies.add(Vector3::new(x, 0.0, 0.0), 1.0, 1.0, 1.0);
            let mut dofs = vec![Dof::Fixed; 6];
            if name == "lid" {
                dofs[2] = pressure.clone();
            }
            bodies.drive(Driven {
                name: name.into(),
                body,
                dofs,
            });
            shapes.surfaces.push(Carried {
                body,
                offset: Vector3::zeros(),
                shape: Box::new(HalfSpace::<Dim3> { normal, shown: 1.0 }),
                material: 0,
            });
        }
        let servos =
            Servo::of(&bodies, &shapes, &ServoTarget::Body(2, 2), &pressure).unwrap_or_default();
        for wide in [0.3, 0.2] {
            bodies.position[1].x = wide;
            servos[0].measure(&mut bodies, &mut Systems::default());
            let force = bodies.driven[2].dofs[2].force(0.0);
            assert!((force + 2e3 * wide * 0.5).abs() < 1e-9, "{force}");
        }
        let blind = Dof::Pressure {
            value: TimeFunction::Constant(1.0),
            between: Vec::new(),
            area: 0.0,
        };
        let said = Servo::of(&bodies, &shapes, &ServoTarget::Body(2, 2), &blind).unwrap_err();
        assert!(said.contains("length along x"), "{said}");
    }
}
