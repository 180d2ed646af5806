//! A slope as engineers draw it: layers of soil between coordinates; and the case that computes its
//! factor of safety.

use std::fmt::Write as _;

use igimp_cases::CaseError;
use igimp_cases::case::Case;
use igimp_cases::input::CaseFile;

use crate::runs::corners;

/// Young's modulus of all soils \[kPa\]: factors of safety do not depend on it.
const YOUNG: f64 = 1e5;
/// Poisson's ratio of all soils \[-\].
const POISSON: f64 = 0.3;
/// A slope has failed at this multiple of the settlement of its highest column under its own weight
/// without sideways strain, if it has not lost equilibrium before \[-\].
pub(crate) const FAILURE: f64 = 3.0;

/// A layer of one soil.
#[derive(Clone, Debug)]
pub(crate) struct Layer {
    /// Cohesion c \[kPa\].
    pub(crate) cohesion: f64,
    /// Angle of friction φ \[degree\].
    pub(crate) friction: f64,
    /// Corners in order \[m\].
    pub(crate) polygon: Vec<[f64; 2]>,
}

/// A slope that falls to the right on a rigid rough base, between smooth upright sides.
#[derive(Clone, Debug)]
pub(crate) struct Section {
    /// Name, with what is varied.
    pub(crate) name: String,
    /// Height H of the slope \[m\].
    pub(crate) height: f64,
    /// Unit weight γ of all layers \[kN/m³\].
    pub(crate) unit_weight: f64,
    /// The surface from the left side to the right one \[m\].
    pub(crate) surface: Vec<[f64; 2]>,
    /// Level of the base \[m\].
    pub(crate) base: f64,
    /// Layers; together they fill what is between base and surface.
    pub(crate) layers: Vec<Layer>,
    /// The point whose displacement tells failure; none: the largest displacement does \[m\].
    pub(crate) watched: Option<[f64; 2]>,
}

/// Mesh and method of one search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Variant {
    /// Cells over the height of the slope.
    pub(crate) cells: u32,
    /// Whether B-bar is on.
    pub(crate) bbar: bool,
    /// ψ = φ, or else ψ = 0.
    pub(crate) associated: bool,
}

impl Section {
    /// A homogeneous slope of height H = 10 m and γ = 20 kN/m³: `run` across for one down, the base
    /// at depth `depth_factor` H below the crest, `beyond` on both sides of the face \[m\].
    pub(crate) fn homogeneous(
        name: &str,
        (run, depth_factor): (f64, f64),
        (cohesion, friction): (f64, f64),
        [before, beyond]: [f64; 2],
    ) -> Self {
        let height = 10.0;
        let foundation = height * (depth_factor - 1.0);
        let (toe, top) = (before + run * height, foundation + height);
        let mut surface = vec![[0.0, top], [before, top], [toe, foundation]];
        let mut polygon = vec![[0.0, 0.0]];
        if foundation > 0.0 {
            surface.push([toe + beyond, foundation]);
            polygon.push([toe + beyond, 0.0]);
        }
        polygon.extend(surface.iter().rev());
        let layer = Layer {
            cohesion,
            friction,
            polygon,
        };
        Self {
            name: name.to_owned(),
            height,
            unit_weight: 20.0,
            surface,
            base: 0.0,
            layers: vec![layer],
            watched: None,
        }
    }

    /// The section seen from behind, so that one that falls to the left falls to the right.
    pub(crate) fn mirrored(mut self) -> Self {
        let turn = |points: &mut Vec<[f64; 2]>, ends: f64| {
            for p in points.iter_mut() {
                p[0] = ends - p[0];
            }
            points.reverse();
        };
        let ends = self.sides().iter().sum();
        turn(&mut self.surface, ends);
        for layer in &mut self.layers {
            turn(&mut layer.polygon, ends);
        }
        self
    }

    /// Where the left and the right side are \[m\].
    pub(crate) fn sides(&self) -> [f64; 2] {
        [self.surface[0], self.surface[self.surface.len() - 1]].map(|p| p[0])
    }

    /// Level of the crest \[m\].
    pub(crate) fn top(&self) -> f64 {
        self.surface[0][1]
    }

    /// Level of the surface at x \[m\], linear beyond its ends.
    pub(crate) fn level(&self, x: f64) -> f64 {
        let last = self.surface.len() - 2;
        let k = (0..last).find(|&k| x <= self.surface[k + 1][0]);
        let [p, q] = [0, 1].map(|end| self.surface[k.unwrap_or(last) + end]);
        p[1] + (q[1] - p[1]) * (x - p[0]) / (q[0] - p[0])
    }

    /// The layer at a point; the first one for points in none.
    pub(crate) fn layer_at(&self, point: [f64; 2]) -> &Layer {
        let mut layers = self.layers.iter();
        let found = layers.find(|layer| contains(&layer.polygon, point));
        found.unwrap_or(&self.layers[0])
    }

    /// The displacement at which the slope counts as failed \[m\].
    pub(crate) fn failure_displacement(&self) -> f64 {
        let constrained = YOUNG * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
        FAILURE * self.unit_weight * (self.top() - self.base).powi(2) / (2.0 * constrained)
    }

    /// The case that searches for the factor of safety, from a bracket of factors: gravity is raised
    /// in five steps on undeformed soil of reduced strength.
    ///
    /// # Errors
    /// If the section states no case.
    pub(crate) fn case(&self, variant: Variant, bracket: [f64; 2]) -> Result<Case, CaseError> {
        let Variant {
            cells,
            bbar,
            associated,
        } = variant;
        let locking = if bbar { "b-bar" } else { "none" };
        let cell = self.height / f64::from(cells);
        let ([left, right], top) = (self.sides(), self.top() + cell);
        let base = self.base;
        let mut text = format!(
            "igimp = 1
             [case]
             title = \"{}\"
             analysis = \"plane-strain\"
             gravity = \"9.81 m/s2\"
             [grid]
             cell = \"{cell} m\"
             domain.x = [\"{left} m\", \"{right} m\"]
             domain.y = [\"{base} m\", \"{top} m\"]
             locking = \"{locking}\"
             [boundaries]
             left = \"roller\"
             right = \"roller\"
             bottom = \"fixed\"
             [solver]
             tolerance = 1e-6
             max_iterations = 20
             [[stages]]
             name = \"strength reduction\"
             type = \"strength-reduction\"
             path = \"gravity\"
             bracket = {bracket:?}
             tolerance = 0.01
             steps = 5
             geometry = \"moving\"
             [stages.failure]
             when = \"no-equilibrium\"
             also.displacement = \"{} m\"
            ",
            self.name,
            self.failure_displacement(),
        );
        for (k, layer) in self.layers.iter().enumerate() {
            let Layer {
                cohesion,
                friction,
                polygon,
            } = layer;
            let strength = if *friction > 0.0 {
                let dilation = if associated { *friction } else { 0.0 };
                format!(
                    "model = \"mohr-coulomb\"
                     cohesion = \"{cohesion} kPa\"
                     friction = \"{friction} deg\"
                     dilation = \"{dilation} deg\""
                )
            } else {
                format!("model = \"tresca\"\ncu = \"{cohesion} kPa\"")
            };
            let _ = write!(
                text,
                "
                 [materials.soil-{k}]
                 unit_weight = \"{} kN/m3\"
                 young = \"{YOUNG} kPa\"
                 poisson = {POISSON}
                 {strength}
                 [[bodies]]
                 name = \"layer {k}\"
                 material = \"soil-{k}\"
                 points_per_cell = 4
                 polygon = {}
                ",
                self.unit_weight,
                corners(polygon),
            );
        }
        if let Some([x, y]) = self.watched {
            text = text.replace(
                "[stages.failure]",
                "[stages.failure]\nalso.monitor = \"crest\"",
            );
            let _ = write!(
                text,
                "
                 [[monitors]]
                 name = \"crest\"
                 point = [\"{x} m\", \"{y} m\"]
                 record = [\"displacement\"]
                "
            );
        }
        Ok(CaseFile::parse(&self.name, &text, &[])?.into_case())
    }
}

/// Whether a point is within a polygon: crossings of a ray.
fn contains(polygon: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let mut inside = false;
    for (k, p) in polygon.iter().enumerate() {
        let q = polygon[(k + 1) % polygon.len()];
        if (p[1] > y) != (q[1] > y) && x < p[0] + (q[0] - p[0]) * (y - p[1]) / (q[1] - p[1]) {
            inside = !inside;
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use igimp_cases::polygon::area_and_centroid;

    use super::*;

    fn area(section: &Section) -> f64 {
        let areas = section.layers.iter();
        areas.map(|l| area_and_centroid(&l.polygon).0.abs()).sum()
    }

    #[test]
    fn a_mirrored_section_has_its_crest_on_the_other_side() {
        let right = Section::homogeneous("slope", (2.0, 1.5), (10.0, 20.0), [12.0, 20.0]);
        let left = right.clone().mirrored();
        let moved = |k: usize| (right.sides()[k] - left.sides()[k]).abs();
        assert!(moved(0) + moved(1) < 1e-9);
        assert!((right.level(22.0) - 10.0).abs() < 1e-12);
        assert!((left.level(30.0) - 10.0).abs() < 1e-12);
        assert!((area(&right) - area(&left)).abs() < 1e-9);
        assert!((area(&right) - (52.0 * 5.0 + 12.0 * 10.0 + 100.0)).abs() < 1e-9);
    }

    #[test]
    fn a_section_states_a_case() {
        let variant = Variant {
            cells: 10,
            bbar: true,
            associated: true,
        };
        for friction in [0.0, 20.0] {
            let shape = (1.0, 1.0);
            let mut section = Section::homogeneous("slope", shape, (10.0, friction), [10.0, 0.0]);
            section.watched = (friction > 0.0).then_some([10.0, 10.0]);
            let case = section.case(variant, [1.0, 1.4]).unwrap();
            assert_eq!(case.grid.cells(), [20, 11]);
            assert_eq!(case.monitors.len(), usize::from(friction > 0.0));
        }
    }
}
