//! GOAL: supports that hold nothing, gaps that cells bridge and walls that soil sticks to are told with place and remedy; ground
//! that reaches its sides, gaps as wide as cells and faces that are held are not.
//! ORACLE: the geometry, by hand. Their effect on a factor of safety: 0.48 for 1.35, 1.35 for 1.06, 1.29 without failure of the wall.

use igimp_input::CaseFile;

const HEAD: &str = r#"igimp = 1
[case]
title = "ground"
[materials.clay]
model = "tresca"
unit_weight = "18 kN/m3"
young = "20 MPa"
poisson = 0.49
cu = "30 kPa"
[materials.concrete]
model = "elastic"
unit_weight = "24 kN/m3"
young = "20 GPa"
poisson = 0.2
[[stages]]
name = "weight"
type = "gravity"
[[stages]]
name = "safety"
type = "strength-reduction"
"#;

/// A body of clay, or of another material, by its corners in metres.
fn body(name: &str, material: &str, corners: &[[f64; 2]]) -> String {
    let corners = corners
        .iter()
        .map(|[x, y]| format!("[\"{x} m\", \"{y} m\"]"));
    let corners = corners.collect::<Vec<_>>().join(", ");
    format!("[[bodies]]\nname = \"{name}\"\nmaterial = \"{material}\"\npolygon = [{corners}]\n")
}

fn rectangle([left, bottom]: [f64; 2], [right, top]: [f64; 2]) -> [[f64; 2]; 4] {
    [[left, bottom], [right, bottom], [right, top], [left, top]]
}

fn warnings(text: &str) -> String {
    let file = CaseFile::parse("ground.toml", text, &[]);
    file.unwrap_or_else(|error| panic!("{error}")).warnings()
}

/// A grid of cells of 1 m between two places in x, 12 m high.
fn grid(left: f64, right: f64) -> String {
    format!(
        "[grid]\ncell = \"1 m\"\ndomain = {{ x = [\"{left} m\", \"{right} m\"], y = [\"0 m\", \"12 m\"] }}\n"
    )
}

const SLOPE: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [30.0, 0.0],
    [30.0, 5.0],
    [20.0, 5.0],
    [15.0, 10.0],
    [0.0, 10.0],
];

fn slope(left: f64, right: f64, more: &str) -> String {
    let body = body("slope", "clay", &SLOPE);
    warnings(&format!("{HEAD}{}{body}{more}", grid(left, right)))
}

#[test]
fn a_side_that_the_ground_does_not_reach_is_told() {
    assert!(!slope(0.0, 30.0, "").contains("touches no soil"));
    let text = slope(-8.0, 30.0, "");
    for part in [
        "left = \"roller\" touches no soil: the ground ends at x = 0 m, 8 m before this side",
        "upright face of 10 m",
        "let [grid] domain end at x = 0 m, or hold x there by [[boundaries.boxes]]",
        "left = \"free\" if the face is meant to be free",
    ] {
        assert!(text.contains(part), "{text}");
    }
    assert!(!text.contains("right ="), "{text}");
    let text = slope(0.0, 32.0, "");
    assert!(
        text.contains("the ground ends at x = 30 m, 2 m before this side"),
        "{text}"
    );
    assert!(text.contains("upright face of 5 m"), "{text}");
}

/// A face less than a cell before a side is held by it: half of a trench of 0.6 m and 1.2 m on cells of 1 m has F = 9.2 and 4.4 for 0.91.
#[test]
fn a_gap_at_a_side_is_told() {
    let trench = |at: f64| {
        let corners = [
            [0.0, 0.0],
            [30.0, 0.0],
            [30.0, 3.0],
            [at, 3.0],
            [at, 9.0],
            [0.0, 9.0],
        ];
        let half = body("half", "clay", &corners);
        warnings(&format!("{HEAD}{}{half}", grid(0.0, 30.0)))
    };
    for at in [29.7, 29.4, 29.1] {
        let text = trench(at);
        let held =
            "right = \"roller\" holds an upright face of 6 m across a gap narrower than a cell";
        assert!(text.contains(held), "{at}: {text}");
        assert!(!text.contains("left ="), "{text}");
    }
    for at in [30.0, 29.0, 28.0] {
        assert!(!trench(at).contains("across a gap"), "{at}");
    }
    // All of the ground ends so.
    let block = body("block", "clay", &rectangle([0.3, 0.0], [30.0, 9.0]));
    let text = warnings(&format!("{HEAD}{}{block}", grid(0.0, 30.0)));
    assert!(
        text.contains("left = \"roller\" holds an upright face of 9 m"),
        "{text}"
    );
    assert!(!text.contains("touches no soil"), "{text}");
    // A slope that comes down to the side, as steep as two to one.
    let corners = [
        [0.0, 0.0],
        [30.0, 0.0],
        [30.0, 1.0],
        [26.0, 9.0],
        [0.0, 9.0],
    ];
    let steep = body("steep", "clay", &corners);
    let text = warnings(&format!("{HEAD}{}{steep}", grid(0.0, 30.0)));
    assert!(!text.contains("across a gap"), "{text}");
}

/// Structures on the soil beside a face do not hold it: the half of a footing had 3.1 for 5.6 of its resistance.
#[test]
fn a_footing_beside_a_face_does_not_hold_it() {
    let ground = body("ground", "clay", &rectangle([0.0, 0.0], [30.0, 9.0]));
    let footing = "[[rigid]]\nname = \"footing\"\ntype = \"rectangle\"\nfrom = [\"-1 m\", \"9 m\"]\nto = [\"4 m\", \"11 m\"]\nfrom_start = true\n";
    let text = warnings(&format!("{HEAD}{}{ground}{footing}", grid(-2.0, 30.0)));
    assert!(text.contains("left = \"roller\" touches no soil"), "{text}");
}

#[test]
fn a_face_that_is_meant_or_held_is_not_told() {
    let quiet = |more: &str| {
        let text = slope(-8.0, 30.0, more);
        assert!(!text.contains("touches no soil"), "{text}");
    };
    quiet("[boundaries]\nleft = \"free\"\n");
    quiet(
        "[[boundaries.boxes]]\nname = \"end\"\nfrom = [\"0 m\", \"0 m\"]\nto = [\"0 m\", \"10 m\"]\nfix = [\"x\"]\n",
    );
    quiet(
        "[[rigid]]\nname = \"wall\"\ntype = \"rectangle\"\nfrom = [\"-2 m\", \"0 m\"]\nto = [\"0 m\", \"11 m\"]\nfrom_start = true\n",
    );
    // A slope that runs out on the base before the side, and a bank of half a cell.
    for foot in [0.0, 0.5] {
        let corners = [
            [0.0, 0.0],
            [28.0, 0.0],
            [28.0, foot],
            [8.0, 10.0],
            [0.0, 10.0],
        ];
        let heap = body("heap", "clay", &corners);
        let text = warnings(&format!("{HEAD}{}{heap}", grid(0.0, 40.0)));
        assert!(!text.contains("touches no soil"), "{text}");
    }
    // A structure beside which there is room.
    let block = body("block", "concrete", &rectangle([0.0, 0.0], [4.0, 9.0]));
    let search = "[[stages]]\nname = \"safety\"\ntype = \"strength-reduction\"\n";
    let head = HEAD.replace(search, "");
    let text = warnings(&format!("{head}{}{block}", grid(0.0, 10.0)));
    assert!(!text.contains("touches no soil"), "{text}");
}

#[test]
fn the_same_in_space() {
    let warnings_of = |back: f64, more: &str| {
        let text = format!(
            "{HEAD}[grid]\ncell = \"1 m\"\ndomain = {{ x = [\"0 m\", \"12 m\"], y = [\"0 m\", \"{back} m\"], z = [\"0 m\", \"9 m\"] }}\n\
             [[bodies]]\nname = \"slope\"\nmaterial = \"clay\"\nacross = [\"0 m\", \"5 m\"]\n\
             polygon = [[\"0 m\", \"0 m\"], [\"12 m\", \"0 m\"], [\"12 m\", \"4 m\"], [\"8 m\", \"4 m\"], [\"4 m\", \"8 m\"], [\"0 m\", \"8 m\"]]\n{more}"
        );
        warnings(&text.replace("title =", "analysis = \"3d\"\ntitle ="))
    };
    assert!(!warnings_of(5.0, "").contains("touches no soil"));
    let text = warnings_of(7.0, "");
    assert!(
        text.contains(
            "back = \"roller\" touches no soil: the ground ends at y = 5 m, 2 m before this side"
        ),
        "{text}"
    );
    // The mean height of the face: 12 by 4 m and a half of 8 by 4 m, over 12 m.
    assert!(text.contains("upright face of 6 m"), "{text}");
    let text = warnings_of(7.0, "[boundaries]\nback = \"free\"\n");
    assert!(!text.contains("touches no soil"), "{text}");
}

/// A block with a notch 6 m deep of some width.
fn notched(width: f64) -> String {
    let [left, right] = [12.2, 12.2 + width];
    let corners = [
        [0.0, 0.0],
        [30.0, 0.0],
        [30.0, 10.0],
        [right, 10.0],
        [right, 4.0],
        [left, 4.0],
        [left, 10.0],
        [0.0, 10.0],
    ];
    let body = body("ground", "clay", &corners);
    warnings(&format!("{HEAD}{}{body}", grid(0.0, 30.0)))
}

#[test]
fn a_notch_narrower_than_a_cell_is_told() {
    let text = notched(0.3);
    assert!(
        text.contains(
            "a gap of 0.3 m, narrower than a cell, cuts into body `ground` at (12.35 m, 7 m)"
        ),
        "{text}"
    );
    assert!(
        text.contains("make it as wide as a cell, or cells as small as the gap"),
        "{text}"
    );
    assert!(!notched(1.0).contains("a gap of"), "{}", notched(1.0));
    assert!(!notched(1.5).contains("a gap of"));
}

#[test]
fn a_body_that_is_taken_away_leaves_a_gap() {
    let dig = |width: f64, is_dug: bool| {
        let far = 10.0 + width;
        let parts = [
            body("left", "clay", &rectangle([0.0, 0.0], [10.0, 10.0])),
            body("slot", "clay", &rectangle([10.0, 4.0], [far, 10.0])),
            body("below", "clay", &rectangle([10.0, 0.0], [far, 4.0])),
            body("right", "clay", &rectangle([far, 0.0], [30.0, 10.0])),
        ];
        let stage = "[[stages]]\nname = \"dig\"\ntype = \"construction\"\nremove = [\"slot\"]\n";
        let stage = if is_dug { stage } else { "" };
        warnings(&format!(
            "{HEAD}{}{}{stage}",
            grid(0.0, 30.0),
            parts.concat()
        ))
    };
    let text = dig(0.4, true);
    assert!(
        text.contains("a gap of 0.4 m parts body `right` from body `left` at (10.2 m, "),
        "{text}"
    );
    assert!(!dig(0.4, false).contains("a gap of"));
    assert!(!dig(1.0, true).contains("a gap of"));
}

#[test]
fn a_gap_in_space_is_told() {
    let warnings_of = |far: f64| {
        let text = format!(
            "{HEAD}[grid]\ncell = \"1 m\"\ndomain = {{ x = [\"0 m\", \"8 m\"], y = [\"0 m\", \"5 m\"], z = [\"0 m\", \"6 m\"] }}\n\
             [[bodies]]\nname = \"a\"\nmaterial = \"clay\"\nbox = {{ from = [\"0 m\", \"0 m\", \"0 m\"], to = [\"8 m\", \"2.4 m\", \"5 m\"] }}\n\
             [[bodies]]\nname = \"b\"\nmaterial = \"clay\"\nbox = {{ from = [\"0 m\", \"{far} m\", \"0 m\"], to = [\"8 m\", \"5 m\", \"5 m\"] }}\n"
        );
        warnings(&text.replace("title =", "analysis = \"3d\"\ntitle ="))
    };
    let text = warnings_of(2.7);
    assert!(
        text.contains("a gap of 0.3 m parts body `b` from body `a` at ("),
        "{text}"
    );
    assert!(!warnings_of(2.4).contains("a gap of"));
    assert!(!warnings_of(3.4).contains("a gap of"));
}

#[test]
fn a_thin_wall_in_soil_is_told() {
    let wall = |thickness: f64, material: &str, foot: f64| {
        let far = 10.0 + thickness;
        let parts = [
            body("behind", "clay", &rectangle([0.0, 0.0], [10.0, 10.0])),
            body("wall", material, &rectangle([10.0, 2.0], [far, 10.0])),
            body("below", "clay", &rectangle([10.0, 0.0], [far, 2.0])),
            body("before", "clay", &rectangle([far, 0.0], [30.0, foot])),
        ];
        warnings(&format!("{HEAD}{}{}", grid(0.0, 30.0), parts.concat()))
    };
    let text = wall(1.0, "concrete", 5.0);
    assert!(
        text.contains("body `wall` is 1 cell thick with soil on both sides, and hardly yields"),
        "{text}"
    );
    assert!(
        text.contains("a wall that soil slides along is a [[rigid]] body"),
        "{text}"
    );
    let text = wall(0.2, "concrete", 5.0);
    assert!(text.contains("body `wall` is 0.2 cells thick"), "{text}");
    for quiet in [wall(4.0, "concrete", 5.0), wall(1.0, "clay", 5.0)] {
        assert!(!quiet.contains("hardly yields"), "{quiet}");
    }
}
