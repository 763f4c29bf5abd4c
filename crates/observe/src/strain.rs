//! Local shear strain of the grains since a reference time, from the motion of their neighbours at
//! that time.
//!
//! The deformation gradient F of a grain minimises the sum of |x - F X|^2 over its neighbours,
//! where X and x are the vectors to a neighbour at the reference time and now (M. L. Falk, J. S.
//! Langer, Phys. Rev. E 57 (1998) 7192). Its largest and smallest singular values a and b give the
//! shear g = (a - b)/sqrt(a b): the amount of simple shear that has the same ratio of stretches, at
//! finite strain. Rotation and dilation do not contribute.

use super::picture::{Picture, PictureContent};
use super::statistics::Column;
use crate::observer::Observer;
use fretwork_core::encoding::{EncodingError, decode, encode};
use fretwork_core::geometry::grid::{Balls, pairs};
use fretwork_core::view::RunView;
use nalgebra::{DMatrix, Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// A neighbour: its index among the grains' balls, and the vector to it at the reference time (m).
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Neighbour {
    ball: u32,
    vector: Vector3<f64>,
    /// Periodic shift of the difference of positions (m).
    image: Vector3<f64>,
}

/// The neighbours of each ball at the reference time.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Strain {
    /// Number of dimensions.
    dimension: usize,
    around: Vec<Vec<Neighbour>>,
}

impl Strain {
    /// Uses the current state as reference. Neighbours of a grain are those with a gap below a mean
    /// diameter: two shells, so that no single neighbour dominates.
    pub fn new(run: &dyn RunView) -> Self {
        let balls = run.balls();
        let centres: Vec<Vector3<f64>> = balls.iter().map(|b| b.centre.into()).collect();
        let radii: Vec<f64> = balls.iter().map(|b| b.radius).collect();
        let grain = run.grain_flags();
        let counts = |b: u32| grain[balls[b as usize].body as usize];
        let grains = balls.iter().filter(|b| grain[b.body as usize]);
        let (sum, n) = grains.fold((0.0, 0.0), |(sum, n), b| (sum + 2.0 * b.radius, n + 1.0));
        let reach = if n > 0.0 { sum / n } else { 0.0 };
        let periodic = run.periodic();
        let mut around = vec![Vec::new(); balls.len()];
        let all = Balls {
            centres: &centres,
            radii: &radii,
            reach,
            periodic,
        };
        for (a, b) in pairs(&all, false, |a, b| counts(a) && counts(b)) {
            let apart = centres[b as usize] - centres[a as usize];
            let vector = periodic.shortest(apart);
            let image = vector - apart;
            let one = |ball, sign: f64| Neighbour {
                ball,
                vector: vector * sign,
                image: image * sign,
            };
            around[a as usize].push(one(b, 1.0));
            around[b as usize].push(one(a, -1.0));
        }
        let dimension = run.dimension();
        Self { dimension, around }
    }

    /// Returns the shear of each ball since the reference time; NaN for balls of first bodies, and
    /// if the neighbours do not span the space.
    pub fn shear(&self, run: &dyn RunView) -> Vec<f64> {
        let balls = run.balls().into_iter();
        let now: Vec<Vector3<f64>> = balls.map(|b| b.centre.into()).collect();
        let all = self.around.iter().enumerate();
        let of = |(a, around): (usize, &Vec<Neighbour>)| {
            let pairs = around
                .iter()
                .map(|n| (n.vector, now[n.ball as usize] - now[a] + n.image));
            shear(self.dimension, pairs)
        };
        all.map(of).collect()
    }
}

/// Observes the local shear since the second phase began, or the start: a column of the grains, and
/// a picture.
#[derive(Clone, Debug)]
pub struct LocalShear {
    strain: Strain,
    /// Shear with the darkest colour.
    top: f64,
}

impl LocalShear {
    /// Name of its pictures.
    pub const PICTURE: &str = "shear";

    /// Creates the observer from the current state, with the shear that has the darkest colour.
    pub fn new(run: &dyn RunView, top: f64) -> Self {
        Self {
            strain: Strain::new(run),
            top,
        }
    }
}

impl Observer for LocalShear {
    fn name(&self) -> String {
        "local shear".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn begin(&mut self, run: &dyn RunView) {
        self.strain = Strain::new(run);
    }

    fn grain_columns(&self) -> Vec<Column> {
        let doc =
            "local shear since the second phase began, or the start; not a number on first bodies";
        vec![Column::new("shear", "", doc)]
    }

    fn grain_values(&self, run: &dyn RunView) -> Vec<Vec<f64>> {
        vec![self.strain.shear(run)]
    }

    fn pictures(&self, run: &dyn RunView) -> Vec<Picture> {
        vec![Picture {
            name: Self::PICTURE,
            shows: PictureContent::Values {
                values: self.strain.shear(run),
                label: "local shear",
                top: self.top,
            },
        }]
    }

    fn picture_names(&self) -> Vec<&'static str> {
        vec![Self::PICTURE]
    }

    fn save(&self) -> Result<Vec<u8>, EncodingError> {
        encode(&self.strain)
    }

    fn restore(&mut self, from: &[u8]) -> Result<(), EncodingError> {
        self.strain = decode(from)?;
        Ok(())
    }
}

/// Returns the shear of the gradient that maps the first of each pair of vectors to the second.
fn shear(dimension: usize, pairs: impl Iterator<Item = (Vector3<f64>, Vector3<f64>)>) -> f64 {
    let (mut moment, mut moved) = (Matrix3::zeros(), Matrix3::zeros());
    for (before, after) in pairs {
        for i in 0..dimension {
            for j in 0..dimension {
                moment[(i, j)] += before[i] * before[j];
                moved[(i, j)] += after[i] * before[j];
            }
        }
    }
    let square = |m: &Matrix3<f64>| DMatrix::from_fn(dimension, dimension, |i, j| m[(i, j)]);
    let (moment, moved) = (square(&moment), square(&moved));
    // Neighbours on a line do not determine the gradient across it.
    let spread = moment.clone().symmetric_eigenvalues();
    if spread.min() <= 1e-3 * spread.max() {
        return f64::NAN;
    }
    let Some(inverse) = moment.try_inverse() else {
        return f64::NAN;
    };
    let stretches = (moved * inverse).singular_values();
    let (a, b) = (stretches.max(), stretches.min());
    if b > 0.0 {
        (a - b) / (a * b).sqrt()
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;

    /// A simple shear, rotated and dilated, gives its own amount at small and large strain, and a
    /// pure rotation gives zero.
    #[test]
    fn simple_shear_has_its_amount() {
        let star: Vec<Vector3<f64>> = (0..7)
            .map(|k| {
                let (sin, cos) = (0.9 * f64::from(k)).sin_cos();
                Vector3::new(cos, sin, 0.0) * (1.0 + 0.1 * f64::from(k))
            })
            .collect();
        for amount in [0.0, 1e-3, 0.4, 3.0] {
            let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), 0.7).matrix() * 1.2;
            let f = turn * Matrix3::new(1.0, amount, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
            let got = shear(2, star.iter().map(|x| (*x, f * x)));
            assert!((got - amount).abs() < 1e-9, "{got} in place of {amount}");
        }
        let ball: Vec<Vector3<f64>> = (0..20)
            .map(|k| {
                let t = f64::from(k);
                Vector3::new(
                    (1.3 * t).sin(),
                    (2.1 * t).cos(),
                    (0.7 * t).sin() * (1.9 * t).cos(),
                )
            })
            .collect();
        let turn = Rotation3::from_euler_angles(0.3, -1.0, 2.0).matrix() * 0.8;
        let f = turn * Matrix3::new(1.0, 0.0, 0.6, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
        let got = shear(3, ball.iter().map(|x| (*x, f * x)));
        assert!((got - 0.6).abs() < 1e-9, "{got}");
    }

    #[test]
    fn neighbours_on_a_line_give_nothing() {
        let line = [1.0, -1.0, 2.0].map(|x| Vector3::new(x, 0.5 * x, 0.0));
        assert!(shear(2, line.iter().map(|x| (*x, *x))).is_nan());
        assert!(shear(2, std::iter::empty()).is_nan());
    }
}
