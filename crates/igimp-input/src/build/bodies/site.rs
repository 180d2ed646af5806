//! The bodies on the grid, for the checks that look at them.

use std::sync::Arc;

use igimp_geometry::polygon::{bounding_box, contains};
use igimp_geometry::region::Region;
use igimp_model::{BodyPart, LoadKind};

use crate::build::bodies::sequence::Sequence;
use crate::build::grid::Frame;
use igimp_geometry::outline::{near_edge, top_edges};

/// Bodies and grid as far as they were found right.
pub(crate) struct Site {
    /// Extent and cells.
    pub(crate) frame: Option<Frame<2>>,
    /// Polygons of the bodies.
    pub(crate) polygons: Vec<Vec<[f64; 2]>>,
    /// Whether all bodies are there.
    pub(crate) is_complete: bool,
    /// Lengths below this are round-off \[m\].
    pub(crate) round_off: f64,
    /// Boxes around the polygons.
    boxes: Vec<([f64; 2], [f64; 2])>,
    /// Which bodies are there at the same time, at one time or another.
    scenes: Vec<Vec<bool>>,
    surface: Vec<[[f64; 2]; 2]>,
}

/// The soil as checks of places see it.
pub(crate) trait Soil<const D: usize> {
    /// Whether all bodies are known.
    fn is_known(&self) -> bool;

    /// Whether a point lies in a body or nearly on its edge.
    fn holds_point(&self, point: &[f64; D], margin: f64) -> bool;

    /// Whether a point lies in one of the bodies that are there, or no further off it than a margin.
    fn is_held_by(&self, present: &[bool], point: &[f64; D], margin: f64) -> bool;

    /// Whether a body lies along a load: near its edge, or around it.
    fn bears(&self, body: usize, load: &LoadKind<D>) -> bool;

    /// Lengths below this are round-off \[m\].
    fn round_off(&self) -> f64;

    /// Smallest side of a cell \[m\].
    fn cell(&self) -> f64;

    /// Lower and upper ends of the grid \[m\]; none where it was found wrong.
    fn ends(&self) -> Option<[[f64; D]; 2]>;

    /// Whether a place on an axis lies between the lines of the grid; it does not where that was found wrong.
    fn is_off_lines(&self, axis: usize, at: f64) -> bool;
}

impl Soil<2> for Site {
    fn is_known(&self) -> bool {
        self.is_complete
    }

    fn holds_point(&self, point: &[f64; 2], margin: f64) -> bool {
        self.holds(*point, margin)
    }

    fn is_held_by(&self, present: &[bool], point: &[f64; 2], margin: f64) -> bool {
        self.near(*point, margin).any(|(body, polygon)| {
            present[body] && (contains(polygon, *point) || near_edge(polygon, *point, margin))
        })
    }

    fn bears(&self, body: usize, load: &LoadKind<2>) -> bool {
        let [from, to] = match *load {
            LoadKind::RigidFooting { from, to, .. } | LoadKind::Pressure { from, to, .. } => {
                [from, to]
            }
            LoadKind::Patch { .. } => return false,
            LoadKind::Point { at, .. } => [at; 2],
        };
        let margin = (1e-2 * self.cell()).max(self.round_off);
        let Some(polygon) = self.polygons.get(body).filter(|_| self.is_complete) else {
            return false;
        };
        (0..5).any(|k| {
            let t = (f64::from(k) + 0.5) / 5.0;
            let at = [0, 1].map(|axis| from[axis] + t * (to[axis] - from[axis]));
            contains(polygon, at) || near_edge(polygon, at, margin)
        })
    }

    fn round_off(&self) -> f64 {
        self.round_off
    }

    fn cell(&self) -> f64 {
        self.cell()
    }

    fn ends(&self) -> Option<[[f64; 2]; 2]> {
        let frame = self.frame.as_ref()?;
        Some([frame.lower, frame.upper])
    }

    fn is_off_lines(&self, axis: usize, at: f64) -> bool {
        (self.frame.as_ref()).is_some_and(|frame| frame.is_off_lines(axis, at))
    }
}

impl Site {
    pub(crate) fn new(
        frame: Option<Frame<2>>,
        bodies: &[Option<BodyPart<2>>],
        sequence: &Sequence,
    ) -> Self {
        let polygons: Vec<_> = bodies
            .iter()
            .flatten()
            .map(|body| body.polygon().to_vec())
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
            scenes: Vec::new(),
            surface: Vec::new(),
        };
        for scene in sequence.scenes() {
            if site.is_complete && !site.scenes.contains(&scene.present) {
                site.scenes.push(scene.present.clone());
            }
        }
        site.surface = site.uncovered();
        site
    }

    /// Smallest side of a cell \[m\].
    pub(crate) fn cell(&self) -> f64 {
        self.frame.as_ref().map_or(self.round_off, |frame| {
            let [x, y] = frame.axes.each_ref().map(|axis| axis.extremes()[0]);
            x.min(y)
        })
    }

    /// Polygons whose box comes within a margin of a point, by number.
    fn near(&self, point: [f64; 2], margin: f64) -> impl Iterator<Item = (usize, &Vec<[f64; 2]>)> {
        let boxed = self.boxes.iter().zip(&self.polygons).enumerate();
        boxed
            .filter(move |(_, ((lower, upper), _))| {
                (0..2).all(|k| lower[k] - margin <= point[k] && point[k] <= upper[k] + margin)
            })
            .map(|(number, (_, polygon))| (number, polygon))
    }

    /// The site as the first stage begins.
    pub(crate) fn at_start(&self) -> Self {
        let first = self.scenes.first().cloned();
        let mut start = Self {
            frame: self.frame.clone(),
            scenes: first.into_iter().collect(),
            polygons: self.polygons.clone(),
            boxes: self.boxes.clone(),
            surface: Vec::new(),
            ..*self
        };
        start.surface = start.uncovered();
        start
    }

    /// Whether a point lies within a body, well inside; one of those that are there, if they are stated.
    pub(crate) fn is_inside(&self, present: Option<&[bool]>, point: [f64; 2]) -> bool {
        self.near(point, 0.0).any(|(body, polygon)| {
            present.is_none_or(|present| present[body]) && contains(polygon, point)
        })
    }

    /// Whether a point lies outside all bodies at some time when a body is there.
    fn is_bare(&self, body: usize, point: [f64; 2]) -> bool {
        let others: Vec<usize> = (self.near(point, 0.0))
            .filter(|(_, polygon)| contains(polygon, point))
            .map(|(number, _)| number)
            .collect();
        let mut scenes = self.scenes.iter().filter(|scene| scene[body]);
        others.is_empty() || scenes.any(|scene| others.iter().all(|&other| !scene[other]))
    }

    /// Whether a point lies in a body or nearly on its edge.
    pub(crate) fn holds(&self, point: [f64; 2], margin: f64) -> bool {
        let margin = margin.max(self.round_off);
        self.near(point, margin)
            .any(|(_, polygon)| contains(polygon, point) || near_edge(polygon, point, margin))
    }

    /// Edges with soil below and none above: left end, right end. Edges that another body covers
    /// are left out, unless it is gone at some time.
    pub(crate) fn surface(&self) -> &[[[f64; 2]; 2]] {
        &self.surface
    }

    fn uncovered(&self) -> Vec<[[f64; 2]; 2]> {
        let lift = 1e-3 * self.cell();
        let mut edges = Vec::new();
        let is_there =
            |body: usize| self.scenes.is_empty() || self.scenes.iter().any(|scene| scene[body]);
        let bodies = self.polygons.iter().enumerate();
        let tops = bodies.filter(|(body, _)| is_there(*body));
        let tops = tops.flat_map(|(body, polygon)| {
            top_edges(polygon).into_iter().map(move |edge| (body, edge))
        });
        for (body, edge) in tops {
            let [from, to] = edge;
            let is_covered = (0..5).all(|k| {
                let t = (f64::from(k) + 0.5) / 5.0;
                let x = from[0] + t * (to[0] - from[0]);
                let y = from[1] + t * (to[1] - from[1]);
                !self.is_bare(body, [x, y + lift])
            });
            if !is_covered {
                edges.push(edge);
            }
        }
        edges
    }
}

/// The bodies, for the checks of places.
pub(crate) struct Solids {
    pub(crate) regions: Vec<Arc<dyn Region<3>>>,
    pub(crate) is_complete: bool,
    pub(crate) round_off: f64,
    /// Smallest side of a cell \[m\].
    pub(crate) cell: f64,
    /// Extent of the grid \[m\].
    pub(crate) lower: [f64; 3],
    pub(crate) upper: [f64; 3],
    /// The grid, as far as it was found right.
    pub(crate) frame: Option<Frame<3>>,
}

impl Solids {
    pub(crate) fn new(bodies: &[Option<BodyPart<3>>], frame: Option<&Frame<3>>) -> Self {
        let regions: Vec<_> = bodies
            .iter()
            .flatten()
            .map(|body| Arc::clone(&body.region))
            .collect();
        let ends = frame
            .iter()
            .flat_map(|frame| frame.lower.iter().chain(&frame.upper));
        let largest = ends.fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let round_off = 1e-9 * largest;
        let cells = frame.iter().flat_map(|frame| frame.axes.iter());
        Self {
            is_complete: frame.is_some() && regions.len() == bodies.len() && !bodies.is_empty(),
            regions,
            round_off,
            lower: frame.map_or([0.0; 3], |frame| frame.lower),
            upper: frame.map_or([0.0; 3], |frame| frame.upper),
            frame: frame.cloned(),
            cell: cells
                .map(|axis| axis.extremes()[0])
                .fold(f64::INFINITY, f64::min),
        }
    }
}
