//! Two, three and four particles per cell and direction: column, soft slope, footing.

use igimp_cases::CaseError;
use igimp_figures::{CurvePlot, LineStyle, Scale, Series, SeriesStyle};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;

use crate::column::{self, ColumnResult};
use crate::comparisons::benchmarks::{
    Footings, Results, Variant, corrections, corrections_of_trials, cuts, drained_slope,
    factor_of_safety, largest_displacement, roughness, soft_slope, work, written,
};
use crate::footing::{self, SEQUENTIAL};
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::reference::{footing_sequential_limit_analysis, interpolate};
use crate::harness::study::{Level, Study};
use crate::runs::Computed;

/// The error of the column.
const SECOND_ORDER: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "second order of the GIMP basis",
    locator: "order between 32 and 128 cells",
};

/// The variants; the default of slopes first.
const VARIANTS: [Variant; 3] = [
    Variant {
        label: "2 × 2",
        slug: "2x2",
        change: |_| {},
    },
    Variant {
        label: "3 × 3",
        slug: "3x3",
        change: |case| case.bodies[0].per_direction = 3,
    },
    Variant {
        label: "4 × 4",
        slug: "4x4",
        change: |case| case.bodies[0].per_direction = 4,
    },
];

/// The comparison: column from the default level on, slopes and footing with the footings of the full one.
pub(super) fn compare(
    study: &mut Study,
    level: Level,
    footings: Option<&Footings>,
) -> Result<(), CaseError> {
    if level >= Level::Default {
        column(study)?;
    }
    if let Some(footings) = footings {
        slope(study)?;
        drained(study)?;
        push(study, footings)?;
    }
    Ok(())
}

/// The columns of both stiffnesses under refinement.
fn column(study: &mut Study) -> Result<(), CaseError> {
    let error = |computed: &Computed<2>| ColumnResult::new(computed).stress_error;
    for young in ["1 MPa", "10 kPa"] {
        let results = Results::compute(&VARIANTS, "cells", &[16, 32, 64, 128], |cells| {
            column::case(cells, young, ("gimp", true))
        })?;
        if young == "1 MPa" {
            for k in 0..3 {
                let run = results.record(study, "column, 128 cells, E = 1 MPa", k, 128);
                let [coarse, fine] = [32, 128].map(|cells| error(results.at(k, cells)));
                study.check(
                    run,
                    "order of the stress error [-]",
                    SECOND_ORDER.says(2.0),
                    Band::AtLeast(1.6),
                    (coarse / fine).log2() / 2.0,
                );
            }
            CurvePlot {
                title: "Column under self-weight, E = 1 MPa".into(),
                x_label: "cells over the height".into(),
                y_label: "mean stress error / (ρ_{0} g l_{0})".into(),
                x_scale: Scale::Log,
                y_scale: Scale::Log,
                series: (0..3)
                    .map(|k| {
                        let style = SeriesStyle::LineAndMarkers(LineStyle::Solid);
                        Series::new(VARIANTS[k].label, results.curve(k, error), style)
                    })
                    .collect(),
                ..CurvePlot::default()
            }
            .write(&study.folder.join("points_column"))?;
        }
        let name = format!("points_column_{}", young.replace(' ', ""));
        study.table(results.table(&name, &[("error_[-]", &error)]))?;
    }
    Ok(())
}

/// Smoothness of the soft slope, h = 1 m and h = 0.5 m, against its steps.
fn slope(study: &mut Study) -> Result<(), CaseError> {
    let results = Results::compute(&VARIANTS, "cells_per_m", &[1, 2], |cells| {
        soft_slope(1.0 / cells as f64, 1.0, 10)
    })?;
    study.table(results.table(
        "points_soft_slope",
        &[
            ("oscillation_[-]", &roughness),
            ("displacement_[m]", &largest_displacement),
            ("corrections_per_step_[-]", &corrections),
            ("million_particle_corrections_[-]", &work),
        ],
    ))
}

/// The factor of safety of the drained slope.
fn drained(study: &mut Study) -> Result<(), CaseError> {
    let results = Results::compute(&VARIANTS, "cell_[m]", &[1], |_| drained_slope())?;
    written(
        study,
        &results.table(
            "points_drained_slope",
            &[
                ("factor_of_safety_[-]", &factor_of_safety),
                ("corrections_[-]", &corrections_of_trials),
            ],
        ),
    )
}

/// The footing pushed one width deep.
fn push(study: &mut Study, footings: &Footings) -> Result<(), CaseError> {
    let pushes = [
        ("2x2", "2 × 2"),
        ("default", "3 × 3"),
        ("4x4", "4 × 4"),
        ("2x2-9", "2 × 2, B/h = 9"),
        ("default-9", "3 × 3, B/h = 9"),
    ];
    let sequential = footing_sequential_limit_analysis().points("w_over_B", "N");
    let expected = interpolate(&sequential, 0.2);
    let run = footings.record(study, "default", "3 × 3");
    study.check(
        run,
        "N at 0.2 B [-]",
        SEQUENTIAL.says(expected),
        Band::Relative(0.03),
        footings.resistance_at("default", 0.2),
    );
    CurvePlot {
        title: "Rough footing: particles per cell".into(),
        x_label: "penetration w/B".into(),
        y_label: "resistance N = Q/(B s_{u}), compression positive".into(),
        series: pushes
            .iter()
            .map(|(name, label)| Series::line(*label, footing::resistance(footings.of(name))))
            .collect(),
        ..CurvePlot::default()
    }
    .write(&study.folder.join("points_footing"))?;
    let header = [
        "cells_per_width",
        "particles_per_direction",
        "scatter_of_N_[-]",
        "corrections_per_step_[-]",
        "cuts_[-]",
        "million_particle_corrections_[-]",
    ];
    let mut effort = Table::new("points_footing_effort", &header);
    for (name, _) in pushes {
        let computed = footings.of(name);
        effort.push(vec![
            (1.0 / computed.case.grid.smallest_cell()[0]).round(),
            computed.case.bodies[0].per_direction as f64,
            footings.scatter(name),
            corrections(computed),
            cuts(computed),
            work(computed),
        ]);
    }
    written(study, &effort)?;
    written(study, &footings.table("points_footing", &pushes))
}
