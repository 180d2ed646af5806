//! Named arrays of tuples on points or cells.

use crate::npy::Values;

/// Numbers on points or cells, a tuple each, with a name that tells unit and sign.
#[derive(Clone, Debug, PartialEq)]
pub struct DataArray {
    name: String,
    components: usize,
    component_names: Vec<String>,
    values: Values,
}

/// How many numbers stand together, and their names in ParaView.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tuple {
    /// One number.
    Scalar,
    /// X, Y, Z.
    Vector,
    /// XX, YY, ZZ, XY, YZ, XZ: the order of ParaView.
    SymmetricTensor,
    /// XX, XY, XZ, YX, …, ZZ: row by row.
    Tensor,
}

impl Tuple {
    /// Names of the components; none for a scalar.
    pub fn names(self) -> &'static [&'static str] {
        match self {
            Self::Scalar => &[],
            Self::Vector => &["X", "Y", "Z"],
            Self::SymmetricTensor => &["XX", "YY", "ZZ", "XY", "YZ", "XZ"],
            Self::Tensor => &["XX", "XY", "XZ", "YX", "YY", "YZ", "ZX", "ZY", "ZZ"],
        }
    }
}

impl DataArray {
    /// An array of tuples.
    ///
    /// # Panics
    /// If the last tuple is not complete.
    pub fn new(name: impl Into<String>, tuple: Tuple, values: Values) -> Self {
        let component_names: Vec<String> = tuple.names().iter().map(|&n| n.to_owned()).collect();
        let components = component_names.len().max(1);
        assert_eq!(values.len() % components, 0, "tuples are complete");
        Self {
            name: name.into(),
            components,
            component_names,
            values,
        }
    }

    /// Real numbers.
    pub fn scalars(name: impl Into<String>, values: Vec<f64>) -> Self {
        Self::new(name, Tuple::Scalar, Values::F64(values))
    }

    /// Integers.
    pub fn integers(name: impl Into<String>, values: Vec<i32>) -> Self {
        Self::new(name, Tuple::Scalar, Values::I32(values))
    }

    /// Vectors of at most three components, filled up with zeros.
    pub fn vectors<const D: usize>(name: impl Into<String>, vectors: &[[f64; D]]) -> Self {
        let values = vectors.iter().flat_map(padded).collect();
        Self::new(name, Tuple::Vector, Values::F64(values))
    }

    /// Symmetric tensors, of which the upper triangle is taken.
    pub fn symmetric(name: impl Into<String>, tensors: &[[[f64; 3]; 3]]) -> Self {
        let values = tensors
            .iter()
            .flat_map(|t| [t[0][0], t[1][1], t[2][2], t[0][1], t[1][2], t[0][2]])
            .collect();
        Self::new(name, Tuple::SymmetricTensor, Values::F64(values))
    }

    /// Tensors of at most three dimensions, filled up with the identity: stretch 1 across the
    /// plane.
    pub fn tensors<const D: usize>(name: impl Into<String>, tensors: &[[[f64; D]; D]]) -> Self {
        let entry = |tensor: &[[f64; D]; D], row: usize, column: usize| {
            if row < D && column < D {
                tensor[row][column]
            } else {
                f64::from(u8::from(row == column))
            }
        };
        let values = tensors
            .iter()
            .flat_map(|tensor| (0..9).map(move |k| entry(tensor, k / 3, k % 3)))
            .collect();
        Self::new(name, Tuple::Tensor, Values::F64(values))
    }

    /// Name with unit and sign.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Numbers in a tuple.
    pub fn components(&self) -> usize {
        self.components
    }

    /// Names of the components; none for scalars.
    pub fn component_names(&self) -> &[String] {
        &self.component_names
    }

    /// Number of tuples.
    pub fn tuples(&self) -> usize {
        self.values.len() / self.components
    }

    /// The numbers, tuple after tuple.
    pub fn values(&self) -> &Values {
        &self.values
    }
}

/// A vector of the plane or of space in three components.
pub fn padded<const D: usize>(vector: &[f64; D]) -> [f64; 3] {
    std::array::from_fn(|axis| vector.get(axis).copied().unwrap_or(0.0))
}
