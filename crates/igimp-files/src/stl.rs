//! Closed surfaces from STL files, ASCII and binary.

use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;

use igimp_schema::diagnostic::Problems;
use igimp_schema::quantity::Dimension;
use igimp_schema::text::clip;
use igimp_schema::tree::{Entry, Node, Value};

use crate::bytes;
use crate::named::{LARGEST, Named, Trouble, quantity, unit_beside};

/// Most triangles.
const MOST: usize = 100_000;
/// Bytes of a binary file before the triangles, and of one triangle.
const HEAD: usize = 84;
const TRIANGLE: usize = 50;

/// Puts corners and triangles in place of the file that has them, in a table that names one in `file`.
pub(crate) fn resolve(surface: &mut Node, folder: &Path, problems: &mut Problems) {
    let Some(value) = surface.get("file") else {
        return;
    };
    let Some(file) = Named::new(value, folder) else {
        surface.value = Value::Invalid;
        return;
    };
    surface.value = match table(&file, surface) {
        Ok(entries) => Value::Table(entries),
        Err(trouble) => {
            file.report(value, trouble, problems);
            Value::Invalid
        }
    };
}

fn table(file: &Named, like: &Node) -> Result<Vec<Entry>, Trouble> {
    let keys = ["file", "unit"];
    let written = like.entries().iter().filter(|entry| entry.node.written);
    let mut others = written.map(|entry| entry.key.as_str());
    if let Some(other) = others.find(|other| !keys.contains(other)) {
        return Err(Trouble::new(
            format_args!("the surface is stated by `file` and by `{other}`"),
            "keep one of them",
        ));
    }
    let unit = unit_beside(like)?;
    let bytes = bytes::of_file(&file.path, LARGEST)
        .map_err(|error| Trouble::new(error, "its path starts from the case file"))?;
    if bytes.len() as u64 > LARGEST {
        let message = format!("it has more than {} MB", LARGEST >> 20);
        return Err(Trouble::new(message, "take fewer triangles"));
    }
    let triangles = triangles(&bytes)?;
    if triangles.len() > MOST {
        return Err(Trouble::new(
            format_args!(
                "it has {} triangles; at most {MOST} are possible",
                triangles.len()
            ),
            "take fewer of them",
        ));
    }
    // Corners that are the same to the bit are written once.
    let mut numbers: HashMap<[u32; 3], usize> = HashMap::new();
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    let list = |items| Node::written(Value::List(items), like.place);
    for triangle in &triangles {
        let mut face = Vec::new();
        for corner in triangle {
            let next = vertices.len();
            // Zero has two signs.
            let number = *numbers
                .entry(corner.map(|x| (x + 0.0).to_bits()))
                .or_insert(next);
            if number == next {
                let of = |&x: &f32| quantity(f64::from(x), &unit, Dimension::Length, like);
                let lengths = corner.iter().map(of).collect::<Result<Vec<_>, _>>()?;
                vertices.push(list(lengths));
            }
            face.push(Node::written(Value::Integer(number as i64), like.place));
        }
        faces.push(list(face));
    }
    let entry = |key: &str, node| Entry {
        key: key.to_owned(),
        key_place: like.place,
        node,
    };
    Ok(vec![
        entry("vertices", list(vertices)),
        entry("triangles", list(faces)),
    ])
}

/// The triangles of a file.
fn triangles(bytes: &[u8]) -> Result<Vec<[[f32; 3]; 3]>, Trouble> {
    let count = bytes
        .get(HEAD - 4..HEAD)
        .and_then(|word| <[u8; 4]>::try_from(word).ok());
    let count = count.map(|word| u32::from_le_bytes(word) as usize);
    let length = |count: usize| count.saturating_mul(TRIANGLE).saturating_add(HEAD);
    // Binary files may begin with the word `solid` too: their length says what they are.
    if count.is_some_and(|count| length(count) == bytes.len()) {
        let mut binary = bytes.to_vec();
        binary[..5].fill(b' ');
        return read(binary);
    }
    let text = String::from_utf8_lossy(bytes);
    let text = text.trim_start_matches('\u{feff}').trim_start();
    if !text.starts_with("solid") {
        let message = match count {
            Some(count) if count > 0 => format!(
                "it is no STL: a binary one with {count} triangles has {} bytes, this one {}",
                length(count),
                bytes.len()
            ),
            _ => "it is no STL, neither ASCII nor binary".to_owned(),
        };
        return Err(Trouble::new(message, "export the surface as STL once more"));
    }
    // A file may hold several solids, one after the other.
    let mut triangles = Vec::new();
    let mut solid = String::new();
    for line in text.lines() {
        let first = line.split_whitespace().next();
        if first == Some("solid") {
            "solid of many\n".clone_into(&mut solid);
        } else {
            solid.push_str(line);
            solid.push('\n');
        }
        if first == Some("endsolid") {
            triangles.extend(read(std::mem::take(&mut solid).into_bytes())?);
        }
    }
    if solid.trim().is_empty() {
        Ok(triangles)
    } else {
        Err(Trouble::new(
            "it ends within a solid",
            "the last line is `endsolid`: the file seems to be cut off",
        ))
    }
}

fn read(bytes: Vec<u8>) -> Result<Vec<[[f32; 3]; 3]>, Trouble> {
    let wrong = |error: std::io::Error| {
        Trouble::new(
            format_args!("it is no right STL: {}", clip(&error.to_string(), 80)),
            "export the surface as STL once more",
        )
    };
    let mut cursor = Cursor::new(bytes);
    let reader = stl_io::create_stl_reader(&mut cursor).map_err(wrong)?;
    let corners = |triangle: stl_io::Triangle| triangle.vertices.map(|corner| corner.0);
    let triangles: Result<Vec<_>, _> = reader.map(|triangle| triangle.map(corners)).collect();
    triangles.map_err(wrong)
}

#[cfg(test)]
mod tests {
    use super::triangles;

    const FACET: &str = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1.5 0\nendloop\nendfacet\n";

    fn message(bytes: &[u8]) -> String {
        triangles(bytes)
            .err()
            .map_or(String::new(), |trouble| trouble.message)
    }

    #[test]
    fn ascii_and_binary_are_told_apart() {
        let text = format!("solid\n{FACET}endsolid\nsolid two\n{FACET}{FACET}endsolid two\n");
        let read = triangles(text.as_bytes()).ok();
        let one = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.5, 0.0]];
        assert_eq!(read, Some(vec![one; 3]));
        // The header of a binary file may begin with `solid`.
        let mut binary = b"solid of some program".to_vec();
        binary.resize(80, 0);
        binary.extend(1_u32.to_le_bytes());
        let numbers = [[0.0, 0.0, 1.0], one[0], one[1], one[2]];
        binary.extend(numbers.iter().flatten().flat_map(|x: &f32| x.to_le_bytes()));
        binary.extend([0, 0]);
        assert_eq!(triangles(&binary).ok(), Some(vec![one]));
        binary[0] = b'x';
        binary.pop();
        assert_eq!(
            message(&binary),
            "it is no STL: a binary one with 1 triangles has 134 bytes, this one 133"
        );
    }

    #[test]
    fn damaged_files_are_refused() {
        assert!(message(b"").contains("neither ASCII nor binary"));
        assert!(message(format!("solid x\n{FACET}").as_bytes()).contains("ends within a solid"));
        let wrong = format!("solid x\n{}endsolid", FACET.replace("1.5", "fine"));
        assert!(
            message(wrong.as_bytes()).contains("no right STL"),
            "{}",
            message(wrong.as_bytes())
        );
        let many = "solid x\nfacet\nendsolid";
        assert!(message(many.as_bytes()).contains("invalid facet header"));
    }
}
