//! Key values of a test: its states at the start, at the largest stress and at the end, and its formula.

use igimp_material::ConstitutiveModel;
use igimp_model::Material;
use igimp_solver::element::{ElementState, Kinematics};

use super::closed_form::{self, ClosedForm};
use super::measure::Measure;
use super::{Drive, Request};

/// Key values of a test.
#[derive(Clone, Debug)]
pub(super) struct KeyValues {
    /// The stress that is looked at: q, of tests in shear τ_xy.
    pub(super) stress: Measure,
    /// The place of its largest size among the states.
    pub(super) peak: usize,
    /// Mobilised strength at the start, at the largest stress and at the end \[-\].
    pub(super) mobilised: [f64; 3],
    /// The stress at failure by a formula, if there is one.
    pub(super) closed: Option<ClosedForm>,
}

impl KeyValues {
    /// Those of the states of a test, of which there is one at least.
    pub(super) fn new(
        material: &Material,
        law: &dyn ConstitutiveModel,
        request: &Request,
        states: &[ElementState],
    ) -> Self {
        let stress = looked_at(&request.drive);
        let size = |state: &ElementState| stress.of(state, &states[0], &request.drive).abs();
        let mut peak = 0;
        for (place, state) in states.iter().enumerate() {
            if size(state) > size(&states[peak]) {
                peak = place;
            }
        }
        let end = states.len() - 1;
        let mobilised = [0, peak, end].map(|place| {
            let state = &states[place];
            law.utilisation(&principal(state, request.kinematics), &state.history)
        });
        let closed = match request.drive {
            Drive::Standard(standard, strain) if strain > 0.0 => {
                closed_form::strength(material, standard, request, &states[end])
            }
            _ => None,
        };
        Self {
            stress,
            peak,
            mobilised,
            closed,
        }
    }

    /// The stress that is looked at, in print.
    pub(super) fn symbol(&self) -> &'static str {
        match self.stress {
            Measure::TauXy => "τ_xy",
            _ => "q",
        }
    }
}

/// The stress of a test that is looked at.
pub(super) fn looked_at(drive: &Drive) -> Measure {
    match drive {
        Drive::Standard(test, _) if test.is_shear() => Measure::TauXy,
        _ => Measure::Q,
    }
}

/// Principal stresses, Kirchhoff \[Pa\].
fn principal(state: &ElementState, kinematics: Kinematics) -> [f64; 3] {
    let volume = match kinematics {
        Kinematics::Finite => (-state.volumetric_strain()).exp(),
        Kinematics::Small => 1.0,
    };
    let tau = state.sigma.map(|row| row.map(|stress| stress * volume));
    igimp_material::principal_values::<3>(&tau)
}
