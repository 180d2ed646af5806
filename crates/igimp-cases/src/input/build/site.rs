//! The bodies on the grid, for the checks that look at them.

use super::grid::Frame;
use crate::case::BodyPart;
use crate::input::geometry::{contains, near_edge, top_edges};
use crate::polygon::bounding_box;

/// Bodies and grid as far as they were found right.
pub(super) struct Site {
    /// Extent and cells.
    pub(super) frame: Option<Frame>,
    /// Polygons of the bodies.
    pub(super) polygons: Vec<Vec<[f64; 2]>>,
    /// Whether all bodies are there.
    pub(super) is_complete: bool,
    /// Lengths below this are round-off \[m\].
    pub(super) round_off: f64,
    /// Boxes around the polygons.
    boxes: Vec<([f64; 2], [f64; 2])>,
    surface: Vec<[[f64; 2]; 2]>,
}

impl Site {
    pub(super) fn new(frame: Option<Frame>, bodies: &[Option<BodyPart>]) -> Self {
        let polygons: Vec<_> = bodies
            .iter()
            .flatten()
            .map(|body| body.polygon.clone())
            .collect();
        let largest = polygons
            .iter()
            .flatten()
            .flatten()
            .copied()
            .chain(
                frame
                    .iter()
                    .flat_map(|frame| frame.lower.into_iter().chain(frame.upper)),
            )
            .fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let mut site = Self {
            frame,
            is_complete: polygons.len() == bodies.len() && !bodies.is_empty(),
            boxes: polygons
                .iter()
                .map(|polygon| bounding_box(polygon))
                .collect(),
            polygons,
            round_off: 1e-9 * largest,
            surface: Vec::new(),
        };
        site.surface = site.uncovered();
        site
    }

    /// Smallest side of a cell \[m\].
    pub(super) fn cell(&self) -> f64 {
        self.frame.as_ref().map_or(self.round_off, |frame| {
            let [x, y] = frame.axes.each_ref().map(|axis| axis.extremes()[0]);
            x.min(y)
        })
    }

    /// Polygons whose box comes within a margin of a point.
    fn near(&self, point: [f64; 2], margin: f64) -> impl Iterator<Item = &Vec<[f64; 2]>> {
        let boxed = self.boxes.iter().zip(&self.polygons);
        boxed
            .filter(move |((lower, upper), _)| {
                (0..2).all(|k| lower[k] - margin <= point[k] && point[k] <= upper[k] + margin)
            })
            .map(|(_, polygon)| polygon)
    }

    /// Whether a point lies within a body, well inside.
    pub(super) fn is_inside(&self, point: [f64; 2]) -> bool {
        self.near(point, 0.0)
            .any(|polygon| contains(polygon, point))
    }

    /// Whether a point lies in a body or nearly on its edge.
    pub(super) fn holds(&self, point: [f64; 2], margin: f64) -> bool {
        let margin = margin.max(self.round_off);
        self.near(point, margin)
            .any(|polygon| contains(polygon, point) || near_edge(polygon, point, margin))
    }

    /// Edges with soil below and none above: left end, right end. Edges that another body covers
    /// are left out.
    pub(super) fn surface(&self) -> &[[[f64; 2]; 2]] {
        &self.surface
    }

    fn uncovered(&self) -> Vec<[[f64; 2]; 2]> {
        let lift = 1e-3 * self.cell();
        let mut edges = Vec::new();
        for edge in self.polygons.iter().flat_map(|polygon| top_edges(polygon)) {
            let [from, to] = edge;
            let is_covered = (0..5).all(|k| {
                let t = (f64::from(k) + 0.5) / 5.0;
                let x = from[0] + t * (to[0] - from[0]);
                let y = from[1] + t * (to[1] - from[1]);
                self.is_inside([x, y + lift])
            });
            if !is_covered {
                edges.push(edge);
            }
        }
        edges
    }
}
