//! What a run is of: the same case, materials, laws and files give the same bits, others do not.

use fretwork_core::geometry::space::Space;
use fretwork_observe::code::{CodeError, encode};
use fretwork_scene::source::{Source, first_difference};
use fretwork_scene::{Built, Loaded};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt::Write;

/// What a resumed run may have otherwise: it changes no number.
const FREE: [&str; 2] = ["output.checkpoint", "output.figures"];
/// What may be later when a run goes on.
const END: &str = "time.end";

/// What a run is of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Identity {
    /// 2 or 3.
    dimension: u32,
    /// The case as text, `--set` applied.
    case: String,
    /// When it ends (s).
    end: f64,
    /// Material files: name and text.
    materials: Vec<(String, String)>,
    /// Libraries of laws: kind with name, and SHA-256.
    plugins: Vec<(String, String)>,
    /// SHA-256 of the scene as it was built: what files that the case names (profiles, meshes, samples) made of it.
    scene: String,
}

impl Identity {
    /// Of a case and the scene that it builds, before its first step.
    ///
    /// # Errors
    /// The scene cannot be put into bytes.
    pub fn of<S: Space>(loaded: &Loaded, built: &Built<S>) -> Result<Self, CodeError> {
        let s = &built.simulation;
        let mut plugins: Vec<(String, String)> = Vec::new();
        for law in s.laws.iter().flat_map(|l| l.loaded()) {
            let p = &law.plugin;
            let stamp = (format!("{} law `{}`", p.kind, p.name), p.sha256.clone());
            if !plugins.contains(&stamp) {
                plugins.push(stamp);
            }
        }
        let mut hash = Hashed(Sha256::new());
        hash.0.update(encode(&s.save())?);
        // Never fails: nothing is written anywhere.
        let _ = write!(hash, "{:?}", s.shapes);
        Ok(Self {
            dimension: loaded.case.dimension,
            case: loaded.source.text().to_owned(),
            end: loaded.case.time.end,
            materials: built.materials.clone(),
            plugins,
            scene: hex(&hash.0.finalize()),
        })
    }

    /// A name for one that was put into bytes: their SHA-256.
    pub fn name(bytes: &[u8]) -> String {
        hex(&Sha256::digest(bytes))
    }

    /// Whether the same run ends later now.
    pub fn ends_later(&self, now: &Self) -> bool {
        now.end > self.end
    }

    /// What differs in another one, in words; none where nothing that counts does, and it ends no earlier.
    pub fn differs(&self, now: &Self) -> Option<String> {
        if self.case != now.case {
            let [a, b] = [&self.case, &now.case].map(|t| Source::from_text("case", t.clone()));
            let mut free = FREE.to_vec();
            if self.ends_later(now) {
                free.push(END);
            }
            if let Some(d) = first_difference(&a, &b, &free) {
                let said = |text: Option<String>| text.unwrap_or("nothing".to_owned());
                return Some(format!(
                    "`{}` was {} there and is {} now",
                    d.path,
                    said(d.one),
                    said(d.other)
                ));
            }
        }
        let find = |list: &[(String, String)], name: &str| -> Option<String> {
            list.iter().find(|l| l.0 == name).map(|l| l.1.clone())
        };
        for (name, text) in &now.materials {
            match find(&self.materials, name) {
                None => return Some(format!("it does not use the material `{name}`")),
                Some(old) if old != *text => {
                    return Some(format!("the material file `{name}` has changed since"));
                }
                Some(_) => {}
            }
        }
        for (name, sha) in &now.plugins {
            match find(&self.plugins, name) {
                None => return Some(format!("it does not use the {name}")),
                Some(old) if old != *sha => {
                    let [old, new] = [&old, sha].map(|s| s.get(..12).unwrap_or(s).to_owned());
                    return Some(format!(
                        "the library of the {name} is another one (SHA-256 {old}... there, {new}... now)"
                    ));
                }
                Some(_) => {}
            }
        }
        if (self.materials.len(), self.plugins.len()) != (now.materials.len(), now.plugins.len()) {
            return Some("it uses other materials or laws".to_owned());
        }
        (self.scene != now.scene || self.dimension != now.dimension).then(|| {
            "the case builds another scene: a file that it names (profile, mesh, sample, scene) has changed since"
                .to_owned()
        })
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut s, b| {
        let _ = write!(s, "{b:02x}");
        s
    })
}

/// Hashes text as it is written.
struct Hashed(Sha256);

impl Write for Hashed {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}
