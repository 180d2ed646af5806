//! The rigid footing beyond 0.3B: the resistance when the soil beside the shaft may
//! let go.
//!
//! ORACLE: sequential limit analysis of rigid-plastic soil without contact on the footing's side.

use std::path::Path;

use igimp_cases::CaseError;
use igimp_figures::{
    Band as ShadedBand, Colour, ColourMap, CurvePlot, FieldPanel, FieldPlot, LineStyle, Outline,
    OutlineStyle, Series, SeriesStyle,
};
use igimp_model::check::Band;
use igimp_results::measure::sigma;
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use crate::footing::side::{Beside, Pushed, push};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::reference::{footing_sequential_limit_analysis, interpolate};
use crate::harness::study::{Level, RunRecord, Study};
use crate::pictures::{contours, scaled, with_outlines};
use crate::runs::{mesh, shipped_case};

/// The book's description of the study.
const ABOUT: &str = "The same footing beyond 0.3 B: what the resistance becomes when the soil in the cell beside the shaft \
    sticks, bears pressure only, or bears nothing.";
/// The large-deformation curve.
const SEQUENTIAL: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "sequential limit analysis",
    locator: "no contact on the side; validation/reference/footing_sequential_limit_analysis.csv",
};
/// The capacity of separating contact.
const NO_TENSION: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "contact that can separate",
    locator: "does not pull",
};
/// Undrained strength of the case \[Pa\]; its footing is 1 m wide.
const STRENGTH: f64 = 1e3;

/// One push.
struct Variant {
    name: &'static str,
    beside: Beside,
    /// Cells per width B/h, odd so that the edge lies mid-cell.
    cells_per_width: u32,
    /// E/s_u \[-\].
    stiffness: u32,
    /// How far, over B \[-\].
    depth: f64,
    steps: usize,
}

impl Variant {
    fn label(&self) -> String {
        let beside = match self.beside {
            Beside::Sticks => "sticks",
            Beside::BearsPressure(_) => "bears pressure only",
            Beside::BearsNothing(_) => "bears nothing",
        };
        format!(
            "soil beside {beside}, B/h = {}, E/s_u = {}, to {} B",
            self.cells_per_width, self.stiffness, self.depth
        )
    }

    fn run(&self) -> Result<Pushed, CaseError> {
        let mut overrides = mesh(1.0 / f64::from(self.cells_per_width), [5.0, 6.0]);
        let young = f64::from(self.stiffness) * STRENGTH;
        overrides.push(format!("materials.clay.young=\"{young} Pa\""));
        push(
            &shipped_case("footing_bonded", overrides)?,
            self.depth,
            self.steps,
            self.beside,
        )
    }
}

fn variants(level: Level) -> Vec<Variant> {
    let of = |name, beside, cells_per_width, stiffness, depth, steps| Variant {
        name,
        beside,
        cells_per_width,
        stiffness,
        depth,
        steps,
    };
    let nothing = Beside::BearsNothing(1.0);
    match level {
        Level::Quick => Vec::new(),
        Level::Default => vec![of("nothing_9_half", nothing, 9, 100, 0.5, 20)],
        Level::Full => vec![
            of("sticks_9", Beside::Sticks, 9, 100, 1.0, 40),
            of("nothing_9", nothing, 9, 100, 1.0, 40),
            of("nothing_9_half", nothing, 9, 100, 0.5, 20),
            of("pressure_9", Beside::BearsPressure(1.0), 9, 100, 0.5, 20),
            of("nothing_9_stiff", nothing, 9, 300, 0.5, 40),
            of("nothing_13", nothing, 13, 100, 1.0, 65),
        ],
    }
}

/// w/B against N = Q/(B s_u), compression positive.
fn resistance(pushed: &Pushed) -> Vec<[f64; 2]> {
    let moments = pushed.moments.iter();
    moments
        .map(|moment| [moment.settlement, moment.resistance / STRENGTH])
        .collect()
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("footing-contact", ABOUT, out)?;
    let variants = variants(level);
    let results = variants
        .par_iter()
        .map(Variant::run)
        .collect::<Result<Vec<_>, _>>()?;
    for (variant, pushed) in variants.iter().zip(&results) {
        let run = RunRecord::new(variant.label(), &pushed.report, pushed.elapsed);
        let run = study.run_to_end(run);
        check(&mut study, variant, run, pushed);
        study.table(table(variant, pushed))?;
    }
    let of = |name: &str| {
        let found = variants.iter().position(|variant| variant.name == name);
        found.map(|index| &results[index])
    };
    if let (Some(sticks), Some(nothing)) = (of("sticks_9"), of("nothing_9")) {
        curves(&study, &variants, &results)?;
        panel(&study, sticks, nothing)?;
    }
    Ok(study)
}

fn check(study: &mut Study, variant: &Variant, run: usize, pushed: &Pushed) {
    let sequential = footing_sequential_limit_analysis().points("w_over_B", "N");
    let resistance = resistance(pushed);
    let expected = |depth| SEQUENTIAL.says(interpolate(&sequential, depth));
    let quantity = |depth: f64| format!("N at {depth} B [-]");
    match variant.beside {
        Beside::Sticks => {
            // Soil that sticks to the side adds 12 % at least.
            study.control(
                run,
                quantity(1.0),
                expected(1.0),
                Band::AtLeast(1.12 * expected(1.0).value),
                interpolate(&resistance, 1.0),
            );
            // And the side pulls with half of s_u at least.
            let last = pushed.moments.last();
            study.control(
                run,
                "pull of one side at 1 B over s_u B [-]",
                NO_TENSION.says(0.0),
                Band::AtLeast(0.5),
                last.map_or(f64::NAN, |last| last.pull / STRENGTH),
            );
        }
        Beside::BearsPressure(_) | Beside::BearsNothing(_) => {
            // Softer soil mobilises later, which shows early on.
            let first = if variant.stiffness > 100 { 0.2 } else { 0.5 };
            let depths = [first, 0.5, 1.0].into_iter();
            let mut depths: Vec<f64> = depths.filter(|&depth| depth <= variant.depth).collect();
            depths.dedup();
            for depth in depths {
                study.check(
                    run,
                    quantity(depth),
                    expected(depth),
                    Band::Relative(0.03),
                    interpolate(&resistance, depth),
                );
            }
        }
    }
}

fn table(variant: &Variant, pushed: &Pushed) -> Table {
    let mut table = Table::new(
        format!("resistance_{}", variant.name),
        &[
            "penetration_w/B_[-]",
            "resistance_N_[-]_compression_+",
            "of_it_on_the_shaft_[-]_compression_+",
            "pull_of_one_side_over_s_u_B_[-]_tension_+",
            "soil_that_let_go_on_one_side_over_B2_[-]",
        ],
    );
    for moment in &pushed.moments {
        let forces = [moment.resistance, moment.shaft, moment.pull].map(|force| force / STRENGTH);
        let mut row = vec![moment.settlement];
        row.extend(forces);
        row.push(moment.released);
        table.push(row);
    }
    table
}

fn curves(study: &Study, variants: &[Variant], results: &[Pushed]) -> Result<(), CaseError> {
    let sequential = footing_sequential_limit_analysis().points("w_over_B", "N");
    let mut series: Vec<Series> = variants
        .iter()
        .zip(results)
        .map(|(variant, pushed)| {
            Series::line(variant.label().replace("s_u", "s_{u}"), resistance(pushed))
        })
        .collect();
    series.push(
        Series::new(
            SEQUENTIAL.source,
            sequential.clone(),
            SeriesStyle::Line(LineStyle::Dashed),
        )
        .in_colour(Colour::BLACK),
    );
    CurvePlot {
        title: "Rigid footing in Tresca soil: contact on its side".into(),
        x_label: "penetration w/B".into(),
        y_label: "resistance N = Q/(B s_{u}), compression positive".into(),
        bands: vec![ShadedBand::around("± 3 %", &sequential, 0.03)],
        series,
        ..CurvePlot::default()
    }
    .write(&study.folder.join("resistance"))?;
    Ok(())
}

/// Shear stress beside the footing at the end.
fn panel(study: &Study, sticks: &Pushed, nothing: &Pushed) -> Result<(), CaseError> {
    let plot = |title: &str, pushed: &Pushed| {
        let values = scaled(&sigma(&pushed.particles, 0, 1), 1.0 / STRENGTH);
        let base = 5.0 - pushed.moments.last().map_or(0.0, |last| last.settlement);
        let block = [[0.0, base], [0.5, base], [0.5, 5.6], [0.0, 5.6]];
        let footing = Outline {
            points: block.to_vec(),
            style: OutlineStyle::Block,
        };
        let label = "shear stress τ_{xy}/s_{u} [-]";
        let range = Some((-1.0, 1.0));
        let map = ColourMap::Diverging;
        FieldPlot {
            x_range: Some((0.0, 2.0)),
            y_range: Some((3.4, 5.6)),
            ..with_outlines(
                contours(title, &pushed.particles, values, label, map, range),
                vec![footing],
            )
        }
    };
    FieldPanel {
        title: "Beside the footing at w = B".into(),
        columns: 2,
        plots: vec![
            plot("soil beside sticks", sticks),
            plot("soil beside bears nothing", nothing),
        ],
    }
    .write(&study.folder.join("beside"))?;
    Ok(())
}
