//! Memory that a direct solution may take for its factors: what the case states, what the environment states, or a share of
//! what the machine has.
//!
//! Where factors have no room systems are solved by iteration, whose last digits are others. The limit is therefore one that
//! stays as long as the machine does: not what is free at the moment, which differs from run to run. A run says where it
//! decided (`run::session` of `igimp-cases`).

use igimp_linear::Reason;
use igimp_model::Case;
use igimp_text::MemoryLimit;

use super::readable;
use super::room::{Limit, lasting_limit};
use crate::error::EstimateError;

/// The variable of the environment that states the limit where no case does.
pub const VARIABLE: &str = "IGIMP_MEMORY";

/// Share of what the machine has, where nothing is stated \[-\]: factors are the largest part of a run, and particles, the matrix
/// with its copies and a search's states take up to as much again (7 kB against 7 to 9 kB per unknown of large bodies in space).
const SHARE: f64 = 0.5;

/// The same where the system does not tell what the machine has \[bytes\]: a choice.
const UNKNOWN: f64 = 8.0 * 1_073_741_824.0;

/// Memory allowed for factors.
#[derive(Clone, Debug, PartialEq)]
pub struct FactorMemory {
    /// How much \[bytes\].
    pub bytes: usize,
    /// Its source, as the end of a sentence.
    pub by: String,
    /// Whether another machine, or another environment, would allow another amount.
    pub is_of_machine: bool,
}

impl FactorMemory {
    /// That of a case on this machine.
    ///
    /// # Errors
    /// [`EstimateError::Variable`] for a variable of the environment that is no amount of memory.
    pub fn of<const D: usize>(case: &Case<D>) -> Result<Self, EstimateError> {
        let variable = std::env::var(VARIABLE).ok();
        resolve(case.solver.memory, variable.as_deref(), lasting_limit())
    }

    /// A reason with the source of the limit, where the limit decided.
    pub fn explain(&self, reason: &Reason) -> String {
        if decides(reason) {
            format!("{reason} ({})", self.by)
        } else {
            reason.to_string()
        }
    }

    /// In words.
    pub fn words(&self) -> String {
        format!("at most {}, {}", readable(self.bytes as f64), self.by)
    }
}

/// Whether a method was taken for want of memory.
pub fn decides(reason: &Reason) -> bool {
    matches!(reason, Reason::Memory { .. } | Reason::OnlySingle { .. })
}

/// The first of the two that states something, or a share of the limit of the machine.
fn resolve(
    stated: Option<MemoryLimit>,
    variable: Option<&str>,
    machine: Option<Limit>,
) -> Result<FactorMemory, EstimateError> {
    let from_environment = || -> Result<Option<MemoryLimit>, EstimateError> {
        variable
            .map(|text| {
                text.parse().map_err(|expected| EstimateError::Variable {
                    name: VARIABLE,
                    value: text.to_owned(),
                    expected,
                })
            })
            .transpose()
    };
    let (limit, by) = match stated {
        Some(limit) => (Some(limit), "solver.memory"),
        None => (from_environment()?, VARIABLE),
    };
    let of_machine = machine.map_or(UNKNOWN, |machine| machine.bytes);
    let whole = machine.map_or_else(
        || "16 GiB, for the system does not tell what the computer has".to_owned(),
        |machine| format!("{}, {}", readable(machine.bytes), machine.by),
    );
    Ok(match limit {
        Some(MemoryLimit::Bytes(bytes)) => FactorMemory {
            bytes: bytes as usize,
            by: format!("by {by}"),
            is_of_machine: stated.is_none(),
        },
        Some(MemoryLimit::Share(share)) => FactorMemory {
            bytes: (share * of_machine) as usize,
            by: format!("by {by} {} % of {whole}", 100.0 * share),
            is_of_machine: true,
        },
        None => FactorMemory {
            bytes: machine.map_or(UNKNOWN, |machine| SHARE * machine.bytes) as usize,
            by: format!("half of {whole}"),
            is_of_machine: true,
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const MACHINE: Option<Limit> = Some(Limit {
        bytes: 24.0 * 1_073_741_824.0,
        by: "what the computer has",
    });

    // GOAL: a case goes before the environment, and that before the machine; messages say which it was.
    // ORACLE: by hand, of a machine with 24 GiB.
    #[test]
    fn the_nearest_statement_counts() {
        let of = |stated: Option<&str>, variable| {
            let stated = stated.map(|text| text.parse().unwrap());
            resolve(stated, variable, MACHINE).unwrap()
        };
        let gibibytes = |memory: &FactorMemory| memory.bytes as f64 / 1_073_741_824.0;
        let by_file = of(Some("3 GiB"), Some("5 GiB"));
        assert!((gibibytes(&by_file) - 3.0).abs() < 1e-9 && !by_file.is_of_machine);
        insta::assert_snapshot!(by_file.words(), @"at most 3.0 GiB, by solver.memory");
        let by_share = of(Some("25 %"), None);
        assert!((gibibytes(&by_share) - 6.0).abs() < 1e-9 && by_share.is_of_machine);
        insta::assert_snapshot!(by_share.words(), @"at most 6.0 GiB, by solver.memory 25 % of 24.0 GiB, what the computer has");
        let by_variable = of(None, Some("5 GiB"));
        assert!((gibibytes(&by_variable) - 5.0).abs() < 1e-9 && by_variable.is_of_machine);
        insta::assert_snapshot!(by_variable.words(), @"at most 5.0 GiB, by IGIMP_MEMORY");
        let by_machine = of(None, None);
        assert!((gibibytes(&by_machine) - 12.0).abs() < 1e-9 && by_machine.is_of_machine);
        insta::assert_snapshot!(by_machine.words(), @"at most 12.0 GiB, half of 24.0 GiB, what the computer has");
        insta::assert_snapshot!(
            resolve(None, Some("much"), MACHINE).unwrap_err(),
            @r#"IGIMP_MEMORY is "much": expected an amount of memory such as "8 GiB", or a share up to "100 %""#
        );
    }

    // GOAL: a limit is named where it decided, and nowhere else.
    // ORACLE: the words of the two.
    #[test]
    fn a_limit_is_named_where_it_decides() {
        let memory = resolve(None, Some("1 GiB"), MACHINE).unwrap();
        let factors = 2 << 30;
        let decided = Reason::Memory {
            factors,
            allowed: memory.bytes,
        };
        insta::assert_snapshot!(
            memory.explain(&decided),
            @"a factorisation would need 2.0 GiB, and 1.0 are allowed (by IGIMP_MEMORY)"
        );
        assert_eq!(memory.explain(&Reason::Plane), "two dimensions");
    }
}
