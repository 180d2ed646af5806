//! Why a region cannot be filled with particles.

/// Errors of seeding a body.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SeedError {
    /// A body reaches beyond the grid.
    #[error("the body reaches {}, outside the grid domain", place(corner))]
    OutsideGrid {
        /// The corner \[length\].
        corner: Vec<f64>,
    },
    /// A body has no volume.
    #[error("the body is empty: it has no volume on the grid")]
    EmptyBody,
    /// The same of a body that has a name.
    #[error("the body `{name}` is empty: it has no volume on the grid")]
    Empty {
        /// Its name.
        name: String,
    },
}

impl SeedError {
    /// The same error of a body that has a name.
    #[must_use]
    pub fn of_body(self, name: &str) -> Self {
        match self {
            Self::EmptyBody => Self::Empty { name: name.into() },
            other => other,
        }
    }
}

/// A point in a message.
fn place(point: &[f64]) -> String {
    let numbers: Vec<String> = point.iter().map(f64::to_string).collect();
    format!("({}) m", numbers.join(", "))
}
