//! Linear and angular momentum of isolated bodies, for any law of their contacts.

use crate::scene::{self, tables};
use crate::temp::TempFolder;
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use fretwork::laws::Kind;
use fretwork::shipped::built_in;
use fretwork::step::Simulation;

fn built<S: Space>(text: &str) -> Simulation<S> {
    scene::text::<S>(text)
}

/// Linear and angular momentum about the origin, and the sums of their magnitudes.
fn momentum<S: Space>(s: &Simulation<S>) -> (S::Vector, S::Spin, [f64; 2]) {
    let bodies = &s.state.bodies;
    let (mut linear, mut angular, mut sizes) = (S::Vector::zero(), S::Spin::zero(), [0.0; 2]);
    for b in 0..bodies.len() {
        let p = bodies.velocity[b] * bodies.mass[b];
        let own = bodies.angular_momentum(b, &bodies.spin[b]);
        let around = S::moment(&bodies.position[b], &p);
        linear += p;
        angular += around + own;
        sizes = [sizes[0] + p.norm(), sizes[1] + around.norm() + own.norm()];
    }
    (linear, angular, sizes)
}

/// Makes steps, in some of which contacts act; returns the drift of momentum relative to the sums
/// of the magnitudes at the start. The ledger must give equal values.
fn drift<S: Space>(s: &mut Simulation<S>, steps: usize) -> [f64; 2] {
    let (linear, angular, sizes) = momentum(s);
    let mut acted = 0;
    for _ in 0..steps {
        let report = s.step().unwrap_or_else(|e| panic!("{e}"));
        acted += report.active;
    }
    assert!(acted > 0, "no contact carries anything");
    let (linear_after, angular_after, _) = momentum(s);
    let found = [
        (linear_after - linear).norm(),
        (angular_after - angular).norm(),
    ];
    let booked = s.momentum().drift();
    for k in 0..2 {
        assert!(
            (found[k] - booked[k]).abs() < 1e-11 * sizes[k],
            "{found:?} in the motion, {booked:?} in the ledger, of {sizes:?}"
        );
    }
    [found[0] / sizes[0], found[1] / sizes[1]]
}

/// Five balls (2D: disks) of different sizes, separated by a twentieth of their radius, which
/// approach at a rate (1/s) and rotate.
fn cluster<S: Space>(rate: f64, interface: &str, more: &str) -> Simulation<S> {
    let places = [
        ([0.0, 0.0, 0.0], 0.010),
        ([0.0205, 0.0, 0.0], 0.010),
        ([0.0102, 0.0165, 0.001], 0.009),
        ([-0.0105, 0.0175, -0.001], 0.010),
        ([0.0100, -0.0170, 0.002], 0.0095),
    ];
    let grains = places.iter().enumerate().map(|(k, (at, radius))| {
        let wave = |n: u32| 0.02 * (1.3 + f64::from(n) + 2.1 * k as f64).sin();
        let v: Vec<f64> = (0..S::D).map(|i| wave(i as u32) - rate * at[i]).collect();
        let w: Vec<f64> = (0..S::Spin::N)
            .map(|i| 100.0 * wave(5 + i as u32))
            .collect();
        format!(
            "(at: {:?}, radius: {radius:?}, velocity: {v:?}, spin: {w:?})",
            &at[..S::D]
        )
    });
    let grains: Vec<String> = grains.collect();
    built::<S>(&format!(
        r#"(
    name: "isolated", dimension: {}, time: (step: 1e-5, end: 1.0),
    detection: (alert: 1.5e-3, skin: 1e-3),
    materials: {{"grain": "magnetite"}},
    solver: (tolerance: 1e-10),
    interfaces: [(name: "all", between: ("grain", "grain"), {interface})],
    grains: [List(material: "grain", grains: [{}])],
    output: (frames: 0, views: 0), {more}
)"#,
        S::D,
        grains.join(", ")
    ))
}

/// Every shipped law in its slot. With a bond, a spring or an attraction angular momentum is
/// conserved up to round-off. Rigid balls, which approach by 8e-4 of their radius per step, have
/// contact forces on their surfaces, which are separated by the remaining gap: the relative loss is
/// smaller than this gap over their radius.
fn every_law<S: Space>() {
    let laws = built_in();
    let mut count = 0;
    for (kind, name) in laws.names() {
        let plugin = laws.open(kind, name).unwrap().unwrap();
        // A point contact, which has no meaning in the plane.
        if S::D == 2 && ["dmt", "jkr"].contains(&name) {
            continue;
        }
        let folder = TempFolder::new("momentum");
        let tables = tables(&plugin, &folder);
        let slots = match kind.spec().word {
            "contact" => format!("contact: \"{name}\"{tables}"),
            "damage" => {
                format!("contact: \"coulomb\", cohesion: \"elastic-bond\", damage: \"{name}\"")
            }
            word => format!("contact: \"coulomb\", {word}: \"{name}\"{tables}"),
        };
        let heat =
            plugin.kind == Kind::TRANSPORT || plugin.flags & fretwork_abi::FLAG_TEMPERATURE != 0;
        // Bonds hold at a slow approach; bodies without bonds approach faster.
        let opens = plugin.flags & fretwork_abi::FLAG_OPENING != 0;
        let bonds = opens || kind.spec().word == "damage";
        let rate = if bonds { 4.0 } else { 40.0 };
        let mut s = cluster::<S>(
            rate,
            &slots,
            if heat { "heat: (initial: 300.0)" } else { "" },
        );
        let exact = s.laws[0].compliant() || s.laws[0].cohesion().is_some();
        let found = drift(&mut s, 300);
        println!("{}D {slots}: {found:?}", S::D);
        assert!(found[0] < 1e-12, "{slots}: {found:?}");
        assert!(
            found[1] < if exact { 1e-12 } else { 1e-3 },
            "{slots}: {found:?}"
        );
        count += 1;
    }
    assert!(count > 30);
}

#[test]
fn every_law_keeps_the_momentum_of_an_isolated_cluster() {
    every_law::<Dim2>();
}

#[test]
fn every_law_keeps_the_momentum_of_an_isolated_cluster_in_space() {
    every_law::<Dim3>();
}

/// Two balls on a bond over a gap rotate about each other twice: nothing is lost, and the rigid
/// rotation does not shear the bond.
fn turning_pair<S: Space>(gap: f64, bond: &str) {
    let (radius, rate) = (0.01, 20.0);
    let half = radius * (1.0 + 0.5 * gap);
    let grain = |side: f64| {
        let (mut at, mut v) = (vec![0.0; S::D], vec![0.0; S::D]);
        (at[0], v[1]) = (side * half, side * half * rate);
        let mut w = vec![0.0; S::Spin::N];
        w[S::Spin::N - 1] = rate;
        format!("(at: {at:?}, radius: {radius:?}, velocity: {v:?}, spin: {w:?})")
    };
    let turns = 4.0 * std::f64::consts::PI / rate;
    let steps = 4000;
    let mut s = built::<S>(&format!(
        r#"(
    name: "pair", dimension: {}, time: (step: {:e}, end: 10.0), detection: (alert: 2e-3, skin: 1e-3),
    materials: {{"grain": "magnetite"}},
    solver: (tolerance: 1e-12, norm: Velocity),
    interfaces: [(name: "all", between: ("grain", "grain"), contact: "coulomb", {bond})],
    grains: [List(material: "grain", grains: [{}, {}])],
    output: (frames: 0, views: 0),
)"#,
        S::D,
        turns / f64::from(steps),
        grain(-1.0),
        grain(1.0)
    ));
    let found = drift(&mut s, steps as usize);
    let bonds = &s.state.network.memory[0].bonds;
    assert!(bonds.len() == 1 && bonds[0].intact());
    let shear = bonds[0].opening_t.norm() / radius;
    println!(
        "{}D {bond} over {gap}: {found:?}, sheared by {shear:e} of the radius",
        S::D
    );
    assert!(found[0] < 1e-12 && found[1] < 1e-12, "{found:?}");
    assert!(shear < 1e-6, "{shear:e}");
}

#[test]
fn a_pair_on_a_bond_over_a_gap_turns_as_one() {
    let bonds = [
        r#"cohesion: "elastic-bond", parameters: (cohesion: {"k_n": 1e9, "k_t": 1e9})"#,
        r#"cohesion: "parallel-bond", parameters: (cohesion: {"k_n": 1e9, "k_t": 1e9, "sigma_c": 1e12, "tau_c": 1e12})"#,
    ];
    for bond in bonds {
        for gap in [0.0, 0.01, 0.05] {
            turning_pair::<Dim2>(gap, bond);
            turning_pair::<Dim3>(gap, bond);
        }
    }
}
