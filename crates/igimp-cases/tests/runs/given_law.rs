//! GOAL: a law that a program gives beside the case is asked like those of the case, one particle after the
//! other or many at once.
//! ORACLE: the same case with its own law, to the bit.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use igimp_assembly::SharedLaw;
use igimp_cases::run::in_memory;
use igimp_input::CaseFile;
use igimp_input::shipped::find;
use igimp_linear::SolverKind;
use igimp_material::{
    Batches, ConstitutiveModel, Elasticity, History, MaterialError, PointContext, Principal,
    ReturnMap, ShearStrength, Strength,
};
use igimp_model::{Case, Field, GivenLaw, GivenSolver};
use igimp_results::fields::{internal_variables, value};

#[path = "../../../igimp-material/tests/support/hardening.rs"]
mod hardening;

use hardening::Hardening;

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

    fn stiffness_bound(&self) -> &Elasticity {
        self.law.stiffness_bound()
    }

    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        context: &PointContext,
    ) -> Result<ReturnMap, MaterialError> {
        self.law.return_map(eps_e_trial, history, context)
    }

    fn batches(&self) -> Option<&dyn Batches> {
        Some(self)
    }

    fn has_symmetric_tangent(&self) -> bool {
        self.law.has_symmetric_tangent()
    }
}

impl Strength for Batched {
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

    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
        self.law.reduced(srf)
    }
}

impl Batches for Batched {
    fn return_maps(
        &self,
        eps_e_trial: &[Principal],
        histories: &[History],
        context: &PointContext,
    ) -> Result<Vec<ReturnMap>, MaterialError> {
        self.asked.fetch_add(1, Ordering::Relaxed);
        std::iter::zip(eps_e_trial, histories)
            .map(|(strain, history)| self.law.return_map(strain, history, context))
            .collect()
    }
}

fn slope() -> Case<2> {
    let slope = find("von_mises_slope").unwrap();
    let settings = ["grid.cell={ x = '1 m', y = '0.5 m' }", "stages.0.steps=5"];
    slope.case_file(settings).unwrap().into_case()
}

#[test]
fn a_law_in_batches_gives_the_same_bits() {
    let plain = in_memory(&slope()).unwrap();
    let mut case = slope();
    let asked = Arc::new(AtomicUsize::new(0));
    case.materials[0].given = Some(GivenLaw(Arc::new(Batched {
        law: case.materials[0].law().unwrap(),
        asked: Arc::clone(&asked),
    })));
    let given = in_memory(&case).unwrap();
    assert_eq!(*given.body.particles, *plain.body.particles);
    assert!(
        given
            .body
            .particles
            .regime
            .iter()
            .any(|regime| regime.is_plastic())
    );
    let passes = asked.load(Ordering::Relaxed);
    let corrections = given.summary.stages[0].iterations;
    assert!(
        passes > corrections && passes < 4 * corrections,
        "{passes} passes"
    );
}

/// GOAL: a law with memory keeps it from step to step, particle by particle, and results print it.
/// ORACLE: σ_y = σ_0 + H κ of every particle; κ is the plastic strain that every law keeps for the record; on the
/// surface q = σ_y, which only holds where the memory of the step before was the one at its end.
#[test]
fn a_law_remembers_from_step_to_step() {
    let text = include_str!("../../../igimp-estimate/tests/data/block.toml");
    let file = CaseFile::parse("block.toml", text, &[]).unwrap();
    let mut case = file.into_case();
    let soil = &mut case.materials[0];
    let law = Hardening {
        elasticity: Elasticity::new(soil.young, soil.poisson).unwrap(),
        yield_stress: 2e3,
        modulus: 0.1 * soil.young,
        srf: 1.0,
    };
    soil.given = Some(GivenLaw(Arc::new(law.clone())));
    let run = in_memory(&case).unwrap();
    let particles = &run.body.particles;
    let laws: [SharedLaw; 1] = [Arc::new(law.clone())];
    let mut hardened = 0;
    for particle in 0..particles.len() {
        let [kappa, yield_stress, ..] = particles.internal[particle];
        let expected = law.yield_stress + law.modulus * kappa;
        assert!((yield_stress - expected).abs() < 1e-9 * expected);
        assert!((kappa - particles.eps_p_eq[particle]).abs() < 1e-12);
        let share = value(Field::Utilisation, particles, particle, &laws);
        assert!(share < 1.0 + 1e-9, "{share}");
        if particles.regime[particle].is_plastic() {
            hardened += 1;
            assert!((share - 1.0).abs() < 1e-9, "{share}");
        }
    }
    assert!(hardened > 20, "{hardened}");
    let printed = internal_variables(particles, &laws);
    let names: Vec<&str> = printed.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["hardening strain [-]", "yield stress [Pa]"]);
    assert!(
        printed[1]
            .1
            .iter()
            .all(|&stress| stress >= law.yield_stress)
    );
}

/// GOAL: a run solves its systems with the solver that a program gives it.
/// ORACLE: the same solver by its name in the case, to the bit.
#[test]
fn a_solver_may_be_given() {
    let mut named = slope();
    named.solver.linear = SolverKind::Multifrontal;
    let mut given = slope();
    let made = Arc::new(AtomicUsize::new(0));
    let count = Arc::clone(&made);
    given.given_solver = Some(GivenSolver {
        name: "of the test",
        make: Arc::new(move |_| {
            count.fetch_add(1, Ordering::Relaxed);
            SolverKind::Multifrontal.build()
        }),
    });
    let [named, given] = [named, given].map(|case| in_memory(&case).unwrap());
    assert_eq!(*given.body.particles, *named.body.particles);
    assert!(made.load(Ordering::Relaxed) > 0);
}
