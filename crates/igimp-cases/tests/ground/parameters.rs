//! GOAL: every parameter of a law may vary from place to place, and soil has there what it would have with a material of its own.
//! ORACLE: constants where nothing changes; a material for each layer where a profile is a step on a line of the grid; formulas by hand.

use std::fmt::Write as _;

use igimp_cases::run::{Model, Run, Start, in_memory};
use igimp_input::CaseFile;
use igimp_model::Case;
use igimp_report::setup;

use crate::resuming::{assert_done, assert_equal, everything, folder, run_into};

const CLAY: &str = "model = \"modified-cam-clay\"\nlambda = 0.12\nkappa = 0.02\nfriction = \"25 deg\"\npoisson = 0.25\nocr = 1.5\nk0 = 0.6\n";
const SAND: &str = "model = \"hardening-soil\"\ncohesion = \"2 kPa\"\nfriction = \"34 deg\"\ndilation = \"4 deg\"\ne50 = \"20 MPa\"\n\
    power = 0.6\nocr = 1.5\nk0 = 0.5\n";
const ROCK: &str = "model = \"hoek-brown\"\nsci = \"1 MPa\"\ngsi = 30\nmi = 10\ndilation = \"2 deg\"\nyoung = \"100 MPa\"\npoisson = 0.3\nk0 = 0.6\n";
const SOIL: &str = "model = \"mohr-coulomb\"\ncohesion = \"10 kPa\"\nfriction = \"25 deg\"\ndilation = \"5 deg\"\ntension_cutoff = \"2 kPa\"\n\
    young = \"20 MPa\"\npoisson = 0.3\nk0 = 0.6\n";

/// Stages: at rest, and then a strip that is loaded.
const LOADED: &str = "[[stages]]\nname = \"rest\"\ntype = \"k0\"\nsteps = 1\n\
    [[stages]]\nname = \"load\"\ntype = \"load\"\nload = \"p\"\nfactor = 1\nsteps = 4\ngeometry = \"given\"\n";

/// Ground of 4 m by 4 m, a body of `low` below 2 m and one of `high` above, under a strip.
fn text((low, high): (&str, &str), stages: &str) -> String {
    format!(
        "igimp = 1\n[case]\ntitle = \"ground\"\n[grid]\ncell = \"0.5 m\"\ndomain = {{ x = [\"0 m\", \"4 m\"], y = [\"0 m\", \"5 m\"] }}\n\
        [materials.low]\nunit_weight = \"20 kN/m3\"\n{low}[materials.high]\nunit_weight = \"20 kN/m3\"\n{high}\
        [[bodies]]\nname = \"low\"\nmaterial = \"low\"\npolygon = [[\"0 m\",\"0 m\"],[\"4 m\",\"0 m\"],[\"4 m\",\"2 m\"],[\"0 m\",\"2 m\"]]\n\
        [[bodies]]\nname = \"high\"\nmaterial = \"high\"\npolygon = [[\"0 m\",\"2 m\"],[\"4 m\",\"2 m\"],[\"4 m\",\"4 m\"],[\"0 m\",\"4 m\"]]\n\
        [boundaries]\nleft = \"roller\"\nright = \"roller\"\nbottom = \"fixed\"\n\
        [[loads]]\nname = \"p\"\ntype = \"pressure\"\nfrom = [\"0 m\",\"4 m\"]\nto = [\"1.5 m\",\"4 m\"]\npressure = \"120 kPa\"\n\
        {stages}[output]\nreport = false\nfigures = []\n"
    )
}

fn file(text: &str) -> CaseFile {
    CaseFile::parse("ground.toml", text, &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn run(text: &str) -> Run<2> {
    let run = in_memory(file(text).case()).unwrap();
    assert!(run.failure.is_none(), "{:?}", run.failure);
    run
}

/// The text with another value of a key.
fn with(text: &str, key: &str, value: &str) -> String {
    let line = text
        .lines()
        .find(|line| line.split(" = ").next() == Some(key));
    text.replacen(
        line.unwrap_or_else(|| panic!("{key}")),
        &format!("{key} = {value}"),
        1,
    )
}

/// A step between two values at y = 2 m, on a line of the grid and on no particle.
fn step(low: &str, high: &str) -> String {
    format!(
        "{{ levels = [\"4 m\", \"2.01 m\", \"1.99 m\", \"0 m\"], values = [{high}, {high}, {low}, {low}] }}"
    )
}

/// The keys with a value, and another.
const KEYS: [(&str, &str, &str, &str); 21] = [
    (SOIL, "dilation", "\"5 deg\"", "\"15 deg\""),
    (SOIL, "poisson", "0.3", "0.4"),
    (SOIL, "tension_cutoff", "\"2 kPa\"", "\"1 kPa\""),
    (ROCK, "sci", "\"1 MPa\"", "\"2 MPa\""),
    (ROCK, "gsi", "30", "45"),
    (ROCK, "mi", "10", "8"),
    (ROCK, "dilation", "\"2 deg\"", "\"6 deg\""),
    (ROCK, "poisson", "0.3", "0.2"),
    (CLAY, "lambda", "0.12", "0.2"),
    (CLAY, "kappa", "0.02", "0.03"),
    (CLAY, "friction", "\"25 deg\"", "\"30 deg\""),
    (CLAY, "poisson", "0.25", "0.3"),
    (CLAY, "ocr", "1.5", "3"),
    (SAND, "cohesion", "\"2 kPa\"", "\"8 kPa\""),
    (SAND, "friction", "\"34 deg\"", "\"38 deg\""),
    (SAND, "dilation", "\"4 deg\"", "\"8 deg\""),
    (SAND, "e50", "\"20 MPa\"", "\"30 MPa\""),
    (SAND, "power", "0.6", "0.8"),
    (SAND, "ocr", "1.5", "2.5"),
    (SAND, "ocr", "1.5", "1.5"),
    (ROCK, "gsi", "30", "30"),
];

/// GOAL: a step of a parameter at a line of the grid is what two materials make of it, to the last bit; where the step is none it is the
/// constant.
#[test]
fn a_step_is_a_material_for_each_layer() {
    for (soil, key, low, high) in KEYS {
        let [below, above] = [low, high].map(|value| with(soil, key, value));
        let apart = run(&text((&below, &above), LOADED));
        let varied = with(soil, key, &step(low, high));
        let one = run(&text((&varied, &varied), LOADED));
        let [apart, one] = [&apart, &one].map(|run| {
            let particles = &run.body.particles;
            (
                particles.sigma.clone(),
                particles.displacement.clone(),
                particles.internal.clone(),
            )
        });
        assert!(apart == one, "{key} of {}", soil.lines().next().unwrap());
    }
}

/// GOAL: the same of soil that a stage makes of bodies that had other laws, and of soil that comes to have one law again.
#[test]
fn a_stage_makes_soil_of_parameters_that_vary() {
    let swap = |low: &str, high: &str| {
        format!(
            "{LOADED}[[stages]]\nname = \"{low}\"\ntype = \"construction\"\nsteps = 2\ngeometry = \"given\"\n\
             materials = [{{ body = \"low\", material = \"{low}\" }}, {{ body = \"high\", material = \"{high}\" }}]\n\
             [[stages]]\nname = \"more\"\ntype = \"load\"\nload = \"p\"\nfactor = 1.2\nsteps = 2\ngeometry = \"given\"\n"
        )
    };
    let weight = "unit_weight = \"20 kN/m3\"";
    let treated = SOIL.replace("10 kPa", "14 kPa");
    let [first, second] =
        ["2", "9"].map(|angle| with(&treated, "dilation", &format!("\"{angle} deg\"")));
    let varied = with(&treated, "dilation", &step("\"2 deg\"", "\"9 deg\""));
    let materials = format!(
        "[materials.first]\n{weight}\n{first}[materials.second]\n{weight}\n{second}[materials.varied]\n{weight}\n{varied}"
    );
    let soil = with(SOIL, "poisson", &step("0.3", "0.35"));
    let [apart, one] = [("first", "second"), ("varied", "varied")].map(|(low, high)| {
        let whole = text((&soil, &soil), &swap(low, high));
        run(&whole.replacen("[[bodies]]", &format!("{materials}[[bodies]]"), 1))
    });
    assert!(apart.body.particles.sigma == one.body.particles.sigma);
    assert!(apart.body.particles.displacement == one.body.particles.displacement);
}

/// GOAL: clay at rest has the preconsolidation pressure that its ratio of overconsolidation says at its place.
/// ORACLE: R (p + q²/(M² p)) of σ_v = γ z and σ_h = K₀ σ_v, by hand, with R = 4 down to 1 m and 1.2 from 3 m on.
#[test]
fn a_crust_is_overconsolidated() {
    let crust = "{ depths = [\"1 m\", \"3 m\"], values = [4, 1.2] }";
    let clay = with(CLAY, "ocr", crust);
    let ground = file(&text((&clay, &clay), LOADED));
    let mut case = ground.case().clone();
    case.stages.truncate(1);
    let run = in_memory(&case).unwrap();
    let sin = 25_f64.to_radians().sin();
    let m = 6.0 * sin / (3.0 - sin);
    let particles = &run.body.particles;
    for particle in 0..particles.len() {
        let depth = 4.0 - particles.x[particle][1];
        let upright = 20e3 * depth;
        let (p, q) = (upright * (1.0 + 2.0 * 0.6) / 3.0, upright * (1.0 - 0.6));
        let ratio = 4.0 - 2.8 * ((depth - 1.0) / 2.0).clamp(0.0, 1.0);
        let expected = ratio * (p + q * q / (m * m * p));
        let found = particles.internal[particle][0];
        assert!(
            (found / expected - 1.0).abs() < 1e-6,
            "{found} for {expected} at {depth} m"
        );
        let sigma = &particles.sigma[particle];
        assert!(
            (sigma[1][1] + upright).abs() < 1e-6 * upright,
            "{}",
            sigma[1][1]
        );
        assert!((sigma[0][0] + 0.6 * upright).abs() < 1e-6 * upright);
    }
}

/// GOAL: elastic ground at rest without a K₀ of its own has ν/(1 − ν) of its place.
#[test]
fn ground_at_rest_has_the_ratio_of_its_place() {
    let elastic = "model = \"elastic\"\nyoung = \"20 MPa\"\npoisson = { at_surface = 0.2, gradient = \"0.05 1/m\" }\n";
    let ground = file(&text((elastic, elastic), LOADED));
    let mut case = ground.case().clone();
    case.stages.truncate(1);
    let (model, _) = Model::new(&case).unwrap();
    let run = in_memory(&case).unwrap();
    let particles = &run.body.particles;
    for particle in 0..particles.len() {
        let nu = 0.2 + 0.05 * (4.0 - particles.x[particle][1]);
        let found = model.laws[particles.law[particle]]
            .stiffness_bound()
            .poisson();
        assert!((found - nu).abs() < 1e-12, "{found} for {nu}");
    }
}

/// GOAL: dilation goes with friction, a raster gives a number by points, and a depth goes down from a face that slopes.
#[test]
fn particles_have_the_law_of_their_place() {
    let soil = with(
        SOIL,
        "friction",
        "{ levels = [\"4 m\", \"0 m\"], values = [\"20 deg\", \"36 deg\"] }",
    );
    let soil = with(
        &soil,
        "dilation",
        "{ at_top = \"0 deg\", gradient = \"1.5 deg/m\" }",
    );
    let rock = with(
        ROCK,
        "gsi",
        "{ x = [\"0 m\", \"4 m\"], y = [\"0 m\", \"4 m\"], rows = [[30, 40], [50, 20]] }",
    );
    let case = file(&text((&rock, &soil), LOADED)).case().clone();
    let (model, state) = Model::new(&case).unwrap();
    let ground = case.ground();
    let particles = &state.body.particles;
    for particle in 0..particles.len() {
        let [x, y] = particles.x[particle];
        let number = particles.law[particle];
        let material = case.material_of(number).at(&particles.x[particle], &ground);
        let key = if y < 2.0 { "gsi" } else { "dilation" };
        let expected = if y < 2.0 {
            (1.0 - y / 4.0) * (30.0 + 2.5 * x) + y / 4.0 * (50.0 - 7.5 * x)
        } else {
            1.5 * (4.0 - y)
        };
        let mut parameters = material.strength.parameters().into_iter();
        let value = parameters.find(|entry| entry.key == key).unwrap().value;
        let found = match value {
            igimp_model::ParameterValue::Angle(angle) => angle.to_degrees(),
            igimp_model::ParameterValue::Number(value) => value,
            other => panic!("{other:?}"),
        };
        assert!((found - expected).abs() < 1e-12, "{found} for {expected}");
        let law = material.law_on(0.5).unwrap();
        assert_eq!(format!("{law:?}"), format!("{:?}", model.laws[number]));
    }
    let tables = setup::tables(&case);
    let materials = tables.iter().find(|t| t.title == "Materials").unwrap();
    insta::assert_snapshot!(
        materials
            .rows
            .iter()
            .map(|row| row.join(" | "))
            .collect::<Vec<_>>()
            .join("\n")
    );
}

/// GOAL: a run that is interrupted and resumed, on other threads too, and strength that is reduced, have the laws of places to the bit.
#[test]
fn laws_of_places_are_made_anew_when_a_run_goes_on() {
    let soil = with(
        SOIL,
        "dilation",
        "{ at_surface = \"4 deg\", gradient = \"2 deg/m\" }",
    );
    let soil = with(
        &soil,
        "poisson",
        "{ at_top = 0.25, gradient = \"0.02 1/m\" }",
    );
    let reduce = "[[stages]]\nname = \"safety\"\ntype = \"strength-reduction\"\nsearch = \"trials\"\nfactors = [1.0, 1.05]\ngeometry = \"given\"\n";
    let file = file(&text((ROCK, &soil), &format!("{LOADED}{reduce}")));
    let (whole, stopped) = (folder("places-whole"), folder("places-stopped"));
    let run = run_into((&file, file.case()), &whole, Start::Afresh, None);
    assert_done(&run.summary);
    run_into((&file, file.case()), &stopped, Start::Afresh, Some(3));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build();
    let resume = || run_into((&file, file.case()), &stopped, Start::Resume, None);
    assert_done(&pool.unwrap().install(resume).summary);
    assert_equal(
        &everything(&whole),
        &everything(&stopped),
        "on three threads",
    );
}

/// Soil, a key and a value that makes no sense of it, with the text beside.
const WRONG: [(&str, &str, &str, &str); 17] = [
    (
        SOIL,
        "dilation",
        "{ at_surface = \"10 deg\", gradient = \"6 deg/m\" }",
        "",
    ),
    (
        SOIL,
        "dilation",
        "{ at_surface = \"10 deg\", gradient = \"6 kPa/m\" }",
        "",
    ),
    (
        SOIL,
        "dilation",
        "{ at_surface = \"3 deg\", gradient = \"-1 deg/m\" }",
        "",
    ),
    (
        SOIL,
        "poisson",
        "{ at_surface = 0.3, gradient = \"0.1 1/m\" }",
        "",
    ),
    (SOIL, "poisson", "{ at_surface = 0.3, gradient = 0.01 }", ""),
    (
        SOIL,
        "poisson",
        "{ at_surface = 0.3, gradient = \"0.01 1/m\" }",
        "drainage = \"undrained\"\n",
    ),
    (
        SOIL,
        "tension_cutoff",
        "{ at_surface = \"1 kPa\", gradient = \"1 kPa/m\" }",
        "# cohesion varies\n",
    ),
    (
        SOIL,
        "dilation",
        "{ levels = [\"4 m\", \"0 m\"], values = [\"24 deg\", \"29 deg\"] }",
        "# friction varies\n",
    ),
    (
        ROCK,
        "gsi",
        "{ at_surface = 60, gradient = \"12 1/m\" }",
        "",
    ),
    (ROCK, "gsi", "{ depths = [\"0 m\", \"4 m\"] }", ""),
    (
        ROCK,
        "disturbance",
        "{ levels = [\"4 m\", \"0 m\"], values = [2.4, 0] }",
        "disturbance = 0.5\n",
    ),
    (
        CLAY,
        "ocr",
        "{ depths = [\"0 m\", \"4 m\"], values = [4, 0.9] }",
        "",
    ),
    (
        CLAY,
        "void_ratio",
        "{ depths = [\"0 m\", \"4 m\"], values = [2, 1] }",
        "void_ratio = 1\n",
    ),
    (
        CLAY,
        "friction",
        "{ depths = [\"0 m\", \"4 m\"], values = [\"30 deg\", \"25 deg\"] }",
        "# jaky\n",
    ),
    (
        CLAY,
        "kappa",
        "{ depths = [\"0 m\", \"4 m\"], values = [0.02, 0.14] }",
        "",
    ),
    (
        CLAY,
        "kappa",
        "{ depths = [\"0 m\", \"4 m\"], values = [0.02, 0.04] }",
        "drainage = \"undrained\"\n",
    ),
    (
        SAND,
        "e50",
        "{ depths = [\"0 m\", \"4 m\"], values = [\"20 MPa\", \"60 MPa\"] }",
        "eur = \"60 MPa\"\n",
    ),
];

#[test]
fn parameters_that_make_no_sense() {
    let mut out = String::new();
    for (soil, key, value, beside) in WRONG {
        let mut soil = with(&format!("{soil}{beside}"), key, value);
        match beside.trim() {
            "# cohesion varies" => {
                soil = with(
                    &soil,
                    "cohesion",
                    "{ at_surface = \"5 kPa\", gradient = \"1 kPa/m\" }",
                );
            }
            "# friction varies" => {
                soil = with(
                    &soil,
                    "friction",
                    "{ levels = [\"4 m\", \"0 m\"], values = [\"20 deg\", \"30 deg\"] }",
                );
            }
            "# jaky" => soil = with(&soil, "k0", "\"jaky\""),
            _ => {}
        }
        let error = CaseFile::parse("ground.toml", &text((&soil, SOIL), LOADED), &[]);
        let printed = error.map_or_else(|error| error.to_string(), |file| file.warnings());
        let _ = writeln!(out, "## {key} = {value} {}\n{printed}", beside.trim());
    }
    insta::assert_snapshot!(out);
}

/// GOAL: a case that a program makes, with a law that a place does not allow, is refused with the place.
#[test]
fn a_place_without_a_law_is_named() {
    let clay = with(
        CLAY,
        "ocr",
        "{ depths = [\"0 m\", \"4 m\"], values = [4, 1] }",
    );
    let mut case: Case<2> = file(&text((&clay, &clay), LOADED)).case().clone();
    let entry = &mut case.materials[0].profiles.parameters[0];
    entry.1 = entry.1.clone().scaled(|value| 0.6 * value);
    let error = Model::new(&case).unwrap_err().to_string();
    assert!(error.contains("`low`") && error.contains("at ("), "{error}");
}

/// GOAL: a constant dilation is cut off where friction that varies is less, beside other parameters that vary, too.
#[test]
fn a_constant_dilation_is_cut_off_by_friction() {
    let friction = "{ levels = [\"4 m\", \"0 m\"], values = [\"20 deg\", \"36 deg\"] }";
    let soil = with(&with(SOIL, "friction", friction), "dilation", "\"28 deg\"");
    let varied = with(
        &soil,
        "poisson",
        "{ at_surface = 0.3, gradient = \"0.01 1/m\" }",
    );
    Model::new(file(&text((&varied, &varied), LOADED)).case()).unwrap();
}
