//! Bonds compared with the load and the time step, for any law, by driving the law on a test bench:
//! the strength of a bond, its slide per step, and how well its oscillation is resolved.

use super::load::Load;
use crate::RunView;
use crate::laws::bench::Bench;
use crate::laws::bench::scale::{BondScale, Mode};
use crate::scene::bond_sites::BondSites;
use crate::scene::case::Case;
use crate::step::Coupling;

/// Range of bond strength over pressure in which load and bonds are comparable.
const STRENGTH: [f64; 2] = [0.01, 100.0];

/// Slide per step over the opening at break. Up to the first value the fracture energy of a bond
/// that takes all of the slide has an error of about 3 %; beyond the second the bond breaks in
/// fewer than ten steps.
const SLIDE: [f64; 2] = [0.01, 0.1];
/// Replaces the first value of [`SLIDE`] where damage is coupled at the midpoint: the error then
/// decreases with the square of the step.
const RESOLVED_AT_MIDPOINT: f64 = 0.07;

/// Time step times angular frequency. Up to the first value a period has at least twenty steps, and
/// the scheme lengthens it by less than 1 %, (h omega)^2/12; beyond the second it has at most three
/// steps.
const FREQUENCY: [f64; 2] = [0.3, 2.0];

/// A bond that breaks below this multiple of its opening at peak traction is brittle.
const BRITTLE: f64 = 1.05;

/// Speed at which bonds are driven if nothing in the case moves (m/s).
const USUAL_SPEED: f64 = 1e-3;

/// Report lines on the bonds of every interface that has a cohesion law.
pub fn lines(case: &Case, s: &dyn RunView, load: &Load) -> Vec<(&'static str, String)> {
    let mut out = Vec::new();
    for (place, law) in s.laws().iter().enumerate() {
        if !law.opens() || (law.bonding_time().is_none() && law.healing.is_none()) {
            continue;
        }
        let Some(sites) = BondSites::of(s, place) else {
            out.push(("bonds", format!("{}: it governs no grain", law.name)));
            continue;
        };
        let speed = load.speed.as_ref().map_or(USUAL_SPEED, |s| s.0);
        let mut bench = Bench::new(law.clone(), s.dimension() as u32, sites.radius);
        let where_from = match sites.contacts {
            0 => "no contact yet, estimated from the grains".to_owned(),
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
                    slide(&scale, load, h, case.coupling),
                    frequency(&scale, &sites, h, case.inertia_scaling),
                ];
                out.extend(texts.into_iter().flatten().map(|text| ("", text)));
            }
            Ok(None) => {}
            Err(e) => out.push(("", format!("NOT KNOWN: on the test bench, {e}"))),
        }
    }
    out
}

/// Bond strength in one mode, compared with the pressure.
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

/// Slide of a bond per step if it takes all of the imposed motion.
fn slide(scale: &BondScale, load: &Load, h: f64, coupling: Coupling) -> Option<String> {
    let ends = |m: &Mode| m.broken.or(m.peak.map(|p| p.1));
    let modes = [&scale.normal, &scale.shear];
    let critical = modes.into_iter().filter_map(ends).reduce(f64::min)?;
    let peaks = modes.into_iter().filter_map(|m| m.peak.map(|p| p.1));
    let peak = peaks.reduce(f64::min)?;
    let Some((speed, body)) = &load.speed else {
        return Some("slide a step: no body has an imposed speed".to_owned());
    };
    let ratio = speed * h / critical;
    // A bond that breaks at its peak has no softening branch that a step could skip.
    let brittle = critical <= BRITTLE * peak;
    // Errors of the energy of a MAC bond (%) for steps of this ratio, and the ratio at which the
    // error is 3 %.
    let (error, resolved) = match coupling {
        Coupling::Midpoint => (540.0 * ratio * ratio, RESOLVED_AT_MIDPOINT),
        Coupling::Explicit | Coupling::Implicit { .. } => (300.0 * ratio, SLIDE[0]),
    };
    let step = h * resolved / ratio;
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
    } else if ratio > resolved && brittle {
        format!(
            "coarse: a bond that takes all of it breaks within {:.0} steps, at once at its peak",
            (1.0 / ratio).ceil()
        )
    } else if ratio > resolved {
        format!(
            "coarse: the fracture energy of a bond that takes all of it is off by some {error:.0} %; time.step of {step:.0e} s brings that to 3 %"
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

/// How well the step resolves the fastest oscillation of one bond.
fn frequency(scale: &BondScale, sites: &BondSites, h: f64, scaling: f64) -> Option<String> {
    let times_step = |stiffness: f64, ratio: f64| h * (stiffness * ratio).sqrt();
    let normal = times_step(scale.normal.stiffness, sites.normal);
    let shear = times_step(scale.shear.stiffness, sites.shear);
    let usual = times_step(scale.normal.stiffness, sites.normal_median)
        .max(times_step(scale.shear.stiffness, sites.shear_median));
    let most = normal.max(shear);
    if !(most > 0.0 && most.is_finite()) {
        return None;
    }
    let step = h * FREQUENCY[0] / most;
    let inertia = scaling * (most / FREQUENCY[0]).powi(2);
    let verdict = if most > FREQUENCY[1] {
        format!(
            "NOT RESOLVED: bonds are treated quasi-statically, their waves are not resolved; for waves time.step of {step:.0e} s, or inertia_scaling of {inertia:.0e} where motion is slow"
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
        "step times frequency of a bond: {normal:.2e} opened, {shear:.2e} sheared, on the lightest pair of bodies ({usual:.2e} on the median pair): {verdict}"
    ))
}
