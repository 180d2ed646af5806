//! GOAL: outlines in space go with the soil, and with it away.
//! ORACLE: an affine motion carries every corner to its own place.

use igimp_input::CaseFile;
use igimp_model::AnyCase;

use super::*;

/// Two boxes beside each other, cut by cells of two thirds of a metre.
const TWO: &str = "igimp = 1\n[case]\ntitle = \"two\"\nanalysis = \"3d\"\ngravity = \"9.81 m/s2\"\n\
    [grid]\ncell = \"0.6 m\"\n\
    domain = { x = [\"0 m\", \"6 m\"], y = [\"0 m\", \"3 m\"], z = [\"0 m\", \"3 m\"] }\n\
    [materials.clay]\nmodel = \"elastic\"\nunit_weight = \"18 kN/m3\"\nyoung = \"10 MPa\"\npoisson = 0.0\n\
    [[bodies]]\nname = \"one\"\nmaterial = \"clay\"\npoints_per_cell = 8\n\
    box = { from = [\"0 m\", \"0 m\", \"0 m\"], to = [\"2 m\", \"2 m\", \"2 m\"] }\n\
    [[bodies]]\nname = \"other\"\nmaterial = \"clay\"\npoints_per_cell = 8\n\
    box = { from = [\"2 m\", \"0 m\", \"0 m\"], to = [\"5 m\", \"2 m\", \"1 m\"] }\n\
    [[stages]]\nname = \"weight\"\ntype = \"gravity\"\n";

/// The gradient of a motion, and where it takes the origin.
const A: [Point; 3] = [[1.1, 0.2, 0.0], [-0.1, 0.9, 0.3], [0.0, 0.1, 1.2]];
const B: Point = [3.0, -1.0, 0.5];

fn moved(at: Point) -> Point {
    std::array::from_fn(|k| B[k] + (0..3).map(|j| A[k][j] * at[j]).sum::<f64>())
}

fn case() -> CaseFile {
    CaseFile::parse("two.toml", TWO, &[]).unwrap()
}

/// The particles of some bodies of the case after the motion.
fn particles(case: &Case<3>, there: &[usize]) -> FrameParticles<3> {
    let grid = case.grid.grid().unwrap();
    let mut all = FrameParticles {
        x: Vec::new(),
        def_grad: Vec::new(),
        number: Vec::new(),
    };
    let mut first = 0;
    for (number, body) in case.bodies.iter().enumerate() {
        let seeds = fill(&grid, &*body.region, body.per_direction, 1.0, 0).unwrap();
        if there.contains(&number) {
            all.x.extend(seeds.iter().map(|seed| moved(seed.x)));
            all.def_grad.extend(seeds.iter().map(|_| A));
            all.number.extend(first..first + seeds.len());
        }
        first += seeds.len();
    }
    all
}

/// The length of a moved edge of a box, by axis.
fn lengths(sides: Point) -> f64 {
    let one = |axis: usize| {
        let mut unit = [0.0; 3];
        unit[axis] = sides[axis];
        distance(moved(unit), moved([0.0; 3]))
    };
    4.0 * (one(0) + one(1) + one(2))
}

fn length(lines: &[Vec<Point>]) -> f64 {
    let ends = lines.iter().flat_map(|line| line.windows(2));
    ends.map(|ends| distance(ends[0], ends[1])).sum()
}

#[test]
fn outlines_go_with_the_soil() {
    let file = case();
    let AnyCase::Space(case) = file.any_case() else {
        panic!("a case in space");
    };
    let outlines = Outlines::of(case).unwrap();
    let both = length(&outlines.now(&particles(case, &[0, 1])));
    let wanted = lengths([2.0; 3]) + lengths([3.0, 2.0, 1.0]);
    assert!((both - wanted).abs() < 1e-9 * wanted, "{both} for {wanted}");
    // Of a body that is not there nothing is drawn.
    let one = outlines.now(&particles(case, &[1]));
    let wanted = lengths([3.0, 2.0, 1.0]);
    assert!((length(&one) - wanted).abs() < 1e-9 * wanted);
    let corner = moved([5.0, 2.0, 1.0]);
    let mut points = one.iter().flatten();
    assert!(points.any(|&at| distance(at, corner) < 1e-9));
}

/// GOAL: where soil parts, lines end instead of going across.
#[test]
fn lines_end_where_soil_parts() {
    let file = case();
    let AnyCase::Space(case) = file.any_case() else {
        panic!("a case in space");
    };
    let outlines = Outlines::of(case).unwrap();
    let whole = particles(case, &[0, 1]);
    let mut parted = whole.clone();
    for at in &mut parted.x {
        // Soil right of x = 3.2 m is moved on by 5 m; the motion takes it to x' > 6.4 m or so.
        if at[0] > 6.6 {
            at[0] += 5.0;
        }
    }
    let longest = |lines: &[Vec<Point>]| {
        let ends = lines.iter().flat_map(|line| line.windows(2));
        ends.map(|ends| distance(ends[0], ends[1]))
            .fold(0.0, f64::max)
    };
    let (before, after) = (outlines.now(&whole), outlines.now(&parted));
    assert!(longest(&before) < 0.5 && longest(&after) < 1.5);
    assert!(after.len() > before.len());
}
