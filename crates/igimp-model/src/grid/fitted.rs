//! Places of grid lines that bodies ask for.
//!
//! Level edges of soil and of rigid bodies lie on lines, upright sides of rigid bodies in the middle of a
//! cell (theory, eq. 37c). Edges of soil that lie on lines of equal cells stay there.

use super::AxisSpec;
use crate::RigidShape;

/// Soil closer to the side of a rigid body than this ends at that side \[cells\].
const AT_SIDE: f64 = 0.6;
/// Places closer to a line than this lie on it \[cells\].
const ON_LINE: f64 = 1e-6;

/// Outlines that lines are fitted to.
#[derive(Clone, Copy, Debug)]
pub struct Outlines<'a, const D: usize> {
    /// Polygons of the bodies of soil \[m\].
    pub soil: &'a [&'a [[f64; D]]],
    /// Rigid bodies; none where lines are not fitted to them.
    pub rigid: &'a [RigidShape],
    /// Whether lines are fitted to the level edges of soil.
    pub layers: bool,
    /// Lengths below this are round-off \[m\].
    pub round_off: f64,
}

/// Places that outlines ask lines for.
#[derive(Clone, Debug, Default)]
pub struct Asked {
    /// Places of lines, the most important first \[m\].
    pub on_lines: Vec<f64>,
    /// Places in the middle of cells, ascending, by rigid body \[m\].
    pub mid_cell: Vec<Vec<f64>>,
}

/// An edge along an axis.
#[derive(Clone, Copy)]
struct Edge {
    /// Its place across the axis \[m\].
    place: f64,
    /// Its length \[m\].
    length: f64,
    /// The level of its lower end \[m\].
    lowest: f64,
}

impl<const D: usize> Outlines<'_, D> {
    /// The demands on the upright lines of a grid whose cells are equal without them.
    pub fn upright(&self, equal: &AxisSpec) -> Asked {
        let top = self.top();
        let sides = |shape: &RigidShape| {
            let mut sides: Vec<f64> = (self.edges(0, shape).iter())
                .filter(|side| side.lowest <= top + self.round_off)
                .map(|side| side.place)
                .collect();
            sides.sort_by(f64::total_cmp);
            sides
        };
        let mid_cell: Vec<Vec<f64>> = self.rigid.iter().map(sides).collect();
        if mid_cell.iter().all(Vec::is_empty) {
            return Asked::default();
        }
        let mut on_lines = self.kept(0, equal);
        on_lines.retain(|x| {
            let mut sides = mid_cell.iter().flatten();
            sides.all(|side| (x - side).abs() > AT_SIDE * equal.cell_at(*x))
        });
        Asked { on_lines, mid_cell }
    }

    /// The same of the level lines.
    pub fn level(&self, equal: &AxisSpec) -> Asked {
        let top = self.top();
        let rigid = self.rigid.iter().flat_map(|shape| self.edges(1, shape));
        let mut on_lines: Vec<f64> = (rigid.map(|edge| edge.place))
            .filter(|level| *level <= top + self.round_off)
            .collect();
        if self.layers {
            on_lines.extend(self.of_soil(1).iter().map(|edge| edge.place));
        } else if !on_lines.is_empty() {
            on_lines.extend(self.kept(1, equal));
        }
        Asked {
            on_lines,
            mid_cell: Vec::new(),
        }
    }

    /// The highest place of soil \[m\].
    fn top(&self) -> f64 {
        let corners = self.soil.iter().copied().flatten();
        corners.map(|p| p[1]).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Edges of soil that lie on lines of equal cells, the longest first.
    fn kept(&self, across: usize, equal: &AxisSpec) -> Vec<f64> {
        let places = self.of_soil(across).into_iter().map(|edge| edge.place);
        let is_on_line = |x: &f64| {
            let line = equal.place(*x);
            (line - line.round()).abs() <= ON_LINE
        };
        places.filter(is_on_line).collect()
    }

    /// Edges of soil, those at one place together, the longest first.
    fn of_soil(&self, across: usize) -> Vec<Edge> {
        let mut all: Vec<Edge> = Vec::new();
        for edge in self.soil.iter().flat_map(|part| self.of(across, part)) {
            let mut known = all.iter_mut();
            match known.find(|other| (other.place - edge.place).abs() <= self.round_off) {
                Some(other) => other.length += edge.length,
                None => all.push(edge),
            }
        }
        let ahead =
            |a: &Edge, b: &Edge| (b.length.total_cmp(&a.length)).then(a.place.total_cmp(&b.place));
        all.sort_by(ahead);
        all
    }

    /// Edges of a rigid body; of a circle the places where it ends.
    fn edges(&self, across: usize, shape: &RigidShape) -> Vec<Edge> {
        match shape {
            RigidShape::Polygon(corners) => self.of(across, corners).collect(),
            RigidShape::Circle { centre, radius } => [-radius, *radius]
                .map(|way| Edge {
                    place: centre[across] + way,
                    length: 0.0,
                    lowest: centre[1] - radius,
                })
                .to_vec(),
        }
    }

    /// Edges of a polygon at one place across an axis.
    fn of<'a, const N: usize>(
        &self,
        across: usize,
        corners: &'a [[f64; N]],
    ) -> impl Iterator<Item = Edge> + 'a {
        let round_off = self.round_off;
        let next = corners.iter().cycle().skip(1);
        std::iter::zip(corners, next)
            .filter(move |(p, q)| (p[across] - q[across]).abs() <= round_off)
            .map(move |(p, q)| Edge {
                place: p[across],
                length: (p[1 - across] - q[1 - across]).abs(),
                lowest: p[1].min(q[1]),
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOIL: [[f64; 2]; 4] = [[0.0, 0.0], [7.0, 0.0], [7.0, 3.0], [0.0, 3.0]];

    fn rectangle(from: [f64; 2], to: [f64; 2]) -> RigidShape {
        RigidShape::Polygon(vec![from, [to[0], from[1]], to, [from[0], to[1]]])
    }

    fn asked(rigid: &[RigidShape]) -> [Asked; 2] {
        let outlines = Outlines {
            soil: &[&SOIL],
            rigid,
            layers: false,
            round_off: 1e-9,
        };
        let axis = |cells| AxisSpec::Equal {
            lower: 0.0,
            cell: 0.5,
            cells,
        };
        [outlines.upright(&axis(14)), outlines.level(&axis(8))]
    }

    #[test]
    fn a_strip_asks_for_its_sides_and_its_base() {
        let [upright, level] = asked(&[rectangle([2.2, 2.1], [4.2, 5.0])]);
        assert_eq!(upright.mid_cell, [[2.2, 4.2]]);
        // The sides of the ground, and no line at the lid, which is above the ground.
        assert_eq!(upright.on_lines, [0.0, 7.0]);
        assert_eq!(level.on_lines, [2.1, 0.0, 3.0]);
    }

    #[test]
    fn soil_that_ends_at_a_side_asks_for_no_line_there() {
        let [upright, _] = asked(&[rectangle([-1.0, 0.0], [0.0, 4.0])]);
        assert_eq!(upright.mid_cell, [[-1.0, 0.0]]);
        assert_eq!(upright.on_lines, [7.0]);
    }

    #[test]
    fn bodies_above_the_ground_ask_for_nothing() {
        let circle = RigidShape::Circle {
            centre: [3.0, 3.6],
            radius: 0.5,
        };
        let [upright, level] = asked(&[circle]);
        assert!(upright.mid_cell.is_empty() && upright.on_lines.is_empty());
        assert_eq!(level.on_lines, [0.0; 0]);
    }
}
