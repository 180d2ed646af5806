//! Outside values, from the tables in `validation/reference`.

/// A table of outside values: a comment with its source, a header, rows of numbers.
pub(crate) struct Reference {
    header: Vec<&'static str>,
    rows: Vec<Vec<f64>>,
}

impl Reference {
    /// Parses a table.
    ///
    /// # Panics
    /// If the table is not made of numbers: the tables are part of the program.
    fn parse(text: &'static str) -> Self {
        let mut lines = text
            .lines()
            .filter(|line| !line.starts_with('#') && !line.is_empty());
        let header = lines
            .next()
            .expect("a table has a header")
            .split(',')
            .collect();
        let rows = lines
            .map(|line| {
                line.split(',')
                    .map(|entry| entry.trim().parse().expect("a table holds numbers"))
                    .collect()
            })
            .collect();
        Self { header, rows }
    }

    /// All rows, for a table of this many columns.
    ///
    /// # Panics
    /// If the table has another number of columns.
    pub(crate) fn rows<const N: usize>(&self) -> Vec<[f64; N]> {
        let rows = self.rows.iter();
        rows.map(|row| row[..].try_into().expect("the table has these columns"))
            .collect()
    }

    /// Two columns as points.
    ///
    /// # Panics
    /// If there is no such column.
    pub(crate) fn points(&self, x: &str, y: &str) -> Vec<[f64; 2]> {
        let column = |name: &str| {
            self.header
                .iter()
                .position(|&column| column == name)
                .unwrap_or_else(|| panic!("no column `{name}`"))
        };
        let (x, y) = (column(x), column(y));
        self.rows
            .iter()
            .map(|row| [row[x], row[y]])
            .filter(|p| p[1].is_finite())
            .collect()
    }
}

/// The value of a curve at `x`, linear between its points; not a number beyond its ends.
pub(crate) fn interpolate(points: &[[f64; 2]], x: f64) -> f64 {
    points
        .windows(2)
        .find(|pair| pair[0][0] <= x && x <= pair[1][0] + 1e-12)
        .map_or(f64::NAN, |pair| {
            let t = (x - pair[0][0]) / (pair[1][0] - pair[0][0]);
            pair[0][1] + t * (pair[1][1] - pair[0][1])
        })
}

/// Stress error of the column against the number of cells.
pub(crate) fn column_stress_error() -> Reference {
    Reference::parse(include_str!("../../reference/column_stress_error.csv"))
}

/// Bounds on the limit load of undrained slopes.
pub(crate) fn slope_limit_load_bounds() -> Reference {
    Reference::parse(include_str!("../../reference/slope_limit_load_bounds.csv"))
}

/// Bounds on the factor of safety of drained slopes.
pub(crate) fn slope_safety_bounds() -> Reference {
    Reference::parse(include_str!("../../reference/slope_safety_bounds.csv"))
}

/// Griffiths and Lane's dimensionless displacement against strength reduction factor.
pub(crate) fn griffiths_lane() -> Reference {
    Reference::parse(include_str!(
        "../../reference/griffiths_lane_1999_table2.csv"
    ))
}

/// Resistance of a footing by sequential limit analysis.
pub(crate) fn footing_sequential_limit_analysis() -> Reference {
    Reference::parse(include_str!(
        "../../reference/footing_sequential_limit_analysis.csv"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_read() {
        let points = griffiths_lane().points("srf", "E_delta_over_gamma_H2");
        assert!((interpolate(&points, 0.8) - 0.379).abs() < 1e-12);
        let footing = footing_sequential_limit_analysis().points("w_over_B", "N");
        assert!((interpolate(&footing, 0.2) - 5.562).abs() < 1e-12);
        assert!(interpolate(&footing, 1.5).is_nan());
    }
}
