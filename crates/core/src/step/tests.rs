//! Whole steps of scenes with a closed form, with laws for unit tests.

use super::control::{Changes, Phase, Until};
use super::*;
use crate::bodies::Dof;
use crate::geometry::polyline::Polyline;
use crate::geometry::space::Dim2;
use crate::heat::{
    BodyNodes, Heat, HeatShares, HeatState, ImposedHeatFlow, Node, Partition, Store,
    ThermalMaterial,
};
use crate::laws::Interface;
use crate::laws::sample_laws::{bond, constant, interface, sticky};
use crate::process::expansion::ThermalExpansion;
use crate::process::heat::HeatFlow;
use nalgebra::Vector2;

const H: f64 = 1.0 / 64.0;

/// Returns whether two numbers are equal to rounding.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * a.abs().max(b.abs()).max(1.0)
}

/// A disk that does not rotate lies on a chain of 20 m, and slides at 3 m/s; body 0 is the disk,
/// body 1 that of the chain.
fn slider() -> Simulation<Dim2> {
    slider_of(interface([]))
}

fn slider_of(law: Interface) -> Simulation<Dim2> {
    let mut s = Simulation::of_disks(&[([0.0, 0.5], 0.5)]);
    s.drive(0, [Dof::Free, Dof::Free, Dof::Fixed]);
    let chain = [-10.0, 10.0].map(|x| Vector2::new(x, 0.0)).to_vec();
    s.add_surface(Polyline::new(chain, None).unwrap());
    s.state.bodies.velocity[0].x = 3.0;
    let mut s = s.with_law(law);
    s.state.gravity = Vector2::new(0.0, -10.0);
    s.options.scheme = Scheme { h: H, theta: 0.5 };
    s
}

/// Under g = 10 m/s^2 with friction of 0.5 the disk slows down by 5 m/s^2: v = 3 - 5 t and x = 3
/// t - 5 t^2/2, exactly at theta = 1/2, and stops; friction dissipates its energy. The chain gets
/// the weight and the friction, and the moment of the weight about its origin.
#[test]
fn a_disk_slides_and_stops() {
    let mut s = slider();
    let m = s.state.bodies.mass[0];
    let before = 0.5 * m * 9.0;
    // A time of 0.6 s is 38.4 steps.
    for k in 1..=38 {
        let x_mean = s.state.bodies.position[0].x + 0.5 * H * s.state.bodies.velocity[0].x;
        s.step().unwrap();
        let t = f64::from(k) * H;
        let (x, v) = (s.state.bodies.position[0], s.state.bodies.velocity[0]);
        assert!(same(s.state.time, t));
        assert!(same(v.x, 3.0 - 5.0 * t) && same(v.y, 0.0), "{t}: {v}");
        assert!(
            same(x.x, 3.0 * t - 2.5 * t * t) && same(x.y, 0.5),
            "{t}: {x}"
        );
        let energy = &s.state.energy;
        assert!(same(energy.friction, before - 0.5 * m * v.x * v.x));
        assert!(same(energy.kinetic + energy.friction, before));
        assert!(energy.residual.abs() < 1e-12);
        let (p, moment) = s.state.received[1];
        assert!(same(p.x, 5.0 * m * H) && same(p.y, -10.0 * m * H), "{p}");
        assert!(same(moment.x, -10.0 * m * H * x_mean), "{moment}");
        assert_eq!(s.state.received[0].0, -p);
    }
    for _ in 0..10 {
        s.step().unwrap();
    }
    assert!(s.state.bodies.velocity[0].norm() < 1e-12);
    let energy = s.state.energy;
    assert!(same(energy.friction, before) && energy.impact.abs() < 1e-12);
}

/// A shear cohesion of 3 Pa over the area of the contact stops the disk earlier: v = 3 - (5 + 3
/// A/m) t, and friction dissipates that energy too.
#[test]
fn shear_cohesion_acts_beside_friction() {
    let law = interface([sticky()]);
    let area = law.area.area(2, 0.5);
    let mut s = slider_of(law);
    let m = s.state.bodies.mass[0];
    let slows = 5.0 + 3.0 * area / m;
    // The disk moves until this step.
    for k in 1..=(3.0 / slows / H) as u32 {
        s.step().unwrap();
        let v = s.state.bodies.velocity[0];
        assert!(
            same(v.x, 3.0 - slows * f64::from(k) * H) && same(v.y, 0.0),
            "{v}"
        );
        assert!(same(s.state.energy.friction, 0.5 * m * (9.0 - v.x * v.x)));
        assert!(s.state.energy.residual.abs() < 1e-12);
    }
    s.step().unwrap();
    assert!(s.state.bodies.velocity[0].norm() < 1e-12);
}

/// The velocity of a falling disk is exact at any theta, its position at theta = 1/2; the scheme
/// dissipates (theta - 1/2) m (g h)^2 in each step.
#[test]
fn a_disk_falls() {
    for theta in [0.5, 0.75, 1.0] {
        let mut s = Simulation::of_disks(&[([0.0, 0.0], 0.5)]);
        s.state.gravity = Vector2::new(0.0, -10.0);
        s.options.scheme = Scheme { h: H, theta };
        let m = s.state.bodies.mass[0];
        for k in 1..=20 {
            s.step().unwrap();
            let (n, t) = (f64::from(k), f64::from(k) * H);
            assert!(same(s.state.bodies.velocity[0].y, -10.0 * t));
            // The sum of -g h^2 (j + theta) over j = 0 to n - 1.
            let y = -10.0 * H * H * (0.5 * n * (n - 1.0) + theta * n);
            assert!(same(s.state.bodies.position[0].y, y));
            let energy = &s.state.energy;
            assert!(same(energy.potential, 10.0 * m * y));
            assert!(same(
                energy.scheme,
                n * (theta - 0.5) * m * (10.0 * H).powi(2)
            ));
            assert!(energy.residual.abs() < 1e-12);
        }
    }
}

/// Two disks held by a bond of k A = 0.5 N/m separate at v: by the midpoint rule the opening is v/w
/// sin(n phi) after n steps and its rate v cos(n phi), with tan(phi/2) = w h/2 and w^2 = 2 k A/m,
/// and no energy is lost.
#[test]
fn a_bond_swings_as_the_midpoint_rule_says() {
    let mut s = Simulation::of_disks(&[([0.0, 0.0], 0.5), ([1.0, 0.0], 0.5)]);
    s.state.bodies.velocity[0].x = -0.0125;
    s.state.bodies.velocity[1].x = 0.0125;
    let mut s = s.with_law(interface([bond()]));
    s.options.scheme = Scheme { h: H, theta: 0.5 };
    let m = s.state.bodies.mass[0];
    // An area of half of the radius.
    let stiffness = 2.0 * 0.25;
    let w = (2.0 * stiffness / m).sqrt();
    let phi = 2.0 * (0.5 * w * H).atan();
    let (v, all) = (0.025, m * 0.0125 * 0.0125);
    // Half an oscillation is 178 steps.
    for k in 1..=150 {
        s.step().unwrap();
        let angle = f64::from(k) * phi;
        let bodies = &s.state.bodies;
        let opening = bodies.position[1].x - bodies.position[0].x - 1.0;
        let speed = bodies.velocity[1].x - bodies.velocity[0].x;
        assert!((opening - v / w * angle.sin()).abs() < 1e-12, "{k}");
        assert!((speed - v * angle.cos()).abs() < 1e-12, "{k}");
        let energy = &s.state.energy;
        let stored = 0.5 * stiffness * opening * opening;
        assert!((energy.elastic - stored).abs() < 1e-14, "{k}");
        assert!((energy.kinetic + energy.elastic - all).abs() < 1e-14, "{k}");
        assert!(energy.residual.abs() < 1e-14 && energy.viscous.abs() < 1e-14);
        let network = &s.state.network;
        let kept = &network.memory[0].bonds[0];
        assert!((kept.opening_n - opening).abs() < 1e-14 && kept.intact());
        assert!((kept.energies.work[0] - stored).abs() < 1e-14);
        assert_eq!((network.bonds_made(), network.bonds_broken()), (1, 0));
    }
}

/// Phases of 8, 4 and 2 steps have friction of 0.5, then none, then 0.25 under twice the weight,
/// which gives the initial force. The run ends with the last phase.
#[test]
fn phases_change_gravity_and_friction() {
    let mut s = slider();
    let phase = |name: &str, steps, friction, gravity: f64| Phase {
        name: name.into(),
        until: Some(Until::Steps(steps)),
        changes: Changes {
            contact: vec![(0, 0, friction)],
            gravity: Some([0.0, -gravity, 0.0]),
            drives: Vec::new(),
            holders: Vec::new(),
            gravity_drive: None,
            open: Vec::new(),
            tolerance: None,
        },
        recurs: false,
    };
    s.phases = vec![
        phase("rub", 8, 0.5, 10.0),
        phase("glide", 4, 0.0, 10.0),
        phase("press", 2, 0.25, 20.0),
    ];
    for k in 1..=14 {
        assert!(!s.finished());
        s.step().unwrap();
        let rubbed = f64::from(k.min(8) + (k - 12).max(0)) * H;
        let v = s.state.bodies.velocity[0].x;
        assert!(same(v, 3.0 - 5.0 * rubbed), "step {k}: {v}");
        assert_eq!(
            s.laws[0].contact().parameters,
            [[0.5, 0.0, 0.25][usize::from(k > 8) + usize::from(k > 12)]]
        );
    }
    assert!(s.finished());
}

const STEEL: ThermalMaterial = ThermalMaterial {
    conductivity: 50.0,
    heat_capacity: 500.0,
    density: 8000.0,
    resistivity: None,
};

/// Heat of two bodies of one node each.
fn heat() -> Heat {
    Heat {
        materials: vec![STEEL],
        pairs: Heat::pairs(&[STEEL]),
        material: vec![0; 2],
        nodes: vec![BodyNodes::One(0), BodyNodes::One(1)],
        columns: Vec::new(),
        elements: Vec::new(),
        first_bodies: vec![("second".into(), 1..2)],
        imposed: Vec::new(),
        initial: 300.0,
        shares: HeatShares::default(),
        partition: Partition::default(),
        theta: 1.0,
        clock: 1.0,
        every: 1,
        start: 0.0,
        flash: None,
        circuit: None,
    }
}

fn nodes(list: [(f64, f64); 2]) -> HeatState {
    let node = |(t, c)| Node::new(t, Store::Lumped(c));
    HeatState::new(list.map(node).to_vec(), 1)
}

/// Two disks of 1 and 2 J/K at 400 and 300 K are joined by 3 W/K, and the first is heated by 5 W:
/// with implicit Euler over a time t the difference d becomes (d + 5 t/1)/(1 + 3 t (1/1 + 1/2)),
/// and 3 W/K times it flows. A step of the heat spans a number of steps of the mechanics, each of
/// the clock times h. Heat begins to flow at its start time.
#[test]
fn two_disks_come_to_one_temperature() {
    for (every, clock, start) in [
        (1, 1.0, 0.0),
        (3, 1.0, 0.0),
        (2, 4.0, 0.0),
        (2, 1.0, 4.0 * H),
    ] {
        let disks = [([0.0, 0.0], 0.5), ([1.0, 0.0], 0.5)];
        let mut s = Simulation::of_disks(&disks).with_law(interface([constant()]));
        s.options.scheme = Scheme { h: H, theta: 0.5 };
        let imposed = vec![ImposedHeatFlow {
            body: None,
            node: 0,
            flow: 5.0,
        }];
        let heat = Heat {
            every,
            clock,
            start,
            imposed,
            ..heat()
        };
        HeatFlow::add_to(&mut s, heat, nodes([(400.0, 1.0), (300.0, 2.0)]));
        let begun = (start / H) as u64;
        let span = every as f64 * clock * H;
        let (mut differ, mut put) = (100.0, 0.0);
        let mut flown = 0.0;
        for k in 1..=24 {
            s.step().unwrap();
            if k > begun {
                put += 5.0 * clock * H;
            }
            if k > begun && (k - begun).is_multiple_of(every) {
                differ = (differ + 5.0 * span) / (1.0 + 4.5 * span);
                flown += 3.0 * differ * span;
            }
            let state = s.state.heat.as_ref().unwrap();
            let [a, b] = [0, 1].map(|n| s.temperature(n).unwrap());
            assert!(same(a - b, differ), "{every} {clock} {k}: {a} {b} {differ}");
            assert!(same(b, 300.0 + flown / 2.0), "{every} {clock} {k}");
            assert!(same(state.received[0], flown));
            let ledger = &state.ledger;
            assert!(same(ledger.imposed, put));
            assert!(same(ledger.stored + ledger.pending, put));
            assert!(ledger.residual.abs() < 1e-12 && ledger.fixed == 0.0);
        }
    }
}

/// The friction of a sliding disk heats disk and chain by half each, since they have the same
/// material; or by the shares of the case; or one side only where the other is insulated, and
/// neither where both are.
#[test]
fn friction_warms_both_sides() {
    let (one, two) = (BodyNodes::One(0), BodyNodes::One(1));
    let none = BodyNodes::Insulated;
    for (nodes_of, share, parts) in [
        ([one.clone(), two.clone()], 1.0, [0.5, 0.5]),
        ([one.clone(), two.clone()], 0.75, [0.375, 0.375]),
        ([none.clone(), two], 1.0, [0.0, 1.0]),
        ([one, none.clone()], 1.0, [1.0, 0.0]),
        ([none.clone(), none], 1.0, [0.0, 0.0]),
    ] {
        let mut s = slider();
        let shares = HeatShares {
            friction: share,
            ..HeatShares::default()
        };
        let heat = Heat {
            nodes: nodes_of.to_vec(),
            shares,
            ..heat()
        };
        HeatFlow::add_to(&mut s, heat, nodes([(300.0, 0.5), (310.0, 2.0)]));
        for _ in 0..30 {
            s.step().unwrap();
        }
        let friction = s.state.energy.friction;
        let state = s.state.heat.as_ref().unwrap();
        let [a, b] = [0, 1].map(|n: usize| state.nodes[n].temperature);
        assert!(same(a, 300.0 + parts[0] * friction / 0.5), "{a}");
        assert!(same(b, 310.0 + parts[1] * friction / 2.0), "{b}");
        assert!(same(state.received[0], parts[1] * friction));
        let ledger = &state.ledger;
        assert!(same(ledger.dissipated, share * friction));
        let into_nothing = share - parts[0] - parts[1];
        assert!(same(ledger.fixed, into_nothing * friction));
        assert!(ledger.residual.abs() < 1e-12);
    }
}

/// Where a hardness is given a contact is warmer than its bodies by the rise that follows from its
/// force, speed and friction, in thermal time, from the second step on.
#[test]
fn a_sliding_contact_flashes() {
    for clock in [1.0, 4.0] {
        let mut s = slider();
        let m = s.state.bodies.mass[0];
        let heat = Heat {
            flash: Some(1e9),
            clock,
            ..heat()
        };
        HeatFlow::add_to(
            &mut s,
            heat.clone(),
            nodes([(300.0, 1e300), (300.0, 1e300)]),
        );
        for k in 0..10 {
            s.step().unwrap();
            let seen = &s.state.network.thermal.as_ref().unwrap().temperatures[0];
            let [mean, a, b] = seen.temperature;
            assert_eq!((a, b), (300.0, 300.0));
            // The rise uses the force of the last step, and the speed at the start of this one.
            let (force, v) = (10.0 * m, (3.0 - 5.0 * f64::from(k) * H) / clock);
            let rise = match k {
                0 => 0.0,
                _ => heat.flash_rise::<Dim2>([0, 1], force, v, 0.5 * force * v),
            };
            assert!(k == 0 || rise > 1e-9, "{rise}");
            assert!(
                (mean - 300.0 - rise).abs() < 1e-9 * (1.0 + rise),
                "{mean} {rise}"
            );
        }
    }
}

/// A disk of mass m and inertia m r^2/2 moves at 2 m/s and 3 rad/s: an impulse p along its motion
/// and L about its axis do the work p v + p^2/(2 m) and L w + L^2/(m r^2).
#[test]
fn the_work_of_an_impulse_is_that_of_the_mean_velocity() {
    let mut s = Simulation::of_disks(&[([0.0, 0.0], 0.5)]);
    let m = s.state.bodies.mass[0];
    s.state.bodies.velocity[0].x = 2.0;
    s.state.bodies.spin[0].x = 3.0;
    let (p, l) = (0.5, 0.25);
    s.apply_impulse(0, &Vector2::new(p, 0.0), &nalgebra::Vector1::new(l));
    let work = p * 2.0 + p * p / (2.0 * m) + l * 3.0 + l * l / (m * 0.25);
    assert!(same(s.state.energy.external_work, work));
    assert!(same(s.state.bodies.velocity[0].x, 2.0 + p / m));
}

/// Contact spots do not heat up without a force, without sliding, or without heat.
#[test]
fn spots_rise_where_a_sliding_contact_is_heated() {
    let heat = Heat {
        flash: Some(1e9),
        ..heat()
    };
    let rise = |force, v, power| heat.flash_rise::<Dim2>([0, 1], force, v, power);
    assert!(rise(1e3, 1.0, 500.0) > 0.0);
    for [force, v, power] in [[0.0, 1.0, 500.0], [1e3, 0.0, 500.0], [1e3, 1.0, 0.0]] {
        assert_eq!(rise(force, v, power), 0.0);
    }
    assert_eq!(
        super::tests::heat().flash_rise::<Dim2>([0, 1], 1e3, 1.0, 500.0),
        0.0
    );
}

/// A disk grows by 5 mm in each step, far more than the skin of the neighbour list, until it is
/// half the alert distance from a disk that was out of its reach: their contact is found.
#[test]
fn a_disk_that_grows_meets_its_neighbour() {
    let disks = [([0.0, 0.0], 0.5), ([1.1, 0.0], 0.5)];
    let mut s = Simulation::of_disks(&disks).with_law(interface([]));
    s.options.scheme = Scheme { h: H, theta: 0.5 };
    HeatFlow::add_to(&mut s, heat(), nodes([(300.0, 1.0), (300.0, 2.0)]));
    ThermalExpansion::add_to(&mut s, vec![1e-3, 0.0], Vec::new());
    for k in 0..=20 {
        // 0.5 m times 1e-3/K, to 0.5995 m.
        s.state.heat.as_mut().unwrap().nodes[0].temperature = 300.0 + 9.95 * f64::from(k);
        s.step().unwrap();
        let radius = 0.5 + 0.004975 * f64::from(k);
        assert!(same(s.shapes.balls[0].radius, radius), "{k}");
        assert!(s.state.network.contacts.is_empty());
    }
    s.step().unwrap();
    assert_eq!(s.state.network.contacts.len(), 1);
    assert!(same(s.state.network.contacts[0].gap, 0.0005));
}
