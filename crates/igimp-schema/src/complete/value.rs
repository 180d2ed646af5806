//! Checks single values against their kind: texts, numbers, quantities, choices.

use super::Completer;
use crate::names::check_name;
use crate::quantity::{Dimension, Quantity, QuantityError};
use crate::spec::{Kind, Range};
use crate::text::{clip, row};
use crate::tree::{Node, Value};

/// A single value, checked.
pub(crate) fn check_value(
    completer: &mut Completer<'_>,
    node: &Node,
    kind: &'static Kind,
    key: &str,
) -> Node {
    let fine = |value| Node { value, ..*node };
    match (kind, &node.value) {
        (Kind::Text | Kind::Reference(_), Value::Text(_)) | (Kind::Flag, Value::Flag(_)) => {
            node.clone()
        }
        (Kind::Name, Value::Text(text)) => {
            if check_name(text, node.place, completer.problems) {
                node.clone()
            } else {
                Node::invalid(node.place)
            }
        }
        (Kind::Integer(least, most), Value::Integer(value)) => {
            if (*least..=*most).contains(value) {
                return node.clone();
            }
            let message = if *most == i64::MAX || value < least {
                format!("`{key}` must be at least {least}, but is {value}")
            } else {
                format!("`{key}` must be at most {most}, but is {value}")
            };
            completer.problems.error(node.place, message);
            Node::invalid(node.place)
        }
        (Kind::IntegerOf(choices), Value::Integer(value)) => {
            if choices.contains(value) {
                return node.clone();
            }
            let names: Vec<_> = choices.iter().map(ToString::to_string).collect();
            completer
                .problems
                .error(node.place, format!("`{value}` is not a choice for `{key}`"))
                .help(format!(
                    "choices: {}",
                    row(names.iter().map(String::as_str))
                ));
            Node::invalid(node.place)
        }
        (Kind::Integer(..) | Kind::IntegerOf(_), Value::Number(_)) => {
            let text = completer.slice(node.place);
            completer
                .problems
                .error(node.place, format!("`{text}` is not a whole number"));
            Node::invalid(node.place)
        }
        (Kind::Number(range), Value::Integer(_) | Value::Number(_)) => {
            let value = node.number().unwrap_or(f64::NAN);
            in_range(completer, node, value, *range, key).map_or_else(
                || Node::invalid(node.place),
                |value| match node.value {
                    Value::Integer(_) => node.clone(),
                    _ => fine(Value::Number(value)),
                },
            )
        }
        (Kind::AnyQuantity, Value::Integer(_) | Value::Number(_)) => {
            let value = node.number().unwrap_or(f64::NAN);
            in_range(completer, node, value, Range::Any, key)
                .map_or_else(|| Node::invalid(node.place), |_| node.clone())
        }
        (Kind::Quantity(dimension, range), Value::Text(text)) => {
            match Quantity::parse_as(text, *dimension) {
                Ok(value) => in_range(completer, node, value, *range, key).map_or_else(
                    || Node::invalid(node.place),
                    |value| fine(Value::Quantity(value, text.clone())),
                ),
                Err(error) => refuse(completer, node, &error, Some(*dimension)),
            }
        }
        (Kind::AnyQuantity, Value::Text(text)) => match Quantity::parse(text) {
            Ok(quantity) if quantity.dimension.is_some() => {
                fine(Value::Quantity(quantity.value, text.clone()))
            }
            Ok(_) => {
                let message = format!("`{}` has no unit", clip(text, 40));
                completer
                    .problems
                    .error(node.place, message)
                    .help("write a plain number without quotes, or add a unit, like \"25 kPa\"");
                Node::invalid(node.place)
            }
            Err(error) => refuse(completer, node, &error, None),
        },
        (Kind::Quantity(dimension, _), Value::Integer(_) | Value::Number(_)) => {
            let error = QuantityError::NoUnit {
                text: completer.slice(node.place),
            };
            refuse(completer, node, &error, Some(*dimension))
        }
        (Kind::Choice(choices), Value::Text(text)) => {
            if choices.iter().any(|choice| choice.name == text) {
                return node.clone();
            }
            let names = choices.iter().map(|choice| choice.name).collect();
            completer.unknown_choice(node, text, key, names);
            Node::invalid(node.place)
        }
        _ => completer.wrong_type(node, kind, key),
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
) -> Node {
    completer
        .problems
        .error(node.place, error.to_string())
        .help(error.help(dimension));
    Node::invalid(node.place)
}
