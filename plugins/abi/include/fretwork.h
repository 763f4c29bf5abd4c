/* fretwork.h - the C interface between Fretwork and its law plugins, version 1.2.
 *
 * A plugin is a shared library named libfretwork_KIND_NAME.so (KIND one of contact, cohesion,
 * damage, wear, transport; NAME with '-' written '_') which exports one function,
 * fretwork_plugin(), returning a static table. The rules:
 *  - the host owns all memory; nothing is allocated on one side and freed on the other; what the
 *    table points to must live as long as the program;
 *  - calls are batches over n contacts, columns of n doubles; a column that a call does not use is
 *    null;
 *  - calls are pure: no globals, any thread, any order, same input same bits;
 *  - a call returns FW_OK, or another status with a message in message->text and, if one contact
 *    caused it, its index in message->contact. Any status but FW_OK ends the run (exit code 1) with
 *    the message; so does an output that is not finite. FW_BAD_PARAMETER from validate refuses the
 *    case (2).
 *
 * When calls are made, for every interface law of a scene:
 *  - once, when the case is read: validate;
 *  - when a contact of a law with internal variables is first detected: initialise, if there is one
 *    (state and state_next then have the schema's initial values);
 *  - at the start of every step, after detection of gaps and normals: prepare of the contact law,
 *    then of the cohesion law; with implicit coupling again after every solve of the step;
 *  - after the step is solved: energy, then prepare of the cohesion at the new openings with D = 0,
 *    which gives energy_intact, intact_* and intact_moment_*; commit of the cohesion; commit of the
 *    damage law; commit of the contact law if it has internal variables; commit of the wear law;
 *    commit of the transport law, whose conductances the heat of this step flows through. With
 *    implicit coupling energy, prepare and the two commits are also called for trials, whose
 *    results the host discards: a law must not depend on this.
 * A cohesion law with FW_FLAG_OPENING is called for intact bonds; without it, for every contact.
 *
 * Compatibility: a host and a plugin of one major version work together for any minor versions.
 * Within a major version every struct begins with its size and grows at its end only, no field
 * changes its meaning, and fw_field is frozen. Each side reads only the fields covered by the
 * other's size: a plugin checks batch->size before it uses a column that 1.0 did not have; a host
 * treats functions missing at the end of the table as null. A change that breaks this increments
 * the major version, which the loader then refuses.
 *
 * SI units everywhere. A test of the crate fretwork-abi compares this file with the Rust structs.
 */
#ifndef FRETWORK_H
#define FRETWORK_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define FW_ABI_MAJOR 1u
#define FW_ABI_MINOR 2u

/* Kind of plugin: friction, restitution, rolling (fills the non-smooth part of the local form). */
#define FW_KIND_CONTACT 1
/* Kind of plugin: traction against opening. */
#define FW_KIND_COHESION 2
/* Kind of plugin: growth of the damage D, and break of a bond. */
#define FW_KIND_DAMAGE 3
/* Kind of plugin: removed volume from slip, force and energy. */
#define FW_KIND_WEAR 4
/* Kind of plugin: thermal and electrical conductance of a contact. Since 1.1. */
#define FW_KIND_TRANSPORT 5
/* Status: success. */
#define FW_OK 0
/* Status: the call failed, the message gives the reason; the run stops with exit code 1. */
#define FW_ERROR 1
/* Status of validate: a parameter is out of the range that the law accepts; exit code 2. */
#define FW_BAD_PARAMETER 2
/* Status: the law could not follow so large a step; the message proposes a smaller one. */
#define FW_REDUCE_STEP 3
/* Status: the plugin panicked; set by the Rust wrapper. */
#define FW_PANIC 4
/* Flag: the law is written for two-dimensional scenes only. */
#define FW_FLAG_2D_ONLY (UINT64_C(1) << 0)
/* Flag: the law is written for three-dimensional scenes only. */
#define FW_FLAG_3D_ONLY (UINT64_C(1) << 1)
/* Flag (cohesion): the normal stiffness acts in tension only; the contact carries compression.
 * Below zero opening the law continues linearly (a negative traction), from which the host finds
 * the zero; the host drops the compression. Such a bond fills the gap at which it formed. One
 * without the flag also acts in compression until the gap closes. */
#define FW_FLAG_TENSION_ONLY (UINT64_C(1) << 2)
/* Flag (cohesion): the law has an opening and a stored energy, so it can be combined with a damage
 * law. */
#define FW_FLAG_OPENING (UINT64_C(1) << 3)
/* Flag (contact): prepare depends on the parameters only, so the host may call it once for one
 * contact and use the result for all. */
#define FW_FLAG_CONSTANT (UINT64_C(1) << 4)
/* Flag (cohesion): the law resists bending and torsion, so the host stores the rotation of its
 * bonds. */
#define FW_FLAG_MOMENT (UINT64_C(1) << 5)
/* Flag (cohesion): commit writes out_damage, so the law breaks without a damage law. */
#define FW_FLAG_BREAKS (UINT64_C(1) << 6)
/* Flag (cohesion): bonds may form in contact during a run, again after they broke. */
#define FW_FLAG_FORMS (UINT64_C(1) << 7)
/* Flag (contact): the contact is a unilateral spring; prepare fills the out_contact_* columns.
 * Since 1.1. */
#define FW_FLAG_COMPLIANT (UINT64_C(1) << 8)
/* Flag: the law reads temperatures, so the case must compute heat; the columns are then not null.
 * Transport laws have them without the flag. Since 1.1. */
#define FW_FLAG_TEMPERATURE (UINT64_C(1) << 9)
/* Flag: the law reads a table, which the case names: `table` of the batch. Since 1.2. */
#define FW_FLAG_TABLE (UINT64_C(1) << 10)

/* Flag of a variable: it is written to the results. */
#define FW_FIELD_OUTPUT (UINT64_C(1) << 0)
/* Flag of a parameter: it is a friction coefficient, on which the results of a case depend. */
#define FW_FIELD_FRICTION (UINT64_C(1) << 1)

/* Describes one parameter or one internal variable. Frozen within a major version. */
typedef struct fw_field {
    const char *name; /* Name, NUL-terminated, [a-z][a-z0-9_]*. */
    const char *unit; /* SI unit, NUL-terminated, empty for a pure number. */
    const char *doc; /* One line for the user, NUL-terminated. */
    double default_value; /* Default value of a parameter, initial value of a variable. */
    double minimum; /* Smallest accepted value (may be minus infinity). */
    double maximum; /* Largest accepted value (may be infinity). */
    uint64_t flags; /* FW_FIELD_... */
} fw_field;

/* The host's buffer for an error message. */
typedef struct fw_message {
    size_t size; /* Size of this struct in bytes, set by the host. */
    char *text; /* Where the plugin writes NUL-terminated UTF-8. */
    size_t capacity; /* Bytes at text, the NUL included. */
    int64_t contact; /* Index in the batch of the contact that caused the error, or -1; set by the plugin. */
} fw_message;

/* One batch of contacts that share an interface law. Columns have n values and belong to the host.
 * 
 * A column that a call does not use is null. Inputs are read-only; out_* and state_next columns
 * are written by the call. Vectors are in the local frame (n, t1, t2), n from the antagonist to the
 * candidate; in two dimensions the t2 columns are null. */
typedef struct fw_batch {
    size_t size; /* Size of this struct in bytes, set by the host. */
    size_t n; /* Number of contacts. */
    uint32_t dimension; /* 2 or 3. */
    uint32_t reserved; /* Zero. */
    double time; /* Time at the start of the step (s). */
    double h; /* Time step (s). */
    double theta; /* Theta of the scheme. */
    double degradation; /* Exponent m of the cohesion law's degradation, psi = (1 - D)^m psi_0 (damage calls). */
    const double *parameters; /* Parameters in the order of the plugin's schema. */
    const double *const *state; /* Internal variables at the start of the step, one column each. */
    double *const *state_next; /* Internal variables at the end of the step, one column each (initialise, commit). */
    const double *gap; /* Gap at detection (m), positive when open. */
    const double *area; /* Contact area (m^2; in 2D length times unit depth). */
    const double *radius; /* Reduced radius r1 r2/(r1 + r2) (m); the radius itself against a flat body. */
    const double *age; /* Time since the contact formed (s). */
    const double *opening_n; /* Bond elongation (m): at the start of the step in prepare, at its end in commit. */
    const double *opening_t1; /* Tangential opening along t1 (m). */
    const double *opening_t2; /* Tangential opening along t2 (m). */
    const double *velocity_n; /* Relative velocity (m/s): u^- in prepare, u_th in commit. */
    const double *velocity_t1; /* Tangential relative velocity along t1 (m/s). */
    const double *velocity_t2; /* Tangential relative velocity along t2 (m/s). */
    const double *impulse_n; /* Impulse (N s): the last step's in prepare, this step's in commit. */
    const double *impulse_t1; /* Tangential impulse along t1 (N s). */
    const double *impulse_t2; /* Tangential impulse along t2 (N s). */
    const double *damage; /* Damage D in [0, 1]; 1 for a contact without bond. */
    const double *energy_intact; /* Stored energy of the undamaged bond at this opening, psi_0 (J/m^2) (damage). */
    const double *intact_n; /* Traction of the undamaged bond at this opening (Pa) (damage). */
    const double *intact_t1; /* Tangential traction of the undamaged bond along t1 (Pa) (damage). */
    const double *intact_t2; /* Tangential traction of the undamaged bond along t2 (Pa) (damage). */
    const double *slip; /* Slip distance over this step, h |u_t| (m) (wear). */
    const double *friction_work; /* Energy dissipated by friction over this step (J) (wear). */
    const double *pressed; /* Time for which the contact has carried a compressive impulse without interruption (s). */
    const double *rotation_n; /* Rotation of the bond about n, twist (rad); null without FW_FLAG_MOMENT and in 2D. */
    const double *rotation_t1; /* Rotation about t1, bending (rad). In 2D that about the axis out of the plane. */
    const double *rotation_t2; /* Rotation about t2, bending (rad). In 2D null. */
    const double *intact_moment_n; /* Moment of the undamaged bond over its area, as the rotations (N m/m^2) (damage). */
    const double *intact_moment_t1; /* Bending moment about t1 over the area (N m/m^2) (damage). */
    const double *intact_moment_t2; /* Bending moment about t2 over the area (N m/m^2) (damage). */
    double *out_friction; /* Contact: friction coefficient mu. */
    double *out_restitution_n; /* Contact: normal restitution e_n. */
    double *out_restitution_t; /* Contact: tangential restitution e_t. */
    double *out_tension_strength; /* Contact, cohesion: tension strength c_n over the area (Pa). */
    double *out_shear_cohesion; /* Contact, cohesion: shear cohesion c_t over the area (Pa). */
    double *out_rolling; /* Contact: rolling friction length (m). */
    double *out_spinning; /* Contact: spinning friction length (m). */
    double *out_traction_n; /* Cohesion: traction at the current opening and damage, positive if attractive (Pa). */
    double *out_traction_t1; /* Cohesion: tangential traction along t1 (Pa). */
    double *out_traction_t2; /* Cohesion: tangential traction along t2 (Pa). */
    double *out_stiffness_n; /* Cohesion: normal stiffness, tangent or secant, not negative (Pa/m). */
    double *out_stiffness_t; /* Cohesion: tangential stiffness (Pa/m). */
    double *out_damping_n; /* Cohesion: normal damping (Pa s/m). */
    double *out_damping_t; /* Cohesion: tangential damping (Pa s/m). */
    double *out_energy; /* Cohesion, call energy: energy stored at this opening and damage (J/m^2). Contact: energy that the tangential spring holds (J), where it is not out_contact_force_t^2/2 over the stiffness on unloading; 0 otherwise. */
    double *out_damage; /* Damage, and cohesion with FW_FLAG_BREAKS: D at the end of the step. */
    double *out_volume; /* Wear: volume removed over this step (m^3). */
    double *out_moment_n; /* Cohesion with FW_FLAG_MOMENT: twisting moment over the area, against rotation_n (N m/m^2). */
    double *out_moment_t1; /* Bending moment over the area, against rotation_t1 (N m/m^2). */
    double *out_moment_t2; /* Bending moment over the area, against rotation_t2 (N m/m^2). */
    double *out_stiffness_twist; /* Twisting stiffness over the area (N m/m^2 per rad). */
    double *out_stiffness_bend; /* Bending stiffness over the area (N m/m^2 per rad). */
    /* Since version 1.1; null for a contact law without FW_FLAG_COMPLIANT. */
    const double *overlap; /* Overlap (m), not negative: in prepare an estimate of that at the end of the step, at which the law gives force and stiffness; in commit that at the end of the step. */
    const double *effective_mass; /* Effective mass of the contact along its normal (kg; kg/m in 2D); 0 if neither body can move. */
    const double *spring_t1; /* Force of the tangential spring along t1 (N; N/m in 2D), positive where the candidate was displaced along t1: at the start of the step in prepare, at its end in commit. */
    const double *spring_t2; /* Force of the tangential spring along t2 (N). */
    const double *spring_before_t1; /* Commit: force of the tangential spring along t1 at the start of the step (N). */
    const double *spring_before_t2; /* Commit: force of the tangential spring along t2 at the start of the step (N). */
    double *out_contact_force_n; /* Contact: compressive force of the spring at overlap (N; N/m in 2D), not negative. */
    double *out_contact_force_t1; /* Contact: force of the tangential spring along t1 at the start of the step (N): spring_t1, unless the law changes it. */
    double *out_contact_force_t2; /* Contact: force of the tangential spring along t2 (N). */
    double *out_contact_stiffness_n; /* Contact: slope of the normal force at overlap (N/m). */
    double *out_contact_stiffness_t; /* Contact: slope of the tangential force (N/m); 0 for a rigid tangential contact. */
    double *out_contact_unloading_t; /* Contact: stiffness of the tangential spring when it unloads (N/m), beyond which displacement is slip; 0 where it is out_contact_stiffness_t. */
    double *out_contact_damping_n; /* Contact: normal damping (N s/m). */
    double *out_contact_damping_t; /* Contact: tangential damping (N s/m). */
    /* Since version 1.1; null where the case computes no heat. */
    const double *temperature; /* Temperature of the contact (K) at the start of the step: that at which two half-spaces of the bodies' temperatures meet, (e1 T1 + e2 T2)/(e1 + e2) with the effusivities e, plus the flash temperature where the case asks for it. */
    const double *temperature_candidate; /* Temperature of the candidate there (K). */
    const double *temperature_antagonist; /* Temperature of the antagonist there (K). */
    const double *conductivity; /* Thermal conductivity of the pair, 2 k1 k2/(k1 + k2) (W/(m K)). */
    const double *resistivity; /* Electrical resistivity of the pair, (rho1 + rho2)/2 (ohm m); null where no current flows. */
    double *out_conductance; /* Transport: thermal conductance (W/K; W/(m K) in 2D), not negative. */
    double *out_electric_conductance; /* Transport: electrical conductance (S; S/m in 2D), not negative. */
    /* Since version 1.2. */
    const double *table; /* Numbers of the law's table; null without one: the numbers of points on the axes slip (m), slip velocity (m/s), pressure (Pa) and temperature (K), 1 where it does not depend on one; the points of each axis, ascending; then the values at all points, the last axis running fastest, their lower ends, and their upper ends. Valid as long as the program runs. */
    size_t table_length; /* Number of numbers in `table`. */
} fw_batch;

/* Checks parameters in addition to their ranges (relations between them). May be null. */
typedef int32_t (*fw_validate)(const double *parameters, fw_message *message);
/* A call over a batch. May be null if the kind does not need it. */
typedef int32_t (*fw_call)(const fw_batch *batch, fw_message *message);

/* The fracture energy (J/m^2) that a bond under this law dissipates under slow monotonic loading at
 * a fixed angle from the normal (rad; 0 is mode I, pi/2 mode II); NaN if it declares none. */
typedef double (*fw_fracture)(const double *parameters, double angle);

/* The table of a plugin: returned by its entry function, static for the life of the program. */
typedef struct fw_plugin {
    size_t size; /* Size of this struct in bytes when the plugin was built. */
    uint32_t abi_major; /* Major version the plugin was built for. */
    uint32_t abi_minor; /* Minor version the plugin was built for. */
    int32_t kind; /* One of the KIND_*. */
    uint32_t reserved; /* Zero. */
    uint64_t flags; /* Union of FLAG_*. */
    const char *name; /* Name of the law in cases, NUL-terminated. */
    const char *version; /* The law's own version, NUL-terminated. */
    const char *doc; /* One line for the user, NUL-terminated. */
    const char *reference; /* Paper or DOI, NUL-terminated. */
    size_t n_parameters; /* Number of parameters. */
    const fw_field *parameters; /* Their schema. */
    size_t n_variables; /* Number of internal variables. */
    const fw_field *variables; /* Their schema. */
    double degradation; /* Cohesion: m of psi = (1 - D)^m psi_0, 0 if damage does not enter. */
    fw_validate validate; /* Checks the parameters. May be null. */
    fw_call initialise; /* Fills state_next of new contacts. Null: the schema's initial values. */
    fw_call prepare; /* Contact and cohesion: fills the local form at the start of the step. */
    fw_call solve_local; /* Solves a contact itself. Null in version 1.0; reserved for laws that do not fit the local form. */
    fw_call commit; /* At the end of the step: new internal variables; damage: out_damage; wear: out_volume; transport: out_conductance, out_electric_conductance. */
    fw_call energy; /* Cohesion: out_energy at the given opening and damage. */
    fw_fracture fracture_energy; /* Cohesion and damage: the fracture energy that the law declares, checked by certify. May be null. */
} fw_plugin;

/* The one exported symbol. */
#if defined(_WIN32)
__declspec(dllexport)
#elif defined(__GNUC__)
__attribute__((visibility("default")))
#endif
const fw_plugin *fretwork_plugin(void);

#ifdef __cplusplus
}
#endif
#endif /* FRETWORK_H */
