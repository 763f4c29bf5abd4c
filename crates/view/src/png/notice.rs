//! Warning band above pictures of a run that is not trustworthy.

use super::canvas::{Canvas, DrawError, Rgb, WHITE};
use super::font::{TextStyle, text_width};
use std::cell::RefCell;

const RED: Rgb = [176, 24, 32];

thread_local! {
    static NOTICE: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Runs `draw` such that each picture has a band with this text, if any, at its top.
pub fn noted<T>(notice: Option<String>, draw: impl FnOnce() -> T) -> T {
    let before = NOTICE.replace(notice);
    let drawn = draw();
    NOTICE.set(before);
    drawn
}

/// Text of the current band.
pub(crate) fn current() -> Option<String> {
    NOTICE.with_borrow(Clone::clone)
}

/// Adds a band above an otherwise unchanged picture.
pub(crate) fn banded(picture: &Canvas, text: &str) -> Result<Canvas, DrawError> {
    let (width, height) = (picture.pixmap.width(), picture.pixmap.height());
    let u = width as f32 / 1400.0;
    let band = (56.0 * u).round().max(12.0);
    let mut page = Canvas::new(width, height + band as u32)?;
    page.paste(picture, 0, band as usize);
    page.rect([0.0, 0.0, width as f32, band], RED);
    let size = 29.0 * u;
    let room = width as f32 - 48.0 * u;
    let size = size * (room / text_width(text, size)).min(1.0);
    let style = TextStyle::new(size, WHITE).bold();
    page.text(text, [24.0 * u, 0.5 * band + 0.35 * size], &style);
    Ok(page)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draw_panels;
    use crate::png::canvas::png_size;
    use fretwork_observe::chart::{Axis, Chart, Series};

    #[test]
    fn a_notice_stands_above_the_picture_which_stays_as_it_is() {
        let mut picture = Canvas::new(1400, 300).unwrap();
        picture.rect([10.0, 10.0, 50.0, 50.0], [1, 2, 3]);
        let page = banded(&picture, "NOT TRUSTWORTHY: NOT CONVERGED").unwrap();
        assert_eq!((page.pixmap.width(), page.pixmap.height()), (1400, 356));
        let kept = &page.pixmap.pixels()[56 * 1400..];
        assert!(kept == picture.pixmap.pixels());
        let white = |p: &&tiny_skia::PremultipliedColorU8| p.red() > 200 && p.blue() > 200;
        let letters = page.pixmap.pixels()[..56 * 1400]
            .iter()
            .filter(white)
            .count();
        assert!(letters > 1000, "{letters} bright pixels in the band");
    }

    #[test]
    fn only_pictures_drawn_under_a_notice_have_the_band() {
        let file = |name: &str| {
            let name = format!("fretwork-notice-{}-{name}.png", std::process::id());
            std::env::temp_dir().join(name)
        };
        let (plain, noted_file) = (file("plain"), file("noted"));
        let mut chart = Chart::new("a", Axis::new("x", "m"), Axis::new("y", "m"));
        chart
            .series
            .push(Series::new("b", vec![(0.0, 0.0), (1.0, 1.0)]));
        noted(Some("NOT TRUSTWORTHY".to_owned()), || {
            draw_panels(std::slice::from_ref(&chart), 1, &noted_file)
        })
        .unwrap();
        draw_panels(&[chart], 1, &plain).unwrap();
        let (one, other) = (png_size(&plain), png_size(&noted_file));
        assert!(one.0 == other.0 && one.1 < other.1, "{one:?} {other:?}");
        for path in [plain, noted_file] {
            std::fs::remove_file(path).unwrap();
        }
    }
}
