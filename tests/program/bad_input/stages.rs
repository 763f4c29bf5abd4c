//! Drives in sequence, and the walls of a biaxial test.

use super::trial::{PLANE, refused, with};

/// The lid's vertical drive as stages.
fn staged(stages: &str) -> String {
    let old = "y: Force(Table([(0.0, -1.0), (1.0, -2.0)]))";
    with(PLANE, old, &format!("y: Stages([{stages}])"))
}

/// The plane case with two upright walls and a biaxial test.
fn tested(axial: &str, lateral: &str, more: &str) -> String {
    let walls = r#"(name: "left", material: "grain", shapes: [HalfSpace(normal: [1.0, 0.0])]),
        (name: "right", material: "grain", shapes: [HalfSpace(normal: [-1.0, 0.0], at: [0.3, 0.0])]),
        (name: "slope", material: "grain", shapes: [HalfSpace(normal: [1.0, 0.1], at: [-0.3, 0.0])]),
        (name: "floor","#;
    let test = format!("biaxial: (axial: ({axial}), lateral: ({lateral}){more}),\n    output:");
    let walled = with(PLANE, r#"(name: "floor","#, walls);
    with(&with(&walled, "periodic: (x: 0.4),", ""), "output:", &test)
}

#[test]
fn stages_that_do_not_follow_one_another() {
    let first = "(until: 0.5, drive: Force(Constant(1.0)))";
    refused(
        &staged(&format!(
            "{first}, (until: ‸0.5, drive: Free), (drive: Fixed)"
        )),
        &["stages must end one after another, got 0.5 after 0.5"],
    );
    refused(
        &staged("(until: ‸NaN, drive: Free), (drive: Fixed)"),
        &["stages must end one after another"],
    );
    refused(
        &staged(&format!("‸(drive: Free), {first}")),
        &["a stage that another one follows needs `until`"],
    );
    refused(
        &staged("(until: ‸0.5, drive: Force(Constant(1.0)))"),
        &["the last stage holds for ever; leave its `until` out"],
    );
}

#[test]
fn stages_that_drive_nothing_known() {
    refused(
        &with(&staged(""), "y: Stages", "y: ‸Stages"),
        &["stages need at least one drive"],
    );
    refused(
        &staged("(drive: ‸Stages([(drive: Free)]))"),
        &["a stage cannot hold stages again"],
    );
    refused(
        &staged("(until: 1.0, drive: Free), (drive: ‸Velocity(Table([])))"),
        &["a table needs at least one (time, value)"],
    );
}

#[test]
fn a_body_that_is_pushed_later_needs_a_mass() {
    let later = staged("(until: 1.0, drive: Fixed), (drive: Force(Constant(1.0)))");
    refused(
        &with(
            &with(&later, "mass: 1.0,", ""),
            "(\n            name: \"lid\"",
            "‸(\n            name: \"lid\"",
        ),
        &["the body `lid` moves under forces, so it needs a `mass`"],
    );
}

#[test]
fn a_biaxial_test_of_unknown_walls() {
    refused(
        &tested(r#""floor", "lid""#, r#"‸"lefd", "right""#, ""),
        &["there is no body `lefd`", "did you mean `left`?"],
    );
    refused(
        &tested(r#""floor", "lid""#, r#""left", ‸"lid""#, ""),
        &["the wall `lid` is named twice"],
    );
}

#[test]
fn walls_that_do_not_face_each_other() {
    refused(
        &tested(r#"‸"lid", "floor""#, r#""left", "right""#, ""),
        &["the open side of the wall `lid` must face `floor`"],
    );
    refused(
        &tested(r#""floor", ‸"right""#, r#""left", "lid""#, ""),
        &["the walls `floor` and `right` do not face each other"],
    );
    refused(
        &tested(r#""floor", "lid""#, r#"‸"slope", "right""#, ""),
        &["the wall `slope` is not flat", "one HalfSpace"],
    );
}

#[test]
fn a_biaxial_test_that_starts_after_the_end() {
    refused(
        &tested(r#""floor", "lid""#, r#""left", "right""#, ", start: ‸1.0"),
        &["after the run ends", "expected a time before 0.002 s"],
    );
}
