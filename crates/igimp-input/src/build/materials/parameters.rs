//! The parameters of a law, each a number or a table that says how it varies.

use igimp_model::Profile;
use igimp_schema::diagnostic::Problems;
use igimp_schema::schema::materials::Profile as Keys;
use igimp_schema::source::Place;
use igimp_schema::text::number;
use igimp_schema::tree::read::{At, Either};

use super::profiles::{Extent, Terms, property};
use super::{STRENGTH, YOUNG};

/// Terms of parameters that vary.
pub(super) const STRESS: Terms = YOUNG;
pub(super) const STRESS_OR_NONE: Terms = Terms {
    may_be_nothing: true,
    ..STRENGTH
};
pub(super) const NUMBER: Terms = Terms {
    printed: number,
    ..YOUNG
};
pub(super) const NUMBER_OR_NONE: Terms = Terms {
    printed: number,
    ..STRESS_OR_NONE
};
pub(super) const ANGLE: Terms = Terms {
    printed: |value| format!("{} deg", number(value.to_degrees())),
    ..YOUNG
};
pub(super) const ANGLE_OR_NONE: Terms = Terms {
    may_vanish: true,
    may_be_nothing: true,
    ..ANGLE
};

/// A parameter as a file states it.
pub(super) type Stated = At<Either<f64, Keys>>;

/// Values that a parameter may have: which, the sentence that the value ends, and help.
pub(super) type Limit = (fn(f64) -> bool, &'static str, &'static str);

/// A ratio of overconsolidation.
pub(super) const OCR: Limit = (
    |value| value >= 1.0,
    "`ocr` must be 1 or more",
    "normally consolidated soil has ocr = 1.0",
);

/// A parameter that was read.
#[derive(Clone, Copy)]
pub(super) struct Parameter {
    pub(super) least: f64,
    /// Its constant: the greatest value where it varies.
    pub(super) most: f64,
    pub(super) place: Place,
}

impl Parameter {
    /// One that is so many times as much.
    pub(super) fn times(self, factor: f64) -> Self {
        Self {
            least: factor * self.least,
            most: factor * self.most,
            ..self
        }
    }
}

/// Parameters that vary: their keys, where they are stated, and how they vary.
pub(super) type Varied = Vec<(&'static str, Place, Profile)>;

/// Reads the parameters of a law.
pub(super) struct Parameters<'a, 'b, const D: usize> {
    pub(super) extent: Extent<'a, D>,
    pub(super) problems: &'b mut Problems,
    pub(super) varied: Varied,
}

impl<const D: usize> Parameters<'_, '_, D> {
    /// The parameter of a key, within its limit.
    pub(super) fn read(
        &mut self,
        key: &'static str,
        stated: &Stated,
        terms: Terms,
        limit: Option<Limit>,
    ) -> Option<Parameter> {
        let read = property(stated, key, self.extent, terms, self.problems)?;
        let (least, most, place) = (read.least, read.constant, stated.place);
        if let Some((holds, message, help)) = limit
            && let Some(value) = [most, least].into_iter().find(|value| !holds(*value))
        {
            let subject = if read.profile.is_some() {
                "its profile has"
            } else {
                "is"
            };
            let message = format!("{message}, but {subject} {}", (terms.printed)(value));
            self.problems.error(place, message).help(help);
        }
        let profile = read.profile.map(|profile| (key, place, profile));
        self.varied.extend(profile);
        Some(Parameter { least, most, place })
    }

    /// A key that is not stated follows another, by a linear function.
    pub(super) fn follow(&mut self, key: &'static str, other: &str, by: impl Fn(f64) -> f64) {
        if let Some(entry) = self.varied.iter().find(|entry| entry.0 == other).cloned() {
            self.varied.push((key, entry.1, entry.2.scaled(by)));
        }
    }

    /// Makes of the values of a key those that the law has, by a linear function.
    pub(super) fn scale(&mut self, key: &str, by: impl Fn(f64) -> f64) {
        for entry in self.varied.iter_mut().filter(|entry| entry.0 == key) {
            entry.2 = entry.2.clone().scaled(&by);
        }
    }
}
