//! The lines of a test.

use std::fmt::Write as _;

use igimp_solver::element::ElementState;
use igimp_text::short;

use super::table;
use super::values::KeyValues;
use super::{Request, Tested};

/// Of a material that varies in its case.
pub(super) const VARIES: &str = "strength or stiffness vary: the greatest in the soil count, in a file of materials alone those at the top of a gradient";
/// Of a strength that is a share of the vertical effective stress.
pub(super) const BY_STRESS: &str = "cu by the vertical stress that the test begins with:";
/// Of a law that takes the place of that of the file.
pub(super) const GIVEN: &str = "the law takes the place of that of the file:";
/// Of a material that is undrained in its case.
pub(super) const UNDRAINED: &str = "stresses are effective ones; an undrained test keeps the volume, whatever the water's stiffness";

/// Of a duration that the law does not know.
pub(super) const TIMELESS: &str =
    "the duration has no effect: this strength does not go with the rate of strain";
/// Of strength that falls with plastic strain, in a test that ended early.
const BRITTLE: &str = "strength that falls fast over plastic strain can snap back in a test that holds stresses: state a longer strain, \
    or shear it with --test simple-shear-drained";

/// The lines of a test, ready to print.
pub(super) fn of(tested: &Tested) -> String {
    let (request, states) = (&tested.request, &tested.run.states);
    let [axial, side] = request.stress.map(|stress| short(stress / 1e3));
    let steps = states.len() - 1;
    let corrections: usize = states.iter().map(|state| state.corrections).sum();
    let mut text = format!(
        "{}\n  from σ_y = {axial} kPa, σ_x = σ_z = {side} kPa, {steps} steps, {corrections} corrections\n",
        tested.title
    );
    for note in tested.notes() {
        let _ = writeln!(text, "  {note}");
    }
    text.push_str(&values(&tested.values, request, states));
    for line in ending(tested) {
        let _ = writeln!(text, "  {line}");
    }
    if let Some(compared) = &tested.compared {
        text.push_str(&compared.text());
    }
    text
}

/// Why a test ended early; no lines where it did not.
pub(super) fn ending(tested: &Tested) -> Vec<String> {
    let Some(lost) = &tested.run.failure else {
        return Vec::new();
    };
    let because = lost.law.as_ref().map(|law| format!("because: {law}"));
    let curves = tested.material.softening;
    let is_brittle = curves.is_some_and(|curves| curves.goes_with_strain()) && because.is_none();
    [format!("ended early: {lost}")]
        .into_iter()
        .chain(because)
        .chain(is_brittle.then(|| BRITTLE.to_owned()))
        .collect()
}

/// The stress at failure by a formula, if there is one.
pub(super) fn closed(
    values: &KeyValues,
    request: &Request,
    states: &[ElementState],
) -> Option<String> {
    let form = values.closed.as_ref()?;
    let end = values.stress.of(states.last()?, &states[0], &request.drive);
    Some(format!(
        "closed form at failure: {} = {} kPa, {}; at the end {} % of it",
        values.symbol(),
        short(form.value / 1e3),
        form.from,
        short(100.0 * end / form.value),
    ))
}

/// Peak and end of a test, and its formula.
fn values(values: &KeyValues, request: &Request, states: &[ElementState]) -> String {
    let peak = &states[values.peak];
    let end = &states[states.len() - 1];
    let strain = table::abscissa(&request.drive);
    let percent = |state| short(100.0 * strain.of(state, &states[0], &request.drive));
    let stress = values.stress.of(peak, &states[0], &request.drive);
    let mut text = format!(
        "  largest {} {} kPa at {} % of {}\n",
        values.symbol(),
        short(stress / 1e3),
        percent(peak),
        table::driven_name(&request.drive),
    );
    let _ = writeln!(
        text,
        "  at the end, {} %: p {} kPa, q {} kPa, q/p {}, volumetric strain {} %, mobilised {}",
        percent(end),
        short(end.p() / 1e3),
        short(end.q() / 1e3),
        short(end.q() / end.p()),
        short(100.0 * end.volumetric_strain()),
        short(values.mobilised[2]),
    );
    if let Some(closed) = closed(values, request, states) {
        let _ = writeln!(text, "  {closed}");
    }
    text
}
