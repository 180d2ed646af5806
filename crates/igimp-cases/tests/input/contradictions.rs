//! Messages on values that make no sense together.

use crate::edits::{Edits, edited};
use crate::messages::messages;
use crate::{CREST, FOOTING, MID_CELL, SLOPE};
use igimp_input::CaseFile;

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
fn friction_by_speed_that_makes_no_sense() {
    let sand = edited(
        igimp_input::shipped::find("column_collapse").unwrap().text,
        &[(
            "model = \"mohr-coulomb\"",
            "model = \"drucker-prager\"\ncone = \"plane-strain\"\nrate = { friction = \"39 deg\", inertial_number = 0.279, grain_diameter = \"0.5 mm\", grain_density = \"2650 kg/m3\" }",
        )],
    );
    insta::assert_snapshot!(messages(
        ("sand.toml", &sand),
        &[
            &[("\"39 deg\"", "\"31 deg\"")],
            &[("\"39 deg\"", "\"90 deg\"")],
            &[("dilation = \"0 deg\"", "dilation = \"5 deg\"")],
            &[("friction = \"31 deg\"", "friction = \"0 deg\"")],
            &[(
                "cohesion = \"10 Pa\"",
                "cohesion = { at_top = \"10 Pa\", gradient = \"1 kPa/m\" }"
            )],
            &[(
                "friction = \"31 deg\"",
                "friction = { levels = [\"0 m\", \"1 m\"], values = [\"30 deg\", \"31 deg\"] }"
            )],
            &[("2650 kg/m3", "26 kN/m3")],
            &[("0.279", "0")],
            &[
                ("type = \"dynamic\" ", "type = \"gravity\" "),
                ("duration = \"0.6 s\"", ""),
                ("at_rest = 1e-4", "")
            ],
        ]
    ));
}

#[test]
fn bodies_of_revolution_that_are_none() {
    let footing = igimp_input::shipped::find("circular_footing").unwrap().text;
    let load = |kind: &str| format!("[output]\n[[loads]]\nname = \"load\"\ntype = {kind}");
    let point = load("\"point\"\nat = [\"0.5 m\", \"2 m\"]\nforce = [\"0 kN/m\", \"-1 kN/m\"]");
    let nail = "[output]\n[[reinforcement]]\nname = \"nail\"\ntype = \"nail\"\nhead = [\"1 m\", \"2 m\"]\nend = [\"2 m\", \"1 m\"]\nspacing = \"1 m\"\nstiffness = \"100 MN\"\ncapacity = \"100 kN\"\nbond = \"10 kN/m\"";
    let rough = "interface = \"rough\" ";
    insta::assert_snapshot!(messages(
        ("circle.toml", footing),
        &[
            &[("x = [\"0 m\",", "x = [\"-0.21 m\",")],
            &[("y = \"-0.1 m\"", "y = \"-0.1 m\", x = \"0.1 m\"")],
            &[("y = \"-0.1 m\"", "y = \"-0.1 m\", free = [\"rotation\"]")],
            &[("y = \"-0.1 m\"", "force_y = \"-10 kN/m\"")],
            &[(rough, "interface = \"rough\"\nweight = \"5 kN/m\" ")],
            &[(rough, "interface = \"rough\"\nforce_factor = 2 ")],
            &[("[output]", &point)],
            &[("[output]", nail)],
            &[(
                "cu = \"50 kPa\"",
                "cu = \"50 kPa\"\nsoftening = { cu = { residual = 0.3, strain = 0.05 }, length = \"0.3 m\" }"
            )],
            &[(
                "bodies = [{ body = \"footing\", y = \"-0.1 m\" }]",
                "loads = [\"x\"]"
            )],
            &[(
                "cell = \"0.105 m\"",
                "cell = \"0.105 m\"\nsmall_cuts = { ghost_penalty = 0.01 }"
            )],
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

/// GOAL: a check without a comparison is named with its place and a remedy.
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

/// GOAL: a value that measures something else than its check is refused at its place, and one that measures the same is taken.
/// ORACLE: units of a length, of a length over a length, and of one over a plain number, by hand.
#[test]
fn values_of_checks_measure_what_is_checked() {
    let number = "the check is of a number without a unit, and this is a length";
    let plain = "the check is of a length, and this is a number without a unit";
    let stress = "the check is of a length, and this is a stress";
    for (keys, printed) in [
        ("at_most = \"9 mm\"", None),
        ("at_most = \"9 kPa\"", Some(stress)),
        ("at_least = 0.009", Some(plain)),
        ("between = [\"0 m\", 1]", Some(plain)),
        ("expected = \"1 kPa\"\ntolerance = 0.1", Some(stress)),
        ("divide_by = [\"1 mm\"]\nat_most = 10", None),
        ("divide_by = [\"1 mm\"]\nat_most = \"10 mm\"", Some(number)),
        (
            "divide_by = [\"2 m\", \"1 kPa\", \"1 kPa\"]\nat_most = 1",
            Some("a quantity in kg^-2 m^2 s^4"),
        ),
        ("divide_by = [1e-3]\nat_most = 10", None),
        ("divide_by = [2]\nat_most = \"10 mm\"", None),
        ("divide_by = [2]\nat_most = \"10 kPa\"", Some(stress)),
    ] {
        let check = format!(
            "[[checks]]\nname = \"c\"\nof = \"largest_displacement\"\nsource = \"s\"\n{keys}\n[output]"
        );
        let text = edited(SLOPE.1, &[("[output]", &check)]);
        let found = CaseFile::parse(SLOPE.0, &text, &[]);
        let found = found.err().map(|error| error.to_string());
        match printed {
            None => assert_eq!(found, None, "{keys}"),
            Some(printed) => {
                let found = found.unwrap_or_else(|| panic!("{keys} is taken"));
                assert!(
                    found.contains(printed) && found.contains("help:"),
                    "{keys}: {found}"
                );
            }
        }
    }
}
