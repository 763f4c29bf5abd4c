//! Certification of a law in a child process, so that a law that crashes, ends the program or hangs
//! only fails a line of its certificate.

use super::{
    Certificate, CertifyProgress, CheckResult, certify, certify_with_progress, plugin_interface,
};
use crate::laws::child::{self, End};
use crate::laws::{BuiltInLaws, Kind, LawError, LoadedLaw, Plugin, SearchPath};
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::path::PathBuf;

/// Hidden subcommand that certifies a law.
pub const CERTIFY_IN_CHILD: &str = "__certify";

/// Name of the check that a crash fails.
const RETURNS: &str = "comes back";

/// A law with parameters, as passed between processes.
#[derive(Serialize, Deserialize)]
struct LawRequest {
    /// Library and SHA-256; `None` if it is built in.
    library: Option<(PathBuf, String)>,
    kind: String,
    name: String,
    /// Parameter values as bit patterns, so that they are not rounded.
    parameters: Vec<u64>,
}

impl LawRequest {
    fn of(plugin: &Plugin, parameters: &[f64]) -> Self {
        Self {
            library: (!plugin.built_in).then(|| (plugin.path.clone(), plugin.sha256.clone())),
            kind: plugin.kind.to_string(),
            name: plugin.name.clone(),
            parameters: parameters.iter().map(|x| x.to_bits()).collect(),
        }
    }

    fn open(self, built_in: &BuiltInLaws) -> Result<LoadedLaw, LawError> {
        let plugin = match &self.library {
            Some((path, sha256)) => Plugin::open_pinned(path, Some(sha256))?,
            None => {
                let kind = Kind::from_word(&self.kind);
                let found = kind.and_then(|k| built_in.open(k, &self.name));
                found.unwrap_or_else(|| {
                    Err(LawError::Unusable {
                        path: PathBuf::from(&self.name),
                        reason: "it is not built in".to_owned(),
                    })
                })?
            }
        };
        let parameters = self.parameters.into_iter().map(f64::from_bits);
        Ok(LoadedLaw::new(plugin, parameters.collect()))
    }
}

/// Certifies a law as [`certify`] does, in a child process where the program can start one. A crash
/// of that process becomes a line of the certificate.
///
/// # Errors
/// The law cannot be prepared with its partners, or the process cannot be started.
pub fn certify_in_child(
    plugin: &Plugin,
    parameters: &[f64],
    cohesion: Option<&LoadedLaw>,
    path: &SearchPath,
) -> Result<Certificate, LawError> {
    if !child::enabled() {
        return certify(plugin, parameters, cohesion, path);
    }
    plugin.validate(parameters)?;
    let refuse = |reason: String| LawError::Unusable {
        path: plugin.path.clone(),
        reason,
    };
    let request = LawRequest::of(plugin, parameters);
    let partner = cohesion.map(|c| LawRequest::of(&c.plugin, &c.parameters));
    let requests = serde_json::to_value((request, partner)).map_err(|e| refuse(e.to_string()))?;
    let output = child::run_request(CERTIFY_IN_CHILD, &requests).map_err(refuse)?;
    let (mut lines, mut begun) = (Vec::new(), String::new());
    for mut message in output.messages {
        if let Some(reason) = message["refused"].as_str() {
            return Err(refuse(reason.to_owned()));
        }
        if let Some(name) = message["begins"].as_str() {
            name.clone_into(&mut begun);
        }
        let line = message.get_mut("line").map(serde_json::Value::take);
        if let Some(Ok(result)) = line.map(serde_json::from_value::<CheckResult>) {
            lines.push(result);
        }
    }
    if output.end == End::Done && lines.is_empty() {
        return Err(refuse(
            "the process that certifies it gave no result".to_owned(),
        ));
    }
    let untested = |reason: String| LawError::Untested {
        kind: plugin.kind,
        name: plugin.name.clone(),
        reason,
    };
    if let End::NoMemory(why) = output.end {
        return Err(untested(why));
    }
    if let End::Early(why) = output.end {
        // No check had begun, so that the law did not end the process.
        if begun.is_empty() {
            return Err(untested(why));
        }
        let text = format!("{why}, while `{begun}` was tested; nothing after it was");
        lines.push(CheckResult::failed(RETURNS, f64::INFINITY, text));
    }
    Ok(Certificate::of(plugin, lines))
}

/// Certifies the requested law in the child process; it may be linked into the program.
///
/// # Errors
/// The request cannot be read.
pub fn certify_requested(built_in: &BuiltInLaws) -> Result<(), String> {
    let requests = child::read_request()?;
    let (request, partner): (LawRequest, Option<LawRequest>) =
        serde_json::from_value(requests).map_err(|e| e.to_string())?;
    let mut report = |event: CertifyProgress<'_>| match event {
        CertifyProgress::Begins(name) => child::send_message(&json!({ "begins": name })),
        CertifyProgress::Ends(result) => child::send_message(&json!({ "line": result })),
    };
    let certified = request.open(built_in).and_then(|law| {
        let partner = partner.map(|p| p.open(built_in)).transpose()?;
        let path = SearchPath::new(&[]).with_built_in(built_in.clone());
        certify_with_progress(
            &law.plugin,
            &law.parameters,
            partner.as_ref(),
            &path,
            &plugin_interface::CHECKS,
            &mut report,
        )
    });
    if let Err(e) = certified {
        child::send_message(&json!({ "refused": e.to_string() }));
    }
    child::send_done();
    Ok(())
}
