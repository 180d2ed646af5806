//! Loads of a body in a step: gravity on every particle, forces on points that the soil carries
//! along, and drag against motion (theory, eqs. 2 and 38).

use igimp_shape::{Grid, Linear, Scratch, Support, supports};

use crate::error::{AssemblyError, padded};
use crate::method::Section;

/// A force on a point that moves with the soil. Its direction stays (dead load).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadPoint<const D: usize> {
    /// Position \[length\].
    pub x: [f64; D],
    /// Force at load factor 1 \[force; per unit thickness in plane strain, on the whole circle in an axisymmetric section\].
    pub force: [f64; D],
    /// Index of its factor in [`StepLoads::factors`]; points of one load share it.
    pub load: usize,
}

impl<const D: usize> LoadPoint<D> {
    /// A traction on a straight edge, as `count` equal points in the middle of equal parts; they
    /// follow factor `load`.
    ///
    /// `traction` is force per unit area \[force/length²\] on the edge from `from` to `to`
    /// (per unit thickness).
    pub fn along_edge(
        from: [f64; D],
        to: [f64; D],
        traction: [f64; D],
        count: usize,
        load: usize,
    ) -> Vec<Self> {
        let length = from
            .iter()
            .zip(&to)
            .map(|(a, b)| (b - a) * (b - a))
            .sum::<f64>()
            .sqrt();
        (0..count)
            .map(|k| {
                let t = (k as f64 + 0.5) / count as f64;
                Self {
                    x: std::array::from_fn(|axis| from[axis] + t * (to[axis] - from[axis])),
                    force: traction.map(|component| component * length / count as f64),
                    load,
                }
            })
            .collect()
    }

    /// The same where the part of an edge that it stands in the middle of goes around the axis of a section: at the centroid of
    /// the ring, with the force on all of it. `way` leads from one end of the part to the other \[length\].
    #[must_use]
    pub fn around(mut self, section: Section, way: &[f64; D]) -> Self {
        let radius = self.x[0];
        if section.is_axisymmetric() && radius > 0.0 {
            for axis in 0..D {
                self.x[axis] += way[0] / (12.0 * radius) * way[axis];
                self.force[axis] *= section.thickness(radius);
            }
        }
        self
    }

    /// A traction on a rectangle across one axis, as equal points in the middle of equal parts, so many along each
    /// axis; they follow factor `load`.
    ///
    /// `traction` is force per unit area \[force/length²\] on the rectangle between the corners `from` and `to`, which
    /// share one coordinate.
    pub fn on_rectangle(
        from: [f64; D],
        to: [f64; D],
        traction: [f64; D],
        counts: [usize; D],
        load: usize,
    ) -> Vec<Self> {
        let way: [f64; D] = std::array::from_fn(|axis| to[axis] - from[axis]);
        let sides = way.iter().filter(|side| side.abs() > 0.0);
        let area: f64 = sides.map(|side| side.abs()).product();
        let counts: [usize; D] = std::array::from_fn(|axis| {
            if way[axis].abs() > 0.0 {
                counts[axis]
            } else {
                1
            }
        });
        let count: usize = counts.iter().product();
        (0..count)
            .map(|k| {
                let mut rest = k;
                let x = std::array::from_fn(|axis| {
                    let part = rest % counts[axis];
                    rest /= counts[axis];
                    from[axis] + (part as f64 + 0.5) / counts[axis] as f64 * way[axis]
                });
                Self {
                    x,
                    force: traction.map(|component| component * area / count as f64),
                    load,
                }
            })
            .collect()
    }

    /// The nodes that take the force: linear shares, so that resultant and moment are kept.
    pub(crate) fn supports(
        &self,
        grid: &Grid<D>,
        point: usize,
    ) -> Result<Vec<Support<D>>, AssemblyError> {
        let mut stencil = Vec::new();
        supports(
            grid,
            &Linear,
            &self.x,
            &[0.0; D],
            &mut Scratch::default(),
            &mut stencil,
        )
        .map_err(|source| AssemblyError::LoadPoint {
            point,
            position: padded(&self.x),
            source,
        })?;
        Ok(stencil)
    }
}

/// Loads of the body at the end of a step.
#[derive(Clone, Debug, PartialEq)]
pub struct StepLoads<const D: usize> {
    /// Acceleration of gravity \[length/time²\].
    pub gravity: [f64; D],
    /// Factors on the loaded points, by load; a load without a factor does not act \[-\].
    pub factors: Vec<f64>,
    /// Drag against motion: a force −drag · m · u on every node, with m its share of the mass and
    /// u its step displacement \[1/time²\]. Zero in a step that has to be in equilibrium.
    pub drag: f64,
}

impl<const D: usize> StepLoads<D> {
    /// Gravity alone \[length/time²\], with its direction.
    pub fn gravity(gravity: [f64; D]) -> Self {
        Self {
            gravity,
            factors: Vec::new(),
            drag: 0.0,
        }
    }

    /// Refuses loads that are not finite, named with the axis or the load.
    pub(crate) fn are_finite(&self) -> Result<(), AssemblyError> {
        for (axis, gravity) in self.gravity.iter().enumerate() {
            finite("gravity", axis, &[*gravity])?;
        }
        for (load, factor) in self.factors.iter().enumerate() {
            finite("load factor", load, &[*factor])?;
        }
        finite("drag", 0, &[self.drag])
    }
}

/// Refuses values that are not finite, with their name.
fn finite(quantity: &'static str, index: usize, values: &[f64]) -> Result<(), AssemblyError> {
    if values.iter().all(|value| value.is_finite()) {
        Ok(())
    } else {
        Err(AssemblyError::NonFinite { quantity, index })
    }
}

/// Refuses loaded points that are not finite, named with their number.
pub(crate) fn finite_points<const D: usize>(points: &[LoadPoint<D>]) -> Result<(), AssemblyError> {
    for (index, point) in points.iter().enumerate() {
        finite("position of a load point", index, &point.x)?;
        finite("force of a load point", index, &point.force)?;
    }
    Ok(())
}
