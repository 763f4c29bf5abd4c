//! Pictures of the scene during a run.

use super::drawing::{self, Picture};
use super::notice::band;
use super::{Recorder, RunError};
use crate::record::summary::Summary;
use fretwork_observe::chart::quantity;
use fretwork_observe::picture::PictureContent;
use fretwork_observe::run_state::damage_ratio;
use std::path::PathBuf;

impl Recorder<'_> {
    /// Starts to draw the pictures of a step, while the following steps are computed.
    pub(super) fn draw_pictures(&mut self, step: u64) -> Result<(), RunError> {
        if self.loaded.case.output.frames == 0 {
            return Ok(());
        }
        self.lock.check_still_owned()?;
        let mut caption = vec![format!("t = {}", quantity(self.simulation.time(), "s", 4))];
        if let Some(phase) = self.simulation.begun().last() {
            caption.push(phase.name.clone());
        }
        caption.extend(self.observers.caption(self.simulation.view()));
        if self.simulation.bonds_made() > 0 {
            caption.push(format!(
                "damage ratio {:.3}",
                damage_ratio(self.simulation.view())
            ));
        }
        self.camera.follow(self.simulation.view());
        let mut pictures = vec![("frame", PictureContent::Scene)];
        if self.loaded.case.output.layers.is_some() && self.simulation.bonds_made() > 0 {
            pictures.push(("bonds", PictureContent::Bonds));
        }
        let own = self.observers.pictures(self.simulation.view());
        pictures.extend(own.into_iter().map(|p| (p.name, p.shows)));
        let (notice, title) = (self.notice(), &self.loaded.case.name);
        let simulation = self.simulation.view();
        let shown = pictures.into_iter().filter_map(|(name, content)| {
            let PictureContent::Charts(mut charts) = content else {
                let frame = self
                    .camera
                    .frame(simulation, &content, title, caption.clone())?;
                return Some((name, drawing::DrawnContent::Scene(Box::new(frame))));
            };
            let heading = [std::slice::from_ref(title), &caption].concat();
            let heading = heading.join("   ·   ");
            charts.iter_mut().for_each(|c| c.head(&heading));
            Some((name, drawing::DrawnContent::Charts(charts)))
        });
        let pictures = shown.map(|(name, content)| Picture {
            content,
            path: self.picture_path(name, step),
            notice: notice.clone(),
        });
        let pictures = pictures.collect();
        self.drawing.begin(pictures)
    }

    fn picture_path(&self, name: &str, step: u64) -> PathBuf {
        let frames = self.out.join("frames");
        frames.join(format!("{name}_{step:08}.png"))
    }

    /// Returns the text of the band over a picture during the run, from what is known so far.
    fn notice(&mut self) -> Option<String> {
        self.observers.before_step(self.simulation.view());
        let mut now = Summary {
            run: self.summary.run.clone(),
            found: self.observers.report_so_far(self.simulation.dimension()),
        };
        band(&now.check())
    }
}
