//! One measurement, from the two files that criterion leaves behind: `benchmark.json` says what was
//! measured, `estimates.json` how long it took.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::failure::Failure;

/// A bench and its time.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Measurement {
    /// Group, such as `assembly`.
    pub(crate) group: String,
    /// Bench within the group, such as `von-mises/tangent`.
    pub(crate) bench: String,
    /// Particles, trial states or unknowns of one pass.
    pub(crate) size: u64,
    /// Median time of one pass \[ns\].
    pub(crate) time: f64,
    /// Confidence interval of the median \[ns\].
    pub(crate) interval: [f64; 2],
}

impl Measurement {
    /// Reads a measurement.
    pub(crate) fn read(benchmark: &Path, estimates: &Path) -> Result<Self, Failure> {
        let text = |path: &Path| {
            fs::read_to_string(path).map_err(|error| {
                Failure::input_output(format!("cannot read {}", path.display()), error)
            })
        };
        Self::parse(&text(benchmark)?, &text(estimates)?).map_err(|missing| {
            let what = format!("{} and {}", benchmark.display(), estimates.display());
            Failure::input_output(what, missing)
        })
    }

    /// The measurement in the text of the two files; an error says what is missing.
    fn parse(benchmark: &str, estimates: &str) -> Result<Self, String> {
        let json = |text: &str| serde_json::from_str(text).map_err(|error| error.to_string());
        let (benchmark, estimates): (Value, Value) = (json(benchmark)?, json(estimates)?);
        let missing = |what: &str| format!("`{what}` is missing");
        let string = |key: &str| benchmark[key].as_str().map(str::to_owned);
        let median = &estimates["median"];
        let bound = |key: &str| {
            let value = median["confidence_interval"][key].as_f64();
            value.ok_or_else(|| missing(key))
        };
        Ok(Self {
            group: string("group_id").ok_or_else(|| missing("group_id"))?,
            bench: string("function_id").ok_or_else(|| missing("function_id"))?,
            size: benchmark["throughput"]["Elements"]
                .as_u64()
                .filter(|&size| size > 0)
                .ok_or_else(|| missing("throughput.Elements"))?,
            time: median["point_estimate"]
                .as_f64()
                .ok_or_else(|| missing("median.point_estimate"))?,
            interval: [bound("lower_bound")?, bound("upper_bound")?],
        })
    }

    /// What the size counts.
    pub(crate) fn unit(&self) -> &'static str {
        match self.group.as_str() {
            "factorisation" => "unknown",
            "return_map" | "lift_small" | "lift_finite" => "state",
            _ => "particle",
        }
    }

    /// Time per particle, state or unknown \[ns\].
    pub(crate) fn cost(&self) -> f64 {
        self.time / self.size as f64
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
        let found = Measurement::parse(BENCHMARK, ESTIMATES).unwrap();
        let expected = Measurement {
            group: "assembly".to_owned(),
            bench: "von-mises/tangent".to_owned(),
            size: 2500,
            time: 1.25e6,
            interval: [1.2e6, 1.4e6],
        };
        assert_eq!(found, expected);
        assert!((found.cost() - 500.0).abs() < 1e-9);
        assert_eq!(found.unit(), "particle");
    }

    #[test]
    fn what_is_missing_is_named() {
        let without = BENCHMARK.replace("Elements", "Bytes");
        assert_eq!(
            Measurement::parse(&without, ESTIMATES).unwrap_err(),
            "`throughput.Elements` is missing"
        );
        let empty = BENCHMARK.replace("{\"Elements\":2500}", "{\"Elements\":0}");
        assert!(Measurement::parse(&empty, ESTIMATES).is_err());
        assert_eq!(
            Measurement::parse(BENCHMARK, "{}").unwrap_err(),
            "`median.point_estimate` is missing"
        );
        assert!(Measurement::parse(BENCHMARK, "not json").is_err());
    }

    #[test]
    fn factorisations_count_unknowns() {
        let benchmark = BENCHMARK.replace("\"assembly\"", "\"factorisation\"");
        let found = Measurement::parse(&benchmark, ESTIMATES).unwrap();
        assert_eq!(found.unit(), "unknown");
    }
}
