//! Arrays in NumPy's format `.npy`, version 1.0: little endian, rows first (C order).
//!
//! A file is `\x93NUMPY`, two bytes of version, the length of the header in two bytes, the header
//! (a Python literal such as `{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2), }`, padded
//! with blanks so that the numbers begin at a multiple of 64 bytes), and the numbers.

use std::path::Path;

use crate::atomic::{at, write_atomically};
use crate::error::ResultsError;

mod header;

use crate::error::NpyError;
use header::Header;

/// An array of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    shape: Vec<usize>,
    values: Values,
}

/// Its numbers, the last index fastest.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// `<f8`.
    F64(Vec<f64>),
    /// `<u8`.
    U64(Vec<u64>),
    /// `<i4`.
    I32(Vec<i32>),
    /// `|u1`.
    U8(Vec<u8>),
}

impl Values {
    /// Number of values.
    pub fn len(&self) -> usize {
        match self {
            Self::F64(values) => values.len(),
            Self::U64(values) => values.len(),
            Self::I32(values) => values.len(),
            Self::U8(values) => values.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn descr(&self) -> &'static str {
        match self {
            Self::F64(_) => "<f8",
            Self::U64(_) => "<u8",
            Self::I32(_) => "<i4",
            Self::U8(_) => "|u1",
        }
    }

    /// Little-endian bytes.
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        match self {
            Self::F64(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Self::U64(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Self::I32(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Self::U8(values) => values.clone(),
        }
    }
}

impl Array {
    /// An array of a shape.
    ///
    /// # Panics
    /// If the shape does not have as many entries as there are values.
    pub fn new(shape: &[usize], values: Values) -> Self {
        assert_eq!(
            shape.iter().product::<usize>(),
            values.len(),
            "an array has as many values as its shape says"
        );
        Self {
            shape: shape.to_vec(),
            values,
        }
    }

    /// Length by index.
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// The numbers, the last index fastest, handed over.
    pub fn into_values(self) -> Values {
        self.values
    }

    /// The numbers, the last index fastest.
    pub fn values(&self) -> &Values {
        &self.values
    }

    /// The array as the bytes of a file.
    pub fn to_bytes(&self) -> Vec<u8> {
        let header = Header {
            descr: self.values.descr().to_owned(),
            fortran_order: false,
            shape: self.shape.clone(),
        };
        let mut bytes = header.to_bytes();
        bytes.extend(self.values.to_bytes());
        bytes
    }

    /// The array in the bytes of a file.
    ///
    /// Reserves no more memory than the bytes take.
    ///
    /// # Errors
    /// [`NpyError`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, NpyError> {
        let (header, bytes) = Header::from_bytes(bytes)?;
        if header.fortran_order {
            return Err(NpyError::FortranOrder);
        }
        let size = match header.descr.as_str() {
            "<f8" | "<u8" => 8,
            "<i4" => 4,
            "|u1" => 1,
            _ => {
                return Err(NpyError::Type {
                    descr: header.descr,
                });
            }
        };
        let length = header
            .shape
            .iter()
            .try_fold(size, |product: usize, &count| product.checked_mul(count));
        if length != Some(bytes.len()) {
            return Err(NpyError::Length {
                shape: header.shape,
                bytes: bytes.len(),
            });
        }
        let values = match header.descr.as_str() {
            "<f8" => Values::F64(numbers(bytes, f64::from_le_bytes)),
            "<u8" => Values::U64(numbers(bytes, u64::from_le_bytes)),
            "<i4" => Values::I32(numbers(bytes, i32::from_le_bytes)),
            _ => Values::U8(bytes.to_vec()),
        };
        Ok(Self {
            shape: header.shape,
            values,
        })
    }

    /// Writes a file, whole or not at all.
    ///
    /// # Errors
    /// [`ResultsError::File`].
    pub fn write(&self, path: &Path) -> Result<(), ResultsError> {
        write_atomically(path, self.to_bytes())
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`ResultsError::File`], [`ResultsError::Npy`].
    pub fn read(path: &Path) -> Result<Self, ResultsError> {
        let bytes = std::fs::read(path).map_err(at(path))?;
        Self::from_bytes(&bytes).map_err(|source| ResultsError::Npy {
            path: path.to_path_buf(),
            source,
        })
    }
}

fn numbers<const N: usize, T>(bytes: &[u8], number: fn([u8; N]) -> T) -> Vec<T> {
    let (chunks, _) = bytes.as_chunks::<N>();
    chunks.iter().map(|chunk| number(*chunk)).collect()
}

#[cfg(test)]
mod tests;
