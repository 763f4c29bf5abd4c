//! Methods of a patch against each other, and what they refuse.

use super::spec::PatchFile;
use super::tests::{COULOMB, folder, laws, near, rolls, solved};
use super::trade::{self, PatchTrade};
use crate::Error;
use std::time::Duration;

fn with_method(text: &str, method: &str) -> String {
    text.replacen("load:", &format!("method: {method}, load:"), 1)
}

/// Adhesion by springs and in closed form differs from that of half-spaces by less than the error
/// that each states, without spin and with it, under Coulomb's law.
#[test]
fn methods_agree_within_the_errors_that_they_state() {
    let motion = "motion: Rolling(along: [0.05 %, 0.1 %, 0.2 %, 0.4 %], across: [0, 0.05 %, 0, 0.1 %], spin: [0, 0, 0.3 1/m, 0.3 1/m])";
    let text = rolls(COULOMB, motion);
    let exact = solved("method-exact", &text).unwrap().answer;
    for (method, says) in [
        ("Fastsim", "by the simplified theory"),
        ("ClosedForm", "by the closed form"),
    ] {
        let name = format!("method-{method}");
        let answer = solved(&name, &with_method(&text, method)).unwrap().answer;
        for (one, other) in answer.points.iter().zip(&exact.points) {
            let off = (one.force[0] - other.force[0]).hypot(one.force[1] - other.force[1]);
            let off = off / answer.load;
            let stated = one.adhesion_error + other.adhesion_error;
            assert!(
                off < stated && off > 0.0,
                "{method}: {off} {stated} {:?}",
                one.motion
            );
        }
        let text = answer.text();
        assert!(text.contains(says) && text.contains("Kalker"), "{text}");
        near(answer.pressure, exact.pressure, 0.02);
        near(answer.approach, exact.approach, 0.01);
    }
}

/// Springs have the laws of the exact method: falling friction and wear; a closed form has forces.
#[test]
fn springs_follow_the_laws_and_closed_forms_have_forces_alone() {
    let falls =
        r#"contact: "rail-falling-friction", wear: "archard", parameters: (wear: {"k": 1e-15})"#;
    let text = rolls(falls, "speed: 10 m/s, motion: Rolling(along: 10 %)");
    let of = |method: &str| {
        let name = format!("method-law-{method}");
        solved(&name, &with_method(&text, method)).unwrap()
    };
    let (exact, springs, closed) = (of("Exact"), of("Fastsim"), of("ClosedForm"));
    let [exact, springs, closed] = [&exact, &springs, &closed].map(|o| o.answer.points[0].clone());
    // In full slip all have the friction of the rigid slip, less the strain.
    near(springs.adhesion, exact.adhesion, 0.01);
    near(closed.adhesion, exact.adhesion, 0.01);
    near(springs.wear[0].volume, exact.wear[0].volume, 0.02);
    assert!(closed.wear.is_empty() && closed.stuck.is_none());
    // What is printed as an error is one of another law, and says so.
    for outcome in [&of("Fastsim"), &of("ClosedForm")] {
        let text = outcome.answer.text();
        assert!(
            text.contains("the printed errors are; for this law none"),
            "{text}"
        );
        let mut errors = text.lines().filter(|l| l.contains(" +- "));
        assert!(errors.all(|l| l.contains("under Coulomb's law")), "{text}");
    }
}

/// A creepage is found for a force by each method.
#[test]
fn forces_have_their_creepage_by_each_method() {
    let text = rolls(COULOMB, "motion: Pulling(force: -20 kN)");
    for method in ["Fastsim", "ClosedForm"] {
        let answer = solved("method-pulled", &with_method(&text, method))
            .unwrap()
            .answer;
        near(answer.points[0].force[0], -20e3, 1e-4);
    }
}

/// Carter's line is that of a row of cells.
#[test]
fn a_line_in_closed_form_is_that_of_cells() {
    let text = rolls(
        COULOMB,
        "motion: Rolling(along: [0.02 %, 0.1 %]), length: 100 mm",
    );
    let text = text
        .replace(", across: 1.776737 m", "")
        .replace("cells: 24", "cells: 96");
    let exact = solved("method-line", &text).unwrap().answer;
    let closed = solved("method-line", &with_method(&text, "ClosedForm"))
        .unwrap()
        .answer;
    for (one, other) in closed.points.iter().zip(&exact.points) {
        let off = (one.adhesion - other.adhesion).abs();
        assert!(
            off < other.adhesion_error,
            "{off:e} {:e}",
            other.adhesion_error
        );
    }
    assert!(closed.text().contains("Carter") && !closed.text().contains("NaN"));
}

#[test]
fn what_a_method_has_no_means_for_is_refused() {
    let fret = "motion: Fretting(amplitude: 1 um)";
    let roll = "motion: Rolling(along: 1 %)";
    let wears = r#"contact: "coulomb", wear: "archard", parameters: (contact: {"mu": 0.3}, wear: {"k": 1e-15})"#;
    let worn = "motion: Rolling(along: 1 %), passages: (count: 100)";
    let line = "motion: Rolling(along: 1 %), length: 10 mm";
    let spun = "motion: Rolling(along: 1 %, spin: 0.1 1/m), length: 10 mm";
    for (method, interface, rest, says) in [
        ("Fastsim", COULOMB, fret, "steady rolling"),
        ("ClosedForm", COULOMB, fret, "steady rolling"),
        ("ClosedForm", wears, worn, "`passages`"),
        ("Fastsim", COULOMB, line, "ellipses"),
        ("ClosedForm", COULOMB, spun, "along the rolling alone"),
    ] {
        let mut text = with_method(&rolls(interface, rest), method);
        if rest.contains("length") {
            text = text.replace(", across: 1.776737 m", "");
        }
        let Err(Error::Input(refused)) = solved("method-refused", &text) else {
            panic!("{method} {rest}");
        };
        let said = refused.compact();
        assert!(
            said.contains(says) && said.contains("method: Exact"),
            "{said}"
        );
        assert!(refused.position().is_some(), "{said}");
    }
    let slender = with_method(&rolls(COULOMB, roll), "Fastsim").replace("1.776737 m", "200 m");
    let said = solved("method-slender", &slender).unwrap_err().to_string();
    assert!(said.contains("from 0.2 to 5"), "{said}");
}

/// Cheaper methods are theories of like bodies: what pressure alone does to unlike ones is left out
/// by more than the errors that they state.
#[test]
fn cheaper_methods_refuse_unlike_bodies() {
    let text = rolls(COULOMB, "motion: Rolling(along: 0.1 %)");
    let unlike = text.replace(r#""rail": "harder""#, r#""rail": "simple""#);
    for method in ["Fastsim", "ClosedForm"] {
        let refused = solved("method-unlike", &with_method(&unlike, method));
        let said = refused.unwrap_err().to_string();
        assert!(said.contains("theory of like bodies"), "{said}");
        assert!(said.contains("method: Exact"), "{said}");
    }
    assert!(solved("method-unlike", &unlike).is_ok());
}

fn traded(name: &str, text: &str, cells: &[usize]) -> PatchTrade {
    let folder = folder(name);
    let path = folder.join("patch.ron");
    std::fs::write(&path, text).unwrap();
    let mut file = PatchFile::read(&path).unwrap();
    let limit = Duration::from_secs(3600);
    let trade = trade::run(&mut file, &laws(), (0.05, cells), limit, &mut |_| ()).unwrap();
    trade.write(&folder).unwrap();
    let table = std::fs::read_to_string(folder.join("trade.csv")).unwrap();
    assert_eq!(table.lines().count(), trade.settings.len() + 1);
    std::fs::remove_dir_all(&folder).unwrap();
    trade
}

/// Errors fall with the cells, the frontier falls with the cost, and the verdict is the cheapest
/// setting within the wanted error.
#[test]
fn a_trade_has_errors_that_fall_with_the_cells() {
    let text = rolls(
        COULOMB,
        "motion: Rolling(along: 0.1 %, across: 0.05 %, spin: 0.3 1/m)",
    );
    let trade = traded("trade-cells", &text, &[16, 32, 64]);
    assert_eq!(trade.outputs, ["adhesion", "moment", "T gamma"]);
    let exact: Vec<_> = trade
        .settings
        .iter()
        .filter(|s| s.method.name() == "Exact")
        .collect();
    assert_eq!(exact.len(), 3);
    for k in 0..3 {
        assert!(exact[0].errors[k] > exact[1].errors[k], "{exact:?}");
        let own = exact[2].errors[k];
        assert!(
            (own - exact[1].errors[k]).abs() < 1e-12 && own < 0.05,
            "{exact:?}"
        );
        let on = trade.settings.iter().filter(|s| s.on_frontier[k]);
        let mut on: Vec<(f64, f64)> = on.map(|s| (s.seconds, s.at_most[k])).collect();
        on.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert!(on.windows(2).all(|w| w[0].1 > w[1].1), "{on:?}");
    }
    assert!(exact[2].reference && trade.settings[0].method.name() == "ClosedForm");
    let text = trade.text();
    assert!(text.contains("5.0 % on all of them: Exact, "), "{text}");
}

/// Strokes have grids alone, and a curve without spin no moment.
#[test]
fn a_trade_compares_what_there_is() {
    let strokes = traded(
        "trade-strokes",
        &rolls(COULOMB, "motion: Fretting(amplitude: 5 um)"),
        &[16, 32],
    );
    assert_eq!(strokes.outputs, ["force", "energy"]);
    assert_eq!((strokes.settings.len(), strokes.left_out.len()), (2, 2));
    let plain = traded(
        "trade-plain",
        &rolls(COULOMB, "motion: Rolling(along: 0.1 %)"),
        &[16, 32],
    );
    assert_eq!(plain.outputs, ["adhesion", "T gamma"]);
}
