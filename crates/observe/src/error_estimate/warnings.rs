//! Warnings of errors that repeated steps show or cannot exclude.

use super::{Change, Repeats};
use crate::warning::Warning;

/// Share of a result, or of the energy, above which an error is reported.
const LARGE_ERROR: f64 = 0.05;
/// Share of the energy that the time integration may add before the run counts as not trustworthy.
const ADDED: f64 = 0.2;

/// A result, its change with a setting, and the name of that setting.
type SettingEffect = (&'static str, Change, &'static str);

impl Repeats {
    /// Returns the warnings on the error of the run.
    pub fn warnings(&self) -> Vec<Warning> {
        let notes = [
            ("POSITION CORRECTION", self.correction()),
            ("ESTIMATED ERROR", self.estimated_error()),
            ("ERROR NOT KNOWN", self.unknown_error()),
        ];
        let notes = notes.into_iter();
        let notes = notes.filter_map(|(of, text)| Some(Warning::note(of, text?)));
        self.scheme().into_iter().chain(notes).collect()
    }

    /// Returns a warning where the position correction is a large share of the energy.
    fn correction(&self) -> Option<String> {
        let share = self.shares.correction?;
        (share > LARGE_ERROR).then(|| {
            format!(
                "{:.0} % of the energy comes from taking overlaps out, not from the drives: take a smaller solver.tolerance or time.step, or \
                 compliant contacts (docs/compliant.md)",
                100.0 * share
            )
        })
    }

    /// Returns a warning where the energy that the time integration dissipates or adds is a large
    /// share.
    fn scheme(&self) -> Option<Warning> {
        let share = self.shares.scheme?;
        let percent = format!("{:.0} %", 100.0 * share.abs());
        let text = if share > LARGE_ERROR {
            format!(
                "the time integration takes {percent} of the energy (`scheme`), as if contacts had damping that no law gives: take a smaller \
                 time.step, to which this loss is proportional (docs/compliant/energy.md)"
            )
        } else if share < -LARGE_ERROR {
            format!(
                "the time integration adds {percent} to the energy (`scheme`): springs of contacts that are found with an overlap bring energy. Take \
                 a smaller time.step; between bodies with corners, whose points of contact come and go, that does not help, but rigid contacts do \
                 (docs/compliant/energy.md)"
            )
        } else {
            return None;
        };
        Some(match share < -ADDED {
            true => Warning::serious("TIME INTEGRATION", text),
            false => Warning::note("TIME INTEGRATION", text),
        })
    }

    /// Returns the changes of the main results that may be large.
    fn large_effects(&self) -> Vec<SettingEffect> {
        let settings = [
            (Some(&self.step), "time.step"),
            (Some(&self.tolerance), "solver.tolerance"),
            (self.coupling.as_ref(), "explicit coupling"),
        ];
        let known = settings.into_iter().filter_map(|(e, of)| Some((e?, of)));
        let effects = known.flat_map(|(e, of)| {
            [
                ("friction", e.friction_coefficient, of),
                ("damage", e.damage, of),
                ("wear", e.wear, of),
            ]
        });
        let effects = effects.filter_map(|(what, change, of)| Some((what, change?, of)));
        effects.filter(|e| e.1.bound() > LARGE_ERROR).collect()
    }

    /// Returns a warning for results whose error is more than 5 % according to repeated steps.
    fn estimated_error(&self) -> Option<String> {
        let list = self.large_effects().into_iter();
        let texts = list.filter(|(_, c, _)| c.change.abs() > c.half_width);
        let texts = texts.map(|(what, c, of)| {
            let (change, half) = (100.0 * c.change, 100.0 * c.half_width);
            format!("{what} {change:+.0} +- {half:.0} % for {of}")
        });
        let texts: Vec<String> = texts.collect();
        (!texts.is_empty()).then(|| {
            format!(
                "finer settings give {}, by repeated steps; take a smaller time.step (also where it is the \
                 coupling) or solver.tolerance, and see `uncertainty` in summary.json",
                texts.join(", ")
            )
        })
    }

    /// Returns a warning for results for which repeated steps cannot exclude an error of 5 %.
    fn unknown_error(&self) -> Option<String> {
        let list = self.large_effects().into_iter();
        let texts = list.filter(|(_, c, _)| c.change.abs() <= c.half_width);
        let texts = texts.map(|(what, c, of)| match c.bound() {
            bound if bound < 1.0 => format!("{what} up to {:.0} % for {of}", 100.0 * bound),
            _ => format!("{what} of any size for {of}"),
        });
        let texts: Vec<String> = texts.collect();
        (!texts.is_empty()).then(|| {
            format!(
                "it may be {}, by steps repeated at {} places; a longer run, or more places (`uncertainty: (repeats: {})`, for more time), tell more",
                texts.join(", "),
                self.places,
                4 * self.places
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of_run(change: impl FnOnce(&mut Repeats)) -> Vec<Warning> {
        let mut repeats = Repeats::default();
        change(&mut repeats);
        repeats.warnings()
    }

    #[test]
    fn errors_above_five_per_cent_are_notes_that_say_whether_they_are_known() {
        let change = |change, half_width| Some(Change { change, half_width });
        let list = of_run(|repeats| {
            repeats.places = 6;
            repeats.step.friction_coefficient = change(0.01, 0.02);
            repeats.tolerance.friction_coefficient = change(-0.08, 0.02);
            repeats.tolerance.damage = change(0.03, 0.06);
            repeats.shares.correction = Some(0.04);
        });
        assert_eq!(list.len(), 2, "{list:?}");
        assert!(list.iter().all(|w| !w.serious));
        let text = list[0].to_string();
        assert!(
            text.starts_with("ESTIMATED ERROR")
                && text.contains("friction -8 +- 2 % for solver.tolerance"),
            "{text}"
        );
        let text = list[1].to_string();
        assert!(
            text.starts_with("ERROR NOT KNOWN")
                && text.contains(
                    "it may be damage up to 9 % for solver.tolerance, by steps repeated at 6 places"
                ),
            "{text}"
        );
        let list = of_run(|repeats| repeats.shares.correction = Some(0.23));
        assert!(
            list.len() == 1
                && list[0].of == "POSITION CORRECTION"
                && list[0].text.starts_with("23 %")
        );
    }

    #[test]
    fn energy_of_the_time_integration_is_a_note_and_much_of_it_added_a_reason() {
        let of = |share| of_run(|repeats| repeats.shares.scheme = Some(share));
        assert_eq!(of(0.04), []);
        assert_eq!(of(-0.04), []);
        for (share, starts, serious) in [
            (0.16, "the time integration takes 16 %", false),
            (-0.17, "the time integration adds 17 %", false),
            (-0.7, "the time integration adds 70 %", true),
        ] {
            let list = of(share);
            assert!(
                list.len() == 1 && list[0].of == "TIME INTEGRATION",
                "{list:?}"
            );
            assert!(list[0].serious == serious && list[0].text.starts_with(starts));
        }
    }
}
