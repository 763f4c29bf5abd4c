//! Heat and current: the cases of `cases/verification/thermal/`.

mod elements;
mod expansion;
mod sources;

use super::{Table, plane, solid, until};
use fretwork::geometry::space::{Dim3, Space};
use fretwork::heat::HeatState;
use fretwork::record::encoding::{decode, encode};
use fretwork::step::Simulation;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// Effusivity of the steel of the cases (W s^(1/2)/(m^2 K)): k = 50, c = 450, rho = 7850.
fn effusivity() -> f64 {
    (50.0f64 * 450.0 * 7850.0).sqrt()
}

pub fn all(table: &mut Table) {
    sliding(table);
    account(table);
    half_space(table);
    order_in_step(table);
    two_half_spaces(table);
    cubic(table);
    series_and_parallel(table);
    network(table);
    band(table);
    wheel_and_rail(table);
    run_away(table);
    sources::all(table);
    expansion::all(table);
    elements::all(table);
}

fn heat<S: Space>(s: &Simulation<S>) -> &HeatState {
    s.state.heat.as_ref().expect("the case computes heat")
}

fn temperature<S: Space>(s: &Simulation<S>, body: &str) -> f64 {
    let body = s.body_named(body).expect("a body of this name");
    s.temperature(body).expect("a temperature")
}

/// Surface nodes of a body.
fn surface<S: Space>(s: &Simulation<S>, body: &str) -> Vec<f64> {
    let body = s.body_named(body).expect("a body of this name");
    let nodes = s.heat().expect("heat").nodes[body].range();
    heat(s).nodes[nodes].iter().map(|n| n.temperature).collect()
}

fn sliding(table: &mut Table) {
    let case = "thermal/slide_to_stop";
    let mut s = plane(case, &[]);
    let block = s.body_named("block").expect("a block");
    s.state.bodies.velocity[block].x = 1.0;
    s.set_in_motion();
    let lost = 0.5 * s.state.bodies.mass[block];
    until(&mut s, 0.4, |_| ());
    table.compare(
        case,
        "heat is the kinetic energy lost (J/m)",
        lost,
        heat(&s).ledger.stored,
        1e-10,
    );
    let rise = 1.0 / (4.0 * 450.0);
    table.compare(
        case,
        "block is warmer by v^2/(4 c) (K)",
        rise,
        temperature(&s, "block") - 300.0,
        1e-9,
    );
    let halves = [&heat(&s).received[0], &heat(&s).received[1]];
    table.compare(
        case,
        "half of it in the floor",
        0.5 * lost,
        *halves[0],
        1e-10,
    );
}

/// The sum of all dissipated energies is heat, with bonds, current, convection and an imposed flow.
fn account(table: &mut Table) {
    let case = "thermal/energy";
    for (theta, every) in [("1.0", "1"), ("0.5", "1"), ("1.0", "7")] {
        let sets = [
            &format!("heat.theta={theta}")[..],
            &format!("heat.every={every}"),
        ];
        let mut s = plane(case, &sets);
        until(&mut s, 0.1, |_| ());
        let energy = s.energies();
        assert!(energy.fracture > 0.0 && energy.friction > 0.0 && energy.impact > 0.0);
        let put_in = energy.friction
            + energy.impact
            + energy.viscous
            + energy.adhesion
            + 0.3 * energy.fracture;
        let ledger = heat(&s).ledger;
        assert!(ledger.joule > 0.0 && ledger.surroundings < 0.0 && ledger.imposed > 0.0);
        let name = format!("theta {theta}, every {every}: heat put in (J/m)");
        table.compare(case, &name, put_in, ledger.dissipated, 1e-10);
        let name = format!("theta {theta}, every {every}: account closes");
        table.closes(case, &name, ledger.relative_residual(), 1e-10);
        table.closes(case, "energy closes", energy.relative_residual(), 1e-10);
    }
    continued(case, 0.05, 0.07);
}

/// A case continued from the bytes of its state at a time (s) is bit-identical at a later time.
fn continued(case: &str, at: f64, end: f64) {
    let mut s = plane(case, &[]);
    until(&mut s, at, |_| ());
    let bytes = encode(&s.state).expect("bytes");
    let mut again = plane(case, &[]);
    assert!(again.restore(decode(&bytes).expect("a state")));
    until(&mut s, end, |_| ());
    until(&mut again, end, |_| ());
    let same = encode(&s.state).expect("bytes") == encode(&again.state).expect("bytes");
    assert!(same, "{case}: continued");
}

fn half_space(table: &mut Table) {
    let case = "thermal/half_space";
    let exact = 2.0 * 1e6 * (1e-2 / PI).sqrt() / effusivity();
    let rise = |step: &str, theta: &str| {
        let sets = [
            &format!("time.step={step}")[..],
            &format!("heat.theta={theta}"),
            // The grid is equal for all steps.
            "heat.bodies.rail.store.spacing=1e-6",
            "heat.bodies.rail.store.growth=1.05",
        ];
        let mut s = plane(case, &sets);
        until(&mut s, 1e-2, |_| ());
        temperature(&s, "rail") - 300.0
    };
    let mut s = plane(case, &[]);
    until(&mut s, 1e-2, |_| ());
    table.compare(
        case,
        "2 q sqrt(t/pi)/e (K)",
        exact,
        temperature(&s, "rail") - 300.0,
        1e-2,
    );
    // The error of the grid remains at the smallest steps.
    let order = |theta: &str| {
        let [a, b, c] = ["4e-4", "2e-4", "1e-4"].map(|step| rise(step, theta));
        ((a - b) / (b - c)).abs().log2()
    };
    table.compare(case, "order in step, theta = 1", 1.0, order("1.0"), 0.1);
    table.compare(
        case,
        "smallest step, theta = 1 (K)",
        exact,
        rise("1e-5", "1.0"),
        1e-3,
    );
    table.compare(
        case,
        "smallest step, theta = 0.55 (K)",
        exact,
        rise("1e-5", "0.55"),
        1e-3,
    );
}

/// A warm grain on a cold floor cools through their contact: T = T_0 + dT exp(-G t/C), of first
/// order in the step for theta = 1 and of second order for 1/2.
fn order_in_step(table: &mut Table) {
    let case = "thermal/expanding_column";
    let sets = [
        "grains=[List(material: \"steel\", grains: [(at: [0.0, 1e-3], radius: 1e-3)])]",
        "bodies.load.position=[0.0, 2e-3]",
        "interfaces.0.transport=constant-conductance",
        "interfaces.0.parameters=(transport: {\"thermal\": 50.0, \"reach\": 1e-5})",
        "heat=(initial: 300.0, grains: {\"steel\": 400.0}, bodies: {\"load\": (store: Insulated)})",
    ];
    let capacity = 7850.0 * 450.0 * PI * 1e-6;
    let exact = 300.0 + 100.0 * f64::exp(-50.0 * 0.2 / capacity);
    let error = |step: &str, theta: &str| {
        let own = [format!("time.step={step}"), format!("heat.theta={theta}")];
        let all = sets.iter().copied().chain(own.iter().map(String::as_str));
        let mut s = plane(case, &all.collect::<Vec<&str>>());
        until(&mut s, 0.2, |_| ());
        let grain = s.state.bodies.grains().next().expect("a grain");
        (s.temperature(grain).expect("a temperature") - exact).abs()
    };
    for (theta, expected) in [("1.0", 1.0), ("0.5", 2.0)] {
        let [a, b, c] = ["1e-2", "5e-3", "2.5e-3"].map(|step| error(step, theta));
        for (coarse, fine) in [(a, b), (b, c)] {
            let name = format!("a grain that cools: order in step, theta = {theta}");
            table.compare(case, &name, expected, (coarse / fine).log2(), 0.03);
        }
    }
}

fn two_half_spaces(table: &mut Table) {
    let case = "thermal/two_half_spaces";
    let mut s = plane(case, &[]);
    let (steel, oxide) = (effusivity(), (4.0f64 * 650.0 * 5000.0).sqrt());
    let meet = (steel * 400.0 + oxide * 300.0) / (steel + oxide);
    until(&mut s, 1e-2, |_| ());
    for body in ["floor", "block"] {
        let name = format!("surface of the {body} (K)");
        table.compare(case, &name, meet, temperature(&s, body), 1e-5);
    }
    // The flow is divided by the difference of the temperatures, also in the middle of the run.
    let mut s = plane(case, &[]);
    until(&mut s, 3e-3, |_| ());
    let off = (temperature(&s, "floor") - meet) / 100.0;
    table.compare(case, "over the difference, at 3 ms", 0.0, off, 1e-3);
}

fn cubic(table: &mut Table) {
    let case = "thermal/cubic";
    let mut s = solid(case, &[]);
    until(&mut s, 4e-2, |_| ());
    let forces: Vec<f64> = s
        .contacts()
        .map(|c| c.normal_force)
        .filter(|f| *f > 0.0)
        .collect();
    assert_eq!(forces.len(), 9 * 5);
    for force in &forces {
        assert!((force / 10.0 - 1.0).abs() < 1e-9, "{force}");
    }
    let modulus: f64 = 210e9 / (2.0 * (1.0 - 0.09));
    let a = (0.75 * 10.0 * 0.5e-3 / modulus).cbrt();
    let d = 2e-3;
    // The gradient is taken between two layers in the middle.
    let of = |s: &Simulation<Dim3>, z: f64| {
        let near = |b: &usize| (s.positions()[*b].z - z).abs() < 1e-4;
        let layer: Vec<f64> = (0..36)
            .filter(near)
            .filter_map(|b| s.temperature(b))
            .collect();
        assert_eq!(layer.len(), 9);
        layer.iter().sum::<f64>() / 9.0
    };
    let before = heat(&s).received[0];
    let step = s.options.scheme.h * 1e9;
    s.step().expect("a step");
    let flow = (heat(&s).received[0] - before) / step;
    let found = flow * d / ((of(&s, 5e-3) - of(&s, 3e-3)) * 9.0 * d * d);
    table.compare(
        case,
        "k_eff = 2 k a/d (W/(m K))",
        2.0 * 50.0 * a / d,
        found,
        1e-8,
    );
}

fn series_and_parallel(table: &mut Table) {
    let case = "thermal/cubic";
    let sets = [
        "interfaces.0.transport=\"constant-conductance\"",
        "interfaces.0.parameters.transport={\"electric\": 3.0, \"thermal\": 2.0}",
        "heat.circuit=Some((from: \"hot\", to: \"cold\", supply: Current(current: 6.0, limit: 1e3)))",
    ];
    let mut s = solid(case, &sets);
    until(&mut s, 4e-2, |_| ());
    let circuit = &heat(&s).circuit;
    // There are 9 columns of 5 contacts of 3 S.
    table.compare(
        case,
        "5 in series, 9 in parallel (ohm)",
        5.0 / 27.0,
        1.0 / circuit.conductance,
        1e-12,
    );
    table.compare(
        case,
        "voltage (V)",
        6.0 * 5.0 / 27.0,
        circuit.voltage,
        1e-12,
    );
    let before = heat(&s).ledger.joule;
    s.step().expect("a step");
    let power = (heat(&s).ledger.joule - before) / (s.options.scheme.h * 1e9);
    table.compare(
        case,
        "Joule's heat is R I^2 (W)",
        36.0 * 5.0 / 27.0,
        power,
        1e-8,
    );
}

/// An independent dense solution of the network of the last step.
fn network(table: &mut Table) {
    let case = "thermal/network";
    let mut s = plane(case, &[]);
    until(&mut s, 2e-2, |_| ());
    let n = s.body_count();
    let mut matrix = DMatrix::<f64>::zeros(n, n);
    let thermal = s.state.network.thermal.as_ref().expect("conductances");
    for (contact, [_, g]) in s.state.network.contacts.iter().zip(&thermal.conductance) {
        let [a, b] = contact.bodies.map(|x| x as usize);
        for (i, j) in [(a, b), (b, a)] {
            matrix[(i, i)] += g;
            matrix[(i, j)] -= g;
        }
    }
    let [upper, lower] = ["upper", "lower"].map(|name| s.body_named(name).expect("a body"));
    let laplacian = matrix.clone();
    let mut right = DVector::<f64>::zeros(n);
    for k in 0..n {
        // A node that no path reaches has no defined potential.
        if k == upper || k == lower || laplacian[(k, k)] == 0.0 {
            matrix.row_mut(k).fill(0.0);
            matrix[(k, k)] = 1.0;
            right[k] = f64::from(u8::from(k == upper));
        }
    }
    let potential = matrix.lu().solve(&right).expect("a regular network");
    let current = (laplacian * &potential)[upper];
    let circuit = &heat(&s).circuit;
    table.compare(
        case,
        "conductance (S/m)",
        current,
        circuit.conductance,
        1e-12,
    );
    let off = potential
        .iter()
        .zip(&circuit.potential)
        .map(|(v, found)| (v - found / circuit.voltage).abs())
        .fold(0.0, f64::max);
    table.compare(
        case,
        "largest error of a potential, of 1 V",
        0.0,
        off,
        1e-11,
    );
}

fn band(table: &mut Table) {
    let case = "thermal/band";
    let (b, v, q) = (1e-3, 1.0, 0.3 * 1e3 / 2e-3);
    let exact = 2.0 * q * (2.0f64 * b / v).sqrt() / (effusivity() * PI.sqrt());
    let mut s = plane(case, &[]);
    until(&mut s, 3e-3, |_| ());
    let highest = surface(&s, "floor").into_iter().fold(0.0, f64::max) - 300.0;
    table.compare(
        case,
        "2 q sqrt(2 b/V)/(e sqrt(pi)) (K)",
        exact,
        highest,
        2e-2,
    );
}

fn wheel_and_rail(table: &mut Table) {
    let case = "thermal/wheel_rail";
    let mut s = plane(case, &[]);
    until(&mut s, 5.6e-4, |_| ());
    let surface = surface(&s, "rail");
    let (hottest, highest) = surface
        .iter()
        .copied()
        .enumerate()
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .expect("pieces");
    table.compare(case, "warmer by at most (K)", 150.3, highest - 300.0, 2e-2);
    let wheel = s.positions()[s.body_named("wheel").expect("a wheel")].x;
    let period = 3.528e-2;
    let middle = -0.5 * period + period * (hottest as f64 + 0.5) / surface.len() as f64;
    let behind = (wheel - middle + 0.5 * period).rem_euclid(period) - 0.5 * period;
    table.compare(case, "behind the middle, x/a", 0.65, behind / 5.88e-3, 5e-2);
}

fn run_away(table: &mut Table) {
    let case = "thermal/runaway";
    // The closed form has mu = mu_0 + s (T - 300 K), s = 1e-3 and -1e-4 /K; P V = 1 kW, C = 10 J/K.
    let stable = |sets: &[&str]| {
        let mut s = plane(case, sets);
        until(&mut s, 60.0, |_| ());
        temperature(&s, "block") - 300.0
    };
    table.compare(
        case,
        "cooled: mu_0 P V/(G - s P V) (K)",
        100.0,
        stable(&[]),
        1e-2,
    );
    let falling = stable(&[
        "interfaces.0.parameters.contact.hot=-0.0",
        "interfaces.0.parameters.contact.to=1300.0",
    ]);
    table.compare(
        case,
        "falling: mu_0 P V/(G + s P V) (K)",
        100.0 / 2.1,
        falling,
        1e-3,
    );
    let sets = [
        "heat.bodies.block.convection.coefficient=0.5",
        "time.step=1e-3",
    ];
    let mut s = plane(case, &sets);
    until(&mut s, 40.0, |_| ());
    // The differential equation is dT/dt = 10 + 0.05 T.
    let grown = 200.0 * (2.0f64.exp() - 1.0);
    table.compare(
        case,
        "run-away: exp((s P V - G) t/C) (K)",
        grown,
        temperature(&s, "block") - 300.0,
        1e-3,
    );
}
