//! Periodic boundaries along the axes.

use super::space::VectorLike;

/// Lengths of the periodic cell; an axis without period has none. Positions are never wrapped in the
/// state (paths stay continuous): differences are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Periodic {
    /// Period of each axis (m).
    pub period: [Option<f64>; 3],
}

impl Periodic {
    /// The shortest of the images of a difference of positions.
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

    /// The image of a position in the cell that begins at zero.
    pub fn wrapped<V: VectorLike>(&self, position: V) -> V {
        let mut x = position;
        for k in 0..V::N {
            if let Some(period) = self.period[k] {
                x[k] -= period * (x[k] / period).floor();
            }
        }
        x
    }

    /// Whether any axis has a period.
    pub fn any(&self) -> bool {
        self.period.iter().any(Option::is_some)
    }
}
