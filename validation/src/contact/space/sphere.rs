//! A rigid sphere on an elastic half-space: Hertz, in a quarter.

use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use igimp_assembly::{
    Interface, Method, Particles, Penalty, RigidBody, RigidMotion, SharedLaw, Surface,
};
use igimp_cases::CaseError;
use igimp_material::{Elasticity, HenckyElastic};
use igimp_model::check::Band;
use igimp_results::tables::table::Table;
use igimp_solver::{Accepted, Body, MarchSettings};

use super::super::{closed, force, graded, weightless};
use super::Quarter;
use crate::continuum::laboratory::run;
use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};

/// The book's description of the study.
const ABOUT: &str = "A rigid smooth sphere is pressed onto an elastic half-space, in a quarter. The radius of contact is Hertz's for the force that was needed; largest pressure and approach, which err by a share of the cell, are told beside it.";
const HERTZ: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "Hertz; rigid sphere on a half-space",
    locator: "a = (3 P R/(4 E*))^(1/3), p₀ = 3 P/(2 π a²), δ = a²/R",
};
/// Radius, about the radius of contact, and how far the ground reaches \[length\].
const RADIUS: f64 = 1.0;
const CONTACT: f64 = 0.04;
const FAR: f64 = 30.0 * CONTACT;
/// Plane-strain modulus E/(1 − ν²) \[stress\].
const MODULUS: f64 = 1.0;
const POISSON: f64 = 0.3;

/// Results: force, radius of contact and largest pressure, and r, p by contact node.
struct Found {
    run: RunRecord,
    load: f64,
    radius: f64,
    largest: f64,
    profile: Vec<[f64; 2]>,
}

/// Presses the sphere by Hertz's approach for the radius of contact, with so many cells along it.
fn press(cells: usize) -> Result<Found, CaseError> {
    let h = CONTACT / cells as f64;
    let fine = (1.25 * CONTACT / h).ceil() * h;
    let quarter = Quarter::new(
        &graded(h, [0.0, fine], [0.0, FAR], 1.5),
        graded(h, [-fine, 0.0], [-FAR, 0.0], 1.5),
    )?;
    let mut body = Body::new(Particles::new(&quarter.seeds)?);
    let surface = Surface::sphere(RADIUS, h).expect("the sphere has a radius");
    let mut sphere = RigidBody::new(surface, vec![Interface::smooth()], [0.0, 0.0, RADIUS]);
    sphere.penalty = Penalty {
        stiffness: 100.0,
        smoothing: 1e-3,
        ..Penalty::default()
    };
    body.rigid = vec![sphere];
    let elasticity = Elasticity::new(MODULUS * (1.0 - POISSON * POISSON), POISSON)?;
    let law: SharedLaw = Arc::new(HenckyElastic::new(elasticity));
    let constraints = quarter.held()?;
    let depth = CONTACT * CONTACT / RADIUS;
    let load_path = |from: f64, to: f64| {
        let motion = RigidMotion::displaced([0.0, 0.0, -depth * (to - from)]);
        weightless(&quarter.grid, &constraints, &law, motion)
    };
    let mut load = 0.0;
    let mut observe = |accepted: &Accepted<'_, 3>| {
        load = -4.0 * force(accepted)[2];
        ControlFlow::Continue(())
    };
    let (run, _) = run(
        format!("a/h ≈ {cells}"),
        &mut body,
        &Method::igimp_bbar(),
        &MarchSettings::steps(4),
        &load_path,
        &mut observe,
    );
    let (mut sum, mut moment) = (0.0, 0.0);
    let mut profile = Vec::new();
    for (x, node) in closed(&body.rigid) {
        let radius = x[0].hypot(x[1]);
        sum += node.pressure * node.area;
        moment += node.pressure * node.area * radius * radius;
        profile.push([radius, node.pressure]);
    }
    profile.sort_by(|a, b| a[0].total_cmp(&b[0]));
    Ok(Found {
        run,
        load,
        // ∫ p r² dA = (2/5) P a².
        radius: (2.5_f64 * moment / sum).sqrt(),
        largest: largest(&profile),
        profile,
    })
}

/// The largest pressure of Hertz's p² = p₀² (1 − r²/a²), by least squares over the part with at least a third of the
/// largest pressure.
fn largest(profile: &[[f64; 2]]) -> f64 {
    let most = profile.iter().fold(0.0, |most: f64, row| most.max(row[1]));
    let (mut n, mut sx, mut sy, mut sxx, mut sxy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for [r, p] in profile.iter().filter(|row| row[1] > most / 3.0) {
        let (x, y) = (r * r, p * p);
        n += 1.0;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    let slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    ((sy - slope * sx) / n).sqrt()
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("contact-sphere", ABOUT, out)?;
    let meshes: &[usize] = match level {
        Level::Quick | Level::Default => &[4],
        Level::Full => &[4, 6, 8],
    };
    let mut errors = Table::new(
        "errors",
        &["a_over_h_[-]", "radius_[-]", "pressure_[-]", "approach_[-]"],
    );
    for &cells in meshes {
        let found = press(cells)?;
        let run = study.run_to_end(found.run);
        let radius = (0.75 * found.load * RADIUS / MODULUS).cbrt();
        let pressure = 1.5 * found.load / (PI * radius * radius);
        let approach = radius * radius / RADIUS;
        let band = Band::Relative(0.03);
        let quantity = "radius of contact a/R [-]";
        study.check(run, quantity, HERTZ.says(radius), band, found.radius);
        let off = [
            found.radius / radius,
            found.largest / pressure,
            CONTACT * CONTACT / RADIUS / approach,
        ]
        .map(|ratio| ratio - 1.0);
        let note = format!(
            "contact-sphere, a/h ≈ {cells}: a is off by {:+.2} %, p₀ by {:+.2} %, δ by {:+.2} %",
            100.0 * off[0],
            100.0 * off[1],
            100.0 * off[2]
        );
        study.notes.push(note);
        // The error of pressure and approach is a share of the cell: two meshes give it.
        if let Some(before) = errors.rows.last() {
            let [coarse, fine] = [before[0], cells as f64];
            let limit = |k: usize| off[k] + (off[k] - before[k + 1]) * coarse / (fine - coarse);
            study.notes.push(format!(
                "contact-sphere, extrapolated from a/h = {coarse} and {fine}: p₀ is off by {:+.2} %, δ by {:+.2} %",
                100.0 * limit(1),
                100.0 * limit(2)
            ));
        }
        errors.push(vec![cells as f64, off[0], off[1], off[2]]);
        let mut profile = Table::new(
            format!("pressure_{cells}"),
            &["r_over_a_[-]", "p_over_p0_[-]"],
        );
        for [r, p] in &found.profile {
            profile.push(vec![r / radius, p / pressure]);
        }
        profile.write_csv(&study.folder)?;
    }
    errors.write_csv(&study.folder)?;
    Ok(study)
}
