//! Conditions of a flow: soils, heads, flows, and the results that are asked for.

use std::f64::consts::TAU;

use crate::curve::{Curve, Pores};

/// Permeability of a soil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Soil {
    /// Along its bedding \[m/s\].
    pub along: f64,
    /// Across its bedding \[m/s\].
    pub across: f64,
    /// Angle by which the bedding rises towards +x \[rad\].
    pub angle: f64,
    /// Its curve of permeability and water where it is not saturated.
    pub curve: Curve,
    /// Share of its volume that it gives back as water where it drains \[-\]; flows in time need it.
    pub drainable: f64,
    /// Water by volume that it gives back where the head falls and its pores stay full, m_v γ_w \[1/m\].
    pub specific_storage: f64,
}

impl Soil {
    /// The same in all directions \[m/s\].
    pub fn isotropic(permeability: f64) -> Self {
        Self {
            along: permeability,
            across: permeability,
            angle: 0.0,
            curve: Curve::Ramp,
            drainable: 0.0,
            specific_storage: 0.0,
        }
    }

    /// How its pores give water back.
    pub(crate) fn pores(&self) -> Pores {
        Pores {
            curve: self.curve,
            drainable: self.drainable,
            specific_storage: self.specific_storage,
        }
    }

    /// The tensor of permeability \[m/s\].
    pub fn tensor<const D: usize>(&self) -> [[f64; D]; D] {
        let (sin, cos) = self.angle.sin_cos();
        let mut tensor = [[0.0; D]; D];
        for axis in 1..D - 1 {
            tensor[axis][axis] = self.along;
        }
        tensor[0][0] = self.along * cos * cos + self.across * sin * sin;
        tensor[D - 1][D - 1] = self.along * sin * sin + self.across * cos * cos;
        tensor[0][D - 1] = (self.along - self.across) * sin * cos;
        tensor[D - 1][0] = tensor[0][D - 1];
        tensor
    }
}

/// A box, faces included: lower and upper corner \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent<const D: usize> {
    /// Lower corner \[m\].
    pub lower: [f64; D],
    /// Upper corner \[m\].
    pub upper: [f64; D],
}

impl<const D: usize> Extent<D> {
    /// Whether a point lies in it or no farther off than `reach` \[m\].
    pub fn holds(&self, x: &[f64; D], reach: f64) -> bool {
        (0..D)
            .all(|axis| self.lower[axis] - reach <= x[axis] && x[axis] <= self.upper[axis] + reach)
    }

    /// Whether it shares more than a face with another.
    pub(crate) fn meets(&self, lower: &[f64; D], upper: &[f64; D]) -> bool {
        (0..D).all(|axis| self.lower[axis] < upper[axis] && lower[axis] < self.upper[axis])
    }
}

/// The condition on the faces of the ground within a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OnFaces {
    /// Water of this head \[m\] stands before them; above its level they are as if nothing were said.
    Head(f64),
    /// So much water enters by the area of the face \[m/s\]; negative leaves.
    Inflow(f64),
    /// So much rain falls by the area in plan on faces that rise \[m/s\]; the excess runs off, and water may come out. Other
    /// faces are as if nothing were said.
    Recharge(f64),
    /// Water comes out where its pressure would be positive, and none enters: a seepage face, a filter.
    Open,
    /// Neither in nor out.
    Closed,
}

/// The condition within a box of the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InGround {
    /// A head \[m\]: a well that is kept at its level, a spring.
    Head(f64),
    /// Water leaves where its pressure would be positive, and none enters: a drain.
    Drain,
    /// So much water enters all of it \[m³/s\], in the plane by the metre run \[m²/s\]; negative leaves.
    Inflow(f64),
    /// Another soil, by index: a core, a cut-off wall.
    Soil(usize),
}

/// A condition under a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Named<const D: usize, T> {
    /// Name.
    pub name: String,
    /// Where it holds.
    pub within: Extent<D>,
    /// The condition.
    pub condition: T,
}

/// A level of free water by place; none where there is none.
pub type FreeWater<'a, const D: usize> = &'a (dyn Fn(&[f64; D]) -> Option<f64> + Sync);

/// All that a flow is given beside the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Conditions<const D: usize> {
    /// Soils, by the index that bodies have.
    pub soils: Vec<Soil>,
    /// On faces: the last that holds one counts.
    pub faces: Vec<Named<D, OnFaces>>,
    /// Within the ground: the last that holds a point counts.
    pub regions: Vec<Named<D, InGround>>,
    /// Sections whose discharge is asked for: boxes without extent along one axis.
    pub sections: Vec<(String, Extent<D>)>,
    /// Whether x is the radius of a body of revolution, whose flows are those of the whole circle; in the plane alone.
    pub axisymmetric: bool,
    /// Whether all pores are full, and heads may be below the ground: no free surface.
    pub confined: bool,
    /// Height over which relative permeability falls \[m\]; none: that of the tallest cell.
    pub width: Option<f64>,
    /// Share of the permeability that dry soil keeps \[-\].
    pub floor: f64,
}

impl<const D: usize> Conditions<D> {
    /// Those of soils, with nothing said of faces.
    pub fn of(soils: Vec<Soil>) -> Self {
        Self {
            soils,
            faces: Vec::new(),
            regions: Vec::new(),
            sections: Vec::new(),
            axisymmetric: false,
            confined: false,
            width: None,
            floor: 1e-3,
        }
    }

    /// The thickness of the ground at a radius.
    pub(crate) fn thickness(&self, radius: f64) -> f64 {
        thickness(self.axisymmetric, radius)
    }
}

/// The thickness of the ground at a radius, $`2πr`$ around an axis \[m\], or one (theory, eq. 130g).
pub(crate) fn thickness(axisymmetric: bool, radius: f64) -> f64 {
    if axisymmetric { TAU * radius } else { 1.0 }
}
