//! Linear systems of a run, as files for other solvers: a folder for each.
//!
//! | file | type, shape | holds |
//! |---|---|---|
//! | `col_ptr.npy` | u8, n + 1 | start of each column in the next two |
//! | `row_idx.npy` | i4, stored | row of each entry, from 0, ascending within a column |
//! | `values.npy` | f8, stored | K, both halves \[N/m per m\] |
//! | `rhs.npy` | f8, n | right-hand side: the out-of-balance force \[N/m\] |
//! | `solution.npy` | f8, n | the correction that the run found \[m\] |
//! | `places.npy` | i4, n × 4 | place of the unknown's node on the grid by axis, the third 0 in the plane, and the component: 0 for x, 1 for y, 2 for z |
//! | `matrix.json` | | the kind of system ([`About`]) |

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use igimp_assembly::Constraints;
use igimp_linear::{Border, NodeBlock, Pattern, SolvedSystem, TangentMatrix};
use igimp_shape::Grid;
use serde::{Deserialize, Serialize};

use super::npy::{Array, Values};
use crate::atomic::{at, write_atomically};
use crate::error::ResultsError;

/// File of the kind of system; written last.
const ABOUT: &str = "matrix.json";
const ARRAYS: [&str; 6] = [
    "col_ptr.npy",
    "row_idx.npy",
    "values.npy",
    "rhs.npy",
    "solution.npy",
    "places.npy",
];

/// The description of a system, as written to `matrix.json`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct About {
    /// `igimp` and its version.
    pub program: String,
    /// Title of the case.
    pub case: String,
    /// Name of the stage.
    pub stage: String,
    /// Number of the stage, from 1.
    pub stage_number: usize,
    /// Number of the step in its stage, from 1; in a strength reduction over all trials.
    pub step: usize,
    /// Number of the correction in its step, from 1: the first has the elastic tangent, all others
    /// the consistent one.
    pub correction: usize,
    /// Unknowns n.
    pub unknowns: usize,
    /// Stored entries of both halves.
    pub stored: usize,
    /// Whether K is symmetric by the laws of the case.
    pub symmetric: bool,
    /// Largest distance, in nodes along one axis, between two coupled nodes.
    pub reach: usize,
}

/// A linear system K x = b with the solution of the run, in compressed sparse columns.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearSystem {
    /// Its description.
    pub about: About,
    /// Start of each column, length unknowns + 1.
    pub col_ptr: Vec<u64>,
    /// Row of each stored entry.
    pub row_idx: Vec<i32>,
    /// Stored values of K \[N/m per m\].
    pub values: Vec<f64>,
    /// b, the out-of-balance force \[N/m\].
    pub rhs: Vec<f64>,
    /// x, the correction \[m\].
    pub solution: Vec<f64>,
    /// Column and row of each unknown's node on the grid, and its component.
    pub places: Vec<[i32; 4]>,
}

impl LinearSystem {
    /// The system that a solver has solved for a step with this grid and these constraints.
    /// `about` gets the numbers that the matrix tells.
    pub fn of<const D: usize>(
        solved: SolvedSystem,
        grid: &Grid<D>,
        constraints: &Constraints<D>,
        about: About,
    ) -> Self {
        let matrix = solved.matrix;
        let pattern = &matrix.pattern;
        let columns = pattern.compressed_columns();
        let mut places = Vec::with_capacity(pattern.unknowns());
        for block in &pattern.blocks {
            let place = block.place.map(|along| along as i32);
            let node = grid.node_index(std::array::from_fn(|axis| block.place[axis]));
            let free = (0..D).filter(|&axis| constraints.of(node, axis).is_none());
            places.extend(free.map(|axis| [place[0], place[1], place[2], axis as i32]));
        }
        Self {
            about: About {
                correction: solved.number,
                unknowns: pattern.unknowns(),
                stored: pattern.stored(),
                symmetric: matrix.symmetric,
                reach: pattern.reach,
                ..about
            },
            col_ptr: columns.col_ptr.iter().map(|&start| start as u64).collect(),
            row_idx: columns.row_idx.iter().map(|&row| row as i32).collect(),
            values: matrix.values,
            rhs: solved.rhs,
            solution: solved.solution,
            places,
        }
    }

    /// The matrix, as solvers of the workspace take it.
    ///
    /// # Errors
    /// A sentence that says which array contradicts another.
    pub fn matrix(&self) -> Result<TangentMatrix, &'static str> {
        let unknowns = self.places.len();
        let stored = self.values.len();
        if self.col_ptr.len() != unknowns + 1 || self.row_idx.len() != stored {
            return Err("the lengths of the arrays do not fit");
        }
        let is_row = |&row: &i32| usize::try_from(row).is_ok_and(|row| row < unknowns);
        if !self.row_idx.iter().all(is_row) {
            return Err("a row is outside the matrix");
        }
        if self.places.iter().flatten().any(|&place| place < 0) {
            return Err("a place is outside the grid");
        }
        let ends = (self.col_ptr[0], self.col_ptr[unknowns]);
        if ends != (0, stored as u64) || !self.col_ptr.is_sorted() {
            return Err("the starts of the columns do not fit the values");
        }
        let mut blocks: Vec<NodeBlock> = Vec::new();
        for (unknown, place) in self.places.iter().enumerate() {
            let [x, y, z, component] = place.map(|index| index as usize);
            let place = [x, y, z];
            let component = 1_u8.checked_shl(component as u32).unwrap_or(0);
            match blocks.last_mut() {
                Some(block) if block.place == place => {
                    block.len += 1;
                    block.free |= component;
                }
                _ => blocks.push(NodeBlock {
                    first: unknown,
                    len: 1,
                    free: component,
                    place,
                }),
            }
        }
        let (mut starts, mut coupled) = (vec![0], Vec::new());
        for block in &blocks {
            let rows = self.col_ptr[block.first] as usize..self.col_ptr[block.first + 1] as usize;
            let block_of =
                |row: &i32| blocks.partition_point(|block| block.first <= *row as usize) - 1;
            let mut neighbours: Vec<u32> = self.row_idx[rows]
                .iter()
                .map(|row| block_of(row) as u32)
                .collect();
            neighbours.sort_unstable();
            neighbours.dedup();
            coupled.extend(neighbours);
            starts.push(coupled.len());
        }
        let pattern = Pattern::new(blocks, starts, coupled, self.about.reach);
        let columns = pattern.compressed_columns();
        let same_rows =
            std::iter::zip(&columns.row_idx, &self.row_idx).all(|(&a, &b)| a == b as usize);
        if columns.row_idx.len() != stored || !same_rows {
            return Err("the rows are not those of whole nodes");
        }
        Ok(TangentMatrix {
            pattern: Arc::new(pattern),
            values: self.values.clone(),
            symmetric: self.about.symmetric,
            border: Border::default(),
        })
    }

    /// Writes the files of the system into a folder, which is made; one of the same name is
    /// replaced.
    ///
    /// # Errors
    /// [`ResultsError::File`].
    ///
    /// # Panics
    /// If the arrays are not as long as each other says.
    pub fn write(self, folder: &Path) -> Result<(), ResultsError> {
        fs::create_dir_all(folder).map_err(at(folder))?;
        remove_if_there(&folder.join(ABOUT))?;
        let (n, stored) = (self.places.len(), self.values.len());
        let arrays = [
            Array::new(&[n + 1], Values::U64(self.col_ptr)),
            Array::new(&[stored], Values::I32(self.row_idx)),
            Array::new(&[stored], Values::F64(self.values)),
            Array::new(&[n], Values::F64(self.rhs)),
            Array::new(&[n], Values::F64(self.solution)),
            Array::new(&[n, 4], Values::I32(self.places.concat())),
        ];
        for (name, array) in std::iter::zip(ARRAYS, arrays) {
            array.write(&folder.join(name))?;
        }
        let about = serde_json::to_string_pretty(&self.about).expect("strings and numbers");
        write_atomically(&folder.join(ABOUT), about + "\n")
    }

    /// Reads the files of a system.
    ///
    /// # Errors
    /// [`ResultsError::File`], [`ResultsError::Npy`], or [`ResultsError::Unusable`] for files that are of
    /// another kind.
    pub fn read(folder: &Path) -> Result<Self, ResultsError> {
        let path = folder.join(ABOUT);
        let text = fs::read(&path).map_err(at(&path))?;
        let about = serde_json::from_slice(&text).map_err(|error| ResultsError::Unusable {
            path,
            why: error.to_string(),
        })?;
        let places = integers(folder.join("places.npy"))?;
        Ok(Self {
            about,
            col_ptr: match array(folder.join("col_ptr.npy"))? {
                (_, Values::U64(values)) => values,
                (path, _) => return Err(other_type(path)),
            },
            row_idx: integers(folder.join("row_idx.npy"))?,
            values: reals(folder.join("values.npy"))?,
            rhs: reals(folder.join("rhs.npy"))?,
            solution: reals(folder.join("solution.npy"))?,
            places: places.as_chunks().0.to_vec(),
        })
    }
}

/// Removes the system that igimp wrote into a folder, and the folder if nothing else is in it.
///
/// # Errors
/// [`ResultsError::File`].
pub fn remove(folder: &Path) -> Result<(), ResultsError> {
    if !folder.join(ABOUT).is_file() {
        return Ok(());
    }
    for name in ARRAYS.into_iter().chain([ABOUT]) {
        remove_if_there(&folder.join(name))?;
    }
    if fs::read_dir(folder).map_err(at(folder))?.next().is_none() {
        fs::remove_dir(folder).map_err(at(folder))?;
    }
    Ok(())
}

fn remove_if_there(path: &Path) -> Result<(), ResultsError> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(()),
        result => result.map_err(at(path)),
    }
}

fn array(path: PathBuf) -> Result<(PathBuf, Values), ResultsError> {
    let values = Array::read(&path)?.values().clone();
    Ok((path, values))
}

fn reals(path: PathBuf) -> Result<Vec<f64>, ResultsError> {
    match array(path)? {
        (_, Values::F64(values)) => Ok(values),
        (path, _) => Err(other_type(path)),
    }
}

fn integers(path: PathBuf) -> Result<Vec<i32>, ResultsError> {
    match array(path)? {
        (_, Values::I32(values)) => Ok(values),
        (path, _) => Err(other_type(path)),
    }
}

fn other_type(path: PathBuf) -> ResultsError {
    ResultsError::Unusable {
        path,
        why: "its numbers are of another type".to_owned(),
    }
}
