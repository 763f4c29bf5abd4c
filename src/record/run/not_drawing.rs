//! Replacement for drawing without the feature `view`: a run makes no pictures. The data of its
//! figures are still written to `figures.json`.

use super::{Recorder, RunError};
use crate::RunView;
use crate::scene::case::OutputSpec;
use fretwork_observe::chart::Figure;
use fretwork_observe::picture::Paint;
use std::path::Path;

/// Colours of layers, which a resumed run reads from its checkpoint.
#[derive(Debug, Default)]
pub(super) struct Camera(Vec<Paint>);

impl Camera {
    pub fn new(_: &dyn RunView, _: &OutputSpec) -> Self {
        Self::default()
    }

    pub fn assign_layers(&mut self, _: &dyn RunView) {}

    pub fn paints(&self) -> &[Paint] {
        &self.0
    }

    pub fn paint(&mut self, paints: Vec<Paint>) {
        self.0 = paints;
    }
}

/// Replacement for the drawing thread, which draws nothing.
#[derive(Debug, Default)]
pub(super) struct Drawing {}

impl Drawing {
    pub fn wait(&mut self) -> Result<(), RunError> {
        Ok(())
    }
}

pub(super) fn noted<T>(_: Option<String>, draw: impl FnOnce() -> T) -> T {
    draw()
}

pub(super) fn draw_figure(_: &Figure, _: &Path) -> Result<(), RunError> {
    Ok(())
}

impl Recorder<'_> {
    pub(super) fn draw_pictures(&mut self, _: u64) -> Result<(), RunError> {
        Ok(())
    }
}
