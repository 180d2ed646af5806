//! The slope in Mohr–Coulomb soil: displacement against strength reduction factor, and the factor
//! of safety.

use std::fmt::Write as _;
use std::path::Path;

use igimp_cases::CaseError;
use igimp_figures::{
    ColourMap, CurvePlot, FieldPanel, LineStyle, ReferenceLine, ReferenceValue, Series, SeriesStyle,
};
use igimp_model::check::Band;
use igimp_results::measure::{displacement_norm, eps_p_eq};
use igimp_results::summary::TrialSummary;
use igimp_results::tables::table::Table;
use igimp_solver::Outcome;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::reference::griffiths_lane;
use crate::harness::study::{Level, RunRecord, Study};
use crate::pictures::contours;
use crate::runs::{Computed, Trial, mesh, method, shipped_case};

/// The book's description of the study.
const ABOUT: &str = "A 2:1 slope in drained soil, φ = 20°, ψ = 0: displacement against strength reduction factor, and the factor of safety.";
/// The displacements.
const GRIFFITHS_LANE: Oracle = Oracle {
    kind: OracleKind::Published,
    source: "Griffiths and Lane 1999",
    locator: "example 1, table 2",
};
/// The factor of safety.
const CHARTS: Oracle = Oracle {
    kind: OracleKind::Published,
    source: "Griffiths and Lane 1999; Bishop and Morgenstern 1960",
    locator: "example 1, table 2: (1.35, 1.40]; charts: 1.380",
};
/// The factor of safety on a coarse mesh, which no chart knows.
const SAME_MESH: Oracle = Oracle {
    kind: OracleKind::IndependentProgram,
    source: "independent iGIMP + B-bar program",
    locator: "same slope and mesh, h = 2 m",
};
/// Height H of the slope \[m\].
const HEIGHT: f64 = 10.0;
/// E δ_max / (γ H²) above which the slope counts as failed \[-\], as the case file says in metres.
const FAILURE_DISPLACEMENT: f64 = 1.0;

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("mohr-coulomb-slope", ABOUT, out)?;
    let mut meshes = vec![
        Mesh::new(1.0, true),
        Mesh::new(0.5, true),
        Mesh::new(0.5, false),
    ];
    if level == Level::Full {
        meshes.extend([Mesh::new(2.0, true), Mesh::new(0.25, true)]);
    }
    let found = meshes
        .par_iter()
        .map(Mesh::run)
        .collect::<Result<Vec<_>, _>>()?;
    for (mesh, found) in meshes.iter().zip(&found) {
        report(&mut study, mesh, found)?;
    }
    figures(&study, &meshes, &found)?;
    Ok(study)
}

/// One mesh and method.
struct Mesh {
    cell: f64,
    bbar: bool,
    label: String,
    slug: String,
}

/// The result on one mesh.
struct Found {
    /// The factors listed: 0.8 to 1.6.
    sweep: Vec<State>,
    /// Every trial, those of the sweep first.
    trials: Vec<(TrialSummary, f64)>,
    /// Largest factor found stable, smallest found failed.
    interval: [Option<f64>; 2],
    /// The trials that the search added.
    search: RunRecord,
}

/// The slope under full gravity at a reduced strength, or as far as it came.
struct State {
    trial: Trial<2>,
    /// E δ_max / (γ H²), δ_max over particles \[-\].
    displacement: f64,
    run: RunRecord,
}

impl Mesh {
    fn new(cell: f64, bbar: bool) -> Self {
        let name = if bbar { "iGIMP + B-bar" } else { "iGIMP" };
        let slug = format!("{}_h{cell}", if bbar { "igimp_bbar" } else { "igimp" });
        Self {
            cell,
            bbar,
            label: format!("{name}, h = {cell} m"),
            slug,
        }
    }

    /// The shipped slope: a sweep over strength reduction factors 0.8 to 1.6, then the search for
    /// the factor of safety.
    fn run(&self) -> Result<Found, CaseError> {
        let factors: Vec<String> = (16..=32)
            .map(|k| (f64::from(k) / 20.0).to_string())
            .collect();
        let mut overrides = mesh(self.cell, [36.0, HEIGHT + self.cell]);
        overrides.extend(method("gimp", self.bbar));
        overrides.push(format!(
            "stages.strength reduction.factors=[{}]",
            factors.join(", ")
        ));
        let computed = Computed::new(shipped_case("mohr_coulomb_slope", overrides)?)?;
        let material = &computed.case.materials[0];
        let scale = material.unit_weight * HEIGHT.powi(2) / material.young;
        let interval = computed
            .safety()
            .map(|safety| [safety.stable, safety.failed]);
        let mut made: Vec<State> = computed
            .trials
            .into_iter()
            .map(|trial| {
                let variant = format!("{}, SRF {:.2}", self.label, trial.summary.srf);
                State {
                    displacement: trial.summary.displacement / scale,
                    run: RunRecord::new(variant, &trial.report, trial.elapsed),
                    trial,
                }
            })
            .collect();
        let trials = made
            .iter()
            .map(|state| (state.trial.summary.clone(), state.displacement))
            .collect();
        let added: Vec<State> = made.drain(factors.len().min(made.len())..).collect();
        let search = RunRecord::sum(
            format!("{}, search", self.label),
            &added.iter().map(|state| &state.run).collect::<Vec<_>>(),
        );
        Ok(Found {
            sweep: made,
            trials,
            interval: interval.unwrap_or_default(),
            search,
        })
    }
}

impl Found {
    /// The middle of the interval \[-\]; not a number when one end is open.
    fn factor_of_safety(&self) -> f64 {
        match self.interval {
            [Some(stable), Some(failed)] => 0.5 * (stable + failed),
            _ => f64::NAN,
        }
    }
}

impl State {
    fn srf(&self) -> f64 {
        self.trial.summary.srf
    }

    fn stands(&self) -> bool {
        self.trial.summary.stable
    }
}

/// Displacement against strength reduction factor.
fn report(study: &mut Study, mesh: &Mesh, found: &Found) -> Result<(), CaseError> {
    let reference = griffiths_lane().points("srf", "E_delta_over_gamma_H2");
    let checked = mesh.slug == "igimp_bbar_h0.5";
    let mut table = Table::new(
        format!("displacement_{}", mesh.slug),
        &[
            "SRF_[-]",
            "E_delta_max/(gamma_H^2)_[-]",
            "stands_(1)_or_failed_(0)",
        ],
    );
    for slope in &found.sweep {
        let run = study.run(slope.run.clone());
        table.push(vec![
            slope.srf(),
            slope.displacement,
            f64::from(u8::from(slope.stands())),
        ]);
        for (srf, share) in [(0.8, 0.015), (1.0, 0.015), (1.2, 0.03), (1.3, 0.06)] {
            if checked && (slope.srf() - srf).abs() < 1e-9 {
                let expected = reference
                    .iter()
                    .find(|p| (p[0] - srf).abs() < 1e-9)
                    .map_or(f64::NAN, |p| p[1]);
                study.check(
                    run,
                    "E δ_max/(γH²) [-]",
                    GRIFFITHS_LANE.says(expected),
                    Band::Relative(share),
                    slope.displacement,
                );
            }
        }
        if (slope.srf() - 1.2).abs() < 1e-9 {
            study.newton(&mesh.slug, run)?;
        }
    }
    // Past failure the values hang on round-off: only the standing part is held in a snapshot.
    table.write_csv(&study.folder)?;
    table.rows.retain(|row| row[2] > 0.5);
    study.tables.push(table);

    factor_of_safety(study, mesh, found)
}

/// The interval, its criterion and the table of trials.
fn factor_of_safety(study: &mut Study, mesh: &Mesh, found: &Found) -> Result<(), CaseError> {
    let run = study.run(found.search.clone());
    let quantity = "factor of safety, middle of the interval [-]";
    let measured = found.factor_of_safety();
    match (mesh.cell, mesh.bbar) {
        (_, false) => study.control(
            run,
            quantity,
            CHARTS.says(1.380),
            Band::AtLeast(1.40),
            measured,
        ),
        (2.0.., true) => study.check(
            run,
            quantity,
            SAME_MESH.says(1.44),
            Band::Relative(0.02),
            measured,
        ),
        (cell, true) => {
            let band = if cell >= 1.0 {
                Band::Between(1.35, 1.42)
            } else {
                Band::Between(1.34, 1.40)
            };
            study.check(run, quantity, CHARTS.says(1.380), band, measured);
        }
    }
    let mut trials = Table::new(
        format!("factor_of_safety_{}", mesh.slug),
        &[
            "trial",
            "SRF_[-]",
            "E_delta_max/(gamma_H^2)_[-]",
            "stands_(1)_or_failed_(0)",
        ],
    );
    let end = |srf: Option<f64>| srf.map_or("?".into(), |srf| format!("{srf:.4}"));
    let mut note = format!("factor of safety, {}:\n", mesh.label);
    for (k, (trial, displacement)) in found.trials.iter().enumerate() {
        let stands = if trial.stable { "stands" } else { "failed" };
        let _ = writeln!(
            note,
            "  trial {:>2}  SRF {:.4}  E δ/(γH²) {:>7.3}  {stands}: {}",
            k + 1,
            trial.srf,
            displacement,
            trial.reason
        );
        let stands = f64::from(u8::from(trial.stable));
        trials.push(vec![k as f64 + 1.0, trial.srf, *displacement, stands]);
    }
    let _ = write!(
        note,
        "  {} ≤ factor of safety < {}, failed when there is no equilibrium or E δ/(γH²) > {}",
        end(found.interval[0]),
        end(found.interval[1]),
        FAILURE_DISPLACEMENT,
    );
    study.notes.push(note);
    trials.write_csv(&study.folder)?;
    trials
        .rows
        .iter_mut()
        .filter(|row| row[3] < 0.5)
        .for_each(|row| row[2] = FAILURE_DISPLACEMENT);
    study.tables.push(trials);
    Ok(())
}

fn figures(study: &Study, meshes: &[Mesh], found: &[Found]) -> Result<(), CaseError> {
    displacements(study, meshes, found)?;
    let fine = meshes
        .iter()
        .position(|mesh| mesh.slug == "igimp_bbar_h0.5")
        .unwrap_or(0);
    let at = |srf: f64| {
        found[fine]
            .sweep
            .iter()
            .find(|slope| (slope.srf() - srf).abs() < 1e-9)
    };
    let states: Vec<&State> = [1.0, 1.3, 1.35, 1.4].into_iter().filter_map(at).collect();
    fields(study, &states)
}

/// Displacement against strength reduction.
fn displacements(study: &Study, meshes: &[Mesh], found: &[Found]) -> Result<(), CaseError> {
    let mut series: Vec<Series> = meshes
        .iter()
        .zip(found)
        .map(|(mesh, found)| {
            let points = found
                .sweep
                .iter()
                .filter(|slope| slope.trial.report.outcome == Outcome::Completed)
                .map(|slope| [slope.srf(), slope.displacement])
                .collect();
            let style = SeriesStyle::LineAndMarkers(LineStyle::Solid);
            Series::new(mesh.label.clone(), points, style)
        })
        .collect();
    let reference = griffiths_lane().points("srf", "E_delta_over_gamma_H2");
    series.push(Series::new(
        "Griffiths & Lane 1999",
        reference,
        SeriesStyle::LineAndMarkers(LineStyle::Dashed),
    ));
    CurvePlot {
        title: "Slope in Mohr–Coulomb soil".into(),
        x_label: "strength reduction factor".into(),
        y_label: "E δ_{max} / (γH^{2})".into(),
        y_range: Some((0.0, 3.0)),
        lines: vec![ReferenceLine {
            label: "Bishop & Morgenstern 1.380".into(),
            at: ReferenceValue::X(1.380),
        }],
        series,
        ..CurvePlot::default()
    }
    .write(&study.folder.join("displacement_srf"))?;
    Ok(())
}

/// Displacement and plastic strain of states on the way to failure.
fn fields(study: &Study, states: &[&State]) -> Result<(), CaseError> {
    for (name, label, values) in [
        (
            "displacement",
            "displacement [m]",
            displacement_norm as fn(&_) -> Vec<f64>,
        ),
        (
            "plastic_strain",
            "accumulated plastic strain invariant [-]",
            eps_p_eq,
        ),
    ] {
        // Each state has its own range: they differ by orders of magnitude across failure.
        for slope in states {
            let stands = if slope.stands() { "stands" } else { "failed" };
            let title = format!("Mohr–Coulomb slope, SRF {:.2}: {stands}", slope.srf());
            contours(
                title,
                &slope.trial.particles,
                values(&slope.trial.particles),
                label,
                ColourMap::Sequential,
                None,
            )
            .write(&study.folder.join(format!("{name}_srf_{:.2}", slope.srf())))?;
        }
    }
    let plots = states
        .iter()
        .filter(|slope| slope.stands())
        .map(|slope| {
            contours(
                format!("SRF {:.2}", slope.srf()),
                &slope.trial.particles,
                eps_p_eq(&slope.trial.particles),
                "accumulated plastic strain invariant [-]",
                ColourMap::Sequential,
                None,
            )
        })
        .collect();
    FieldPanel {
        title: "Towards failure".into(),
        columns: 1,
        plots,
    }
    .write(&study.folder.join("plastic_strain_before_failure"))?;
    Ok(())
}
