//! A slope as engineers draw it: layers of soil between coordinates; and the case that computes its
//! factor of safety.

use std::fmt::Write as _;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_input::CaseFile;
use igimp_model::Case;

use crate::runs::corners;

/// Width of the interval at which a search ends \[-\].
pub(crate) const TOLERANCE: f64 = 0.005;
/// Young's modulus of all soils \[kPa\]: factors of safety do not depend on it.
pub(crate) const YOUNG: f64 = 1e5;
/// Poisson's ratio of all soils \[-\].
const POISSON: f64 = 0.3;
/// The stage that a reduction of the strength of loaded soil starts from, on the given geometry too.
const WEIGHT: &str = "[[stages]]
             name = \"weight\"
             type = \"gravity\"
             steps = 5
             geometry = \"given\"";

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
    /// Name, with the variation.
    pub(crate) name: String,
    /// Height H of the slope \[m\].
    pub(crate) height: f64,
    /// Unit weight γ of all layers \[kN/m³\].
    pub(crate) unit_weight: f64,
    /// Pseudo-static force to the right, down the slope, over the weight \[-\].
    pub(crate) horizontal: f64,
    /// The surface from the left side to the right one \[m\].
    pub(crate) surface: Vec<[f64; 2]>,
    /// Level of the base \[m\].
    pub(crate) base: f64,
    /// Layers; together they fill the space between base and surface.
    pub(crate) layers: Vec<Layer>,
}

/// Mesh and method of one search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Variant {
    /// Cells over the height of the slope.
    pub(crate) cells: u32,
    /// The measure against locking.
    pub(crate) locking: Locking,
    /// ψ = φ, or else ψ = 0.
    pub(crate) associated: bool,
}

/// How a factor of safety is searched for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Search {
    /// Where the search begins \[-\].
    pub(crate) bracket: [f64; 2],
    /// How the reduced strength is reached.
    pub(crate) path: Path,
    /// Steps of a trial, or of the march through the bracket.
    pub(crate) steps: u32,
    /// Young's modulus of all soils \[kPa\].
    pub(crate) young: f64,
}

/// How reduced strength is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Path {
    /// Gravity is raised on the whole strength, which is then reduced step by step.
    Reduce,
    /// Gravity is raised on soil of reduced strength: for slopes that do not stand otherwise.
    Gravity,
}

/// The part of a slope in space between two ends of which the one in front is smooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ends {
    /// From one to the other \[m\].
    pub(crate) length: f64,
    /// Cells between them.
    pub(crate) cells: u32,
    /// Whether soil sticks to the one at the back.
    pub(crate) is_rough: bool,
}

impl Ends {
    /// Where they are.
    fn domain(self) -> String {
        format!("domain.y = [\"0 m\", \"{} m\"]", self.length)
    }

    /// The walls at the ends.
    fn walls(self) -> String {
        let back = if self.is_rough { "fixed" } else { "roller" };
        format!("front = \"roller\"\nback = \"{back}\"")
    }
}

impl Section {
    /// A homogeneous slope of height H = 10 m and γ = 20 kN/m³: `run` across for one down, the base
    /// at depth `depth_factor` H below the crest, `beyond` on both sides of the face \[m\].
    pub(crate) fn homogeneous(
        name: &str,
        (run, depth_factor): (f64, f64),
        strength: (f64, f64),
        margins: [f64; 2],
    ) -> Self {
        let foundation = 10.0 * (depth_factor - 1.0);
        Self::cut(name, [10.0, run, foundation], 20.0, strength, margins)
    }

    /// A homogeneous slope of a height \[m\], `run` across for one down, on a foundation \[m\], with
    /// unit weight, cohesion and friction \[kN/m³, kPa, degree\] and ground before and beyond the face
    /// \[m\].
    pub(crate) fn cut(
        name: &str,
        [height, run, foundation]: [f64; 3],
        unit_weight: f64,
        (cohesion, friction): (f64, f64),
        [before, beyond]: [f64; 2],
    ) -> Self {
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
            unit_weight,
            horizontal: 0.0,
            surface,
            base: 0.0,
            layers: vec![layer],
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

    /// Level of the crest, the highest of the surface \[m\].
    pub(crate) fn top(&self) -> f64 {
        self.surface
            .iter()
            .map(|p| p[1])
            .fold(f64::NEG_INFINITY, f64::max)
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

    /// The case that searches for the factor of safety of the section as it is given: no equilibrium
    /// alone is failure.
    ///
    /// # Errors
    /// If the section states no case.
    pub(crate) fn case(&self, variant: Variant, search: Search) -> Result<Case<2>, CaseError> {
        self.case_with(variant, search, &[])
    }

    /// The same, changed by overrides such as `materials.soil-0.poisson=0.45`; soils have the numbers of their layers.
    ///
    /// # Errors
    /// If the section states no case.
    pub(crate) fn case_with(
        &self,
        variant: Variant,
        search: Search,
        overrides: &[String],
    ) -> Result<Case<2>, CaseError> {
        let text = self.text(variant, search, None);
        Ok(CaseFile::parse(&self.name, &text, overrides)?.into_case())
    }

    /// The case that computes its factor of safety in space, between two ends.
    pub(crate) fn case_in_space(
        &self,
        variant: Variant,
        search: Search,
        ends: Ends,
        overrides: &[String],
    ) -> Result<Case<3>, CaseError> {
        let text = self.text(variant, search, Some(ends));
        let file = CaseFile::parse(&self.name, &text, overrides)?;
        Ok(file.case_in_space().clone())
    }

    /// The case file, in the plane or in space between two ends.
    fn text(&self, variant: Variant, search: Search, ends: Option<Ends>) -> String {
        let cell = self.height / f64::from(variant.cells);
        let upright = format!("[\"{} m\", \"{} m\"]", self.base, self.top() + cell);
        let extent = Extent::of(ends, cell, &upright);
        let mut text = self.tables(variant, &extent) + &self.stages(search);
        for (k, layer) in self.layers.iter().enumerate() {
            let dilation = if variant.associated {
                layer.friction
            } else {
                0.0
            };
            let _ = write!(
                text,
                "
                 [materials.soil-{k}]
                 unit_weight = \"{} kN/m3\"
                 young = \"{} kPa\"
                 poisson = {POISSON}
                 {}
                 [[bodies]]
                 name = \"layer {k}\"
                 material = \"soil-{k}\"
                 points_per_cell = {}
                 polygon = {}
                 {}
                ",
                self.unit_weight,
                search.young,
                layer.strength(dilation),
                extent.points_per_cell,
                corners(&layer.polygon),
                extent.across,
            );
        }
        text
    }

    /// The tables that a case has once, but for its stages.
    fn tables(&self, variant: Variant, extent: &Extent) -> String {
        let locking = match variant.locking {
            Locking::None => "none",
            Locking::BBar => "b-bar",
            Locking::SharedStrain => "shared-strain",
        };
        let [left, right] = self.sides();
        format!(
            "igimp = 1
             [case]
             title = \"{}\"
             analysis = \"{}\"
             gravity = \"9.81 m/s2\"
             [grid]
             cell = {}
             domain.x = [\"{left} m\", \"{right} m\"]
             {}
             locking = \"{locking}\"
             [boundaries]
             left = \"roller\"
             right = \"roller\"
             bottom = \"fixed\"
             {}
             [solver]
             tolerance = 1e-6
             max_iterations = 20
            ",
            self.name, extent.analysis, extent.cells, extent.domain, extent.walls,
        )
    }

    /// The stages that search for the factor of safety.
    fn stages(&self, search: Search) -> String {
        let Search {
            bracket,
            path,
            steps,
            ..
        } = search;
        let push = if self.horizontal == 0.0 {
            String::new()
        } else {
            format!("\nhorizontal = {}", self.horizontal)
        };
        // Gravity is raised anew, but a push is what a stage has left.
        let weight = match path {
            Path::Gravity if push.is_empty() => String::new(),
            Path::Reduce | Path::Gravity => format!("{WEIGHT}{push}"),
        };
        let path = match path {
            Path::Reduce => "reduce",
            Path::Gravity => "gravity",
        };
        format!(
            "{weight}
             [[stages]]
             name = \"strength reduction\"
             type = \"strength-reduction\"
             path = \"{path}\"
             search = \"trials\"
             bracket = {bracket:?}
             tolerance = {TOLERANCE}
             steps = {steps}
            "
        )
    }
}

impl Layer {
    /// The keys of its strength.
    fn strength(&self, dilation: f64) -> String {
        let Self {
            cohesion, friction, ..
        } = self;
        if *friction > 0.0 {
            format!(
                "model = \"mohr-coulomb\"
                     cohesion = \"{cohesion} kPa\"
                     friction = \"{friction} deg\"
                     dilation = \"{dilation} deg\""
            )
        } else {
            format!("model = \"tresca\"\ncu = \"{cohesion} kPa\"")
        }
    }
}

/// The changes of a case in space against one in the plane.
struct Extent {
    analysis: &'static str,
    cells: String,
    /// The domain but for x.
    domain: String,
    walls: String,
    points_per_cell: u32,
    /// The reach of a body from one end to the other.
    across: String,
}

impl Extent {
    fn of(ends: Option<Ends>, cell: f64, upright: &str) -> Self {
        let Some(ends) = ends else {
            return Self {
                analysis: "plane-strain",
                cells: format!("\"{cell} m\""),
                domain: format!("domain.y = {upright}"),
                walls: String::new(),
                points_per_cell: 4,
                across: String::new(),
            };
        };
        let between = ends.length / f64::from(ends.cells);
        Self {
            analysis: "3d",
            cells: format!("{{ x = \"{cell} m\", y = \"{between} m\", z = \"{cell} m\" }}"),
            domain: format!("{}\ndomain.z = {upright}", ends.domain()),
            walls: ends.walls(),
            points_per_cell: 8,
            across: format!("across = [\"0 m\", \"{} m\"]", ends.length),
        }
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
    use igimp_geometry::polygon::area_and_centroid;

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
            locking: Locking::SharedStrain,
            associated: true,
        };
        for (friction, path, stages) in [(0.0, Path::Gravity, 1), (20.0, Path::Reduce, 2)] {
            let shape = (1.0, 1.0);
            let section = Section::homogeneous("slope", shape, (10.0, friction), [10.0, 0.0]);
            let search = Search {
                bracket: [1.0, 1.4],
                path,
                steps: 5,
                young: YOUNG,
            };
            let case = section.case(variant, search).unwrap();
            assert_eq!(case.grid.cells(), [20, 11]);
            assert_eq!(case.stages.len(), stages);
        }
    }
}
