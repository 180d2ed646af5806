//! The slopes: geometry and strength as their sources state them, and the known values of their factor
//! of safety.

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::Level;
use crate::limit_equilibrium::section::{Layer, Path, Search, Section, YOUNG};

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
/// A slope that many programs were tried on.
pub(crate) const ARAI_TAGYO: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "least upper bound of rotating blocks; slope of Arai and Tagyo 1985, example 1",
    locator: "limit_equilibrium/rotation.rs: 1.408",
};
/// The survey of programs.
pub(crate) const ACADS: Oracle = Oracle {
    kind: OracleKind::Published,
    source: "Giam and Donald 1989, ACADS survey",
    locator: "1(a): 1.00 (mean of 33 programs 0.991, Bishop 0.987); 1(c): 1.39 (Bishop 1.405, Spencer 1.375)",
};

/// The known factor of a slope, and its search.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    /// The slope.
    pub(crate) section: Section,
    /// The oracle of its factor of safety.
    pub(crate) oracle: Oracle,
    /// Least and greatest value of the factor of safety by that knowledge \[-\]; none: the hand
    /// calculation is all there is.
    pub(crate) known: Option<[f64; 2]>,
    /// The claim with ψ = φ.
    pub(crate) asked: Asked,
    /// The claim with ψ = 0, if that is run.
    pub(crate) without_dilation: Option<Asked>,
    /// How the second opinion is computed.
    pub(crate) opinion: Opinion,
    /// How the factor of safety is searched for.
    pub(crate) search: Search,
    /// The lowest levels at which the slope is run on its coarse and its fine mesh.
    pub(crate) levels: [Level; 2],
    /// Whether it is run without a cure for locking too, as a control.
    pub(crate) locks: bool,
    /// Cells over the height, coarse and fine.
    pub(crate) meshes: Vec<u32>,
}

/// How far a factor of safety may lie beyond the known one, as shares of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Asked {
    /// Below the least value \[-\].
    pub(crate) below: f64,
    /// Above the greatest value, on the coarse and on the fine mesh \[-\].
    pub(crate) above: [f64; 2],
}

/// Soil that dilates as it is sheared, ψ = φ.
const DILATES: Asked = Asked {
    below: 0.02,
    above: [0.03, 0.02],
};
/// Soil that keeps its volume: undrained, or ψ = 0.
const KEEPS_VOLUME: Asked = Asked {
    below: 0.01,
    above: [0.02, 0.02],
};

/// Strength is reduced on the loaded slope, through the bracket in ten steps.
fn reduce(bracket: [f64; 2]) -> Search {
    Search {
        bracket,
        path: Path::Reduce,
        steps: 10,
        young: YOUNG,
    }
}

/// Gravity is raised on reduced strength: for slopes near F = 1 and below, which do not bear their weight.
fn by_gravity(bracket: [f64; 2]) -> Search {
    Search {
        bracket,
        path: Path::Gravity,
        steps: 5,
        young: YOUNG,
    }
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
        let upright = angle > 89.0;
        let run = if upright {
            0.0
        } else if angle > 50.0 {
            angle.to_radians().tan().recip()
        } else if angle > 40.0 {
            1.0
        } else {
            2.0
        };
        // About F = 1.3.
        let cohesion = (260.0 / upper).round();
        let margins = match (depth > 1.0, upright) {
            (true, true) => [10.0, 20.0],
            // The right side lies on a line of the grid.
            (true, false) => [20.0, 20.0 + (10.0 * run).ceil() - 10.0 * run],
            (false, _) => [15.0, 0.0],
        };
        let name = format!("undrained, {angle}°, D = {depth}");
        let above = match (depth > 1.0, upright) {
            (true, false) => KEEPS_VOLUME.above,
            (true, true) => [0.045, 0.025],
            // The slip line ends in the corner between face and rough base.
            (false, _) => [0.06, 0.03],
        };
        Problem {
            section: Section::homogeneous(&name, (run, depth), (cohesion, 0.0), margins),
            oracle: UNDRAINED_BOUNDS,
            known: Some([lower, upper].map(|number| number * cohesion / 200.0)),
            asked: Asked {
                above,
                ..KEEPS_VOLUME
            },
            without_dilation: None,
            opinion: Opinion::Rotation,
            search: reduce([1.0, 2.0]),
            levels: if (1.2..1.8).contains(&depth) && angle < 40.0 {
                [Level::Quick, Level::Default]
            } else {
                [Level::Default; 2]
            },
            locks: (1.2..1.8).contains(&depth) && angle < 40.0,
            meshes: vec![10, 20],
        }
    };
    bounds.iter().map(problem).collect()
}

/// The homogeneous drained slopes: number of the example and bounds on the factor of safety.
pub(crate) fn drained(bounds: &[[f64; 3]]) -> Vec<Problem> {
    let of = |example: usize, section, oracle, search| {
        let [_, lower, upper] = bounds[example - 1];
        Problem {
            section,
            oracle,
            known: Some([lower, upper]),
            asked: DILATES,
            without_dilation: Some(KEEPS_VOLUME),
            opinion: Opinion::Rotation,
            search,
            levels: [Level::Quick, Level::Default],
            locks: false,
            meshes: vec![10, 20],
        }
    };
    let (common, steep) = ((10.0, 20.0), (12.38, 20.0));
    let griffiths_lane_1 =
        Section::homogeneous("Griffiths and Lane 1", (2.0, 1.0), common, [12.0, 0.0]);
    let griffiths_lane_2 =
        Section::homogeneous("Griffiths and Lane 2", (2.0, 1.5), common, [12.0, 20.0]);
    let dawson = Section::homogeneous("Dawson et al.", (1.0, 1.5), steep, [15.0, 10.0]);
    let low = Section::cut(
        "4.5 m high, 2:1",
        [4.5, 2.0, 2.0],
        16.0,
        (5.0, 20.0),
        [4.5, 4.5],
    );
    let low = Problem {
        meshes: vec![9, 18],
        asked: Asked {
            below: 0.007,
            above: [0.031, 0.0115],
        },
        ..of(4, low, DRAINED_BOUNDS, reduce([1.0, 2.0]))
    };
    vec![
        of(1, griffiths_lane_1, DRAINED_BOUNDS, reduce([1.0, 2.0])),
        of(2, griffiths_lane_2, DRAINED_BOUNDS, reduce([1.0, 2.0])),
        of(3, dawson, DAWSON, by_gravity([0.9, 1.2])),
        low,
    ]
}

/// A slope of soil that dilates, on ten cells over the height.
fn dilating(section: Section, oracle: Oracle, opinion: Opinion, search: Search) -> Problem {
    Problem {
        section,
        oracle,
        known: None,
        asked: DILATES,
        without_dilation: None,
        opinion,
        search,
        levels: [Level::Default, Level::Full],
        locks: false,
        meshes: vec![10],
    }
}

/// The slopes of published studies, layered ones among them.
pub(crate) fn published() -> Vec<Problem> {
    let foundation = |ratio, search| Problem {
        asked: Asked {
            below: 0.02,
            above: [0.08, 0.08],
        },
        ..dilating(
            two_layers(ratio),
            GRIFFITHS_LANE_4,
            Opinion::Rotation,
            search,
        )
    };
    let weak = Problem {
        asked: Asked {
            below: 0.02,
            above: [0.25, 0.25],
        },
        levels: [Level::Full; 2],
        meshes: vec![20],
        ..dilating(
            weak_layer(0.2),
            GRIFFITHS_LANE_3,
            Opinion::Sliding,
            by_gravity([0.4, 1.6]),
        )
    };
    let arai_tagyo = Section::cut(
        "Arai and Tagyo 1",
        [20.0, 1.5, 16.0],
        18.82,
        (41.65, 15.0),
        [30.0, 30.0],
    );
    let arai_tagyo = Problem {
        without_dilation: Some(KEEPS_VOLUME),
        meshes: vec![10, 20],
        ..dilating(
            arai_tagyo,
            ARAI_TAGYO,
            Opinion::Rotation,
            reduce([1.0, 2.0]),
        )
    };
    let acads = |section, known, search| Problem {
        known: Some(known),
        meshes: vec![10, 20],
        ..dilating(section, ACADS, Opinion::Bishop, search)
    };
    let layered = Problem {
        // The bounds to within 1.5 %.
        asked: Asked {
            below: 0.015,
            above: [0.015, 0.015],
        },
        ..acads(acads_1c(), [1.375, 1.405], reduce([1.0, 2.0]))
    };
    vec![
        foundation(0.6, by_gravity([0.8, 1.3])),
        foundation(1.5, reduce([1.0, 3.0])),
        foundation(2.0, reduce([1.0, 3.0])),
        weak,
        arai_tagyo,
        acads(acads_1a(), [0.987, 1.0], by_gravity([0.9, 1.2])),
        layered,
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
        horizontal: 0.0,
        surface: vec![[20.0, 25.0], [30.0, 25.0], [50.0, 35.0], [70.0, 35.0]],
        base: 20.0,
        layers,
    };
    published.mirrored()
}
