//! Drives in sequence, and the biaxial test made with them.

use super::{Table, plane, until};
use crate::scene;
use fretwork::geometry::space::Dim2;
use fretwork::record::biaxial::Biaxial;
use fretwork::record::stress::love_weber;
use fretwork::step::Simulation;

pub fn all(table: &mut Table) {
    cart(table);
    lid(table);
    biaxial(table);
}

fn place(s: &Simulation<Dim2>, name: &str) -> usize {
    let found = s.state.bodies.driven.iter().position(|d| d.name == name);
    found.unwrap_or_else(|| panic!("a body named {name}"))
}

/// The drive is F for t1, then V, then -F. At theta = 1/2 the scheme is exact: V begins with a jump
/// of the velocity at the position of the cart.
fn cart(table: &mut Table) {
    let (f, m, v2, t1) = (10.0, 5.0, -0.7, 0.2);
    let mut s = plane("staged_drive", &[]);
    let b = s.state.bodies.driven[place(&s, "cart")].body as usize;
    let x0 = s.state.bodies.position[b].x;
    let name = "staged_drive";
    until(&mut s, t1, |_| {});
    let v1 = f * t1 / m;
    let x1 = 0.5 * v1 * t1;
    let (v, x) = (
        s.state.bodies.velocity[b].x,
        s.state.bodies.position[b].x - x0,
    );
    table.compare(name, "pushed: F t/m (m/s)", v1, v, 1e-12);
    table.compare(name, "pushed: F t^2/(2 m) (m)", x1, x, 1e-12);
    until(&mut s, 0.3, |_| {});
    let x2 = x1 + v2 * 0.1;
    let (v, x) = (
        s.state.bodies.velocity[b].x,
        s.state.bodies.position[b].x - x0,
    );
    table.compare(name, "moved: V (m/s)", v2, v, 0.0);
    table.compare(name, "moved: place (m)", x2, x, 1e-12);
    until(&mut s, 0.5, |_| {});
    let (v3, t) = (v2 - f * 0.2 / m, 0.2);
    let x3 = x2 + v2 * t - 0.5 * f / m * t * t;
    let (v, x) = (
        s.state.bodies.velocity[b].x,
        s.state.bodies.position[b].x - x0,
    );
    table.compare(name, "pushed again: V - F t/m (m/s)", v3, v, 1e-12);
    table.compare(name, "pushed again: place (m)", x3, x, 1e-12);
}

/// The lid falls through the gap and rests on the grain, then it is lifted. The work is F times the
/// gap, lost in impacts, then m V^2/2.
fn lid(table: &mut Table) {
    let (f, gap, m, v) = (100.0, 0.01, 4.0, 0.3);
    let mut s = plane("staged_drive", &[]);
    let name = "staged_drive";
    let lid = place(&s, "lid");
    let cart = s.state.bodies.driven[place(&s, "cart")].body as usize;
    let cart_work = |s: &Simulation<Dim2>| 0.5 * 5.0 * s.state.bodies.velocity[cart].x.powi(2);
    until(&mut s, 0.2, |_| {});
    let felt = s.state.received[lid].0.y / s.options.scheme.h;
    table.compare(name, "the lid feels F (N/m)", f, felt, 1e-9);
    let work = s.state.energy.external_work - cart_work(&s);
    table.compare(name, "work F g (J/m)", f * gap, work, 1e-9);
    until(&mut s, 0.25, |_| {});
    table.compare(
        name,
        "lifted it feels nothing (N/m)",
        0.0,
        s.state.received[lid].0.y,
        0.0,
    );
    let work = s.state.energy.external_work - cart_work(&s);
    table.compare(
        name,
        "work F g + m V^2/2 (J/m)",
        f * gap + 0.5 * m * v * v,
        work,
        1e-9,
    );
    table.compare(
        name,
        "residual over largest energy",
        0.0,
        s.state.energy.relative_residual(),
        1e-12,
    );
}

/// Momentum of the driven walls and half of that of the grains. Its rate is the difference between
/// the mean force on two walls and the load.
fn momentum(s: &Simulation<Dim2>) -> [f64; 2] {
    let walls = ["right", "top"].map(|name| s.state.bodies.driven[place(s, name)].body as usize);
    let mut sum = [0.0; 2];
    for b in 0..s.state.bodies.len() {
        let share = if walls.contains(&b) { 1.0 } else { 0.5 };
        let v = s.state.bodies.velocity[b];
        for (k, v) in [v.x, v.y].into_iter().enumerate() {
            if s.state.bodies.inverse_mass[b][k] > 0.0 {
                sum[k] += share * s.state.bodies.mass[b] * v;
            }
        }
    }
    sum
}

/// At rest the stress is given by forces over lengths, and by the Love-Weber stress. Then the
/// strain follows from the wall's motion.
fn biaxial(table: &mut Table) {
    let name = "biaxial";
    let loaded = scene::loaded("verification/biaxial", &[""; 0]);
    let mut s = scene::simulation::<Dim2>(&loaded);
    let spec = loaded
        .case
        .biaxial
        .as_ref()
        .unwrap_or_else(|| panic!("a test"));
    let mut test = Biaxial::new(spec, &s).unwrap_or_else(|| panic!("its walls"));
    // While grains collide the forces need few digits; at rest they need all.
    let tolerance = s.options.solver.tolerance;
    until(&mut s, 0.3, |s| test.follow(s));
    s.options.solver.tolerance = 1e-9;
    let last = 0.4 - 1.5 * s.options.scheme.h;
    until(&mut s, last, |s| test.follow(s));
    let before = momentum(&s);
    until(&mut s, 0.4, |s| test.follow(s));
    let after = momentum(&s);
    let at = |s: &Simulation<Dim2>, name: &str| {
        s.state.bodies.position[s.state.bodies.driven[place(s, name)].body as usize]
    };
    // The left wall is 0.01 m below zero, the right one 0.14 m from its frame.
    let width = at(&s, "right").x + 0.14 + 0.01;
    let height = at(&s, "top").y;
    let state = test.state(&s);
    // The sample is not quite at rest: a driven wall has the push F and its inertia, the wall
    // across also the inertia of grains.
    let inertia = [0, 1].map(|k| (after[k] - before[k]) / s.options.scheme.h);
    table.compare(
        name,
        "axial stress F/L at rest (Pa)",
        (1000.0 + inertia[1]) / width,
        state.walls[0],
        1e-6,
    );
    table.compare(
        name,
        "lateral stress F/L at rest (Pa)",
        (1500.0 + inertia[0]) / height,
        state.walls[1],
        1e-6,
    );
    let (walls, contacts) = (state.pressure_walls, state.pressure_contacts);
    table.compare(
        name,
        "Love-Weber pressure is that of walls",
        walls,
        contacts,
        1e-6,
    );
    let stress = love_weber(&s, width * height);
    for (k, axis) in ["lateral", "axial"].into_iter().enumerate() {
        let quantity = format!("Love-Weber stress, {axis} (Pa)");
        table.compare(name, &quantity, state.walls[1 - k], stress[k][k], 1e-6);
    }
    s.options.solver.tolerance = tolerance;
    until(&mut s, 0.5, |s| test.follow(s));
    let strain = test.state(&s).axial_strain;
    let expected = 0.02 * 0.1 / height;
    table.compare(name, "axial strain V t/L", expected, strain, 1e-4);
    table.compare(
        name,
        "residual over largest energy",
        0.0,
        s.state.energy.relative_residual(),
        1e-9,
    );
}
