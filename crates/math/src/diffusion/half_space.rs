//! A half-space below a piece of surface: heat flows along its depth only, on a grid that is graded
//! with depth.

use crate::diffusion::DiffusionError;
use crate::diffusion::node::add;
use serde::{Deserialize, Serialize};

/// Capacities and conductances of the points of a grid over depth, per area of surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Grid {
    /// Depth of each point (m); the first is 0.
    pub depth: Vec<f64>,
    /// Heat capacity of the layer around each point (J/(m^2 K)).
    pub capacity: Vec<f64>,
    /// Conductance between each point and the next (W/(m^2 K)).
    pub conductance: Vec<f64>,
}

impl Grid {
    /// Creates a grid whose first spacing is given (m), each further one longer by a factor, down
    /// to a depth (m) below which no heat flows. `conductivity` is in W/(m K), `capacity` is the
    /// volumetric heat capacity rho c in J/(m^3 K).
    ///
    /// The spacing of the surface should be below sqrt(D h), the depth above 4 sqrt(D t), with the
    /// diffusivity D = conductivity/capacity, the step h and the duration t.
    ///
    /// # Errors
    /// A number is not positive, or the factor is below one.
    pub fn graded(
        conductivity: f64,
        capacity: f64,
        first: f64,
        growth: f64,
        depth: f64,
    ) -> Result<Self, DiffusionError> {
        let positive = [
            ("conductivity", conductivity),
            ("heat capacity", capacity),
            ("first spacing", first),
            ("depth", depth),
        ];
        let refuse = |what, value, expected| {
            Err(DiffusionError::Number {
                what,
                node: 0,
                value,
                expected,
            })
        };
        for (what, value) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return refuse(what, value, "a number above zero");
            }
        }
        if !(1.0..=2.0).contains(&growth) {
            return refuse("growth of the spacing", growth, "1 to 2");
        }
        let (mut places, mut spacing) = (vec![0.0], first);
        while places[places.len() - 1] < depth {
            places.push(places[places.len() - 1] + spacing);
            spacing *= growth;
        }
        Ok(Self::at(conductivity, capacity, places))
    }

    /// A grid of given depths, in their order.
    fn at(conductivity: f64, capacity: f64, depth: Vec<f64>) -> Self {
        let gaps: Vec<f64> = depth.windows(2).map(|w| w[1] - w[0]).collect();
        let layer = |k: usize| {
            let above = k.checked_sub(1).map_or(0.0, |j| gaps[j]);
            let below = gaps.get(k).copied().unwrap_or(0.0);
            0.5 * (above + below)
        };
        Self {
            capacity: (0..depth.len()).map(|k| capacity * layer(k)).collect(),
            conductance: gaps.iter().map(|gap| conductivity / gap).collect(),
            depth,
        }
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.capacity.len()
    }
}

/// A half-space below a piece of surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HalfSpace {
    /// Grid over the depth.
    pub grid: Grid,
    /// Area of the piece (m^2; m in 2D).
    pub area: f64,
    /// Temperature of each point (K), that of the surface first.
    pub temperature: Vec<f64>,
    /// Rounding errors of each temperature so far (K).
    pub(crate) lost: Vec<f64>,
}

/// Contribution of the depth to the equation of the surface, and data for the temperatures at
/// depth.
#[derive(Clone, Debug, Default)]
pub(crate) struct Eliminated {
    /// Term added to the diagonal of the surface (W/K).
    pub diagonal: f64,
    /// Term added to the right-hand side of the surface (W).
    pub right: f64,
    /// For each point below the surface the inverse of its pivot and its right-hand side, both
    /// eliminated from below (K/W, W).
    points: Vec<(f64, f64)>,
}

impl HalfSpace {
    /// Creates a half-space with a uniform temperature (K).
    pub fn new(grid: Grid, area: f64, temperature: f64) -> Self {
        Self {
            temperature: vec![temperature; grid.points()],
            lost: vec![0.0; grid.points()],
            grid,
            area,
        }
    }

    /// Returns whether this is a later state of a half-space, which may have another depth: it has
    /// a temperature at each point of its grid.
    pub(crate) fn fits(&self, first: &Self) -> bool {
        let (points, grid) = (self.grid.points(), &self.grid);
        [
            grid.depth.len(),
            grid.conductance.len() + 1,
            self.temperature.len(),
            self.lost.len(),
        ] == [points; 4]
            && self.area == first.area
            && self.temperature.iter().all(|t| t.is_finite())
    }

    /// Returns the heat stored relative to a reference temperature (J).
    pub fn heat(&self, reference: f64) -> f64 {
        let each = self.grid.capacity.iter().zip(&self.temperature);
        self.area * each.map(|(c, t)| c * (t - reference)).sum::<f64>()
    }

    /// Eliminates the depth from (C/w + L) d = -L T, from the lowest point upwards; `w` is theta
    /// times the step (s).
    pub(crate) fn eliminate(&self, w: f64) -> Eliminated {
        let (grid, area) = (&self.grid, self.area);
        let n = grid.points();
        let t = &self.temperature;
        let flow = |k: usize| area * grid.conductance[k] * (t[k + 1] - t[k]);
        let mut points = vec![(0.0, 0.0); n];
        let (mut below_diagonal, mut below_right) = (0.0, 0.0);
        for k in (0..n).rev() {
            let inflow = if k + 1 < n { flow(k) } else { 0.0 };
            let outflow = if k > 0 { flow(k - 1) } else { 0.0 };
            let pivot = area * grid.capacity[k] / w + below_diagonal;
            let right = inflow - outflow + below_right;
            if k > 0 {
                // A conductance g connects the point to the one above: its own equation is (pivot +
                // g) d_k = right + g d_(k-1).
                let g = area * grid.conductance[k - 1];
                let inverse = 1.0 / (pivot + g);
                points[k] = (inverse, right);
                below_diagonal = g * (pivot * inverse);
                below_right = g * (right * inverse);
            } else {
                (below_diagonal, below_right) = (pivot, right);
            }
        }
        Eliminated {
            diagonal: below_diagonal,
            right: below_right,
            points,
        }
    }

    /// Changes the temperatures, given the change of the surface at theta of the step (K); returns
    /// the stored heat (J).
    pub(crate) fn advance(&mut self, eliminated: &Eliminated, surface: f64, theta: f64) -> f64 {
        let mut change = surface;
        let mut stored = 0.0;
        let mut take = |k: usize, change: f64| {
            let (t, lost) = (&mut self.temperature[k], &mut self.lost[k]);
            add(t, lost, change / theta);
            stored += self.area * self.grid.capacity[k] * (change / theta);
        };
        take(0, change);
        for k in 1..self.grid.points() {
            let g = self.area * self.grid.conductance[k - 1];
            let (inverse, right) = eliminated.points[k];
            change = (right + g * change) * inverse;
            take(k, change);
        }
        stored
    }
}
