//! The fretting layer of angular grains with elastic contacts, in a window of a fifth: its steps
//! are solved to any tolerance, and report their errors.

use crate::scene;
use fretwork::geometry::space::Dim2;
use fretwork::solve::Report;
use fretwork::solve::error::Norm;
use fretwork::step::Simulation;

/// The layer before it is loaded.
fn layer(more: &[&str]) -> Simulation<Dim2> {
    let window = [
        "periodic.x=8e-5",
        "grains.0.high=[8e-5, 4.32e-5]",
        "bodies.rail.shapes.0.points=160",
        "bodies.wheel.shapes.0.points=160",
        "bodies.rail.shapes.0.longest=4e-5",
        "bodies.wheel.shapes.0.longest=4e-5",
        "bodies.wheel.mass=2200.0",
        "bodies.wheel.dofs.y=Force(Table([(0.0, -448.0), (0.005, -448.0), (0.022, -8.96e4)]))",
    ];
    scene::case("wheel_rail_fretting", &[&window[..], more].concat())
}

/// The layer at 1.12 GPa, shortly after the wheel began to slide.
fn sliding(more: &[&str]) -> Simulation<Dim2> {
    let mut s = layer(more);
    while s.state.time < 0.027 {
        s.step().unwrap();
    }
    assert_eq!(s.state.network.step_size.warning(), None);
    s
}

fn slips(s: &mut Simulation<Dim2>, norm: Norm, tolerance: f64, most: u32) -> Vec<Report> {
    let solver = &mut s.options.solver;
    (solver.norm, solver.tolerance, solver.max_iterations) = (norm, tolerance, most);
    (0..20).map(|_| s.step().unwrap().solver).collect()
}

/// A prototype found that the number of sweeps to 1e-8 grows as 55 sqrt(k h^2/m), with up to 29 for
/// the root here: 300.
#[test]
fn elastic_contacts_are_solved_to_any_tolerance_while_they_slip() {
    let mut s = sliding(&[]);
    for (tolerance, most) in [(1e-6, 1000), (1e-8, 2000)] {
        for report in slips(&mut s, Norm::Balance, tolerance, most) {
            assert!(report.converged, "{report:?} at {tolerance}");
            // The heat of the residuals vanishes with the tolerance.
            let parts = report.parts;
            assert!(
                parts.slip_energy > 0.0 && parts.contact_law < 1e3 * tolerance,
                "{parts:?}"
            );
        }
    }
}

/// With a tenth of the inertia rigid contacts reach the tolerance of the rigid fretting case,
/// although velocities are wrong. The heat of the residuals reports it: it is above the half of the
/// heat of slip that the norm `Power` permits, and below which it remains with springs.
#[test]
fn the_parts_of_the_error_tell_loose_velocities() {
    let law = |interface: &str| format!("interfaces.{interface}.contact=coulomb");
    let laws = ["third_body", "rail_oxide", "wheel_oxide"].map(law);
    let mut rigid: Vec<&str> = laws.iter().map(String::as_str).collect();
    rigid.extend([
        "solver.norm=Balance",
        "solver.tolerance=1e-3",
        "solver.correction=0.05",
        "time.step=5e-5",
        "inertia_scaling=5.8e7",
    ]);
    let heat = |mut s: Simulation<Dim2>, norm, tolerance| {
        let reports = slips(&mut s, norm, tolerance, 20_000);
        let sum = |f: fn(&Report) -> f64| reports.iter().map(f).sum::<f64>();
        assert!(reports.iter().all(|r| r.converged), "{reports:?}");
        sum(|r| r.parts.contact_law * r.parts.slip_energy) / sum(|r| r.parts.slip_energy)
    };
    let elastic = heat(sliding(&["inertia_scaling=5.8e7"]), Norm::Power, 0.5);
    let rigid = heat(sliding(&rigid), Norm::Balance, 1e-3);
    println!("heat of residuals over that of slip: rigid {rigid:.2}, elastic {elastic:.2}");
    assert!(elastic <= 0.5 && rigid > 0.5, "{elastic} and {rigid}");
}

/// Contact points of polygons, and pairs that meet within a step, are found by several threads:
/// more than 256 pairs, with bonds, under a wheel that initially falls by the size of a grain per
/// step.
#[test]
fn threads_do_not_change_a_bit_of_a_layer_of_polygons() {
    let bits = |threads: usize| {
        let bonds = |interface: &str| format!("interfaces.{interface}.bonds=At(0.0015)");
        let mut sets = ["third_body", "rail_oxide", "wheel_oxide"]
            .map(bonds)
            .to_vec();
        sets.push("bodies.wheel.dofs.y=Force(Constant(-8.96e4))".to_owned());
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let mut s = layer(&sets);
        s.options.solver.parallel = threads > 1;
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            for _ in 0..120 {
                s.step().unwrap();
            }
        });
        let memory = &s.state.network.memory;
        assert!(s.state.network.contacts.len() > 512 && memory.iter().any(|m| m.broken > 0));
        assert!(s.state.network.step_size.foreseen > 0);
        let bodies = &s.state.bodies;
        let places = bodies.position.iter().chain(&bodies.velocity);
        let places = places.flat_map(|v| [v.x.to_bits(), v.y.to_bits()]);
        let bonds = memory.iter().flat_map(|m| &m.bonds);
        let bonds = bonds.flat_map(|b| [b.damage.to_bits(), b.opening_t.norm().to_bits()]);
        let keys = s.state.network.contacts.iter();
        let keys = keys.flat_map(|c| [c.key.feature, c.gap.to_bits()]);
        let bits: Vec<u64> = places.chain(bonds).chain(keys).collect();
        bits
    };
    let one = bits(1);
    assert!(one == bits(2), "two threads");
    assert!(one == bits(3), "three threads");
}
