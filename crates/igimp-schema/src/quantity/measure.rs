//! The dimension of a quotient of quantities, as powers of base units.

use std::fmt::{self, Display, Formatter};

use super::units::Dimension;

/// Dimensions by which a quotient is named, each as the powers of another.
const NAMED: [Dimension; 14] = [
    Dimension::Length,
    Dimension::Stress,
    Dimension::UnitWeight,
    Dimension::UnitWeightGradient,
    Dimension::Acceleration,
    Dimension::ForcePerLength,
    Dimension::MassDensity,
    Dimension::Force,
    Dimension::Moment,
    Dimension::Area,
    Dimension::Time,
    Dimension::Velocity,
    Dimension::DischargePerLength,
    Dimension::Discharge,
];

/// Powers of kilogram, metre and second; an angle has none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Powers([i32; 3]);

impl Powers {
    /// The powers of an SI unit, such as `N m/m`.
    pub fn of_unit(unit: &str) -> Self {
        let mut total = [0; 3];
        for (place, part) in unit.split('/').enumerate() {
            let sign = if place == 0 { 1 } else { -1 };
            for factor in part.split(' ') {
                let symbol = factor.trim_end_matches(|letter: char| letter.is_ascii_digit());
                let power: i32 = factor[symbol.len()..].parse().unwrap_or(1);
                let base = match symbol {
                    "kg" => [1, 0, 0],
                    "m" => [0, 1, 0],
                    "s" => [0, 0, 1],
                    "N" => [1, 1, -2],
                    "Nm" | "J" => [1, 2, -2],
                    "Pa" => [1, -1, -2],
                    _ => [0; 3],
                };
                for (sum, by) in total.iter_mut().zip(base) {
                    *sum += sign * power * by;
                }
            }
        }
        Self(total)
    }

    /// The powers of a dimension; none of a plain number.
    pub fn of(dimension: Option<Dimension>) -> Self {
        dimension.map_or_else(Self::default, |kind| Self::of_unit(kind.si_unit()))
    }

    /// The powers of a quotient.
    #[must_use]
    pub fn over(self, divisor: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] - divisor.0[k]))
    }

    /// The dimension with these powers that is usual.
    pub fn dimension(self) -> Option<Dimension> {
        let same = |named: &&Dimension| Self::of(Some(**named)) == self;
        NAMED.iter().find(same).copied()
    }
}

/// In words, with an article.
impl Display for Powers {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match (*self == Self::default(), self.dimension()) {
            (true, _) => f.write_str("a number without a unit"),
            (false, Some(dimension)) => f.write_str(dimension.name()),
            (false, None) => {
                f.write_str("a quantity in")?;
                let powers = ["kg", "m", "s"].into_iter().zip(self.0);
                powers
                    .filter(|(_, power)| *power != 0)
                    .try_for_each(|(unit, power)| match power {
                        1 => write!(f, " {unit}"),
                        _ => write!(f, " {unit}^{power}"),
                    })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GOAL: units of one dimension have the same powers however they are written, and others differ.
    /// ORACLE: N = kg m/s² and Pa = N/m², by hand.
    #[test]
    fn powers_are_those_of_base_units() {
        let of = Powers::of_unit;
        assert_eq!(of("Pa"), of("N/m2"));
        assert_eq!(of("Pa"), Powers([1, -1, -2]));
        assert_eq!(of("N m/m"), of("Nm/m"));
        assert_eq!(of("J/m"), of("N"));
        assert_eq!(of("N/m3/m"), of("Pa").over(of("m2")));
        assert_eq!(of("1/s"), Powers::default().over(of("s")));
        for none in ["-", "rad"] {
            assert_eq!(of(none), Powers::default());
        }
        assert_eq!(of("rad/s"), of("1/s"));
        assert_eq!(of("N/m").over(of("m")).to_string(), "a stress");
        assert_eq!(
            of("m").over(of("Pa")).to_string(),
            "a quantity in kg^-1 m^2 s^2"
        );
        assert_eq!(of("m").over(of("m")).to_string(), "a number without a unit");
        for one in NAMED {
            let same = NAMED
                .iter()
                .filter(|named| Powers::of(Some(**named)) == Powers::of(Some(one)));
            assert_eq!(same.count(), 1, "{one:?}");
        }
    }
}
