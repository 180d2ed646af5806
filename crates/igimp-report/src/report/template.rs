//! Templates of pages, filled in.

use minijinja::value::Serde;
use minijinja::{Environment, Value};
use serde::Serialize;

/// How pages look, on screens and on paper.
const STYLE: &str = include_str!("style.css");

/// Parts that all pages share: head, contents, pictures and warnings.
const PARTS: &str = include_str!("parts.html");

/// A template with its values; those of HTML are escaped.
pub(super) fn filled(
    name: &str,
    template: &str,
    values: impl Serialize,
) -> Result<String, minijinja::Error> {
    let mut environment = Environment::new();
    environment.add_template("style.css", STYLE)?;
    environment.add_template("parts.html", PARTS)?;
    environment.add_template(name, template)?;
    environment
        .get_template(name)?
        .render(Value::from(Serde(values)))
}
