//! Materials and the limits of their parameters.

mod cam_clay;
mod plausible;
pub(crate) mod profiles;

use std::sync::Arc;

use igimp_model::{BodyPart, Drainage, Flow, Ground, Layer, Material, Profile, Profiles, Strength};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::materials::{self as keys, MaterialCommon, Model, MohrCoulomb};
use igimp_schema::text::{clip, number};
use igimp_schema::tree::read::{At, Either, Found, Named};
use igimp_schema::tree::{Node, Wrong};
use igimp_seepage::{Curve, Soil};

use profiles::{Extent, Property, TABLES, Terms, property};

/// What may be said of a strength, of Young's modulus, of a unit weight and of friction that vary.
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
const FRICTION: Terms = Terms {
    may_vanish: true,
    may_be_nothing: true,
    kept: f64::tan,
    printed: |value| format!("{} deg", number(value.atan().to_degrees())),
    forms: TABLES,
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
        added: 0.0,
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
    }
    let saturated = saturated(name, common, unit_weight, problems);
    let stiffness = match (linear, strength) {
        (Some(own), _) => {
            (young.as_ref()).and_then(|young| Some([young.constant, **own.poisson.as_ref().ok()?]))
        }
        (None, Some(Strength::ModifiedCamClay(own))) => cam_clay::stiffness(own),
        (None, _) => None,
    };
    let drainage = drainage((common, &own.form), stiffness, strength, problems);
    let material = Material {
        saturated: saturated.ok()?,
        drainage: drainage?,
        permeability: permeability(common, problems).ok()?,
        given: None,
        name: name.clone(),
        unit_weight: unit_weight?.constant,
        young: stiffness?[0],
        poisson: stiffness?[1],
        strength: strength?,
        k0: k0.ok()?,
        profiles: Profiles {
            strength: profile(cohesive.as_ref()),
            friction: profile(friction.as_ref()),
            young: profile(young.as_ref()),
            unit_weight: profile(unit_weight),
        },
    };
    if problems.errors() == before
        && let Err(error) = material.law()
    {
        let message = format!("the material `{}` is not possible: {error}", clip(name, 40));
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
        Model::CamClay(_) => None,
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
        Model::MohrCoulomb(Err(_)) => (None, None, None),
        Model::MohrCoulomb(Ok(own)) => {
            let cohesive = own.cohesion.as_ref().ok();
            let cohesive =
                cohesive.and_then(|own| property(own, "cohesion", extent, STRENGTH, problems));
            let friction = friction(own, extent, problems);
            let both = [cohesive.as_ref(), friction.as_ref()];
            let strength = mohr_coulomb(name, own, both, problems);
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
        Model::MohrCoulomb(Ok(own)) => {
            all.push(("cohesion", constant(&own.cohesion)));
            all.push(("friction", constant(&own.friction)));
        }
        _ => {}
    }
    let stated = all.into_iter().filter_map(|(key, own)| Some((key, own?)));
    stated.collect()
}

/// tan φ, where the angle is one.
fn friction<const D: usize>(
    own: &MohrCoulomb,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) -> Option<Property> {
    let stated = own.friction.as_ref().ok()?;
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

/// The permeability, if the material states one.
fn permeability(common: &MaterialCommon, problems: &mut Problems) -> Result<Option<Soil>, Wrong> {
    let stated = common.permeability.as_ref().map_err(|_| Wrong)?;
    let Some(stated) = stated else {
        return Ok(None);
    };
    let own = match &**stated {
        Either::First(permeability) => return Ok(Some(Soil::isotropic(*permeability))),
        Either::Second(own) => own,
    };
    let curve = match (&own.gardner, &own.van_genuchten) {
        (Some(_), Some(second)) => {
            problems
                .error(second.place, "both `gardner` and `van_genuchten` are given")
                .help("keep the curve that was measured");
            return Err(Wrong);
        }
        (Some(height), None) => Curve::Gardner {
            alpha: 1.0 / **height,
        },
        (None, Some(own)) => {
            if *own.n <= 1.0 {
                problems
                    .error(own.n.place, "n of van Genuchten's curve has to be above 1")
                    .help("clay has about 1.1 to 1.4, sand 2 to 3");
                return Err(Wrong);
            }
            Curve::VanGenuchten {
                alpha: 1.0 / *own.height,
                n: *own.n,
            }
        }
        (None, None) => Curve::Ramp,
    };
    Ok(Some(Soil {
        along: *own.horizontal,
        across: own.vertical.as_ref().map_or(*own.horizontal, |own| **own),
        angle: *own.angle,
        curve,
        drainable: own.drainable.as_ref().map_or(0.0, |own| **own),
        // It follows from the stiffness, with the weight of the water.
        specific_storage: 0.0,
    }))
}

/// The unit weight below a water table, if the material states one.
fn saturated(
    name: &str,
    common: &MaterialCommon,
    unit_weight: Option<&Property>,
    problems: &mut Problems,
) -> Result<Option<f64>, Wrong> {
    let stated = common.saturated_unit_weight.as_ref().map_err(|_| Wrong)?;
    if let (Some(saturated), Some(above)) = (stated, unit_weight)
        && **saturated < above.constant
    {
        problems
            .error(
                saturated.place,
                format!(
                    "`{}` would be lighter with full pores, {} kN/m3, than above the water, {} kN/m3",
                    clip(name, 40),
                    number(**saturated / 1e3),
                    number(above.constant / 1e3)
                ),
            )
            .help("it is the weight of soil and water together, not that under buoyancy");
        return Err(Wrong);
    }
    Ok(stated.as_ref().map(|own| **own))
}

/// Poisson's ratio of undrained soil where the file does not say.
const UNDRAINED_POISSON: f64 = 0.495;

/// What a material does with water.
fn drainage(
    (common, model): (&MaterialCommon, &Model),
    stiffness: Option<[f64; 2]>,
    strength: Option<Strength>,
    problems: &mut Problems,
) -> Option<Drainage> {
    let kind = **common.drainage.as_ref().ok()?.as_ref()?;
    let (undrained, pore_water) = (&common.undrained_poisson, &common.pore_water);
    let (undrained, pore_water) = (undrained.as_ref().ok()?, pore_water.as_ref().ok()?);
    let first = match (undrained, pore_water) {
        (Some(own), _) => Some(("undrained_poisson", own.place)),
        (None, own) => own.as_ref().map(|own| ("pore_water", own.place)),
    };
    let unlike = match kind {
        keys::Drainage::Undrained => None,
        keys::Drainage::Total => Some((Drainage::Total, "one of total stress")),
        keys::Drainage::Drained => Some((Drainage::Drained, "drained")),
    };
    if let Some((drainage, words)) = unlike {
        let Some((first, place)) = first else {
            return Some(drainage);
        };
        problems
            .error(
                place,
                format!("`{first}` is for undrained soil, and this material is {words}"),
            )
            .help("write drainage = \"undrained\", or remove it");
        return None;
    }
    if let (Some(_), Some(second)) = (undrained, pore_water) {
        problems
            .error(
                second.place,
                "both `undrained_poisson` and `pore_water` are given",
            )
            .help("keep one of them");
        return None;
    }
    if let (Model::MohrCoulomb(Ok(own)), Some(Strength::MohrCoulomb { .. })) = (model, strength) {
        never_fails(own, problems)?;
    }
    if let Some(stiffness) = pore_water {
        return Some(Drainage::Undrained {
            stiffness: **stiffness,
        });
    }
    let [young, poisson] = stiffness?;
    let stated = linear_stiffness(model).and_then(|own| own.poisson.as_ref().ok());
    let with_water = undrained.as_ref().map_or(UNDRAINED_POISSON, |own| **own);
    if with_water >= 0.5 || with_water <= poisson {
        let stated = stated.map(|own| own.place);
        problems
            .error(
                undrained.as_ref().map(|own| own.place).or(stated),
                format!(
                    "Poisson's ratio of undrained soil, {}, must lie between that of its skeleton, {}, and 0.5",
                    number(with_water),
                    number(poisson)
                ),
            )
            .help("poisson is that of drained soil, like 0.3; undrained_poisson = 0.495");
        return None;
    }
    let shear = young / (2.0 * (1.0 + poisson));
    let bulk = |poisson: f64| 2.0 * shear * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson));
    Some(Drainage::Undrained {
        stiffness: bulk(with_water) - bulk(poisson),
    })
}

/// Refuses undrained soil that dilates as associated flow does; warns of one that dilates.
fn never_fails(own: &MohrCoulomb, problems: &mut Problems) -> Option<()> {
    let (flow, dilation) = (own.flow.as_ref().ok()?, own.dilation.as_ref().ok()?);
    if **flow == keys::Flow::Davis {
        problems
            .error(
                flow.place,
                "flow = \"davis\" dilates as associated flow does, and undrained soil that dilates never fails",
            )
            .help("leave `flow` out, or model = \"tresca\" with the undrained strength");
        return None;
    }
    if **dilation > 0.0 {
        problems
            .warning(
                dilation.place,
                "undrained soil that dilates never fails: suction grows without limit",
            )
            .help("dilation = \"0 deg\" for undrained soil");
    }
    Some(())
}

fn mohr_coulomb(
    name: &str,
    own: &MohrCoulomb,
    [cohesive, friction]: [Option<&Property>; 2],
    problems: &mut Problems,
) -> Option<Strength> {
    let cohesion = cohesive.map(|own| own.constant);
    let friction_varies = friction.is_some_and(|own| own.profile.is_some());
    // An angle that is stated is kept to the last bit.
    let stated = own.friction.as_ref().ok().map(|own| &own.value);
    let friction = friction.and_then(|own| match (&own.profile, stated) {
        (None, Some(Either::First(angle))) => Some(*angle),
        (None, _) => None,
        (Some(_), _) => Some(own.constant.atan()),
    });
    let dilation = own.dilation.as_ref().ok();
    if let (Some(friction), Some(dilation)) = (friction, dilation)
        && **dilation > friction * (1.0 + if friction_varies { 1e-12 } else { 0.0 })
    {
        problems
            .error(
                dilation.place,
                "dilation angle is larger than the friction angle",
            )
            .help("dilation <= friction");
    }
    if let (Some(cohesion), Some(friction)) = (cohesion, friction)
        && cohesion == 0.0
    {
        no_cohesion(name, own, friction, problems)?;
    }
    let cutoff = own.tension_cutoff.as_ref().ok()?.as_ref();
    let cohesion_varies = cohesive.is_some_and(|own| own.profile.is_some());
    if let Some(cutoff) = cutoff.filter(|cutoff| cohesion_varies && ***cutoff > 0.0) {
        problems
            .error(
                cutoff.place,
                "a constant tension cut-off does not go with a cohesion that varies",
            )
            .help("tension_cutoff = \"0 kPa\", or leave it out: cohesion / tan(friction) limits tension");
        return None;
    }
    if let (Some(cohesion), Some(friction), Some(cutoff)) = (cohesion, friction, cutoff) {
        let apex = cohesion / friction.tan();
        if friction > 0.0 && **cutoff > apex * (1.0 + 1e-12) {
            problems
                .warning(
                    cutoff.place,
                    "this tension cut-off never acts: it lies above the apex of the cone",
                )
                .help(format!(
                    "apex: cohesion / tan(friction) = {} kPa",
                    number(apex / 1e3)
                ));
        }
    }
    Some(Strength::MohrCoulomb {
        cohesion: cohesion?,
        friction_angle: friction?,
        dilation_angle: (**dilation?).min(friction?),
        flow: match **own.flow.as_ref().ok()? {
            keys::Flow::Davis => Flow::Davis,
            keys::Flow::Dilation => Flow::Dilation,
        },
        tension_cutoff: cutoff.map(|cutoff| **cutoff),
    })
}

/// Refuses soil without cohesion and friction, somewhere or everywhere; warns of soil without cohesion.
fn no_cohesion(
    name: &str,
    own: &MohrCoulomb,
    friction: f64,
    problems: &mut Problems,
) -> Option<()> {
    let name = clip(name, 40);
    let stated = own.friction.as_ref().ok()?;
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
    let place = own.cohesion.as_ref().ok()?.place;
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
        (Either::Second(_), Some(Strength::MohrCoulomb { .. })) if friction_varies => {
            "k0 = \"jaky\" needs one friction angle, and friction varies here"
        }
        (Either::Second(_), Some(Strength::MohrCoulomb { friction_angle, .. })) => {
            return Ok(Some(1.0 - friction_angle.sin()));
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
