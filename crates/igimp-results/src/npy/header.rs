//! The header of a `.npy` file: a Python dictionary of three entries.

use crate::error::NpyError;

const MAGIC: &[u8] = b"\x93NUMPY";

/// NumPy itself stops at 64.
const MOST_DIMENSIONS: usize = 64;

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) descr: String,
    pub(super) fortran_order: bool,
    pub(super) shape: Vec<usize>,
}

impl Header {
    /// Everything before the numbers.
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        let lengths: Vec<String> = self.shape.iter().map(usize::to_string).collect();
        let comma = if lengths.len() == 1 { "," } else { "" };
        let mut text = format!(
            "{{'descr': '{}', 'fortran_order': {}, 'shape': ({}{comma}), }}",
            self.descr,
            if self.fortran_order { "True" } else { "False" },
            lengths.join(", "),
        );
        let unpadded = MAGIC.len() + 4 + text.len() + 1;
        text.push_str(&" ".repeat(unpadded.next_multiple_of(64) - unpadded));
        text.push('\n');
        let length = u16::try_from(text.len()).expect("invariant: shapes have few dimensions");
        let mut bytes = MAGIC.to_vec();
        bytes.extend([1, 0]);
        bytes.extend(length.to_le_bytes());
        bytes.extend(text.as_bytes());
        bytes
    }

    /// The header, and the bytes after it.
    pub(super) fn from_bytes(bytes: &[u8]) -> Result<(Self, &[u8]), NpyError> {
        let rest = bytes.strip_prefix(MAGIC).ok_or(NpyError::NotNpy)?;
        let (&[major, minor], rest) = rest.split_first_chunk().ok_or(NpyError::CutHeader)?;
        if (major, minor) != (1, 0) {
            return Err(NpyError::Version { major, minor });
        }
        let (&length, rest) = rest.split_first_chunk().ok_or(NpyError::CutHeader)?;
        let (text, numbers) = rest
            .split_at_checked(usize::from(u16::from_le_bytes(length)))
            .ok_or(NpyError::CutHeader)?;
        let text = std::str::from_utf8(text).map_err(|_| not_understood("it is not text"))?;
        Ok((Self::parse(text)?, numbers))
    }

    fn parse(text: &str) -> Result<Self, NpyError> {
        let (mut descr, mut fortran_order, mut shape) = (None, None, None);
        let mut text = Reader(text);
        text.expect('{')?;
        while !text.accept('}') {
            let key = text.quoted()?;
            text.expect(':')?;
            let is_new = match key {
                "descr" => descr.replace(text.quoted()?.to_owned()).is_none(),
                "fortran_order" => fortran_order.replace(text.boolean()?).is_none(),
                "shape" => shape.replace(text.tuple()?).is_none(),
                _ => return Err(not_understood("it has an unknown entry")),
            };
            if !is_new {
                return Err(not_understood("it has an entry twice"));
            }
            if !text.accept(',') {
                text.expect('}')?;
                break;
            }
        }
        if !text.0.trim().is_empty() {
            return Err(not_understood("something follows the dictionary"));
        }
        match (descr, fortran_order, shape) {
            (Some(descr), Some(fortran_order), Some(shape)) => Ok(Self {
                descr,
                fortran_order,
                shape,
            }),
            _ => Err(not_understood("an entry is missing")),
        }
    }
}

fn not_understood(why: &'static str) -> NpyError {
    NpyError::Header { why }
}

/// The rest of the header.
struct Reader<'a>(&'a str);

impl<'a> Reader<'a> {
    fn accept(&mut self, symbol: char) -> bool {
        let text = self.0.trim_start();
        let rest = text.strip_prefix(symbol);
        self.0 = rest.unwrap_or(text);
        rest.is_some()
    }

    fn expect(&mut self, symbol: char) -> Result<(), NpyError> {
        if self.accept(symbol) {
            Ok(())
        } else {
            Err(not_understood("it is not a dictionary of three entries"))
        }
    }

    fn quoted(&mut self) -> Result<&'a str, NpyError> {
        let text = self.0.trim_start();
        ['\'', '"']
            .into_iter()
            .find_map(|mark| text.strip_prefix(mark)?.split_once(mark))
            .map(|(quoted, rest)| {
                self.0 = rest;
                quoted
            })
            .ok_or(not_understood("a quoted text is missing"))
    }

    fn boolean(&mut self) -> Result<bool, NpyError> {
        let text = self.0.trim_start();
        [("True", true), ("False", false)]
            .into_iter()
            .find_map(|(word, value)| Some((text.strip_prefix(word)?, value)))
            .map(|(rest, value)| {
                self.0 = rest;
                value
            })
            .ok_or(not_understood("`fortran_order` is neither True nor False"))
    }

    fn tuple(&mut self) -> Result<Vec<usize>, NpyError> {
        let wrong = not_understood("`shape` is not a tuple of numbers");
        let text = self.0.trim_start();
        let (inside, rest) = text
            .strip_prefix('(')
            .and_then(|text| text.split_once(')'))
            .ok_or(wrong.clone())?;
        self.0 = rest;
        let inside = inside.trim();
        let inside = inside.strip_suffix(',').unwrap_or(inside);
        if inside.is_empty() {
            return Ok(Vec::new());
        }
        if inside.split(',').count() > MOST_DIMENSIONS {
            return Err(not_understood("`shape` has too many dimensions"));
        }
        inside
            .split(',')
            .map(|length| length.trim().parse().map_err(|_| wrong.clone()))
            .collect()
    }
}
