//! Deposits of sand that has spread and rests.

use igimp_assembly::Particles;
use igimp_cases::CaseError;
use igimp_model::check::Band;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::{Computed, shipped_case};

const COLUMNS: Oracle = Oracle {
    kind: OracleKind::Published,
    source: "Lube et al. 2005; Lajeunesse et al. 2005; arXiv 1512.05180",
    locator: "run-out over half width: 1.2 a, a, 3.25 a^0.96 for short columns, 1.9 a^⅔, a^⅔, 3.80 a^0.73 for tall ones; the band is their range",
};
const LUBE: Oracle = Oracle {
    kind: OracleKind::Published,
    source: "Lube et al. 2005",
    locator: "run-out over half width 1.2 a below a = 2.3",
};
const BEADS: Oracle = Oracle {
    kind: OracleKind::Published,
    source: "Kumar 2015 (thesis, Cambridge), chapter 4: explicit GIMP and grains",
    locator: "run-out over the width 1.67 a, for grains and by the material point method below a = 1.7",
};
const EXPONENT: Oracle = Oracle {
    kind: OracleKind::Published,
    source: "Lube et al. 2005; Lajeunesse et al. 2005",
    locator: "run-out of columns lower than twice their half width in proportion to height",
};
const WIDE_CHANNELS: Oracle = Oracle {
    kind: OracleKind::Published,
    source: "Balmforth and Kerswell 2005 (four grains, wide channels)",
    locator: "run-out over the length of the column as a^(0.9 ± 0.1), height of the column over that of the deposit as a^0.6",
};
/// Half the width of a column \[m\].
const HALF_WIDTH: f64 = 0.1;
/// Where the domains of all but a share of the mass end along the first axis \[m\].
fn front(particles: &Particles<2>, beyond: f64) -> f64 {
    let ends = std::iter::zip(&particles.x, &particles.half_length)
        .zip(&particles.mass)
        .map(|((x, half), mass)| [x[0] + half[0], *mass]);
    length_with(1.0 - beyond, ends.collect())
}

/// Holds the columns.
pub(super) fn hold(study: &mut Study, level: Level) -> Result<(), CaseError> {
    columns(study, level)?;
    if level >= Level::Default {
        beads(study)?;
    }
    if level >= Level::Full {
        on_a_rigid_floor(study)?;
    }
    Ok(())
}

/// The shipped column on a rigid body as floor, which sand slides on: it comes to rest, and friction takes energy from it.
fn on_a_rigid_floor(study: &mut Study) -> Result<(), CaseError> {
    for cell in ["1 cm", "5 mm"] {
        let mut changes = column(1.0, cell, "1 s");
        changes.retain(|change| !change.starts_with("boundaries"));
        changes.push("boundaries.bottom = free".into());
        changes.push("boundaries.boxes = []".into());
        changes.push(
            "rigid = [{ name = \"floor\", type = \"rectangle\", from = [\"-20 cm\", \"-6 cm\"], to = [\"80 cm\", \"0 cm\"], \
             interface = { friction = 0.6 }, from_start = true, rounding = 0 }]"
                .into(),
        );
        let computed = Computed::<2>::new(shipped_case("column_collapse", changes)?)?;
        let variant = format!("column of sand on a rigid floor, a = 1, cells of {cell}");
        let run = RunRecord::new(variant, &computed.report, computed.elapsed);
        let run = study.run_to_end(run);
        let deposit = Deposit::of(run, 1.0, computed.particles(), HALF_WIDTH);
        let quantity = "run-out over half the width [-]";
        let band = Band::Relative(0.15);
        study.check(run, quantity, LUBE.says(1.2), band, deposit.run_out);
        study.notes.push(format!(
            "motion: sand on a rigid floor, cells of {cell}, leaves a height of {:.2} over half its width; {}",
            deposit.height, computed.run.summary.stages[0].reason
        ));
    }
    Ok(())
}

/// The place within which a share of masses lies, each with its place.
pub(super) fn length_with(share: f64, mut masses: Vec<[f64; 2]>) -> f64 {
    masses.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let within = share * masses.iter().map(|[_, mass]| mass).sum::<f64>();
    let mut reached = 0.0;
    let held = masses.iter().take_while(|[_, mass]| {
        reached += mass;
        reached <= within * (1.0 + 1e-9)
    });
    held.last().map_or(f64::NAN, |[place, _]| *place)
}

/// The shipped column, so many times as high as half of it is wide, on cells of 2 cm or of others.
fn column(ratio: f64, cell: &str, duration: &str) -> Vec<String> {
    let height = 10.0 * ratio;
    let wide = (20.0 + 32.0 * ratio).ceil();
    let top = height.ceil() + 4.0;
    vec![
        format!("grid.cell = {cell}"),
        format!("grid.domain = {{ x = [\"0 m\", \"{wide} cm\"], y = [\"-2 cm\", \"{top} cm\"] }}"),
        format!(
            "bodies.column.polygon = [[\"0 cm\", \"0 cm\"], [\"10 cm\", \"0 cm\"], [\"10 cm\", \"{height} cm\"], [\"0 cm\", \"{height} cm\"]]"
        ),
        format!("boundaries.boxes.0.to = [\"{wide} cm\", \"0 cm\"]"),
        format!("monitors.corner.point = [\"10 cm\", \"{height} cm\"]"),
        format!("stages.0.duration = {duration}"),
    ]
}

/// Columns of glass beads as another program of the method computed them, with its parameters.
fn beads(study: &mut Study) -> Result<(), CaseError> {
    for ratio in [0.4, 0.8, 1.5] {
        let mut changes = column(ratio, "1 cm", "1 s");
        let soil = [
            ("unit_weight", "17.66 kN/m3"),
            ("young", "1.98 MPa"),
            ("poisson", "0.23"),
            ("friction", "23.2 deg"),
        ];
        changes.extend(soil.map(|(key, value)| format!("materials.sand.{key} = {value}")));
        let computed = Computed::<2>::new(shipped_case("column_collapse", changes)?)?;
        let variant = format!("column of glass beads, a = {ratio}");
        let run = RunRecord::new(variant, &computed.report, computed.elapsed);
        let run = study.run_to_end(run);
        let run_out = front(computed.particles(), 0.01) / HALF_WIDTH - 1.0;
        let quantity = "run-out over the width [-]";
        let band = Band::Relative(0.2);
        study.check(run, quantity, BEADS.says(1.67 * ratio), band, run_out);
    }
    Ok(())
}

/// Columns of sand, 10 cm wide to either side, on a rough floor.
fn columns(study: &mut Study, level: Level) -> Result<(), CaseError> {
    let (cells, ratios): (&[u8], &[f64]) = match level {
        Level::Quick | Level::Default => (&[2], &[1.0, 2.0, 3.0]),
        Level::Full => (&[2, 1], &[1.0, 2.0, 3.0, 5.0, 8.0]),
    };
    for cell in cells {
        let computed = (ratios.par_iter())
            .map(|&ratio| {
                let duration = format!("{} s", f64::max(1.2, 0.6 + 0.15 * ratio));
                let changes = column(ratio, &format!("{cell} cm"), &duration);
                Computed::<2>::new(shipped_case("column_collapse", changes)?)
            })
            .collect::<Result<Vec<_>, CaseError>>()?;
        let mut found = Vec::new();
        for (&ratio, result) in std::iter::zip(ratios, &computed) {
            let variant = format!("column of sand, a = {ratio}, cells of {cell} cm");
            let run = study.run_to_end(RunRecord::new(variant, &result.report, result.elapsed));
            let deposit = Deposit::of(run, ratio, result.particles(), HALF_WIDTH);
            let least = ratio.min(1.9 * ratio.powf(2.0 / 3.0));
            let band = Band::Between(least, 3.8 * ratio.powf(0.73));
            let lube = if ratio < 2.3 {
                1.2 * ratio
            } else {
                1.9 * ratio.powf(2.0 / 3.0)
            };
            let quantity = "run-out over half the width [-]";
            study.check(run, quantity, COLUMNS.says(lube), band, deposit.run_out);
            found.push(deposit);
        }
        let slope = (found[1].run_out / found[0].run_out).log2();
        let quantity = "exponent of the run-out from a = 1 to 2 [-]";
        let band = Band::Between(0.85, 1.15);
        study.check(found[1].run, quantity, EXPONENT.says(1.0), band, slope);
        if level >= Level::Full {
            exponents(study, &found);
        }
        let heights = Deposit::heights(&found);
        study.notes.push(format!(
            "motion: columns of sand on cells of {cell} cm leave heights over half their width of {heights}"
        ));
    }
    Ok(())
}

/// Checks with which power of the ratio run-outs and heights of all columns grow.
fn exponents(study: &mut Study, found: &[Deposit]) {
    let last = found[found.len() - 1].run;
    let run_out: fn(&Deposit) -> f64 = |deposit| deposit.run_out;
    let height: fn(&Deposit) -> f64 = |deposit| deposit.height;
    for (name, value, exponent) in [("run-out", run_out, 0.9), ("height", height, 0.4)] {
        let points = found.iter().map(|d| [d.ratio.ln(), value(d).ln()]);
        let quantity = format!("exponent of the {name} from a = 1 to 8, by least squares [-]");
        let band = Band::Between(exponent - 0.15, exponent + 0.15);
        let found = slope(&points.collect::<Vec<_>>());
        study.check(last, quantity, WIDE_CHANNELS.says(exponent), band, found);
    }
}

/// The slope of the line that comes closest to points.
fn slope(points: &[[f64; 2]]) -> f64 {
    let count = points.len() as f64;
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / count;
    let middle = [mean(0), mean(1)];
    let sum = |axis: usize| {
        let product = |point: &[f64; 2]| (point[0] - middle[0]) * (point[axis] - middle[axis]);
        points.iter().map(product).sum::<f64>()
    };
    sum(1) / sum(0)
}

/// The deposit of a column at rest.
pub(super) struct Deposit {
    /// Number of the run.
    pub(super) run: usize,
    /// Height of the column over half its width \[-\].
    pub(super) ratio: f64,
    /// Run-out of all but a hundredth of the mass and height within a fifth of the middle, over half the width \[-\].
    pub(super) run_out: f64,
    pub(super) height: f64,
}

impl Deposit {
    /// Of a column of a `half_width` \[m\], by its particles at rest.
    pub(super) fn of(run: usize, ratio: f64, particles: &Particles<2>, half_width: f64) -> Self {
        let ends = std::iter::zip(&particles.x, &particles.half_length);
        let near = ends.filter(|(x, _)| x[0] < 0.2 * half_width);
        let top = near.map(|(x, half)| x[1] + half[1]).fold(0.0, f64::max);
        Self {
            run,
            ratio,
            run_out: front(particles, 0.01) / half_width - 1.0,
            height: top / half_width,
        }
    }

    /// Heights by ratios, in words.
    pub(super) fn heights(found: &[Self]) -> String {
        let heights = found.iter();
        let heights = heights.map(|d| format!("{:.2} at a = {}", d.height, d.ratio));
        heights.collect::<Vec<_>>().join(", ")
    }
}
