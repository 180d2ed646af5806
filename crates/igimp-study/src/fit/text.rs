//! The text on parameters that were found: lines, rows and TOML.

use std::fmt::Write as _;

use igimp_text::short;

use super::parameter::written;
use super::{Fitted, Found, Known};

/// The lines of a fit.
pub(super) fn of(fitted: &Fitted) -> String {
    let [iterations, evaluations] = fitted.effort;
    let mut text = format!(
        "{}, {}\n  converged after {iterations} iterations, {evaluations} evaluations\n",
        fitted.title,
        from(fitted),
    );
    if fitted.has_kink {
        let _ = writeln!(text, "  {KINK}");
    }
    for found in &fitted.parameters {
        let _ = writeln!(text, "  {}", line(found, &fitted.parameters));
    }
    for pair in pairs(fitted) {
        let _ = writeln!(text, "  {pair}");
    }
    for (tested, at) in fitted.tests.iter().zip(1..) {
        let title = tested.text.lines().next().unwrap_or_default();
        let _ = writeln!(text, "  test {at}, {title}");
        for line in tested.compared.iter().flat_map(|data| lines(&data.text())) {
            let _ = writeln!(text, "  {line}");
        }
    }
    let _ = write!(text, "\n{}", fitted.block);
    text
}

/// The remark where the best values have a measurement at the beginning of yield.
pub(super) const KINK: &str = "the least sum of squares is at a kink, as where soil begins to yield at a measurement: errors are rough";

/// How many parameters come from how many data.
pub(super) fn from(fitted: &Fitted) -> String {
    format!(
        "{} from {}, {} values",
        counted(fitted.parameters.len(), "parameter"),
        counted(fitted.tests.len(), "test"),
        fitted.values,
    )
}

/// Pairs that are not told apart.
pub(super) fn pairs(fitted: &Fitted) -> Vec<String> {
    let key = |place: usize| &fitted.parameters[place].key;
    (fitted.correlated().into_iter())
        .map(|(one, other, correlation)| {
            format!(
                "{} and {} are not told apart by these data: correlation {correlation:.4}",
                key(one),
                key(other),
            )
        })
        .collect()
}

/// A correlation with so many places; empty where there is none.
pub(super) fn correlation(value: f64, places: usize) -> String {
    if value.is_finite() {
        format!("{value:.places$}")
    } else {
        String::new()
    }
}

fn lines(text: &str) -> Vec<String> {
    text.lines().map(str::to_owned).collect()
}

fn counted(count: usize, noun: &str) -> String {
    let more = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{more}")
}

/// A line for a parameter.
pub(super) fn line(found: &Found, all: &[Found]) -> String {
    let Found {
        key, unit, value, ..
    } = found;
    match &found.known {
        Known::Well {
            error,
            interval: [low, high],
        } => format!(
            "{key} = {} {unit}, standard error {} {unit}, with 95 % from {} to {} {unit}",
            digits(*value, *error),
            short(*error),
            digits(*low, *error),
            digits(*high, *error),
        ),
        Known::AtBound { upper } => format!(
            "{key} = {} {unit}: at its {} bound, which decides on it and not the data",
            short(*value),
            if *upper { "upper" } else { "lower" },
        ),
        Known::AtWall { upper } => format!(
            "{key} = {} {unit}: the {} value that its law and the tests accept beside the others, which decides on it and not the data",
            short(*value),
            if *upper { "greatest" } else { "least" },
        ),
        Known::NotDetermined { with } if with.is_empty() => {
            format!("{key}: not determined, these data do not depend on it")
        }
        Known::NotDetermined { with } => {
            let others: Vec<&str> = with.iter().map(|&k| all[k].key.as_str()).collect();
            let others = others.join(" and ");
            format!("{key}: not determined, {key} and {others} are not told apart by these data")
        }
    }
    .replace(" ,", ",")
    .replace(" :", ":")
    .trim_end()
    .to_owned()
}

/// A value with the digits that its error leaves, and one more.
pub(super) fn digits(value: f64, error: f64) -> String {
    let size = value.abs().max(f64::MIN_POSITIVE).log10().floor();
    let places = (1.0
        - error
            .max(1e-12 * value.abs())
            .max(f64::MIN_POSITIVE)
            .log10()
            .floor())
    .clamp(-size, 15.0 - size.max(0.0));
    if (0.0..=15.0).contains(&places) {
        format!("{value:.*}", places as usize)
    } else {
        short(value)
    }
}

/// The row of a parameter in `fit.csv`.
pub(super) fn row(found: &Found) -> Vec<String> {
    let number = |value: f64| format!("{value:.9e}");
    let mut row = vec![found.key.clone(), found.unit.clone(), number(found.start)];
    let (values, known) = match &found.known {
        Known::Well {
            error,
            interval: [low, high],
        } => (
            [found.value, *error, *low, *high].map(number),
            "standard error",
        ),
        Known::AtBound { .. } | Known::AtWall { .. } => {
            let known = match found.known {
                Known::AtBound { upper: true } => "at its upper bound",
                Known::AtBound { .. } => "at its lower bound",
                Known::AtWall { upper: true } => "greatest that is accepted",
                _ => "least that is accepted",
            };
            let none = String::new;
            ([number(found.value), none(), none(), none()], known)
        }
        Known::NotDetermined { .. } => ([(); 4].map(|()| String::new()), "not determined"),
    };
    row.extend(values);
    row.push(known.to_owned());
    row
}

/// The values as a block of a case file; undetermined ones are left out.
pub(super) fn block(material: &str, found: &[Found]) -> String {
    let mut text = format!("[materials.{}]\n", quoted(material));
    for parameter in found {
        let key = &parameter.key;
        let value = match &parameter.known {
            Known::NotDetermined { .. } => {
                let _ = writeln!(text, "# {key} is not determined");
                continue;
            }
            Known::Well { error, .. } => digits(parameter.value, error / 100.0),
            Known::AtBound { .. } | Known::AtWall { .. } => parameter.value.to_string(),
        };
        let number = value.parse().unwrap_or(parameter.value);
        let value = written(number, &parameter.unit);
        let value = if parameter.unit.is_empty() {
            value
        } else {
            format!("\"{value}\"")
        };
        let _ = writeln!(text, "{key} = {value}");
    }
    text
}

/// A name as a key of TOML.
pub(super) fn quoted(name: &str) -> String {
    let is_bare = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
    if !name.is_empty() && name.chars().all(is_bare) {
        name.to_owned()
    } else {
        format!("{name:?}")
    }
}
