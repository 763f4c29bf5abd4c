//! Heat in finite elements, and their thermal expansion.

use super::expansion::{ALPHA, RISE, height};
use super::{Table, effusivity, heat, plane, solid, until};
use fretwork::geometry::space::Dim2;
use fretwork::record::encoding::{decode, encode};
use fretwork::step::Simulation;
use std::f64::consts::PI;

/// Poisson's ratio, Young's modulus (Pa) and width (m) of the block of finite elements.
const NU: f64 = 0.3;
const YOUNG: f64 = 210e9;
const WIDTH: f64 = 1e-3;

pub fn all(table: &mut Table) {
    wall(table);
    grain_on_elements(table);
    two_meshes(table);
    elements(table);
    held_elements(table);
    bent(table);
    in_space(table);
}

fn wall(table: &mut Table) {
    let case = "thermal/mesh_wall";
    let mut s = plane(case, &[]);
    let range = s.heat().expect("heat").first_bodies[0].1.clone();
    let hottest = |s: &Simulation<Dim2>| {
        let nodes = &heat(s).nodes[range.clone()];
        nodes.iter().map(|n| n.temperature).fold(0.0, f64::max) - 300.0
    };
    until(&mut s, 1e-2, |_| ());
    let early = 2.0 * 1e6 * (1e-2 / PI).sqrt() / effusivity();
    table.compare(
        case,
        "top at 10 ms, a half-space (K)",
        early,
        hottest(&s),
        1e-2,
    );
    until(&mut s, 2.0, |_| ());
    table.compare(case, "top in the end, q L/k (K)", 40.0, hottest(&s), 1e-6);
    let ledger = heat(&s).ledger;
    table.compare(
        case,
        "heat put in, q t b (J/m)",
        2e6 * 1e-3,
        ledger.imposed,
        1e-10,
    );
    table.closes(case, "heat closes", ledger.relative_residual(), 1e-10);
}

fn grain_on_elements(table: &mut Table) {
    let case = "thermal/mesh_contact";
    let mut s = plane(case, &[]);
    until(&mut s, 0.2, |_| ());
    let (grain, block) = (PI * 25e-8, 2e-3 * 1e-3);
    let mean = (400.0 * grain + 300.0 * block) / (grain + block);
    let nodes = &heat(&s).nodes;
    let ends = nodes.iter().map(|n| n.temperature);
    let [low, high] = ends.fold([f64::INFINITY, 0.0], |[l, h], t| [t.min(l), t.max(h)]);
    table.compare(case, "lowest temperature in the end (K)", mean, low, 1e-6);
    table.compare(case, "highest temperature in the end (K)", mean, high, 1e-6);
    let ledger = heat(&s).ledger;
    let gained = 7850.0 * 450.0 * block * (mean - 300.0);
    let into = heat(&s).received[0] - 0.5 * ledger.dissipated;
    table.compare(case, "heat into the block (J/m)", gained, into, 1e-4);
    table.closes(case, "heat closes", ledger.relative_residual(), 1e-10);
}

/// Two blocks whose meshes do not match: the heat flow through their contacts is that of the law,
/// for the temperatures of both blocks.
fn two_meshes(table: &mut Table) {
    let case = "elastic/patch";
    let sets = [
        "materials.steel=verification_steel",
        "interfaces.0.transport=constant-conductance",
        "interfaces.0.parameters.transport={\"thermal\": 1e-3, \"reach\": 1e-5}",
        "heat=(initial: 300.0, shares: (friction: 0.0, impact: 0.0, viscous: 0.0, adhesion: 0.0), bodies: {\"lower\": (store: Mesh()), \"upper\": (store: Mesh(), temperature: 400.0)})",
    ];
    let mut s = plane(case, &sets);
    until(&mut s, 8e-4, |_| ());
    let before = heat(&s).received[0];
    s.step().expect("a step");
    let flow = (heat(&s).received[0] - before) / s.options.scheme.h;
    let thermal = s.state.network.thermal.as_ref().expect("contacts");
    let all: f64 = thermal.conductance.iter().map(|c| c[0]).sum();
    assert!(all > 5e-3, "{all}");
    let quantity = "flow between two meshes, n G dT (W/m)";
    table.compare(case, quantity, 100.0 * all, flow, 1e-5);
    let mut seen = thermal
        .temperatures
        .iter()
        .flat_map(|seen| seen.temperature);
    assert!(seen.all(|t| (300.0..=400.0).contains(&t)));
}

/// A block of finite elements lifts a load, with each measure of strain; the result is equal if one
/// thermal step spans several of the mechanics.
fn elements(table: &mut Table) {
    let case = "thermal/mesh_expansion";
    let runs: [(&[&str], f64); 4] = [
        (&[], 1e-6),
        (&["heat.every=10"], 1e-6),
        // The error is of second order in the strain, 1.6e-3.
        (&["elastic.block.strain=Corotational"], 3e-3),
        (&["elastic.block.strain=NeoHookean"], 3e-3),
    ];
    for (sets, tolerance) in runs {
        let mut s = plane(case, sets);
        until(&mut s, 0.15, |_| ());
        let rise = height(&s, "load") - 2e-3;
        let free = (1.0 + NU) * ALPHA * RISE * 2e-3;
        let pressed = 1e3 * 2e-3 * (1.0 - NU * NU) / (YOUNG * WIDTH);
        let named = |what: &str| match sets {
            [] => what.to_owned(),
            _ => format!("{}: {what}", sets[0]),
        };
        let name = named("rise (1 + nu) alpha dT L - F L/(E' b) (m)");
        table.compare(case, &name, free - pressed, rise, tolerance);
        let energy = s.energies();
        let closes = energy.relative_residual();
        table.compare(case, &named("energy closes"), 0.0, closes, 1e-10);
        let ledger = heat(&s).ledger;
        let name = named("heat gone into work (J/m)");
        table.compare(case, &name, energy.expansion, ledger.expansion, 1e-12);
        let closes = ledger.relative_residual();
        table.compare(case, &named("heat closes"), 0.0, closes, 1e-10);
    }

    // A run continued from saved bytes is bit-identical.
    for strain in ["Small", "NeoHookean"] {
        let set = format!("elastic.block.strain={strain}");
        let [mut s, mut again] = [0, 1].map(|_| plane(case, &[&set]));
        until(&mut s, 2e-3, |_| ());
        let bytes = encode(&s.state).expect("bytes");
        assert!(again.restore(decode(&bytes).expect("a state")));
        until(&mut s, 4e-3, |_| ());
        until(&mut again, 4e-3, |_| ());
        let [s, again] = [s, again].map(|s| encode(&s.state).expect("bytes"));
        assert_eq!(s, again, "{case}, {strain}: continued");
    }
}

/// Heated elements between two plates: sigma = -E alpha dT/(1 - nu) in plane strain, and the
/// elastic energy comes from the heat.
fn held_elements(table: &mut Table) {
    let case = "thermal/mesh_expansion";
    for (strain, tolerance) in [
        ("Small", 1e-8),
        ("Corotational", 3e-3),
        ("NeoHookean", 5e-3),
    ] {
        let sets = [
            format!("elastic.block.strain={strain}"),
            "elastic.block.supports=[(part: \"left\", x: Fixed), (part: \"bottom\", y: Fixed), (part: \"top\", y: Fixed)]".to_owned(),
            "elastic.block.touches=Nothing".to_owned(),
        ];
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let mut s = plane(case, &sets);
        until(&mut s, 0.15, |_| ());
        let stress = -YOUNG * ALPHA * RISE / (1.0 - NU);
        let system = s.state.systems.get(0).expect("the block");
        let mesh = system.deformed_mesh().expect("a mesh");
        let middle = mesh.stress[mesh.stress.len() / 2];
        let name = format!("{strain}: stress between plates (Pa)");
        table.compare(case, &name, stress, middle[1], tolerance);
        let holders = system.holders();
        let top = holders.iter().find(|h| h.part == "top").expect("the top");
        let name = format!("{strain}: force on the plate above (N/m)");
        table.compare(case, &name, stress * WIDTH, top.force, tolerance);
        let energy = s.energies();
        // These are sigma_y and sigma_z of the strains -alpha dT, both constrained.
        let zz = NU * stress - YOUNG * ALPHA * RISE;
        let stored = -0.5 * (stress + zz) * ALPHA * RISE * WIDTH * 2e-3;
        let name = format!("{strain}: energy stored (J/m)");
        table.compare(case, &name, stored, energy.elastic, 2.0 * tolerance);
        let closes = energy.relative_residual();
        table.closes(case, &format!("{strain}: energy closes"), closes, 1e-10);
        let ledger = heat(&s).ledger;
        let name = format!("{strain}: heat gone into work (J/m)");
        table.compare(case, &name, energy.expansion, ledger.expansion, 1e-12);
        let name = format!("{strain}: heat closes");
        table.closes(case, &name, ledger.relative_residual(), 1e-10);
    }
}

/// A block that is warmer above than below, and is held at its left side only in x, bends without
/// stress.
fn bent(table: &mut Table) {
    let case = "thermal/mesh_expansion";
    let sets = [
        "bodies=[]",
        "elastic.block.touches=Nothing",
        "elastic.block.supports=[(part: \"left\", x: Fixed)]",
        "elastic.block.mesh=Block(x: (from: 0.0, to: 1e-3, size: 2.5e-5), y: (from: 0.0, to: 1e-3, size: 2.5e-5))",
        "heat.bodies={\"block\": (store: Mesh(fixed: {\"bottom\": 300.0, \"top\": 400.0}))}",
        "time.step=1e-3",
    ];
    let mut s = plane(case, &sets);
    until(&mut s, 0.2, |_| ());
    let mesh = s.state.systems.get(0).and_then(|b| b.deformed_mesh());
    let mesh = mesh.expect("a mesh");
    // The mean over the height is used, without the change of the height along the block.
    let rise = |x: f64| {
        let all = mesh.points.iter().zip(&mesh.displacement);
        let there = all.filter(|(p, _)| (p.x - x).abs() < 1e-9);
        let rises: Vec<f64> = there.map(|(_, u)| u.y).collect();
        rises.iter().sum::<f64>() / rises.len() as f64
    };
    let bend = 0.5 * (1.0 + NU) * ALPHA * (RISE / 1e-3) * 1e-6;
    let name = "warm above: bent down by (1 + nu) alpha (dT/dy) L^2/2 (m)";
    table.compare(case, name, bend, rise(0.0) - rise(1e-3), 2e-2);
    // In-plane stresses of elements of constant strain have an error of the size of the elements.
    let [xx, yy, xy] = [0, 1, 5].map(|k| {
        let sizes = mesh.stress.iter().map(|s| s[k].abs());
        sizes.fold(0.0, f64::max) / (YOUNG * ALPHA * RISE)
    });
    assert!(xx < 0.05 && yy < 0.05 && xy < 0.05, "{xx} {yy} {xy}");
}

/// A free block in 3D, with damping and theta 1/2, grows evenly without stress with each measure of
/// strain, also if steps are repeated.
fn in_space(table: &mut Table) {
    let case = "thermal/mesh_expansion_3d";
    for strain in ["Small", "Corotational", "NeoHookean"] {
        let set = format!("elastic.block.strain={strain}");
        let [mut s, mut again] = [0, 1].map(|_| solid(case, &[&set]));
        while s.state.time < 0.05 {
            s.step().expect("a step");
            // The state is restored after a failed trial.
            let tried = again.attempt(|s| s.step().map_or(Err(()), |_| Err::<(), ()>(())));
            assert_eq!(tried.expect("steps that repeat"), Err(()));
            again.step().expect("a step");
        }
        let bytes = [&s, &again].map(|s| encode(&s.state).expect("bytes"));
        assert_eq!(
            bytes[0], bytes[1],
            "{strain}: after steps that were put back"
        );
        let nodes = &heat(&s).nodes;
        let warmer = nodes[nodes.len() - 1].temperature - 300.0;
        assert!(warmer > 90.0, "{warmer}");
        let body = s.state.systems.get(0).expect("the block");
        let mesh = body.deformed_mesh().expect("a mesh");
        // The free strain of the step is that of the temperature at its start.
        let strain_now = mesh.displacement.iter().map(|u| u.x).fold(0.0, f64::max) / 1e-3;
        let name = format!("{strain}: growth along x, alpha dT");
        table.compare(case, &name, ALPHA * warmer, strain_now, 1e-3);
        for (axis, length) in [(1, 2e-3), (2, 1.5e-3)] {
            let most = mesh
                .displacement
                .iter()
                .map(|u| u[axis])
                .fold(0.0, f64::max);
            let name = format!("{strain}: the same along axis {axis}");
            table.compare(case, &name, strain_now, most / length, 1e-6);
        }
        let stress = mesh.stress.iter().flatten();
        let most = stress.fold(0.0, |m: f64, s| m.max(s.abs())) / (YOUNG * ALPHA * warmer);
        assert!(most < 1e-3, "{strain}: {most}");
        let energy = s.energies();
        let name = format!("{strain}: energy closes");
        table.closes(case, &name, energy.relative_residual(), 1e-10);
        let ledger = heat(&s).ledger;
        let name = format!("{strain}: heat gone into work (J)");
        table.compare(case, &name, energy.expansion, ledger.expansion, 1e-12);
        let name = format!("{strain}: heat closes");
        table.closes(case, &name, ledger.relative_residual(), 1e-10);
    }
}
