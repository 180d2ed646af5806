//! Materials and the limits of their parameters.

mod cam_clay;
mod checks;
mod frictional;
mod hardening_soil;
mod hoek_brown;
mod parameters;
mod plausible;
pub(crate) mod profiles;
mod softening;
mod unused;
mod water;

use std::sync::Arc;

use igimp_model::{BodyPart, Ground, Layer, Material, Profile, Profiles, Strength, jaky};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::Root;
use igimp_schema::schema::materials::{self as keys, MaterialCommon, Model};
use igimp_schema::text::{clip, number};
use igimp_schema::tree::read::{At, Either, Named};
use igimp_schema::tree::{Node, Wrong};

use parameters::{Limit, NUMBER_OR_NONE, Parameters, Varied};
use profiles::{Extent, FORMS_OF_ALL, Property, Terms, property};
use water::{drainage, permeability, saturated};

pub(super) use checks::{check_lengths, check_on_cells, check_rates};
pub(super) use unused::check_unused;

/// Terms of a strength, of Young's modulus and of a unit weight that vary.
const STRENGTH: Terms = Terms {
    may_vanish: true,
    may_be_nothing: false,
    kept: |value| value,
    printed: |value| format!("{} kPa", number(value / 1e3)),
    forms: FORMS_OF_ALL,
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
    let stated = Root::<D>::materials(tree).map_or_else(|Wrong| Vec::new(), |list| list.value.0);
    let outlines = bodies.iter().flatten();
    let layer = |body: &BodyPart<D>, unit_weight, profile| Layer {
        region: Arc::clone(&body.region),
        unit_weight,
        profile,
        saturated: None,
    };
    let surface = Ground::of_layers(outlines.map(|body| layer(body, 0.0, None)));
    let weights: Vec<Option<Property>> = (stated.iter().enumerate())
        .map(|(material, entry)| {
            let extent = Extent {
                name: &entry.name,
                material,
                bodies,
                ground: &surface,
            };
            let common = entry.value.as_ref().ok()?.common.as_ref().ok()?;
            let weight = common.unit_weight.as_ref().ok()?;
            property(weight, "unit_weight", extent, UNIT_WEIGHT, problems)
        })
        .collect();
    let with_weights = bodies.iter().flatten().filter_map(|body| {
        let weight = weights.get(body.material)?.as_ref()?;
        Some(layer(body, weight.constant, weight.profile.clone()))
    });
    let ground = Ground::of_layers(with_weights);
    let of_water = Root::<D>::case(tree).map(|case| *case.water_unit_weight);
    let ground = match of_water {
        Ok(unit_weight) => ground.with_water_of(unit_weight),
        Err(Wrong) => ground,
    };
    std::iter::zip(&stated, &weights)
        .enumerate()
        .map(|(index, (entry, weight))| {
            let extent = Extent {
                name: &entry.name,
                material: index,
                bodies,
                ground: &ground,
            };
            material(entry, weight.as_ref(), extent, problems)
        })
        .collect()
}

fn material<const D: usize>(
    stated: &Named<keys::Material>,
    unit_weight: Option<&Property>,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) -> Option<Material> {
    let (name, table) = (&stated.name, stated.value.as_ref().ok()?);
    let common = table.common.as_ref().ok()?;
    let before = problems.errors();
    let linear = table.form.stiffness();
    let young = linear.and_then(|linear| linear.young.as_ref().ok());
    let young = young.and_then(|value| property(value, "young", extent, YOUNG, problems));
    let Resistance {
        poisson,
        strength,
        cohesive,
        friction,
        varied,
    } = resistance(&table.form, extent, problems);
    let profile = |value: Option<&Property>| -> Option<Profile> { value?.profile.clone() };
    let friction_varies = friction.as_ref().is_some_and(|phi| phi.profile.is_some())
        || (varied.iter()).any(|entry| ["friction", "critical_ratio"].contains(&entry.0));
    let k0 = k0(common, strength, friction_varies, problems);
    if problems.errors() == before {
        if let (Some(stated), Some(young), Some(strength)) = (linear, &young, &cohesive) {
            let key = table.form.undrained().map_or("cohesion", |_| "cu");
            let place = stated.young.as_ref().ok().map(|value| value.place);
            plausible::check_stiffness(name, (young, place), (key, strength), problems);
        }
        let varies = cohesive.as_ref().is_some_and(|c| c.profile.is_some()) || friction_varies;
        if let (Some(strength), Some(weight), false) = (strength, unit_weight, varies) {
            check_at_rest(common, strength, weight, extent, problems);
        }
    }
    let saturated = saturated(name, common, unit_weight, problems);
    let stiffness = match (linear, strength) {
        (Some(_), _) => (young.as_ref()).and_then(|young| Some([young.constant, poisson?])),
        (None, strength) => strength.and_then(|law| law.stiffness()),
    };
    let softening = softening::curves(name, &table.form, strength, problems);
    let of_soil = (stiffness, strength);
    let drainage = drainage((common, &table.form), of_soil, &varied, problems);
    let permeable = permeability(common, extent, problems).ok()?;
    let material = Material {
        saturated: saturated.ok()?,
        drainage: drainage?,
        permeability: permeable.as_ref().map(|flow| flow.soil),
        void_law: permeable.as_ref().and_then(|flow| flow.void_law),
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
            permeability: permeable.and_then(|flow| flow.profile),
            parameters: varied.into_iter().map(|entry| (entry.0, entry.2)).collect(),
        },
    };
    if problems.errors() == before
        && let Err(why) = material.possible(0.0)
    {
        let message = format!("the material `{}` is not possible{why}", clip(name, 40));
        problems.error(stated.place, message);
    }
    Some(material)
}

/// Poisson's ratios that linear elasticity may have.
const POISSON: Limit = (
    |value| value < 0.5,
    "Poisson's ratio must be below 0.5",
    "nearly incompressible, as undrained soil is: poisson = 0.49",
);

/// The strength of a material and its Poisson's ratio, the properties that it comes from, and the parameters that vary beside them.
struct Resistance {
    poisson: Option<f64>,
    strength: Option<Strength>,
    cohesive: Option<Property>,
    friction: Option<Property>,
    varied: Varied,
}

fn resistance<const D: usize>(
    model: &Model,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) -> Resistance {
    let cu = model.undrained().and_then(|table| table.cu.as_ref().ok());
    let cu = cu.and_then(|value| property(value, "cu", extent, UNDRAINED, problems));
    let [cohesive, friction] = match model.frictional() {
        Some(table) => frictional::properties(table, extent, problems),
        None => [cu, None],
    };
    let both = [cohesive.as_ref(), friction.as_ref()];
    let cu = both[0].map(|value| value.constant);
    let mut read = Parameters {
        extent,
        problems,
        varied: Varied::new(),
    };
    let poisson = model.stiffness().and_then(|law| law.poisson.as_ref().ok());
    let poisson = poisson.and_then(|value| {
        let parameter = read.read("poisson", value, NUMBER_OR_NONE, Some(POISSON))?;
        if parameter.most > 0.499 && parameter.most < 0.5 {
            (read.problems)
                .warning(parameter.place, "Poisson's ratio is very close to 0.5")
                .help("the tangent is badly conditioned; 0.49 to 0.495 is close enough");
        }
        Some(parameter.most)
    });
    let strength = match model {
        Model::Elastic(_) => Some(Strength::Elastic),
        Model::VonMises(_) => {
            cu.map(|undrained_strength| Strength::VonMises { undrained_strength })
        }
        Model::Tresca(_) => cu.map(|undrained_strength| Strength::Tresca { undrained_strength }),
        Model::CamClay(Ok(table)) => cam_clay::strength(table, &mut read),
        Model::HardeningSoil(Ok(table)) => hardening_soil::strength(table, &mut read),
        Model::HoekBrown(Ok(table)) => hoek_brown::strength(table, &mut read),
        Model::MohrCoulomb(Ok(table)) => frictional::mohr_coulomb(table, both, &mut read),
        Model::DruckerPrager(Ok(table)) => frictional::drucker_prager(table, both, &mut read),
        _ => None,
    };
    Resistance {
        poisson,
        strength,
        varied: read.varied,
        cohesive,
        friction,
    }
}

/// Warns of a K₀ that the strength of the bodies of a material does not allow.
fn check_at_rest<const D: usize>(
    common: &MaterialCommon,
    strength: Strength,
    weight: &Property,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) {
    let stated = common.k0.as_ref().ok().and_then(Option::as_ref);
    let Some(k0) = stated.and_then(At::first) else {
        return;
    };
    let height = |body: &BodyPart<D>| {
        let (lower, upper) = body.region.bounds();
        upper[D - 1] - lower[D - 1]
    };
    let bodies = extent.bodies.iter().flatten();
    let bodies = bodies.filter(|body| body.material == extent.material);
    let highest = bodies.map(height).fold(0.0, f64::max);
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
        (Either::Second(_), Some(_)) if friction_varies => {
            "k0 = \"jaky\" needs one friction angle, and friction varies here"
        }
        (Either::Second(_), Some(Strength::ModifiedCamClay(law))) => {
            // sin φ of M in triaxial compression.
            return Ok(Some(
                1.0 - 3.0 * law.critical_ratio / (6.0 + law.critical_ratio),
            ));
        }
        (Either::Second(_), Some(law)) => match law.friction_angle() {
            Some(friction_angle) => return Ok(Some(jaky(friction_angle))),
            None => "k0 = \"jaky\" needs a friction angle",
        },
    };
    problems
        .error(stated.place, refused)
        .help("write a number, like k0 = 0.5");
    Err(Wrong)
}
