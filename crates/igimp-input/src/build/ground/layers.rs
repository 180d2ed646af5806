//! Warnings about how bodies sit on the grid and by each other: boundaries of layers within cells,
//! gaps, bodies thinner than three cells, and stiffness out of proportion to the weight.

use igimp_assembly::Geometry;
use igimp_geometry::polygon::{bounding_box, contains};
use igimp_model::{
    BodyPart, Drainage, Ground, Material, ReductionPath, Stage, StageKind, Strength,
};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::bodies::Body;
use igimp_schema::schema::grid::{Fit, MixedCells};
use igimp_schema::source::Place;
use igimp_schema::text::{clip, number, point};
use igimp_schema::tree::Node;
use igimp_seepage::Soil;
use igimp_text::short;

use crate::build::Thing;
use crate::build::bodies::polygon_place;
use crate::build::bodies::sequence::Sequence;
use crate::build::bodies::site::Site;
use crate::build::grid::Frame;
use crate::build::materials::linear_stiffness;
use crate::geometry::{Facing, facing, largest_run};

/// Error of the stress beside a boundary that is worth a warning \[-\].
const WORTH: f64 = 0.04;
/// Gaps narrower than this share of the smallest cell are warned of: nodes see soil on both sides \[-\].
const NARROW: f64 = 1.0;
/// Cells across a layer that resolve its strength.
const ENOUGH: f64 = 3.0;
/// The same across a slope, where its sides cut cells \[-\].
const ENOUGH_ACROSS_SLOPES: f64 = 4.0;
/// γH/E beyond which the ground has another shape when its weight acts \[-\].
const SOFT: f64 = 0.05;
/// γH/E below which round-off shows in the strains \[-\].
const STIFF: f64 = 1e-6;

/// What the warnings look at.
pub(crate) struct Layers<'a> {
    /// The file.
    pub(crate) tree: &'a Node,
    /// Its bodies as they are stated.
    pub(crate) own: &'a [Thing<Body>],
    /// Its bodies.
    pub(crate) bodies: &'a [Option<BodyPart<2>>],
    /// Its materials.
    pub(crate) materials: &'a [Option<Material>],
    /// Bodies on the grid.
    pub(crate) site: &'a Site,
    /// Which of them are there at the same time.
    pub(crate) sequence: &'a Sequence,
}

/// Warns of boundaries within cells, gaps and thin bodies.
pub(crate) fn check(layers: &Layers<'_>, problems: &mut Problems) {
    let (Some(frame), true) = (&layers.site.frame, layers.site.is_complete) else {
        return;
    };
    let (Some(bodies), Some(materials)) = (complete(layers.bodies), complete(layers.materials))
    else {
        return;
    };
    let ground = ground_of(&bodies, &materials);
    let neighbours = check_pairs(layers, frame, (&bodies, &materials, &ground), problems);
    check_thickness(layers, frame, &bodies, &neighbours, problems);
}

fn complete<T>(parts: &[Option<T>]) -> Option<Vec<&T>> {
    parts.iter().map(Option::as_ref).collect()
}

/// The ground of bodies and materials.
fn ground_of<'a>(bodies: &[&'a BodyPart<2>], materials: &[&'a Material]) -> Ground<2> {
    Ground::new(bodies.iter().map(|body| (*body, materials[body.material])))
}

/// The modulus of compression without lateral strain at a place, with the water that does not leave.
fn constrained(material: &Material, place: [f64; 2], ground: &Ground<2>) -> f64 {
    let nu = material.poisson;
    let soil = material.young_at(&place, ground) * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
    match material.drainage {
        Drainage::Undrained { stiffness, .. } => soil + stiffness.modulus,
        _ => soil,
    }
}

/// Whether water does not leave soil.
fn holds_water(soil: &Material) -> bool {
    matches!(soil.drainage, Drainage::Undrained { .. })
}

/// Whether soil has all the strength of another one, and more.
fn is_stronger(own: &Strength, other: &Strength) -> bool {
    let parameters = |of: &Strength| [of.cohesive(), of.friction_angle()].map(|p| p.unwrap_or(0.0));
    match (own, other) {
        (Strength::Elastic, other) => *other != Strength::Elastic,
        (_, Strength::Elastic) => false,
        _ => {
            let [mine, its] = [own, other].map(parameters);
            let pairs = || std::iter::zip(mine, its);
            pairs().any(|(mine, its)| mine > its) && pairs().all(|(mine, its)| mine >= its)
        }
    }
}

/// Boundaries within cells and gaps; tells which bodies touch a stiffer one, or one of their own
/// material, or nothing.
fn check_pairs(
    layers: &Layers<'_>,
    frame: &Frame<2>,
    (bodies, materials, ground): (&[&BodyPart<2>], &[&Material], &Ground<2>),
    problems: &mut Problems,
) -> Vec<Neighbours> {
    let [width, height] = frame.axes.each_ref().map(|axis| axis.extremes()[0]);
    let narrow = NARROW * width.min(height);
    let grid = Root::<2>::grid(layers.tree).ok();
    let is_fitted =
        (grid.iter()).any(|own| own.wishes.as_ref().is_ok_and(|own| *own.fit == Fit::Layers));
    let is_shared = (grid.iter()).any(|own| {
        own.mixed_cells
            .as_ref()
            .is_ok_and(|own| **own == MixedCells::Mean)
    });
    let mut neighbours = vec![Neighbours::default(); bodies.len()];
    for (second, b) in bodies.iter().enumerate() {
        for (first, a) in bodies[..second].iter().enumerate() {
            if !layers.sequence.are_together(first, second) {
                continue;
            }
            let pieces = facing(a.polygon(), b.polygon(), narrow);
            let place = layers.own[second].as_ref().map(polygon_place);
            let gap = pieces.iter().find(|piece| {
                piece.distance > layers.site.round_off && !layers.site.is_inside(None, piece.middle)
            });
            let names = [&a.name, &b.name].map(|name| clip(name, 40));
            if let Some(gap) = gap {
                warn_of_gap(gap, &names, Report { place, problems });
            }
            let middle = pieces.first().map_or([0.0; 2], |piece| piece.middle);
            let moduli = [a, b].map(|body| constrained(materials[body.material], middle, ground));
            let mut touching = pieces
                .iter()
                .filter(|piece| piece.distance <= layers.site.round_off)
                .peekable();
            if touching.peek().is_none() {
                continue;
            }
            let soils = [a, b].map(|body| materials[body.material]);
            neighbours[first].sees(soils, moduli);
            neighbours[second].sees([soils[1], soils[0]], [moduli[1], moduli[0]]);
            let round_off = layers.site.round_off;
            let within = touching.filter_map(|piece| Within::of(piece.ends, frame, round_off));
            // One warning for two bodies: of the boundary that matters most.
            let worst = within
                .map(|within| {
                    let is_first = contains(a.polygon(), within.beside());
                    let ordered = if is_first {
                        moduli
                    } else {
                        [moduli[1], moduli[0]]
                    };
                    (within.error(ordered), within)
                })
                .max_by(|a, b| a.0.total_cmp(&b.0));
            let by_water = soils.iter().any(|own| holds_water(own));
            if let Some((_, within)) = worst.as_ref().filter(|_| unlike_for_water(soils)) {
                within.warn_of_flow(&names, Report { place, problems });
            }
            if let Some((error, within)) =
                worst.filter(|(error, _)| *error > WORTH && (by_water || !is_shared))
            {
                within.warn(
                    &names,
                    error,
                    (is_fitted, by_water),
                    Report { place, problems },
                );
            }
        }
    }
    neighbours
}

fn warn_of_gap(gap: &Facing, [a, b]: &[String; 2], report: Report<'_>) {
    let Report { place, problems } = report;
    let text = format!(
        "a gap of {} m parts body `{b}` from body `{a}` at {}",
        short(gap.distance),
        point(gap.middle)
    );
    problems
        .warning(place, text)
        .help("bodies closer than a cell stick together: let them share the edge, or leave a cell between them");
}

/// Whether water flows through two soils as they consolidate, and through one much faster.
fn unlike_for_water(soils: [&Material; 2]) -> bool {
    let flows = |own: &Material| matches!(own.drainage, Drainage::Undrained { flows: true, .. });
    let [a, b] = soils.map(|own| own.permeability.filter(|_| flows(own)));
    let fast = |own: Soil| own.along.max(own.across);
    let ratio = |(a, b)| (fast(a) / fast(b)).ln().abs();
    a.zip(b).is_some_and(|own| ratio(own) > UNLIKE.ln())
}

/// Permeabilities that differ by this factor in a cell are told of \[-\].
const UNLIKE: f64 = 3.0;

/// What a body touches.
#[derive(Clone, Copy, Debug, Default)]
struct Neighbours {
    has_any: bool,
    has_stiffer: bool,
    has_same: bool,
}

impl Neighbours {
    /// Takes a neighbour in: of soils and moduli the own one first.
    fn sees(&mut self, [own, other]: [&Material; 2], [mine, its]: [f64; 2]) {
        self.has_any = true;
        self.has_stiffer |= its > mine || is_stronger(&other.strength, &own.strength);
        self.has_same |= std::ptr::eq(own, other);
    }
}

/// A stretch of a boundary that lies within cells.
#[derive(Clone, Copy, Debug)]
struct Within {
    ends: [[f64; 2]; 2],
    /// For a level or an upright boundary: the axis across it, and the share of the cell below it or
    /// on its left.
    across: Option<(usize, f64)>,
}

impl Within {
    fn of(ends: [[f64; 2]; 2], frame: &Frame<2>, round_off: f64) -> Option<Self> {
        let across = [1, 0]
            .into_iter()
            .find(|&axis| (ends[0][axis] - ends[1][axis]).abs() <= round_off);
        let Some(axis) = across else {
            return Some(Self { ends, across: None });
        };
        let place = frame.axes[axis].place(ends[0][axis]);
        let is_on_line = (place - place.round()).abs() < 1e-6;
        (!is_on_line).then(|| Self {
            ends,
            across: Some((axis, place - place.floor())),
        })
    }

    /// A place just below the boundary or on its left.
    fn beside(&self) -> [f64; 2] {
        let [p, q] = self.ends;
        let middle = [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
        let off = 1e-3 * (p[0] - q[0]).hypot(p[1] - q[1]);
        match self.across {
            Some((0, _)) => [middle[0] - off, middle[1]],
            _ => [middle[0], middle[1] - off],
        }
    }

    /// The larger error of the stress across the boundary (theory, eq. 37a), with the moduli on the
    /// lower or left side and on the other \[-\]. A sloping boundary is taken to halve its cells.
    fn error(&self, moduli: [f64; 2]) -> f64 {
        let share = self.across.map_or(0.5, |(_, share)| share);
        let mean = share * moduli[0] + (1.0 - share) * moduli[1];
        let errors = moduli.map(|own| (own / mean - 1.0).abs());
        errors[0].max(errors[1])
    }

    fn warn_of_flow(&self, [a, b]: &[String; 2], report: Report<'_>) {
        let Report { place, problems } = report;
        let at = point(self.ends[0]);
        let text =
            format!("water flows by the mean of `{a}` and `{b}` in cells that both share at {at}");
        problems
            .warning(place, text)
            .help("fit = \"layers\" in [grid] puts lines of the grid on level boundaries");
    }

    fn warn(
        &self,
        names: &[String; 2],
        error: f64,
        (is_fitted, by_water): (bool, bool),
        problem: Report<'_>,
    ) {
        let Report { place, problems } = problem;
        let at = self.ends[0];
        let percent = short(100.0 * error);
        let between = format!("between `{}` and `{}`", names[0], names[1]);
        let Some((axis, _)) = self.across else {
            problems
                .warning(
                    place,
                    format!(
                        "the boundary {between} slopes through cells at {}",
                        point(at)
                    ),
                )
                .help(format!(
                    "where it halves a cell, the stress across it is {percent} % off at particles"
                ))
                .help(if by_water {
                    "water that does not leave makes soil stiff; finer cells narrow the band"
                } else {
                    "mixed_cells = \"mean\" in [grid] shares one stiffness in such cells; finer cells narrow the band"
                });
            return;
        };
        let key = ["x", "y"][axis];
        let at = number(at[axis]);
        problems
            .warning(
                place,
                format!("the boundary {between} at {key} = {at} m lies within cells"),
            )
            .help(format!(
                "particles beside it have a stress across it up to {percent} % off"
            ))
            .help(if axis == 1 && !is_fitted {
                "fit = \"layers\" in [grid] moves a line of the grid onto it".to_owned()
            } else {
                format!(
                    "lines = {{ {key} = [\"{at} m\"] }} in [grid] puts a line of the grid there"
                )
            });
    }
}

/// Where a warning goes.
struct Report<'a> {
    place: Option<Place>,
    problems: &'a mut Problems,
}

/// The least width of an outline across one of its slanting sides \[m\]; infinite without one.
fn width_across_slants(outline: &[[f64; 2]]) -> f64 {
    let sides = std::iter::zip(outline, outline.iter().cycle().skip(1));
    let widths = sides.filter_map(|(a, b)| {
        let side = [b[0] - a[0], b[1] - a[1]];
        let slants = side
            .iter()
            .all(|own| own.abs() > 1e-9 * side[0].hypot(side[1]));
        let off = |c: &[f64; 2]| (side[0] * (c[1] - a[1]) - side[1] * (c[0] - a[0])).abs();
        let farthest = outline.iter().map(off).fold(0.0, f64::max);
        slants.then(|| farthest / side[0].hypot(side[1]))
    });
    widths.fold(f64::INFINITY, f64::min)
}

/// Warns of bodies thinner than three cells, across a slope than four, that are alone, or softer or weaker than what they touch.
fn check_thickness(
    layers: &Layers<'_>,
    frame: &Frame<2>,
    bodies: &[&BodyPart<2>],
    neighbours: &[Neighbours],
    problems: &mut Problems,
) {
    for (index, body) in bodies.iter().enumerate() {
        let Neighbours {
            has_any,
            has_stiffer,
            has_same,
        } = neighbours[index];
        if has_same || has_any && !has_stiffer {
            continue;
        }
        let thinnest = [0, 1]
            .into_iter()
            .filter_map(|axis| {
                let [from, to] = largest_run(body.polygon(), axis);
                let spans = from <= frame.lower[axis] + layers.site.round_off
                    && to >= frame.upper[axis] - layers.site.round_off;
                let own = &frame.axes[axis];
                let is_single = own.cells() == 1;
                (!spans && !is_single).then(|| (own.place(to) - own.place(from), to - from))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let [width, height] = frame.axes.each_ref().map(|axis| axis.extremes()[0]);
        let across = width_across_slants(body.polygon());
        let slanting = (across / width.min(height), across);
        let (told, needed, (cells, thickness)) =
            match thinnest.filter(|(cells, _)| *cells < ENOUGH - 1e-6) {
                Some(thinnest) => ("where three are needed", ENOUGH, thinnest),
                None if slanting.0 < ENOUGH_ACROSS_SLOPES => (
                    "across its slope, where four are needed",
                    ENOUGH_ACROSS_SLOPES,
                    slanting,
                ),
                None => continue,
            };
        problems
            .warning(
                layers.own[index].as_ref().map(polygon_place),
                format!(
                    "body `{}` is {} cells thick, {told}",
                    clip(&body.name, 40),
                    short(cells)
                ),
            )
            .help("neither its bending nor sliding along it is resolved")
            .help(format!(
                "a zone in [grid] with cells of {} m, or smaller cells throughout",
                short(thickness / needed)
            ));
    }
}

/// Whether weight is raised on a geometry that moves and a factor of safety is looked for: it is then that of the shape
/// under weight. On the given geometry the shape is that of the file, whatever the stiffness.
fn searched_in_another_shape(stages: &[Option<Stage>]) -> bool {
    let stages = || stages.iter().flatten();
    let searches = |stage: &Stage| matches!(stage.kind, StageKind::StrengthReduction(_));
    let raises = |stage: &Stage| match &stage.kind {
        StageKind::Gravity { .. } | StageKind::Construction(_) => true,
        StageKind::StrengthReduction(own) => own.path == ReductionPath::Gravity,
        _ => false,
    };
    stages().any(searches)
        && stages().any(|stage| raises(stage) && stage.geometry == Geometry::Moving)
}

/// Warns of materials whose stiffness is out of proportion to the weight.
pub(crate) fn check_stiffness(
    layers: &Layers<'_>,
    stages: &[Option<Stage>],
    gravity: Option<f64>,
    problems: &mut Problems,
) {
    let (Some(bodies), Some(materials)) = (complete(layers.bodies), complete(layers.materials))
    else {
        return;
    };
    let kinds = || stages.iter().flatten().map(|stage| &stage.kind);
    let raises = kinds().any(|kind| {
        matches!(
            kind,
            StageKind::Gravity { .. } | StageKind::StrengthReduction(_)
        )
    });
    let changes_shape = searched_in_another_shape(stages);
    if !raises || gravity.is_none_or(|gravity| gravity <= 0.0) {
        return;
    }
    let ground = ground_of(&bodies, &materials);
    let levels = |body: &BodyPart<2>| {
        let (lower, upper) = bounding_box(body.polygon());
        [lower[1], upper[1]]
    };
    let top = bodies
        .iter()
        .map(|body| levels(body)[1])
        .fold(f64::MIN, f64::max);
    let stated = Root::<2>::materials(layers.tree).map_or_else(|_| Vec::new(), |own| own.value.0);
    for (index, material) in materials.iter().enumerate() {
        let own = bodies.iter().filter(|body| body.material == index);
        let Some(body) = own.min_by(|a, b| levels(a)[0].total_cmp(&levels(b)[0])) else {
            continue;
        };
        let lowest = levels(body)[0];
        let (lower, upper) = bounding_box(body.polygon());
        let middle = [0.5 * (lower[0] + upper[0]), 0.5 * (top + lowest)];
        let weight = material.unit_weight_at(&middle, &ground);
        let young = material.young_at(&middle, &ground);
        let ratio = weight * (top - lowest) / young;
        let own = stated.get(index).and_then(|own| own.value.as_ref().ok());
        let place = (own.and_then(|own| linear_stiffness(&own.form)))
            .and_then(|own| own.young.as_ref().ok())
            .map(|own| own.place);
        let name = clip(&material.name, 40);
        if ratio > SOFT && changes_shape && material.strength != Strength::Elastic {
            problems
                .warning(
                    place,
                    format!("`{name}` is soft: unit_weight * height / young = {}", short(ratio)),
                )
                .help(
                    "on a geometry that moves weight changes the shape of the ground, and the factor of safety is that of the new shape",
                )
                .help(format!(
                    "geometry = \"given\" in the stages that raise weight keeps the shape; so does young from {} kPa on",
                    short(1e-3 * young * ratio / SOFT)
                ));
        } else if ratio > 0.0 && ratio < STIFF {
            problems
                .warning(
                    place,
                    format!(
                        "`{name}` is stiff: unit_weight * height / young = {}",
                        short(ratio)
                    ),
                )
                .help("its strains are so small that round-off shows in the residual")
                .help(format!(
                    "young of {} kPa or less is stiff enough for any soil or rock",
                    short(1e-3 * young * ratio / STIFF)
                ));
        }
    }
}
