//! The grid and the variant of the method.

pub(crate) mod axisymmetric;
pub(crate) mod boundaries;

use std::sync::Arc;

use igimp_assembly::{
    CutVolume, DomainUpdate, Geometry, Kinematics, Locking, Method, Remedy, Section, SmallCuts,
};
use igimp_model::fitted::{Asked, Outlines};
use igimp_model::lines::{WantedLines, Zone, largest_jump};
use igimp_model::{AxisSpec, BodyPart, GridSpec, MixedCells, RigidShape};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::grid::{self as keys, Fit};
use igimp_schema::schema::stages::{Geometry as GeometryKey, StageForm};
use igimp_schema::source::Place;
use igimp_schema::text::{count, number};
use igimp_schema::tree::Node;
use igimp_schema::tree::read::{At, Either};
use igimp_shape::{Basis, Gimp, Linear};
use igimp_text::short;

/// Most cells, and most particles.
pub(super) const MOST: f64 = 5e7;
/// Most lines in a direction that has them at places of its own.
const MOST_LINES: f64 = 2e4;
/// Least ratio of neighbouring cells that can be asked for \[-\].
const LEAST_GROWTH: f64 = 1.05;
/// Ratio of neighbouring cells beyond which a warning is given \[-\].
const MOST_JUMP: f64 = 2.0;
/// The keys of the directions.
const DIRECTIONS: [&str; 3] = ["x", "y", "z"];

/// Extent of the grid and its axes, for checks of bodies and loads \[m\].
#[derive(Clone, Debug)]
pub(super) struct Frame<const D: usize> {
    /// Corner of the lowest coordinates.
    pub(super) lower: [f64; D],
    /// Corner of the highest coordinates.
    pub(super) upper: [f64; D],
    /// The axes; equal cells as written as long as the grid is not known.
    pub(super) axes: [AxisSpec; D],
}

/// Places this near to a line lie on it, as a share of the cell \[-\].
const ON_LINE: f64 = 1e-2;

impl<const D: usize> Frame<D> {
    /// Whether a place on an axis lies within the grid and between its lines.
    pub(crate) fn is_off_lines(&self, axis: usize, at: f64) -> bool {
        let place = self.axes[axis].place(at);
        self.lower[axis] < at && at < self.upper[axis] && (place - place.round()).abs() > ON_LINE
    }
}

/// The values of a table by axis.
fn by_axis<'a, T, const D: usize>(
    [x, y]: [&'a At<T>; 2],
    z: Option<&'a At<T>>,
) -> Option<[&'a At<T>; D]> {
    let all: Vec<&At<T>> = [x, y].into_iter().chain(z).take(D).collect();
    all.try_into().ok()
}

/// Where the size of a cell is said.
pub(super) fn cell_place(tree: &Node) -> Option<Place> {
    let grid = Root::<2>::grid(tree).ok()?;
    Some(grid.extent.as_ref().ok()?.cell.place)
}

/// The frame, if its numbers make sense.
pub(super) fn frame<const D: usize>(
    extent: &keys::Extent,
    problems: &mut Problems,
) -> Option<Frame<D>> {
    let cell = match &*extent.cell {
        Either::First(one) => [*one; D],
        Either::Second(size) => by_axis([&size.x, &size.y], size.z.as_ref())?.map(|s| **s),
    };
    let domain: [_; D] = by_axis(
        [&extent.domain.x, &extent.domain.y],
        extent.domain.z.as_ref(),
    )?;
    let (mut lower, mut upper) = ([0.0; D], [0.0; D]);
    let mut is_right = true;
    for (axis, ends) in domain.into_iter().enumerate() {
        let [from, to] = **ends;
        (lower[axis], upper[axis]) = (from, to);
        if from >= to || !(to - from).is_finite() {
            let key = DIRECTIONS[axis];
            problems
                .error(ends.place, format!("the domain in {key} has no extent"))
                .help("write the lower end first");
            is_right = false;
        }
    }
    let axes = std::array::from_fn(|axis| AxisSpec::Equal {
        lower: lower[axis],
        cell: cell[axis],
        cells: ((upper[axis] - lower[axis]) / cell[axis]).round().max(1.0) as usize,
    });
    is_right.then_some(Frame { lower, upper, axes })
}

/// The grid; reports a domain that is not a whole number of cells, lines off the domain, and too
/// many cells.
pub(super) fn grid<const D: usize>(
    grid: &keys::Grid,
    frame: Option<&Frame<D>>,
    (bodies, rigid): (&[Option<BodyPart<D>>], &[RigidShape]),
    problems: &mut Problems,
) -> Option<GridSpec<D>> {
    let table = grid.extent.as_ref().ok()?;
    let Frame { lower, upper, axes } = frame?;
    let cell: [f64; D] = std::array::from_fn(|axis| axes[axis].cell_at(lower[axis]));
    let extent: [f64; D] = std::array::from_fn(|axis| upper[axis] - lower[axis]);
    let total: f64 = (0..D)
        .map(|axis| (extent[axis] / cell[axis]).max(1.0))
        .product();
    if total.is_nan() || total > MOST {
        too_many(table.cell.place, &count(total), problems);
        return None;
    }
    let wishes = grid.wishes.as_ref().ok()?;
    let fit = **wishes.fit.as_ref()?;
    let soil: Vec<_> = (bodies.iter().flatten().map(|body| body.region.polygon())).collect();
    let outlines = Outlines {
        soil: &soil,
        rigid: if matches!(fit, Fit::Bodies | Fit::All) {
            rigid
        } else {
            &[]
        },
        layers: matches!(fit, Fit::Layers | Fit::All),
        round_off: 1e-9 * extent[D - 1].max(upper[D - 1].abs()),
    };
    let domain = &table.domain;
    let domain: [_; D] = by_axis([&domain.x, &domain.y], domain.z.as_ref())?;
    let lines: [_; D] = by_axis([&wishes.lines.x, &wishes.lines.y], wishes.lines.z.as_ref())?;
    let zones: [_; D] = by_axis([&wishes.zones.x, &wishes.zones.y], wishes.zones.z.as_ref())?;
    let found: [Option<AxisSpec>; D] = std::array::from_fn(|axis| {
        let key = DIRECTIONS[axis];
        if cell[axis] < 1e-9 * lower[axis].abs().max(upper[axis].abs()) {
            problems
                .error(
                    domain[axis].place,
                    format!("the coordinates in {key} are too large for cells this small"),
                )
                .help("move the origin to the model");
            return None;
        }
        let ends = [lower[axis], upper[axis]];
        let asked = match axis {
            0 => outlines.upright(&axes[0]),
            axis if axis == D - 1 => outlines.level(&axes[axis]),
            _ => Asked::default(),
        };
        let about = Direction {
            key,
            ends,
            domain: domain[axis].place,
            cell: cell[axis],
            cell_place: table.cell.place,
            growth: &wishes.growth,
        };
        match wish(&about, (lines[axis], zones[axis]), asked, problems)? {
            Some(wish) => with_lines(&about, &wish, problems),
            None => equal_cells(&about, problems),
        }
    });
    let axes: Option<Vec<AxisSpec>> = found.into_iter().collect();
    let spec = GridSpec {
        axes: axes?.try_into().ok()?,
        mixed_cells: match **grid.mixed_cells.as_ref().ok()? {
            keys::MixedCells::Mean => MixedCells::Mean,
            keys::MixedCells::Own => MixedCells::Own,
        },
    };
    let total: f64 = spec.cells().iter().map(|&cells| cells as f64).product();
    if total > MOST {
        too_many(table.cell.place, &count(total), problems);
        return None;
    }
    Some(spec)
}

fn too_many(at: Place, cells: &str, problems: &mut Problems) {
    problems
        .error(at, format!("the grid would have {cells} cells"))
        .help(format!(
            "at most {} are possible: use larger cells or a smaller domain",
            count(MOST)
        ));
}

/// An axis of equal cells that fill the domain.
fn equal_cells(about: &Direction<'_>, problems: &mut Problems) -> Option<AxisSpec> {
    let Direction {
        key,
        ends: [lower, upper],
        cell,
        ..
    } = *about;
    let extent = upper - lower;
    let cells = extent / cell;
    let whole = cells.round().max(1.0);
    if (cells - whole).abs() > 1e-6 {
        let end = number(lower + whole * cell);
        let size = number(extent / whole);
        problems
            .error(
                about.domain,
                format!(
                    "the domain in {key} is not a whole number of cells: {} m / {} m = {}",
                    number(extent),
                    number(cell),
                    number(cells)
                ),
            )
            .help(format!(
                "the nearest that is: {key} = [\"{} m\", \"{end} m\"], or a cell of {size} m",
                number(lower)
            ));
        return None;
    }
    Some(AxisSpec::Equal {
        lower,
        // The cell that fits, to the last digit.
        cell: extent / whole,
        cells: whole as usize,
    })
}

/// An axis with lines where they are wanted; warns of neighbouring cells that differ too much.
fn with_lines(
    about: &Direction<'_>,
    wish: &WantedLines,
    problems: &mut Problems,
) -> Option<AxisSpec> {
    let key = about.key;
    let Some(axis) = wish.axis(MOST_LINES) else {
        problems
            .error(
                about.cell_place,
                format!(
                    "the grid would have more than {} lines in {key}",
                    count(MOST_LINES)
                ),
            )
            .help("use larger cells, or shorter zones");
        return None;
    };
    let (jump, at) = largest_jump(&axis);
    if jump > MOST_JUMP + 1e-9 {
        problems
            .warning(
                about.growth.place,
                format!(
                    "neighbouring cells at {key} = {} m differ by a factor of {}",
                    number(at),
                    short(jump)
                ),
            )
            .help(format!(
                "neighbours should not differ by more than {MOST_JUMP}: \
                 move lines or zones, or let cells grow more slowly"
            ));
    }
    Some(axis)
}

/// A direction of the grid.
struct Direction<'a> {
    key: &'static str,
    /// Where it begins and ends \[m\].
    ends: [f64; 2],
    /// Where that is said.
    domain: Place,
    /// Size of a cell \[m\].
    cell: f64,
    /// Where that is said.
    cell_place: Place,
    growth: &'a At<f64>,
}

/// Lines wanted of an axis beyond equal cells; none within: nothing. None: something is wrong.
#[allow(
    clippy::option_option,
    reason = "wrong, nothing and something are three answers"
)]
fn wish(
    about: &Direction<'_>,
    (wanted, stretches): (&[At<f64>], &[At<keys::Zone>]),
    asked: Asked,
    problems: &mut Problems,
) -> Option<Option<WantedLines>> {
    let Direction {
        key, ends, cell, ..
    } = *about;
    let growth = **about.growth;
    let mut is_right = true;
    if !(LEAST_GROWTH..=MOST_JUMP).contains(&growth) {
        let message = format!("`growth` must be from {LEAST_GROWTH} to {MOST_JUMP}");
        problems
            .error(about.growth.place, message)
            .help("1.3 is usual");
        is_right = false;
    }
    let round_off = 1e-9 * ends[0].abs().max(ends[1].abs());
    let is_inside = |x: f64| ends[0] - round_off <= x && x <= ends[1] + round_off;
    let mut lines = Vec::new();
    for line in wanted {
        let x = **line;
        if is_inside(x) {
            lines.push(x);
        } else {
            problems
                .error(
                    line.place,
                    format!(
                        "this line at {key} = {} m is off the grid domain",
                        number(x)
                    ),
                )
                .help("extend [grid] domain, or leave the line out");
            is_right = false;
        }
    }
    let mut zones = Vec::new();
    for zone in stretches {
        let built = Zone {
            ends: [*zone.from, *zone.to],
            cell: *zone.cell,
        };
        let wrong = wrong_zone(zone, built.ends.into_iter().all(is_inside), cell, round_off);
        if let Some((at, message, help)) = wrong {
            problems.error(at, message).help(help);
            is_right = false;
        } else {
            zones.push(built);
        }
    }
    let mut levels = asked.on_lines;
    levels.retain(|&x| is_inside(x));
    let is_inside = |x: &f64| ends[0] < *x && *x < ends[1];
    let is_equal = lines.is_empty()
        && zones.is_empty()
        && levels.is_empty()
        && !asked.mid_cell.iter().flatten().any(is_inside);
    is_right.then(|| {
        (!is_equal).then_some(WantedLines {
            ends,
            cell,
            lines,
            levels,
            mid_cell: asked.mid_cell,
            zones,
            growth,
        })
    })
}

/// The fault of a zone of finer cells: place, message and remedy.
fn wrong_zone(
    zone: &keys::Zone,
    is_inside: bool,
    coarse: f64,
    round_off: f64,
) -> Option<(Place, &'static str, &'static str)> {
    if *zone.from >= *zone.to {
        Some((
            zone.from.place,
            "this zone has no extent",
            "write the lower end first",
        ))
    } else if !is_inside {
        Some((
            zone.from.place,
            "this zone reaches off the grid domain",
            "extend [grid] domain",
        ))
    } else if *zone.cell >= coarse {
        Some((
            zone.cell.place,
            "the cells of this zone are no finer than those of the grid",
            "write the size of the coarse cells as `cell` of the grid",
        ))
    } else if *zone.cell < round_off {
        Some((
            zone.cell.place,
            "the coordinates are too large for cells this small",
            "move the origin to the model",
        ))
    } else {
        None
    }
}

/// The variant of the method.
pub(super) fn method(table: &keys::Method) -> Option<Method> {
    let cuts = &table.small_cuts;
    let basis: Arc<dyn Basis> = match *table.basis {
        keys::Basis::Linear => Arc::new(Linear),
        keys::Basis::Gimp => Arc::new(Gimp),
    };
    Some(Method {
        section: Section::PlaneStrain,
        basis,
        locking: match *table.locking {
            keys::Locking::None => Locking::None,
            keys::Locking::BBar => Locking::BBar,
            keys::Locking::SharedStrain => Locking::SharedStrain,
        },
        geometry: Geometry::Moving,
        kinematics: match *table.kinematics {
            keys::Kinematics::Small => Kinematics::SmallStrain,
            keys::Kinematics::Finite => Kinematics::FiniteStrain,
        },
        domain_update: match **table.domain_update.as_ref()? {
            keys::DomainUpdate::Fixed => DomainUpdate::Fixed,
            keys::DomainUpdate::DiagonalF => DomainUpdate::DiagonalF,
            keys::DomainUpdate::Stretch => DomainUpdate::DiagonalU,
            keys::DomainUpdate::RootJ => DomainUpdate::RootJ,
            keys::DomainUpdate::Moments => DomainUpdate::Moments,
            keys::DomainUpdate::ScaledMoments => DomainUpdate::ScaledMoments,
        },
        small_cuts: SmallCuts {
            below: **cuts.below.as_ref()?,
            of: CutVolume::Cell,
            remedy: match **cuts.remedy.as_ref()? {
                keys::Remedy::Drop => Remedy::Drop,
                keys::Remedy::Tie => Remedy::Tie,
                keys::Remedy::Extrapolate => Remedy::Extrapolate,
            },
            ghost_penalty: *cuts.ghost_penalty,
        },
    })
}
/// The geometry that the steps of a stage are computed on; types without the key move the particles.
pub(super) fn geometry_of(form: &StageForm) -> Geometry {
    let stated = match form {
        StageForm::Gravity(Ok(table)) => table.geometry.as_ref(),
        StageForm::Load(Ok(table)) => table.geometry.as_ref().ok(),
        StageForm::Displacement(Ok(table)) => table.geometry.as_ref().ok(),
        StageForm::Rigid(Ok(table)) => table.geometry.as_ref().ok(),
        StageForm::Construction(Ok(table)) => table.geometry.as_ref().ok(),
        StageForm::Wait(Ok(table)) => table.geometry.as_ref().ok(),
        StageForm::StrengthReduction(Ok(table)) => Some(&table.geometry),
        StageForm::Dynamic(Ok(table)) => table.geometry.as_ref().ok(),
        _ => None,
    };
    match stated.map(|key| **key) {
        Some(GeometryKey::Given) => Geometry::Given,
        Some(GeometryKey::Moving) | None => Geometry::Moving,
    }
}
