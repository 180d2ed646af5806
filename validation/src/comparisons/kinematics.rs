//! Finite against small strain: column, rigid rotation, soft and stiff slope, footing.

use igimp_assembly::{Kinematics, Method, SmallCuts};
use igimp_cases::CaseError;
use igimp_figures::{
    CurvePlot, LineStyle, ReferenceLine, ReferenceValue, Scale, Series, SeriesStyle,
};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use crate::column::{self, ColumnResult, HENCKY_COLUMN};
use crate::comparisons::benchmarks::{
    Footings, Quantity, Results, Variant, cantilever, corrections, corrections_of_trials, cuts,
    deflection, drained_slope, factor_of_safety, largest_displacement, reached, soft_slope,
    written,
};
use crate::comparisons::block::{QUARTER, small_strain_turned, turn};
use crate::footing;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{RunRecord, Study};
use crate::runs::Computed;
use crate::von_mises_slope::{BOUNDS, Collapse, bounds, limit, slope_to_collapse};

/// The height in small strain, steps without end.
const SMALL_STRAIN_COLUMN: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "column of the rate law dσ = E dλ/λ under its own weight",
    locator: "λ = exp(−s): height (1 − e^−S)/S, S = ρ₀ g l₀/E",
};
/// The effect of a rotation on a body without stress.
const RIGID_ROTATION: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "rigid rotation of a stress-free body",
    locator: "no stress",
};
/// Its result at small strain.
const SMALL_STRAIN_ROTATION: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "small strain of a rotation in n steps",
    locator: "n (1 − cos(α/n)) E / ((1 + ν)(1 − 2ν)) in the plane",
};

/// The variants; the default first.
const VARIANTS: [Variant; 2] = [
    Variant {
        label: "finite strain",
        slug: "finite",
        change: |_| {},
    },
    Variant {
        label: "small strain",
        slug: "small",
        change: |case| case.method.kinematics = Kinematics::SmallStrain,
    },
];

/// The comparison: column and rotation always, slopes and footing with the footings of the full level.
pub(super) fn compare(study: &mut Study, footings: Option<&Footings>) -> Result<(), CaseError> {
    column(study)?;
    rotation(study)?;
    if let Some(footings) = footings {
        bent(study)?;
        soft(study)?;
        stiff(study)?;
        drained(study)?;
        push(study, footings)?;
    }
    Ok(())
}

/// Columns of 32 cells against the number of steps: S = 0.4 and S = 4.
fn column(study: &mut Study) -> Result<(), CaseError> {
    let height = |computed: &Computed<2>| ColumnResult::new(computed).top / column::HEIGHT;
    let error = |computed: &Computed<2>| ColumnResult::new(computed).stress_error;
    let steps = [5, 10, 20, 40, 80];
    let mut series = Vec::new();
    let mut lines = Vec::new();
    for (young, load) in [("100 kPa", 0.4_f64), ("10 kPa", 4.0)] {
        let results = Results::compute(&VARIANTS, "steps", &steps, |steps| {
            let mut case = column::case(32, young, ("gimp", true))?;
            case.stages[0].steps = steps;
            case.method.small_cuts = SmallCuts::default();
            Ok(case)
        })?;
        let exact = ColumnResult::new(results.at(0, 40)).exact_top / column::HEIGHT;
        let rate_law = (1.0 - (-load).exp()) / load;
        let quantity = "height over initial height [-]";
        for steps in [10, 80] {
            let name = format!("column, S = {load}, {steps} steps");
            let run = results.record(study, &name, 0, steps);
            let measured = height(results.at(0, steps));
            study.check(
                run,
                quantity,
                HENCKY_COLUMN.says(exact),
                Band::Relative(2e-3),
                measured,
            );
            let run = results.record(study, &name, 1, steps);
            let measured = height(results.at(1, steps));
            // At least ten times as far from the exact height as finite strain may be.
            let band = Band::AtMost(0.98 * exact);
            study.control(run, quantity, HENCKY_COLUMN.says(exact), band, measured);
            if steps == 80 {
                let quantity = "height over initial height, many steps [-]";
                let expected = SMALL_STRAIN_COLUMN.says(rate_law);
                study.check(run, quantity, expected, Band::Relative(0.02), measured);
            }
        }
        for (k, variant) in VARIANTS.iter().enumerate() {
            let style = SeriesStyle::LineAndMarkers(LineStyle::Solid);
            let label = format!("{}, S = {load}", variant.label);
            series.push(Series::new(label, results.curve(k, height), style));
        }
        lines.extend(
            [("exact", exact), ("rate law", rate_law)].map(|(label, y)| ReferenceLine {
                label: format!("{label}, S = {load}"),
                at: ReferenceValue::Y(y),
            }),
        );
        study.table(results.table(
            &format!("kinematics_column_{}", young.replace(' ', "")),
            &[
                ("height/initial_[-]", &height),
                ("stress_error_[-]", &error),
                ("corrections_per_step_[-]", &corrections),
            ],
        ))?;
    }
    CurvePlot {
        title: "Columns under self-weight, S = ρ_{0} g l_{0} / E".into(),
        x_label: "steps".into(),
        y_label: "height / initial height".into(),
        x_scale: Scale::Log,
        y_range: Some((0.0, 1.0)),
        lines,
        series,
        ..CurvePlot::default()
    }
    .write(&study.folder.join("kinematics_column"))?;
    Ok(())
}

/// A free block turned by 90°, against the number of steps.
fn rotation(study: &mut Study) -> Result<(), CaseError> {
    let method = |kinematics| Method {
        kinematics,
        ..Method::default()
    };
    let steps = [1, 3, 9, 18, 45, 90];
    let turned = steps
        .par_iter()
        .map(|&steps| {
            let finite = turn(&method(Kinematics::FiniteStrain), QUARTER, steps)?;
            let small = turn(&method(Kinematics::SmallStrain), QUARTER, steps)?;
            Ok([finite, small])
        })
        .collect::<Result<Vec<_>, CaseError>>()?;
    let header = [
        "steps",
        "finite_stress/E_[-]",
        "small_stress/E_[-]",
        "small_exact_[-]",
    ];
    let mut table = Table::new("kinematics_rotation", &header);
    for (&steps, [finite, small]) in steps.iter().zip(&turned) {
        // Round-off of the finite-strain run is no result.
        let expected = small_strain_turned(QUARTER, steps);
        let rounded = if finite.stress < 1e-12 {
            0.0
        } else {
            finite.stress
        };
        table.push(vec![steps as f64, rounded, small.stress, expected]);
        if steps != 1 && steps != 9 {
            continue;
        }
        let quantity = "largest stress / E after 90° [-]";
        let name = format!("finite strain: rotation in {steps} steps");
        let run = study.run(RunRecord::new(name, &finite.report, finite.elapsed));
        study.check(
            run,
            quantity,
            RIGID_ROTATION.says(0.0),
            Band::AtMost(1e-12),
            finite.stress,
        );
        let name = format!("small strain: rotation in {steps} steps");
        let run = study.run(RunRecord::new(name, &small.report, small.elapsed));
        study.control(
            run,
            quantity,
            SMALL_STRAIN_ROTATION.says(expected),
            Band::Relative(1e-6),
            small.stress,
        );
    }
    study.table(table)
}

/// The soft slope under its weight, and its weight raised until small strain or equilibrium ends.
fn soft(study: &mut Study) -> Result<(), CaseError> {
    let quantities: [Quantity<'_>; 3] = [
        ("displacement_[m]", &largest_displacement),
        ("corrections_per_step_[-]", &corrections),
        ("cuts_[-]", &cuts),
    ];
    let weight = Results::compute(&VARIANTS, "steps", &[5, 10, 20, 40], |steps| {
        soft_slope(1.0, 1.0, steps)
    })?;
    study.table(weight.table("kinematics_soft_slope", &quantities))?;
    let to_collapse = Results::compute(&VARIANTS, "steps", &[20, 40, 80], |steps| {
        soft_slope(1.0, 2.0, steps)
    })?;
    let factor = |computed: &Computed<2>| 2.0 * reached(computed);
    written(
        study,
        &to_collapse.table(
            "kinematics_soft_slope_to_collapse",
            &[
                ("gravity_factor_[-]", &factor),
                ("displacement_[m]", &largest_displacement),
            ],
        ),
    )
}

/// The cantilever under two and ten times its shipped load, against the number of steps.
fn bent(study: &mut Study) -> Result<(), CaseError> {
    for load in [2, 10] {
        let results = Results::compute(&VARIANTS, "steps", &[20, 80, 320], |steps| {
            cantilever(4, load, steps)
        })?;
        written(
            study,
            &results.table(
                &format!("kinematics_cantilever_load_{load}"),
                &[
                    ("share_of_load_reached_[-]", &reached),
                    ("deflection/L_[-]", &deflection),
                    ("corrections_per_step_[-]", &corrections),
                ],
            ),
        )?;
    }
    Ok(())
}

/// The factor of safety of the drained slope.
fn drained(study: &mut Study) -> Result<(), CaseError> {
    let results = Results::compute(&VARIANTS, "cell_[m]", &[1], |_| drained_slope())?;
    written(
        study,
        &results.table(
            "kinematics_drained_slope",
            &[
                ("factor_of_safety_[-]", &factor_of_safety),
                ("corrections_[-]", &corrections_of_trials),
            ],
        ),
    )
}

/// The collapse load of the stiff slope, D = 2, h = 1 m.
fn stiff(study: &mut Study) -> Result<(), CaseError> {
    let steps = [32, 64];
    let results = Results::compute(&VARIANTS, "steps", &steps, |steps| {
        let mut case = slope_to_collapse(&Collapse {
            depth_factor: 2.0,
            bbar: true,
            cell: 1.0,
        })?;
        case.stages[0].steps = steps;
        Ok(case)
    })?;
    let measured = |computed: &Computed<2>| limit(computed).unwrap_or(f64::INFINITY);
    let [lower, upper] = bounds(2.0);
    for k in 0..2 {
        let run = results.record(study, "stiff slope, D = 2, h = 1 m", k, 64);
        study.check(
            run,
            "γH/c_u at collapse [-]",
            BOUNDS.says(0.5 * (lower + upper)),
            Band::Between(0.98 * lower, 1.02 * upper),
            measured(results.at(k, 64)),
        );
    }
    written(
        study,
        &results.table(
            "kinematics_stiff_slope",
            &[
                ("gamma_H/c_u_[-]", &measured),
                ("corrections_per_step_[-]", &corrections),
            ],
        ),
    )
}

/// The footing pushed one width deep.
fn push(study: &mut Study, footings: &Footings) -> Result<(), CaseError> {
    let pushes = [
        ("default", "finite strain, 40 steps"),
        ("small-strain-40", "small strain, 40 steps"),
        ("small-strain-80", "small strain, 80 steps"),
    ];
    CurvePlot {
        title: "Rough footing, B/h = 5: finite and small strain".into(),
        x_label: "penetration w/B".into(),
        y_label: "resistance N = Q/(B s_{u}), compression positive".into(),
        series: pushes
            .iter()
            .map(|(name, label)| Series::line(*label, footing::resistance(footings.of(name))))
            .collect(),
        ..CurvePlot::default()
    }
    .write(&study.folder.join("kinematics_footing"))?;
    study.table(footings.table("kinematics_footing", &pushes.map(|(name, _)| (name, name))))
}
