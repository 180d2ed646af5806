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

use super::gaps::{self, NARROW};
use crate::build::Thing;
use crate::build::bodies::polygon_place;
use crate::build::bodies::sequence::Sequence;
use crate::build::bodies::site::Site;
use crate::build::grid::Frame;
use igimp_geometry::outline::{facing, largest_run};

/// Error of the stress beside a boundary that is worth a warning \[-\].
const WORTH: f64 = 0.04;
/// Cells across a layer that resolve its strength.
const ENOUGH: f64 = 3.0;
/// The same across a slope, where its sides cut cells \[-\].
const ENOUGH_ACROSS_SLOPES: f64 = 4.0;
/// A body stiffer than its neighbours by this factor hardly yields with them \[-\].
const FAR_STIFFER: f64 = 50.0;
/// γH/E beyond which the ground has another shape when its weight acts \[-\].
const SOFT: f64 = 0.05;
/// γH/E beyond which displacements are a share of the height, whatever the geometry \[-\].
const SINKS: f64 = 0.3;
/// γH/E below which round-off shows in the strains \[-\].
const STIFF: f64 = 1e-6;

/// Data of the warnings.
pub(crate) struct Layers<'a> {
    /// The file.
    pub(crate) tree: &'a Node,
    /// Its bodies as they are stated.
    pub(crate) stated: &'a [Thing<Body>],
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
    let there = (&bodies[..], layers.site, layers.sequence);
    gaps::check(layers.stated, frame, there, problems);
    let neighbours = check_pairs(layers, frame, (&bodies, &materials, &ground), problems);
    check_thickness(layers, frame, &bodies, &neighbours, problems);
}

fn complete<T>(parts: &[Option<T>]) -> Option<Vec<&T>> {
    parts.iter().map(Option::as_ref).collect()
}

/// The ground of bodies and materials.
fn ground_of<'a, const D: usize>(
    bodies: &[&'a BodyPart<D>],
    materials: &[&'a Material],
) -> Ground<D> {
    Ground::new(bodies.iter().map(|body| (*body, materials[body.material])))
}

/// The modulus of compression without lateral strain at a place, with the water that does not leave.
fn constrained(material: &Material, place: [f64; 2], ground: &Ground<2>) -> f64 {
    let nu = material.at(&place, ground).poisson;
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
fn is_stronger(soil: &Strength, other: &Strength) -> bool {
    let parameters = |of: &Strength| [of.cohesive(), of.friction_angle()].map(|p| p.unwrap_or(0.0));
    match (soil, other) {
        (Strength::Elastic, other) => *other != Strength::Elastic,
        (_, Strength::Elastic) => false,
        _ => {
            let [mine, its] = [soil, other].map(parameters);
            let pairs = || std::iter::zip(mine, its);
            pairs().any(|(mine, its)| mine > its) && pairs().all(|(mine, its)| mine >= its)
        }
    }
}

/// Boundaries within cells; tells which bodies touch a stiffer one, or one of their own
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
    let fit = (grid.as_ref()).and_then(|grid| Some(**grid.wishes.as_ref().ok()?.fit.as_ref()?));
    let is_fitted = matches!(fit, Some(Fit::Layers | Fit::All));
    let is_shared = (grid.iter()).any(|grid| {
        grid.mixed_cells
            .as_ref()
            .is_ok_and(|mixed| **mixed == MixedCells::Mean)
    });
    let mut neighbours = vec![Neighbours::default(); bodies.len()];
    for (second, b) in bodies.iter().enumerate() {
        for (first, a) in bodies[..second].iter().enumerate() {
            if !layers.sequence.are_together(first, second) {
                continue;
            }
            let pieces = facing(a.polygon(), b.polygon(), narrow);
            let place = layers.stated[second].as_ref().map(polygon_place);
            let names = [&a.name, &b.name].map(|name| clip(name, 40));
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
            let by_water = soils.iter().any(|soil| holds_water(soil));
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

/// Whether water flows through two soils as they consolidate, and through one much faster.
fn unlike_for_water(soils: [&Material; 2]) -> bool {
    let flows = |soil: &Material| matches!(soil.drainage, Drainage::Undrained { flows: true, .. });
    let [a, b] = soils.map(|soil| soil.permeability.filter(|_| flows(soil)));
    let fast = |soil: Soil| soil.along.max(soil.across);
    let ratio = |(a, b)| (fast(a) / fast(b)).ln().abs();
    a.zip(b).is_some_and(|pair| ratio(pair) > UNLIKE.ln())
}

/// Permeabilities that differ by this factor in a cell are reported \[-\].
const UNLIKE: f64 = 3.0;

/// Neighbours of a body.
#[derive(Clone, Copy, Debug, Default)]
struct Neighbours {
    has_any: bool,
    has_stiffer: bool,
    has_same: bool,
    /// Bodies of soil that yields, and is far softer than itself.
    far_softer: usize,
}

impl Neighbours {
    /// Takes a neighbour in: of soils and moduli the own one first.
    fn sees(&mut self, [soil, other]: [&Material; 2], [mine, its]: [f64; 2]) {
        self.has_any = true;
        self.has_stiffer |= its > mine || is_stronger(&other.strength, &soil.strength);
        self.has_same |= std::ptr::eq(soil, other);
        let never_yields = soil.strength == Strength::Elastic || mine > FAR_STIFFER * its;
        let is_soil = other.strength != Strength::Elastic;
        self.far_softer += usize::from(never_yields && mine > its && is_soil);
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
        let errors = moduli.map(|modulus| (modulus / mean - 1.0).abs());
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
        let slants = side.iter().all(|x| x.abs() > 1e-9 * side[0].hypot(side[1]));
        let off = |c: &[f64; 2]| (side[0] * (c[1] - a[1]) - side[1] * (c[0] - a[0])).abs();
        let farthest = outline.iter().map(off).fold(0.0, f64::max);
        slants.then(|| farthest / side[0].hypot(side[1]))
    });
    widths.fold(f64::INFINITY, f64::min)
}

/// The thinnest run of a body along an axis that does not span the grid: in cells, the axis, and its ends \[m\].
fn thinnest(site: &Site, frame: &Frame<2>, outline: &[[f64; 2]]) -> Option<(f64, usize, [f64; 2])> {
    let runs = [0, 1].into_iter().filter_map(|axis| {
        let [from, to] = largest_run(outline, axis);
        let spans =
            from <= frame.lower[axis] + site.round_off && to >= frame.upper[axis] - site.round_off;
        let along = &frame.axes[axis];
        let is_single = along.cells() == 1;
        (!spans && !is_single).then(|| (along.place(to) - along.place(from), axis, [from, to]))
    });
    runs.min_by(|a, b| a.0.total_cmp(&b.0))
}

/// Warns of bodies thinner than three cells, across a slope than four, that are alone, or softer or weaker than the soil that
/// they touch; and of upright ones with soil on both sides that never yield.
fn check_thickness(
    layers: &Layers<'_>,
    frame: &Frame<2>,
    bodies: &[&BodyPart<2>],
    neighbours: &[Neighbours],
    problems: &mut Problems,
) {
    for (index, body) in bodies.iter().enumerate() {
        let beside = &neighbours[index];
        let thin = thinnest(layers.site, frame, body.polygon());
        let thin = thin.filter(|(cells, ..)| *cells < ENOUGH - 1e-6);
        let place = layers.stated[index].as_ref().map(polygon_place);
        let name = clip(&body.name, 40);
        if let Some((cells, 0, ends)) = thin
            && beside.far_softer > 0
            && !beside.has_stiffer
            && is_between_soil(layers, index, ends)
        {
            warn_of_wall(&name, cells, Report { place, problems });
            continue;
        }
        if beside.has_same || beside.has_any && !beside.has_stiffer {
            continue;
        }
        let [width, height] = frame.axes.each_ref().map(|axis| axis.extremes()[0]);
        let across = width_across_slants(body.polygon());
        let slanting = (across / width.min(height), across);
        let (remark, needed, (cells, thickness)) = match thin {
            Some((cells, _, [from, to])) => ("where three are needed", ENOUGH, (cells, to - from)),
            None if slanting.0 < ENOUGH_ACROSS_SLOPES => (
                "across its slope, where four are needed",
                ENOUGH_ACROSS_SLOPES,
                slanting,
            ),
            None => continue,
        };
        problems
            .warning(
                place,
                format!("body `{name}` is {} cells thick, {remark}", short(cells)),
            )
            .help("neither its bending nor sliding along it is resolved")
            .help(format!(
                "a zone in [grid] with cells of {} m, or smaller cells throughout",
                short(thickness / needed)
            ));
    }
}

/// Whether soil lies on the left and on the right of a body, somewhere along its height.
fn is_between_soil(layers: &Layers<'_>, body: usize, [from, to]: [f64; 2]) -> bool {
    let (lower, upper) = bounding_box(&layers.site.polygons[body]);
    let off = 1e-3 * (to - from);
    [from - off, to + off].iter().all(|&x| {
        (0..8).any(|k| {
            let y = lower[1] + (f64::from(k) + 0.5) / 8.0 * (upper[1] - lower[1]);
            layers.site.is_inside(None, [x, y])
        })
    })
}

fn warn_of_wall(name: &str, cells: f64, report: Report<'_>) {
    let Report { place, problems } = report;
    let thick = match short(cells).as_str() {
        "1" => "1 cell".to_owned(),
        other => format!("{other} cells"),
    };
    problems
        .warning(
            place,
            format!("body `{name}` is {thick} thick with soil on both sides, and hardly yields"),
        )
        .help("soil sticks to it in the cells that both share: nothing slides along it, its bending is not resolved, and a factor of safety is too high")
        .help("a wall that soil slides along is a [[rigid]] body; one that bends has three cells across it, and a body of weaker soil along each face");
}

/// Whether weight is raised on a geometry that moves and a factor of safety is looked for: it is then that of the shape
/// under weight. On the given geometry the shape is that of the file, whatever the stiffness.
fn searched_in_another_shape(stages: &[Option<Stage>]) -> bool {
    let stages = || stages.iter().flatten();
    let searches = |stage: &Stage| matches!(stage.kind, StageKind::StrengthReduction(_));
    let raises = |stage: &Stage| match &stage.kind {
        StageKind::Gravity { .. } | StageKind::Construction(_) => true,
        StageKind::StrengthReduction(search) => search.path == ReductionPath::Gravity,
        _ => false,
    };
    stages().any(searches)
        && stages().any(|stage| raises(stage) && stage.geometry == Geometry::Moving)
}

/// Whether weight is raised on the given geometry, where displacements are those of small strain.
fn raises_on_given(stages: &[Option<Stage>]) -> bool {
    stages.iter().flatten().any(|stage| {
        matches!(stage.kind, StageKind::Gravity { .. }) && stage.geometry == Geometry::Given
    })
}

/// Warns of materials whose stiffness is out of proportion to the weight.
pub(crate) fn check_stiffness<const D: usize>(
    (tree, bodies, materials): (&Node, &[Option<BodyPart<D>>], &[Option<Material>]),
    stages: &[Option<Stage>],
    gravity: Option<f64>,
    problems: &mut Problems,
) {
    let (Some(bodies), Some(materials)) = (complete(bodies), complete(materials)) else {
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
    let levels = |body: &BodyPart<D>| {
        let (lower, upper) = body.region.bounds();
        [lower[D - 1], upper[D - 1]]
    };
    let top = bodies
        .iter()
        .map(|body| levels(body)[1])
        .fold(f64::MIN, f64::max);
    let stated = Root::<D>::materials(tree).map_or_else(|_| Vec::new(), |list| list.value.0);
    for (index, material) in materials.iter().enumerate() {
        let filled = bodies.iter().filter(|body| body.material == index);
        let Some(body) = filled.min_by(|a, b| levels(a)[0].total_cmp(&levels(b)[0])) else {
            continue;
        };
        let lowest = levels(body)[0];
        let (lower, upper) = body.region.bounds();
        let mut middle: [f64; D] = std::array::from_fn(|axis| 0.5 * (lower[axis] + upper[axis]));
        middle[D - 1] = 0.5 * (top + lowest);
        let weight = material.unit_weight_at(&middle, &ground);
        let young = material.young_at(&middle, &ground);
        let ratio = weight * (top - lowest) / young;
        let table = stated.get(index).and_then(|item| item.value.as_ref().ok());
        let place = (table.and_then(|table| table.form.stiffness()))
            .and_then(|keys| keys.young.as_ref().ok())
            .map(|at| at.place);
        let shape = [changes_shape, raises_on_given(stages)]
            .map(|counts| counts && material.strength != Strength::Elastic);
        let report = Report { place, problems };
        warn_of_stiffness(material, (young, ratio, top - lowest), shape, report);
    }
}

/// Warns of a Young's modulus \[Pa\] by its ratio γH/E and the height \[m\], where weight changes the shape, and where it acts on the
/// given one.
fn warn_of_stiffness(
    material: &Material,
    (young, ratio, height): (f64, f64, f64),
    [changes_shape, is_given]: [bool; 2],
    Report { place, problems }: Report<'_>,
) {
    let name = clip(&material.name, 40);
    let kpa_at = |bound: f64| short(1e-3 * young * ratio / bound);
    let message = |kind: &str| {
        let ratio = short(ratio);
        format!("`{name}` is {kind}: unit_weight * height / young = {ratio}")
    };
    if ratio > SOFT && changes_shape {
        problems
            .warning(place, message("soft"))
            .help(
                "on a geometry that moves weight changes the shape of the ground, and the factor of safety is that of the new shape",
            )
            .help(format!(
                "geometry = \"given\" in the stages that raise weight keeps the shape; so does young from {} kPa on",
                kpa_at(SOFT)
            ));
    } else if ratio > SINKS && is_given {
        problems
            .warning(place, message("soft"))
            .help(format!(
                "on the given geometry weight sinks it by some {} m, and displacements are those of small strain; the factor of safety does not follow it",
                short(0.5 * ratio * height)
            ))
            .help(format!(
                "soil has a young of 1 MPa or more; from {} kPa on the ratio is below {SINKS}",
                kpa_at(SINKS)
            ));
    } else if ratio > 0.0 && ratio < STIFF {
        problems
            .warning(place, message("stiff"))
            .help("its strains are so small that round-off shows in the residual")
            .help(format!(
                "young of {} kPa or less is stiff enough for any soil or rock",
                kpa_at(STIFF)
            ));
    }
}
