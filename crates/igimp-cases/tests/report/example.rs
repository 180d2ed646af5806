//! A made-up run of a slope with everything that a results folder can hold.

use std::path::{Path, PathBuf};

use igimp_assembly::{Method, ParticleFields, Particles, SharedLaw};
use igimp_cases::case::{
    BodyPart, Boundaries, Case, Curve, CurveAxis, Every, Field, FixedBox, GridSpec, Load, LoadKind,
    Material, Monitor, Output, Quantity, Reference, ReferenceValues, Section, Side, SolverSettings,
    Stage, StageKind, StopWhen, Strength,
};
use igimp_cases::check::{Band, Check};
use igimp_cases::results::{fields, pictures};
use igimp_cases::seed::fill_polygon;
use igimp_cases::summary::{
    CheckRow, FigureNote, ModelSize, SafetySummary, StageSummary, Summary, TrialSummary,
};
use igimp_cases::table::Table;
use igimp_shape::{Axis, Grid};

/// An empty folder that stays after the test, to be looked at.
pub(crate) fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("report")
        .join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

pub(crate) fn case() -> Case {
    let stage = |name: &str, kind| Stage {
        name: name.into(),
        kind,
        steps: 10,
        start_from: None,
        reset_displacements: false,
        stop_when: StopWhen::default(),
    };
    let body = |name: &str, material, polygon: &[[f64; 2]]| BodyPart {
        name: name.into(),
        material,
        per_direction: 2,
        polygon: polygon.to_vec(),
    };
    let slope = [
        [0.0, 2.0],
        [60.0, 2.0],
        [60.0, 10.0],
        [25.0, 10.0],
        [15.0, 20.0],
        [0.0, 20.0],
    ];
    Case {
        title: "10 m cut slope, 1:1, c-φ soil on rock".into(),
        gravity: 9.81,
        grid: GridSpec {
            cell: [0.5, 0.5],
            lower: [0.0, 0.0],
            cells: [120, 44],
        },
        method: Method::default(),
        materials: materials(),
        bodies: vec![
            body("slope", 0, &slope),
            body(
                "bedrock",
                1,
                &[[0.0, 0.0], [60.0, 0.0], [60.0, 2.0], [0.0, 2.0]],
            ),
        ],
        boundaries: Boundaries {
            left: Side::Roller,
            right: Side::Roller,
            bottom: Side::Fixed,
            top: Side::Free,
            boxes: vec![FixedBox {
                name: "anchor".into(),
                lower: [52.0, 6.0],
                upper: [54.0, 8.0],
                fix: [true, true],
            }],
        },
        loads: loads(),
        stages: vec![
            stage("initial stresses", StageKind::Gravity { factor: 1.0 }),
            stage(
                "surcharge",
                StageKind::Load {
                    loads: vec![0],
                    factor: 1.0,
                },
            ),
        ],
        solver: SolverSettings::default(),
        monitors: vec![Monitor {
            name: "crest".into(),
            point: [15.0, 20.0],
            record: vec![
                Field::Displacement,
                Field::DisplacementY,
                Field::PlasticStrain,
            ],
        }],
        sections: vec![
            section("A-A", [20.0, 2.0], [20.0, 15.0]),
            section("B-B", [0.0, 4.0], [60.0, 4.0]),
        ],
        curves: vec![curve()],
        checks: Vec::new(),
        output: Output {
            folder: "results/slope".into(),
            paraview: Every::Stage,
            figures: Vec::new(),
            report: true,
            checkpoint_every: 10,
            checkpoint_keep: 2,
        },
    }
}

fn materials() -> Vec<Material> {
    let clay = Material {
        name: "clay".into(),
        unit_weight: 20e3,
        young: 20e6,
        poisson: 0.3,
        strength: Strength::MohrCoulomb {
            cohesion: 10e3,
            friction_angle: 20_f64.to_radians(),
            dilation_angle: 0.0,
            tension_cutoff: None,
        },
        k0: None,
    };
    let rock = Material {
        name: "rock".into(),
        strength: Strength::Elastic,
        ..clay.clone()
    };
    vec![clay, rock]
}

fn loads() -> Vec<Load> {
    let load = |name: &str, kind| Load {
        name: name.into(),
        kind,
    };
    vec![
        load(
            "traffic",
            LoadKind::Pressure {
                from: [6.0, 20.0],
                to: [14.0, 20.0],
                traction: [0.0, -20e3],
            },
        ),
        load(
            "footing",
            LoadKind::RigidFooting {
                from: [32.0, 10.0],
                to: [36.0, 10.0],
                rough: true,
                reaction_factor: 1.0,
            },
        ),
        load(
            "pull",
            LoadKind::Point {
                at: [45.0, 10.0],
                force: [20e3, 20e3],
            },
        ),
    ]
}

fn section(name: &str, from: [f64; 2], to: [f64; 2]) -> Section {
    Section {
        name: name.into(),
        from,
        to,
        points: 30,
        record: vec![Field::SigmaXx, Field::SigmaYy, Field::Q, Field::Utilisation],
    }
}

pub(crate) fn curve() -> Curve {
    let axis = |of, label: &str| CurveAxis {
        of,
        divide_by: 1.0,
        label: label.into(),
    };
    Curve {
        name: "load-settlement".into(),
        x: axis(Quantity::Settlement(0), "d / B [−]"),
        y: axis(Quantity::Reaction(0), "q / c_{u} [−]"),
        stage: None,
        reference: Some(Reference {
            label: "Prandtl, 2 + π".into(),
            values: ReferenceValues::Level {
                y: 5.1416,
                at: None,
            },
            tolerance: Some(0.05),
        }),
    }
}

/// The slope with stresses that grow with depth and a slide along a circle.
pub(crate) fn particles(case: &Case) -> (Particles<2>, Vec<SharedLaw>) {
    let laws: Vec<SharedLaw> = case.materials.iter().map(|m| m.law().unwrap()).collect();
    let axis = |k: usize| Axis::uniform(case.grid.lower[k], case.grid.cell[k], case.grid.cells[k]);
    let grid = Grid::new([axis(0).unwrap(), axis(1).unwrap()]);
    let seeds: Vec<_> = case
        .bodies
        .iter()
        .flat_map(|body| {
            let density = case.materials[body.material].unit_weight / case.gravity;
            fill_polygon(
                &grid,
                &body.polygon,
                body.per_direction,
                density,
                body.material,
            )
            .unwrap()
        })
        .collect();
    let mut fields: ParticleFields<2> = (*Particles::new(&seeds).unwrap()).clone();
    for p in 0..fields.x.len() {
        let [x, y] = fields.x[p];
        let surface = (20.0 - (x - 15.0).max(0.0)).max(10.0);
        let depth = (surface - y).max(0.0);
        let radius = (x - 27.0).hypot(y - 24.0);
        let slide = 1.0 / (1.0 + ((radius - 14.0) / 0.4).exp());
        let sigma = [-9e3 * depth, -20e3 * depth, -8.7e3 * depth];
        let eps_e = laws[fields.law[p]].elasticity().strain(&sigma);
        for a in 0..3 {
            fields.sigma[p][a][a] = sigma[a];
            fields.b_e[p][a][a] = (2.0 * eps_e[a]).exp();
        }
        let shear = 4e3 * ((x - 27.0) / 8.0).tanh() * depth.min(4.0);
        (fields.sigma[p][0][1], fields.sigma[p][1][0]) = (shear, shear);
        let turn = 0.05 * slide;
        fields.displacement[p] = [turn * (24.0 - y), turn * (x - 27.0)];
        for axis in 0..2 {
            fields.x[p][axis] += fields.displacement[p][axis];
        }
        fields.history[p].eps_p_eq = 0.2 * (-((radius - 14.0) / 0.6).powi(2)).exp();
    }
    (Particles::from_fields(fields).unwrap(), laws)
}

pub(crate) fn curve_table() -> Table {
    let mut table = Table::new("load-settlement", &["d/B_[-]", "q/cu_[-]"]);
    for k in 0..=30 {
        let d = f64::from(k) / 300.0;
        table.push(vec![d, 5.25 * (1.0 - (-60.0 * d).exp())]);
    }
    table
}

pub(crate) fn monitor_table(monitor: &Monitor) -> Table {
    let headers: Vec<String> = monitor.record.iter().map(|&f| fields::header(f)).collect();
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

pub(crate) fn section_table(section: &Section) -> Table {
    let headers: Vec<String> = section.record.iter().map(|&f| fields::header(f)).collect();
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
        };
        let pass = check.passes();
        CheckRow { check, pass }
    };
    Summary {
        program: "igimp 0.1.0".into(),
        title: case().title,
        method: "iGIMP, B-bar, finite strain".into(),
        size: ModelSize {
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
        interrupted: false,
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
            let mut residual = 0.3 / f64::from(step);
            if step % 17 == 16 {
                for iteration in 0..12 {
                    let stuck = 8e-2 * (1.0 + 0.4 * (1.3 * f64::from(iteration)).sin());
                    text += &format!("{stage},{step},{from},{to},{iteration},{stuck:e},false\n");
                }
            }
            for iteration in 0..6 {
                text += &format!("{stage},{step},{from},{to},{iteration},{residual:e},true\n");
                residual = (0.8 * residual * residual.sqrt()).max(3e-13 * (1.0 + f64::from(step)));
            }
        }
    }
    text
}

/// Every picture of the run, written into its folder.
pub(crate) fn draw(folder: &Path, case: &Case) -> Vec<FigureNote> {
    let title = case.title.as_str();
    let mut notes = vec![pictures::model_picture(folder, case).unwrap()];
    notes.push(pictures::curve_picture(folder, title, &curve(), &curve_table()).unwrap());
    notes.push(pictures::safety_picture(folder, title, "factor of safety", &safety()).unwrap());
    for monitor in &case.monitors {
        let table = monitor_table(monitor);
        notes.extend(pictures::monitor_pictures(folder, title, monitor, &table).unwrap());
    }
    for section in &case.sections {
        let table = section_table(section);
        let stage = "surcharge";
        notes.extend(pictures::section_pictures(folder, title, section, stage, &table).unwrap());
    }
    let (particles, laws) = particles(case);
    for field in [
        Field::Displacement,
        Field::SigmaYy,
        Field::TauXy,
        Field::PlasticStrain,
        Field::Utilisation,
    ] {
        let state = (&particles, laws.as_slice());
        notes.push(pictures::field_picture(folder, case, 1, field, state, &[]).unwrap());
    }
    notes
}

/// A results folder with a summary and whatever else belongs to it.
pub(crate) fn write(folder: &Path, summary: &Summary) {
    let case = case();
    for name in ["curves", "monitors", "sections"] {
        std::fs::create_dir_all(folder.join(name)).unwrap();
    }
    curve_table().write_csv(&folder.join("curves")).unwrap();
    monitor_table(&case.monitors[0])
        .write_csv(&folder.join("monitors"))
        .unwrap();
    for section in &case.sections {
        section_table(section)
            .write_csv(&folder.join("sections"))
            .unwrap();
    }
    std::fs::write(folder.join("convergence.csv"), convergence()).unwrap();
    std::fs::write(
        folder.join("case.toml"),
        "[case]\ntitle = \"a < b & c\"\n".repeat(30),
    )
    .unwrap();
    std::fs::write(
        folder.join("case.completed.toml"),
        "[solver]\ntolerance = 1e-9\n",
    )
    .unwrap();
    let json = serde_json::to_string_pretty(summary).unwrap();
    std::fs::write(folder.join("summary.json"), json).unwrap();
}
