//! One row a run as CSV, and the distribution of ends and effort as Markdown.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use igimp_text::short;

use crate::distribution::spread;
use crate::footing::{DEPTHS, Footing, depth_reached, resistance_at};
use crate::slope::{Drive, Slope};
use crate::watch::{End, Watched};

/// A residual below which a step that was not accepted had all but converged \[-\].
const ALL_BUT_CONVERGED: f64 = 1e-6;

/// Upper ends of the classes of E/c \[-\].
const CLASSES: [f64; 4] = [1e2, 1e3, 1e4, 1e5];

/// Columns of effort.
pub(crate) const EFFORT: &str = "end,cause,closest_residual,plastic_share,steps,cuts,corrections_median,\
    corrections_90,corrections_max,at_round_off,worst_at_round_off,rechecked,violations,seconds,\
    reason";

pub(crate) fn effort_csv(watched: &Watched) -> String {
    let effort = &watched.effort;
    let [median, ninety, most] = spread(&corrections(watched));
    format!(
        "{},{},{:.2e},{:.3},{},{},{median},{ninety},{most},{},{:.2e},{},{},{:.2},\"{}\"",
        watched.end.label(),
        watched.cut.map_or("", |cut| cut.cause),
        watched.cut.map_or(f64::NAN, |cut| cut.closest),
        effort.plastic_share,
        effort.corrections.len(),
        effort.cuts,
        effort.at_round_off,
        effort.worst_at_round_off,
        effort.rechecked,
        effort.violations.len(),
        watched.seconds,
        watched.reason.replace('"', "'").replace('\n', " "),
    )
}

/// Corrections of the accepted steps.
fn corrections(watched: &Watched) -> Vec<f64> {
    let all = watched.effort.corrections.iter();
    all.map(|&corrections| corrections as f64).collect()
}

/// One row a slope.
pub(crate) fn slopes_csv(runs: &[(Slope, Watched)]) -> String {
    let mut text = format!(
        "number,drive,law,angle_deg,height_m,cells,per_direction,foundation_cells,gamma_h_over_c,\
         friction_deg,dilation_deg,poisson,e_over_c,particles,load,load_over_bound,{EFFORT}\n"
    );
    for (slope, watched) in runs {
        let (load, share) = load(slope, watched);
        let _ = writeln!(
            text,
            "{},{},{},{:.1},{:.2},{},{},{},{:.3},{:.1},{:.1},{:.5},{:.3e},{},{load:.4},{share:.3},{}",
            slope.number,
            slope.drive.label().replace(',', ""),
            slope.law.label().replace(',', ""),
            slope.angle,
            slope.height,
            slope.cells,
            slope.per_direction,
            slope.foundation,
            slope.stability_number,
            slope.friction,
            slope.dilation,
            slope.poisson,
            slope.stiffness,
            watched.particles,
            effort_csv(watched),
        );
    }
    text
}

/// γH/c at the end under rising gravity, or the factor of safety; and the load over its bound.
fn load(slope: &Slope, watched: &Watched) -> (f64, f64) {
    match (slope.drive, &watched.safety) {
        (Drive::Gravity, _) => {
            let load = watched.reached * slope.last_gravity() * slope.stability_number;
            (load, load / slope.bound())
        }
        (_, Some(safety)) => {
            let factor =
                0.5 * (safety.stable.unwrap_or(f64::NAN) + safety.failed.unwrap_or(f64::NAN));
            (factor, factor / slope.factor_of_safety())
        }
        _ => (f64::NAN, f64::NAN),
    }
}

/// The distribution of ends and effort over the slopes.
pub(crate) fn slopes(runs: &[(Slope, Watched)], seed: u64) -> String {
    let watched: Vec<&Watched> = runs.iter().map(|(_, watched)| watched).collect();
    let mut text = format!("{} slopes, seed {seed}.\n\n", runs.len());
    text.push_str(&ends(runs));
    text.push_str(&causes(&watched));
    text.push_str(&effort(&watched));
    text.push_str(&by_stiffness(runs));
    text.push_str(&invariants(&watched));
    text
}

fn ends(runs: &[(Slope, Watched)]) -> String {
    let drives = [Drive::Gravity, Drive::Reduction, Drive::WeakerSoil];
    let mut counts: BTreeMap<End, [usize; 3]> = BTreeMap::new();
    for (slope, watched) in runs {
        for (column, &drive) in drives.iter().enumerate() {
            counts.entry(watched.end).or_default()[column] += usize::from(slope.drive == drive);
        }
    }
    let mut text = "| end of the run | gravity raised | strength reduced | gravity anew on weaker soil | all |\n\
         |---|---|---|---|---|\n"
        .to_owned();
    for (end, [a, b, c]) in counts {
        let _ = writeln!(
            text,
            "| {} | {a} | {b} | {c} | {} |",
            end.label(),
            a + b + c
        );
    }
    text + "\n"
}

pub(crate) fn causes(runs: &[&Watched]) -> String {
    let mut counts: BTreeMap<&str, [usize; 2]> = BTreeMap::new();
    for cut in runs.iter().filter_map(|watched| watched.cut) {
        let [all, close] = counts.entry(cut.cause).or_default();
        *all += 1;
        *close += usize::from(cut.closest < ALL_BUT_CONVERGED);
    }
    let mut text = format!(
        "| why the last step found no equilibrium | runs | of these with a residual below {} |\n\
         |---|---|---|\n",
        short(ALL_BUT_CONVERGED)
    );
    for (cause, [all, close]) in counts {
        let _ = writeln!(text, "| {cause} | {all} | {close} |");
    }
    text + "\n"
}

/// Median, 90 % and largest of the effort of runs.
pub(crate) fn effort(runs: &[&Watched]) -> String {
    let each =
        |of: &dyn Fn(&Watched) -> f64| -> Vec<f64> { runs.iter().map(|run| of(run)).collect() };
    let all: Vec<f64> = runs.iter().flat_map(|run| corrections(run)).collect();
    let rows = [
        ("particles", each(&|run| run.particles as f64)),
        (
            "accepted steps of a run",
            each(&|run| run.effort.corrections.len() as f64),
        ),
        ("cuts of a run", each(&|run| run.effort.cuts as f64)),
        ("corrections of an accepted step", all),
        (
            "steps of a run at round-off",
            each(&|run| run.effort.at_round_off as f64),
        ),
        ("seconds of a run, one thread", each(&|run| run.seconds)),
    ];
    let mut text = "| | median | 90 % | most |\n|---|---|---|---|\n".to_owned();
    for (name, values) in rows {
        let [median, ninety, most] = spread(&values).map(short);
        let _ = writeln!(text, "| {name} | {median} | {ninety} | {most} |");
    }
    text + "\n"
}

/// How stiffness against strength tells.
fn by_stiffness(runs: &[(Slope, Watched)]) -> String {
    let mut text =
        "| E/c | runs | accepted steps | at round-off | largest residual of these | cuts | \
         stopped with a residual below 1e-6 |\n|---|---|---|---|---|---|---|\n"
            .to_owned();
    let mut low = 10.0;
    for high in CLASSES {
        let class: Vec<&Watched> = runs
            .iter()
            .filter(|(slope, _)| (low..high).contains(&slope.stiffness))
            .map(|(_, watched)| watched)
            .collect();
        let sum = |of: &dyn Fn(&Watched) -> usize| class.iter().map(|run| of(run)).sum::<usize>();
        let worst = class
            .iter()
            .map(|run| run.effort.worst_at_round_off)
            .fold(0.0, f64::max);
        let worst = if worst > 0.0 {
            format!("{worst:.0e}")
        } else {
            "-".to_owned()
        };
        let _ = writeln!(
            text,
            "| {low:.0e} to {high:.0e} | {} | {} | {} | {worst} | {} | {} |",
            class.len(),
            sum(&|run| run.effort.corrections.len()),
            sum(&|run| run.effort.at_round_off),
            sum(&|run| run.effort.cuts),
            sum(&|run| usize::from(run.cut.is_some_and(|cut| cut.closest < ALL_BUT_CONVERGED))),
        );
        low = high;
    }
    text + "\n"
}

/// The rules of every run, and how many runs broke them.
pub(crate) fn invariants(runs: &[&Watched]) -> String {
    let count = |of: &dyn Fn(&Watched) -> bool| runs.iter().filter(|run| of(run)).count();
    let sum = |of: &dyn Fn(&Watched) -> usize| runs.iter().map(|run| of(run)).sum::<usize>();
    format!(
        "| asked of every run | did not |\n|---|---|\n\
         | ends, with a reason | {} of {all} |\n\
         | does not panic | {} of {all} |\n\
         | keeps to its budget of corrections and time | {} of {all} |\n\
         | accepts no step above the tolerance that is not at round-off | {} of {} steps, {} of them computed again |\n",
        count(&|run| matches!(run.end, End::Hangs | End::Refused) || run.reason.is_empty()),
        count(&|run| run.end == End::Panics),
        count(&|run| matches!(run.end, End::Budget | End::Hangs)),
        sum(&|run| run.effort.violations.len()),
        sum(&|run| run.effort.corrections.len()),
        sum(&|run| run.effort.rechecked),
        all = runs.len(),
    )
}

/// One row a footing.
pub(crate) fn footings_csv(runs: &[(Footing, Watched)]) -> String {
    let mut text = format!(
        "e_over_su,poisson,cells_per_width,particles,depth_reached,n_at_0.2,n_at_0.5,n_at_1.0,{EFFORT}\n"
    );
    for (footing, watched) in runs {
        let [a, b, c] = DEPTHS.map(|depth| resistance_at(&watched.curves, depth));
        let _ = writeln!(
            text,
            "{},{},{},{},{:.4},{a:.4},{b:.4},{c:.4},{}",
            footing.stiffness,
            footing.poisson,
            footing.cells_per_width,
            watched.particles,
            depth_reached(&watched.curves),
            effort_csv(watched),
        );
    }
    text
}

/// A row a footing, and the rules for all.
pub(crate) fn footings(runs: &[(Footing, Watched)]) -> String {
    let mut text = String::new();
    if let Some((footing, watched)) = runs.first() {
        let _ = writeln!(
            text,
            "B/h = {}, {} particles, {} steps when none is cut.\n",
            footing.cells_per_width, watched.particles, footing.steps
        );
    }
    text.push_str(
        "| E/s_u | ν | w/B reached | N at 0.2B | N at 0.5B | N at 1B | steps | cuts | corrections: median | 90 % | most | at round-off | end |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for (footing, watched) in runs {
        let number = |value: f64| {
            if value.is_finite() {
                format!("{value:.2}")
            } else {
                "-".to_owned()
            }
        };
        let [a, b, c] = DEPTHS.map(|depth| number(resistance_at(&watched.curves, depth)));
        let [median, ninety, most] = spread(&corrections(watched)).map(short);
        let end = match watched.cut {
            Some(cut) => format!("{}: {}", watched.end.label(), cut.cause),
            None => watched.end.label().to_owned(),
        };
        let _ = writeln!(
            text,
            "| {} | {} | {:.2} | {a} | {b} | {c} | {} | {} | {median} | {ninety} | {most} | {} | {end} |",
            footing.stiffness,
            footing.poisson,
            depth_reached(&watched.curves),
            watched.effort.corrections.len(),
            watched.effort.cuts,
            watched.effort.at_round_off,
        );
    }
    text.push('\n');
    let watched: Vec<&Watched> = runs.iter().map(|(_, watched)| watched).collect();
    text.push_str(&invariants(&watched));
    text
}
