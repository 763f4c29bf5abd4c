//! Content, size and escaping of pages.

use super::{Trial, chart_numbers, data, text};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

#[test]
fn a_run_leaves_a_page_with_all_that_was_run_and_came_out() {
    let trial = Trial::new("content");
    let output = trial.run("out", &[]);
    assert!(text(&output).contains("report.html"), "{}", text(&output));
    let page = trial.page("out/report.html");
    let summary: Value = serde_json::from_str(&trial.page("out/summary.json")).unwrap();

    // Verdict and warnings come before the results, in the words of the summary.
    let verdict = page.find("class=\"verdict").unwrap();
    assert!(verdict < page.find("id=\"results\"").unwrap());
    let escaped = |t: &str| {
        t.replace('&', "&amp;")
            .replace('<', "&lt;")
            .replace('>', "&gt;")
            .replace('"', "&quot;")
            .replace('\'', "&#39;")
    };
    for warning in summary["warnings"].as_array().unwrap() {
        let (key, _) = warning.as_str().unwrap().split_once(':').unwrap();
        assert!(
            page.contains(&format!("<strong>{}</strong>", escaped(key))),
            "{key}"
        );
    }
    // The page has laws with version and SHA-256, identity, parameters with their units, and inputs
    // that are given or not.
    for plugin in summary["plugins"].as_array().unwrap() {
        for key in ["name", "version", "sha256"] {
            assert!(page.contains(plugin[key].as_str().unwrap()), "{plugin}");
        }
        // The path of a library on this machine must not appear.
        assert!(!page.contains(plugin["path"].as_str().unwrap()), "{plugin}");
    }
    assert!(page.contains(summary["identity"].as_str().unwrap()));
    assert!(page.contains("@software{fretwork_"));
    assert!(
        page.contains("1e10 Pa/m"),
        "a parameter with the unit of its law"
    );
    for (key, value, unit, from) in [
        ("time.step", "0.0001", "s", "given"),
        ("time.theta", "0.5", "", "default"),
        ("bodies.plate.dofs.x.amplitude", "0.002", "m", "given"),
        ("solver.relaxation", "1.45", "", "default"),
        ("biaxial", "", "", "not set"),
    ] {
        let row = format!("<code>{key}</code></th><td>{value}</td><td>{unit}</td><td>{from}</td>");
        assert!(page.contains(&row), "{row}");
    }
    let mu = summary["energetic_coefficient"].as_f64().unwrap();
    assert!(
        page.contains(&format!("<span class=\"value\">{}", four_digits(mu))),
        "{mu}"
    );
}

/// Formats with four digits, without zeros at the end.
fn four_digits(value: f64) -> String {
    let text = format!(
        "{:.*}",
        (3 - value.abs().log10().floor() as i32).max(0) as usize,
        value
    );
    text.trim_end_matches('0').to_owned()
}

#[test]
fn figures_and_fields_have_the_names_units_and_words_of_the_file() {
    let trial = Trial::new("fields");
    trial.run("out", &[]);
    let data = data(&trial.page("out/report.html"));
    let file = hdf5::H5File::open(trial.path("out/results.h5")).unwrap();
    let same = |column: &Value, group: &str| {
        let set = file
            .dataset(&format!("{group}/{}", column["name"].as_str().unwrap()))
            .unwrap();
        let text = |name: &str| set.attr(name).unwrap().read_string().unwrap();
        let unit = text("unit");
        assert_eq!(
            column["unit"].as_str().unwrap(),
            if unit == "1" { "" } else { &unit }
        );
        assert_eq!(column["doc"].as_str().unwrap(), text("doc"));
    };
    let columns = data["runs"][0]["columns"].as_array().unwrap();
    assert!(columns.len() > 30);
    columns.iter().for_each(|c| same(c, "statistics"));
    for (of, group) in [
        ("grains", "views/grains/PointData"),
        ("contacts", "views/contacts/CellData"),
    ] {
        let fields = data["scene"][of]["fields"].as_array().unwrap();
        assert!(fields.len() > 5, "{of}");
        fields
            .iter()
            .filter(|f| f["of"].is_null())
            .for_each(|f| same(f, group));
    }
    let figures = data["figures"].as_array().unwrap();
    let names: Vec<&str> = figures
        .iter()
        .filter_map(|f| f["figure"].as_str())
        .collect();
    for name in [
        "fretting_loops",
        "friction_history",
        "damage_ratio",
        "energy",
    ] {
        assert!(names.contains(&name), "{name} in {names:?}");
    }
    assert_eq!(figures.last().unwrap()["any"]["up"][0], "mu");
    assert_eq!(data["scene"]["period"][0], 0.1);
    assert_eq!(data["scene"]["times"].as_array().unwrap().len(), 7);
}

#[test]
fn a_figure_is_the_same_in_its_picture_and_on_the_page() {
    let trial = Trial::new("figures");
    trial.run("out", &["output.figures=true"]);
    let page = trial.page("out/report.html");
    let (data, numbers) = (data(&page), chart_numbers(&page));
    let text = |v: &Value| v.as_str().unwrap().to_owned();
    let axis = |a: &Value| match a["unit"].as_str().unwrap() {
        "" => text(&a["name"]),
        unit => format!("{} ({unit})", text(&a["name"])),
    };
    // The page draws the figures with the titles of the pictures.
    let mut page: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for chart in data["figures"].as_array().unwrap() {
        let Some(figure) = chart["figure"].as_str() else {
            continue;
        };
        let series = chart["series"].as_array().unwrap();
        for one in series {
            let [x, y] = ["x", "y"].map(|key| &numbers[one[key].as_str().unwrap()]);
            assert!(x.len() == y.len() && y.iter().any(|v| *v != 0.0), "{one}");
        }
        let labels: Vec<String> = series.iter().map(|s| text(&s["label"])).collect();
        let labels: Vec<String> = labels.into_iter().filter(|l| !l.is_empty()).collect();
        let of = if labels.is_empty() { "" } else { ": " };
        let line = format!(
            "{}; {} over {}{of}{}",
            text(&chart["title"]),
            axis(&chart["y"]),
            axis(&chart["x"]),
            labels.join(", ")
        );
        page.entry(figure.to_owned()).or_default().push(line);
    }
    assert!(page.len() >= 4, "{:?}", page.keys());
    let described: Value = serde_json::from_str(&trial.page("out/figures.json")).unwrap();
    for figure in described.as_array().unwrap() {
        let name = figure["name"].as_str().unwrap();
        let picture = trial.path(&format!("out/{name}.png"));
        assert_eq!(picture.exists(), page.contains_key(name), "{name}");
        if let Some(lines) = page.get(name) {
            assert_eq!(
                description(&picture).lines().collect::<Vec<_>>(),
                *lines,
                "{name}"
            );
            let pixels = tiny_skia::Pixmap::load_png(&picture).unwrap();
            let coloured = pixels.pixels().iter().filter(|p| {
                let [a, b, c] = [p.red(), p.green(), p.blue()];
                a.max(b).max(c) - a.min(b).min(c) > 60
            });
            assert!(coloured.count() > 500, "{name}");
        }
    }
}

/// The text `Description` of a PNG file.
fn description(path: &Path) -> String {
    let bytes = std::fs::read(path).unwrap();
    let mut rest = &bytes[8..];
    while let Some((length, after)) = rest.split_first_chunk::<4>() {
        let length = u32::from_be_bytes(*length) as usize;
        if after.starts_with(b"iTXtDescription") {
            // A flag and a method of compression, and two empty texts follow the keyword.
            return String::from_utf8(after[20..4 + length].to_vec()).unwrap();
        }
        rest = &after[8 + length..];
    }
    panic!("no description in {}", path.display());
}

#[test]
fn no_text_of_a_case_becomes_markup_and_the_page_may_load_nothing() {
    let trial = Trial::new("escape");
    trial.run("out", &[]);
    trial.run("other", &["seed=6"]);
    let output = trial.call(&["compare", "out", "other"]);
    assert!(output.status.success(), "{}", text(&output));
    for name in ["out/report.html", "compare.html"] {
        let page = trial.page(name);
        assert!(page.contains("default-src 'none'"), "{name}");
        assert!(
            !page.contains("alert('title')") && !page.contains("<img src=x"),
            "{name}"
        );
        // One script runs, that of the policy; all others are data.
        assert_eq!(page.matches("<script>").count(), 1, "{name}");
        for from in ["http://", "//cdn", "src=\"", "@import", "url("] {
            let foreign = page
                .match_indices(from)
                .find(|(k, _)| !page[*k..].starts_with("http://www.w3.org/"));
            assert_eq!(foreign, None, "{name} {from}");
        }
    }
}

#[test]
fn a_page_keeps_to_its_size_and_says_what_it_leaves_out() {
    let trial = Trial::new("size");
    trial.run(
        "out",
        &[
            "output.views=400",
            "grains.0.count=180",
            "grains.0.radius=(0.0019,0.002)",
        ],
    );
    let full = trial.call(&["report", "out", "--full"]);
    assert!(full.status.success(), "{}", text(&full));
    let all = trial.page("out/report.html");
    assert_eq!(data(&all)["scene"]["times"].as_array().unwrap().len(), 401);
    let small = trial.call(&["report", "out", "--size", "0.7"]);
    assert!(small.status.success(), "{}", text(&small));
    let page = trial.page("out/report.html");
    assert!(page.len() <= 700_000, "{}", page.len());
    let scene = &data(&page)["scene"];
    let shown = scene["times"].as_array().unwrap();
    assert!(shown.len() < 401 && shown.len() > 3, "{}", shown.len());
    // The states include the first and the last.
    assert_eq!(shown.first(), Some(&0.0.into()));
    assert_eq!(
        shown.last(),
        data(&all)["scene"]["times"].as_array().unwrap().last()
    );
    assert!(page.contains(&format!(
        "{} of the 401 recorded states are shown",
        shown.len()
    )));
    assert!(all.len() > page.len() && !all.contains("recorded states are shown"));
}

#[test]
fn without_views_there_is_a_small_page_and_without_a_wish_none() {
    let trial = Trial::new("bare");
    trial.run("out", &["output.views=0"]);
    let page = trial.page("out/report.html");
    assert!(
        page.len() < 600_000 && page.contains("output.views"),
        "{}",
        page.len()
    );
    assert!(
        data(&page)["scene"].is_null()
            || data(&page)["scene"]["times"].as_array().unwrap().len() <= 1
    );
    // The next run removes the page of the previous one.
    let words = ["run", "case.ron", "--out", "out", "--no-report", "--force"];
    let output = trial.call(&words);
    assert!(output.status.success(), "{}", text(&output));
    assert!(!trial.path("out/report.html").exists());
}

#[test]
fn runs_side_by_side_show_what_differs() {
    let trial = Trial::new("compare");
    trial.run("soft", &["interfaces.layer.parameters.contact.mu=0.2"]);
    trial.run("hard", &[]);
    let output = trial.call(&["compare", "soft", "hard", "--out", "both.html"]);
    assert!(output.status.success(), "{}", text(&output));
    let page = trial.page("both.html");
    let row =
        "<code>interfaces.layer.parameters.contact.mu</code></th><td></td><td>0.2</td><td>0.4</td>";
    assert!(page.contains(row));
    let differences = &page[page.find("id=\"differences\"").unwrap()..];
    let differences = &differences[..differences.find("</table>").unwrap()];
    assert_eq!(differences.matches("<tr>").count(), 2, "{differences}");
    for name in ["soft", "hard"] {
        let summary: Value =
            serde_json::from_str(&trial.page(&format!("{name}/summary.json"))).unwrap();
        let mu = summary["energetic_coefficient"].as_f64().unwrap();
        assert!(page.contains(&four_digits(mu)), "{name} {mu}");
    }
    assert_eq!(data(&page)["runs"].as_array().unwrap().len(), 2);
}
