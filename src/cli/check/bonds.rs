//! Bonds against the load and the step: what a bond carries, how far it slides within a step, and how its oscillation is
//! resolved; of any law, by driving it on the bench.

use super::load::Load;
use crate::geometry::space::Space;
use crate::laws::bench::Bench;
use crate::laws::bench::scale::{BondScale, Mode};
use crate::scene::bond_sites::BondSites;
use crate::scene::build::Built;
use crate::scene::case::Case;

/// Strength over pressure between which a load and a bond are of one size.
const STRENGTH: [f64; 2] = [0.01, 100.0];

/// Slide within a step over the opening at break: up to the first the fracture energy of a bond that takes all of the slide is
/// right to some 3 %; beyond the second the bond goes in fewer than ten steps.
const SLIDE: [f64; 2] = [0.01, 0.1];

/// Step times circular frequency: up to the first a period has twenty steps or more, and the scheme lengthens it by less than
/// 1 %, (h omega)^2/12; beyond the second it has three steps or fewer.
const FREQUENCY: [f64; 2] = [0.3, 2.0];

/// A bond that is broken within this many times the opening at its peak is brittle.
const BRITTLE: f64 = 1.05;

/// The speed at which bonds are driven where nothing is moved (m/s).
const USUAL_SPEED: f64 = 1e-3;

/// Lines on the bonds of every interface that makes some.
pub fn lines<S: Space>(case: &Case, built: &Built<S>, load: &Load) -> Vec<(&'static str, String)> {
    let s = &built.simulation;
    let mut out = Vec::new();
    for (place, law) in s.laws.iter().enumerate() {
        if !law.opens() || (law.bonding_time().is_none() && law.healing.is_none()) {
            continue;
        }
        let Some(sites) = BondSites::of(s, place) else {
            out.push(("bonds", format!("{}: no grain is governed by it", law.name)));
            continue;
        };
        let speed = load.speed.as_ref().map_or(USUAL_SPEED, |s| s.0);
        let mut bench = Bench::new(law.clone(), S::D as u32, sites.radius);
        let where_from = match sites.contacts {
            0 => "none yet, judged by the grains".to_owned(),
            n => format!("{n} contacts at the start"),
        };
        let head = format!(
            "{}: {where_from}, reduced radius {:.2e} m, driven at {speed:.1e} m/s",
            law.name, sites.radius
        );
        out.push(("bonds", head));
        match bench.scale(speed) {
            Ok(Some(scale)) => {
                let h = case.time.step;
                let texts = [
                    strength("opened", &scale.normal, load),
                    strength("sheared", &scale.shear, load),
                    slide(&scale, load, h),
                    frequency(&scale, &sites, h, case.inertia_scaling),
                ];
                out.extend(texts.into_iter().flatten().map(|text| ("", text)));
            }
            Ok(None) => {}
            Err(e) => out.push(("", format!("NOT KNOWN: driven on the bench, {e}"))),
        }
    }
    out
}

/// What a bond carries in one mode, against the pressure.
fn strength(how: &str, mode: &Mode, load: &Load) -> Option<String> {
    let Some((peak, opening)) = mode.peak else {
        return (mode.stiffness > 0.0).then(|| {
            format!(
                "{how}: {:.2e} Pa/m, does not break up to 1 m",
                mode.stiffness
            )
        });
    };
    let broken = match mode.broken {
        Some(b) => format!("broken at {b:.2e} m"),
        None => "not broken up to 1 m".to_owned(),
    };
    let against = load.pressure.map_or(String::new(), |(p, origin)| {
        let ratio = peak / p;
        let verdict = if ratio < STRENGTH[0] {
            "; WEAK: this load breaks bonds at once, as if there were none; raise the strength or lower the load"
        } else if ratio > STRENGTH[1] {
            "; STRONG: this load does not break bonds, only imposed motion can; lower the strength or raise the load if they are to break"
        } else {
            ""
        };
        format!(", {ratio:.3e} of the pressure {origin} ({p:.2e} Pa){verdict}")
    });
    Some(format!(
        "{how}: strength {peak:.3e} Pa at {opening:.2e} m, {broken}{against}"
    ))
}

/// How far a bond slides within a step, if it takes all of the imposed motion.
fn slide(scale: &BondScale, load: &Load, h: f64) -> Option<String> {
    let ends = |m: &Mode| m.broken.or(m.peak.map(|p| p.1));
    let modes = [&scale.normal, &scale.shear];
    let critical = modes.into_iter().filter_map(ends).reduce(f64::min)?;
    let peaks = modes.into_iter().filter_map(|m| m.peak.map(|p| p.1));
    let peak = peaks.reduce(f64::min)?;
    let Some((speed, body)) = &load.speed else {
        return Some("slide a step: no body is moved by a given speed".to_owned());
    };
    let ratio = speed * h / critical;
    // What breaks at its peak has no softening that a step could jump over.
    let brittle = critical <= BRITTLE * peak;
    let step = h * SLIDE[0] / ratio;
    let verdict = if ratio > SLIDE[1] {
        let energy = if brittle {
            ""
        } else {
            ", and its fracture energy is wrong"
        };
        format!(
            "NOT RESOLVED: a bond that takes all of it breaks within {:.0} steps{energy}; time.step of {step:.0e} s resolves it",
            (1.0 / ratio).ceil()
        )
    } else if ratio > SLIDE[0] && brittle {
        format!(
            "coarse: a bond that takes all of it breaks within {:.0} steps, at once at its peak",
            (1.0 / ratio).ceil()
        )
    } else if ratio > SLIDE[0] {
        format!(
            "coarse: the fracture energy of a bond that takes all of it is off by some {:.0} %; time.step of {step:.0e} s brings that to 3 %",
            300.0 * ratio
        )
    } else {
        "resolved".to_owned()
    };
    Some(format!(
        "slide a step: {:.2e} m by `{body}`, {ratio:.2e} of the opening at break ({:.2e} of that at the peak): {verdict}",
        speed * h,
        speed * h / peak
    ))
}

/// How the step resolves the fastest oscillation of one bond.
fn frequency(scale: &BondScale, sites: &BondSites, h: f64, scaling: f64) -> Option<String> {
    let normal = h * (scale.normal.stiffness * sites.normal).sqrt();
    let shear = h * (scale.shear.stiffness * sites.shear).sqrt();
    let most = normal.max(shear);
    if !(most > 0.0 && most.is_finite()) {
        return None;
    }
    let step = h * FREQUENCY[0] / most;
    let inertia = scaling * (most / FREQUENCY[0]).powi(2);
    let verdict = if most > FREQUENCY[1] {
        format!(
            "NOT RESOLVED: bonds are followed as at rest, their waves are not; for waves time.step of {step:.0e} s, or inertia_scaling of {inertia:.0e} where motion is slow"
        )
    } else if most > FREQUENCY[0] {
        format!(
            "coarse: periods are {:.0} % too long; time.step of {step:.0e} s brings that below 1 %",
            100.0 * (most / 2.0 / (most / 2.0).atan() - 1.0)
        )
    } else {
        "resolved".to_owned()
    };
    Some(format!(
        "step times frequency of a bond: {normal:.2e} opened, {shear:.2e} sheared, on the lightest bodies: {verdict}"
    ))
}
