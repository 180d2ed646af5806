//! Laws that are asked for many particles at once: their trial strains are gathered before a pass, and the
//! pass finds the answers there. The results are the same.

use igimp_material::{History, PointContext, Principal, ReturnMap};
use rayon::prelude::*;

use crate::equations::system::System;
use crate::error::AssemblyError;

impl<const D: usize> System<'_, D> {
    /// The answers of laws that prefer batches at nodal step displacements `u`, by particle; nothing where no
    /// law does. A particle of another strength or stiffness than its law is not among them.
    pub(crate) fn answers(&self, u: &[[f64; D]]) -> Result<Vec<Option<ReturnMap>>, AssemblyError> {
        let laws = &self.conditions.laws;
        if !laws.iter().any(|law| law.batches().is_some()) {
            return Ok(Vec::new());
        }
        let particles = self.particles;
        let strains: Vec<Option<Principal>> = (0..particles.len())
            .into_par_iter()
            .map(|particle| {
                let law = &laws[particles.law[particle]];
                let is_asked = law.batches().is_some() && particles.ratios[particle].are_one();
                // Faults of the step are found in the pass.
                let strained = is_asked.then(|| {
                    let (supports, hoops) = self.stencils.with_hoops(particle);
                    self.strain_particle((particle, supports, hoops), u).ok()
                })??;
                Some(*strained.1.principal())
            })
            .collect();
        let mut answers = vec![None; particles.len()];
        let context = PointContext::over(self.conditions.duration());
        for (number, law) in laws.iter().enumerate() {
            let Some(batches) = law.batches() else {
                continue;
            };
            let of_law = |&particle: &usize| particles.law[particle] == number;
            let (list, asked): (Vec<usize>, Vec<Principal>) = (0..particles.len())
                .filter(of_law)
                .filter_map(|particle| Some((particle, strains[particle]?)))
                .unzip();
            let Some(&first) = list.first() else { continue };
            let histories: Vec<History> = list.iter().map(|&p| particles.history(p)).collect();
            let found = batches
                .return_maps(&asked, &histories, &context)
                .map_err(|source| AssemblyError::Material {
                    particle: first,
                    source,
                })?;
            for (particle, answer) in std::iter::zip(list, found) {
                answers[particle] = Some(answer);
            }
        }
        Ok(answers)
    }
}
