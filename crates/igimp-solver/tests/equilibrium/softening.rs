//! GOAL: slip of soil that softens gathers in one row of cells, whatever the mesh, so that strains scaled by a width over the size of
//! a cell keep the work per area (theory, eq. 110).
//! BODY: a layer sheared between its lower and its upper side, of 4, 8 and 16 unit cells, one row of which is 1 % weaker.
//! ORACLE: the work per area of a band of a width w, w √3 (c_p − c_r) κ_r/2 beyond residual friction, that of eq. 109.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::body_support::{block, elasticity, unit_grid, workspace};
use igimp_assembly::{
    Constraints, Geometry, Kinematics, Method, ParticleFields, Particles, SharedLaw,
    StepConditions, StepLoads,
};
use igimp_material::{Curve, Decay, Softening};
use igimp_solver::element::{self, ElementTest, StandardTest};
use igimp_solver::{Accepted, Body, MarchSettings, Outcome, march};

/// c_u at first, and in the end \[stress\].
const CU: [f64; 2] = [1.0, 0.3];

/// Plastic strain of the curve on cells of a quarter of the layer \[-\].
const STRAIN: f64 = 0.2;

/// A sheared layer of `cells` cells.
struct Layer {
    /// Width of the band over the size of a cell, by the work that softening takes \[-\].
    band: f64,
    /// Shear stress in the end \[stress\].
    residual: f64,
    /// That of the law, at its largest.
    peak: f64,
}

fn law(peak: f64, ratio: f64) -> SharedLaw {
    let cu = Curve {
        initial: peak,
        residual: CU[1],
        strain: STRAIN * ratio,
        decay: Decay::Linear,
    };
    Arc::new(Softening::tresca(elasticity(), cu).unwrap())
}

fn sheared(cells: usize, method: &Method) -> Layer {
    let grid = unit_grid([2, cells]);
    // A width of a quarter of the layer over the size of a cell.
    let ratio = cells as f64 / 4.0;
    let body = block(&grid, [0, 0], [2, cells]);
    let mut fields: ParticleFields<2> = (*body.particles).clone();
    for (law, x) in fields.law.iter_mut().zip(&fields.x) {
        *law = usize::from(x[1].floor() as usize == cells / 2);
    }
    let mut body = Body::new(Particles::from_fields(fields).unwrap());
    let travel = 0.2 * cells as f64;
    let laws = vec![law(CU[0], ratio), law(0.99 * CU[0], ratio)];
    let load_path = |from: f64, to: f64| {
        let mut constraints = Constraints::free(&grid);
        for column in 0..=2 {
            for row in 0..=cells {
                constraints.prescribe(grid.node_index([column, row]), 1, 0.0)?;
            }
            constraints.prescribe(grid.node_index([column, 0]), 0, 0.0)?;
            let top = grid.node_index([column, cells]);
            constraints.prescribe(top, 0, travel * (to - from))?;
        }
        let loads = StepLoads {
            gravity: [0.0; 2],
            factors: Vec::new(),
            drag: 0.0,
        };
        StepConditions::new(grid.clone(), constraints, loads, laws.clone())
    };
    let mut curve = vec![[0.0, 0.0]];
    let report = march(
        &mut body,
        method,
        &load_path,
        &MarchSettings::steps(200),
        &mut workspace(),
        &mut |accepted: &Accepted<'_, 2>| {
            let particles = &accepted.body.particles;
            let mean = particles.sigma.iter().map(|sigma| sigma[0][1]).sum::<f64>()
                / particles.len() as f64;
            curve.push([travel * accepted.report.to, mean]);
            ControlFlow::Continue(())
        },
    );
    assert_eq!(
        report.outcome,
        Outcome::Completed,
        "{:?}",
        report.failures.last()
    );
    let residual = curve[curve.len() - 1][1];
    let shear = elasticity().shear();
    let work: f64 = curve
        .windows(2)
        .map(|pair| {
            // Slip is what is not elastic.
            let slip = |[travel, tau]: [f64; 2]| travel - cells as f64 * tau / shear;
            (0.5 * (pair[0][1] + pair[1][1]) - CU[1]) * (slip(pair[1]) - slip(pair[0]))
        })
        .sum();
    Layer {
        band: work / (0.5 * 3.0_f64.sqrt() * STRAIN * ratio * (0.99 * CU[0] - CU[1])),
        residual,
        peak: curve.iter().fold(0.0, |most: f64, [_, tau]| most.max(*tau)),
    }
}

/// GOAL: work per area on three meshes within 3 % of each other and of a band of a cell, from a peak to residual strength.
#[test]
fn work_per_area_does_not_depend_on_the_mesh() {
    let methods = [
        ("shared strain", Method::shared_strain()),
        ("B-bar", Method::igimp_bbar()),
        ("linear, B-bar", Method::impm_bbar()),
    ];
    for (name, method) in methods {
        let method = Method {
            kinematics: Kinematics::SmallStrain,
            geometry: Geometry::Given,
            ..method
        };
        let layers = [4, 8, 16].map(|cells| sheared(cells, &method));
        for layer in &layers {
            println!("{name}: band of {:.4} cells", layer.band);
            assert!(
                (layer.band / layers[0].band - 1.0).abs() < 0.03,
                "{name} {}",
                layer.band
            );
            assert!((layer.band - 1.0).abs() < 0.03, "{name} {}", layer.band);
            assert!(
                (layer.residual - CU[1]).abs() < 1e-6,
                "{name} {}",
                layer.residual
            );
            assert!(
                layer.peak > 0.98 * CU[0] && layer.peak < 0.99 * CU[0] + 1e-6,
                "{name} {}",
                layer.peak
            );
        }
    }
}

/// GOAL: simple shear of one piece of soil follows the curve: 1e-9 of the strength. ORACLE: eq. 109, linear strain.
#[test]
fn simple_shear_of_an_element_follows_the_curve() {
    let law = law(CU[0], 0.5);
    let test = ElementTest {
        sigma: [0.0; 3],
        path: StandardTest::SimpleShearUndrained.path(0.15),
        steps: 40,
        kinematics: element::Kinematics::Small,
        durations: Vec::new(),
    };
    let run = test.run(&*law).unwrap();
    assert!(run.failure.is_none());
    let shear = elasticity().shear();
    let fall = (CU[0] - CU[1]) / (3.0_f64.sqrt() * 0.5 * STRAIN);
    for state in &run.states {
        let gamma = state.strain[3];
        let expected = if gamma * shear <= CU[0] {
            gamma * shear
        } else {
            (CU[0] - fall * gamma) / (1.0 - fall / shear)
        };
        let (tau, expected) = (state.sigma[0][1], expected.max(0.0));
        assert!((tau - expected).abs() < 1e-9, "{gamma} {tau} {expected}");
    }
    let left = run.states.last().map_or(0.0, |state| state.sigma[0][1]);
    assert!(left < 0.5 * CU[0], "{left}");
}
