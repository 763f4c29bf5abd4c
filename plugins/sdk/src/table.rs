//! The macros that describe parameters and export a law.

/// Builds the schema of internal variables at compile time.
pub const fn variables<const N: usize>(list: &[crate::Variable]) -> [fretwork_abi::FwField; N] {
    let blank = fretwork_abi::FwField {
        name: c"".as_ptr(),
        unit: c"".as_ptr(),
        doc: c"".as_ptr(),
        default: 0.0,
        minimum: f64::NEG_INFINITY,
        maximum: f64::INFINITY,
        flags: 0,
    };
    let mut out = [blank; N];
    let mut k = 0;
    while k < N {
        out[k].name = list[k].name.as_ptr();
        out[k].unit = list[k].unit.as_ptr();
        out[k].doc = list[k].doc.as_ptr();
        out[k].default = list[k].initial;
        out[k].flags = list[k].output as u64;
        k += 1;
    }
    out
}

/// Copies text with a terminating NUL, at compile time.
pub const fn terminated<const N: usize>(text: &str) -> [u8; N] {
    let mut out = [0; N];
    let bytes = text.as_bytes();
    let mut k = 0;
    while k < bytes.len() {
        out[k] = bytes[k];
        k += 1;
    }
    out
}

/// Declares the parameters of a law: `name: "unit" = default, minimum, maximum, "doc";`. A friction
/// coefficient, on which the results of a case depend, ends with `"doc", friction;`.
#[macro_export]
macro_rules! parameters {
    (@flag) => { 0 };
    (@flag friction) => { $crate::abi::FIELD_FRICTION };
    ($(#[$meta:meta])* pub struct $law:ident {
        $($name:ident : $unit:literal = $default:expr, $min:expr, $max:expr, $doc:literal $(, $role:ident)?;)*
    }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug)]
        pub struct $law {
            $(#[doc = $doc] pub $name: f64,)*
        }

        impl $crate::Parameters for $law {
            const FIELDS: &'static [$crate::abi::FwField] = &[
                $($crate::abi::FwField {
                    name: concat!(stringify!($name), "\0").as_ptr().cast(),
                    unit: concat!($unit, "\0").as_ptr().cast(),
                    doc: concat!($doc, "\0").as_ptr().cast(),
                    default: $default,
                    minimum: $min,
                    maximum: $max,
                    flags: $crate::parameters!(@flag $($role)?),
                },)*
            ];
            const PACKAGE_VERSION: &'static str = env!("CARGO_PKG_VERSION");
            #[allow(unused_mut, unused_variables, unused_assignments)]
            fn read(values: &[f64]) -> Self {
                let mut next = values.iter().copied();
                Self { $($name: next.next().unwrap_or($default),)* }
            }
        }

        impl Default for $law {
            fn default() -> Self {
                Self { $($name: $default,)* }
            }
        }
    };
}

/// Exports a law as the plugin of this library: `export!(contact Coulomb);`,
/// `export!(cohesion Mac);`, `export!(damage Mac);`, `export!(wear Archard);`,
/// `export!(transport Constriction);`.
#[macro_export]
macro_rules! export {
    ($kind:ident $law:ty) => {
        const _: () = {
    $crate::plugin_table!($kind $law);

            /// The plugin's entry function.
            #[unsafe(no_mangle)]
            pub extern "C" fn fretwork_plugin() -> *const $crate::abi::FwPlugin {
                TABLE.table()
            }
        };
    };
}

/// Makes the table of a law, a static named `TABLE`, without the exported entry function: for
/// programs with built-in laws.
#[macro_export]
macro_rules! plugin_table {
    (contact $law:ty) => {
        $crate::plugin_table!(@table $law, KIND_CONTACT, 0.0,
            prepare: Some($crate::ffi::contact_prepare::<$law>),
            commit: if <$law as $crate::Law>::VARIABLES.is_empty() { None } else { Some($crate::ffi::contact_commit::<$law>) },
            energy: None);
    };
    (cohesion $law:ty) => {
        $crate::plugin_table!(@table $law, KIND_COHESION, <$law as $crate::CohesionLaw>::DEGRADATION,
            prepare: Some($crate::ffi::cohesion_prepare::<$law>),
            commit: if <$law as $crate::Law>::VARIABLES.is_empty() && <$law as $crate::Law>::FLAGS & $crate::abi::FLAG_BREAKS == 0 { None } else { Some($crate::ffi::cohesion_commit::<$law>) },
            energy: Some($crate::ffi::cohesion_energy::<$law>));
    };
    (damage $law:ty) => {
        $crate::plugin_table!(@table $law, KIND_DAMAGE, 0.0,
            prepare: None, commit: Some($crate::ffi::damage_commit::<$law>), energy: None);
    };
    (wear $law:ty) => {
        $crate::plugin_table!(@table $law, KIND_WEAR, 0.0,
            prepare: None, commit: Some($crate::ffi::wear_commit::<$law>), energy: None);
    };
    (transport $law:ty) => {
        $crate::plugin_table!(@table $law, KIND_TRANSPORT, 0.0,
            prepare: None, commit: Some($crate::ffi::transport_commit::<$law>), energy: None);
    };
    (@table $law:ty, $kind:ident, $degradation:expr, prepare: $prepare:expr, commit: $commit:expr, energy: $energy:expr) => {
        use $crate::{Law as _, Parameters as _};
        const VARIABLES: usize = <$law>::VARIABLES.len();
        static SCHEMA: $crate::table::Fields<VARIABLES> =
            $crate::table::Fields($crate::table::variables(<$law>::VARIABLES));
        static NAME: [u8; <$law>::NAME.len() + 1] = $crate::table::terminated(<$law>::NAME);
        static VERSION: [u8; <$law>::VERSION.len() + 1] = $crate::table::terminated(<$law>::VERSION);
        static DOC: [u8; <$law>::DOC.len() + 1] = $crate::table::terminated(<$law>::DOC);
        static REFERENCE: [u8; <$law>::REFERENCE.len() + 1] = $crate::table::terminated(<$law>::REFERENCE);
        // SAFETY: names, schemas and functions are static, and the functions are those of the
        // wrapper.
        static TABLE: $crate::abi::LinkedLaw = unsafe { $crate::abi::LinkedLaw::new($crate::abi::FwPlugin {
            size: core::mem::size_of::<$crate::abi::FwPlugin>(),
            abi_major: $crate::abi::ABI_MAJOR,
            abi_minor: $crate::abi::ABI_MINOR,
            kind: $crate::abi::$kind,
            reserved: 0,
            flags: <$law>::FLAGS,
            name: NAME.as_ptr().cast(),
            version: VERSION.as_ptr().cast(),
            doc: DOC.as_ptr().cast(),
            reference: REFERENCE.as_ptr().cast(),
            n_parameters: <$law>::FIELDS.len(),
            parameters: <$law>::FIELDS.as_ptr(),
            n_variables: VARIABLES,
            variables: SCHEMA.0.as_ptr(),
            degradation: $degradation,
            validate: Some($crate::ffi::validate::<$law>),
            initialise: None,
            prepare: $prepare,
            solve_local: None,
            commit: $commit,
            energy: $energy,
            fracture_energy: Some($crate::ffi::fracture_energy::<$law>),
        }) };
    };
}

/// A schema that can be stored in a static.
pub struct Fields<const N: usize>(pub [fretwork_abi::FwField; N]);

// SAFETY: the schema is never written; its pointers refer to static text.
unsafe impl<const N: usize> Sync for Fields<N> {}

#[cfg(test)]
mod tests {
    use crate::Parameters;
    use fretwork_abi::FIELD_FRICTION;

    crate::parameters! {
        /// Friction of a stiff contact.
        pub struct Sliding {
            mu: "" = 0.3, 0.0, 1.0, "largest tangential over normal force", friction;
            k: "Pa/m" = 1.0, 0.0, 2.0, "stiffness";
        }
    }

    #[test]
    fn a_friction_coefficient_is_declared_as_one() {
        let flags: Vec<u64> = Sliding::FIELDS.iter().map(|field| field.flags).collect();
        assert_eq!(flags, [FIELD_FRICTION, 0]);
        let Sliding { mu, k } = Sliding::default();
        assert_eq!([mu, k], [0.3, 1.0]);
    }
}
