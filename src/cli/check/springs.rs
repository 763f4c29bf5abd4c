//! Compliant contacts compared with the load, for any law: stiffness, overlap under the pressure,
//! stiffness number.

use super::load::Load;
use crate::RunView;
use crate::laws::bench::Bench;
use crate::laws::bench::spring::SpringAnswer;
use crate::laws::{Interface, LawError};
use crate::scene::bond_sites::BondSites;
use crate::scene::case::Case;
use fretwork_core::unit::STIFFNESS;

/// Ratio of overlap to radius above which grains are too soft: contacts of a grain then affect each
/// other.
const SOFT: f64 = 0.05;
/// Ratio of overlap to radius at which stiffnesses are reported if no pressure is known.
const SHOWN: f64 = 0.01;

/// Shares of the pairs of bodies, by mass, on which the stiffness is compared with the step: the
/// median first, the lightest last.
const QUANTILES: [f64; 4] = [0.5, 0.75, 0.95, 1.0];

/// Report lines on every interface whose contacts are springs.
pub fn lines(case: &Case, s: &dyn RunView, load: &Load) -> Vec<(&'static str, String)> {
    let mut out = Vec::new();
    let compliant = s.laws().iter().enumerate().filter(|(_, l)| l.compliant());
    for (place, law) in compliant {
        let Some(sites) = BondSites::of(s, place) else {
            continue;
        };
        let text = match text(s.dimension(), law, case.time.step, &sites, load) {
            Ok(text) => text,
            Err(e) => format!("NOT KNOWN: on the test bench, {e}"),
        };
        out.push(("contact stiffness", format!("{}: {text}", law.name)));
    }
    out
}

/// A contact on the bench under the load.
struct Pressed {
    /// Radius of two equal grains whose contact has this reduced radius (m).
    radius: f64,
    /// Overlap under the pressure, or the overlap at which values are reported if there is none
    /// (m).
    overlap: f64,
    /// Stiffnesses at this overlap (N/m; N/m per m of depth in 2D).
    spring: SpringAnswer,
}

impl Pressed {
    /// Returns the contact of a reduced radius (m); `None` if the law cannot carry the load.
    fn find(
        dimension: usize,
        law: &Interface,
        reduced: f64,
        load: &Load,
    ) -> Result<Option<Self>, LawError> {
        let radius = 2.0 * reduced;
        let mut bench = Bench::new(law.clone(), dimension as u32, reduced);
        let overlap = match load.pressure.filter(|p| p.0 > 0.0) {
            Some((p, _)) => {
                let force = p * (2.0 * radius).powi(dimension as i32 - 1);
                bench.overlap_under(force)?
            }
            None => Some(SHOWN * radius),
        };
        let Some(overlap) = overlap else {
            return Ok(None);
        };
        let spring = bench.spring(overlap)?;
        Ok(spring.map(|spring| Self {
            radius,
            overlap,
            spring,
        }))
    }
}

fn text(
    dimension: usize,
    law: &Interface,
    h: f64,
    sites: &BondSites,
    load: &Load,
) -> Result<String, LawError> {
    let unit = STIFFNESS.symbol(dimension);
    let known = load.pressure.filter(|p| p.0 > 0.0);
    let Some(Pressed {
        radius,
        overlap,
        spring,
    }) = Pressed::find(dimension, law, sites.radius, load)?
    else {
        return Ok(String::new());
    };
    // Each pair is evaluated with the stiffness of its own contact: light pairs are small, and may
    // be softer.
    let mut kappas = Vec::new();
    for quantile in QUANTILES {
        let pair = sites.pair(quantile);
        if let Some(contact) = Pressed::find(dimension, law, pair.radius, load)? {
            kappas.push(contact.spring.stiffness * pair.normal * h * h);
        }
    }
    let largest = kappas.iter().copied().fold(0.0, f64::max);
    let middle = kappas.first().copied().unwrap_or(0.0);
    let share = overlap / radius;
    let under = known.map_or_else(
        || format!("at an overlap of {SHOWN} of the radius"),
        |(p, origin)| {
            let soft = if share > SOFT {
                "; SOFT: grains change their shape under this load and a contact no longer acts by itself; use a stiffer law or less load"
            } else {
                ""
            };
            format!(
                "at the pressure {origin} ({p:.2e} Pa), where two grains of radius {radius:.2e} m overlap by {:.2} % of it: stiffness number E/P {:.0}{soft}",
                100.0 * share,
                2.0 / share
            )
        },
    );
    Ok(format!(
        "{:.2e} {unit} along the normal, {:.2e} along tangents, {under}; k h^2/m {middle:.1e} on the median pair of bodies, up to {largest:.1e}",
        spring.stiffness, spring.tangential
    ))
}
