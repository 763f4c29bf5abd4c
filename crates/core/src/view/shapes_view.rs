//! Reading the shapes of a simulation, and its bodies that are more than rigid.

use super::rows::{BallView, Outline, PieceView, ScarVertex, ScarView, SurfaceView};
use super::systems::{SystemReader, SystemView};
use crate::bodies::SystemStep;
use crate::contact::detect;
use crate::geometry::convex::Core;
use crate::geometry::space::{Space, VectorLike};
use crate::step::Simulation;
use std::fmt::Write;

/// The shapes of the bodies of a run, and its dynamical systems.
///
/// Pieces are numbered as in [`ShapesView::pieces`], surfaces as in [`ShapesView::surfaces`], scars
/// as in [`ShapesView::scars`].
pub trait ShapesView {
    /// Returns the balls of all bodies, and the points of those that deform.
    fn balls(&self) -> Vec<BallView>;
    /// The convex pieces of all bodies.
    fn pieces(&self) -> Vec<PieceView>;
    /// Returns the corners of the core of a piece about its centre, in the axes of its body (m),
    /// and in space the corners of each face, anticlockwise from outside; no faces in the plane.
    fn piece_core(&self, piece: usize) -> (Vec<[f64; 3]>, Vec<Vec<u32>>);
    /// Returns the current outline of a piece, including its rounding, about its centre, in world
    /// axes (m): one line in 2D, one around each face in 3D.
    fn piece_outline(&self, piece: usize) -> Vec<Vec<[f64; 3]>>;
    /// The surfaces of all bodies.
    fn surfaces(&self) -> Vec<SurfaceView>;
    /// Returns the lines of a surface in its own frame (m), whose origin is
    /// [`SurfaceView::offset`].
    fn surface_lines(&self, surface: usize) -> Vec<Vec<[f64; 3]>>;
    /// Returns the faces of a surface up to a distance (m) from its origin, in its own frame (m).
    fn surface_faces(&self, surface: usize, reach: f64) -> Vec<Vec<[f64; 3]>>;
    /// Returns the lines of the surfaces of bodies that have not been removed, at their current
    /// positions (m).
    fn surface_outlines(&self) -> Vec<Outline>;
    /// Returns the surfaces that recede by wear.
    fn scars(&self) -> Vec<ScarView<'_>>;
    /// Returns the vertices of a scar, in the order of its surface.
    fn scar_vertices(&self, scar: usize) -> Vec<ScarVertex>;
    /// Returns 1 where the solid is below the surface of a scar, which recedes downwards, and -1
    /// where it is above; `None` where the surface no longer recedes.
    fn scar_sign(&self, scar: usize) -> Option<f64>;
    /// Returns the position of the image of the first vertex of a scar at the end of the period of
    /// its profile (m).
    fn scar_end(&self, scar: usize) -> Option<[f64; 3]>;
    /// Returns a scar along x: positions (m), tributary lengths (m; areas in 3D, m^2) and depths
    /// (m), in 3D averaged over equal x.
    fn scar_profile(&self, scar: usize) -> Vec<[f64; 3]>;

    /// Writes the shapes of all bodies as text that differs between shapes that differ, so that
    /// scenes can be compared.
    ///
    /// # Errors
    /// Writing to `out` fails.
    fn describe_shapes(&self, out: &mut dyn Write) -> std::fmt::Result;

    /// Number of dynamical systems.
    fn system_count(&self) -> usize;
    /// A dynamical system.
    fn system(&self, system: usize) -> Option<Box<dyn SystemView + '_>>;
    /// The dynamical system of a name.
    fn system_named(&self, name: &str) -> Option<usize>;
    /// Returns the bodies that represent the contactors of a dynamical system, in their order.
    fn bodies_of_system(&self, system: usize) -> &[u32];
}

fn padded<V: VectorLike>(points: &[V]) -> Vec<[f64; 3]> {
    points.iter().map(VectorLike::padded).collect()
}

impl<S: Space> ShapesView for Simulation<S> {
    fn balls(&self) -> Vec<BallView> {
        let bodies = &self.state.bodies;
        let balls = self.shapes.balls.iter().map(|ball| BallView {
            body: ball.body,
            material: ball.material,
            radius: ball.radius,
            centre: detect::centre(ball, bodies).padded(),
            offset: ball.offset.padded(),
            area: ball.area.padded(),
        });
        balls.collect()
    }
    fn pieces(&self) -> Vec<PieceView> {
        let bodies = &self.state.bodies;
        let pieces = self.shapes.pieces.iter().map(|piece| PieceView {
            body: piece.body,
            material: piece.material,
            size: piece.size,
            rounding: piece.rounding,
            centre: detect::piece_centre(piece, bodies).padded(),
            offset: piece.offset.padded(),
            bound: piece.bound,
        });
        pieces.collect()
    }
    fn piece_core(&self, piece: usize) -> (Vec<[f64; 3]>, Vec<Vec<u32>>) {
        let boundary = self.shapes.pieces[piece].core.boundary();
        (padded(&boundary.corners), boundary.faces)
    }
    fn piece_outline(&self, piece: usize) -> Vec<Vec<[f64; 3]>> {
        let piece = &self.shapes.pieces[piece];
        let rotation = &self.state.bodies.rotation[piece.body as usize];
        let lines = piece.core.turned(rotation).outline(piece.rounding);
        lines.iter().map(|line| padded(line)).collect()
    }
    fn surfaces(&self) -> Vec<SurfaceView> {
        let surfaces = self.shapes.surfaces.iter().map(|surface| SurfaceView {
            body: surface.body,
            material: surface.material,
            offset: surface.offset.padded(),
            closed: surface.shape.is_closed(),
            bounded: surface.shape.bounded(),
            flat: surface.shape.flat().map(|normal| normal.padded()),
        });
        surfaces.collect()
    }
    fn surface_lines(&self, surface: usize) -> Vec<Vec<[f64; 3]>> {
        let lines = self.shapes.surfaces[surface].shape.outline();
        lines.iter().map(|line| padded(line)).collect()
    }
    fn surface_faces(&self, surface: usize, reach: f64) -> Vec<Vec<[f64; 3]>> {
        let faces = self.shapes.surfaces[surface].shape.faces_within(reach);
        faces.iter().map(|face| padded(face)).collect()
    }
    fn surface_outlines(&self) -> Vec<Outline> {
        let bodies = &self.state.bodies;
        let surfaces = self.shapes.surfaces.iter();
        let present = surfaces.filter(|f| !bodies.removed[f.body as usize]);
        let lines = present.flat_map(|surface| {
            let b = surface.body as usize;
            let place = move |p: &S::Vector| {
                let arm = S::rotate(&bodies.rotation[b], &(surface.offset + *p));
                (bodies.position[b] + arm).padded()
            };
            let chains = surface.shape.outline().into_iter();
            chains.map(move |chain| Outline {
                body: surface.body,
                points: chain.iter().map(place).collect(),
            })
        });
        lines.collect()
    }
    fn scars(&self) -> Vec<ScarView<'_>> {
        let scars = self.state.scars.iter().map(|scar| ScarView {
            name: &scar.name,
            surface: scar.surface,
            thickness: scar.thickness,
            vertices: scar.vertices().count(),
            volume: scar.volume(),
            deepest: scar.deepest(),
            deepest_at: scar.deepest_at().padded(),
        });
        scars.collect()
    }
    fn scar_vertices(&self, scar: usize) -> Vec<ScarVertex> {
        let vertices = self.state.scars[scar].vertices();
        let vertices = vertices.map(|(vertex, depth)| ScarVertex {
            at: vertex.at.padded(),
            tributary: vertex.tributary,
            depth,
        });
        vertices.collect()
    }
    fn scar_sign(&self, scar: usize) -> Option<f64> {
        let surface = self.shapes.surfaces.get(self.state.scars[scar].surface)?;
        Some(surface.shape.receding()?.sign())
    }
    fn scar_end(&self, scar: usize) -> Option<[f64; 3]> {
        let scar = &self.state.scars[scar];
        let shape = self.shapes.surfaces.get(scar.surface)?.shape.receding()?;
        // The scar of a surface that deforms is not in the frame of the surface.
        let (end, (first, _)) = (shape.end()?, scar.vertices().next()?);
        Some((end + (first.at - shape.vertices().first()?.at)).padded())
    }
    fn scar_profile(&self, scar: usize) -> Vec<[f64; 3]> {
        self.state.scars[scar].along()
    }

    fn describe_shapes(&self, out: &mut dyn Write) -> std::fmt::Result {
        write!(out, "{:?}", self.shapes)
    }

    fn system_count(&self) -> usize {
        self.state.systems.len()
    }
    fn system(&self, system: usize) -> Option<Box<dyn SystemView + '_>> {
        let system = self.state.systems.get(system)?;
        let step = SystemStep {
            time: self.state.time,
            h: self.options.scheme.h,
            theta: self.options.scheme.theta,
            gravity: self.state.gravity,
        };
        Some(Box::new(SystemReader { system, step }))
    }
    fn system_named(&self, name: &str) -> Option<usize> {
        self.state.systems.named(name)
    }
    fn bodies_of_system(&self, system: usize) -> &[u32] {
        self.state.systems.bodies(system)
    }
}
