//! Shapes of random bodies: rectangles, circles, walls, convex polygons, and such with notches.

use std::f64::consts::TAU;

use super::outline::{anticlockwise, edges, inset};
use crate::random::Random;

/// A body is a little thicker than the two cells that a case file asks for \[cells\].
const LEAST_THICKNESS: f64 = 2.05;
/// A side is at least so long when its corners are rounded \[cells\].
const LEAST_SIDE: f64 = 0.3;

/// The kind of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    /// Level.
    Rectangle,
    /// Turned.
    Turned,
    /// Round.
    Circle,
    /// Three to seven corners.
    Convex,
    /// L, U, star, arrow.
    NonConvex,
    /// A wall beside the soil.
    Wall,
}

impl Kind {
    /// In tables.
    pub(crate) fn label(self) -> &'static str {
        match self {
            Self::Rectangle => "rectangle",
            Self::Turned => "turned rectangle",
            Self::Circle => "circle",
            Self::Convex => "convex polygon",
            Self::NonConvex => "polygon with notches",
            Self::Wall => "wall",
        }
    }
}

/// Corners, anticlockwise, or a circle \[m\].
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    /// Of a polygon.
    Corners(Vec<[f64; 2]>),
    /// A circle.
    Circle {
        /// Centre.
        centre: [f64; 2],
        /// Radius.
        radius: f64,
    },
}

impl Shape {
    /// A shape of a kind about the origin, on cells of a size \[m\] and with corners rounded by so many
    /// of them; walls are made where they stand.
    pub(crate) fn random(kind: Kind, cell: f64, rounding: f64, random: &mut Random) -> Self {
        if kind == Kind::Circle {
            return Self::Circle {
                centre: [0.0; 2],
                radius: cell * random.uniform(1.1, 3.0),
            };
        }
        loop {
            let corners = match kind {
                Kind::Rectangle => rectangle(random, 0.0),
                Kind::Turned => {
                    let turn = random.uniform(-0.8, 0.8);
                    rectangle(random, turn)
                }
                Kind::Convex => convex(random),
                _ => notched(random),
            };
            let corners = anticlockwise(corners);
            if is_sound(&corners, rounding) {
                let scaled = corners.iter().map(|at| at.map(|x| cell * x));
                return Self::Corners(scaled.collect());
            }
        }
    }

    /// Its corners; those of a polygon around a circle.
    pub(crate) fn outline(&self) -> Vec<[f64; 2]> {
        match self {
            Self::Corners(corners) => corners.clone(),
            Self::Circle { centre, radius } => {
                let count = 48;
                let around = radius / (0.5 * TAU / f64::from(count)).cos();
                (0..count)
                    .map(|k| {
                        polar(
                            *centre,
                            around * (1.0 + 1e-9),
                            TAU * f64::from(k) / f64::from(count),
                        )
                    })
                    .collect()
            }
        }
    }

    /// The same elsewhere.
    pub(crate) fn shifted(self, by: [f64; 2]) -> Self {
        let shift = |at: [f64; 2]| [at[0] + by[0], at[1] + by[1]];
        match self {
            Self::Corners(corners) => Self::Corners(corners.into_iter().map(shift).collect()),
            Self::Circle { centre, radius } => Self::Circle {
                centre: shift(centre),
                radius,
            },
        }
    }

    /// Its width \[m\].
    pub(crate) fn width(&self) -> f64 {
        let xs = self.outline().into_iter().map(|at| at[0]);
        let (low, high) = xs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        high - low
    }
}

fn polar(centre: [f64; 2], radius: f64, angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [centre[0] + radius * cos, centre[1] + radius * sin]
}

fn rectangle(random: &mut Random, turn: f64) -> Vec<[f64; 2]> {
    let (a, b) = (random.uniform(1.3, 3.0), random.uniform(1.05, 2.0));
    let (sin, cos) = turn.sin_cos();
    [[-a, -b], [a, -b], [a, b], [-a, b]]
        .map(|[x, y]| [cos * x - sin * y, sin * x + cos * y])
        .to_vec()
}

fn convex(random: &mut Random) -> Vec<[f64; 2]> {
    let count = random.integer(3, 7);
    let first = random.uniform(0.0, TAU);
    // Corners on an ellipse make a convex polygon.
    let (a, b) = (random.uniform(1.8, 3.2), random.uniform(1.6, 2.6));
    (0..count)
        .map(|k| {
            let angle = first + TAU * (k as f64 + random.uniform(-0.25, 0.25)) / count as f64;
            [a * angle.cos(), b * angle.sin()]
        })
        .collect()
}

fn notched(random: &mut Random) -> Vec<[f64; 2]> {
    let turn = random.uniform(0.0, TAU);
    let arm = random.uniform(1.6, 2.4);
    let (w, t) = (random.uniform(4.0, 6.0), random.uniform(4.0, 5.5));
    let corners = match random.integer(1, 4) {
        // L
        1 => vec![
            [0.0, 0.0],
            [w, 0.0],
            [w, arm],
            [arm, arm],
            [arm, t],
            [0.0, t],
        ],
        // U
        2 => vec![
            [0.0, 0.0],
            [w, 0.0],
            [w, t],
            [w - arm, t],
            [w - arm, arm],
            [arm, arm],
            [arm, t],
            [0.0, t],
        ],
        // Star
        3 => {
            let points = random.integer(4, 6);
            let inner = random.uniform(1.6, 2.2);
            (0..2 * points)
                .map(|k| {
                    let radius = if k % 2 == 0 { 3.4 } else { inner };
                    polar([0.0; 2], radius, 0.5 * TAU * k as f64 / points as f64)
                })
                .collect()
        }
        // Arrow
        _ => vec![
            [0.0, 0.0],
            [w, 0.5 * t],
            [0.0, t],
            [random.uniform(0.5, 1.5), 0.5 * t],
        ],
    };
    let (sin, cos) = turn.sin_cos();
    let about: Vec<[f64; 2]> = corners
        .iter()
        .map(|[x, y]| [cos * x - sin * y, sin * x + cos * y])
        .collect();
    let count = about.len() as f64;
    let middle = [0, 1].map(|k| about.iter().map(|at| at[k]).sum::<f64>() / count);
    about
        .iter()
        .map(|at| [at[0] - middle[0], at[1] - middle[1]])
        .collect()
}

/// Whether a polygon \[cells\] is thick enough, and keeps all its sides when its corners are rounded.
fn is_sound(corners: &[[f64; 2]], rounding: f64) -> bool {
    let core = inset(corners, rounding);
    let keeps = std::iter::zip(edges(corners), edges(&core)).all(|((a, b), (c, d))| {
        let (along, inner) = ([b[0] - a[0], b[1] - a[1]], [d[0] - c[0], d[1] - c[1]]);
        let length = along[0].hypot(along[1]);
        (along[0] * inner[0] + along[1] * inner[1]) / length > LEAST_SIDE
    });
    keeps && thickness(corners) > LEAST_THICKNESS
}

/// The narrowest strip that holds a polygon, among many directions.
fn thickness(corners: &[[f64; 2]]) -> f64 {
    let across = |k: u32| {
        let (sin, cos) = (0.5 * TAU * f64::from(k) / 720.0).sin_cos();
        let heights = corners.iter().map(|at| cos * at[0] + sin * at[1]);
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        high - low
    };
    (0..720).map(across).fold(f64::INFINITY, f64::min)
}
