//! The day and time of a run, for the head of its report and nothing else. This is the one place that
//! reads the time of day; nothing that is computed, ordered or compared depends on it.

use std::time::{SystemTime, UNIX_EPOCH};

use crate::error::ProgramError;

/// Set to seconds since 1970-01-01 it takes the place of the clock, as in reproducible builds.
const FIXED: &str = "SOURCE_DATE_EPOCH";
/// The first second of the year 10000.
const END: u64 = 253_402_300_800;

/// Day and time, as in `2026-03-01 14:05 UTC`; none if the clock stands before 1970.
///
/// # Errors
/// If `SOURCE_DATE_EPOCH` is set to something else than seconds.
pub(crate) fn now() -> Result<Option<String>, ProgramError> {
    if let Some(given) = std::env::var_os(FIXED) {
        let seconds = given.to_str().and_then(|text| text.parse::<u64>().ok());
        return match seconds.filter(|&seconds| seconds < END) {
            Some(seconds) => Ok(Some(words(seconds))),
            None => Err(ProgramError::usage(
                format!("{FIXED} is set to {:?}", given.to_string_lossy()),
                "it takes seconds since 1970-01-01 as a whole number; unset it for the time of the clock",
            )),
        };
    }
    #[expect(
        clippy::disallowed_methods,
        reason = "the date in the head of a report; elapsed times and orders never come from here"
    )]
    let now = SystemTime::now();
    let since = now.duration_since(UNIX_EPOCH).ok();
    Ok(since
        .map(|since| since.as_secs())
        .filter(|&seconds| seconds < END)
        .map(words))
}

/// A second since 1970-01-01 as a date of the Gregorian calendar.
fn words(seconds: u64) -> String {
    let (mut days, second) = (seconds / 86_400, seconds % 86_400);
    let leap =
        |year: u64| year.is_multiple_of(4) && !year.is_multiple_of(100) || year.is_multiple_of(400);
    let mut year = 1970;
    loop {
        let length = 365 + u64::from(leap(year));
        if days < length {
            break;
        }
        days -= length;
        year += 1;
    }
    let february = 28 + u64::from(leap(year));
    let mut month = 1;
    for length in [31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30] {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    let (hour, minute) = (second / 3600, second % 3600 / 60);
    format!(
        "{year:04}-{month:02}-{:02} {hour:02}:{minute:02} UTC",
        days + 1
    )
}

#[cfg(test)]
mod tests {
    use super::words;

    /// ORACLE: `date -u -d @SECONDS`.
    #[test]
    fn seconds_become_dates() {
        for (seconds, date) in [
            (0, "1970-01-01 00:00 UTC"),
            (951_782_399, "2000-02-28 23:59 UTC"),
            (951_782_400, "2000-02-29 00:00 UTC"),
            (1_735_689_599, "2024-12-31 23:59 UTC"),
            (4_107_542_400, "2100-03-01 00:00 UTC"),
            (253_402_300_799, "9999-12-31 23:59 UTC"),
        ] {
            assert_eq!(words(seconds), date);
        }
    }
}
