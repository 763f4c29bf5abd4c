//! Incidence of the corners, edges and faces of a polyhedron.

use super::polyhedron_hull::PolyhedronError;

/// Incidence of corners, edges and faces.
#[derive(Debug, PartialEq, Eq)]
pub struct Topology {
    /// Corners of each face, anticlockwise seen from outside.
    pub faces: Vec<Vec<u32>>,
    /// Edges of each face: side k goes from its corner k to the next.
    pub sides: Vec<Vec<u32>>,
    /// All edges.
    pub edges: Vec<Edge>,
    /// Faces around each corner, anticlockwise seen from outside.
    pub about: Vec<Vec<u32>>,
}

/// An edge: two corners and the faces on both sides; a segment has no faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Corners at the start and the end of the edge.
    pub corners: [u32; 2],
    /// The face oriented along the edge, and the one oriented against it.
    pub faces: Option<[u32; 2]>,
}

/// Maximum number of edges that the names of contact points can distinguish.
pub const MAX_EDGES: usize = 1 << 14;

impl Topology {
    /// Builds the incidence from the corners of the faces.
    pub(super) fn new(corners: usize, faces: Vec<Vec<u32>>) -> Result<Self, PolyhedronError> {
        let mut edges: Vec<Edge> = Vec::new();
        let mut sides = Vec::with_capacity(faces.len());
        let mut known = std::collections::HashMap::new();
        for (f, face) in faces.iter().enumerate() {
            let mut own = Vec::with_capacity(face.len());
            for (k, a) in face.iter().enumerate() {
                let b = face[(k + 1) % face.len()];
                let edge = *known.entry((*a.min(&b), *a.max(&b))).or_insert_with(|| {
                    edges.push(Edge {
                        corners: [*a, b],
                        faces: Some([f as u32; 2]),
                    });
                    edges.len() - 1
                });
                if edges[edge].corners == [b, *a]
                    && let Some(faces) = &mut edges[edge].faces
                {
                    faces[1] = f as u32;
                }
                own.push(edge as u32);
            }
            sides.push(own);
        }
        let closed = |e: &Edge| e.faces.is_some_and(|f| f[0] != f[1]);
        if faces.iter().any(|f| f.len() < 3) || !edges.iter().all(closed) {
            return Err(PolyhedronError::Open);
        }
        if edges.len() > MAX_EDGES {
            return Err(PolyhedronError::TooMany(edges.len()));
        }
        let mut out = Self {
            faces,
            sides,
            edges,
            about: Vec::new(),
        };
        out.about = (0..corners as u32)
            .map(|c| out.around(c))
            .collect::<Result<_, _>>()?;
        Ok(out)
    }

    /// Returns the faces around a corner: each next face leaves along the edge on which the
    /// previous one arrives.
    fn around(&self, corner: u32) -> Result<Vec<u32>, PolyhedronError> {
        let place = |f: usize| self.faces[f].iter().position(|c| *c == corner);
        let first = (0..self.faces.len()).find(|f| place(*f).is_some());
        let first = first.ok_or(PolyhedronError::Open)?;
        let (mut out, mut f) = (Vec::new(), first);
        loop {
            out.push(f as u32);
            let n = self.faces[f].len();
            let at = place(f).ok_or(PolyhedronError::Open)?;
            let edge = &self.edges[self.sides[f][(at + n - 1) % n] as usize];
            let [a, b] = edge.faces.ok_or(PolyhedronError::Open)?;
            f = if a as usize == f { b } else { a } as usize;
            if f == first {
                return Ok(out);
            }
            if out.len() > self.faces.len() {
                return Err(PolyhedronError::Open);
            }
        }
    }
}
