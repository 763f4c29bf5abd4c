//! Warning of contacts that leave the tables of their laws, where the values are those at the
//! border.

use super::observer::{Observer, RunEnd};
use super::quantity::Findings;
use super::warning::Warning;
use fretwork_core::laws::Interface;
use fretwork_core::view::RunView;

/// Begin of the names of variables that count the time outside of a table.
const OUTSIDE: &str = "outside_";

/// Share of the time of the contacts from which results do not follow from the table.
const TOLD: f64 = 0.01;

/// Observes the laws that read tables.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LawTables;

/// Returns whether a law of an interface has a table.
pub(crate) fn reads_table(interface: &Interface) -> bool {
    interface.loaded().any(|law| !law.table.is_empty())
}

impl Observer for LawTables {
    fn name(&self) -> String {
        "tables of laws".to_owned()
    }

    fn reads_statistics(&self) -> bool {
        false
    }

    fn report(&self, end: &RunEnd<'_>, found: &mut Findings) {
        found.warn(warnings(end.simulation));
    }
}

fn warnings(run: &dyn RunView) -> Vec<Warning> {
    let mut out = Vec::new();
    for (index, interface) in run.laws().iter().enumerate() {
        let mut time = 0.0;
        run.visit_contacts(&mut |contact| {
            if usize::from(contact.interface) == index {
                time += run.time() - contact.formed_at;
            }
        });
        for law in interface.loaded().filter(|l| !l.table.is_empty()) {
            let variables = law.plugin.variables.iter().enumerate();
            for (k, _) in variables.filter(|(_, v)| v.name.starts_with(OUTSIDE)) {
                let values = run.law_variable(index, law.first_variable + k);
                let share = values.iter().sum::<f64>() / time;
                if share > TOLD {
                    out.push(Warning::serious(
                        "NOT IN RANGE",
                        format!(
                            "contacts of the interface `{}` are outside of the table of its {} law for {:.0} % of their time, where the value is that at its border: give a table that contains their slip, slip velocity, pressure and temperature",
                            interface.name,
                            law.plugin.kind,
                            100.0 * share
                        ),
                    ));
                }
            }
        }
    }
    out
}
