//! GOAL: the meshes of a study are meshes of one problem, and where they are not it is said.
//! ORACLE: by hand.

use igimp_model::meshes::{differences, label, meshes, refinements};
use igimp_model::{Case, FixedBox, Load, LoadKind};

use crate::block;

/// Cells of 0.5 m from 0 to 4 m.
fn study(footing: Option<[f64; 2]>) -> Case<2> {
    let mut case = block();
    case.mesh_study.meshes = 3;
    case.loads.extend(footing.map(|[from, to]| Load {
        name: "footing".into(),
        kind: LoadKind::RigidFooting {
            from: [from, 2.0],
            to: [to, 2.0],
            rough: true,
            reaction_factor: 1.0,
        },
    }));
    case
}

#[test]
fn cells_are_halved() {
    let case = study(None);
    assert_eq!(refinements(&case), [1, 2, 4]);
    let finest = &meshes(&case)[2];
    assert_eq!(finest.grid.cells(), [32, 32]);
    assert_eq!(format!("{:?}", finest.grid.upper()), "[4.0, 4.0]");
    assert_eq!(finest.mesh_study.meshes, 1);
    assert!(differences(&case).is_empty());
    assert_eq!([1, 2].map(label), ["h", "h/2"]);
}

/// GOAL: an edge in the middle of a cell stays there; the axis of symmetry at the side does not count.
#[test]
fn a_footing_keeps_its_width() {
    let case = study(Some([0.0, 0.75]));
    assert_eq!(refinements(&case), [1, 3, 5]);
    assert!(differences(&case).is_empty());
    let on_line = study(Some([0.0, 1.0]));
    assert_eq!(refinements(&on_line), [1, 2, 4]);
    assert!(differences(&on_line).is_empty());
    let odd = study(Some([0.0, 0.6]));
    assert_eq!(differences(&odd).len(), 1);
}

/// GOAL: so does a side of a rigid body; one elsewhere is told, once for each side within the grid.
#[test]
fn the_sides_of_a_body_keep_their_place() {
    let with = |cell: &str, side: &str| {
        let shipped = igimp_input::shipped::find("contact_footing").unwrap();
        let overrides = [
            format!("grid.cell=\"{cell}\""),
            "grid.fit=none".to_owned(),
            format!("rigid.footing.to=[\"{side}\", \"3 m\"]"),
            "mesh_study.meshes=3".to_owned(),
        ];
        shipped.case_file(overrides).unwrap().into_case()
    };
    let mid_cell = with("1/9 m", "0.5 m");
    assert_eq!(refinements(&mid_cell), [1, 3, 5]);
    assert!(differences(&mid_cell).is_empty());
    assert!(differences(&with("0.1 m", "0.5 m")).is_empty());
    let diff = differences(&with("0.1 m", "0.475 m"));
    assert_eq!(diff.len(), 1);
    assert!(diff[0].contains("`footing` at x = 0.475 m"), "{}", diff[0]);
}

#[test]
fn a_box_that_catches_more_nodes_is_told() {
    let mut case = study(None);
    let held = |lower: [f64; 2], upper: [f64; 2]| FixedBox {
        name: "wall".into(),
        lower,
        upper,
        fix: [true; 2],
    };
    // Around a line of nodes, and beyond the grid.
    case.boundaries.boxes = vec![held([0.95, -1.0], [1.05, 9.0])];
    assert!(differences(&case).is_empty());
    case.boundaries.boxes = vec![held([0.95, 0.0], [1.3, 2.0])];
    assert!(differences(&case)[0].contains("`wall`"));
}
