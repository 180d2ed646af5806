//! Results of the made-up run: tables, trials, the summary, the convergence.

use igimp_model::check::{Band, Check};
use igimp_model::{Monitor, Section};
use igimp_results::model_size::ModelSize;
use igimp_results::summary::{CheckRow, SafetySummary, StageSummary, Summary, TrialSummary};
use igimp_results::tables::table::Table;

use super::example::case;

pub(crate) fn curve_table() -> Table {
    let mut table = Table::new("load-settlement", &["d/B_[-]", "q/cu_[-]"]);
    for k in 0..=30 {
        let d = f64::from(k) / 300.0;
        table.push(vec![d, 5.25 * (1.0 - (-60.0 * d).exp())]);
    }
    table
}

pub(crate) fn monitor_table(monitor: &Monitor<2>) -> Table {
    let headers: Vec<String> = monitor.record.iter().map(|&f| f.header()).collect();
    let mut names = vec!["stage", "step"];
    names.extend(headers.iter().map(String::as_str));
    let mut table = Table::new("crest", &names);
    for k in 1..=25 {
        let t = f64::from(k) / 25.0;
        let down = 0.04 * t * t;
        table.push(vec![
            if k <= 10 { 1.0 } else { 2.0 },
            f64::from(k),
            1.1 * down,
            -down,
            0.1 * t.powi(4),
        ]);
    }
    table
}

pub(crate) fn section_table(section: &Section<2>) -> Table {
    let headers: Vec<String> = section.record.iter().map(|&f| f.header()).collect();
    let mut names = vec!["distance_[m]"];
    names.extend(headers.iter().map(String::as_str));
    let mut table = Table::new(format!("{}__surcharge", section.name), &names);
    let length = (section.to[0] - section.from[0]).hypot(section.to[1] - section.from[1]);
    for k in 0..section.points {
        let t = (k as f64 + 0.5) / section.points as f64;
        let depth = 13.0 * (1.0 - t);
        let wave = 1.0 + 0.1 * (9.0 * t).sin();
        table.push(vec![
            t * length,
            9e3 * depth * wave,
            20e3 * depth,
            11e3 * depth,
            0.4 + 0.5 * t,
        ]);
    }
    table
}

pub(crate) fn safety() -> SafetySummary {
    let trial = |srf: f64, stable: bool, displacement: f64| TrialSummary {
        srf,
        stable,
        reason: if stable {
            "equilibrium"
        } else {
            "no equilibrium: the residual stagnates"
        }
        .into(),
        displacement,
        steps: 10,
        iterations: 48,
        cuts: if stable { 0 } else { 5 },
        course: Vec::new(),
    };
    SafetySummary {
        stable: Some(1.375),
        failed: Some(1.3828),
        criterion: "no equilibrium, or the crest moves by 0.5 m".into(),
        materials: vec!["clay".into()],
        excluded: vec!["rock".into()],
        moving_mass: Some(0.27),
        trials: vec![
            trial(1.0, true, 0.021),
            trial(2.0, false, 0.19),
            trial(1.5, false, 0.16),
            trial(1.25, true, 0.035),
            trial(1.375, true, 0.071),
            trial(1.4375, false, 0.14),
            trial(1.3828, false, 0.12),
        ],
        path: None,
    }
}

pub(crate) fn summary() -> Summary {
    let stage = |name: &str, kind: &str, seconds: f64| StageSummary {
        name: name.into(),
        kind: kind.into(),
        reason: "it reached its end".into(),
        reached: 1.0,
        steps: 10,
        iterations: 43,
        seconds,
        phases: [0.02, 0.3, 0.28, 0.35, 0.05].map(|share| share * seconds),
        largest_displacement: 0.0213,
        plastic_share: 0.034,
        ..StageSummary::default()
    };
    let check = |quantity: &str, expected: f64, measured: f64, band: Band| {
        let check = Check {
            case: "slope".into(),
            variant: String::new(),
            quantity: quantity.into(),
            expected,
            source: "Griffiths & Lane (1999), Géotechnique 49(3), table 2".into(),
            band,
            measured,
            unit: None,
        };
        CheckRow::held(check)
    };
    Summary {
        failure: None,
        program: "igimp 0.1.0".into(),
        title: case().title,
        method: "iGIMP, B-bar, finite strain".into(),
        size: ModelSize {
            axisymmetric: false,
            dimensions: 2,
            particles: 10_240,
            cells: 5_280,
            unknowns: 7_934,
            weight: 1.86e7,
            volume: 912.5,
        },
        stages: vec![
            stage("initial stresses", "gravity", 4.31),
            stage("surcharge", "load", 6.8),
            StageSummary {
                safety: Some(safety()),
                iterations: 336,
                steps: 70,
                cuts: 20,
                at_round_off: 2,
                plastic_share: 0.31,
                largest_displacement: 0.19,
                ..stage("factor of safety", "strength-reduction", 83.2)
            },
        ],
        checks: vec![
            check("factor of safety [-]", 1.38, 1.3789, Band::Relative(0.02)),
            check(
                "settlement of the crest [mm]",
                20.0,
                21.3,
                Band::Relative(0.05),
            ),
        ],
        warnings: vec!["The bracket was widened: F = 2 was thought unstable and is.".into()],
        figures: Vec::new(),
        seconds: 96.4,
        output_seconds: 2.1,
        peak_memory_mib: Some(312.4),
        memory: None,
        interrupted: false,
        ..Summary::default()
    }
}

pub(crate) const CONVERGENCE_HEADER: &str =
    "stage,step,from,to,iteration,relative_out_of_balance,accepted\n";

/// Quadratic convergence in every step, but for a cut one.
pub(crate) fn convergence() -> String {
    let mut text = CONVERGENCE_HEADER.to_owned();
    for (stage, steps) in [("initial stresses", 10), ("factor of safety", 70)] {
        for step in 1..=steps {
            let (from, to) = (0.1 * f64::from(step - 1), 0.1 * f64::from(step));
            let row = |text: &mut String, iteration: u32, norm: f64, accepted: bool| {
                let line = format!("{stage},{step},{from},{to},{iteration},{norm:e},{accepted}");
                text.extend([line.as_str(), "\n"]);
            };
            let mut residual = 0.3 / f64::from(step);
            if step % 17 == 16 {
                for iteration in 0..12 {
                    let stuck = 8e-2 * (1.0 + 0.4 * (1.3 * f64::from(iteration)).sin());
                    row(&mut text, iteration, stuck, false);
                }
            }
            for iteration in 0..6 {
                row(&mut text, iteration, residual, true);
                residual = (0.8 * residual * residual.sqrt()).max(3e-13 * (1.0 + f64::from(step)));
            }
        }
    }
    text
}
