//! Temperature of the surfaces of a patch that rolls fast: heat flows into the depth alone, and
//! each row of cells has the temperature of a half-space under a flux that passes over it (M. Ertz,
//! K. Knothe, Wear 253, 2002).

use fretwork_elastic::half_space::CellGrid;
use fretwork_math::diffusion::Conductor;
use std::f64::consts::PI;

/// Thermal properties of both bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thermal {
    /// Conductivity and heat capacity.
    pub bodies: [Conductor; 2],
    /// Temperatures far from the patch (K, or °C).
    pub bulk: [f64; 2],
}

/// The temperature of a cell by the fluxes of its row.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// Temperature without heat of friction (K, or °C).
    pub mixed: f64,
    /// Rise by a flux in the cell itself, in the one before it upstream, and so on (K m²/W).
    pub weights: Vec<f64>,
}

impl Thermal {
    /// Returns the temperature that both surfaces have in each cell under fluxes of heat (W/m²),
    /// where material passes at a speed (m/s) from the last cell of a row to its first.
    ///
    /// T = (e1 T1 + e2 T2)/(e1 + e2) + 1/((e1 + e2) sqrt(pi V)) int q(x')/sqrt(x' - x) dx'
    pub fn temperature(&self, grid: &CellGrid, flux: &[f64], speed: f64) -> Vec<f64> {
        let [columns, _] = grid.cells;
        let Response { mixed, weights } = self.response(grid, speed);
        let mut out = Vec::with_capacity(flux.len());
        for row in flux.chunks(columns) {
            for i in 0..columns {
                let upstream = row[i..].iter().zip(&weights);
                out.push(mixed + upstream.map(|(q, w)| q * w).sum::<f64>());
            }
        }
        out
    }

    /// Returns how the temperature of a cell follows from the fluxes of its row at a speed (m/s).
    pub fn response(&self, grid: &CellGrid, speed: f64) -> Response {
        let effusivity = self.bodies.map(|b| b.effusivity());
        let sum = effusivity[0] + effusivity[1];
        // The integral of 1/sqrt over a cell at a distance in cells upstream of the middle of this.
        let root = |cells: f64| (cells.max(0.0) * grid.size[0]).sqrt();
        let scale = 2.0 / (sum * (PI * speed).sqrt());
        let weight = |d: usize| scale * (root(d as f64 + 0.5) - root(d as f64 - 0.5));
        Response {
            mixed: (effusivity[0] * self.bulk[0] + effusivity[1] * self.bulk[1]) / sum,
            weights: (0..grid.cells[0]).map(weight).collect(),
        }
    }

    /// Returns the Peclet number V a/(2 kappa) of the better conductor for half of the length of a
    /// patch (m): heat flows into the depth alone if it is above some 10.
    pub fn peclet(&self, half: f64, speed: f64) -> f64 {
        let diffusivity = self.bodies.map(|b| b.diffusivity());
        0.5 * speed * half / diffusivity[0].max(diffusivity[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEEL: Conductor = Conductor {
        conductivity: 50.0,
        capacity: 450.0 * 7850.0,
    };

    fn row(cells: usize, half: f64) -> CellGrid {
        CellGrid {
            from: [-half, 0.0],
            size: [2.0 * half / cells as f64, 1e-3],
            cells: [cells, 1],
        }
    }

    fn hottest(cells: usize, bulk: [f64; 2]) -> f64 {
        // The case `ertz_temperature` of the program CONTACT (commit d431cdb): a 5.88 mm, b 10.54
        // mm, 100 kN, mu 0.3, slip of 1 m/s at 30 m/s, in the middle row.
        let (a, b) = (5.88e-3, 10.54e-3);
        let largest = 0.3 * 1.5 * 100e3 / (PI * a * b);
        let grid = row(cells, a);
        let flux: Vec<f64> = (0..cells)
            .map(|c| largest * (1.0 - (grid.middle(c)[0] / a).powi(2)).max(0.0).sqrt())
            .collect();
        let thermal = Thermal {
            bodies: [STEEL; 2],
            bulk,
        };
        let found = thermal.temperature(&grid, &flux, 30.0);
        found.into_iter().fold(0.0, f64::max)
    }

    /// The largest rise under a semi-elliptic flux is 150.3 K, from the maximum over x of the
    /// integral of sqrt(1 - s²)/sqrt(s - x) from x to 1. (CONTACT gives 166.8 K by a rule of its
    /// own for the integral.)
    #[test]
    fn a_sliding_ellipse_has_the_temperature_of_the_closed_form() {
        let integral = |x: f64| {
            // s = x + (1 - x) t².
            let n = 20_000;
            let part = |k: usize| {
                let t = (k as f64 + 0.5) / n as f64;
                let s = x + (1.0 - x) * t * t;
                2.0 * (1.0 - x).sqrt() * (1.0 - s * s).max(0.0).sqrt() / n as f64
            };
            (0..n).map(part).sum::<f64>()
        };
        let most = (0..200)
            .map(|k| integral(-1.0 + 0.005 * f64::from(k)))
            .fold(0.0, f64::max);
        let largest = 0.3 * 1.5 * 100e3 / (PI * 5.88e-3 * 10.54e-3);
        let closed = 0.5 * largest / STEEL.effusivity() * (5.88e-3 / 30.0 / PI).sqrt() * most;
        assert!((closed / 150.3 - 1.0).abs() < 2e-3, "{closed} {most}");
        for (cells, by) in [(20, 0.02), (60, 5e-3), (400, 1e-3)] {
            let found = hottest(cells, [0.0; 2]);
            assert!(
                (found / closed - 1.0).abs() < by,
                "{cells}: {found} {closed}"
            );
        }
    }

    /// Bodies of 0 and 150 K meet at their mean, 75 K, which the heat of friction adds to.
    #[test]
    fn bodies_of_other_temperatures_meet_at_their_mean() {
        let rise = hottest(60, [0.0; 2]);
        assert!((hottest(60, [0.0, 150.0]) - 75.0 - rise).abs() < 1e-9);
    }

    /// A uniform flux over a band: Jaeger's closed form at its end.
    #[test]
    fn a_band_has_jaegers_temperature() {
        let (half, speed, flux) = (2e-3, 20.0, 1e8);
        let grid = row(2000, half);
        let thermal = Thermal {
            bodies: [STEEL; 2],
            bulk: [20.0; 2],
        };
        let found = thermal.temperature(&grid, &vec![flux; 2000], speed)[0] - 20.0;
        let expected = STEEL.band(0.5 * flux, half, speed);
        assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
    }
}
