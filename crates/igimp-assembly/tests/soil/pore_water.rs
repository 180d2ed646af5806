//! GOAL: water in the pores acts as it must: hydrostatic pressure leaves buoyant weight; the tangent of undrained soil and
//! of soil under a pressure of its own is the derivative of the internal force; water that cannot leave takes its share.
//! ORACLE: Archimedes; central differences; Skempton's B; bulk modulus of water in closed form; work of a pressure.

use std::sync::Arc;

use crate::common::{Random, conditions, displacements, grid, laws, methods, particles};
use igimp_assembly::{
    Kinematics, Method, ParticleFields, Particles, PoreSite, PoreState, PoreStiffness, PoreWater,
    SharedLaw, Stencils, StepConditions, System, TimeScheme, TimeStep, Water,
};
use igimp_material::TangentKind;

/// Water that stands up to a level far above, and pressure beyond it by a factor.
#[derive(Debug)]
struct Standing {
    unit_weight: f64,
    level: f64,
    beyond: f64,
}

impl<const D: usize> PoreWater<D> for Standing {
    fn at(&self, site: PoreSite<'_, D>) -> PoreState<D> {
        let up = D - 1;
        let reference = self.unit_weight * (self.level - site.x[up]);
        let mut gradient = [0.0; D];
        gradient[up] = -self.unit_weight;
        PoreState {
            pressure: self.beyond * reference,
            reference,
            gradient,
            added_density: 0.0,
            water_density: self.unit_weight / 10.0,
        }
    }
}

fn with_water<const D: usize>(
    conditions: StepConditions<D>,
    beyond: f64,
    stiffness: f64,
) -> StepConditions<D> {
    let given = Standing {
        unit_weight: 3.0,
        level: 20.0,
        beyond,
    };
    conditions
        .with_water(Water {
            given: Some(Arc::new(given)),
            factor: 1.0,
            stiffness: vec![stiffness.into()],
        })
        .unwrap()
}

/// A body that is already deformed.
fn deformed<const D: usize>(
    grid: &igimp_shape::Grid<D>,
    law: &SharedLaw,
    method: &Method,
    random: &mut Random,
) -> Particles<D> {
    let mut body = particles(grid, 1.0, random);
    let conditions = conditions(grid, law);
    let stencils = Stencils::build(&body, method, &conditions).unwrap();
    let system = System::new(&body, &stencils, &conditions, method).unwrap();
    let u = displacements(grid, 0.03, random);
    let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
    body.commit(&stencils, method, &trial, &u);
    body
}

#[test]
fn standing_water_leaves_buoyant_weight() {
    let grid = grid::<2>(6);
    let mut random = Random(7);
    let (_, law) = laws().swap_remove(0);
    for method in methods() {
        let body = deformed(&grid, &law, &method, &mut random);
        let mut dry = conditions(&grid, &law);
        dry.loads.gravity = [0.0, -10.0];
        let wet = with_water(dry.clone(), 1.0, 0.0);
        let stencils = Stencils::build(&body, &method, &dry).unwrap();
        let wet = System::new(&body, &stencils, &wet, &method).unwrap();
        // Density 2 under 10 weighs 20 a unit of volume, water 3.
        let buoyant = body.mass.iter().map(|mass| mass * 17.0 / 20.0).collect();
        let buoyant = Particles::from_fields(ParticleFields {
            mass: buoyant,
            ..(*body).clone()
        })
        .unwrap();
        let drained = Stencils::build(&buoyant, &method, &dry).unwrap();
        let dry = System::new(&buoyant, &drained, &dry, &method).unwrap();
        let size = dry
            .f_ext()
            .iter()
            .flatten()
            .fold(0.0, |a: f64, b| a.max(b.abs()));
        for (wet, dry) in wet
            .f_ext()
            .iter()
            .flatten()
            .zip(dry.f_ext().iter().flatten())
        {
            assert!((wet - dry).abs() < 1e-13 * size, "{wet} {dry}");
        }
    }
}

#[test]
fn the_tangent_knows_the_water() {
    fn compare<const D: usize>(cells: usize, random: &mut Random) {
        let grid = grid::<D>(cells);
        let [mut tried, mut compared] = [0, 0];
        for (name, law) in laws() {
            for method in methods() {
                let body = deformed(&grid, &law, &method, random);
                let conditions = with_water(conditions(&grid, &law), 0.4, 900.0);
                let stencils = Stencils::build(&body, &method, &conditions).unwrap();
                let system = System::new(&body, &stencils, &conditions, &method).unwrap();
                let u = displacements(&grid, 0.02, random);
                let (_, matrix) = system.linearise(&u, TangentKind::Consistent).unwrap();
                let unknowns = system.unknowns();
                let dofs: Vec<(usize, usize)> = (0..grid.node_count())
                    .flat_map(|node| (0..D).map(move |axis| (node, axis)))
                    .filter(|&(node, axis)| unknowns.index(node, axis).is_some())
                    .collect();
                for k in 0..4 {
                    let (node, axis) = dofs[k * dofs.len() / 4];
                    let mut unit = vec![0.0; unknowns.len()];
                    unit[unknowns.index(node, axis).unwrap()] = 1.0;
                    let mut column = vec![0.0; unknowns.len()];
                    matrix.multiply(&unit, &mut column);
                    let moved = |by: f64| {
                        let mut u = u.clone();
                        u[node][axis] += by;
                        system.evaluate(&u, TangentKind::Consistent).unwrap()
                    };
                    let (plus, minus) = (moved(1e-6), moved(-1e-6));
                    let regimes = |trial: &igimp_assembly::Trial<D>| -> Vec<_> {
                        trial.particles.iter().map(|p| p.regime).collect()
                    };
                    tried += 1;
                    if regimes(&plus) != regimes(&minus) {
                        continue; // a kink
                    }
                    compared += 1;
                    let largest = column.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
                    for &(row, along) in &dofs {
                        let slope = (plus.f_int[row][along] - minus.f_int[row][along]) / 2e-6;
                        let entry = column[unknowns.index(row, along).unwrap()];
                        assert!(
                            (slope - entry).abs() < 2e-6 * largest,
                            "{name}: {slope} {entry}"
                        );
                    }
                }
            }
        }
        assert!(2 * compared > tried, "{compared} of {tried} columns");
    }
    let random = &mut Random(11);
    compare::<2>(5, random);
    compare::<3>(3, random);
}

/// Under a change of total mean stress water that cannot leave takes B = 1/(1 + K′ n/K_w) of it.
#[test]
fn water_takes_the_share_of_skempton() {
    let grid = grid::<3>(4);
    let (_, law) = laws().swap_remove(0);
    let bulk = law.stiffness_bound().bulk();
    for stiffness in [0.5 * bulk, 20.0 * bulk, 1000.0 * bulk] {
        for method in methods() {
            let mut body = particles(&grid, 0.0, &mut Random(3));
            let mut conditions = conditions(&grid, &law);
            conditions.water.stiffness = vec![stiffness.into()];
            let stencils = Stencils::build(&body, &method, &conditions).unwrap();
            let system = System::new(&body, &stencils, &conditions, &method).unwrap();
            let squeeze = -1e-7;
            let u: Vec<[f64; 3]> = (0..grid.node_count())
                .map(|node| grid.node_position(node).map(|x| squeeze * x))
                .collect();
            let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
            body.commit(&stencils, &method, &trial, &u);
            let share = 1.0 / (1.0 + bulk / stiffness);
            for particle in 0..body.len() {
                let sigma = body.total_stress(particle);
                let mean = (sigma[0][0] + sigma[1][1] + sigma[2][2]) / 3.0;
                let b = body.excess[particle] / -mean;
                assert!((b / share - 1.0).abs() < 1e-6, "{b} for {share}");
            }
        }
    }
}

/// Accepts a uniform stretch of everything by a factor, as if nothing resisted it.
fn stretch<const D: usize>(
    body: &mut Particles<D>,
    conditions: &StepConditions<D>,
    method: &Method,
    factor: f64,
) {
    let grid = &conditions.grid;
    let stencils = Stencils::build(body, method, conditions).unwrap();
    let system = System::new(body, &stencils, conditions, method).unwrap();
    let u: Vec<[f64; D]> = (0..grid.node_count())
        .map(|node| grid.node_position(node).map(|x| (factor - 1.0) * x))
        .collect();
    let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
    body.commit(&stencils, method, &trial, &u);
}

// GOAL: excess pore pressure of one step is where the next begins, whatever the volume has become; soil of other
// stiffness has water of other stiffness, unless that of the water is stated.
// CASE: two uniform squeezes by a tenth and more, particles at ratios of stiffness 1 and 2.5.
// ORACLE: J u = −r K_w/n ln J in finite strain, u = −r K_w/n times the sum of volume strains in small strain; r = 1 where it is stated.
#[test]
fn excess_pressure_goes_on_from_step_to_step() {
    fn squeezed<const D: usize>(goes_with_soil: bool) {
        let grid = grid::<D>(4);
        let (_, law) = laws().swap_remove(0);
        for mut method in methods() {
            method.small_cuts.below = 0.0;
            let mut fields = (*particles(&grid, 0.0, &mut Random(3))).clone();
            for ratios in fields.ratios.iter_mut().step_by(2) {
                ratios.stiffness = 2.5;
            }
            let mut body = Particles::from_fields(fields).unwrap();
            let mut conditions = conditions(&grid, &law);
            conditions.water.stiffness = vec![PoreStiffness {
                modulus: 300.0,
                goes_with_soil,
            }];
            let (factors, dimension) = ([0.9, 0.85], D as f64);
            for factor in factors {
                stretch(&mut body, &conditions, &method, factor);
            }
            let volume = (factors[0] * factors[1]).powf(dimension);
            let unit = match method.kinematics {
                Kinematics::FiniteStrain => -300.0 * volume.ln() / volume,
                Kinematics::SmallStrain => -300.0 * dimension * (factors[0] + factors[1] - 2.0),
            };
            for particle in 0..body.len() {
                let ratio = body.ratios[particle].stiffness;
                let expected = if goes_with_soil { ratio * unit } else { unit };
                let found = body.excess[particle];
                assert!(
                    (found / expected - 1.0).abs() < 1e-9,
                    "{} {:?}: {found} for {expected}",
                    method.label(),
                    method.kinematics
                );
            }
        }
    }
    for goes_with_soil in [true, false] {
        squeezed::<2>(goes_with_soil);
        squeezed::<3>(goes_with_soil);
    }
}

// GOAL: given pressure acts on the soil as it is now, in both kinematics.
// CASE: pressure beyond the reference in a body that was stretched.
// ORACLE: the work of a pressure on a uniform dilation, D Σ V (u − u_r), with the volumes of now.
#[test]
fn given_pressure_acts_on_the_volume_of_now() {
    let grid = grid::<2>(6);
    let (_, law) = laws().swap_remove(0);
    for mut method in methods() {
        method.small_cuts.below = 0.0;
        method.small_cuts.ghost_penalty = 0.0;
        let mut body = particles(&grid, 0.0, &mut Random(3));
        let dry = conditions(&grid, &law);
        stretch(&mut body, &dry, &method, 0.9);
        let work = |conditions: &StepConditions<2>| -> f64 {
            let stencils = Stencils::build(&body, &method, conditions).unwrap();
            let system = System::new(&body, &stencils, conditions, &method).unwrap();
            let still = vec![[0.0; 2]; grid.node_count()];
            let trial = system.evaluate(&still, TangentKind::Consistent).unwrap();
            (trial.f_int.iter().enumerate())
                .map(|(node, force)| {
                    let x = grid.node_position(node);
                    x[0] * force[0] + x[1] * force[1]
                })
                .sum()
        };
        let wet = with_water(dry.clone(), 1.4, 0.0);
        let expected: f64 = (0..body.len())
            .map(|particle| {
                let reference = 3.0 * (20.0 - body.x[particle][1]);
                -2.0 * body.volume(particle) * 0.4 * reference
            })
            .sum();
        let found = work(&wet) - work(&dry);
        let label = (method.label(), method.kinematics);
        assert!(
            (found / expected - 1.0).abs() < 1e-10,
            "{label:?}: {found} {expected}"
        );
    }
}

/// Water that makes soil heavier than it was seeded, without a pressure.
#[derive(Debug)]
struct Filling(f64);

impl<const D: usize> PoreWater<D> for Filling {
    fn at(&self, _: PoreSite<'_, D>) -> PoreState<D> {
        PoreState {
            pressure: 0.0,
            reference: 0.0,
            gradient: [0.0; D],
            added_density: self.0,
            water_density: 0.0,
        }
    }
}

// GOAL: water that moves with the soil has its mass in the energy of motion.
// ORACLE: ½ m v² with the density that the water adds, before and after a step that makes all of it twice as fast.
#[test]
fn water_moves_with_its_mass() {
    let grid = grid::<2>(6);
    let (_, law) = laws().swap_remove(0);
    let (velocity, added, duration) = ([0.3, -0.2], 0.5, 0.01);
    let body = particles(&grid, 1.0, &mut Random(7));
    let count = body.len();
    let body = body.with_velocities(vec![velocity; count]).unwrap();
    let conditions = conditions(&grid, &law)
        .with_water(Water {
            given: Some(Arc::new(Filling(added))),
            factor: 1.0,
            stiffness: vec![0.0.into()],
        })
        .and_then(|conditions| {
            conditions.with_time(Some(TimeStep {
                duration,
                scheme: TimeScheme::BackwardEuler,
                lumped: 0.0,
                is_first: false,
                must_resolve: false,
            }))
        })
        .unwrap();
    let method = Method::igimp();
    let stencils = Stencils::build(&body, &method, &conditions).unwrap();
    let system = System::new(&body, &stencils, &conditions, &method)
        .and_then(System::in_motion)
        .unwrap();
    let u = vec![velocity.map(|v| 2.0 * duration * v); grid.node_count()];
    let trial = system.evaluate(&u, TangentKind::Consistent).unwrap();
    let energy = system.energy(&trial, &u).unwrap().unwrap();
    let masses = std::iter::zip(&body.mass, &body.volume0);
    let mass: f64 = masses.map(|(mass, volume)| mass + added * volume).sum();
    let kinetic = 0.5 * mass * velocity.iter().map(|v| v * v).sum::<f64>();
    let near = |found: f64, exact: f64| {
        assert!(
            (found - exact).abs() < 1e-12 * exact.abs(),
            "{found} {exact}"
        );
    };
    near(energy.kinetic, 4.0 * kinetic);
    near(energy.kinetic - energy.kinetic_gain, kinetic);
}
