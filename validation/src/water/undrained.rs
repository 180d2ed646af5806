//! Soil that cannot drain: its undrained strength from effective parameters, in a specimen and in a slope.

use igimp_cases::CaseError;
use igimp_input::CaseFile;
use igimp_model::check::Band;
use igimp_model::{Case, Drainage};

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};
use crate::runs::Computed;

const STRENGTH: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "undrained strength of Mohr\u{2013}Coulomb soil in plane strain, ψ = 0",
    locator: "s_u = c′ cos φ′ + s′ sin φ′, s′ the mean of σ′_v and σ′_h at failure, that at rest and the share of the rise that water does not take",
};
const SAME: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "soil that keeps its volume under one mean effective stress",
    locator: "the limit load is that of Tresca soil of s_u = c′ cos φ′ + p′ sin φ′",
};
const NEVER: Oracle = Oracle {
    kind: OracleKind::Theory,
    source: "soil that dilates and cannot take in water",
    locator: "ψ > 0: suction grows with shear, and nothing limits the load",
};

/// c′ \[kPa\], φ′ \[degree\].
const COHESION: f64 = 10.0;
const FRICTION: f64 = 25.0;
const POISSON: f64 = 0.3;
/// Of the slope, so that pressure on its surface is its mean stress between supports too: K₀ = 0.99.
const CONFINED: f64 = 0.498;
/// Young's modulus \[kPa\].
const YOUNG: f64 = 1e5;

/// K_w/n for an undrained Poisson's ratio \[kPa\].
fn stiffness(poisson: f64, undrained: f64) -> f64 {
    let shear = YOUNG / (2.0 * (1.0 + poisson));
    let bulk = |nu: f64| 2.0 * shear * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu));
    bulk(undrained) - bulk(poisson)
}

/// Checks of undrained strength.
pub(super) fn report(study: &mut Study, level: Level) -> Result<(), CaseError> {
    specimen(study)?;
    if level >= Level::Default {
        slope(study)?;
    }
    Ok(())
}

/// A material in effective stress that cannot drain.
fn soil(poisson: f64, dilation: f64) -> String {
    format!(
        "model = \"mohr-coulomb\"
         unit_weight = \"20 kN/m3\"
         young = \"{YOUNG} kPa\"
         poisson = {poisson}
         cohesion = \"{COHESION} kPa\"
         friction = \"{FRICTION} deg\"
         dilation = \"{dilation} deg\""
    )
}

/// The case of a specimen between two plates, by the drained pressures on it \[kPa\].
fn specimen_file(vertical: f64, horizontal: f64) -> String {
    format!(
            "igimp = 1
             [case]
             title = \"specimen\"
             analysis = \"plane-strain\"
             gravity = \"9.81 m/s2\"
             [grid]
             cell = \"0.25 m\"
             domain = {{ x = [\"0 m\", \"1.25 m\"], y = [\"0 m\", \"1.25 m\"] }}
             [boundaries]
             left = \"roller\"
             bottom = \"roller\"
             [solver]
             tolerance = 1e-11
             [materials.clay]
             {}
             [[bodies]]
             name = \"clay\"
             material = \"clay\"
             points_per_cell = 4
             polygon = [[\"0 m\", \"0 m\"], [\"1 m\", \"0 m\"], [\"1 m\", \"1 m\"], [\"0 m\", \"1 m\"]]
             [[loads]]
             name = \"top\"
             type = \"pressure\"
             from = [\"0 m\", \"1 m\"]
             to = [\"1 m\", \"1 m\"]
             pressure = \"{vertical} kPa\"
             [[loads]]
             name = \"side\"
             type = \"pressure\"
             from = [\"1 m\", \"0 m\"]
             to = [\"1 m\", \"1 m\"]
             pressure = \"{horizontal} kPa\"
             [[loads]]
             name = \"plate\"
             type = \"rigid-footing\"
             from = [\"0 m\", \"1 m\"]
             to = [\"1 m\", \"1 m\"]
             interface = \"smooth\"
             [[stages]]
             name = \"confine\"
             type = \"load\"
             loads = [\"top\", \"side\"]
             steps = 2
             geometry = \"given\"
             [[stages]]
             name = \"press\"
             type = \"displacement\"
             load = \"plate\"
             settlement = \"2 mm\"
             steps = 10
             geometry = \"given\"
            ",
            soil(POISSON, 0.0)
        )
}

/// A specimen under two drained pressures that is pressed together undrained.
fn specimen(study: &mut Study) -> Result<(), CaseError> {
    let [vertical, horizontal] = [100.0, 60.0];
    for undrained in [0.49, 0.495, 0.4999] {
        let text = specimen_file(vertical, horizontal);
        let mut case = CaseFile::parse("specimen", &text, &[])?.into_case();
        let stiff = stiffness(POISSON, undrained);
        case.materials[0].drainage = Drainage::Undrained {
            stiffness: (1e3 * stiff).into(),
            flows: false,
        };
        case.stages[0].drained = true;
        let computed = Computed::new(case)?;
        let name = format!("specimen, ν_u = {undrained}");
        let run = study.run_to_end(RunRecord::new(name, &computed.report, computed.elapsed));
        let (sin, cos) = FRICTION.to_radians().sin_cos();
        let shear = YOUNG / (2.0 * (1.0 + POISSON));
        // In the plane: K′ + G/3.
        let bulk = shear / (1.0 - 2.0 * POISSON);
        let kept = bulk / (bulk + stiff);
        let [mean, shear] = [vertical + horizontal, vertical - horizontal].map(|sum| 0.5 * sum);
        let rise = (COHESION * cos + mean * sin - shear) / (1.0 - kept * sin);
        let stages = &computed.run.summary.stages;
        let pressed = stages.last().and_then(|stage| stage.peak_resistance);
        let strength = shear + 0.5e-3 * pressed.unwrap_or(f64::NAN);
        let quantity = "undrained strength [kPa]";
        let exact = STRENGTH.says(shear + rise);
        study.check(run, quantity, exact, Band::Relative(1e-6), strength);
    }
    Ok(())
}

/// The case of a slope of a material, under a pressure on its surface \[kPa\].
fn slope_file(material: &str, pressure: f64) -> String {
    format!(
            "igimp = 1
             [case]
             title = \"undrained slope\"
             analysis = \"plane-strain\"
             gravity = \"9.81 m/s2\"
             [grid]
             cell = \"0.5 m\"
             domain = {{ x = [\"0 m\", \"32 m\"], y = [\"0 m\", \"11 m\"] }}
             locking = \"shared-strain\"
             [boundaries]
             left = \"roller\"
             right = \"roller\"
             bottom = \"fixed\"
             [solver]
             tolerance = 1e-7
             [materials.clay]
             {material}
             [[bodies]]
             name = \"clay\"
             material = \"clay\"
             points_per_cell = 4
             polygon = [[\"0 m\", \"0 m\"], [\"32 m\", \"0 m\"], [\"12 m\", \"10 m\"], [\"0 m\", \"10 m\"]]
             [[loads]]
             name = \"crest\"
             type = \"pressure\"
             from = [\"0 m\", \"10 m\"]
             to = [\"12 m\", \"10 m\"]
             pressure = \"{pressure} kPa\"
             [[loads]]
             name = \"face\"
             type = \"pressure\"
             from = [\"12 m\", \"10 m\"]
             to = [\"32 m\", \"0 m\"]
             pressure = \"{pressure} kPa\"
             [[stages]]
             name = \"confine\"
             type = \"load\"
             loads = [\"crest\", \"face\"]
             steps = 2
             geometry = \"given\"
             [[stages]]
             name = \"raise gravity\"
             type = \"gravity\"
             factor = 4
             steps = 320
             geometry = \"given\"
             stop_when = {{ displacement = \"0.5 m\", no_equilibrium = true }}
            "
        )
}

/// A weightless slope under one pressure on its surface, drained, in which gravity is raised undrained until the slope
/// flows: half a metre, which elastic soil does not come near.
fn slope(study: &mut Study) -> Result<(), CaseError> {
    let pressure = 100.0;
    let (sin, cos) = FRICTION.to_radians().sin_cos();
    let strength = COHESION * cos + pressure * sin;
    let case = |material: &str| -> Result<Case<2>, CaseError> {
        let text = slope_file(material, pressure);
        Ok(CaseFile::parse("undrained slope", &text, &[])?.into_case())
    };
    let undrained = |dilation: f64| -> Result<Computed<2>, CaseError> {
        let mut case = case(&soil(CONFINED, dilation))?;
        case.materials[0].drainage = Drainage::Undrained {
            stiffness: (1e3 * stiffness(CONFINED, 0.499_999)).into(),
            flows: false,
        };
        case.stages[0].drained = true;
        Computed::new(case)
    };
    let tresca = Computed::new(case(&format!(
        "model = \"tresca\"
         unit_weight = \"20 kN/m3\"
         young = \"{YOUNG} kPa\"
         poisson = 0.495
         cu = \"{strength} kPa\""
    ))?)?;
    let limit = |computed: &Computed<2>| {
        let stages = &computed.run.summary.stages;
        4.0 * stages.last().map_or(f64::NAN, |stage| stage.reached)
    };
    let plain = undrained(0.0)?;
    let run = study.run(RunRecord::new(
        "undrained slope, ψ = 0",
        &plain.report,
        plain.elapsed,
    ));
    let quantity = "limit of gravity over that of Tresca soil [-]";
    let ratio = limit(&plain) / limit(&tresca);
    study.check(run, quantity, SAME.says(1.0), Band::Relative(0.01), ratio);
    let dilates = undrained(FRICTION)?;
    let run = study.run(RunRecord::new(
        "undrained slope, ψ = φ",
        &dilates.report,
        dilates.elapsed,
    ));
    let quantity = "gravity that is borne over the limit of Tresca soil [-]";
    let expected = NEVER.says(f64::INFINITY);
    let ratio = limit(&dilates) / limit(&tresca);
    study.control(run, quantity, expected, Band::AtLeast(1.5), ratio);
    Ok(())
}
