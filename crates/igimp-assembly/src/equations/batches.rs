//! Laws that are asked for many particles at once: their trial strains are gathered before a pass, and the
//! pass finds the answers there. What is computed is the same.

use std::sync::{Arc, Mutex, PoisonError};

use igimp_material::{
    ConstitutiveModel, Elasticity, History, MaterialError, Principal, Regime, ReturnMap,
    TangentKind,
};
use rayon::prelude::*;

use crate::equations::kinematics::ParticleTrial;
use crate::equations::system::System;
use crate::error::AssemblyError;

impl<const D: usize> System<'_, D> {
    /// The answers of laws that prefer batches at nodal step displacements `u`, by particle; nothing where no
    /// law does. A particle of another strength or stiffness than its law is not among them.
    pub(crate) fn answers(&self, u: &[[f64; D]]) -> Result<Vec<Option<ReturnMap>>, AssemblyError> {
        let laws = &self.conditions.laws;
        if !laws.iter().any(|law| law.prefers_batches()) {
            return Ok(Vec::new());
        }
        let particles = self.particles;
        let strains: Vec<Option<Principal>> = (0..particles.len())
            .into_par_iter()
            .map(|particle| {
                let law = &laws[particles.law[particle]];
                let is_asked = law.prefers_batches() && particles.ratios[particle].are_one();
                is_asked.then(|| self.trial_strain(particle, u, &**law))?
            })
            .collect();
        let mut answers = vec![None; particles.len()];
        for (number, law) in laws.iter().enumerate() {
            let is_own = |&particle: &usize| particles.law[particle] == number;
            let (own, asked): (Vec<usize>, Vec<Principal>) = (0..particles.len())
                .filter(is_own)
                .filter_map(|particle| Some((particle, strains[particle]?)))
                .unzip();
            let Some(&first) = own.first() else { continue };
            let histories: Vec<History> = own.iter().map(|&own| particles.history[own]).collect();
            let found =
                law.return_maps(&asked, &histories)
                    .map_err(|source| AssemblyError::Material {
                        particle: first,
                        source,
                    })?;
            for (particle, answer) in std::iter::zip(own, found) {
                answers[particle] = Some(answer);
            }
        }
        Ok(answers)
    }

    /// The principal trial strain that the law of a particle is asked at; none where the step has none.
    fn trial_strain(
        &self,
        particle: usize,
        u: &[[f64; D]],
        law: &dyn ConstitutiveModel,
    ) -> Option<Principal> {
        let listening = Listening {
            law,
            heard: Mutex::new(None),
        };
        let mut trial = ParticleTrial::at_rest();
        // What is wrong with the step is said in the pass.
        let _ = self.evaluate_by(&listening, particle, u, TangentKind::Elastic, &mut trial);
        let heard = listening.heard.into_inner();
        heard.unwrap_or_else(PoisonError::into_inner)
    }
}

/// Keeps the strain that a law is asked at.
#[derive(Debug)]
struct Listening<'a> {
    law: &'a dyn ConstitutiveModel,
    heard: Mutex<Option<Principal>>,
}

/// A law that gives an answer which is known.
#[derive(Debug)]
pub(crate) struct Answered<'a> {
    pub(crate) law: &'a dyn ConstitutiveModel,
    pub(crate) answer: &'a ReturnMap,
}

/// What both leave to the law.
macro_rules! as_the_law {
    () => {
        fn name(&self) -> &'static str {
            self.law.name()
        }

        fn elasticity(&self) -> &Elasticity {
            self.law.elasticity()
        }

        fn yield_function(&self, tau: &Principal, history: &History) -> f64 {
            self.law.yield_function(tau, history)
        }

        fn stress_scale(&self, tau: &Principal) -> f64 {
            self.law.stress_scale(tau)
        }

        fn utilisation(&self, tau: &Principal, history: &History) -> f64 {
            self.law.utilisation(tau, history)
        }

        fn has_symmetric_tangent(&self) -> bool {
            self.law.has_symmetric_tangent()
        }

        fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
            self.law.reduced(srf)
        }
    };
}

impl ConstitutiveModel for Listening<'_> {
    as_the_law!();

    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
    ) -> Result<ReturnMap, MaterialError> {
        *self.heard.lock().unwrap_or_else(PoisonError::into_inner) = Some(*eps_e_trial);
        let elasticity = self.law.elasticity();
        Ok(ReturnMap {
            tau: elasticity.stress(eps_e_trial),
            tangent: elasticity.tangent(),
            delta_eps_p: [0.0; 3],
            history: *history,
            regime: Regime::Elastic,
        })
    }
}

impl ConstitutiveModel for Answered<'_> {
    as_the_law!();

    fn return_map(&self, _: &Principal, _: &History) -> Result<ReturnMap, MaterialError> {
        Ok(*self.answer)
    }
}
