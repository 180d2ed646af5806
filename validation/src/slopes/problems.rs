//! The slopes: geometry and strength as their sources state them, and what is known of their factor
//! of safety.

use super::section::{Layer, Section};
use crate::oracle::{Oracle, OracleKind};
use crate::study::Level;

/// Undrained bounds.
pub(crate) const UNDRAINED_BOUNDS: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "finite-element limit analysis, lower and upper bound",
    locator: "validation/reference/slope_limit_load_bounds.csv, as factors of safety",
};
/// Drained bounds.
pub(crate) const DRAINED_BOUNDS: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "finite-element limit analysis, ψ = φ, lower and upper bound",
    locator: "validation/reference/slope_safety_bounds.csv",
};
/// The slope of Dawson et al.
pub(crate) const DAWSON: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "Dawson, Roth and Drescher 1999, after Chen 1975; finite-element limit analysis",
    locator: "upper bound 1.000 by a logarithmic spiral; lower bound 0.988 computed",
};
/// The thin weak layer.
pub(crate) const GRIFFITHS_LANE_3: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "least upper bound of rigid blocks; slope of Griffiths and Lane 1999, example 3",
    locator: "limit_equilibrium/sliding.rs and rotation.rs; their fig. 7: 1.05 and 0.60 at ratios of 0.4 and 0.2",
};
/// The weak or strong foundation.
pub(crate) const GRIFFITHS_LANE_4: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "least upper bound of rotating blocks; slope of Griffiths and Lane 1999, example 4",
    locator: "limit_equilibrium/rotation.rs; their fig. 10: 2.03 at a ratio of 2",
};
/// The survey of programs.
pub(crate) const ACADS: Oracle = Oracle {
    kind: OracleKind::Published,
    source: "Giam and Donald 1989, ACADS survey",
    locator: "1(a): 1.00 (mean of 33 programs 0.991, Bishop 0.987); 1(c): 1.39 (Bishop 1.405, Spencer 1.375)",
};

/// What is known of a slope, and how it is looked for.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    /// The slope.
    pub(crate) section: Section,
    /// Who knows its factor of safety.
    pub(crate) oracle: Oracle,
    /// Least and greatest value of the factor of safety by that knowledge \[-\]; none: the hand
    /// calculation is all there is.
    pub(crate) known: Option<[f64; 2]>,
    /// The share by which the factor may exceed what is known on ten cells over the height; it
    /// falls with h^(2/3) \[-\].
    pub(crate) excess: f64,
    /// How the second opinion is computed.
    pub(crate) opinion: Opinion,
    /// Where the search begins \[-\].
    pub(crate) bracket: [f64; 2],
    /// The lowest level at which the slope is run.
    pub(crate) level: Level,
    /// Whether it is run without B-bar too, as a control.
    pub(crate) locks: bool,
    /// Cells over the height: the first at that level, all of them at the full level.
    pub(crate) meshes: Vec<u32>,
}

/// A hand calculation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Opinion {
    /// A rotating block: an upper bound.
    Rotation,
    /// The method of slices.
    Bishop,
    /// Blocks that slide along the weak layer: an upper bound.
    Sliding,
}

/// The homogeneous undrained slopes: bounds on γH/c_u for a slope angle and a depth factor, stated
/// as factors of safety.
pub(crate) fn undrained(bounds: &[[f64; 4]]) -> Vec<Problem> {
    let problem = |&[angle, depth, lower, upper]: &[f64; 4]| {
        let run = if angle > 40.0 { 1.0 } else { 2.0 };
        // About F = 1.
        let cohesion = (200.0 / upper).round();
        let margins = if depth > 1.0 { [20.0; 2] } else { [15.0, 0.0] };
        let name = format!("undrained, {angle}°, D = {depth}");
        Problem {
            section: Section::homogeneous(&name, (run, depth), (cohesion, 0.0), margins),
            oracle: UNDRAINED_BOUNDS,
            known: Some([lower, upper].map(|number| number * cohesion / 200.0)),
            excess: if depth > 1.0 { 0.02 } else { 0.065 },
            opinion: Opinion::Rotation,
            bracket: [0.9, 1.3],
            level: if (1.2..1.8).contains(&depth) {
                Level::Quick
            } else {
                Level::Default
            },
            locks: true,
            meshes: if depth < 1.8 { vec![10, 20] } else { vec![10] },
        }
    };
    bounds.iter().map(problem).collect()
}

/// The homogeneous drained slopes: number of the example and bounds on the factor of safety.
pub(crate) fn drained(bounds: &[[f64; 3]]) -> Vec<Problem> {
    let slopes = [
        (
            "Griffiths and Lane 1",
            DRAINED_BOUNDS,
            (2.0, 1.0),
            10.0,
            [12.0, 0.0],
            vec![10, 20, 40],
        ),
        (
            "Griffiths and Lane 2",
            DRAINED_BOUNDS,
            (2.0, 1.5),
            10.0,
            [12.0, 20.0],
            vec![10, 20],
        ),
        (
            "Dawson et al.",
            DAWSON,
            (1.0, 1.5),
            12.38,
            [15.0, 10.0],
            vec![10, 20, 40],
        ),
    ];
    let problem = |(slope, &[_, lower, upper]): (_, &[f64; 3])| {
        let (name, oracle, shape, cohesion, margins, meshes) = slope;
        Problem {
            section: Section::homogeneous(name, shape, (cohesion, 20.0), margins),
            oracle,
            known: Some([lower, upper]),
            excess: 0.10,
            opinion: Opinion::Rotation,
            bracket: [lower - 0.1, lower + 0.2],
            level: Level::Quick,
            locks: false,
            meshes,
        }
    };
    slopes.into_iter().zip(bounds).map(problem).collect()
}

/// The slopes of published studies, layered ones among them.
pub(crate) fn published() -> Vec<Problem> {
    let foundation = |ratio| Problem {
        section: two_layers(ratio),
        oracle: GRIFFITHS_LANE_4,
        known: None,
        excess: 0.08,
        opinion: Opinion::Rotation,
        bracket: [0.8, 2.3],
        level: Level::Default,
        locks: false,
        meshes: vec![10],
    };
    let weak = Problem {
        section: weak_layer(0.2),
        oracle: GRIFFITHS_LANE_3,
        known: None,
        excess: 0.25,
        opinion: Opinion::Sliding,
        bracket: [0.4, 1.6],
        level: Level::Full,
        locks: false,
        meshes: vec![20],
    };
    let acads = |section, known, excess| Problem {
        section,
        oracle: ACADS,
        known,
        excess,
        opinion: Opinion::Bishop,
        bracket: [0.9, 1.5],
        level: Level::Default,
        locks: false,
        meshes: vec![10, 20],
    };
    // Without any cohesion the thin end of the upper layer at the toe fails by itself.
    let mut layered = acads_1c();
    layered.layers[0].cohesion = 0.1;
    layered.name += " with c = 0.1 kPa for 0";
    layered.watched = Some(layered.surface[1]);
    vec![
        foundation(0.6),
        foundation(1.5),
        foundation(2.0),
        weak,
        acads(acads_1a(), Some([0.987, 1.0]), 0.08),
        acads(layered, Some([1.375, 1.405]), 0.03),
    ]
}

/// Griffiths and Lane (1999), example 4: a 2:1 slope of c_u1 = γH/4 on a foundation as thick as the
/// slope is high, of `ratio` times that strength.
pub(crate) fn two_layers(ratio: f64) -> Section {
    let name = format!("Griffiths and Lane 4, c_u2/c_u1 = {ratio}");
    let mut section = Section::homogeneous(&name, (2.0, 2.0), (50.0, 0.0), [20.0, 20.0]);
    let layer = |cohesion, corners: [[f64; 2]; 4]| Layer {
        cohesion,
        friction: 0.0,
        polygon: corners.to_vec(),
    };
    section.layers = vec![
        layer(50.0, [[0.0, 10.0], [40.0, 10.0], [20.0, 20.0], [0.0, 20.0]]),
        layer(
            50.0 * ratio,
            [[0.0, 0.0], [60.0, 0.0], [60.0, 10.0], [0.0, 10.0]],
        ),
    ];
    section
}

/// The edges of the weak layer of example 3, the one nearer to the face first \[m\]. Their figure 6
/// states them as fractions of H: at the crest 0.6 H and 0.8 H from the left side, below the toe
/// 0.4 H below the ground and 0.4 H above the base, 1.2 H and 1.4 H before the toe, with the face and
/// at 45°.
pub(crate) fn weak_layer_edges() -> [[[f64; 2]; 4]; 2] {
    [
        [[8.0, 20.0], [36.0, 6.0], [48.0, 6.0], [52.0, 10.0]],
        [[6.0, 20.0], [38.0, 4.0], [48.0, 4.0], [54.0, 10.0]],
    ]
}

/// Griffiths and Lane (1999), example 3: the slope of example 4 in soil of c_u1 = γH/4, with a thin
/// layer of `ratio` times that strength.
pub(crate) fn weak_layer(ratio: f64) -> Section {
    let name = format!("Griffiths and Lane 3, c_u2/c_u1 = {ratio}");
    let mut section = Section::homogeneous(&name, (2.0, 2.0), (50.0, 0.0), [20.0, 20.0]);
    let [upper, lower] = weak_layer_edges();
    let mut above = upper.to_vec();
    above.extend([[40.0, 10.0], [20.0, 20.0]]);
    let mut band = upper.to_vec();
    band.extend(lower.iter().rev());
    let mut below = vec![[0.0, 0.0], [60.0, 0.0], [60.0, 10.0]];
    below.extend(lower.iter().rev());
    below.push([0.0, 20.0]);
    let layer = |cohesion, polygon| Layer {
        cohesion,
        friction: 0.0,
        polygon,
    };
    section.layers = vec![
        layer(50.0, above),
        layer(50.0 * ratio, band),
        layer(50.0, below),
    ];
    section
}

/// ACADS problem 1(a): a simple slope, 2:1 and 10 m high.
pub(crate) fn acads_1a() -> Section {
    acads(
        "ACADS 1(a)",
        20.0,
        vec![Layer {
            cohesion: 3.0,
            friction: 19.6,
            polygon: vec![
                [20.0, 20.0],
                [70.0, 20.0],
                [70.0, 35.0],
                [50.0, 35.0],
                [30.0, 25.0],
                [20.0, 25.0],
            ],
        }],
    )
}

/// ACADS problem 1(c): the same outline with three layers.
pub(crate) fn acads_1c() -> Section {
    let layer = |cohesion, friction, polygon| Layer {
        cohesion,
        friction,
        polygon,
    };
    let upper = vec![
        [30.0, 25.0],
        [40.0, 27.0],
        [50.0, 29.0],
        [54.0, 31.0],
        [70.0, 31.0],
        [70.0, 35.0],
        [50.0, 35.0],
    ];
    let middle = vec![
        [40.0, 27.0],
        [52.0, 24.0],
        [70.0, 24.0],
        [70.0, 31.0],
        [54.0, 31.0],
        [50.0, 29.0],
    ];
    let lower = vec![
        [20.0, 20.0],
        [70.0, 20.0],
        [70.0, 24.0],
        [52.0, 24.0],
        [40.0, 27.0],
        [30.0, 25.0],
        [20.0, 25.0],
    ];
    let layers = vec![
        layer(0.0, 38.0, upper),
        layer(5.3, 23.0, middle),
        layer(7.2, 20.0, lower),
    ];
    acads("ACADS 1(c)", 19.5, layers)
}

/// The outline of ACADS problems 1: it falls to the left where it is published.
fn acads(name: &str, unit_weight: f64, layers: Vec<Layer>) -> Section {
    let published = Section {
        name: name.to_owned(),
        height: 10.0,
        unit_weight,
        surface: vec![[20.0, 25.0], [30.0, 25.0], [50.0, 35.0], [70.0, 35.0]],
        base: 20.0,
        layers,
        watched: None,
    };
    published.mirrored()
}
