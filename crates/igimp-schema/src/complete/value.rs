//! Checks single values against their kind: texts, numbers, quantities, choices.

use super::Completer;
use crate::names::check_name;
use crate::quantity::{Dimension, Quantity, QuantityError};
use crate::spec::{Bodies, Kind, Range};
use crate::text::{clip, row};
use crate::tree::{Node, Value};

/// A single value, checked.
pub(crate) fn check_value(
    completer: &mut Completer<'_>,
    node: &Node,
    kind: &'static Kind,
    key: &str,
) -> Node {
    let checked = match (kind, &node.value) {
        (Kind::Text | Kind::Reference(_), Value::Text(_)) | (Kind::Flag, Value::Flag(_)) => {
            Some(node.clone())
        }
        (Kind::Name, Value::Text(text)) => {
            check_name(text, node.place, completer.problems).then(|| node.clone())
        }
        (Kind::Integer(least, most), Value::Integer(value)) => {
            integer_between(completer, node, *value, [*least, *most], key)
        }
        (Kind::IntegerOf(choices), Value::Integer(value)) => {
            integer_of(completer, node, *value, choices, key)
        }
        (Kind::Integer(..) | Kind::IntegerOf(_), Value::Number(_)) => {
            let message = format!("`{}` is not a whole number", completer.slice(node.place));
            completer.problems.error(node.place, message);
            None
        }
        (Kind::Number(range), Value::Integer(_) | Value::Number(_)) => {
            plain_number(completer, node, *range, key)
        }
        (Kind::AnyQuantity, Value::Integer(_) | Value::Number(_)) => {
            plain_number(completer, node, Range::Any, key)
        }
        (Kind::Quantity(dimension, range), Value::Text(text)) => {
            quantity(completer, (node, text), *dimension, *range, key)
        }
        (Kind::AnyQuantity, Value::Text(text)) => any_quantity(completer, node, text),
        (Kind::Quantity(dimension, _), Value::Integer(_) | Value::Number(_)) => {
            let text = completer.slice(node.place);
            let error = QuantityError::NoUnit { text };
            refuse(completer, node, &error, Some(*dimension))
        }
        (Kind::Choice(choices), Value::Text(text)) => {
            if choices.iter().any(|choice| choice.name == text) {
                return node.clone();
            }
            let names = choices.iter().map(|choice| choice.name).collect();
            completer.unknown_choice(node, text, key, names);
            None
        }
        _ => return completer.wrong_type(node, kind, key),
    };
    checked.unwrap_or_else(|| Node::invalid(node.place))
}

/// A whole number between two bounds.
fn integer_between(
    completer: &mut Completer<'_>,
    node: &Node,
    value: i64,
    [least, most]: [i64; 2],
    key: &str,
) -> Option<Node> {
    if (least..=most).contains(&value) {
        return Some(node.clone());
    }
    let message = if most == i64::MAX || value < least {
        format!("`{key}` must be at least {least}, but is {value}")
    } else {
        format!("`{key}` must be at most {most}, but is {value}")
    };
    completer.problems.error(node.place, message);
    None
}

/// A whole number that is one of several.
fn integer_of(
    completer: &mut Completer<'_>,
    node: &Node,
    value: i64,
    choices: &[i64],
    key: &str,
) -> Option<Node> {
    if choices.contains(&value) {
        return Some(node.clone());
    }
    let names: Vec<_> = choices.iter().map(ToString::to_string).collect();
    completer
        .problems
        .error(node.place, format!("`{value}` is not a choice for `{key}`"))
        .help(format!(
            "choices: {}",
            row(names.iter().map(String::as_str))
        ));
    None
}

/// A number without a unit.
fn plain_number(
    completer: &mut Completer<'_>,
    node: &Node,
    range: Range,
    key: &str,
) -> Option<Node> {
    let value = node.number().unwrap_or(f64::NAN);
    in_range(completer, node, value, range, key).map(|_| node.clone())
}

/// A number with a unit of a dimension.
fn quantity(
    completer: &mut Completer<'_>,
    (node, text): (&Node, &str),
    dimension: Dimension,
    range: Range,
    key: &str,
) -> Option<Node> {
    match Quantity::parse_as(text, dimension) {
        Ok(value) => {
            let value = in_range(completer, node, value, range, key)?;
            let value = Value::Quantity(value, text.to_owned());
            Some(Node { value, ..*node })
        }
        Err(error) => refuse(completer, node, &error, Some(dimension)),
    }
}

/// A number with a unit of any dimension.
fn any_quantity(completer: &mut Completer<'_>, node: &Node, text: &str) -> Option<Node> {
    match Quantity::parse(text) {
        Ok(quantity) if quantity.dimension.is_some() => {
            let value = Value::Quantity(quantity.value, text.to_owned());
            Some(Node { value, ..*node })
        }
        Ok(_) => {
            let message = format!("`{}` has no unit", clip(text, 40));
            completer
                .problems
                .error(node.place, message)
                .help("write a plain number without quotes, or add a unit, like \"25 kPa\"");
            None
        }
        Err(error) => refuse(completer, node, &error, None),
    }
}

/// The value, if it lies in its range; reports it otherwise.
fn in_range(
    completer: &mut Completer<'_>,
    node: &Node,
    value: f64,
    range: Range,
    key: &str,
) -> Option<f64> {
    if range.holds(value) {
        return Some(value);
    }
    let text = completer.slice(node.place);
    let text = text.trim_matches('"');
    let requirement = if value.is_finite() {
        range.requirement()
    } else {
        Range::Any.requirement()
    };
    completer.problems.error(
        node.place,
        format!("`{key}` must be {requirement}, but is {text}"),
    );
    None
}

fn refuse(
    completer: &mut Completer<'_>,
    node: &Node,
    error: &QuantityError,
    dimension: Option<Dimension>,
) -> Option<Node> {
    // Keys of forces per metre run that an analysis of revolution reads are those of loads at a point and of reinforcement.
    let is_at_circle = completer.bodies == Bodies::Revolution
        && matches!(
            error,
            QuantityError::WrongKind {
                expected: Dimension::ForcePerLength,
                found: Dimension::Force,
                ..
            }
        );
    let help = if is_at_circle {
        "around an axis a force at a point or along a line would go along a whole circle: state a pressure over an area"
            .to_owned()
    } else {
        error.help(dimension)
    };
    completer
        .problems
        .error(node.place, error.to_string())
        .help(help);
    None
}
