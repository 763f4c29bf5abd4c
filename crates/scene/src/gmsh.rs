//! Reader of meshes in Gmsh's text format, versions 2.2 and 4.1: points, simplices, and named
//! physical groups.
//!
//! Source: "Gmsh reference manual", file formats.

use super::source::read_bytes;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// Limit on the size of a file, in bytes.
const MAX_BYTES: u64 = 1 << 30;
/// Gmsh's numbers of lines, triangles and tetrahedra, by their dimension.
const SIMPLEX: [i64; 3] = [1, 2, 4];
/// Gmsh's number of a single point.
const POINT: i64 = 15;

/// Content of a file, in the file's unit of length.
#[derive(Debug, Default, PartialEq)]
pub struct GmshMesh {
    /// Points that elements use.
    pub points: Vec<[f64; 3]>,
    /// Points of the elements of the dimension, one after the other.
    pub elements: Vec<u32>,
    /// Points of the elements one dimension below, by the name of their physical group.
    pub parts: BTreeMap<String, Vec<u32>>,
}

/// Reads the simplices of a dimension (2 or 3) and the named groups of their sides.
///
/// # Errors
/// A sentence with the file and the line.
pub fn read(path: &Path, dimension: usize) -> Result<GmshMesh, String> {
    let bytes = read_bytes(path, MAX_BYTES).map_err(|e| e.in_a_sentence())?;
    let shown = path.display();
    let text = std::str::from_utf8(&bytes).map_err(|_| {
        format!("{shown} is no text; save the mesh as version 4.1 (ASCII), with `Mesh.Binary = 0`")
    })?;
    parse(text, dimension).map_err(|(line, why)| format!("{shown}, line {line}: {why}"))
}

type Fault = (usize, String);

/// The lines of a file, with their numbers.
struct Lines<'a> {
    rest: std::iter::Enumerate<std::str::Lines<'a>>,
    last: usize,
}

impl<'a> Lines<'a> {
    fn next(&mut self) -> Option<&'a str> {
        let (k, line) = self.rest.next()?;
        self.last = k + 1;
        Some(line.trim())
    }

    fn fault<T>(&self, why: impl Into<String>) -> Result<T, Fault> {
        Err((self.last, why.into()))
    }

    /// Returns the numbers of the next line, of which there must be a minimum.
    fn numbers<T: std::str::FromStr>(&mut self, least: usize) -> Result<Vec<T>, Fault> {
        let Some(line) = self.next() else {
            return self.fault("the file ends within a section; save it again");
        };
        let numbers: Result<Vec<T>, _> = line.split_whitespace().map(str::parse).collect();
        match numbers {
            Ok(numbers) if numbers.len() >= least => Ok(numbers),
            _ => self.fault(format!(
                "expected {least} numbers, found `{}`",
                shorter(line)
            )),
        }
    }
}

fn shorter(line: &str) -> String {
    line.chars().take(40).collect()
}

/// Dimension, physical groups and points of elements, by the file's numbers.
type Elements = Vec<(usize, Vec<i64>, Vec<u64>)>;

#[derive(Default)]
struct MeshReader {
    version: f64,
    names: HashMap<(usize, i64), String>,
    /// Physical groups of each entity.
    groups: HashMap<(usize, i64), Vec<i64>>,
    places: HashMap<u64, [f64; 3]>,
    elements: Elements,
}

fn parse(text: &str, dimension: usize) -> Result<GmshMesh, Fault> {
    let mut lines = Lines {
        rest: text.lines().enumerate(),
        last: 0,
    };
    let mut read = MeshReader::default();
    while let Some(line) = lines.next() {
        match line {
            "$MeshFormat" => read.format(&mut lines)?,
            "$PhysicalNames" => read.physical_names(&mut lines)?,
            "$Entities" => read.entities(&mut lines)?,
            "$Nodes" => read.nodes(&mut lines)?,
            "$Elements" => read.elements(&mut lines)?,
            _ => {}
        }
    }
    if read.version == 0.0 {
        return Err((
            1,
            "this is no file of Gmsh: it has no `$MeshFormat`".to_owned(),
        ));
    }
    read.mesh(dimension)
}

impl MeshReader {
    fn format(&mut self, lines: &mut Lines) -> Result<(), Fault> {
        let format = lines.numbers::<f64>(2)?;
        if format[1] != 0.0 {
            return lines.fault("the file is binary; save it as text, with `Mesh.Binary = 0`");
        }
        if !(format[0] == 4.1 || (2.0..3.0).contains(&format[0])) {
            return lines.fault(format!(
                "version {} is not known; save the mesh as version 4.1, with `Mesh.MshFileVersion = 4.1`",
                format[0]
            ));
        }
        self.version = format[0];
        Ok(())
    }

    fn physical_names(&mut self, lines: &mut Lines) -> Result<(), Fault> {
        let count = lines.numbers::<usize>(1)?[0];
        for _ in 0..count {
            let line = lines.next().unwrap_or_default();
            let mut words = line.splitn(3, char::is_whitespace);
            let number = |word: Option<&str>| word.and_then(|w| w.parse::<i64>().ok());
            let (of, tag) = (number(words.next()), number(words.next()));
            let name = words.next().map(|w| w.trim().trim_matches('"').to_owned());
            let (Some(of), Some(tag), Some(name)) = (of, tag, name) else {
                return lines.fault(format!(
                    "expected a dimension, a number and a name, found `{}`",
                    shorter(line)
                ));
            };
            self.names.insert((of as usize, tag), name);
        }
        Ok(())
    }

    /// Reads the physical groups of each curve, surface and volume.
    fn entities(&mut self, lines: &mut Lines) -> Result<(), Fault> {
        let counts = lines.numbers::<usize>(4)?;
        for (of, count) in counts.iter().enumerate().take(4) {
            // Before the number of groups a point has three coordinates, other entities a box of
            // six.
            let before = if of == 0 { 4 } else { 7 };
            for _ in 0..*count {
                let entity = lines.numbers::<f64>(before + 1)?;
                let count = entity[before].max(0.0) as usize;
                let groups = entity[before + 1..].iter().take(count);
                let groups: Vec<i64> = groups.map(|g| g.abs() as i64).collect();
                if groups.len() < count {
                    return lines.fault("the entity has fewer groups than it announces");
                }
                self.groups.insert((of, entity[0] as i64), groups);
            }
        }
        Ok(())
    }

    fn nodes(&mut self, lines: &mut Lines) -> Result<(), Fault> {
        let header = lines.numbers::<u64>(1)?;
        if self.version < 3.0 {
            for _ in 0..header[0] {
                let node = lines.numbers::<f64>(4)?;
                self.places
                    .insert(node[0] as u64, [node[1], node[2], node[3]]);
            }
            return Ok(());
        }
        for _ in 0..header[0] {
            let block = lines.numbers::<i64>(4)?;
            let mut tags = Vec::new();
            for _ in 0..block[3] {
                tags.push(lines.numbers::<u64>(1)?[0]);
            }
            for tag in tags {
                let at = lines.numbers::<f64>(3)?;
                self.places.insert(tag, [at[0], at[1], at[2]]);
            }
        }
        Ok(())
    }

    fn elements(&mut self, lines: &mut Lines) -> Result<(), Fault> {
        let header = lines.numbers::<u64>(1)?;
        if self.version < 3.0 {
            for _ in 0..header[0] {
                let element = lines.numbers::<i64>(3)?;
                let tags = element[2].max(0) as usize;
                let groups = element.iter().skip(3).take(tags.min(1)).copied().collect();
                let points = element.iter().skip(3 + tags).map(|p| *p as u64).collect();
                self.push(lines, element[1], groups, points)?;
            }
            return Ok(());
        }
        for _ in 0..header[0] {
            let block = lines.numbers::<i64>(4)?;
            for _ in 0..block[3] {
                let element = lines.numbers::<u64>(1)?;
                let groups = self.groups.get(&(block[0].max(0) as usize, block[1]));
                let groups = groups.cloned().unwrap_or_default();
                self.push(lines, block[2], groups, element[1..].to_vec())?;
            }
        }
        Ok(())
    }

    fn push(
        &mut self,
        lines: &Lines,
        kind: i64,
        groups: Vec<i64>,
        points: Vec<u64>,
    ) -> Result<(), Fault> {
        if kind == POINT {
            return Ok(());
        }
        let Some(of) = SIMPLEX.iter().position(|k| *k == kind).map(|k| k + 1) else {
            return lines.fault(format!(
                "an element of Gmsh's type {kind}; only straight lines, triangles and tetrahedra are read: mesh with \
                 `Mesh.ElementOrder = 1` and without recombining"
            ));
        };
        if points.len() != of + 1 {
            return lines.fault(format!(
                "the element has {} points, not {}",
                points.len(),
                of + 1
            ));
        }
        if let Some(unknown) = points.iter().find(|p| !self.places.contains_key(p)) {
            return lines.fault(format!(
                "the element has node {unknown}, which the file does not give"
            ));
        }
        self.elements.push((of, groups, points));
        Ok(())
    }

    /// Returns the mesh, with points in the order in which the elements name them.
    fn mesh(self, dimension: usize) -> Result<GmshMesh, Fault> {
        let mut out = GmshMesh::default();
        let mut known: HashMap<u64, u32> = HashMap::new();
        for (_, _, points) in self.elements.iter().filter(|e| e.0 == dimension) {
            for point in points {
                let next = known.len() as u32;
                let at = *known.entry(*point).or_insert(next);
                if at == next {
                    out.points.push(self.places[point]);
                }
                out.elements.push(at);
            }
        }
        for (of, groups, points) in self.elements.iter().filter(|e| e.0 + 1 == dimension) {
            for name in groups.iter().filter_map(|g| self.names.get(&(*of, *g))) {
                let points: Option<Vec<u32>> =
                    points.iter().map(|p| known.get(p).copied()).collect();
                let Some(points) = points else {
                    let why =
                        format!("a side of the physical group `{name}` belongs to no element");
                    return Err((1, why));
                };
                out.parts.entry(name.clone()).or_default().extend(points);
            }
        }
        if dimension == 2 {
            if let Some(at) = out.points.iter().find(|p| p[2] != 0.0) {
                let why = format!("a point of the mesh at {at:?} is not in the plane z = 0");
                return Err((1, why));
            }
            out.turn();
        }
        Ok(out)
    }
}

impl GmshMesh {
    /// Reverses the triangles of a plane surface if all of them are clockwise.
    fn turn(&mut self) {
        let area = |t: &[u32]| {
            let [a, b, c] = [t[0], t[1], t[2]].map(|k| self.points[k as usize]);
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        if self.elements.chunks_exact(3).all(|t| area(t) < 0.0) {
            for t in self.elements.chunks_exact_mut(3) {
                t.swap(1, 2);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NEW: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 7 \"top side\"\n$EndPhysicalNames\n\
        $Entities\n0 1 1 0\n3 0 1 0 1 1 0 1 7 0\n1 0 0 0 1 1 0 0 0\n$EndEntities\n\
        $Nodes\n1 4 1 9\n2 1 0 4\n1\n2\n3\n9\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n\
        $Elements\n2 3 1 3\n1 3 1 1\n1 3 9\n2 1 2 2\n2 1 2 3\n3 1 3 9\n$EndElements\n";
    const OLD: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n1 7 \"top side\"\n$EndPhysicalNames\n\
        $Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n9 0 1 0\n$EndNodes\n\
        $Elements\n3\n1 1 2 7 3 3 9\n2 2 2 0 1 1 2 3\n3 2 2 0 1 1 3 9\n$EndElements\n";

    #[test]
    fn both_versions_say_the_same() {
        let new = parse(NEW, 2).unwrap();
        assert_eq!(new.elements, [0, 1, 2, 0, 2, 3]);
        assert_eq!(new.points[3], [0.0, 1.0, 0.0]);
        assert_eq!(new.parts["top side"], [2, 3]);
        assert_eq!(parse(OLD, 2).unwrap(), new);
        assert!(parse(NEW, 3).unwrap().elements.is_empty());
    }

    #[test]
    fn a_curve_may_be_in_two_groups() {
        let two = NEW
            .replace(
                "\n1\n1 7 \"top side\"\n",
                "\n2\n1 7 \"top side\"\n1 8 \"all\"\n",
            )
            .replace("3 0 1 0 1 1 0 1 7 0", "3 0 1 0 1 1 0 2 7 8 0");
        let mesh = parse(&two, 2).unwrap();
        assert_eq!(mesh.parts["all"], mesh.parts["top side"]);
    }

    #[test]
    fn clockwise_triangles_are_turned_and_others_refused() {
        let clockwise = OLD
            .replace("1 1 2 3", "1 1 3 2")
            .replace("1 1 3 9", "1 1 9 3");
        assert_eq!(parse(&clockwise, 2).unwrap().elements, [0, 2, 1, 0, 1, 3]);
        let high = OLD.replace("9 0 1 0", "9 0 1 0.5");
        assert!(parse(&high, 2).unwrap_err().1.contains("z = 0"));
        let quad = OLD.replace("3 2 2 0 1 1 3 9", "3 3 2 0 1 1 2 3 9");
        assert!(
            parse(&quad, 2)
                .unwrap_err()
                .1
                .contains("without recombining")
        );
    }

    #[test]
    fn faults_have_their_line() {
        let fault = |text: String| parse(&text, 2).unwrap_err();
        assert_eq!(fault(NEW.replace("4.1 0 8", "4.1 1 8")).0, 2);
        assert!(fault(NEW.replace("4.1 0 8", "3.0 0 8")).1.contains("4.1"));
        assert!(
            fault(OLD.replace("1 1 2 3", "1 1 2 5"))
                .1
                .contains("node 5")
        );
        assert!(
            fault(NEW.replace("1 1 0\n0 1 0", "1 1\n0 1 0"))
                .1
                .contains("3 numbers")
        );
        assert!(fault("solid".to_owned()).1.contains("no file of Gmsh"));
        let cut = &OLD[..OLD.find("3 1 1 0\n").unwrap()];
        assert!(fault(cut.to_owned()).1.contains("ends"));
    }
}
