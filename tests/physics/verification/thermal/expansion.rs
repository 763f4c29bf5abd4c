//! Thermal expansion, and heat in finite elements.

use super::{Table, effusivity, heat, plane, solid, until};
use fretwork::geometry::space::Dim2;
use fretwork::record::code::{decode, encode};
use fretwork::step::Simulation;
use std::f64::consts::PI;

/// Coefficient of linear expansion (1/K), rise of temperature (K) and height of the columns (m).
const ALPHA: f64 = 1.2e-5;
const RISE: f64 = 100.0;
const HEIGHT: f64 = 6e-3;

pub fn all(table: &mut Table) {
    lifted(table);
    several_steps(table);
    held(table);
    bonded(table);
    wall(table);
    grain_on_elements(table);
    two_meshes(table);
    polygon(table);
    first_body(table);
    elements(table);
    held_elements(table);
    bent(table);
    in_space(table);
}

fn height(s: &Simulation<Dim2>, body: &str) -> f64 {
    s.state.bodies.position[s.body_named(body).expect("a body")].y
}

fn lifted(table: &mut Table) {
    let case = "thermal/expanding_column";
    let mut s = plane(case, &[]);
    until(&mut s, 4.0, |_| ());
    // What is not yet warm, by the temperature of the grains before the last step.
    let rise = height(&s, "load") - HEIGHT;
    table.compare(
        case,
        "rise alpha dT L (m)",
        ALPHA * RISE * HEIGHT,
        rise,
        1e-5,
    );
    let work = 1e3 * rise;
    let energy = s.energies();
    table.compare(
        case,
        "work of the load (J/m)",
        -work,
        energy.external_work,
        1e-9,
    );
    table.compare(
        case,
        "work of the expansion (J/m)",
        work,
        energy.expansion,
        1e-5,
    );
    table.compare(
        case,
        "energy closes",
        0.0,
        energy.relative_residual(),
        1e-10,
    );
    let ledger = heat(&s).ledger;
    table.compare(
        case,
        "heat gone into work (J/m)",
        energy.expansion,
        ledger.expansion,
        1e-12,
    );
    table.compare(case, "heat closes", 0.0, ledger.relative_residual(), 1e-10);
    let stored = ledger.surroundings + ledger.dissipated - energy.expansion;
    table.compare(
        case,
        "heat of the surroundings less work",
        stored,
        ledger.stored,
        1e-10,
    );

    // Continued from bytes it has the same bits.
    let mut s = plane(case, &[]);
    until(&mut s, 0.2, |_| ());
    let bytes = encode(&s.state).expect("bytes");
    let mut again = plane(case, &[]);
    assert!(again.restore(decode(&bytes).expect("a state")));
    assert_eq!(s.shapes.balls[0].radius, again.shapes.balls[0].radius);
    assert!(s.shapes.balls[0].radius > 1e-3);
    until(&mut s, 0.3, |_| ());
    until(&mut again, 0.3, |_| ());
    assert_eq!(
        encode(&s.state).expect("bytes"),
        encode(&again.state).expect("bytes"),
        "{case}: continued"
    );
}

/// Where heat makes one step for several of the mechanics, the growth is spread over these, and for another step the rise is the same.
fn several_steps(table: &mut Table) {
    let case = "thermal/expanding_column";
    for sets in [&["heat.every=10"][..], &["time.step=4e-3"]] {
        let mut s = plane(case, sets);
        let (mut last, mut fastest) = (height(&s, "load"), 0.0f64);
        until(&mut s, 4.0, |s| {
            let now = height(s, "load");
            fastest = fastest.max((now - last) / s.options.scheme.h);
            last = now;
        });
        let rise = last - HEIGHT;
        let quantity = format!("{}: rise (m)", sets[0]);
        table.compare(case, &quantity, ALPHA * RISE * HEIGHT, rise, 5e-5);
        // The rate at the start is alpha dT L/(0.1766 s), that of one step at a time ten times as much.
        let rate = ALPHA * RISE * HEIGHT / (7850.0 * 450.0 * 1e-3 / 2e4);
        assert!(fastest < 1.1 * rate, "{}: {fastest} of {rate}", sets[0]);
        let closes = s.energies().relative_residual();
        table.compare(
            case,
            &format!("{}: energy closes", sets[0]),
            0.0,
            closes,
            1e-10,
        );
    }
}

fn held(table: &mut Table) {
    let case = "thermal/held_column";
    let mut s = plane(case, &[]);
    // Before it stands still, where velocities are rounding.
    until(&mut s, 0.8, |_| ());
    let rise = s.temperature(1).expect("a temperature") - 300.0;
    assert!(rise > 98.0, "{rise}");
    let force = 1e6 * ALPHA * rise * HEIGHT / 4.0;
    for contact in s.contacts() {
        let name = "force k alpha dT L/4 (N/m)";
        table.compare(case, name, force, contact.normal_force, 1e-4);
    }
    let energy = s.energies();
    // Of four springs.
    let stored = 4.0 * 0.5 * force * force / 1e6;
    table.compare(
        case,
        "energy in the springs (J/m)",
        stored,
        energy.elastic,
        1e-4,
    );
    table.compare(
        case,
        "work of the expansion: stored and damped (J/m)",
        energy.elastic + energy.viscous,
        energy.expansion,
        1e-3,
    );
    table.compare(
        case,
        "energy closes",
        0.0,
        energy.relative_residual(),
        1e-10,
    );
}

fn bonded(table: &mut Table) {
    let case = "thermal/expanding_bond";
    let mut s = plane(case, &[]);
    let mut most = 0.0f64;
    until(&mut s, 2.0, |s| most = most.max(s.energies().elastic));
    let [a, b] = [s.state.bodies.position[0], s.state.bodies.position[1]];
    let apart = (b - a).norm() - 2e-3;
    table.compare(
        case,
        "centres apart by alpha dT d (m)",
        ALPHA * RISE * 2e-3,
        apart,
        1e-4,
    );
    // The bond has 1e11 Pa/m on 2 mm: as stretched by the expansion it would store 5.8e-4 J/m.
    table.compare(case, "energy of the bond (J/m)", 0.0, most, 1e-9);
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
    table.compare(case, "heat closes", 0.0, ledger.relative_residual(), 1e-10);
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
    table.compare(case, "heat closes", 0.0, ledger.relative_residual(), 1e-10);
}

/// Two blocks whose meshes do not match: through their contacts flows what the law says, between the temperatures of the two.
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
    let mut seen = thermal.seen.iter().flat_map(|seen| seen.temperature);
    assert!(seen.all(|t| (300.0..=400.0).contains(&t)));
}

/// A square on springs between a floor and a load, which friction holds: its corners move outwards by alpha dT a, against the tangential stiffness of
/// the contacts, 0.8 of the normal one.
fn polygon(table: &mut Table) {
    let case = "thermal/expanding_column";
    let sets = [
        "grains=[Polygons(material: \"steel\", grains: [(at: [0.0, 1e-3], points: [(-1e-3, -1e-3), (1e-3, -1e-3), (1e-3, 1e-3), (-1e-3, 1e-3)])])]",
        "interfaces.0.contact=linear-contact",
        "interfaces.0.parameters=(contact: {\"stiffness\": 1e8, \"ratio\": 0.8, \"restitution\": 0.1, \"mu\": 0.3})",
        "solver=(norm: Balance, tolerance: 1e-8, max_iterations: 100000)",
        "time.step=1e-4",
        "bodies.load.position=[0.0, 2e-3]",
    ];
    let mut s = plane(case, &sets);
    until(&mut s, 0.6, |_| ());
    let rise = s.temperature(0).expect("a temperature") - 300.0;
    assert!(rise > 90.0, "{rise}");
    let shear = 0.8e8 * ALPHA * rise * 1e-3;
    let contacts = &s.state.network.contacts;
    assert_eq!(contacts.len(), 4);
    for contact in contacts {
        let force = contact.impulse / s.options.scheme.h;
        let name = "a square: force at a corner across the load (N/m)";
        table.compare(case, name, 500.0, force.y.abs(), 1e-3);
        let name = "a square: along it, k_t alpha dT a (N/m)";
        // Overlaps are 0.5 % of a.
        table.compare(case, name, shear, force.x.abs(), 1e-2);
    }
    let energy = s.energies();
    table.compare(
        case,
        "a square: energy closes",
        0.0,
        energy.relative_residual(),
        1e-10,
    );
    let ledger = heat(&s).ledger;
    table.compare(
        case,
        "a square: heat closes",
        0.0,
        ledger.relative_residual(),
        1e-10,
    );
}

/// First bodies of balls expand about their position, so that what lies on them rises: one disk, and two of one body that hold a grain between them, on
/// which nothing slides.
fn first_body(table: &mut Table) {
    let case = "thermal/expanding_column";
    let pin = |balls: &str| {
        format!(
            "bodies.floor=(name: \"pin\", material: \"steel\", shapes: [Balls([{balls}])], position: [0.0, 1e-3])"
        )
    };
    let grain = |y: f64| {
        format!("grains=[List(material: \"steel\", grains: [(at: [0.0, {y}], radius: 1e-3)])]")
    };
    // The body warms as fast as the grain.
    let heat = |disks: usize| {
        let area = disks as f64 * 2.0 * PI * 1e-3;
        format!(
            "heat.bodies={{\"pin\": (store: Lumped(), convection: (coefficient: 1e4, area: {area}, ambient: 400.0)), \"load\": (store: Insulated)}}"
        )
    };
    // Heights above the centre of the pin.
    let between = 3f64.sqrt() * 1e-3;
    let scenes = [
        ("([0.0, 0.0], 1e-3)", 2e-3),
        ("([-1e-3, 0.0], 1e-3), ([1e-3, 0.0], 1e-3)", between),
    ];
    for (k, (balls, height_of_grain)) in scenes.into_iter().enumerate() {
        let top = 2e-3 + height_of_grain;
        let sets = [
            pin(balls),
            grain(1e-3 + height_of_grain),
            heat(k + 1),
            format!("bodies.load.position=[0.0, {top}]"),
            "interfaces.0.contact=coulomb".to_owned(),
            "interfaces.0.parameters=(contact: {\"mu\": 0.3})".to_owned(),
        ];
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let mut s = plane(case, &sets);
        until(&mut s, 4.0, |_| ());
        let rise = height(&s, "load") - top;
        let name = format!("on a first body of {} disks: rise (m)", k + 1);
        let expected = ALPHA * RISE * (height_of_grain + 1e-3);
        table.compare(case, &name, expected, rise, 2e-5);
        let energy = s.energies();
        let name = format!("on a first body of {} disks: work (J/m)", k + 1);
        table.compare(case, &name, 1e3 * rise, energy.expansion, 1e-5);
        let closes = energy.relative_residual();
        table.compare(case, "a first body: energy closes", 0.0, closes, 1e-10);
        // What sticks does not slide.
        assert!(energy.friction < 1e-4 * energy.expansion, "{energy:?}");
        let ledger = super::heat(&s).ledger;
        let closes = ledger.relative_residual();
        table.compare(case, "a first body: heat closes", 0.0, closes, 1e-10);
    }
}

/// Poisson's ratio, Young's modulus (Pa) and width (m) of the block of finite elements.
const NU: f64 = 0.3;
const YOUNG: f64 = 210e9;
const WIDTH: f64 = 1e-3;

/// A block of finite elements lifts a load, by each measure of strain; the answer is the same where heat makes one step for several.
fn elements(table: &mut Table) {
    let case = "thermal/mesh_expansion";
    let runs: [(&[&str], f64); 4] = [
        (&[], 1e-6),
        (&["heat.every=10"], 1e-6),
        // Of second order in the strain, 1.6e-3.
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

    // Continued from bytes it has the same bits.
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

/// The same between two plates: sigma = -E alpha dT/(1 - nu) in plane strain, and its energy comes from the heat.
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
        // sigma_y and sigma_z of the strains -alpha dT, both held.
        let zz = NU * stress - YOUNG * ALPHA * RISE;
        let stored = -0.5 * (stress + zz) * ALPHA * RISE * WIDTH * 2e-3;
        let name = format!("{strain}: energy stored (J/m)");
        table.compare(case, &name, stored, energy.elastic, 2.0 * tolerance);
        let closes = energy.relative_residual();
        table.compare(
            case,
            &format!("{strain}: energy closes"),
            0.0,
            closes,
            1e-10,
        );
        let ledger = heat(&s).ledger;
        let name = format!("{strain}: heat gone into work (J/m)");
        table.compare(case, &name, energy.expansion, ledger.expansion, 1e-12);
        let name = format!("{strain}: heat closes");
        table.compare(case, &name, 0.0, ledger.relative_residual(), 1e-10);
    }
}

/// A block that is warmer above than below, held at its left side in x alone, bends without stress.
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
    // The mean over the height, which the change of the height along it leaves out.
    let rise = |x: f64| {
        let all = mesh.points.iter().zip(&mesh.displacement);
        let there = all.filter(|(p, _)| (p.x - x).abs() < 1e-9);
        let rises: Vec<f64> = there.map(|(_, u)| u.y).collect();
        rises.iter().sum::<f64>() / rises.len() as f64
    };
    let bend = 0.5 * (1.0 + NU) * ALPHA * (RISE / 1e-3) * 1e-6;
    let name = "warm above: bent down by (1 + nu) alpha (dT/dy) L^2/2 (m)";
    table.compare(case, name, bend, rise(0.0) - rise(1e-3), 2e-2);
    // In the plane; elements of one strain are off by that of their size.
    let [xx, yy, xy] = [0, 1, 5].map(|k| {
        let sizes = mesh.stress.iter().map(|s| s[k].abs());
        sizes.fold(0.0, f64::max) / (YOUNG * ALPHA * RISE)
    });
    assert!(xx < 0.05 && yy < 0.05 && xy < 0.05, "{xx} {yy} {xy}");
}

/// A free block in space, with damping and theta 1/2: it grows evenly without stress by each measure of strain, and the same where steps are repeated.
fn in_space(table: &mut Table) {
    let case = "thermal/mesh_expansion_3d";
    for strain in ["Small", "Corotational", "NeoHookean"] {
        let set = format!("elastic.block.strain={strain}");
        let [mut s, mut again] = [0, 1].map(|_| solid(case, &[&set]));
        while s.state.time < 0.05 {
            s.step().expect("a step");
            // What a failed trial changes is put back.
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
        table.compare(case, &name, 0.0, energy.relative_residual(), 1e-10);
        let ledger = heat(&s).ledger;
        let name = format!("{strain}: heat gone into work (J)");
        table.compare(case, &name, energy.expansion, ledger.expansion, 1e-12);
        let name = format!("{strain}: heat closes");
        table.compare(case, &name, 0.0, ledger.relative_residual(), 1e-10);
    }
}
