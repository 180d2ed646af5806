//! GOAL: a law that a program gives beside the case is asked like those of the case, one particle after the
//! other or many at once.
//! ORACLE: the same case with its own law, to the bit.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use igimp_assembly::SharedLaw;
use igimp_cases::run::in_memory;
use igimp_input::shipped::find;
use igimp_material::{
    ConstitutiveModel, Elasticity, History, MaterialError, Principal, ReturnMap, ShearStrength,
};
use igimp_model::{Case, GivenLaw};

/// Another law, asked in batches.
#[derive(Debug)]
struct Batched {
    law: SharedLaw,
    asked: Arc<AtomicUsize>,
}

impl ConstitutiveModel for Batched {
    fn name(&self) -> &'static str {
        "batched"
    }

    fn elasticity(&self) -> &Elasticity {
        self.law.elasticity()
    }

    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
    ) -> Result<ReturnMap, MaterialError> {
        self.law.return_map(eps_e_trial, history)
    }

    fn prefers_batches(&self) -> bool {
        true
    }

    fn return_maps(
        &self,
        eps_e_trial: &[Principal],
        histories: &[History],
    ) -> Result<Vec<ReturnMap>, MaterialError> {
        self.asked.fetch_add(1, Ordering::Relaxed);
        self.law.return_maps(eps_e_trial, histories)
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

    fn shear_strength(&self) -> Option<ShearStrength> {
        self.law.shear_strength()
    }

    fn has_symmetric_tangent(&self) -> bool {
        self.law.has_symmetric_tangent()
    }

    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
        self.law.reduced(srf)
    }
}

fn slope() -> Case {
    let slope = find("von_mises_slope").unwrap();
    let settings = ["grid.cell={ x = '1 m', y = '0.5 m' }", "stages.0.steps=5"];
    slope.case_file(settings).unwrap().into_case()
}

#[test]
fn a_law_in_batches_gives_the_same_bits() {
    let own = in_memory(&slope()).unwrap();
    let mut case = slope();
    let asked = Arc::new(AtomicUsize::new(0));
    case.materials[0].given = Some(GivenLaw(Arc::new(Batched {
        law: case.materials[0].law().unwrap(),
        asked: Arc::clone(&asked),
    })));
    let given = in_memory(&case).unwrap();
    assert_eq!(*given.body.particles, *own.body.particles);
    assert!(
        given
            .body
            .particles
            .regime
            .iter()
            .any(|own| own.is_plastic())
    );
    let passes = asked.load(Ordering::Relaxed);
    let corrections = given.summary.stages[0].iterations;
    assert!(
        passes > corrections && passes < 4 * corrections,
        "{passes} passes"
    );
}
