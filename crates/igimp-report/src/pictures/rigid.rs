//! Rigid bodies in pictures.

use igimp_figures::{Outline, OutlineStyle};
use igimp_geometry::polygon::clip_to_box;
use igimp_model::Case;

/// A circle is drawn with so many points.
pub const POINTS_OF_CIRCLE: usize = 96;

/// An outline as a block, as far as it lies within the grid: half a body beyond an axis of symmetry is
/// not seen.
pub fn block(case: &Case<2>, outline: &[[f64; 2]]) -> Option<Outline> {
    let points = clip_to_box(outline, case.grid.lower(), case.grid.upper());
    (points.len() > 2).then_some(Outline {
        points,
        style: OutlineStyle::Block,
    })
}
