//! Messages on slips of syntax, of keys and of values.

use igimp_input::shipped::find;
use igimp_input::{CaseFile, InputError};

use crate::edits::edited;
use crate::messages::{messages, printed};
use crate::{SLOPE, overridden};

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
    let first = printed(&CaseFile::parse("slope.toml", &text, &[]));
    let text = text
        .replace(" ; # é", "")
        .replace("point = [", "\tpunkt = [");
    let second = printed(&CaseFile::parse("slope.toml", &text, &[]));
    insta::assert_snapshot!(format!("{first}\n{second}"));
}

/// A file from elsewhere must not get at the terminal through its messages.
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

/// GOAL: a slip of the unit is told, with its place and a likely meaning; a value of soil, rock or steel is not.
#[test]
fn implausible_values_are_named() {
    let cases = [
        (
            "unit_weight",
            "20 N/m3",
            "`clay` has unit_weight = 0.02 kN/m3",
        ),
        ("cohesion", "20 MPa", "`clay` has cohesion = 20000 kPa"),
        ("friction", "0.35 deg", "0.35 rad are 20 deg"),
        ("friction", "80 deg", "`clay` has friction = 80 deg"),
        ("young", "20000 GPa", "steel 210 GPa"),
        (
            "young",
            "20 kPa",
            "young = 20 kPa, 2 times its cohesion = 10 kPa",
        ),
        (
            "permeability",
            "1 m/s",
            "`clay` has permeability = 1 m/s, outside the range",
        ),
    ];
    for (key, value, expected) in cases {
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
        ("young", "101 kPa"),
        ("permeability", "1e-2 m/s"),
    ];
    for (key, value) in quiet {
        let file = overridden(SLOPE, &[&format!("materials.clay.{key}={value}")]).unwrap();
        let warnings = file.warnings();
        assert!(!warnings.contains("outside the range"), "{warnings}");
        let is_soft = warnings.contains("hardly yields");
        assert!(!is_soft || key == "cohesion", "{warnings}");
    }
}

/// GOAL: one table of ranges holds for constants, profiles and rasters, and for loads, reinforcement and the case as a whole.
/// ORACLE: by hand: a slip of a thousand, of a hundred or of a per cent each; beside it a value that is found in the ground.
#[test]
fn ranges_hold_for_all_forms_of_a_value() {
    let profile = |cu: &str| format!("materials.clay.cohesion={cu}");
    let cases = [
        (profile("{ levels = [\"20 m\", \"2 m\"], values = [\"20 kPa\", \"40 MPa\"] }"), "cohesion up to 40000 kPa"),
        (profile("{ at_surface = \"40 MPa\", gradient = \"1 kPa/m\" }"), "cohesion up to 40000 kPa"),
        (profile("{ at_top = \"20 kPa\", gradient = \"1.5 MPa/m\" }"), "cohesion up to 15000 kPa"),
        (profile("{ x = [\"0 m\", \"60 m\"], y = [\"0 m\", \"22 m\"], rows = [[\"20 kPa\", \"20 MPa\"], [\"20 kPa\", \"20 kPa\"]] }"), "cohesion up to 20000 kPa"),
        ("materials.clay.unit_weight={ levels = [\"20 m\", \"2 m\"], values = [\"20 N/m3\", \"20 kN/m3\"] }".to_owned(), "unit_weight down to 0.02 kN/m3"),
        ("materials.clay.friction={ levels = [\"20 m\", \"2 m\"], values = [\"0.35 deg\", \"30 deg\"] }".to_owned(), "friction down to 0.35 deg"),
        ("materials.clay.unit_weight=196 kN/m3".to_owned(), "`clay` has unit_weight = 196 kN/m3"),
        ("materials.clay.young={ levels = [\"20 m\", \"2 m\"], values = [\"40 kPa\", \"60 kPa\"] }".to_owned(), "`clay` has young up to 60 kPa, "),
        ("case.gravity=9.81 mm/s2".to_owned(), "gravity = 0.00981 m/s2"),
        ("case.gravity=9810 m/s2".to_owned(), "gravity = 9810 m/s2"),
        ("case.water_unit_weight=9.81 N/m3".to_owned(), "water_unit_weight = 0.00981 kN/m3 is not that of water"),
        ("case.water_unit_weight=98.1 kN/m3".to_owned(), "water has 9.8 kN/m3 under a gravity of 9.81 m/s2"),
    ];
    for (set, expected) in cases {
        let file = overridden(SLOPE, &[&set, "materials.clay.k0=0.5"])
            .unwrap_or_else(|error| panic!("{set}: {error}"));
        let warnings = file.warnings();
        assert!(warnings.contains(expected), "{set}: {warnings}");
    }
    let quiet = [
        vec![profile(
            "{ at_surface = \"20 kPa\", gradient = \"3 kPa/m\" }",
        )],
        vec!["case.water_unit_weight=10.1 kN/m3".to_owned()],
        vec![
            "case.gravity=981 m/s2".to_owned(),
            "case.water_unit_weight=981 kN/m3".to_owned(),
        ],
    ];
    for set in quiet {
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let warnings = overridden(SLOPE, &set).unwrap().warnings();
        assert!(
            !warnings.contains("outside the range") && !warnings.contains("not that of water"),
            "{warnings}"
        );
    }
}

/// GOAL: slips in loads and in reinforcement are told, and each once. ORACLE: the shipped files, whose values are usual.
#[test]
fn loads_and_reinforcement_have_ranges() {
    let once = |name: &str, set: &[&str], expected: &str| {
        let file = find(name).unwrap();
        let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
        let file = file
            .case_file(set)
            .unwrap_or_else(|error| panic!("{error}"));
        let warnings = file.warnings();
        assert_eq!(
            warnings.matches(expected).count(),
            1,
            "{expected}: {warnings}"
        );
    };
    let nail = |key: &str| format!("reinforcement.0.{key}");
    once(
        "nailed_cut",
        &[&nail("capacity=30 N/m")],
        "has capacity = 0.03 kN",
    );
    once("nailed_cut", &[&nail("bond=20 Pa")], "has bond = 0.02 kPa");
    once(
        "nailed_cut",
        &[&nail("bond=20 MPa")],
        "has bond = 20000 kPa",
    );
    once(
        "nailed_cut",
        &[&nail("stiffness=80000 MN/m")],
        "has stiffness = 80000 MN",
    );
    once(
        "nailed_cut",
        &[&nail("plate=1.5 mm")],
        "has plate = 0.0015 m",
    );
    once(
        "strip_load",
        &["loads.0.pressure=20 MPa"],
        "has pressure = 20000 kPa",
    );
    once(
        "strip_load",
        &["loads.0.pressure=-20 kPa"],
        "pulls at the soil",
    );
    once(
        "rock_slope",
        &["materials.rock.sci=30 kPa"],
        "has sci = 0.03 MPa",
    );
    once("rock_slope", &["materials.rock.gsi=0.3"], "has gsi = 0.3");
    once(
        "anisotropic_footing",
        &["materials.clay.anisotropy.simple_shear=70"],
        "has simple_shear = 70",
    );
}

/// GOAL: a tolerance with which nothing is in equilibrium is refused, and a loose one is told. ORACLE: 0.1 told F = 3.8 for 1.35.
#[test]
fn a_tolerance_has_bounds() {
    let printed = |tolerance: &str| {
        printed(&overridden(
            SLOPE,
            &[&format!("solver.tolerance={tolerance}")],
        ))
    };
    assert!(
        printed("0.1").contains("must be above 0 and at most 0.01"),
        "{}",
        printed("0.1")
    );
    assert!(
        printed("0.005").contains("tolerance = 0.005 is loose"),
        "{}",
        printed("0.005")
    );
    assert!(!printed("1e-3").contains("is loose"));
}

/// GOAL: stages that change nothing, or that lift a body off its soil, are told; those that change something are not.
/// ORACLE: by hand.
#[test]
fn stages_that_change_nothing_are_named() {
    let load = "[[loads]]\nname = \"q\"\ntype = \"pressure\"\nfrom = [\"2 m\", \"20 m\"]\nto = [\"8 m\", \"20 m\"]\npressure = \"20 kPa\"\n";
    let stages = |more: &str| {
        let text = format!(
            "{}\n{load}[[stages]]\nname = \"q\"\ntype = \"load\"\nload = \"q\"\n{more}",
            SLOPE.1
        );
        printed(&CaseFile::parse(SLOPE.0, &text, &[]))
    };
    let again = |key: &str| stages(&format!("[[stages]]\nname = \"again\"\n{key}"));
    let text = again("type = \"load\"\nload = \"q\"\n");
    assert!(
        text.contains("stage `again` changes nothing: load `q` acts with a factor of 1 already"),
        "{text}"
    );
    assert!(
        text.contains("factor = 2 makes it twice the load"),
        "{text}"
    );
    let text = again("type = \"gravity\"\ngeometry = \"given\"\n");
    assert!(
        text.contains("changes nothing: gravity acts as in stage `initial stresses` already"),
        "{text}"
    );
    for more in [
        "type = \"load\"\nload = \"q\"\nfactor = 2.0\n",
        "type = \"load\"\nload = \"q\"\nfactor = 0.0\n",
        "type = \"gravity\"\nhorizontal = 0.1\n",
    ] {
        let text = again(more);
        assert!(!text.contains("nothing:"), "{text}");
    }
    let none = printed(&overridden(SLOPE, &["stages.initial stresses.factor=0.0"]));
    assert!(none.contains("raises no weight: factor = 0"), "{none}");
    let pushed = |by: &str| {
        let set = [format!("stages.push.bodies.0.y={by}")];
        find("contact_footing")
            .unwrap()
            .case_file(set)
            .unwrap()
            .warnings()
    };
    assert!(
        pushed("0.01 m").contains("lifts the rigid body `footing` off the soil that it rests on"),
        "{}",
        pushed("0.01 m")
    );
    assert!(
        pushed("0 m").contains("moves the rigid body `footing` by nothing"),
        "{}",
        pushed("0 m")
    );
}

/// GOAL: values that are possible and hardly meant are told, with their places and remedies; those next to them are not.
/// ORACLE: by hand: tan 20° = 0.364; K₀ of soil without cohesion at 20° lies between 0.49 and 2.04; E / (3 (1 − 2 ν)) of 20 MPa
/// and 0.3 is 16.7 MPa.
#[test]
fn values_that_are_hardly_meant_are_named() {
    let of = |key: &str, value: &str| {
        let impact = find("impact").unwrap();
        let (file, set) = match key {
            "rigid" => (
                ("impact.toml", impact.text),
                format!("rigid.0.interface={value}"),
            ),
            "damping" => (
                ("impact.toml", impact.text),
                format!(
                    "stages.fall.rayleigh={{ ratio = {value}, periods = [\"0.1 s\", \"1 s\"] }}"
                ),
            ),
            "water" => (
                SLOPE,
                format!(
                    "materials.clay={{ model = \"mohr-coulomb\", unit_weight = \"20 kN/m3\", young = \"20 MPa\", poisson = 0.3, \
                     cohesion = \"10 kPa\", friction = \"20 deg\", dilation = \"0 deg\", drainage = \"undrained\", pore_water = \"{value}\" }}"
                ),
            ),
            key => (SLOPE, format!("{key}={value}")),
        };
        overridden(file, &[&set]).map(|file| file.warnings())
    };
    let printed = [
        (
            "rigid",
            "{ friction = 20 }",
            "{ friction = 0.4 }",
            "angle = \"20 deg\"",
        ),
        (
            "rigid",
            "{ adhesion_share = 1.5 }",
            "{ adhesion_share = 1 }",
            "more than the strength of the soil",
        ),
        (
            "water",
            "10 kPa",
            "17 MPa",
            "softer than the soil around it",
        ),
        ("damping", "5", "0.05", "0.05 are 5 %"),
        ("materials.clay.k0", "8", "0.6", "beyond its strength"),
    ];
    for (key, slip, meant, expected) in printed {
        let warnings = of(key, slip).unwrap();
        assert!(warnings.contains(expected), "{key}: {warnings}");
        let warnings = of(key, meant).unwrap();
        assert!(!warnings.contains(expected), "{key}: {warnings}");
    }
}

/// GOAL: keys of materials that nothing of a case asks for are named, and are quiet where something does. ORACLE: the words of the
/// messages, and their places.
#[test]
fn keys_without_effect_are_named() {
    let warned = |set: &[&str]| overridden(SLOPE, set).unwrap().warnings();
    let k0 = "`k0` of `clay` has no effect";
    assert!(warned(&["materials.clay.k0=0.6"]).contains(k0));
    let saturated = "`saturated_unit_weight` of `clay` has no effect";
    assert!(warned(&["materials.clay.saturated_unit_weight=21 kN/m3"]).contains(saturated));
    assert!(!warned(&[]).contains(saturated));
    let strength = "materials.clay={ model = \"tresca\", unit_weight = \"20 kN/m3\", young = \"20 MPa\", poisson = 0.4, cu = { ratio = 0.3, at_least = \"5 kPa\", SHARE } }";
    let exponent = "`exponent` has no effect";
    let alone = strength.replace("SHARE", "exponent = 0.9");
    assert!(warned(&[&alone]).contains(exponent));
    let both = strength.replace("SHARE", "exponent = 0.9, ocr = 2.0");
    assert!(!warned(&[&both]).contains(exponent));
    // A level of the water that stood in the ground saturates it, and a share of the weight saturates nothing.
    let level = strength.replace("SHARE", "water_level = \"6 m\"");
    let level = level.replace(
        "poisson = 0.4,",
        "poisson = 0.4, saturated_unit_weight = \"21 kN/m3\",",
    );
    assert!(!warned(&[&level]).contains(saturated));
    let wet = |set: &str| warned(&["materials.clay.saturated_unit_weight=21 kN/m3", set]);
    let by_share = wet("water=[{ name = \"w\", r_u = 0.2 }]");
    assert!(
        by_share.contains(saturated) && by_share.contains("has a table"),
        "{by_share}"
    );
    assert!(!wet("water=[{ name = \"w\", level = \"3 m\" }]").contains(saturated));
}

/// GOAL: curves that would share the file of the table of factors of safety in time are refused, and a force at a point of a body of
/// revolution is answered as such. ORACLE: the words of the messages.
#[test]
fn names_of_runs_and_points_on_circles_are_refused() {
    let curve = "curves=[{ name = \"safety-in-time\", x = { of = \"gravity_factor\" }, y = { of = \"largest_displacement\" } }]";
    let printed = overridden(SLOPE, &[curve]).unwrap_err().to_string();
    assert!(
        printed.contains("a curve cannot be called `safety-in-time`"),
        "{printed}"
    );
    let point = "loads=[{ name = \"q\", type = \"point\", at = [\"1 m\", \"2 m\"], force = [\"0 kN\", \"-10 kN\"] }]";
    let printed = overridden(SLOPE, &[point, "case.analysis=axisymmetric"]);
    let printed = printed.unwrap_err().to_string();
    assert!(
        printed.contains("along a whole circle") && !printed.contains("one metre thick"),
        "{printed}"
    );
}

/// GOAL: sharp edges of a body that sinks and slides are named: they plough. CASE: a footing that is pressed and pushed.
#[test]
fn sharp_edges_that_slide_are_named() {
    let warned = |rounding: &str, by: &str| {
        let shipped = igimp_input::shipped::find("eccentric_footing").unwrap();
        let changes = [
            format!("rigid.footing.rounding={rounding}"),
            format!("stages.load.bodies=[{{ body = \"footing\", {by} }}]"),
        ];
        let warnings = shipped.case_file(changes).unwrap().warnings();
        warnings.contains("plough the soil beside it")
    };
    assert!(warned("0", "x = \"0.01 m\""));
    assert!(warned("0", "force_x = \"1 kN/m\""));
    assert!(!warned("0", "y = \"-0.01 m\""));
    assert!(!warned("0.3", "x = \"0.01 m\""));
}

/// GOAL: sides that hold soil against the motion of the ground are named: they go along as rigid walls. CASE: the shipped slope in an
/// earthquake, with soil in free field at its sides and without.
#[test]
fn rigid_walls_of_shaken_ground_are_named() {
    let warned = |free_field: &str| {
        let shipped = igimp_input::shipped::find("earthquake_slope").unwrap();
        let changes = [
            "stages.earthquake.tied_sides=false".to_owned(),
            format!("stages.earthquake.free_field={free_field}"),
        ];
        shipped.case_file(changes).unwrap().warnings()
    };
    assert!(!warned("[\"left\", \"right\"]").contains("rigid walls"));
    assert!(warned("[\"left\"]").contains("right goes with the base as rigid walls"));
    assert!(warned("[]").contains("left and right go with the base as rigid walls"));
}
