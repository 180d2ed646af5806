//! Damage: what becomes of bytes when they are edited by a careless or hostile hand.

use std::ops::Range;

use crate::random::Random;

/// Most bytes of a mutated text.
const LONGEST: usize = 1 << 16;

/// Numbers at and beyond the ends of what is sensible.
const NUMBERS: [&str; 36] = [
    "0",
    "-0",
    "-0.0",
    "1",
    "-1",
    "2",
    "0.5",
    "0.4999999999999999",
    "0.5000000000000001",
    "1e-300",
    "1e-308",
    "5e-324",
    "1e-9",
    "1e9",
    "1e15",
    "1e300",
    "1.7976931348623157e308",
    "1e309",
    "1e999999",
    "1e-999999",
    "inf",
    "-inf",
    "nan",
    "1/0",
    "0/0",
    "1/3",
    "1e308/1e-308",
    "255",
    "65536",
    "4294967296",
    "9223372036854775807",
    "9223372036854775808",
    "18446744073709551616",
    "1152921504606846976",
    "1_000",
    "0x7fffffffffffffff",
];

/// Bytes that mean something in one of the formats, or upset a reader.
const BYTES: &[u8] = b"\0\t\n\r \"'#,.-+=[]{}()\\/_:e\x1b\x7f\xc2\xb2\xff\xef\xbb\xbf\xe2\x80\xae";

/// Damages a text in one place or in several; `other` is a text to take pieces from.
///
/// Half of the time the hand is careful: words, numbers and lines change, and the syntax stands.
pub fn damage(text: &mut Vec<u8>, other: &[u8], words: &[String], random: &mut Random) {
    if random.once_in(2) {
        for _ in 0..random.length(2) {
            carefully(text, other, random);
        }
    } else {
        for _ in 0..random.length(3) {
            once(text, other, words, random);
        }
    }
    text.truncate(LONGEST);
}

/// Changes what stands in a text and keeps its form.
fn carefully(text: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    match random.below(9) {
        0 => {
            if let Some(range) = number(text, random) {
                let at = range.start + random.below(range.len());
                if text[at].is_ascii_digit() {
                    text[at] = b'0' + random.below(10) as u8;
                }
            }
        }
        1 => {
            if let (Some(range), Some(number)) = (number(text, random), random.pick(&NUMBERS)) {
                text.splice(range, number.bytes());
            }
        }
        2 => {
            if let (Some(to), Some(from)) = (number(text, random), number(other, random)) {
                text.splice(to, other[from].iter().copied());
            }
        }
        3 | 4 => {
            let copy = text.clone();
            let donor = if random.once_in(2) { &copy } else { other };
            if let (Some(to), Some(from)) = (quoted(text, random), quoted(donor, random)) {
                text.splice(to, donor[from].iter().copied());
            }
        }
        5 => {
            if let (Some(to), Some(from)) = (token(text, random), token(other, random)) {
                text.splice(to, other[from].iter().copied());
            }
        }
        6 => {
            let range = line(text, random);
            text.drain(range);
        }
        7 => {
            let (from, to) = (line(text, random), line(text, random));
            let piece = text[from].to_vec();
            text.splice(to.start..to.start, piece);
        }
        _ => {
            let at = line(text, random).start;
            let piece = other[line(other, random)].to_vec();
            text.splice(at..at, piece);
        }
    }
}

fn once(text: &mut Vec<u8>, other: &[u8], words: &[String], random: &mut Random) {
    match random.below(20) {
        kind @ 0..9 => of_bytes(kind, text, other, random),
        kind @ 9..16 => of_words(kind, text, other, words, random),
        kind => of_lines(kind, text, other, random),
    }
    text.truncate(2 * LONGEST);
}

/// Bytes and stretches of them are changed, left out, repeated and taken from elsewhere.
fn of_bytes(kind: usize, text: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    match kind {
        0 => {
            if let Some(at) = place(text, random) {
                text[at] ^= 1 << random.below(8);
            }
        }
        1 => {
            if let Some(at) = place(text, random) {
                text[at] = byte(random);
            }
        }
        2 => {
            let at = random.below(text.len() + 1);
            let count = random.length(3);
            text.splice(at..at, (0..count).map(|_| byte(random)).collect::<Vec<_>>());
        }
        3 => {
            let range = stretch(text, random);
            text.drain(range);
        }
        4 => {
            let range = stretch(text, random);
            let doublings = if random.once_in(50) { 12 } else { 3 };
            let times = random.length(doublings);
            let piece = text[range.clone()].repeat(times.min(1 + LONGEST / (range.len() + 1)));
            text.splice(range.end..range.end, piece);
        }
        5 => text.truncate(random.below(text.len() + 1)),
        6 => {
            let (to, from) = (stretch(text, random), stretch(text, random));
            let piece = text[from].to_vec();
            text.splice(to, piece);
        }
        7 => {
            text.truncate(random.below(text.len() + 1));
            text.extend_from_slice(&other[random.below(other.len() + 1)..]);
        }
        _ => {
            let at = random.below(text.len() + 1);
            let piece = other[stretch(other, random)].to_vec();
            text.splice(at..at, piece);
        }
    }
}

/// Numbers and words give way to others.
fn of_words(kind: usize, text: &mut Vec<u8>, other: &[u8], words: &[String], random: &mut Random) {
    match kind {
        9..12 => {
            if let (Some(range), Some(number)) = (number(text, random), random.pick(&NUMBERS)) {
                text.splice(range, number.bytes());
            }
        }
        12 | 13 => {
            if let (Some(range), Some(word)) = (token(text, random), random.pick(words)) {
                text.splice(range, word.bytes());
            }
        }
        14 => {
            if let (Some(to), Some(from)) = (token(text, random), token(other, random)) {
                text.splice(to, other[from].iter().copied());
            }
        }
        _ => {
            let at = random.below(text.len() + 1);
            if let Some(word) = random.pick(words) {
                text.splice(at..at, word.bytes());
            }
        }
    }
}

/// Lines are left out, repeated elsewhere and taken from elsewhere.
fn of_lines(kind: usize, text: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    match kind {
        16 => {
            let range = line(text, random);
            text.drain(range);
        }
        17 => {
            let (from, to) = (line(text, random), line(text, random));
            let piece = text[from].to_vec();
            text.splice(to.start..to.start, piece);
        }
        18 => {
            let at = line(text, random).start;
            let piece = other[line(other, random)].to_vec();
            text.splice(at..at, piece);
        }
        _ => {
            let to = line(text, random);
            let piece = other[line(other, random)].to_vec();
            text.splice(to, piece);
        }
    }
}

fn place(text: &[u8], random: &mut Random) -> Option<usize> {
    (!text.is_empty()).then(|| random.below(text.len()))
}

fn byte(random: &mut Random) -> u8 {
    if random.once_in(3) {
        random.byte()
    } else {
        random.pick(BYTES).copied().unwrap_or_default()
    }
}

fn stretch(text: &[u8], random: &mut Random) -> Range<usize> {
    let start = random.below(text.len() + 1);
    let end = (start + random.length(8)).min(text.len());
    start..end
}

/// A line with its end.
fn line(text: &[u8], random: &mut Random) -> Range<usize> {
    let at = random.below(text.len() + 1);
    let start = text[..at]
        .iter()
        .rposition(|&b| b == b'\n')
        .map_or(0, |k| k + 1);
    let end = text[at..]
        .iter()
        .position(|&b| b == b'\n')
        .map_or(text.len(), |k| at + k + 1);
    start..end
}

/// The first run of bytes of a kind after a random place, or else after the beginning.
fn run(
    text: &[u8],
    random: &mut Random,
    begins: fn(u8) -> bool,
    goes_on: fn(u8) -> bool,
) -> Option<Range<usize>> {
    let at = random.below(text.len() + 1);
    let found = |from: usize| {
        text[from..]
            .iter()
            .position(|&b| begins(b))
            .map(|k| from + k)
    };
    let start = found(at).or_else(|| found(0))?;
    let length = text[start..].iter().position(|&b| !goes_on(b));
    Some(start..length.map_or(text.len(), |length| start + length))
}

fn number(text: &[u8], random: &mut Random) -> Option<Range<usize>> {
    run(
        text,
        random,
        |b| b.is_ascii_digit(),
        |b| b.is_ascii_digit() || matches!(b, b'.' | b'e' | b'E' | b'_'),
    )
}

/// What stands between two marks `"` of one line, the marks included.
fn quoted(text: &[u8], random: &mut Random) -> Option<Range<usize>> {
    let line = line(text, random);
    let marks: Vec<usize> = line.filter(|&at| text[at] == b'"').collect();
    let pairs: Vec<&[usize]> = marks.chunks_exact(2).collect();
    random.pick(&pairs).map(|pair| pair[0]..pair[1] + 1)
}

fn token(text: &[u8], random: &mut Random) -> Option<Range<usize>> {
    run(
        text,
        random,
        |b| b.is_ascii_alphanumeric(),
        |b| b.is_ascii_alphanumeric() || matches!(b, b'_' | b'-' | b'.'),
    )
}
