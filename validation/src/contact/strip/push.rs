//! One push of a rigid strip of unit width on weightless Tresca soil, on the given geometry.

use std::ops::ControlFlow;
use std::sync::Arc;

use igimp_assembly::{
    Drive, Geometry, Interface, Method, Particles, RigidBody, RigidMotion, SharedLaw, Surface,
};
use igimp_cases::CaseError;
use igimp_material::{Elasticity, Tresca};
use igimp_results::tables::table::Table;
use igimp_solver::{Accepted, Body, MarchSettings};

use super::super::{Ground, force, graded, weightless};
use crate::continuum::laboratory::run;
use crate::harness::study::RunRecord;

/// Young's modulus over undrained strength \[-\].
const YOUNG: f64 = 1e4;
/// Settlement at the end and at the start over the width \[-\]. In between it grows by the same factor from step
/// to step: strip and soil come together softly, and an eccentric strip tilts from the first steps on.
const SETTLEMENT: [f64; 2] = [1e-5, 3e-3];
const STEPS: usize = 24;
/// Vertical load under which the strip is pushed sideways over B s_u \[-\].
const LIGHT: f64 = 1.0;

/// How soil and contact are discretised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Scheme {
    /// Shared strain, contact up to the very edge.
    Sharp,
    /// B-bar, and half a cell at each edge carries nothing, as case files have it if nothing else is said.
    Rounded,
}

/// The load on the strip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Load {
    /// Pushed down, its edges so many cells beyond lines of the grid.
    Centric { place: f64 },
    /// Pushed down so far off its middle, free to tilt and, if rough, to move sideways \[length\].
    Eccentric(f64),
    /// Pushed down and sideways, so much further sideways than down \[-\].
    Inclined(f64),
    /// Pushed sideways under a small vertical load.
    Sideways,
}

/// One push of a strip of unit width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Push {
    pub(super) scheme: Scheme,
    pub(super) load: Load,
    pub(super) rough: bool,
    /// Cells per width.
    pub(super) cells: usize,
}

impl Push {
    /// Its name.
    pub(super) fn variant(&self) -> String {
        let kind = if self.rough { "rough" } else { "smooth" };
        let load = match self.load {
            Load::Centric { place } => format!("edge {place} of a cell beyond a node"),
            Load::Eccentric(e) => format!("e = {e} B"),
            Load::Inclined(ratio) => format!("pushed {ratio}:1 sideways"),
            Load::Sideways => "pushed sideways".to_owned(),
        };
        let scheme = match self.scheme {
            Scheme::Sharp => "shared strain, sharp edges",
            Scheme::Rounded => "B-bar, edges rounded by half a cell",
        };
        format!("{kind}, {load}, {scheme}, B/h = {}", self.cells)
    }

    fn file_name(&self) -> String {
        let kind = if self.rough { "rough" } else { "smooth" };
        let scheme = match self.scheme {
            Scheme::Sharp => "sharp",
            Scheme::Rounded => "rounded",
        };
        let load = match self.load {
            Load::Centric { place } => format!("edge_{place}"),
            Load::Eccentric(e) => format!("eccentric_{e}"),
            Load::Inclined(ratio) => format!("inclined_{ratio}"),
            Load::Sideways => "sideways".to_owned(),
        };
        format!("{load}_{kind}_{scheme}_{}", self.cells)
    }

    /// Lines of the grid across the strip: the right half for a centric load, else all of it, with the edges in the
    /// middle of cells.
    fn columns(&self) -> Vec<f64> {
        let h = 1.0 / self.cells as f64;
        let Load::Centric { place } = self.load else {
            let reach = 14.0_f64.max(1.5 * self.cells as f64).ceil() * h;
            return graded(h, [-reach, reach], [-3.5, 3.5], 1.15);
        };
        // The cell at the axis is as wide as the rest, 0.6 to 1.6 times the others.
        let edge = 0.5 - place * h;
        let mut first = edge - (edge / h).floor() * h;
        if first < 0.6 * h {
            first += h;
        }
        let end = first + ((1.5 - first) / h).ceil() * h;
        let mut lines = vec![0.0];
        lines.extend(graded(h, [first, end], [first, 3.5], 1.15));
        lines
    }

    /// The strip: a body much higher than its base settles, with smooth sides.
    fn strip(&self) -> RigidBody<2> {
        let h = 1.0 / self.cells as f64;
        let e = match self.load {
            Load::Eccentric(e) => e,
            _ => 0.0,
        };
        let rounding = match self.scheme {
            Scheme::Sharp => 0.0,
            Scheme::Rounded => 0.5,
        };
        let corners = [[-0.5, 0.0], [0.5, 0.0], [0.5, 1.0], [-0.5, 1.0]].map(|[x, y]| [x - e, y]);
        let surface = Surface::polygon(&corners, rounding * h, h).expect("the outline has corners");
        let mut sides = vec![Interface::smooth(); surface.side_count()];
        if self.rough {
            sides[0] = Interface::rough();
        }
        RigidBody::new(surface, sides, [e, 0.0])
    }

    /// How it moves between two settlements over the width, the first of which is 0 in the first step.
    fn motion(&self, from: f64, to: f64) -> RigidMotion<2> {
        let down = to - from;
        let mut motion = RigidMotion::displaced([0.0, -down]);
        if from == 0.0 {
            return motion;
        }
        match self.load {
            Load::Centric { .. } => {}
            Load::Eccentric(_) => {
                motion.rotation[0] = Drive::Loaded(0.0);
                // Nothing holds a smooth strip sideways.
                if self.rough {
                    motion.displacement[0] = Drive::Loaded(0.0);
                }
            }
            Load::Inclined(ratio) => motion.displacement[0] = Drive::Moved(ratio * down),
            Load::Sideways => {
                motion.displacement = [Drive::Moved(down), Drive::Loaded(-LIGHT)];
            }
        }
        motion
    }

    /// The push, and settlement, V and H by step.
    pub(super) fn run(&self) -> Result<(RunRecord, Table), CaseError> {
        let h = 1.0 / self.cells as f64;
        let rows = graded(h, [-(0.9 / h).round() * h, 0.0], [-2.5, 0.0], 1.15);
        let ground = Ground::new(self.columns(), rows, 3, 2)?;
        let mut body = Body::new(Particles::new(&ground.seeds)?);
        body.rigid = vec![self.strip()];
        let law: SharedLaw = Arc::new(Tresca::new(Elasticity::new(YOUNG, 0.49)?, 1.0)?);
        let constraints = ground.held()?;
        let settlement = |at: f64| {
            let [first, last] = SETTLEMENT;
            if at > 0.0 {
                first * (last / first).powf(at)
            } else {
                0.0
            }
        };
        let load_path = |from: f64, to: f64| {
            let motion = self.motion(settlement(from), settlement(to));
            weightless(&ground.grid, &constraints, &law, motion)
        };
        let sides = match self.load {
            Load::Centric { .. } => 2.0,
            _ => 1.0,
        };
        let mut curve = Table::new(
            self.file_name(),
            &["settlement_over_B_[-]", "V_[B s_u]", "H_[B s_u]"],
        );
        let mut observe = |accepted: &Accepted<'_, 2>| {
            let [horizontal, vertical] = force(accepted);
            let at = settlement(accepted.report.to);
            curve.push(vec![at, -sides * vertical, horizontal.abs()]);
            ControlFlow::Continue(())
        };
        let mut method = match self.scheme {
            Scheme::Sharp => Method::shared_strain(),
            Scheme::Rounded => Method::igimp_bbar(),
        };
        method.geometry = Geometry::Given;
        let settings = MarchSettings::steps(STEPS);
        let (run, _) = run(
            self.variant(),
            &mut body,
            &method,
            &settings,
            &load_path,
            &mut observe,
        );
        Ok((run, curve))
    }
}
