//! Two elastic half-spaces that touch over a grid of cells: relative displacements of their
//! surfaces by tractions that are uniform in each cell.

use crate::convolution::{Convolution, Spectrum};
use crate::fields::{Field, Vector};
use crate::motion::Motion;
use fretwork_elastic::Elasticity;
use fretwork_elastic::half_space::influence::{Influence, rectangle};
use fretwork_elastic::half_space::{CellGrid, Complex64};
use std::sync::OnceLock;

/// What passes from one step of a motion to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Passage {
    /// Steady rolling: in a step material moves by one cell, in a field that stays as it is.
    Steady,
    /// A shift: all tractions are those of this step.
    Shift,
}

/// The surfaces of two bodies. Tables are made once from the grid and the layer, which stay as they
/// are.
#[derive(Debug)]
pub struct Surfaces {
    /// The cells.
    pub grid: CellGrid,
    /// Compliance of an elastic layer between the bodies, its thickness over its shear modulus
    /// (m/Pa).
    pub layer: f64,
    bodies: [Elasticity; 2],
    convolution: Convolution,
    /// Normal displacement by pressure (m/Pa).
    normal: Spectrum,
    tables: Tables,
}

/// Tables that are made at their first use.
#[derive(Debug, Default)]
struct Tables {
    /// Entries xx, yy and xy of the displacement by traction, here and one cell upstream (m/Pa).
    displacement: [OnceLock<[Spectrum; 3]>; 2],
    /// The same entries of the slip in a step of steady rolling (m/Pa).
    steady: OnceLock<[Spectrum; 3]>,
    /// Slip in rolling by pressure, along x and y (m/Pa).
    slip_by_pressure: OnceLock<[Spectrum; 2]>,
    /// Normal displacement by traction along x and y (m/Pa).
    normal_by_traction: OnceLock<[Spectrum; 2]>,
    /// Inverse of the displacement by waves of traction (Pa/m).
    stiffness: OnceLock<[Vec<f64>; 3]>,
}

impl Surfaces {
    /// Creates the surfaces over a grid.
    pub fn new(grid: CellGrid, bodies: [Elasticity; 2], layer: f64) -> Self {
        let convolution = Convolution::new(&grid);
        let [normal] = convolution.spectra(|at| [of_cell(&grid, &bodies, at)[2][2]]);
        Self {
            grid,
            layer,
            bodies,
            convolution,
            normal,
            tables: Tables::default(),
        }
    }

    /// Returns the sum of the normal displacements of both surfaces by pressures (m).
    pub fn normal(&self, pressure: &[f64]) -> Vec<f64> {
        self.convolution.convolve(pressure, &self.normal)
    }

    /// Returns whether pressures move the surfaces along each other, and tractions apart.
    pub fn couple(&self) -> bool {
        let [one, other] = self.bodies.map(|b| (1.0 - 2.0 * b.poisson) / b.shear());
        (one - other).abs() > 1e-12 * (one.abs() + other.abs())
    }

    /// Returns the slip by pressures in a motion (m): in rolling the displacement less that one
    /// cell upstream, in a shift under constant pressures none.
    pub fn slip_by_pressure(&self, pressure: &[f64], motion: &Motion) -> Field {
        if matches!(motion, Motion::Shift { .. }) {
            return vec![[0.0; 2]; pressure.len()];
        }
        let made = || {
            self.convolution.spectra(|at| {
                let ahead = |n| of_cell(&self.grid, &self.bodies, [at[0] + n, at[1]]);
                let [here, there] = [0.0, 1.0].map(ahead);
                [0, 1].map(|k| here[k][2] - there[k][2])
            })
        };
        let [x, y] = self.tables.slip_by_pressure.get_or_init(made);
        let field: Field = pressure.iter().map(|p| [*p, 0.0]).collect();
        self.convolution
            .apply(&field, |k, [p, _]| [x[k] * p, y[k] * p])
    }

    /// Returns the normal displacements by tractions (m), which open the gap.
    pub fn normal_by_traction(&self, traction: &[Vector]) -> Vec<f64> {
        let made = || {
            self.convolution.spectra(|at| {
                let here = of_cell(&self.grid, &self.bodies, at);
                [here[2][0], here[2][1]]
            })
        };
        let [x, y] = self.tables.normal_by_traction.get_or_init(made);
        let moved = self
            .convolution
            .apply(traction, |k, [p, q]| [x[k] * p + y[k] * q, Complex64::ZERO]);
        moved.into_iter().map(|u| u[0]).collect()
    }

    /// Returns the tangential displacements by tractions (m), including that of the layer, at
    /// places that lie no cell or one cell upstream of each cell.
    pub fn displacement(&self, traction: &[Vector], upstream: bool) -> Field {
        let [xx, yy, xy] = self.displacement_table(upstream);
        self.convolution.apply(traction, |k, [x, y]| {
            [xx[k] * x + xy[k] * y, xy[k] * x + yy[k] * y]
        })
    }

    fn displacement_table(&self, upstream: bool) -> &[Spectrum; 3] {
        let ahead = usize::from(upstream);
        self.tables.displacement[ahead].get_or_init(|| {
            self.convolution
                .spectra(|at| self.moved([at[0] + ahead as f64, at[1]]))
        })
    }

    fn steady_table(&self) -> &[Spectrum; 3] {
        self.tables.steady.get_or_init(|| {
            self.convolution.spectra(|at| {
                let (here, there) = (self.moved(at), self.moved([at[0] + 1.0, at[1]]));
                std::array::from_fn(|k| here[k] - there[k])
            })
        })
    }

    /// Returns the entries xx, yy and xy of the displacement at a distance in cells by unit
    /// tractions on a cell (m/Pa), including that of the layer on the cell itself.
    fn moved(&self, at: [f64; 2]) -> [f64; 3] {
        let u = of_cell(&self.grid, &self.bodies, at);
        let own = if at == [0.0; 2] { self.layer } else { 0.0 };
        [u[0][0] + own, u[1][1] + own, u[0][1]]
    }

    /// Returns the displacement of a cell along the rolling by a traction on it (m/Pa), including
    /// that of the layer.
    pub fn own_compliance(&self) -> f64 {
        self.moved([0.0; 2])[0]
    }

    /// Returns the map from tractions to slip.
    pub fn slip(&self, passage: Passage) -> Slip<'_> {
        Slip::new(self, passage)
    }
}

/// Returns the relative displacement at a distance in cells by unit tractions on a cell (m/Pa).
///
/// Tractions act on the first body, and opposite ones on the second; normals point into each body.
fn of_cell(grid: &CellGrid, bodies: &[Elasticity; 2], at: [f64; 2]) -> Influence {
    let [x, y] = [at[0] * grid.size[0], at[1] * grid.size[1]];
    let area = grid.size[0] * grid.size[1];
    let [one, other] = bodies.map(|body| rectangle(&body, grid.size, x, y));
    let mut out = Influence::default();
    for a in 0..3 {
        for b in 0..3 {
            // The second body has the opposite traction along the surface, and the same along its
            // normal.
            let sign = if (a == 2) == (b == 2) { 1.0 } else { -1.0 };
            out[a][b] = area * (one[a][b] + sign * other[a][b]);
        }
    }
    out
}

/// The linear map from tractions to slip in a step, S = B p (m by Pa), and an approximate inverse.
#[derive(Debug)]
pub struct Slip<'a> {
    surfaces: &'a Surfaces,
    passage: Passage,
    /// Entries xx, yy and xy of B by wave number.
    map: &'a [Spectrum; 3],
    /// Inverse of the displacement by waves of traction (Pa/m).
    inverse: &'a [Vec<f64>; 3],
    /// Slip of a cell by its own traction along x (m/Pa).
    pub own: f64,
}

impl<'a> Slip<'a> {
    fn new(surfaces: &'a Surfaces, passage: Passage) -> Self {
        let own = surfaces.own_compliance();
        let stiffness = &surfaces.tables.stiffness;
        Self {
            surfaces,
            passage,
            map: match passage {
                Passage::Steady => surfaces.steady_table(),
                Passage::Shift => surfaces.displacement_table(false),
            },
            inverse: stiffness.get_or_init(|| stiffness_of_waves(surfaces)),
            own: match passage {
                Passage::Steady => own - surfaces.moved([1.0, 0.0])[0],
                Passage::Shift => own,
            },
        }
    }

    /// Returns the slip by tractions (m), without the rigid one.
    pub fn by(&self, traction: &[Vector]) -> Field {
        let [xx, yy, xy] = self.map;
        self.surfaces.convolution.apply(traction, |k, [x, y]| {
            [xx[k] * x + xy[k] * y, xy[k] * x + yy[k] * y]
        })
    }

    /// Returns about the tractions that give a slip where `sticks` is set (Pa), and the slip as it
    /// is elsewhere.
    ///
    /// In steady rolling the slip along a row is the difference of displacements of neighbours: it
    /// is summed up from the leading edge of each part that sticks. The inverse of the displacement
    /// is that of waves, which have no ends.
    pub fn about_inverse(&self, slip: &[Vector], sticks: impl Fn(usize) -> bool) -> Field {
        let columns = self.surfaces.grid.cells[0];
        let mut moved = vec![[0.0; 2]; slip.len()];
        for start in (0..slip.len()).step_by(columns) {
            let mut sum = [0.0; 2];
            for cell in (start..start + columns).rev() {
                if !sticks(cell) || self.passage == Passage::Shift {
                    sum = [0.0; 2];
                }
                if sticks(cell) {
                    sum = [sum[0] + slip[cell][0], sum[1] + slip[cell][1]];
                    moved[cell] = sum;
                }
            }
        }
        let [xx, yy, xy] = self.inverse;
        let mut out = self.surfaces.convolution.apply(&moved, |k, [x, y]| {
            [x * xx[k] + y * xy[k], x * xy[k] + y * yy[k]]
        });
        for (cell, out) in out.iter_mut().enumerate() {
            if !sticks(cell) {
                *out = slip[cell];
            }
        }
        out
    }
}

/// Returns the traction per displacement of waves (Pa/m), entries xx, yy and xy: a half-space has
/// the compliance (1 - nu)/(G k) along the wave vector and 1/(G k) across it (K. L. Johnson,
/// Contact Mechanics, 1985, 13.2, for plane strain).
fn stiffness_of_waves(surfaces: &Surfaces) -> [Vec<f64>; 3] {
    let size = surfaces.grid.size;
    let sum = |of: fn(&Elasticity) -> f64| surfaces.bodies.iter().map(of).sum::<f64>();
    let along = sum(|b| (1.0 - b.poisson) / b.shear());
    let across = sum(|b| 1.0 / b.shear());
    // The mean traction of a patch acts on waves as long as the table.
    let longest = [0, 1].map(|k| {
        let extent = 2.0 * surfaces.grid.cells[k] as f64 * size[k];
        std::f64::consts::TAU / extent
    });
    // A single row has no waves across it.
    let lowest = 0.5
        * match surfaces.grid.cells[1] {
            1 => longest[0],
            _ => longest[0].min(longest[1]),
        };
    surfaces.convolution.waves(|wave| {
        let k = [wave[0] / size[0], wave[1] / size[1]];
        let number = k[0].hypot(k[1]);
        let stiffness = |compliance: f64| {
            let waves = compliance / number.max(lowest);
            1.0 / (waves + surfaces.layer)
        };
        let (along, across) = (stiffness(along), stiffness(across));
        let [x, y] = match number > 0.0 {
            true => k.map(|k| k / number),
            false => [std::f64::consts::FRAC_1_SQRT_2; 2],
        };
        let odd = match number > 0.0 {
            true => (along - across) * x * y,
            false => 0.0,
        };
        [
            along * x * x + across * y * y,
            along * y * y + across * x * x,
            odd,
        ]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Displacements and slips of unlike bodies with a layer between them are sums over the cells,
    /// whichever was asked for before.
    #[test]
    fn displacements_are_sums_over_cells() {
        let body = |young, poisson| Elasticity {
            young,
            poisson,
            density: 7800.0,
        };
        let grid = CellGrid {
            from: [0.0; 2],
            size: [1e-4, 2e-4],
            cells: [7, 4],
        };
        let bodies = [body(210e9, 0.3), body(70e9, 0.2)];
        let layer = 1e-15;
        let surfaces = Surfaces::new(grid, bodies, layer);
        let value = |c: usize| [(3.0 * c as f64).sin(), (5.0 * c as f64).cos()];
        let traction: Field = (0..grid.len()).map(value).collect();
        let pressure: Vec<f64> = traction.iter().map(|v| 1.0 + v[0]).collect();
        // Of a component of the displacement at a cell, or one cell upstream of it.
        let sum = |at: usize, a: usize, ahead: usize, by: &dyn Fn(usize) -> [f64; 3]| -> f64 {
            let loads = (0..grid.len()).map(|load| {
                let [[i, j], [k, l]] = [at, load].map(|c| grid.place(c));
                let place = [(i + ahead) as f64 - k as f64, j as f64 - l as f64];
                let mut u = of_cell(&grid, &bodies, place);
                if place == [0.0; 2] {
                    (0..2).for_each(|b| u[b][b] += layer);
                }
                (0..3).map(|b| u[a][b] * by(load)[b]).sum::<f64>()
            });
            loads.sum()
        };
        let by_traction = |c: usize| [traction[c][0], traction[c][1], 0.0];
        let by_pressure = |c: usize| [0.0, 0.0, pressure[c]];
        let creepage = Motion::Steady(crate::motion::Creepage::default());
        for _ in 0..2 {
            let moved = [false, true].map(|upstream| surfaces.displacement(&traction, upstream));
            let shift = surfaces.slip(Passage::Shift).by(&traction);
            let steady = surfaces.slip(Passage::Steady).by(&traction);
            let opened = surfaces.normal_by_traction(&traction);
            let pressed = surfaces.normal(&pressure);
            let slipped = surfaces.slip_by_pressure(&pressure, &creepage);
            for at in 0..grid.len() {
                let near = |found: f64, wanted: f64| {
                    let largest = surfaces.own_compliance() * 10.0;
                    assert!(
                        (found - wanted).abs() < 1e-12 * largest,
                        "{at}: {found:e} {wanted:e}"
                    );
                };
                for a in 0..2 {
                    let [here, there] = [0, 1].map(|ahead| sum(at, a, ahead, &by_traction));
                    near(moved[0][at][a], here);
                    near(moved[1][at][a], there);
                    near(shift[at][a], here);
                    near(steady[at][a], here - there);
                    let [here, there] = [0, 1].map(|ahead| sum(at, a, ahead, &by_pressure));
                    near(slipped[at][a], here - there);
                }
                near(opened[at], sum(at, 2, 0, &by_traction));
                near(pressed[at], sum(at, 2, 0, &by_pressure));
            }
        }
        let own = surfaces.slip(Passage::Steady).own;
        let next = surfaces.moved([1.0, 0.0])[0];
        assert!((own - (surfaces.own_compliance() - next)).abs() < 1e-12 * own);
    }
}
