//! What a run is stamped with: its laws, and the density of its first bodies.

use crate::certify::certify;
use crate::laws::{Interface, SearchPath};
use crate::record::summary::PluginStamp;
use crate::scene::build::Loaded;

/// The laws of a run, each once, and whether they keep their promises with its parameters.
pub(super) fn stamps(laws: &[Interface]) -> Vec<PluginStamp> {
    // The partners on the bench are shipped laws.
    let path = SearchPath::new(&[]);
    let mut seen: Vec<(&str, &[f64])> = Vec::new();
    let mut stamps: Vec<PluginStamp> = Vec::new();
    for law in laws.iter().flat_map(Interface::loaded) {
        let p = &law.plugin;
        if seen.contains(&(&p.sha256, &law.parameters)) {
            continue;
        }
        seen.push((&p.sha256, &law.parameters));
        let certified = certify(p, &law.parameters, &path).is_ok_and(|c| c.certified());
        match stamps.iter_mut().find(|s| s.sha256 == p.sha256) {
            Some(stamp) => stamp.certified &= certified,
            None => stamps.push(PluginStamp {
                kind: p.kind.to_string(),
                name: p.name.clone(),
                version: p.version.clone(),
                sha256: p.sha256.clone(),
                path: p.path.display().to_string(),
                certified,
            }),
        }
    }
    stamps
}

/// Density of the first bodies, for wear as a mass.
pub(super) fn density_of(loaded: &Loaded, any: bool) -> f64 {
    let material = loaded.case.bodies.first().map(|b| b.material.as_str());
    match (any, material) {
        (true, Some(name)) => loaded.density(name).unwrap_or(0.0),
        _ => 0.0,
    }
}
