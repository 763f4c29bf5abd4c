//! Each dissipation of the energy ledger is compared with its own closed form, and with identities
//! that do not follow from the ledger's residual: normal work from the lid's path, forces along a
//! column, momentum in 3D.

use super::{G, Table, plane, solid, until};
use fretwork::geometry::space::{Dim2, Dim3, Space, VectorLike};
use fretwork::step::Simulation;
use nalgebra::Vector3;

pub fn all(table: &mut Table) {
    friction(table);
    impacts(table);
    fracture(table);
    column(table);
    rolling_limit(table);
    lid(table);
    shear(table);
}

fn driven<S: Space>(s: &Simulation<S>, name: &str) -> usize {
    let at = s.state.bodies.driven.iter().position(|d| d.name == name);
    at.unwrap_or_else(|| panic!("there is a body `{name}`"))
}

/// A sliding body loses energy to friction: all of m v^2/2, or k/(1 + k) of it if it ends rolling
/// (rows 3, 4).
fn friction(table: &mut Table) {
    let mut s = plane("slide_to_stop", &[]);
    let b = s.state.bodies.driven[driven(&s, "block")].body as usize;
    s.state.bodies.velocity[b].x = 1.0;
    until(&mut s, 0.4, |_| {});
    let heat = 0.5 * s.state.bodies.mass[b];
    table.compare(
        "slide_to_stop",
        "friction m v^2/2 (J/m)",
        heat,
        s.state.energy.friction,
        1e-9,
    );
    let mut s = plane("slide_to_roll_disk", &[]);
    until(&mut s, 0.2, |_| {});
    let heat = s.state.energy.initial_kinetic * 0.5 / 1.5;
    table.compare(
        "slide_to_roll_disk",
        "friction m v^2/6 (J/m)",
        heat,
        s.state.energy.friction,
        1e-9,
    );
    let mut s = solid("slide_to_roll_sphere", &[]);
    until(&mut s, 0.2, |_| {});
    let heat = s.state.energy.initial_kinetic * 0.4 / 1.4;
    table.compare(
        "slide_to_roll_sphere",
        "friction m v^2/7 (J)",
        heat,
        s.state.energy.friction,
        1e-9,
    );
}

/// A ball that has come to rest has lost m g h0 in its impacts (row 1); with e = 1 it loses nothing
/// (row 6).
fn impacts(table: &mut Table) {
    let mut s = plane("bouncing_ball", &[]);
    until(&mut s, 4.3, |_| {});
    let ball = (0..s.state.bodies.len())
        .find(|b| !s.state.bodies.immovable(*b))
        .unwrap();
    let heat = s.state.bodies.mass[ball] * G;
    table.compare(
        "bouncing_ball",
        "impact m g h0 (J/m)",
        heat,
        s.state.energy.impact,
        1e-2,
    );
    // A bounce loses (1 - e^2) m v^2/2 and does not lift the ball, even where overlaps are removed
    // by a velocity.
    for e in [0.5_f64, 0.9, 1.0] {
        let restitution = format!("interfaces.grain.parameters.contact.restitution_n={e}");
        let sets = ["gravity=[0.0, 0.0]", "solver.correction=0.2", &restitution];
        let mut s = plane("bouncing_ball", &sets);
        s.state.bodies.velocity[ball].y = -10.0;
        until(&mut s, 0.15, |_| {});
        let before = 50.0 * s.state.bodies.mass[ball];
        let up = s.state.bodies.velocity[ball].y;
        for (quantity, expected, obtained) in [
            ("velocity e v (m/s)", 10.0 * e, up),
            (
                "impact (1 - e^2) m v^2/2, over m v^2/2",
                1.0 - e * e,
                s.state.energy.impact / before,
            ),
            (
                "correction, over m v^2/2",
                0.0,
                s.state.energy.correction / before,
            ),
        ] {
            table.compare(
                &format!("bounce, e = {e}"),
                quantity,
                expected,
                obtained,
                1e-9,
            );
        }
    }
    for (case, end) in [("cradle_touching", 5e-4), ("cradle_apart", 0.2)] {
        let mut s = plane(case, &[]);
        until(&mut s, end, |_| {});
        let lost = s.state.energy.impact / s.state.energy.initial_kinetic;
        table.compare(case, "impact over kinetic energy, e = 1", 0.0, lost, 1e-9);
    }
}

/// Of the area w (1 - 1/200) up to 10 u0, beta^2 C u^2/2 = w/200 is still stored, so w (1 - 1/100)
/// was released (row 27).
fn fracture(table: &mut Table) {
    let (c, w, area) = (1e12, 0.1f64, 0.5);
    for case in ["bond_mode_1", "bond_mode_2", "bond_mixed"] {
        let mut s = plane(case, &["time.step=2e-9"]);
        until(&mut s, 10.0 * (w / c).sqrt() / 0.045, |_| {});
        let (released, stored) = (
            s.state.energy.fracture / area,
            s.state.energy.elastic / area,
        );
        table.compare(case, "fracture 0.99 w (J/m^2)", 0.99 * w, released, 1e-3);
        table.compare(case, "still stored w/200 (J/m^2)", w / 200.0, stored, 1e-3);
    }
}

/// Contacts are compared one by one, by height (row 7): the contact under grain k carries n - k
/// grains, k from 0.
fn column(table: &mut Table) {
    let mut s = plane("column", &["solver.tolerance=1e-10"]);
    until(&mut s, 2e-3, |_| {});
    let weight = s.state.bodies.mass.iter().copied().fold(0.0, f64::max) * G;
    let mut carried: Vec<(f64, f64)> = Vec::new();
    for c in &s.state.network.contacts {
        let closest_point = s.state.bodies.position[c.bodies[0] as usize] + c.arms[0];
        carried.push((
            closest_point.y,
            c.normal.dot(&c.impulse) / s.options.scheme.h / weight,
        ));
    }
    carried.sort_by(|a, b| a.0.total_cmp(&b.0));
    table.compare("column", "contacts", 10.0, carried.len() as f64, 0.0);
    let worst = carried
        .iter()
        .enumerate()
        .map(|(k, c)| (c.1 - (10 - k) as f64).abs());
    let worst = worst.fold(0.0, f64::max);
    table.compare(
        "column",
        "n - k + 1 by height, worst error",
        0.0,
        worst,
        1e-8,
    );
}

/// Just above k/(1 + k) tan the body rolls (row 5).
fn rolling_limit(table: &mut Table) {
    fn slip<S: Space>(mut s: Simulation<S>) -> f64 {
        until(&mut s, 0.5, |_| {});
        let b = (0..s.state.bodies.len())
            .find(|b| !s.state.bodies.immovable(*b))
            .unwrap();
        (s.state.bodies.velocity[b][0] - 0.1 * s.state.bodies.spin[b].norm()).abs()
    }
    let set = |k: f64| {
        let mu = 1.01 * k / (1.0 + k) * 30f64.to_radians().tan();
        format!("interfaces.grain.parameters.contact.mu={mu:?}")
    };
    let disk = slip(plane("roll_down_disk", &[&set(0.5)]));
    table.compare(
        "roll_down_disk",
        "slip 1 % above the limit (m/s)",
        0.0,
        disk,
        1e-9,
    );
    let sphere = slip(solid("roll_down_sphere", &[&set(0.4)]));
    table.compare(
        "roll_down_sphere",
        "slip 1 % above the limit (m/s)",
        0.0,
        sphere,
        1e-9,
    );
}

/// Work of a lid, from its contact forces and its path only (not from the ledger's external work).
#[derive(Default)]
struct Lid {
    /// Work of the tangential force on the layer (J).
    drag: f64,
    /// Work of the normal force on the layer (J).
    press: f64,
    /// Integral of P |dx| (J).
    pressure_path: f64,
}

impl Lid {
    fn add<S: Space>(&mut self, received: &S::Vector, h: f64, moved: &S::Vector, normal: usize) {
        self.drag -= received[0] / h * moved[0];
        self.press -= received[normal] / h * moved[normal];
        self.pressure_path += received[normal] / h * moved[0].abs();
    }

    /// Friction from forces less friction from heat. The energy balance of the layer is drag +
    /// press = heat + stored, without the lid's own kinetic energy, so mu from heat is (heat +
    /// stored - press)/(P V).
    fn compare<S: Space>(&self, table: &mut Table, case: &str, s: &Simulation<S>, lid: usize) {
        let e = &s.state.energy;
        let v = s.state.bodies.velocity[lid];
        let layer =
            e.kinetic - 0.5 * s.state.bodies.mass[lid] * v.dot(&v) + e.potential + e.elastic;
        let heat = e.dissipated() + layer - self.press;
        let (forces, heat) = (self.drag / self.pressure_path, heat / self.pressure_path);
        table.compare(case, "mu from heat is mu from forces", forces, heat, 1e-9);
    }
}

/// In the layer of row 34 at the case's own tolerance, every step converges and no bond is lost.
fn lid(table: &mut Table) {
    let mut s: Simulation<Dim2> = plane("energy", &[]);
    let d = driven(&s, "top");
    let b = s.state.bodies.driven[d].body as usize;
    let (mut lid, mut last) = (Lid::default(), s.state.bodies.position[b]);
    until(&mut s, 0.1, |s| {
        let now = s.state.bodies.position[b];
        lid.add::<Dim2>(&s.state.received[d].0, s.options.scheme.h, &(now - last), 1);
        last = now;
    });
    let e = &s.state.energy;
    assert!(e.friction > 0.0 && e.elastic > 0.0 && e.impact >= 0.0);
    table.compare(
        "energy",
        "bonds broken",
        0.0,
        s.state.network.bonds_broken() as f64,
        0.0,
    );
    table.compare(
        "energy",
        "fracture energy, no damage law (J/m)",
        0.0,
        e.fracture,
        0.0,
    );
    let off = e.residual / e.external_work.abs();
    table.compare(
        "energy",
        "residual over work, tolerance 1e-12",
        0.0,
        off,
        1e-6,
    );
    lid.compare(table, "energy", &s, b);
}

/// Spheres on a height field, periodic in x and y, sheared (row 34; action and reaction).
fn shear(table: &mut Table) {
    let case = "shear_3d";
    let mut s = solid(case, &[]);
    let d = driven(&s, "top");
    let b = s.state.bodies.driven[d].body as usize;
    let held: Vec<bool> = (0..s.state.bodies.len())
        .map(|b| s.state.bodies.driven.iter().any(|d| d.body as usize == b))
        .collect();
    let (mut lid, mut last) = (Lid::default(), s.state.bodies.position[b]);
    let (mut velocity, mut unbalanced) = (s.state.bodies.velocity.clone(), 0.0f64);
    until(&mut s, 0.6, |s| {
        let now = s.state.bodies.position[b];
        lid.add::<Dim3>(&s.state.received[d].0, s.options.scheme.h, &(now - last), 2);
        last = now;
        // Without gravity grains gain the momentum that contacts supply, and driven bodies receive
        // the opposite.
        let (mut sum, mut scale): (Vector3<f64>, f64) = (Vector3::zeros(), 0.0);
        for (k, v) in s
            .state
            .bodies
            .velocity
            .iter()
            .enumerate()
            .filter(|(k, _)| !held[*k])
        {
            sum += (v - velocity[k]) * s.state.bodies.mass[k];
        }
        for (impulse, _) in &s.state.received {
            sum += impulse;
            scale += impulse.norm();
        }
        if scale > 0.0 {
            unbalanced = unbalanced.max(sum.norm() / scale);
        }
        velocity.clone_from(&s.state.bodies.velocity);
    });
    let e = &s.state.energy;
    assert!(e.friction > 0.0 && e.impact >= 0.0 && s.state.network.contacts.len() > 32);
    table.compare(
        case,
        "sum of impulses over those on walls",
        0.0,
        unbalanced,
        1e-9,
    );
    let off = e.residual / e.external_work.abs();
    table.compare(case, "residual over external work", 0.0, off, 1e-6);
    lid.compare(table, case, &s, b);
}
