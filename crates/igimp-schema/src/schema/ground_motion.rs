//! Motion of the ground, and what of it concerns walls and soil.

use super::MANY;
use super::declare::{choices, table};

table! {
    GROUND_MOTION: GroundMotion, "Motion of the ground by a record, which is linear between its samples.";
    file: text, optional "`time` and `values` say it",
        "a CSV file with the columns time and acceleration, or time and velocity; its path from the case file";
    unit: choice(RecordUnit), optional "the header of the file says it, as in `acceleration [g]`",
        "unit of acceleration or velocity; it says which of the two the record is";
    time: list(quantity(Time, NotNegative), 2, MANY), optional "`file` says it", "times of the samples, ascending";
    values: list(number(Any), 2, MANY), optional "`file` says it", "acceleration or velocity at these times, in `unit`";
    scale: number(Any), default "1", "factor on acceleration or velocity";
    axis: choice(MotionAxis), default "\"x\"", "the axis along which the ground moves";
    base: choice(BaseKind), default "\"rigid\"", "what lies below the soil";
}

choices! {
    /// Units of a record.
    RecordUnit;
    Gravity "g", "standard gravity, 9.80665 m/s²";
    MetrePerSecondSquared "m/s2", "acceleration";
    CentimetrePerSecondSquared "cm/s2", "acceleration (gal)";
    MillimetrePerSecondSquared "mm/s2", "acceleration";
    MetrePerSecond "m/s", "velocity";
    CentimetrePerSecond "cm/s", "velocity";
    MillimetrePerSecond "mm/s", "velocity";
}

impl RecordUnit {
    /// Its size in SI units, and whether it measures a velocity.
    pub fn in_si(self) -> (f64, bool) {
        match self {
            Self::Gravity => (9.806_65, false),
            Self::MetrePerSecondSquared => (1.0, false),
            Self::CentimetrePerSecondSquared => (1e-2, false),
            Self::MillimetrePerSecondSquared => (1e-3, false),
            Self::MetrePerSecond => (1.0, true),
            Self::CentimetrePerSecond => (1e-2, true),
            Self::MillimetrePerSecond => (1e-3, true),
        }
    }

    /// The one that is written so.
    pub fn named(text: &str) -> Option<Self> {
        let all = [
            Self::Gravity,
            Self::MetrePerSecondSquared,
            Self::CentimetrePerSecondSquared,
            Self::MillimetrePerSecondSquared,
            Self::MetrePerSecond,
            Self::CentimetrePerSecond,
            Self::MillimetrePerSecond,
        ];
        all.into_iter().find(|unit| unit.name() == text)
    }

    /// All of them, as they are written.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Self::CHOICES.iter().map(|choice| choice.name)
    }
}

choices! {
    /// Axes of a motion of the ground.
    MotionAxis;
    X "x", "from left to right";
    Y "y", "upwards in plane strain, across in space";
    Z "z", "upwards in space";
}

choices! {
    /// The base below the soil.
    BaseKind;
    Rigid "rigid", "rock that moves by the record, whatever the soil does";
    Compliant "compliant",
        "rock that goes on, whose outcrop moves by the record: dashpots at the bottom, with the soil that touches it";
}

choices! {
    /// Sides of the grid.
    Wall;
    Left "left", "side of the lowest x";
    Right "right", "side of the highest x";
    Front "front", "side of the lowest y, in space";
    Back "back", "side of the highest y, in space";
    Bottom "bottom", "side of the lowest y, in space of the lowest z";
    Top "top", "side of the highest y, in space of the highest z";
}

table! {
    RAYLEIGH: Rayleigh, "Rayleigh damping: a force (α M + β K_e) v, of this ratio of critical damping at two periods, less between.";
    ratio: number(NotNegative), required "0.02", "ratio of critical damping at both periods";
    periods: pair(quantity(Time, Positive)), required "[\"1 s\", \"0.1 s\"]", "the two periods";
}
