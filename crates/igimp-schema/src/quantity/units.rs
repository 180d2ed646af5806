//! Units that a case file may use, and what they measure.

/// The dimension of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Length \[m\].
    Length,
    /// Stress \[Pa\].
    Stress,
    /// Weight per volume \[N/m³\].
    UnitWeight,
    /// Growth of a stress with depth \[Pa/m\].
    StressGradient,
    /// Growth of a unit weight with depth \[N/m³ per m\].
    UnitWeightGradient,
    /// Angle \[rad\].
    Angle,
    /// Growth of an angle with depth \[rad/m\].
    AngleGradient,
    /// Growth of a number with depth \[1/m\].
    NumberGradient,
    /// Acceleration \[m/s²\].
    Acceleration,
    /// Force per metre run, in plane strain \[N/m\].
    ForcePerLength,
    /// Moment per metre run, in plane strain \[N m/m\].
    MomentPerLength,
    /// Mass per volume \[kg/m³\]: of grains; soil has a unit weight.
    MassDensity,
    /// Force, in space \[N\].
    Force,
    /// Moment, in space \[N m\].
    Moment,
    /// Area \[m²\], a divisor only.
    Area,
    /// Time \[s\].
    Time,
    /// Velocity: permeability, rain \[m/s\].
    Velocity,
    /// Discharge per metre run, in plane strain \[m²/s\].
    DischargePerLength,
    /// Discharge, in space \[m³/s\].
    Discharge,
    /// Rate of strain \[1/s\].
    StrainRate,
}

impl Dimension {
    /// With an article, as in "expected a stress".
    pub fn name(self) -> &'static str {
        match self {
            Self::Length => "a length",
            Self::Stress => "a stress",
            Self::UnitWeight => "a unit weight",
            Self::StressGradient => "a stress per depth",
            Self::UnitWeightGradient => "a unit weight per depth",
            Self::Angle => "an angle",
            Self::AngleGradient => "an angle per depth",
            Self::NumberGradient => "a number per depth",
            Self::Acceleration => "an acceleration",
            Self::ForcePerLength => "a force per length",
            Self::MomentPerLength => "a moment per length",
            Self::MassDensity => "a mass density",
            Self::Force => "a force",
            Self::Moment => "a moment",
            Self::Area => "an area",
            Self::Time => "a time",
            Self::Velocity => "a velocity",
            Self::DischargePerLength => "a discharge per length",
            Self::Discharge => "a discharge",
            Self::StrainRate => "a rate of strain",
        }
    }

    /// The unit that messages name.
    pub fn usual_unit(self) -> &'static str {
        match self {
            Self::Length => "m",
            Self::Stress => "kPa",
            Self::UnitWeight => "kN/m3",
            Self::StressGradient => "kPa/m",
            Self::UnitWeightGradient => "kN/m3/m",
            Self::Angle => "deg",
            Self::AngleGradient => "deg/m",
            Self::NumberGradient => "1/m",
            Self::Acceleration => "m/s2",
            Self::ForcePerLength => "kN/m",
            Self::MomentPerLength => "kNm/m",
            Self::MassDensity => "kg/m3",
            Self::Force => "kN",
            Self::Moment => "kNm",
            Self::Area => "m2",
            Self::Time => "s",
            Self::Velocity => "m/s",
            Self::DischargePerLength => "m2/s",
            Self::Discharge => "m3/s",
            Self::StrainRate => "%/h",
        }
    }

    /// The SI unit, in which values are stored.
    pub fn si_unit(self) -> &'static str {
        match self {
            Self::Length => "m",
            Self::Stress => "Pa",
            Self::UnitWeight => "N/m3",
            Self::StressGradient => "Pa/m",
            Self::UnitWeightGradient => "N/m3/m",
            Self::Angle => "rad",
            Self::AngleGradient => "rad/m",
            Self::NumberGradient => "1/m",
            Self::Acceleration => "m/s2",
            Self::ForcePerLength => "N/m",
            Self::MomentPerLength => "Nm/m",
            Self::MassDensity => "kg/m3",
            Self::Force => "N",
            Self::Moment => "Nm",
            Self::Area => "m2",
            Self::Time => "s",
            Self::Velocity => "m/s",
            Self::DischargePerLength => "m2/s",
            Self::Discharge => "m3/s",
            Self::StrainRate => "1/s",
        }
    }

    /// A quantity for messages.
    pub fn example(self) -> &'static str {
        match self {
            Self::Length => "2 m",
            Self::Stress => "25 kPa",
            Self::UnitWeight => "18 kN/m3",
            Self::StressGradient => "1.5 kPa/m",
            Self::UnitWeightGradient => "0.2 kN/m3/m",
            Self::Angle => "30 deg",
            Self::AngleGradient => "0.5 deg/m",
            Self::NumberGradient => "0.1 1/m",
            Self::Acceleration => "9.81 m/s2",
            Self::ForcePerLength => "100 kN/m",
            Self::MomentPerLength => "50 kNm/m",
            Self::MassDensity => "2000 kg/m3",
            Self::Force => "100 kN",
            Self::Moment => "50 kNm",
            Self::Area => "2 m2",
            Self::Time => "5 s",
            Self::Velocity => "1e-5 m/s",
            Self::DischargePerLength => "2e-5 m2/s",
            Self::Discharge => "3e-3 m3/s",
            Self::StrainRate => "1 %/h",
        }
    }

    /// The units that are understood, the usual spellings only.
    pub fn units(self) -> impl Iterator<Item = &'static str> {
        UNITS
            .iter()
            .filter(move |unit| unit.dimension == self)
            .map(|unit| unit.symbol)
    }
}

/// How a unit turns into its SI unit.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Scale {
    /// Ten to this power; exact where the result is.
    Ten(i32),
    /// A fraction of two numbers that are exact.
    Fraction(f64, f64),
    /// Degrees.
    Degrees,
}

/// A unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Unit {
    /// As it is written, with plain digits for powers.
    pub symbol: &'static str,
    /// Its dimension.
    pub dimension: Dimension,
    scale: Scale,
}

impl Unit {
    /// A number of this unit in SI units.
    pub(crate) fn to_si(self, number: f64) -> f64 {
        match self.scale {
            Scale::Ten(power) if power < 0 => number / 10_f64.powi(-power),
            Scale::Ten(power) => number * 10_f64.powi(power),
            Scale::Fraction(above, below) => number * above / below,
            Scale::Degrees => number.to_radians(),
        }
    }

    /// The unit of this spelling: `²`, `³`, `^2`, `^3` and `**2` are powers, spaces do not count.
    pub(crate) fn find(spelling: &str) -> Option<Self> {
        let plain = plain(spelling);
        UNITS.iter().find(|unit| unit.symbol == plain).copied()
    }

    /// The unit that a spelling may have meant.
    pub(crate) fn nearest(spelling: &str, dimension: Dimension) -> Option<&'static str> {
        let plain = plain(spelling);
        let folded = plain.to_lowercase();
        let same = |unit: &&Self| unit.symbol.to_lowercase() == folded;
        let of_kind = |unit: &&Self| unit.dimension == dimension;
        let mut known = UNITS.iter().filter(of_kind).filter(same);
        known
            .next()
            .or_else(|| UNITS.iter().find(same))
            .map(|unit| unit.symbol)
            .or_else(|| crate::names::suggest::nearest(&plain, dimension.units()))
    }
}

/// A spelling with plain digits for powers and without spaces.
fn plain(spelling: &str) -> String {
    spelling
        .chars()
        .filter_map(|c| match c {
            '²' => Some('2'),
            '³' => Some('3'),
            '^' | '*' | ' ' | '\u{a0}' => None,
            other => Some(other),
        })
        .collect()
}

const fn ten(symbol: &'static str, dimension: Dimension, power: i32) -> Unit {
    Unit {
        symbol,
        dimension,
        scale: Scale::Ten(power),
    }
}

/// So much in the SI unit of the dimension.
const fn rate(symbol: &'static str, dimension: Dimension, above: f64, below: f64) -> Unit {
    Unit {
        symbol,
        dimension,
        scale: Scale::Fraction(above, below),
    }
}

/// So many seconds.
const fn seconds(symbol: &'static str, count: f64) -> Unit {
    Unit {
        symbol,
        dimension: Dimension::Time,
        scale: Scale::Fraction(count, 1.0),
    }
}

const fn degrees(symbol: &'static str) -> Unit {
    Unit {
        symbol,
        dimension: Dimension::Angle,
        scale: Scale::Degrees,
    }
}

/// A foot is 381/1250 m and an inch 127/5000 m (international yard and pound agreement, 1959).
const FOOT: (f64, f64) = (381.0, 1250.0);
const INCH: (f64, f64) = (127.0, 5000.0);
/// A pound-force is 0.45359237 kg times 9.80665 m/s² = 4.4482216152605 N.
const POUND: (f64, f64) = (44_482_216_152_605.0, 1e13);

/// A unit of the foot, the pound-force and so on: a product of powers of these, times a whole number.
const fn customary(
    symbol: &'static str,
    dimension: Dimension,
    times: f64,
    pounds: bool,
    (length, power): ((f64, f64), i32),
) -> Unit {
    let (mut above, mut below) = if pounds {
        (times * POUND.0, POUND.1)
    } else {
        (times, 1.0)
    };
    let mut left = power;
    while left != 0 {
        let (over, under) = if left > 0 {
            length
        } else {
            (length.1, length.0)
        };
        (above, below) = (above * over, below * under);
        left -= left.signum();
    }
    Unit {
        symbol,
        dimension,
        scale: Scale::Fraction(above, below),
    }
}

/// Feet to a power.
const fn feet(symbol: &'static str, dimension: Dimension, times: f64, power: i32) -> Unit {
    customary(symbol, dimension, times, false, (FOOT, power))
}

/// Inches to a power.
const fn inches(symbol: &'static str, dimension: Dimension, times: f64, power: i32) -> Unit {
    customary(symbol, dimension, times, false, (INCH, power))
}

/// Pounds-force times feet to a power.
const fn pounds(symbol: &'static str, dimension: Dimension, times: f64, power: i32) -> Unit {
    customary(symbol, dimension, times, true, (FOOT, power))
}

/// Pounds-force times inches to a power.
const fn pounds_inch(symbol: &'static str, dimension: Dimension, times: f64, power: i32) -> Unit {
    customary(symbol, dimension, times, true, (INCH, power))
}

static UNITS: [Unit; 130] = [
    ten("m", Dimension::Length, 0),
    ten("mm", Dimension::Length, -3),
    ten("cm", Dimension::Length, -2),
    ten("km", Dimension::Length, 3),
    feet("ft", Dimension::Length, 1.0, 1),
    inches("in", Dimension::Length, 1.0, 1),
    feet("yd", Dimension::Length, 3.0, 1),
    ten("kPa", Dimension::Stress, 3),
    ten("Pa", Dimension::Stress, 0),
    ten("MPa", Dimension::Stress, 6),
    ten("GPa", Dimension::Stress, 9),
    ten("N/m2", Dimension::Stress, 0),
    ten("kN/m2", Dimension::Stress, 3),
    ten("MN/m2", Dimension::Stress, 6),
    ten("GN/m2", Dimension::Stress, 9),
    ten("N/mm2", Dimension::Stress, 6),
    ten("bar", Dimension::Stress, 5),
    pounds("psf", Dimension::Stress, 1.0, -2),
    pounds("ksf", Dimension::Stress, 1000.0, -2),
    pounds("tsf", Dimension::Stress, 2000.0, -2),
    pounds_inch("psi", Dimension::Stress, 1.0, -2),
    pounds_inch("ksi", Dimension::Stress, 1000.0, -2),
    pounds("lbf/ft2", Dimension::Stress, 1.0, -2),
    pounds("kip/ft2", Dimension::Stress, 1000.0, -2),
    pounds_inch("lbf/in2", Dimension::Stress, 1.0, -2),
    ten("kN/m3", Dimension::UnitWeight, 3),
    ten("N/m3", Dimension::UnitWeight, 0),
    ten("MN/m3", Dimension::UnitWeight, 6),
    pounds("pcf", Dimension::UnitWeight, 1.0, -3),
    pounds("kcf", Dimension::UnitWeight, 1000.0, -3),
    pounds("lbf/ft3", Dimension::UnitWeight, 1.0, -3),
    pounds("kip/ft3", Dimension::UnitWeight, 1000.0, -3),
    pounds_inch("pci", Dimension::UnitWeight, 1.0, -3),
    ten("kPa/m", Dimension::StressGradient, 3),
    ten("Pa/m", Dimension::StressGradient, 0),
    ten("MPa/m", Dimension::StressGradient, 6),
    ten("kN/m2/m", Dimension::StressGradient, 3),
    pounds("psf/ft", Dimension::StressGradient, 1.0, -3),
    pounds("ksf/ft", Dimension::StressGradient, 1000.0, -3),
    pounds("psi/ft", Dimension::StressGradient, 144.0, -3),
    pounds("lbf/ft2/ft", Dimension::StressGradient, 1.0, -3),
    ten("kN/m3/m", Dimension::UnitWeightGradient, 3),
    ten("N/m3/m", Dimension::UnitWeightGradient, 0),
    ten("kN/m4", Dimension::UnitWeightGradient, 3),
    pounds("pcf/ft", Dimension::UnitWeightGradient, 1.0, -4),
    pounds("lbf/ft3/ft", Dimension::UnitWeightGradient, 1.0, -4),
    degrees("deg"),
    degrees("°"),
    degrees("degree"),
    degrees("degrees"),
    ten("rad", Dimension::Angle, 0),
    Unit {
        dimension: Dimension::AngleGradient,
        ..degrees("deg/m")
    },
    ten("rad/m", Dimension::AngleGradient, 0),
    feet("1/ft", Dimension::NumberGradient, 1.0, -1),
    ten("1/m", Dimension::NumberGradient, 0),
    ten("m/s2", Dimension::Acceleration, 0),
    ten("cm/s2", Dimension::Acceleration, -2),
    ten("mm/s2", Dimension::Acceleration, -3),
    feet("ft/s2", Dimension::Acceleration, 1.0, 1),
    inches("in/s2", Dimension::Acceleration, 1.0, 1),
    ten("kN/m", Dimension::ForcePerLength, 3),
    ten("N/m", Dimension::ForcePerLength, 0),
    ten("MN/m", Dimension::ForcePerLength, 6),
    pounds("lbf/ft", Dimension::ForcePerLength, 1.0, -1),
    pounds("kip/ft", Dimension::ForcePerLength, 1000.0, -1),
    pounds("plf", Dimension::ForcePerLength, 1.0, -1),
    pounds("klf", Dimension::ForcePerLength, 1000.0, -1),
    pounds_inch("lbf/in", Dimension::ForcePerLength, 1.0, -1),
    ten("kNm", Dimension::Moment, 3),
    ten("Nm", Dimension::Moment, 0),
    ten("MNm", Dimension::Moment, 6),
    ten("kNm/m", Dimension::MomentPerLength, 3),
    ten("Nm/m", Dimension::MomentPerLength, 0),
    ten("MNm/m", Dimension::MomentPerLength, 6),
    pounds("lbf-ft/ft", Dimension::MomentPerLength, 1.0, 0),
    pounds("kip-ft/ft", Dimension::MomentPerLength, 1000.0, 0),
    ten("kg/m3", Dimension::MassDensity, 0),
    ten("t/m3", Dimension::MassDensity, 3),
    ten("Mg/m3", Dimension::MassDensity, 3),
    ten("g/cm3", Dimension::MassDensity, 3),
    ten("kg/dm3", Dimension::MassDensity, 3),
    ten("kg/l", Dimension::MassDensity, 3),
    ten("N", Dimension::Force, 0),
    ten("kN", Dimension::Force, 3),
    ten("MN", Dimension::Force, 6),
    pounds("lbf", Dimension::Force, 1.0, 0),
    pounds("kip", Dimension::Force, 1000.0, 0),
    ten("m2", Dimension::Area, 0),
    ten("mm2", Dimension::Area, -6),
    ten("cm2", Dimension::Area, -4),
    ten("km2", Dimension::Area, 6),
    feet("ft2", Dimension::Area, 1.0, 2),
    inches("in2", Dimension::Area, 1.0, 2),
    ten("s", Dimension::Time, 0),
    ten("ms", Dimension::Time, -3),
    seconds("min", 60.0),
    seconds("h", 3600.0),
    seconds("d", 86_400.0),
    seconds("a", 31_557_600.0),
    rate("m/s", Dimension::Velocity, 1.0, 1.0),
    rate("cm/s", Dimension::Velocity, 1.0, 100.0),
    rate("mm/s", Dimension::Velocity, 1.0, 1000.0),
    rate("m/h", Dimension::Velocity, 1.0, 3600.0),
    rate("mm/h", Dimension::Velocity, 1.0, 3_600_000.0),
    rate("m/d", Dimension::Velocity, 1.0, 86_400.0),
    rate("m/day", Dimension::Velocity, 1.0, 86_400.0),
    rate("mm/d", Dimension::Velocity, 1.0, 86_400_000.0),
    rate("mm/day", Dimension::Velocity, 1.0, 86_400_000.0),
    rate("m/a", Dimension::Velocity, 1.0, 31_557_600.0),
    rate("mm/a", Dimension::Velocity, 1.0, 31_557_600_000.0),
    rate("ft/s", Dimension::Velocity, 0.3048, 1.0),
    rate("ft/d", Dimension::Velocity, 0.3048, 86_400.0),
    rate("m2/s", Dimension::DischargePerLength, 1.0, 1.0),
    rate("m2/d", Dimension::DischargePerLength, 1.0, 86_400.0),
    rate("m2/day", Dimension::DischargePerLength, 1.0, 86_400.0),
    rate("m3/d/m", Dimension::DischargePerLength, 1.0, 86_400.0),
    rate("m3/s", Dimension::Discharge, 1.0, 1.0),
    rate("m3/h", Dimension::Discharge, 1.0, 3600.0),
    rate("m3/d", Dimension::Discharge, 1.0, 86_400.0),
    rate("m3/day", Dimension::Discharge, 1.0, 86_400.0),
    rate("l/s", Dimension::Discharge, 1.0, 1000.0),
    rate("l/min", Dimension::Discharge, 1.0, 60_000.0),
    rate("1/s", Dimension::StrainRate, 1.0, 1.0),
    rate("1/min", Dimension::StrainRate, 1.0, 60.0),
    rate("1/h", Dimension::StrainRate, 1.0, 3600.0),
    rate("1/d", Dimension::StrainRate, 1.0, 86_400.0),
    rate("%/s", Dimension::StrainRate, 1.0, 100.0),
    rate("%/min", Dimension::StrainRate, 1.0, 6000.0),
    rate("%/h", Dimension::StrainRate, 1.0, 360_000.0),
    rate("%/d", Dimension::StrainRate, 1.0, 8_640_000.0),
];
