//! Rigid bodies wished in place in weightless Tresca soil, and the force at which it flows around them.

pub(crate) mod bar;
pub(crate) mod deep;

use std::ops::ControlFlow;
use std::sync::Arc;

use igimp_assembly::{
    Geometry, Interface, Locking, Method, Particles, RigidBody, RigidMotion, SharedLaw, Shear,
    Surface,
};
use igimp_cases::CaseError;
use igimp_geometry::seed::fill_polygon;
use igimp_material::{Elasticity, Tresca};
use igimp_model::check::Band;
use igimp_results::mesh_study::Convergence;
use igimp_results::tables::table::Table;
use igimp_shape::{Axis, Grid};
use igimp_solver::{Accepted, Body, MarchSettings};
use rayon::prelude::*;

use super::{force, graded, held, weightless};
use crate::continuum::laboratory::run;
use crate::harness::oracle::Oracle;
use crate::harness::study::coverage::{self, Known, on_cells};
use crate::harness::study::{RunRecord, Study};

/// Young's modulus over undrained strength \[-\].
const YOUNG: f64 = 1e3;
/// Stiffness of contact in units of E/h where adhesion limits the shear: with the usual 10 a strip on
/// nine cells is cut six times as often, and its force is the same to 0.1 % \[-\].
const SOFT: f64 = 1.0;

/// A body of unit width in half of the soil around it, x ≥ 0.
pub(crate) struct Buried {
    /// The body, and how it is computed.
    pub(crate) variant: String,
    /// Cells over the unit width.
    pub(crate) cells: usize,
    pub(crate) surface: Surface<2>,
    /// One for each of its sides.
    pub(crate) interfaces: Vec<Interface>,
    /// The right part of the soil's outline, anticlockwise, from its top down along the body to x = 0; the
    /// rest of it is the domain's edge.
    pub(crate) inner: Vec<[f64; 2]>,
    /// Height of the soil's surface.
    pub(crate) top: f64,
    /// Where cells are `h` large: as far as this from x = 0, from this y, and to this y.
    pub(crate) fine: [f64; 3],
    /// How far the soil reaches: aside and down.
    pub(crate) reach: [f64; 2],
    /// Motion upwards.
    pub(crate) push: f64,
    pub(crate) locking: Locking,
    /// Share of a cell's volume below which a node is a small cut.
    pub(crate) small_cut: f64,
    /// Whether soil and body stay where they are seeded, or move.
    pub(crate) geometry: Geometry,
    /// Particles in a cell along a direction.
    pub(crate) per_direction: usize,
    pub(crate) steps: usize,
}

/// How the push went.
struct Pushed {
    record: RunRecord,
    /// Displacement and force of the whole body, both along the push.
    curve: Table,
}

impl Pushed {
    /// The force at the end of the push.
    fn limit(&self) -> f64 {
        self.curve.rows.last().map_or(f64::NAN, |row| row[1])
    }
}

/// A side that soil sticks to up to its strength.
pub(crate) fn adhesive(share: f64) -> Interface {
    Interface {
        shear: Shear::Limited {
            adhesion: vec![share],
            varies: false,
            friction: 0.0,
        },
        ..Interface::smooth()
    }
}

impl Buried {
    /// Lines of the grid: aside, and upwards to two rows above the soil. The soil's surface is a line.
    fn grid(&self) -> Result<Grid<2>, CaseError> {
        let h = 1.0 / self.cells as f64;
        let [wide, low, high] = self.fine;
        let low = -(-low / h).round() * h;
        let high = low + ((high.min(self.top) - low) / h - 1e-9).ceil() * h;
        let x = graded(h, [0.0, (wide / h).round() * h], [0.0, self.reach[0]], 1.3);
        let mut y = graded(h, [low, high], [-self.reach[1], self.top.max(high)], 1.3);
        let last = y[y.len() - 1];
        if high < self.top - 1e-9 {
            let scale = (self.top - high) / (last - high);
            for line in y.iter_mut().filter(|line| **line > high) {
                *line = high + scale * (*line - high);
            }
        }
        let [below, last] = [y[y.len() - 2], y[y.len() - 1]];
        y.extend([1.0, 2.0].map(|row| last + row * (last - below)));
        Ok(Grid::new([Axis::from_nodes(x)?, Axis::from_nodes(y)?]))
    }

    /// Pushes the body.
    fn run(&self) -> Result<Pushed, CaseError> {
        let grid = self.grid()?;
        let (right, bottom) = (grid.axes[0].end(), grid.axes[1].start());
        let mut outline = vec![[0.0, bottom], [right, bottom], [right, self.top]];
        outline.extend(&self.inner);
        let mut rigid = RigidBody::new(self.surface.clone(), self.interfaces.clone(), [0.0; 2]);
        if self
            .interfaces
            .iter()
            .any(|side| matches!(side.shear, Shear::Limited { .. }))
        {
            rigid.penalty.stiffness = SOFT;
        }
        let mut seeds = fill_polygon(&grid, &outline, self.per_direction, 1.0, 0)?;
        // A particle that stands in the body would be none of its business.
        seeds.retain(|seed| rigid.distance(&seed.x) > 0.25 * seed.half_length[0]);
        let mut body = Body::new(Particles::new(&seeds)?);
        body.rigid = vec![rigid];
        let law: SharedLaw = Arc::new(Tresca::new(Elasticity::new(YOUNG, 0.49)?, 1.0)?);
        let constraints = held(&grid)?;
        // Short steps at first, while soil is elastic.
        let load_path = |from: f64, to: f64| {
            let by = self.push * (to * to - from * from);
            weightless(&grid, &constraints, &law, RigidMotion::displaced([0.0, by]))
        };
        let mut method = Method::igimp_bbar();
        method.locking = self.locking;
        method.geometry = self.geometry;
        method.small_cuts.below = self.small_cut;
        let mut curve = Table::new(
            self.variant.replace([' ', ',', '/', '='], "_"),
            &["displacement_over_B_[-]", "force_[B s_u]"],
        );
        let way = self.push.signum();
        let mut observe = |accepted: &Accepted<'_, 2>| {
            let moved = self.push.abs() * accepted.report.to.powi(2);
            curve.push(vec![moved, way * 2.0 * force(accepted)[1]]);
            ControlFlow::Continue(())
        };
        let (record, _) = run(
            self.variant.clone(),
            &mut body,
            &method,
            &MarchSettings::steps(self.steps),
            &load_path,
            &mut observe,
        );
        Ok(Pushed { record, curve })
    }
}

/// Cells over the unit width of a fine mesh.
const FINE: usize = 17;

/// The claim on a limit load.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Claim {
    /// That of every mesh, and the extrapolated one.
    Every,
    /// The one extrapolated from two meshes; that of each is printed.
    Extrapolated,
    /// That of every mesh of [`FINE`] cells: values that go up and down say nothing of none.
    Fine,
    /// Nothing: all is printed.
    None,
}

/// A limit load that limit analysis knows.
pub(crate) struct Question<'a> {
    pub(crate) name: String,
    pub(crate) oracle: Oracle,
    /// Lower and upper bound, and how far beyond them a value may lie \[-\].
    pub(crate) bounds: [f64; 2],
    pub(crate) beyond: f64,
    pub(crate) claim: Claim,
    /// Cells over the unit width, for one or two meshes.
    pub(crate) meshes: Vec<usize>,
    /// The body on a mesh; its variant is filled in.
    pub(crate) body: Box<dyn Fn(usize) -> Buried + Sync + 'a>,
}

/// Computes limit loads, and holds them against known ones.
pub(crate) fn answer(study: &mut Study, questions: &[Question<'_>]) -> Result<(), CaseError> {
    let mut jobs = Vec::new();
    for question in questions {
        for &cells in &question.meshes {
            let mut body = (question.body)(cells);
            body.variant = format!("{}, B/h = {cells}", question.name);
            jobs.push(body);
        }
    }
    let pushed = jobs
        .par_iter()
        .map(Buried::run)
        .collect::<Result<Vec<_>, CaseError>>()?;
    let mut pushed = pushed.into_iter();
    for question in questions {
        let [lower, upper] = question.bounds;
        let band = Band::Between(
            (1.0 - question.beyond) * lower,
            (1.0 + question.beyond) * upper,
        );
        let expected = question.oracle.says(0.5 * (lower + upper));
        let (mut parts, mut limits, mut last) = (Vec::new(), Vec::new(), 0);
        let mut has_ended_early = false;
        for (&cells, push) in question.meshes.iter().zip(&mut pushed) {
            let limit = push.limit();
            has_ended_early |= push.record.stopped_by.is_some();
            let end = match push.record.stopped_by {
                None => String::new(),
                Some(_) => format!(" ({})", push.record.outcome),
            };
            last = match question.claim {
                Claim::None => study.run(push.record),
                _ => study.run_to_end(push.record),
            };
            let is_claimed = match question.claim {
                Claim::Every => true,
                Claim::Fine => cells >= FINE,
                Claim::Extrapolated | Claim::None => false,
            };
            if is_claimed {
                study.check(last, "V/(B s_u) [-]", expected, band, limit);
            }
            parts.push(format!("{limit:.3} on {cells} cells{end}"));
            limits.push(limit);
            push.curve.write_csv(&study.folder)?;
        }
        if let (&[coarse, fine], &[a, b]) = (&limits[..], &question.meshes[..]) {
            let [a, b] = [a, b].map(|cells| 1.0 / cells as f64);
            let values = [on_cells(a, coarse), on_cells(b, fine)];
            let known = Known {
                convergence: Convergence::CONTACT,
                truth: question.bounds,
            };
            // A march that ended early has no limit load: nothing is extrapolated, and the check fails.
            let name = format!("{}, {}", study.case, question.name);
            let found = (!has_ended_early).then(|| study.extrapolate(name, known, &values));
            let limit = coverage::value(found.flatten());
            if matches!(question.claim, Claim::Every | Claim::Extrapolated) {
                study.check(last, "V/(B s_u), extrapolated [-]", expected, band, limit);
            }
            parts.push(if has_ended_early {
                "nothing is extrapolated: a march ended early".to_owned()
            } else {
                format!("{limit:.3} extrapolated")
            });
        }
        study.notes.push(format!(
            "{}, {}: V/(B s_u) = {}; bounds {lower:.3} to {upper:.3}",
            study.case,
            question.name,
            parts.join(", ")
        ));
    }
    Ok(())
}
