//! Rigid bodies at places of the grid within a cell, from case files that say nothing of the method, and with lines that are not
//! fitted to them.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::path::Path;

use igimp_cases::CaseError;
use igimp_input::CaseFile;
use igimp_model::check::Band;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::{Computed, corners};

/// The book's description of the study.
const ABOUT: &str = "Strips, pipes and an anchor in weightless Tresca soil with E/s_u = 1000, from case files that say nothing of the method but fit = none, on ten cells, are pushed or pulled at small strain with their sides at five places of the grid within a cell, and a strip with sharp edges on ground at eight. Every march has to reach its end. Loads within 4 % of limit analysis and spreads within 3 % are claimed, all is told.";
const ABOUT_FITTED: &str = "The bodies of contact-places, and a strip whose sides are bonded, on lines that are fitted to them, as they are where a file says nothing of fit. Sides and ground stand at four pairs of places within a cell. Every march has to reach its end. Loads within 4 % of limit analysis and spreads within 3 % are claimed of all.";
const PRANDTL: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Prandtl 1920",
    locator: "V/(B s_u) = 2 + π",
};
const BOUNDS: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "finite-element limit analysis of a body wished in place, no heave",
    locator: "lower and upper bound of V/(B s_u)",
};
const INDIFFERENT: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "the soil and the body, which know no grid",
    locator: "largest less smallest load over their mean: 0",
};

/// By how much a load that is claimed may lie beyond its bounds \[-\].
const BEYOND: f64 = 0.04;
/// By how much the loads of five places may differ where that is claimed \[-\].
const SPREAD: f64 = 0.03;
/// Where the left side of a body, or the ground, stands in its cell \[cells\].
const PLACES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 0.9];
/// More places of the ground, where the soil above a line fills little of its cells \[cells\].
const SLICES: [f64; 3] = [0.05, 0.1, 0.2];
/// Where sides and the ground stand where lines are fitted to them \[cells\].
const FITTED: [[f64; 2]; 4] = [[0.0, 0.0], [0.25, 0.0], [0.9, 0.5], [0.5, 0.25]];
/// Size of a cell \[m\].
const CELL: f64 = 0.1;
/// Parts of an arc that stands for a circle in the outline of soil, just outside of it \[m\].
const ARC: usize = 120;
const ARC_RADIUS: f64 = 0.5003;

/// A kind of body.
#[derive(Clone, Copy)]
enum Kind {
    /// A rough strip with its base so deep \[m\], and along its sides.
    Strip { depth: f64, sides: &'static str },
    /// A rough strip with sharp edges, the ground at the place in its cell.
    OnGround,
    /// A pipe so deep \[m\], and along it.
    Pipe { depth: f64, interface: &'static str },
    /// A plate so deep \[m\], its tension, and along it.
    Anchor {
        depth: f64,
        tension: &'static str,
        interface: &'static str,
    },
}

/// A body, its limit load over width and strength, and the level from which on it is asked for.
struct Question {
    name: &'static str,
    kind: Kind,
    oracle: Oracle,
    bounds: [f64; 2],
    /// The claim where lines are not fitted to it; none where that is not computed. Both are where they are.
    claim: Option<Claim>,
    level: Level,
}

/// Whether lines are fitted to bodies.
#[derive(Clone, Copy)]
enum Fit {
    /// As in a file that says nothing of them.
    Bodies,
    None,
}

impl Fit {
    /// The key of the grid.
    fn key(self) -> &'static str {
        match self {
            Self::Bodies => "",
            Self::None => "fit = \"none\"\n",
        }
    }
}

/// The claim on the places; all is printed.
#[derive(Clone, Copy)]
enum Claim {
    /// Nothing: they only have to reach their end.
    End,
    /// Their bounds.
    Bounds,
    /// By how much they differ.
    Spread,
    /// Both.
    Both,
}

/// Sides that soil leaves without a force, and sides that hold it with its strength.
const BARE: &str = "interface = \"smooth\"";
const BONDED: &str = "interface = { adhesion_share = 1 }, tension = \"bonded\"";
const ADHESIVE: &str = "{ adhesion_share = 1 }";

/// A body whose bounds are from limit analysis.
fn question(
    name: &'static str,
    kind: Kind,
    bounds: [f64; 2],
    claim: Claim,
    level: Level,
) -> Question {
    Question {
        name,
        kind,
        oracle: BOUNDS,
        bounds,
        claim: Some(claim),
        level,
    }
}

/// All of them.
fn questions() -> Vec<Question> {
    let strip = |depth| Kind::Strip { depth, sides: BARE };
    let anchor = |tension, interface| Kind::Anchor {
        depth: 2.0,
        tension,
        interface,
    };
    let n_c = 2.0 + PI;
    let surface = question("strip", strip(0.0), [n_c; 2], Claim::Spread, Level::Quick);
    let mut all = vec![
        Question {
            oracle: PRANDTL,
            ..surface
        },
        question(
            "strip 1B deep",
            strip(1.0),
            [6.27, 6.404],
            Claim::Bounds,
            Level::Full,
        ),
        Question {
            claim: None,
            ..question(
                "strip 1B deep, bonded sides",
                Kind::Strip {
                    depth: 1.0,
                    sides: BONDED,
                },
                [8.30, 8.40],
                Claim::Both,
                Level::Full,
            )
        },
        Question {
            oracle: PRANDTL,
            ..question(
                "strip, level of the ground",
                Kind::OnGround,
                [n_c; 2],
                Claim::Both,
                Level::Quick,
            )
        },
    ];
    all.extend(pipes());
    let breaks_away = anchor("none", "\"rough\"");
    all.extend([
        question(
            "anchor that breaks away",
            breaks_away,
            [3.56, 3.68],
            Claim::End,
            Level::Full,
        ),
        question(
            "anchor, bonded",
            anchor("bonded", ADHESIVE),
            [11.19, 11.5],
            Claim::Both,
            Level::Full,
        ),
    ]);
    all
}

/// Pipes without tension.
fn pipes() -> [Question; 8] {
    let pipe = |depth, interface| Kind::Pipe { depth, interface };
    let (smooth, half) = ("\"smooth\"", "{ adhesion_share = 0.5 }");
    [
        question(
            "smooth pipe, w/D = 0.2",
            pipe(0.2, smooth),
            [3.36, 3.45],
            Claim::Bounds,
            Level::Full,
        ),
        question(
            "smooth pipe, w/D = 0.3",
            pipe(0.3, smooth),
            [3.760, 3.833],
            Claim::Bounds,
            Level::Full,
        ),
        question(
            "smooth pipe, w/D = 0.5",
            pipe(0.5, smooth),
            [4.231, 4.334],
            Claim::Both,
            Level::Full,
        ),
        question(
            "smooth pipe, w/D = 1",
            pipe(1.0, smooth),
            [5.007, 5.099],
            Claim::End,
            Level::Full,
        ),
        question(
            "adhesive pipe, w/D = 0.3",
            pipe(0.3, ADHESIVE),
            [4.668, 4.758],
            Claim::Bounds,
            Level::Full,
        ),
        question(
            "adhesive pipe, w/D = 0.5",
            pipe(0.5, ADHESIVE),
            [5.521, 5.629],
            Claim::Bounds,
            Level::Full,
        ),
        question(
            "adhesive pipe, w/D = 1",
            pipe(1.0, ADHESIVE),
            [6.111, 6.218],
            Claim::Bounds,
            Level::Full,
        ),
        // Between the smooth pipe and the rough one.
        question(
            "half adhesive pipe, w/D = 0.5",
            pipe(0.5, half),
            [4.231, 5.629],
            Claim::Spread,
            Level::Full,
        ),
    ]
}

/// The ground, and where the left side of the body stands \[m\].
struct Site {
    width: f64,
    top: f64,
    left: f64,
}

impl Kind {
    /// Where the side and the ground stand where lines are not fitted to them \[cells\].
    fn places(self) -> Vec<[f64; 2]> {
        match self {
            Self::OnGround => {
                let all = PLACES.iter().chain(&SLICES);
                all.map(|&ground| [0.75, ground]).collect()
            }
            Self::Strip { .. } | Self::Pipe { .. } | Self::Anchor { .. } => {
                PLACES.map(|side| [side, 0.0]).to_vec()
            }
        }
    }

    /// Its places in words.
    fn place_label(self, [side, ground]: [f64; 2], fit: Fit) -> String {
        match (fit, self) {
            (Fit::Bodies, _) => format!("side at {side} and ground at {ground} of a cell"),
            (Fit::None, Self::OnGround) => format!("ground at {ground} of its cell"),
            (Fit::None, _) => format!("side at {side} of its cell"),
        }
    }

    fn site(self, [side, ground]: [f64; 2]) -> Site {
        let [side, ground] = [side, ground].map(|place| place * CELL);
        let site = |width: f64, top: f64, left: f64| Site {
            width,
            top: top + ground,
            left: left + side,
        };
        match self {
            Self::Strip { .. } | Self::OnGround => site(7.0, 3.5, 3.0),
            Self::Pipe { .. } => site(5.0, 2.0, 2.0),
            Self::Anchor { depth, .. } => site(2.0 * depth + 4.0, depth + 2.2, depth + 1.5),
        }
    }

    /// Outlines of the soil around the body \[m\].
    fn soil(self, site: &Site) -> Vec<Vec<[f64; 2]>> {
        let &Site { width, top, left } = site;
        let right = left + 1.0;
        let box_of =
            |from: [f64; 2], to: [f64; 2]| vec![from, [to[0], from[1]], to, [from[0], to[1]]];
        let mut around = vec![[0.0, 0.0], [width, 0.0], [width, top]];
        match self {
            Self::Strip { depth, .. } => {
                if depth > 0.0 {
                    let base = top - depth;
                    around.extend([[right, top], [right, base], [left, base], [left, top]]);
                }
            }
            Self::OnGround => {}
            Self::Pipe { depth, .. } => {
                let middle = [left + 0.5, top + 0.5 - depth];
                let lip = ((top - middle[1]) / ARC_RADIUS).min(0.0).asin();
                let arc = PI + 2.0 * lip;
                let sides = [middle[0] + ARC_RADIUS, middle[0] - ARC_RADIUS];
                // Above its widest place the walls of the trench stand upright.
                let walls = |side: f64| (depth > 0.5).then_some([side, top]);
                around.extend(walls(sides[0]));
                around.extend((0..=ARC).map(|k| {
                    let angle = lip - arc * k as f64 / ARC as f64;
                    [
                        middle[0] + ARC_RADIUS * angle.cos(),
                        middle[1] + ARC_RADIUS * angle.sin(),
                    ]
                }));
                around.extend(walls(sides[1]));
            }
            Self::Anchor { depth, .. } => {
                let [base, lid] = [top - depth - 0.2, top - depth];
                return vec![
                    box_of([0.0, 0.0], [width, base]),
                    box_of([0.0, base], [left, lid]),
                    box_of([right, base], [width, lid]),
                    box_of([0.0, lid], [width, top]),
                ];
            }
        }
        around.push([0.0, top]);
        vec![around]
    }

    /// The body as a case file has it, and how far it goes \[m\].
    fn body(self, site: &Site) -> (String, f64) {
        let &Site { top, left, .. } = site;
        let rectangle = |base: f64, lid: f64| {
            let [right, left] = [left + 1.0, left];
            format!(
                "type = \"rectangle\"\nfrom = [\"{left} m\", \"{base} m\"]\nto = [\"{right} m\", \"{lid} m\"]"
            )
        };
        match self {
            Self::Strip { depth, sides } => {
                let sides =
                    ["right", "left"].map(|side| format!("{{ side = \"{side}\", {sides} }}"));
                let body = rectangle(top - depth, top - depth + 2.0);
                (
                    format!("{body}\nsides = [{}]", sides.join(", ")),
                    -0.05 - 0.05 * depth,
                )
            }
            Self::OnGround => {
                let body = rectangle(top, top + 2.0);
                (
                    format!("{body}\ninterface = \"rough\"\nrounding = 0"),
                    -0.05,
                )
            }
            Self::Pipe { depth, interface } => {
                let [x, y] = [left + 0.5, top + 0.5 - depth];
                (
                    format!(
                        "type = \"circle\"\ncentre = [\"{x} m\", \"{y} m\"]\nradius = \"0.5 m\"\ninterface = {interface}"
                    ),
                    -0.05,
                )
            }
            Self::Anchor {
                depth,
                tension,
                interface,
            } => {
                let body = rectangle(top - depth - 0.2, top - depth);
                (
                    format!("{body}\ninterface = {interface}\ntension = \"{tension}\""),
                    0.05,
                )
            }
        }
    }

    /// The case file of the places of side and ground \[cells\].
    fn file(self, places: [f64; 2], fit: Fit) -> String {
        let site = self.site(places);
        let fit = fit.key();
        let (body, way) = self.body(&site);
        let mut bodies = String::new();
        for (number, outline) in self.soil(&site).iter().enumerate() {
            let outline = corners(outline);
            let _ = write!(
                bodies,
                "[[bodies]]\nname = \"soil {number}\"\nmaterial = \"clay\"\npolygon = {outline}\n"
            );
        }
        let Site { width, top, .. } = site;
        let sky = CELL * ((top + 1.0) / CELL).round();
        format!(
            "igimp = 1
[case]
title = \"place of the grid\"
gravity = \"0 m/s2\"
[grid]
cell = \"{CELL} m\"
domain = {{ x = [\"0 m\", \"{width} m\"], y = [\"0 m\", \"{sky} m\"] }}
{fit}[materials.clay]
model = \"tresca\"
unit_weight = \"0 kN/m3\"
young = \"1 MPa\"
poisson = 0.49
cu = \"1 kPa\"
{bodies}[[rigid]]
name = \"body\"
{body}
[[stages]]
name = \"push\"
type = \"rigid\"
geometry = \"given\"
bodies = [{{ body = \"body\", y = \"{way} m\" }}]
steps = 20
[[curves]]
name = \"load\"
x = {{ of = \"rigid.body.settlement\" }}
y = {{ of = \"rigid.body.resistance\", divide_by = [\"1 m\", \"1 kPa\"] }}
"
        )
    }
}

/// Loads of a body at its places, each with the bounds held against where they are claimed.
fn add(
    study: &mut Study,
    question: &Question,
    (fit, places): (Fit, &[[f64; 2]]),
    claim: Claim,
) -> Result<(), CaseError> {
    let computed = places
        .par_iter()
        .map(|&place| {
            let text = question.kind.file(place, fit);
            Computed::new(CaseFile::parse(question.name, &text, &[])?.into_case())
        })
        .collect::<Result<Vec<_>, CaseError>>()?;
    let name = question.name;
    let mut loads = Vec::new();
    let mut last = 0;
    for (place, run) in std::iter::zip(places, &computed) {
        let place = question.kind.place_label(*place, fit);
        let variant = format!("{name}, {place}");
        last = study.run_to_end(RunRecord::new(variant, &run.report, run.elapsed));
        let load = run.curve("load").points(0, 1);
        let load = load.last().map_or(f64::NAN, |[_, load]| load.abs());
        let [lower, upper] = question.bounds;
        let band = Band::Between((1.0 - BEYOND) * lower, (1.0 + BEYOND) * upper);
        let expected = question.oracle.says(0.5 * (lower + upper));
        if matches!(claim, Claim::Bounds | Claim::Both) {
            study.check(last, "V/(B s_u) [-]", expected, band, load);
        }
        loads.push(load);
    }
    let most = loads.iter().copied().fold(0.0, f64::max);
    let least = loads.iter().copied().fold(f64::INFINITY, f64::min);
    let mean = loads.iter().sum::<f64>() / loads.len() as f64;
    let spread = (most - least) / mean;
    if matches!(claim, Claim::Spread | Claim::Both) {
        let quantity = format!("{name}: spread over the places of the grid [-]");
        let band = Band::Between(0.0, SPREAD);
        study.check(last, quantity, INDIFFERENT.says(0.0), band, spread);
    }
    let [lower, upper] = question.bounds;
    study.notes.push(format!(
        "{}: {name} has V/(B s_u) from {least:.3} to {most:.3}, spread {:.1} %; {lower:.3} to {upper:.3} is known",
        study.case,
        100.0 * spread
    ));
    Ok(())
}

/// Runs the study of bodies on lines that are not fitted to them.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-places", ABOUT, out)?;
    for question in questions().iter().filter(|q| q.level <= level) {
        if let Some(claim) = question.claim {
            let places = question.kind.places();
            add(&mut study, question, (Fit::None, &places), claim)?;
        }
    }
    Ok(study)
}

/// Runs the study of bodies on lines that are fitted to them.
pub(crate) fn fitted(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-fitted", ABOUT_FITTED, out)?;
    for question in questions().iter().filter(|q| q.level <= level) {
        add(&mut study, question, (Fit::Bodies, &FITTED), Claim::Both)?;
    }
    Ok(study)
}
