//! Energy of broken bonds, and whether the step resolves bonds.

use crate::quantity::unit::{ENERGY, METRE, ONE, WORD};
use crate::quantity::{Findings, Role, Topic, number, parts, values};
use crate::warning::Warning;
use fretwork_core::contact::SlideStatistics;
use fretwork_core::step::Coupling;
use fretwork_core::step::Options;
use serde::Serialize;

/// Relative difference of the released energy from that of the laws above which bonds count as not
/// resolved.
pub const UNRESOLVED_ENERGY_ERROR: f64 = 0.05;
/// Share of bonds that break within the step in which their damage begins, above which bonds count
/// as not resolved.
pub const UNRESOLVED_BREAK_SHARE: f64 = 0.1;
/// Ratio of the opening at failure to that at peak traction below which a bond is brittle: it
/// breaks within one step for any step length.
const BRITTLE: f64 = 1.05;
/// Ratio of displacement to critical opening, in the steps in which they break, above which brittle
/// bonds count as not resolved: which of several bonds breaks then depends on the step, not on the
/// law.
const OVERSHOOT: f64 = 0.2;
/// Ratio of displacement per step to critical opening up to which a step resolves a bond, as in
/// `fretwork check`: if damage is that at the start or end of the step, and if it is that at its
/// middle.
const RESOLVED: [f64; 2] = [0.01, 0.07];

/// Fracture energy with which the energy to break a bond is compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reference {
    /// The fracture energy that the law declares.
    Declared,
    /// The work of a slow pull to failure on the test bench, as the law declares nothing.
    SlowPull,
    /// None: bonds do not break by damage, none has broken, or the law failed on the test bench.
    #[default]
    None,
}

crate::described! {
    /// Bonds of one interface.
    #[derive(Clone, Debug, Default, PartialEq, Serialize)]
    pub struct InterfaceBonds {
        /// Name of the interface.
        pub interface: String => WORD,
        /// Bonds that damage broke.
        pub broken: u64 => ONE,
        /// Bonds whose contact moved out of range, or whose body was removed.
        pub torn: u64 => ONE,
        /// Energy that the bonds broken by damage released, all that was stored at the break
        /// included.
        pub released: f64 => ENERGY,
        /// Part of it that is compared with the next: all, unless bonds were broken by rotation in
        /// great numbers.
        #[serde(skip)]
        pub compared: f64,
        /// Fracture energy of their laws for their areas and openings; where bonds were also
        /// turned, the work of a slow pull that opens and turns them in the same proportion.
        pub declared: Option<f64> => ENERGY,
        /// What the fracture energy comes from.
        pub reference: Reference => WORD,
        /// Released over declared; null without broken bonds.
        pub released_over_declared: Option<f64> => ONE,
        /// Whether a ratio other than 1 is an error of the step: the law declares the energy, or it
        /// depends on neither speed, pressure nor history; and no broken bond began at its gap,
        /// with an energy that its law may not have allowed.
        pub comparable: bool => WORD,
        /// Share of the broken bonds that had no damage at the start of the step in which they
        /// broke.
        pub broken_at_once: Option<f64> => ONE,
        /// Opening of a slow pull at which a bond breaks, the smaller of both modes.
        pub critical_opening: Option<f64> => METRE,
        /// Smallest opening at the peak of the traction.
        pub peak_opening: Option<f64> => METRE,
        /// Change of the opening of an intact bond in a step over the critical opening: mean over
        /// bonds and steps.
        pub slide_mean: Option<f64> => ONE,
        /// Change of the opening in a step over the critical opening, mean over the steps that
        /// released energy, weighted by that energy.
        pub slide_breaking: Option<f64> => ONE,
        /// Largest change of the opening of an intact bond in a step over the critical opening.
        pub slide_largest: Option<f64> => ONE,
        /// Time step times the frequency of a bond at the contacts at the end: median and largest.
        pub step_times_frequency: Option<[f64; 2]> = values(ONE),
    }
}

crate::described! {
    /// Energy that broken bonds released, over what their laws declare; the slide of bonds in a
    /// step.
    #[derive(Clone, Debug, Default, PartialEq, Serialize)]
    pub struct FractureSummary {
        /// Energy released over that of the laws, over all bonds that damage broke in interfaces
        /// where they are `comparable`; null without any.
        pub released_over_declared: Option<f64> => ONE,
        /// The interfaces that made bonds.
        pub interfaces: Vec<InterfaceBonds> = parts::<InterfaceBonds>(),
        /// Whether cycles were skipped: damage then grows by more than what the energies of a step
        /// say, and nothing is compared.
        pub jumps: bool => WORD,
        /// Time step, and the slide per step over critical opening with which it would resolve a
        /// bond.
        #[serde(skip)]
        pub step: [f64; 2],
    }
}

impl FractureSummary {
    /// Summarises the bonds of some interfaces in a run with these options; `jumps` is whether
    /// cycles were skipped.
    pub fn new(interfaces: Vec<InterfaceBonds>, jumps: bool, options: &Options) -> Self {
        let resolved = match options.coupling {
            Coupling::Midpoint => RESOLVED[1],
            Coupling::Explicit | Coupling::Implicit { .. } => RESOLVED[0],
        };
        let known = || interfaces.iter().filter(|b| b.comparable);
        let declared: f64 = known().filter_map(|b| b.declared).sum();
        let released: f64 = known().map(|b| b.compared).sum();
        Self {
            released_over_declared: (declared > 0.0 && !jumps).then(|| released / declared),
            interfaces,
            jumps,
            step: [options.scheme.h, resolved],
        }
    }

    /// Adds the energies of broken bonds.
    pub(super) fn report(&self, found: &mut Findings) {
        found.begin(Topic::Damage, Role::Detail);
        found.part("fracture", self, "");
        if let Some(ratio) = self.released_over_declared {
            let text = self.sentence(ratio);
            found.edit("fracture.released_over_declared", |q| {
                q.secondary("energy released").sentence("released", text);
            });
        }
        let text = self.warning();
        found.warn(text.map(|text| Warning::note("BONDS NOT RESOLVED", text)));
    }

    /// Returns the sentence for the terminal on the ratio of the released to the declared energy.
    fn sentence(&self, ratio: f64) -> String {
        let once = self.interfaces.iter().filter_map(|b| {
            let share = b.softening_at_once().filter(|s| *s > 0.0)?;
            Some(format!(
                "{} % of the bonds of `{}` broke within one step",
                number(100.0 * share, 3),
                b.interface
            ))
        });
        let mut text = vec![format!(
            "{} of the fracture energy of the broken bonds",
            number(ratio, 4)
        )];
        text.extend(once);
        text.join("; ")
    }

    /// Returns which bonds the step does not resolve, and what to change; `None` where it resolves
    /// all, or nothing is known.
    pub fn warning(&self) -> Option<String> {
        if self.jumps {
            return None;
        }
        let texts = self
            .interfaces
            .iter()
            .filter_map(InterfaceBonds::unresolved);
        let texts: Vec<String> = texts.collect();
        if texts.is_empty() {
            return None;
        }
        let resolved_or_brittle =
            |b: &InterfaceBonds| b.overshoot().is_some() || b.unresolved().is_none();
        let brittle = self.interfaces.iter().all(resolved_or_brittle);
        let slides = self.interfaces.iter().filter_map(|b| b.slide_breaking);
        let slide = slides.fold(0.0, f64::max);
        let [step, softening] = self.step;
        let resolved = if brittle { OVERSHOOT } else { softening };
        let target = if slide > resolved {
            format!(
                " ({:.0e} s would let them slide by {:.0} % of their critical opening in a step)",
                step * resolved / slide,
                100.0 * resolved
            )
        } else {
            String::new()
        };
        let compare = if brittle {
            "see whether their number changes"
        } else {
            "compare with `coupling: Explicit` and `Implicit(..)` at the same step, between which the energy lies"
        };
        Some(format!(
            "{}; take a smaller time.step{target}, and {compare}",
            texts.join("; ")
        ))
    }
}

impl InterfaceBonds {
    /// Sets the displacement of the bonds in a step, relative to their critical opening if it is
    /// known.
    pub(crate) fn slide(&mut self, slides: &SlideStatistics) {
        let Some(critical) = self.critical_opening else {
            return;
        };
        self.slide_mean = slides.mean().map(|x| x / critical);
        self.slide_breaking = slides.mean_by_released().map(|x| x / critical);
        self.slide_largest = (slides.steps > 0).then_some(slides.largest / critical);
    }

    /// Whether bonds break at their peak, without softening.
    fn brittle(&self) -> bool {
        match (self.critical_opening, self.peak_opening) {
            (Some(critical), Some(peak)) => critical <= BRITTLE * peak,
            _ => false,
        }
    }

    /// Returns the share of the bonds that broke within one step, where they should soften.
    fn softening_at_once(&self) -> Option<f64> {
        self.broken_at_once.filter(|_| !self.brittle())
    }

    /// Returns the displacement over the critical opening of brittle bonds in the steps in which
    /// they broke, if the step does not resolve them.
    fn overshoot(&self) -> Option<f64> {
        self.slide_breaking
            .filter(|s| self.brittle() && *s > OVERSHOOT)
    }

    /// Returns the text of the warning, if the step does not resolve the bonds.
    fn unresolved(&self) -> Option<String> {
        let ratio = self.released_over_declared.filter(|_| self.comparable);
        let wrong = ratio.filter(|r| (r - 1.0).abs() > UNRESOLVED_ENERGY_ERROR);
        let at_once = self
            .softening_at_once()
            .filter(|s| *s > UNRESOLVED_BREAK_SHARE);
        let overshoot = self.overshoot();
        if wrong.is_none() && at_once.is_none() && overshoot.is_none() {
            return None;
        }
        let bonds = format!("the {} broken bonds of `{}`", self.broken, self.interface);
        if let Some(slide) = overshoot {
            let released = ratio.map_or(String::new(), |r| {
                format!(" and released {} of their fracture energy", number(r, 3))
            });
            return Some(format!(
                "{bonds} are brittle: they slid by {} of their critical opening (that without pressure) in the steps in which they \
                 broke{released}, so that the step decides how many break",
                number(slide, 2)
            ));
        }
        let mut text = bonds;
        if let Some(ratio) = ratio {
            text += &format!(" released {} of their fracture energy", number(ratio, 3));
        }
        if let Some(share) = at_once {
            let and = if ratio.is_some() { ", and" } else { "," };
            text += &format!("{and} {:.0} % of them broke within one step", 100.0 * share);
        }
        if let Some(slide) = self.slide_breaking {
            text += &format!(
                " (they slide by {} of their critical opening in the steps in which they release energy)",
                number(slide, 2)
            );
        }
        Some(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn brittle(slide: f64, comparable: bool) -> FractureSummary {
        let bonds = InterfaceBonds {
            interface: "grains".to_owned(),
            broken: 10,
            critical_opening: Some(2e-6),
            peak_opening: Some(2e-6),
            slide_breaking: Some(slide),
            released_over_declared: Some(1.4),
            comparable,
            ..InterfaceBonds::default()
        };
        FractureSummary::new(vec![bonds], false, &Options::default())
    }

    #[test]
    fn brittle_bonds_that_the_step_does_not_resolve_are_reported() {
        assert_eq!(brittle(0.1, false).warning(), None);
        let told = brittle(1.6, false).warning().unwrap_or_default();
        assert!(
            told.contains("10 broken bonds of `grains` are brittle: they slid by 1.6 of")
                && told.contains("would let them slide by 20 %")
                && told.ends_with("see whether their number changes"),
            "{told}"
        );
        let told = brittle(1.6, true).warning().unwrap_or_default();
        assert!(
            told.contains("in which they broke and released 1.40 of their fracture energy,"),
            "{told}"
        );
    }
}
