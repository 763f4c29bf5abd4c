//! Tangents, rotations and patches of elements.

use super::*;
use crate::generate::{block, even};
use crate::model::assemble;
use fretwork_core::geometry::space::{Dim2, Dim3};

const RUBBER: Elasticity = Elasticity {
    young: 1e6,
    poisson: 0.35,
    density: 1000.0,
};
const BOTH: [Strain; 2] = [Strain::Corotational, Strain::NeoHookean];

struct Sample<S: Space> {
    mesh: Mesh<S>,
    freedoms: Freedoms<S>,
    stiffness: Sparse,
    large: LargeStrain<S>,
}

fn sample<S: Space>(strain: Strain, damping: f64) -> Sample<S> {
    let lines = [even(0.0, 1.0, 2), even(0.0, 1.5, 2), even(0.0, 1.2, 2)];
    let mesh = block::<S>(&lines[..S::D]).unwrap();
    let freedoms = Freedoms::new(&mesh, &[]).unwrap();
    let (_, stiffness) = assemble(&mesh, &RUBBER, &freedoms);
    let large = LargeStrain::new(strain, &RUBBER, damping, &mesh, &freedoms, &stiffness);
    Sample {
        large: large.unwrap(),
        mesh,
        freedoms,
        stiffness,
    }
}

impl<S: Space> Sample<S> {
    /// Returns displacements as a function of the unloaded position.
    fn displaced(&self, to: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Vec<f64> {
        let mut q = vec![0.0; self.freedoms.total()];
        for (p, x) in self.mesh.points().iter().enumerate() {
            let u = to(Vector3::from(x.padded()));
            for axis in 0..S::D {
                q[self.freedoms.of(p as u32, axis)] = u[axis] - x[axis];
            }
        }
        q
    }
}

/// Returns some smooth displacement of a given size.
fn waves(size: f64, phase: f64) -> impl Fn(Vector3<f64>) -> Vector3<f64> {
    move |x| {
        x + Vector3::new(
            (1.3 * x.y + 0.4 * x.z + phase).sin() + 0.3 * x.x,
            (0.9 * x.x - 0.5 * x.z + 2.0 * phase).cos(),
            (0.7 * x.x + 0.8 * x.y - phase).sin(),
        ) * size
    }
}

fn turned(angle: f64) -> impl Fn(Vector3<f64>) -> Vector3<f64> {
    let rotation = nalgebra::Rotation3::new(Vector3::z() * angle);
    move |x| rotation * x + Vector3::new(3.0, -2.0, 0.0)
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// Returns free strains of some elements.
fn free<S: Space>(sample: &Sample<S>) -> Vec<f64> {
    let elements = sample.mesh.elements().enumerate();
    elements.map(|(e, _)| 0.02 * (e as f64).sin()).collect()
}

/// Returns the largest relative difference of the tangent from central differences of the force,
/// along some direction.
fn tangent_error<S: Space>(strain: Strain, theta: f64, moved: f64) -> f64 {
    let sample = sample::<S>(strain, 1e-3);
    let [start, to] = [0.0, moved].map(|m| sample.displaced(waves(0.2, m)));
    let step = Stretch {
        start: &start,
        end: &to,
        h: 0.1,
        theta,
        free_strain: &free(&sample),
    };
    let direction = sample.displaced(waves(0.5, 0.7));
    let small = 1e-5;
    let [low, high] = [-small, small].map(|s| {
        let end: Vec<f64> = to.iter().zip(&direction).map(|(q, d)| q + s * d).collect();
        let forces = sample.large.forces(&Stretch { end: &end, ..step });
        let both = forces.elastic.iter().zip(forces.viscous);
        both.map(|(a, b)| a + b).collect::<Vec<f64>>()
    });
    let slope = low
        .iter()
        .zip(&high)
        .map(|(a, b)| (b - a) / (2.0 * small * theta));
    let slope: Vec<f64> = slope.collect();
    let tangent = sample.large.tangent(&step, &sample.stiffness);
    let found = tangent.times(&direction);
    let off: Vec<f64> = found.iter().zip(&slope).map(|(a, b)| a - b).collect();
    norm(&off) / norm(&slope)
}

#[test]
fn tangents_are_derivatives_of_the_force() {
    for strain in BOTH {
        let exact = [
            tangent_error::<Dim2>(strain, 1.0, 0.3),
            tangent_error::<Dim3>(strain, 1.0, 0.3),
        ];
        assert!(exact.iter().all(|e| *e < 1e-8), "{strain:?}: {exact:?}");
        // At other theta the error is proportional to the change of F over the step.
        let some = [0.3, 0.03].map(|moved| tangent_error::<Dim3>(strain, 0.5, moved));
        println!("{strain:?}: tangent off by {exact:?}, {some:?} at theta 1/2");
        assert!(
            some[0] < 0.2 && some[1] < 0.15 * some[0],
            "{strain:?}: {some:?}"
        );
    }
}

/// A rotating body has no forces, for any angle of a step; in small strain it would have forces at
/// half of that angle.
fn turns_freely<S: Space>(strain: Strain) {
    let sample = sample::<S>(strain, 1e-3);
    for [from, to] in [[0.0, 1e-3], [0.2, 1.2], [0.0, 1.57], [1.0, 4.14]] {
        let [start, end] = [from, to].map(|angle| sample.displaced(turned(angle)));
        for theta in [0.5, 0.7, 1.0] {
            let forces = sample.large.forces(&Stretch {
                start: &start,
                end: &end,
                h: 0.1,
                theta,
                free_strain: &[],
            });
            let most = norm(&forces.elastic).max(norm(&forces.viscous));
            assert!(most < 1e-13 * RUBBER.young, "{strain:?} {to}: {most:e}");
        }
        let stresses = sample.large.stresses(&end, &[]);
        let most = stresses
            .iter()
            .flatten()
            .fold(0.0, |m: f64, s| m.max(s.abs()));
        assert!(most < 1e-14 * RUBBER.young, "{strain:?}: {most:e}");
        assert!(sample.large.energy(&end, &[]) < 1e-26 * RUBBER.young);
    }
}

#[test]
fn rotations_strain_nothing() {
    for strain in BOTH {
        turns_freely::<Dim2>(strain);
        turns_freely::<Dim3>(strain);
    }
}

/// A uniform strain causes no force at inner points, all elements have its stress, and no resultant
/// force or moment on the body.
fn patch<S: Space>(strain: Strain) {
    let sample = sample::<S>(strain, 0.0);
    let f = Matrix3::new(1.2, 0.3, 0.0, -0.2, 0.8, 0.0, 0.0, 0.0, 1.0);
    let q = sample.displaced(|x| f * x);
    let step = Stretch {
        start: &q,
        end: &q,
        h: 1.0,
        theta: 0.5,
        free_strain: &[],
    };
    let forces = sample.large.forces(&step);
    let sides = [1.0, 1.5, 1.2];
    let inner = |x: &S::Vector| (0..S::D).all(|k| x[k] > 1e-9 && x[k] < sides[k] - 1e-9);
    for (p, x) in sample.mesh.points().iter().enumerate() {
        for axis in (0..S::D).filter(|_| inner(x)) {
            let c = sample.freedoms.of(p as u32, axis);
            assert!(forces.elastic[c].abs() < 1e-14 * forces.size[c] + 1e-9);
        }
    }
    let stresses = sample.large.stresses(&q, &[]);
    for stress in &stresses {
        for (s, first) in stress.iter().zip(stresses[0]) {
            assert!((s - first).abs() < 1e-12 * RUBBER.young);
        }
    }
}

#[test]
fn patches_pass() {
    for strain in BOTH {
        patch::<Dim2>(strain);
        patch::<Dim3>(strain);
    }
}

#[test]
fn elements_that_turn_inside_out_are_found() {
    let sample = sample::<Dim2>(Strain::NeoHookean, 0.0);
    let inverted = |q: &[f64]| sample.large.inverted(&sample.mesh, q);
    assert!(inverted(&sample.displaced(|x| x * 0.1)).is_none());
    assert!(inverted(&sample.displaced(|x| Vector3::new(-x.x, x.y, 0.0))).is_some());
    assert!(inverted(&vec![f64::NAN; sample.freedoms.total()]).is_some());
}

/// A body with a uniform free strain and the corresponding deformation, rotated by any angle, has
/// no force, stress and energy.
#[test]
fn what_expands_freely_is_without_stress() {
    for strain in BOTH {
        let sample = sample::<Dim3>(strain, 0.0);
        let free = vec![0.05; free(&sample).len()];
        let turn = turned(0.7);
        let q = sample.displaced(|x| turn(x * 1.05));
        let forces = sample.large.forces(&Stretch {
            start: &q,
            end: &q,
            h: 1.0,
            theta: 0.5,
            free_strain: &free,
        });
        let most = norm(&forces.elastic);
        assert!(most < 1e-12 * RUBBER.young, "{strain:?}: {most:e}");
        let stresses = sample.large.stresses(&q, &free);
        let most = stresses
            .iter()
            .flatten()
            .fold(0.0, |m: f64, s| m.max(s.abs()));
        assert!(most < 1e-13 * RUBBER.young, "{strain:?}: {most:e}");
        assert!(sample.large.energy(&q, &free) < 1e-24 * RUBBER.young);
    }
}

/// Forces are derivatives of the stored energy for any free strains, in the plane at constant depth
/// too.
#[test]
fn forces_with_free_strains_are_derivatives_of_the_energy() {
    fn error<S: Space>(strain: Strain) -> f64 {
        let sample = sample::<S>(strain, 0.0);
        let free = free(&sample);
        let q = sample.displaced(waves(0.2, 0.3));
        let direction = sample.displaced(waves(0.5, 0.7));
        let small = 1e-6;
        let [low, high] = [-small, small].map(|s| {
            let at: Vec<f64> = q.iter().zip(&direction).map(|(q, d)| q + s * d).collect();
            sample.large.energy(&at, &free)
        });
        let forces = sample.large.forces(&Stretch {
            start: &q,
            end: &q,
            h: 1.0,
            theta: 1.0,
            free_strain: &free,
        });
        let power: f64 = forces
            .elastic
            .iter()
            .zip(&direction)
            .map(|(f, d)| f * d)
            .sum();
        ((high - low) / (2.0 * small) / power - 1.0).abs()
    }
    for strain in BOTH {
        let found = [error::<Dim2>(strain), error::<Dim3>(strain)];
        assert!(found.iter().all(|e| *e < 1e-7), "{strain:?}: {found:?}");
    }
}
