//! Slopes with water in them: geometry, strength and pressure as their sources state them, and the bounds of their factor
//! of safety.
//!
//! Where a source is in feet and pounds its numbers stand as metres, kN/m³ and kPa: a factor of safety knows no units.

use igimp_model::PoreSource;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::Level;
use crate::limit_equilibrium::section::{Layer, Path, Search, Section, YOUNG};

/// Unit weight of water \[kN/m³, pcf\].
const SI: f64 = 9.81;
const POUNDS: f64 = 62.4;

const GRIFFITHS_LANE_5: Oracle = bounds("Griffiths and Lane 1999, example 5");
/// Where the least factor lies.
pub(super) const MINIMUM: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "the bounds of slopes under water at all levels",
    locator: "the least lies at L/H = 0.7 to 0.8: at most the least upper bound over the lower one of the empty slope, 0.962 for D = 1 and 0.975 for D = 1.5",
};
const R_U: Oracle = bounds("slope of Griffiths and Lane 1999, example 1, with r_u");
const GRIFFITHS_LANE_6: Oracle = bounds(
    "Griffiths and Lane 1999, example 6: 2.4 dry and 1.9 full; 2.42 and 1.90 by limit equilibrium",
);
const VP70: Oracle = bounds(
    "Duncan and Wright 2005, fig. 6.27: 1.60; Rocscience verification problem 70: 1.599 to 1.603",
);
const VP82: Oracle =
    bounds("Duncan and Wright 2005, fig. 14.20a: 1.535; Rocscience verification problem 82: 1.540");
const VP21: Oracle = bounds(
    "Fredlund and Krahn 1977; Rocscience verification problem 21: 2.073 to 2.076 dry, 1.761 to 1.764 with r_u on their circle",
);
const VP100: Oracle = bounds("Morgenstern 1963: 1.20; Rocscience verification problem 100: 1.212");

/// Lower and upper bounds.
const fn bounds(locator: &'static str) -> Oracle {
    Oracle {
        kind: OracleKind::LimitAnalysis,
        source: "finite-element limit analysis with given pore pressure, ψ = φ, lower and upper bound",
        locator,
    }
}

/// A slope with water, and its known factor.
pub(super) struct Problem {
    pub(super) group: &'static str,
    pub(super) section: Section,
    /// Unit weight by layer \[kN/m³\].
    pub(super) unit_weights: Vec<f64>,
    pub(super) water: PoreSource,
    pub(super) water_unit_weight: f64,
    pub(super) oracle: Oracle,
    /// Lower and upper bound of the factor of safety \[-\].
    pub(super) known: [f64; 2],
    /// How far beyond the bounds is asked \[-\].
    pub(super) beyond: f64,
    pub(super) search: Search,
    /// Cells over the height, coarse and fine.
    pub(super) meshes: [u32; 2],
    pub(super) level: Level,
}

/// Where a search begins; by gravity where the slope does not bear its weight.
fn around(known: [f64; 2], weight: f64) -> Search {
    let middle = 0.5 * (known[0] + known[1]);
    let by_weight = middle > 1.12;
    Search {
        bracket: if by_weight {
            [1.0, 1.2 * middle]
        } else {
            [0.85 * middle, 1.2 * middle]
        },
        path: if by_weight {
            Path::Reduce
        } else {
            Path::Gravity
        },
        steps: if by_weight { 10 } else { 5 },
        young: YOUNG * weight,
    }
}

/// A level water table.
fn level(y: f64) -> PoreSource {
    PoreSource::Table(vec![[0.0, y]])
}

/// The 2:1 slope of ten metres, with its base at a depth factor.
fn common(name: &str, depth: f64) -> Section {
    let margins = if depth > 1.0 {
        [12.0, 20.0]
    } else {
        [12.0, 0.0]
    };
    Section::homogeneous(name, (2.0, depth), (10.0, 20.0), margins)
}

/// Water at one level inside and outside, that is lowered slowly.
fn drawn_down() -> Vec<Problem> {
    let rows = [
        (1.0, 0.0, [1.817, 1.847], Level::Default),
        (1.0, 0.2, [1.572, 1.592], Level::Full),
        (1.0, 0.6, [1.312, 1.329], Level::Full),
        (1.0, 0.7, [1.299, 1.322], Level::Default),
        (1.0, 0.8, [1.307, 1.331], Level::Full),
        (1.0, 1.0, [1.374, 1.394], Level::Full),
        (1.5, 0.0, [1.770, 1.784], Level::Full),
        (1.5, 0.2, [1.550, 1.563], Level::Full),
        (1.5, 0.6, [1.293, 1.305], Level::Full),
        (1.5, 0.7, [1.272, 1.284], Level::Full),
        (1.5, 0.8, [1.271, 1.280], Level::Full),
        (1.5, 1.0, [1.313, 1.321], Level::Full),
    ];
    let problem = |(depth, lowered, known, of): (f64, f64, [f64; 2], Level)| {
        let name = format!("water L/H = {lowered} below the crest, D = {depth}");
        let section = common(&name, depth);
        let water = level(section.top() - 10.0 * lowered);
        Problem {
            group: "drawdown",
            section,
            unit_weights: vec![20.0],
            water,
            water_unit_weight: SI,
            oracle: GRIFFITHS_LANE_5,
            known,
            beyond: 0.015,
            search: around(known, 1.0),
            meshes: [10, 20],
            level: of,
        }
    };
    rows.map(problem).into()
}

/// Pressure as a share of the weight above.
fn ratios() -> Vec<Problem> {
    let rows = [
        (1.0, 0.0, [1.374, 1.394], Level::Full),
        (1.0, 0.1, [1.269, 1.287], Level::Full),
        (1.0, 0.4, [0.950, 0.965], Level::Default),
        (1.0, 0.5, [0.842, 0.857], Level::Full),
        (1.5, 0.0, [1.359, 1.374], Level::Full),
        (1.5, 0.1, [1.253, 1.268], Level::Full),
        (1.5, 0.4, [0.933, 0.944], Level::Full),
        (1.5, 0.5, [0.826, 0.836], Level::Full),
    ];
    let problem = |(depth, ratio, known, of): (f64, f64, [f64; 2], Level)| {
        let name = format!("r_u = {ratio}, D = {depth}");
        Problem {
            group: "r_u",
            section: common(&name, depth),
            unit_weights: vec![20.0],
            water: PoreSource::Ratio(ratio),
            water_unit_weight: SI,
            oracle: R_U,
            known,
            beyond: 0.015,
            search: around(known, 1.0),
            meshes: [10, 20],
            level: of,
        }
    };
    rows.map(problem).into()
}

/// A section of layers on a base at level 0, with the surface from the left; the cells divide `height`.
fn section(name: &str, height: f64, surface: &[[f64; 2]], layers: Vec<Layer>) -> Section {
    Section {
        name: name.to_owned(),
        height,
        unit_weight: 20.0,
        horizontal: 0.0,
        surface: surface.to_vec(),
        base: 0.0,
        layers,
    }
}

/// One soil between the surface and the base.
fn one(cohesion: f64, friction: f64, surface: &[[f64; 2]]) -> Vec<Layer> {
    let ends = [surface[0][0], surface[surface.len() - 1][0]];
    let mut polygon = vec![[ends[0], 0.0]];
    if surface[surface.len() - 1][1] > 0.0 {
        polygon.push([ends[1], 0.0]);
    }
    polygon.extend(surface.iter().rev());
    vec![Layer {
        cohesion,
        friction,
        polygon,
    }]
}

/// The dam, dry and with a full reservoir to its left.
fn dam() -> Vec<Problem> {
    let surface = [
        [0.0, 7.3],
        [33.5, 7.3],
        [99.83, 28.6],
        [107.13, 28.6],
        [157.9, 7.3],
        [191.4, 7.3],
    ];
    let line = vec![[0.0, 24.4], [86.75, 24.4], [157.9, 7.3], [191.4, 7.3]];
    let problem = |(state, water, known, of): (&str, PoreSource, [f64; 2], Level)| Problem {
        group: "dam",
        section: section(
            &format!("dam, {state}"),
            28.6,
            &surface,
            one(13.8, 37.0, &surface),
        ),
        unit_weights: vec![18.2],
        water,
        water_unit_weight: SI,
        oracle: GRIFFITHS_LANE_6,
        known,
        beyond: 0.02,
        search: around(known, 2.0),
        meshes: [26, 52],
        level: of,
    };
    [
        ("dry", PoreSource::Dry, [2.429, 2.461], Level::Full),
        ("full", PoreSource::Table(line), [1.892, 1.908], Level::Full),
    ]
    .map(problem)
    .into()
}

/// A slope in feet and pounds.
struct Imperial<'a> {
    name: &'a str,
    height: f64,
    surface: &'a [[f64; 2]],
    layers: Vec<Layer>,
    unit_weights: Vec<f64>,
    /// Cells over the height on the coarse mesh.
    cells: u32,
}

impl Imperial<'_> {
    fn with(self, oracle: Oracle, water: PoreSource, known: [f64; 2]) -> Problem {
        Problem {
            group: "others",
            section: section(self.name, self.height, self.surface, self.layers),
            search: around(known, self.unit_weights[0] * self.height / 200.0),
            unit_weights: self.unit_weights,
            water,
            water_unit_weight: POUNDS,
            oracle,
            known,
            beyond: 0.02,
            meshes: [self.cells, 2 * self.cells],
            level: Level::Full,
        }
    }
}

/// Slopes of Duncan and Wright, turned so that they fall to the right.
fn duncan_wright() -> Vec<Problem> {
    let surface = [[0.0, 45.0], [35.0, 45.0], [110.0, 15.0], [140.0, 15.0]];
    let submerged = Imperial {
        name: "submerged",
        height: 30.0,
        surface: &surface,
        layers: one(100.0, 20.0, &surface),
        unit_weights: vec![128.0],
        cells: 12,
    };
    let layers = vec![
        Layer {
            cohesion: 600.0,
            friction: 25.0,
            polygon: vec![[0.0, 20.0], [140.0, 20.0], [60.0, 60.0], [0.0, 60.0]],
        },
        Layer {
            cohesion: 0.0,
            friction: 30.0,
            polygon: vec![[0.0, 0.0], [200.0, 0.0], [200.0, 20.0], [0.0, 20.0]],
        },
    ];
    let two_layers = Imperial {
        name: "two layers, line",
        height: 40.0,
        surface: &[[0.0, 60.0], [60.0, 60.0], [140.0, 20.0], [200.0, 20.0]],
        layers,
        unit_weights: vec![125.0, 132.0],
        cells: 16,
    };
    let line = vec![[0.0, 40.0], [100.0, 30.0], [140.0, 20.0], [200.0, 20.0]];
    vec![
        submerged.with(VP70, level(60.0), [1.583, 1.600]),
        two_layers.with(VP82, PoreSource::Table(line), [1.519, 1.533]),
    ]
}

/// Slopes of Fredlund and Krahn, and of Morgenstern, turned so that they fall to the right.
fn one_soil() -> Vec<Problem> {
    let fredlund = [[0.0, 60.0], [60.0, 60.0], [140.0, 20.0], [180.0, 20.0]];
    let vp21 = |name| Imperial {
        name,
        height: 40.0,
        surface: &fredlund,
        layers: one(600.0, 20.0, &fredlund),
        unit_weights: vec![120.0],
        cells: 16,
    };
    let morgenstern = [[0.0, 100.0], [75.0, 100.0], [375.0, 0.0]];
    let vp100 = |name| Imperial {
        name,
        height: 100.0,
        surface: &morgenstern,
        layers: one(312.0, 30.0, &morgenstern),
        unit_weights: vec![124.8],
        cells: 20,
    };
    let ground = PoreSource::Table(morgenstern.to_vec());
    let quarter = PoreSource::Ratio(0.25);
    vec![
        vp21("Fredlund and Krahn, dry").with(VP21, PoreSource::Dry, [1.976, 1.998]),
        vp21("Fredlund and Krahn, r_u = 0.25").with(VP21, quarter, [1.683, 1.702]),
        vp100("Morgenstern, dry").with(VP100, PoreSource::Dry, [2.228, 2.262]),
        vp100("Morgenstern, full pool").with(VP100, level(100.0), [2.561, 2.605]),
        vp100("Morgenstern, drawn down").with(VP100, ground, [1.196, 1.217]),
    ]
}

/// All of them.
pub(super) fn all() -> Vec<Problem> {
    let mut all = drawn_down();
    all.extend(ratios());
    all.extend(dam());
    all.extend(duncan_wright());
    all.extend(one_soil());
    all
}
