//! Several charts on one page.

use super::canvas::{Canvas, INK, ReportError};
use super::chart::{DrawChart, PAGE, Sheet, wrapped};
use super::font::TextStyle;
use fretwork_observe::chart::Chart;
use std::path::Path;

/// Width of a page in pixels: 318 per inch if it is printed 16 cm wide.
const WIDTH: u32 = 2000;
/// Height of a panel over its width.
const ASPECT: f32 = 0.8;
/// Limit on the columns: in narrower panels text of 9 pt leaves no room for curves.
const COLUMNS: usize = 2;

/// Draws charts row by row in a number of columns (at most two) to one PNG file. Charts without data are omitted;
/// without any chart there is no file. A subtitle common to all charts is drawn once, above the page.
///
/// # Errors
/// The file cannot be written.
pub fn draw_panels(charts: &[Chart], columns: usize, path: &Path) -> Result<(), ReportError> {
    let mut charts: Vec<Chart> = charts.iter().filter(|c| c.has_data()).cloned().collect();
    match charts.as_slice() {
        [] => return Ok(()),
        [one] => return one.draw(path),
        _ => {}
    }
    let heading = common(&mut charts);
    let columns = columns.clamp(1, COLUMNS);
    let panel = WIDTH / columns as u32;
    let high = (panel as f32 * if columns == 1 { 0.6 } else { ASPECT }).round() as u32;
    let u = WIDTH as f32 / PAGE;
    let lines = wrapped(&heading, 32.0 * u, WIDTH as f32 - 48.0 * u);
    let top = match lines.len() {
        0 => 0,
        n => ((18.0 + 40.0 * n as f32) * u).round() as u32,
    };
    let rows = charts.len().div_ceil(columns) as u32;
    let mut page = Canvas::new(WIDTH, top + high * rows)?;
    let bold = TextStyle::new(32.0 * u, INK).bold();
    for (k, line) in lines.iter().enumerate() {
        page.text(line, [24.0 * u, (44.0 + 40.0 * k as f32) * u], &bold);
    }
    for (k, chart) in charts.iter_mut().enumerate() {
        chart.size_px = (panel, high);
        let letter = char::from(b'a' + (k % 26) as u8);
        chart.title = format!("({letter}) {}", chart.title);
        let (row, column) = (k / columns, k % columns);
        page.paste(
            &Sheet(chart).page(WIDTH)?,
            column * panel as usize,
            top as usize + row * high as usize,
        );
    }
    page.save(path)
}

/// Removes the subtitle that all charts have in common, and returns it.
fn common(charts: &mut [Chart]) -> String {
    let first = charts.first().and_then(|c| c.subtitle.clone());
    let Some(first) = first.filter(|f| charts.iter().all(|c| c.subtitle.as_ref() == Some(f)))
    else {
        return String::new();
    };
    charts.iter_mut().for_each(|c| c.subtitle = None);
    first
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::png_size;
    use fretwork_observe::chart::{Axis, Series};

    fn chart(points: Vec<(f64, f64)>) -> Chart {
        let mut chart = Chart::new("heading", Axis::new("time", "s"), Axis::new("force", "N"));
        chart.subtitle = Some("case".to_owned());
        chart.with(Series::new("curve", points))
    }

    #[test]
    fn charts_without_data_are_left_out_and_so_is_an_empty_page() {
        let path = std::env::temp_dir().join(format!("fretwork-panels-{}.png", std::process::id()));
        let none = chart(vec![(f64::NAN, 1.0)]);
        draw_panels(&[none.clone(), chart(Vec::new())], 2, &path).unwrap();
        assert!(!path.exists());
        let some = chart(vec![(0.0, 1.0), (1.0, 2.0)]);
        draw_panels(&[none.clone(), some.clone(), some.clone()], 3, &path).unwrap();
        let two = png_size(&path);
        assert_eq!(two.0, WIDTH);
        draw_panels(&[some.clone(), some.clone(), some], 3, &path).unwrap();
        // A third chart begins a second row, since there are at most two columns.
        assert!(png_size(&path).1 > two.1 + 700);
        std::fs::remove_file(path).unwrap();
    }
}
