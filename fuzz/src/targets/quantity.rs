//! The reader of quantities, such as `"25 kPa"`.
//!
//! What must hold, beside that nothing panics:
//!
//! - a value that is read is finite, prints, and reads back to the same bits;
//! - blanks around it make no difference, and a minus before it changes its sign alone;
//! - it is accepted for its own dimension and for no other, with the same value;
//! - what is refused is refused with a message of bounded length and with help.

use igimp_schema::Quantity;

use super::{Verdict, holds};
use crate::input::Input;
use crate::words::dimensions;

/// Most characters of a message and of help.
const LONGEST: usize = 300;

/// Every line of the files of the corpus is an input.
pub(super) fn lines(files: &[Input]) -> Vec<Input> {
    let lines = files
        .iter()
        .flat_map(|file| file.bytes().split(|&byte| byte == b'\n'));
    lines.map(Input::text).collect()
}

/// Reads a quantity.
///
/// # Errors
/// What does not hold.
pub fn check(bytes: &[u8]) -> Result<Verdict, String> {
    let text = String::from_utf8_lossy(bytes);
    let read = Quantity::parse(&text);
    let number = text.len() % dimensions().count();
    for (index, dimension) in dimensions().enumerate() {
        let value = Quantity::parse_as(&text, dimension);
        let fits = read
            .as_ref()
            .is_ok_and(|read| read.dimension == Some(dimension));
        holds(value.is_ok() == fits, || {
            format!("{dimension:?}: {value:?}, but {read:?}")
        })?;
        if let (Ok(value), Ok(read)) = (&value, &read) {
            holds(value.to_bits() == read.value.to_bits(), || {
                format!("{value} and {read:?}")
            })?;
        }
        // Suggestions cost more than all else: those for one dimension at a time.
        if let Err(error) = &value
            && index == number
        {
            let (printed, help) = (error.to_string(), error.help(Some(dimension)));
            for text in [printed, help, error.help(None)] {
                holds(!text.is_empty() && text.chars().count() < LONGEST, || {
                    format!("a message is empty or long: {text:?}")
                })?;
            }
        }
    }
    let Ok(read) = read else {
        return Ok(Verdict::Refused);
    };
    holds(read.value.is_finite(), || format!("{read:?} is not finite"))?;
    same(&read.to_string(), read)?;
    same(&format!("\u{2003}{text}\r\n"), read)?;
    if text.trim_start().starts_with(|c: char| c.is_ascii_digit()) {
        let negative = Quantity {
            value: -read.value,
            ..read
        };
        same(&format!("-{}", text.trim_start()), negative)?;
    }
    Ok(Verdict::Accepted)
}

/// A text reads as a quantity, to the bit.
fn same(text: &str, quantity: Quantity) -> Result<(), String> {
    let read = Quantity::parse(text);
    let is_same = read.as_ref().is_ok_and(|read| {
        read.value.to_bits() == quantity.value.to_bits() && read.dimension == quantity.dimension
    });
    holds(is_same, || {
        format!("{text:?} reads as {read:?} instead of {quantity:?}")
    })
}
