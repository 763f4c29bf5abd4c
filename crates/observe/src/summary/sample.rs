//! What decides how far the numbers of one run go: a random sample, and elements or cells. What is
//! known of the scatter over seeds.

use crate::quantity::unit::WORD;
use fretwork_core::view::RunView;
use fretwork_scene::case::Case;
use fretwork_scene::random::draws;
use serde::Serialize;

crate::described! {
    /// What decides how far the numbers of one run go.
    #[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
    pub struct SampleFacts {
        /// Whether another seed gives another scene.
        pub random: bool => WORD,
        /// Whether bodies are divided into elements or cells, whose error one run does not show.
        pub cells: bool => WORD,
        /// What is known of the scatter over seeds; null where the seed changes nothing.
        pub seeds: Option<String> => WORD,
    }
}

impl SampleFacts {
    /// Returns the facts of a case and its scene.
    pub fn of(case: &Case, run: &dyn RunView) -> Self {
        let random = draws(case);
        Self {
            random,
            cells: run.system_count() > 0,
            seeds: random.then(|| scatter_over_seeds(&case.name)),
        }
    }
}

/// Titles of shipped cases, what runs of several of their seeds found, and where
/// `docs/dev/sensitivity.md` has the number.
const STUDIED: [(&str, &str, &str); 6] = [
    (
        "wheel-rail fretting of a third body",
        "over 10 seeds of the shipped case the energetic coefficient scatters by 2.3 %",
        "samples scatter by 2.3 %, as seeds do",
    ),
    (
        "regimes of a sheared layer",
        "over 3 seeds of the shipped case friction scatters by 8 %, bonds broken by 0.7 %",
        "| regime_map (3; fine 1) | friction | 0.266 | 8, 11 * |",
    ),
    (
        "propagation of a fault",
        "over 3 seeds of the shipped case the number of broken bonds scatters by 3 %",
        "| fault_propagation (3; others 1) | bonds broken | 2,160 | 3 |",
    ),
    (
        "wheel-rail fretting on a degradable rail",
        "over 3 seeds of the shipped case the energetic coefficient scatters by 10 %, damage by 0.5 %",
        "| wheel_rail_degradable, 1 cycle (3; inertia, alert 2) | energetic coefficient | 0.146 | 10 |",
    ),
    (
        "collapse of a column of disks",
        "over 3 seeds of the shipped case the energy dissipated by friction scatters by 3 %",
        "| collapse (3) | energy dissipated by friction | 31.1 J/m | 3 |",
    ),
    (
        "Voronoi block torn obliquely",
        "over 3 seeds of the shipped case the largest force on the wall scatters by 4 %",
        "| voronoi_block (3 seeds) | largest force on the wall | 188 kN/m | 4 |",
    ),
];

/// Says what is known of the scatter over seeds of a case with this title, whose seed changes its
/// scene.
fn scatter_over_seeds(title: &str) -> String {
    let found = STUDIED.iter().find(|s| s.0 == title);
    found.map_or_else(
        || {
            "one seed, and the scatter over seeds is not known; `fretwork study run CASE --seeds 8` measures it".to_owned()
        },
        |(_, says, _)| format!("one seed; {says} (docs/dev/sensitivity.md)"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(path: &str) -> String {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        std::fs::read_to_string(root.join(path)).unwrap()
    }

    #[test]
    fn each_scatter_is_that_of_the_page_on_accuracy() {
        let page = read("docs/dev/sensitivity.md");
        let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
        let cases = [
            "wheel_rail_fretting",
            "regime_map",
            "fault_propagation",
            "wheel_rail_degradable",
            "collapse",
            "voronoi_block",
        ];
        for ((title, says, row), case) in STUDIED.iter().zip(cases) {
            assert!(page.contains(row), "{row}");
            let case = read(&format!("cases/{case}.ron"));
            assert!(case.contains(&format!("name: \"{title}\"")), "{title}");
            assert!(scatter_over_seeds(title).contains(says));
        }
        assert!(scatter_over_seeds("mine").contains("not known"));
    }
}
