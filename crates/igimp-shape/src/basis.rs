//! Basis weights of one direction: linear (iMPM) and GIMP, on any axis and any domain.
//!
//! Theory, eqs. 3 and 5. Bardenhagen & Kober (2004) for GIMP; Yuan et al. (2021), doi:10.1631/jzus.A2100219, for the
//! cell-averaged centre gradient.

use crate::{Axis, AxisPart, ShapeError};

/// Weights of one node of an axis for one particle, in one direction.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct NodeWeight {
    /// Number of the node along the axis.
    pub node: usize,
    /// Basis value $`S`$ \[-\].
    pub value: f64,
    /// Derivative $`S'`$ with respect to the particle's coordinate \[1/length\].
    pub slope: f64,
    /// $`\bar S`$ \[-\]: mean over the particle of the tent function taken at the centre of the
    /// cell that contains the point; the factor of the *other* directions in
    /// [`Support::grad_bar`](crate::Support::grad_bar).
    pub centre: f64,
}

/// Basis functions of one direction; those of the grid are products over the directions.
///
/// On every axis and for every particle the weights satisfy, up to round-off,
///
/// ```math
/// \sum_i S_i = 1, \quad \sum_i S_i x_i = x_m, \quad
/// \sum_i S'_i = 0, \quad \sum_i S'_i x_i = 1, \quad \sum_i \bar S_i = 1
/// ```
///
/// with $`x_m`$ the point that the basis represents the particle by.
pub trait Basis: Send + Sync + std::fmt::Debug {
    /// Replaces `out` with the weights of the nodes that the particle touches: contiguous nodes,
    /// ascending.
    ///
    /// `x` is the coordinate of the particle's centre and `half_length` the half-length $`l_p`$ of
    /// its domain \[length\].
    ///
    /// # Errors
    ///
    /// [`ShapeError::OutsideGrid`] when `x` is not on the axis,
    /// [`ShapeError::InvalidHalfLength`] when `half_length` is negative or not finite. Both say
    /// direction 0, because a basis does not know which direction it serves; `out` is then
    /// unchanged.
    fn axis_weights(
        &self,
        axis: &Axis,
        x: f64,
        half_length: f64,
        out: &mut Vec<NodeWeight>,
    ) -> Result<(), ShapeError>;

    /// Appends the parts of the particle's domain in the cells that it overlaps, ascending: the
    /// parts that weights are made of.
    ///
    /// # Errors
    /// As [`axis_weights`](Self::axis_weights).
    fn axis_parts(
        &self,
        axis: &Axis,
        x: f64,
        half_length: f64,
        out: &mut Vec<AxisPart>,
    ) -> Result<(), ShapeError>;

    /// Short name for case files and reports: `"linear"` or `"gimp"`.
    fn name(&self) -> &'static str;
}

/// Linear basis of the standard (implicit) material point method: the particle is a point.
///
/// Values and slopes of the two tent functions of the particle's cell, $`\bar S = 1/2`$ for both:
/// in `D` directions `grad_bar` is the gradient at the centre of the particle's cell. A particle
/// on a face belongs to the cell that [`Axis::cell_at`] names.
///
/// ```
/// use igimp_shape::{Axis, Basis, Linear};
///
/// let mut weights = Vec::new();
/// Linear.axis_weights(&Axis::uniform(0.0, 2.0, 4)?, 2.5, 0.0, &mut weights)?;
/// assert_eq!(weights[0].node, 1);
/// assert_eq!(weights.iter().map(|w| w.value).collect::<Vec<_>>(), [0.75, 0.25]);
/// assert_eq!(weights.iter().map(|w| w.slope).collect::<Vec<_>>(), [-0.5, 0.5]);
/// assert_eq!(weights.iter().map(|w| w.centre).collect::<Vec<_>>(), [0.5, 0.5]);
/// # Ok::<(), igimp_shape::ShapeError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Linear;

/// GIMP basis: means over the particle's domain $`[x_p - l_p,\, x_p + l_p]`$.
///
/// The domain is cut at the ends of the axis, which are walls, and means are taken over the part that
/// remains. Every cell $`c`$ of size $`h`$ that the domain overlaps by the fraction $`w`$ of its
/// length, with the overlap's middle at local coordinate $`m \in [0, 1]`$, adds to its two nodes
/// (theory, eq. 5)
///
/// ```math
/// \begin{array}{llll}
/// \text{left:} & S \leftarrow S + w (1 - m), & S' \leftarrow S' - w / h, & \bar S \leftarrow \bar S + w / 2 \\
/// \text{right:} & S \leftarrow S + w m, & S' \leftarrow S' + w / h, & \bar S \leftarrow \bar S + w / 2
/// \end{array}
/// ```
///
/// This holds for any $`l_p`$ and any spacing. On a uniform axis with $`l_p \le h/2`$ and no wall
/// near it is, with $`r = x_p - x_i`$ and $`a = |r|`$, the well-known (eq. 4)
///
/// ```math
/// \begin{array}{llll}
/// a < l_p: & S = 1 - \dfrac{r^2 + l_p^2}{2 h l_p}, & S' = -\dfrac{r}{h l_p}, & \bar S = \tfrac12 \\
/// l_p \le a < h - l_p: & S = 1 - \dfrac{a}{h}, & S' = -\dfrac{\operatorname{sign} r}{h}, & \bar S = \tfrac12 \\
/// h - l_p \le a < h + l_p: & S = \dfrac{(h + l_p - a)^2}{4 h l_p}, & S' = -\operatorname{sign} r\,\dfrac{h + l_p - a}{2 h l_p}, & \bar S = \dfrac{h + l_p - a}{4 l_p}
/// \end{array}
/// ```
///
/// The point that represents the particle is the middle of the cut domain. Overlaps no wider than
/// round-off create no node: the domain then ends on the face. A domain no longer than round-off
/// is a point, served by the [`Linear`] weights.
///
/// ```
/// use igimp_shape::{Axis, Basis, Gimp};
///
/// let mut weights = Vec::new();
/// Gimp.axis_weights(&Axis::uniform(0.0, 1.0, 4)?, 2.0, 0.25, &mut weights)?;
/// assert_eq!(weights.iter().map(|w| w.node).collect::<Vec<_>>(), [1, 2, 3]);
/// assert_eq!(weights.iter().map(|w| w.value).collect::<Vec<_>>(), [0.0625, 0.875, 0.0625]);
/// assert_eq!(weights.iter().map(|w| w.slope).collect::<Vec<_>>(), [-0.5, 0.0, 0.5]);
/// assert_eq!(weights.iter().map(|w| w.centre).collect::<Vec<_>>(), [0.25, 0.5, 0.25]);
/// # Ok::<(), igimp_shape::ShapeError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Gimp;

impl Basis for Linear {
    #[inline]
    fn axis_weights(
        &self,
        axis: &Axis,
        x: f64,
        half_length: f64,
        out: &mut Vec<NodeWeight>,
    ) -> Result<(), ShapeError> {
        check_particle(axis, x, half_length)?;
        out.clear();
        push_point(axis, x, out);
        Ok(())
    }

    fn axis_parts(
        &self,
        axis: &Axis,
        x: f64,
        half_length: f64,
        out: &mut Vec<AxisPart>,
    ) -> Result<(), ShapeError> {
        check_particle(axis, x, half_length)?;
        out.push(point_part(axis, x));
        Ok(())
    }

    fn name(&self) -> &'static str {
        "linear"
    }
}

impl Basis for Gimp {
    #[inline]
    fn axis_weights(
        &self,
        axis: &Axis,
        x: f64,
        half_length: f64,
        out: &mut Vec<NodeWeight>,
    ) -> Result<(), ShapeError> {
        check_particle(axis, x, half_length)?;
        out.clear();
        let lower = (x - half_length).max(axis.start());
        let upper = (x + half_length).min(axis.end());
        if upper - lower <= 2.0 * axis.resolution() {
            push_point(axis, x, out);
        } else {
            push_interval(axis, lower, upper, out);
        }
        Ok(())
    }

    fn axis_parts(
        &self,
        axis: &Axis,
        x: f64,
        half_length: f64,
        out: &mut Vec<AxisPart>,
    ) -> Result<(), ShapeError> {
        check_particle(axis, x, half_length)?;
        let lower = (x - half_length).max(axis.start());
        let upper = (x + half_length).min(axis.end());
        if upper - lower <= 2.0 * axis.resolution() {
            out.push(point_part(axis, x));
        } else {
            out.extend(interval_parts(axis, lower, upper));
        }
        Ok(())
    }

    fn name(&self) -> &'static str {
        "gimp"
    }
}

/// The particle's centre is on the axis and its half-length is a length.
#[inline]
fn check_particle(axis: &Axis, x: f64, half_length: f64) -> Result<(), ShapeError> {
    let (start, end) = (axis.start(), axis.end());
    if !(start <= x && x <= end) {
        return Err(ShapeError::OutsideGrid {
            axis: 0,
            x,
            start,
            end,
        });
    }
    if !(half_length >= 0.0 && half_length.is_finite()) {
        return Err(ShapeError::InvalidHalfLength {
            axis: 0,
            half_length,
        });
    }
    Ok(())
}

/// Tent functions of the cell that contains `x`.
#[inline]
fn push_point(axis: &Axis, x: f64, out: &mut Vec<NodeWeight>) {
    let node = axis.nearest_cell(x);
    let (left, right) = (axis.nodes()[node], axis.nodes()[node + 1]);
    let slope = (right - left).recip();
    out.extend([
        NodeWeight {
            node,
            value: (right - x) * slope,
            slope: -slope,
            centre: 0.5,
        },
        NodeWeight {
            node: node + 1,
            value: (x - left) * slope,
            slope,
            centre: 0.5,
        },
    ]);
}

/// The whole particle in the cell that contains `x`.
fn point_part(axis: &Axis, x: f64) -> AxisPart {
    let cell = axis.nearest_cell(x);
    let (left, right) = (axis.nodes()[cell], axis.nodes()[cell + 1]);
    AxisPart {
        cell,
        share: 1.0,
        middle: (x - left) / (right - left),
    }
}

/// The parts of `lower..upper`, an interval on the axis longer than twice its resolution; cells that
/// are only touched have none.
fn interval_parts(axis: &Axis, lower: f64, upper: f64) -> impl Iterator<Item = AxisPart> {
    let first = axis.nearest_cell(lower + axis.resolution());
    let last = axis.nearest_cell(upper - axis.resolution());
    let nodes = axis.nodes();
    let lower = lower.max(nodes[first]);
    let upper = upper.min(nodes[last + 1]);
    (first..=last).map(move |cell| {
        let (left, right) = (nodes[cell], nodes[cell + 1]);
        let (from, to) = (lower.max(left), upper.min(right));
        AxisPart {
            cell,
            share: (to - from) / (upper - lower),
            middle: 0.5 * ((from - left) + (to - left)) / (right - left),
        }
    })
}

/// Means over `lower..upper`, an interval on the axis longer than twice its resolution.
#[inline]
fn push_interval(axis: &Axis, lower: f64, upper: f64, out: &mut Vec<NodeWeight>) {
    // Searching a round-off inside the interval leaves out cells that are only touched. The part
    // beyond their faces is cut off, so the fractions below still add up to one.
    let first = axis.nearest_cell(lower + axis.resolution());
    let last = axis.nearest_cell(upper - axis.resolution());
    let nodes = &axis.nodes()[first..=last + 1];
    let lower = lower.max(nodes[0]);
    let upper = upper.min(nodes[nodes.len() - 1]);
    let length = upper - lower;

    let mut weight = NodeWeight {
        node: first,
        ..NodeWeight::default()
    };
    for cell in nodes.windows(2) {
        let (left, right) = (cell[0], cell[1]);
        let (from, to) = (lower.max(left), upper.min(right));
        let fraction = (to - from) / length;
        let slope = fraction / (right - left);
        // Local coordinates of the overlap's middle, seen from either node: no cancellation.
        weight.value += 0.5 * slope * ((right - from) + (right - to));
        weight.slope -= slope;
        weight.centre += 0.5 * fraction;
        out.push(weight);
        weight = NodeWeight {
            node: weight.node + 1,
            value: 0.5 * slope * ((from - left) + (to - left)),
            slope,
            centre: 0.5 * fraction,
        };
    }
    out.push(weight);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weights(basis: &dyn Basis, axis: &Axis, x: f64, half_length: f64) -> Vec<NodeWeight> {
        let mut out = vec![NodeWeight::default(); 7];
        basis.axis_weights(axis, x, half_length, &mut out).unwrap();
        out
    }

    fn nodes(weights: &[NodeWeight]) -> Vec<usize> {
        weights.iter().map(|weight| weight.node).collect()
    }

    fn unit_axis() -> Axis {
        Axis::uniform(0.0, 1.0, 10).unwrap()
    }

    #[test]
    fn names() {
        assert_eq!((Linear.name(), Gimp.name()), ("linear", "gimp"));
    }

    #[test]
    fn a_touched_cell_adds_no_node() {
        let axis = unit_axis();
        assert_eq!(nodes(&weights(&Gimp, &axis, 3.5, 0.5)), [3, 4]);
        assert_eq!(nodes(&weights(&Gimp, &axis, 3.25, 0.25)), [3, 4]);
        assert_eq!(nodes(&weights(&Gimp, &axis, 4.0, 1.0)), [3, 4, 5]);
        assert_eq!(nodes(&weights(&Gimp, &axis, 4.5, 1.5)), [3, 4, 5, 6]);
    }

    #[test]
    fn an_overlap_within_round_off_adds_no_node() {
        // Eighths of a cell of 0.1 are not exact in binary: the domains of 4x4 particles per cell
        // reach a few units in the last place over the faces.
        let axis = Axis::uniform(0.0, 0.1, 100).unwrap();
        for cell in 0..100 {
            for k in 0..4 {
                let x = 0.1 * (f64::from(cell) + (f64::from(k) + 0.5) / 4.0);
                let seen = weights(&Gimp, &axis, x, 0.1 / 8.0);
                assert_eq!(seen.len(), 2, "cell {cell}, particle {k}: {seen:?}");
                assert!((seen[0].value + seen[1].value - 1.0).abs() < 1e-15);
                assert_eq!((seen[0].centre, seen[1].centre), (0.5, 0.5));
            }
        }
    }

    #[test]
    fn an_overlap_beyond_round_off_adds_a_node() {
        let seen = weights(&Gimp, &unit_axis(), 3.25, 0.25 + 1e-9);
        assert_eq!(nodes(&seen), [2, 3, 4]);
        assert!(
            seen[0].value > 0.0 && seen[0].value < 1e-17,
            "quadratic in the overlap: {seen:?}"
        );
        assert!((seen[0].centre - 1e-9).abs() < 1e-15);
    }

    #[test]
    fn walls_cut_the_domain() {
        let axis = Axis::from_nodes(vec![0.0, 1.0, 3.0]).unwrap();
        // Cut to [0, 0.75]: one cell, middle 0.375.
        let at_start = weights(&Gimp, &axis, 0.25, 0.5);
        assert_eq!(nodes(&at_start), [0, 1]);
        assert_eq!((at_start[0].value, at_start[1].value), (0.625, 0.375));
        // Centre on the wall, cut to [2, 3].
        let at_end = weights(&Gimp, &axis, 3.0, 1.0);
        assert_eq!(nodes(&at_end), [1, 2]);
        assert_eq!((at_end[0].value, at_end[1].value), (0.25, 0.75));
        assert_eq!((at_end[0].slope, at_end[1].slope), (-0.5, 0.5));
        // The whole axis and far beyond: cells weighted by their sizes, 1/3 and 2/3.
        let whole = weights(&Gimp, &axis, 1.7, f64::MAX);
        let expected = [(1.0 / 6.0, -1.0 / 3.0), (0.5, 0.0), (1.0 / 3.0, 1.0 / 3.0)];
        for (weight, (value, slope)) in whole.iter().zip(expected) {
            assert!((weight.value - value).abs() < 1e-15, "{weight:?}");
            assert!((weight.slope - slope).abs() < 1e-15, "{weight:?}");
            assert!((weight.centre - value).abs() < 1e-15, "{weight:?}");
        }
    }

    #[test]
    fn a_vanishing_domain_is_a_point() {
        let axis = unit_axis();
        for x in [0.0, 1e-17, 0.3, 4.0, 4.7, 10.0] {
            let point = weights(&Linear, &axis, x, 0.25);
            for half_length in [0.0, f64::MIN_POSITIVE, 1e-300, 1e-17, axis.resolution()] {
                assert_eq!(weights(&Gimp, &axis, x, half_length), point);
            }
        }
        for half_length in [1e-13, 1e-9] {
            let small = weights(&Gimp, &axis, 4.7, half_length);
            for (small, point) in small.iter().zip(weights(&Linear, &axis, 4.7, half_length)) {
                assert!((small.value - point.value).abs() < 1e-14);
                assert_eq!((small.slope, small.centre), (point.slope, point.centre));
            }
        }
    }

    #[test]
    fn a_far_origin_keeps_gradients_exact() {
        let axis = Axis::uniform(1e6, 0.1, 100).unwrap();
        let x = 1e6 + 3.17;
        for basis in [&Linear as &dyn Basis, &Gimp] {
            let seen = weights(basis, &axis, x, 0.04);
            let gradient: f64 = seen
                .iter()
                .map(|w| w.slope * (axis.nodes()[w.node] - x))
                .sum();
            assert!((gradient - 1.0).abs() < 1e-14, "{gradient:e}");
        }
    }

    #[test]
    fn bad_particles_are_refused_and_leave_no_trace() {
        let axis = unit_axis();
        for basis in [&Linear as &dyn Basis, &Gimp] {
            let mut out = vec![NodeWeight::default()];
            for x in [-1e-300, 10.0 + 1e-14, f64::INFINITY, f64::NAN] {
                let error = basis.axis_weights(&axis, x, 0.25, &mut out).unwrap_err();
                assert!(
                    matches!(error, ShapeError::OutsideGrid { axis: 0, .. }),
                    "{error}"
                );
            }
            for half_length in [-1e-300, f64::INFINITY, f64::NAN] {
                let error = basis
                    .axis_weights(&axis, 5.0, half_length, &mut out)
                    .unwrap_err();
                assert!(
                    matches!(error, ShapeError::InvalidHalfLength { axis: 0, .. }),
                    "{error}"
                );
            }
            assert_eq!(out, [NodeWeight::default()]);
        }
    }
}
