//! The mesh error of an answer: a case on several meshes, and the extrapolation of their values.
//!
//! | | |
//! |---|---|
//! | [`known`] | prior knowledge of how results converge, by the case |
//! | [`extrapolation`] | from values on two or three meshes to an extrapolated value and its uncertainty; numbers only |
//! | [`order`] | which orders of convergence are possible, and which the values on three meshes leave; numbers only |

pub mod extrapolation;
#[cfg(test)]
mod extrapolation_tests;
pub mod known;
pub mod order;

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::atomic::create;
use crate::ending::Ending;
use crate::error::ResultsError;
use crate::model_size::ModelSize;
use crate::tables::cells::cell;
pub use extrapolation::{Computed, Estimate, estimate};
use igimp_model::check::PrintedUnit;
use igimp_text::short;
pub use order::{Convergence, Order};

/// An uncertainty below this share of its value is round-off \[-\].
const ROUND_OFF: f64 = 1e-12;

/// The results of a case on all its meshes, as written to `summary.json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StudySummary {
    /// The meshes from coarse to fine.
    pub meshes: Vec<MeshSummary>,
    /// Factors of safety, limit loads and checks.
    pub results: Vec<StudyResult>,
}

impl StudySummary {
    /// How the study ended: as badly as the worst of its meshes.
    pub fn ending(&self) -> Ending {
        let with = |ending| self.meshes.iter().any(|mesh| mesh.ending == ending);
        [Ending::Failed, Ending::NotConverged, Ending::Interrupted]
            .into_iter()
            .find(|&ending| with(ending))
            .unwrap_or(Ending::Done)
    }

    /// The mesh whose stages and pictures stand for the study: the finest that came to its end, or the
    /// finest that ran at all.
    pub fn shown(&self) -> Option<&MeshSummary> {
        let done = |mesh: &&MeshSummary| mesh.ending == Ending::Done;
        let ran = |mesh: &&MeshSummary| mesh.ending != Ending::Failed;
        let mut backwards = self.meshes.iter().rev();
        let good = backwards.clone().find(done);
        good.or_else(|| backwards.find(ran))
    }

    /// Writes the results as a table, a row each: values and half-widths by mesh, estimate, order.
    ///
    /// # Errors
    /// [`ResultsError::Table`] if it cannot be written.
    pub fn write_table(&self, path: &Path) -> Result<(), ResultsError> {
        let labels = || self.meshes.iter().map(MeshSummary::label);
        let mut header = vec!["result".to_owned()];
        header.extend(labels().map(|label| format!("value ({label})")));
        header.extend(labels().map(|label| format!("half width ({label})")));
        header.extend(["extrapolated", "uncertainty", "order"].map(str::to_owned));
        let number = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:.9e}"));
        let write = || -> Result<(), csv::Error> {
            let mut writer = csv::Writer::from_writer(create(path)?);
            writer.write_record(&header)?;
            for result in &self.results {
                let mut row = vec![cell(&result.name).into_owned()];
                row.extend(result.values.iter().map(|&value| number(value)));
                row.extend(result.half_widths.iter().map(|&width| number(Some(width))));
                row.push(number(result.estimate.map(|found| found.value)));
                row.push(number(result.estimate.map(|found| found.uncertainty)));
                let order = result.estimate.map(|found| found.order.sentence());
                row.push(order.unwrap_or_default());
                writer.write_record(&row)?;
            }
            Ok(writer.flush()?)
        };
        write().map_err(|source| ResultsError::Table {
            path: path.to_owned(),
            source,
        })
    }
}

/// A mesh of a study, and how its run went.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MeshSummary {
    /// Into how many parts it cuts the cells of the case, in each direction.
    pub parts: usize,
    /// Its folder within that of the study.
    pub folder: String,
    /// Size of the model.
    pub size: ModelSize,
    /// How its run ended; a check that is missed on a single mesh counts as done.
    pub ending: Ending,
    /// Why it failed, if it did.
    pub message: Option<String>,
    /// Accepted steps of all stages.
    pub steps: usize,
    /// Wall-clock time \[s\].
    pub seconds: f64,
}

impl MeshSummary {
    /// The size of its cells, as in `h/2`.
    pub fn label(&self) -> String {
        igimp_model::meshes::label(self.parts)
    }
}

/// One result on all meshes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StudyResult {
    /// Name with unit.
    pub name: String,
    /// Its kind.
    pub kind: ResultKind,
    /// By mesh; `None` where the run did not reach it.
    pub values: Vec<Option<f64>>,
    /// By mesh: half the width of the interval in which a search left the value; 0 where nothing was
    /// searched for.
    pub half_widths: Vec<f64>,
    /// By mesh: whether the run ended before it came to the state of the value; these values are not extrapolated.
    #[serde(default)]
    pub early: Vec<bool>,
    /// The extrapolation; `None` for fewer than two values.
    pub estimate: Option<Estimate>,
    /// Of a check the unit in which the case states its band; numbers here are in SI units all the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<PrintedUnit>,
}

impl StudyResult {
    /// The result as it is told: its numbers in the unit of the case, and that unit in its name.
    #[must_use]
    pub fn as_printed(&self) -> Self {
        let Some(unit) = &self.unit else {
            return self.clone();
        };
        let scaled = |value: f64| value / unit.in_si;
        Self {
            name: format!("{} [{}]", self.name, unit.name),
            values: self.values.iter().map(|value| value.map(scaled)).collect(),
            half_widths: self.half_widths.iter().copied().map(scaled).collect(),
            estimate: self.estimate.map(|found| Estimate {
                value: scaled(found.value),
                uncertainty: scaled(found.uncertainty),
                ..found
            }),
            unit: None,
            ..self.clone()
        }
    }

    /// Whether the run on a mesh ended before it came to the value.
    pub fn ended_early(&self, mesh: usize) -> bool {
        self.early.get(mesh).copied().unwrap_or_default()
    }

    /// The finest mesh whose run came to the value, and the value; `None` where no run came to it.
    pub fn finest(&self) -> Option<(usize, f64)> {
        let mut meshes = (0..self.values.len()).rev();
        meshes.find_map(|mesh| Some((mesh, self.values[mesh].filter(|_| !self.ended_early(mesh))?)))
    }

    /// Why nothing is extrapolated; `None` where something is.
    pub fn refusal(&self, meshes: &[MeshSummary]) -> Option<String> {
        if self.estimate.is_some() {
            return None;
        }
        let numbered = meshes.iter().enumerate();
        let early: Vec<String> = numbered
            .filter(|(mesh, _)| self.ended_early(*mesh))
            .map(|(_, mesh)| mesh.label())
            .collect();
        Some(match &early[..] {
            [] => "nothing is extrapolated of fewer than two values".to_owned(),
            [mesh] => format!("nothing is extrapolated: the run on the mesh {mesh} ended early"),
            [before @ .., last] => format!(
                "nothing is extrapolated: the runs on the meshes {} and {last} ended early",
                before.join(", ")
            ),
        })
    }
}

/// The kind of a result of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ResultKind {
    /// Middle of the interval that a strength reduction found.
    FactorOfSafety,
    /// Load at which a stage found no further equilibrium, or the largest resistance of a footing.
    LimitLoad,
    /// A check.
    Check,
}

impl Estimate {
    /// The uncertainty, rounded up to two digits: more are not known.
    pub fn rounded_uncertainty(&self) -> f64 {
        let uncertainty = self.uncertainty;
        if !uncertainty.is_finite() {
            return uncertainty;
        }
        if uncertainty <= ROUND_OFF * self.value.abs() {
            return 0.0;
        }
        let digits = 1.0 - uncertainty.log10().floor();
        let unit = 10.0_f64.powf(-digits);
        // A round number stays one.
        unit * (uncertainty / unit - 1e-9).ceil()
    }

    /// Whether the value is another one than that of the finest mesh, in words before it.
    pub fn lead(&self) -> &'static str {
        match self.order.used() {
            Some(_) => "extrapolated",
            None => "not extrapolated",
        }
    }

    /// As it is printed: the value, and how far it may be off.
    pub fn sentence(&self) -> String {
        let (value, uncertainty) = (short(self.value), short(self.rounded_uncertainty()));
        format!("{value} ± {uncertainty}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_uncertainty_is_rounded_up() {
        let text = |value, uncertainty| {
            let order = Order::Assumed { slowest: 0.5 };
            let found = Estimate {
                value,
                uncertainty,
                order,
            };
            found.sentence()
        };
        assert_eq!(text(1.265, 0.113_38), "1.265 ± 0.12");
        assert_eq!(text(1.265, 0.1), "1.265 ± 0.1");
        assert_eq!(text(514.2, 3.001), "514.2 ± 3.1");
        assert_eq!(text(2.0, 0.0), "2 ± 0");
        assert_eq!(text(71.5, 4.4e-12), "71.5 ± 0");
        assert_eq!(text(0.0, 4.4e-12), "0 ± 4.400e-12");
    }

    #[test]
    fn a_study_ends_as_badly_as_its_worst_mesh() {
        let mesh = |parts, ending| MeshSummary {
            parts,
            ending,
            ..MeshSummary::default()
        };
        let mut study = StudySummary {
            meshes: vec![mesh(1, Ending::Done), mesh(2, Ending::Done)],
            results: Vec::new(),
        };
        assert_eq!(study.ending(), Ending::Done);
        assert_eq!(
            study.shown().map(MeshSummary::label).as_deref(),
            Some("h/2")
        );
        study.meshes[1].ending = Ending::NotConverged;
        assert_eq!(study.ending(), Ending::NotConverged);
        assert_eq!(study.shown().map(MeshSummary::label).as_deref(), Some("h"));
    }
}
