//! Flows that were computed: pore pressure, free surface, flow lines and equipotentials.

use std::path::Path;

use igimp_figures::{ColourMap, FieldPlot, Outline, OutlineStyle, Polygon};
use igimp_geometry::polygon::{area_and_centroid, clip_to_box};
use igimp_model::{Case, Cut, in_plane};
use igimp_results::summary::FigureNote;
use igimp_seepage::Seepage;
use igimp_text::short;

use super::{titled, write};
use crate::error::ReportError;

/// Flow lines and equipotentials that are drawn.
const LINES: [usize; 2] = [9, 11];
/// Parts of a cell smaller than this share are not drawn \[-\].
const SMALL: f64 = 1e-6;

/// Parts of a cell along each axis that are drawn or not, where a plane cuts ground in space.
const PARTS: usize = 4;

/// The picture of a flow in the plane, or pictures of upright cuts through the middle of the ground in space, under a name for
/// files.
///
/// # Errors
/// [`ResultsError::File`](igimp_results::ResultsError::File) and [`ReportError::Figure`].
pub fn seepage_pictures<const D: usize>(
    folder: &Path,
    case: &Case<D>,
    name: &str,
    flow: &Seepage<D>,
) -> Result<Vec<FigureNote>, ReportError> {
    if D == 2 {
        return Ok(vec![picture(folder, case, name, (flow, None))?]);
    }
    let cuts = (0..D - 1).rev().filter_map(|axis| middle(flow, axis));
    cuts.map(|cut| {
        let name = format!("{name}-{}", ["x", "y", "z"][cut.axis]);
        picture(folder, case, &name, (flow, Some(cut)))
    })
    .collect()
}

/// The plane across an axis through the middle of the ground.
fn middle<const D: usize>(flow: &Seepage<D>, axis: usize) -> Option<Cut> {
    let nodes = (0..flow.heads.len()).filter(|&node| flow.is_ground[node]);
    let places = nodes.map(|node| flow.grid.node_position(node)[axis]);
    let [from, to] = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[from, to], x| {
        [from.min(x), to.max(x)]
    });
    let at = 0.5 * (from + to);
    (from < to).then_some(Cut { axis, at })
}

/// The parts of a rectangle of a cut, or of the plane, that ground fills.
fn parts<const D: usize>(
    case: &Case<D>,
    cut: Option<Cut>,
    lower: [f64; 2],
    upper: [f64; 2],
) -> Vec<Polygon> {
    let size = [0, 1].map(|d| upper[d] - lower[d]);
    if let Some(case) = in_plane::<_, Case<2>>(case) {
        let clipped = case
            .bodies
            .iter()
            .map(|body| clip_to_box(body.polygon(), lower, upper));
        return clipped
            .filter(|part| area_and_centroid(part).0.abs() > SMALL * size[0] * size[1])
            .collect();
    }
    let corner = |k: usize, l: usize| {
        let along = [k, l].map(|k| k as f64 / PARTS as f64);
        [0, 1].map(|d| lower[d] + along[d] * size[d])
    };
    let all = (0..PARTS * PARTS).map(|part| {
        let (k, l) = (part % PARTS, part / PARTS);
        vec![
            corner(k, l),
            corner(k + 1, l),
            corner(k + 1, l + 1),
            corner(k, l + 1),
        ]
    });
    all.filter(|part| is_ground(case, cut, area_and_centroid(part).1))
        .collect()
}

/// Whether a place of a cut, or of the plane, is in the ground.
fn is_ground<const D: usize>(case: &Case<D>, cut: Option<Cut>, place: [f64; 2]) -> bool {
    let mut x = [cut.map_or(0.0, |cut| cut.at); D];
    let along = usize::from(cut.is_some_and(|cut| cut.axis == 0));
    (x[along], x[D - 1]) = (place[0], place[1]);
    case.bodies.iter().any(|body| body.region.encloses(x))
}

/// The picture of a flow in the plane or in a cut.
fn picture<const D: usize>(
    folder: &Path,
    case: &Case<D>,
    name: &str,
    (flow, cut): (&Seepage<D>, Option<Cut>),
) -> Result<FigureNote, ReportError> {
    let flow = flow.upright(cut.map(|cut| (cut.axis, cut.at)));
    let place = cut.map(|cut| format!("{} = {} m", ["x", "y", "z"][cut.axis], short(cut.at)));
    let seepage = titled(&case.title, "seepage");
    let mut plot = FieldPlot {
        title: place
            .as_ref()
            .map_or_else(|| seepage.clone(), |place| titled(&seepage, place)),
        label: "pore pressure u [kPa]".to_owned(),
        map: ColourMap::Sequential,
        ..FieldPlot::default()
    };
    if let Some(cut) = cut {
        plot.x_label = String::from(["y [m]", "x [m]"][cut.axis]);
        plot.y_label = String::from("z [m]");
    }
    for cell in (0..flow.filled.len()).filter(|&cell| flow.filled[cell] > 0.0) {
        let place = flow.grid.cell_place(cell);
        let corner = |up: usize| [0, 1].map(|d| flow.grid.axes[d].nodes()[place[d] + up]);
        for part in parts(case, cut, corner(0), corner(1)) {
            let centre = area_and_centroid(&part).1;
            let pressure = case.water_unit_weight * flow.pressure_head(&centre).max(0.0);
            plot.domains.push(part);
            plot.values.push(pressure / 1e3);
        }
    }
    let line = |style| move |points| Outline { points, style };
    let is_ground = |x: &[f64; 2]| is_ground(case, cut, *x);
    let [lines, levels] = LINES;
    // Cells that soil fills in part have heads beyond its surface too.
    let equal = flow.equipotentials(levels).into_iter();
    let equal = equal.filter(|[a, b]| is_ground(&[0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]));
    plot.outlines
        .extend(equal.map(|piece| line(OutlineStyle::Grid)(piece.to_vec())));
    if cut.is_none() {
        let within = |line: Vec<[f64; 2]>| line.into_iter().filter(is_ground).collect();
        let along = flow.flow_lines(lines).into_iter().map(within);
        plot.outlines.extend(along.map(line(OutlineStyle::Edge)));
    }
    let surface = flow.free_surface_lines().into_iter();
    plot.outlines.extend(surface.map(line(OutlineStyle::Water)));
    // Flow lines leave a cut where water passes it.
    let caption = match place {
        Some(place) => format!(
            "Seepage in the plane {place}, in the ground as the case draws it: pore pressure, equipotentials (thin); blue: the free surface."
        ),
        None => "Seepage in the ground as the case draws it: pore pressure, flow lines (firm), equipotentials (thin)\
                   ; blue: the free surface."
            .to_owned(),
    };
    write(folder, name, &plot.draw()?, caption)
}
