//! Checks of a case before its run: drives that the step does not resolve, laws that are not
//! called, and results that the case cannot have.

use super::heat::without_heat;
use super::quantity::Findings;
use super::warning::Warning;
use super::{biaxial, circuit, friction_report, jump};
use crate::observer::{Observer, RunEnd};
use fretwork_core::view::RunView;
use fretwork_scene::case::Case;
use fretwork_scene::{law_inputs, sampling};

/// Checks of a case.
#[derive(Clone, Debug)]
pub(crate) struct CaseChecks {
    warnings: Vec<Warning>,
    /// Whether the case has a friction test, a biaxial test, a circuit and jumps.
    has: [bool; 4],
}

impl CaseChecks {
    pub fn of(case: &Case, run: &dyn RunView) -> Self {
        let drives = sampling::unresolved(case);
        let texts = |aliased: bool| {
            let drives = drives.iter().filter(|d| d.aliased == aliased);
            let texts: Vec<&str> = drives.map(|d| d.text.as_str()).collect();
            (!texts.is_empty()).then(|| texts.join("; "))
        };
        let idle = without_heat(run);
        let aliased = texts(true).map(|text| Warning::serious("ALIASED DRIVE", text));
        let coarse = texts(false).map(|text| Warning::note("COARSE DRIVE", text));
        let idle = (!idle.is_empty()).then(|| Warning::note("NO HEAT", idle.join("; ")));
        let undecided = law_inputs::undecided(case, run);
        let undecided =
            (!undecided.is_empty()).then(|| Warning::note("LAW DEFAULT", undecided.join("; ")));
        let unmeasured = law_inputs::unmeasured(case, run);
        let unmeasured =
            (!unmeasured.is_empty()).then(|| Warning::note("NO WEAR RATE", unmeasured.join("; ")));
        let warnings = [aliased, coarse, idle, undecided, unmeasured];
        Self {
            warnings: warnings.into_iter().flatten().collect(),
            has: [
                case.friction.is_some(),
                case.biaxial.is_some(),
                case.circuit.is_some(),
                case.jump.is_some(),
            ],
        }
    }
}

impl Observer for CaseChecks {
    fn name(&self) -> String {
        "checks of the case".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn report(&self, _: &RunEnd<'_>, found: &mut Findings) {
        let none: [fn(&mut Findings); 4] = [
            friction_report::report_none,
            biaxial::report_none,
            circuit::report_none,
            jump::report_none,
        ];
        for (report_none, has) in none.into_iter().zip(self.has) {
            if !has {
                report_none(found);
            }
        }
        Observer::report_so_far(self, found);
    }

    fn report_so_far(&self, found: &mut Findings) {
        found.warn(self.warnings.iter().cloned());
    }
}
