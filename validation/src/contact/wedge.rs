//! A smooth rigid wedge pushed deep into rigid-plastic soil.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    AssemblyError, Constraints, Interface, Method, Particles, RigidBody, RigidMotion, SharedLaw,
};
use igimp_cases::CaseError;
use igimp_geometry::seed::fill_polygon;
use igimp_material::{Elasticity, Tresca};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use igimp_shape::{Axis, Grid};
use igimp_solver::{Accepted, Body, MarchSettings};
use rayon::prelude::*;

use super::{closed, force, graded, polygon, weightless};
use crate::continuum::laboratory::run;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "A smooth rigid wedge that stands in weightless Tresca soil with E/s_u = 300, with the lip that it has thrown up, is pushed deeper by a fifth (in full also by a half, where the lip is told and not claimed: at 30° it comes out 5.05 % too high on c/h = 8). The motion is self-similar: force and height of the lip over the depth, and the pressure, stay those of Hill, Lee and Tupper. The height is thrice that of the centroid of the soil above the old ground, as of a triangle; the highest soil is told beside it. Half of the wedge is modelled, with knots of contact two cells apart, a ghost penalty of 0.001, and no support on those nodes of the axis of symmetry that stand in the wedge: they belong to soil beside it that has left the axis. With the support the same run must miss.";
const HILL: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Hill, Lee and Tupper 1947, indentation by a smooth wedge",
    locator: "cos(2β − ψ) = cos ψ/(1 + sin ψ), p = 2 s_u (1 + ψ)",
};
/// Young's modulus over undrained strength \[-\].
const YOUNG: f64 = 300.0;
/// Depth at the start.
const DEPTH: f64 = 1.0;
/// How far it is pushed; in full also further.
const PUSH: f64 = 0.2;
/// Distance of the contact nodes in cells: closer ones take turns in carrying on an inclined face.
const KNOTS: f64 = 2.0;
/// Nodes of the lip and of the axis in the wedge carry next to no soil.
const GHOST_PENALTY: f64 = 1e-3;

/// Hill's solution of a wedge with semi-angle `beta` \[rad\] at unit depth.
struct Field {
    /// Angle of the fan ψ \[rad\].
    fan: f64,
    /// Length of contact, and of the straight surface of the lip, over the depth.
    contact: f64,
    beta: f64,
}

impl Field {
    fn new(beta: f64) -> Self {
        // cos(2β − ψ) − cos ψ/(1 + sin ψ) grows with ψ from negative to positive between 0 and 2β.
        let (mut low, mut high) = (0.0, 2.0 * beta);
        for _ in 0..60 {
            let fan: f64 = 0.5 * (low + high);
            if (2.0 * beta - fan).cos() < fan.cos() / (1.0 + fan.sin()) {
                low = fan;
            } else {
                high = fan;
            }
        }
        Self {
            fan: low,
            contact: 1.0 / (beta.cos() - (beta - low).sin()),
            beta,
        }
    }

    /// P/(s_u c).
    fn force(&self) -> f64 {
        4.0 * (1.0 + self.fan) * self.contact * self.beta.sin()
    }

    /// Height of the lip over the depth.
    fn lip(&self) -> f64 {
        self.contact * (self.beta - self.fan).sin()
    }

    /// Where the straight surface of the lip meets the level ground.
    fn foot(&self) -> f64 {
        self.contact * (self.beta.sin() + (self.beta - self.fan).cos())
    }

    /// The outline of half the soil around a wedge of unit depth, as far as a distance and a depth.
    fn soil(&self, wide: f64, deep: f64) -> Vec<[f64; 2]> {
        let top = [self.contact * self.beta.sin(), self.lip()];
        vec![
            [0.0, -deep],
            [wide, -deep],
            [wide, 0.0],
            [self.foot(), 0.0],
            top,
            [0.0, -1.0],
        ]
    }
}

/// The wedge, and its push.
#[derive(Clone, Copy)]
struct Wedge {
    /// Semi-angle \[°\].
    degrees: f64,
    /// Cells to the first depth.
    cells: usize,
    /// By how much of the first depth.
    push: f64,
}

impl Wedge {
    fn new(degrees: f64, cells: usize, push: f64) -> Self {
        Self {
            degrees,
            cells,
            push,
        }
    }

    fn name(&self) -> String {
        let (degrees, cells, push) = (self.degrees, self.cells, self.push);
        format!("β = {degrees}°, c/h = {cells}, pushed by {push} c")
    }

    fn field(&self) -> Field {
        Field::new(self.degrees.to_radians())
    }

    fn h(&self) -> f64 {
        DEPTH / self.cells as f64
    }

    /// The grid: equal cells where the field flows.
    fn grid(&self) -> Result<Grid<2>, CaseError> {
        let (h, field) = (self.h(), self.field());
        let up_to = |length: f64| (length / h).ceil() * h;
        let wide = up_to(field.foot() + 0.3 * DEPTH);
        let (low, high) = (
            up_to(1.5 * DEPTH),
            up_to((1.0 + self.push) * field.lip()) + 3.0 * h,
        );
        let x = graded(h, [0.0, wide], [0.0, wide + 2.0 * DEPTH], 1.2);
        let y = graded(h, [-low, high], [-low - 2.0 * DEPTH, high], 1.2);
        Ok(Grid::new([Axis::from_nodes(x)?, Axis::from_nodes(y)?]))
    }

    /// Half of the wedge, closed upon the soil as far as its face is in contact.
    fn rigid(&self) -> RigidBody<2> {
        let (field, tall) = (self.field(), 2.5 * DEPTH);
        let corners = [[0.0, 0.0], [tall * field.beta.tan(), tall], [0.0, tall]];
        let origin = [0.0, -DEPTH];
        let mut wedge = polygon(&corners, KNOTS * self.h(), &Interface::smooth(), origin);
        let places = wedge.surface.knots();
        for ((place, side), node) in places.into_iter().zip(&mut wedge.contact.knots) {
            if side == 0 && place[0].hypot(place[1]) < field.contact {
                (node.area, node.is_closed) = (self.h(), true);
            }
        }
        wedge
    }

    /// Smooth walls and a fixed bottom.
    fn supports(grid: &Grid<2>) -> Result<Constraints<2>, AssemblyError> {
        let mut constraints = Constraints::free(grid);
        constraints.fix_wall(grid, 0, false, 0)?;
        constraints.fix_wall(grid, 0, true, 0)?;
        constraints.fix_wall(grid, 1, false, 0)?;
        constraints.fix_wall(grid, 1, false, 1)?;
        Ok(constraints)
    }
}

/// Height of the lip as of a triangle upon the old ground: three times that of the centroid of the soil above
/// it, as far as the lip reaches \[length\]. The highest particle stands for a point at the wedge alone.
fn lip(particles: &Particles<2>, reach: f64) -> f64 {
    let (mut volume, mut moment) = (0.0, 0.0);
    for p in 0..particles.len() {
        let ([x, y], half) = (particles.x[p], particles.half_length[p][1]);
        let (bottom, top) = ((y - half).max(0.0), y + half);
        if x < reach && top > bottom {
            let share = particles.volume(p) * (top - bottom) / (2.0 * half);
            volume += share;
            moment += share * 0.5 * (top + bottom);
        }
    }
    3.0 * moment / volume
}

/// Pushes a wedge from unit depth on, with the lip that it has thrown up by then; by step: depth, P/(s_u c),
/// P over the face up to the lip, height of the lip over depth, length and pressure of the contact nodes that touch, the highest soil.
fn push(wedge: Wedge) -> Result<(RunRecord, Table), CaseError> {
    let (grid, field) = (wedge.grid()?, wedge.field());
    let wide = grid.axes[0].end();
    let deep = -grid.axes[1].nodes()[0];
    let rigid = wedge.rigid();
    // A particle that stands in the wedge would be none of its business.
    let mut seeds = fill_polygon(&grid, &field.soil(wide, deep), 3, 1.0, 0)?;
    seeds.retain(|seed| rigid.distance(&seed.x) > 0.25 * seed.half_length[0]);
    let mut body = Body::new(Particles::new(&seeds)?);
    body.rigid = vec![rigid];
    let law: SharedLaw = Arc::new(Tresca::new(Elasticity::new(YOUNG, 0.49)?, 1.0)?);
    let load_path = |from: f64, to: f64| {
        let supports = Wedge::supports(&grid)?;
        let motion = RigidMotion::displaced([0.0, -wedge.push * (to - from)]);
        weightless(&grid, &supports, &law, motion)
    };
    let mut curve = Table::new(
        format!("force_{}_{}_{}", wedge.degrees, wedge.cells, wedge.push),
        &[
            "depth_[-]",
            "P_[s_u c]",
            "p_to_lip_[2 s_u]",
            "lip_[c]",
            "knots_touching_[c]",
            "p_of_knots_[2 s_u]",
            "highest_soil_[c]",
        ],
    );
    let mut observe = |accepted: &Accepted<'_, 2>| {
        let depth = DEPTH + wedge.push * accepted.report.to;
        let particles = &accepted.body.particles;
        let lip = lip(particles, field.foot() * depth);
        let tops = (0..particles.len()).map(|p| particles.x[p][1] + particles.half_length[p][1]);
        let highest = tops.fold(0.0, f64::max);
        let nodes = closed(&accepted.body.rigid);
        let length: f64 = nodes.iter().map(|(_, node)| node.area).sum();
        let pressed: f64 = nodes
            .iter()
            .map(|(_, node)| node.area * node.pressure)
            .sum();
        let load = -2.0 * force(accepted)[1];
        let face = (depth + lip) / field.beta.cos();
        curve.push(vec![
            depth,
            load / depth,
            load / (4.0 * face * field.beta.sin()),
            lip / depth,
            length / depth,
            0.5 * pressed / length,
            highest / depth,
        ]);
        ControlFlow::Continue(())
    };
    let mut method = Method::igimp_bbar();
    method.small_cuts.ghost_penalty = GHOST_PENALTY;
    let (run, _) = run(
        wedge.name(),
        &mut body,
        &method,
        &MarchSettings::steps((16.0 * wedge.push * wedge.cells as f64).round() as usize),
        &load_path,
        &mut observe,
    );
    Ok((run, curve))
}

/// The runs of a level.
fn wedges(level: Level) -> Vec<Wedge> {
    let mut wedges = vec![Wedge::new(15.0, 8, PUSH), Wedge::new(30.0, 8, PUSH)];
    if level >= Level::Default {
        wedges.push(Wedge::new(45.0, 8, PUSH));
    }
    if level >= Level::Full {
        wedges.extend([15.0, 30.0].map(|degrees| Wedge::new(degrees, 8, 0.5)));
        wedges.extend([15.0, 30.0].map(|degrees| Wedge::new(degrees, 12, PUSH)));
    }
    wedges
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-wedge", ABOUT, out)?;
    let wedges = wedges(level);
    let done = wedges
        .par_iter()
        .map(|&wedge| push(wedge))
        .collect::<Result<Vec<_>, CaseError>>()?;
    for (wedge, (record, curve)) in wedges.iter().zip(done) {
        let run = study.run_to_end(record);
        let field = wedge.field();
        // A run that stops early has no such rows, and a mean that is no number.
        let late = curve
            .rows
            .iter()
            .filter(|row| row[0] > DEPTH + 0.5 * wedge.push);
        let late: Vec<&Vec<f64>> = late.collect();
        let mean = |k: usize| late.iter().map(|row| row[k]).sum::<f64>() / late.len() as f64;
        let quantity = "P/(s_u c), mean over the second half of the push [-]";
        let band = Band::Relative(0.03);
        study.check(run, quantity, HILL.says(field.force()), band, mean(1));
        let quantity = "pressure P over the face up to the lip / 2 s_u, the same mean [-]";
        let expected = HILL.says(1.0 + field.fan);
        study.check(run, quantity, expected, band, mean(2));
        // Of a longer push the lip is printed alone: at 30° it is some 5 % too high.
        if wedge.push <= PUSH {
            let quantity = "height of the lip / c, from its centroid, the same mean [-]";
            let band = Band::Relative(0.05);
            study.check(run, quantity, HILL.says(field.lip()), band, mean(3));
        }
        // Knots close one by one as the lip grows, and a particle is a rough measure of its edge.
        study.notes.push(format!(
            "contact-wedge, {}: the knots that touch cover {:.3} c of the face, exact {:.3}, at a mean pressure of {:.3} times 2 s_u, exact {:.3}; by its centroid the lip is {:.4} c high and the highest soil stands at {:.4} c, exact {:.4} c",
            wedge.name(),
            mean(4),
            field.contact,
            mean(5),
            1.0 + field.fan,
            mean(3),
            mean(6),
            field.lip(),
        ));
        curve.write_csv(&study.folder)?;
    }
    Ok(study)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ORACLE: force, lip and the balance of volume of the published solution.
    #[test]
    fn the_field_is_hills() {
        let table = [
            (15.0_f64, 5.4299_f64, 1.417_32, 0.2079),
            (30.0, 17.3397, 4.027_60, 0.3388),
            (45.0, 32.9351, 8.942_77, 0.4196),
        ];
        for (beta, fan, force, lip) in table {
            let field = Field::new(beta.to_radians());
            assert!((field.fan.to_degrees() - fan).abs() < 1e-3);
            assert!((field.force() - force).abs() < 1e-4);
            assert!((field.lip() - lip).abs() < 1e-4);
            let soil = field.soil(6.0, 4.0);
            let (area, _) = igimp_geometry::polygon::area_and_centroid(&soil);
            assert!((area.abs() - 24.0).abs() < 1e-3, "{beta}: {area}");
        }
    }
}
