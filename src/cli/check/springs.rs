//! Compliant contacts compared with the load, for any law: stiffness, overlap under the pressure, stiffness number.

use super::load::Load;
use crate::geometry::space::Space;
use crate::laws::bench::Bench;
use crate::scene::bond_sites::BondSites;
use crate::scene::build::Built;
use crate::scene::case::Case;

/// Overlap over the radius of a grain from which grains are too soft: contacts no longer act one by one.
const SOFT: f64 = 0.05;
/// Overlap over the radius at which stiffnesses are told where no pressure is known.
const SHOWN: f64 = 0.01;

/// Report lines on every interface whose contacts are springs.
pub fn lines<S: Space>(case: &Case, built: &Built<S>, load: &Load) -> Vec<(&'static str, String)> {
    let s = &built.simulation;
    let mut out = Vec::new();
    let compliant = s.laws.iter().enumerate().filter(|(_, l)| l.compliant());
    for (place, law) in compliant {
        let Some(sites) = BondSites::of(s, place) else {
            continue;
        };
        // Of two like grains.
        let radius = 2.0 * sites.radius;
        let mut bench = Bench::new(law.clone(), S::D as u32, sites.radius);
        let text = match text::<S>(&mut bench, radius, case.time.step, &sites, load) {
            Ok(text) => text,
            Err(e) => format!("NOT KNOWN: on the test bench, {e}"),
        };
        out.push(("contact stiffness", format!("{}: {text}", law.name)));
    }
    out
}

fn text<S: Space>(
    bench: &mut Bench,
    radius: f64,
    h: f64,
    sites: &BondSites,
    load: &Load,
) -> Result<String, crate::laws::LawError> {
    let per = if S::D == 2 { "N/m per m" } else { "N/m" };
    let known = load.pressure.filter(|p| p.0 > 0.0);
    let overlap = match known {
        Some((p, _)) => {
            let force = p * (2.0 * radius).powi(S::D as i32 - 1);
            bench.overlap_under(force)?
        }
        None => Some(SHOWN * radius),
    };
    let Some((overlap, spring)) = overlap.zip(bench.spring(overlap.unwrap_or(0.0))?) else {
        return Ok(String::new());
    };
    // Area over mass is known, the mass along the normal follows.
    let area = bench.area();
    let kappa = spring.stiffness * sites.normal / area * h * h;
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
        "{:.2e} {per} along the normal, {:.2e} along tangents, {under}; k h^2/m up to {kappa:.1e}",
        spring.stiffness, spring.tangential
    ))
}
