//! What a run is stamped with: its laws, and the density of its first bodies.

use crate::certify::certify;
use crate::laws::{Interface, Kind, SearchPath};
use crate::record::summary::PluginStamp;
use crate::scene::build::Loaded;

/// The laws of a run, each once, and whether they keep their promises with its parameters: a damage law with the
/// cohesion that it stands beside, the others with plain shipped partners.
pub(super) fn stamps(laws: &[Interface]) -> Vec<PluginStamp> {
    let path = SearchPath::new(&[]);
    type Seen<'a> = (&'a str, &'a [f64], Option<(&'a str, &'a [f64])>);
    let mut seen: Vec<Seen<'_>> = Vec::new();
    let mut stamps: Vec<PluginStamp> = Vec::new();
    for interface in laws {
        for law in interface.loaded() {
            let p = &law.plugin;
            let partner = interface
                .cohesion
                .as_ref()
                .filter(|_| p.kind == Kind::Damage);
            let key: Seen<'_> = (
                &p.sha256,
                &law.parameters,
                partner.map(|l| (l.plugin.sha256.as_str(), l.parameters.as_slice())),
            );
            if seen.contains(&key) {
                continue;
            }
            seen.push(key);
            let certified =
                certify(p, &law.parameters, partner, &path).is_ok_and(|c| c.certified());
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
