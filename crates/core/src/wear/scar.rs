//! The scar of a surface: how deep each of its vertices was worn, from the volumes that contacts lose.
//!
//! A volume dV that is worn at a foot on a segment (triangle) goes to the ends (corners) by their linear functions N_i
//! there, and lowers vertex i by N_i dV/A_i with A_i the integral of N_i over the surface: the integral of the
//! depth is then the sum of all dV, and it is what is between the surface before and now ([`crate::geometry::recede`]).

use crate::geometry::recede::Vertex;
use crate::geometry::shape::{Carried, Shapes};
use crate::geometry::space::Space;
use serde::{Deserialize, Serialize};

/// A surface that wears, and by how much it did.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Scar<S: Space> {
    /// Name: of the body, with a number where several of its surfaces wear.
    pub name: String,
    /// Index of the surface in [`Shapes::surfaces`].
    pub surface: usize,
    /// Depth at which it is worn through (m).
    pub thickness: f64,
    /// Steps between two at which the surface follows its depth.
    pub every: u64,
    vertices: Vec<Vertex<S::Vector>>,
    depth: Vec<f64>,
    /// Depth that the surface shows, vertex by vertex (m).
    shown: Vec<f64>,
    /// Volume put so far (m^3; m^3/m in 2D).
    volume: f64,
    deepest: usize,
    /// Vertices whose depth the surface does not show yet.
    pending: Vec<usize>,
    /// How far the surface may have moved since the neighbour list was told (m).
    moved: f64,
}

/// A surface that was worn as deep as it is thick.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Serialize, Deserialize)]
#[error(
    "`{name}` is worn through at {at:?} m: {depth:.4e} m deep of a thickness of {thickness:.4e} m; give it more \
     `wears.thickness`, less load or slip, or end the run before"
)]
pub struct WornThrough {
    /// The scar.
    pub name: String,
    /// Where the deepest vertex stood at first, in the surface's frame (m).
    pub at: Vec<f64>,
    /// Depth there (m).
    pub depth: f64,
    /// Thickness (m).
    pub thickness: f64,
}

impl<S: Space> Scar<S> {
    /// The scar of a surface that is whole; none where it cannot wear.
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
            shown: vec![0.0; vertices.len()],
            vertices,
            volume: 0.0,
            deepest: 0,
            pending: Vec::new(),
            moved: 0.0,
        })
    }

    /// Takes a volume (m^3; m^3/m in 2D) off about a point of the surface, in its frame (m).
    ///
    /// # Errors
    /// That the surface is worn through; the volume is taken all the same.
    pub fn put(
        &mut self,
        shapes: &Shapes<S>,
        closest_point: &S::Vector,
        volume: f64,
    ) -> Result<(), WornThrough> {
        let shape = &shapes.surfaces[self.surface].shape;
        let Some(shape) = shape.receding() else {
            return Ok(());
        };
        for (vertex, part) in shape.shares(closest_point) {
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
        // A long interval names vertices again and again.
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

    /// Lets the surface follow its depth. Whether what it moved since the last time this said yes is more than a
    /// bound (m).
    pub fn show(&mut self, shapes: &mut Shapes<S>, bound: f64) -> bool {
        if self.pending.is_empty() {
            return false;
        }
        self.pending.sort_unstable();
        self.pending.dedup();
        for vertex in &self.pending {
            self.shown[*vertex] = self.depth[*vertex];
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

    /// Lets a surface that is whole show what this scar had it show: what was worn since waits still.
    pub fn show_again(&self, shapes: &mut Shapes<S>) {
        let all: Vec<usize> = (0..self.shown.len()).collect();
        let carried = shapes.surfaces.get_mut(self.surface);
        if let Some(shape) = carried.and_then(|c| c.shape.receding_mut()) {
            shape.recede(&self.shown, &all);
        }
    }

    /// Volume worn so far (m^3; m^3/m in 2D).
    pub fn volume(&self) -> f64 {
        self.volume
    }

    /// The largest depth (m).
    pub fn deepest(&self) -> f64 {
        self.depth[self.deepest]
    }

    /// Where the largest depth is, in the surface's frame before any wear (m).
    pub fn deepest_at(&self) -> S::Vector {
        self.vertices[self.deepest].at
    }

    /// Vertices as they were at first, and their depths (m).
    pub fn vertices(&self) -> impl Iterator<Item = (&Vertex<S::Vector>, f64)> + Clone {
        self.vertices.iter().zip(self.depth.iter().copied())
    }

    /// Depth along the sliding, x: in space the mean over what has the same x. Places (m), lengths (m; areas in
    /// space) they stand for, and depths (m), from left to right.
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

/// The foot of a contact in the frame of its surface: the arm from the centre of the body that carries it (m).
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

    /// The integral of height along the chain, by trapezia: less where solid is lost, whichever way it goes.
    fn under(shapes: &Shapes<Dim2>) -> f64 {
        let chain = shapes.surfaces[0].shape.outline().remove(0);
        let trapezium = |w: &[Vector2<f64>]| 0.5 * (w[1].x - w[0].x) * (w[0].y + w[1].y);
        chain.windows(2).map(trapezium).sum()
    }

    /// A flank of 87 degrees, a gentle slope, a plateau; solid below, above, and repeating.
    #[test]
    fn the_area_between_the_chains_is_the_volume_that_was_put() {
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
                // With a period what is one period away is the same place.
                let x = x + period.map_or(0.0, |p| p * f64::from(k % 5 - 2));
                let closest_point = Vector2::new(x, 0.0);
                scar.put(&shapes, &closest_point, 1e-4).unwrap();
                scar.show(&mut shapes, 1.0);
            }
            let gone = before - under(&shapes);
            assert!((gone / 0.04 - 1.0).abs() < 1e-12, "{gone}");
            assert!((scar.volume() / 0.04 - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn it_says_when_and_where_it_is_worn_through() {
        let shapes = scene(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)], None);
        let mut scar = Scar::new("rail".into(), 0, &shapes.surfaces[0], 0.1, 1).unwrap();
        let at = Vector2::new(1.0, 0.0);
        assert_eq!(scar.put(&shapes, &at, 0.09), Ok(()));
        let error = scar.put(&shapes, &at, 0.02).unwrap_err();
        assert_eq!(error.at, [1.0, 0.0]);
        assert!((error.depth - 0.11).abs() < 1e-15);
        assert!(error.to_string().contains("`rail` is worn through"));
    }

    /// Boxes of the search follow a profile that wears, often and far.
    #[test]
    fn contacts_are_found_where_the_worn_profile_is() {
        let mut shapes = scene(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0)], None);
        let mut scar = Scar::new("rail".into(), 0, &shapes.surfaces[0], 1e3, 1).unwrap();
        for k in 1..200 {
            for x in [1.0, 2.0] {
                scar.put(&shapes, &Vector2::new(x, 0.0), 0.01).unwrap();
            }
            scar.show(&mut shapes, 1.0);
            let (mut out, depth) = (Vec::new(), 0.01 * f64::from(k));
            let shape = &shapes.surfaces[0].shape;
            shape.touches(&Vector2::new(1.5, 0.1 - depth), 0.2, &mut out);
            assert_eq!(out.len(), 1, "{depth}");
            assert!((out[0].distance - 0.1).abs() < 1e-12);
            assert!(shape.near(&Vector2::new(1.5, 0.1 - depth), 0.11));
        }
    }
}
