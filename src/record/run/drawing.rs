//! Drawing in parallel with the steps: a separate thread draws the pictures of one time while the
//! following steps are computed.

use super::RunError;
pub(super) use crate::view::noted;
pub(super) use crate::view::picture::Camera;
use crate::view::{Chart, DrawError, Figure, Frame, draw_panels};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::{Builder, JoinHandle};

/// A picture to be drawn.
#[derive(Debug)]
pub(super) struct Picture {
    pub content: DrawnContent,
    pub path: PathBuf,
    /// Text of the band above the picture.
    pub notice: Option<String>,
}

#[derive(Debug)]
pub(super) enum DrawnContent {
    Scene(Box<Frame>),
    Charts(Vec<Chart>),
}

/// Draws a figure from the rows of the statistics.
///
/// # Errors
/// The file cannot be written.
pub(super) fn draw_figure(figure: &Figure, path: &Path) -> Result<(), RunError> {
    Ok(draw_panels(&figure.headed(), figure.columns, path)?)
}

impl Picture {
    fn draw(&self) -> Result<(), DrawError> {
        noted(self.notice.clone(), || match &self.content {
            DrawnContent::Scene(frame) => frame.draw(&self.path),
            DrawnContent::Charts(charts) => draw_panels(charts, 2, &self.path),
        })
    }
}

/// The drawing thread, if one is running.
#[derive(Debug, Default)]
pub(super) struct Drawing {
    thread: Option<JoinHandle<Result<(), DrawError>>>,
}

impl Drawing {
    /// Starts to draw pictures after the previous ones are finished.
    ///
    /// # Errors
    /// A previous picture could not be written.
    pub fn begin(&mut self, pictures: Vec<Picture>) -> Result<(), RunError> {
        self.wait()?;
        let pictures = Arc::new(pictures);
        let theirs = Arc::clone(&pictures);
        let draw = move || theirs.iter().try_for_each(Picture::draw);
        match Builder::new().name("pictures".to_owned()).spawn(draw) {
            Ok(thread) => self.thread = Some(thread),
            // The system has no more threads.
            Err(_) => pictures.iter().try_for_each(Picture::draw)?,
        }
        Ok(())
    }

    /// Waits until all pictures are on disk.
    ///
    /// # Errors
    /// A picture could not be written.
    pub fn wait(&mut self) -> Result<(), RunError> {
        match self.thread.take().map(JoinHandle::join) {
            None => Ok(()),
            Some(Ok(drawn)) => Ok(drawn?),
            Some(Err(panic)) => std::panic::resume_unwind(panic),
        }
    }
}

impl Drop for Drawing {
    fn drop(&mut self) {
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
