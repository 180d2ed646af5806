//! One measurement, from the two files that criterion leaves behind: `benchmark.json` says what was
//! measured, `estimates.json` how long it took.

use std::fs;
use std::path::Path;

use serde_json::Value;

use super::row::Row;
use crate::failure::Failure;

/// Reads a measurement; its value is the median time of one pass over its size.
pub(crate) fn read(benchmark: &Path, estimates: &Path) -> Result<Row, Failure> {
    let text = |path: &Path| {
        fs::read_to_string(path).map_err(|error| {
            Failure::input_output(format!("cannot read {}", path.display()), error)
        })
    };
    parse(&text(benchmark)?, &text(estimates)?).map_err(|missing| {
        let files = format!("{} and {}", benchmark.display(), estimates.display());
        Failure::input_output(files, missing)
    })
}

/// The measurement in the text of the two files; an error names the missing entry.
fn parse(benchmark: &str, estimates: &str) -> Result<Row, String> {
    let json = |text: &str| serde_json::from_str(text).map_err(|error| error.to_string());
    let (benchmark, estimates): (Value, Value) = (json(benchmark)?, json(estimates)?);
    let missing = |key: &str| format!("`{key}` is missing");
    let string = |key: &str| {
        let value = benchmark[key].as_str().map(str::to_owned);
        value.ok_or_else(|| missing(key))
    };
    let median = &estimates["median"];
    let bound = |key: &str| {
        let value = median["confidence_interval"][key].as_f64();
        value.ok_or_else(|| missing(key))
    };
    let size = benchmark["throughput"]["Elements"]
        .as_u64()
        .filter(|&size| size > 0)
        .ok_or_else(|| missing("throughput.Elements"))?;
    let time = median["point_estimate"]
        .as_f64()
        .ok_or_else(|| missing("median.point_estimate"))?;
    let group = string("group_id")?;
    let per_one = |time: f64| time / size as f64;
    Ok(Row {
        bench: string("function_id")?,
        size,
        unit: format!("ns/{}", counted(&group)),
        value: per_one(time),
        range: [bound("lower_bound")?, bound("upper_bound")?].map(per_one),
        group,
    })
}

/// The unit that the size of a group's benches counts.
fn counted(group: &str) -> &'static str {
    match group {
        "factorisation" => "unknown",
        "return_map" | "lift_small" | "lift_finite" => "state",
        _ => "particle",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BENCHMARK: &str = r#"{"group_id":"assembly","function_id":"von-mises/tangent",
        "value_str":"2500","throughput":{"Elements":2500},
        "full_id":"assembly/von-mises/tangent/2500",
        "directory_name":"assembly/von-mises_tangent/2500","title":"a"}"#;
    const ESTIMATES: &str = r#"{"mean":{"point_estimate":9.0},"median":{"confidence_interval":
        {"confidence_level":0.95,"lower_bound":1.2e6,"upper_bound":1.4e6},
        "point_estimate":1.25e6,"standard_error":1.0},"slope":null}"#;

    #[test]
    fn criterion_files_are_understood() {
        let found = parse(BENCHMARK, ESTIMATES).unwrap();
        let expected = Row {
            group: "assembly".to_owned(),
            bench: "von-mises/tangent".to_owned(),
            size: 2500,
            unit: "ns/particle".to_owned(),
            value: 500.0,
            range: [480.0, 560.0],
        };
        assert_eq!(found, expected);
    }

    #[test]
    fn missing_entries_are_named() {
        let without = BENCHMARK.replace("Elements", "Bytes");
        assert_eq!(
            parse(&without, ESTIMATES).unwrap_err(),
            "`throughput.Elements` is missing"
        );
        let empty = BENCHMARK.replace("{\"Elements\":2500}", "{\"Elements\":0}");
        assert!(parse(&empty, ESTIMATES).is_err());
        assert_eq!(
            parse(BENCHMARK, "{}").unwrap_err(),
            "`median.point_estimate` is missing"
        );
        assert!(parse(BENCHMARK, "not json").is_err());
    }

    #[test]
    fn factorisations_count_unknowns() {
        let benchmark = BENCHMARK.replace("\"assembly\"", "\"factorisation\"");
        assert_eq!(parse(&benchmark, ESTIMATES).unwrap().unit, "ns/unknown");
    }
}
