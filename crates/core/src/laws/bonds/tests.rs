//! Energies of a bond over a step whose motion and impulses are given.

use super::*;
use crate::geometry::space::Dim2;
use crate::laws::sample_laws::{bond, contact, interface};
use crate::laws::step_result::ContactStep;
use crate::solve::MomentSolution;
use crate::solve::form::ContactSolution;
use nalgebra::{Vector1, Vector2};

const INFO: StepInfo = StepInfo {
    dimension: 2,
    time: 0.0,
    h: 0.5,
    theta: 0.5,
    correction: 0.0,
};

/// A bond of stiffness k = 2 Pa/m over an area of 1.5 m opens by 1, slides by 2 and turns by 3 in a
/// step at half of the final forces, k A x/2, while the contact presses, slides and rolls with
/// friction. The bond stores k A x^2/2 of each motion, and none of the work of friction.
#[test]
fn friction_of_a_bonded_contact_is_no_work_of_its_bond() {
    let (k, area) = (2.0, 1.5);
    let x = [1.0, 2.0, 3.0];
    let law = interface([bond()]);
    let mut network = Network::<Dim2>::new(1.0, 1.0, &[0]);
    network.memory[0].rotates = true;
    network.dissipation = Some(Vec::new());
    let contact = contact([0, 1]);
    let slot = network.memory[0].allocate(true, 0.0, area, &[]);
    network.contacts.push(Contact { slot, ..contact });

    let h = INFO.h;
    // Impulses of the bond, against its openings, and the impulses of the contact.
    let elastic = x.map(|x| -h * k * area * 0.5 * x);
    let (pressed, friction, rolling) = (0.25, -0.5, -0.75);
    let normal = Vector2::new(0.0, 1.0);
    let tangent = Dim2::tangent_vector(&normal, &Vector1::new(1.0));
    let along = |n: f64, t: f64| normal * n + tangent * t;
    let average = along(x[0] / h, x[1] / h);
    let contact_step = ContactStep {
        before: average,
        average,
        adheres: false,
        lost: None,
        corrected: 0.0,
        slides: true,
        solution: ContactSolution {
            impulse: along(elastic[0] + pressed, elastic[1] + friction),
            unilateral_n: pressed,
            unilateral_t: Vector1::new(friction),
        },
    };
    let spin = x[2] / h;
    let moment_step = MomentStep {
        moment: MomentSolution {
            contact: 0,
            moment: Vector1::new(elastic[2] + rolling),
            friction: Vector1::new(rolling),
        },
        spin: Vector1::new(spin),
        lost: 0.0,
    };
    let step = SolvedStep {
        contacts: &[contact_step],
        springs: &[],
        moments: &[moment_step],
        info: &INFO,
        predicted: false,
    };
    let laws = [law];
    let mut evaluator = LawEvaluator::default();
    evaluator.select(&laws, &network);
    let history = &mut LawHistory::default();
    let totals = evaluator
        .commit(&laws, history, &mut network, &step)
        .unwrap();

    let stored = x.map(|x| 0.5 * k * area * x * x);
    let bond = &network.memory[0].bonds[0];
    assert_eq!((bond.opening_n, bond.opening_t.x), (x[0], x[1]));
    assert_eq!(network.memory[0].rotations[0].x, x[2]);
    assert_eq!(bond.energies.work, stored);
    assert_eq!(bond.energy, stored.iter().sum::<f64>());
    assert_eq!((bond.energies.viscous, bond.energies.fracture), (0.0, 0.0));
    // Friction acts against the motion: -p u.
    let rubbed = -friction * x[1] / h - rolling * spin;
    assert_eq!(bond.energies.friction, rubbed);
    assert_eq!(totals.friction, rubbed);
    assert_eq!(network.contacts[0].friction_work, rubbed);
    assert_eq!(network.dissipation.as_ref().unwrap()[0].friction, rubbed);
    assert_eq!(network.contacts[0].moment.x, elastic[2] + rolling);
}

/// A step that represents a number of cycles adds that number times the damage of one cycle, at
/// most up to full damage.
#[test]
fn damage_of_a_step_counts_for_all_its_cycles() {
    for (cycles, damage, broken) in [(1.0, 0.25, 0), (2.0, 0.375, 0), (10.0, 1.0, 1)] {
        let law = interface([bond()]);
        let mut network = Network::<Dim2>::new(1.0, 1.0, &[0]);
        network.cycle_multiplier = cycles;
        let slot = network.memory[0].allocate(true, 0.0, 1.0, &[]);
        let contact = contact([0, 1]);
        network.contacts.push(Contact { slot, ..contact });
        // Damage grows from 1/8 to 1/4 in a cycle.
        let memory = &mut network.memory[0];
        memory.rotates = false;
        (memory.bonds[0].damage, memory.bonds[0].step_damage) = (0.125, 0.125);
        let end = BondEnd {
            opening: (0.0, Vector1::new(0.0)),
            rotation: Vector1::new(0.0),
            work: [0.0; 3],
            given: 0.0,
            lost: None,
            friction: [0.0; 2],
            slide: 0.0,
            intact: 0.0,
            damage: 0.25,
        };
        let mut totals = Totals::default();
        store_bonds(0, &law, &mut network, &[0], vec![end], false, &mut totals);
        let bond = &network.memory[0].bonds[0];
        assert_eq!((bond.damage, totals.broken), (damage, broken));
    }
}

#[test]
fn damage_grows_to_one_at_most() {
    let mut damage = [0.25, 0.5, 0.5, 0.75];
    raise(&mut damage, &[0.5, 0.25, f64::NAN, 2.0]);
    assert_eq!(damage, [0.5, 0.5, 0.5, 1.0]);
}

/// (1 - D)^m at D = 0.75, also for an exponent m = 1/2.
#[test]
fn what_damage_leaves_is_a_power() {
    for (m, left) in [(1.0, 0.25), (2.0, 0.0625), (3.0, 0.015625), (0.5, 0.5)] {
        assert_eq!(degradation_factor(0.75, m), left);
    }
}
