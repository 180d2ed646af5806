//! Materials in words.

use igimp_model::{
    Case, Material, Parameter, ParameterValue, Profile, Profiles, Strength, StressShare, Variation,
};
use igimp_results::summary::SetupTable;
use igimp_text::{on_a_line, short};

use super::{NONE, kilo, table};

pub(super) fn materials<const D: usize>(case: &Case<D>) -> SetupTable {
    let header = [
        "Material",
        "Law",
        "Unit weight [kN/m³]",
        "E [MPa]",
        "ν [−]",
        "Strength",
        "K₀ [−]",
    ];
    table(
        "Materials",
        &header,
        case.materials.iter().map(material).collect(),
    )
}

/// Most letters of a law in words.
const MOST_LETTERS: usize = 200;

/// The name of the law of a material: of the one that it was given, or of its strength.
pub fn law_name(material: &Material) -> &str {
    match &material.given {
        Some(given) => given.0.name(),
        None => material.strength.name(),
    }
}

/// A law that takes the place of that of the file, in the words by which a run knows it; none of other materials.
pub fn given_in_words(material: &Material) -> Option<String> {
    let given = material.given.as_ref()?;
    let whole = format!("{:?}", given.0);
    let whole = on_a_line(&whole);
    Some(match whole.char_indices().nth(MOST_LETTERS) {
        Some((end, _)) => format!("{}…", &whole[..end]),
        None => whole.into_owned(),
    })
}

/// The law of a material and its parameters with their units, a row each; where they vary, the greatest.
pub fn of_material(material: &Material) -> SetupTable {
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let mut rows = vec![row("Law", law_name(material).to_owned())];
    rows.extend(given_in_words(material).map(|words| row("in place of that of the file", words)));
    let poisson = || short(material.poisson);
    match &material.strength {
        // Its elasticity is among the parameters.
        Strength::ModifiedCamClay(_) => {}
        Strength::HardeningSoil(_) => rows.push(row("ν", poisson())),
        _ => {
            let young = format!("{} MPa", short(material.young / 1e6));
            rows.extend([row("E", young), row("ν", poisson())]);
        }
    }
    if material.given.is_none() {
        let constant = Profiles::default();
        let parameters = material.strength.parameters().into_iter();
        rows.extend(parameters.map(|parameter| {
            let name = parameter.label.trim_end().trim_end_matches('=').trim_end();
            row(name, value(parameter, &constant))
        }));
        let effects = material
            .softening
            .iter()
            .flat_map(|softening| softening.in_words(short));
        rows.extend(effects.map(|words| row("with strain, rate or direction", words)));
    }
    table("Material", &["Parameter", "Value"], rows)
}

/// The divisor of the values of a parameter of a law as printed, and its unit.
fn scale_of(value: ParameterValue) -> (f64, &'static str) {
    match value {
        ParameterValue::Cohesive(_) | ParameterValue::Stress(_) => (1e3, " kPa"),
        ParameterValue::Friction(_) | ParameterValue::Angle(_) => (1_f64.to_radians(), "°"),
        ParameterValue::Modulus(_) => (1e6, " MPa"),
        ParameterValue::Number(_) | ParameterValue::Note => (1.0, ""),
    }
}

/// Parameters that vary and are not printed among those of the strength.
fn beside(material: &Material) -> impl Iterator<Item = String> {
    let printed = material.strength.parameters();
    let is_beside = move |entry: &&(&str, Profile)| {
        entry.0 != "poisson" && !printed.iter().any(|other| other.key == entry.0)
    };
    let parameters = material.profiles.parameters.iter().filter(is_beside);
    parameters.map(|(key, profile)| match *key {
        "friction" => format!(
            "φ at the critical state = {}",
            in_words(profile, over(1_f64.to_radians()), "°")
        ),
        _ => format!("{key} = {}", in_words(profile, short, "")),
    })
}

/// The value of a parameter with its unit, by profile where it varies.
fn value(parameter: Parameter, profiles: &Profiles) -> String {
    let degrees = |angle: f64| short(angle.to_degrees());
    if parameter.key == "critical_ratio" && profiles.of_parameter("friction").is_some() {
        return "by φ at the critical state".to_owned();
    }
    if let Some(profile) = profiles.of_parameter(parameter.key) {
        let (scale, unit) = scale_of(parameter.value);
        return in_words(profile, over(scale), unit);
    }
    match (parameter.value, &profiles.strength, &profiles.friction) {
        (ParameterValue::Cohesive(_), Some(profile), _) => in_words(profile, over(1e3), " kPa"),
        (ParameterValue::Friction(_), _, Some(profile)) => {
            in_words(profile, |tangent| degrees(tangent.atan()), "°")
        }
        (ParameterValue::Cohesive(stress) | ParameterValue::Stress(stress), ..) => {
            kilo(stress, "Pa")
        }
        (ParameterValue::Friction(angle) | ParameterValue::Angle(angle), ..) => {
            format!("{}°", degrees(angle))
        }
        (ParameterValue::Modulus(stress), ..) => format!("{} MPa", short(1e-6 * stress)),
        (ParameterValue::Number(number), ..) => short(number),
        (ParameterValue::Note, ..) => String::new(),
    }
}

fn material(material: &Material) -> Vec<String> {
    let profiles = &material.profiles;
    let or_constant = |profile: &Option<Profile>, constant: f64, scale: f64| match profile {
        Some(profile) => in_words(profile, over(scale), ""),
        None => short(constant / scale),
    };
    let printed = |entry: Parameter| format!("{}{}", entry.label, value(entry, profiles));
    let of_file = || {
        let parameters = material.strength.parameters().into_iter();
        let effects = material.softening.iter();
        let effects = effects.flat_map(|softening| softening.in_words(short));
        let varies =
            profiles.friction.is_some() && material.softening.is_some_and(|s| s.friction.is_some());
        let varies = varies.then(|| {
            "φ in the end where it is greatest, elsewhere as much less by its tangent".to_owned()
        });
        let parameters = parameters.map(printed).chain(beside(material));
        let each = parameters.chain(effects).chain(varies);
        each.collect::<Vec<_>>().join(", ")
    };
    let poisson = profiles.of_parameter("poisson");
    vec![
        material.name.clone(),
        law_name(material).to_owned(),
        or_constant(&profiles.unit_weight, material.unit_weight, 1e3),
        or_constant(&profiles.young, material.young, 1e6),
        poisson.map_or_else(|| short(material.poisson), |nu| in_words(nu, short, "")),
        given_in_words(material).unwrap_or_else(of_file),
        material.k0.map_or_else(|| NONE.to_owned(), short),
    ]
}

/// Most rows of a profile that are listed one by one.
const MOST_ROWS: usize = 6;

/// Prints a value divided by a scale.
fn over(scale: f64) -> impl Fn(f64) -> String {
    move |value| short(value / scale)
}

/// A profile in words, its values as they are `printed` before a unit.
fn in_words(profile: &Profile, printed: impl Fn(f64) -> String, unit: &str) -> String {
    let (variation, is_by_depth) = match profile {
        Profile::Level(variation) => (variation, false),
        Profile::Depth(variation) => (variation, true),
        Profile::StressShare(share) => return share_in_words(share),
        Profile::Raster(raster) => {
            let values = raster.values.iter().flatten().copied();
            let least = values.clone().fold(f64::INFINITY, f64::min);
            let greatest = values.fold(f64::NEG_INFINITY, f64::max);
            return format!(
                "{}{unit} to {}{unit} by a raster of {} by {} points",
                printed(least),
                printed(greatest),
                raster.x.len(),
                raster.y.len()
            );
        }
    };
    let place = |level: f64| {
        if is_by_depth {
            format!("at a depth of {} m", short(0.0 - level))
        } else {
            format!("at y = {} m", short(level))
        }
    };
    match variation {
        Variation::Gradient {
            from,
            at_top,
            gradient,
        } => {
            let place = if is_by_depth {
                "at the surface".to_owned()
            } else {
                format!("down to y = {} m", short(*from))
            };
            format!(
                "{}{unit} {place}, {}{unit} per metre {} below",
                printed(*at_top),
                printed(gradient.abs()),
                if *gradient < 0.0 { "less" } else { "more" }
            )
        }
        Variation::Table(rows) if rows.len() <= MOST_ROWS => {
            let row =
                |[level, value]: &[f64; 2]| format!("{}{unit} {}", printed(*value), place(*level));
            let rows: Vec<String> = rows.iter().rev().map(row).collect();
            rows.join(", ")
        }
        Variation::Table(rows) => {
            let ([low, deepest], [high, highest]) = (rows[0], rows[rows.len() - 1]);
            format!(
                "{}{unit} {} to {}{unit} {} by a table of {} {}",
                printed(highest),
                place(high),
                printed(deepest),
                place(low),
                rows.len(),
                if is_by_depth { "depths" } else { "levels" }
            )
        }
    }
}

/// A strength that follows the stress, in words.
fn share_in_words(share: &StressShare) -> String {
    let ocr = match &share.ocr_profile {
        Some(profile) => in_words(profile, short, ""),
        None => short(share.ocr),
    };
    let consolidated = if share.ocr_profile.is_none() && share.ocr.total_cmp(&1.0).is_eq() {
        String::new()
    } else {
        format!(" OCR^{}, OCR = {ocr}", short(share.exponent))
    };
    let least = if share.at_least > 0.0 {
        format!(", at least {}", kilo(share.at_least, "Pa"))
    } else {
        String::new()
    };
    let water = share.water_level.map_or_else(String::new, |level| {
        format!(", water at rest to y = {} m", short(level))
    });
    format!("{} σ′_v0{consolidated}{least}{water}", short(share.ratio))
}
