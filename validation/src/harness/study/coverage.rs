//! How often the truth lies within the uncertainty that a study of meshes states, over all problems whose answer is known.

use std::fmt::Write as _;

use igimp_results::mesh_study::{Computed, Convergence, Estimate, estimate};

use crate::harness::study::Study;

/// Least orders that are tried beside the one that is thought possible \[-\].
const OTHERS: [f64; 4] = [0.75, 2.0 / 3.0, 0.5, 1.0 / 3.0];

/// Knowledge of a result: how it converges, and where it lies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    /// How results of its kind converge.
    pub(crate) convergence: Convergence,
    /// Least and greatest value that are possible; the same where it is known exactly.
    pub(crate) truth: [f64; 2],
}

/// A result on several meshes, extrapolated.
#[derive(Clone, Debug)]
pub(crate) struct Extrapolated {
    pub(crate) name: String,
    pub(crate) known: Known,
    pub(crate) values: Vec<Computed>,
    pub(crate) estimate: Estimate,
}

impl Extrapolated {
    /// Whether the truth can lie within the uncertainty.
    pub(crate) fn covers(&self) -> bool {
        let Estimate {
            value, uncertainty, ..
        } = self.estimate;
        let [lower, upper] = self.known.truth;
        // Digits of printed bounds.
        let slack = 1e-9 * upper.abs();
        value - uncertainty <= upper + slack && value + uncertainty >= lower - slack
    }

    /// The same result if the least order that is thought possible were another one.
    fn with_slowest(&self, slowest: f64) -> Option<Self> {
        let convergence = self.known.convergence.with_slowest(slowest);
        let estimate = estimate(&self.values, convergence)?;
        Some(Self {
            estimate,
            ..self.clone()
        })
    }

    /// From the lower to the upper end of the uncertainty, as a share of the value \[-\].
    pub(crate) fn width(&self) -> f64 {
        2.0 * self.estimate.uncertainty / self.estimate.value.abs()
    }
}

impl Study {
    /// Extrapolates a result that is known, and keeps the estimate; none for fewer than two finite values.
    pub(crate) fn extrapolate(
        &mut self,
        name: impl Into<String>,
        known: Known,
        values: &[Computed],
    ) -> Option<Estimate> {
        let estimate = estimate(values, known.convergence)?;
        self.extrapolated.push(Extrapolated {
            name: name.into(),
            known,
            values: values.to_vec(),
            estimate,
        });
        Some(estimate)
    }
}

/// A value on cells of a size that was not searched for.
pub(crate) fn on_cells(h: f64, value: f64) -> Computed {
    Computed {
        h,
        value,
        half_width: 0.0,
    }
}

/// The value without a mesh; not a number where there is none.
pub(crate) fn value(estimate: Option<Estimate>) -> f64 {
    estimate.map_or(f64::NAN, |estimate| estimate.value)
}

/// How many results there are, in how many the truth can lie within the uncertainty, and the median width \[-\].
pub(crate) fn counted<'a>(results: impl Iterator<Item = &'a Extrapolated>) -> (usize, usize, f64) {
    let (mut covered, mut widths) = (0, Vec::new());
    for result in results {
        covered += usize::from(result.covers());
        widths.push(result.width());
    }
    (widths.len(), covered, median(&mut widths))
}

/// The median; not a number of nothing.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    let half = values.len() / 2;
    match values.len() {
        0 => f64::NAN,
        count if count % 2 == 0 => 0.5 * (values[half - 1] + values[half]),
        _ => values[half],
    }
}

/// The coverage over all results of some studies, by kind of convergence, and those that are not covered; none where
/// nothing was extrapolated.
pub(crate) fn note(studies: &[Study]) -> Option<String> {
    let all = || studies.iter().flat_map(|study| &study.extrapolated);
    all().next()?;
    let kinds = [
        ("soil alone", Convergence::SOIL),
        ("strength that varies", Convergence::VARIED_SOIL),
        ("footings that hold nodes", Convergence::FOOTING),
        ("contact and reinforcement", Convergence::CONTACT),
    ];
    let mut text = "mesh error: known answers within the uncertainty, median width of it [%]; the same with orders from \
         3/4, 2/3, 1/2, 1/3 on\n"
        .to_owned();
    let share = |(count, covered, width): (usize, usize, f64)| {
        format!("{covered} of {count}, {:.2}", 100.0 * width)
    };
    let mut line = |name: &str, of: &[&Extrapolated]| {
        let others = OTHERS.map(|slowest| {
            let found: Vec<_> = (of.iter())
                .filter_map(|result| result.with_slowest(slowest))
                .collect();
            share(counted(found.iter()))
        });
        let usual = share(counted(of.iter().copied()));
        let _ = writeln!(text, "  {name}: {usual}; {}", others.join("; "));
    };
    for (name, convergence) in kinds {
        let of_kind: Vec<_> = all()
            .filter(|result| result.known.convergence == convergence)
            .collect();
        if !of_kind.is_empty() {
            line(name, &of_kind);
        }
    }
    line("all", &all().collect::<Vec<_>>());
    for result in all().filter(|result| !result.covers()) {
        let Extrapolated {
            name,
            known: Known { truth, .. },
            estimate,
            ..
        } = result;
        let _ = writeln!(
            text,
            "  not covered: {name}: {:.4} ± {:.4}, known {:.4} to {:.4} (order {})",
            estimate.value,
            estimate.uncertainty,
            truth[0],
            truth[1],
            estimate.order.sentence()
        );
    }
    Some(text)
}
