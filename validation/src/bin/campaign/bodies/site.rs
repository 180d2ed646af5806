//! The soil of a scene: its polygons, with room left for bodies.

use super::scene::Place;
use super::shape::Shape;
use crate::random::Random;

/// Height of the soil \[cells\].
const DEPTH: f64 = 11.0;
/// Room above it \[cells\].
const ROOM: f64 = 9.0;

/// Soil, and where bodies stand on it.
#[derive(Clone, Debug)]
pub(super) struct Site {
    /// h \[m\].
    pub(super) cell: f64,
    /// Whether a wall holds the soil on its left.
    pub(super) has_wall: bool,
    /// Polygons of soil \[m\].
    pub(super) polygons: Vec<Vec<[f64; 2]>>,
    cells: f64,
    /// Height of the surface on the left and on the right \[m\].
    surface: [f64; 2],
}

impl Site {
    pub(super) fn random(cell: f64, is_pair: bool, random: &mut Random) -> Self {
        let cells = if is_pair { 24.0 } else { 16.0 };
        let level = cell * (DEPTH + random.uniform(-0.5, 0.5));
        let dip = if random.chance(0.2) {
            0.1 * cell * cells
        } else {
            0.0
        };
        let surface = [level, level - dip];
        let width = cell * cells;
        Self {
            cell,
            has_wall: false,
            polygons: vec![vec![
                [0.0, 0.0],
                [width, 0.0],
                [width, surface[1]],
                [0.0, surface[0]],
            ]],
            cells,
            surface,
        }
    }

    pub(super) fn width(&self) -> f64 {
        self.cell * self.cells
    }

    pub(super) fn height(&self) -> f64 {
        self.cell * (DEPTH + 1.0 + ROOM)
    }

    fn surface_at(&self, x: f64) -> f64 {
        let [left, right] = self.surface;
        left + (right - left) * x / self.width()
    }

    /// A wall on the left that the soil stands against, leaning by a little.
    pub(super) fn wall(&mut self, random: &mut Random) -> Shape {
        let h = self.cell;
        let lean = random.uniform(-0.2, 0.2);
        let face = |y: f64| [4.0 * h + lean * (y - 6.0 * h), y];
        let (low, high) = (face(-1.5 * h), face(self.surface[0] + 2.0 * h));
        let back = h * random.uniform(2.2, 3.0);
        self.has_wall = true;
        // The surface is level where a wall stands.
        let level = self.surface[0];
        self.surface[1] = level;
        self.polygons[0] = vec![
            face(0.0),
            [self.width(), 0.0],
            [self.width(), level],
            face(level),
        ];
        Shape::Corners(vec![
            low,
            high,
            [high[0] - back, high[1]],
            [low[0] - back, low[1]],
        ])
    }

    /// A shape in its place.
    pub(super) fn put(
        &mut self,
        shape: Shape,
        slot: usize,
        place: Place,
        gap: f64,
        random: &mut Random,
    ) -> Shape {
        let at = match (slot, self.cells > 20.0) {
            (0, true) => 0.3,
            (_, true) => 0.72,
            _ => 0.5,
        };
        let x = self.width() * at + self.cell * random.uniform(-0.5, 0.5);
        let shape = shape.shifted([x, 0.0]);
        // How far its outline stands above the surface.
        let above = |shape: &Shape| match shape {
            Shape::Circle { centre, radius } => {
                let slope = (self.surface[1] - self.surface[0]) / self.width();
                centre[1] - self.surface_at(centre[0]) - radius * slope.hypot(1.0)
            }
            Shape::Corners(corners) => corners
                .iter()
                .map(|at| at[1] - self.surface_at(at[0]))
                .fold(f64::INFINITY, f64::min),
        };
        match place {
            Place::Top | Place::Beside => {
                let by = gap - above(&shape);
                shape.shifted([0.0, by])
            }
            Place::Pit => {
                // As deep as the lower side of the surface allows.
                let by = -above(&shape) - self.cell * random.uniform(1.0, 3.0);
                let shape = shape.shifted([0.0, by]);
                self.dig(&shape.outline());
                shape
            }
            Place::Buried => {
                let (low, high) = extent(&shape.outline());
                let lowest = self.cell * 2.0;
                let highest = self.surface[1].min(self.surface[0]) - 0.7 * self.cell - (high - low);
                let bottom = random.uniform(lowest, highest.max(lowest + 0.1 * self.cell));
                let shape = shape.shifted([0.0, bottom - low]);
                self.bury(&shape.outline());
                shape
            }
        }
    }

    /// Takes a pit for a level rectangle out of the surface.
    fn dig(&mut self, corners: &[[f64; 2]]) {
        let [a, b] = [corners[0], corners[1]];
        let (left, right) = ([a[0], self.surface_at(a[0])], [b[0], self.surface_at(b[0])]);
        let polygon = &mut self.polygons[0];
        polygon.splice(3..3, [right, b, a, left]);
    }

    /// Divides the soil along a body below its surface into the parts left and right of it.
    fn bury(&mut self, outline: &[[f64; 2]]) {
        let count = outline.len();
        let by_height = |a: &usize, b: &usize| outline[*a][1].total_cmp(&outline[*b][1]);
        let bottom = (0..count).min_by(by_height).unwrap_or(0);
        let top = (0..count).max_by(by_height).unwrap_or(0);
        let way = |from: usize, to: usize| {
            let steps = (to + count - from) % count;
            (0..=steps).map(move |k| outline[(from + k) % count])
        };
        let [low, high] = [outline[bottom], outline[top]];
        let (foot, head) = ([low[0], 0.0], [high[0], self.surface_at(high[0])]);
        let whole = self.polygons.remove(0);
        // The outline runs anticlockwise: up its right side, and down its left.
        let mut right = vec![foot, whole[1], whole[2], head];
        right.extend(way(bottom, top).collect::<Vec<_>>().into_iter().rev());
        let mut left = vec![whole[0], foot];
        left.extend(way(top, bottom).collect::<Vec<_>>().into_iter().rev());
        left.extend([head, whole[3]]);
        self.polygons = vec![left, right];
    }
}

fn extent(corners: &[[f64; 2]]) -> (f64, f64) {
    let ys = corners.iter().map(|at| at[1]);
    ys.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| {
        (low.min(y), high.max(y))
    })
}

/// Corners in the syntax of case files.
pub(super) fn corners_text(corners: &[[f64; 2]]) -> String {
    let corners: Vec<String> = corners
        .iter()
        .map(|[x, y]| format!("[\"{x} m\", \"{y} m\"]"))
        .collect();
    format!("[{}]", corners.join(", "))
}
