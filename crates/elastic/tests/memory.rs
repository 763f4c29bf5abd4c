//! The memory that a body reports for its solutions equals the allocated memory. This binary
//! contains this test alone, since it counts allocations.

#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use fretwork_core::bodies::{ContactorShape, Dof, DynamicalSystem, SystemStep};
use fretwork_core::geometry::space::{Dim2, Dim3, Space, VectorLike};
use fretwork_elastic::generate::{block, even};
use fretwork_elastic::{
    BodySpec, ElasticBody, Elasticity, Mesh, Rayleigh, Strain, Support, Touching,
};

#[path = "../../../tests/support/counting.rs"]
mod counting;

#[global_allocator]
static COUNTING: counting::Counting = counting::Counting;

fn body<S: Space>(mesh: Mesh<S>, strain: Strain) -> ElasticBody<S> {
    let supports = [Support {
        part: "bottom".to_owned(),
        axes: vec![Some(Dof::Fixed); S::D],
        later: Vec::new(),
    }];
    let spec = BodySpec {
        name: "block",
        mesh,
        material: Elasticity {
            young: 210e9,
            poisson: 0.3,
            density: 7800.0,
        },
        strain,
        damping: Rayleigh::default(),
        supports: &supports,
        touching: Touching::Points("top"),
        surface_material: 0,
        velocity: [0.0; 3],
        spin: [0.0; 3],
    };
    ElasticBody::new(spec).unwrap()
}

/// Returns the bytes that a function leaves allocated.
fn kept(work: impl FnOnce()) -> f64 {
    let before = counting::held();
    work();
    counting::held().saturating_sub(before) as f64
}

fn compare<S: Space>(what: &str, mesh: Mesh<S>, strain: Strain) {
    let mut first = body(mesh.clone(), strain);
    let mut body = body(mesh, strain);
    let size = body.size().unwrap();
    let step = SystemStep {
        time: 0.0,
        h: 1e-6,
        theta: 1.0,
        gravity: S::Vector::zero(),
    };
    // The library of factors keeps a buffer from its first use on.
    first.begin_step(&step);
    first.linearise(&step);
    let factor = kept(|| {
        body.begin_step(&step);
        body.linearise(&step);
    });
    // In large strain the tangent is kept too.
    let tangent = if size.refactorised {
        size.matrix as f64 / 2.0
    } else {
        0.0
    };
    let estimated = size.factor as f64 + tangent;
    let contactors = body.contactors();
    let points = contactors
        .iter()
        .filter(|c| c.shape == ContactorShape::Point);
    let nodes: Vec<u32> = points
        .flat_map(|c| c.nodes.terms())
        .map(|(n, _)| n)
        .collect();
    let surface = kept(|| drop(body.compliance(&nodes)));
    let one = size.point as f64 * nodes.len() as f64;
    println!(
        "{what}: {} unknowns, factor {:.3} MB of {:.3} estimated, surface {:.3} MB of {:.3}, {:.2e} operations a factorisation",
        size.unknowns,
        factor / 1e6,
        estimated / 1e6,
        surface / 1e6,
        size.surface as f64 / 1e6,
        size.operations[0]
    );
    for (found, estimate) in [
        (factor, estimated),
        (surface, size.surface as f64),
        (surface, one),
    ] {
        let off = estimate / found - 1.0;
        assert!(
            off.abs() < 0.08,
            "{what}: {found} bytes, estimated {estimate}"
        );
    }
}

#[test]
fn memory_is_what_is_said() {
    let plane = |n: usize| block::<Dim2>(&[even(0.0, 2.0, 2 * n), even(0.0, 1.0, n)]).unwrap();
    let space = |n: usize| {
        let [long, short] = [even(0.0, 2.0, 2 * n), even(0.0, 1.0, n)];
        block::<Dim3>(&[long, short.clone(), short]).unwrap()
    };
    // Few unknowns are factorised column by column, many in blocks.
    for n in [4, 20, 60] {
        compare(&format!("plane, {n}"), plane(n), Strain::Small);
    }
    for n in [3, 8, 11] {
        compare(&format!("space, {n}"), space(n), Strain::Small);
    }
    compare("space, neo-Hookean", space(8), Strain::NeoHookean);
    compare("plane, corotational", plane(40), Strain::Corotational);
}
