use super::{AnySimulation, FieldValues, GrainFields};
use crate::geometry::space::{Dim2, Dim3};
use crate::laws::sample_laws::interface;
use crate::step::Simulation;
use nalgebra::{Vector1, Vector2};

/// Returns two touching disks after a step, one of which moves and rotates.
fn two_disks() -> AnySimulation {
    let disks = [([0.0, 0.0], 0.5), ([1.0, 0.0], 0.5)];
    let mut s = Simulation::<Dim2>::of_disks(&disks).with_law(interface([]));
    s.options.scheme.h = 0.25;
    s.state.bodies.velocity[1] = Vector2::new(-0.5, 0.5);
    s.state.bodies.spin[1] = Vector1::new(3.0);
    let mut run = AnySimulation::from(s);
    run.step().unwrap();
    run
}

#[test]
fn a_plane_simulation_has_depth_along_the_third_axis() {
    let run = two_disks();
    let s = run.get::<Dim2>().unwrap();
    assert!(run.get::<Dim3>().is_none());
    assert_eq!((run.dimension(), run.steps(), run.time()), (2, 1, 0.25));
    let motion = run.motion(1);
    assert_eq!(
        motion.velocity[..2],
        s.state.bodies.velocity[1].as_slice()[..]
    );
    assert_eq!(
        (motion.velocity[2], motion.spin[..2].to_vec()),
        (0.0, vec![0.0; 2])
    );
    assert_eq!(motion.spin[2], s.state.bodies.spin[1].x);
    assert_eq!(run.bodies().mass, s.state.bodies.mass);
    let mut seen = Vec::new();
    run.visit_contacts(&mut |c| seen.push(*c));
    let row = s.contacts().next().unwrap();
    assert_eq!(seen.len(), 1);
    assert_eq!(seen[0].force, [row.force.x, row.force.y, 0.0]);
    assert!(seen[0].normal_force > 0.0 && seen[0].normal_force == row.normal_force);
    let ends = run.contact_ends()[0];
    assert!((ends[0][0] - ends[1][0]).abs() > 0.5 && ends[0][2] == 0.0);
}

#[test]
fn columns_and_turned_vectors_have_three_components() {
    let run = two_disks();
    let (bodies, motion) = (run.bodies(), run.motion(1));
    assert_eq!(bodies.position.len(), bodies.len());
    assert_eq!(bodies.velocity.at(1), motion.velocity);
    assert_eq!(bodies.spin.at(1), motion.spin);
    assert_eq!(bodies.position.iter().nth(1), Some(motion.position));
    // The disk has turned by 3 rad/s for a quarter of a second.
    let turned = run.turned(1, [1.0, 0.0, 0.0]);
    assert!((turned[1] - motion.rotation[0].sin()).abs() < 1e-15 && turned[2] == 0.0);
    let back = run.turned_back(1, turned);
    assert!((back[0] - 1.0).abs() < 1e-15 && back[1].abs() < 1e-15);
    let momentum = run.angular_momentum(1, [0.0, 0.0, 2.0]);
    assert_eq!(momentum, [0.0, 0.0, 2.0 * bodies.inertia[1]]);
    let mut forces = Vec::new();
    run.visit_contacts(&mut |c| forces.push((c.force, c.bodies, run.ends_of_contact(c.place))));
    let [(force, bodies, ends)] = forces[..] else {
        panic!("{forces:?}");
    };
    assert!(force[0].abs() > 0.0);
    assert_eq!(ends[0], run.motion(bodies[0] as usize).position);
}

#[test]
fn a_failed_trial_is_undone_and_one_that_succeeds_is_kept() {
    let mut run = two_disks();
    let before = run.save().unwrap();
    let failed = run.attempted(|run| {
        run.step()
            .map(|_| ())
            .map_err(|_| 0)
            .and(Err::<(), _>(run.steps()))
    });
    assert_eq!(failed.unwrap(), Err(2));
    assert_eq!(run.save().unwrap(), before);
    let made = run.attempted(|run| run.step().map(|_| run.steps()));
    assert_eq!(made.unwrap().unwrap(), 2);
    assert_eq!(run.steps(), 2);
    let time = run.repeated(|run| {
        run.span_steps(0.25, 2);
        run.step().map(|_| run.time())
    });
    assert_eq!(time.unwrap().unwrap(), 1.0);
    assert_eq!(run.time(), 0.5);
}

#[test]
fn fields_are_columns_of_all_that_carry_them() {
    let run = two_disks();
    let (fields, values) = (
        run.grain_fields(GrainFields::default()),
        run.grain_values(GrainFields::default()),
    );
    assert_eq!(fields.len(), values.len());
    let spin = fields.iter().position(|f| f.name == "spin").unwrap();
    let FieldValues::Number(spins) = &values[spin] else {
        panic!("{:?}", values[spin]);
    };
    assert_eq!(spins[1], run.motion(1).spin[2]);
    assert_eq!(run.grain_field("spin"), Some(values[spin].clone()));
    assert_eq!(run.grain_field("none"), None);
    let with = GrainFields {
        orientation: true,
        removed: true,
    };
    let names: Vec<&str> = run.grain_fields(with).iter().map(|f| f.name).collect();
    assert_eq!(names[fields.len()..], ["angle", "removed"]);
    let widths = run
        .contact_fields()
        .iter()
        .map(|f| f.width())
        .sum::<usize>();
    let values = run.contact_values(true);
    let numbers = values.iter().map(|v| match v {
        FieldValues::Number(all) | FieldValues::Vector(all) => all.len(),
        FieldValues::Whole(all) => all.len(),
    });
    assert_eq!(numbers.sum::<usize>(), widths);
}

#[test]
fn a_state_goes_to_bytes_and_back() {
    let saved = [two_disks().save().unwrap(), vec![7]].concat();
    let disks = [([0.0, 0.0], 0.5), ([1.0, 0.0], 0.5)];
    let fresh = Simulation::<Dim2>::of_disks(&disks).with_law(interface([]));
    let mut fresh = AnySimulation::from(fresh);
    assert_eq!(fresh.restore(&saved).unwrap(), Some(&[7][..]));
    assert_eq!(fresh.save().unwrap(), saved[..saved.len() - 1]);
    let mut other = AnySimulation::from(Simulation::<Dim2>::of_disks(&disks[..1]));
    assert_eq!(other.restore(&saved).unwrap(), None);
    assert!(other.restore(&saved[..9]).is_err());
}

#[test]
fn a_trial_is_undone() {
    let mut run = two_disks();
    let before = run.save().unwrap();
    let mut within = 0;
    let trial = run.repeat(&mut |run| {
        run.options_mut().scheme.h = 0.5;
        run.step().unwrap();
        within = run.steps();
    });
    trial.unwrap();
    assert_eq!(within, 2);
    assert_eq!(run.save().unwrap(), before);
    assert_eq!(run.options().scheme.h, 0.25);
    let s = run
        .into_dimension::<Dim3>()
        .unwrap_err()
        .into_dimension::<Dim2>();
    assert_eq!(s.unwrap().state.steps, 1);
}
