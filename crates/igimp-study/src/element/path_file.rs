//! A path from a CSV file: a column a component, a row the end of a leg.

use std::path::Path;

use igimp_results::ResultsError;
use igimp_results::tables::rows;
use igimp_solver::element::{COMPONENTS, Control, ElementPath};
use thiserror::Error;

use super::measure::factor;

/// The names of the components.
const NAMES: [&str; COMPONENTS] = ["xx", "yy", "zz", "xy"];

/// Why a file states no path.
#[derive(Debug, Error)]
pub enum PathFileError {
    /// It cannot be read.
    #[error(transparent)]
    File(#[from] ResultsError),
    /// A column that is none of a path.
    #[error("`{column}` is no column of a path")]
    Column {
        /// Its header.
        column: String,
    },
    /// A component that is not prescribed, or twice.
    #[error("`{component}` has to be prescribed once, as a strain or as a stress")]
    Component {
        /// Its name.
        component: &'static str,
    },
    /// No rows.
    #[error("the path has no row")]
    Empty,
}

impl PathFileError {
    /// Help with the file.
    pub fn help(&self) -> &'static str {
        match self {
            Self::File(_) => "numbers with a decimal point, separated by commas",
            Self::Column { .. } => {
                "columns are strain_xx [%] or stress_xx [kPa], and the same of yy, zz and xy; compression is positive"
            }
            Self::Component { .. } => {
                "zz strains as xx, and xy not at all, where they have no column"
            }
            Self::Empty => "a row is the end of a leg; the first leg begins at the initial state",
        }
    }
}

/// Reads a path: columns `strain_xx [%]` or `stress_xx [kPa]` and the same of yy, zz and xy, compression positive. Without a column zz
/// strains as xx does, and xy not at all.
///
/// # Errors
/// [`PathFileError`].
pub fn read_path(path: &Path) -> Result<ElementPath, PathFileError> {
    let table = rows::read(path)?;
    let mut columns: [Option<(usize, Control, f64)>; COMPONENTS] = [None; COMPONENTS];
    for (place, header) in table.header.iter().enumerate() {
        let (component, control, factor) = column(header).ok_or_else(|| PathFileError::Column {
            column: header.clone(),
        })?;
        if columns[component].is_some() {
            return Err(PathFileError::Component {
                component: NAMES[component],
            });
        }
        columns[component] = Some((place, control, factor));
    }
    for component in [0, 1] {
        if columns[component].is_none() {
            return Err(PathFileError::Component {
                component: NAMES[component],
            });
        }
    }
    if table.rows.is_empty() {
        return Err(PathFileError::Empty);
    }
    let without = [
        Control::Strain,
        Control::Strain,
        Control::AsXx,
        Control::Strain,
    ];
    Ok(ElementPath {
        controls: std::array::from_fn(|c| columns[c].map_or(without[c], |(_, control, _)| control)),
        legs: (table.rows.iter())
            .map(|row| {
                std::array::from_fn(|c| {
                    columns[c].map_or(0.0, |(place, _, factor)| factor * row[place])
                })
            })
            .collect(),
    })
}

/// Component, control and factor to strain or pascal, extension positive, of a header such as `stress_xx [kPa]`.
fn column(header: &str) -> Option<(usize, Control, f64)> {
    let (name, unit) = header.trim().strip_suffix(']')?.split_once('[')?;
    let (kind, component) = name.trim().rsplit_once('_')?;
    let component = NAMES.iter().position(|known| *known == component)?;
    let control = match kind {
        "strain" => Control::Strain,
        "stress" => Control::Stress,
        _ => return None,
    };
    let scale = factor(control == Control::Stress, unit)?;
    // Shear has the sign that it has inside.
    let sign = if component < 3 { -1.0 } else { 1.0 };
    Some((component, control, sign * scale))
}
