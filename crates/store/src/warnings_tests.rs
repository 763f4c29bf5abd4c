//! Tests of the warnings.

use super::*;
use fretwork_core::contact::Occurrence;
use fretwork_observe::deformable::{BorderLoad, SmallStrain};

fn of_run(change: impl FnOnce(&mut Summary)) -> Vec<Warning> {
    let mut summary = Summary {
        steps: 600,
        ..Summary::default()
    };
    change(&mut summary);
    of(&summary, None)
}

#[test]
fn a_sound_run_has_none() {
    assert_eq!(of_run(|_| ()), []);
    assert_eq!(of_run(|s| s.energy_residual_relative = 1e-9), []);
}

#[test]
fn each_failed_check_is_a_reason() {
    let list = of_run(|s| {
        s.solver.unconverged_steps = 12;
        s.solver.uncoupled_steps = 1;
        s.solver.overlap_max = 0.5;
        s.step_size.late = 3;
        s.step_size.deepest = 0.2;
        s.small_strain = [("bent", 1e-3, 0.3), ("stiff", 1e-3, 1e-3)]
            .map(|(body, strain, rotation)| SmallStrain {
                body: Some(body.into()),
                strain,
                rotation,
            })
            .into();
        s.border_loads = [("wide", 1e-3), ("narrow", 0.5)]
            .map(|(body, share)| BorderLoad {
                body: body.into(),
                share,
            })
            .into();
        s.energy.kinetic = f64::NAN;
        s.energy_residual_relative = 1e-3;
        s.heat = Some(HeatChecks {
            residual_relative: f64::NAN,
            ..HeatChecks::default()
        });
        s.phases_missed = vec!["shear".to_owned()];
        s.stopped = Some("no room".to_owned());
        s.plugins = vec![crate::summary::PluginStamp {
            kind: "contact".into(),
            name: "mine".into(),
            version: String::new(),
            sha256: String::new(),
            path: String::new(),
            links: Vec::new(),
            certified: false,
        }];
    });
    let reasons: Vec<&str> = list.iter().filter(|w| w.serious).map(|w| w.of).collect();
    let expected = [
        "STOPPED",
        "NOT FINITE",
        "ENERGY DOES NOT ADD UP",
        "HEAT DOES NOT ADD UP",
        "TOO FAST",
        "OVERLAP",
        "NOT SMALL STRAIN",
        "LOAD AT BORDER",
        "NOT CONVERGED",
        "NOT COUPLED",
        "NOT CERTIFIED",
    ];
    assert_eq!(reasons, expected);
    let bent = list.iter().find(|w| w.of == "NOT SMALL STRAIN").unwrap();
    assert!(bent.text.contains("`bent`") && bent.text.contains("strain: Corotational"));
    assert!(list.iter().all(|w| w.serious));
    assert!(
        list[8]
            .to_string()
            .starts_with("NOT CONVERGED: 12 of 600 steps")
    );
}

#[test]
fn laws_that_steps_did_not_meet_are_a_reason() {
    let of = |friction, attraction| {
        of_run(|s| {
            s.solver.laws.friction_mean = friction;
            s.solver.laws.attraction_max = attraction;
        })
    };
    assert_eq!(of(1e-3, 1e-2), []);
    for (friction, attraction, cure) in [
        (0.03, 0.0, "3.00 % on average"),
        (
            0.0,
            0.2,
            "up to 20.0 % of the load; take a smaller time.step",
        ),
    ] {
        let list = of(friction, attraction);
        assert!(list.len() == 1 && list[0].serious && list[0].of == "LAWS NOT MET");
        assert!(list[0].text.contains(cure), "{}", list[0].text);
    }
}

#[test]
fn loose_velocities_are_a_reason_where_slip_is_outweighed() {
    let parts = |velocity, contact_law| {
        of_run(|s| {
            s.solver.error_parts.velocity = velocity;
            s.solver.error_parts.contact_law = contact_law;
        })
    };
    assert_eq!(parts(1e-2, 0.3), []);
    // At rest both are small, whatever their ratio.
    assert_eq!(parts(1e-7, 4.0), []);
    let list = parts(3e-2, 1.8);
    assert!(list.len() == 1 && list[0].serious && list[0].of == "LOOSE VELOCITIES");
}

#[test]
fn errors_above_five_per_cent_are_notes_that_say_whether_they_are_known() {
    let change = |change, half_width| Some(Change { change, half_width });
    let list = of_run(|s| {
        let repeats = &mut s.uncertainty.repeats;
        repeats.places = 6;
        repeats.step.friction_coefficient = change(0.01, 0.02);
        repeats.tolerance.friction_coefficient = change(-0.08, 0.02);
        repeats.tolerance.damage = change(0.03, 0.06);
        repeats.shares.correction = Some(0.04);
    });
    assert_eq!(list.len(), 2, "{list:?}");
    assert!(list.iter().all(|w| !w.serious));
    let text = list[0].to_string();
    assert!(
        text.starts_with("ESTIMATED ERROR")
            && text.contains("friction -8 +- 2 % for solver.tolerance"),
        "{text}"
    );
    let text = list[1].to_string();
    assert!(
        text.starts_with("ERROR NOT KNOWN")
            && text.contains("damage up to 9 % for solver.tolerance"),
        "{text}"
    );
    let list = of_run(|s| s.uncertainty.repeats.shares.correction = Some(0.23));
    assert!(
        list.len() == 1 && list[0].of == "POSITION CORRECTION" && list[0].text.starts_with("23 %")
    );
}

#[test]
fn energy_of_the_time_integration_is_a_note_and_much_of_it_added_a_reason() {
    let of = |share| of_run(|s| s.uncertainty.repeats.shares.scheme = Some(share));
    assert_eq!(of(0.04), []);
    assert_eq!(of(-0.04), []);
    for (share, starts, serious) in [
        (0.16, "the time integration takes 16 %", false),
        (-0.17, "the time integration adds 17 %", false),
        (-0.7, "the time integration adds 70 %", true),
    ] {
        let list = of(share);
        assert!(
            list.len() == 1 && list[0].of == "TIME INTEGRATION",
            "{list:?}"
        );
        assert!(list[0].serious == serious && list[0].text.starts_with(starts));
    }
}

#[test]
fn friction_that_gives_energy_is_a_reason() {
    let of = |given: f64| {
        of_run(|s| {
            s.energy.friction = 1.0 - given;
            s.energy.given_by_friction = given;
            s.energy.scale = 2.0;
        })
    };
    assert_eq!(of(0.01), []);
    let list = of(0.2);
    assert!(list.len() == 1 && list[0].serious && list[0].of == "FRICTION GIVES ENERGY");
}

#[test]
fn phases_that_were_not_reached_are_a_reason_of_a_run_to_its_end() {
    let list = of_run(|s| s.phases_missed = vec!["shear".to_owned()]);
    assert!(list.len() == 1 && list[0].serious && list[0].of == NOT_REACHED);
}

/// Bodies that slid into low edges are a reason from one to a thousand pieces, and a note below.
#[test]
fn low_edges_are_a_reason_where_they_are_many() {
    let told = |edges: u64| {
        let list = of_run(|s| {
            (s.step_size.edges, s.step_size.pieces) = (edges, 5000);
            s.step_size.highest_edge = 3e-5;
            s.step_size.first_edge = (edges > 0).then(|| Occurrence {
                time: 0.5,
                bodies: vec!["grain 1".to_owned(), "floor".to_owned()],
            });
        });
        assert!(list.iter().all(|w| w.of == "EDGES MET"));
        list
    };
    assert!(told(0).is_empty());
    let few = told(4);
    assert!(few.len() == 1 && !few[0].serious);
    let many = told(5);
    assert!(many.len() == 1 && many[0].serious);
    assert!(
        many[0].text.starts_with("5 times a body")
            && many[0].text.contains("detection.alert of 6.0e-3 m")
    );
}

/// Steps in which no other solution was sought say nothing alone, as dense flows have them, but where grains between first bodies let go.
#[test]
fn several_solutions_are_a_note_and_grains_between_first_bodies_that_let_go() {
    let told = |several: u64, pinched: u64| {
        let list = of_run(|s| {
            s.solver.not_searched_steps = 5;
            (s.solver.several_steps, s.solver.pinched_steps) = (several, pinched);
        });
        assert!(list.iter().all(|w| w.of == "NOT UNIQUE" && !w.serious));
        let text: Vec<String> = list.into_iter().map(|w| w.text).collect();
        text.join("; ")
    };
    assert_eq!(told(0, 0), "");
    let (found, alone, both) = (told(2, 0), told(0, 3), told(2, 3));
    assert!(found.contains("in 2 steps another solution") && found.contains("in 5 steps a loaded"));
    assert!(!found.contains("between first bodies"));
    assert!(alone.contains("in 3 of them one of a grain between first bodies"));
    assert!(!alone.contains("another solution was found"));
    assert!(both.contains("in 2 steps another solution") && both.contains("in 3 of them"));
}
