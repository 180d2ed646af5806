//! Materials and the limits of their parameters.

mod cam_clay;
mod frictional;
mod hardening_soil;
mod hoek_brown;
mod plausible;
pub(crate) mod profiles;
mod softening;

use std::sync::Arc;

use igimp_assembly::VoidLaw;
use igimp_linear::SolverKind;
use igimp_model::{
    BodyPart, Case, Drainage, Ground, Layer, Material, Profile, Profiles, Stage, StageKind,
    Strength,
};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::materials::{self as keys, MaterialCommon, Model};
use igimp_schema::text::{clip, number};
use igimp_schema::tree::read::{At, Either, Found, Named};
use igimp_schema::tree::{Node, Wrong};
use igimp_seepage::{Curve, Soil};

use profiles::{Extent, Property, TABLES, Terms, property};

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
const PERMEABILITY: Terms = Terms {
    printed: |value| format!("{} m/s", number(value)),
    forms: TABLES,
    ..YOUNG
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
        (None, Some(Strength::HardeningSoil(own))) => Some([own.unloading, own.poisson]),
        (None, _) => None,
    };
    let varies = profile(friction.as_ref()).is_some();
    let softening = softening::curves(name, &own.form, (strength, varies), problems);
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
        && let Err(error) = material.law()
    {
        let message = format!("the material `{}` is not possible: {error}", clip(name, 40));
        problems.error(stated.place, message);
    }
    Some(material)
}

/// Refuses strength that softens so fast, on the cells of a case, that stress snaps back.
pub(super) fn check_on_cells<const D: usize>(case: &Case<D>, problems: &mut Problems) {
    let cell = case.grid.smallest_cell()[D - 1];
    for material in &case.materials {
        let Some(curves) = material.softening.filter(|own| own.band_width.is_some()) else {
            continue;
        };
        if let Err(error) = material.law_on(cell) {
            let message = format!(
                "the material `{}` is not possible on cells of {} m, where its strains are times {}: {error}",
                clip(&material.name, 40),
                number(cell),
                number(curves.strain_ratio(cell))
            );
            problems
                .error(None, message)
                .help("smaller cells, or a larger `band_width` or `strain` of its softening");
        }
    }
}

/// Refuses strength that sees the ground around where that is not solved for, and warns of cells that do not resolve its bands.
pub(super) fn check_lengths<const D: usize>(case: &Case<D>, problems: &mut Problems) {
    let cell = (0..D)
        .map(|axis| case.grid.smallest_cell()[axis])
        .fold(0.0, f64::max);
    for material in &case.materials {
        let Some(own) = material.softening.and_then(|own| own.nonlocal) else {
            continue;
        };
        let name = clip(&material.name, 40);
        let takes_time = |stage: &&Stage| {
            stage.consolidation.is_some() || matches!(stage.kind, StageKind::Dynamic(_))
        };
        let refused = if D == 3 {
            Some("in plane strain, and this case is in space".to_owned())
        } else if let Some(stage) = case.stages.iter().find(takes_time) {
            let stage = clip(&stage.name, 40);
            Some(format!(
                "in stages without time, and stage `{stage}` takes time"
            ))
        } else if case.solver.linear == SolverKind::Multigrid {
            Some("by direct solvers, and solver.linear is \"multigrid\"".to_owned())
        } else {
            None
        };
        if let Some(why) = refused {
            problems
                .error(
                    None,
                    format!("softening of `{name}` over a length is solved for {why}"),
                )
                .help("write `band_width` in place of `length`: strains are scaled to the cells");
        } else if cell > 0.5 * own.length * (1.0 + 1e-9) {
            let message = format!(
                "cells of {} m do not resolve the bands of `{name}`, whose softening has a length of {} m",
                number(cell),
                number(own.length)
            );
            problems
                .warning(None, message)
                .help("cells of half the length or less, or `band_width` in place of `length`");
        }
    }
}

/// Refuses strength that goes with the rate of strain where no stage takes time.
pub(super) fn check_rates<const D: usize>(case: &Case<D>, problems: &mut Problems) {
    let takes_time = |stage: &Stage| {
        stage.consolidation.is_some() || matches!(stage.kind, StageKind::Dynamic(_))
    };
    if case.stages.iter().any(takes_time) {
        return;
    }
    let goes = |own: &&Material| own.softening.is_some_and(|own| own.rate.is_some());
    for material in case.materials.iter().filter(goes) {
        let message = format!(
            "the strength of `{}` goes with the rate of strain, and no stage takes time",
            clip(&material.name, 40)
        );
        problems.error(None, message).help(
            "give the stage that shears it consolidation = { duration = \"100 s\" }, make it a dynamic one, or remove `rate`",
        );
    }
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
    let stated = all.into_iter().filter_map(|(key, own)| Some((key, own?)));
    stated.collect()
}

/// A permeability as a material states it.
struct Permeability {
    /// The greatest where it varies.
    soil: Soil,
    profile: Option<Profile>,
    void_law: Option<VoidLaw>,
}

/// The permeability, if the material states one.
fn permeability<const D: usize>(
    common: &MaterialCommon,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) -> Result<Option<Permeability>, Wrong> {
    let stated = common.permeability.as_ref().map_err(|_| Wrong)?;
    let Some(stated) = stated else {
        return Ok(None);
    };
    let own = match &**stated {
        Either::First(permeability) => {
            return Ok(Some(Permeability {
                soil: Soil::isotropic(*permeability),
                profile: None,
                void_law: None,
            }));
        }
        Either::Second(own) => own,
    };
    let curve = curve(own, problems)?;
    if let (Some(index), None) = (&own.c_k, &own.void_ratio) {
        problems
            .error(
                index.place,
                "`c_k` needs the void ratio that it starts from",
            )
            .help("add void_ratio = 1.0, or what it is");
        return Err(Wrong);
    }
    let void_law = own.void_ratio.as_ref().map(|initial| VoidLaw {
        initial: **initial,
        index: own.c_k.as_ref().map(|own| **own),
    });
    let along = property(
        &own.horizontal,
        "horizontal",
        extent,
        PERMEABILITY,
        problems,
    );
    let Property { constant, profile } = along.ok_or(Wrong)?;
    let soil = Soil {
        along: constant,
        across: own.vertical.as_ref().map_or(constant, |own| **own),
        angle: *own.angle,
        curve,
        drainable: own.drainable.as_ref().map_or(0.0, |own| **own),
        // It follows from the stiffness, with the weight of the water.
        specific_storage: 0.0,
    };
    Ok(Some(Permeability {
        soil,
        profile,
        void_law,
    }))
}

/// What soil keeps of its permeability above the free surface.
fn curve(own: &keys::Permeability, problems: &mut Problems) -> Result<Curve, Wrong> {
    match (&own.gardner, &own.van_genuchten) {
        (Some(_), Some(second)) => {
            problems
                .error(second.place, "both `gardner` and `van_genuchten` are given")
                .help("keep the curve that was measured");
            Err(Wrong)
        }
        (Some(height), None) => Ok(Curve::Gardner {
            alpha: 1.0 / **height,
        }),
        (None, Some(own)) => {
            if *own.n <= 1.0 {
                problems
                    .error(own.n.place, "n of van Genuchten's curve has to be above 1")
                    .help("clay has about 1.1 to 1.4, sand 2 to 3");
                return Err(Wrong);
            }
            Ok(Curve::VanGenuchten {
                alpha: 1.0 / *own.height,
                n: *own.n,
            })
        }
        (None, None) => Ok(Curve::Ramp),
    }
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
        keys::Drainage::Undrained | keys::Drainage::Coupled => None,
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
                format!(
                    "`{first}` is for undrained and coupled soil, and this material is {words}"
                ),
            )
            .help("write drainage = \"undrained\" or \"coupled\", or remove it");
        return None;
    }
    let flows = kind == keys::Drainage::Coupled;
    if let (true, Ok(None)) = (flows, &common.permeability) {
        problems
            .error(
                common.drainage.as_ref().ok()?.as_ref()?.place,
                "water flows through coupled soil, and it has no permeability",
            )
            .help("add permeability = \"1e-9 m/s\"; clay 1e-9, silt 1e-7, sand 1e-4");
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
    if strength.is_some() {
        frictional::never_fails(model, problems)?;
    }
    if let Some(stiffness) = pore_water {
        return Some(Drainage::Undrained {
            stiffness: **stiffness,
            flows,
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
        flows,
    })
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
