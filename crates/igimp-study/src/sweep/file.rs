//! Reads a sweep file; every problem is reported with its place.

use std::ops::Range;
use std::path::{Path, PathBuf};

use igimp_input::shipped::closest;
use igimp_schema::syntax::toml_text::{self, quoted};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::{Sweep, SweepError, Task};

/// Most tasks of a study; more are a slip of the keyboard.
const MOST_TASKS: usize = 100_000;

/// A problem, its place and its help.
struct Problem {
    at: Range<usize>,
    message: String,
    help: String,
}

impl Problem {
    fn new(at: Range<usize>, message: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            at,
            message: message.into(),
            help: help.into(),
        }
    }

    /// The message with the line of the file and a mark below the place.
    fn render(&self, name: &str, text: &str) -> String {
        let start = self.at.start.min(text.len());
        let before = &text[..start];
        let number = before.matches('\n').count() + 1;
        let line_start = before.rfind('\n').map_or(0, |end| end + 1);
        let line = text[line_start..].lines().next().unwrap_or("");
        let column = text[line_start..start].chars().count();
        let rest = line.chars().count().saturating_sub(column).max(1);
        let marked = text
            .get(self.at.clone())
            .map_or(1, |text| text.lines().next().unwrap_or("").chars().count());
        let gutter = " ".repeat(number.to_string().len());
        let mark = "^".repeat(marked.clamp(1, rest));
        let mut out = format!(
            "error: {}\n{gutter} --> {name}:{number}:{}\n{gutter} |\n{number} | {line}\n\
             {gutter} | {}{mark}",
            self.message,
            column + 1,
            " ".repeat(column)
        );
        if !self.help.is_empty() {
            out.extend(["\n", &gutter, " = help: ", &self.help]);
        }
        out
    }
}

/// One parameter and its values, as TOML.
struct Parameter {
    key: String,
    at: Range<usize>,
    values: Vec<String>,
}

/// Reads the text of a sweep file; `base` is the folder of the file.
pub(super) fn parse(name: &str, text: &str, base: &Path) -> Result<Sweep, SweepError> {
    let invalid = |problem: &Problem| SweepError::Invalid {
        text: problem.render(name, text),
    };
    let table = DeTable::parse(text).map_err(|error| {
        let at = error.span().unwrap_or(0..0);
        invalid(&Problem::new(at, error.message(), ""))
    })?;
    read(table.get_ref(), base).map_err(|problem| invalid(&problem))
}

fn read(table: &DeTable<'_>, base: &Path) -> Result<Sweep, Problem> {
    let known = [
        "igimp_sweep",
        "case",
        "parameters",
        "combine",
        "output",
        "collect",
    ];
    only(table, &known)?;
    let version = need(table, "igimp_sweep", "igimp_sweep = 1", 0..0)?;
    if !matches!(version.get_ref(), DeValue::Integer(value) if value.as_str() == "1") {
        return Err(Problem::new(
            version.span(),
            "this version of sweep files is not known",
            "write igimp_sweep = 1",
        ));
    }
    let case = string(need(table, "case", "case = \"slope.toml\"", 0..0)?)?;
    let help = "[output]\nfolder = \"results/sweep\"".replace('\n', " ");
    let output = need(table, "output", &help, 0..0)?;
    let DeValue::Table(output_table) = output.get_ref() else {
        return Err(Problem::new(output.span(), "`output` is not a table", help));
    };
    only(output_table, &["folder"])?;
    let folder = string(need(output_table, "folder", &help, output.span())?)?;
    let folder = PathBuf::from(folder);
    let collect = table.get("collect").map_or(Ok(Vec::new()), |value| {
        let DeValue::Array(items) = value.get_ref() else {
            let help = "write a list, like [\"factor_of_safety\"]";
            return Err(Problem::new(value.span(), "`collect` is not a list", help));
        };
        items.iter().map(string).collect()
    })?;

    let help = "[parameters] materials.clay.cohesion = [\"8 kPa\", \"10 kPa\"]";
    let place = need(table, "parameters", help, 0..0)?;
    let mut parameters = Vec::new();
    flatten("", place, &mut parameters)?;
    parameters.sort_by_key(|parameter| parameter.at.start);
    if parameters.is_empty() {
        return Err(Problem::new(place.span(), "there are no parameters", help));
    }
    let choices = combine(table.get("combine"), &parameters)?;
    let keys: Vec<String> = parameters.iter().map(|one| one.key.clone()).collect();
    let tasks = choices
        .into_iter()
        .enumerate()
        .map(|(index, choice)| task(index + 1, &choice, &parameters, &folder))
        .collect();
    Ok(Sweep {
        file: PathBuf::new(),
        case: base.join(case),
        folder,
        collect,
        keys,
        tasks,
        date: None,
        given_solver: None,
    })
}

fn task(number: usize, choice: &[usize], parameters: &[Parameter], folder: &Path) -> Task {
    let values: Vec<String> = parameters
        .iter()
        .zip(choice)
        .map(|(parameter, &index)| parameter.values[index].clone())
        .collect();
    let settings = parameters
        .iter()
        .zip(&values)
        .map(|(parameter, value)| format!("{}={value}", parameter.key))
        .collect();
    Task {
        number,
        values,
        settings,
        folder: folder.join(format!("task-{number:04}")),
    }
}

/// For each task, which value each parameter takes.
fn combine(
    how: Option<&Spanned<DeValue<'_>>>,
    parameters: &[Parameter],
) -> Result<Vec<Vec<usize>>, Problem> {
    let word = how.map(string).transpose()?;
    match word.as_deref() {
        None | Some("grid") => {
            let count = parameters
                .iter()
                .try_fold(1_usize, |n, parameter| {
                    n.checked_mul(parameter.values.len())
                })
                .filter(|&count| count <= MOST_TASKS);
            let Some(count) = count else {
                return Err(Problem::new(
                    parameters[0].at.clone(),
                    format!("more than {MOST_TASKS} combinations"),
                    "fewer values, or combine = \"zip\"",
                ));
            };
            Ok((0..count)
                .map(|mut rest| {
                    let mut choice = vec![0; parameters.len()];
                    for (slot, parameter) in choice.iter_mut().zip(parameters).rev() {
                        *slot = rest % parameter.values.len();
                        rest /= parameter.values.len();
                    }
                    choice
                })
                .collect())
        }
        Some("zip") => {
            let many = |one: &&Parameter| one.values.len() > 1;
            let Some(first) = parameters.iter().find(many) else {
                return Ok(vec![vec![0; parameters.len()]]);
            };
            let count = first.values.len();
            let odd = |one: &&Parameter| many(one) && one.values.len() != count;
            match parameters.iter().find(odd) {
                None => Ok((0..count)
                    .map(|k| (parameters.iter().map(|one| k.min(one.values.len() - 1))).collect())
                    .collect()),
                Some(odd) => Err(Problem::new(
                    odd.at.clone(),
                    format!(
                        "`{}` has {} values, but `{}` has {count}",
                        odd.key,
                        odd.values.len(),
                        first.key
                    ),
                    "with combine = \"zip\" all parameters have as many values, or one",
                )),
            }
        }
        Some(other) => Err(Problem::new(
            how.map_or(0..0, Spanned::span),
            format!("`{other}` is no way to combine"),
            "grid (every combination) or zip (first with first, second with second)",
        )),
    }
}

/// Collects `a.b.c = [values]`, written with dots or as tables.
fn flatten(
    prefix: &str,
    value: &Spanned<DeValue<'_>>,
    out: &mut Vec<Parameter>,
) -> Result<(), Problem> {
    let help = "write a list, like [\"8 kPa\", \"10 kPa\"]";
    match value.get_ref() {
        DeValue::Table(table) => {
            for (key, inner) in table {
                let key = if prefix.is_empty() {
                    // A path in quotes, "grid.cell", is as good as grid.cell.
                    key.get_ref().to_string()
                } else {
                    format!("{prefix}.{}", toml_text::key(key.get_ref()))
                };
                flatten(&key, inner, out)?;
            }
            Ok(())
        }
        DeValue::Array(items) if items.is_empty() => Err(Problem::new(
            value.span(),
            format!("`{prefix}` has no values"),
            help,
        )),
        DeValue::Array(items) => {
            out.push(Parameter {
                key: prefix.to_owned(),
                at: value.span(),
                values: items.iter().map(|item| as_toml(item.get_ref())).collect(),
            });
            Ok(())
        }
        _ => Err(Problem::new(
            value.span(),
            format!("`{prefix}` is not a list of values"),
            help,
        )),
    }
}

/// A value as it is written in TOML, on one line.
fn as_toml(value: &DeValue<'_>) -> String {
    let list = |items: Vec<String>| items.join(", ");
    match value {
        DeValue::String(text) => quoted(text),
        DeValue::Integer(number) => number.to_string(),
        DeValue::Float(number) => number.to_string(),
        DeValue::Boolean(flag) => flag.to_string(),
        DeValue::Datetime(time) => time.to_string(),
        DeValue::Array(items) => {
            let items = items.iter().map(|item| as_toml(item.get_ref())).collect();
            format!("[{}]", list(items))
        }
        DeValue::Table(table) => {
            let entries = table
                .iter()
                .map(|(key, value)| format!("{} = {}", key.get_ref(), as_toml(value.get_ref())))
                .collect();
            format!("{{ {} }}", list(entries))
        }
    }
}

fn need<'a, 't>(
    table: &'a DeTable<'t>,
    key: &str,
    help: &str,
    at: Range<usize>,
) -> Result<&'a Spanned<DeValue<'t>>, Problem> {
    table
        .get(key)
        .ok_or_else(|| Problem::new(at, format!("`{key}` is missing"), format!("write {help}")))
}

fn string(value: &Spanned<DeValue<'_>>) -> Result<String, Problem> {
    match value.get_ref() {
        DeValue::String(text) => Ok(text.to_string()),
        _ => Err(Problem::new(value.span(), "expected text in quotes", "")),
    }
}

/// Refuses keys that are not known.
fn only(table: &DeTable<'_>, known: &[&str]) -> Result<(), Problem> {
    let odd = table
        .keys()
        .filter(|key| !known.contains(&key.get_ref().as_ref()))
        .min_by_key(|key| key.span().start);
    odd.map_or(Ok(()), |key| {
        let name = key.get_ref();
        let help = closest(name, known.iter().copied()).map_or_else(
            || format!("known: {}", known.join(", ")),
            |near| format!("did you mean `{near}`?"),
        );
        Err(Problem::new(
            key.span(),
            format!("unknown field `{name}`"),
            help,
        ))
    })
}
