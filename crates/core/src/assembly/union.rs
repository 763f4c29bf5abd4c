//! Rigid unions: the shapes carried by one body, with their mass properties.

use crate::geometry::any_shape::{AnyPart, AnySurface};
use crate::geometry::convex::ConvexPart;
use crate::geometry::shape::Surface;
use crate::geometry::space::{MatrixLike, Space, VectorLike, ball_volume};

/// Balls, convex parts and surfaces that move together, of either dimension.
#[derive(Debug, Default)]
pub struct AnyUnion {
    balls: Vec<([f64; 3], f64)>,
    parts: Vec<AnyPart>,
    surfaces: Vec<([f64; 3], AnySurface)>,
}

impl AnyUnion {
    /// Adds a ball: its centre and radius (m).
    pub fn add_ball(&mut self, centre: [f64; 3], radius: f64) {
        self.balls.push((centre, radius));
    }

    /// Adds a convex part.
    pub fn add_part(&mut self, part: AnyPart) {
        self.parts.push(part);
    }

    /// Adds a surface at an offset (m).
    pub fn add_surface(&mut self, at: [f64; 3], surface: AnySurface) {
        self.surfaces.push((at, surface));
    }

    /// Returns whether the union has no shape.
    pub fn is_empty(&self) -> bool {
        self.balls.is_empty() && self.parts.is_empty() && self.surfaces.is_empty()
    }

    /// Returns whether the union has a surface.
    pub fn has_surfaces(&self) -> bool {
        !self.surfaces.is_empty()
    }

    /// Returns the total volume in a dimension (m^3; m^2 in 2D); surfaces have none.
    pub fn volume(&self, dimension: usize) -> f64 {
        let balls = self.balls.iter().map(|b| ball_volume(dimension, b.1));
        balls.chain(self.parts.iter().map(AnyPart::volume)).sum()
    }

    /// Returns the union in dimension `S`; `None` if a part of it has the other dimension.
    pub(super) fn into_dimension<S: Space>(self) -> Option<Union<S>> {
        let balls = self.balls.into_iter();
        let parts = self.parts.into_iter();
        let surfaces = self.surfaces.into_iter();
        Some(Union {
            balls: balls.map(|(x, r)| (S::Vector::from_slice(&x), r)).collect(),
            parts: parts.map(AnyPart::into_dimension).collect::<Option<_>>()?,
            surfaces: surfaces
                .map(|(at, s)| Some((S::Vector::from_slice(&at), s.into_dimension()?)))
                .collect::<Option<_>>()?,
        })
    }
}

/// A surface, and its offset in the frame of its body (m).
type PlacedSurface<S> = (<S as Space>::Vector, Box<dyn Surface<S>>);

/// Balls, convex parts and surfaces that move together.
pub(super) struct Union<S: Space> {
    pub balls: Vec<(S::Vector, f64)>,
    pub parts: Vec<ConvexPart<S>>,
    pub surfaces: Vec<PlacedSurface<S>>,
}

impl<S: Space> Union<S> {
    /// Centre (m), volume (m^3; 2D: m^2) and moments of inertia about the centre at unit density,
    /// of each shape that has a volume.
    fn volumes(&self) -> impl Iterator<Item = (S::Vector, f64, S::Tensor)> + '_ {
        let ball = |(x, r): &(S::Vector, f64)| {
            let volume = S::ball_volume(*r);
            (
                *x,
                volume,
                S::Tensor::uniform(S::BALL_INERTIA * r * r * volume),
            )
        };
        let parts = self.parts.iter().map(|p| (p.centre, p.volume, p.inertia));
        self.balls.iter().map(ball).chain(parts)
    }

    /// Returns the total volume (m^3; 2D: m^2).
    pub fn volume(&self) -> f64 {
        self.volumes().map(|v| v.1).sum()
    }

    /// Returns the centre of mass (m); the origin if the union has surfaces only, which have no
    /// volume.
    pub fn centre(&self) -> S::Vector {
        let (mut centre, volume) = (S::Vector::zero(), self.volume());
        if volume > 0.0 && self.surfaces.is_empty() {
            for (x, v, _) in self.volumes() {
                centre += x * (v / volume);
            }
        }
        centre
    }

    /// Returns the moments of inertia about a point at unit density (m^5; 2D: m^4).
    pub fn inertia(&self, about: &S::Vector) -> S::Tensor {
        self.volumes()
            .fold(S::Tensor::uniform(0.0), |sum, (x, volume, own)| {
                sum + own + S::steiner(&(x - *about)).scaled(volume)
            })
    }

    /// The radius (m), if the union is a single ball.
    pub fn only_ball(&self) -> Option<f64> {
        let alone = self.balls.len() == 1 && self.parts.is_empty() && self.surfaces.is_empty();
        alone.then(|| self.balls[0].1)
    }
}
