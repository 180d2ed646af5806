//! The benchmarks on coarse meshes, in variants of the method that differ in one choice.

use igimp_assembly::{DomainUpdate, Kinematics};
use igimp_cases::CaseError;
use igimp_model::Case;
use igimp_results::measure::{oscillation, sigma};
use igimp_results::tables::table::Table;
use rayon::prelude::*;

use crate::footing;
use crate::harness::study::{RunRecord, Study};
use crate::runs::{Computed, corners, mesh, shipped_case, unwatched};

/// One choice: its changes to a case.
pub(super) struct Variant {
    /// Its name in texts.
    pub(super) label: &'static str,
    /// Its name in headers of tables and in names of runs.
    pub(super) slug: &'static str,
    /// The change.
    pub(super) change: fn(&mut Case<2>),
}

/// A benchmark in several variants, each at several values of a parameter.
pub(super) struct Results<'a> {
    /// The variants.
    pub(super) variants: &'a [Variant],
    /// The parameter and its unit, as in the header of a table.
    pub(super) parameter: &'static str,
    /// Its values.
    pub(super) values: &'a [usize],
    /// Results by variant, then by value.
    pub(super) computed: Vec<Vec<Computed<2>>>,
}

/// A quantity of a run: its name with unit, as in the header of a table, and how it is read.
pub(super) type Quantity<'a> = (&'a str, &'a dyn Fn(&Computed<2>) -> f64);

impl<'a> Results<'a> {
    /// Runs a benchmark in every variant at every value.
    pub(super) fn compute(
        variants: &'a [Variant],
        parameter: &'static str,
        values: &'a [usize],
        case: impl Fn(usize) -> Result<Case<2>, CaseError> + Sync,
    ) -> Result<Self, CaseError> {
        let jobs: Vec<_> = variants
            .iter()
            .flat_map(|variant| values.iter().map(move |&value| (variant, value)))
            .collect();
        let mut computed = jobs
            .par_iter()
            .map(|(variant, value)| {
                let mut case = case(*value)?;
                (variant.change)(&mut case);
                Computed::new(case)
            })
            .collect::<Result<Vec<_>, CaseError>>()?
            .into_iter();
        let computed = variants
            .iter()
            .map(|_| computed.by_ref().take(values.len()).collect())
            .collect();
        Ok(Self {
            variants,
            parameter,
            values,
            computed,
        })
    }

    /// Quantities against the parameter: a row for each value, columns by variant.
    pub(super) fn table(&self, name: &str, quantities: &[Quantity<'_>]) -> Table {
        let mut header = vec![self.parameter.to_owned()];
        for variant in self.variants {
            for (quantity, _) in quantities {
                header.push(format!("{}_{quantity}", variant.slug));
            }
        }
        let header: Vec<&str> = header.iter().map(String::as_str).collect();
        let mut table = Table::new(name, &header);
        for (k, &value) in self.values.iter().enumerate() {
            let mut row = vec![value as f64];
            for by_value in &self.computed {
                row.extend(quantities.iter().map(|(_, of)| of(&by_value[k])));
            }
            table.push(row);
        }
        table
    }

    /// A quantity against the parameter, for a variant.
    pub(super) fn curve(&self, variant: usize, of: impl Fn(&Computed<2>) -> f64) -> Vec<[f64; 2]> {
        let pairs = self.values.iter().zip(&self.computed[variant]);
        pairs
            .map(|(&value, computed)| [value as f64, of(computed)])
            .collect()
    }

    /// Records the run of a variant at a value, under its name on this benchmark.
    pub(super) fn record(
        &self,
        study: &mut Study,
        benchmark: &str,
        variant: usize,
        value: usize,
    ) -> usize {
        let computed = self.at(variant, value);
        let name = format!("{}: {benchmark}", self.variants[variant].label);
        study.run(RunRecord::new(name, &computed.report, computed.elapsed))
    }

    /// The result of a variant at a value.
    ///
    /// # Panics
    /// If it was not computed.
    pub(super) fn at(&self, variant: usize, value: usize) -> &Computed<2> {
        let place = self.values.iter().position(|&known| known == value);
        &self.computed[variant][place.expect("the value was computed")]
    }
}

/// Writes a table that is not held against a snapshot: its states lie past failure or behind cut
/// steps, and hang on round-off.
pub(super) fn written(study: &Study, table: &Table) -> Result<(), CaseError> {
    Ok(table.write_csv(&study.folder)?)
}

/// Newton corrections per accepted step \[-\].
pub(super) fn corrections(computed: &Computed<2>) -> f64 {
    computed.report.iterations() as f64 / computed.report.steps.len() as f64
}

/// Steps that were tried and cut \[-\].
pub(super) fn cuts(computed: &Computed<2>) -> f64 {
    computed.report.failures.len() as f64
}

/// Particles times corrections in accepted steps, in millions: the work, whatever the machine \[-\].
pub(super) fn work(computed: &Computed<2>) -> f64 {
    1e-6 * computed.particles().len() as f64 * computed.report.iterations() as f64
}

/// Load factor of the last stage that was reached \[-\].
pub(super) fn reached(computed: &Computed<2>) -> f64 {
    computed.report.reached()
}

/// Largest displacement at the end \[m\].
pub(super) fn largest_displacement(computed: &Computed<2>) -> f64 {
    let stages = &computed.run.summary.stages;
    stages
        .last()
        .map_or(f64::NAN, |stage| stage.largest_displacement)
}

/// The soft slope of the benchmark, gravity raised to a multiple \[-\] in equal steps.
pub(super) fn soft_slope(cell: f64, factor: f64, steps: usize) -> Result<Case<2>, CaseError> {
    let mut overrides = mesh(cell, [40.0, 15.0 + cell]);
    overrides.extend(unwatched());
    overrides.push(format!("stages.own weight.factor={factor}"));
    overrides.push(format!("stages.own weight.steps={steps}"));
    overrides.push("stages.own weight.stop_when={ no_equilibrium = true }".to_owned());
    shipped_case("von_mises_slope", overrides)
}

/// The shipped cantilever with so many cells over its depth of 1 m, under a multiple of its load \[-\]
/// that is raised in equal steps.
pub(super) fn cantilever(cells: usize, load: usize, steps: usize) -> Result<Case<2>, CaseError> {
    let mut overrides = mesh(1.0 / cells as f64, [16.0, 11.0]);
    let corner = [[0.0, 9.0], [10.25, 9.0], [10.25, 10.0], [0.0, 10.0]];
    overrides.push(format!("bodies.beam.polygon={}", corners(&corner)));
    overrides.push(format!("loads.end load.at=[\"10 m\", \"{} m\"]", TIP[1]));
    overrides.extend(unwatched());
    overrides.push("curves=[]".to_owned());
    overrides.push(format!("stages.large.factor={load}"));
    overrides.push(format!("stages.large.steps={steps}"));
    overrides.push("stages.large.stop_when={ no_equilibrium = true }".to_owned());
    shipped_case("cantilever", overrides)
}

/// The loaded point of the cantilever before it is bent \[m\].
const TIP: [f64; 2] = [10.0, 9.5];

/// Particles are equally far from the tip when their distances differ by less \[m\].
const AS_FAR: f64 = 1e-6;

/// Deflection of the cantilever's tip over its length, the mean of the particles that are next to it; not a number
/// when it did not reach its load \[-\].
pub(super) fn deflection(computed: &Computed<2>) -> f64 {
    if reached(computed) < 1.0 {
        return f64::NAN;
    }
    let particles = computed.particles();
    let start = std::iter::zip(&particles.x, &particles.displacement);
    let distances: Vec<f64> = start
        .map(|(x, u)| (x[0] - u[0] - TIP[0]).hypot(x[1] - u[1] - TIP[1]))
        .collect();
    let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
    let next = std::iter::zip(&distances, &particles.displacement)
        .filter(|&(&distance, _)| distance < least + AS_FAR)
        .map(|(_, u)| -u[1] / TIP[0]);
    let (count, sum) = next.fold((0, 0.0), |(count, sum), share| (count + 1, sum + share));
    sum / f64::from(count)
}

/// The drained slope of the benchmark, h = 1 m, with a search for its factor of safety alone.
pub(super) fn drained_slope() -> Result<Case<2>, CaseError> {
    let mut overrides = mesh(1.0, [36.0, 11.0]);
    overrides.push("stages.strength reduction.factors=[]".to_owned());
    overrides.push("stages.strength reduction.tolerance=0.002".to_owned());
    overrides.push("curves=[]".to_owned());
    shipped_case("mohr_coulomb_slope", overrides)
}

/// Middle of the interval of the factor of safety \[-\].
pub(super) fn factor_of_safety(computed: &Computed<2>) -> f64 {
    let interval = computed
        .safety()
        .and_then(|safety| Some([safety.stable?, safety.failed?]));
    interval.map_or(f64::NAN, |[stable, failed]| 0.5 * (stable + failed))
}

/// Corrections of all trials of a search \[-\].
pub(super) fn corrections_of_trials(computed: &Computed<2>) -> f64 {
    let trials = computed.trials.iter();
    trials.map(|trial| trial.summary.iterations).sum::<usize>() as f64
}

/// Oscillation of σ_yy over γH in the slope, H = 10 m: deviation from local planes of radius 1.3 h \[-\].
pub(super) fn roughness(computed: &Computed<2>) -> f64 {
    let particles = computed.particles();
    let radius = 1.3 * computed.case.grid.smallest_cell()[0];
    let scale = 10.0 * computed.case.materials[0].unit_weight;
    oscillation(&particles.x, &sigma(particles, 1, 1), radius) / scale
}

/// Pushes of the footing to one width with five cells per width, and two with nine, each different in
/// one choice.
pub(super) struct Footings {
    pushed: Vec<(&'static str, Computed<2>)>,
}

impl Footings {
    /// Runs them.
    pub(super) fn push() -> Result<Self, CaseError> {
        type Change = fn(&mut Case<2>);
        let small: Change = |case| case.method.kinematics = Kinematics::SmallStrain;
        let fixed: Change = |case| case.method.domain_update = DomainUpdate::Fixed;
        let by_f: Change = |case| case.method.domain_update = DomainUpdate::DiagonalF;
        let by_j: Change = |case| case.method.domain_update = DomainUpdate::RootJ;
        let two: Change = |case| case.bodies[0].per_direction = 2;
        let four: Change = |case| case.bodies[0].per_direction = 4;
        // Name, cells per width (odd, so that the edge lies mid-cell), steps, choice.
        let pushes: [(&'static str, u32, usize, Change); 10] = [
            ("default-9", 9, 40, |_| {}),
            ("2x2-9", 9, 40, two),
            ("default", 5, 40, |_| {}),
            ("small-strain-80", 5, 80, small),
            ("small-strain-40", 5, 40, small),
            ("fixed", 5, 40, fixed),
            ("F", 5, 40, by_f),
            ("root-J", 5, 40, by_j),
            ("2x2", 5, 40, two),
            ("4x4", 5, 40, four),
        ];
        let pushed = pushes
            .par_iter()
            .map(|&(name, cells, steps, change)| {
                let mut overrides = mesh(1.0 / f64::from(cells), [5.0, 6.0]);
                overrides.extend(footing::to(1.0, steps));
                let mut case = shipped_case("footing_bonded", overrides)?;
                change(&mut case);
                Ok((name, Computed::new(case)?))
            })
            .collect::<Result<_, CaseError>>()?;
        Ok(Self { pushed })
    }

    /// A push by its name.
    ///
    /// # Panics
    /// If there is none.
    pub(super) fn of(&self, name: &str) -> &Computed<2> {
        let found = self.pushed.iter().find(|(known, _)| *known == name);
        &found.expect("the footing was pushed").1
    }

    /// Resistance N against penetration w/B for some pushes: a row at every twentieth of B that all
    /// reached, not a number beyond.
    pub(super) fn table(&self, name: &str, pushes: &[(&str, &str)]) -> Table {
        let mut header = vec!["penetration_w/B_[-]".to_owned()];
        header.extend(pushes.iter().map(|(_, label)| format!("{label}_N_[-]")));
        let header: Vec<&str> = header.iter().map(String::as_str).collect();
        let mut table = Table::new(name, &header);
        for k in 1..=20 {
            let penetration = f64::from(k) / 20.0;
            let mut row = vec![penetration];
            row.extend(
                pushes
                    .iter()
                    .map(|(push, _)| self.resistance_at(push, penetration)),
            );
            table.push(row);
        }
        table
    }

    /// N at a penetration w/B; not a number beyond the end of a push \[-\].
    pub(super) fn resistance_at(&self, push: &str, penetration: f64) -> f64 {
        crate::harness::reference::interpolate(&footing::resistance(self.of(push)), penetration)
    }

    /// Scatter of N beyond 0.3 B: root mean square of its second differences over √6, which is the
    /// standard deviation of independent noise on a smooth curve \[-\].
    pub(super) fn scatter(&self, push: &str) -> f64 {
        let points = footing::resistance(self.of(push));
        let late: Vec<f64> = points.iter().filter(|p| p[0] > 0.3).map(|p| p[1]).collect();
        let squares: Vec<f64> = late
            .windows(3)
            .map(|n| (n[0] - 2.0 * n[1] + n[2]).powi(2))
            .collect();
        (squares.iter().sum::<f64>() / (6.0 * squares.len() as f64)).sqrt()
    }

    /// Records the run of a push.
    pub(super) fn record(&self, study: &mut Study, push: &str, label: &str) -> usize {
        let computed = self.of(push);
        let name = format!("{label}: footing, B/h = 5");
        study.run(RunRecord::new(name, &computed.report, computed.elapsed))
    }
}
