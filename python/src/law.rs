//! Laws that are written in Python, behind the contract of all laws.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use igimp_material::{
    Batches, ConstitutiveModel, Elasticity, History, MaterialError, NonlocalRates, PointContext,
    Principal, Regime, ReturnMap, Strength,
};
use igimp_model::{Case, GivenLaw, Material};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::raised::Raised;

/// What a law raised first, and the flag that ends the run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trouble {
    raised: Arc<Mutex<Option<PyErr>>>,
    interrupt: Arc<AtomicBool>,
}

impl Trouble {
    /// For a run that this flag ends.
    pub(crate) fn new(interrupt: Arc<AtomicBool>) -> Self {
        Self {
            raised: Arc::default(),
            interrupt,
        }
    }

    /// What a law raised, if one did.
    pub(crate) fn take(&self) -> Option<PyErr> {
        let mut raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
        raised.take()
    }

    fn is_there(&self) -> bool {
        let raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
        raised.is_some()
    }

    /// Keeps the first error, and ends the run: the step that asked is the last.
    fn keep(&self, error: PyErr) -> MaterialError {
        let mut raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner);
        raised.get_or_insert(error);
        self.interrupt.store(true, Ordering::SeqCst);
        MaterialError::NonFinite {
            quantity: "stress of the law in Python",
        }
    }
}

/// Gives a material of a case a law that is written in Python.
pub(crate) fn give<const D: usize>(
    py: Python<'_>,
    case: &mut Case<D>,
    (material, law): (&str, Py<PyAny>),
    trouble: &Trouble,
) -> PyResult<()> {
    let Some(place) = case
        .materials
        .iter()
        .position(|given| given.name == material)
    else {
        let names: Vec<&str> = case
            .materials
            .iter()
            .map(|given| given.name.as_str())
            .collect();
        let text = format!(
            "error: there is no material `{material}`\n  help: materials: {}",
            names.join(", ")
        );
        return Err(Raised::bad_input(text).exception(py));
    };
    give_to(py, &mut case.materials[place], law, trouble)
}

/// Gives a material a law that is written in Python.
pub(crate) fn give_to(
    py: Python<'_>,
    material: &mut Material,
    law: Py<PyAny>,
    trouble: &Trouble,
) -> PyResult<()> {
    let elasticity = Elasticity::new(material.young, material.poisson)
        .map_err(|error| Raised::bad_input(format!("error: {error}")).exception(py))?;
    let law = InPython::new(py, &material.name, law, elasticity, trouble.clone())?;
    material.given = Some(GivenLaw(Arc::new(law)));
    Ok(())
}

/// A law that is written in Python.
struct InPython {
    /// Material that has it.
    material: String,
    law: Py<PyAny>,
    elasticity: Elasticity,
    symmetric: bool,
    yields: bool,
    /// Class and parameters, in words.
    identity: String,
    trouble: Trouble,
}

impl fmt::Debug for InPython {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Its elasticity is that of the material, which a run knows anyway.
        f.write_str(&self.identity)
    }
}

impl InPython {
    fn new(
        py: Python<'_>,
        material: &str,
        law: Py<PyAny>,
        elasticity: Elasticity,
        trouble: Trouble,
    ) -> PyResult<Self> {
        let given = law.bind(py);
        Ok(Self {
            symmetric: given.getattr("symmetric")?.extract()?,
            yields: given.getattr("yields")?.extract()?,
            identity: given.call_method0("identity")?.extract()?,
            material: material.to_owned(),
            law,
            elasticity,
            trouble,
        })
    }

    /// Principal stresses and tangents that Python answers, flat.
    fn ask(
        &self,
        py: Python<'_>,
        strains: &[Principal],
        histories: &[History],
    ) -> PyResult<(Vec<f64>, Vec<f64>)> {
        let n = strains.len();
        let flat = PyArray1::from_vec(py, strains.as_flattened().to_vec());
        let past: Vec<f64> = histories.iter().map(|history| history.eps_p_eq).collect();
        let arguments = (
            flat.reshape([n, 3])?,
            PyArray1::from_vec(py, past),
            self.elasticity.young(),
            self.elasticity.poisson(),
        );
        let answer = self.law.bind(py).call_method1("_answer", arguments)?;
        let (tau, tangent): (PyReadonlyArray1<'_, f64>, PyReadonlyArray1<'_, f64>) =
            answer.extract()?;
        Ok((tau.as_slice()?.to_vec(), tangent.as_slice()?.to_vec()))
    }

    /// The first exception of the run, with a note that names the law and its material.
    /// Python 3.10 has no notes.
    fn keep(&self, py: Python<'_>, error: PyErr, during: &str) -> MaterialError {
        let note = format!(
            "raised by the law {} of material \"{}\" in {during}",
            self.identity, self.material
        );
        // Without the note the exception stays what it is.
        let _ = error.value(py).call_method1("add_note", (note,));
        self.trouble.keep(error)
    }

    /// The answer of the contract from a stress and a tangent.
    fn returned(
        &self,
        strain: &Principal,
        history: History,
        (tau, tangent): (&[f64], &[f64]),
    ) -> ReturnMap {
        let trial = self.elasticity.stress(strain);
        let tau: Principal = std::array::from_fn(|a| tau[a]);
        let scale = trial.iter().fold(0.0_f64, |most, tau| most.max(tau.abs()));
        let is_trial = (0..3).all(|a| (trial[a] - tau[a]).abs() <= 1e-12 * scale);
        let lost = std::array::from_fn(|a| trial[a] - tau[a]);
        let delta_eps_p = if is_trial {
            [0.0; 3]
        } else {
            self.elasticity.strain(&lost)
        };
        ReturnMap {
            tau,
            tangent: std::array::from_fn(|a| std::array::from_fn(|b| tangent[3 * a + b])),
            delta_eps_p,
            history: history.after(&delta_eps_p),
            regime: if is_trial {
                Regime::Elastic
            } else {
                Regime::Smooth
            },
            nonlocal: NonlocalRates::NONE,
        }
    }
}

impl ConstitutiveModel for InPython {
    fn name(&self) -> &'static str {
        "law in Python"
    }

    fn stiffness_bound(&self) -> &Elasticity {
        &self.elasticity
    }

    fn return_map(
        &self,
        eps_e_trial: &Principal,
        history: &History,
        context: &PointContext,
    ) -> Result<ReturnMap, MaterialError> {
        let maps = self.return_maps(&[*eps_e_trial], &[*history], context)?;
        maps.into_iter().next().ok_or(MaterialError::NonFinite {
            quantity: "stress of the law in Python",
        })
    }

    fn batches(&self) -> Option<&dyn Batches> {
        Some(self)
    }

    fn has_symmetric_tangent(&self) -> bool {
        self.symmetric
    }
}

impl Batches for InPython {
    fn return_maps(
        &self,
        eps_e_trial: &[Principal],
        histories: &[History],
        _: &PointContext,
    ) -> Result<Vec<ReturnMap>, MaterialError> {
        if self.trouble.is_there() {
            return Err(MaterialError::NonFinite {
                quantity: "stress of the law in Python",
            });
        }
        let (tau, tangent) = Python::attach(|py| {
            (self.ask(py, eps_e_trial, histories))
                .map_err(|error| self.keep(py, error, "return_map"))
        })?;
        let states = std::iter::zip(eps_e_trial, histories);
        let answers = std::iter::zip(tau.chunks_exact(3), tangent.chunks_exact(9));
        Ok(std::iter::zip(states, answers)
            .map(|((strain, history), answer)| self.returned(strain, *history, answer))
            .collect())
    }
}

impl Strength for InPython {
    fn yield_function(&self, _: &Principal, _: &History) -> f64 {
        f64::NEG_INFINITY
    }

    fn stress_scale(&self, tau: &Principal) -> f64 {
        tau.iter().fold(0.0, |most, stress| most.max(stress.abs()))
    }

    fn utilisation(&self, _: &Principal, _: &History) -> f64 {
        0.0
    }

    fn yields(&self) -> bool {
        self.yields
    }

    fn reduced(&self, srf: f64) -> Result<Arc<dyn ConstitutiveModel>, MaterialError> {
        Python::attach(|py| {
            let law = self.law.bind(py).call_method1("reduced", (srf,));
            let weaker = law.and_then(|law| {
                let trouble = self.trouble.clone();
                Self::new(py, &self.material, law.unbind(), self.elasticity, trouble)
            });
            match weaker {
                Ok(law) => Ok(Arc::new(law) as Arc<dyn ConstitutiveModel>),
                Err(error) => Err(self.keep(py, error, "reduced")),
            }
        })
    }
}
