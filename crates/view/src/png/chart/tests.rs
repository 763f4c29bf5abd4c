//! Tests of charts as PNG files.

use super::*;
use crate::png::canvas::png_size;
use fretwork_observe::chart::{Axis, Style};

fn file(name: &str) -> std::path::PathBuf {
    std::env::temp_dir().join(format!("fretwork-chart-{}-{name}.png", std::process::id()))
}

fn chart() -> Chart {
    Chart::new(
        "Title",
        Axis::new("displacement δ", "m"),
        Axis::new("load Q", "N"),
    )
}

#[test]
fn any_data_gives_a_picture_of_the_stated_size() {
    let cases = [
        ("empty", vec![]),
        ("one", vec![(1.0, 2.0)]),
        ("constant", vec![(0.0, 3.0), (1.0, 3.0)]),
        (
            "gaps",
            vec![
                (0.0, 1.0),
                (f64::NAN, 2.0),
                (1.0, f64::INFINITY),
                (2.0, 0.0),
            ],
        ),
        ("nothing-finite", vec![(f64::NAN, f64::NAN)]),
    ];
    for (name, points) in cases {
        for style in [
            Style::Line,
            Style::Dashed,
            Style::Markers,
            Style::LineMarkers,
        ] {
            let mut chart = chart().with(Series::new(name, points.clone()).style(style));
            chart.size_px = (420, 300);
            let path = file(name);
            draw_panels(&[chart], 1, &path).unwrap();
            // No file is written if there is nothing to show.
            let empty = ["empty", "nothing-finite"].contains(&name);
            assert_eq!(path.exists(), !empty, "{name}");
            if !empty {
                assert_eq!(png_size(&path), (420, 300));
                std::fs::remove_file(path).unwrap();
            }
        }
    }
}

#[test]
fn errors_name_what_to_change() {
    let drawn = chart().with(Series::new("a", vec![(0.0, 1.0)]));
    let error = draw_panels(
        std::slice::from_ref(&drawn),
        1,
        Path::new("no-such-folder/a.png"),
    )
    .unwrap_err();
    assert!(
        error.to_string().contains("no-such-folder/a.png"),
        "{error}"
    );
    let mut upside_down = drawn;
    upside_down.x_range = Some((1.0, 0.0));
    let error = draw_panels(&[upside_down], 1, &file("range")).unwrap_err();
    assert!(error.to_string().contains("displacement δ"), "{error}");
}

#[test]
fn grid_lies_where_the_labels_are_written() {
    let chart = Chart {
        x_range: Some((0.0, 1.0)),
        y_range: Some((0.9, 2.9)),
        size_px: (400, 300),
        ..chart()
    };
    let layout = Layout::new(&chart, 0.4).unwrap();
    let mut page = Canvas::new(400, 300).unwrap();
    layout.grid(&mut page);
    let Plot {
        left, top, height, ..
    } = layout.plot;
    let grey = |row: i32| {
        let pixel = page.pixmap.pixel(left as u32 + 3, row as u32).unwrap();
        pixel.red() < 240
    };
    assert!(layout.y.ticks.len() > 2);
    for (tick, _) in &layout.y.ticks {
        let row = top + height - ((tick - 0.9) / 2.0 * f64::from(height)).round() as i32;
        assert!((row - 1..=row + 1).any(grey), "no line at {tick}");
    }
}

#[test]
fn a_page_has_the_colours_and_ranges_of_the_picture() {
    let log = |chart: Chart| Chart {
        x: chart.x.log(),
        y: chart.y.log(),
        ..chart
    };
    let with = |points: &[(f64, f64)]| chart().with(Series::new("a", points.to_vec()));
    let intervals = Series::new("b", vec![(1e-6, 2.0), (3e-6, 1.0)]);
    let mut fixed = with(&[(0.0, 1.0), (1.0, 2.0)]);
    fixed.x_range = Some((0.2, 0.4));
    let mut later = Series::new("later", vec![(0.0, 1.0)]);
    later.place = 9;
    let charts = [
        with(&[]),
        log(with(&[])),
        with(&[(0.0, 0.0), (1.0, 0.0)]),
        with(&[(1.0, 3.0), (1.0 + 1e-13, 3.0)]),
        with(&[(0.0, 2e4), (1.0, f64::NAN), (2e-3, -3e5)]),
        log(with(&[(0.0, 2e4), (1e-3, 7.0), (10.0, 3.0)])),
        log(with(&[(1e-3, 7.0)])),
        chart().with(intervals.intervals(vec![(0.5, 9.0), (f64::NAN, 1.0)])),
        fixed,
        with(&[(1.0, 1.0)]).with(later.clone()),
        with(&[(1.0, 1.0)]).with(later.coloured(1, 2, 3)),
    ];
    let palette = crate::html::figures::palette();
    for chart in charts {
        let layout = Layout::new(&chart, 1.0).unwrap();
        let page = crate::html::figures::chart("", &chart, &mut Default::default());
        for (axis, scale) in [(&page["x"], &layout.x), (&page["y"], &layout.y)] {
            assert_eq!(axis["label"], scale.label);
            let range = [&axis["range"][0], &axis["range"][1]].map(|v| v.as_f64().unwrap());
            assert_eq!(range.map(|v| scale.shown(v)), <[f64; 2]>::from(scale.range));
            let factor = axis["factor"].as_f64().unwrap();
            assert_eq!(factor, 10f64.powi(-scale.exponent));
        }
        for (k, series) in page["series"].as_array().unwrap().iter().enumerate() {
            let own = &palette["light"][series["place"].as_u64().unwrap() as usize];
            let colour = match &series["colour"] {
                serde_json::Value::Null => own,
                given => given,
            };
            assert_eq!(*colour, serde_json::json!(layout.colour(k)));
        }
    }
}

#[test]
fn gaps_split_the_line() {
    let points = vec![(0.0, 0.0), (1.0, 1.0), (f64::NAN, 0.0), (2.0, 0.0)];
    let chart = chart().with(Series::new("a", points));
    let runs = Layout::new(&chart, 1.0).unwrap().curves();
    assert_eq!(runs[0].iter().map(Vec::len).collect::<Vec<_>>(), [2, 1]);
}

#[test]
fn charts_without_data_are_left_out_and_so_is_an_empty_page() {
    let chart = |points| {
        let mut chart = chart().with(Series::new("curve", points));
        chart.subtitle = Some("case".to_owned());
        chart
    };
    let path = file("panels");
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
