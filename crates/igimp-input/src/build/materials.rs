//! Materials and the limits of their parameters.

mod cam_clay;
mod checks;
mod frictional;
mod hardening_soil;
mod hoek_brown;
mod plausible;
pub(crate) mod profiles;
mod softening;
mod unused;
mod water;

use std::sync::Arc;

use igimp_model::{BodyPart, Ground, Layer, Material, Profile, Profiles, Strength};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::materials::{self as keys, MaterialCommon, Model};
use igimp_schema::text::{clip, number};
use igimp_schema::tree::read::{At, Either, Found, Named};
use igimp_schema::tree::{Node, Wrong};

use profiles::{Extent, Property, Terms, property};
use water::{drainage, permeability, saturated};

pub(super) use checks::{check_lengths, check_on_cells, check_rates};
pub(super) use unused::check_unused;

/// What may be said of a strength, of Young's modulus and of a unit weight that vary.
const STRENGTH: Terms = Terms {
    may_vanish: true,
    may_be_nothing: false,
    kept: |value| value,
    printed: |value| format!("{} kPa", number(value / 1e3)),
    forms: "{ at_top = ..., gradient = ... }, { at_surface = ..., gradient = ... }, { levels = [...], values = [...] }, or { raster = ... }",
};
const UNDRAINED: Terms = Terms {
    forms: "{ at_top = ..., gradient = ... }, { at_surface = ..., gradient = ... }, { levels = [...], values = [...] }, { raster = ... }, or { ratio = ..., ocr = ... }",
    ..STRENGTH
};
const YOUNG: Terms = Terms {
    may_vanish: false,
    ..STRENGTH
};
const UNIT_WEIGHT: Terms = Terms {
    may_be_nothing: true,
    printed: |value| format!("{} kN/m3", number(value / 1e3)),
    ..STRENGTH
};

/// The materials in the order of the file.
pub(super) fn materials<const D: usize>(
    tree: &Node,
    bodies: &[Option<BodyPart<D>>],
    problems: &mut Problems,
) -> Vec<Option<Material>> {
    let stated = Root::<D>::materials(tree).map_or_else(|Wrong| Vec::new(), |own| own.value.0);
    let outlines = bodies.iter().flatten();
    let layer = |body: &BodyPart<D>, unit_weight, profile| Layer {
        region: Arc::clone(&body.region),
        unit_weight,
        profile,
        saturated: None,
    };
    let surface = Ground::of_layers(outlines.map(|body| layer(body, 0.0, None)));
    let weights: Vec<Option<Property>> = (stated.iter().enumerate())
        .map(|(material, own)| {
            let extent = Extent {
                name: &own.name,
                material,
                bodies,
                ground: &surface,
            };
            let common = own.value.as_ref().ok()?.common.as_ref().ok()?;
            let weight = common.unit_weight.as_ref().ok()?;
            property(weight, "unit_weight", extent, UNIT_WEIGHT, problems)
        })
        .collect();
    let with_weights = bodies.iter().flatten().filter_map(|body| {
        let weight = weights.get(body.material)?.as_ref()?;
        Some(layer(body, weight.constant, weight.profile.clone()))
    });
    let ground = Ground::of_layers(with_weights);
    let of_water = Root::<D>::case(tree).map(|own| *own.water_unit_weight);
    let ground = match of_water {
        Ok(unit_weight) => ground.with_water_of(unit_weight),
        Err(Wrong) => ground,
    };
    std::iter::zip(&stated, &weights)
        .enumerate()
        .map(|(index, (own, weight))| {
            let extent = Extent {
                name: &own.name,
                material: index,
                bodies,
                ground: &ground,
            };
            material(own, weight.as_ref(), extent, problems)
        })
        .collect()
}

fn material<const D: usize>(
    stated: &Named<keys::Material>,
    unit_weight: Option<&Property>,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) -> Option<Material> {
    let (name, own) = (&stated.name, stated.value.as_ref().ok()?);
    let common = own.common.as_ref().ok()?;
    let before = problems.errors();
    let linear = linear_stiffness(&own.form);
    if let Some(Ok(poisson)) = linear.map(|own| &own.poisson) {
        check_poisson(poisson, problems);
    }
    let young = linear.and_then(|own| own.young.as_ref().ok());
    let young = young.and_then(|own| property(own, "young", extent, YOUNG, problems));
    let Resistance {
        strength,
        cohesive,
        friction,
    } = resistance(name, &own.form, extent, problems);
    let profile = |own: Option<&Property>| -> Option<Profile> { own?.profile.clone() };
    let k0 = k0(
        common,
        strength,
        profile(friction.as_ref()).is_some(),
        problems,
    );
    if problems.errors() == before {
        plausible::check(name, &constants(own, common), problems);
        let varies = [&cohesive, &friction].map(|own| profile(own.as_ref()).is_some());
        if let (Some(strength), Some(weight), [false, false]) = (strength, unit_weight, varies) {
            check_at_rest(common, strength, weight, extent, problems);
        }
    }
    let saturated = saturated(name, common, unit_weight, problems);
    let stiffness = match (linear, strength) {
        (Some(own), _) => {
            (young.as_ref()).and_then(|young| Some([young.constant, **own.poisson.as_ref().ok()?]))
        }
        (None, Some(Strength::ModifiedCamClay(own))) => cam_clay::stiffness(own),
        (None, Some(Strength::HardeningSoil(own))) => Some([own.unloading, own.poisson]),
        (None, _) => None,
    };
    let softening = softening::curves(name, &own.form, strength, problems);
    let drainage = drainage((common, &own.form), stiffness, strength, problems);
    let permeable = permeability(common, extent, problems).ok()?;
    let material = Material {
        saturated: saturated.ok()?,
        drainage: drainage?,
        permeability: permeable.as_ref().map(|own| own.soil),
        void_law: permeable.as_ref().and_then(|own| own.void_law),
        given: None,
        name: name.clone(),
        unit_weight: unit_weight?.constant,
        young: stiffness?[0],
        poisson: stiffness?[1],
        strength: strength?,
        softening: softening.ok()?,
        k0: k0.ok()?,
        profiles: Profiles {
            strength: profile(cohesive.as_ref()),
            friction: profile(friction.as_ref()),
            young: profile(young.as_ref()),
            unit_weight: profile(unit_weight),
            permeability: permeable.and_then(|own| own.profile),
        },
    };
    if problems.errors() == before
        && let Err(why) = checks::possible(&material, 0.0)
    {
        let message = format!("the material `{}` is not possible{why}", clip(name, 40));
        problems.error(stated.place, message);
    }
    Some(material)
}

/// The keys of linear elasticity, if the model has them.
pub(crate) fn linear_stiffness(model: &Model) -> Option<&keys::Stiffness> {
    match model {
        Model::Elastic(own) => own.as_ref().ok().map(|own| &own.stiffness),
        Model::VonMises(own) => own.as_ref().ok().map(|own| &own.stiffness),
        Model::Tresca(own) => own.as_ref().ok().map(|own| &own.stiffness),
        Model::MohrCoulomb(own) => own.as_ref().ok().map(|own| &own.stiffness),
        Model::DruckerPrager(own) => own.as_ref().ok().map(|own| &own.stiffness),
        Model::HoekBrown(own) => own.as_ref().ok().map(|own| &own.stiffness),
        Model::CamClay(_) | Model::HardeningSoil(_) => None,
    }
}

/// Refuses Poisson's ratios of 0.5 and more, and warns of those close to it.
fn check_poisson(poisson: &At<f64>, problems: &mut Problems) {
    if **poisson >= 0.5 {
        problems
            .error(poisson.place, "Poisson's ratio must be below 0.5")
            .help("nearly incompressible, as undrained soil is: poisson = 0.49");
    } else if **poisson > 0.499 {
        problems
            .warning(poisson.place, "Poisson's ratio is very close to 0.5")
            .help("the tangent is badly conditioned; 0.49 to 0.495 is close enough");
    }
}

/// The strength of a material, and the properties that it comes from.
struct Resistance {
    strength: Option<Strength>,
    cohesive: Option<Property>,
    friction: Option<Property>,
}

fn resistance<const D: usize>(
    name: &str,
    model: &Model,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) -> Resistance {
    let mut undrained = |own: &keys::Undrained| {
        let cu = own.cu.as_ref().ok()?;
        property(cu, "cu", extent, UNDRAINED, problems)
    };
    let (strength, cohesive, friction) = match model {
        Model::Elastic(_) => (Some(Strength::Elastic), None, None),
        Model::VonMises(own) => {
            let cohesive = own.as_ref().ok().and_then(|own| undrained(&own.strength));
            let strength = cohesive.as_ref().map(|own| Strength::VonMises {
                undrained_strength: own.constant,
            });
            (strength, cohesive, None)
        }
        Model::Tresca(own) => {
            let cohesive = own.as_ref().ok().and_then(|own| undrained(&own.strength));
            let strength = cohesive.as_ref().map(|own| Strength::Tresca {
                undrained_strength: own.constant,
            });
            (strength, cohesive, None)
        }
        Model::CamClay(own) => {
            let own = own.as_ref().ok();
            (
                own.and_then(|own| cam_clay::strength(own, problems)),
                None,
                None,
            )
        }
        Model::HardeningSoil(own) => {
            let own = own.as_ref().ok();
            (
                own.and_then(|own| hardening_soil::strength(own, problems)),
                None,
                None,
            )
        }
        Model::HoekBrown(own) => {
            let own = own.as_ref().ok();
            (
                own.and_then(|own| hoek_brown::strength(own, problems)),
                None,
                None,
            )
        }
        Model::MohrCoulomb(Err(_)) | Model::DruckerPrager(Err(_)) => (None, None, None),
        Model::MohrCoulomb(Ok(own)) => {
            let both = frictional::properties(&own.strength, extent, problems);
            let strength =
                frictional::mohr_coulomb(name, own, both.each_ref().map(Option::as_ref), problems);
            let [cohesive, friction] = both;
            (strength, cohesive, friction)
        }
        Model::DruckerPrager(Ok(own)) => {
            let both = frictional::properties(&own.strength, extent, problems);
            let strength = frictional::drucker_prager(
                name,
                own,
                both.each_ref().map(Option::as_ref),
                problems,
            );
            let [cohesive, friction] = both;
            (strength, cohesive, friction)
        }
    };
    Resistance {
        strength,
        cohesive,
        friction,
    }
}

/// The constants that a material states, with their keys.
fn constants(own: &keys::Material, common: &MaterialCommon) -> Vec<(&'static str, At<f64>)> {
    fn constant<T>(own: &Found<Either<f64, T>>) -> Option<At<f64>> {
        let own = own.as_ref().ok()?;
        let Either::First(value) = own.value else {
            return None;
        };
        Some(At {
            value,
            place: own.place,
            key_place: own.key_place,
            written: own.written,
        })
    }
    let mut all = vec![
        ("unit_weight", constant(&common.unit_weight)),
        (
            "young",
            linear_stiffness(&own.form).and_then(|own| constant(&own.young)),
        ),
    ];
    match &*own.form {
        Model::VonMises(Ok(own)) => all.push(("cu", constant(&own.strength.cu))),
        Model::Tresca(Ok(own)) => all.push(("cu", constant(&own.strength.cu))),
        _ => {}
    }
    if let Some(own) = frictional::keys_of(&own.form) {
        all.push(("cohesion", constant(&own.cohesion)));
        all.push(("friction", constant(&own.friction)));
    }
    if let Ok(Some(own)) = &common.permeability {
        all.push(("permeability", water::greatest(own)));
    }
    let stated = all.into_iter().filter_map(|(key, own)| Some((key, own?)));
    stated.collect()
}

/// Warns of a K₀ that the strength of the bodies of a material does not allow.
fn check_at_rest<const D: usize>(
    common: &MaterialCommon,
    strength: Strength,
    weight: &Property,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) {
    let Ok(Some(stated)) = &common.k0 else {
        return;
    };
    let Either::First(value) = **stated else {
        return;
    };
    let height = |body: &BodyPart<D>| {
        let (lower, upper) = body.region.bounds();
        upper[D - 1] - lower[D - 1]
    };
    let bodies = extent.bodies.iter().flatten();
    let own = bodies.filter(|body| body.material == extent.material);
    let highest = own.map(height).fold(0.0, f64::max);
    let k0 = At {
        value,
        place: stated.place,
        key_place: stated.key_place,
        written: stated.written,
    };
    let loaded = (strength, highest * weight.constant);
    plausible::check_k0(extent.name, &k0, loaded, problems);
}

/// K₀ of a material, if it states one.
fn k0(
    common: &MaterialCommon,
    strength: Option<Strength>,
    friction_varies: bool,
    problems: &mut Problems,
) -> Result<Option<f64>, Wrong> {
    let Some(stated) = common.k0.as_ref().map_err(|_| Wrong)? else {
        return Ok(None);
    };
    let refused = match (&**stated, strength) {
        (Either::First(value), _) => return Ok(Some(*value)),
        (Either::Second(_), None) => return Err(Wrong),
        (
            Either::Second(_),
            Some(Strength::MohrCoulomb { .. } | Strength::DruckerPrager { .. }),
        ) if friction_varies => "k0 = \"jaky\" needs one friction angle, and friction varies here",
        (
            Either::Second(_),
            Some(
                Strength::MohrCoulomb { friction_angle, .. }
                | Strength::DruckerPrager { friction_angle, .. },
            ),
        ) => {
            return Ok(Some(1.0 - friction_angle.sin()));
        }
        (Either::Second(_), Some(Strength::HardeningSoil(own))) => {
            return Ok(Some(1.0 - own.friction_angle.sin()));
        }
        (Either::Second(_), Some(Strength::ModifiedCamClay(own))) => {
            // sin φ of M in triaxial compression.
            return Ok(Some(
                1.0 - 3.0 * own.critical_ratio / (6.0 + own.critical_ratio),
            ));
        }
        (Either::Second(_), Some(_)) => "k0 = \"jaky\" needs a friction angle",
    };
    problems
        .error(stated.place, refused)
        .help("write a number, like k0 = 0.5");
    Err(Wrong)
}
