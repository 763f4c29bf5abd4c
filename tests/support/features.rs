//! Features of a scene of grains by the `--set` arguments that enable them, for measurements of
//! their cost and memory.

/// Name of a feature and its `--set` arguments.
pub type Feature = (&'static str, &'static [&'static str]);

/// Feature with which the others are compared.
pub const BASE: Feature = ("Coulomb friction (the base)", &[]);

/// Bonds without damage.
pub const BONDS: Feature = (
    "bonds (elastic-bond)",
    &["interfaces.0.cohesion=elastic-bond"],
);

/// Features measured for cost and for memory.
pub const FEATURES: [Feature; 8] = [
    (
        "no friction",
        &[
            "interfaces.0.contact=frictionless",
            "interfaces.0.parameters.contact={}",
        ],
    ),
    BASE,
    (
        "friction against rotation",
        &[
            "interfaces.0.contact=rolling-friction",
            "interfaces.0.parameters.contact={}",
        ],
    ),
    ("wear (archard)", &["interfaces.0.wear=archard"]),
    (
        "a bond law, no bonds",
        &[
            "interfaces.0.cohesion=elastic-bond",
            "interfaces.0.bonds=Never",
        ],
    ),
    BONDS,
    (
        "bonds with damage (mac)",
        &["interfaces.0.cohesion=mac", "interfaces.0.damage=mac"],
    ),
    ("position correction", &["solver.correction=0.1"]),
];
