//! Case files as users write them: the messages, the overrides, the completed file, the schema.
//!
//! The two files in `tests/data` are models of the format; every message is what one or more
//! edits of them lead to.

// Values are read to the last digit.
#![allow(clippy::float_cmp)]

use igimp_assembly::Locking;
use std::fmt::Write;

use igimp_input::shipped::SHIPPED;
use igimp_input::{CaseFile, InputError};
use igimp_schema::reference_markdown;

const SLOPE: (&str, &str) = ("slope.toml", include_str!("data/slope.toml"));
const FOOTING: (&str, &str) = ("footing.toml", include_str!("data/footing.toml"));
type Edits<'a> = &'a [(&'a str, &'a str)];

fn edited(text: &str, edits: Edits<'_>) -> String {
    edits.iter().fold(text.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "`{from}` is not in the file");
        text.replacen(from, to, 1)
    })
}

fn said(result: &Result<CaseFile, InputError>) -> String {
    match result {
        Ok(file) if file.warnings().is_empty() => "(nothing)\n".to_owned(),
        Ok(file) => file.warnings(),
        Err(error) => error.to_string(),
    }
}

/// What is said of a file after each set of edits.
fn messages(file: (&str, &str), cases: &[Edits<'_>]) -> String {
    let mut out = String::new();
    for edits in cases {
        for (from, to) in *edits {
            let _ = writeln!(out, "## {from:?} -> {to:?}");
        }
        let result = CaseFile::parse(file.0, &edited(file.1, edits), &[]);
        let _ = writeln!(out, "{}", said(&result));
    }
    out
}

fn overridden(file: (&str, &str), overrides: &[&str]) -> Result<CaseFile, InputError> {
    let overrides: Vec<_> = overrides.iter().map(ToString::to_string).collect();
    CaseFile::parse(file.0, file.1, &overrides)
}

/// The footing of the model ends mid-cell, and nothing is warned about.
const MID_CELL: (&str, &str) = (
    "cell = \"0.125 m\"",
    "cell = { x = \"2/17 m\", y = \"0.125 m\" }",
);
const CREST: (&str, &str) = (
    "stop_when = { load_grows_less_than = 0.001 }",
    "stop_when = { load_grows_less_than = 0.001 }\n[[monitors]]\nname = \"edge\"\npoint = [\"1 m\", \"5 m\"]",
);

#[test]
fn the_models_state_their_cases() {
    insta::assert_snapshot!(messages(SLOPE, &[&[]]));
    insta::assert_snapshot!(messages(FOOTING, &[&[]]));
    for file in [SLOPE, FOOTING] {
        insta::assert_debug_snapshot!(CaseFile::parse(file.0, file.1, &[]).unwrap().case());
    }
}

#[test]
fn the_shipped_files_are_right_and_without_warning() {
    for case in SHIPPED {
        let (name, text) = (case.name, case.text);
        let file = CaseFile::parse(name, text, &[]).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(file.warnings(), "");
        assert_eq!(file.source(), text);
    }
}

#[test]
fn the_six_messages_of_the_contract() {
    insta::assert_snapshot!(messages(
        SLOPE,
        &[
            &[("unit_weight = \"20 kN/m3\"", "unit_weight = \"2000 kg/m3\"")],
            &[("cohesion = ", "cohesoin = ")],
            &[("\"10 kPa\"", "10")],
            &[("material = \"clay\"", "material = \"caly\"")],
            &[("dilation = \"0 deg\"", "dilation = \"25 deg\"")],
            &[("[\"0 m\",\"20 m\"]]", "[\"0 m\",\"24 m\"]]")],
        ]
    ));
}

#[test]
fn several_problems_are_shown_together_in_the_order_of_the_file() {
    insta::assert_snapshot!(messages(
        SLOPE,
        &[&[
            ("[\"0 m\",\"20 m\"]]", "[\"0 m\",\"24 m\"]]"),
            ("unit_weight = \"20 kN/m3\"", "unit_weight = \"2000 kg/m3\""),
            ("poisson = 0.25", "poisson = 0.4999"),
            ("material = \"rock\"", "material = \"rok\""),
            ("steps = 200", "steps = 0"),
            ("max_iterations", "max_iteration"),
        ]]
    ));
}

#[test]
fn slips_of_syntax() {
    insta::assert_snapshot!(messages(
        SLOPE,
        &[
            &[("\"10 kPa\"", "10 kPa")],
            &[("tolerance = 1e-6", "tolerance = True")],
            &[(
                "young = \"20 MPa\"",
                "young = \"20 MPa\"\nyoung = \"30 MPa\""
            )],
            &[("[[monitors]]", "[solver]")],
            &[("title = \"10 m", "title = 10 m")],
            &[("\"60 m\"], y", "\"60 m\", y")],
            &[("[boundaries]", "[boundaries")],
            &[("locking", "\u{0} locking")],
        ]
    ));
}

#[test]
fn slips_of_keys() {
    insta::assert_snapshot!(messages(
        SLOPE,
        &[
            &[("igimp = 1 ", "# igimp = 1 ")],
            &[("igimp = 1 ", "igimp = 2 ")],
            &[("[grid]", "[gird]")],
            &[("locking = \"b-bar\"", "gravity = \"9.81 m/s2\"")],
            &[("locking = \"b-bar\"", "colour = \"red\"")],
            &[("friction = \"20 deg\"\n", "")],
            &[("model = \"mohr-coulomb\"\n", "")],
            &[("model = \"mohr-coulomb\"", "model = \"mohr coulomb\"")],
            &[(
                "model = \"elastic\"",
                "model = \"elastic\"\ncohesion = \"1 kPa\""
            )],
            &[("[[monitors]]", "[monitors]")],
            &[("[grid]", "[[grid]]")],
            &[("[materials.clay]", "[materials.\"soft/clay\"]")],
            &[("name = \"bedrock\"", "name = \"Slope\"")],
            &[("name = \"crest\"", "name = \"slope.crest\"")],
        ]
    ));
}

#[test]
fn slips_of_values() {
    insta::assert_snapshot!(messages(
        SLOPE,
        &[
            &[("young = \"20 MPa\"", "young = \"20 Mpa\"")],
            &[("young = \"20 MPa\"", "young = \"-20 MPa\"")],
            &[("young = \"20 MPa\"", "young = \"inf MPa\"")],
            &[("poisson = 0.3", "poisson = \"0.3\"")],
            &[("poisson = 0.3", "poisson = nan")],
            &[("locking = \"b-bar\"", "locking = \"bbar\"")],
            &[("steps = 10\n", "steps = 10.5\n")],
            &[("points_per_cell = 4", "points_per_cell = 6")],
            &[("tolerance = 1e-6", "tolerance = 0")],
            &[("bracket = [1.0, 2.0]", "bracket = [1.0]")],
            &[("left = \"roller\"", "left = \"rollers\"")],
            &[("every = \"stage\"", "every = [1]")],
            &[("point = [\"15 m\", \"20 m\"]", "point = [15, 20]")],
            &[("friction = \"20 deg\"", "friction = \"20 m\"")],
            &[("cohesion = \"10 kPa\"", "cohesion = 1979-05-27")],
        ]
    ));
}

#[test]
fn materials_and_grid_that_make_no_sense() {
    insta::assert_snapshot!(messages(
        SLOPE,
        &[
            &[("plane-strain", "3d")],
            &[("poisson = 0.3", "poisson = 0.5")],
            &[("friction = \"20 deg\"", "friction = \"90 deg\"")],
            &[("cohesion = \"10 kPa\"", "cohesion = \"0 kPa\"")],
            &[
                ("cohesion = \"10 kPa\"", "cohesion = \"0 kPa\""),
                ("friction = \"20 deg\"", "friction = \"0 deg\""),
            ],
            &[("tension_cutoff = \"0 kPa\"", "tension_cutoff = \"40 kPa\"")],
            &[("poisson = 0.25", "poisson = 0.25\nk0 = \"jaky\"")],
            &[("\"60 m\"], y", "\"60.3 m\"], y")],
            &[("\"0 m\", \"22 m\"", "\"22 m\", \"0 m\"")],
            &[("cell = \"0.5 m\"", "cell = \"1 mm\"")],
            &[("cell = \"0.5 m\"", "cell = \"1e-300 m\"")],
            &[("linear = \"auto\"", "linear = \"cholesky\"")],
            &[("linear = \"auto\"", "linear = \"gmres\"")],
        ]
    ));
}

#[test]
fn bodies_that_make_no_sense() {
    let rock = "[[\"0 m\",\"0 m\"], [\"60 m\",\"0 m\"], [\"60 m\",\"2 m\"], [\"0 m\",\"2 m\"]]";
    insta::assert_snapshot!(messages(
        SLOPE,
        &[
            &[(rock, "[[\"0 m\",\"0 m\"], [\"60 m\",\"0 m\"]]")],
            &[(
                rock,
                "[[\"0 m\",\"0 m\"], [\"9 m\",\"1 m\"], [\"18 m\",\"2 m\"]]"
            )],
            &[(
                rock,
                "[[\"0 m\",\"0 m\"], [\"60 m\",\"2 m\"], [\"60 m\",\"0 m\"], [\"0 m\",\"2 m\"]]"
            )],
            &[(
                rock,
                "[[\"0 m\",\"0 m\"], [\"60 m\",\"0 m\"], [\"60 m\",\"2 m\"], [\"9 m\",\"3 m\"]]"
            )],
            &[(
                rock,
                "[[\"0 m\",\"0 m\"], [\"60 m\",\"0 m\"], [\"0 m\",\"0 m\"], [\"0 m\",\"0 m\"]]"
            )],
            &[(
                rock,
                "[[\"40 m\",\"12 m\"], [\"60 m\",\"12 m\"], [\"60 m\",\"20 m\"]]"
            )],
            &[("material = \"rock\"", "material = \"clay\"")],
            &[
                ("points_per_cell = 4", "points_per_cell = 25"),
                ("cell = \"0.5 m\"", "cell = \"1 cm\"")
            ],
            &[(
                "bottom = \"fixed\"",
                "bottom = \"fixed\"\nboxes = [{ name = \"wall\", from = [\"9.1 m\", \"3 m\"], to = [\"9.2 m\", \"0 m\"] }]"
            )],
        ]
    ));
}

#[test]
fn loads_that_make_no_sense() {
    let footing = "type = \"rigid-footing\"                           # rigid-footing | pressure | point\nfrom = [\"0 m\", \"5 m\"]\nto = [\"1 m\", \"5 m\"]\ninterface = \"rough\"                              # rough | smooth\nreaction_factor = 2 ";
    let pressure = |from: &str, to: &str| {
        format!("type = \"pressure\"\npressure = \"10 kPa\"\nfrom = {from}\nto = {to}\n")
    };
    let inside = pressure("[\"1 m\", \"3 m\"]", "[\"2 m\", \"3 m\"]");
    let beside = pressure("[\"1 m\", \"5.5 m\"]", "[\"2 m\", \"5.5 m\"]");
    let part = pressure("[\"7 m\", \"5 m\"]", "[\"9 m\", \"5 m\"]");
    let point = "type = \"point\"\nat = [\"2 m\", \"6 m\"]\nforce = [\"0 kN/m\", \"-1 kN\"]\n";
    insta::assert_snapshot!(messages(
        FOOTING,
        &[
            &[("to = [\"1 m\", \"5 m\"]", "to = [\"1 m\", \"5.5 m\"]")],
            &[("to = [\"1 m\", \"5 m\"]", "to = [\"0 m\", \"5 m\"]")],
            &[
                ("from = [\"0 m\", \"5 m\"]", "from = [\"0 m\", \"5.1 m\"]"),
                ("to = [\"1 m\", \"5 m\"]", "to = [\"1 m\", \"5.1 m\"]"),
            ],
            &[("to = [\"1 m\", \"5 m\"]", "to = [\"9 m\", \"5 m\"]")],
            &[(
                "cell = \"0.125 m\"",
                "cell = { x = \"2/17 m\", y = \"0.125 m\" }"
            )],
            &[(footing, &inside)],
            &[(footing, &beside)],
            &[(footing, &part)],
            &[(footing, point)],
            &[("load = \"footing\"", "load = \"foting\"")],
            &[("settlement = \"0.2 m\"", "settlement = \"6 m\"")],
            &[(
                "[[stages]]",
                "[[loads]]\nname = \"idle\"\ntype = \"point\"\nat = [\"2 m\", \"5 m\"]\nforce = [\"0 N/m\", \"-1 N/m\"]\n[[stages]]"
            )],
        ]
    ));
}

/// The grid can follow one footing only.
#[test]
fn a_second_footing_is_refused() {
    let second = "[[loads]]\nname = \"second\"\ntype = \"rigid-footing\"\nfrom = [\"3 m\", \"5 m\"]\nto = [\"4 m\", \"5 m\"]\n[[stages]]";
    let text = messages(FOOTING, &[&[("[[stages]]", second)]]);
    assert!(
        text.contains("error: this is a second rigid footing"),
        "{text}"
    );
}

#[test]
fn stages_that_make_no_sense() {
    let search = "type = \"strength-reduction\"                      # c, tan(phi), tension cut-off divided by F";
    insta::assert_snapshot!(messages(
        SLOPE,
        &[
            &[(
                "materials = [\"clay\"] ",
                "materials = [\"clay\", \"rock\"] "
            )],
            &[
                ("model = \"mohr-coulomb\"", "model = \"elastic\""),
                (
                    "cohesion = \"10 kPa\"\nfriction = \"20 deg\"\ndilation = \"0 deg\"\ntension_cutoff = \"0 kPa\"\n",
                    ""
                ),
                ("k0 = \"jaky\" ", "k0 = 0.5 "),
                ("materials = [\"clay\"] ", "")
            ],
            &[("bracket = [1.0, 2.0]", "bracket = [2.0, 1.0]")],
            &[("monitor = \"crest\"", "monitor = \"toe\"")],
            &[(
                "start_from = \"initial stresses\"",
                "start_from = \"run-out\""
            )],
            &[(
                "start_from = \"initial stresses\"",
                "start_from = \"initial stress\""
            )],
            &[("reset_displacements = true", "start_from = \"run-out\"")],
            &[
                (search, "type = \"gravity\""),
                ("materials = [\"clay\"] ", ""),
                ("bracket = [1.0, 2.0] ", ""),
                ("tolerance = 0.01\n", ""),
                (
                    "failure = { when = \"no-equilibrium\", also = { monitor = \"crest\", displacement = \"0.5 m\" } }\n",
                    ""
                )
            ],
            &[("{ times_fos = 1.05 }", "{ times_fos = 1.05, factor = 1.5 }")],
            &[("{ times_fos = 1.05 }", "{}")],
            &[("type = \"gravity\" ", "type = \"k0\" ")],
            &[(
                "steps = 10\n",
                "stop_when = { monitor = \"crest\", load_grows_less_than = 0.1 }\n"
            )],
            &[("9.81 m/s2", "0 m/s2")],
            &[("steps = 200", "steps = 200\nfactor = 2")],
        ]
    ));
}

#[test]
fn ground_at_rest_and_loads_in_stages() {
    let text = edited(
        FOOTING.1,
        &[
            MID_CELL,
            ("gravity = \"0 m/s2\"", "gravity = \"9.81 m/s2\""),
            (
                "[[stages]]",
                "[[loads]]\nname = \"strip\"\ntype = \"pressure\"\nfrom = [\"3 m\", \"5 m\"]\n\
                 to = [\"4 m\", \"5 m\"]\npressure = \"9 kPa\"\n[[stages]]\nname = \"rest\"\n\
                 type = \"k0\"\n[[stages]]\nname = \"press\"\ntype = \"load\"\nload = \"strip\"\n[[stages]]",
            ),
        ],
    );
    insta::assert_snapshot!(messages(
        ("footing.toml", &text),
        &[
            &[],
            &[("cu = \"50 kPa\"", "cu = \"50 kPa\"\nk0 = 0.7")],
            &[
                ("cu = \"50 kPa\"", "cu = \"50 kPa\"\nk0 = 0.7"),
                (
                    "[\"0 m\",\"5 m\"]]",
                    "[\"5 m\",\"5 m\"], [\"5 m\", \"4 m\"], [\"0 m\", \"4 m\"]]"
                )
            ],
            &[
                ("model = \"tresca\"", "model = \"elastic\""),
                ("cu = \"50 kPa\"\n", "")
            ],
            &[("cu = ", "k0 = 0.7\ncu = "), ("load = \"strip\"", "")],
            &[
                ("cu = ", "k0 = 0.7\ncu = "),
                ("load = \"strip\"", "load = \"strip\"\nloads = [\"strip\"]")
            ],
            &[
                ("cu = ", "k0 = 0.7\ncu = "),
                (
                    "load = \"strip\"",
                    "loads = [\"strip\", \"footing\", \"strip\"]"
                )
            ],
            &[
                ("cu = ", "k0 = 0.7\ncu = "),
                ("load = \"footing\"", "load = \"strip\"")
            ],
            &[
                ("cu = ", "k0 = 0.7\ncu = "),
                ("type = \"load\"\nload = \"strip\"", "type = \"k0\"")
            ],
        ]
    ));
}

#[test]
fn large_files_are_judged_quickly() {
    let mut bodies = String::new();
    for k in 0..1200 {
        let (x, y) = (k % 60, k / 60);
        let [right, top] = [x + 1, y + 1];
        let _ = write!(
            bodies,
            "[[bodies]]\nname = \"b{k}\"\nmaterial = \"rock\"\npolygon = [[\"{x} m\",\"{y} m\"], \
             [\"{right} m\",\"{y} m\"], [\"{right} m\",\"{top} m\"], [\"{x} m\",\"{top} m\"]]\n"
        );
    }
    let mut more = String::new();
    for k in 0..1000 {
        let _ = write!(
            more,
            "[[sections]]\nname = \"s{k}\"\nfrom = [\"1 m\",\"21 m\"]\nto = [\"2 m\",\"21 m\"]\n\
             [[monitors]]\nname = \"m{k}\"\npoint = [\"1 m\",\"21 m\"]\n\
             [[loads]]\nname = \"l{k}\"\ntype = \"pressure\"\nfrom = [\"1 m\",\"20 m\"]\nto = [\"9 m\",\"20 m\"]\npressure = \"1 kPa\"\n"
        );
    }
    let (head, tail) = SLOPE.1.split_once("[[bodies]]").unwrap();
    let (_, tail) = tail.split_once("[boundaries]").unwrap();
    let tail = tail.split_once("[[stages]]").unwrap().0;
    let stage = "[[stages]]\nname = \"weight\"\ntype = \"gravity\"\n";
    let text = format!("{head}{bodies}[boundaries]{tail}{stage}{more}");
    let begin = std::time::Instant::now();
    let file = CaseFile::parse("large.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(file.case().bodies.len(), 1200);
    assert!(begin.elapsed().as_secs() < 20, "{:?}", begin.elapsed());
}

#[test]
fn records_that_make_no_sense() {
    let reference = "reference = { y = 5.1416, label = \"Prandtl, 2 + pi\", tolerance = 0.05 }";
    let check = |rest: &str| {
        format!("{reference}\n[[checks]]\nname = \"Nc\"\nsource = \"Prandtl\"\n{rest}")
    };
    let [none, both, safety, zero] = [
        "of = \"footing.reaction\"",
        "of = \"top\"\nat_most = \"5 m\"\nbetween = [2, 1]",
        "of = \"factor_of_safety\"\nexpected = 1.4\ntolerance = 0.1",
        "of = \"top\"\nexpected = 0\ntolerance = 0.1",
    ]
    .map(check);
    let text = edited(FOOTING.1, &[MID_CELL]);
    insta::assert_snapshot!(messages(
        ("footing.toml", &text),
        &[
            &[("footing.settlement", "footing.setlement")],
            &[("footing.settlement", "factor_of_safety")],
            &[("divide_by = [\"2 m\"]", "divide_by = [\"0 m\"]")],
            &[("divide_by = [\"2 m\"]", "divide_by = [\"2\"]")],
            &[("y = 5.1416", "y = 5.1416, points = [[1, 2]]")],
            &[("y = 5.1416", "file = \"no-such-file.csv\"")],
            &[(reference, &none)],
            &[(reference, &both)],
            &[(reference, &safety)],
            &[(reference, &zero)],
            &[CREST, ("footing.reaction", "edge.sigma_zy")],
            &[
                CREST,
                ("point = [\"1 m\", \"5 m\"]", "point = [\"1 m\", \"5.4 m\"]")
            ],
            &[("folder = \"results/footing\"", "folder = \"\"")],
            &[(
                "folder = \"results/footing\"",
                "figures = [\"plastic-strain\"]"
            )],
        ]
    ));
}

#[test]
fn overrides_change_values_of_any_type() {
    let file = overridden(
        SLOPE,
        &[
            "materials.clay.cohesion=12 kPa",
            "materials.clay.young = \"30 MPa\"",
            "materials.rock.poisson=0.2",
            "bodies.slope.points_per_cell=9",
            "stages.0.steps=5",
            "stages.run-out.steps=7",
            "stages.\"factor of safety\".bracket=[1.2, 1.6]",
            "grid.locking=none",
            "grid.small_cuts.remedy=drop",
            "solver.linear=multigrid",
            "output.folder=elsewhere",
        ],
    );
    let case = file.unwrap_or_else(|error| panic!("{error}")).into_case();
    assert_eq!(case.materials[0].young, 30e6);
    assert_eq!(case.materials[1].poisson, 0.2);
    assert_eq!(case.bodies[0].per_direction, 3);
    assert_eq!((case.stages[0].steps, case.stages[2].steps), (5, 7));
    assert_eq!(case.method.locking, Locking::None);
    let debug = format!("{case:?}");
    for part in [
        "cohesion: 12000.0",
        "remedy: Drop",
        "bracket: [1.2, 1.6]",
        "Multigrid",
        "elsewhere",
    ] {
        assert!(debug.contains(part), "{part}");
    }
}

#[test]
fn wrong_overrides_are_named() {
    let mut out = String::new();
    for text in [
        "materials.clay.cohesoin=12 kPa",
        "materials.clay.cohesion=12",
        "materials.clay.cohesion=12 kN/m3",
        "materials.caly.cohesion=12 kPa",
        "bodies.slop.points_per_cell=9",
        "stages.7.steps=5",
        "loads.footing.reaction_factor=2",
        "grid.cell.x=1 m",
        "solver.tolerance=\"1e-6",
        "solver.tolerance=",
        "solver..tolerance=1",
        "tolerance",
        "grid.domain.x=[\"0 m\", \"50 m\"]",
    ] {
        let _ = writeln!(
            out,
            "## --set {text}\n{}",
            said(&overridden(SLOPE, &[text]))
        );
    }
    insta::assert_snapshot!(out);
}

#[test]
fn tabs_carriage_returns_and_accents_keep_their_columns() {
    let text = SLOPE.1.replace('\n', "\r\n");
    let text = edited(
        &text,
        &[
            ("title = \"10 m cut slope", "title = \"Böschung, 10 m"),
            ("name = \"crest\"", "\tname = \"Böschungskante\" ; # é"),
            ("monitor = \"crest\"", "monitor = \"Böschungskante\""),
        ],
    );
    let first = said(&CaseFile::parse("slope.toml", &text, &[]));
    let text = text
        .replace(" ; # é", "")
        .replace("point = [", "\tpunkt = [");
    let second = said(&CaseFile::parse("slope.toml", &text, &[]));
    insta::assert_snapshot!(format!("{first}\n{second}"));
}

/// A file from elsewhere must not get at the terminal through what is said of it.
#[test]
fn messages_hold_no_control_characters() {
    for (key, value) in [
        ("\"coh\\u001b[31mesion\"", "\"10 kPa\""),
        ("cohesion", "\"10 k\\u0007Pa\""),
        ("cohesion", "\"\\u001b[2J\""),
        ("cohesion", "'''10\nkPaa'''"),
    ] {
        let text = edited(
            SLOPE.1,
            &[("cohesion = \"10 kPa\"", &format!("{key} = {value}"))],
        );
        let error = CaseFile::parse(SLOPE.0, &text, &[]).unwrap_err();
        let InputError::Invalid {
            text, diagnostics, ..
        } = error
        else {
            panic!("{error}");
        };
        assert!(
            text.chars().all(|c| c == '\n' || !c.is_control()),
            "{text:?}"
        );
        for found in &diagnostics {
            let mut lines = found.help.iter().chain([&found.message]);
            assert!(
                lines.all(|line| !line.contains(char::is_control)),
                "{found:?}"
            );
        }
    }
}

/// Every unknown key is counted, and none is compared with all others.
#[test]
fn files_of_unknown_keys_are_judged_quickly() {
    let mut text = SLOPE.1.to_owned();
    for key in 0..50_000 {
        let _ = writeln!(text, "key_{key} = 1");
    }
    let error = CaseFile::parse(SLOPE.0, &text, &[]).unwrap_err();
    assert!(matches!(error, InputError::Invalid { errors: 50_000, .. }));
}

#[test]
fn an_explained_file_states_the_same_case() {
    let pressure = "[[loads]]\nname = \"strip\"\ntype = \"pressure\"\nfrom = [\"2 m\", \"5 m\"]\nto = [\"3 m\", \"5 m\"]\npressure = \"10 kPa\"\n[[stages]]\nname = \"press\"\ntype = \"load\"\nload = \"strip\"\n[[stages]]\nname = \"push";
    let more = edited(
        FOOTING.1,
        &[
            (
                "cell = \"0.125 m\"",
                "cell = { x = \"2/17 m\", y = \"0.125 m\" }",
            ),
            ("[[stages]]\nname = \"push", pressure),
            ("materials.clay", "materials.\"stiff clay\""),
            ("\"clay\"", "\"stiff clay\""),
            (", label = \"d / B [-]\"", ""),
            (
                "right = \"roller\"",
                "right = \"roller\"\nboxes = [{ name = \"wall\", to = [\"8 m\", \"0 m\"], from = [\"7 m\", \"5 m\"] }]",
            ),
            (
                "[output]",
                "[[checks]]\nname = \"Nc\"\nof = \"footing.reaction\"\ndivide_by = [\"2 m\", 50e3]\nbetween = [5, 5.5]\nsource = \"Prandtl \\\"1920\\\"\"\n[output]",
            ),
        ],
    );
    let files = [SLOPE, FOOTING, ("more.toml", more.as_str())];
    let shipped = SHIPPED.iter().map(|case| (case.name, case.text));
    for (name, text) in files.into_iter().chain(shipped) {
        let file = CaseFile::parse(name, text, &[]).unwrap_or_else(|error| panic!("{error}"));
        let explained = file.explain();
        let again = CaseFile::parse("other.toml", &explained, &[])
            .unwrap_or_else(|error| panic!("{error}\n{explained}"));
        assert_eq!(
            format!("{:?}", file.any_case()),
            format!("{:?}", again.any_case())
        );
        assert_eq!(
            again.explain().replace("default; ", ""),
            explained.replace("default; ", "")
        );
    }
    let file = overridden(SLOPE, &["materials.clay.cohesion=12 kPa"]).unwrap();
    insta::assert_snapshot!(file.explain());
    let file = CaseFile::parse("more.toml", &more, &[]).unwrap();
    insta::assert_snapshot!(file.explain());
}

#[test]
fn pressure_acts_into_the_soil_whichever_way_its_segment_runs() {
    let load = |from: &str, to: &str, more: &str| {
        let text = edited(
            FOOTING.1,
            &[
                (
                    "[[stages]]",
                    &format!(
                        "[[loads]]\nname = \"p\"\ntype = \"pressure\"\nfrom = {from}\nto = {to}\npressure = \"10 kPa\"\n{more}\n[[stages]]\nname = \"press\"\ntype = \"load\"\nload = \"p\"\n[[stages]]"
                    ),
                ),
                ("[\"8 m\",\"5 m\"], [\"0 m\"", "[\"7 m\",\"5 m\"], [\"0 m\""),
            ],
        );
        let file =
            CaseFile::parse("footing.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}"));
        match file.case().loads[1].kind {
            igimp_model::LoadKind::Pressure { traction, .. } => traction,
            ref kind => panic!("{kind:?}"),
        }
    };
    let [left, right] = ["[\"2 m\", \"5 m\"]", "[\"4 m\", \"5 m\"]"];
    assert_eq!(load(left, right, ""), [0.0, -10e3]);
    assert_eq!(load(right, left, ""), [0.0, -10e3]);
    let [foot, crest] = ["[\"8 m\", \"0 m\"]", "[\"7 m\", \"5 m\"]"];
    let across = load(foot, crest, "");
    assert!((across[0] + 10e3 * 5.0 / 26_f64.sqrt()).abs() < 1e-6);
    assert!((across[1] + 10e3 / 26_f64.sqrt()).abs() < 1e-6);
    assert_eq!(load(foot, crest, "direction = \"down\""), [0.0, -10e3]);
}

#[test]
fn files_are_read_with_their_references() {
    let folder = std::env::temp_dir().join(format!("igimp-input-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("my case.toml");
    let text = edited(
        FOOTING.1,
        &[
            ("y = 5.1416", "file = \"measured.csv\""),
            ("folder = \"results/footing\"\n", ""),
        ],
    );
    std::fs::write(&path, &text).unwrap();
    std::fs::write(
        folder.join("measured.csv"),
        "# source\nd/B, N\n0, 0\n0.1, 5.2\n",
    )
    .unwrap();
    let case = CaseFile::read(&path, &[])
        .unwrap_or_else(|error| panic!("{error}"))
        .into_case();
    let debug = format!("{:?}", case.curves[0].reference);
    assert!(
        debug.contains("Points([[0.0, 0.0], [0.1, 5.2]])"),
        "{debug}"
    );
    assert_eq!(case.output.folder, std::path::Path::new("results/my case"));

    std::fs::write(folder.join("measured.csv"), "d/B, N\n0, zero\n").unwrap();
    let error = CaseFile::read(&path, &[]).unwrap_err().to_string();
    assert!(error.contains("row 2 does not hold two numbers"), "{error}");
    std::fs::write(&path, b"igimp = 1\n\xff\xfe = 2\n").unwrap();
    let error = CaseFile::read(&path, &[]).unwrap_err();
    assert!(matches!(error, InputError::Invalid { errors: 1, .. }));
    assert!(error.to_string().contains("my case.toml:2:1"), "{error}");
    assert!(matches!(
        CaseFile::read(&folder, &[]),
        Err(InputError::File { .. })
    ));
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(matches!(
        CaseFile::read(&path, &[]),
        Err(InputError::File { .. })
    ));
}

#[test]
fn absurd_files_are_refused_quickly() {
    let corner = "[\"1 m\", \"2 m\"], ".repeat(20_000);
    let stages = "[[stages]]\nname = \"x\"\ntype = \"gravity\"\n".repeat(5_000);
    let deep = format!("{}1{}", "[".repeat(10_000), "]".repeat(10_000));
    let table = format!("[{}]\n", vec!["a"; 10_000].join("."));
    for text in [
        edited(SLOPE.1, &[("polygon = [", &format!("polygon = [{corner}"))]),
        format!("{}{stages}", SLOPE.1),
        format!("x = {deep}"),
        table,
        "a".repeat(9 << 20),
        String::new(),
        "\n".repeat(100_000),
    ] {
        let error = CaseFile::parse("absurd.toml", &text, &[])
            .unwrap_err()
            .to_string();
        assert!(error.contains("absurd.toml"), "{error}");
        assert!(error.len() < 200_000, "{} bytes", error.len());
    }
    let key = vec!["a"; 10_000].join(".");
    assert!(overridden(SLOPE, &[&format!("{key}=1")]).is_err());
}

#[test]
fn the_reference_has_every_table() {
    insta::assert_snapshot!(reference_markdown());
}

/// GOAL: whom a case is for reaches the case, changes nothing that is computed, and is explained.
#[test]
fn a_title_block_is_read() {
    let block = "[case]\nproject = \"Bypass\"\nclient = \"Road authority\"\nauthor = \"A. Engineer\"\nrevision = \"B\"";
    let text = edited(SLOPE.1, &[("[case]", block)]);
    let file = CaseFile::parse(SLOPE.0, &text, &[]).unwrap();
    let block = &file.case().title_block;
    let read = [
        &block.project,
        &block.client,
        &block.author,
        &block.revision,
    ];
    let expected = ["Bypass", "Road authority", "A. Engineer", "B"];
    assert_eq!(read.map(|text| text.as_deref().unwrap()), expected);
    assert!(file.explain().contains("revision = \"B\""));
}

/// GOAL: a slip of the unit is told, with its place and what may be meant; a value that soil, rock or steel has is not.
#[test]
fn implausible_values_are_told() {
    let told = [
        (
            "unit_weight",
            "20 N/m3",
            "`clay` has unit_weight = 0.02 kN/m3",
        ),
        ("cohesion", "20 MPa", "`clay` has cohesion = 20000 kPa"),
        ("friction", "0.35 deg", "0.35 rad are 20 deg"),
        ("friction", "80 deg", "`clay` has friction = 80 deg"),
        ("young", "20000 GPa", "steel 210 GPa"),
    ];
    for (key, value, expected) in told {
        let file = overridden(SLOPE, &[&format!("materials.clay.{key}={value}")]).unwrap();
        let warnings = file.warnings();
        assert!(warnings.contains(expected), "{warnings}");
        assert!(warnings.contains(value), "{warnings}");
    }
    let quiet = [
        ("unit_weight", "0 kN/m3"),
        ("unit_weight", "0.8 kN/m3"),
        ("cohesion", "4 MPa"),
        ("friction", "1.1 deg"),
        ("friction", "69 deg"),
        ("young", "210 GPa"),
    ];
    for (key, value) in quiet {
        let file = overridden(SLOPE, &[&format!("materials.clay.{key}={value}")]).unwrap();
        let warnings = file.warnings();
        assert!(!warnings.contains("outside the range"), "{warnings}");
    }
}

/// GOAL: what cannot be held against a reference is said with its place and a remedy.
#[test]
fn messages_of_references() {
    let section = |reference: &str| {
        format!(
            "[[sections]]\nname = \"S\"\nfrom = [\"20 m\", \"2 m\"]\nto = [\"20 m\", \"15 m\"]\nrecord = [\"sigma_yy\"]\n[[sections.references]]\n{reference}\n[output]"
        )
    };
    let cases = [
        section("of = \"tau_xy\"\ny = 1\nlabel = \"l\""),
        section("of = \"sigma_yy\"\nlabel = \"l\""),
        section("of = \"sigma_yy\"\ny = 1\nstage = \"nine\"\nlabel = \"l\""),
        section("of = \"sigma_yy\"\ny = 1\nstage = \"factor of safety\"\nlabel = \"l\""),
        "[[checks]]\nname = \"f\"\nof = \"factor_of_safety\"\nat = \"peak\"\nat_least = 1.3\nsource = \"s\"\n[output]".to_owned(),
    ];
    let edits: Vec<[(&str, &str); 1]> =
        cases.iter().map(|to| [("[output]", to.as_str())]).collect();
    let edits: Vec<Edits<'_>> = edits.iter().map(|edit| &edit[..]).collect();
    insta::assert_snapshot!(messages(SLOPE, &edits));
}
