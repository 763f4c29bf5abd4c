//! What decides how far the numbers of one run go: a random sample, and elements or cells. What is
//! known of the scatter over seeds.

use crate::quantity::unit::{ONE, WORD};
use crate::quantity::{part, percent};
use fretwork_core::view::RunView;
use fretwork_math::statistics::interval;
use fretwork_scene::LoadedCase;
use fretwork_scene::material::MaterialLibrary;
use fretwork_scene::random::draws;
use fretwork_scene::source::{Source, first_difference};
use serde::{Deserialize, Serialize};

crate::described! {
    /// What decides how far the numbers of one run go.
    #[derive(Clone, Debug, Default, PartialEq, Serialize)]
    pub struct SampleFacts {
        /// Whether another seed gives another scene.
        pub random: bool => WORD,
        /// Whether bodies are divided into elements or cells, whose error one run does not show.
        pub cells: bool => WORD,
        /// What is known of the scatter over seeds; null where the seed changes nothing.
        pub seeds: Option<String> => WORD,
        /// Scatter of the coefficient of sliding over seeds, of a study of this case; null where
        /// none was made.
        pub sliding: Option<SeedScatter> = part::<SeedScatter>(),
    }
}

crate::described! {
    /// Scatter of a result over the seeds of a study.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
    pub struct SeedScatter {
        /// Number of seeds.
        pub seeds: u32 => ONE,
        /// Mean over the seeds.
        pub mean: f64 => ONE,
        /// Standard deviation over the seeds, as a share of the mean.
        pub deviation: f64 => ONE,
    }
}

impl SeedScatter {
    /// Returns the half-width of the 95 % interval of what one further seed gives, as a share of
    /// the mean: Student's t times the deviation times sqrt(1 + 1/n).
    pub fn half_width(&self) -> f64 {
        let count = self.seeds as usize;
        let t = interval::quantile(count).unwrap_or(f64::INFINITY);
        t * self.deviation * (1.0 + 1.0 / count as f64).sqrt()
    }
}

/// Names and texts of the material files of a scene.
type Materials = [(String, String)];

impl SampleFacts {
    /// Returns the facts of a case, its material files (names and texts) and its scene.
    pub fn of(loaded: &LoadedCase, materials: &Materials, run: &dyn RunView) -> Self {
        let random = draws(&loaded.case);
        let (seeds, sliding) = match random {
            true => scatter_over_seeds(loaded, materials),
            false => (String::new(), None),
        };
        Self {
            random,
            cells: run.system_count() > 0,
            seeds: random.then_some(seeds),
            sliding,
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
    /// Scatter of the coefficient of sliding.
    sliding: Option<SeedScatter>,
    /// Scatter of another result of a case without a friction test, with the number of seeds.
    other: &'static str,
    /// Where [`PAGE`] has that of the other result.
    #[cfg_attr(not(test), allow(dead_code, reason = "tests look for it"))]
    row: &'static str,
}

/// Page that has the numbers.
const PAGE: &str = "docs/dev/sensitivity.md";

const fn sliding(seeds: u32, mean: f64, deviation: f64) -> Option<SeedScatter> {
    Some(SeedScatter {
        seeds,
        mean,
        deviation,
    })
}

/// Shipped cases of which several seeds were run.
const STUDIED: [Studied; 5] = [
    Studied {
        case: "wheel_rail_fretting",
        text: include_str!("../../../../cases/wheel_rail_fretting.ron"),
        sliding: sliding(5, 0.4282, 0.0147),
        other: "",
        row: "",
    },
    Studied {
        case: "regime_map",
        text: include_str!("../../../../cases/regime_map.ron"),
        sliding: sliding(5, 0.2648, 0.032),
        other: "",
        row: "",
    },
    Studied {
        case: "fault_propagation",
        text: include_str!("../../../../cases/fault_propagation.ron"),
        sliding: None,
        other: "the number of broken bonds scatters by 3 % over 3 seeds",
        row: "| fault_propagation (3; others 1) | bonds broken | 2,160 | 3 |",
    },
    Studied {
        case: "collapse",
        text: include_str!("../../../../cases/collapse.ron"),
        sliding: None,
        other: "the energy dissipated by friction scatters by 3 % over 3 seeds",
        row: "| collapse (3) | energy dissipated by friction | 31.1 J/m | 3 |",
    },
    Studied {
        case: "voronoi_block",
        text: include_str!("../../../../cases/voronoi_block.ron"),
        sliding: None,
        other: "the largest force on the wall scatters by 4 % over 3 seeds",
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

/// Says what is known of the scatter over seeds of a case whose seed changes its scene; with the
/// scatter of the coefficient of sliding, where a study of this very case measured it.
fn scatter_over_seeds(loaded: &LoadedCase, materials: &Materials) -> (String, Option<SeedScatter>) {
    let mut like = STUDIED.iter().map(|s| (s, s.differs(loaded, materials)));
    let (same, titled) = (
        like.clone().find(|(_, differs)| differs.is_none()),
        like.find(|(s, _)| s.has_title_of(loaded)),
    );
    let found = same.or(titled);
    let unknown = match loaded.case.friction {
        Some(_) => "scatter of seeds: not studied for the coefficient of sliding",
        None => "scatter of seeds: not studied",
    };
    let Some((studied, differs)) = found else {
        let text = format!("one seed; {unknown}; `fretwork study run CASE --seeds 8` measures it");
        return (text, None);
    };
    let of = match &differs {
        None => "of this case".to_owned(),
        Some(by) => format!("of the shipped case, which has another {by}"),
    };
    let text = match &studied.sliding {
        Some(known) => format!(
            "one seed; the coefficient of sliding scatters by {} over {} seeds {of} (standard deviation by `fretwork study run cases/{}.ron --seeds {}`, {PAGE})",
            percent(known.deviation),
            known.seeds,
            studied.case,
            known.seeds
        ),
        None => format!("one seed; {} {of} ({PAGE})", studied.other),
    };
    (text, studied.sliding.filter(|_| differs.is_none()))
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
            let Some(known) = s.sliding else { continue };
            let row = format!(
                "| {} | {} | {:.4} | {} |",
                s.case,
                known.seeds,
                known.mean,
                percent(known.deviation)
            );
            assert!(page.contains(&row), "{row}");
        }
    }

    #[test]
    fn the_scatter_is_that_of_the_shipped_case_whose_inputs_a_case_has() {
        let of = |name: &str, sets: &[&str], materials: &Materials| {
            let sets: Vec<String> = sets.iter().map(|s| (*s).to_owned()).collect();
            let loaded = load(&root().join(format!("cases/{name}.ron")), &sets);
            scatter_over_seeds(&loaded.unwrap_or_else(|e| panic!("{e}")), materials)
        };
        for s in &STUDIED {
            let (own, sliding) = of(s.case, &["seed=12345", "output.frames=0"], &[]);
            let known = match s.sliding {
                Some(known) => format!("over {} seeds of this case", known.seeds),
                None => s.other.to_owned(),
            };
            assert!(own.contains(&known), "{own}");
            assert_eq!(sliding, s.sliding);
        }
        let (other, sliding) = of("wheel_rail_fretting", &["time.end=0.075"], &[]);
        assert!(
            other.contains("seeds of the shipped case, which has another `time.end` (standard"),
            "{other}"
        );
        assert_eq!(sliding, None);
        let steel = ["contact_steel", "mine"].map(|name| (name.to_owned(), "()".to_owned()));
        let (own_steel, _) = of("wheel_rail_fretting", &[], &steel);
        assert!(
            own_steel.contains("another material file `contact_steel`"),
            "{own_steel}"
        );
        let (unknown, _) = of("plane_shear", &[], &[]);
        assert!(
            unknown.contains("scatter of seeds: not studied;"),
            "{unknown}"
        );
        let (unknown, _) = of("wheel_rail_rigid", &[], &[]);
        assert!(
            unknown.contains("not studied for the coefficient of sliding; `fretwork study"),
            "{unknown}"
        );
    }

    #[test]
    fn one_seed_is_off_the_mean_by_its_scatter_and_that_of_the_mean() {
        // t(4, 0.975) = 2.776445, sqrt(6/5) = 1.0954451.
        let known = SeedScatter {
            seeds: 5,
            mean: 0.4,
            deviation: 0.02,
        };
        assert!((known.half_width() / (2.776_445 * 0.02 * 1.095_445_1) - 1.0).abs() < 1e-6);
    }
}
