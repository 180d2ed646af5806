//! The background grid of a case: two axes, each with equal cells or with lines where they are
//! wanted.

pub mod fitted;
pub mod lines;

use igimp_shape::{Axis, Grid, ShapeError};

/// A fixed background grid.
#[derive(Clone, Debug, PartialEq)]
pub struct GridSpec<const D: usize> {
    /// One axis for each direction.
    pub axes: [AxisSpec; D],
    /// Stiffness of particles in cells that several soils share.
    pub mixed_cells: MixedCells,
}

/// Stiffness of particles in cells that several soils share when the bodies are filled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MixedCells {
    /// Each has that of its own soil.
    #[default]
    Own,
    /// All have the inverse of the mean compliance of the cell, by volume.
    Mean,
}

/// One direction of the grid.
#[derive(Clone, Debug, PartialEq)]
pub enum AxisSpec {
    /// Cells of one size.
    Equal {
        /// Where the axis begins \[m\].
        lower: f64,
        /// Size of a cell \[m\].
        cell: f64,
        /// Number of cells.
        cells: usize,
    },
    /// Grid lines at these places, ascending, at least two \[m\].
    Lines(Vec<f64>),
}

impl<const D: usize> GridSpec<D> {
    /// A grid of equal cells: lower corner \[m\], size \[m\] and number of cells by direction.
    pub fn equal(lower: [f64; D], cell: [f64; D], cells: [usize; D]) -> Self {
        let axes = std::array::from_fn(|axis| AxisSpec::Equal {
            lower: lower[axis],
            cell: cell[axis],
            cells: cells[axis],
        });
        Self {
            axes,
            mixed_cells: MixedCells::Own,
        }
    }

    /// Corner of the lowest coordinates \[m\].
    pub fn lower(&self) -> [f64; D] {
        self.axes.each_ref().map(AxisSpec::lower)
    }

    /// Corner of the highest coordinates \[m\].
    pub fn upper(&self) -> [f64; D] {
        self.axes.each_ref().map(AxisSpec::upper)
    }

    /// Number of cells by direction.
    pub fn cells(&self) -> [usize; D] {
        self.axes.each_ref().map(AxisSpec::cells)
    }

    /// Size of the smallest cell by direction \[m\].
    pub fn smallest_cell(&self) -> [f64; D] {
        self.axes.each_ref().map(|axis| axis.extremes()[0])
    }

    /// Size of the largest cell by direction \[m\].
    pub fn largest_cell(&self) -> [f64; D] {
        self.axes.each_ref().map(|axis| axis.extremes()[1])
    }

    /// Size of the cell at a place, or of the one nearest to it \[m\].
    pub fn cell_at(&self, x: [f64; D]) -> [f64; D] {
        std::array::from_fn(|axis| self.axes[axis].cell_at(x[axis]))
    }

    /// Every cell divided in `n` equal parts in each direction.
    ///
    /// # Panics
    /// When `n` is zero.
    #[must_use]
    pub fn refined(&self, n: usize) -> Self {
        Self {
            axes: self.axes.each_ref().map(|axis| axis.refined(n)),
            mixed_cells: self.mixed_cells,
        }
    }

    /// The grid.
    ///
    /// # Errors
    /// [`ShapeError`] for cells that make no grid.
    pub fn grid(&self) -> Result<Grid<D>, ShapeError> {
        let first = self.axes[0].axis()?;
        let mut axes: [Axis; D] = std::array::from_fn(|_| first.clone());
        for (axis, spec) in std::iter::zip(&mut axes, &self.axes) {
            *axis = spec.axis()?;
        }
        Ok(Grid::new(axes))
    }
}

impl AxisSpec {
    /// Where the axis begins \[m\].
    pub fn lower(&self) -> f64 {
        match self {
            Self::Equal { lower, .. } => *lower,
            Self::Lines(lines) => lines.first().copied().unwrap_or(f64::NAN),
        }
    }

    /// Where the axis ends \[m\].
    pub fn upper(&self) -> f64 {
        match self {
            Self::Equal { lower, cell, cells } => lower + *cells as f64 * cell,
            Self::Lines(lines) => lines.last().copied().unwrap_or(f64::NAN),
        }
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        match self {
            Self::Equal { cells, .. } => *cells,
            Self::Lines(lines) => lines.len().saturating_sub(1),
        }
    }

    /// Distance of line `line` from the first one \[m\]. Beyond the last line, cells go on in the
    /// size of the last one.
    pub fn rise(&self, line: usize) -> f64 {
        match self {
            Self::Equal { cell, .. } => line as f64 * cell,
            Self::Lines(lines) => {
                let known = line.min(lines.len().saturating_sub(1));
                let beyond = (line - known) as f64;
                lines.get(known).copied().unwrap_or(f64::NAN) - self.lower()
                    + beyond * self.last_cell()
            }
        }
    }

    /// The grid lines \[m\].
    pub fn lines(&self) -> impl Iterator<Item = f64> {
        (0..=self.cells()).map(|line| match self {
            Self::Equal { lower, cell, .. } => lower + line as f64 * cell,
            Self::Lines(lines) => lines[line],
        })
    }

    /// The number of the line at a place \[m\], with a fraction between lines; cells go on beyond
    /// both ends.
    pub fn place(&self, x: f64) -> f64 {
        match self {
            Self::Equal { lower, cell, .. } => (x - lower) / cell,
            Self::Lines(lines) => {
                let cell = cell_holding(lines, x);
                cell as f64 + (x - lines[cell]) / (lines[cell + 1] - lines[cell])
            }
        }
    }

    /// Size of the cell at a place, or of the one nearest to it \[m\].
    pub fn cell_at(&self, x: f64) -> f64 {
        match self {
            Self::Equal { cell, .. } => *cell,
            Self::Lines(lines) => {
                let cell = cell_holding(lines, x);
                lines[cell + 1] - lines[cell]
            }
        }
    }

    /// Size of the last cell \[m\].
    pub fn last_cell(&self) -> f64 {
        self.cell_at(f64::INFINITY)
    }

    /// Sizes of the smallest and of the largest cell \[m\].
    pub fn extremes(&self) -> [f64; 2] {
        match self {
            Self::Equal { cell, .. } => [*cell; 2],
            Self::Lines(lines) => {
                let sizes = || lines.windows(2).map(|pair| pair[1] - pair[0]);
                [
                    sizes().fold(f64::INFINITY, f64::min),
                    sizes().fold(0.0, f64::max),
                ]
            }
        }
    }

    /// Size of the smallest cell that an interval reaches into \[m\].
    pub fn smallest_between(&self, from: f64, to: f64) -> f64 {
        match self {
            Self::Equal { cell, .. } => *cell,
            Self::Lines(lines) => {
                let (first, last) = (
                    cell_holding(lines, from.min(to)),
                    cell_holding(lines, from.max(to)),
                );
                (first..=last)
                    .map(|cell| lines[cell + 1] - lines[cell])
                    .fold(f64::INFINITY, f64::min)
            }
        }
    }

    fn refined(&self, n: usize) -> Self {
        assert!(n > 0, "a cell is divided in one part at least");
        match self {
            Self::Equal { lower, cell, cells } => Self::Equal {
                lower: *lower,
                cell: cell / n as f64,
                cells: cells * n,
            },
            Self::Lines(lines) => {
                let parts = lines.windows(2).flat_map(|pair| {
                    let size = pair[1] - pair[0];
                    (0..n).map(move |k| pair[0] + size * k as f64 / n as f64)
                });
                Self::Lines(parts.chain(lines.last().copied()).collect())
            }
        }
    }

    /// The axis.
    ///
    /// # Errors
    /// [`ShapeError`] for lines that make no axis.
    pub fn axis(&self) -> Result<Axis, ShapeError> {
        match self {
            Self::Equal { lower, cell, cells } => Axis::uniform(*lower, *cell, *cells),
            Self::Lines(lines) => Axis::from_nodes(lines.clone()),
        }
    }
}

/// The cell that holds a place; the first or the last one for places beyond.
fn cell_holding(lines: &[f64], x: f64) -> usize {
    let above = lines.partition_point(|&line| line <= x);
    above.clamp(1, lines.len().max(2) - 1) - 1
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_cmp, reason = "lines are handed out as they came in")]

    use super::*;

    fn graded() -> AxisSpec {
        AxisSpec::Lines(vec![-1.0, 0.0, 2.0, 2.5])
    }

    #[test]
    fn lines_have_places() {
        let axis = graded();
        assert_eq!((axis.lower(), axis.upper(), axis.cells()), (-1.0, 2.5, 3));
        for (x, place) in [
            (-1.0, 0.0),
            (1.0, 1.5),
            (2.0, 2.0),
            (2.5, 3.0),
            (3.0, 4.0),
            (-2.0, -1.0),
        ] {
            assert_eq!(axis.place(x), place);
        }
        assert_eq!(
            [0, 2, 3, 5].map(|line| axis.rise(line)),
            [0.0, 3.0, 3.5, 4.5]
        );
        assert_eq!(axis.extremes(), [0.5, 2.0]);
        assert_eq!(
            [-3.0, 0.0, 2.4, 9.0].map(|x| axis.cell_at(x)),
            [1.0, 2.0, 0.5, 0.5]
        );
        assert_eq!(axis.smallest_between(1.5, -0.5), 1.0);
        assert_eq!(axis.axis().unwrap().nodes(), [-1.0, 0.0, 2.0, 2.5]);
    }

    #[test]
    fn equal_cells_are_the_same_either_way() {
        let equal = AxisSpec::Equal {
            lower: -1.0,
            cell: 0.25,
            cells: 10,
        };
        let lines = AxisSpec::Lines(equal.lines().collect());
        for x in [-1.3, -1.0, 0.1, 1.5, 2.0] {
            assert_eq!(equal.place(x), lines.place(x));
        }
        assert_eq!(equal.axis().unwrap(), lines.axis().unwrap());
        assert_eq!(equal.upper(), lines.upper());
        assert_eq!(equal.rise(13), lines.rise(13));
    }

    #[test]
    fn refined_cells_keep_every_line() {
        let grid = GridSpec {
            axes: [
                graded(),
                AxisSpec::Equal {
                    lower: 0.0,
                    cell: 1.0,
                    cells: 3,
                },
            ],
            mixed_cells: MixedCells::Mean,
        };
        let finer = grid.refined(2);
        assert_eq!(finer.cells(), [6, 6]);
        assert_eq!(
            finer.axes[0],
            AxisSpec::Lines(vec![-1.0, -0.5, 0.0, 1.0, 2.0, 2.25, 2.5])
        );
        assert_eq!(finer.smallest_cell(), [0.25, 0.5]);
        assert_eq!((finer.lower(), finer.upper()), (grid.lower(), grid.upper()));
        assert_eq!(grid.refined(1), grid);
    }
}
