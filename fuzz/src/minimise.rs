//! Smaller inputs that fail in the same way.

use crate::input::Input;

/// Most trials of a search.
const TRIALS: usize = 2000;

/// The smallest input found that still fails: stretches of bytes are left out, long ones first.
pub fn minimise(input: &Input, fails: impl Fn(&Input) -> bool) -> Input {
    let mut best = input.clone();
    let mut trials = 0;
    let places: Vec<String> = best.parts.keys().cloned().collect();
    for place in places {
        let mut length = best.parts[&place].len();
        while length > 0 && trials < TRIALS {
            let mut at = 0;
            while at < best.parts[&place].len() && trials < TRIALS {
                let mut smaller = best.clone();
                if let Some(bytes) = smaller.parts.get_mut(&place) {
                    let end = (at + length).min(bytes.len());
                    bytes.drain(at..end);
                }
                trials += 1;
                if fails(&smaller) {
                    best = smaller;
                } else {
                    at += length;
                }
            }
            length /= 2;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_needed_stays() {
        let input = Input::text("a long text with an x in it, and a y behind");
        let fails = |input: &Input| {
            let text = String::from_utf8_lossy(input.bytes());
            text.find('x').is_some_and(|x| text[x..].contains('y'))
        };
        assert_eq!(minimise(&input, fails).bytes(), b"xy");
    }
}
