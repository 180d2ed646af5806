//! Pseudo-static acceleration: a layer that is pushed along its base, and slopes that are pushed down.

use std::path::Path;

use igimp_assembly::Locking;
use igimp_cases::CaseError;
use igimp_input::CaseFile;
use igimp_model::check::Band;
use igimp_model::{Case, Stage, StageKind};
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use crate::harness::oracle::{Oracle, OracleKind};
use crate::harness::study::{Level, RunRecord, Study};
use crate::limit_equilibrium::rotation;
use crate::limit_equilibrium::section::{self, Search, Section, Variant, YOUNG};
use crate::runs::Computed;

/// The book's description of the study.
const ABOUT: &str = "A pseudo-static force as a share of the weight. A level layer of dry soil without cohesion is pushed along its rough base: the infinite slope, whose factor of safety is known. Slopes with k = 0.1 are held against rotating blocks, and the force on the slope of Loukidis et al. is raised until it fails. Soil dilates with ψ = φ, and the geometry is given.";
/// A block on a plane.
const INFINITE_SLOPE: Oracle = Oracle {
    kind: OracleKind::Exact,
    source: "infinite slope with pseudo-static force (Kramer 1996)",
    locator: "theory, eq. 37e: F = (1 - k_v) tan φ / k_h for c = 0 and β = 0",
};
/// A block that turns.
const ROTATION: Oracle = Oracle {
    kind: OracleKind::LimitAnalysis,
    source: "least upper bound of rotating blocks; Chang, Chen and Yao 1984",
    locator: "limit_equilibrium/rotation.rs",
};
/// The slope whose critical acceleration is published.
const LOUKIDIS: Oracle = Oracle {
    kind: OracleKind::Published,
    source: "Loukidis, Bandini and Salgado 2003, example 1, dry",
    locator: "k_c = 0.432, where Spencer's method on logarithmic spirals has F = 1.000",
};
/// By how much an upper bound of rigid blocks may lie above the bounded value \[-\].
const BLOCKS: f64 = 0.03;
/// By how much a mesh may lie above it: coarse, fine \[-\].
const ABOVE: [f64; 2] = [0.03, 0.02];
/// Where the force on the slope of Loukidis et al. is raised to, in steps.
const RAISED: (f64, usize) = (0.5, 20);

/// Runs the study.
pub(crate) fn study(level: Level, out: &Path) -> Result<Study, CaseError> {
    let mut study = Study::new("pseudo-static", ABOUT, out)?;
    layers(&mut study, level)?;
    slopes(&mut study, level)?;
    critical(&mut study, level)?;
    Ok(study)
}

/// A layer of depth 1 m between smooth ends.
struct Layer {
    /// L/d.
    length: u32,
    /// Cells over the depth.
    cells: u32,
    /// Force to the right and upwards over the weight \[-\].
    force: [f64; 2],
}

impl Layer {
    /// F of the infinite layer (theory, eq. 37e) \[-\].
    fn factor(&self) -> f64 {
        let [horizontal, vertical] = self.force;
        (1.0 - vertical) * 30_f64.to_radians().tan() / horizontal
    }

    fn case(&self) -> Result<Case<2>, CaseError> {
        let Layer {
            length,
            cells,
            force: [horizontal, vertical],
        } = self;
        let cell = 1.0 / f64::from(*cells);
        let text = format!(
            "igimp = 1
             [case]
             title = \"layer pushed along its base\"
             [grid]
             cell = \"{cell} m\"
             domain = {{ x = [\"0 m\", \"{length} m\"], y = [\"0 m\", \"{} m\"] }}
             [materials.sand]
             model = \"mohr-coulomb\"
             cohesion = \"0 kPa\"
             friction = \"30 deg\"
             dilation = \"30 deg\"
             unit_weight = \"20 kN/m3\"
             young = \"100 MPa\"
             poisson = 0.3
             [[bodies]]
             name = \"layer\"
             material = \"sand\"
             polygon = [[\"0 m\", \"0 m\"], [\"{length} m\", \"0 m\"], [\"{length} m\", \"1 m\"], [\"0 m\", \"1 m\"]]
             [solver]
             tolerance = 1e-6
             max_iterations = 20
             [[stages]]
             name = \"weight\"
             type = \"gravity\"
             steps = 2
             geometry = \"given\"
             [[stages]]
             name = \"push\"
             type = \"gravity\"
             horizontal = {horizontal}
             vertical = {vertical}
             steps = 5
             geometry = \"given\"
             [[stages]]
             name = \"factor\"
             type = \"strength-reduction\"
             bracket = [1.0, 2.0]
             tolerance = 0.005
             ",
            1.0 + cell,
        );
        Ok(CaseFile::parse("layer", &text, &[])?.into_case())
    }
}

fn layers(study: &mut Study, level: Level) -> Result<(), CaseError> {
    let layer = |length, cells, force| Layer {
        length,
        cells,
        force,
    };
    let mut all = vec![layer(20, 4, [0.4, 0.0])];
    if level >= Level::Default {
        all.extend([layer(40, 4, [0.4, 0.0]), layer(40, 4, [0.4, 0.2])]);
    }
    let found = (all.par_iter())
        .map(|layer| Computed::new(layer.case()?))
        .collect::<Result<Vec<_>, _>>()?;
    for (layer, computed) in all.iter().zip(&found) {
        let Layer {
            length,
            cells,
            force: [horizontal, vertical],
        } = layer;
        let name =
            format!("layer, L/d = {length}, h = d/{cells}, k_h = {horizontal}, k_v = {vertical}");
        let run = study.run(record(name, computed));
        let band = Band::Relative(if *length >= 40 { 0.01 } else { 0.02 });
        let exact = INFINITE_SLOPE.says(layer.factor());
        study.check(run, "factor of safety [-]", exact, band, factor(computed));
    }
    Ok(())
}

/// All trials of a search as one run.
fn record(name: String, computed: &Computed<2>) -> RunRecord {
    let runs: Vec<RunRecord> = (computed.trials.iter())
        .map(|trial| RunRecord::new("", &trial.report, trial.elapsed))
        .collect();
    RunRecord::sum(name, &runs.iter().collect::<Vec<_>>())
}

/// The middle of the interval that a search found \[-\].
fn factor(computed: &Computed<2>) -> f64 {
    let safety = computed.safety();
    let end = |which: fn(&_) -> Option<f64>| safety.and_then(which).unwrap_or(f64::NAN);
    0.5 * (end(|safety| safety.stable) + end(|safety| safety.failed))
}

/// A mesh of a slope.
const fn variant(cells: u32) -> Variant {
    Variant {
        cells,
        locking: Locking::SharedStrain,
        associated: true,
    }
}

const SEARCH: Search = Search {
    bracket: [1.0, 2.0],
    path: section::Path::Reduce,
    steps: 10,
    young: YOUNG,
};

fn slopes(study: &mut Study, level: Level) -> Result<(), CaseError> {
    let undrained = Section::homogeneous(
        "undrained, 2:1, D = 1.5",
        (2.0, 1.5),
        (60.0, 0.0),
        [20.0, 20.0],
    );
    let drained = Section::homogeneous("c-φ, 2:1, D = 1.5", (2.0, 1.5), (15.0, 20.0), [15.0, 20.0]);
    let meshes: &[u32] = if level >= Level::Default {
        &[10, 20]
    } else {
        &[10]
    };
    let mut sought = Vec::new();
    for (slope, section) in [undrained, drained].into_iter().enumerate() {
        let section = Section {
            horizontal: 0.1,
            ..section
        };
        sought.extend(
            meshes
                .iter()
                .map(|&cells| (slope, section.clone(), cells, SEARCH)),
        );
        let by_gravity = Search {
            path: section::Path::Gravity,
            steps: 5,
            ..SEARCH
        };
        sought.push((slope, section, meshes[0], by_gravity));
    }
    let found = (sought.par_iter())
        .map(|(_, section, cells, search)| Computed::new(section.case(variant(*cells), *search)?))
        .collect::<Result<Vec<_>, _>>()?;
    let mut table = Table::new(
        "factors",
        &[
            "slope",
            "cells_over_H",
            "by_gravity",
            "upper_bound_[-]",
            "F_[-]",
        ],
    );
    for ((slope, section, cells, search), computed) in sought.iter().zip(&found) {
        let bound = rotation::upper_bound(section);
        let by_gravity = search.path == section::Path::Gravity;
        let name = format!(
            "{}, k = {}, h = H/{cells}{}",
            section.name,
            section.horizontal,
            if by_gravity { ", by gravity" } else { "" }
        );
        let run = study.run(record(name, computed));
        let value = factor(computed);
        let above = ABOVE[usize::from(*cells > 10)];
        study.check(
            run,
            "factor of safety [-]",
            ROTATION.says(bound),
            Band::Between((1.0 - BLOCKS) * bound, (1.0 + above) * bound),
            value,
        );
        table.push(vec![
            *slope as f64 + 1.0,
            f64::from(*cells),
            f64::from(u8::from(by_gravity)),
            bound,
            value,
        ]);
    }
    Ok(table.write_csv(&study.folder)?)
}

/// The force on the slope of Loukidis et al. is raised until it fails.
fn critical(study: &mut Study, level: Level) -> Result<(), CaseError> {
    let section = Section::cut(
        "Loukidis et al.",
        [25.0, 3.0, 25.0],
        20.0,
        (25.0, 30.0),
        [75.0, 50.0],
    );
    let meshes: &[u32] = if level >= Level::Default {
        &[10, 20]
    } else {
        &[10]
    };
    let case = |cells: &u32| -> Result<Case<2>, CaseError> {
        let mut case = section.case(variant(*cells), SEARCH)?;
        let weight = case.stages[0].clone();
        let (horizontal, steps) = RAISED;
        let mut push = Stage {
            name: "push".to_owned(),
            kind: StageKind::Gravity {
                factor: 1.0,
                horizontal: Some(horizontal),
                across: None,
                vertical: None,
            },
            steps,
            start_from: Some(0),
            ..weight.clone()
        };
        push.stop_when.no_equilibrium = true;
        case.stages = vec![weight, push];
        Ok(case)
    };
    let found = (meshes.par_iter())
        .map(|cells| Computed::new(case(cells)?))
        .collect::<Result<Vec<_>, _>>()?;
    let mut table = Table::new("critical_acceleration", &["cells_over_H", "k_c_[-]"]);
    for (cells, computed) in meshes.iter().zip(&found) {
        let name = format!("{}, h = H/{cells}", section.name);
        let run = study.run(RunRecord::new(name, &computed.report, computed.elapsed));
        let reached = computed
            .report
            .steps
            .last()
            .map_or(f64::NAN, |step| step.to);
        let value = RAISED.0 * reached;
        study.check(
            run,
            "horizontal force at failure over the weight [-]",
            LOUKIDIS.says(0.432),
            Band::Between(
                (1.0 - BLOCKS) * 0.432,
                (1.0 + ABOVE[usize::from(*cells > 10)]) * 0.432,
            ),
            value,
        );
        table.push(vec![f64::from(*cells), value]);
    }
    Ok(table.write_csv(&study.folder)?)
}
