//! Flow that fills all pores, against exact and published values.

use crate::common::{faces, flow, flow_below, grid, rectangle};
use igimp_seepage::{
    Conditions, Extent, InGround, Named, OnFaces, SeepageBody, SeepageError, Soil, solve,
};

fn confined(soils: &[f64]) -> Conditions<2> {
    Conditions {
        confined: true,
        ..Conditions::of(soils.iter().copied().map(Soil::isotropic).collect())
    }
}

/// GOAL: discharge round the tip of a sheet pile, from a half of the layer and two meshes: the error falls with the size of
/// cells at the tip. ORACLE: q/(k h) = K(k')/(2 K(k)), k = sin(π s / 2T).
#[test]
fn sheet_piles_let_the_known_flow_round_their_tip() {
    for (driven, exact) in [
        (0.1, 1.02981),
        (0.25, 0.73461),
        (0.5, 0.5),
        (0.75, 0.34032),
        (0.9, 0.24276),
    ] {
        let [coarse, fine] = [20_u32, 40].map(|cells| {
            let size = cells as usize;
            let grid = grid([0.0, 0.0], 1.0 / f64::from(cells), [3 * size, size]);
            let mut conditions = confined(&[1.0]);
            conditions.faces = vec![
                faces("ground", [0.0, 1.0], [3.0, 1.0], OnFaces::Head(0.0)),
                faces("gap", [0.0, 0.0], [0.0, 1.0 - driven], OnFaces::Head(0.5)),
            ];
            let ground = [rectangle([0.0, 0.0], [3.0, 1.0])];
            flow(&grid, &ground, &conditions).unwrap().outflow
        });
        let found = 2.0 * fine - coarse;
        println!("s/T {driven}: {coarse:.5} {fine:.5} -> {found:.5} of {exact}");
        assert!((found / exact - 1.0).abs() < 0.01);
    }
}

/// GOAL: layers one above the other, on lines of the grid and off them, through a section too. ORACLE: the harmonic mean.
#[test]
fn layers_have_the_harmonic_mean() {
    for shift in [0.0, 0.3] {
        let grid = grid([0.0, -shift * 0.25], 0.25, [4, 17]);
        let mut conditions = confined(&[1e-5, 1e-7, 4e-6]);
        conditions.faces = vec![
            faces("bottom", [0.0, 0.0], [1.0, 0.0], OnFaces::Head(7.0)),
            faces("top", [0.0, 4.0], [1.0, 4.0], OnFaces::Head(4.0)),
        ];
        let across = Extent {
            lower: [0.0, 2.1],
            upper: [1.0, 2.1],
        };
        conditions.sections = vec![("middle".to_owned(), across)];
        let ground = [0.0, 1.0, 2.5, 4.0];
        let ground: Vec<_> = (ground.windows(2))
            .map(|ends| rectangle([0.0, ends[0]], [1.0, ends[1]]))
            .collect();
        let found = flow(&grid, &ground, &conditions).unwrap();
        let exact = 3.0 / (1.0 / 1e-5 + 1.5 / 1e-7 + 1.5 / 4e-6);
        for flux in [found.inflow, found.outflow, found.sections[0].inflow] {
            assert!((flux / exact - 1.0).abs() < 1e-9, "{flux} of {exact}");
        }
    }
}

/// GOAL: permeability that falls tenfold with depth, on lines of the grid and off them: across in series, along side by side.
/// ORACLE: for k = k₀ (1 + a z) the integrals by hand, q = Δh a k₀ / ln(1 + a H) and q = Δh/L k₀ (H + a H²/2); the mean of k in
/// place of its inverse, 1.41 times the first, is the control.
#[test]
fn permeability_that_grows_upwards_has_the_mean_of_its_direction() {
    let (least, growth, thick) = (1e-6, 2.25, 4.0);
    let scale = |x: &[f64; 2]| 1.0 + growth * x[1];
    // Cells that the ground cuts take k at the middles of a quarter of their height: that error falls with the square of the cell.
    for (shift, cell, accuracy) in [(0.0, 0.25, 1e-7), (0.3, 0.25, 5e-4), (0.3, 0.125, 1.25e-4)] {
        let count = (1.0 / cell) as usize;
        let grid = grid([0.0, -shift * cell], cell, [count, 4 * count + 1]);
        let region = rectangle([0.0, 0.0], [1.0, thick]);
        let body = SeepageBody {
            region: &region,
            soil: 0,
            scale: Some(&scale),
        };
        let through = |ends: [([f64; 2], [f64; 2]); 2]| {
            let mut conditions = confined(&[least]);
            conditions.faces = (std::iter::zip(ends, [7.0, 4.0]))
                .map(|((lower, upper), head)| {
                    faces(&format!("{head}"), lower, upper, OnFaces::Head(head))
                })
                .collect();
            let found = solve(&grid, &[body], &conditions, &|_| None).unwrap();
            assert!((found.inflow / found.outflow - 1.0).abs() < 1e-10);
            found.outflow
        };
        let across = through([([0.0, 0.0], [1.0, 0.0]), ([0.0, thick], [1.0, thick])]);
        let along = through([([0.0, 0.0], [0.0, thick]), ([1.0, 0.0], [1.0, thick])]);
        let series = 3.0 * growth * least / (1.0 + growth * thick).ln();
        let beside = 3.0 * least * thick * (1.0 + 0.5 * growth * thick);
        println!(
            "shift {shift}: {} {}",
            across / series - 1.0,
            along / beside - 1.0
        );
        assert!((across / series - 1.0).abs() < accuracy);
        assert!((along / beside - 1.0).abs() < accuracy);
        assert!(3.0 * least * (1.0 + 0.5 * growth * thick) / thick > 1.3 * across);
    }
}

/// GOAL: layers that slope against the grid, by bedding and angle. ORACLE: the tensor of the bedding turned by its angle.
#[test]
fn bedding_turns_the_flow() {
    let grid = grid([0.0, 0.0], 0.25, [4, 4]);
    let angle: f64 = 0.5;
    let mut conditions = confined(&[1.0]);
    conditions.soils[0] = Soil {
        along: 4.0,
        across: 1.0,
        angle,
        ..Soil::isotropic(1.0)
    };
    conditions.faces = vec![
        faces("left", [0.0, 0.0], [0.0, 1.0], OnFaces::Head(1.0)),
        faces("right", [1.0, 0.0], [1.0, 1.0], OnFaces::Head(0.0)),
        // The flow through top and bottom where the head has no slope along y.
        faces(
            "top",
            [0.1, 1.0],
            [0.9, 1.0],
            OnFaces::Inflow(-1.5 * (2.0 * angle).sin()),
        ),
        faces(
            "bottom",
            [0.1, 0.0],
            [0.9, 0.0],
            OnFaces::Inflow(1.5 * (2.0 * angle).sin()),
        ),
    ];
    conditions.faces[2].within = Extent {
        lower: [0.0, 1.0],
        upper: [1.0, 1.0],
    };
    conditions.faces[3].within = Extent {
        lower: [0.0, 0.0],
        upper: [1.0, 0.0],
    };
    let found = flow(&grid, &[rectangle([0.0, 0.0], [1.0, 1.0])], &conditions).unwrap();
    let along = 4.0 * angle.cos().powi(2) + angle.sin().powi(2);
    let through = &found.discharges[0];
    assert!((through.inflow - through.outflow - along).abs() < 1e-9);
    assert!((found.head(&[0.3, 0.7]) - 0.7).abs() < 1e-9);
}

/// GOAL: a boundary that lies on no line of the grid. ORACLE: heads round a cylinder as published programs have them.
#[test]
fn flow_round_a_cylinder() {
    let grid = grid([0.0, 0.0], 0.125, [64, 32]);
    let arc = (0..=90).map(|k| std::f64::consts::PI * (1.0 - f64::from(k) / 90.0));
    let mut ground = vec![[0.0, 0.0]];
    ground.extend(arc.map(|angle| [4.0 + angle.cos(), angle.sin()]));
    ground.extend([[8.0, 0.0], [8.0, 4.0], [0.0, 4.0]]);
    let mut conditions = confined(&[1.0]);
    conditions.faces = vec![
        faces("left", [0.0, 0.0], [0.0, 4.0], OnFaces::Head(1.0)),
        faces("right", [8.0, 0.0], [8.0, 4.0], OnFaces::Head(0.0)),
    ];
    let found = flow(&grid, &[ground], &conditions).unwrap();
    for (x, known) in [
        ([4.0, 1.0], 0.5),
        ([4.5, 0.866], 0.381),
        ([5.0, 0.0], 0.263),
        ([6.0, 0.0], 0.203),
    ] {
        let head = found.head(&x);
        println!("cylinder {x:?}: {head:.4} of {known}");
        assert!((head / known - 1.0).abs() < 0.01);
    }
    assert!((found.inflow / found.outflow - 1.0).abs() < 1e-10);
}

/// GOAL: heads under a dam. ORACLE: published values, within 1 % of the difference of heads.
#[test]
fn heads_under_a_dam() {
    let grid = grid([0.0, -10.0], 0.5, [80, 20]);
    let mut conditions = confined(&[1.0]);
    conditions.faces = vec![
        faces("pond", [0.0, 0.0], [8.0, 0.0], OnFaces::Head(5.0)),
        faces("toe", [20.0, 0.0], [40.0, 0.0], OnFaces::Head(0.0)),
    ];
    let found = flow(&grid, &[rectangle([0.0, -10.0], [40.0, 0.0])], &conditions).unwrap();
    for (x, known) in [
        (0.0, 4.5),
        (10.0, 3.45),
        (14.0, 2.47),
        (20.0, 1.05),
        (30.0, 0.2),
        (40.0, 0.07),
    ] {
        let head = found.head(&[x, -4.0]);
        println!("under a dam x {x}: {head:.3} of {known}");
        assert!((head - known).abs() < 0.01 * 5.0);
    }
}

/// GOAL: a well held at a level, a well that is pumped, a cut-off. ORACLE: flow along a strip; the resistances in a row.
#[test]
fn wells_and_walls() {
    let grid = grid([0.0, 0.0], 0.5, [40, 20]);
    let ground = [rectangle([0.0, 0.0], [20.0, 10.0])];
    let region = |name: &str, left: f64, right: f64, condition| Named {
        name: name.to_owned(),
        within: Extent {
            lower: [left, 0.0],
            upper: [right, 10.0],
        },
        condition,
    };
    let mut conditions = confined(&[1e-4]);
    conditions.faces = vec![faces("left", [0.0, 0.0], [0.0, 10.0], OnFaces::Head(12.0))];
    conditions.regions = vec![region("well", 19.0, 20.0, InGround::Head(10.0))];
    let outflow = flow(&grid, &ground, &conditions).unwrap().outflow;
    assert!((outflow / (1e-4 * 10.0 * 2.0 / 19.0) - 1.0).abs() < 1e-3);

    conditions.regions = vec![region("pump", 19.0, 20.0, InGround::Inflow(-3e-5))];
    let found = flow(&grid, &ground, &conditions).unwrap();
    assert!((found.head(&[19.0, 4.0]) - (12.0 - 3e-5 / 1e-3 * 19.0)).abs() < 1e-6);
    assert!((found.outflow / 3e-5 - 1.0).abs() < 1e-10);

    conditions.soils.push(Soil::isotropic(1e-7));
    conditions.faces.push(faces(
        "right",
        [20.0, 0.0],
        [20.0, 10.0],
        OnFaces::Head(10.0),
    ));
    conditions.regions = vec![region("wall", 8.25, 9.0, InGround::Soil(1))];
    let outflow = flow(&grid, &ground, &conditions).unwrap().outflow;
    let exact = 2.0 * 10.0 / (19.25 / 1e-4 + 0.75 / 1e-7);
    assert!((outflow / exact - 1.0).abs() < 1e-9, "{outflow} of {exact}");
}

/// GOAL: conditions without a flow are refused by name.
#[test]
fn conditions_without_a_flow_are_refused() {
    let grid = grid([0.0, 0.0], 0.5, [4, 4]);
    let ground = [rectangle([0.0, 0.0], [2.0, 2.0])];
    let mut conditions = confined(&[1e-4]);
    let error = flow(&grid, &ground, &conditions).unwrap_err();
    assert!(matches!(error, SeepageError::NoHead), "{error}");
    conditions.faces = vec![faces("pond", [5.0, 0.0], [6.0, 1.0], OnFaces::Head(1.0))];
    let error = flow(&grid, &ground, &conditions).unwrap_err().to_string();
    assert!(error.starts_with("`pond` holds no face"), "{error}");
    conditions.faces = vec![faces("pond", [0.0, 0.0], [0.0, 1.0], OnFaces::Head(1.0))];
    conditions.soils[0].across = -1.0;
    let error = flow(&grid, &ground, &conditions).unwrap_err().to_string();
    assert!(error.contains("is -1, and has to be positive"), "{error}");
    conditions = confined(&[1e-4]);
    conditions.confined = false;
    let error = flow(&grid, &ground, &conditions).unwrap_err();
    assert!(matches!(error, SeepageError::NotFed), "{error}");
}

/// GOAL: free water that stands just at the level of the ground touches it, wherever that lies in its cell.
/// ORACLE: water at rest, one head all over, as with water a tenth of a millimetre higher.
#[test]
fn free_water_at_the_level_of_the_ground_touches_it() {
    let grid = grid([0.0, 0.0], 0.5, [4, 8]);
    let mut conditions = confined(&[1e-4]);
    conditions.confined = false;
    for level in [1.0, 1.15, 1.3, 2.3] {
        let ground = [rectangle([0.0, 0.0], [2.0, level])];
        for above in [0.0, 1e-4] {
            let head = level + above;
            let found = flow_below(&grid, &ground, &conditions, Some(head)).unwrap();
            let off = found.heads.iter().map(|h| (h - head).abs());
            assert!(off.fold(0.0, f64::max) < 1e-6, "{level} {above}");
        }
    }
}

/// GOAL: water at rest says how well its heads balance, though nothing flows. ORACLE: one head all over; round-off.
#[test]
fn water_at_rest_balances() {
    let grid = grid([0.0, 0.0], 0.25, [4, 16]);
    let mut conditions = confined(&[1e-9]);
    conditions.faces = vec![faces("top", [0.0, 4.0], [1.0, 4.0], OnFaces::Head(4.0))];
    let found = flow(&grid, &[rectangle([0.0, 0.0], [1.0, 4.0])], &conditions).unwrap();
    assert!(found.heads.iter().all(|head| (head - 4.0).abs() < 1e-9));
    assert!(found.residual < 1e-9, "{}", found.residual);
    assert!(found.inflow.max(found.outflow) < 1e-15);
}

/// A section across x, from a height to another.
fn upright(at: f64, [from, to]: [f64; 2]) -> (String, Extent<2>) {
    let extent = Extent {
        lower: [at, from],
        upper: [at, to],
    };
    (format!("{at} {from} {to}"), extent)
}

/// GOAL: a section passes the flow through the part of the ground that it crosses, wherever it begins and ends, on lines of the
/// grid, off them and on faces of the ground, also where the ground cuts cells.
/// ORACLE: uniform flow between two heads: k i times the length within the ground.
#[test]
fn parts_of_sections_pass_their_share_of_a_uniform_flow() {
    // In cells that the ground cuts heads are hardly off: by some thousandths of the flow through a cell.
    for ([left, low, length, height], accuracy) in
        [([0.0, 0.0, 8.0, 10.0], 1e-9), ([0.15, 0.2, 7.6, 9.4], 5e-3)]
    {
        let grid = grid([0.0, 0.0], 0.5, [16, 22]);
        let (right, top) = (left + length, low + height);
        let mut conditions = confined(&[1e-5]);
        conditions.faces = vec![
            faces("left", [left, low], [left, top], OnFaces::Head(20.0)),
            faces("right", [right, low], [right, top], OnFaces::Head(12.0)),
        ];
        for at in [left, 0.5, 3.3, 3.5, 7.7, right] {
            for [from, to] in [
                [0.0, 11.0],
                [2.0, 4.0],
                [2.0, 4.1],
                [2.2, 2.3],
                [1.9, 2.1],
                [8.8, 11.0],
            ] {
                conditions.sections.push(upright(at, [from, to]));
            }
        }
        let ground = [rectangle([left, low], [right, top])];
        let found = flow(&grid, &ground, &conditions).unwrap();
        for (section, (_, extent)) in std::iter::zip(&found.sections, &conditions.sections) {
            let within = extent.upper[1].min(top) - extent.lower[1].max(low);
            let rate = 1e-5 * 8.0 / length;
            let off = (section.inflow / rate - within) / 0.5;
            assert!(off.abs() < accuracy, "{}: {off} of a cell", section.name);
            // Across all of the ground, off its faces, it passes all that enters, to the tolerance of the equations.
            let is_within = extent.lower[0] > left + 0.5 && extent.lower[0] < right - 0.5;
            if is_within && extent.lower[1] <= low && extent.upper[1] > top {
                let off = section.inflow / found.discharges[0].inflow - 1.0;
                assert!(off.abs() < 1e-6, "{}: {off} of what enters", section.name);
            }
        }
    }
}

/// GOAL: the flow through a section across all of the ground is the inflow on its one side, and mirrored ground passes the same the
/// other way. CASE: a layer with oblique bedding between two heads, rain on the part from x = 3 m to 8 m; a sink.
/// ORACLE: balance: rain on a side and the inflow of its face; the mirror.
#[test]
fn sections_pass_all_that_enters_on_their_side() {
    let at = [0.0, 1.0, 2.0, 2.2, 3.0, 3.7, 6.0, 8.0];
    let sink = |x: f64| if x > 5.5 { -2e-3 } else { 0.0 };
    let ran = |is_mirrored: bool| {
        let turned = |x: f64| if is_mirrored { 8.0 - x } else { x };
        let boxed = |x: [f64; 2], y: [f64; 2]| {
            let [a, b] = x.map(turned);
            ([a.min(b), y[0]], [a.max(b), y[1]])
        };
        let face = |name, x, y, condition| {
            let (lower, upper) = boxed(x, y);
            faces(name, lower, upper, condition)
        };
        let mut conditions = confined(&[1.0]);
        conditions.soils[0] = Soil {
            across: 0.5,
            angle: if is_mirrored { -0.17 } else { 0.17 },
            ..Soil::isotropic(1e-2)
        };
        conditions.faces = vec![
            face("one", [0.0, 0.0], [0.0, 4.0], OnFaces::Head(5.0)),
            face("other", [8.0, 8.0], [0.0, 4.0], OnFaces::Head(4.5)),
            face("rain", [3.0, 8.0], [4.0, 4.0], OnFaces::Inflow(1e-3)),
        ];
        let (lower, upper) = boxed([5.1, 5.4], [1.2, 1.7]);
        conditions.regions = vec![Named {
            name: "sink".to_owned(),
            within: Extent { lower, upper },
            condition: InGround::Inflow(-2e-3),
        }];
        conditions.sections = at.map(|x| upright(turned(x), [0.0, 4.0])).to_vec();
        let ground = [rectangle([0.0, 0.0], [8.0, 4.0])];
        flow(&grid([0.0, 0.0], 1.0, [8, 5]), &ground, &conditions).unwrap()
    };
    let [plain, mirrored] = [false, true].map(ran);
    let enters = plain.discharges[0].inflow - plain.discharges[0].outflow;
    let pairs = std::iter::zip(&plain.sections, &mirrored.sections);
    for (x, (section, other)) in std::iter::zip(at, pairs) {
        // Within a cell with a sink the place of its points counts.
        let exact = enters + 1e-3 * (x - 3.0).max(0.0) + sink(x);
        assert!((section.inflow - exact).abs() < 1e-9 * plain.inflow);
        assert!((section.inflow + other.inflow).abs() < 1e-9 * plain.inflow);
    }
}

/// GOAL: the discharge of a condition is the flow, and no noise of single places: a slanting layer, ten times as permeable along as
/// across, whose faces cut the grid at any angle. ORACLE: k H Δh / L, which enters at one end and leaves at the other.
#[test]
fn the_discharge_at_an_end_of_a_slanting_layer_is_its_flow() {
    let (length, thick) = (6.0_f64, 1.5);
    for (degrees, cell, [x, y]) in [
        (35.0_f64, 0.25, [0.0, 0.0]),
        (35.0, 0.125, [0.0, 0.0]),
        (35.0, 0.25, [0.06, 0.02]),
        (-35.0, 0.25, [0.13, 0.21]),
        (17.0, 0.25, [0.0, 0.0]),
    ] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let place = |u: f64, v: f64| [3.0 + x + u * cos - v * sin, 4.0 + y + u * sin + v * cos];
        let count = |size: f64| (size / cell) as usize;
        let grid = grid([0.0, 0.0], cell, [count(12.0), count(10.0)]);
        let mut conditions = confined(&[1e-5]);
        conditions.soils[0].across = 1e-6;
        conditions.soils[0].angle = degrees.to_radians();
        let end = |name: &str, u: f64, head: f64| {
            let [a, b] = [place(u, 0.0), place(u, thick)];
            let lower = [0, 1].map(|axis| a[axis].min(b[axis]));
            let upper = [0, 1].map(|axis| a[axis].max(b[axis]));
            faces(name, lower, upper, OnFaces::Head(head))
        };
        conditions.faces = vec![end("in", 0.0, 20.0), end("out", length, 14.0)];
        let layer = [(0.0, 0.0), (length, 0.0), (length, thick), (0.0, thick)];
        let layer = layer.map(|(u, v)| place(u, v)).to_vec();
        let found = flow(&grid, &[layer], &conditions).unwrap();
        let exact = 1e-5 * thick * 6.0 / length;
        let passed: Vec<_> = (found.discharges.iter())
            .map(|discharge| [discharge.inflow / exact, discharge.outflow / exact])
            .collect();
        println!(
            "{degrees} {cell}: {:.4} {passed:.4?}",
            found.outflow / exact
        );
        let [inflow, outflow] = [0, 1].map(|way| passed.iter().map(|flow| flow[way]).sum());
        let is_flow = |share: f64| (share - 1.0).abs() < 5e-4;
        assert!(is_flow(found.outflow / exact), "{degrees} {cell}");
        assert!(is_flow(passed[0][0]) && is_flow(passed[1][1]), "{passed:?}");
        assert!(is_flow(inflow) && is_flow(outflow), "{passed:?}");
    }
}

/// GOAL: full pores with faces where water comes out, and with rain, whose excess runs off; faces on lines of the grid and off
/// them. ORACLE: Darcy's law for a column: k (7 − 4)/4 comes out; rain of k/4 enters whole, and its head at the top is 2; of 2 k enters
/// k (4 − 1)/4. No water comes out where the head is below the face.
#[test]
fn full_pores_have_open_faces_and_rain() {
    let (permeability, height) = (1e-5, 4.0);
    for shift in [0.0, 0.3] {
        for (top, below, passes, head) in [
            (OnFaces::Open, 7.0, -0.75, 4.0),
            (OnFaces::Open, 3.0, 0.0, 3.0),
            (OnFaces::Recharge(0.25 * permeability), 1.0, 0.25, 2.0),
            (OnFaces::Recharge(2.0 * permeability), 1.0, 0.75, 4.0),
        ] {
            let grid = grid([0.0, -shift * 0.25], 0.25, [4, 17]);
            let mut conditions = confined(&[permeability]);
            conditions.faces = vec![
                faces("top", [0.0, height], [1.0, height], top),
                faces("base", [0.0, 0.0], [1.0, 0.0], OnFaces::Head(below)),
            ];
            let ground = [rectangle([0.0, 0.0], [1.0, height])];
            let found = flow(&grid, &ground, &conditions).unwrap();
            let discharge = &found.discharges[0];
            let entered = (discharge.inflow - discharge.outflow) / permeability;
            println!("{top:?}, head {below}, shift {shift}: {entered} of {passes}");
            assert!((entered - passes).abs() < 1e-8, "{entered} of {passes}");
            assert!((found.head(&[0.4, height]) - head).abs() < 1e-8);
        }
    }
}

/// GOAL: full pores with a slope where water comes out at a part, between heads on both sides: a flow once refused as without solution.
/// ORACLE: the balance; none enters at the open face, and the head there is nowhere above it.
#[test]
fn full_pores_drain_to_an_open_slope() {
    let grid = grid([0.0, 0.0], 0.5, [24, 16]);
    let mut conditions = confined(&[1e-5]);
    conditions.faces = vec![
        faces("right", [12.0, 0.0], [12.0, 8.0], OnFaces::Head(5.0)),
        faces("left", [0.0, 0.0], [0.0, 8.0], OnFaces::Head(5.5)),
        faces("slope", [4.5, 3.9], [12.0, 8.0], OnFaces::Open),
    ];
    let ground = [
        [0.0, 0.0],
        [12.0, 0.0],
        [12.0, 4.0],
        [8.0, 4.0],
        [4.0, 6.0],
        [0.0, 6.0],
    ];
    let found = flow(&grid, &[ground.to_vec()], &conditions).unwrap();
    println!("{:?}", found.discharges);
    assert!((found.inflow / found.outflow - 1.0).abs() < 1e-9);
    let slope = &found.discharges[2];
    assert!(slope.outflow > 0.0 && slope.inflow < 1e-6 * slope.outflow);
    for x in [8.5, 9.5, 11.0] {
        let head = found.head(&[x, 4.0]);
        assert!((head - 4.0).abs() < 0.05, "{x}: {head}");
    }
}
