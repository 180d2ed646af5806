//! Reads frames back as igimp wrote them, for pages that show them: the frames in `paraview/` are the only states along
//! a run that its folder keeps, for checkpoints hold the last ones alone.
//!
//! A file that was damaged, or that another program wrote, is refused and harms nothing.

use std::io::Read as _;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use flate2::read::ZlibDecoder;
use rayon::prelude::*;

use super::{BLOCK, CellKind};

/// Most components of an array.
const MOST_COMPONENTS: usize = 9;

/// A frame, whose arrays are unpacked when they are asked for.
#[derive(Debug)]
pub struct Frame<'a> {
    text: &'a str,
    /// Number of cells.
    pub cells: usize,
    points: usize,
}

/// An array that stands in a frame.
#[derive(Clone, Debug)]
pub struct Stored<'a> {
    /// Its name.
    pub name: String,
    /// Number of components.
    pub components: usize,
    /// Names of the components; none for a scalar.
    pub component_names: Vec<String>,
    kind: &'a str,
    format: &'a str,
    body: &'a str,
}

impl<'a> Frame<'a> {
    /// The frame in a text, if it is one.
    pub fn of(text: &'a str) -> Option<Self> {
        let piece = between(text, "<Piece ", ">")?;
        let number = |name| attribute(piece, name)?.parse().ok();
        Some(Self {
            text,
            cells: number("NumberOfCells")?,
            points: number("NumberOfPoints")?,
        })
    }

    /// The arrays of a part of the frame, such as `CellData`.
    pub fn arrays(&self, part: &str) -> Vec<Stored<'a>> {
        let section = between(self.text, &format!("<{part}>"), &format!("</{part}>"));
        let mut rest = section.unwrap_or_default();
        let mut arrays = Vec::new();
        while let Some(next) = between(rest, "<DataArray ", "</DataArray>") {
            arrays.extend(stored(next));
            let end = rest.find("</DataArray>").unwrap_or(rest.len());
            rest = rest.get(end + 1..).unwrap_or_default();
        }
        arrays
    }

    /// Kind of the cells; the same for all of a frame, and none where there are no cells.
    pub fn kind(&self) -> Option<CellKind> {
        let types = self.part("Cells", "types")?.bytes(self.cells)?;
        let kind = CellKind::of_code(*types.first()?)?;
        types
            .iter()
            .all(|&code| code == kind.code())
            .then_some(kind)
    }

    /// The corners of every cell, in VTK's order.
    pub fn corners(&self, corners: usize) -> Option<Vec<[f64; 3]>> {
        let points = self.part("Points", "Points")?;
        let connectivity = self.part("Cells", "connectivity")?;
        if (points.components, connectivity.components) != (3, 1) {
            return None;
        }
        let points = points.numbers(self.points)?;
        let (points, _) = points.as_chunks::<3>();
        let corner = |&place: &f64| (place >= 0.0).then(|| points.get(place as usize).copied())?;
        let places = connectivity.numbers(corners.checked_mul(self.cells)?)?;
        places.iter().map(corner).collect()
    }

    fn part(&self, part: &str, name: &str) -> Option<Stored<'a>> {
        let mut arrays = self.arrays(part).into_iter();
        arrays.find(|array| array.name == name)
    }
}

impl Stored<'_> {
    /// Whether the numbers are codes and counts.
    pub fn is_whole(&self) -> bool {
        self.kind != "Float64"
    }

    /// The numbers of all tuples, one tuple after another; `None` unless there are `tuples` of them.
    pub fn numbers(&self, tuples: usize) -> Option<Vec<f64>> {
        let count = tuples.checked_mul(self.components)?;
        let bytes = self.bytes(count.checked_mul(self.size()?)?)?;
        let numbers: Vec<f64> = match self.kind {
            "Float64" => each(&bytes, f64::from_le_bytes),
            "Int64" | "UInt64" => each(&bytes, |raw| i64::from_le_bytes(raw) as f64),
            "Int32" => each(&bytes, |raw| f64::from(i32::from_le_bytes(raw))),
            _ => bytes.iter().map(|&byte| f64::from(byte)).collect(),
        };
        Some(numbers)
    }

    fn size(&self) -> Option<usize> {
        match self.kind {
            "Float64" | "Int64" | "UInt64" => Some(8),
            "Int32" => Some(4),
            "UInt8" => Some(1),
            _ => None,
        }
    }

    /// The bytes, if there are `count` of them: number of blocks, their size, size of a smaller last one,
    /// compressed size of each; then the blocks.
    fn bytes(&self, count: usize) -> Option<Vec<u8>> {
        if self.format != "binary" {
            return (count == 0).then(Vec::new);
        }
        let text = self.body.trim();
        let first = BASE64.decode(text.get(..12)?).ok()?;
        let blocks = usize::try_from(u64::from_le_bytes(*first.first_chunk()?)).ok()?;
        if blocks != count.div_ceil(BLOCK) {
            return None;
        }
        let header = blocks.checked_add(3)?.checked_mul(8)?;
        let length = header.div_ceil(3).checked_mul(4)?;
        let header = BASE64.decode(text.get(..length)?).ok()?;
        let data = BASE64.decode(text.get(length..)?).ok()?;
        let mut start = 0_usize;
        let parts: Vec<&[u8]> = each(&header, u64::from_le_bytes)
            .into_iter()
            .skip(3)
            .map(|size| {
                let end = start.checked_add(usize::try_from(size).ok()?)?;
                let part = data.get(start..end);
                start = end;
                part
            })
            .collect::<Option<_>>()?;
        let mut bytes = vec![0; count];
        let whole = bytes
            .par_chunks_mut(BLOCK)
            .zip(parts)
            .map(|(place, part)| ZlibDecoder::new(part).read_exact(place).is_ok());
        whole.all(|read| read).then_some(bytes)
    }
}

fn each<const N: usize, T>(bytes: &[u8], read: impl Fn([u8; N]) -> T) -> Vec<T> {
    bytes.as_chunks().0.iter().map(|raw| read(*raw)).collect()
}

fn stored(text: &str) -> Option<Stored<'_>> {
    let (head, body) = text.split_once('>')?;
    let value = |name: &str| attribute(head, name);
    let components = value("NumberOfComponents").map_or(Some(1), |number| number.parse().ok())?;
    if !(1..=MOST_COMPONENTS).contains(&components) {
        return None;
    }
    let names = (0..components).map_while(|k| value(&format!("ComponentName{k}")).map(unescaped));
    Some(Stored {
        name: unescaped(value("Name")?),
        components,
        component_names: names.collect(),
        kind: value("type")?,
        format: value("format")?,
        body,
    })
}

/// The value of an attribute.
fn attribute<'a>(head: &'a str, name: &str) -> Option<&'a str> {
    let start = format!("{name}=\"");
    let places = head.match_indices(&start);
    let whole = |place: usize| place == 0 || head.as_bytes()[place - 1].is_ascii_whitespace();
    let (place, _) = places.into_iter().find(|&(place, _)| whole(place))?;
    head[place + start.len()..].split('"').next()
}

/// The text between two marks.
fn between<'a>(text: &'a str, from: &str, to: &str) -> Option<&'a str> {
    let start = text.find(from)? + from.len();
    let length = text[start..].find(to)?;
    Some(&text[start..start + length])
}

/// The text whose [`escaped`](super::escaped) form is an attribute's value.
pub(crate) fn unescaped(text: &str) -> String {
    text.replace("&quot;", "\"")
        .replace("&gt;", ">")
        .replace("&lt;", "<")
        .replace("&amp;", "&")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vtu::{DataArray, UnstructuredGrid};

    fn grid(cells: usize) -> UnstructuredGrid {
        let points: Vec<[f64; 3]> = (0..4 * cells).map(|k| [k as f64, 0.5, -1.0]).collect();
        UnstructuredGrid {
            connectivity: (0..points.len()).rev().collect(),
            kind: CellKind::Quad,
            cell_data: vec![
                DataArray::scalars(
                    "a <b> \"c\" & d",
                    (0..cells).map(|k| k as f64 / 3.0).collect(),
                ),
                DataArray::integers("law", (0..cells).map(|k| k as i32 - 2).collect()),
            ],
            point_data: Vec::new(),
            field_data: Vec::new(),
            points,
        }
    }

    #[test]
    fn what_was_written_is_read() {
        for cells in [0, 1, 5, 5000] {
            let written = grid(cells);
            let text = written.to_xml();
            let frame = Frame::of(&text).unwrap();
            let arrays = frame.arrays("CellData");
            assert_eq!(arrays[0].name, "a <b> \"c\" & d");
            assert_eq!(
                arrays[0].numbers(cells).unwrap(),
                (0..cells).map(|k| k as f64 / 3.0).collect::<Vec<_>>()
            );
            assert!(arrays[1].is_whole() && !arrays[0].is_whole());
            assert_eq!(
                arrays[1].numbers(cells).unwrap().first(),
                (cells > 0).then_some(&-2.0)
            );
            assert_eq!(frame.kind(), (cells > 0).then_some(CellKind::Quad));
            let corners = frame.corners(4).unwrap();
            assert_eq!(corners.first(), written.points.last());
        }
    }

    #[test]
    fn what_was_changed_is_refused() {
        let text = grid(9).to_xml();
        let frame = |text: &str| Frame::of(text).and_then(|frame| frame.corners(4)).is_some();
        assert!(frame(&text));
        for cut in (0..text.len()).step_by(7) {
            let frame = Frame::of(&text[..cut]);
            let _ = frame.map(|frame| (frame.corners(4), frame.kind()));
        }
        assert!(!frame(&text.replace(
            "NumberOfCells=\"9\"",
            "NumberOfCells=\"99999999999\""
        )));
        assert!(!frame(&text.replace("AQAAAAAAAAA", "/////////38")));
        assert!(!frame(""));
    }

    /// GOAL: sizes whose product does not fit a number are refused, also where the product wraps to the right one.
    #[test]
    fn sizes_that_overflow_are_refused() {
        let text = grid(8).to_xml();
        let frame = |text: &str| Frame::of(text).and_then(|frame| frame.corners(4)).is_some();
        let with = |name: &str, count: usize, to: usize| {
            let [from, to] = [count, to].map(|count| format!("{name}=\"{count}\""));
            assert!(text.contains(&from));
            text.replace(&from, &to)
        };
        // In 64 bits 4 (2⁶² + 8) wraps to 32, and 3 · 8 (2⁶¹ + 32) to 3 · 8 · 32.
        for cells in [(1 << 62) + 8, usize::MAX, usize::MAX / 4] {
            assert!(!frame(&with("NumberOfCells", 8, cells)));
        }
        for points in [(1 << 61) + 32, (1 << 63) + 32, usize::MAX, usize::MAX / 3] {
            assert!(!frame(&with("NumberOfPoints", 32, points)));
        }
        let arrays = Frame::of(&text).unwrap().arrays("CellData");
        for tuples in [(1 << 61) + 8, usize::MAX, usize::MAX / 8] {
            assert!(arrays[0].numbers(tuples).is_none());
        }
    }
}
