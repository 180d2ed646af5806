//! Materials and the limits of their parameters.

mod plausible;
pub(crate) mod profiles;

use std::sync::Arc;

use igimp_model::{BodyPart, Drainage, Flow, Ground, Layer, Material, Profile, Profiles, Strength};
use igimp_schema::diagnostic::Problems;
use igimp_schema::text::{clip, number};
use igimp_schema::tree::{Entry, Node, Wrong};

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
    let entries = tree.get("materials").map_or(&[][..], Node::entries);
    let outlines = bodies.iter().flatten();
    let layer = |body: &BodyPart<D>, unit_weight, profile| Layer {
        region: Arc::clone(&body.region),
        unit_weight,
        profile,
        added: 0.0,
    };
    let surface = Ground::of_layers(outlines.map(|body| layer(body, 0.0, None)));
    let weights: Vec<Option<Property>> = entries
        .iter()
        .enumerate()
        .map(|(material, entry)| {
            let extent = Extent {
                name: &entry.key,
                material,
                bodies,
                ground: &surface,
            };
            property(&entry.node, "unit_weight", extent, UNIT_WEIGHT, problems)
        })
        .collect();
    let with_weights = bodies.iter().flatten().filter_map(|body| {
        let weight = weights.get(body.material)?.as_ref()?;
        Some(layer(body, weight.constant, weight.profile.clone()))
    });
    let ground = Ground::of_layers(with_weights);
    std::iter::zip(entries, &weights)
        .enumerate()
        .map(|(index, (entry, weight))| {
            let extent = Extent {
                name: &entry.key,
                material: index,
                bodies,
                ground: &ground,
            };
            material(entry, weight.as_ref(), extent, problems)
        })
        .collect()
}

fn material<const D: usize>(
    entry: &Entry,
    unit_weight: Option<&Property>,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) -> Option<Material> {
    let (name, node) = (&entry.key, &entry.node);
    let before = problems.errors();
    let poisson = node.number_at("poisson");
    if let Some(poisson) = poisson {
        let place = node.place_at("poisson");
        if poisson >= 0.5 {
            problems
                .error(place, "Poisson's ratio must be below 0.5")
                .help("nearly incompressible, as undrained soil is: poisson = 0.49");
        } else if poisson > 0.499 {
            problems
                .warning(place, "Poisson's ratio is very close to 0.5")
                .help("the tangent is badly conditioned; 0.49 to 0.495 is close enough");
        }
    }
    let mut given = |key, terms| property(node, key, extent, terms, problems);
    let young = given("young", YOUNG);
    let cohesive = match node.text_at("model") {
        Some("von-mises" | "tresca") => given("cu", UNDRAINED),
        Some("mohr-coulomb") => given("cohesion", STRENGTH),
        _ => None,
    };
    let is_frictional = node.text_at("model") == Some("mohr-coulomb");
    let friction = if is_frictional {
        friction(node, extent, problems)
    } else {
        None
    };
    let undrained = cohesive.as_ref().map(|own| own.constant);
    let strength = match node.text_at("model") {
        Some("elastic") => Some(Strength::Elastic),
        Some("von-mises") => {
            undrained.map(|undrained_strength| Strength::VonMises { undrained_strength })
        }
        Some("tresca") => {
            undrained.map(|undrained_strength| Strength::Tresca { undrained_strength })
        }
        Some("mohr-coulomb") => {
            mohr_coulomb(name, node, [cohesive.as_ref(), friction.as_ref()], problems)
        }
        _ => None,
    };
    let profile = |own: Option<&Property>| -> Option<Profile> { own?.profile.clone() };
    let k0 = k0(
        node,
        strength,
        profile(friction.as_ref()).is_some(),
        problems,
    );
    if problems.errors() == before {
        plausible::check(name, node, problems);
    }
    let saturated = saturated(name, node, unit_weight, problems);
    let young_constant = young.as_ref().map(|own| own.constant);
    let drainage = drainage(node, young_constant, strength, problems);
    let material = Material {
        saturated: saturated.ok()?,
        drainage: drainage?,
        given: None,
        name: name.clone(),
        unit_weight: unit_weight?.constant,
        young: young.as_ref()?.constant,
        poisson: poisson?,
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
        problems.error(node.place, message);
    }
    Some(material)
}

/// tan φ, where the angle is one.
fn friction<const D: usize>(
    node: &Node,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) -> Option<Property> {
    let value = node.get("friction")?;
    let angles = std::iter::once(value).chain(value.items_at("values"));
    for angle in angles {
        if angle
            .number()
            .is_some_and(|angle| angle.to_degrees() > 89.999_999)
        {
            problems
                .error(angle.place, "the friction angle must be below 90 deg")
                .help("soils have 15 deg to 45 deg");
            return None;
        }
    }
    property(node, "friction", extent, FRICTION, problems)
}

/// The unit weight below a water table, if the material states one.
fn saturated(
    name: &str,
    node: &Node,
    unit_weight: Option<&Property>,
    problems: &mut Problems,
) -> Result<Option<f64>, Wrong> {
    let saturated = node.optional_number("saturated_unit_weight")?;
    if let (Some(saturated), Some(above)) = (saturated, unit_weight)
        && saturated < above.constant
    {
        problems
            .error(
                node.place_at("saturated_unit_weight"),
                format!(
                    "`{}` would be lighter with full pores, {} kN/m3, than above the water, {} kN/m3",
                    clip(name, 40),
                    number(saturated / 1e3),
                    number(above.constant / 1e3)
                ),
            )
            .help("it is the weight of soil and water together, not that under buoyancy");
        return Err(Wrong);
    }
    Ok(saturated)
}

/// Poisson's ratio of undrained soil where the file does not say.
const UNDRAINED_POISSON: f64 = 0.495;

/// What a material does with water.
fn drainage(
    node: &Node,
    young: Option<f64>,
    strength: Option<Strength>,
    problems: &mut Problems,
) -> Option<Drainage> {
    let kind = node.text_at("drainage")?;
    let stated = ["undrained_poisson", "pore_water"];
    let stated = stated.into_iter().filter(|key| node.get(key).is_some());
    let stated: Vec<&str> = stated.collect();
    if let (true, Some(first)) = (kind != "undrained", stated.first()) {
        problems
            .error(
                node.place_at(first),
                format!(
                    "`{first}` is for undrained soil, and this material is {}",
                    match kind {
                        "total" => "one of total stress",
                        _ => "drained",
                    }
                ),
            )
            .help("write drainage = \"undrained\", or remove it");
        return None;
    }
    match kind {
        "total" => return Some(Drainage::Total),
        "undrained" => {}
        _ => return Some(Drainage::Drained),
    }
    if let [_, second] = stated.as_slice() {
        problems
            .error(
                node.place_at(second),
                "both `undrained_poisson` and `pore_water` are given",
            )
            .help("keep one of them");
        return None;
    }
    if let Some(Strength::MohrCoulomb {
        flow: Flow::Davis, ..
    }) = strength
    {
        problems
            .error(
                node.place_at("flow"),
                "flow = \"davis\" dilates as associated flow does, and undrained soil that dilates never fails",
            )
            .help("leave `flow` out, or model = \"tresca\" with the undrained strength");
        return None;
    }
    if let Some(Strength::MohrCoulomb { dilation_angle, .. }) = strength
        && dilation_angle > 0.0
    {
        problems
            .warning(
                node.place_at("dilation"),
                "undrained soil that dilates never fails: suction grows without limit",
            )
            .help("dilation = \"0 deg\" for undrained soil");
    }
    if let Some(stiffness) = node.optional_number("pore_water").ok()? {
        return Some(Drainage::Undrained { stiffness });
    }
    let undrained = node.optional_number("undrained_poisson").ok()?;
    let (young, poisson) = (young?, node.number_at("poisson")?);
    let with_water = undrained.unwrap_or(UNDRAINED_POISSON);
    if with_water >= 0.5 || with_water <= poisson {
        let place = match undrained {
            Some(_) => node.place_at("undrained_poisson"),
            None => node.place_at("poisson"),
        };
        problems
            .error(
                place,
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

fn mohr_coulomb(
    name: &str,
    node: &Node,
    [cohesive, friction]: [Option<&Property>; 2],
    problems: &mut Problems,
) -> Option<Strength> {
    let cohesion = cohesive.map(|own| own.constant);
    let friction_varies = friction.is_some_and(|own| own.profile.is_some());
    // An angle that is stated is kept to the last bit.
    let friction = friction.and_then(|own| match own.profile {
        None => node.number_at("friction"),
        Some(_) => Some(own.constant.atan()),
    });
    let dilation = node.number_at("dilation");
    if let (Some(friction), Some(dilation)) = (friction, dilation)
        && dilation > friction * (1.0 + if friction_varies { 1e-12 } else { 0.0 })
    {
        problems
            .error(
                node.place_at("dilation"),
                "dilation angle is larger than the friction angle",
            )
            .help("dilation <= friction");
    }
    if let (Some(cohesion), Some(friction)) = (cohesion, friction)
        && cohesion == 0.0
    {
        if vanishes(node) {
            problems
                .error(
                    node.place_at("friction"),
                    format!(
                        "`{}` has no strength where friction is zero",
                        clip(name, 40)
                    ),
                )
                .help("a small cohesion, like cohesion = \"0.1 kPa\"");
            return None;
        }
        let (place, name) = (node.place_at("cohesion"), clip(name, 40));
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
    }
    let tension_cutoff = node.optional_number("tension_cutoff").ok()?;
    let cohesion_varies = cohesive.is_some_and(|own| own.profile.is_some());
    if cohesion_varies && tension_cutoff.is_some_and(|limit| limit > 0.0) {
        problems
            .error(
                node.place_at("tension_cutoff"),
                "a constant tension cut-off does not go with a cohesion that varies",
            )
            .help("tension_cutoff = \"0 kPa\", or leave it out: cohesion / tan(friction) limits tension");
        return None;
    }
    if let (Some(cohesion), Some(friction), Some(cutoff)) = (cohesion, friction, tension_cutoff) {
        let apex = cohesion / friction.tan();
        if friction > 0.0 && cutoff > apex * (1.0 + 1e-12) {
            problems
                .warning(
                    node.place_at("tension_cutoff"),
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
        dilation_angle: dilation?.min(friction?),
        flow: flow(node)?,
        tension_cutoff,
    })
}

/// How plastic flow follows from ψ.
fn flow(node: &Node) -> Option<Flow> {
    Some(match node.text_at("flow")? {
        "davis" => Flow::Davis,
        _ => Flow::Dilation,
    })
}

/// Whether a table of friction has a zero.
fn vanishes(node: &Node) -> bool {
    let table = node
        .get("friction")
        .map_or(&[][..], |own| own.items_at("values"));
    table.iter().any(|angle| angle.number() == Some(0.0))
}

/// K₀ of a material, if it states one.
fn k0(
    node: &Node,
    strength: Option<Strength>,
    friction_varies: bool,
    problems: &mut Problems,
) -> Result<Option<f64>, Wrong> {
    let is_jaky = node.text_at("k0").is_some();
    match strength {
        _ if !is_jaky => node.optional_number("k0"),
        Some(Strength::MohrCoulomb { .. }) if friction_varies => {
            problems
                .error(
                    node.place_at("k0"),
                    "k0 = \"jaky\" needs one friction angle, and friction varies here",
                )
                .help("write a number, like k0 = 0.5");
            Err(Wrong)
        }
        Some(Strength::MohrCoulomb { friction_angle, .. }) => Ok(Some(1.0 - friction_angle.sin())),
        None => Err(Wrong),
        Some(_) => {
            problems
                .error(node.place_at("k0"), "k0 = \"jaky\" needs a friction angle")
                .help("write a number, like k0 = 0.5");
            Err(Wrong)
        }
    }
}
