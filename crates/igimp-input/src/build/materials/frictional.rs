//! Soil with cohesion and friction, Mohr–Coulomb and Drucker–Prager: its parameters from what a file states.

use igimp_material::{Cone, InertialFriction};
use igimp_model::{Flow, Strength};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::materials::{
    self as keys, DruckerPrager, Frictional, InertialRate, Model, MohrCoulomb,
};
use igimp_schema::text::{clip, number};
use igimp_schema::tree::read::{At, Either};

use super::parameters::{ANGLE_OR_NONE, Parameters, STRESS_OR_NONE};
use super::profiles::{Extent, Property, TABLES, Terms, property};
use super::{STRENGTH, softening};

/// Terms of friction that varies.
const FRICTION: Terms = Terms {
    may_vanish: true,
    may_be_nothing: true,
    kept: f64::tan,
    printed: |value| format!("{} deg", number(value.atan().to_degrees())),
    forms: TABLES,
};

/// Cohesion, and tan φ.
pub(super) fn properties<const D: usize>(
    law: &Frictional,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) -> [Option<Property>; 2] {
    let cohesive = law.cohesion.as_ref().ok();
    let cohesive = cohesive.and_then(|at| property(at, "cohesion", extent, STRENGTH, problems));
    [cohesive, friction(law, extent, problems)]
}

/// tan φ, where the angle is one.
fn friction<const D: usize>(
    law: &Frictional,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) -> Option<Property> {
    let stated = law.friction.as_ref().ok()?;
    let is_steep = |angle: f64| angle.to_degrees() > 89.999_999;
    let steep = match &**stated {
        Either::First(angle) => is_steep(*angle).then_some(stated.place),
        Either::Second(table) => (table.values.iter().flat_map(|values| values.iter()))
            .find(|angle| is_steep(***angle))
            .map(|angle| angle.place),
    };
    if let Some(place) = steep {
        problems
            .error(place, "the friction angle must be below 90 deg")
            .help("soils have 15 deg to 45 deg");
        return None;
    }
    property(stated, "friction", extent, FRICTION, problems)
}

/// Refuses undrained soil that dilates as associated flow does; warns of one that `dilates`.
pub(super) fn never_fails(model: &Model, dilates: bool, problems: &mut Problems) -> Option<()> {
    if let Model::MohrCoulomb(Ok(law)) = model
        && let flow = law.flow.as_ref().ok()?
        && **flow == keys::Flow::Davis
    {
        problems
            .error(
                flow.place,
                "flow = \"davis\" dilates as associated flow does, and undrained soil that dilates never fails",
            )
            .help("leave `flow` out, or model = \"tresca\" with the undrained strength");
        return None;
    }
    let Some(law) = model.frictional() else {
        return Some(());
    };
    let dilation = law.dilation.as_ref().ok()?;
    if dilates && !softening::ends_dilation(model) {
        problems
            .warning(
                dilation.place,
                "undrained soil that dilates never fails: suction grows without limit",
            )
            .help("dilation = \"0 deg\" for undrained soil");
    }
    Some(())
}

/// c, φ and ψ.
fn angles<const D: usize>(
    law: &Frictional,
    [cohesive, friction]: [Option<&Property>; 2],
    read: &mut Parameters<'_, '_, D>,
) -> Option<[f64; 3]> {
    let cohesion = cohesive.map(|prop| prop.constant);
    let friction_varies = friction.is_some_and(|prop| prop.profile.is_some());
    // An angle that is stated is kept to the last bit.
    let stated = law.friction.as_ref().ok().map(|at| &at.value);
    let friction = friction.and_then(|prop| match (&prop.profile, stated) {
        (None, Some(Either::First(angle))) => Some(*angle),
        (None, _) => None,
        (Some(_), _) => Some(prop.constant.atan()),
    });
    let stated = law.dilation.as_ref().ok();
    let dilation = stated.and_then(|at| read.read("dilation", at, ANGLE_OR_NONE, None));
    if let (Some(friction), Some(dilation)) = (friction, dilation)
        && dilation.most > friction * (1.0 + if friction_varies { 1e-12 } else { 0.0 })
    {
        read.problems
            .error(
                dilation.place,
                "dilation angle is larger than the friction angle",
            )
            .help("dilation <= friction");
    }
    if let (Some(cohesion), Some(friction)) = (cohesion, friction)
        && cohesion == 0.0
    {
        no_cohesion(read.extent.name, law, friction, read.problems)?;
    }
    Some([cohesion?, friction?, dilation?.most.min(friction?)])
}

/// Drucker–Prager.
pub(super) fn drucker_prager<const D: usize>(
    law: &DruckerPrager,
    both: [Option<&Property>; 2],
    read: &mut Parameters<'_, '_, D>,
) -> Option<Strength> {
    let parameters = angles(&law.strength, both, read);
    let rate = match law.rate.as_ref().ok()? {
        Some(rate) => {
            let dilates = parameters.is_some_and(|angles| angles[2] > 0.0);
            Some(inertial((rate, dilates), law, both, read.problems)?)
        }
        None => None,
    };
    let [cohesion, friction_angle, dilation_angle] = parameters?;
    Some(Strength::DruckerPrager {
        cohesion,
        friction_angle,
        dilation_angle,
        cone: match **law.cone.as_ref().ok()? {
            keys::Cone::Compression => Cone::Compression,
            keys::Cone::Extension => Cone::Extension,
            keys::Cone::PlaneStrain => Cone::PlaneStrain,
        },
        rate,
    })
}

/// Friction that grows with the speed of shear, of soil that keeps its volume and has one strength.
fn inertial(
    (rate, dilates): (&At<InertialRate>, bool),
    law: &DruckerPrager,
    both: [Option<&Property>; 2],
    problems: &mut Problems,
) -> Option<InertialFriction> {
    let dilation = law.strength.dilation.as_ref().ok()?;
    let slow = match &**law.strength.friction.as_ref().ok()? {
        Either::First(angle) => Some(*angle),
        Either::Second(_) => None,
    };
    let fast = &rate.friction;
    let varies = both.iter().flatten().any(|prop| prop.profile.is_some());
    let refused = match slow {
        _ if dilates => Some((
            dilation.place,
            "`rate` is of soil that keeps its volume as it flows, and this one dilates",
            "dilation = \"0 deg\", or remove `rate`",
        )),
        Some(slow) if !varies && **fast <= slow => Some((
            fast.place,
            "the friction angle of fast shear must be above that of slow shear",
            "with the cone of plane strain mu of the literature is the sine of the angle: glass beads have 22.3 deg and 39.8 deg",
        )),
        _ if fast.to_degrees() > 89.999_999 => Some((
            fast.place,
            "the friction angle must be below 90 deg",
            "grains have 30 deg to 45 deg in fast shear",
        )),
        Some(slow) if !varies && slow > 0.0 => None,
        _ => Some((
            rate.place,
            "`rate` needs one cohesion and one friction angle, above zero",
            "layers with materials of their own in place of what varies",
        )),
    };
    if let Some((place, message, help)) = refused {
        problems.error(place, message).help(help);
        return None;
    }
    Some(InertialFriction {
        friction_angle: **fast,
        inertial_number: *rate.inertial_number,
        grain_diameter: *rate.grain_diameter,
        grain_density: *rate.grain_density,
    })
}

/// Mohr–Coulomb.
pub(super) fn mohr_coulomb<const D: usize>(
    law: &MohrCoulomb,
    both: [Option<&Property>; 2],
    read: &mut Parameters<'_, '_, D>,
) -> Option<Strength> {
    let [cohesive, _] = both;
    let parameters = angles(&law.strength, both, read);
    let cutoff = match law.tension_cutoff.as_ref().ok()? {
        Some(stress) => Some(read.read("tension_cutoff", stress, STRESS_OR_NONE, None)?),
        None => None,
    };
    let cohesion_varies = cohesive.is_some_and(|prop| prop.profile.is_some());
    if let Some(cutoff) = cutoff.filter(|cutoff| cohesion_varies && cutoff.most > 0.0) {
        read.problems
            .error(
                cutoff.place,
                "a tension cut-off above zero does not go with a cohesion that varies",
            )
            .help("tension_cutoff = \"0 kPa\", or leave it out: cohesion / tan(friction) limits tension");
        return None;
    }
    if let (Some([cohesion, friction, _]), Some(cutoff)) = (parameters, cutoff) {
        let apex = cohesion / friction.tan();
        if friction > 0.0 && cutoff.least > apex * (1.0 + 1e-12) {
            read.problems
                .warning(
                    cutoff.place,
                    "this tension cut-off never acts: it lies above the apex of the cone",
                )
                .help(format!(
                    "apex: cohesion / tan(friction) = {} kPa",
                    number(apex / 1e3)
                ));
        } else if friction > 0.0 && cutoff.least > NEARLY_APEX * apex {
            read.problems
                .warning(
                    cutoff.place,
                    format!("this tension cut-off leaves nearly all of the tension of the cone, {} kPa", number(apex / 1e3)),
                )
                .help("soil carries next to no tension: tension_cutoff = \"0 kPa\"; rock carries a tenth of its compressive strength");
        }
    }
    let [cohesion, friction_angle, dilation_angle] = parameters?;
    Some(Strength::MohrCoulomb {
        cohesion,
        friction_angle,
        dilation_angle,
        flow: match **law.flow.as_ref().ok()? {
            keys::Flow::Davis => Flow::Davis,
            keys::Flow::Dilation => Flow::Dilation,
        },
        tension_cutoff: cutoff.map(|cutoff| cutoff.most),
    })
}

/// Share of the apex of a cone from which on a cut-off takes next to nothing away \[-\].
const NEARLY_APEX: f64 = 0.8;

/// Refuses soil without cohesion and friction, somewhere or everywhere; warns of soil without cohesion.
fn no_cohesion(name: &str, law: &Frictional, friction: f64, problems: &mut Problems) -> Option<()> {
    let name = clip(name, 40);
    let stated = law.friction.as_ref().ok()?;
    if let Either::Second(table) = &**stated
        && (table.values.iter().flat_map(|values| values.iter())).any(|angle| **angle == 0.0)
    {
        problems
            .error(
                stated.place,
                format!("`{name}` has no strength where friction is zero"),
            )
            .help("a small cohesion, like cohesion = \"0.1 kPa\"");
        return None;
    }
    let place = law.cohesion.as_ref().ok()?.place;
    if friction == 0.0 {
        problems
            .error(place, format!("`{name}` has neither cohesion nor friction"))
            .help("give it one of them, or model = \"elastic\"");
    } else {
        problems
            .warning(
                place,
                format!("`{name}` has no cohesion: without confinement it has no strength"),
            )
            .help("it counts with a cohesion of unit_weight × cell / 400, which the cells at its face need");
    }
    Some(())
}
