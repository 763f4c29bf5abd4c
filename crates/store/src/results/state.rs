//! Reads the grains of a recorded state of `results.h5`, also of a truncated file or a running run.

use super::deformed;
use super::reader::Reader;
use super::shapes::Shaped;
use fretwork_core::fields::ORIENTATION;
pub use fretwork_scene::recorded::{Grain, Motion, ShapedGrain, State, StateError};
use std::collections::HashMap;
use std::path::Path;

/// Reads the state with the index `frame`, or the last one, for a case of a dimension (2 or 3).
///
/// # Errors
/// The file is missing, not a results file, damaged, of the other dimension, without this state, or
/// without the shapes of its grains.
pub fn read(path: &Path, frame: Option<usize>, dimension: usize) -> Result<State, StateError> {
    let unreadable = |reason: String| StateError::Unreadable {
        path: path.to_owned(),
        reason,
    };
    let reader = Reader::open(path).map_err(unreadable)?;
    let has = |name: &str| reader.has(&format!("{ROOT}/{name}"));
    if !has("Points") {
        return Err(unreadable(
            "it has no `/views/grains`; name a `results.h5` of `fretwork run`".to_owned(),
        ));
    }
    let spins: &[&str] = match (dimension, has("PointData/spin_x")) {
        (2, false) => &["spin"],
        (3, true) => &["spin_x", "spin_y", "spin_z"],
        (2, true) => {
            return Err(unreadable(
                "its grains are of a case of dimension 3; take a run of a case of dimension 2"
                    .to_owned(),
            ));
        }
        _ => {
            return Err(unreadable(
                "its grains have no `spin_x`: it is of a case of dimension 2, or of an older version".to_owned(),
            ));
        }
    };
    let turns: &[&str] = if dimension == 2 {
        &["angle"]
    } else {
        &ORIENTATION
    };
    let shaped = Shaped::read(&reader).map_err(unreadable)?;
    let turned = turns.iter().all(|t| has(&format!("PointData/{t}")));
    if shaped.is_some() && !turned {
        let reason = "it has shapes of grains but no orientations: it is damaged";
        return Err(unreadable(reason.to_owned()));
    }
    let grains = Grains {
        reader,
        spins,
        turns: if turned { turns } else { &[] },
    };
    grains.read(path, frame, shaped)
}

/// Group of the view of the grains.
const ROOT: &str = "views/grains";

/// The grains of a file.
struct Grains {
    reader: Reader,
    /// Names of the columns of the angular velocity.
    spins: &'static [&'static str],
    /// Names of the columns of the orientation; empty if the file has none.
    turns: &'static [&'static str],
}

impl Grains {
    /// Checks the index of the state and reads it.
    fn read(
        &self,
        path: &Path,
        frame: Option<usize>,
        shaped: Option<Shaped>,
    ) -> Result<State, StateError> {
        let unreadable = |reason: String| StateError::Unreadable {
            path: path.to_owned(),
            reason,
        };
        // The columns of an interrupted run may differ in length by one state.
        let states = ["Steps/Values", "Steps/PointOffsets", "NumberOfPoints"]
            .map(|n| self.reader.rows(&format!("{ROOT}/{n}")))
            .into_iter()
            .try_fold(usize::MAX, |least, n| Ok(least.min(n?)))
            .map_err(unreadable)?;
        let asked = frame.unwrap_or(states.saturating_sub(1));
        if asked >= states {
            if states == 0 {
                let reason = "it holds no state; run the case with `output.views` above 0";
                return Err(unreadable(reason.to_owned()));
            }
            return Err(StateError::NoFrame {
                path: path.to_owned(),
                states: format!("0 to {}", states - 1),
                asked,
            });
        }
        self.frame(asked, shaped).map_err(unreadable)
    }

    /// Reads the state with an index that exists in the file.
    fn frame(&self, frame: usize, shaped: Option<Shaped>) -> Result<State, String> {
        let time = self
            .reader
            .numbers(&format!("{ROOT}/Steps/Values"), (frame, 1), 1)?[0];
        let whole = |name: &str| {
            let value = self.reader.whole(&format!("{ROOT}/{name}"), (frame, 1))?[0];
            usize::try_from(value).map_err(|_| format!("`{name}` holds {value}"))
        };
        let (first, count) = (whole("Steps/PointOffsets")?, whole("NumberOfPoints")?);
        let rows = (first, count);
        let points = self.reader.numbers(&format!("{ROOT}/Points"), rows, 3)?;
        let place = |name: &str| format!("{ROOT}/PointData/{name}");
        let column = |name: &str| self.reader.numbers(&place(name), rows, 1);
        // Columns that are absent from files of older versions, or from cases without such grains,
        // read as zero.
        let where_listed = |name: &str| match self.reader.has(&place(name)) {
            true => column(name),
            false => Ok(vec![0.0; count]),
        };
        let axes = |names: &[&str]| {
            names
                .iter()
                .map(|n| column(n))
                .collect::<Result<Vec<_>, _>>()
        };
        let (radius, first_body, id) = (column("radius")?, column("first_body")?, column("id")?);
        let corners = where_listed("corners")?;
        // Older files call this column `gone`.
        let removed = match self.reader.has(&place("gone")) {
            true => column("gone")?,
            false => where_listed("removed")?,
        };
        let velocity = axes(&["velocity_x", "velocity_y", "velocity_z"])?;
        let (spin, turn) = (axes(self.spins)?, axes(self.turns)?);
        fn at<const N: usize>(columns: &[Vec<f64>], k: usize) -> [f64; N] {
            std::array::from_fn(|axis| columns.get(axis).map_or(0.0, |c| c[k]))
        }
        let mut deformed = deformed::read(&self.reader, frame)?;
        let mut shapes = ShapesByGrain::of(shaped.unwrap_or_default())?;
        let mut state = State {
            frame,
            time,
            ..State::default()
        };
        let mut balls: Vec<u64> = Vec::new();
        let grains = (0..count).filter(|k| first_body[*k] == 0.0);
        for k in grains.filter(|k| removed[*k] == 0.0) {
            let motion = Motion {
                at: std::array::from_fn(|axis| points[3 * k + axis]),
                rotation: (!turn.is_empty()).then(|| at(&turn, k)),
                velocity: at(&velocity, k),
                spin: at(&spin, k),
            };
            let numbers = [motion.at, motion.velocity, motion.spin];
            let turns = motion.rotation.unwrap_or_default();
            let finite = |x: &f64| x.is_finite();
            if !(radius[k] > 0.0 && numbers.iter().flatten().chain(&turns).all(finite)) {
                return Err(format!(
                    "grain {k} of state {frame} has values that are not finite"
                ));
            }
            let body = id[k] as u64;
            match shapes.take(body, motion) {
                RowShape::New(mut grain) => {
                    grain.deformed = deformed.remove(&body);
                    state.shaped.push(*grain);
                }
                RowShape::AlreadyTaken => {}
                RowShape::None if corners[k] > 0.0 => return Err(shapeless(frame)),
                RowShape::None => {
                    balls.push(body);
                    let radius = radius[k];
                    state.grains.push(Grain { radius, motion });
                }
            }
        }
        balls.sort_unstable();
        if balls.windows(2).any(|w| w[0] == w[1]) {
            return Err(shapeless(frame));
        }
        if state.grains.is_empty() && state.shaped.is_empty() {
            return Err(format!("state {frame} holds no grains"));
        }
        Ok(state)
    }
}

/// Returns the error for grains whose shapes are not in the file.
fn shapeless(frame: usize) -> String {
    format!(
        "state {frame} holds grains that are no balls, and the file does not say of what shape: it is of an older version; \
         run its case again with this one"
    )
}

/// Shapes of grains by the identity of the grain; `None` once taken.
struct ShapesByGrain(HashMap<u64, Option<Box<ShapedGrain>>>);

/// Shape of the grain in a row.
enum RowShape {
    /// A shape that no earlier row has taken.
    New(Box<ShapedGrain>),
    /// A shape that was returned for an earlier row.
    AlreadyTaken,
    /// The grain has no shape: it is a single ball.
    None,
}

impl ShapesByGrain {
    /// Sorts the balls and pieces by grain.
    fn of(shaped: Shaped) -> Result<Self, String> {
        let mut grains: HashMap<u64, Option<Box<ShapedGrain>>> = HashMap::new();
        for body in shaped.bodies {
            let grain = ShapedGrain {
                balls: Vec::new(),
                pieces: Vec::new(),
                motion: Motion::default(),
                deformed: None,
                body,
            };
            grains.insert(grain.body.id, Some(Box::new(grain)));
        }
        let lost = |body: u64| format!("`shapes` has parts of a grain {body} that is not there");
        for ball in shaped.balls {
            let body = ball.body;
            let grain = grains.get_mut(&body).and_then(Option::as_mut);
            grain.ok_or_else(|| lost(body))?.balls.push(ball);
        }
        for piece in shaped.pieces {
            let body = piece.body;
            let grain = grains.get_mut(&body).and_then(Option::as_mut);
            grain.ok_or_else(|| lost(body))?.pieces.push(piece);
        }
        let bare = |g: &Option<Box<ShapedGrain>>| {
            g.as_ref()
                .is_some_and(|g| g.balls.is_empty() && g.pieces.is_empty())
        };
        if grains.values().any(bare) {
            return Err("`shapes` has a grain of no parts".to_owned());
        }
        Ok(Self(grains))
    }

    /// Returns the shape of the grain in a row, with the motion of that row.
    fn take(&mut self, body: u64, motion: Motion) -> RowShape {
        match self.0.get_mut(&body).map(Option::take) {
            None => RowShape::None,
            Some(None) => RowShape::AlreadyTaken,
            Some(Some(mut grain)) => {
                grain.motion = motion;
                RowShape::New(grain)
            }
        }
    }
}
