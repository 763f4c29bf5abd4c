//! Fields of contacts.

use super::Field;
use crate::contact::{BondState, Contact, ContactNames};
use crate::geometry::space::{Space, VectorLike};
use crate::step::Simulation;
use crate::unit::{ENERGY, FORCE};

/// Force of the last step on the candidate (N; N/m in 2D).
fn force<S: Space>(s: &Simulation<S>, contact: &Contact<S>) -> S::Vector {
    contact.impulse * (1.0 / s.options.scheme.h)
}

/// 0 contact, 1 intact bond, 2 broken bond.
fn state<S: Space>(s: &Simulation<S>, contact: &Contact<S>) -> f64 {
    match s.state.network.bond_state(contact) {
        BondState::None => 0.0,
        BondState::Intact { .. } => 1.0,
        BondState::Broken => 2.0,
    }
}

fn status<S: Space>(s: &Simulation<S>, contact: &Contact<S>) -> f64 {
    let state = state(s, contact);
    if state == 1.0 {
        3.0
    } else if contact.impulse == S::Vector::zero() {
        2.0 * state
    } else {
        1.0 + f64::from(u8::from(contact.slides))
    }
}

/// Fields that all simulations have.
pub(super) fn standard<S: Space>() -> Vec<Field<S, Contact<S>>> {
    let [newton, joule] = [FORCE, ENERGY].map(|unit| unit.symbol(S::D));
    let mut fields = vec![
        Field::number(
            "state",
            "",
            "0 contact, 1 intact bond, 2 broken bond",
            state::<S>,
        ),
        Field::number(
            "status",
            "",
            "0 carries nothing, 1 sticks, 2 slides (friction is at its bound), 3 an intact bond holds, 4 carries nothing and its bond broke",
            status::<S>,
        ),
        Field::number(
            "damage",
            "",
            "damage D; 1 where there is no bond",
            |s: &Simulation<S>, c: &Contact<S>| match s.state.network.bond_state(c) {
                BondState::Intact { damage } => damage,
                _ => 1.0,
            },
        ),
        Field::number("gap", "m", "gap", |_, c: &Contact<S>| c.gap),
    ];
    fields.extend(forces(newton));
    fields.extend(frame());
    fields.extend(vectors(newton));
    let bond = |name, doc, get: fn(&crate::contact::Bond<S>) -> f64| {
        Field::number(name, "m", doc, move |s: &Simulation<S>, c: &Contact<S>| {
            s.state.network.bond(c).map_or(0.0, get)
        })
    };
    fields.extend([
        Field::number(
            "friction_work",
            joule,
            "energy that friction took at this contact since it formed",
            |_, c: &Contact<S>| c.friction_work,
        ),
        bond("opening_normal", "elongation of the bond", |b| b.opening_n),
        bond(
            "opening_tangential",
            "norm of its tangential opening",
            |b| b.opening_t.norm(),
        ),
        Field::number("law", "", "index of the interface", |_, c: &Contact<S>| {
            f64::from(c.law)
        }),
    ]);
    let body = |name, doc, side: usize| {
        Field::whole(name, doc, move |s: &Simulation<S>, c: &Contact<S>| {
            s.state.bodies.id[c.bodies[side] as usize] as i64
        })
    };
    fields.extend([
        body(
            "body_1",
            "identity of the candidate, as `id` of grains and `body` of bodies",
            0,
        ),
        body("body_2", "identity of the antagonist", 1),
    ]);
    fields
}

/// The force on the candidate in the local frame.
fn forces<S: Space>(newton: &'static str) -> Vec<Field<S, Contact<S>>> {
    let along = |name, doc, k: usize| {
        Field::number(
            name,
            newton,
            doc,
            move |s: &Simulation<S>, c: &Contact<S>| S::tangents(&c.normal)[k].dot(&force(s, c)),
        )
    };
    let mut fields = vec![
        Field::number(
            "force_normal",
            newton,
            "normal force, positive in compression",
            |s: &Simulation<S>, c: &Contact<S>| c.normal.dot(&force(s, c)),
        ),
        Field::number(
            "force_tangential",
            newton,
            "norm of the tangential force",
            |s: &Simulation<S>, c: &Contact<S>| S::tangential(&c.normal, &force(s, c)).norm(),
        ),
        along(
            "force_tangential_1",
            "tangential force on body_1 along the tangent t1; in 2D t1 is the normal turned by +90 degrees",
            0,
        ),
    ];
    if S::D == 3 {
        fields.push(along(
            "force_tangential_2",
            "tangential force on body_1 along t2 = normal x t1",
            1,
        ));
    }
    fields
}

/// Returns the components of vectors as vectors in world axes too, since viewers draw arrows of
/// vectors.
fn vectors<S: Space>(newton: &'static str) -> [Field<S, Contact<S>>; 2] {
    [
        Field::vector("force", newton, "force on body_1", |s, c| force(s, c)),
        Field::vector(
            "normal",
            "",
            "unit normal, from body_2 to body_1",
            |_, c: &Contact<S>| c.normal,
        ),
    ]
}

/// Returns normal and tangent.
fn frame<S: Space>() -> Vec<Field<S, Contact<S>>> {
    let normal = |name, axis: usize| {
        Field::number(
            name,
            "",
            "unit normal, from body_2 to body_1; a positive normal force pushes body_1 along it",
            move |_: &Simulation<S>, c: &Contact<S>| c.normal.padded()[axis],
        )
    };
    let tangent = |name, axis: usize| {
        Field::number(
            name,
            "",
            "unit tangent t1",
            move |_: &Simulation<S>, c: &Contact<S>| S::tangents(&c.normal)[0].padded()[axis],
        )
    };
    let mut fields = vec![normal("normal_x", 0), normal("normal_y", 1)];
    if S::D == 3 {
        fields.push(normal("normal_z", 2));
        let tangents = ["tangent_1_x", "tangent_1_y", "tangent_1_z"].into_iter();
        fields.extend(tangents.enumerate().map(|(k, name)| tangent(name, k)));
    }
    fields
}

/// Returns the parts of a [`ContactId`](crate::contact::ContactId) that `body_1` and `body_2` do
/// not give: kind and number of the contactor of each of these bodies, in the same order, and the
/// feature, for programs that match contacts of several files. They refer to the present shapes and
/// bodies.
pub fn id_fields<S: Space>(s: &Simulation<S>) -> Vec<Field<S, Contact<S>>> {
    let names = std::sync::Arc::new(ContactNames::of(&s.shapes, &s.state.bodies));
    let side = |name, doc, side: usize, number: bool| {
        let names = names.clone();
        Field::whole(name, doc, move |_: &Simulation<S>, c: &Contact<S>| {
            names.sides(&c.key).map_or(-1, |sides| match number {
                true => i64::from(sides[side].number),
                false => sides[side].kind as i64,
            })
        })
    };
    let features = names.clone();
    vec![
        side(
            "contactor_1",
            "number of the contactor of body_1 among those of its kind of the body",
            0,
            true,
        ),
        side(
            "contactor_2",
            "number of the contactor of body_2 among those of its kind of the body",
            1,
            true,
        ),
        side(
            "contactor_kind_1",
            "kind of the contactor of body_1: 0 ball, 1 convex piece, 2 surface",
            0,
            false,
        ),
        side(
            "contactor_kind_2",
            "kind of the contactor of body_2: 0 ball, 1 convex piece, 2 surface",
            1,
            false,
        ),
        Field::whole(
            "feature",
            "feature that is touched, as in the contact's name: seen with the contactor of lower kind, then lower body, first",
            move |_: &Simulation<S>, c: &Contact<S>| {
                features.id::<S>(&c.key).map_or(-1, |id| id.feature as i64)
            },
        ),
    ]
}
