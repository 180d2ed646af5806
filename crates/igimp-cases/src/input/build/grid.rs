//! The grid and the variant of the method.

use std::sync::Arc;

use igimp_assembly::{DomainUpdate, Geometry, Kinematics, Locking, Method, Remedy, SmallCuts};
use igimp_shape::{Basis, Gimp, Linear};

use crate::case::GridSpec;
use crate::input::diagnostic::Problems;
use crate::input::text::{count, number};
use crate::input::tree::Node;

/// Most cells, and most particles.
pub(super) const MOST: f64 = 5e7;

/// Extent of the grid and size of its cells as written \[m\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// Lower left corner.
    pub(super) lower: [f64; 2],
    /// Upper right corner.
    pub(super) upper: [f64; 2],
    /// Size of a cell.
    pub(super) cell: [f64; 2],
}

/// The frame, if its numbers make sense.
pub(super) fn frame(tree: &Node, problems: &mut Problems) -> Option<Frame> {
    let grid = tree.get("grid")?;
    let cell = match grid.get("cell")? {
        table if table.get("x").is_some() => [table.number_at("x")?, table.number_at("y")?],
        one => [one.number()?; 2],
    };
    let domain = grid.get("domain")?;
    let mut frame = Frame {
        lower: [0.0; 2],
        upper: [0.0; 2],
        cell,
    };
    let mut is_right = true;
    for (axis, key) in ["x", "y"].into_iter().enumerate() {
        let [from, to] = domain.pair_at(key)?;
        (frame.lower[axis], frame.upper[axis]) = (from, to);
        if from >= to || !(to - from).is_finite() {
            problems
                .error(
                    domain.place_at(key),
                    format!("the domain in {key} has no extent"),
                )
                .help("write the lower end first");
            is_right = false;
        }
    }
    is_right.then_some(frame)
}

/// The grid; reports a domain that is not a whole number of cells, and too many cells.
pub(super) fn grid(tree: &Node, frame: Option<Frame>, problems: &mut Problems) -> Option<GridSpec> {
    let node = tree.get("grid")?;
    let domain = node.get("domain")?;
    let Frame { lower, upper, cell } = frame?;
    let extent = [upper[0] - lower[0], upper[1] - lower[1]];
    let cells = [extent[0] / cell[0], extent[1] / cell[1]];
    let total = cells[0].max(1.0) * cells[1].max(1.0);
    if total.is_nan() || total > MOST {
        problems
            .error(
                node.place_at("cell"),
                format!("the grid would have {} cells", count(total)),
            )
            .help(format!(
                "at most {} are possible: use larger cells or a smaller domain",
                count(MOST)
            ));
        return None;
    }
    let mut is_right = true;
    for (axis, key) in ["x", "y"].into_iter().enumerate() {
        if cell[axis] < 1e-9 * lower[axis].abs().max(upper[axis].abs()) {
            problems
                .error(
                    domain.place_at(key),
                    format!("the coordinates in {key} are too large for cells this small"),
                )
                .help("move the origin to the model");
            is_right = false;
            continue;
        }
        let whole = cells[axis].round().max(1.0);
        if (cells[axis] - whole).abs() > 1e-6 {
            let end = number(lower[axis] + whole * cell[axis]);
            let size = number(extent[axis] / whole);
            problems
                .error(
                    domain.place_at(key),
                    format!(
                        "the domain in {key} is not a whole number of cells: {} m / {} m = {}",
                        number(extent[axis]),
                        number(cell[axis]),
                        number(cells[axis])
                    ),
                )
                .help(format!(
                    "the nearest that is: {key} = [\"{} m\", \"{end} m\"], or a cell of {size} m",
                    number(lower[axis])
                ));
            is_right = false;
        }
    }
    let whole = cells.map(|cells| cells.round().max(1.0));
    is_right.then(|| GridSpec {
        // The cell that fits, to the last digit.
        cell: [extent[0] / whole[0], extent[1] / whole[1]],
        lower,
        cells: whole.map(|cells| cells as usize),
    })
}

/// The variant of the method.
pub(super) fn method(tree: &Node) -> Option<Method> {
    let grid = tree.get("grid")?;
    let cuts = grid.get("small_cuts")?;
    let basis: Arc<dyn Basis> = match grid.text_at("basis")? {
        "linear" => Arc::new(Linear),
        _ => Arc::new(Gimp),
    };
    Some(Method {
        basis,
        locking: match grid.text_at("locking")? {
            "none" => Locking::None,
            "shared-strain" => Locking::SharedStrain,
            _ => Locking::BBar,
        },
        geometry: Geometry::Moving,
        kinematics: match grid.text_at("kinematics")? {
            "small" => Kinematics::SmallStrain,
            _ => Kinematics::FiniteStrain,
        },
        domain_update: match grid.text_at("domain_update")? {
            "fixed" => DomainUpdate::Fixed,
            "diagonal-f" => DomainUpdate::DiagonalF,
            "root-j" => DomainUpdate::RootJ,
            _ => DomainUpdate::DiagonalU,
        },
        small_cuts: SmallCuts {
            below: cuts.number_at("below")?,
            remedy: match cuts.text_at("remedy")? {
                "drop" => Remedy::Drop,
                _ => Remedy::Tie,
            },
            ghost_penalty: cuts.number_at("ghost_penalty")?,
        },
    })
}
