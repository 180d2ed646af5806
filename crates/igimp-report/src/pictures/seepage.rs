//! Flows that were computed: pore pressure, free surface, flow lines and equipotentials.

use std::path::Path;

use igimp_figures::{ColourMap, FieldPlot, Outline, OutlineStyle};
use igimp_geometry::polygon::{area_and_centroid, clip_to_box, contains};
use igimp_model::Case;
use igimp_results::summary::FigureNote;
use igimp_seepage::Seepage;

use super::{titled, write};
use crate::error::ReportError;

/// Flow lines and equipotentials that are drawn.
const LINES: [usize; 2] = [9, 11];
/// Parts of a cell smaller than this share are not drawn \[-\].
const SMALL: f64 = 1e-6;

/// The picture of a flow, under a name for files.
///
/// # Errors
/// [`ResultsError::File`](igimp_results::ResultsError::File) and [`ReportError::Figure`].
pub fn seepage_picture(
    folder: &Path,
    case: &Case<2>,
    name: &str,
    flow: &Seepage<2>,
) -> Result<FigureNote, ReportError> {
    let mut plot = FieldPlot {
        title: titled(&case.title, "seepage"),
        label: "pore pressure u [kPa]".to_owned(),
        map: ColourMap::Sequential,
        ..FieldPlot::default()
    };
    for cell in (0..flow.filled.len()).filter(|&cell| flow.filled[cell] > 0.0) {
        let place = flow.grid.cell_place(cell);
        let corner = |up: usize| [0, 1].map(|d| flow.grid.axes[d].nodes()[place[d] + up]);
        let (lower, upper) = (corner(0), corner(1));
        let whole = (upper[0] - lower[0]) * (upper[1] - lower[1]);
        for body in &case.bodies {
            let part = clip_to_box(body.polygon(), lower, upper);
            let (area, centre) = area_and_centroid(&part);
            if area.abs() > SMALL * whole {
                let pressure = case.water_unit_weight * flow.pressure_head(&centre).max(0.0);
                plot.domains.push(part);
                plot.values.push(pressure / 1e3);
            }
        }
    }
    let line = |style| move |points| Outline { points, style };
    let is_ground = |x: &[f64; 2]| (case.bodies.iter()).any(|own| contains(own.polygon(), *x));
    let [lines, levels] = LINES;
    // Cells that soil fills in part have heads beyond its surface too.
    let equal = flow.equipotentials(levels).into_iter();
    let equal = equal.filter(|[a, b]| is_ground(&[0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]));
    plot.outlines
        .extend(equal.map(|piece| line(OutlineStyle::Grid)(piece.to_vec())));
    let within = |line: Vec<[f64; 2]>| line.into_iter().filter(is_ground).collect();
    let along = flow.flow_lines(lines).into_iter().map(within);
    plot.outlines.extend(along.map(line(OutlineStyle::Edge)));
    let surface = flow.free_surface_lines().into_iter();
    plot.outlines.extend(surface.map(line(OutlineStyle::Water)));
    let caption = "Seepage in the ground as the case draws it: pore pressure, flow lines (firm), equipotentials (thin)\
                   ; blue: the free surface.";
    write(folder, name, &plot.draw()?, caption.to_owned())
}
