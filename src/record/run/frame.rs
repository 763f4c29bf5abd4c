//! Pictures of the scene during a run.

use super::{Recorder, RunError};
use crate::record::picture::Subject;
use crate::report::{noted, quantity};
use crate::scene::build::Dimensional;

/// Name prefixes of pictures: `frames/NAME_STEP.png`.
pub(super) const PICTURES: [&str; 5] = ["frame", "shear", "bonds", "circuit", "chains"];

impl<S: Dimensional> Recorder<'_, S> {
    /// Draws the pictures of a step.
    pub(super) fn frame(&mut self, step: u64) -> Result<(), RunError> {
        if self.loaded.case.output.frames == 0 {
            return Ok(());
        }
        let mut caption = vec![format!("t = {}", quantity(self.simulation.time, "s", 4))];
        if let Some(phase) = self.simulation.control.begun().last() {
            caption.push(phase.name.clone());
        }
        if let Some((cycles, _)) = &self.cycles {
            let number = cycles.number(self.simulation.time);
            if number > 0 && cycles.oscillates() {
                caption.push(format!("cycle {number} of {}", cycles.total()));
            }
            if let Some(c) = cycles.list.last() {
                caption.push(format!(
                    "friction coefficient {:.3}",
                    c.friction_coefficient
                ));
            }
        }
        if self.simulation.network.bonds_made() > 0 {
            caption.push(format!("damage ratio {:.3}", self.damage_ratio()));
        }
        self.camera.follow(&self.simulation);
        let shear = self
            .strain
            .as_ref()
            .map(|strain| strain.shear(&self.simulation));
        let [frame, sheared, bonds, circuit, forces] = PICTURES;
        let mut subjects = vec![(frame, Subject::Scene)];
        if let (Some(values), Some(top)) = (&shear, self.loaded.case.output.shear) {
            let label = "local shear";
            subjects.push((sheared, Subject::Values { values, label, top }));
        }
        if self.loaded.case.output.layers.is_some() && self.simulation.network.bonds_made() > 0 {
            subjects.push((bonds, Subject::Bonds));
        }
        let paints = self.account.paints(&self.simulation);
        if !paints.is_empty() {
            subjects.push((circuit, Subject::Painted(&paints)));
        }
        let chains = self.measures.chains(&self.simulation).filter(|_| S::D == 2);
        if let Some(pairs) = &chains {
            subjects.push((forces, Subject::Chains(pairs)));
        }
        let notice = self.notice();
        for (name, subject) in subjects {
            let path = self
                .out
                .join("frames")
                .join(format!("{name}_{step:08}.png"));
            let title = &self.loaded.case.name;
            let caption = caption.clone();
            noted(notice.clone(), || {
                self.camera
                    .draw(&self.simulation, subject, title, caption, &path)
            })?;
        }
        Ok(())
    }
}
