//! Level ground of two soils under its own weight, the boundary anywhere in a cell.

use igimp_cases::CaseError;
use igimp_input::CaseFile;

use crate::harness::study::RunRecord;
use crate::runs::Computed;

/// Height of the lower soil, to the line of the grid below the boundary, and of the upper \[m\].
const HEIGHTS: [f64; 2] = [8.0, 9.0];
/// Unit weight of the lower and of the upper soil \[N/m³\].
const UNIT_WEIGHTS: [f64; 2] = [2e4, 1.6e4];
/// Young's modulus of the upper soil \[Pa\]: the ground settles by next to nothing.
const YOUNG: f64 = 1e10;

/// The weight of half a cell of the heavier soil over the least weight above a boundary \[-\]: as far as that the stress of a
/// cell, which is that of its middle, is off at its particles.
pub(super) fn half_a_cell() -> f64 {
    let most = super::OFFSETS.into_iter().fold(0.0, f64::max);
    0.5 * UNIT_WEIGHTS[0] / (UNIT_WEIGHTS[1] * (HEIGHTS[1] - most))
}

/// Level ground on cells of 1 m.
pub(super) struct Ground {
    /// Height of the boundary above a line of the grid of equal cells \[cells\].
    pub(super) offset: f64,
    /// Young's modulus of the lower soil over that of the upper one \[-\].
    pub(super) stiffness: f64,
    /// The treatment of the boundary.
    pub(super) cells: Cells,
}

/// The treatment of a boundary within cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cells {
    /// A line of the grid is put on it.
    Fitted,
    /// Nothing.
    Own,
    /// The soils of a cell share a mean stiffness.
    Mean,
}

impl Cells {
    /// All of them.
    pub(super) const ALL: [Self; 3] = [Self::Fitted, Self::Own, Self::Mean];

    /// As the table says it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Fitted => "grid fitted",
            Self::Own => "not fitted",
            Self::Mean => "not fitted, mean stiffness",
        }
    }

    /// As files are named.
    pub(super) fn key(self) -> &'static str {
        match self {
            Self::Fitted => "fitted",
            Self::Own => "own",
            Self::Mean => "mean",
        }
    }
}

impl Ground {
    /// Raises gravity; returns the run and the largest error of the vertical stress below the
    /// boundary and above it, in size, with its sign, over the weight above the boundary \[-\].
    pub(super) fn settle(&self) -> Result<(RunRecord, [f64; 2]), CaseError> {
        let level = HEIGHTS[0] + self.offset;
        let top = HEIGHTS[0] + HEIGHTS[1];
        let (fit, mixed) = match self.cells {
            Cells::Fitted => ("layers", "own"),
            Cells::Own => ("none", "own"),
            Cells::Mean => ("none", "mean"),
        };
        let text = format!(
            "igimp = 1\n[case]\ntitle = \"Level ground\"\ngravity = \"10 m/s2\"\n\
             [grid]\ncell = \"1 m\"\nfit = \"{fit}\"\nmixed_cells = \"{mixed}\"\n\
             domain = {{ x = [\"0 m\", \"3 m\"], y = [\"0 m\", \"{} m\"] }}\n\
             [materials.lower]\nmodel = \"elastic\"\nunit_weight = \"{} N/m3\"\n\
             young = \"{} Pa\"\npoisson = 0.3\n\
             [materials.upper]\nmodel = \"elastic\"\nunit_weight = \"{} N/m3\"\n\
             young = \"{YOUNG} Pa\"\npoisson = 0.3\n\
             [[bodies]]\nname = \"lower\"\nmaterial = \"lower\"\n\
             polygon = [[\"0 m\", \"0 m\"], [\"3 m\", \"0 m\"], [\"3 m\", \"{level} m\"], \
             [\"0 m\", \"{level} m\"]]\n\
             [[bodies]]\nname = \"upper\"\nmaterial = \"upper\"\n\
             polygon = [[\"0 m\", \"{level} m\"], [\"3 m\", \"{level} m\"], [\"3 m\", \"{top} m\"], \
             [\"0 m\", \"{top} m\"]]\n\
             [[stages]]\nname = \"weight\"\ntype = \"gravity\"\nsteps = 1\n",
            top + 1.0,
            UNIT_WEIGHTS[0],
            YOUNG * self.stiffness,
            UNIT_WEIGHTS[1],
        );
        let case = CaseFile::parse("level.toml", &text, &[])?.into_case();
        let computed = Computed::new(case)?;
        let name = format!(
            "boundary at {} h, E ratio {}, {}",
            self.offset,
            self.stiffness,
            self.cells.name()
        );
        let run = RunRecord::new(name, &computed.report, computed.elapsed);
        let particles = &computed.run.body.particles;
        let above = UNIT_WEIGHTS[1] * (top - level);
        let mut errors = [0.0_f64; 2];
        for (particle, x) in particles.x.iter().enumerate() {
            let y = x[1] - particles.displacement[particle][1];
            let exact = UNIT_WEIGHTS[1] * (top - y.max(level)).max(0.0)
                + UNIT_WEIGHTS[0] * (level - y).max(0.0);
            let error = (-particles.sigma[particle][1][1] - exact) / above;
            let worst = &mut errors[particles.law[particle] % 2];
            // The first of those that are equal but for round-off.
            if error.abs() > worst.abs() + 1e-6 {
                *worst = error;
            }
        }
        Ok((run, errors))
    }

    /// The error that one strain in the cut cell makes of the stress below the boundary and above
    /// it, over the mean stress of the cell (theory, eq. 37a) \[-\].
    pub(super) fn stated(&self) -> [f64; 2] {
        let lower = match self.cells {
            Cells::Own => self.offset,
            Cells::Fitted | Cells::Mean => 0.0,
        };
        let mean = lower * self.stiffness + (1.0 - lower);
        let is_cut = lower > 0.0;
        [self.stiffness, 1.0].map(|young| if is_cut { young / mean - 1.0 } else { 0.0 })
    }
}
