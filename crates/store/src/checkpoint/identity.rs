//! Identity of a run: the case, materials, laws and files that determine its results bit by bit.

use fretwork_core::encoding::hex;
use fretwork_core::geometry::space::Space;
use fretwork_core::heat::{Grid, HalfSpace, Node, Store};
use fretwork_core::in_dimension;
use fretwork_core::step::State;
use fretwork_observe::encoding::{EncodingError, encode};
use fretwork_scene::source::{Source, first_difference};
use fretwork_scene::{Built, LoadedCase};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::borrow::Cow;
use std::fmt::Write;

/// Keys of the case that may differ in a resumed run, since they do not affect the computation.
const FREE: [&str; 2] = ["output.checkpoint", "output.figures"];
/// Key whose value may increase in a resumed run.
const END: &str = "time.end";

/// Where the code of a law comes from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum LawCode {
    /// A library with this SHA-256.
    Library(String),
    /// The program itself, whose file has this SHA-256.
    Program(String),
}

impl LawCode {
    /// Whether `now` is the same code, or the shipped law of another build of the program.
    fn is_input(&self, now: &Self) -> bool {
        let program = |code: &Self| matches!(code, Self::Program(_));
        self == now || (program(self) && program(now))
    }

    /// Says where the code comes from, with the beginning of its SHA-256.
    fn said(&self) -> String {
        let (of, sum) = match self {
            Self::Library(sum) => ("", sum),
            Self::Program(sum) => ("program of ", sum),
        };
        format!("{of}SHA-256 {}...", sum.get(..12).unwrap_or(sum))
    }
}

/// Identity of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Identity {
    /// Dimension, 2 or 3.
    dimension: u32,
    /// Text of the case, with `--set` applied.
    case: String,
    /// End time (s).
    end: f64,
    /// Material files: name and text.
    materials: Vec<(String, String)>,
    /// Laws: kind with name, and where their code comes from.
    laws: Vec<(String, LawCode)>,
    /// SHA-256 of the built scene without the depths of its thermal half-spaces. It includes the
    /// effect of files named in the case (profiles, meshes, samples).
    scene: String,
}

impl Identity {
    /// Identity of a case and its built scene, before the first step.
    ///
    /// # Errors
    /// The scene cannot be serialized.
    pub fn of(loaded: &LoadedCase, built: &Built) -> Result<Self, EncodingError> {
        let mut laws: Vec<(String, LawCode)> = Vec::new();
        for law in built.simulation.laws().iter().flat_map(|l| l.loaded()) {
            let p = &law.plugin;
            let sum = p.sha256.clone();
            let code = match p.built_in {
                true => LawCode::Program(sum),
                false => LawCode::Library(sum),
            };
            let stamp = (format!("{} law `{}`", p.kind, p.name), code);
            if !laws.contains(&stamp) {
                laws.push(stamp);
            }
        }
        let mut hash = HashWriter(Sha256::new());
        in_dimension!(&built.simulation, |s| {
            hash.0.update(encode(&*without_depths(&s.state))?);
            // Writing to the hash never fails.
            let _ = write!(hash, "{:?}", s.shapes);
        });
        Ok(Self {
            dimension: loaded.case.dimension,
            case: loaded.source.text().to_owned(),
            end: loaded.case.time.end,
            materials: built.materials.clone(),
            laws,
            scene: hex(&hash.0.finalize()),
        })
    }

    /// Whether shipped laws are those of another build of the program than in `now`.
    pub fn is_of_another_build(&self, now: &Self) -> bool {
        let other = |(name, code): &(String, LawCode)| {
            find(&self.laws, name).is_some_and(|old| old.is_input(code) && old != code)
        };
        now.laws.iter().any(other)
    }

    /// Name of a serialized identity: its SHA-256.
    pub fn name(bytes: &[u8]) -> String {
        hex(&Sha256::digest(bytes))
    }

    /// End time (s).
    pub fn end(&self) -> f64 {
        self.end
    }

    /// Whether `now` describes the same run with a later end.
    pub fn ends_later(&self, now: &Self) -> bool {
        now.end > self.end
    }

    /// Describes the first relevant difference of the inputs from those of `now`; `None` if there
    /// is none and `now` ends no earlier. Shipped laws are part of the program, whatever its build.
    pub fn differs(&self, now: &Self) -> Option<String> {
        if self.case != now.case {
            let [a, b] = [&self.case, &now.case].map(|t| Source::from_text("case", t.clone()));
            let mut free = FREE.to_vec();
            if self.ends_later(now) {
                free.push(END);
            }
            if let Some(d) = first_difference(&a, &b, &free) {
                let said = |text: Option<String>| text.unwrap_or("not given".to_owned());
                return Some(format!(
                    "`{}` was {} in the original run and is {} now",
                    d.path,
                    said(d.one),
                    said(d.other)
                ));
            }
        }
        for (name, text) in &now.materials {
            match find(&self.materials, name) {
                None => return Some(format!("it does not use the material `{name}`")),
                Some(old) if old != text => {
                    return Some(format!("the material file `{name}` has changed since"));
                }
                Some(_) => {}
            }
        }
        for (name, code) in &now.laws {
            match find(&self.laws, name) {
                None => return Some(format!("it does not use the {name}")),
                Some(old) if !old.is_input(code) => {
                    let [old, new] = [old, code].map(LawCode::said);
                    return Some(format!(
                        "the library of the {name} has changed ({old} in the original run, {new} now)"
                    ));
                }
                Some(_) => {}
            }
        }
        if (self.materials.len(), self.laws.len()) != (now.materials.len(), now.laws.len()) {
            return Some("it uses other materials or laws".to_owned());
        }
        (self.scene != now.scene || self.dimension != now.dimension).then(|| {
            "the case builds another scene: a file that it names (profile, mesh, sample, scene) has changed since"
                .to_owned()
        })
    }
}

fn find<'a, T>(list: &'a [(String, T)], name: &str) -> Option<&'a T> {
    list.iter().find(|l| l.0 == name).map(|l| &l.1)
}

/// Returns a state whose thermal half-spaces have no depth. Their grids follow from the rest of an
/// identity, except for a depth that the case does not give: that depth follows from `time.end`,
/// and an extended run keeps the one with which it began.
fn without_depths<S: Space>(state: &State<S>) -> Cow<'_, State<S>> {
    let deep = |node: &Node| matches!(node.store, Store::HalfSpace(_));
    let heat = state.heat.as_ref();
    if !heat.is_some_and(|h| h.nodes.iter().any(deep)) {
        return Cow::Borrowed(state);
    }
    let mut state = state.clone();
    for node in state.heat.iter_mut().flat_map(|h| &mut h.nodes) {
        if let Store::HalfSpace(space) = &mut node.store {
            let grid = Grid {
                depth: Vec::new(),
                capacity: Vec::new(),
                conductance: Vec::new(),
            };
            **space = HalfSpace::new(grid, space.area, node.temperature);
        }
    }
    Cow::Owned(state)
}

/// Writer that hashes what is written to it.
struct HashWriter(Sha256);

impl Write for HashWriter {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(laws: &[(&str, LawCode)]) -> Identity {
        let laws = laws.iter();
        Identity {
            dimension: 2,
            case: String::new(),
            end: 1.0,
            materials: Vec::new(),
            laws: laws
                .map(|(name, code)| ((*name).to_owned(), code.clone()))
                .collect(),
            scene: String::new(),
        }
    }

    #[test]
    fn a_key_that_one_case_does_not_give_is_said_to_be_missing() {
        let case = |text: &str| Identity {
            case: text.to_owned(),
            ..of(&[])
        };
        let (without, with) = (case("(name: \"a\")"), case("(name: \"a\", seed: 7)"));
        assert_eq!(
            without.differs(&with).unwrap(),
            "`seed` was not given in the original run and is 7 now"
        );
        assert_eq!(
            with.differs(&without).unwrap(),
            "`seed` was 7 in the original run and is not given now"
        );
    }

    #[test]
    fn shipped_laws_are_no_inputs_whatever_the_build_of_the_program() {
        let program = |sum: &str| LawCode::Program(sum.to_owned());
        let library = |sum: &str| LawCode::Library(sum.to_owned());
        let old = of(&[("contact law `coulomb`", program("a"))]);
        let rebuilt = of(&[("contact law `coulomb`", program("b"))]);
        assert_eq!(old.differs(&rebuilt), None);
        assert!(old.is_of_another_build(&rebuilt) && !old.is_of_another_build(&old));
        // A library is an input, and so is a law of that name in place of the shipped one.
        for other in [library("a"), library("b")] {
            let mine = of(&[("contact law `coulomb`", other)]);
            let says = old.differs(&mine).unwrap();
            assert!(says.contains("(program of SHA-256 a... in"), "{says}");
        }
        let mine = |sum| of(&[("wear law `mine`", library(sum))]);
        assert!(mine("a").differs(&mine("b")).is_some());
    }
}
