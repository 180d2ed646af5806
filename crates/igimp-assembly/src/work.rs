//! Where the work of a step goes: into elastic strain, or into dissipation (theory, eqs. 33c and 33i).

use igimp_material::{MaterialError, Tensor, logarithmic_strain, principal_values};
use rayon::prelude::*;

use crate::body::particles::CHUNK;
use crate::energy::contracted;
use crate::equations::kinematics::Gradients;
use crate::equations::system::System;
use crate::equations::trial::Trial;
use crate::error::AssemblyError;

/// Weight of elastic work that particles only exchange, over that which is left in the sum \[-\]. A choice: where bodies move as
/// mechanisms they exchange up to a seventh of the gross work, and where few particles begin to yield all of it and more.
const EXCHANGE: f64 = 0.05;

/// The work of effective stress and of reinforcement on the strain of a step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepWork {
    /// Work of the stress at the end of the step on the strain of the step \[force·length\].
    pub whole: f64,
    /// Its part on the elastic strain \[force·length\].
    pub elastic: f64,
    /// The magnitudes of that of all particles and members, added up \[force·length\].
    pub exchanged: f64,
    /// Its part on the plastic strain, by law \[force·length\].
    pub dissipated: Vec<f64>,
    /// Its part on slip and yield of reinforcement \[force·length\].
    pub in_reinforcement: f64,
}

impl StepWork {
    /// The share of the gross work of the external force, `gross` \[force·length\], that is not elastic \[-\]: 1 where
    /// stresses stay and the body moves as a mechanism (theory, eq. 33c).
    pub fn dissipated_share(&self, gross: f64) -> f64 {
        let elastic = self.elastic.abs().max(EXCHANGE * self.exchanged);
        1.0 - (elastic / gross).abs()
    }
}

/// Dissipation of a field of displacements if soil flowed with it by the normality rule.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlasticFlow {
    /// Work of the cohesive strength of all soil that has a limit \[force·length\].
    pub work: f64,
    /// Work of the mean stress on the volume by which the field misses that of this flow, by magnitude
    /// \[force·length\].
    pub missed: f64,
}

impl<const D: usize> System<'_, D> {
    /// The work of a step that leads to `trial` by nodal displacements `u` \[length\], in small strain.
    ///
    /// # Errors
    /// [`AssemblyError::Material`] of a particle whose elastic strain cannot be found.
    pub fn work(&self, trial: &Trial<D>, u: &[[f64; D]]) -> Result<StepWork, AssemblyError> {
        let order = self.stencils.order();
        let parts: Vec<Result<[f64; 2], AssemblyError>> = (0..order.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|slot| {
                let particle = order[slot] as usize;
                self.work_of_particle(trial, slot, particle, u)
                    .map_err(|source| AssemblyError::Material { particle, source })
            })
            .collect();
        let mut work = StepWork {
            dissipated: vec![0.0; self.conditions.laws.len()],
            ..StepWork::default()
        };
        for (&particle, part) in order.iter().zip(parts) {
            let [whole, elastic] = part?;
            work.whole += whole;
            work.elastic += elastic;
            work.exchanged += elastic.abs();
            work.dissipated[self.particles.law[particle as usize]] += whole - elastic;
        }
        let [whole, elastic] = self.work_of_reinforcement(u);
        work.whole += whole;
        work.elastic += elastic;
        work.exchanged += elastic.abs();
        work.in_reinforcement = whole - elastic;
        Ok(work)
    }

    /// Dissipation of nodal displacements `u` \[length\] as plastic flow by the normality rule, at the strength
    /// that the laws have now; mean stresses are those of `trial`.
    ///
    /// # Errors
    /// [`AssemblyError::Material`] of a particle whose law cannot be found.
    pub fn plastic_flow(
        &self,
        trial: &Trial<D>,
        u: &[[f64; D]],
    ) -> Result<PlasticFlow, AssemblyError> {
        let order = self.stencils.order();
        let parts: Vec<Result<PlasticFlow, AssemblyError>> = (0..order.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|slot| {
                let particle = order[slot] as usize;
                self.flow_of_particle(&trial.particles[slot].tau, particle, u)
                    .map_err(|source| AssemblyError::Material { particle, source })
            })
            .collect();
        let mut flow = PlasticFlow::default();
        for part in parts {
            let part = part?;
            flow.work += part.work;
            flow.missed += part.missed;
        }
        Ok(flow)
    }

    /// That of one particle.
    fn flow_of_particle(
        &self,
        tau: &Tensor,
        particle: usize,
        u: &[[f64; D]],
    ) -> Result<PlasticFlow, MaterialError> {
        let strain = self.strain_of_step(particle, u);
        let rate = principal_values::<D>(&strain);
        let laws = &self.conditions.laws;
        let asked = (self.particles).ask_law(particle, laws, |law| law.dissipation(&rate))?;
        let volume = self.reference_volume(particle);
        let trace = |tensor: &Tensor| tensor[0][0] + tensor[1][1] + tensor[2][2];
        Ok(asked.map_or_else(PlasticFlow::default, |flow| PlasticFlow {
            work: volume * flow.power,
            missed: volume * (trace(tau) / 3.0 * (trace(&strain) - flow.dilation)).abs(),
        }))
    }

    /// The small strain of a step at a particle \[-\].
    fn strain_of_step(&self, particle: usize, u: &[[f64; D]]) -> Tensor {
        let (supports, hoops) = self.stencils.with_hoops(particle);
        let mut strain = [[0.0; 3]; 3];
        Gradients::of((supports, hoops), u).add_small_strain(&mut strain);
        strain
    }

    /// The work of a particle, and its elastic part \[force·length\].
    fn work_of_particle(
        &self,
        trial: &Trial<D>,
        slot: usize,
        particle: usize,
        u: &[[f64; D]],
    ) -> Result<[f64; 2], MaterialError> {
        let end = &trial.particles[slot];
        let strain = self.strain_of_step(particle, u);
        let before = logarithmic_strain(&self.particles.b_e[particle])?;
        let mut elastic = [[0.0; 3]; 3];
        for a in 0..3 {
            for b in 0..3 {
                let after: f64 = (0..3)
                    .map(|k| end.eps_e[k] * end.frame[k][a] * end.frame[k][b])
                    .sum();
                elastic[a][b] = after - before[a][b];
            }
        }
        let volume = self.reference_volume(particle);
        Ok([&strain, &elastic].map(|strain| volume * contracted(&end.tau, strain)))
    }
}
