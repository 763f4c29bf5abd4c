//! Checks of the heat of a run: an account that does not close, half-spaces that are not deep
//! enough, and contacts that heat a body outside the range of its half-spaces.

use crate::quantity::parts;
use crate::quantity::unit::{METRE, ONE, WORD};
use crate::run_state::LEDGER_TOLERANCE;
use crate::warning::Warning;
use fretwork_core::contact::HeatSide;
use fretwork_core::heat::{BodyNodes, Heat, HeatState, Pieces, Store};
use fretwork_core::view::RunView;
use serde::{Deserialize, Serialize};

/// Ratio of the depth of half-spaces to the diffusion length sqrt(D t) below which their end may
/// affect the result.
const DEEP: f64 = 4.0;
/// Share of the heat of a body that may pass outside its half-spaces without a note.
const NEGLIGIBLE: f64 = 1e-2;
/// Distance beyond the ends of the half-spaces that still counts as inside, over their length:
/// rounding, and rotation in a step.
const ROUNDING: f64 = 1e-3;

crate::described! {
    /// The checks of a run that computes heat.
    #[derive(Clone, Debug, Default, PartialEq, Serialize)]
    pub struct HeatChecks {
        /// Residual of the account of heat over its scale; among the measures.
        #[serde(skip)]
        pub residual_relative: f64,
        /// The first bodies with half-spaces.
        pub half_spaces: Vec<HalfSpaceCheck> = parts::<HalfSpaceCheck>(),
    }
}

crate::described! {
    /// The half-spaces below the surface of a first body.
    #[derive(Clone, Debug, Default, PartialEq, Serialize)]
    pub struct HalfSpaceCheck {
        /// Name of the body.
        pub body: String => WORD,
        /// Depth of the half-spaces.
        pub depth: f64 => METRE,
        /// Distance sqrt(D t) that heat has come in thermal time.
        pub reach: f64 => METRE,
        /// Share of the heat that contacts put into the body and conduct to it, of those beside the
        /// range of its half-spaces.
        pub outside: f64 => ONE,
    }
}

impl HeatChecks {
    /// Returns the warnings.
    pub(super) fn warnings(&self) -> Vec<Warning> {
        let account = self.account();
        let account = account.map(|text| Warning::serious("HEAT DOES NOT ADD UP", text));
        let notes = [
            ("SHALLOW HALF-SPACES", self.shallow()),
            ("HEAT OUT OF RANGE", self.outside()),
        ];
        let notes = notes.into_iter();
        let notes = notes.filter_map(|(of, text)| Some(Warning::note(of, text?)));
        account.into_iter().chain(notes).collect()
    }

    /// Returns a warning if the account does not close.
    fn account(&self) -> Option<String> {
        let share = self.residual_relative;
        (share > LEDGER_TOLERANCE || share.is_nan()).then(|| {
            format!(
                "the residual of the account of heat is {share:.1e} of the largest heat (rounding leaves less than {LEDGER_TOLERANCE:.0e}): temperatures are \
                 wrong; this is a defect of the program, please report it"
            )
        })
    }

    /// Returns a warning for half-spaces whose depth the heat has reached.
    fn shallow(&self) -> Option<String> {
        let shallow = self.half_spaces.iter().filter(|h| h.depth < DEEP * h.reach);
        let texts: Vec<String> = shallow
            .map(|h| {
                format!(
                    "those of `{}` are {:.2e} m deep, {:.1} times the {:.2e} m that heat has come",
                    h.body,
                    h.depth,
                    h.depth / h.reach,
                    h.reach
                )
            })
            .collect();
        (!texts.is_empty()).then(|| {
            format!(
                "half-spaces of heat should be {DEEP} times as deep as heat comes, and no heat leaves at their depth: {}; give a larger `depth`, or leave it out \
                 and run from the start (a run that was extended keeps the depth that it began with)",
                texts.join("; ")
            )
        })
    }

    /// Returns a warning for contacts outside the half-spaces.
    fn outside(&self) -> Option<String> {
        let outside = self.half_spaces.iter().filter(|h| h.outside > NEGLIGIBLE);
        let texts: Vec<String> = outside
            .map(|h| format!("{:.0} % for `{}`", 100.0 * h.outside, h.body))
            .collect();
        (!texts.is_empty()).then(|| {
            format!(
                "heat that contacts beside the range of the half-spaces put in or conduct goes to the pieces at its ends: {}; give a wider \
                 `over` in `store: HalfSpace(..)`",
                texts.join(", ")
            )
        })
    }
}

/// Heat at the contacts of each driven body with half-spaces, in their order: outside the
/// half-spaces, and in total (J; J/m in 2D).
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct ContactShares(Vec<[f64; 2]>);

impl ContactShares {
    /// Adds the contacts of the last step.
    pub fn add(&mut self, run: &dyn RunView, heat: &Heat, state: &HeatState) {
        let driven = run.bodies().driven;
        self.0.resize(driven.len(), [0.0; 2]);
        let h = run.options().scheme.h;
        let bounded: Vec<(usize, u32, &Pieces)> = driven
            .iter()
            .enumerate()
            .filter_map(|(k, d)| match &heat.nodes[d.body as usize] {
                BodyNodes::Pieces(_, p) if p.axes.iter().any(|a| !a.periodic) => {
                    Some((k, d.body, p))
                }
                _ => None,
            })
            .collect();
        let begun = run.time() - 0.5 * h >= heat.start;
        let (Some(thermal), true) = (run.contact_heat(), begun && !bounded.is_empty()) else {
            return;
        };
        // With a circuit conductances are known in every step, without one only in those in which
        // heat flows.
        let steps = if thermal.current { 1 } else { heat.every };
        let span = heat.clock * h * steps as f64;
        let temperature =
            |side: HeatSide| thermal.temperature_of(side, |n| state.nodes[n].temperature);
        let mut heats = thermal
            .temperatures
            .iter()
            .zip(&thermal.conductance)
            .zip(&thermal.source);
        run.visit_contacts(&mut |contact| {
            let Some(((seen, conductance), source)) = heats.next() else {
                return;
            };
            let sides = &seen.sides;
            for (side, body) in contact.bodies.into_iter().enumerate() {
                let Some((k, _, pieces)) = bounded.iter().find(|b| b.1 == body) else {
                    continue;
                };
                let [own, other] = [sides[side], sides[1 - side]].map(temperature);
                let (share, flow) = match (own, other) {
                    (Some(own), Some(other)) => {
                        let first = heat.share(seen.pair as usize);
                        let share = if side == 0 { first } else { 1.0 - first };
                        (share, conductance[0] * (other - own).abs() * span)
                    }
                    _ => (1.0, 0.0),
                };
                let amount = share * source.abs() + flow;
                let place = run.turned_back(body as usize, contact.arms[side]);
                self.0[*k][1] += amount;
                if beside(pieces, place) {
                    self.0[*k][0] += amount;
                }
            }
        });
    }
}

/// Returns whether a position in the axes of a body (m) is outside its pieces.
fn beside(pieces: &Pieces, place: [f64; 3]) -> bool {
    pieces.axes.iter().filter(|a| !a.periodic).any(|a| {
        let along = (place[a.axis] - a.low) / a.length;
        !(-ROUNDING..=1.0 + ROUNDING).contains(&along)
    })
}

/// The checks of the current state.
pub(super) fn checks(
    run: &dyn RunView,
    residual_relative: f64,
    shares: &ContactShares,
) -> Option<HeatChecks> {
    let (heat, state) = (run.heat()?, run.heat_state()?);
    let time = heat.clock * (run.time() - heat.start.max(0.0)).max(0.0);
    let of_body = |(k, driven): (usize, &fretwork_core::bodies::Driven)| {
        let nodes = &state.nodes[heat.nodes[driven.body as usize].range()];
        let Some(Store::HalfSpace(space)) = nodes.first().map(|n| &n.store) else {
            return None;
        };
        let conductor = heat.material_of(driven.body).conductor();
        let [beside, all] = shares.0.get(k).copied().unwrap_or_default();
        Some(HalfSpaceCheck {
            body: driven.name.clone(),
            depth: space.grid.depth.last().copied().unwrap_or_default(),
            reach: (conductor.diffusivity() * time).sqrt(),
            outside: if beside > 0.0 { beside / all } else { 0.0 },
        })
    };
    let driven = run.bodies().driven.iter().enumerate();
    Some(HeatChecks {
        residual_relative,
        half_spaces: driven.filter_map(of_body).collect(),
    })
}

/// Returns a sentence for each interface whose transport law is not called, since the case computes
/// no heat.
pub fn without_heat(run: &dyn RunView) -> Vec<String> {
    let laws = run.laws().iter();
    let idle = laws.filter(|l| l.transport().is_some() && run.heat().is_none());
    idle.map(|law| {
        format!(
            "the transport law of `{}` is not asked: the case computes no heat; `heat: ()` would",
            law.name
        )
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_account_that_is_off_or_no_number_is_a_reason() {
        let of = |residual_relative| {
            let checks = HeatChecks {
                residual_relative,
                ..HeatChecks::default()
            };
            checks.warnings()
        };
        assert!(of(1e-9).is_empty());
        for off in [1e-3, f64::NAN] {
            let list = of(off);
            assert!(list.len() == 1 && list[0].serious && list[0].of == "HEAT DOES NOT ADD UP");
        }
    }
}
