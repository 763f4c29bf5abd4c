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

/// Schema of the values of a field. Lists and maps have the schema of their entries.
#[derive(Clone, Copy, Debug)]
pub enum Schema {
    /// Values of a unit.
    Values(Unit),
    /// Results with fields.
    Part(&'static [Field]),
    /// Values that are not reported.
    Hidden,
}

/// A result with described fields, see [`described!`](crate::described).
pub trait Described: Serialize + Clone + Send + Sync + 'static {
    /// Fields, in their order in `summary.json`.
    const FIELDS: &'static [Field];
}

/// Returns the schema of a field that is itself a described result, or a list of such results.
pub const fn part<T: Described>() -> Schema {
    Schema::Part(T::FIELDS)
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
