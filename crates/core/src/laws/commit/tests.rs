//! Internal variables of laws at the end of a step.

use super::*;
use crate::contact::{ContactHeat, ContactTemperature, MaterialPair};
use crate::geometry::space::Dim2;
use crate::laws::StepInfo;
use crate::laws::sample_laws::{constant, contact, growing, interface};
use crate::solve::form::ContactSolution;
use nalgebra::{Vector1, Vector2};

const INFO: StepInfo = StepInfo {
    dimension: 2,
    time: 0.0,
    h: 0.25,
    theta: 0.5,
    correction: 0.0,
};

const PAIR: [MaterialPair; 1] = [MaterialPair {
    material: [1.0, 0.0],
    share: 0.5,
}];

/// A contact at rest, of an interface with this number of internal variables.
fn network(variables: usize) -> Network<Dim2> {
    let mut network = Network::new(1.0, 1.0, &[variables]);
    let mut contact = contact([0, 1]);
    if variables > 0 {
        contact.slot = network.memory[0].allocate(false, 0.0, 1.0, &vec![0.0; variables]);
    }
    network.contacts.push(contact);
    network
}

fn commit(law: &Interface, network: &mut Network<Dim2>) {
    let rests = ContactStep {
        before: Vector2::zeros(),
        average: Vector2::zeros(),
        adheres: false,
        lost: None,
        corrected: 0.0,
        slides: false,
        solution: ContactSolution {
            impulse: Vector2::zeros(),
            unilateral_n: 0.0,
            unilateral_t: Vector1::zeros(),
        },
    };
    let step = SolvedStep {
        contacts: &[rests],
        springs: &[],
        moments: &[],
        info: &INFO,
        predicted: false,
    };
    let laws = std::slice::from_ref(law);
    let mut evaluator = LawEvaluator::default();
    evaluator.select(laws, network);
    let history = &mut LawHistory::default();
    evaluator.commit(laws, history, network, &step).unwrap();
}

/// A transport law with an internal variable that counts steps is called in each step where heat is
/// computed, also in steps in which no heat flows, and not at all without heat. Its conductance is
/// used where heat flows.
#[test]
fn a_law_of_transport_remembers_steps_without_a_flow_of_heat() {
    let law = interface([growing()]);
    let mut network = network(1);
    for (heat, conducts, time) in [
        (false, false, 0.0),
        (true, false, 0.25),
        (true, false, 0.5),
        (true, true, 0.75),
        (false, false, 0.75),
        (true, false, 1.0),
    ] {
        network.thermal = heat.then(|| ContactHeat {
            conducts,
            temperatures: vec![ContactTemperature::default()],
            conductance: vec![[0.0; 2]],
            pairs: PAIR.into(),
            ..ContactHeat::default()
        });
        commit(&law, &mut network);
        assert_eq!(network.memory[0].variables, [[time]]);
        if conducts {
            assert_eq!(network.thermal.unwrap().conductance, [[time, 0.0]]);
        }
        network.thermal = None;
    }
}

/// A law without internal variables is called only where heat flows.
#[test]
fn a_law_without_memory_is_asked_where_heat_flows() {
    let law = interface([constant()]);
    for conducts in [false, true] {
        let mut network = network(0);
        network.thermal = Some(ContactHeat {
            conducts,
            temperatures: vec![ContactTemperature::default()],
            conductance: vec![[0.0; 2]],
            pairs: PAIR.into(),
            ..ContactHeat::default()
        });
        commit(&law, &mut network);
        let given = if conducts { 3.0 } else { 0.0 };
        assert_eq!(network.thermal.unwrap().conductance, [[given, 0.0]]);
    }
}
