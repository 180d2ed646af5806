//! Slopes of soil that grows stronger with depth, and an embankment on such soil.

use std::path::Path;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_model::check::Band;
use igimp_results::mesh_study::{Computed as OnMesh, Convergence};
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::coverage::{self, Known};
use crate::harness::study::{Level, RunRecord, Study};
use crate::limit_equilibrium::section::{self, Layer, Search, Section, Variant, YOUNG};
use crate::runs::Computed;
use crate::slopes::Found;

/// The book's description of the study.
const ABOUT: &str = "Undrained slopes whose strength grows with depth from nothing or from c_0 at the crest, and an embankment with friction on clay whose strength grows with depth: factors of safety of the given geometry with shared strain on two meshes, extrapolated. Circles bound the slopes from above, half a percent to two above the truth; limit analysis bounds the embankment on both sides.";
const CIRCLES: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "least upper bound of circles for s_u = c_0 + k z; Gibson and Morgenstern 1962 for c_0 = 0",
    locator: "N = γF/k = 4.106 and 5.898; γHF/c_0 by slope and kH/c_0; truth 0.5 to 2 % below",
};
const EMBANKMENT: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "finite-element limit analysis, ψ = φ; Duncan and Wright 2005",
    locator: "their fig. 15.9: lower and upper bound by the gradient of the strength",
};
/// Where the truth lies below the circles, as shares of them.
const BELOW_CIRCLES: [f64; 2] = [0.98, 0.995];
/// How far an extrapolated factor may lie beyond the known one \[-\].
const BEYOND: f64 = 0.02;
/// ν of undrained soil \[-\]: with much less, ground at rest whose strength begins at nothing yields everywhere.
const POISSON: f64 = 0.45;
/// γ of the slopes times their height \[kPa\].
const GAMMA_H: f64 = 200.0;
/// A foot \[m\].
const FOOT: f64 = 0.3048;
/// A pound per square foot \[kPa\].
const PSF: f64 = 0.047_880_26;
/// A pound per cubic foot \[kN/m³\].
const PCF: f64 = 0.157_087_5;

/// A slope and how it is computed.
struct Slope {
    section: Section,
    /// Overrides that let the strength vary, for cells of a size \[m\].
    strength: Box<dyn Fn(f64) -> Vec<String> + Send + Sync>,
    oracle: Oracle,
    /// Least and greatest value of the factor of safety \[-\].
    known: [f64; 2],
    /// Cells over the height.
    cells: [u32; 2],
    level: Level,
}

/// The slopes of clay: one down for `run` across, kH/c_0 (none: c_0 = 0), the value of the circles and a strength
/// in kPa, c_0 or kH, that makes the factor one to two.
fn clays() -> Vec<Slope> {
    let rows = [
        (1.0, Some(1.0), 10.157, 30.0, Level::Quick),
        (1.0, None, 4.106, 100.0, Level::Default),
        (2.0, Some(5.0), 36.696, 10.0, Level::Full),
        (2.0, None, 5.898, 70.0, Level::Full),
        (1.0, Some(2.0), 14.336, 20.0, Level::Full),
        (1.0, Some(5.0), 26.738, 10.0, Level::Full),
        (2.0, Some(1.0), 12.834, 20.0, Level::Full),
        (2.0, Some(2.0), 18.863, 20.0, Level::Full),
    ];
    let slope = |(run, growth, circles, strength, level): (f64, Option<f64>, f64, f64, Level)| {
        let depth_factor = if growth.is_some() { 1.5 } else { 1.0 };
        let (angle, top) = (f64::atan2(1.0, run).to_degrees(), 10.0 * depth_factor);
        let name = match growth {
            Some(growth) => format!("slope of {angle:.0}°, kH/c_0 = {growth}"),
            None => format!("slope of {angle:.0}°, c_0 = 0"),
        };
        let margins = [15.0, if growth.is_some() { 15.0 } else { 0.0 }];
        let circles = circles * strength / GAMMA_H;
        let cu = move |cell: f64| match growth {
            Some(growth) => format!(
                "{{ at_top = \"{strength} kPa\", gradient = \"{} kPa/m\" }}",
                growth * strength / 10.0
            ),
            // Without the strength of their lower edge the outermost cells fail by themselves.
            None => format!(
                "{{ levels = [\"{top} m\", \"{} m\", \"0 m\"], values = [\"{edge} kPa\", \"{edge} kPa\", \"{} kPa\"] }}",
                top - cell,
                0.1 * strength * top,
                edge = 0.1 * strength * cell,
            ),
        };
        Slope {
            section: Section::homogeneous(&name, (run, depth_factor), (strength, 0.0), margins),
            strength: Box::new(move |cell| {
                vec![
                    format!("materials.soil-0.cu={}", cu(cell)),
                    format!("materials.soil-0.poisson={POISSON}"),
                ]
            }),
            oracle: CIRCLES,
            known: BELOW_CIRCLES.map(|share| share * circles),
            cells: [10, 20],
            level,
        }
    };
    rows.into_iter().map(slope).collect()
}

/// Cohesion of the fill \[psf\], which has none in the source: the least with which its thin end at the toe does not
/// fail by itself on the coarse mesh.
const FILL: f64 = 20.0;

/// The embankment: gradients of the strength in psf/ft with their bounds.
fn embankments() -> Vec<Slope> {
    let rows = [
        (0.0, [0.779, 0.789]),
        (5.0, [0.928, 0.934]),
        (10.0, [1.054, 1.058]),
        (15.0, [1.147, 1.151]),
    ];
    let feet = |corners: &[[f64; 2]]| -> Vec<[f64; 2]> {
        let corners = corners.iter();
        corners.map(|corner| corner.map(|x| x * FOOT)).collect()
    };
    let embankment = |(gradient, known): (f64, [f64; 2])| Slope {
        section: Section {
            horizontal: 0.0,
            name: format!("embankment, c_z = {gradient} psf/ft"),
            height: 20.0 * FOOT,
            unit_weight: 125.0 * PCF,
            surface: feet(&[[0.0, 40.0], [50.0, 40.0], [100.0, 20.0], [140.0, 20.0]]),
            base: 0.0,
            layers: vec![
                Layer {
                    cohesion: FILL * PSF,
                    friction: 35.0,
                    polygon: feet(&[[0.0, 20.0], [100.0, 20.0], [50.0, 40.0], [0.0, 40.0]]),
                },
                Layer {
                    cohesion: 300.0 * PSF,
                    friction: 0.0,
                    polygon: feet(&[[0.0, 0.0], [140.0, 0.0], [140.0, 20.0], [0.0, 20.0]]),
                },
            ],
        },
        strength: Box::new(move |_| {
            vec![
                format!(
                    "materials.soil-1.cu={{ at_top = \"{} kPa\", gradient = \"{} kPa/m\" }}",
                    300.0 * PSF,
                    gradient * PSF / FOOT
                ),
                format!("materials.soil-1.unit_weight=\"{} kN/m3\"", 100.0 * PCF),
                format!("materials.soil-1.poisson={POISSON}"),
            ]
        }),
        oracle: EMBANKMENT,
        known,
        cells: [10, 15],
        level: Level::Full,
    };
    rows.into_iter().map(embankment).collect()
}

impl Slope {
    /// Searches for the factor of safety on one of the meshes.
    fn find(&self, cells: u32) -> Result<Found, CaseError> {
        let variant = Variant {
            cells,
            locking: Locking::SharedStrain,
            associated: true,
        };
        let [lower, upper] = self.known;
        // Slopes that hardly stand get their weight after the reduction.
        let path = if lower > 1.2 {
            section::Path::Reduce
        } else {
            section::Path::Gravity
        };
        let search = Search {
            bracket: [0.97 * lower, 1.05 * upper],
            path,
            steps: if path == section::Path::Reduce { 10 } else { 5 },
            young: YOUNG,
        };
        let strength = (self.strength)(self.section.height / f64::from(cells));
        let case = self.section.case_with(variant, search, &strength)?;
        Ok(Found::of(Computed::new(case)?))
    }
}

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("slope-profile", ABOUT, out)?;
    let slopes: Vec<Slope> = clays().into_iter().chain(embankments()).collect();
    let slopes: Vec<Slope> = slopes
        .into_iter()
        .filter(|slope| slope.level <= level)
        .collect();
    let meshes: Vec<(&Slope, u32)> = slopes
        .iter()
        .flat_map(|slope| slope.cells.map(|cells| (slope, cells)))
        .collect();
    let found = meshes
        .par_iter()
        .map(|(slope, cells)| slope.find(*cells))
        .collect::<Result<Vec<_>, _>>()?;
    let mut table = Table::new(
        "factors_of_safety",
        &[
            "slope",
            "known_from_[-]",
            "known_to_[-]",
            "coarse_[-]",
            "fine_[-]",
            "extrapolated_[-]",
            "uncertainty_[-]",
        ],
    );
    for (number, (slope, pair)) in std::iter::zip(&slopes, found.chunks(2)).enumerate() {
        let values = [0, 1].map(|mesh| OnMesh {
            h: f64::from(slope.cells[mesh]).recip(),
            value: pair[mesh].factor(),
            half_width: pair[mesh].half_width(),
        });
        let known = Known {
            convergence: Convergence::VARIED_SOIL,
            truth: slope.known,
        };
        let estimate = study.extrapolate(slope.section.name.clone(), known, &values);
        let value = coverage::value(estimate);
        let both = [0, 1].map(|mesh| pair[mesh].run(String::new()));
        let label = format!(
            "{}, H/h = {} and {}",
            slope.section.name, slope.cells[0], slope.cells[1]
        );
        let run = study.run(RunRecord::sum(label, &[&both[0], &both[1]]));
        let [lower, upper] = slope.known;
        study.check(
            run,
            "factor of safety, extrapolated from two meshes [-]",
            slope.oracle.says(0.5 * (lower + upper)),
            Band::Between((1.0 - BEYOND) * lower, (1.0 + BEYOND) * upper),
            value,
        );
        study.notes.push(format!(
            "{}: known {lower:.3} to {upper:.3}; {:.4}, {:.4}; extrapolated {value:.4}",
            slope.section.name, values[0].value, values[1].value,
        ));
        table.push(vec![
            number as f64 + 1.0,
            lower,
            upper,
            values[0].value,
            values[1].value,
            value,
            estimate.map_or(f64::NAN, |estimate| estimate.uncertainty),
        ]);
    }
    table.write_csv(&study.folder)?;
    Ok(study)
}
