//! How far FASTSIM is off half-spaces in wear, slip and temperature of a passage.

use crate::Error;
use crate::patch::law::PatchLaw;
use crate::patch::method::Rung;
use crate::patch::setup::Setup;
use fretwork_rolling::friction::Cells;
use fretwork_rolling::motion::rigid_slip;
use fretwork_rolling::{Creepage, Rolling};

/// Largest differences without spin and with it, under Coulomb's and Archard's laws, as a test of
/// this file measures them: of the volume worn, the largest depth and the highest rise of the
/// temperature over the same number in full slip, that of the rigid bodies.
const SHARES: [[f64; 3]; 2] = [[0.04, 0.17, 0.2], [0.25, 0.17, 0.3]];
/// That of the largest slip over itself: near the trailing edge of parabolic pressures springs slip
/// faster than half-spaces, by a factor of up to 2.7.
const SLIP: f64 = 0.65;

/// Errors of the theory in a point; 0 of half-spaces.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TheoryError {
    /// Volume over the distance rolled that wears off the interface (m²).
    pub volume: f64,
    /// Largest depth (m).
    pub depth: f64,
    /// Largest slip over the distance rolled.
    pub slip: f64,
    /// Highest temperature (K).
    pub temperature: f64,
}

impl TheoryError {
    /// Returns the errors of a method in a solved point.
    ///
    /// # Errors
    /// The law fails.
    pub(super) fn of(
        setup: &Setup,
        law: &PatchLaw,
        creepage: &Creepage,
        rolling: &Rolling,
    ) -> Result<Self, Error> {
        if !matches!(setup.rung, Rung::Fastsim(_)) {
            return Ok(Self::default());
        }
        let [volume, depth, temperature] = SHARES[usize::from(creepage.spin != 0.0)];
        let full = FullSlip::of(setup, law, creepage, rolling)?;
        Ok(Self {
            volume: volume * full.volume,
            depth: depth * full.depth,
            slip: SLIP * super::fastest(rolling),
            temperature: temperature * full.rise,
        })
    }
}

/// What the laws give where all of the patch slips by the rigid slip.
struct FullSlip {
    volume: f64,
    depth: f64,
    rise: f64,
}

impl FullSlip {
    fn of(
        setup: &Setup,
        law: &PatchLaw,
        creepage: &Creepage,
        rolling: &Rolling,
    ) -> Result<Self, Error> {
        let cells = Cells {
            grid: &rolling.grid,
            pressure: &rolling.pressure.pressure,
            speed: setup.rolling_speed(),
        };
        let slip = rigid_slip(&rolling.grid, creepage);
        let passage = law.passage(cells, &slip);
        let passage = passage.map_err(|e| Error::Failed(e.to_string()))?;
        let rows = super::wear::Rows::of(rolling, &passage.worn);
        let coldest = law.thermal().map_or(0.0, |t| t.bulk[0].min(t.bulk[1]));
        let hottest = passage.temperature.iter().copied().fold(coldest, f64::max);
        Ok(Self {
            volume: rows.volume(),
            depth: rows.deepest(),
            rise: hottest - coldest,
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::patch::answer::Point;
    use crate::patch::tests::solved;

    /// A patch of bodies of a material with relative radii along the rolling and across it (m).
    fn text(material: &str, [along, across]: [f64; 2], method: &str, motion: &str) -> String {
        format!(
            r#"(
                name: "a wheel", materials: {{"wheel": "{material}", "rail": "{material}"}},
                bodies: ((material: "wheel", radius: {along}), (material: "rail", across: {across})),
                interfaces: [(name: "dry", between: ("wheel", "rail"), {COULOMB_AND_WEAR})],
                load: 100 kN, speed: 20 m/s, cells: 32, method: {method}, motion: Rolling({motion}),
            )"#
        )
    }

    const COULOMB_AND_WEAR: &str = r#"contact: "coulomb", wear: "archard", parameters: (contact: {"mu": 0.33}, wear: {"k": 1e-15})"#;

    /// Volume, depth, slip velocity and temperature of a point, with their errors.
    fn numbers(point: &Point) -> [[f64; 2]; 4] {
        let wear = &point.wear[0];
        [
            [wear.volume, wear.volume_error],
            [wear.depth, wear.depth_error],
            [point.slip_speed.unwrap(), point.slip_speed_error.unwrap()],
            [point.temperature.unwrap(), point.temperature_error.unwrap()],
        ]
    }

    /// Springs differ from half-spaces by less than they state, from stick to full slip, along,
    /// across and with spin, on ellipses of 0.2 to 5.
    #[test]
    fn springs_are_off_by_less_than_they_state() {
        for material in ["contact", "simple"] {
            for radii in [[1.0, 1.0], [1.0, 0.1], [0.1, 1.0]] {
                for motion in [
                    "along: [0.02 %, 0.1 %, 0.3 %, 1 %]",
                    "across: [0.02 %, 0.1 %, 0.3 %, 1 %]",
                    "along: [0.02 %, 0.1 %, 0.3 %, 1 %], spin: 0.2 1/m",
                    "across: [-0.3 %, -0.1 %, 0.1 %, 0.3 %], spin: 0.5 1/m",
                ] {
                    let of = |method: &str| {
                        let text = text(material, radii, method, motion);
                        solved("theory", &text).unwrap().answer.points
                    };
                    for (exact, springs) in of("Exact").iter().zip(of("Fastsim")) {
                        let both = numbers(exact).into_iter().zip(numbers(&springs));
                        for (k, ([right, own], [got, stated])) in both.enumerate() {
                            assert!(
                                (got - right).abs() < stated + own,
                                "{material} {radii:?} {:?} {k}: {got:e} {right:e} {stated:e}",
                                springs.motion
                            );
                        }
                    }
                }
            }
        }
    }
}
