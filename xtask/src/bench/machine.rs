//! The measuring machine and the date.

use std::fs;
use std::thread::available_parallelism;
use std::time::{SystemTime, UNIX_EPOCH};

use crate::process::{output, program};

/// Processor, cores, compiler and date, as far as the system tells.
pub(crate) fn line() -> String {
    let cores = available_parallelism().map_or(1, usize::from);
    let rustc = output(program("rustc").arg("--version"));
    let rustc = rustc.map_or("rustc of unknown version".to_owned(), |text| {
        text.trim().to_owned()
    });
    let cpuinfo = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let processor = processor(&cpuinfo).unwrap_or("unknown processor");
    #[allow(
        clippy::disallowed_methods,
        reason = "a date for the reader, compared with nothing"
    )]
    let now = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .unwrap_or_default();
    let [year, month, day] = date(now.as_secs() / 86_400);
    format!("{processor}, {cores} cores, {rustc}, {year}-{month:02}-{day:02}")
}

/// The model of the processor in the text of `/proc/cpuinfo`.
fn processor(cpuinfo: &str) -> Option<&str> {
    let line = cpuinfo
        .lines()
        .find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim())
}

/// Year, month and day of a number of days since the first of January 1970.
///
/// Days are counted from the first of March of the year 0, so that the leap day is the last of its
/// year.
fn date(days: u64) -> [u64; 3] {
    let days = days + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    [era * 400 + year + u64::from(month <= 2), month, day]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(date(0), [1970, 1, 1]);
        assert_eq!(date(11_016), [2000, 2, 29]);
        assert_eq!(date(20_453), [2025, 12, 31]);
    }

    #[test]
    fn the_processor_is_named() {
        let cpuinfo = "processor\t: 0\nmodel name\t: A CPU @ 2.0GHz\nmodel name\t: B\n";
        assert_eq!(processor(cpuinfo), Some("A CPU @ 2.0GHz"));
        assert_eq!(processor(""), None);
    }

    #[test]
    fn the_line_names_the_compiler() {
        assert!(line().contains("rustc"), "{}", line());
    }
}
