#![allow(clippy::float_cmp, reason = "places are whole numbers")]

use super::*;

type Corners = (Vec<[f64; 3]>, Vec<[f64; 3]>);

/// A block of n[0] × n[1] × n[2] boxes of width 1, without those that are left out.
fn block(n: [usize; 3], is_left_out: impl Fn([usize; 3]) -> bool) -> Corners {
    let places = (0..n[0] * n[1] * n[2])
        .map(|k| [k % n[0], k / n[0] % n[1], k / (n[0] * n[1])])
        .filter(|&place| !is_left_out(place));
    places
        .map(|place| {
            let low = place.map(|i| i as f64);
            (low, low.map(|x| x + 1.0))
        })
        .unzip()
}

fn skin((low, high): &Corners) -> Skin {
    Skin::of(Boxes { low, high }, &[])
}

#[test]
fn a_cube_shows_its_six_sides() {
    for n in [1, 2, 3, 8, 13] {
        let cube = block([n; 3], |_| false);
        assert_eq!(skin(&cube).count(), 6 * n * n, "{n}");
    }
    assert_eq!(skin(&(Vec::new(), Vec::new())).count(), 0);
}

#[test]
fn cubes_that_touch_are_one_body() {
    let mut two = block([3; 3], |_| false);
    let (low, high) = block([3; 3], |_| false);
    let moved = |corners: Vec<[f64; 3]>| corners.into_iter().map(|[x, y, z]| [x + 3.0, y, z]);
    two.0.extend(moved(low.clone()));
    two.1.extend(moved(high.clone()));
    assert_eq!(skin(&two).count(), 2 * 54 - 2 * 9);
    // Half a width apart they are two.
    for corners in [&mut two.0, &mut two.1] {
        corners[27..].iter_mut().for_each(|x| x[0] += 0.5);
    }
    assert_eq!(skin(&two).count(), 2 * 54);
}

#[test]
fn a_hole_inside_has_a_surface() {
    let hollow = block([5; 3], |place| place == [2, 2, 2]);
    assert_eq!(skin(&hollow).count(), 6 * 25 + 6);
}

#[test]
fn boxes_of_many_sizes_cover_each_other() {
    // Fine boxes on a coarse one, which they cover whole, and one box around everything else's scale.
    let (mut low, mut high): Corners = block([4, 4, 4], |_| false);
    low.push([0.0, 0.0, -4.0]);
    high.push([4.0, 4.0, 0.0]);
    let found = skin(&(low, high));
    assert_eq!(found.faces[64], 0b01_1111);
    assert_eq!(found.count(), 5 * 16 + 5);
}

/// GOAL: stretched and sheared bodies have the skin that they had, though boxes overlap and gape.
#[test]
fn deformation_opens_no_holes() {
    let n = 10;
    let (low, high) = block([n; 3], |_| false);
    let centre = |k: usize| [0, 1, 2].map(|axis| 0.5 * (low[k][axis] + high[k][axis]));
    for shear in [0.0, 0.02, -0.05, 0.08] {
        let deformed: Corners = (0..low.len())
            .map(|k| {
                let [x, y, z] = centre(k);
                // Wider by 3 %, with half-lengths that know of 1 % alone: gaps of 2 %, and slanted columns.
                let at = [1.03 * x + shear * z, 0.96 * y, z + 0.5 * shear * x];
                let half = [0.505, 0.49, 0.5];
                (
                    [0, 1, 2].map(|axis| at[axis] - half[axis]),
                    [0, 1, 2].map(|axis| at[axis] + half[axis]),
                )
            })
            .unzip();
        let found = skin(&deformed);
        let inside = |k: usize| (0..3).all(|axis| (1.0..9.0).contains(&centre(k)[axis]));
        for k in (0..low.len()).filter(|&k| inside(k)) {
            assert_eq!(found.faces[k], 0, "{shear}: {:?}", centre(k));
        }
        for k in 0..low.len() {
            for (axis, x) in centre(k).into_iter().enumerate() {
                if x < 1.0 {
                    assert_ne!(found.faces[k] & (1 << (2 * axis)), 0, "{shear}");
                }
                if x > 9.0 {
                    assert_ne!(found.faces[k] & (2 << (2 * axis)), 0, "{shear}");
                }
            }
        }
    }
}

#[test]
fn a_step_between_columns_is_seen() {
    // A column that has sunk by a third of a box: the upper third of the wall beside it shows.
    let (mut low, mut high) = block([4, 1, 4], |_| false);
    for k in 0..low.len() {
        if low[k][0] > 1.5 {
            low[k][2] -= 0.33;
            high[k][2] -= 0.33;
        }
    }
    let top = low.iter().position(|&x| x == [1.0, 0.0, 3.0]).unwrap();
    assert_ne!(skin(&(low, high)).faces[top] & 0b10, 0);
}

#[test]
fn the_surface_points_outwards_and_knows_hollows() {
    let found = skin(&block([9, 9, 9], |[x, _, z]| x > 4 && z > 4));
    let (low, _) = block([9, 9, 9], |[x, _, z]| x > 4 && z > 4);
    let at = |place: [f64; 3]| found.lie[low.iter().position(|&x| x == place).unwrap()];
    let level = at([2.0, 4.0, 8.0]);
    assert!(
        level.normal[2] > 0.85 && (0.3..0.6).contains(&level.open),
        "{level:?}"
    );
    // The foot of the upper part is a hollow, its edge is none.
    assert!(at([5.0, 4.0, 4.0]).open < level.open);
    assert!(at([4.0, 4.0, 8.0]).open > level.open);
}

#[test]
fn boxes_without_place_are_not_seen_and_harm_nothing() {
    let (mut low, mut high) = block([3; 3], |_| false);
    low.extend([[f64::NAN; 3], [1e9; 3]]);
    high.extend([[f64::NAN; 3], [1e9 + 1.0; 3]]);
    let found = skin(&(low, high));
    assert_eq!(found.faces[27], 0);
    assert_eq!(found.count(), 54 + 6);
}

/// The corners of the faces of a skin.
fn corners_seen((low, high): &Corners, edges: &[Vec<[f64; 3]>]) -> Vec<[f64; 3]> {
    let boxes = Boxes { low, high };
    let found = Skin::of(boxes, edges);
    let seen = (0..low.len()).flat_map(|k| (0..6).map(move |face| (k, face)));
    seen.filter(|&(k, face)| found.faces[k] & (1 << face) != 0)
        .flat_map(|(k, face)| found.corners(boxes, k, face))
        .collect()
}

/// GOAL: a slope of boxes has no stairs, and a block keeps its sides and edges. ORACLE: the plane that boxes were left out above.
#[test]
fn slopes_have_no_stairs() {
    for run in [1, 2, 3] {
        let n = [24, 8, 24 / run];
        let top = |x: f64| (24.0 - x) / run as f64;
        let slope = block(n, |[x, _, z]| z as f64 + 0.5 > top(x as f64 + 0.5));
        let seen = corners_seen(&slope, &[]);
        let inside = |at: &&[f64; 3]| {
            (4.0..20.0).contains(&at[0]) && (0.5..7.5).contains(&at[1]) && at[2] > 1.5
        };
        let off = |at: &[f64; 3]| (at[2] - top(at[0])).abs();
        let most = seen.iter().filter(inside).map(off).filter(|&off| off < 1.0);
        let most = most.fold(0.0, f64::max);
        // Stairs leave their plane by half a box and more; those of 1:1 lie a quarter of a box to either side of theirs.
        assert!(most < [0.56, 0.4, 0.4][run - 1], "1:{run}: {most}");
        // The sides stay where they are, and meet in edges.
        let ends = seen.iter().fold([f64::MAX, f64::MIN], |[a, b], at| {
            [a.min(at[1]), b.max(at[1])]
        });
        assert_eq!(ends, [0.0, 8.0]);
    }
    let cube = block([6; 3], |_| false);
    for corner in corners_seen(&cube, &[]) {
        assert_eq!(corner, corner.map(f64::round));
    }
}

/// GOAL: an edge that is drawn is an edge of the skin. ORACLE: the crest of a vertical cut, with and without it.
#[test]
fn edges_stay_sharp() {
    let cut = block([12, 6, 8], |[x, _, z]| x > 5 && z > 3);
    let crest = vec![[6.0, 0.0, 8.0], [6.0, 3.0, 8.0], [6.0, 6.0, 8.0]];
    let near = |edges: &[Vec<[f64; 3]>]| {
        let seen = corners_seen(&cut, edges).into_iter();
        seen.map(|at| (at[0] - 6.0).abs().max((at[2] - 8.0).abs()))
            .fold(f64::MAX, f64::min)
    };
    assert_eq!(near(&[crest]), 0.0);
    assert!(near(&[]) > 0.2);
}
