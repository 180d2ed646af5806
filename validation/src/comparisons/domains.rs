//! Updates of the particle domains: fixed, by the diagonal of F, by that of U, by √J; on the column, a
//! rigid rotation, the cantilever and the footing.

use igimp_assembly::{DomainUpdate, Method};
use igimp_cases::CaseError;
use igimp_figures::{CurvePlot, LineStyle, Scale, Series, SeriesStyle};
use igimp_model::check::Band;
use igimp_results::measure::oscillation;
use igimp_results::tables::table::Table;

use crate::column::{self, ColumnResult};
use crate::comparisons::benchmarks::{
    Footings, Results, Variant, cantilever, corrections, cuts, deflection, written,
};
use crate::comparisons::block::turn;
use crate::footing;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::Computed;

/// The stress errors of the column.
const COLUMN: Oracle = Oracle {
    kind: OracleKind::IndependentProgram,
    source: "independent iGIMP program, set-up of Charlton et al. 2017",
    locator: "256 cells, E = 1 MPa: U or F 6.35e-5, √J 3.5e-4, fixed 6.7e-4",
};
/// Order of the error.
const SECOND_ORDER: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "second order of the GIMP basis",
    locator: "order between 64 and 256 cells",
};
/// The effect of a rotation on domains.
const RIGID_ROTATION: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "rigid rotation",
    locator: "a body keeps its area",
};
/// The bent cantilever: ∫cos²θ ds = 0.280 L of shear and ∫sin²θ ds = 0.720 L of stretch along the
/// elastica, as P/(κGA) and P/(EA) weigh them.
const ELASTICA: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "elastica, Mattiasson 1981, with shear and stretch of a beam of depth L/10",
    locator: "dead end load, P L²/(E I) = 10: 0.81061 L + 0.0056 L + 0.0060 L",
};

/// The variants; the default first.
const VARIANTS: [Variant; 4] = [
    Variant {
        label: "U",
        slug: "U",
        change: |_| {},
    },
    Variant {
        label: "F",
        slug: "F",
        change: |case| case.method.domain_update = DomainUpdate::DiagonalF,
    },
    Variant {
        label: "√J",
        slug: "root-J",
        change: |case| case.method.domain_update = DomainUpdate::RootJ,
    },
    Variant {
        label: "fixed",
        slug: "fixed",
        change: |case| case.method.domain_update = DomainUpdate::Fixed,
    },
];

/// The comparison: stiff column and rotation always, soft column from the default level on, cantilever and
/// footing with the footings of the full one.
pub(super) fn compare(
    study: &mut Study,
    level: Level,
    footings: Option<&Footings>,
) -> Result<(), CaseError> {
    stiff_column(study)?;
    rotation(study)?;
    if level >= Level::Default {
        soft_column(study)?;
    }
    if let Some(footings) = footings {
        bent(study)?;
        push(study, footings)?;
    }
    Ok(())
}

fn error(computed: &Computed<2>) -> f64 {
    ColumnResult::new(computed).stress_error
}

/// The column of 1 MPa under refinement.
fn stiff_column(study: &mut Study) -> Result<(), CaseError> {
    let cells = [16, 32, 64, 128, 256];
    let results = Results::compute(&VARIANTS, "cells", &cells, |cells| {
        column::case(cells, "1 MPa", ("gimp", true))
    })?;
    let quantity = "stress error [-]";
    let best = error(results.at(0, 256));
    for (k, expected) in [(0, 6.351e-5), (2, 3.5e-4), (3, 6.7e-4)] {
        let run = results.record(study, "column, 256 cells, E = 1 MPa", k, 256);
        let measured = error(results.at(k, 256));
        if k == 0 {
            let expected = COLUMN.says(expected);
            study.check(run, quantity, expected, Band::Relative(0.03), measured);
            let order = (error(results.at(0, 64)) / measured).log2() / 2.0;
            let quantity = "order of the stress error [-]";
            study.check(
                run,
                quantity,
                SECOND_ORDER.says(2.0),
                Band::AtLeast(1.7),
                order,
            );
        } else {
            let band = Band::AtLeast(4.0 * best);
            study.control(run, quantity, COLUMN.says(expected), band, measured);
        }
    }
    figure(&results, "E = 1 MPa").write(&study.folder.join("domains_column"))?;
    study.table(results.table("domains_column_1MPa", &[("error_[-]", &error)]))
}

/// The column of 10 kPa, halved by its weight.
fn soft_column(study: &mut Study) -> Result<(), CaseError> {
    let cells = [16, 32, 64, 128];
    let results = Results::compute(&VARIANTS, "cells", &cells, |cells| {
        column::case(cells, "10 kPa", ("gimp", true))
    })?;
    figure(&results, "E = 10 kPa").write(&study.folder.join("domains_soft_column"))?;
    study.table(results.table(
        "domains_column_10kPa",
        &[("error_[-]", &error), ("cuts_[-]", &cuts)],
    ))
}

fn figure(results: &Results<'_>, stiffness: &str) -> CurvePlot {
    CurvePlot {
        title: format!("Column under self-weight, {stiffness}"),
        x_label: "cells over the height".into(),
        y_label: "mean stress error / (ρ_{0} g l_{0})".into(),
        x_scale: Scale::Log,
        y_scale: Scale::Log,
        series: (0..results.variants.len())
            .map(|k| {
                let style = SeriesStyle::LineAndMarkers(LineStyle::Solid);
                Series::new(results.variants[k].label, results.curve(k, error), style)
            })
            .collect(),
        ..CurvePlot::default()
    }
}

/// Domains after a turn of the body.
fn rotation(study: &mut Study) -> Result<(), CaseError> {
    let header = [
        "angle_[deg]",
        "U_area_[-]",
        "F_area_[-]",
        "root-J_area_[-]",
        "fixed_area_[-]",
    ];
    let mut table = Table::new("domains_rotation", &header);
    let updates = [
        DomainUpdate::DiagonalU,
        DomainUpdate::DiagonalF,
        DomainUpdate::RootJ,
        DomainUpdate::Fixed,
    ];
    for angle in [15.0_f64, 30.0, 45.0, 60.0, 75.0] {
        let mut row = vec![angle];
        for (k, &domain_update) in updates.iter().enumerate() {
            let method = Method {
                domain_update,
                ..Method::default()
            };
            let turned = turn(&method, angle.to_radians(), 5)?;
            row.push(turned.area);
            if (angle - 45.0).abs() < 1e-9 && k < 2 {
                let name = format!("{}: rotation by 45°", VARIANTS[k].label);
                let run = study.run(RunRecord::new(name, &turned.report, turned.elapsed));
                let quantity = "area of the domains / area of the body [-]";
                let expected = RIGID_ROTATION.says(1.0);
                if k == 0 {
                    study.check(run, quantity, expected, Band::Relative(1e-10), turned.area);
                } else {
                    study.control(run, quantity, expected, Band::AtMost(0.51), turned.area);
                }
            }
        }
        table.push(row);
    }
    study.table(table)
}

/// The cantilever under ten times its shipped load, with four and eight cells over its depth.
fn bent(study: &mut Study) -> Result<(), CaseError> {
    let results = Results::compute(&VARIANTS, "cells_over_depth", &[4, 8], |cells| {
        cantilever(cells, 10, 30)
    })?;
    let run = results.record(study, "cantilever, P L²/(E I) = 10", 0, 8);
    let measured = deflection(results.at(0, 8));
    let quantity = "deflection / L [-]";
    study.check(
        run,
        quantity,
        ELASTICA.says(0.8222),
        Band::Relative(0.02),
        measured,
    );
    written(
        study,
        &results.table(
            "domains_cantilever",
            &[
                ("deflection/L_[-]", &deflection),
                ("oscillation_of_p_[-]", &pressure_oscillation),
                ("corrections_per_step_[-]", &corrections),
                ("cuts_[-]", &cuts),
            ],
        ),
    )
}

/// Oscillation of the mean stress over its root mean square: deviation from local planes of radius
/// 1.3 h \[-\].
fn pressure_oscillation(computed: &Computed<2>) -> f64 {
    let particles = computed.particles();
    let mean: Vec<f64> = particles
        .sigma
        .iter()
        .map(|sigma| (sigma[0][0] + sigma[1][1] + sigma[2][2]) / 3.0)
        .collect();
    let square = mean.iter().map(|p| p * p).sum::<f64>() / mean.len() as f64;
    oscillation(
        &particles.x,
        &mean,
        1.3 * computed.case.grid.smallest_cell()[0],
    ) / square.sqrt()
}

/// The footing pushed one width deep.
fn push(study: &mut Study, footings: &Footings) -> Result<(), CaseError> {
    let pushes = [
        ("default", "U"),
        ("F", "F"),
        ("root-J", "√J"),
        ("fixed", "fixed"),
    ];
    CurvePlot {
        title: "Rough footing, B/h = 5: updates of the particle domains".into(),
        x_label: "penetration w/B".into(),
        y_label: "resistance N = Q/(B s_{u}), compression positive".into(),
        series: pushes
            .iter()
            .map(|(name, label)| Series::line(*label, footing::resistance(footings.of(name))))
            .collect(),
        ..CurvePlot::default()
    }
    .write(&study.folder.join("domains_footing"))?;
    let mut scatter = Table::new(
        "domains_footing_scatter",
        &[
            "U_scatter_[-]",
            "F_scatter_[-]",
            "root-J_scatter_[-]",
            "fixed_scatter_[-]",
        ],
    );
    scatter.push(
        pushes
            .iter()
            .map(|(name, _)| footings.scatter(name))
            .collect(),
    );
    study.table(scatter)?;
    let named = pushes.map(|(name, _)| (name, if name == "default" { "U" } else { name }));
    study.table(footings.table("domains_footing", &named))
}
