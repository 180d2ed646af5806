//! Footings of many stiffnesses and Poisson's ratios, pushed one width deep.

use igimp_cases::CaseError;
use igimp_input::shipped;
use igimp_model::Case;
use igimp_results::tables::table::Table;

/// E/s_u of the grid \[-\].
pub(crate) const STIFFNESSES: [f64; 5] = [50.0, 100.0, 200.0, 500.0, 1000.0];
/// ν of the grid \[-\].
pub(crate) const POISSONS: [f64; 5] = [0.3, 0.49, 0.495, 0.499, 0.4999];
/// Penetrations at which the resistance is read, w/B \[-\].
pub(crate) const DEPTHS: [f64; 3] = [0.2, 0.5, 1.0];

/// A rough footing on undrained clay.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footing {
    /// E/s_u \[-\].
    pub(crate) stiffness: f64,
    /// ν \[-\].
    pub(crate) poisson: f64,
    /// Cells per width B/h, odd so that the edge lies mid-cell.
    pub(crate) cells_per_width: u32,
    /// Penetration asked for w/B \[-\].
    pub(crate) depth: f64,
    /// Steps when none is cut.
    pub(crate) steps: usize,
}

impl Footing {
    /// The grid of all stiffnesses and ratios.
    pub(crate) fn all(cells_per_width: u32) -> Vec<Self> {
        let of = |stiffness| {
            POISSONS.map(|poisson| Self {
                stiffness,
                poisson,
                cells_per_width,
                depth: 1.0,
                steps: 40,
            })
        };
        STIFFNESSES.iter().flat_map(|&e| of(e)).collect()
    }

    /// The shipped footing with the changes.
    ///
    /// # Panics
    /// If the case is not shipped: it is part of the program.
    pub(crate) fn case(&self) -> Result<Case<2>, CaseError> {
        let shipped = shipped::find("footing_bonded").expect("the footing is shipped");
        let overrides = [
            format!("grid.cell=\"1/{} m\"", self.cells_per_width),
            format!("materials.clay.young=\"{} kPa\"", self.stiffness),
            format!("materials.clay.poisson={}", self.poisson),
            format!("stages.push to one width.settlement=\"{} m\"", self.depth),
            format!("stages.push to one width.steps={}", self.steps),
            "checks=[]".to_owned(),
        ];
        Ok(shipped.case_file(overrides)?.into_case())
    }
}

/// The resistance N at a penetration, between the two points of the curve around it; not a number
/// beyond its end \[-\].
pub(crate) fn resistance_at(curves: &[Table], depth: f64) -> f64 {
    let Some(curve) = curves.iter().find(|curve| curve.name == "resistance") else {
        return f64::NAN;
    };
    let points = curve.points(0, 1);
    points
        .windows(2)
        .find(|pair| pair[0][0] < depth && depth <= pair[1][0] + 1e-9)
        .map_or(f64::NAN, |pair| {
            let share = ((depth - pair[0][0]) / (pair[1][0] - pair[0][0])).min(1.0);
            pair[0][1] + share * (pair[1][1] - pair[0][1])
        })
}

/// The penetration reached w/B \[-\].
pub(crate) fn depth_reached(curves: &[Table]) -> f64 {
    let curve = curves.iter().find(|curve| curve.name == "resistance");
    curve
        .and_then(|curve| curve.rows.last())
        .map_or(0.0, |row| row[0])
}
