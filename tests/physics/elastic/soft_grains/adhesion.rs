//! Attraction over a range of gaps: its work is that of the law, for any alert distance.

use super::*;

/// Alert distances, a numerical setting.
const ALERTS: [f64; 3] = [2e-4, 4e-4, 8e-4];

/// A square that is pulled off a floor needs the work of the tension over the range: tension times
/// side times range. The square or the floor is deformable.
#[test]
fn pulling_off_takes_the_tension_over_the_range() {
    let (tension, side, range) = (1e4, 0.02, 1e-4);
    for material in ["soft", "stone"] {
        let mut first = None;
        for alert in ALERTS {
            let mut s = Soft {
                step: 1e-6,
                young: 1e9,
                mu: 0.0,
                contact: (
                    "mohr-coulomb",
                    format!(", \"cohesion\": {tension:?}, \"tension\": {tension:?}, \"range\": {range:?}"),
                ),
                detection: [alert, 1e-3],
                bodies: wall("floor", &[0.0, 1.0], &[0.0, 0.0], ""),
                grains: square(material, [0.0, 0.01], side, 0.0, "velocity: [0.0, 1.0]")
                    + &disks("soft", &[ball_at(&[1.0, 1.0], &[])]),
                ..Soft::default()
            }
            .build::<Dim2>();
            go(&mut s, 200);
            let found = s.state.energy.adhesion / (tension * range);
            println!("{material}, alert {alert}: work over a length of {found} m");
            if material == "soft" {
                // A step is a hundredth of the range.
                near(side, found, 0.02);
            }
            near(*first.get_or_insert(found), found, 1e-6);
            closes(&s, 1e-9);
        }
    }
}
