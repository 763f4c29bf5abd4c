//! Results of a run in numbers and words. Observers add quantities to [`Findings`], each with its
//! path in `summary.json`, unit, explanation, role and half-widths; all code that shows results, on
//! the terminal, in files and in tables, uses that list and its [`Catalogue`], and names no
//! quantity.

mod catalogue;
mod described;
mod difference;
mod estimate;
mod findings;
mod format;
mod nested;
mod path;

pub use catalogue::{Catalogue, Entry};
pub use described::{Described, Field, Schema, field, part, parts, values};
pub use difference::{Compared, Difference, Significance};
pub use estimate::{DETERMINED, Estimate, short_cause};
pub use findings::{Expected, Findings};
pub use format::{below_digits, half_width, number, percent, quantity, with_half_width};
pub use fretwork_core::unit::{self, Unit};
pub use path::{find, renamed};

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// How prominent a quantity is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// A main result, which studies compare unless other results are requested.
    Headline,
    /// A result that is shown in the terminal text and in the report.
    Secondary,
    /// A further result, in `summary.json` only.
    #[default]
    Detail,
    /// Course and cost of the run: not a result of the case.
    Diagnostic,
}

/// Topic of a quantity: results are grouped by topic, in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Topic {
    /// Friction.
    Friction,
    /// Regimes of slip and flow, in words.
    Regime,
    /// Bonds and their damage.
    Damage,
    /// Wear and the flows of matter.
    Wear,
    /// Energies.
    Energy,
    /// Tests and measures of the case.
    #[default]
    Measures,
    /// Settings, solver and course of the run.
    Run,
}

impl Topic {
    /// Heading.
    pub fn title(self) -> &'static str {
        match self {
            Self::Friction => "Friction",
            Self::Regime => "Regime",
            Self::Damage => "Damage",
            Self::Wear => "Wear",
            Self::Energy => "Energy",
            Self::Measures => "Measures",
            Self::Run => "Run",
        }
    }
}

/// Reason why quantities that describe the course of a run are not compared.
pub const DESCRIBES_THE_RUN: &str = "it describes the course of the run, not a result of the case";

/// Form of a quantity on the terminal.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Wording {
    /// Value with half-widths, and a remark, which may be empty.
    Value(String),
    /// A separate sentence, with its label.
    Sentence(String, String),
    /// The quantity is not shown, since the sentence of another quantity contains it.
    #[default]
    Silent,
}

/// A result of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Path in `summary.json`: keys, and indices in lists.
    pub path: Vec<PathStep>,
    /// Number, text, flag or null; an empty list or object where there is nothing to list.
    pub value: Value,
    /// Unit of the quantity.
    pub unit: Unit,
    /// One line of explanation.
    pub doc: String,
    /// Prominence.
    pub role: Role,
    /// Topic.
    pub topic: Topic,
    /// Short name for tables; empty for the last key of its path.
    pub label: String,
    /// Half-widths of its 95 % interval by cause.
    pub estimate: Option<Estimate>,
    /// Form on the terminal.
    pub wording: Wording,
    /// Reason why runs of this case have no value for it; `None` where they have one.
    pub lacks: Option<&'static str>,
}

/// One step of a path.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PathStep {
    /// Key of an object.
    Key(String),
    /// Index in a list.
    Place(usize),
}

impl Quantity {
    /// Returns the path as one text, `wear.bodies.0.volume`.
    pub fn name(&self) -> String {
        self.spelled(|k| k.to_string())
    }

    /// Returns the path with `*` for indices in lists.
    pub fn pattern(&self) -> String {
        self.spelled(|_| "*".to_owned())
    }

    fn spelled(&self, place: impl Fn(usize) -> String) -> String {
        let steps = self.path.iter().map(|step| match step {
            PathStep::Key(key) => key.clone(),
            PathStep::Place(k) => place(*k),
        });
        steps.collect::<Vec<_>>().join(".")
    }

    /// Returns the short name.
    pub fn label(&self) -> String {
        match (self.label.as_str(), self.path.last()) {
            ("", Some(PathStep::Key(key))) => key.replace('_', " "),
            ("", _) => self.name(),
            (label, _) => label.to_owned(),
        }
    }

    /// Makes it a main result.
    pub fn headline(&mut self, label: impl Into<String>) -> &mut Self {
        self.as_role(Role::Headline, label)
    }

    /// Makes it a result that the terminal and the report show.
    pub fn secondary(&mut self, label: impl Into<String>) -> &mut Self {
        self.as_role(Role::Secondary, label)
    }

    fn as_role(&mut self, role: Role, label: impl Into<String>) -> &mut Self {
        (self.role, self.label) = (role, label.into());
        if self.wording == Wording::Silent {
            self.wording = Wording::Value(String::new());
        }
        self
    }

    /// Adds a remark after its value on the terminal.
    pub fn remark(&mut self, remark: impl Into<String>) -> &mut Self {
        self.wording = Wording::Value(remark.into());
        self
    }

    /// Shows a sentence instead of the value on the terminal.
    pub fn sentence(&mut self, label: impl Into<String>, text: impl Into<String>) -> &mut Self {
        self.wording = Wording::Sentence(label.into(), text.into());
        self
    }

    /// Omits it on the terminal, since another sentence contains it.
    pub fn silent(&mut self) -> &mut Self {
        self.wording = Wording::Silent;
        self
    }

    /// Sets the topic.
    pub fn about(&mut self, topic: Topic) -> &mut Self {
        self.topic = topic;
        self
    }

    /// Sets the reason why runs of this case have no value for it.
    pub fn lacks(&mut self, why: &'static str) -> &mut Self {
        self.lacks = Some(why);
        self
    }
}
