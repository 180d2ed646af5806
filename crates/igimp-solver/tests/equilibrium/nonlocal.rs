//! GOAL: a sheared layer that softens over a length: width of its band, slope of softening, peak and snap-back, on three meshes.
//! BODY: a column of unit cells between a lower side that is held and an upper one that is pushed or loaded along. Its middle row is
//! 1 % weaker, and what is farther than 3 l from it 5 % stronger, so that one band forms there and no half of one at a side. Strength
//! falls on a line, so that all is linear behind the peak.
//! ORACLE: eq. 110e, the closed form of $`\bar\kappa - l^2 \bar\kappa'' = \kappa`$ with $`\tau = c + H (m \bar\kappa + (1 - m) \kappa)`$ over slip:
//! with s = √(m − 1) the band is w = 2 l s (π − atan 1/s) wide, and $`\mathrm{d}\tau/\mathrm{d}\delta = H/(w + 2l)`$. A layer of
//! height T snaps back beyond −H T = G (w + 2l).

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::body_support::{bits, block, elasticity, unit_grid, workspace};
use igimp_assembly::{
    Constraints, Geometry, Kinematics, Method, ParticleFields, Particles, SharedLaw,
    StepConditions, StepLoads,
};
use igimp_material::{Curve, Decay, Nonlocal, Softening};
use igimp_shape::Grid;
use igimp_solver::{
    Accepted, Body, ContinuationSettings, ContinuationState, MarchReport, MarchSettings,
    MarchState, NewtonSettings, Observed, Outcome, follow, march_from,
};

/// c_u at first, and in the end \[stress\].
const CU: [f64; 2] = [1.0, 0.05];

/// Share of it that the middle row has \[-\].
const WEAK: f64 = 0.99;

/// Share of it that soil far from the middle has \[-\].
const STRONG: f64 = 1.05;

/// Plastic strain of the curve \[-\].
const STRAIN: f64 = 0.27;

/// Share of the load factor in which a push goes fast \[-\].
const FAST: f64 = 0.2;

/// Rows whose plastic strain grows by less than this share of the most are at the edge of a band \[-\].
const EDGE: f64 = 0.05;

/// A layer and how it softens.
#[derive(Clone, Copy)]
struct Layer {
    /// Height \[cells\].
    cells: usize,
    /// Length over which plastic strain is spread \[cells\].
    length: f64,
    over_nonlocal: f64,
    /// Plastic strain of the curve \[-\].
    strain: f64,
    is_tresca: bool,
}

/// A point of its path.
#[derive(Clone, Debug)]
struct Point {
    /// Displacement of the upper side \[length\].
    travel: f64,
    /// Shear stress \[stress\].
    tau: f64,
    /// Plastic strain of rows of cells, upwards \[-\].
    plastic: Vec<f64>,
}

impl Layer {
    /// Slope of softening by plastic shear, H \[stress\].
    fn slope(&self) -> f64 {
        (CU[1] - CU[0]) / (3.0_f64.sqrt() * self.strain)
    }

    /// Width of the band \[length\].
    fn width(&self) -> f64 {
        let s = (self.over_nonlocal - 1.0).sqrt();
        2.0 * self.length * s * (std::f64::consts::PI - (1.0 / s).atan())
    }

    /// Slope of softening by slip, H/(w + 2l) \[stress/length\].
    fn slope_by_slip(&self) -> f64 {
        self.slope() / (self.width() + 2.0 * self.length)
    }

    fn law(&self, share: f64) -> SharedLaw {
        let cu = Curve {
            initial: share * CU[0],
            residual: CU[1],
            strain: self.strain,
            decay: Decay::Linear,
        };
        let law = if self.is_tresca {
            Softening::tresca(elasticity(), cu)
        } else {
            Softening::von_mises(elasticity(), cu)
        };
        let nonlocal = Nonlocal {
            length: self.length,
            over_nonlocal: self.over_nonlocal,
        };
        Arc::new(law.unwrap().with_nonlocal(nonlocal).unwrap())
    }

    fn laws(&self) -> Vec<SharedLaw> {
        [1.0, WEAK, STRONG].map(|share| self.law(share)).to_vec()
    }

    fn grid(&self) -> Grid<2> {
        unit_grid([1, self.cells])
    }

    /// The body, its middle row of the weaker law and what is far of the stronger; the uppermost row alone has mass.
    fn body(&self) -> Body<2> {
        let body = block(&self.grid(), [0, 0], [1, self.cells]);
        let mut fields: ParticleFields<2> = (*body.particles).clone();
        for (particle, x) in fields.x.iter().enumerate() {
            let row = x[1].floor() as usize;
            let apart = row.abs_diff(self.cells / 2) as f64;
            fields.law[particle] = if apart > 3.0 * self.length {
                2
            } else {
                usize::from(apart < 1.0)
            };
            fields.mass[particle] = if row + 1 == self.cells { 0.25 } else { 0.0 };
        }
        Body::new(Particles::from_fields(fields).unwrap())
    }

    /// Held below, upright everywhere, and pushed above if it is.
    fn constraints(&self, travel: Option<f64>) -> Constraints<2> {
        let grid = self.grid();
        let mut constraints = Constraints::free(&grid);
        for column in 0..=1 {
            for row in 0..=self.cells {
                let node = grid.node_index([column, row]);
                constraints.prescribe(node, 1, 0.0).unwrap();
            }
            let base = grid.node_index([column, 0]);
            constraints.prescribe(base, 0, 0.0).unwrap();
            if let Some(travel) = travel {
                let top = grid.node_index([column, self.cells]);
                constraints.prescribe(top, 0, travel).unwrap();
            }
        }
        constraints
    }

    /// Shears the layer by the displacements that `travel` makes of the load factor, until the observer ends it.
    fn march(
        &self,
        (body, state): (&mut Body<2>, MarchState),
        method: &Method,
        travel: &dyn Fn(f64) -> f64,
        steps: usize,
        observe: &mut dyn FnMut(Point, &MarchState) -> ControlFlow<()>,
    ) -> MarchReport {
        let laws = self.laws();
        let load_path = |from: f64, to: f64| {
            let loads = StepLoads::gravity([0.0; 2]);
            let constraints = self.constraints(Some(travel(to) - travel(from)));
            StepConditions::new(self.grid(), constraints, loads, laws.clone())
        };
        march_from(
            state,
            body,
            method,
            &MarchSettings::steps(steps),
            &mut workspace(),
            &mut Observed {
                load_path: &load_path,
                observer: &mut |accepted: &Accepted<'_, 2>| {
                    let particles = &accepted.body.particles;
                    let point = Point::of(particles, self.cells, travel(accepted.report.to));
                    observe(point, accepted.state)
                },
            },
        )
    }

    /// The path by a displacement that grows fast to its share `slowly` at the peak of intact soil, and then slowly by `more` of that,
    /// to a stress behind the peak, or as far as there is equilibrium; and whether the stress was reached.
    fn sheared(&self, method: &Method, [slowly, more]: [f64; 2], to: f64) -> (Vec<Point>, bool) {
        let peak = self.cells as f64 * CU[0] / elasticity().shear();
        let travel = |factor: f64| {
            let fast = (factor / FAST).min(1.0) * slowly;
            peak * (fast + more * (factor - FAST).max(0.0) / (1.0 - FAST))
        };
        let steps = 200;
        let state = MarchState::start(&MarchSettings::steps(steps));
        let mut path: Vec<Point> = Vec::new();
        let mut most = 0.0_f64;
        let report = self.march(
            (&mut self.body(), state),
            method,
            &travel,
            steps,
            &mut |point, _| {
                let is_over = point.tau < most && point.tau < to;
                most = most.max(point.tau);
                path.push(point);
                if is_over {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            },
        );
        (path, matches!(report.outcome, Outcome::Stopped { .. }))
    }

    /// The path under a load, by continuation, to a stress behind the peak.
    fn followed(&self, method: &Method, until: f64) -> Vec<Point> {
        let laws = self.laws();
        let load_path = |_: f64, to: f64| {
            // The load factor is the stress below the uppermost row.
            let loads = StepLoads::gravity([to, 0.0]);
            StepConditions::new(self.grid(), self.constraints(None), loads, laws.clone())
        };
        let settings = ContinuationSettings::new(NewtonSettings::default());
        let mut state = ContinuationState::start(0.9, None, &settings);
        let mut body = self.body();
        let mut path: Vec<Point> = Vec::new();
        let failure = follow(
            &mut state,
            &mut body,
            method,
            &settings,
            &mut workspace(),
            &mut Observed {
                load_path: &load_path,
                observer: &mut |accepted: &Accepted<'_, 2>| {
                    let particles = &accepted.body.particles;
                    let uppermost = particles.x.iter().map(|x| x[1]).fold(0.0, f64::max);
                    let travel = std::iter::zip(&particles.x, &particles.displacement)
                        .find(|(x, _)| x[1] >= uppermost)
                        .map_or(0.0, |(_, u)| u[0]);
                    path.push(Point {
                        tau: accepted.report.to,
                        ..Point::of(particles, self.cells, travel)
                    });
                    if accepted.report.to < until {
                        ControlFlow::Break(())
                    } else {
                        ControlFlow::Continue(())
                    }
                },
            },
        );
        assert!(failure.is_none(), "{failure:?}");
        path
    }
}

impl Point {
    fn of(particles: &Particles<2>, cells: usize, travel: f64) -> Self {
        let mut plastic = vec![0.0; cells];
        for (x, internal) in particles.x.iter().zip(&particles.internal) {
            plastic[x[1].floor() as usize] += 0.25 * internal[0];
        }
        let stresses = particles.sigma.iter().map(|sigma| sigma[0][1]);
        Self {
            travel,
            tau: stresses.sum::<f64>() / particles.len() as f64,
            plastic,
        }
    }

    /// The width over which plastic strain grew since another point, two rows on either side drawn on to zero \[length\].
    fn width_since(&self, other: &Self) -> f64 {
        let grew: Vec<f64> = std::iter::zip(&self.plastic, &other.plastic)
            .map(|(now, other)| now - other)
            .collect();
        let most = grew.iter().copied().fold(0.0, f64::max);
        let rows: Vec<(f64, f64)> = (grew.into_iter().enumerate())
            .filter(|(_, value)| *value > EDGE * most)
            .map(|(row, value)| (row as f64, value))
            .collect();
        let zero =
            |[(y, value), (next, more)]: [(f64, f64); 2]| y - value * (next - y) / (more - value);
        let n = rows.len();
        zero([rows[n - 1], rows[n - 2]]) - zero([rows[0], rows[1]])
    }

    fn most_plastic(&self) -> f64 {
        self.plastic.iter().copied().fold(0.0, f64::max)
    }
}

/// The slope of a quantity over stress between two stresses behind the peak, by least squares.
fn by_stress(path: &[Point], [upper, lower]: [f64; 2], of: impl Fn(&Point) -> f64) -> f64 {
    let peak = (0..path.len())
        .max_by(|&a, &b| path[a].tau.total_cmp(&path[b].tau))
        .unwrap();
    let points: Vec<[f64; 2]> = path[peak..]
        .iter()
        .filter(|point| point.tau < upper && point.tau > lower)
        .map(|point| [point.tau, of(point)])
        .collect();
    assert!(points.len() >= 3, "{} points", points.len());
    let n = points.len() as f64;
    let mean = [0, 1].map(|k| points.iter().map(|point| point[k]).sum::<f64>() / n);
    let sum = |k: usize| {
        points
            .iter()
            .map(|p| (p[0] - mean[0]) * (p[k] - mean[k]))
            .sum::<f64>()
    };
    sum(1) / sum(0)
}

fn small_strain(method: Method) -> Method {
    Method {
        kinematics: Kinematics::SmallStrain,
        geometry: Geometry::Given,
        ..method
    }
}

/// A layer of 16 l on cells of l/`length`.
fn layer(length: usize, over_nonlocal: f64) -> Layer {
    Layer {
        cells: 16 * length + 1,
        length: length as f64,
        over_nonlocal,
        strain: STRAIN,
        is_tresca: false,
    }
}

/// Slope over slip and width over the closed form, and the peak over the strength.
fn over_closed_form(layer: &Layer, method: &Method) -> [f64; 3] {
    let path = layer.followed(method, 0.6);
    let peak = path
        .iter()
        .fold(0.0, |peak: f64, point| point.tau.max(peak));
    let mut behind = path.iter().skip_while(|point| point.tau < peak);
    let begun = behind.find(|point| point.tau <= 0.9).unwrap();
    let last = &path[path.len() - 1];
    let fall = last.tau - begun.tau;
    let elastic = layer.cells as f64 / elasticity().shear();
    let slip = last.travel - begun.travel - elastic * fall;
    [
        fall / slip / layer.slope_by_slip(),
        last.width_since(begun) / layer.width(),
        peak / CU[0],
    ]
}

/// Holds what was found against the closed form: 1 %, and the peak between the strengths of both laws.
fn holds(label: &str, found: [f64; 3]) {
    println!("{label}: slope, width, peak over exact {found:.5?}");
    for ratio in &found[..2] {
        assert!((ratio - 1.0).abs() < 0.01, "{label}: {found:?}");
    }
    assert!(found[2] > WEAK && found[2] <= 1.0, "{label}: {found:?}");
}

/// GOAL: a static march under a load passes its peak by continuation, and on cells of l/6, l/8 and l/10 slope and width are
/// within 1 % of the closed form, for m = 1.5 and 2.
#[test]
fn a_sheared_layer_has_the_band_of_the_closed_form() {
    let method = small_strain(Method::igimp_bbar());
    for over_nonlocal in [1.5, 2.0] {
        for length in [6, 8, 10] {
            let found = over_closed_form(&layer(length, over_nonlocal), &method);
            holds(&format!("m = {over_nonlocal}, cells of l/{length}"), found);
        }
        let coarse = over_closed_form(&layer(2, over_nonlocal), &method);
        println!("m = {over_nonlocal}, cells of l/2: {coarse:.5?}");
        assert!((coarse[0] - 1.0).abs() < 0.05, "{coarse:?}");
    }
}

/// GOAL: the same of Tresca's law, with the linear basis, and with shared strain. ORACLE: the same.
#[test]
fn other_laws_and_methods_have_the_same_band() {
    for (name, method, is_tresca) in [
        ("Tresca", Method::igimp_bbar(), true),
        ("linear, B-bar", Method::impm_bbar(), false),
        ("shared strain", Method::shared_strain(), false),
    ] {
        let layer = Layer {
            is_tresca,
            ..layer(6, 2.0)
        };
        holds(name, over_closed_form(&layer, &small_strain(method)));
    }
}

/// GOAL: with m = 1 there is no band: plastic strain gathers in one row of cells, whatever their size.
/// ORACLE: the closed form has w = 0; with m = 2 a row of cells of l/4 has no more than κ_max h/(w + 2l) = 9 % of it.
#[test]
fn without_overshoot_plastic_strain_gathers_in_one_row() {
    let method = small_strain(Method::igimp_bbar());
    let share = |layer: &Layer| {
        let (path, _) = layer.sheared(&method, [0.985, 0.06], 0.98);
        let last = &path[path.len() - 1];
        assert!(last.tau < WEAK, "beyond the peak: {}", last.tau);
        last.most_plastic() / last.plastic.iter().sum::<f64>()
    };
    let shares = [2, 3, 4].map(|length| share(&layer(length, 1.0)));
    let found = over_closed_form(&layer(4, 2.0), &method);
    println!("m = 1: share of plastic strain in one row of cells {shares:.4?}; m = 2 {found:.4?}");
    assert!(shares.iter().all(|share| *share > 0.99), "{shares:?}");
}

/// GOAL: a layer snaps back from −H T = G (w + 2l) on: 1 %; a march by displacement passes the peak of a lower one and finds no
/// equilibrium beside that of a higher one. ORACLE: closed form.
#[test]
fn a_layer_snaps_back_from_its_closed_form_on() {
    let method = small_strain(Method::igimp_bbar());
    let shear = elasticity().shear();
    let of_height = |cells: usize| Layer {
        cells,
        // The layer of 64 cells is the one that snaps back.
        strain: 64.0 * (CU[0] - CU[1])
            / (3.0_f64.sqrt() * shear * (3.0 * std::f64::consts::FRAC_PI_2 + 2.0) * 4.0),
        ..layer(4, 2.0)
    };
    let critical = -shear / of_height(64).slope_by_slip();
    assert!((critical - 64.0).abs() < 1e-9, "{critical}");
    let slowly = [0.98, 0.2];
    let [low, high] = [50, 58].map(|cells| {
        let (path, is_passed) = of_height(cells).sheared(&method, slowly, 0.5);
        assert!(is_passed, "{cells} cells");
        let by_stress = by_stress(&path, [0.85, 0.55], |point| point.travel);
        println!("{cells} cells: dU/dτ = {by_stress:.5}");
        (cells as f64, by_stress)
    });
    // Displacement over stress is linear in the height: where it is zero the layer snaps back.
    let found = low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1);
    println!("snap-back from {found:.3} cells on, exact {critical:.3}");
    assert!((found / critical - 1.0).abs() < 0.01, "{found} {critical}");
    let (path, _) = of_height(70).sheared(&method, slowly, 0.5);
    let falls = path.windows(2).map(|pair| pair[0].tau - pair[1].tau);
    let most = falls.fold(0.0, f64::max);
    let last = &path[path.len() - 1];
    println!("70 cells: down to {:.4}, largest fall {most:.4}", last.tau);
    // It stops at the peak, or leaps to the residual strength.
    assert!(last.tau > 0.95 || most > 0.5, "{} {most}", last.tau);
}

/// GOAL: a march that is taken up half-way has the bits of one that was not; nonlocal strain is carried by the particles.
/// ORACLE: the march that was not.
#[test]
fn a_march_that_is_taken_up_keeps_its_bits() {
    let layer = Layer {
        cells: 17,
        ..layer(2, 2.0)
    };
    let method = small_strain(Method::igimp_bbar());
    let run = |stop: Option<usize>| {
        let (mut body, steps) = (layer.body(), 24);
        let mut state = MarchState::start(&MarchSettings::steps(steps));
        loop {
            let (mut count, mut after) = (0, state);
            let report = layer.march(
                (&mut body, state),
                &method,
                &|factor| 1.2 * factor,
                steps,
                &mut |_, state| {
                    (count, after) = (count + 1, *state);
                    if Some(count) == stop {
                        ControlFlow::Break(())
                    } else {
                        ControlFlow::Continue(())
                    }
                },
            );
            state = after;
            if report.outcome == Outcome::Completed {
                return bits(&body);
            }
            assert!(matches!(report.outcome, Outcome::Stopped { .. }));
        }
    };
    let whole = run(None);
    assert!(whole.contains("internal"));
    assert_eq!(whole, run(Some(11)));
}
