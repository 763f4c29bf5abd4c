//! Periodic boundaries along the axes.

use super::space::VectorLike;

/// Lengths of the periodic cell; `None` for axes without a period. Positions in the state are never
/// wrapped (paths stay continuous); only differences are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Periodic {
    /// Period of each axis (m).
    pub period: [Option<f64>; 3],
}

impl Periodic {
    /// Returns the shortest periodic image of a difference of positions.
    #[inline(always)]
    pub fn shortest<V: VectorLike>(&self, difference: V) -> V {
        let mut d = difference;
        for k in 0..V::N {
            if let Some(period) = self.period[k] {
                d[k] -= period * (d[k] / period).round();
            }
        }
        d
    }

    /// Returns the image of a position in the cell that starts at zero.
    pub fn wrapped<V: VectorLike>(&self, position: V) -> V {
        let mut x = position;
        for k in 0..V::N {
            if let Some(period) = self.period[k] {
                x[k] -= period * (x[k] / period).floor();
            }
        }
        x
    }

    /// Returns whether any axis has a period.
    pub fn any(&self) -> bool {
        self.period.iter().any(Option::is_some)
    }
}
