//! The C header and the Rust crate agree: sizes and offsets of every field, every constant.
//! A C program prints them as compiled by the system's compiler.
use fretwork_abi::*;
use std::{mem::offset_of, mem::size_of, process::Command};

macro_rules! layout {
    ($out:ident, $rust:ident, $c:literal, $($field:ident),*) => {
        $out.push((format!("sizeof({})", $c), size_of::<$rust>() as u64));
        $( $out.push((
            format!("offsetof({}, {})", $c, match stringify!($field) { "default" => "default_value", f => f }),
            offset_of!($rust, $field) as u64,
        )); )*
    };
}

fn rust_layout() -> Vec<(String, u64)> {
    let mut out = Vec::new();
    layout!(
        out, FwField, "fw_field", name, unit, doc, default, minimum, maximum, flags
    );
    layout!(out, FwMessage, "fw_message", size, text, capacity, contact);
    layout!(
        out,
        FwBatch,
        "fw_batch",
        size,
        n,
        dimension,
        reserved,
        time,
        h,
        theta,
        degradation,
        parameters,
        state,
        state_next,
        gap,
        area,
        radius,
        age,
        opening_n,
        opening_t1,
        opening_t2,
        velocity_n,
        velocity_t1,
        velocity_t2,
        impulse_n,
        impulse_t1,
        impulse_t2,
        damage,
        energy_intact,
        intact_n,
        intact_t1,
        intact_t2,
        slip,
        friction_work,
        pressed,
        rotation_n,
        rotation_t1,
        rotation_t2,
        intact_moment_n,
        intact_moment_t1,
        intact_moment_t2,
        out_friction,
        out_restitution_n,
        out_restitution_t,
        out_tension_strength,
        out_shear_cohesion,
        out_rolling,
        out_spinning,
        out_traction_n,
        out_traction_t1,
        out_traction_t2,
        out_stiffness_n,
        out_stiffness_t,
        out_damping_n,
        out_damping_t,
        out_energy,
        out_damage,
        out_volume,
        out_moment_n,
        out_moment_t1,
        out_moment_t2,
        out_stiffness_twist,
        out_stiffness_bend,
        overlap,
        effective_mass,
        spring_t1,
        spring_t2,
        spring_before_t1,
        spring_before_t2,
        out_contact_force_n,
        out_contact_force_t1,
        out_contact_force_t2,
        out_contact_stiffness_n,
        out_contact_stiffness_t,
        out_contact_unloading_t,
        out_contact_damping_n,
        out_contact_damping_t,
        temperature,
        temperature_candidate,
        temperature_antagonist,
        conductivity,
        resistivity,
        out_conductance,
        out_electric_conductance,
        table,
        table_length
    );
    layout!(
        out,
        FwPlugin,
        "fw_plugin",
        size,
        abi_major,
        abi_minor,
        kind,
        reserved,
        flags,
        name,
        version,
        doc,
        reference,
        n_parameters,
        parameters,
        n_variables,
        variables,
        degradation,
        validate,
        initialise,
        prepare,
        solve_local,
        commit,
        energy,
        fracture_energy
    );
    for (name, value) in [
        ("FW_ABI_MAJOR", ABI_MAJOR as u64),
        ("FW_ABI_MINOR", ABI_MINOR as u64),
        ("FW_KIND_CONTACT", KIND_CONTACT as u64),
        ("FW_KIND_COHESION", KIND_COHESION as u64),
        ("FW_KIND_DAMAGE", KIND_DAMAGE as u64),
        ("FW_KIND_WEAR", KIND_WEAR as u64),
        ("FW_KIND_TRANSPORT", KIND_TRANSPORT as u64),
        ("FW_OK", STATUS_OK as u64),
        ("FW_ERROR", STATUS_ERROR as u64),
        ("FW_BAD_PARAMETER", STATUS_BAD_PARAMETER as u64),
        ("FW_REDUCE_STEP", STATUS_REDUCE_STEP as u64),
        ("FW_PANIC", STATUS_PANIC as u64),
        ("FW_FIELD_OUTPUT", FIELD_OUTPUT),
        ("FW_FIELD_FRICTION", FIELD_FRICTION),
        ("FW_FLAG_2D_ONLY", FLAG_2D_ONLY),
        ("FW_FLAG_3D_ONLY", FLAG_3D_ONLY),
        ("FW_FLAG_TENSION_ONLY", FLAG_TENSION_ONLY),
        ("FW_FLAG_OPENING", FLAG_OPENING),
        ("FW_FLAG_CONSTANT", FLAG_CONSTANT),
        ("FW_FLAG_MOMENT", FLAG_MOMENT),
        ("FW_FLAG_BREAKS", FLAG_BREAKS),
        ("FW_FLAG_FORMS", FLAG_FORMS),
        ("FW_FLAG_COMPLIANT", FLAG_COMPLIANT),
        ("FW_FLAG_TEMPERATURE", FLAG_TEMPERATURE),
        ("FW_FLAG_TABLE", FLAG_TABLE),
    ] {
        out.push((name.to_owned(), value));
    }
    out
}

#[test]
fn header_matches_crate() {
    let expected = rust_layout();
    let dir = std::env::temp_dir().join(format!("fretwork-abi-{}", std::process::id()));
    std::fs::create_dir_all(&dir).unwrap();
    let mut program =
        String::from("#include <stdio.h>\n#include \"fretwork.h\"\nint main(void) {\n");
    for (expression, _) in &expected {
        program += &format!("printf(\"%llu\\n\", (unsigned long long)({expression}));\n");
    }
    program += "return 0; }\n";
    let (source, binary) = (dir.join("layout.c"), dir.join("layout"));
    std::fs::write(&source, program).unwrap();
    let include = concat!(env!("CARGO_MANIFEST_DIR"), "/include");
    let compiled = Command::new("cc")
        .args([
            "-std=c99", "-Wall", "-Wextra", "-Werror", "-I", include, "-o",
        ])
        .arg(&binary)
        .arg(&source)
        .status()
        .expect("a C compiler named cc");
    assert!(compiled.success());
    let printed = String::from_utf8(Command::new(&binary).output().unwrap().stdout).unwrap();
    let seen: Vec<u64> = printed.lines().map(|l| l.parse().unwrap()).collect();
    assert_eq!(seen.len(), expected.len());
    for ((expression, rust), c) in expected.iter().zip(seen) {
        assert_eq!(*rust, c, "{expression}");
    }
    std::fs::remove_dir_all(&dir).ok();
}
