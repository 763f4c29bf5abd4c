//! Results that describe themselves: a struct whose fields have a unit and an explanation.

use super::Unit;
use serde::Serialize;

/// A field of a result: its name in `summary.json`, its schema, and one line of explanation.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    /// Key in the JSON object.
    pub name: &'static str,
    /// Explanation.
    pub doc: &'static str,
    /// Schema of its values.
    pub schema: Schema,
}

/// Schema of the values of a field. Maps have the schema of their entries.
#[derive(Clone, Copy, Debug)]
pub enum Schema {
    /// A value of a unit.
    Values(Unit),
    /// A list of values of a unit.
    ListOfValues(Unit),
    /// A result with fields.
    Part(&'static [Field]),
    /// A list of results with fields.
    ListOfParts(&'static [Field]),
    /// Values that are not reported.
    Hidden,
}

impl Schema {
    /// Returns the schema of the entries of a list.
    pub(super) const fn of_entries(self) -> Self {
        match self {
            Self::ListOfValues(unit) => Self::Values(unit),
            Self::ListOfParts(fields) => Self::Part(fields),
            other => other,
        }
    }
}

/// A result with described fields, see [`described!`](crate::described).
pub trait Described: Serialize + Clone + Send + Sync + 'static {
    /// Fields, in their order in `summary.json`.
    const FIELDS: &'static [Field];
}

/// Returns the schema of a field that is itself a described result.
pub const fn part<T: Described>() -> Schema {
    Schema::Part(T::FIELDS)
}

/// Returns the schema of a field that is a list of described results.
pub const fn parts<T: Described>() -> Schema {
    Schema::ListOfParts(T::FIELDS)
}

/// Returns the schema of a field that is a list of values of a unit.
pub const fn values(unit: Unit) -> Schema {
    Schema::ListOfValues(unit)
}

/// A field of values.
pub const fn field(name: &'static str, unit: Unit, doc: &'static str) -> Field {
    Field {
        name,
        doc,
        schema: Schema::Values(unit),
    }
}

/// Declares a struct whose fields have a unit, `=> UNIT`, or a schema, `= part::<Other>()`; their
/// documentation is their explanation in all outputs. Fields with neither are not reported, and
/// need `#[serde(skip)]`.
#[macro_export]
macro_rules! described {
    (@schema [] [$unit:expr]) => { $crate::quantity::Schema::Values($unit) };
    (@schema [$schema:expr] []) => { $schema };
    (@schema [] []) => { $crate::quantity::Schema::Hidden };
    (
        $(#[doc = $about:literal])*
        #[derive($($derive:ident),* $(,)?)]
        $(#[$attribute:meta])?
        $see:vis struct $name:ident {
            $(
                $(#[doc = $doc:literal])*
                $(#[serde($($serde:tt)*)])?
                $open:vis $field:ident : $type:ty $(= $schema:expr)? $(=> $unit:expr)?
            ),* $(,)?
        }
    ) => {
        $(#[doc = $about])*
        #[derive($($derive),*)]
        $(#[$attribute])?
        $see struct $name {
            $(
                $(#[doc = $doc])*
                $(#[serde($($serde)*)])?
                $open $field: $type,
            )*
        }

        impl $crate::quantity::Described for $name {
            const FIELDS: &'static [$crate::quantity::Field] = &[
                $(
                    $crate::quantity::Field {
                        name: stringify!($field),
                        doc: concat!($($doc),*),
                        schema: $crate::described!(@schema [$($schema)?] [$($unit)?]),
                    },
                )*
            ];
        }
    };
}
