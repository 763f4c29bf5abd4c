//! Tests of the warnings.

use super::*;
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
fn phases_that_were_not_reached_are_a_reason_of_a_run_to_its_end() {
    let list = of_run(|s| s.phases_missed = vec!["shear".to_owned()]);
    assert!(list.len() == 1 && list[0].serious && list[0].of == NOT_REACHED);
}
