//! Unstructured grids in VTK's XML format (`.vtu`), for ParaView, PyVista and meshio.
//!
//! Arrays stand in the text itself, compressed in blocks by zlib and written in base64. Before the
//! blocks stands a header of 64-bit numbers, in base64 of its own: number of blocks, their size,
//! size of the last one if it is smaller (else 0), and the compressed size of each. See "VTK XML
//! Formats" in the VTK documentation.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use rayon::prelude::*;

use crate::atomic::write_whole;
use crate::error::ResultsError;
use crate::npy::Values;

mod array;
pub mod read;

pub use array::padded;
pub use array::{DataArray, Tuple};

/// Bytes of a block before compression; a multiple of every size of number.
const BLOCK: usize = 32_768;

/// A film writes many frames: the quickest. Numbers pack hardly better by others.
const LEVEL: Compression = Compression::fast();

/// Bytes of an array that one thread packs by itself.
const ALONE: usize = 1 << 20;

/// Kinds of cells, with VTK's number and order of corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellKind {
    /// Two ends.
    Line,
    /// Three corners.
    Triangle,
    /// Four corners, counter-clockwise.
    Quad,
    /// Four corners of the lower face counter-clockwise seen from above, then the upper face.
    Hexahedron,
}

impl CellKind {
    /// The cell of `dimension` directions: line, quad or hexahedron.
    ///
    /// # Panics
    /// For other dimensions.
    pub fn of_dimension(dimension: usize) -> Self {
        match dimension {
            1 => Self::Line,
            2 => Self::Quad,
            3 => Self::Hexahedron,
            _ => panic!("cells have 1, 2 or 3 dimensions"),
        }
    }

    /// Corners in VTK's order, each by whether it is at the upper end of x, y and z.
    pub fn corners(self) -> &'static [[bool; 3]] {
        const ALL: [[bool; 3]; 8] = [
            [false, false, false],
            [true, false, false],
            [true, true, false],
            [false, true, false],
            [false, false, true],
            [true, false, true],
            [true, true, true],
            [false, true, true],
        ];
        match self {
            Self::Line => &ALL[..2],
            Self::Triangle => &ALL[..3],
            Self::Quad => &ALL[..4],
            Self::Hexahedron => &ALL,
        }
    }

    /// The kind with VTK's number.
    fn of_code(code: u8) -> Option<Self> {
        let all = [Self::Line, Self::Triangle, Self::Quad, Self::Hexahedron];
        all.into_iter().find(|kind| kind.code() == code)
    }

    fn code(self) -> u8 {
        match self {
            Self::Line => 3,
            Self::Triangle => 5,
            Self::Quad => 9,
            Self::Hexahedron => 12,
        }
    }
}

/// Points, cells of one kind, and numbers on both.
#[derive(Clone, Debug, PartialEq)]
pub struct UnstructuredGrid {
    /// Points \[m\]; z = 0 in the plane.
    pub points: Vec<[f64; 3]>,
    /// Kind of every cell.
    pub kind: CellKind,
    /// Points of the cells, one cell after another.
    pub connectivity: Vec<usize>,
    /// Arrays with a tuple for each point.
    pub point_data: Vec<DataArray>,
    /// Arrays with a tuple for each cell.
    pub cell_data: Vec<DataArray>,
    /// Arrays of the whole, such as `TimeValue`.
    pub field_data: Vec<DataArray>,
}

impl UnstructuredGrid {
    /// Number of cells.
    pub fn cell_count(&self) -> usize {
        self.connectivity.len() / self.kind.corners().len()
    }

    /// Adds the time that ParaView shows: here the pseudo-time of the run, not seconds.
    #[must_use]
    pub fn at_time(mut self, time: f64) -> Self {
        self.field_data
            .push(DataArray::scalars("TimeValue", vec![time]));
        self
    }

    /// Writes the file, whole or not at all.
    ///
    /// # Errors
    /// [`ResultsError::File`].
    ///
    /// # Panics
    /// If an array does not have as many tuples as there are points or cells, or if a cell names a
    /// point that is not there.
    pub fn write(&self, path: &Path) -> Result<(), ResultsError> {
        write_whole(path, self.to_xml())
    }

    /// The file as text.
    ///
    /// # Panics
    /// As [`write`](Self::write).
    pub fn to_xml(&self) -> String {
        let (points, cells) = (self.points.len(), self.cell_count());
        let corners = self.kind.corners().len();
        assert_eq!(
            self.connectivity.len(),
            cells * corners,
            "cells are complete"
        );
        assert!(
            self.connectivity.iter().all(|&point| point < points),
            "cells are made of points that are there"
        );
        let mut text = String::from(
            "<?xml version=\"1.0\"?>\n\
             <VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" \
             header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n\
             <UnstructuredGrid>\n",
        );
        if !self.field_data.is_empty() {
            text.push_str("<FieldData>\n");
            for array in &self.field_data {
                push_array(&mut text, array, true);
            }
            text.push_str("</FieldData>\n");
        }
        let _ = writeln!(
            text,
            "<Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">"
        );
        for (name, arrays, tuples) in [
            ("PointData", &self.point_data, points),
            ("CellData", &self.cell_data, cells),
        ] {
            let _ = writeln!(text, "<{name}>");
            for array in arrays {
                assert_eq!(array.tuples(), tuples, "`{}` in {name}", array.name());
                push_array(&mut text, array, false);
            }
            let _ = writeln!(text, "</{name}>");
        }
        text.push_str("<Points>\n");
        push_array(
            &mut text,
            &DataArray::vectors("Points", &self.points),
            false,
        );
        text.push_str("</Points>\n<Cells>\n");
        let connectivity: Vec<u64> = self.connectivity.iter().map(|&k| k as u64).collect();
        let offsets: Vec<u64> = (1..=cells).map(|cell| (cell * corners) as u64).collect();
        for (name, values) in [("connectivity", connectivity), ("offsets", offsets)] {
            push_numbers(
                &mut text,
                "Int64",
                &format!("Name=\"{name}\""),
                &Values::U64(values),
            );
        }
        let types = Values::U8(vec![self.kind.code(); cells]);
        push_numbers(&mut text, "UInt8", "Name=\"types\"", &types);
        text.push_str("</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
        text
    }
}

fn push_array(text: &mut String, array: &DataArray, in_field_data: bool) {
    let mut attributes = format!("Name=\"{}\"", escaped(array.name()));
    // Readers differ on scalars that say they have one component.
    if array.components() > 1 {
        let _ = write!(attributes, " NumberOfComponents=\"{}\"", array.components());
    }
    for (k, name) in array.component_names().iter().enumerate() {
        let _ = write!(attributes, " ComponentName{k}=\"{}\"", escaped(name));
    }
    if in_field_data {
        let _ = write!(attributes, " NumberOfTuples=\"{}\"", array.tuples());
    }
    let kind = match array.values() {
        Values::F64(_) => "Float64",
        Values::U64(_) => "UInt64",
        Values::I32(_) => "Int32",
        Values::U8(_) => "UInt8",
    };
    push_numbers(text, kind, &attributes, array.values());
}

fn push_numbers(text: &mut String, kind: &str, attributes: &str, values: &Values) {
    // An empty array has no block, which not every reader understands: it is written as text.
    let format = if values.is_empty() { "ascii" } else { "binary" };
    let _ = writeln!(
        text,
        "<DataArray type=\"{kind}\" {attributes} format=\"{format}\">"
    );
    if !values.is_empty() {
        push_compressed(text, &values.to_bytes());
    }
    text.push_str("\n</DataArray>\n");
}

/// Header and blocks, as described above.
fn push_compressed(text: &mut String, bytes: &[u8]) {
    // Fewer blocks take less time than to wake a thread for some of them.
    let blocks: Vec<Vec<u8>> = if bytes.len() < ALONE {
        bytes.chunks(BLOCK).map(compressed).collect()
    } else {
        bytes.par_chunks(BLOCK).map(compressed).collect()
    };
    let header: Vec<u8> = [blocks.len(), BLOCK, bytes.len() % BLOCK]
        .into_iter()
        .chain(blocks.iter().map(Vec::len))
        .flat_map(|number| (number as u64).to_le_bytes())
        .collect();
    BASE64.encode_string(header, text);
    BASE64.encode_string(blocks.concat(), text);
}

fn compressed(block: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::with_capacity(block.len()), LEVEL);
    encoder
        .write_all(block)
        .and_then(|()| encoder.finish())
        .expect("invariant: writing to a Vec cannot fail")
}

/// A text as the value of an XML attribute.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests;
