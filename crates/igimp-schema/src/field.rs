//! Fields on particles, declared once: name in case files and tables, title and sign in print, unit, array in frames for ParaView.

use crate::spec::{Choice, choice};
use crate::tree::read::Read;
use crate::tree::{Node, Wrong};

/// The kind of number of a field: fields of a kind share an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Dimension {
    /// A displacement \[m\].
    Displacement,
    /// A position \[m\].
    Position,
    /// A stress \[Pa\].
    Stress,
    /// A strain \[-\].
    Strain,
    /// A share \[-\].
    Share,
    /// An angle \[rad\].
    Angle,
    /// A velocity \[m/s\].
    Velocity,
    /// An acceleration \[m/s²\].
    Acceleration,
}

impl Dimension {
    /// The SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Displacement | Self::Position => "m",
            Self::Stress => "Pa",
            Self::Strain | Self::Share => "-",
            Self::Angle => "rad",
            Self::Velocity => "m/s",
            Self::Acceleration => "m/s2",
        }
    }
}

/// Which sign a field is printed with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// Its own.
    Own,
    /// Compression positive.
    Compression,
    /// That which goes with compression positive, in shear.
    Shear,
}

/// Names of the arrays of frames for ParaView.
pub mod arrays {
    /// Displacement, a vector.
    pub const DISPLACEMENT: &str = "displacement [m]";
    /// Velocity, a vector.
    pub const VELOCITY: &str = "velocity [m/s]";
    /// Acceleration, a vector.
    pub const ACCELERATION: &str = "acceleration [m/s2]";
    /// Total stress, a symmetric tensor.
    pub const TOTAL: &str = "sigma [Pa], tension +";
    /// Effective stress, a symmetric tensor; without water there is none.
    pub const EFFECTIVE: &str = "sigma_eff [Pa], tension +";
}
use arrays::{ACCELERATION, DISPLACEMENT, EFFECTIVE, TOTAL, VELOCITY};

/// Where a field stands in the frames for ParaView.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InFrames {
    /// An array of its own, with its sign.
    Scalar(&'static str),
    /// A component of an array of vectors.
    Component(&'static str, usize),
    /// The length of an array of vectors.
    Length(&'static str),
    /// A component of an array of symmetric tensors, tension positive: xx, yy, zz, xy, yz, xz.
    Tension(&'static str, usize),
    /// A coordinate of the middle of a cell.
    Middle(usize),
}

/// How a field is declared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Declaration {
    name: &'static str,
    dimension: Dimension,
    sign: Sign,
    /// In plane strain, of bodies of revolution and in space; none: there is none in plane strain.
    titles: (Option<[&'static str; 2]>, &'static str),
    in_frames: InFrames,
}

/// The names of the axes of an analysis in print.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axes {
    /// Plane strain: x level, y upright, z out of the plane.
    Plane,
    /// Bodies of revolution: x the radius, y upright, z around the axis.
    Revolution,
    /// Space: z upright.
    Space,
}

/// Declares the fields: `Variant "name" dimension sign "title" => "text of the reference", place in frames;`, with `in_space "title"`
/// for another title in space, `around "title"` for one of bodies of revolution, and `only_in_space` before the title of one that plane strain does not have.
macro_rules! fields {
    ($(
        $(#[$doc:meta])*
        $variant:ident $name:literal $dimension:ident $sign:ident
        $($title:literal)? $(in_space $space:literal)? $(around $around:literal)? $(only_in_space $only:literal)?
        => $reference:literal, $place:ident($($at:expr),*);
    )*) => {
        /// A field on particles, as it is printed: stress compression positive.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Field {
            $($(#[$doc])* $variant,)*
        }

        const DECLARATIONS: &[Declaration] = &[$(Declaration {
            name: $name,
            dimension: Dimension::$dimension,
            sign: Sign::$sign,
            titles: fields!(@titles $($title)? $(in_space $space)? $(around $around)? $(only_in_space $only)?),
            in_frames: InFrames::$place($($at),*),
        },)*];

        impl Field {
            /// Every field.
            pub const ALL: &[Self] = &[$(Self::$variant,)*];

            /// The fields as a case file names them.
            pub(crate) const CHOICES: &[Choice] = &[$(choice($name, $reference),)*];
        }

    };
    (@titles $title:literal) => { (Some([$title; 2]), $title) };
    (@titles $title:literal around $around:literal) => { (Some([$title, $around]), $title) };
    (@titles $title:literal in_space $space:literal) => { (Some([$title; 2]), $space) };
    (@titles $title:literal in_space $space:literal around $around:literal) => {
        (Some([$title, $around]), $space)
    };
    (@titles only_in_space $only:literal) => { (None, $only) };
}

fields! {
    /// Length of the displacement \[m\].
    Displacement "displacement" Displacement Own "displacement |u|"
        => "length of the displacement [m]", Length(DISPLACEMENT);
    /// Displacement in x \[m\].
    DisplacementX "displacement_x" Displacement Own
        "horizontal displacement u_{x}" in_space "displacement u_{x}" around "radial displacement u_{x}"
        => "displacement in x [m]", Component(DISPLACEMENT, 0);
    /// Displacement in y \[m\].
    DisplacementY "displacement_y" Displacement Own
        "vertical displacement u_{y}" in_space "displacement u_{y}" => "displacement in y [m]", Component(DISPLACEMENT, 1);
    /// Displacement in z \[m\]; in space.
    DisplacementZ "displacement_z" Displacement Own
        only_in_space "vertical displacement u_{z}" => "displacement in z, in space [m]", Component(DISPLACEMENT, 2);
    /// Position x \[m\].
    X "x" Position Own "position x" => "position x [m]", Middle(0);
    /// Position y \[m\].
    Y "y" Position Own "position y" => "position y [m]", Middle(1);
    /// Position z \[m\]; in space.
    Z "z" Position Own only_in_space "position z" => "position z, in space [m]", Middle(2);
    /// −σ_xx of total stress \[Pa\].
    SigmaXx "sigma_xx" Stress Compression "horizontal stress −σ_{xx}" around "radial stress −σ_{xx}"
        => "total stress xx, compression positive [Pa]", Tension(TOTAL, 0);
    /// −σ_yy of total stress \[Pa\].
    SigmaYy "sigma_yy" Stress Compression
        "vertical stress −σ_{yy}" in_space "horizontal stress −σ_{yy}"
        => "total stress yy, compression positive [Pa]", Tension(TOTAL, 1);
    /// −σ_zz of total stress \[Pa\].
    SigmaZz "sigma_zz" Stress Compression
        "out-of-plane stress −σ_{zz}" in_space "vertical stress −σ_{zz}" around "hoop stress −σ_{zz}"
        => "total stress zz, compression positive [Pa]", Tension(TOTAL, 2);
    /// −τ_xy \[Pa\].
    TauXy "tau_xy" Stress Shear "shear stress −τ_{xy}"
        => "shear stress, with the sign of compression positive [Pa]", Tension(TOTAL, 3);
    /// −τ_yz \[Pa\]; in space.
    TauYz "tau_yz" Stress Shear only_in_space "shear stress −τ_{yz}"
        => "the same in y and z, in space [Pa]", Tension(TOTAL, 4);
    /// −τ_xz \[Pa\]; in space.
    TauXz "tau_xz" Stress Shear only_in_space "shear stress −τ_{xz}"
        => "the same in x and z, in space [Pa]", Tension(TOTAL, 5);
    /// Mean pressure p = −tr σ/3 of total stress \[Pa\].
    P "p" Stress Compression "mean pressure p" => "mean pressure of total stress [Pa]", Scalar("p [Pa], compression +");
    /// −σ′_xx of effective stress: the stress that the law speaks of \[Pa\].
    SigmaEffXx "sigma_eff_xx" Stress Compression "effective horizontal stress −σ′_{xx}" around "effective radial stress −σ′_{xx}"
        => "effective stress xx, compression positive [Pa]; without water the same as sigma_xx", Tension(EFFECTIVE, 0);
    /// −σ′_yy of effective stress \[Pa\].
    SigmaEffYy "sigma_eff_yy" Stress Compression
        "effective vertical stress −σ′_{yy}" in_space "effective horizontal stress −σ′_{yy}"
        => "effective stress yy, compression positive [Pa]", Tension(EFFECTIVE, 1);
    /// −σ′_zz of effective stress \[Pa\].
    SigmaEffZz "sigma_eff_zz" Stress Compression
        "effective out-of-plane stress −σ′_{zz}" in_space "effective vertical stress −σ′_{zz}"
        around "effective hoop stress −σ′_{zz}"
        => "effective stress zz, compression positive [Pa]", Tension(EFFECTIVE, 2);
    /// Mean effective pressure p′ = −tr σ′/3 \[Pa\].
    PEff "p_eff" Stress Compression "mean effective pressure p′"
        => "mean pressure of effective stress [Pa]", Scalar("p_eff [Pa], compression +");
    /// Pore pressure u, given and excess \[Pa\].
    U "u" Stress Compression "pore pressure u"
        => "pore pressure, given and excess, compression positive [Pa]", Scalar("u [Pa], compression +");
    /// Excess pore pressure that undrained soil made itself \[Pa\].
    UExcess "u_excess" Stress Compression "excess pore pressure Δu"
        => "excess pore pressure of undrained soil, compression positive [Pa]", Scalar("u_excess [Pa], compression +");
    /// Deviatoric stress q = √(3/2)‖s‖ \[Pa\].
    Q "q" Stress Own "deviatoric stress q" => "deviatoric stress [Pa]", Scalar("q [Pa]");
    /// Accumulated plastic strain invariant \[-\].
    PlasticStrain "plastic_strain" Strain Own "plastic strain ε_{p}"
        => "accumulated plastic strain invariant [-]", Scalar("plastic strain [-]");
    /// Share of the strength that is mobilised \[-\].
    Utilisation "utilisation" Share Own "share of the shear strength"
        => "share of the strength that is mobilised [-]", Scalar("utilisation [-]");
    /// Undrained strength or cohesion \[Pa\]; none of soil without a strength limit.
    Strength "strength" Stress Own "undrained strength or cohesion"
        => "undrained strength or cohesion that soil carries [Pa]", Scalar("strength [Pa]");
    /// Angle of friction \[rad\]; none of soil without a strength limit.
    Friction "friction" Angle Own "angle of friction φ"
        => "angle of friction that soil carries [rad]", Scalar("friction angle [rad]");
    /// Young's modulus \[Pa\].
    Young "young" Stress Own "Young's modulus E" => "Young's modulus that soil carries [Pa]", Scalar("Young's modulus [Pa]");
    /// Speed: length of the velocity \[m/s\]; in motion.
    Speed "speed" Velocity Own "speed |v|" => "length of the velocity, in motion [m/s]", Length(VELOCITY);
    /// Velocity in x \[m/s\]; in motion.
    VelocityX "velocity_x" Velocity Own
        "horizontal velocity v_{x}" in_space "velocity v_{x}" around "radial velocity v_{x}"
        => "velocity in x, in motion [m/s]", Component(VELOCITY, 0);
    /// Velocity in y \[m/s\]; in motion.
    VelocityY "velocity_y" Velocity Own
        "vertical velocity v_{y}" in_space "velocity v_{y}" => "velocity in y, in motion [m/s]", Component(VELOCITY, 1);
    /// Velocity in z \[m/s\]; in motion in space.
    VelocityZ "velocity_z" Velocity Own
        only_in_space "vertical velocity v_{z}" => "velocity in z, in motion in space [m/s]", Component(VELOCITY, 2);
    /// Length of the acceleration \[m/s²\]; in motion.
    Acceleration "acceleration" Acceleration Own "acceleration |a|"
        => "length of the acceleration, in motion [m/s2]", Length(ACCELERATION);
    /// Acceleration in x \[m/s²\]; in motion.
    AccelerationX "acceleration_x" Acceleration Own
        "horizontal acceleration a_{x}" in_space "acceleration a_{x}" around "radial acceleration a_{x}"
        => "acceleration in x, in motion [m/s2]", Component(ACCELERATION, 0);
    /// Acceleration in y \[m/s²\]; in motion.
    AccelerationY "acceleration_y" Acceleration Own
        "vertical acceleration a_{y}" in_space "acceleration a_{y}"
        => "acceleration in y, in motion [m/s2]", Component(ACCELERATION, 1);
    /// Acceleration in z \[m/s²\]; in motion in space.
    AccelerationZ "acceleration_z" Acceleration Own
        only_in_space "vertical acceleration a_{z}"
        => "acceleration in z, in motion in space [m/s2]", Component(ACCELERATION, 2);
}

impl Read for Field {
    fn read(node: &Node) -> Result<Self, Wrong> {
        node.text().and_then(Self::of_name).ok_or(Wrong)
    }
}

impl Field {
    fn declaration(self) -> &'static Declaration {
        &DECLARATIONS[self as usize]
    }

    /// The field of a name in case files.
    pub fn of_name(name: &str) -> Option<Self> {
        let mut all = Self::ALL.iter();
        all.find(|field| field.name() == name).copied()
    }

    /// Name in case files.
    pub fn name(self) -> &'static str {
        self.declaration().name
    }

    /// Its kind of number.
    pub fn dimension(self) -> Dimension {
        self.declaration().dimension
    }

    /// The sign that it is printed with.
    pub fn sign(self) -> Sign {
        self.declaration().sign
    }

    /// Where it stands in the frames for ParaView.
    pub fn in_frames(self) -> InFrames {
        self.declaration().in_frames
    }

    /// Whether there is such a number in so many dimensions.
    pub fn exists_in(self, dimensions: usize) -> bool {
        dimensions == 3 || self.declaration().titles.0.is_some()
    }

    /// Whether only bodies that move in time have it.
    pub fn is_of_motion(self) -> bool {
        matches!(
            self.dimension(),
            Dimension::Velocity | Dimension::Acceleration
        )
    }

    /// Whether it is one of total stress that has a counterpart of effective stress.
    pub fn is_total(self) -> bool {
        Self::ALL.iter().any(|field| field.of_total() == Some(self))
    }

    /// The field of total stress that it is without water; none of a field that is none of effective stress.
    pub fn of_total(self) -> Option<Self> {
        let (kind, component) = self.name().split_once("_eff")?;
        Self::of_name(&format!("{kind}{component}"))
    }

    /// The header of its column in a table, such as `sigma_yy_[Pa]_compression_+`.
    pub fn header(self) -> String {
        let sign = match self.sign() {
            Sign::Own => "",
            Sign::Compression | Sign::Shear => "_compression_+",
        };
        format!("{}_[{}]{sign}", self.name(), self.dimension().unit())
    }

    /// Its title where the axes are called so, in words and signs with the index marks of figures.
    pub fn title_in(self, axes: Axes) -> &'static str {
        let (in_plane, space) = self.declaration().titles;
        match (axes, in_plane) {
            (Axes::Plane, Some([plane, _])) => plane,
            (Axes::Revolution, Some([_, around])) => around,
            _ => space,
        }
    }

    /// Its title in plane strain.
    pub fn title(self) -> &'static str {
        self.title_in(Axes::Plane)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_has_its_own_name_and_header() {
        for &field in Field::ALL {
            assert_eq!(Field::of_name(field.name()), Some(field));
            assert!(field.header().starts_with(field.name()));
        }
        assert_eq!(Field::SigmaYy.header(), "sigma_yy_[Pa]_compression_+");
        assert_eq!(Field::Displacement.header(), "displacement_[m]");
        assert_eq!(Field::Utilisation.header(), "utilisation_[-]");
        assert_eq!(Field::Strength.header(), "strength_[Pa]");
        assert_eq!(Field::Friction.header(), "friction_[rad]");
        assert_eq!(Field::Speed.header(), "speed_[m/s]");
        assert_eq!(Field::AccelerationY.header(), "acceleration_y_[m/s2]");
    }

    #[test]
    fn total_stresses_have_effective_counterparts() {
        let total: Vec<Field> = Field::ALL
            .iter()
            .copied()
            .filter(|f| f.is_total())
            .collect();
        let expected = [Field::SigmaXx, Field::SigmaYy, Field::SigmaZz, Field::P];
        assert_eq!(total, expected);
    }

    #[test]
    fn some_fields_are_of_space_alone() {
        let only: Vec<&str> = (Field::ALL.iter())
            .filter(|field| !field.exists_in(2))
            .map(|field| field.name())
            .collect();
        assert_eq!(
            only,
            [
                "displacement_z",
                "z",
                "tau_yz",
                "tau_xz",
                "velocity_z",
                "acceleration_z"
            ]
        );
    }
}
