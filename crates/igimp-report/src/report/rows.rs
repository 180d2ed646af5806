//! The rows of the tables of a report, as text.

use igimp_model::check::Band;
use igimp_results::fields::{Dimension, Scale};
use igimp_results::mesh_study::MeshSummary;
use igimp_results::summary::{
    ConsolidationSummary, MaterialShare, MemberSummary, NEEDLESS, PoreSummary, StageOutcome,
    StageSummary, Summary,
};
use igimp_text::{short, told_apart};
use serde::Serialize;

use super::verdict::on_safety;
use crate::report::numbers::{UNKNOWN, percent};

/// The phases of a stage, in the order of [`StageSummary::phases`].
pub(super) const PHASES: [&str; 5] = ["set-up", "assembly", "factorisation", "solution", "commit"];

/// The note on a result whose mesh error was not studied.
const MESH_ERROR_UNKNOWN: &str = "mesh error not known: igimp run --meshes 2 finds it";

/// A number with its name, and a note for its reader.
#[derive(Serialize)]
pub(super) struct Number {
    pub name: String,
    pub value: String,
    pub(super) note: String,
}

impl Number {
    fn new(name: impl Into<String>, value: String, note: impl Into<String>) -> Self {
        let (name, note) = (name.into(), note.into());
        Self { name, value, note }
    }
}

/// The headline numbers: factors of safety, resistances, displacements, checks.
pub(super) fn headline(summary: &Summary) -> Vec<Number> {
    let mesh_error = match &summary.mesh_study {
        Some(study) => {
            let shown = study.shown().map_or_else(String::new, MeshSummary::label);
            format!("on the mesh {shown}; its error is that of the extrapolated value")
        }
        None => MESH_ERROR_UNKNOWN.to_owned(),
    };
    let mut numbers = factors_of_safety(summary, &mesh_error);
    numbers.extend(resistances(summary, &mesh_error));
    numbers.extend(sliding_blocks(summary));
    let moved = |stage: &&StageSummary| stage.safety.is_none();
    if let Some(stage) = summary.stages.iter().rev().find(moved) {
        let note = format!("of all particles, at the end of “{}”", stage.name);
        let value = length(stage.largest_displacement);
        numbers.push(Number::new("Largest displacement", value, note));
    }
    numbers.extend(pore_pressures(summary));
    for (stage, flow) in consolidated(summary) {
        let has_one = |stage: &StageSummary| stage.consolidation.is_some();
        let name = of_stage(summary, has_one, stage, "Excess pressure dissipated");
        let value = format!("{} %", short(100.0 * flow.dissipated()));
        numbers.push(Number::new(name, value, dissipation_note(summary, flow)));
    }
    if !summary.checks.is_empty() {
        let met = summary.checks.iter().filter(|row| row.pass).count();
        let value = format!("{met} of {}", summary.checks.len());
        let note = "against references from outside";
        numbers.push(Number::new("Checks met", value, note));
    }
    numbers
}

/// The name of a number, with that of its stage where several stages have one.
fn of_stage(
    summary: &Summary,
    has_one: fn(&StageSummary) -> bool,
    stage: &StageSummary,
    name: &str,
) -> String {
    if summary.stages.iter().filter(|stage| has_one(stage)).count() > 1 {
        format!("{name}, {}", stage.name)
    } else {
        name.to_owned()
    }
}

fn factors_of_safety(summary: &Summary, mesh_error: &str) -> Vec<Number> {
    let number = |stage: &StageSummary| {
        let safety = stage.safety.as_ref()?;
        let bound = |factor: Option<f64>| factor.map_or_else(|| "?".to_owned(), short);
        let (from, to) = match (safety.stable, safety.failed) {
            (Some(stable), Some(failed)) => told_apart(stable, failed).into(),
            (stable, failed) => (bound(stable), bound(failed)),
        };
        let has_one = |stage: &StageSummary| stage.safety.is_some();
        let name = of_stage(summary, has_one, stage, "Factor of safety");
        if safety.needs_no_strength() {
            let note = "nothing of this ground can fail: its strength is not needed";
            return Some(Number::new(name, format!("> {NEEDLESS}"), note));
        }
        let value = format!("{from}\u{a0}…\u{a0}{to}");
        Some(Number::new(name, value, mesh_error))
    };
    summary.stages.iter().filter_map(number).collect()
}

fn resistances(summary: &Summary, mesh_error: &str) -> Vec<Number> {
    let mut numbers = Vec::new();
    for stage in &summary.stages {
        if let Some(peak) = stage.peak_resistance {
            let has_one = |stage: &StageSummary| stage.peak_resistance.is_some();
            let name = of_stage(summary, has_one, stage, "Peak resistance");
            let value = quantity(peak, force(summary));
            numbers.push(Number::new(name, value, mesh_error));
        }
        if let Some(settlement) = stage.settlement {
            let has_one = |stage: &StageSummary| stage.settlement.is_some();
            let name = of_stage(summary, has_one, stage, "Settlement");
            let note = format!("of the footing, at the end of “{}”", stage.name);
            numbers.push(Number::new(name, length(settlement), note));
        }
    }
    numbers
}

/// The displacements of Newmark's sliding blocks.
fn sliding_blocks(summary: &Summary) -> Vec<Number> {
    let number = |stage: &StageSummary| {
        let newmark = stage.newmark.as_ref()?;
        let has_one = |stage: &StageSummary| stage.newmark.is_some();
        let name = of_stage(summary, has_one, stage, "Newmark's sliding block");
        let note = format!(
            "k_c = {} of “{}”, ground at up to {}, in “{}”",
            short(newmark.yield_coefficient),
            newmark.from,
            quantity(newmark.peak_acceleration, "m/s²"),
            stage.name
        );
        Some(Number::new(name, length(newmark.displacement), note))
    };
    summary.stages.iter().filter_map(number).collect()
}

/// Pore pressures of the last stage that left water in the pores.
fn pore_pressures(summary: &Summary) -> Vec<Number> {
    let Some((stage, pores)) = last_pores(summary) else {
        return Vec::new();
    };
    let note = format!(
        "of any particle, compression positive, at the end of “{}”",
        stage.name
    );
    let value = quantity(pores.largest, "Pa");
    let mut numbers = vec![Number::new("Largest pore pressure", value, note.clone())];
    if let Some([least, most]) = pores.excess {
        let value = format!("{} to {}", quantity(least, "Pa"), quantity(most, "Pa"));
        let value = value.replace('-', "−");
        numbers.push(Number::new("Excess pore pressure", value, note));
    }
    numbers
}

/// The stages in which water flowed.
fn consolidated(summary: &Summary) -> impl Iterator<Item = (&StageSummary, &ConsolidationSummary)> {
    let stages = summary.stages.iter();
    stages.filter_map(|stage| Some((stage, stage.consolidation.as_ref()?)))
}

/// The note below the share of excess pressure that is gone.
fn dissipation_note(summary: &Summary, flow: &ConsolidationSummary) -> String {
    format!(
        "mean of coupled soil {} of {} at most; water that left {} {}",
        quantity(flow.excess, "Pa"),
        quantity(flow.most_excess, "Pa"),
        short(flow.outflow),
        if summary.size.is_whole() {
            "m³"
        } else {
            "m³/m"
        }
    )
}

/// A member of reinforcement at the end of a stage.
#[derive(Serialize)]
pub(super) struct MemberView {
    stage: String,
    name: String,
    force: String,
    head_force: String,
    at_limit: String,
    /// Whether forces are those per metre run.
    per_metre: bool,
}

/// The tension of reinforcement at the end of the stages that changed it.
pub(super) fn reinforcement(summary: &Summary) -> Vec<MemberView> {
    let stages = summary.stages.iter().filter(|stage| stage.safety.is_none());
    let per_metre = !summary.size.is_whole();
    let unit = force(summary);
    let view = |(stage, member): (&StageSummary, &MemberSummary)| MemberView {
        per_metre,
        stage: stage.name.clone(),
        name: member.name.clone(),
        force: quantity(member.force, unit),
        head_force: quantity(member.head_force, unit),
        at_limit: format!("{} %", short(100.0 * member.at_limit)),
    };
    stages
        .flat_map(|stage| stage.reinforcement.iter().map(move |bar| (stage, bar)))
        .map(view)
        .collect()
}

/// Unit of forces: per metre run in plane strain.
fn force(summary: &Summary) -> &'static str {
    if summary.size.is_whole() { "N" } else { "N/m" }
}

/// The last stage that left water in the pores.
fn last_pores(summary: &Summary) -> Option<(&StageSummary, &PoreSummary)> {
    let stage = summary
        .stages
        .iter()
        .rfind(|stage| stage.pore_water.is_some())?;
    Some((stage, stage.pore_water.as_ref()?))
}

/// The computing effort.
pub(super) fn effort(summary: &Summary) -> Vec<Number> {
    let mut numbers = Vec::new();
    let mut add = |name: &str, value: String| {
        let (name, note) = (name.to_owned(), String::new());
        numbers.push(Number { name, value, note });
    };
    let (stages, size) = (&summary.stages, &summary.size);
    let sum = |of: fn(&StageSummary) -> usize| grouped(stages.iter().map(of).sum());
    add("Steps", sum(|stage| stage.steps));
    add("Newton iterations", sum(|stage| stage.iterations));
    add("Particles", grouped(size.particles));
    add("Grid cells", grouped(size.cells));
    add("Most unknowns", grouped(size.unknowns));
    add("Weight", quantity(size.weight, force(summary)));
    let volume = if size.is_whole() { "m³" } else { "m³/m" };
    add("Volume", format!("{} {volume}", short(size.volume)));
    add("Time", time(summary.seconds));
    if summary.output_seconds > 0.0 {
        add("Of that, writing", time(summary.output_seconds));
    }
    if let Some(memory) = summary.peak_memory_mib {
        add("Most memory", format!("{memory:.0} MiB"));
    }
    numbers
}

/// An entry of the head of the report.
#[derive(Serialize)]
pub(super) struct HeadView {
    name: &'static str,
    value: String,
    /// Whether the value is a long code.
    code: bool,
}

/// Project, client, author, revision, date, input and program of the results.
pub(super) fn head(summary: &Summary) -> Vec<HeadView> {
    let block = &summary.title_block;
    let entries = [
        ("Project", &block.project, false),
        ("Client", &block.client, false),
        ("Author", &block.author, false),
        ("Revision", &block.revision, false),
        ("Date of the run", &summary.date, false),
        ("Input, SHA-256", &summary.input_sha256, true),
    ];
    let program = Some(summary.program.clone()).filter(|program| !program.is_empty());
    entries
        .into_iter()
        .chain([("Program", &program, false)])
        .filter_map(|(name, value, code)| {
            let value = value.clone()?;
            Some(HeadView { name, value, code })
        })
        .collect()
}

/// A check.
#[derive(Serialize)]
pub(super) struct CheckView {
    pass: bool,
    verdict: &'static str,
    quantity: String,
    about: String,
    measured: String,
    expected: String,
    band: String,
    deviation: String,
    source: String,
}

pub(super) fn checks(summary: &Summary) -> Vec<CheckView> {
    let view = |row: &igimp_results::summary::CheckRow| {
        let check = &row.check;
        let share = (check.measured - check.expected) / check.expected.abs();
        let deviation = match check.band {
            Band::Relative(_) if share.is_finite() => format!("{:+.2} %", 100.0 * share),
            _ => String::new(),
        };
        CheckView {
            pass: row.pass,
            verdict: row.verdict(),
            quantity: check.quantity.clone(),
            about: check.variant.trim().to_owned(),
            measured: row.measured(),
            expected: check.printed(check.expected),
            band: check.printed_band(),
            deviation: deviation.replace('-', "−"),
            source: check.source.clone(),
        }
    };
    summary.checks.iter().map(view).collect()
}

/// A stage.
#[derive(Serialize)]
pub(super) struct StageView {
    name: String,
    kind: String,
    class: &'static str,
    outcome: &'static str,
    reason: String,
    reached: String,
    steps: String,
    at_round_off: usize,
    cuts: String,
    iterations: String,
    displacement: String,
    plastic: String,
    time: String,
    /// Shares in percent; empty where no time was measured.
    phases: Vec<f64>,
    phases_text: String,
}

pub(super) fn stages(summary: &Summary) -> Vec<StageView> {
    summary.stages.iter().map(stage).collect()
}

fn stage(stage: &StageSummary) -> StageView {
    let (class, outcome) = match stage.outcome {
        StageOutcome::Completed => ("good", "completed"),
        StageOutcome::Stopped => ("good", "stopped as asked"),
        StageOutcome::NotConverged => ("bad", "not converged"),
        StageOutcome::Interrupted => ("fair", "interrupted"),
    };
    let all: f64 = stage.phases.iter().sum();
    let phases: Vec<f64> = if all > 0.0 && all.is_finite() {
        let share = |seconds: &f64| (1000.0 * seconds / all).round() / 10.0;
        stage.phases.iter().map(share).collect()
    } else {
        Vec::new()
    };
    let text: Vec<String> = std::iter::zip(PHASES, &phases)
        .map(|(name, share)| format!("{name} {share:.0} %"))
        .collect();
    StageView {
        name: stage.name.clone(),
        kind: stage.kind.clone(),
        class,
        outcome,
        reason: stage.reason.clone(),
        reached: percent(stage.reached),
        steps: grouped(stage.steps),
        at_round_off: stage.at_round_off,
        cuts: grouped(stage.cuts),
        iterations: grouped(stage.iterations),
        displacement: length(stage.largest_displacement),
        plastic: percent(stage.plastic_share),
        time: time(stage.seconds),
        phases,
        phases_text: text.join(", "),
    }
}

/// A search for a factor of safety.
#[derive(Serialize)]
pub(super) struct SafetyView {
    stage: String,
    text: String,
    trials: Vec<TrialView>,
    path: Vec<PathView>,
    shares: Vec<ShareView>,
}

/// The share of a material in a factor of safety.
#[derive(Serialize)]
struct ShareView {
    material: String,
    dissipation: String,
    /// Each strength: its symbol, the change of the factor with it, and that in percent for a bar.
    strengths: Vec<(&'static str, String, f64)>,
}

impl ShareView {
    fn of(share: &MaterialShare) -> Self {
        let bar = |symbol, by: f64| (symbol, format!("{by:.3}"), (100.0 * by).clamp(0.0, 100.0));
        let friction = share.friction.map(|friction| bar("tan φ", friction));
        let kept = if share.is_reduced { "" } else { " (kept)" };
        Self {
            material: format!("{}{kept}", share.material),
            dissipation: percent(share.dissipation),
            strengths: std::iter::once(bar("c", share.cohesion))
                .chain(friction)
                .collect(),
        }
    }
}

/// An equilibrium of a path.
#[derive(Serialize)]
struct PathView {
    factor: String,
    displacement: String,
    dissipated: String,
    plastic: String,
    iterations: String,
}

/// A trial of a search.
#[derive(Serialize)]
struct TrialView {
    srf: String,
    stable: bool,
    reason: String,
    displacement: String,
    steps: String,
    iterations: String,
    cuts: String,
}

pub(super) fn safety(summary: &Summary) -> Vec<SafetyView> {
    let view = |stage: &StageSummary| {
        let safety = stage.safety.as_ref()?;
        let trials = safety.trials.iter().map(|trial| TrialView {
            srf: format!("{:.4}", trial.srf),
            stable: trial.stable,
            reason: trial.reason.clone(),
            displacement: length(trial.displacement),
            steps: grouped(trial.steps),
            iterations: grouped(trial.iterations),
            cuts: grouped(trial.cuts),
        });
        let points = safety.path.iter().flat_map(|path| &path.points);
        let path = points.map(|point| PathView {
            factor: format!("{:.4}", point.factor),
            displacement: length(point.displacement),
            dissipated: percent(point.dissipated),
            plastic: percent(point.plastic_share),
            iterations: grouped(point.iterations),
        });
        let shares = safety.path.iter().flat_map(|path| &path.shares);
        let shares = shares.flat_map(|shares| &shares.materials);
        Some(SafetyView {
            shares: shares.map(ShareView::of).collect(),
            path: path.collect(),
            stage: stage.name.clone(),
            text: on_safety(safety).join(" "),
            trials: trials.collect(),
        })
    };
    summary.stages.iter().filter_map(view).collect()
}

/// A length in mm or m.
fn length(metres: f64) -> String {
    if !metres.is_finite() {
        return UNKNOWN.to_owned();
    }
    let scale = Scale::of(Dimension::Displacement, [metres]);
    format!("{} {}", short(metres / scale.divide_by), scale.unit)
}

/// A number with a prefix of its unit.
fn quantity(value: f64, unit: &str) -> String {
    let magnitude = value.abs();
    let (divide_by, prefix) = if magnitude >= 1e6 {
        (1e6, "M")
    } else if magnitude >= 1e3 {
        (1e3, "k")
    } else {
        (1.0, "")
    };
    format!("{} {prefix}{unit}", short(value / divide_by))
}

/// A wall-clock time.
pub(super) fn time(seconds: f64) -> String {
    if !seconds.is_finite() || seconds < 0.0 {
        return UNKNOWN.to_owned();
    }
    let whole = seconds.round() as u64;
    match whole {
        0..60 => format!("{} s", short((10.0 * seconds).round() / 10.0)),
        60..3600 => format!("{} min {} s", whole / 60, whole % 60),
        _ => format!("{} h {} min", whole / 3600, whole % 3600 / 60),
    }
}

/// A count with narrow no-break spaces between thousands.
pub(super) fn grouped(count: usize) -> String {
    let digits = count.to_string();
    let mut text = String::with_capacity(digits.len() + 4);
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(
            [0.0, 0.034, 0.5, 1.0].map(percent),
            ["0 %", "3.4 %", "50 %", "100 %"]
        );
        assert_eq!(grouped(1_234_567), "1\u{202f}234\u{202f}567");
        assert_eq!(grouped(123), "123");
        assert_eq!(
            [0.04, 12.34, 61.0, 7325.0].map(time),
            ["0 s", "12.3 s", "1 min 1 s", "2 h 2 min"]
        );
        assert_eq!(length(0.0123), "12.3 mm");
        assert_eq!(quantity(2.5e7, "N/m"), "25 MN/m");
        assert_eq!(
            [time, length, percent].map(|text| text(f64::NAN)),
            [UNKNOWN; 3]
        );
    }
}
