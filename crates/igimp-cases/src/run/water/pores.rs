//! Pressures that a stage leaves in pores, and the unsafe ones among them.

use igimp_assembly::Particles;
use igimp_model::{Case, Drainage, Strength};
use igimp_results::summary::PoreSummary;
use igimp_text::short;

/// Soil floats where the pore pressure exceeds the total vertical stress by more than this share of the largest pore
/// pressure \[-\].
const FLOATS: f64 = 0.01;
/// The same, at least \[Pa\]: round-off is no pressure.
const NOTHING: f64 = 1.0;

/// The pore pressures of a state; none where there are none.
pub(crate) fn summary<const D: usize>(
    case: &Case<D>,
    particles: &Particles<D>,
) -> Option<PoreSummary> {
    if !case.has_pore_water() {
        return None;
    }
    let pressure = |k: usize| particles.pore_pressure[k] + particles.excess[k];
    let all = || 0..particles.len();
    let largest = all().map(pressure).fold(0.0, f64::max);
    let excess = particles.excess.iter();
    let [least, most] = excess.fold([0.0, 0.0], |[least, most]: [f64; 2], &value| {
        [least.min(value), most.max(value)]
    });
    if largest <= 0.0 && least >= 0.0 {
        return None;
    }
    // Effective stress in tension: u exceeds the total vertical pressure.
    let up = D - 1;
    let floor = (FLOATS * largest).max(NOTHING);
    let floats = |&k: &usize| pressure(k) > 0.0 && particles.sigma[k][up][up] > floor;
    Some(PoreSummary {
        largest,
        excess: (least < 0.0 || most > 0.0).then_some([least, most]),
        floating: all().filter(floats).count(),
        particles: particles.len(),
    })
}

/// A remark on a stage that leaves soil floating.
pub(crate) fn remark(stage: &str, pores: &PoreSummary) -> Option<String> {
    (pores.floating > 0).then(|| {
        let share = 100.0 * pores.floating as f64 / pores.particles as f64;
        format!(
            "stage \"{stage}\" ends with a pore pressure above the total vertical stress in {} particles ({} %): they float, \
             held by tension between the grains, which soil hardly bears; lower the water, let it drain, or give the soil \
             a tension_cutoff",
            pores.floating,
            short(share)
        )
    })
}

/// Remarks on materials that are undrained and dilate: they never fail.
pub(crate) fn dilatant<const D: usize>(case: &Case<D>) -> Vec<String> {
    if case.stages.iter().all(|stage| stage.drained) {
        return Vec::new();
    }
    let remark = |material: &igimp_model::Material| {
        let (Strength::MohrCoulomb { dilation_angle, .. }
        | Strength::DruckerPrager { dilation_angle, .. }) = material.strength
        else {
            return None;
        };
        let undrained = matches!(material.drainage, Drainage::Undrained { .. });
        let ends = material.softening.and_then(|softening| softening.dilation);
        if ends.is_some_and(|ends| ends.residual == 0.0) {
            return None;
        }
        (undrained && dilation_angle > 0.0).then(|| {
            format!(
                "material \"{}\" is undrained and dilates by {}°: as it shears its pore pressure falls without end and its \
                 strength grows with it, so that it never fails; dilation = \"0 deg\" is safe",
                material.name,
                short(dilation_angle.to_degrees())
            )
        })
    };
    case.materials.iter().filter_map(remark).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixture::case;
    use crate::run::Model;
    use igimp_assembly::ParticleFields;

    /// GOAL: extremes are told of all particles, and soil under effective tension is counted.
    #[test]
    fn pores_have_their_extremes() {
        let mut case = case();
        let particles = Model::new(&case).unwrap().1.body.particles;
        assert_eq!(summary(&case, &particles), None);
        case.materials[0].drainage = Drainage::Undrained {
            stiffness: 1e9.into(),
            flows: false,
        };
        assert_eq!(summary(&case, &particles), None);
        let mut fields: ParticleFields<2> = (*particles).clone();
        fields.pore_pressure[1] = 40e3;
        fields.excess[1] = 5e3;
        fields.excess[2] = -8e3;
        fields.sigma[1][1][1] = 20e3;
        fields.sigma[3][1][1] = 20e3;
        let found = summary(&case, &Particles::from_fields(fields).unwrap()).unwrap();
        let expected = PoreSummary {
            largest: 45e3,
            excess: Some([-8e3, 5e3]),
            floating: 1,
            particles: particles.len(),
        };
        assert_eq!(found, expected);
        assert!(
            remark("end", &found)
                .unwrap()
                .contains("in 1 particles (1.")
        );
    }

    #[test]
    fn undrained_soil_that_dilates_has_a_remark() {
        let mut case = case();
        case.materials[0].strength = Strength::MohrCoulomb {
            cohesion: 5e3,
            friction_angle: 0.5,
            dilation_angle: 0.1,
            flow: igimp_model::Flow::Dilation,
            tension_cutoff: None,
        };
        assert!(dilatant(&case).is_empty());
        case.materials[0].drainage = Drainage::Undrained {
            stiffness: 1e9.into(),
            flows: false,
        };
        assert_eq!(dilatant(&case).len(), 1);
        for stage in &mut case.stages {
            stage.drained = true;
        }
        assert!(dilatant(&case).is_empty());
    }
}
