//! Processor time of a run, as the system counts it for the process; nothing where it does not tell.

/// Ticks of `/proc/self/stat` in a second, the same on every Linux.
const TICKS: f64 = 100.0;

/// Time of all processors together since the process began \[s\].
pub fn seconds() -> Option<f64> {
    of_stat(&std::fs::read_to_string("/proc/self/stat").ok()?)
}

/// User and system time of a line of `/proc/PID/stat`. The second field is the name of the program
/// in parentheses, and may hold anything.
fn of_stat(stat: &str) -> Option<f64> {
    let (_, fields) = stat.rsplit_once(')')?;
    let mut fields = fields.split_whitespace().skip(11);
    let mut ticks = || fields.next()?.parse::<f64>().ok();
    Some((ticks()? + ticks()?) / TICKS)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ORACLE: proc(5): field 14 is user time, field 15 system time.
    #[test]
    fn user_and_system_time_are_fields_14_and_15() {
        let line = "77 (a (b) c) S 1 2 3 4 5 6 7 8 9 10 250 50 0 0 20 0";
        assert_eq!(of_stat(line), Some(3.0));
        assert_eq!(of_stat("77 (igimp) S 1"), None);
    }
}
