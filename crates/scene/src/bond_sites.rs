//! Contacts on which an interface's bonds form, estimated from the scene before it runs.

use fretwork_core::geometry::shape::point_radius;
use fretwork_core::view::RunView;
use nalgebra::Vector3;

/// A pair of bodies that a bond may join.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BondPair {
    /// Reduced radius r1 r2/(r1 + r2) (m).
    pub radius: f64,
    /// Sum of the inverse masses along the normal (1/kg).
    pub normal: f64,
    /// Sum of the inverse masses along the tangents, including the rotation of the grains (1/kg).
    pub shear: f64,
}

/// Statistics of the contacts on which bonds form.
#[derive(Clone, Debug, PartialEq)]
pub struct BondSites {
    /// Number of contacts of the interface at the start; 0 if there are none yet and the estimate
    /// is made from the grains.
    pub contacts: usize,
    /// Median of their reduced radii (m).
    pub radius: f64,
    /// Largest ratio of contact area to effective mass along the normal (m^2/kg; in 2D per metre of
    /// depth). A bond stiffness of k (Pa/m) times this ratio is the square of the bond's angular
    /// frequency.
    pub normal: f64,
    /// Largest ratio of contact area to effective mass along the tangents.
    pub shear: f64,
    /// Median of the ratio along the normal.
    pub normal_median: f64,
    /// Median of the ratio along the tangents.
    pub shear_median: f64,
    /// The pairs, by inverse mass along the normal, heaviest first.
    pairs: Vec<BondPair>,
    /// The lightest pair.
    lightest: BondPair,
}

impl BondSites {
    /// Returns the bond sites of the interface with index `law`; `None` if it governs no contact
    /// and no grain. While there are fewer contacts than grains, the lightest pairs that grains may
    /// form are used for the largest ratios.
    pub fn of(s: &dyn RunView, law: usize) -> Option<Self> {
        let area = |radius: f64| s.laws()[law].area.area(s.dimension(), radius);
        let pairs = of_contacts(s, law);
        let grains = s.balls().len() + s.pieces().len();
        if !pairs.is_empty() && pairs.len() >= grains {
            return Self::of_pairs(pairs.len(), pairs, &[], area);
        }
        let Candidates { usual, extreme } = of_grains(s, law);
        if !pairs.is_empty() {
            return Self::of_pairs(pairs.len(), pairs, &extreme, area);
        }
        Self::of_pairs(0, usual, &extreme, area)
    }

    /// Computes the statistics of the usual pairs, and of others that are used for the largest
    /// ratios only.
    fn of_pairs(
        contacts: usize,
        mut pairs: Vec<BondPair>,
        extreme: &[BondPair],
        area: impl Fn(f64) -> f64,
    ) -> Option<Self> {
        let normal = |p: &BondPair| area(p.radius) * p.normal;
        let shear = |p: &BondPair| area(p.radius) * p.shear;
        let middle = |of: &dyn Fn(&BondPair) -> f64| median(pairs.iter().map(of).collect());
        let largest =
            |of: &dyn Fn(&BondPair) -> f64| pairs.iter().chain(extreme).map(of).fold(0.0, f64::max);
        let by_mass = |a: &&BondPair, b: &&BondPair| a.normal.total_cmp(&b.normal);
        let lightest = *pairs.iter().chain(extreme).max_by(by_mass)?;
        let out = Self {
            contacts,
            radius: middle(&|p| p.radius)?,
            normal: largest(&normal),
            shear: largest(&shear),
            normal_median: middle(&normal)?,
            shear_median: middle(&shear)?,
            pairs: Vec::new(),
            lightest,
        };
        pairs.sort_by(|a, b| a.normal.total_cmp(&b.normal));
        Some(Self { pairs, ..out })
    }

    /// Returns the pair below which a share of all pairs lie by inverse mass along the normal: 0.5
    /// for the median, 1 for the lightest.
    pub fn pair(&self, share: f64) -> BondPair {
        if share >= 1.0 {
            return self.lightest;
        }
        let last = self.pairs.len() - 1;
        self.pairs[((share * last as f64).round() as usize).min(last)]
    }
}

/// The contacts of an interface.
fn of_contacts(s: &dyn RunView, law: usize) -> Vec<BondPair> {
    let mut pairs = Vec::new();
    s.visit_contacts(&mut |c| {
        if usize::from(c.interface) != law || c.radius <= 0.0 {
            return;
        }
        let (mut normal, mut shear) = (0.0, 0.0);
        for (body, arm) in c.bodies.iter().zip(&c.arms) {
            let inverse = s.bodies().inverse_mass.at(*body as usize);
            let along: f64 = (0..3).map(|k| inverse[k] * c.normal[k].powi(2)).sum();
            normal += of_deforming(s, *body).map_or(along, |inverse| inverse[0]);
            let arm = Vector3::from(*arm).norm();
            shear += inverse_mass(s, *body) + arm.powi(2) * inverse_inertia(s, *body);
        }
        pairs.push(BondPair {
            radius: c.radius,
            normal,
            shear,
        });
    });
    pairs
}

/// A grain, or a surface of a body: its body, curvature (1/m), inverse mass along the normal and
/// the tangents (1/kg), material.
#[derive(Clone, Copy)]
struct BondSide {
    body: u32,
    curvature: f64,
    normal: f64,
    shear: f64,
    material: u16,
}

impl BondSide {
    fn with(&self, other: &Self) -> BondPair {
        BondPair {
            radius: 1.0 / (self.curvature + other.curvature),
            normal: self.normal + other.normal,
            shear: self.shear + other.shear,
        }
    }
}

/// Pairs that may come into contact.
#[derive(Default)]
struct Candidates {
    /// Pairs that are typical of most contacts.
    usual: Vec<BondPair>,
    /// Pairs of the lightest grain with every other, and with surfaces.
    extreme: Vec<BondPair>,
}

/// Returns pairs before there are contacts: each grain with the next one in the scene, or with each
/// surface where the interface has no pairs of grains.
fn of_grains(s: &dyn RunView, law: usize) -> Candidates {
    let governed = |a: &BondSide, b: &BondSide| {
        let found = s.table().get(a.material, b.material);
        found.map(usize::from) == Some(law)
    };
    let join = |a: &BondSide, b: &BondSide| governed(a, b).then(|| a.with(b));
    let apart = |a: &BondSide, b: &BondSide| (a.body != b.body).then(|| join(a, b)).flatten();
    let (grains, surfaces) = (grains(s), surfaces(s));
    let mut out = Candidates::default();
    let neighbours = grains.windows(2);
    out.usual
        .extend(neighbours.filter_map(|w| apart(&w[0], &w[1])));
    let mut kinds: Vec<u16> = grains.iter().map(|g| g.material).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let own = |g: &&BondSide| {
        let with = |kind: &u16| s.table().get(g.material, *kind).map(usize::from) == Some(law);
        kinds.iter().any(with)
    };
    let lightest = grains.iter().filter(own);
    let lightest = lightest.max_by(|a, b| a.normal.total_cmp(&b.normal));
    if let Some(lightest) = lightest {
        out.extreme
            .extend(grains.iter().filter_map(|g| apart(lightest, g)));
    }
    let mut at_surfaces: Vec<BondPair> = Vec::new();
    for surface in &surfaces {
        at_surfaces.extend(grains.iter().filter_map(|g| join(surface, g)));
    }
    if out.usual.is_empty() {
        std::mem::swap(&mut out.usual, &mut out.extreme);
    }
    if out.usual.is_empty() {
        out.usual = at_surfaces;
    } else {
        out.extreme.append(&mut at_surfaces);
    }
    // A single grain, which may meet grains like itself.
    if out.usual.is_empty() {
        out.usual.extend(grains.iter().filter_map(|g| join(g, g)));
    }
    out
}

fn grains(s: &dyn RunView) -> Vec<BondSide> {
    // The size of a point of a deformable grain is that of its tributary area.
    let balls = s.balls().into_iter().map(|b| {
        let size = match b.radius > 0.0 {
            true => b.radius,
            false => point_radius(s.dimension(), Vector3::from(b.area).norm()),
        };
        (b.body, size, b.material)
    });
    let balls = balls.filter(|(_, size, _)| *size > 0.0);
    let pieces = s.pieces().into_iter();
    let pieces = pieces.map(|p| (p.body, p.size, p.material));
    let side = |(body, radius, material): (u32, f64, u16)| {
        let inverse = inverse_mass(s, body);
        let arm = match of_deforming(s, body) {
            Some(_) => s.bodies().length[body as usize],
            None => radius,
        };
        let turning = arm * arm * inverse_inertia(s, body);
        BondSide {
            body,
            curvature: 1.0 / radius,
            normal: inverse,
            shear: inverse + turning,
            material,
        }
    };
    balls.chain(pieces).map(side).collect()
}

/// Returns one surface for each material and mass.
fn surfaces(s: &dyn RunView) -> Vec<BondSide> {
    let mut out: Vec<BondSide> = Vec::new();
    for surface in s.surfaces() {
        let normal = inverse_mass(s, surface.body);
        let known = |x: &BondSide| x.material == surface.material && x.normal == normal;
        if !out.iter().any(known) {
            out.push(BondSide {
                body: surface.body,
                curvature: 0.0,
                normal,
                shear: normal,
                material: surface.material,
            });
        }
    }
    out
}

/// Returns inverse mass and inverse moment of inertia of a deformable grain, treated as the rigid
/// ball (2D: disk) of its mass; `None` for other bodies.
fn of_deforming(s: &dyn RunView, body: u32) -> Option<[f64; 2]> {
    let (bodies, b) = (s.bodies(), body as usize);
    bodies.carrier(b).filter(|carrier| carrier.grain)?;
    let (mass, radius) = (bodies.mass[b], bodies.length[b]);
    let share = if s.dimension() == 2 { 0.5 } else { 0.4 };
    Some([1.0 / mass, 1.0 / (share * mass * radius * radius)])
}

fn inverse_inertia(s: &dyn RunView, body: u32) -> f64 {
    let rigid = s.bodies().inverse_inertia[body as usize];
    of_deforming(s, body).map_or(rigid, |inverse| inverse[1])
}

fn inverse_mass(s: &dyn RunView, body: u32) -> f64 {
    if let Some([inverse, _]) = of_deforming(s, body) {
        return inverse;
    }
    let inverse = s.bodies().inverse_mass.at(body as usize);
    inverse.into_iter().fold(0.0, f64::max)
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
