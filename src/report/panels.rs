//! Several charts on one page.

use super::canvas::{Canvas, ReportError};
use super::chart::Chart;
use std::path::Path;

/// Draws charts row by row, so many columns wide, to one PNG file; each takes the size of the first.
///
/// # Errors
/// The file cannot be written, or there is nothing to draw.
pub fn draw_panels(charts: &[Chart], columns: usize, path: &Path) -> Result<(), ReportError> {
    let (width, height) = charts.first().map_or((0, 0), |c| c.size_px);
    let columns = columns.clamp(1, charts.len().max(1));
    let rows = charts.len().div_ceil(columns) as u32;
    let mut page = Canvas::new(width * columns as u32, height * rows)?;
    for (k, chart) in charts.iter().enumerate() {
        let mut chart = chart.clone();
        chart.size_px = (width, height);
        let (row, column) = (k / columns, k % columns);
        page.paste(
            &chart.page()?,
            column * width as usize,
            row * height as usize,
        );
    }
    page.save(path)
}
