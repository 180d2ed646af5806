//! The three readers under test: how their inputs are made, and what must hold of them.

use std::io;
use std::path::Path;

use crate::input::{Input, entries};
use crate::mutate::damage;
use crate::random::Random;
use crate::targets::outcome::outcome;
use crate::words;

pub mod case;
pub mod checkpoint;
pub mod outcome;
pub mod quantity;

/// A reader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// Case files: from bytes to a case, with overrides.
    Case,
    /// Checkpoints: from the bytes of a manifest and its arrays to bodies.
    Checkpoint,
    /// Quantities: from a text such as `25 kPa` to a number.
    Quantity,
}

/// What a reader made of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It was understood.
    Accepted,
    /// It was refused, with a message.
    Refused,
}

/// What mutations of one reader are made from.
#[derive(Clone, Debug)]
pub struct Material {
    /// The inputs that are known, each complete in itself.
    pub corpus: Vec<Input>,
    /// Those of them that are accepted.
    sound: Vec<Input>,
    /// Words of the format.
    words: Vec<String>,
}

impl Target {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Case, Self::Checkpoint, Self::Quantity];

    /// Its name, and that of its folder in the corpus.
    pub fn name(self) -> &'static str {
        match self {
            Self::Case => "case",
            Self::Checkpoint => "checkpoint",
            Self::Quantity => "quantity",
        }
    }

    /// Reads its part of a corpus.
    ///
    /// # Errors
    /// What the system says; [`io::ErrorKind::NotFound`] also for a corpus without an entry.
    pub fn material(self, corpus: &Path) -> io::Result<Material> {
        let folder = corpus.join(self.name());
        let paths = entries(&folder)?;
        let known: io::Result<Vec<Input>> = paths.iter().map(|path| Input::read(path)).collect();
        let (corpus, words) = match self {
            Self::Case => (known?, words::of_cases()),
            Self::Checkpoint => (
                checkpoint::complete(&paths, known?),
                words::of_checkpoints(),
            ),
            Self::Quantity => (quantity::lines(&known?), words::of_quantities()),
        };
        if corpus.is_empty() {
            let nothing = format!("{} holds no input", folder.display());
            return Err(io::Error::new(io::ErrorKind::NotFound, nothing));
        }
        let is_sound = |input: &&Input| outcome(self, input) == Ok(Verdict::Accepted);
        let sound = corpus.iter().filter(is_sound).cloned().collect();
        Ok(Material {
            corpus,
            sound,
            words,
        })
    }

    /// The input of an execution: the corpus as it is comes first, then damaged entries, half of
    /// them from those that are accepted.
    pub fn input(self, material: &Material, seed: u64, execution: u64) -> Input {
        let Material {
            corpus,
            sound,
            words,
        } = material;
        if let Some(entry) = corpus.get(execution as usize) {
            return entry.clone();
        }
        let mut random = Random::of(seed, execution);
        let from = if random.once_in(2) { sound } else { corpus };
        let Some(other) = random.pick(corpus) else {
            return Input::default();
        };
        let entry = random.pick(from).unwrap_or(other);
        match self {
            Self::Checkpoint => checkpoint::mutated(entry, other, words, &mut random),
            Self::Case | Self::Quantity => {
                let mut text = entry.bytes().to_vec();
                damage(&mut text, other.bytes(), words, &mut random);
                Input::text(text)
            }
        }
    }

    /// Reads an input and checks what must hold.
    ///
    /// # Errors
    /// What does not hold.
    pub fn check(self, input: &Input) -> Result<Verdict, String> {
        match self {
            Self::Case => case::check(input.bytes()),
            Self::Checkpoint => checkpoint::check(&input.parts),
            Self::Quantity => quantity::check(input.bytes()),
        }
    }
}

/// Refuses what is false.
fn holds(is_so: bool, what: impl FnOnce() -> String) -> Result<(), String> {
    if is_so { Ok(()) } else { Err(what()) }
}
