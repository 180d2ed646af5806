//! A rigid cylinder on an elastic half-plane: Hertz, and Cattaneo and Mindlin under a tangential load.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    Drive, Interface, Method, Particles, Penalty, RigidBody, RigidMotion, SharedLaw, Surface,
};
use igimp_cases::CaseError;
use igimp_material::{Elasticity, HenckyElastic};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use igimp_solver::{Accepted, Body, MarchSettings};

use super::{Ground, closed, force, graded, weightless};
use crate::continuum::laboratory::run;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "A rigid cylinder is pressed onto an elastic half-plane, smooth, and with friction pushed sideways. Half-width and pressure are Hertz's, the stick zone is that of Cattaneo and Mindlin.";
const HERTZ: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Hertz; rigid cylinder on a half-plane",
    locator: "b = 2 √(P R/(π E*)), p₀ = √(P E*/(π R))",
};
const CATTANEO: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Cattaneo 1938, Mindlin 1949; Goodman's approximation, exact for ν = 1/2",
    locator: "c/b = √(1 − Q/(μ P)), and q(0)/(μ p(0)) = 1 − c/b",
};
/// Radius \[length\], and about the half-width of contact.
const RADIUS: f64 = 1.0;
const HALF_WIDTH: f64 = 0.04;
/// Plane-strain modulus E/(1 − ν²) \[stress\].
const MODULUS: f64 = 1.0;

/// A cylinder on ground; `cells` along the expected half-width.
struct Cylinder {
    cells: usize,
    poisson: f64,
    interface: Interface,
    /// Sideways push at the end \[length\], under the load that the indentation needed.
    sideways: f64,
}

/// Results at the end: tangential and vertical force, half-width and largest pressure of the
/// profile, and the share of friction that the middle takes.
struct Found {
    run: RunRecord,
    force: [f64; 2],
    half_width: f64,
    largest: f64,
    /// Shear over pressure in the middle \[-\].
    middle: f64,
    profile: Vec<[f64; 3]>,
}

impl Cylinder {
    fn press(&self) -> Result<Found, CaseError> {
        let h = HALF_WIDTH / self.cells as f64;
        let (fine, far) = (1.75 * HALF_WIDTH, 14.0 * HALF_WIDTH);
        let fine = (fine / h).ceil() * h;
        let ground = Ground::new(
            graded(h, [-fine, fine], [-far, far], 1.2),
            graded(h, [-fine, 0.0], [-far, 0.0], 1.2),
            3,
            2,
        )?;
        let mut body = Body::new(Particles::new(&ground.seeds)?);
        let surface = Surface::circle(RADIUS, 2.0 * h).expect("the cylinder has a radius");
        let mut cylinder = RigidBody::new(surface, vec![self.interface.clone()], [0.0, RADIUS]);
        cylinder.penalty = Penalty {
            stiffness: 100.0,
            smoothing: 1e-3,
            ..Penalty::default()
        };
        body.rigid = vec![cylinder];
        let young = MODULUS * (1.0 - self.poisson.powi(2));
        let elasticity = Elasticity::new(young, self.poisson)?;
        let law: SharedLaw = Arc::new(HenckyElastic::new(elasticity));
        let constraints = ground.held()?;
        let pressed = std::cell::Cell::new(0.0);
        let depth = 2.1e-3;
        let load_path = |from: f64, to: f64| {
            let mut motion = RigidMotion::displaced([0.0, -2.0 * depth * (to - from)]);
            if from >= 0.5 {
                let by = 2.0 * self.sideways * (to - from);
                motion.displacement = if self.sideways > 0.0 {
                    [Drive::Moved(by), Drive::Loaded(pressed.get())]
                } else {
                    [Drive::Moved(0.0); 2]
                };
            }
            weightless(&ground.grid, &constraints, &law, motion)
        };
        let mut last = [0.0; 2];
        let mut observe = |accepted: &Accepted<'_, 2>| {
            last = force(accepted);
            if accepted.report.to <= 0.5 {
                pressed.set(last[1]);
                if self.sideways == 0.0 && accepted.report.to >= 0.5 {
                    return ControlFlow::Break(());
                }
            } else {
                last[1] = pressed.get();
            }
            ControlFlow::Continue(())
        };
        let (run, _) = run(
            format!("b/h ≈ {}, ν = {}", self.cells, self.poisson),
            &mut body,
            &Method::igimp_bbar(),
            &MarchSettings::steps(12),
            &load_path,
            &mut observe,
        );
        let profile = profile(&body.rigid);
        let middle = profile
            .iter()
            .min_by(|a, b| a[0].abs().total_cmp(&b[0].abs()))
            .map_or(f64::NAN, |knot| knot[2] / knot[1]);
        let [half_width, largest] = fitted(&profile);
        Ok(Found {
            run,
            force: last,
            half_width,
            largest,
            middle: middle.abs(),
            profile,
        })
    }
}

/// Place beside the axis, pressure and shear of the knots in contact, from left to right.
fn profile(bodies: &[RigidBody<2>]) -> Vec<[f64; 3]> {
    let axis = bodies[0].pose.origin[0];
    let mut profile: Vec<[f64; 3]> = closed(bodies)
        .iter()
        .map(|(x, node)| [x[0] - axis, node.pressure, node.shear[0]])
        .collect();
    profile.sort_by(|a, b| a[0].total_cmp(&b[0]));
    profile
}

/// Half-width and largest pressure of Hertz's ellipse with the second moment of a profile and with its
/// squares: ∫ p x² = P b²/4, and p² = p₀² (1 − x²/b²) by least squares over the part with at least a third
/// of the largest pressure.
fn fitted(profile: &[[f64; 3]]) -> [f64; 2] {
    let most = profile.iter().fold(0.0, |most: f64, row| most.max(row[1]));
    let (mut sum, mut moment) = (0.0, 0.0);
    let (mut n, mut sx, mut sy, mut sxx, mut sxy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for [x, p, _] in profile {
        sum += p;
        moment += p * x * x;
        if *p > most / 3.0 {
            let (x, y) = (x * x, p * p);
            n += 1.0;
            sx += x;
            sy += y;
            sxx += x * x;
            sxy += x * y;
        }
    }
    let slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    [2.0 * (moment / sum).sqrt(), ((sy - slope * sx) / n).sqrt()]
}

/// Tells the errors of all meshes, and checks their order.
fn refinement(study: &mut Study, third: usize, rows: &[Vec<f64>]) {
    for row in rows {
        study.notes.push(format!(
            "contact-hertz, b/h ≈ {:.0}: b is off by {:.2} %, p₀ by {:.2} %",
            row[0],
            100.0 * row[1],
            100.0 * row[2]
        ));
    }
    // On a fourth mesh the error has changed its sign, and tells no order.
    if let [first, _, end, ..] = rows {
        let order = (first[1] / end[1]).abs().ln() / (end[0] / first[0]).ln();
        study.check(
            third,
            "order of the error of b over the first three meshes [-]",
            HERTZ.says(1.0),
            Band::AtLeast(1.0),
            order,
        );
    }
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-hertz", ABOUT, out)?;
    let meshes: &[usize] = match level {
        Level::Quick => &[8],
        Level::Default => &[4, 8, 16],
        Level::Full => &[4, 8, 16, 32],
    };
    let mut errors = Table::new(
        "errors",
        &["b_over_h_[-]", "half_width_[-]", "pressure_[-]"],
    );
    let mut third = 0;
    for &cells in meshes {
        let found = Cylinder {
            cells,
            poisson: 0.3,
            interface: Interface::smooth(),
            sideways: 0.0,
        }
        .press()?;
        let last = study.run_to_end(found.run);
        let load = -found.force[1];
        let width = 2.0 * (load * RADIUS / (std::f64::consts::PI * MODULUS)).sqrt();
        let pressure = (load * MODULUS / (std::f64::consts::PI * RADIUS)).sqrt();
        if cells == 16 {
            third = last;
        }
        errors.push(vec![
            cells as f64,
            found.half_width / width - 1.0,
            found.largest / pressure - 1.0,
        ]);
        if cells >= 8 {
            let band = Band::Relative(0.03);
            study.check(
                last,
                "half-width b/R [-]",
                HERTZ.says(width),
                band,
                found.half_width,
            );
            study.check(
                last,
                "largest pressure p₀/E* [-]",
                HERTZ.says(pressure),
                band,
                found.largest,
            );
        }
        let mut profile = Table::new(
            format!("pressure_{cells}"),
            &["x_over_b_[-]", "p_over_p0_[-]"],
        );
        for row in &found.profile {
            profile.push(vec![row[0] / width, row[1] / pressure]);
        }
        study.table(profile)?;
    }
    refinement(&mut study, third, &errors.rows);
    errors.write_csv(&study.folder)?;
    if level > Level::Quick {
        friction(&mut study)?;
    }
    Ok(study)
}

/// A cylinder that is pressed and pushed sideways: the middle sticks, the rest slides.
fn friction(study: &mut Study) -> Result<(), CaseError> {
    let friction = 0.5;
    let found = Cylinder {
        cells: 16,
        poisson: 0.4999,
        interface: Interface::friction(friction),
        sideways: 5e-4,
    }
    .press()?;
    let run = study.run_to_end(found.run);
    let share = found.force[0].abs() / (friction * -found.force[1]);
    let stick = (1.0 - share).sqrt();
    let quantity = format!("stick zone c/b at Q/(μ P) = {share:.3} [-]");
    let measured = 1.0 - found.middle / friction;
    study.check(
        run,
        quantity,
        CATTANEO.says(stick),
        Band::Relative(0.03),
        measured,
    );
    let mut profile = Table::new("shear", &["x_[-]", "p_[-]", "q_[-]"]);
    for row in &found.profile {
        profile.push(row.to_vec());
    }
    study.table(profile)?;
    Ok(())
}
