//! The C binary interface between Fretwork and its law plugins, version 1.
//!
//! The C header `include/fretwork.h` declares the same items for C and Fortran authors; a test
//! compares both, offset by offset. Rust authors use the safe wrapper crate `fretwork-law` instead.
//!
//! Rules of the interface:
//! * the host owns all memory; nothing is allocated on one side and freed on the other;
//! * every struct begins with its size and only grows at the end, so that a newer minor version
//!   loads in an older host of the same major version and vice versa;
//! * calls are batches over `n` contacts, state is stored in columns (struct of arrays);
//! * calls are pure: no globals, any thread, any order, same input same bits;
//! * a call returns a status code and, when it fails, a message in the host's buffer.
#![no_std]

use core::ffi::c_char;

/// Major version: a host refuses a plugin of another major.
pub const ABI_MAJOR: u32 = 1;
/// Minor version: incremented when structs grow at their end.
pub const ABI_MINOR: u32 = 2;
/// Name of the one exported function, of type [`FwEntry`].
pub const ENTRY_SYMBOL: &str = "fretwork_plugin";

/// Kind of plugin: friction, restitution, rolling (fills the non-smooth part of the local form).
pub const KIND_CONTACT: i32 = 1;
/// Kind of plugin: traction against opening.
pub const KIND_COHESION: i32 = 2;
/// Kind of plugin: growth of the damage D, and break of a bond.
pub const KIND_DAMAGE: i32 = 3;
/// Kind of plugin: removed volume from slip, force and energy.
pub const KIND_WEAR: i32 = 4;
/// Kind of plugin: thermal and electrical conductance of a contact. Since version 1.1.
pub const KIND_TRANSPORT: i32 = 5;

/// Status: success.
pub const STATUS_OK: i32 = 0;
/// Status: the call failed, the message gives the reason; the run stops with exit code 1.
pub const STATUS_ERROR: i32 = 1;
/// Status of `validate`: a parameter is out of the range that the law accepts; the run stops with
/// exit code 2.
pub const STATUS_BAD_PARAMETER: i32 = 2;
/// Status: the law cannot follow a step of this size; the message proposes a smaller one.
pub const STATUS_REDUCE_STEP: i32 = 3;
/// Status: the plugin panicked; set by the Rust wrapper.
pub const STATUS_PANIC: i32 = 4;

/// Flag: the law is written for two-dimensional scenes only.
pub const FLAG_2D_ONLY: u64 = 1;
/// Flag: the law is written for three-dimensional scenes only.
pub const FLAG_3D_ONLY: u64 = 1 << 1;
/// Flag (cohesion): the normal stiffness acts in tension only; the contact carries compression.
/// Below zero opening the law continues linearly (a negative traction), from which the host finds
/// the zero; the host drops the compression. Such a bond fills the gap at which it formed. A bond
/// without this flag also acts in compression until the gap closes.
pub const FLAG_TENSION_ONLY: u64 = 1 << 2;
/// Flag (cohesion): the law has an opening and a stored energy, so it can be combined with a damage
/// law.
pub const FLAG_OPENING: u64 = 1 << 3;
/// Flag (cohesion): the law resists bending and torsion, so the host stores the rotation of its
/// bonds.
pub const FLAG_MOMENT: u64 = 1 << 5;
/// Flag (cohesion): `commit` writes `out_damage`, so the law breaks without a damage law.
pub const FLAG_BREAKS: u64 = 1 << 6;
/// Flag (cohesion): bonds may form in contact during a run, also after they broke.
pub const FLAG_FORMS: u64 = 1 << 7;
/// Flag (contact): `prepare` depends on the parameters only, so the host may call it once for one
/// contact and use the result for all.
pub const FLAG_CONSTANT: u64 = 1 << 4;
/// Flag (contact): the contact is a unilateral spring; `prepare` fills the `out_contact_*` columns.
/// Since version 1.1.
pub const FLAG_COMPLIANT: u64 = 1 << 8;
/// Flag: the law reads temperatures, so the case must compute heat; the columns of temperature are
/// then not null. Transport laws receive them without this flag. Since version 1.1.
pub const FLAG_TEMPERATURE: u64 = 1 << 9;

/// Flag: the law reads a table, which the case names; see [`FwBatch::table`]. Since version 1.2.
pub const FLAG_TABLE: u64 = 1 << 10;

/// All flags of this version.
pub const FLAGS: u64 = FLAG_2D_ONLY
    | FLAG_3D_ONLY
    | FLAG_TENSION_ONLY
    | FLAG_OPENING
    | FLAG_CONSTANT
    | FLAG_MOMENT
    | FLAG_BREAKS
    | FLAG_FORMS
    | FLAG_COMPLIANT
    | FLAG_TEMPERATURE
    | FLAG_TABLE;

/// Flag of a variable: it is written to the results.
pub const FIELD_OUTPUT: u64 = 1;
/// Flag of a parameter: it is a friction coefficient, on which the results of a case depend.
pub const FIELD_FRICTION: u64 = 1 << 1;

/// Describes one parameter or one internal variable. Frozen within a major version.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FwField {
    /// Name, NUL-terminated, `[a-z][a-z0-9_]*`.
    pub name: *const c_char,
    /// SI unit, NUL-terminated, empty for a pure number.
    pub unit: *const c_char,
    /// One line for the user, NUL-terminated.
    pub doc: *const c_char,
    /// Default value of a parameter, initial value of a variable.
    pub default: f64,
    /// Smallest accepted value (may be minus infinity).
    pub minimum: f64,
    /// Largest accepted value (may be infinity).
    pub maximum: f64,
    /// [`FIELD_OUTPUT`] of a variable, [`FIELD_FRICTION`] of a parameter; otherwise 0.
    pub flags: u64,
}

/// The host's buffer for an error message.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FwMessage {
    /// Size of this struct in bytes, set by the host.
    pub size: usize,
    /// Buffer to which the plugin writes NUL-terminated UTF-8.
    pub text: *mut c_char,
    /// Size of the buffer `text` in bytes, including the NUL.
    pub capacity: usize,
    /// Index in the batch of the contact that caused the error, or -1; set by the plugin.
    pub contact: i64,
}

/// One batch of contacts that share an interface law. Columns have `n` values and belong to the
/// host.
///
/// A column that a call does not use is null. Inputs are read-only; `out_*` and `state_next`
/// columns are written by the call. Vectors are in the local frame (n, t1, t2), n from the
/// antagonist to the candidate; in two dimensions the `t2` columns are null.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FwBatch {
    /// Size of this struct in bytes, set by the host.
    pub size: usize,
    /// Number of contacts.
    pub n: usize,
    /// 2 or 3.
    pub dimension: u32,
    /// Reserved; zero.
    pub reserved: u32,
    /// Time at the start of the step (s).
    pub time: f64,
    /// Time step (s).
    pub h: f64,
    /// Theta of the scheme.
    pub theta: f64,
    /// Exponent m of the cohesion law's degradation, psi = (1 - D)^m psi_0 (damage calls).
    pub degradation: f64,
    /// Parameters in the order of the plugin's schema.
    pub parameters: *const f64,
    /// Internal variables at the start of the step, one column each.
    pub state: *const *const f64,
    /// Internal variables at the end of the step, one column each (initialise, commit).
    pub state_next: *const *mut f64,
    /// Gap at detection (m), positive when open.
    pub gap: *const f64,
    /// Contact area (m^2; in 2D length times unit depth).
    pub area: *const f64,
    /// Reduced radius r1 r2/(r1 + r2) (m); the radius itself against a flat body.
    pub radius: *const f64,
    /// Time since the contact formed (s).
    pub age: *const f64,
    /// Bond elongation (m): at the start of the step in `prepare`, at its end in `commit`.
    pub opening_n: *const f64,
    /// Tangential opening along t1 (m).
    pub opening_t1: *const f64,
    /// Tangential opening along t2 (m).
    pub opening_t2: *const f64,
    /// Relative velocity (m/s): u^- in `prepare`, u_th in `commit`.
    pub velocity_n: *const f64,
    /// Tangential relative velocity along t1 (m/s).
    pub velocity_t1: *const f64,
    /// Tangential relative velocity along t2 (m/s).
    pub velocity_t2: *const f64,
    /// Impulse (N s): the last step's in `prepare`, this step's in `commit`.
    pub impulse_n: *const f64,
    /// Tangential impulse along t1 (N s).
    pub impulse_t1: *const f64,
    /// Tangential impulse along t2 (N s).
    pub impulse_t2: *const f64,
    /// Damage D in \[0, 1\]; 1 for a contact without bond.
    pub damage: *const f64,
    /// Stored energy of the undamaged bond at this opening, psi_0 (J/m^2) (damage).
    pub energy_intact: *const f64,
    /// Traction of the undamaged bond at this opening (Pa) (damage).
    pub intact_n: *const f64,
    /// Tangential traction of the undamaged bond along t1 (Pa) (damage).
    pub intact_t1: *const f64,
    /// Tangential traction of the undamaged bond along t2 (Pa) (damage).
    pub intact_t2: *const f64,
    /// Slip distance over this step, h |u_t| (m) (wear).
    pub slip: *const f64,
    /// Energy dissipated by friction over this step (J) (wear).
    pub friction_work: *const f64,
    /// Time for which the contact has carried a compressive impulse without interruption (s).
    pub pressed: *const f64,
    /// Twist of the bond, its rotation about n (rad). Null in two dimensions and without
    /// [`FLAG_MOMENT`].
    pub rotation_n: *const f64,
    /// Bending of the bond, its rotation about t1 (rad). In two dimensions the rotation about the
    /// axis out of the plane.
    pub rotation_t1: *const f64,
    /// Bending of the bond, its rotation about t2 (rad). Null in two dimensions.
    pub rotation_t2: *const f64,
    /// Twisting moment of the undamaged bond over its area, about n (N m/m^2) (damage).
    pub intact_moment_n: *const f64,
    /// Bending moment about t1 over the area (N m/m^2) (damage).
    pub intact_moment_t1: *const f64,
    /// Bending moment about t2 over the area (N m/m^2) (damage).
    pub intact_moment_t2: *const f64,
    /// Contact: friction coefficient mu.
    pub out_friction: *mut f64,
    /// Contact: normal restitution e_n.
    pub out_restitution_n: *mut f64,
    /// Contact: tangential restitution e_t.
    pub out_restitution_t: *mut f64,
    /// Contact, cohesion: tension strength c_n over the area (Pa).
    pub out_tension_strength: *mut f64,
    /// Contact, cohesion: shear cohesion c_t over the area (Pa).
    pub out_shear_cohesion: *mut f64,
    /// Contact: rolling friction length (m).
    pub out_rolling: *mut f64,
    /// Contact: spinning friction length (m).
    pub out_spinning: *mut f64,
    /// Cohesion: traction at the current opening and damage, positive if attractive (Pa).
    pub out_traction_n: *mut f64,
    /// Cohesion: tangential traction along t1 (Pa).
    pub out_traction_t1: *mut f64,
    /// Cohesion: tangential traction along t2 (Pa).
    pub out_traction_t2: *mut f64,
    /// Cohesion: normal stiffness, tangent or secant, not negative (Pa/m).
    pub out_stiffness_n: *mut f64,
    /// Cohesion: tangential stiffness (Pa/m).
    pub out_stiffness_t: *mut f64,
    /// Cohesion: normal damping (Pa s/m).
    pub out_damping_n: *mut f64,
    /// Cohesion: tangential damping (Pa s/m).
    pub out_damping_t: *mut f64,
    /// Cohesion, call `energy`: energy stored at this opening and damage (J/m^2). Contact: energy
    /// stored in the tangential spring (J), if it differs from T^2/2 over the stiffness on
    /// unloading; 0 otherwise.
    pub out_energy: *mut f64,
    /// Damage, and cohesion with [`FLAG_BREAKS`]: D at the end of the step.
    pub out_damage: *mut f64,
    /// Wear: volume removed over this step (m^3).
    pub out_volume: *mut f64,
    /// Cohesion with [`FLAG_MOMENT`]: twisting moment over the area, against `rotation_n` (N
    /// m/m^2).
    pub out_moment_n: *mut f64,
    /// Cohesion with [`FLAG_MOMENT`]: bending moment over the area, against `rotation_t1` (N
    /// m/m^2).
    pub out_moment_t1: *mut f64,
    /// Cohesion with [`FLAG_MOMENT`]: bending moment over the area, against `rotation_t2` (N
    /// m/m^2).
    pub out_moment_t2: *mut f64,
    /// Cohesion with [`FLAG_MOMENT`]: twisting stiffness over the area (N m/m^2 per rad).
    pub out_stiffness_twist: *mut f64,
    /// Cohesion with [`FLAG_MOMENT`]: bending stiffness over the area (N m/m^2 per rad).
    pub out_stiffness_bend: *mut f64,
    // The fields below exist since version 1.1; they are null for a contact law without
    // [`FLAG_COMPLIANT`].
    /// Overlap of the bodies (m), not negative. In `prepare` it is an estimate of the overlap at
    /// the end of the step, at which the law gives force and stiffness; in `commit` the overlap at
    /// the end of the step.
    pub overlap: *const f64,
    /// Effective mass of the contact along its normal, 1/W_nn (kg; kg/m in 2D); 0 if neither body
    /// can move.
    pub effective_mass: *const f64,
    /// Force of the tangential spring along t1 (N; N/m in 2D), positive where the candidate was
    /// displaced along t1: at the start of the step in `prepare`, at its end in `commit`.
    pub spring_t1: *const f64,
    /// Force of the tangential spring along t2 (N).
    pub spring_t2: *const f64,
    /// Commit: force of the tangential spring along t1 at the start of the step (N).
    pub spring_before_t1: *const f64,
    /// Commit: force of the tangential spring along t2 at the start of the step (N).
    pub spring_before_t2: *const f64,
    /// Contact: compressive force of the spring at `overlap` (N; N/m in 2D), not negative.
    pub out_contact_force_n: *mut f64,
    /// Contact: force of the tangential spring along t1 at the start of the step (N): `spring_t1`,
    /// unless the law changes it.
    pub out_contact_force_t1: *mut f64,
    /// Contact: force of the tangential spring along t2 (N).
    pub out_contact_force_t2: *mut f64,
    /// Contact: slope of the normal force at `overlap` (N/m).
    pub out_contact_stiffness_n: *mut f64,
    /// Contact: slope of the tangential force (N/m); 0 for a rigid tangential contact.
    pub out_contact_stiffness_t: *mut f64,
    /// Contact: stiffness of the tangential spring when it unloads (N/m), which defines its stored
    /// energy; 0 if it equals `out_contact_stiffness_t`.
    pub out_contact_unloading_t: *mut f64,
    /// Contact: normal damping (N s/m).
    pub out_contact_damping_n: *mut f64,
    /// Contact: tangential damping (N s/m).
    pub out_contact_damping_t: *mut f64,
    // The fields below exist since version 1.1; they are null if the case computes no heat.
    /// Temperature of the contact (K) at the start of the step: the temperature at which two
    /// half-spaces of the bodies' temperatures meet, (e1 T1 + e2 T2)/(e1 + e2) with the
    /// effusivities e, plus the flash temperature if the case requests it.
    pub temperature: *const f64,
    /// Temperature of the candidate at the contact (K).
    pub temperature_candidate: *const f64,
    /// Temperature of the antagonist at the contact (K).
    pub temperature_antagonist: *const f64,
    /// Thermal conductivity of the pair, 2 k1 k2/(k1 + k2) (W/(m K)).
    pub conductivity: *const f64,
    /// Electrical resistivity of the pair, (rho1 + rho2)/2 (ohm m); null without current.
    pub resistivity: *const f64,
    /// Transport: thermal conductance (W/K; W/(m K) in 2D), not negative.
    pub out_conductance: *mut f64,
    /// Transport: electrical conductance (S; S/m in 2D), not negative.
    pub out_electric_conductance: *mut f64,
    // The fields below exist since version 1.2.
    /// Numbers of the table of the law; null without one. They are the numbers of points on the
    /// axes slip (m), slip velocity (m/s), pressure (Pa) and temperature (K), 1 where the table
    /// does not depend on one; the points of each axis, ascending; then the values at all points,
    /// the last axis running fastest, their lower ends, and their upper ends. They are valid as
    /// long as the program runs.
    pub table: *const f64,
    /// Number of numbers in `table`.
    pub table_length: usize,
}

/// Checks parameters in addition to their ranges (relations between them). May be null.
pub type FwValidate =
    Option<unsafe extern "C" fn(parameters: *const f64, message: *mut FwMessage) -> i32>;
/// A call over a batch. May be null if the kind does not need it.
pub type FwCall =
    Option<unsafe extern "C" fn(batch: *const FwBatch, message: *mut FwMessage) -> i32>;

/// The fracture energy (J/m^2) that a bond under this law dissipates under slow monotonic loading
/// at a fixed angle from the normal (rad; 0 is mode I, pi/2 mode II); NaN if the law declares none.
pub type FwFracture = Option<unsafe extern "C" fn(parameters: *const f64, angle: f64) -> f64>;

/// The table of a plugin, returned by its entry function. It is static for the life of the program.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct FwPlugin {
    /// Size of this struct in bytes when the plugin was built.
    pub size: usize,
    /// Major version the plugin was built for.
    pub abi_major: u32,
    /// Minor version the plugin was built for.
    pub abi_minor: u32,
    /// Kind of the law, one of `KIND_*`.
    pub kind: i32,
    /// Reserved; zero.
    pub reserved: u32,
    /// Union of `FLAG_*`.
    pub flags: u64,
    /// Name of the law in cases, NUL-terminated.
    pub name: *const c_char,
    /// The law's own version, NUL-terminated.
    pub version: *const c_char,
    /// One line for the user, NUL-terminated.
    pub doc: *const c_char,
    /// Paper or DOI, NUL-terminated.
    pub reference: *const c_char,
    /// Number of parameters.
    pub n_parameters: usize,
    /// Schema of the parameters.
    pub parameters: *const FwField,
    /// Number of internal variables.
    pub n_variables: usize,
    /// Schema of the internal variables.
    pub variables: *const FwField,
    /// Cohesion: exponent m of psi = (1 - D)^m psi_0; 0 if damage has no effect.
    pub degradation: f64,
    /// Checks the parameters. May be null.
    pub validate: FwValidate,
    /// Fills `state_next` of new contacts. If null, the initial values of the schema are used.
    pub initialise: FwCall,
    /// Contact and cohesion: fills the local form at the start of the step.
    pub prepare: FwCall,
    /// Solves a contact itself. Null in version 1.0; reserved for laws that do not fit the local
    /// form.
    pub solve_local: FwCall,
    /// Computes at the end of the step the new internal variables; damage: `out_damage`; wear:
    /// `out_volume`; transport: `out_conductance`, `out_electric_conductance`.
    pub commit: FwCall,
    /// Cohesion: `out_energy` at the given opening and damage.
    pub energy: FwCall,
    /// Cohesion and damage: the fracture energy that the law declares; `certify` compares. May be
    /// null.
    pub fracture_energy: FwFracture,
}

/// The entry function's type.
pub type FwEntry = unsafe extern "C" fn() -> *const FwPlugin;

/// The table of a law that is linked into a program, as a static made by the macro `plugin_table!`
/// of the crate `fretwork-law`.
#[derive(Debug)]
pub struct LinkedLaw(FwPlugin);

// SAFETY: the table is never written; its pointers refer to static text and functions.
unsafe impl Sync for LinkedLaw {}

impl LinkedLaw {
    /// Returns the law of a table.
    ///
    /// # Safety
    /// All pointers of the table must be valid as long as the program runs, and its functions must
    /// follow the interface.
    pub const unsafe fn new(table: FwPlugin) -> Self {
        Self(table)
    }

    /// Returns the table.
    pub const fn table(&self) -> &FwPlugin {
        &self.0
    }
}
