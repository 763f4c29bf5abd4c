//! Certification: tests of the declared properties of a law on the one-contact bench.
//!
//! A law is combined with plain partners (frictionless contact, a linear bond) and driven along
//! paths around its characteristic opening. Each property gives a line: pass, fail or not
//! applicable, with the number that decided.

mod bond;
mod child;
mod plugin_interface;
mod rig;
mod spring;
mod static_memory;
mod surface;
mod transport;

pub use child::{CERTIFY_IN_CHILD, certify_in_child, certify_requested};

use crate::laws::kind::CheckSet;
use crate::laws::{LawError, LoadedLaw, Plugin, SearchPath};
use rig::Rig;
use serde::{Deserialize, Deserializer, Serialize};

/// Whether a law has the property that a check tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CheckOutcome {
    /// The law has the property.
    Pass,
    /// The law lacks the property.
    Fail,
    /// The check does not apply to this law.
    Skip,
}

/// Result of one check, a line of the certificate.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CheckResult {
    /// Name of the check.
    pub check: String,
    /// Whether the law has the property.
    pub outcome: CheckOutcome,
    /// The number that decided, described by the text. Infinity is written as null.
    #[serde(deserialize_with = "null_is_infinite")]
    pub number: f64,
    /// Description of the measured quantity.
    pub text: String,
}

impl CheckResult {
    fn judged(check: &str, kept: bool, number: f64, text: impl Into<String>) -> Self {
        let outcome = if kept {
            CheckOutcome::Pass
        } else {
            CheckOutcome::Fail
        };
        Self {
            check: check.to_owned(),
            outcome,
            number,
            text: text.into(),
        }
    }

    /// Passes when the number is at most `limit`.
    fn below(check: &str, number: f64, limit: f64, text: impl Into<String>) -> Self {
        let text = format!("{}; at most {limit:e}", text.into());
        Self::judged(check, number <= limit, number, text)
    }

    fn skip(check: &str, why: impl Into<String>) -> Self {
        Self {
            check: check.to_owned(),
            outcome: CheckOutcome::Skip,
            number: 0.0,
            text: why.into(),
        }
    }

    fn passed(check: &str, number: f64, text: impl Into<String>) -> Self {
        Self::judged(check, true, number, text)
    }

    fn failed(check: &str, number: f64, text: impl Into<String>) -> Self {
        Self::judged(check, false, number, text)
    }

    fn error(check: &str, e: &LawError) -> Self {
        Self::failed(check, f64::INFINITY, e.to_string())
    }
}

fn null_is_infinite<'a, D: Deserializer<'a>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(from)?.unwrap_or(f64::INFINITY))
}

/// Progress of a certification.
enum CertifyProgress<'a> {
    /// A check begins.
    Begins(&'a str),
    /// A check gave this result.
    Ends(&'a CheckResult),
}

/// A certificate while it is written: the results so far.
struct CertificateWriter<'a> {
    results: Vec<CheckResult>,
    /// Partner of the law under test, added to the text of each result.
    partner: String,
    report: &'a mut dyn FnMut(CertifyProgress<'_>),
}

/// A check; errors of the law are turned into a failed result by the caller.
type Check = fn(&mut Rig) -> Result<CheckResult, LawError>;

impl CertificateWriter<'_> {
    /// Runs checks, each regardless of the result of the previous one.
    fn run(&mut self, rig: &mut Rig, checks: &[(&str, Check)]) {
        for (name, check) in checks {
            (self.report)(CertifyProgress::Begins(name));
            let result = check(rig).unwrap_or_else(|e| CheckResult::error(name, &e));
            self.write(result);
        }
    }

    fn write(&mut self, result: CheckResult) {
        let text = format!("{}{}", result.text, self.partner);
        let result = CheckResult { text, ..result };
        (self.report)(CertifyProgress::Ends(&result));
        self.results.push(result);
    }
}

/// Certificate of a law.
#[derive(Clone, Debug, Serialize)]
pub struct Certificate {
    /// Kind of the law.
    pub kind: String,
    /// Name of the law.
    pub name: String,
    /// Version of its plugin.
    pub version: String,
    /// SHA-256 of the library.
    pub sha256: String,
    /// Path of the library.
    pub library: String,
    /// Results of the checks.
    pub lines: Vec<CheckResult>,
}

impl Certificate {
    /// Returns whether no check failed.
    pub fn certified(&self) -> bool {
        self.lines.iter().all(|l| l.outcome != CheckOutcome::Fail)
    }
}

/// Tests a law with these parameters. Partner laws are taken from the search path, with their
/// default parameters. A damage law is tested with `cohesion` if given, since its properties depend
/// on the bond's stiffness.
///
/// # Errors
/// A partner is missing, or the law rejects the parameters. Errors of the law itself become lines
/// of the certificate.
pub fn certify(
    plugin: &Plugin,
    parameters: &[f64],
    cohesion: Option<&LoadedLaw>,
    path: &SearchPath,
) -> Result<Certificate, LawError> {
    certify_with_progress(
        plugin,
        parameters,
        cohesion,
        path,
        &plugin_interface::CHECKS,
        &mut |_| {},
    )
}

/// Tests a law like [`certify`], but without the checks that do not depend on parameters: for laws
/// whose code is known, such as the shipped ones.
///
/// # Errors
/// The law cannot be prepared with its partners.
pub fn certify_parameters(
    plugin: &Plugin,
    parameters: &[f64],
    cohesion: Option<&LoadedLaw>,
    path: &SearchPath,
) -> Result<Certificate, LawError> {
    let checks = &plugin_interface::OF_PARAMETERS;
    certify_with_progress(plugin, parameters, cohesion, path, checks, &mut |_| {})
}

fn certify_with_progress(
    plugin: &Plugin,
    parameters: &[f64],
    cohesion: Option<&LoadedLaw>,
    path: &SearchPath,
    interface_checks: &[(&str, Check)],
    report: &mut dyn FnMut(CertifyProgress<'_>),
) -> Result<Certificate, LawError> {
    const RUNS: &str = "runs on the bench";
    plugin.validate(parameters)?;
    let mut writer = CertificateWriter {
        results: Vec::new(),
        partner: String::new(),
        report,
    };
    let rigs = Rig::all(plugin, parameters, cohesion, path)?;
    for (k, mut rig) in rigs.into_iter().enumerate() {
        if k == 0 && interface_checks.len() == plugin_interface::CHECKS.len() {
            writer.run(&mut rig, &[plugin_interface::FIRST]);
            if writer
                .results
                .iter()
                .any(|l| l.outcome == CheckOutcome::Fail)
            {
                break;
            }
        }
        writer.partner = rig.partner().to_owned();
        (writer.report)(CertifyProgress::Begins(RUNS));
        match (rig.find_scale(), plugin.kind.spec().certificate.checks) {
            (Err(e), _) => writer.write(CheckResult::error(RUNS, &e)),
            (Ok(()), CheckSet::Bond) if rig.opens() => writer.run(&mut rig, &bond::CHECKS),
            (Ok(()), checks) => writer.run(&mut rig, surface::checks(checks)),
        }
        if rig.tested().has(fretwork_abi::FLAG_COMPLIANT) {
            writer.run(&mut rig, &spring::CHECKS);
        }
        if k == 0 {
            writer.partner.clear();
            writer.run(&mut rig, interface_checks);
        }
    }
    Ok(Certificate::of(plugin, writer.results))
}

impl Certificate {
    fn of(plugin: &Plugin, lines: Vec<CheckResult>) -> Self {
        Self {
            kind: plugin.kind.to_string(),
            name: plugin.name.clone(),
            version: plugin.version.clone(),
            sha256: plugin.sha256.clone(),
            library: plugin.path.display().to_string(),
            lines,
        }
    }
}
