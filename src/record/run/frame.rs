//! Pictures of the scene during a run.

use super::drawing::{self, Picture};
use super::{Recorder, RunError};
use crate::record::picture::Subject;
use crate::view::quantity;
use fretwork_observe::picture::{self, Shows};
use fretwork_observe::run_state::damage_ratio;
use fretwork_observe::standard::Observed;
use std::path::PathBuf;

/// Name prefixes of pictures: `frames/NAME_STEP.png`.
pub(super) const PICTURES: [&str; 5] = ["frame", "shear", "bonds", "circuit", "chains"];

impl<S: Observed> Recorder<'_, S> {
    /// Has the pictures of a step drawn, beside the steps that follow.
    pub(super) fn draw_pictures(&mut self, step: u64) -> Result<(), RunError> {
        if self.loaded.case.output.frames == 0 {
            return Ok(());
        }
        self.lock.kept()?;
        let mut caption = vec![format!(
            "t = {}",
            quantity(self.simulation.state.time, "s", 4)
        )];
        if let Some(phase) = self.simulation.state.control.begun().last() {
            caption.push(phase.name.clone());
        }
        caption.extend(self.observers.caption(&self.simulation));
        if self.simulation.state.network.bonds_made() > 0 {
            caption.push(format!(
                "damage ratio {:.3}",
                damage_ratio(&self.simulation)
            ));
        }
        self.camera.follow(&self.simulation);
        let pictures = self.observers.pictures(&self.simulation);
        let mut subjects = vec![("frame", Subject::Scene)];
        if self.loaded.case.output.layers.is_some()
            && self.simulation.state.network.bonds_made() > 0
        {
            subjects.push(("bonds", Subject::Bonds));
        }
        subjects.extend(
            pictures
                .iter()
                .filter_map(|p| Some((p.name, subject::<S>(p)?))),
        );
        let notice = self.notice();
        let mut shown = Vec::new();
        for picture in &pictures {
            let Shows::Charts(charts) = &picture.shows else {
                continue;
            };
            let heading = [&[self.loaded.case.name.clone()][..], &caption].concat();
            let heading = heading.join("   ·   ");
            let mut charts = charts.clone();
            charts.iter_mut().for_each(|c| c.head(&heading));
            shown.push((picture.name, drawing::Shows::Charts(charts)));
        }
        for (name, subject) in subjects {
            let (title, caption) = (&self.loaded.case.name, caption.clone());
            let frame = self.camera.frame(&self.simulation, subject, title, caption);
            shown.push((name, drawing::Shows::Scene(Box::new(frame))));
        }
        let pictures = shown.into_iter().map(|(name, shows)| Picture {
            shows,
            path: self.picture_path(name, step),
            notice: notice.clone(),
        });
        let pictures = pictures.collect();
        Ok(self.drawing.begin(pictures)?)
    }

    fn picture_path(&self, name: &str, step: u64) -> PathBuf {
        let frames = self.out.join("frames");
        frames.join(format!("{name}_{step:08}.png"))
    }
}

/// How a picture of an observer is drawn; none where the dimension has no such picture, and of charts, which have a page of their own.
fn subject<S: Observed>(picture: &picture::Picture) -> Option<Subject<'_>> {
    Some(match &picture.shows {
        Shows::Paints(paints) => Subject::Painted(paints),
        Shows::Chains(pairs) if S::D == 2 => Subject::Chains(pairs),
        Shows::Stress if S::D == 2 => Subject::Stress,
        Shows::Chains(_) | Shows::Stress | Shows::Charts(_) => return None,
        Shows::Values { values, label, top } => Subject::Values {
            values,
            label,
            top: *top,
        },
    })
}
