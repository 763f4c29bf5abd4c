//! Metadata of a run: the certification of its laws, and the density of its first bodies.

use super::certificates::Certificates;
use crate::certify::{Certificate, certify_in_child, certify_parameters};
use crate::laws::{Interface, Kind, LawError, LoadedLaw, Plugin, SearchPath};
use crate::record::summary::PluginStamp;
use std::path::PathBuf;

/// Returns the laws of a run, each listed once, and whether each passes certification with its
/// parameters. A damage law is tested with its cohesion law if that passes itself, other laws with
/// plain shipped partners, so that a failure is attributed to the law that causes it.
pub(super) fn stamps(laws: &[Interface]) -> Vec<PluginStamp> {
    let mut certifier = Certifier {
        path: partners(),
        certificates: Certificates::read(file()),
    };
    let mut stamps: Vec<PluginStamp> = Vec::new();
    for interface in laws {
        for law in interface.loaded() {
            let p = &law.plugin;
            let partner = interface
                .cohesion()
                .filter(|_| stands_beside_cohesion(p.kind))
                .filter(|cohesion| certifier.certified(cohesion, None));
            let certified = certifier.certified(law, partner);
            let same = |s: &&mut PluginStamp| {
                (&s.sha256, &s.name) == (&p.sha256, &p.name) && s.kind == p.kind.word()
            };
            match stamps.iter_mut().find(same) {
                Some(stamp) => stamp.certified &= certified,
                None => stamps.push(PluginStamp {
                    kind: p.kind.to_string(),
                    name: p.name.clone(),
                    version: p.version.clone(),
                    sha256: p.sha256.clone(),
                    path: p.path.display().to_string(),
                    links: links(p),
                    certified,
                }),
            }
        }
    }
    stamps
}

/// Returns the search path with the partners for tests of laws.
#[cfg(feature = "laws")]
fn partners() -> SearchPath {
    crate::shipped::search_path()
}

#[cfg(not(feature = "laws"))]
fn partners() -> SearchPath {
    SearchPath::new(&[])
}

/// Returns the file with the certificates of earlier runs.
#[cfg(feature = "program")]
fn file() -> Option<PathBuf> {
    let folder = crate::cache_folder::cache_folder().ok()?;
    Some(folder.join("certificates.txt"))
}

#[cfg(not(feature = "program"))]
fn file() -> Option<PathBuf> {
    None
}

/// Returns the libraries to which a law is linked, each with its SHA-256.
fn links(p: &Plugin) -> Vec<String> {
    let links = p.links.iter();
    links
        .map(|(path, sum)| format!("{} {sum}", path.display()))
        .collect()
}

/// Whether laws of a kind are certified beside a cohesion law.
fn stands_beside_cohesion(kind: Kind) -> bool {
    let sets = kind.spec().certificate.partners.iter();
    sets.flat_map(|set| set.iter())
        .any(|(partner, _)| *partner == Kind::COHESION)
}

/// Tests laws with the shipped partners.
struct Certifier {
    path: SearchPath,
    certificates: Certificates,
}

impl Certifier {
    fn certified(&mut self, law: &LoadedLaw, partner: Option<&LoadedLaw>) -> bool {
        // A foreign law may end the process in which it is tested, or corrupt its memory, so it is
        // tested in a separate process. The shipped laws are certified by the project's tests.
        let path = &self.path;
        let own = |p: &Plugin| path.belongs_to_program(p);
        let trusted = own(&law.plugin) && partner.is_none_or(|p| own(&p.plugin));
        type Test =
            fn(&Plugin, &[f64], Option<&LoadedLaw>, &SearchPath) -> Result<Certificate, LawError>;
        let test: Test = if trusted {
            certify_parameters
        } else {
            certify_in_child
        };
        let test = || {
            let made = test(&law.plugin, &law.parameters, partner, path);
            made.is_ok_and(|c| c.certified())
        };
        self.certificates.passes(law, partner, trusted, test)
    }
}
