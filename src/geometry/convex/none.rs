//! No convex cores: three dimensions have none yet.

use super::{Core, Gauge, Meeting};
use crate::geometry::shape::Surface;
use crate::geometry::space::{Solid, Space};

type V = <Solid as Space>::Vector;

/// A core that no body can have.
#[derive(Clone, Copy, Debug)]
pub enum NoCore {}

impl Core<Solid> for NoCore {
    fn turned(&self, _: &<Solid as Space>::Rotation) -> Self {
        match *self {}
    }

    fn meet(&self, _: &Self, _: &V, _: [f64; 2], _: &Gauge, _: &mut Vec<Meeting<V>>) {
        match *self {}
    }

    fn meet_ball(&self, _: &V, _: f64, _: f64) -> Meeting<V> {
        match *self {}
    }

    fn meet_surface(
        &self,
        _: &dyn Surface<Solid>,
        _: &V,
        _: f64,
        _: &Gauge,
        _: &mut Vec<Meeting<V>>,
    ) {
        match *self {}
    }

    fn outline(&self, _: f64) -> Vec<V> {
        match *self {}
    }
}
