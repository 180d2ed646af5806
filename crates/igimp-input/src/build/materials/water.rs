//! Water in the pores of a material: permeability, the weight of full pores, drainage.

use igimp_assembly::{PoreStiffness, VoidLaw};
use igimp_model::{Drainage, Profile, Strength};
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::materials::{self as keys, MaterialCommon, Model};
use igimp_schema::text::{clip, number};
use igimp_schema::tree::Wrong;
use igimp_schema::tree::read::{At, Either};
use igimp_seepage::{Curve, Soil};

use super::parameters::Varied;
use super::profiles::{Extent, Property, TABLES, Terms, property};
use super::{YOUNG, frictional};

/// Terms of a permeability that varies.
const PERMEABILITY: Terms = Terms {
    printed: |value| format!("{} m/s", number(value)),
    forms: TABLES,
    ..YOUNG
};

/// A permeability as a material states it.
pub(super) struct Permeability {
    /// The greatest where it varies.
    pub(super) soil: Soil,
    pub(super) profile: Option<Profile>,
    pub(super) void_law: Option<VoidLaw>,
}

/// The permeability, if the material states one.
pub(super) fn permeability<const D: usize>(
    common: &MaterialCommon,
    extent: Extent<'_, D>,
    problems: &mut Problems,
) -> Result<Option<Permeability>, Wrong> {
    let stated = common.permeability.as_ref().map_err(|_| Wrong)?;
    let Some(stated) = stated else {
        return Ok(None);
    };
    let table = match &**stated {
        Either::First(permeability) => {
            return Ok(Some(Permeability {
                soil: Soil::isotropic(*permeability),
                profile: None,
                void_law: None,
            }));
        }
        Either::Second(table) => table,
    };
    let curve = curve(table, problems)?;
    if let (Some(index), None) = (&table.c_k, &table.void_ratio) {
        problems
            .error(
                index.place,
                "`c_k` needs the void ratio that it starts from",
            )
            .help("add void_ratio = 1.0, or what it is");
        return Err(Wrong);
    }
    let void_law = table.void_ratio.as_ref().map(|initial| VoidLaw {
        initial: **initial,
        index: table.c_k.as_ref().map(|index| **index),
    });
    let along = property(
        &table.horizontal,
        "horizontal",
        extent,
        PERMEABILITY,
        problems,
    );
    let Property {
        constant, profile, ..
    } = along.ok_or(Wrong)?;
    let across = table.vertical.as_ref().map_or(constant, |value| **value);
    if table.angle.abs() > 0.0 && (across - constant).abs() <= 1e-12 * constant {
        problems
            .warning(
                table.angle.place,
                "`angle` has no effect: this soil is as permeable across its bedding as along it",
            )
            .help("add vertical = \"1e-6 m/s\", or remove it");
    }
    let soil = Soil {
        along: constant,
        across,
        angle: *table.angle,
        curve,
        drainable: table.drainable.as_ref().map_or(0.0, |share| **share),
        // It follows from the stiffness, with the weight of the water.
        specific_storage: 0.0,
    };
    Ok(Some(Permeability {
        soil,
        profile,
        void_law,
    }))
}

/// The curve of permeability above the free surface.
fn curve(table: &keys::Permeability, problems: &mut Problems) -> Result<Curve, Wrong> {
    match (&table.gardner, &table.van_genuchten) {
        (Some(_), Some(second)) => {
            problems
                .error(second.place, "both `gardner` and `van_genuchten` are given")
                .help("keep the curve that was measured");
            Err(Wrong)
        }
        (Some(height), None) => Ok(Curve::Gardner {
            alpha: 1.0 / **height,
        }),
        (None, Some(keys)) => {
            if *keys.n <= 1.0 {
                problems
                    .error(keys.n.place, "n of van Genuchten's curve has to be above 1")
                    .help("clay has about 1.1 to 1.4, sand 2 to 3");
                return Err(Wrong);
            }
            Ok(Curve::VanGenuchten {
                alpha: 1.0 / *keys.height,
                n: *keys.n,
            })
        }
        (None, None) => Ok(Curve::Ramp),
    }
}

/// The unit weight below a water table, if the material states one.
pub(super) fn saturated(
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
    Ok(stated.as_ref().map(|weight| **weight))
}

/// Poisson's ratio of undrained soil where the file does not say.
const UNDRAINED_POISSON: f64 = 0.495;

/// Parameters that the stiffness of a skeleton follows from.
const OF_STIFFNESS: [&str; 4] = ["poisson", "shear", "kappa", "eur"];

/// The drainage of a material.
pub(super) fn drainage(
    (common, model): (&MaterialCommon, &Model),
    (stiffness, strength): (Option<[f64; 2]>, Option<Strength>),
    varied: &Varied,
    problems: &mut Problems,
) -> Option<Drainage> {
    let kind = **common.drainage.as_ref().ok()?.as_ref()?;
    let (undrained, pore_water) = (&common.undrained_poisson, &common.pore_water);
    let (undrained, pore_water) = (undrained.as_ref().ok()?, pore_water.as_ref().ok()?);
    let first = match (undrained, pore_water) {
        (Some(ratio), _) => Some(("undrained_poisson", ratio.place)),
        (None, water) => water.as_ref().map(|water| ("pore_water", water.place)),
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
        let dilates = strength.and_then(|law| law.dilation()) > Some(0.0);
        frictional::never_fails(model, dilates, problems)?;
    }
    if let Some(water) = pore_water {
        softer_than_soil(water, stiffness, problems);
    }
    if let Some(stiffness) = pore_water {
        return Some(Drainage::Undrained {
            stiffness: (**stiffness).into(),
            flows,
        });
    }
    let stiffens = |entry: &&(&str, _, _)| OF_STIFFNESS.contains(&entry.0);
    if let Some((key, place, _)) = varied.iter().find(stiffens) {
        let message = format!(
            "`{key}` of undrained and coupled soil is one number: the stiffness of its pore water follows from it"
        );
        problems.error(*place, message).help(
            "pore_water = \"5.5 GPa\", the water over the porosity, or layers with a material each",
        );
        return None;
    }
    let stiffness = stiffness_of_pores(undrained.as_ref(), model, stiffness?, problems)?;
    let stiffness = PoreStiffness {
        modulus: stiffness,
        goes_with_soil: true,
    };
    Some(Drainage::Undrained { stiffness, flows })
}

/// Warns of water that is softer than the skeleton of the given Young's modulus and Poisson's ratio: the skeleton carries what is put on
/// at once.
fn softer_than_soil(water: &At<f64>, stiffness: Option<[f64; 2]>, problems: &mut Problems) {
    let Some([young, poisson]) = stiffness else {
        return;
    };
    let bulk = young / (3.0 * (1.0 - 2.0 * poisson));
    if **water >= bulk {
        return;
    }
    let message = format!(
        "the water in the pores has {} kPa and is softer than the soil around it, whose bulk modulus is {} kPa",
        number(**water / 1e3),
        number(bulk / 1e3)
    );
    problems
        .warning(water.place, message)
        .help("pore_water is the bulk modulus of water over the porosity: \"5.5 GPa\" is 2.2 GPa over 0.4");
}

/// The stiffness of the pore water \[Pa\] that makes undrained soil as incompressible as its Poisson's ratio says, from Young's
/// modulus and Poisson's ratio of its skeleton.
fn stiffness_of_pores(
    undrained: Option<&At<f64>>,
    model: &Model,
    [young, poisson]: [f64; 2],
    problems: &mut Problems,
) -> Option<f64> {
    let stated = model.stiffness().and_then(|law| law.poisson.as_ref().ok());
    let with_water = undrained.map_or(UNDRAINED_POISSON, |ratio| **ratio);
    if with_water >= 0.5 || with_water <= poisson {
        let stated = stated.map(|at| at.place);
        problems
            .error(
                undrained.map(|at| at.place).or(stated),
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
    Some(bulk(with_water) - bulk(poisson))
}
