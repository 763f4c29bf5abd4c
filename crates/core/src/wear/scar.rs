//! The scar of a surface: worn depth of each vertex, from the volumes worn at contacts.
//!
//! A volume dV worn at a contact point on a segment (triangle) is distributed to its ends (corners)
//! by their linear shape functions N_i there, and lowers vertex i by N_i dV/A_i, where A_i is the
//! integral of N_i over the surface. The integral of the depth is then the sum of all dV, and
//! equals the volume between the initial and the current surface ([`crate::geometry::recede`]).

use crate::geometry::recede::Vertex;
use crate::geometry::shape::{Carried, Shapes};
use crate::geometry::space::Space;
use serde::{Deserialize, Serialize};

/// A wearing surface and its worn depth.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Scar<S: Space> {
    /// Name: that of the body, with an index where several of its surfaces wear.
    pub name: String,
    /// Index of the surface in [`Shapes::surfaces`].
    pub surface: usize,
    /// Depth at which it is worn through (m).
    pub thickness: f64,
    /// Number of steps between two updates of the surface.
    pub every: u64,
    vertices: Vec<Vertex<S::Vector>>,
    depth: Vec<f64>,
    /// Depth currently applied to the surface, by vertex (m).
    applied: Vec<f64>,
    /// Accumulated wear volume (m^3; m^3/m in 2D).
    volume: f64,
    deepest: usize,
    /// Vertices whose depth is not yet applied to the surface.
    pending: Vec<usize>,
    /// Upper bound of the displacement of the surface since the neighbour list was rebuilt (m).
    moved: f64,
}

/// A surface whose wear has reached its thickness.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Serialize, Deserialize)]
#[error(
    "`{name}` is worn through at {at:?} m: {depth:.4e} m deep of a thickness of {thickness:.4e} m; give it more \
     `wears.thickness`, less load or slip, or end the run before"
)]
pub struct WornThrough {
    /// The scar.
    pub name: String,
    /// Initial position of the deepest vertex, in the surface's frame (m).
    pub at: Vec<f64>,
    /// Depth there (m).
    pub depth: f64,
    /// Thickness (m).
    pub thickness: f64,
}

impl<S: Space> Scar<S> {
    /// Returns whether it is a valid later state of a scar.
    pub(crate) fn fits(&self, first: &Self) -> bool {
        let count = first.vertices.len();
        (&self.name, self.surface) == (&first.name, first.surface)
            && [self.vertices.len(), self.depth.len(), self.applied.len()] == [count; 3]
            && self
                .depth
                .iter()
                .chain(&self.applied)
                .all(|d| d.is_finite())
            && self.deepest < count.max(1)
            && self.pending.iter().all(|k| *k < count)
    }

    /// Creates the scar of an unworn surface; `None` if the surface cannot wear.
    pub fn new(
        name: String,
        surface: usize,
        carried: &Carried<S>,
        thickness: f64,
        every: u64,
    ) -> Option<Self> {
        let vertices = carried.shape.receding()?.vertices();
        Some(Self {
            name,
            surface,
            thickness,
            every,
            depth: vec![0.0; vertices.len()],
            applied: vec![0.0; vertices.len()],
            vertices,
            volume: 0.0,
            deepest: 0,
            pending: Vec::new(),
            moved: 0.0,
        })
    }

    /// Shifts its vertices (m): the frame of a surface that deforms has its origin at one of its
    /// points.
    #[must_use]
    pub fn shifted(mut self, by: S::Vector) -> Self {
        self.vertices.iter_mut().for_each(|v| v.at += by);
        self
    }

    /// Removes a volume (m^3; m^3/m in 2D) at a point of the surface, in its frame (m).
    ///
    /// # Errors
    /// The surface is worn through; the volume is removed nevertheless.
    pub fn wear_at(
        &mut self,
        shapes: &Shapes<S>,
        closest_point: &S::Vector,
        volume: f64,
    ) -> Result<(), WornThrough> {
        match shapes.surfaces[self.surface].shape.receding() {
            Some(shape) => self.wear_vertices(shape.shares(closest_point), volume),
            None => Ok(()),
        }
    }

    /// Removes a volume (m^3; m^3/m in 2D) from vertices, by their shares of it, which add up to 1.
    ///
    /// # Errors
    /// The surface is worn through; the volume is removed nevertheless.
    pub fn wear_vertices(
        &mut self,
        shares: impl IntoIterator<Item = (usize, f64)>,
        volume: f64,
    ) -> Result<(), WornThrough> {
        for (vertex, part) in shares {
            if part == 0.0 {
                continue;
            }
            self.depth[vertex] += volume * part / self.vertices[vertex].tributary;
            self.pending.push(vertex);
            if self.depth[vertex] > self.depth[self.deepest] {
                self.deepest = vertex;
            }
        }
        self.volume += volume;
        // Over a long interval vertices are listed repeatedly.
        if self.pending.len() > 4 * self.vertices.len() {
            self.pending.sort_unstable();
            self.pending.dedup();
        }
        if self.deepest() < self.thickness {
            return Ok(());
        }
        let at = self.vertices[self.deepest].at;
        Err(WornThrough {
            name: self.name.clone(),
            at: (0..S::D).map(|k| at[k]).collect(),
            depth: self.deepest(),
            thickness: self.thickness,
        })
    }

    /// Applies the depth to the surface. Returns whether the displacement since the last `true`
    /// exceeds a bound (m).
    pub fn apply_depth(&mut self, shapes: &mut Shapes<S>, bound: f64) -> bool {
        if self.pending.is_empty() {
            return false;
        }
        self.pending.sort_unstable();
        self.pending.dedup();
        for vertex in &self.pending {
            self.applied[*vertex] = self.depth[*vertex];
        }
        if let Some(shape) = shapes.surfaces[self.surface].shape.receding_mut() {
            self.moved += shape.recede(&self.depth, &self.pending);
        }
        self.pending.clear();
        let far = self.moved > bound;
        if far {
            self.moved = 0.0;
        }
        far
    }

    /// Applies the depth of an earlier [`Self::apply_depth`] to an unworn surface; later wear
    /// remains pending.
    pub fn reapply_depth(&self, shapes: &mut Shapes<S>) {
        let all: Vec<usize> = (0..self.applied.len()).collect();
        let carried = shapes.surfaces.get_mut(self.surface);
        if let Some(shape) = carried.and_then(|c| c.shape.receding_mut()) {
            shape.recede(&self.applied, &all);
        }
    }

    /// Returns whether this state and another one of the scar have applied the same depths.
    pub fn same_depths(&self, other: &Self) -> bool {
        self.applied == other.applied
    }

    /// Returns the wear volume so far (m^3; m^3/m in 2D).
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// Returns the largest depth (m).
    pub fn deepest(&self) -> f64 {
        self.depth[self.deepest]
    }

    /// Returns the position of the largest depth, in the surface's frame before any wear (m).
    pub fn deepest_at(&self) -> S::Vector {
        self.vertices[self.deepest].at
    }

    /// Iterates over the initial vertices and their depths (m).
    pub fn vertices(&self) -> impl Iterator<Item = (&Vertex<S::Vector>, f64)> + Clone {
        self.vertices.iter().zip(self.depth.iter().copied())
    }

    /// Returns the depth along the sliding direction x, in 3D averaged over equal x: positions (m),
    /// tributary lengths (m; areas in 3D), and depths (m), in order of x.
    pub fn along(&self) -> Vec<[f64; 3]> {
        let mut rows: Vec<[f64; 3]> = self
            .vertices()
            .map(|(v, depth)| [v.at[0], v.tributary, depth * v.tributary])
            .collect();
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut out: Vec<[f64; 3]> = Vec::new();
        for row in rows {
            match out.last_mut().filter(|last| last[0] == row[0]) {
                Some(last) => {
                    last[1] += row[1];
                    last[2] += row[2];
                }
                None => out.push(row),
            }
        }
        for row in &mut out {
            row[2] /= row[1];
        }
        out
    }
}

/// Returns the contact point in the frame of its surface, from the lever arm of the body that
/// carries it (m).
pub fn closest_point<S: Space>(
    carried: &Carried<S>,
    rotation: &S::Rotation,
    arm: &S::Vector,
) -> S::Vector {
    S::unrotate(rotation, arm) - carried.offset
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::periodic::Periodic;
    use crate::geometry::polyline::Polyline;
    use crate::geometry::space::Dim2;
    use nalgebra::Vector2;

    fn scene(points: &[(f64, f64)], period: Option<f64>) -> Shapes<Dim2> {
        let points = points.iter().map(|p| Vector2::new(p.0, p.1)).collect();
        let shape = Polyline::new(points, period).unwrap_or_else(|e| panic!("{e}"));
        Shapes {
            balls: Vec::new(),
            pieces: Vec::new(),
            surfaces: vec![Carried {
                body: 0,
                offset: Vector2::zeros(),
                shape: Box::new(shape),
                material: 0,
            }],
            periodic: Periodic {
                period: [period, None, None],
            },
        }
    }

    /// A flat chain of 1 m segments from x = 0, and its scar of this thickness (m).
    fn flat(segments: u32, thickness: f64) -> (Shapes<Dim2>, Scar<Dim2>) {
        let points: Vec<_> = (0..=segments).map(|x| (f64::from(x), 0.0)).collect();
        let shapes = scene(&points, None);
        let scar = Scar::new("rail".into(), 0, &shapes.surfaces[0], thickness, 1).unwrap();
        (shapes, scar)
    }

    /// Integral of height along the chain by the trapezoidal rule; it decreases where solid is
    /// removed, for either orientation.
    fn under(shapes: &Shapes<Dim2>) -> f64 {
        let chain = shapes.surfaces[0].shape.outline().remove(0);
        let trapezium = |w: &[Vector2<f64>]| 0.5 * (w[1].x - w[0].x) * (w[0].y + w[1].y);
        chain.windows(2).map(trapezium).sum()
    }

    /// A flank of 87 degrees, a gentle slope, a plateau; solid below, above, and periodic.
    #[test]
    fn the_area_between_the_chains_is_the_worn_volume() {
        let hill = [
            (0.0, 0.0),
            (0.1, 2.0),
            (1.0, 2.2),
            (1.5, 2.2),
            (1.52, 1.0),
            (2.0, 0.0),
        ];
        let back: Vec<(f64, f64)> = hill.iter().rev().copied().collect();
        for (points, period) in [
            (&hill[..], None),
            (&back[..], None),
            (&hill[..], Some(2.0)),
            (&back[..], Some(2.0)),
        ] {
            let mut shapes = scene(points, period);
            let before = under(&shapes);
            let mut scar = Scar::new("rail".into(), 0, &shapes.surfaces[0], 1e3, 1).unwrap();
            for k in 0..400 {
                let x = 1.0 + 0.999 * (1.3 * f64::from(k)).sin();
                // With a period, positions one period apart are equivalent.
                let x = x + period.map_or(0.0, |p| p * f64::from(k % 5 - 2));
                let closest_point = Vector2::new(x, 0.0);
                scar.wear_at(&shapes, &closest_point, 1e-4).unwrap();
                scar.apply_depth(&mut shapes, 1.0);
            }
            let removed = before - under(&shapes);
            assert!((removed / 0.04 - 1.0).abs() < 1e-12, "{removed}");
            assert!((scar.volume() / 0.04 - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_error_has_the_place_where_it_is_worn_through() {
        let (shapes, mut scar) = flat(2, 0.1);
        let at = Vector2::new(1.0, 0.0);
        assert_eq!(scar.wear_at(&shapes, &at, 0.09), Ok(()));
        let error = scar.wear_at(&shapes, &at, 0.02).unwrap_err();
        assert_eq!(error.at, [1.0, 0.0]);
        assert!((error.depth - 0.11).abs() < 1e-15);
        assert!(error.to_string().contains("`rail` is worn through"));
    }

    /// The bounding boxes of the search follow a profile that wears often and deep.
    #[test]
    fn contacts_are_found_where_the_worn_profile_is() {
        let (mut shapes, mut scar) = flat(3, 1e3);
        for k in 1..200 {
            for x in [1.0, 2.0] {
                scar.wear_at(&shapes, &Vector2::new(x, 0.0), 0.01).unwrap();
            }
            scar.apply_depth(&mut shapes, 1.0);
            let (mut out, depth) = (Vec::new(), 0.01 * f64::from(k));
            let shape = &shapes.surfaces[0].shape;
            shape.closest_points(&Vector2::new(1.5, 0.1 - depth), 0.2, &mut out);
            assert_eq!(out.len(), 1, "{depth}");
            assert!((out[0].distance - 0.1).abs() < 1e-12);
            assert!(shape.near(&Vector2::new(1.5, 0.1 - depth), 0.11));
        }
    }

    /// The displacement of the surface is summed until the neighbour list is rebuilt, and then
    /// starts from zero.
    #[test]
    fn displacements_add_up_between_two_lists() {
        let (mut shapes, mut scar) = flat(2, 1e3);
        let step = 1.0 / 1024.0;
        let far: Vec<bool> = (0..9)
            .map(|_| {
                scar.wear_at(&shapes, &Vector2::new(1.0, 0.0), step)
                    .unwrap();
                scar.apply_depth(&mut shapes, 2.5 * step)
            })
            .collect();
        let third = [false, false, true];
        assert_eq!(far, [third; 3].concat());
        assert!(!scar.apply_depth(&mut shapes, 0.0), "nothing is worn since");
    }

    /// Two states have the same surface depths until later wear is applied to the surface.
    #[test]
    fn states_of_a_scar_differ_by_the_depths_applied_to_the_surface() {
        let (mut shapes, scar) = flat(2, 1e3);
        let mut later = scar.clone();
        later
            .wear_at(&shapes, &Vector2::new(1.0, 0.0), 0.1)
            .unwrap();
        assert!(later.same_depths(&scar));
        later.apply_depth(&mut shapes, 1.0);
        assert!(!later.same_depths(&scar));
        let before = under(&shapes);
        scar.reapply_depth(&mut shapes);
        assert!((under(&shapes) - before - 0.1).abs() < 1e-15);
    }

    /// A chain of 1 m pieces: a vertex at an end has a tributary length of half a piece, and a
    /// vertex that loses a volume of 0.09 m^2 recedes by that divided by its length.
    #[test]
    fn depths_along_the_chain_are_those_of_its_vertices() {
        let (shapes, mut scar) = flat(2, 1.0);
        scar.wear_at(&shapes, &Vector2::new(1.0, 0.0), 0.09)
            .unwrap();
        assert_eq!(
            scar.along(),
            [[0.0, 0.5, 0.0], [1.0, 1.0, 0.09], [2.0, 0.5, 0.0]]
        );
    }

    /// On a flank, vertices at one position along the sliding direction have the mean of their
    /// depths, weighted by their lengths.
    #[test]
    fn depths_of_one_place_are_averaged() {
        let shapes = scene(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (2.0, 1.0)], None);
        let mut scar = Scar::new("rail".into(), 0, &shapes.surfaces[0], 1.0, 1).unwrap();
        scar.wear_vertices([(1, 1.0)], 0.125).unwrap();
        let along = scar.along();
        let places: Vec<f64> = along.iter().map(|row| row[0]).collect();
        assert_eq!(places, [0.0, 1.0, 2.0]);
        let middle = scar.vertices().skip(1).take(2);
        let both: f64 = middle.map(|(v, _)| v.tributary).sum();
        assert!((along[1][1] - both).abs() < 1e-15);
        assert!((along[1][2] * both - 0.125).abs() < 1e-15);
    }

    /// A state read from a file is refused where it names vertices that the scar does not have.
    #[test]
    fn a_state_with_other_vertices_does_not_fit() {
        let (_, first) = flat(2, 1.0);
        assert!(first.fits(&first));
        for (deepest, pending, fits) in
            [(2, vec![2], true), (3, vec![], false), (0, vec![3], false)]
        {
            let mut later = first.clone();
            later.deepest = deepest;
            later.pending.extend(pending);
            assert_eq!(later.fits(&first), fits);
        }
        let mut later = first.clone();
        later.depth[1] = f64::NAN;
        assert!(!later.fits(&first));
    }
}
