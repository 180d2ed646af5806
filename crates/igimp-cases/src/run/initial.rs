//! The stresses of level ground: the weight above, and K₀ times that sideways (theory, eqs. 36
//! and 37).

use igimp_assembly::Particles;
use igimp_material::ConstitutiveModel;

use super::model::Model;
use super::state::State;
use crate::error::CaseError;

/// Sets the stresses of level ground under full gravity in an undeformed body.
///
/// The vertical stress is the weight of the ground above a particle, layer by layer; the
/// horizontal ones are K₀ times that. The elastic strain follows from the stress, so that the
/// state is what the law would have returned; deformation counts from here.
pub(crate) fn level_ground(model: &Model<'_>, state: &mut State) -> Result<(), CaseError> {
    let case = model.case;
    let mut fields = (*state.body.particles).clone();
    for particle in 0..fields.x.len() {
        let x = fields.x[particle];
        let vertical = -weight_above(model, &x);
        let material = &case.materials[fields.law[particle] % case.materials.len()];
        let k0 = material
            .k0
            .unwrap_or(material.poisson / (1.0 - material.poisson));
        let sigma = [k0 * vertical, vertical, k0 * vertical];
        let answer = |law: &dyn ConstitutiveModel| {
            let excess = law.yield_function(&sigma, &fields.history[particle]);
            (excess <= 1e-9 * law.stress_scale(&sigma)).then(|| law.elasticity().strain(&sigma))
        };
        let strain = state
            .body
            .particles
            .ask_law(particle, &model.laws, answer)?;
        let Some(strain) = strain else {
            return Err(CaseError::InitialStress {
                material: material.name.clone(),
                position: x,
                k0,
            });
        };
        for axis in 0..3 {
            fields.sigma[particle][axis][axis] = sigma[axis];
            fields.b_e[particle][axis][axis] = (2.0 * strain[axis]).exp();
        }
    }
    state.body.particles = Particles::from_fields(fields)?;
    state.controls.gravity = 1.0;
    Ok(())
}

/// The weight of the bodies above a point \[Pa\].
fn weight_above(model: &Model<'_>, x: &[f64; 2]) -> f64 {
    let case = model.case;
    case.bodies
        .iter()
        .map(|part| {
            let material = &case.materials[part.material];
            match &material.profiles.unit_weight {
                None => sum_above(&part.polygon, x, |level| level) * material.unit_weight,
                Some(own) => sum_above(&part.polygon, x, |level| own.integral(x[1], level)),
            }
        })
        .sum()
}

/// The growth of a quantity that rises with the level along the part of the vertical ray upwards from a point that
/// lies within a polygon: with the level itself, the length \[m\].
fn sum_above(polygon: &[[f64; 2]], x: &[f64; 2], quantity: impl Fn(f64) -> f64) -> f64 {
    let mut sum = 0.0;
    for (k, p) in polygon.iter().enumerate() {
        let q = polygon[(k + 1) % polygon.len()];
        if (p[0] <= x[0]) == (q[0] <= x[0]) {
            continue;
        }
        let t = (x[0] - p[0]) / (q[0] - p[0]);
        let crossing = quantity((p[1] + t * (q[1] - p[1])).max(x[1]));
        sum += if q[0] < p[0] { crossing } else { -crossing };
    }
    sum.abs()
}

#[cfg(test)]
mod tests {
    use super::sum_above;
    use crate::case::Profile;

    #[test]
    fn the_ray_counts_what_lies_above() {
        let length_above = |ring: &[[f64; 2]], x: &[f64; 2]| sum_above(ring, x, |level| level);
        let ring = [[0.0, 0.0], [4.0, 0.0], [4.0, 5.0], [0.0, 5.0]];
        assert!((length_above(&ring, &[1.0, 2.0]) - 3.0).abs() < 1e-15);
        assert!((length_above(&ring, &[1.0, -2.0]) - 5.0).abs() < 1e-15);
        assert!(length_above(&ring, &[1.0, 6.0]).abs() < 1e-15);
        let clockwise: Vec<[f64; 2]> = ring.iter().rev().copied().collect();
        assert!((length_above(&clockwise, &[1.0, 2.0]) - 3.0).abs() < 1e-15);
        let denser = Profile::Gradient {
            from: 4.0,
            at_top: 18.0,
            gradient: 0.5,
        };
        let weight = sum_above(&ring, &[1.0, 2.0], |level| denser.integral(2.0, level));
        assert!((weight - (18.0 + 2.0 * 18.5)).abs() < 1e-12);
    }
}
