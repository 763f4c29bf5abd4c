//! What decides how far the numbers of one run go: a random sample, and elements or cells. What is
//! known of the scatter over seeds.

use crate::quantity::unit::WORD;
use fretwork_core::view::RunView;
use fretwork_scene::LoadedCase;
use fretwork_scene::material::MaterialLibrary;
use fretwork_scene::random::draws;
use fretwork_scene::source::{Source, first_difference};
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

/// Names and texts of the material files of a scene.
type Materials = [(String, String)];

impl SampleFacts {
    /// Returns the facts of a case, its material files (names and texts) and its scene.
    pub fn of(loaded: &LoadedCase, materials: &Materials, run: &dyn RunView) -> Self {
        let random = draws(&loaded.case);
        Self {
            random,
            cells: run.system_count() > 0,
            seeds: random.then(|| scatter_over_seeds(loaded, materials)),
        }
    }
}

/// Keys of a case that change nothing in what its seeds scatter by.
const FREE: [&str; 3] = ["name", "seed", "output"];

/// A shipped case of which several seeds were run.
struct Studied {
    /// Name of the case, without .ron.
    case: &'static str,
    /// Its text.
    text: &'static str,
    /// Number of seeds.
    seeds: u32,
    /// What they scatter by.
    says: &'static str,
    /// Where [`PAGE`] has the number.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests look for it"))]
    row: &'static str,
}

/// Page that has the numbers.
const PAGE: &str = "docs/dev/sensitivity.md";

/// Shipped cases of which several seeds were run.
const STUDIED: [Studied; 6] = [
    Studied {
        case: "wheel_rail_fretting",
        text: include_str!("../../../../cases/wheel_rail_fretting.ron"),
        seeds: 10,
        says: "the energetic coefficient scatters by 2.3 %",
        row: "samples scatter by 2.3 %, as seeds do",
    },
    Studied {
        case: "regime_map",
        text: include_str!("../../../../cases/regime_map.ron"),
        seeds: 3,
        says: "friction scatters by 8 %, bonds broken by 0.7 %",
        row: "| regime_map (3; fine 1) | friction | 0.266 | 8, 11 * |",
    },
    Studied {
        case: "fault_propagation",
        text: include_str!("../../../../cases/fault_propagation.ron"),
        seeds: 3,
        says: "the number of broken bonds scatters by 3 %",
        row: "| fault_propagation (3; others 1) | bonds broken | 2,160 | 3 |",
    },
    Studied {
        case: "wheel_rail_degradable",
        text: include_str!("../../../../cases/wheel_rail_degradable.ron"),
        seeds: 3,
        says: "the energetic coefficient scatters by 10 %, damage by 0.5 %",
        row: "| wheel_rail_degradable, 1 cycle (3; inertia, alert 2) | energetic coefficient | 0.146 | 10 |",
    },
    Studied {
        case: "collapse",
        text: include_str!("../../../../cases/collapse.ron"),
        seeds: 3,
        says: "the energy dissipated by friction scatters by 3 %",
        row: "| collapse (3) | energy dissipated by friction | 31.1 J/m | 3 |",
    },
    Studied {
        case: "voronoi_block",
        text: include_str!("../../../../cases/voronoi_block.ron"),
        seeds: 3,
        says: "the largest force on the wall scatters by 4 %",
        row: "| voronoi_block (3 seeds) | largest force on the wall | 188 kN/m | 4 |",
    },
];

impl Studied {
    /// Returns the first input in which a case differs from this one, as a phrase; `None` if it has
    /// the same inputs but for its seed.
    fn differs(&self, loaded: &LoadedCase, materials: &Materials) -> Option<String> {
        let own = Source::from_text(self.case, self.text);
        if let Some(found) = first_difference(&own, &loaded.source, &FREE) {
            return Some(format!("`{}`", found.path));
        }
        let shipped = MaterialLibrary::shipped();
        let other = materials.iter().find(|(name, text)| {
            let file = shipped.read(name);
            !file.is_ok_and(|file| {
                first_difference(&file, &Source::from_text(name, text.as_str()), &[]).is_none()
            })
        });
        other.map(|(name, _)| format!("material file `{name}`"))
    }

    /// Whether a case has the title of this one.
    fn has_title_of(&self, loaded: &LoadedCase) -> bool {
        let title = format!("name: \"{}\"", loaded.case.name);
        self.text.contains(&title)
    }
}

/// Says what is known of the scatter over seeds of a case whose seed changes its scene.
fn scatter_over_seeds(loaded: &LoadedCase, materials: &Materials) -> String {
    let mut like = STUDIED.iter().map(|s| (s, s.differs(loaded, materials)));
    let (same, titled) = (
        like.clone().find(|(_, differs)| differs.is_none()),
        like.find(|(s, _)| s.has_title_of(loaded)),
    );
    match same.or(titled) {
        None => "one seed, and the scatter over seeds is not known; `fretwork study run CASE --seeds 8` measures it".to_owned(),
        Some((s, None)) => format!("one seed; over {} seeds of this case {} ({PAGE})", s.seeds, s.says),
        Some((s, Some(by))) => format!(
            "one seed; over {} seeds of the shipped case, which has another {by}, {} ({PAGE})",
            s.seeds, s.says
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fretwork_scene::load;
    use std::path::{Path, PathBuf};

    fn root() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
    }

    #[test]
    fn each_scatter_is_that_of_the_page_on_sensitivity() {
        let page = std::fs::read_to_string(root().join(PAGE)).unwrap();
        let page = page.split_whitespace().collect::<Vec<_>>().join(" ");
        for s in &STUDIED {
            assert!(page.contains(s.row), "{}", s.row);
        }
    }

    #[test]
    fn the_scatter_is_that_of_the_shipped_case_whose_inputs_a_case_has() {
        let says = |name: &str, sets: &[&str], materials: &Materials| {
            let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
            let loaded = load(&root().join(format!("cases/{name}.ron")), &sets);
            scatter_over_seeds(&loaded.unwrap_or_else(|e| panic!("{e}")), materials)
        };
        for s in &STUDIED {
            let own = says(s.case, &["seed=12345", "output.frames=0"], &[]);
            let known = format!("over {} seeds of this case {}", s.seeds, s.says);
            assert!(own.contains(&known), "{own}");
        }
        let other = says("wheel_rail_fretting", &["time.end=0.075"], &[]);
        assert!(
            other.contains("of the shipped case, which has another `time.end`, the energetic"),
            "{other}"
        );
        let steel = ["contact_steel", "mine"].map(|name| (name.to_owned(), "()".to_owned()));
        let own_steel = says("wheel_rail_fretting", &[], &steel);
        assert!(
            own_steel.contains("another material file `contact_steel`"),
            "{own_steel}"
        );
        let unknown = says("plane_shear", &[], &[]);
        assert!(unknown.contains("not known"), "{unknown}");
    }
}
