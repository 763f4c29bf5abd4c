//! Dimension-independent formulation for 2D and 3D.
//!
//! Time stepping, detection and solvers are generic over [`Space`]; each dimension is compiled to
//! separate code without data of the other.

pub use super::algebra::{MatrixLike, VectorLike, Vectors, greatest, least};
use super::lane_space::LaneSpace;
use nalgebra::{Matrix1, Matrix2, Matrix3, Vector1, Vector2, Vector3};
use serde::{Serialize, de::DeserializeOwned};
use std::fmt::Debug;

/// A dimension of space.
pub trait Space: LaneSpace + Clone + Default + Send + Sync {
    /// Number of translations: 2 or 3.
    const D: usize;
    /// Positions, velocities, impulses.
    type Vector: VectorLike;
    /// Angular velocities and moments: one component in 2D, three in 3D.
    type Spin: VectorLike;
    /// Inertia tensor: one number in 2D.
    type Tensor: MatrixLike<V = Self::Spin> + Serialize + DeserializeOwned;
    /// Contact blocks of the Delassus operator.
    type Matrix: MatrixLike<V = Self::Vector>;
    /// Tangential part of a contact vector: one number along t1 in 2D; in 3D a vector normal to n,
    /// so that no tangent frame is needed.
    type Tangent: VectorLike;
    /// Orientation of a body: an angle in 2D, a unit quaternion in 3D.
    type Rotation: Copy
        + Debug
        + Default
        + Send
        + Sync
        + PartialEq
        + Serialize
        + DeserializeOwned
        + 'static;
    /// Cores of convex pieces.
    type Core: super::convex::Core<Self>;

    /// Returns the velocity of a point at `arm` from the centre of a rotating body: omega x arm.
    fn spin_velocity(spin: &Self::Spin, arm: &Self::Vector) -> Self::Vector;
    /// Returns the moment of a force at `arm`: arm x force.
    fn moment(arm: &Self::Vector, force: &Self::Vector) -> Self::Spin;
    /// Returns the matrix S with S p = (I^-1 moment(arm, p)) x arm.
    fn rotation_block(arm: &Self::Vector, inverse_inertia: &Self::Tensor) -> Self::Matrix;
    /// Returns the moment of inertia of a unit mass at `arm`.
    fn steiner(arm: &Self::Vector) -> Self::Tensor;
    /// Transforms a tensor from body axes to world axes.
    fn turned_tensor(rotation: &Self::Rotation, tensor: &Self::Tensor) -> Self::Tensor;
    /// Returns `rotation` after a rotation in the body's own axes, by the Cayley map: `half` is the
    /// axis times tan(angle/2).
    fn turned_within(rotation: &Self::Rotation, half: &Self::Spin) -> Self::Rotation;
    /// Transforms a spin from body axes to world axes.
    fn rotate_spin(rotation: &Self::Rotation, spin: &Self::Spin) -> Self::Spin;
    /// Transforms a spin from world axes to body axes.
    fn unrotate_spin(rotation: &Self::Rotation, spin: &Self::Spin) -> Self::Spin;
    /// Returns the vector product of two spins; zero in 2D.
    fn spin_cross(a: &Self::Spin, b: &Self::Spin) -> Self::Spin;
    /// Returns the tangential part of a vector at a contact of unit normal `n`.
    fn tangential(n: &Self::Vector, v: &Self::Vector) -> Self::Tangent;
    /// Returns the vector of a tangential part.
    fn tangent_vector(n: &Self::Vector, t: &Self::Tangent) -> Self::Vector;
    /// Returns omega x n as a tangential part.
    fn roll(spin: &Self::Spin, n: &Self::Vector) -> Self::Tangent;
    /// Returns n x p_t as a spin.
    fn twist(n: &Self::Vector, t: &Self::Tangent) -> Self::Spin;
    /// Rotates a tangential part with its contact: by the smallest rotation between the normals,
    /// then by an angle about the new one. In 2D it rotates with its frame.
    fn transport(
        from: &Self::Vector,
        to: &Self::Vector,
        angle: f64,
        t: &Self::Tangent,
    ) -> Self::Tangent;
    /// Rotates a spin like [`Space::transport`].
    fn transport_spin(
        from: &Self::Vector,
        to: &Self::Vector,
        angle: f64,
        w: &Self::Spin,
    ) -> Self::Spin;
    /// Returns a tangential part from its components along [`Space::tangents`].
    fn from_components(n: &Self::Vector, t1: f64, t2: f64) -> Self::Tangent;
    /// Returns the components of a tangential part along [`Space::tangents`].
    fn components(n: &Self::Vector, t: &Self::Tangent) -> [f64; 2];
    /// Returns the identity rotation.
    fn identity() -> Self::Rotation;
    /// Rotates by the rotation vector `angle` (rad).
    fn turned(rotation: &Self::Rotation, angle: &Self::Spin) -> Self::Rotation;
    /// Transforms a vector from the body's frame to the world.
    fn rotate(rotation: &Self::Rotation, v: &Self::Vector) -> Self::Vector;
    /// Transforms a vector from the world to the body's frame.
    fn unrotate(rotation: &Self::Rotation, v: &Self::Vector) -> Self::Vector;
    /// Returns the inverse rotation.
    fn inverse(rotation: &Self::Rotation) -> Self::Rotation;
    /// Returns the rotation as numbers: angle, or quaternion (w, x, y, z).
    fn rotation_numbers(rotation: &Self::Rotation) -> [f64; 4];
    /// Returns the rotation with exactly these numbers; `None` if they are not those of a rotation.
    fn rotation_from(numbers: &[f64; 4]) -> Option<Self::Rotation>;
    /// Returns two tangents that form a right-handed frame with `n`; in 2D the first is n rotated
    /// by +90 degrees and the second is zero.
    fn tangents(n: &Self::Vector) -> [Self::Vector; 2];
    /// Splits a spin into twist about `n` and the rest, bending. In 2D all is bending.
    fn split_spin(n: &Self::Vector, spin: &Self::Spin) -> (f64, Self::Spin);
    /// Returns the spin of a twist about `n`.
    fn spin_about(n: &Self::Vector, twist: f64) -> Self::Spin;
    /// Returns the components of a spin along n and [`Space::tangents`]; in 2D the second contains
    /// the spin.
    fn spin_components(n: &Self::Vector, spin: &Self::Spin) -> [f64; 3];
    /// Returns a spin from its components.
    fn spin_from(n: &Self::Vector, components: [f64; 3]) -> Self::Spin;
    /// Returns the volume of a ball (in 2D the area of a disk times unit depth).
    fn ball_volume(radius: f64) -> f64;
    /// Returns the radius of the ball of a volume.
    fn ball_radius(volume: f64) -> f64 {
        (volume / Self::ball_volume(1.0)).powf(1.0 / Self::D as f64)
    }
    /// Returns the moment of inertia of a homogeneous ball divided by m r^2: 1/2 for a disk, 2/5
    /// for a sphere.
    const BALL_INERTIA: f64;
}

/// Returns the components of an angular velocity or a moment about world axes; in 2D only the third
/// is nonzero.
pub fn about_axes<S: Space>(spin: &S::Spin) -> [f64; 3] {
    match spin.padded() {
        [about_depth, ..] if S::D == 2 => [0.0, 0.0, about_depth],
        spin => spin,
    }
}

/// Returns the angular velocity or moment with these components about world axes; in 2D that about
/// the third.
pub fn spin_about<S: Space>(axes: &[f64; 3]) -> S::Spin {
    S::Spin::from_slice(&axes[3 - S::Spin::N..])
}

/// Returns the volume of a ball in a space of this dimension; see [`Space::ball_volume`].
pub fn ball_volume(dimension: usize, radius: f64) -> f64 {
    match dimension {
        2 => Dim2::ball_volume(radius),
        _ => Dim3::ball_volume(radius),
    }
}

/// The radius of the ball of a volume; see [`Space::ball_radius`].
pub fn ball_radius(dimension: usize, volume: f64) -> f64 {
    match dimension {
        2 => Dim2::ball_radius(volume),
        _ => Dim3::ball_radius(volume),
    }
}

/// Two dimensions; masses and forces are per metre of depth.
#[derive(Copy, Clone, Debug, Default)]
pub struct Dim2;
/// Three dimensions.
#[derive(Copy, Clone, Debug, Default)]
pub struct Dim3;

impl Space for Dim2 {
    const D: usize = 2;
    type Vector = Vector2<f64>;
    type Spin = Vector1<f64>;
    type Tensor = Matrix1<f64>;
    type Matrix = Matrix2<f64>;
    type Tangent = Vector1<f64>;
    type Rotation = f64;
    type Core = super::convex::polygon::Polygon;
    const BALL_INERTIA: f64 = 0.5;

    #[inline(always)]
    fn spin_velocity(spin: &Self::Spin, arm: &Self::Vector) -> Self::Vector {
        Vector2::new(-spin[0] * arm[1], spin[0] * arm[0])
    }
    #[inline(always)]
    fn moment(arm: &Self::Vector, force: &Self::Vector) -> Self::Spin {
        Vector1::new(arm[0] * force[1] - arm[1] * force[0])
    }
    fn rotation_block(arm: &Self::Vector, inverse_inertia: &Self::Tensor) -> Self::Matrix {
        let s = Vector2::new(-arm[1], arm[0]);
        s * s.transpose() * inverse_inertia[0]
    }
    fn steiner(arm: &Self::Vector) -> Self::Tensor {
        Matrix1::new(arm.norm_squared())
    }
    fn turned_tensor(_: &f64, tensor: &Self::Tensor) -> Self::Tensor {
        *tensor
    }
    fn turned_within(rotation: &f64, half: &Self::Spin) -> f64 {
        rotation + 2.0 * half[0].atan()
    }
    fn rotate_spin(_: &f64, spin: &Self::Spin) -> Self::Spin {
        *spin
    }
    fn unrotate_spin(_: &f64, spin: &Self::Spin) -> Self::Spin {
        *spin
    }
    fn spin_cross(_: &Self::Spin, _: &Self::Spin) -> Self::Spin {
        Vector1::zeros()
    }
    #[inline(always)]
    fn tangential(n: &Self::Vector, v: &Self::Vector) -> Self::Tangent {
        Vector1::new(n[0] * v[1] - n[1] * v[0])
    }
    #[inline(always)]
    fn tangent_vector(n: &Self::Vector, t: &Self::Tangent) -> Self::Vector {
        Vector2::new(-n[1] * t[0], n[0] * t[0])
    }
    #[inline(always)]
    fn roll(spin: &Self::Spin, _n: &Self::Vector) -> Self::Tangent {
        *spin
    }
    #[inline(always)]
    fn twist(_n: &Self::Vector, t: &Self::Tangent) -> Self::Spin {
        *t
    }
    #[inline(always)]
    fn transport(
        _from: &Self::Vector,
        _to: &Self::Vector,
        _: f64,
        t: &Self::Tangent,
    ) -> Self::Tangent {
        *t
    }
    fn transport_spin(
        _from: &Self::Vector,
        _to: &Self::Vector,
        _: f64,
        w: &Self::Spin,
    ) -> Self::Spin {
        *w
    }
    fn from_components(_n: &Self::Vector, t1: f64, _t2: f64) -> Self::Tangent {
        Vector1::new(t1)
    }
    #[inline]
    fn components(_n: &Self::Vector, t: &Self::Tangent) -> [f64; 2] {
        [t[0], 0.0]
    }
    fn identity() -> f64 {
        0.0
    }
    fn turned(rotation: &f64, angle: &Self::Spin) -> f64 {
        rotation + angle[0]
    }
    fn rotate(rotation: &f64, v: &Self::Vector) -> Self::Vector {
        let (s, c) = rotation.sin_cos();
        Vector2::new(c * v[0] - s * v[1], s * v[0] + c * v[1])
    }
    fn unrotate(rotation: &f64, v: &Self::Vector) -> Self::Vector {
        Self::rotate(&-rotation, v)
    }
    fn inverse(rotation: &f64) -> f64 {
        -rotation
    }
    fn rotation_numbers(rotation: &f64) -> [f64; 4] {
        [*rotation, 0.0, 0.0, 0.0]
    }
    fn rotation_from(numbers: &[f64; 4]) -> Option<f64> {
        numbers[0].is_finite().then_some(numbers[0])
    }
    #[inline(always)]
    fn tangents(n: &Self::Vector) -> [Self::Vector; 2] {
        [Vector2::new(-n[1], n[0]), Vector2::zeros()]
    }
    #[inline(always)]
    fn split_spin(_n: &Self::Vector, spin: &Self::Spin) -> (f64, Self::Spin) {
        (0.0, *spin)
    }
    #[inline(always)]
    fn spin_about(_n: &Self::Vector, _twist: f64) -> Self::Spin {
        Vector1::new(0.0)
    }
    fn spin_components(_n: &Self::Vector, spin: &Self::Spin) -> [f64; 3] {
        [0.0, spin[0], 0.0]
    }
    fn spin_from(_n: &Self::Vector, components: [f64; 3]) -> Self::Spin {
        Vector1::new(components[1])
    }
    fn ball_volume(radius: f64) -> f64 {
        std::f64::consts::PI * radius * radius
    }
}

impl Space for Dim3 {
    const D: usize = 3;
    type Vector = Vector3<f64>;
    type Spin = Vector3<f64>;
    type Tensor = Matrix3<f64>;
    type Matrix = Matrix3<f64>;
    type Tangent = Vector3<f64>;
    type Rotation = nalgebra::UnitQuaternion<f64>;
    type Core = super::convex::polyhedron::Polyhedron;
    const BALL_INERTIA: f64 = 0.4;

    #[inline(always)]
    fn spin_velocity(spin: &Self::Spin, arm: &Self::Vector) -> Self::Vector {
        spin.cross(arm)
    }
    #[inline(always)]
    fn moment(arm: &Self::Vector, force: &Self::Vector) -> Self::Spin {
        arm.cross(force)
    }
    fn rotation_block(arm: &Self::Vector, inverse_inertia: &Self::Tensor) -> Self::Matrix {
        let cross = arm.cross_matrix();
        -(cross * inverse_inertia * cross)
    }
    fn steiner(arm: &Self::Vector) -> Self::Tensor {
        Matrix3::identity() * arm.norm_squared() - arm * arm.transpose()
    }
    fn turned_tensor(rotation: &Self::Rotation, tensor: &Self::Tensor) -> Self::Tensor {
        let r = rotation.to_rotation_matrix();
        r * tensor * r.transpose()
    }
    fn turned_within(rotation: &Self::Rotation, half: &Self::Spin) -> Self::Rotation {
        let cayley = nalgebra::Quaternion::new(1.0, half[0], half[1], half[2]);
        let mut turned = rotation * nalgebra::UnitQuaternion::from_quaternion(cayley);
        turned.renormalize_fast();
        turned
    }
    fn rotate_spin(rotation: &Self::Rotation, spin: &Self::Spin) -> Self::Spin {
        rotation * spin
    }
    fn unrotate_spin(rotation: &Self::Rotation, spin: &Self::Spin) -> Self::Spin {
        rotation.inverse_transform_vector(spin)
    }
    fn spin_cross(a: &Self::Spin, b: &Self::Spin) -> Self::Spin {
        a.cross(b)
    }
    #[inline(always)]
    fn tangential(n: &Self::Vector, v: &Self::Vector) -> Self::Tangent {
        v - n * n.dot(v)
    }
    #[inline(always)]
    fn tangent_vector(_n: &Self::Vector, t: &Self::Tangent) -> Self::Vector {
        *t
    }
    #[inline(always)]
    fn roll(spin: &Self::Spin, n: &Self::Vector) -> Self::Tangent {
        spin.cross(n)
    }
    #[inline(always)]
    fn twist(n: &Self::Vector, t: &Self::Tangent) -> Self::Spin {
        n.cross(t)
    }
    fn transport(
        from: &Self::Vector,
        to: &Self::Vector,
        angle: f64,
        t: &Self::Tangent,
    ) -> Self::Tangent {
        // Rounding leaves a normal component, which a tangential part must not have.
        let turned = Self::transport_spin(from, to, angle, t);
        turned - to * to.dot(&turned)
    }
    fn transport_spin(
        from: &Self::Vector,
        to: &Self::Vector,
        angle: f64,
        w: &Self::Spin,
    ) -> Self::Spin {
        if *w == Vector3::zeros() {
            return *w;
        }
        let least = nalgebra::UnitQuaternion::rotation_between(from, to)
            .unwrap_or_else(nalgebra::UnitQuaternion::identity);
        let about = nalgebra::UnitQuaternion::from_scaled_axis(to * angle);
        about * (least * w)
    }
    fn from_components(n: &Self::Vector, t1: f64, t2: f64) -> Self::Tangent {
        let [e1, e2] = Self::tangents(n);
        e1 * t1 + e2 * t2
    }
    #[inline]
    fn components(n: &Self::Vector, t: &Self::Tangent) -> [f64; 2] {
        let [e1, e2] = Self::tangents(n);
        [e1.dot(t), e2.dot(t)]
    }
    fn identity() -> Self::Rotation {
        nalgebra::UnitQuaternion::identity()
    }
    fn turned(rotation: &Self::Rotation, angle: &Self::Spin) -> Self::Rotation {
        let mut turned = from_scaled_axis(angle) * rotation;
        // Rounding changes the norm with a systematic sign.
        turned.renormalize_fast();
        turned
    }
    fn rotate(rotation: &Self::Rotation, v: &Self::Vector) -> Self::Vector {
        rotation * v
    }
    fn unrotate(rotation: &Self::Rotation, v: &Self::Vector) -> Self::Vector {
        rotation.inverse_transform_vector(v)
    }
    fn inverse(rotation: &Self::Rotation) -> Self::Rotation {
        rotation.inverse()
    }
    fn rotation_numbers(rotation: &Self::Rotation) -> [f64; 4] {
        [rotation.w, rotation.i, rotation.j, rotation.k]
    }
    fn rotation_from(numbers: &[f64; 4]) -> Option<Self::Rotation> {
        let [w, x, y, z] = *numbers;
        let quaternion = nalgebra::Quaternion::new(w, x, y, z);
        // NaN fails this test.
        let unit = (quaternion.norm() - 1.0).abs() < 1e-6;
        unit.then(|| nalgebra::UnitQuaternion::new_unchecked(quaternion))
    }
    fn tangents(n: &Self::Vector) -> [Self::Vector; 2] {
        // Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017.
        let sign = 1.0_f64.copysign(n[2]);
        let a = -1.0 / (sign + n[2]);
        let b = n[0] * n[1] * a;
        [
            Vector3::new(1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]),
            Vector3::new(b, sign + n[1] * n[1] * a, -n[1]),
        ]
    }
    #[inline(always)]
    fn split_spin(n: &Self::Vector, spin: &Self::Spin) -> (f64, Self::Spin) {
        let twist = n.dot(spin);
        (twist, spin - n * twist)
    }
    #[inline(always)]
    fn spin_about(n: &Self::Vector, twist: f64) -> Self::Spin {
        n * twist
    }
    fn spin_components(n: &Self::Vector, spin: &Self::Spin) -> [f64; 3] {
        let [e1, e2] = Self::tangents(n);
        [n.dot(spin), e1.dot(spin), e2.dot(spin)]
    }
    fn spin_from(n: &Self::Vector, components: [f64; 3]) -> Self::Spin {
        let [e1, e2] = Self::tangents(n);
        n * components[0] + e1 * components[1] + e2 * components[2]
    }
    fn ball_volume(radius: f64) -> f64 {
        4.0 / 3.0 * std::f64::consts::PI * radius.powi(3)
    }
}

/// Returns the rotation by a rotation vector (rad). Rotations of a step are small: sine and cosine
/// use series that are exact to round-off there.
#[inline]
fn from_scaled_axis(angle: &Vector3<f64>) -> nalgebra::UnitQuaternion<f64> {
    /// Squared half angle below which the next terms are below round-off.
    const MAX_SERIES_ARGUMENT: f64 = 1e-6;
    let squared = 0.25 * angle.norm_squared();
    if squared >= MAX_SERIES_ARGUMENT {
        return nalgebra::UnitQuaternion::from_scaled_axis(*angle);
    }
    let cosine = 1.0 - squared * (0.5 - squared / 24.0);
    let half_sinc = 0.5 - squared * (1.0 / 12.0 - squared / 240.0);
    let v = angle * half_sinc;
    nalgebra::UnitQuaternion::new_unchecked(nalgebra::Quaternion::new(cosine, v.x, v.y, v.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_rotations_are_those_of_sine_and_cosine() {
        for size in [0.0, 1e-300, 1e-9, 1e-5, 1e-3, 1.9e-3, 2.1e-3, 0.3] {
            let angle = Vector3::new(0.6, -0.48, 0.64) * size;
            let (ours, exact) = (
                from_scaled_axis(&angle),
                nalgebra::UnitQuaternion::from_scaled_axis(angle),
            );
            let difference = ours.into_inner() - exact.into_inner();
            assert!(difference.norm() < 2e-16, "{size}");
            assert!((ours.imag() - exact.imag()).norm() <= 2e-16 * size);
        }
    }

    #[test]
    fn moment_is_the_transpose_of_sweep() {
        let (arm, f, w) = (
            Vector3::new(1.0, -2.0, 0.5),
            Vector3::new(0.3, 0.7, -1.1),
            Vector3::new(-0.2, 0.4, 0.9),
        );
        let power = Dim3::spin_velocity(&w, &arm).dot(&f);
        assert!((power - w.dot(&Dim3::moment(&arm, &f))).abs() < 1e-14);
        let inverse = Matrix3::new(2.0, 0.3, -0.1, 0.3, 1.0, 0.2, -0.1, 0.2, 0.7);
        let block = Dim3::spin_velocity(&(inverse * Dim3::moment(&arm, &f)), &arm);
        assert!((block - Dim3::rotation_block(&arm, &inverse) * f).norm() < 1e-14);
        let (arm, f, w) = (
            Vector2::new(1.0, -2.0),
            Vector2::new(0.3, 0.7),
            Vector1::new(0.6),
        );
        let power = Dim2::spin_velocity(&w, &arm).dot(&f);
        assert!((power - w[0] * Dim2::moment(&arm, &f)[0]).abs() < 1e-14);
        let inverse = Matrix1::new(0.3);
        let block = Dim2::spin_velocity(&(inverse * Dim2::moment(&arm, &f)), &arm);
        assert!((block - Dim2::rotation_block(&arm, &inverse) * f).norm() < 1e-14);
    }

    #[test]
    fn frames_are_orthonormal() {
        for n in [
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
            [0.6, 0.0, -0.8],
            [1.0, 0.0, 0.0],
        ] {
            let n = Vector3::from(n);
            let [t1, t2] = Dim3::tangents(&n);
            assert!((n.cross(&t1) - t2).norm() < 1e-14 && t1.dot(&n).abs() < 1e-14);
        }
    }
}
