//! Columns of particles: each is declared once, and all that keeps, picks, checks and stores particles goes by that.

use igimp_material::{INTERNAL_VARIABLES, Ratios, Regime};

use crate::error::AssemblyError;
use igimp_shape::matrices::determinant;

/// The numbers of a column, particle after particle.
#[derive(Clone, Debug, PartialEq)]
pub enum ColumnValues {
    /// Real numbers.
    F64(Vec<f64>),
    /// Counts and indices.
    U64(Vec<u64>),
    /// Codes.
    U8(Vec<u8>),
}

/// A column of particles as numbers with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Name, the same in every file.
    pub name: &'static str,
    /// Shape of one particle's entry; empty: a number.
    pub shape: &'static [usize],
    /// The numbers.
    pub values: ColumnValues,
}

/// Which column is wanted when a body is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColumnRequest {
    /// Name.
    pub name: &'static str,
    /// Shape of one particle's entry.
    pub shape: &'static [usize],
    /// Type of the numbers: a column without any.
    pub kind: ColumnKind,
    /// Whether it may be missing, every particle being as it was seeded.
    pub is_optional: bool,
}

/// Type of the numbers of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// Real numbers.
    F64,
    /// Counts and indices.
    U64,
    /// Codes.
    U8,
}

/// The values that a number may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Range {
    Finite,
    Positive,
    NotNegative,
    WithinOne,
    AboveMinusOne,
    /// Finite, and with a positive determinant.
    Invertible,
}

impl Range {
    fn holds(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Finite | Self::Invertible => true,
                Self::Positive => value > 0.0,
                Self::NotNegative => value >= 0.0,
                Self::WithinOne => value.abs() < 1.0,
                Self::AboveMinusOne => value > -1.0,
            }
    }

    fn requirement(self) -> &'static str {
        match self {
            Self::Finite | Self::Invertible => "finite",
            Self::Positive => "positive and finite",
            Self::NotNegative => "zero or positive, and finite",
            Self::WithinOne => "between -1 and 1",
            Self::AboveMinusOne => "above -1 and finite",
        }
    }
}

/// The error that names the first value out of its range.
pub(crate) fn require(
    particle: usize,
    field: &'static str,
    values: &[f64],
    range: Range,
) -> Result<(), AssemblyError> {
    match values.iter().find(|&&value| !range.holds(value)) {
        None => Ok(()),
        Some(&value) => Err(AssemblyError::InvalidParticle {
            particle,
            field,
            value,
            requirement: range.requirement(),
        }),
    }
}

/// The entry of one particle.
pub(crate) trait Entry: Copy + PartialEq {
    /// Its shape; empty: a number.
    const SHAPE: &'static [usize];
    /// Type of its numbers.
    const KIND: ColumnKind;
    /// The entry in an optional column that is not stored.
    const IDLE: Self;

    /// The numbers of all particles.
    fn to_values(entries: Vec<Self>) -> ColumnValues;

    /// The entries of numbers of this shape and kind; an error names the property that one lacks.
    fn from_values(values: ColumnValues) -> Result<Vec<Self>, String>;

    /// Refuses an entry out of its range.
    fn require(
        &self,
        particle: usize,
        name: &'static str,
        range: Range,
    ) -> Result<(), AssemblyError>;
}

/// The message on numbers of another kind than was asked for.
const OTHER_KIND: &str = "its numbers are of another type";

/// Real numbers, or the words that they are none.
fn reals(values: ColumnValues) -> Result<Vec<f64>, String> {
    match values {
        ColumnValues::F64(values) => Ok(values),
        _ => Err(OTHER_KIND.to_owned()),
    }
}

impl Entry for f64 {
    const SHAPE: &'static [usize] = &[];
    const KIND: ColumnKind = ColumnKind::F64;
    const IDLE: Self = 0.0;

    fn to_values(entries: Vec<Self>) -> ColumnValues {
        ColumnValues::F64(entries)
    }

    fn from_values(values: ColumnValues) -> Result<Vec<Self>, String> {
        reals(values)
    }

    fn require(
        &self,
        particle: usize,
        name: &'static str,
        range: Range,
    ) -> Result<(), AssemblyError> {
        require(particle, name, &[*self], range)
    }
}

impl<const N: usize> Entry for [f64; N] {
    const SHAPE: &'static [usize] = &[N];
    const KIND: ColumnKind = ColumnKind::F64;
    const IDLE: Self = [0.0; N];

    fn to_values(entries: Vec<Self>) -> ColumnValues {
        ColumnValues::F64(entries.into_flattened())
    }

    fn from_values(values: ColumnValues) -> Result<Vec<Self>, String> {
        Ok(reals(values)?.as_chunks::<N>().0.to_vec())
    }

    fn require(
        &self,
        particle: usize,
        name: &'static str,
        range: Range,
    ) -> Result<(), AssemblyError> {
        require(particle, name, self, range)
    }
}

impl<const N: usize> Entry for [[f64; N]; N] {
    const SHAPE: &'static [usize] = &[N, N];
    const KIND: ColumnKind = ColumnKind::F64;
    const IDLE: Self = [[0.0; N]; N];

    fn to_values(entries: Vec<Self>) -> ColumnValues {
        ColumnValues::F64(entries.into_flattened().into_flattened())
    }

    fn from_values(values: ColumnValues) -> Result<Vec<Self>, String> {
        let rows = reals(values)?.as_chunks::<N>().0.to_vec();
        Ok(rows.as_chunks::<N>().0.to_vec())
    }

    fn require(
        &self,
        particle: usize,
        name: &'static str,
        range: Range,
    ) -> Result<(), AssemblyError> {
        require(particle, name, self.as_flattened(), range)?;
        if range == Range::Invertible {
            let determinant = [determinant(self)];
            return require(particle, "det def_grad", &determinant, Range::Positive);
        }
        Ok(())
    }
}

impl Entry for usize {
    const SHAPE: &'static [usize] = &[];
    const KIND: ColumnKind = ColumnKind::U64;
    const IDLE: Self = 0;

    fn to_values(entries: Vec<Self>) -> ColumnValues {
        ColumnValues::U64(entries.into_iter().map(|entry| entry as u64).collect())
    }

    fn from_values(values: ColumnValues) -> Result<Vec<Self>, String> {
        match values {
            ColumnValues::U64(values) => Ok(values.into_iter().map(|k| k as usize).collect()),
            _ => Err(OTHER_KIND.to_owned()),
        }
    }

    fn require(&self, _: usize, _: &'static str, _: Range) -> Result<(), AssemblyError> {
        Ok(())
    }
}

impl Entry for Regime {
    const SHAPE: &'static [usize] = &[];
    const KIND: ColumnKind = ColumnKind::U8;
    const IDLE: Self = Self::Elastic;

    fn to_values(entries: Vec<Self>) -> ColumnValues {
        ColumnValues::U8(entries.into_iter().map(Regime::code).collect())
    }

    fn from_values(values: ColumnValues) -> Result<Vec<Self>, String> {
        let ColumnValues::U8(codes) = values else {
            return Err(OTHER_KIND.to_owned());
        };
        let known =
            |code| Regime::from_code(code).ok_or(format!("{code} is the code of no regime"));
        codes.into_iter().map(known).collect()
    }

    fn require(&self, _: usize, _: &'static str, _: Range) -> Result<(), AssemblyError> {
        Ok(())
    }
}

impl Entry for Ratios {
    const SHAPE: &'static [usize] = &[3];
    const KIND: ColumnKind = ColumnKind::F64;
    const IDLE: Self = Self::ONE;

    fn to_values(entries: Vec<Self>) -> ColumnValues {
        let rows = (entries.into_iter()).map(|r| [r.strength, r.friction, r.stiffness]);
        ColumnValues::F64(rows.flatten().collect())
    }

    fn from_values(values: ColumnValues) -> Result<Vec<Self>, String> {
        let rows = <[f64; 3]>::from_values(values)?.into_iter();
        Ok(rows
            .map(|[strength, friction, stiffness]| Self {
                strength,
                friction,
                stiffness,
            })
            .collect())
    }

    fn require(&self, particle: usize, name: &'static str, _: Range) -> Result<(), AssemblyError> {
        require(
            particle,
            name,
            &[self.strength, self.stiffness],
            Range::Positive,
        )?;
        require(particle, name, &[self.friction], Range::NotNegative)
    }
}

/// Whether no particle uses a column.
pub(crate) fn is_idle<T: Entry>(entries: &[T]) -> bool {
    entries.iter().all(|entry| *entry == T::IDLE)
}

/// Internal variables of a law by particle.
pub(crate) type Internal = [f64; INTERNAL_VARIABLES];

/// Declares the columns of particles: `name: type = value of a seed, range;`. A column with `optional` behind its
/// range is stored only where a particle has other numbers than [`Entry::IDLE`].
macro_rules! columns {
    (
        |$seed:ident, $number:ident|
        $(
            $(#[$doc:meta])*
            $name:ident: $entry:ty = $start:expr, $range:expr $(, $optional:ident)?;
        )*
    ) => {
        /// The arrays, one entry per particle.
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct ParticleFields<const D: usize> {
            $($(#[$doc])* pub $name: Vec<$entry>,)*
        }

        impl<const D: usize> ParticleFields<D> {
            /// The columns of seeds.
            fn seeded(seeds: &[ParticleSeed<D>]) -> Self {
                let seeds = || seeds.iter().enumerate();
                Self {
                    $($name: seeds().map(|($number, $seed)| {
                        let _ = ($number, $seed);
                        $start
                    }).collect(),)*
                }
            }

            /// Whether every column has so many entries.
            fn are_of(&self, n: usize) -> bool {
                [$(self.$name.len()),*].iter().all(|&length| length == n)
            }

            /// Some of the particles, in this order.
            fn picked(&self, which: &[usize]) -> Self {
                Self {
                    $($name: which.iter().map(|&k| self.$name[k]).collect(),)*
                }
            }

            /// These particles with others behind them.
            fn joined(&self, others: &Self) -> Self {
                Self {
                    $($name: [&self.$name[..], &others.$name[..]].concat(),)*
                }
            }

            /// Refuses a particle with an entry out of its range.
            fn validate(&self, particle: usize) -> Result<(), AssemblyError> {
                $(Entry::require(&self.$name[particle], particle, stringify!($name), $range)?;)*
                Ok(())
            }

            /// The columns by name. Those that are optional are there only where a particle is not as it was seeded.
            pub fn into_columns(self) -> Vec<Column> {
                let mut columns = Vec::new();
                $(
                    if !columns!(@is_idle self.$name $(, $optional)?) {
                        columns.push(Column {
                            name: stringify!($name),
                            shape: <$entry as Entry>::SHAPE,
                            values: Entry::to_values(self.$name),
                        });
                    }
                )*
                columns
            }

            /// The particles of `n` entries whose columns are handed out by name.
            ///
            /// # Errors
            /// The name of a column, and why it does not serve.
            pub fn from_columns(
                n: usize,
                read: impl Fn(ColumnRequest) -> Result<Option<ColumnValues>, String>,
            ) -> Result<Self, (&'static str, String)> {
                Ok(Self {
                    $($name: {
                        let request = ColumnRequest {
                            name: stringify!($name),
                            shape: <$entry as Entry>::SHAPE,
                            kind: <$entry as Entry>::KIND,
                            is_optional: columns!(@is_optional $($optional)?),
                        };
                        let values = read(request).map_err(|why| (request.name, why))?;
                        match values {
                            Some(values) => {
                                Entry::from_values(values).map_err(|why| (request.name, why))?
                            }
                            None => columns!(@missing n $(, $optional)?),
                        }
                    },)*
                })
            }
        }
    };
    (@is_optional) => { false };
    (@is_optional optional) => { true };
    (@is_idle $column:expr) => { false };
    (@is_idle $column:expr, optional) => {
        is_idle(&$column)
    };
    (@missing $n:ident) => { Vec::new() };
    (@missing $n:ident, optional) => { vec![Entry::IDLE; $n] };
}
pub(crate) use columns;
