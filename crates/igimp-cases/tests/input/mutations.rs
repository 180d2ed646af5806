//! Case files with every kind of damage: the reader never panics, and either accepts the file or
//! names its fault.

use std::panic::catch_unwind;
use std::path::Path;

use igimp_input::{CaseFile, InputError};

/// A small generator of numbers, the same in every run (xorshift, Marsaglia 2003).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % limit.max(1) as u64) as usize
    }

    fn pick<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[self.below(from.len())]
    }
}

const VALUES: [&str; 34] = [
    "\"1 m\"",
    "\"1 kPa\"",
    "\"1 kg/m3\"",
    "\"-1 m\"",
    "\"1e308 m\"",
    "\"1e300 kPa\"",
    "\"1e-300 m\"",
    "\"0 m\"",
    "\"nan m\"",
    "\"inf m\"",
    "\"1/0 m\"",
    "\"\"",
    "\"clay\"",
    "\"no such name\"",
    "\"a/b\"",
    "\"\\u0000\"",
    "0",
    "-1",
    "1",
    "9223372036854775807",
    "99999999999999999999",
    "1e308",
    "-0.0",
    "inf",
    "nan",
    "true",
    "[]",
    "{}",
    "[[]]",
    "[\"0 m\", \"0 m\"]",
    "[[\"0 m\"], 1]",
    "{ x = 1 }",
    "1979-05-27",
    "'''\n'''",
];

/// Places of a file where a value stands: after `= `, to the end of the line or a comment.
fn values(text: &str) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        if let Some(equals) = line.find(" = ") {
            let end = line.find('#').unwrap_or(line.len());
            if end > equals + 3 {
                found.push((at + equals + 3, at + end));
            }
        }
        at += line.len();
    }
    found
}

/// Quantities and numbers anywhere in a file.
fn atoms(text: &str) -> Vec<(usize, usize)> {
    let quotes: Vec<_> = text.match_indices('"').map(|(at, _)| at).collect();
    quotes
        .chunks_exact(2)
        .map(|pair| (pair[0], pair[1] + 1))
        .collect()
}

fn mutate(text: &str, kind: usize, random: &mut Random) -> Vec<u8> {
    let lines: Vec<&str> = text.lines().collect();
    let joined = |lines: Vec<&str>| lines.join("\n").into_bytes();
    let replaced = |(from, to): (usize, usize), by: &str| {
        format!("{}{by}{}", &text[..from], &text[to..]).into_bytes()
    };
    match kind {
        // Drop a line, or everything from it on.
        0 => {
            let drop = random.below(lines.len());
            let keep = lines.iter().enumerate().filter(|(k, _)| *k != drop);
            joined(keep.map(|(_, line)| *line).collect())
        }
        1 => text.as_bytes()[..random.below(text.len())].to_vec(),
        // Write a line twice, or somewhere else.
        2 => {
            let mut lines = lines;
            let at = random.below(lines.len());
            lines.insert(at, lines[at]);
            joined(lines)
        }
        3 => {
            let mut lines = lines;
            let line = lines.remove(random.below(lines.len()));
            lines.insert(random.below(lines.len()), line);
            joined(lines)
        }
        // Another value.
        4 | 5 => {
            let all = values(text);
            replaced(*random.pick(&all), &format!("{}\n", random.pick(&VALUES)))
        }
        6 | 7 => {
            let all = atoms(text);
            replaced(*random.pick(&all), random.pick::<&str>(&VALUES))
        }
        // A slip of the pen.
        8 => {
            let mut characters: Vec<char> = text.chars().collect();
            let at = random.below(characters.len() - 1);
            characters.swap(at, at + 1);
            characters.into_iter().collect::<String>().into_bytes()
        }
        9 => {
            let mut characters: Vec<char> = text.chars().collect();
            characters.remove(random.below(characters.len()));
            characters.into_iter().collect::<String>().into_bytes()
        }
        // Noise.
        10 => {
            let mut bytes = text.as_bytes().to_vec();
            for _ in 0..=random.below(8) {
                let at = random.below(bytes.len());
                bytes[at] = random.below(256) as u8;
            }
            bytes
        }
        // Both ends of two values change places.
        _ => {
            let all = values(text);
            let (a, b) = (*random.pick(&all), *random.pick(&all));
            let value = text[b.0..b.1].to_owned();
            replaced(a, &format!("{value}\n"))
        }
    }
}

#[test]
fn damaged_files_are_accepted_or_explained() {
    const MUTATIONS: usize = 480;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../igimp-input/cases");
    let mut files = 0;
    let mut outcomes = [0, 0];
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        files += 1;
        let text = std::fs::read_to_string(&path).unwrap();
        let mut random = Random(0x9e37_79b9_7f4a_7c15);
        for number in 0..MUTATIONS {
            let damaged = mutate(&text, number % 12, &mut random);
            let damaged = String::from_utf8_lossy(&damaged).into_owned();
            let result = catch_unwind(|| CaseFile::parse("damaged.toml", &damaged, &[]));
            let Ok(result) = result else {
                panic!("mutation {number} of {} panics:\n{damaged}", path.display());
            };
            match result {
                Ok(file) => {
                    outcomes[0] += 1;
                    let explained = file.explain();
                    let again = CaseFile::parse("damaged.toml", &explained, &[]);
                    let again = again.unwrap_or_else(|error| panic!("{error}\n{explained}"));
                    assert_eq!(
                        format!("{:?}", file.any_case()),
                        format!("{:?}", again.any_case())
                    );
                }
                Err(InputError::Invalid { text, errors, .. }) => {
                    outcomes[1] += 1;
                    assert!(errors > 0 && text.contains("damaged.toml"), "{text}");
                }
                Err(error) => panic!("mutation {number}: {error}"),
            }
        }
    }
    assert!(files >= 2);
    // Both must happen, or the damage is of no use.
    assert!(outcomes.iter().all(|&count| count > 20), "{outcomes:?}");
}
