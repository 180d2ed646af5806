//! A made-up run of a slope with everything that a results folder can hold.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use igimp_assembly::Geometry;
use igimp_assembly::{Method, ParticleFields, Particles, SharedLaw};
use igimp_geometry::seed::fill_polygon;
use igimp_model::{
    Average, BodyPart, Boundaries, Case, Curve, CurveAxis, Drainage, Every, Field, FixedBox,
    GridSpec, Load, LoadKind, Material, MeshStudy, Monitor, Output, Profiles, Quantity, Reference,
    ReferenceValues, Section, Side, SolverSettings, Stage, StageKind, StopWhen, Strength,
    TitleBlock,
};
use igimp_report::patches::Pieces;
use igimp_report::pictures::{self, Canvas, Shown};
use igimp_results::fields::Axes;
use igimp_results::summary::{FigureNote, Summary};

use super::findings;

/// An empty folder that stays after the test, to be looked at.
pub(crate) fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("report")
        .join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn stage(name: &str, kind: StageKind) -> Stage {
    Stage {
        name: name.into(),
        kind,
        steps: 10,
        geometry: Geometry::Moving,
        start_from: None,
        reset_displacements: false,
        install: Vec::new(),
        stop_when: StopWhen::default(),
        drained: false,
        consolidation: None,
    }
}

pub(crate) fn case() -> Case<2> {
    Case {
        title: "10 m cut slope, 1:1, c-φ soil on rock".into(),
        title_block: TitleBlock::default(),
        gravity: 9.81,
        grid: GridSpec::equal([0.0, 0.0], [0.5, 0.5], [120, 44]),
        method: Method::default(),
        water_unit_weight: 9.81e3,
        water: Vec::new(),
        materials: materials(),
        bodies: bodies(),
        boundaries: Boundaries {
            sides: [[Side::Roller; 2], [Side::Fixed, Side::Free]],
            boxes: vec![FixedBox {
                name: "anchor".into(),
                lower: [52.0, 6.0],
                upper: [54.0, 8.0],
                fix: [true, true],
            }],
        },
        loads: loads(),
        rigid: Vec::new(),
        reinforcement: Vec::new(),
        stages: stages(),
        solver: SolverSettings::default(),
        given_solver: None,
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
        mesh_study: MeshStudy::default(),
        output: Output {
            folder: "results/slope".into(),
            paraview: Every::Stage,
            figures: Vec::new(),
            cuts: Vec::new(),
            report: true,
            checkpoint_every: 10,
            checkpoint_keep: 2,
        },
    }
}

fn bodies() -> Vec<BodyPart<2>> {
    let body = |name: &str, material, polygon: &[[f64; 2]]| BodyPart {
        name: name.into(),
        material,
        per_direction: 2,
        region: Arc::new(polygon.to_vec()),
        from_start: true,
    };
    let slope = [
        [0.0, 2.0],
        [60.0, 2.0],
        [60.0, 10.0],
        [25.0, 10.0],
        [15.0, 20.0],
        [0.0, 20.0],
    ];
    let rock = [[0.0, 0.0], [60.0, 0.0], [60.0, 2.0], [0.0, 2.0]];
    vec![body("slope", 0, &slope), body("bedrock", 1, &rock)]
}

fn stages() -> Vec<Stage> {
    let weight = StageKind::Gravity {
        factor: 1.0,
        horizontal: None,
        across: None,
        vertical: None,
    };
    let surcharge = StageKind::Load {
        loads: vec![0],
        factor: 1.0,
    };
    vec![
        stage("initial stresses", weight),
        stage("surcharge", surcharge),
    ]
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
            flow: igimp_model::Flow::Dilation,
            tension_cutoff: None,
        },
        k0: None,
        profiles: Profiles::default(),
        permeability: None,
        void_law: None,
        softening: None,
        saturated: None,
        drainage: Drainage::Drained,
        given: None,
    };
    let rock = Material {
        name: "rock".into(),
        strength: Strength::Elastic,
        ..clay.clone()
    };
    vec![clay, rock]
}

fn loads() -> Vec<Load<2>> {
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

fn section(name: &str, from: [f64; 2], to: [f64; 2]) -> Section<2> {
    Section {
        name: name.into(),
        from,
        to,
        points: 30,
        record: vec![Field::SigmaXx, Field::SigmaYy, Field::Q, Field::Utilisation],
        average: Average::None,
        references: Vec::new(),
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
pub(crate) fn particles(case: &Case<2>) -> (Particles<2>, Vec<SharedLaw>) {
    let laws: Vec<SharedLaw> = case.materials.iter().map(|m| m.law().unwrap()).collect();
    let grid = case.grid.grid().unwrap();
    let seeds: Vec<_> = case
        .bodies
        .iter()
        .flat_map(|body| {
            let density = case.materials[body.material].unit_weight / case.gravity;
            fill_polygon(
                &grid,
                body.polygon(),
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
        let eps_e = laws[fields.law[p]].stiffness_bound().strain(&sigma);
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
        fields.eps_p_eq[p] = 0.2 * (-((radius - 14.0) / 0.6).powi(2)).exp();
    }
    (Particles::from_fields(fields).unwrap(), laws)
}

/// Every picture of the run, written into its folder.
pub(crate) fn draw(folder: &Path, case: &Case<2>) -> Vec<FigureNote> {
    let title = case.title.as_str();
    let mut notes = vec![pictures::model_picture(folder, case).unwrap()];
    notes.push(pictures::curve_picture(folder, title, &curve(), &findings::curve_table()).unwrap());
    notes.push(
        pictures::safety_picture(folder, title, "factor of safety", &findings::safety()).unwrap(),
    );
    for monitor in &case.monitors {
        let table = findings::monitor_table(monitor);
        notes.extend(pictures::monitor_pictures(folder, case, monitor, &table).unwrap());
    }
    for section in &case.sections {
        let table = findings::section_table(section);
        let drawn = pictures::section_pictures(
            folder,
            (title, Axes::Plane),
            section,
            "surcharge",
            &[],
            &table,
        );
        notes.extend(drawn.unwrap());
    }
    let (particles, laws) = particles(case);
    let pieces = Pieces::of(case).unwrap();
    let canvas = Canvas {
        folder,
        case,
        pieces: &pieces,
    };
    for field in [
        Field::Displacement,
        Field::SigmaYy,
        Field::TauXy,
        Field::PlasticStrain,
        Field::Utilisation,
    ] {
        let state = pictures::Seen {
            particles: &particles,
            laws: &laws,
        };
        let shown = Shown::end_of_stage(case, 1);
        notes.push(
            pictures::field_picture(
                &canvas,
                &shown,
                field,
                state,
                &[],
                &pictures::Over::default(),
            )
            .unwrap(),
        );
    }
    notes
}

/// A results folder with a summary and whatever else belongs to it.
pub(crate) fn write(folder: &Path, summary: &Summary) {
    let case = case();
    for name in ["curves", "monitors", "sections"] {
        std::fs::create_dir_all(folder.join(name)).unwrap();
    }
    findings::curve_table()
        .write_csv(&folder.join("curves"))
        .unwrap();
    findings::monitor_table(&case.monitors[0])
        .write_csv(&folder.join("monitors"))
        .unwrap();
    for section in &case.sections {
        findings::section_table(section)
            .write_csv(&folder.join("sections"))
            .unwrap();
    }
    std::fs::write(folder.join("convergence.csv"), findings::convergence()).unwrap();
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
