//! Errors on the grid, as data.

/// Why an [`Axis`](crate::Axis) or a list of supports could not be made.
///
/// Every variant carries the offending numbers; lengths are in the caller's length unit. `axis`
/// is the direction (0 = x); functions that see a single [`Axis`](crate::Axis) say 0.
#[derive(thiserror::Error, Debug, Clone, PartialEq)]
pub enum ShapeError {
    /// An axis needs at least one cell, hence two nodes.
    #[error("an axis needs at least 2 nodes (1 cell), got {nodes}")]
    EmptyAxis {
        /// Number of nodes given.
        nodes: usize,
    },
    /// The cell size of a uniform axis is zero, negative, infinite or not a number.
    #[error("`spacing` = {spacing} must be positive and finite")]
    InvalidSpacing {
        /// Cell size given \[length\].
        spacing: f64,
    },
    /// A node coordinate is infinite or not a number.
    #[error("`nodes[{index}]` = {node} must be finite")]
    NotFinite {
        /// Number of the node along the axis.
        index: usize,
        /// Its coordinate \[length\].
        node: f64,
    },
    /// A node does not lie beyond its predecessor by more than the round-off of the coordinates.
    #[error(
        "`nodes[{index}]` = {node} must exceed its predecessor {previous} by more than round-off"
    )]
    NotIncreasing {
        /// Number of the node along the axis.
        index: usize,
        /// Coordinate of the node before it \[length\].
        previous: f64,
        /// Its coordinate \[length\].
        node: f64,
    },
    /// The centre of a particle is outside the grid, or not a number.
    #[error("axis {axis}: particle centre `x` = {x} is outside the grid [{start}, {end}]")]
    OutsideGrid {
        /// Direction, 0 = x.
        axis: usize,
        /// Coordinate of the particle's centre \[length\].
        x: f64,
        /// First node of the axis \[length\].
        start: f64,
        /// Last node of the axis \[length\].
        end: f64,
    },
    /// A half-length of a particle's domain is negative, infinite or not a number.
    #[error("axis {axis}: `half_length` = {half_length} must be finite and not negative")]
    InvalidHalfLength {
        /// Direction, 0 = x.
        axis: usize,
        /// Half-length given \[length\].
        half_length: f64,
    },
}

impl ShapeError {
    /// The same error, for direction `direction` of a grid.
    pub(crate) fn on_axis(mut self, direction: usize) -> Self {
        if let Self::OutsideGrid { axis, .. } | Self::InvalidHalfLength { axis, .. } = &mut self {
            *axis = direction;
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::ShapeError::{self, *};

    #[test]
    fn messages_name_the_field_and_its_value() {
        let cases: [(ShapeError, &str); 6] = [
            (
                EmptyAxis { nodes: 1 },
                "an axis needs at least 2 nodes (1 cell), got 1",
            ),
            (
                InvalidSpacing { spacing: -0.5 },
                "`spacing` = -0.5 must be positive and finite",
            ),
            (
                NotFinite {
                    index: 3,
                    node: f64::NAN,
                },
                "`nodes[3]` = NaN must be finite",
            ),
            (
                NotIncreasing {
                    index: 2,
                    previous: 1.5,
                    node: 1.0,
                },
                "`nodes[2]` = 1 must exceed its predecessor 1.5 by more than round-off",
            ),
            (
                OutsideGrid {
                    axis: 0,
                    x: 3.0,
                    start: 0.0,
                    end: 2.0,
                }
                .on_axis(1),
                "axis 1: particle centre `x` = 3 is outside the grid [0, 2]",
            ),
            (
                InvalidHalfLength {
                    axis: 0,
                    half_length: -1e-3,
                }
                .on_axis(2),
                "axis 2: `half_length` = -0.001 must be finite and not negative",
            ),
        ];
        for (error, message) in cases {
            assert_eq!(error.to_string(), message);
        }
    }
}
