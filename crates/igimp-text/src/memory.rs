//! Amounts of memory as they are written: `8 GiB`, or `50 %` of what there is.

use std::fmt;
use std::str::FromStr;

/// A limit of memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MemoryLimit {
    /// So much \[bytes\].
    Bytes(f64),
    /// A share of what the computer has \[-\].
    Share(f64),
}

/// A text that is no amount of memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoAmount;

impl fmt::Display for NoAmount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("expected an amount of memory such as \"8 GiB\", or a share up to \"100 %\"")
    }
}

impl std::error::Error for NoAmount {}

/// Units of memory \[bytes\].
const UNITS: [(&str, f64); 7] = [
    ("B", 1.0),
    ("MB", 1e6),
    ("GB", 1e9),
    ("TB", 1e12),
    ("MiB", 1_048_576.0),
    ("GiB", 1_073_741_824.0),
    ("TiB", 1_099_511_627_776.0),
];

impl FromStr for MemoryLimit {
    type Err = NoAmount;

    fn from_str(text: &str) -> Result<Self, NoAmount> {
        let text = text.trim();
        let end = text
            .find(|c: char| !(c.is_ascii_digit() || c == '.'))
            .ok_or(NoAmount)?;
        let (number, unit) = text.split_at(end);
        let number: f64 = number.parse().map_err(|_| NoAmount)?;
        let unit = unit.trim();
        if unit == "%" {
            let share = number / 100.0;
            return if share > 0.0 && share <= 1.0 {
                Ok(Self::Share(share))
            } else {
                Err(NoAmount)
            };
        }
        let of_unit = UNITS.iter().find(|(name, _)| *name == unit);
        let &(_, bytes) = of_unit.ok_or(NoAmount)?;
        Ok(Self::Bytes(number * bytes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    // GOAL: amounts are read with their units, and nothing is guessed.
    // ORACLE: IEC 80000-13 for KiB and its like, the SI for the others.
    #[test]
    fn amounts_have_units() {
        let read = |text: &str| text.parse::<MemoryLimit>();
        assert_eq!(read("8 GiB"), Ok(MemoryLimit::Bytes(8_589_934_592.0)));
        assert_eq!(read("1.5GB"), Ok(MemoryLimit::Bytes(1.5e9)));
        assert_eq!(read(" 0 B "), Ok(MemoryLimit::Bytes(0.0)));
        assert_eq!(read("25 %"), Ok(MemoryLimit::Share(0.25)));
        for wrong in [
            "",
            "8",
            "GiB",
            "8 gib",
            "-8 GiB",
            "1e3 MB",
            "0 %",
            "120 %",
            "8 GiB of it",
            "1.2.3 MB",
        ] {
            assert_eq!(read(wrong), Err(NoAmount), "{wrong}");
        }
    }
}
