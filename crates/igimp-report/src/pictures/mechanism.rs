//! How a body begins to fail: shear between two equilibria, the slip line, and which way the soil goes.

use igimp_assembly::Particles;
use igimp_figures::{FieldPlot, Outline, OutlineStyle};
use igimp_geometry::polygon::bounding_box;
use igimp_model::Case;
use igimp_results::measure::Buckets;
use igimp_results::summary::FigureNote;
use igimp_results::tables::table::Table;
use igimp_text::short;

use super::field::edges;
use super::{Canvas, Over, file_name, titled, write};
use crate::error::ReportError;
use crate::failure_mechanism::{Increment, IncrementInSpace, SlipPoint};

/// Arrows stand so many to the longer side of the picture.
const ARROWS: f64 = 34.0;
/// The longest arrow reaches so far, in distances of arrows \[-\].
const LONGEST: f64 = 1.5;
/// Soil that moves by less than this share of the most has no arrow \[-\].
const STILL: f64 = 0.06;
/// The picture shows soil that shears or moves by more than this share of the most \[-\] …
const PART: f64 = 0.15;
/// … with so much beside it, in shares of its own size \[-\].
const AIR: f64 = 0.2;
/// Shear beyond this share of the particles has the last colour \[-\].
const FEW: f64 = 0.005;

/// The last two equilibria of a search before it failed.
#[derive(Clone, Copy, Debug)]
pub struct Failing<'a, const D: usize> {
    /// Number of its stage, from 0.
    pub stage: usize,
    /// Strength reduction factor of the state \[-\].
    pub srf: f64,
    /// Name of the state, as `first-unstable`.
    pub label: &'a str,
    /// The last equilibrium but one.
    pub before: &'a Particles<D>,
    /// The last equilibrium.
    pub last: &'a Particles<D>,
}

impl<const D: usize> Failing<'_, D> {
    fn moved(&self) -> Vec<[f64; D]> {
        std::iter::zip(&self.before.displacement, &self.last.displacement)
            .map(|(before, last)| std::array::from_fn(|axis| last[axis] - before[axis]))
            .collect()
    }
}

/// The surface over which soil slides in space as a table, if one stands out.
pub fn slip_surface(failing: &Failing<'_, 3>, case: &Case<3>) -> Option<Table> {
    let moved = failing.moved();
    let increment = IncrementInSpace {
        x: &failing.last.x,
        half_length: &failing.last.half_length0,
        moved: &moved,
    };
    let surface = increment.slip_surface();
    let mut table = Table::new(
        table_name(case, failing.stage),
        &["x_[m]", "y_[m]", "z_[m]"],
    );
    for point in &surface {
        table.push(point.to_vec());
    }
    (!surface.is_empty()).then_some(table)
}

/// The name of a table of the failure in a stage.
fn table_name<const D: usize>(case: &Case<D>, stage: usize) -> String {
    format!("{}-{}", stage + 1, file_name(&case.stages[stage].name))
}

/// The displacements between two equilibria of a failing body.
#[derive(Clone, Debug)]
pub struct Mechanism {
    moved: Vec<[f64; 2]>,
    shear: Vec<f64>,
    line: Option<Vec<SlipPoint>>,
}

/// The mechanism of a failure; none where nothing moved from the one equilibrium to the other.
pub fn mechanism(failing: &Failing<'_, 2>) -> Option<Mechanism> {
    let moved = failing.moved();
    let most = moved.iter().map(|d| d[0].hypot(d[1])).fold(0.0, f64::max);
    if most <= 0.0 {
        return None;
    }
    let increment = Increment {
        x: &failing.last.x,
        half_length: &failing.last.half_length0,
        volume: &failing.last.volume0,
        moved: &moved,
    };
    let shear = increment.shear();
    let line = increment.slip_line(&shear);
    Some(Mechanism { moved, shear, line })
}

impl Mechanism {
    /// The slip line as a table, if one stands out.
    pub fn table(&self, case: &Case<2>, stage: usize) -> Option<Table> {
        let line = self.line.as_ref()?;
        let name = table_name(case, stage);
        let mut table = Table::new(name, &["x_[m]", "y_[m]", "shear_strain_increment_[-]"]);
        for point in line {
            table.push(vec![point.x[0], point.x[1], point.shear]);
        }
        Some(table)
    }
}

/// The picture of a mechanism, with structures `over` it where they stand.
///
/// # Errors
/// [`ResultsError::File`](igimp_results::ResultsError::File) and [`ReportError::Figure`].
pub fn mechanism_picture(
    canvas: &Canvas<'_>,
    failing: &Failing<'_, 2>,
    found: &Mechanism,
    over: &Over,
) -> Result<FigureNote, ReportError> {
    let stage = &canvas.case.stages[failing.stage].name;
    let (domains, whose) = canvas.pieces.now(failing.last);
    let mut sorted: Vec<f64> = found
        .shear
        .iter()
        .copied()
        .filter(|v| v.is_finite())
        .collect();
    sorted.sort_by(f64::total_cmp);
    let place = ((1.0 - FEW) * sorted.len().saturating_sub(1) as f64).round() as usize;
    let most = sorted.get(place).copied().unwrap_or(0.0);
    let most = if most > 0.0 { most } else { 1.0 };
    let window = window(failing.last, found, most);
    let mut outlines = edges(canvas.case, canvas.pieces, failing.last);
    outlines.extend_from_slice(&over.outlines);
    outlines.push(arrows(failing.last, found, &window));
    let mut remark = "; no line of shear stands out".to_owned();
    if let Some(line) = &found.line {
        outlines.push(Outline {
            points: line.iter().map(|point| point.x).collect(),
            style: OutlineStyle::Trace,
        });
        if let [first, .., last] = line.as_slice() {
            let at = |point: &SlipPoint| format!("({}, {})", short(point.x[0]), short(point.x[1]));
            remark = format!(
                ". Heavy line: where it shears most, from {} to {} m",
                at(first),
                at(last)
            );
        }
    }
    let plot = FieldPlot {
        title: titled(&canvas.case.title, &format!("{stage}, mechanism")),
        domains,
        values: whose.iter().map(|&k| found.shear[k] / most).collect(),
        label:
            "increment of shear strain, as a share of its most [−]; bar to 99.5 % of the particles"
                .into(),
        range: Some((0.0, 1.0)),
        outlines,
        x_range: Some((window[0][0], window[1][0])),
        y_range: Some((window[0][1], window[1][1])),
        ..FieldPlot::default()
    };
    let caption = format!(
        "How the body begins to fail in “{stage}”: increments from the last equilibrium but one to the \
         last, {} state, SRF {:.4}. Colours: largest shear strain; arrows: displacement{remark}.",
        failing.label.replace('-', " "),
        failing.srf,
    );
    let name = format!("mechanism-{}-{}", failing.stage + 1, file_name(stage));
    write(canvas.folder, &name, &plot.draw()?, caption)
}

/// Lower and upper corner of the picture.
fn window(particles: &Particles<2>, found: &Mechanism, most_shear: f64) -> [[f64; 2]; 2] {
    let length = |k: usize| found.moved[k][0].hypot(found.moved[k][1]);
    let most = (0..particles.len()).map(length).fold(0.0, f64::max);
    let takes_part = |&k: &usize| length(k) > PART * most || found.shear[k] > PART * most_shear;
    let part: Vec<[f64; 2]> = (0..particles.len())
        .filter(takes_part)
        .map(|k| particles.x[k])
        .collect();
    let (all_lower, all_upper) = bounding_box(&particles.x);
    let (lower, upper) = bounding_box(&part);
    let edge = particles
        .half_length0
        .iter()
        .flatten()
        .fold(0.0_f64, |a, &b| a.max(b));
    // One particle alone takes some room too.
    let air = (AIR * (upper[0] - lower[0]).max(upper[1] - lower[1])).max(2.0 * edge);
    [
        [0, 1].map(|k| (lower[k] - air).max(all_lower[k] - 2.0 * edge)),
        [0, 1].map(|k| (upper[k] + air).min(all_upper[k] + 2.0 * edge)),
    ]
}

/// Arrows at equal distances, from where the soil is in the direction in which it goes.
fn arrows(particles: &Particles<2>, found: &Mechanism, window: &[[f64; 2]; 2]) -> Outline {
    let [lower, upper] = *window;
    let apart = (upper[0] - lower[0]).max(upper[1] - lower[1]) / ARROWS;
    let length = |k: usize| found.moved[k][0].hypot(found.moved[k][1]);
    let most = (0..particles.len()).map(length).fold(0.0, f64::max);
    let buckets = Buckets::new(&particles.x, apart);
    let count = |axis: usize| ((upper[axis] - lower[axis]) / apart) as usize;
    let places = (0..count(1)).flat_map(|row| (0..count(0)).map(move |column| [column, row]));
    let mut points = Vec::new();
    for place in places {
        let at = [0, 1].map(|axis| lower[axis] + (place[axis] as f64 + 0.5) * apart);
        let Some(near) = buckets.nearest(&particles.x, &at) else {
            continue;
        };
        let from = particles.x[near];
        let inside = (0..2).all(|axis| {
            (from[axis] - at[axis]).abs() <= (0.5 * apart).max(particles.half_length0[near][axis])
        });
        if inside && length(near) > STILL * most {
            let moved = found.moved[near].map(|d| d * LONGEST * apart / most);
            points.extend([at, [at[0] + moved[0], at[1] + moved[1]]]);
        }
    }
    Outline {
        points,
        style: OutlineStyle::Vectors,
    }
}
