//! Words of the formats, for mutations that keep near to what is understood.

use igimp_schema::{Dimension, json_schema};
use serde_json::Value;

const DIMENSIONS: [Dimension; 9] = [
    Dimension::Length,
    Dimension::Stress,
    Dimension::UnitWeight,
    Dimension::Angle,
    Dimension::Acceleration,
    Dimension::ForcePerLength,
    Dimension::MassDensity,
    Dimension::Force,
    Dimension::Area,
];

/// Every dimension that a quantity may have.
pub fn dimensions() -> impl Iterator<Item = Dimension> {
    DIMENSIONS.into_iter()
}

/// Units and what stands around them.
pub fn of_quantities() -> Vec<String> {
    let marks = [
        "²", "³", "^2", "**3", "°", "\u{a0}", " / ", "e5", "nan", "inf", "+", "--", "_", "5/3",
    ];
    let units = dimensions().flat_map(Dimension::units);
    units.chain(marks).map(str::to_owned).collect()
}

/// Keys and choices of case files, values of every type, units.
pub fn of_cases() -> Vec<String> {
    let mut words = Vec::new();
    collect(&json_schema(), &mut words);
    let values = [
        "true",
        "[]",
        "{}",
        "[[]]",
        "\"\"",
        "[\"0 m\", \"1 m\"]",
        "{ x = \"1 m\", y = \"1 m\" }",
        "1979-05-27",
        "'''\n'''",
        "\"1/9 m\"",
        "\"1e308 m\"",
        "\"-1 kPa\"",
        "\"\\u001b[2J\"",
        "\"../x\"",
        "[[stages]]\n",
        "[[bodies]]\n",
        "\n#set ",
        "=",
        "name = \"b\"\n",
        "\u{feff}",
        "\r\n",
    ];
    words.extend(values.map(str::to_owned));
    words.extend(dimensions().map(|dimension| format!("\"{}\"", dimension.example())));
    words.sort();
    words.dedup();
    words
}

/// Names of properties and choices of a JSON Schema, the latter also in quotes.
fn collect(schema: &Value, words: &mut Vec<String>) {
    match schema {
        Value::Object(entries) => {
            for (key, value) in entries {
                match (key.as_str(), value) {
                    ("properties", Value::Object(properties)) => {
                        words.extend(properties.keys().cloned());
                    }
                    ("enum", Value::Array(choices)) => {
                        words.extend(choices.iter().map(ToString::to_string));
                    }
                    ("const", choice) => words.push(choice.to_string()),
                    _ => {}
                }
                collect(value, words);
            }
        }
        Value::Array(items) => items.iter().for_each(|item| collect(item, words)),
        _ => {}
    }
}

/// Words of manifests and of the headers of arrays.
pub fn of_checkpoints() -> Vec<String> {
    [
        "'descr'",
        "'fortran_order'",
        "'shape'",
        "True",
        "False",
        "'<f8'",
        "'<u8'",
        "'<i4'",
        "'|u1'",
        "'>f8'",
        "'<f4'",
        "(2,)",
        "(2, 2)",
        "(2, 3, 3)",
        "()",
        "(0,)",
        "(1152921504606846976,)",
        "(9223372036854775807, 2, 0)",
        "{",
        "}",
        "\"format\"",
        "\"states\"",
        "\"files\"",
        "\"current\"",
        "\"..\"",
        "\"/\"",
        "null",
        "{}",
        "[]",
        "\"sha256\"",
        "\"bytes\"",
        "\"particles\"",
        "\"load_points\"",
        "\"data\"",
        "1e999",
        "[[[[[[[[[[[[[[[[",
        "\"\\ud800\"",
        "x.npy",
    ]
    .map(str::to_owned)
    .to_vec()
}
