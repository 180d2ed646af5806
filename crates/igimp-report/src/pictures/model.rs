//! The set-up of a model: materials, grid, rigid bodies, reinforcement, supports, loads, sections and monitors.

use std::path::Path;

use igimp_figures::{FieldPlot, KeyEntry, KeySample, Outline, OutlineStyle};
use igimp_geometry::polygon::bounding_box;
use igimp_model::{AxisSpec, Case, GridSpec, LoadKind, PoreSource, Side, table_level};
use igimp_results::summary::FigureNote;
use igimp_text::short;

use super::rigid::{POINTS_OF_CIRCLE, block};
use super::write;
use crate::error::ReportError;

/// More cells than this in a direction make grey of the grid lines.
const MOST_LINES: usize = 160;
/// Share of the larger side of the model that the longest arrows take.
const ARROW: f64 = 0.075;
/// Share of the larger side that is left free around the model.
const AIR: f64 = 0.035;

/// The picture of the model as it is set up.
///
/// # Errors
/// [`ResultsError::File`](igimp_results::ResultsError::File) and [`ReportError::Figure`].
pub fn model_picture(folder: &Path, case: &Case<2>) -> Result<FigureNote, ReportError> {
    let plot = plot(case);
    let grid = &case.grid;
    let lines = if has_lines(grid) { "" } else { " (not drawn)" };
    let [columns, rows] = grid.cells();
    let [width, height] = grid.axes.each_ref().map(sizes);
    let rigid = if case.rigid.is_empty() {
        ""
    } else {
        "rigid bodies where they start, "
    };
    let is_table = |source: &PoreSource| matches!(source, PoreSource::Table(_));
    let water = if case.water.iter().any(|water| is_table(&water.source)) {
        "water tables, "
    } else {
        ""
    };
    let caption = format!(
        "The model: {columns} × {rows} cells of {width} × {height}{lines}, bodies by material, {rigid}{water}supports and loads.",
    );
    write(folder, "model", &plot.draw()?, caption)
}

fn plot(case: &Case<2>) -> FieldPlot {
    let mut plot = FieldPlot {
        title: case.title.clone(),
        domains: case
            .bodies
            .iter()
            .map(|body| body.polygon().to_vec())
            .collect(),
        values: case
            .bodies
            .iter()
            .map(|body| body.material as f64)
            .collect(),
        ..FieldPlot::default()
    };
    for (index, material) in case.materials.iter().enumerate() {
        plot.key.push(KeyEntry {
            sample: KeySample::Value(index),
            label: material.name.clone(),
        });
    }
    let size = model_size(case);
    if has_lines(&case.grid) {
        plot.outlines.extend(grid_lines(&case.grid));
    }
    plot.outlines.extend(bodies(case));
    add_water(&mut plot, case);
    add_rigid_bodies(&mut plot, case);
    for part in &case.reinforcement {
        plot.outlines.push(Outline {
            points: part.line.clone(),
            style: OutlineStyle::Member,
        });
        plot.labels.push((part.line[0], part.name.clone()));
    }
    add_supports(&mut plot, case);
    let reach = add_loads(&mut plot, case, ARROW * size);
    for section in &case.sections {
        plot.outlines.push(Outline {
            points: vec![section.from, section.to],
            style: OutlineStyle::Section,
        });
        plot.labels.push((section.to, section.name.clone()));
    }
    for monitor in &case.monitors {
        plot.outlines.push(Outline {
            points: vec![monitor.point],
            style: OutlineStyle::Point,
        });
        plot.labels.push((monitor.point, monitor.name.clone()));
    }
    let (lower, upper) = (case.grid.lower(), case.grid.upper());
    let range = |axis: usize| {
        let low = reach.iter().map(|p| p[axis]).fold(lower[axis], f64::min);
        let high = reach.iter().map(|p| p[axis]).fold(upper[axis], f64::max);
        Some((low - AIR * size, high + AIR * size))
    };
    (plot.x_range, plot.y_range) = (range(0), range(1));
    add_symbols_to_key(&mut plot, !case.rigid.is_empty());
    plot
}

/// The larger side of grid and bodies.
fn model_size(case: &Case<2>) -> f64 {
    let corners: Vec<[f64; 2]> = case
        .bodies
        .iter()
        .flat_map(|b| b.polygon().to_vec())
        .collect();
    let (lower, upper) = bounding_box(&corners);
    let (from, to) = (case.grid.lower(), case.grid.upper());
    let side = |axis: usize| upper[axis].max(to[axis]) - lower[axis].min(from[axis]);
    side(0).max(side(1))
}

/// The size of cells, or the range of it.
fn sizes(axis: &AxisSpec) -> String {
    let [smallest, largest] = axis.extremes();
    match axis {
        AxisSpec::Equal { cell, .. } => format!("{} m", short(*cell)),
        AxisSpec::Lines(_) => format!("{} to {} m", short(smallest), short(largest)),
    }
}

fn has_lines(grid: &GridSpec<2>) -> bool {
    grid.cells().iter().all(|&cells| cells <= MOST_LINES)
}

fn grid_lines(grid: &GridSpec<2>) -> impl Iterator<Item = Outline> {
    let (lower, upper) = (grid.lower(), grid.upper());
    let line = move |axis: usize, at: f64| {
        let (mut from, mut to) = (lower, upper);
        (from[axis], to[axis]) = (at, at);
        Outline {
            points: vec![from, to],
            style: OutlineStyle::Grid,
        }
    };
    (0..2).flat_map(move |axis| grid.axes[axis].lines().map(move |at| line(axis, at)))
}

/// Bodies, those that stages place dashed.
fn bodies(case: &Case<2>) -> impl Iterator<Item = Outline> {
    let (first, later): (Vec<_>, Vec<_>) =
        std::iter::zip(super::field::body_outlines(case), &case.bodies)
            .partition(|(_, body)| body.from_start);
    let dashed = later.into_iter().map(|(outline, _)| Outline {
        style: OutlineStyle::Former,
        ..outline
    });
    // Firm lines over dashed ones where they meet.
    dashed.chain(first.into_iter().map(|(outline, _)| outline))
}

/// The tables of the conditions of the water, with their names.
fn add_water(plot: &mut FieldPlot, case: &Case<2>) {
    let ([left, _], [right, _]) = (case.grid.lower(), case.grid.upper());
    for condition in &case.water {
        let PoreSource::Table(table) = &condition.source else {
            continue;
        };
        let inside = table.iter().filter(|at| left < at[0] && at[0] < right);
        let end = |x: f64| [x, table_level(table, x)];
        let mut points = vec![end(left)];
        points.extend(inside.copied());
        points.push(end(right));
        plot.labels.push((points[0], condition.name.clone()));
        plot.outlines.push(Outline {
            points,
            style: OutlineStyle::Water,
        });
    }
}

/// Rigid bodies where they start, with their names.
fn add_rigid_bodies(plot: &mut FieldPlot, case: &Case<2>) {
    for part in &case.rigid {
        if let Some(outline) = block(case, &part.outline(POINTS_OF_CIRCLE)) {
            let (lower, upper) = bounding_box(&outline.points);
            let middle = [0, 1].map(|axis| 0.5 * (lower[axis] + upper[axis]));
            plot.labels.push((middle, part.name.clone()));
            plot.outlines.push(outline);
        }
    }
}

/// Sides counter-clockwise, so that their symbols stand outside; boxes clockwise, symbols within.
fn add_supports(plot: &mut FieldPlot, case: &Case<2>) {
    let ([left, bottom], [right, top]) = (case.grid.lower(), case.grid.upper());
    let sides = &case.boundaries.sides;
    let lines = [
        (sides[1][0], [left, bottom], [right, bottom]),
        (sides[0][1], [right, bottom], [right, top]),
        (sides[1][1], [right, top], [left, top]),
        (sides[0][0], [left, top], [left, bottom]),
    ];
    for (side, from, to) in lines {
        let style = match side {
            Side::Free => continue,
            Side::Roller => OutlineStyle::Roller,
            Side::Fixed => OutlineStyle::Fixed,
        };
        plot.outlines.push(Outline {
            points: vec![from, to],
            style,
        });
    }
    for held in &case.boundaries.boxes {
        let style = match held.fix {
            [true, true] => OutlineStyle::Fixed,
            [false, false] => continue,
            _ => OutlineStyle::Roller,
        };
        let ([x0, y0], [x1, y1]) = (held.lower, held.upper);
        plot.outlines.push(Outline {
            points: vec![[x0, y0], [x0, y1], [x1, y1], [x1, y0], [x0, y0]],
            style,
        });
        plot.labels.push((held.upper, held.name.clone()));
    }
}

/// Arrows and blocks of the loads; returns the points that they reach. Traction and forces are
/// drawn to the scale of the largest of their kind.
fn add_loads(plot: &mut FieldPlot, case: &Case<2>, length: f64) -> Vec<[f64; 2]> {
    let norm = |v: [f64; 2]| v[0].hypot(v[1]);
    let largest = |size: &dyn Fn(&LoadKind<2>) -> f64| {
        case.loads
            .iter()
            .map(|load| size(&load.kind))
            .fold(0.0, f64::max)
    };
    let traction = largest(&|kind| match kind {
        LoadKind::Pressure { traction, .. } => norm(*traction),
        _ => 0.0,
    });
    let force = largest(&|kind| match kind {
        LoadKind::Point { force, .. } => norm(*force),
        _ => 0.0,
    });
    let mut reach = Vec::new();
    let mut arrow = |plot: &mut FieldPlot, to: [f64; 2], along: [f64; 2]| {
        let from = [to[0] - along[0], to[1] - along[1]];
        reach.push(from);
        plot.outlines.push(Outline {
            points: vec![from, to],
            style: OutlineStyle::Arrow,
        });
        from
    };
    for load in &case.loads {
        let at = match load.kind.clone() {
            LoadKind::Patch { .. } => continue,
            LoadKind::RigidFooting { from, to, .. } => {
                let height = 0.35 * length;
                let middle = 0.5 * (from[0] + to[0]);
                plot.outlines.push(Outline {
                    points: vec![
                        from,
                        to,
                        [to[0], to[1] + height],
                        [from[0], from[1] + height],
                    ],
                    style: OutlineStyle::Block,
                });
                arrow(plot, [middle, from[1] + height], [0.0, -length])
            }
            LoadKind::Pressure {
                from,
                to,
                traction: vector,
            } => {
                let along = vector.map(|part| part / traction.max(f64::MIN_POSITIVE) * length);
                let span = norm([to[0] - from[0], to[1] - from[1]]);
                let count = (3.0 * span / length).clamp(2.0, 15.0).round() as usize;
                let mut tail = from;
                for k in 0..count {
                    let t = (k as f64 + 0.5) / count as f64;
                    let to = std::array::from_fn(|axis| from[axis] + t * (to[axis] - from[axis]));
                    tail = arrow(plot, to, along);
                }
                tail
            }
            LoadKind::Point { at, force: vector } => {
                let along = vector.map(|part| part / force.max(f64::MIN_POSITIVE) * length);
                arrow(plot, at, along)
            }
        };
        plot.labels.push((at, load.name.clone()));
    }
    reach
}

/// Names for the symbols that are in the picture.
fn add_symbols_to_key(plot: &mut FieldPlot, has_bodies: bool) {
    let block = if has_bodies {
        "rigid body"
    } else {
        "rigid footing"
    };
    for (style, label) in [
        (OutlineStyle::Fixed, "held in both directions"),
        (OutlineStyle::Roller, "held across"),
        (OutlineStyle::Block, block),
        (OutlineStyle::Member, "reinforcement"),
        (OutlineStyle::Arrow, "load"),
        (OutlineStyle::Water, "water table"),
        (OutlineStyle::Former, "placed later"),
        (OutlineStyle::Section, "section"),
        (OutlineStyle::Point, "monitor"),
    ] {
        if plot.outlines.iter().any(|outline| outline.style == style) {
            plot.key.push(KeyEntry {
                sample: KeySample::Outline(style),
                label: label.to_owned(),
            });
        }
    }
}
