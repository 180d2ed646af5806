//! Particles as arrays. The memory of the engine is handed over to numpy, not copied.

use igimp_assembly::ParticleFields;
use igimp_results::fields::regime;
use igimp_results::tables::table::Table;
use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The arrays of a body by name, with the shape of what each holds by particle; named as the files of a
/// checkpoint.
#[derive(Debug, Default)]
pub(crate) struct Arrays {
    particles: usize,
    numbers: Vec<(&'static str, Vec<f64>, Vec<usize>)>,
    counts: Vec<(&'static str, Vec<u64>)>,
    regime: Vec<u8>,
}

impl Arrays {
    /// Takes the arrays of particles over.
    pub(crate) fn of<const D: usize>(fields: ParticleFields<D>) -> Self {
        let counted = |values: Vec<usize>| values.into_iter().map(|value| value as u64).collect();
        let ratios: Vec<[f64; 3]> = (fields.ratios.iter())
            .map(|own| [own.strength, own.friction, own.stiffness])
            .collect();
        let history = fields.history.iter().map(|own| own.eps_p_eq).collect();
        let tensors = |values: Vec<[[f64; 3]; 3]>| values.into_flattened().into_flattened();
        Self {
            particles: fields.x.len(),
            regime: fields.regime.iter().map(|&own| regime::code(own)).collect(),
            counts: vec![
                ("number", counted(fields.number)),
                ("law", counted(fields.law)),
            ],
            numbers: vec![
                ("x", fields.x.into_flattened(), vec![D]),
                (
                    "displacement",
                    fields.displacement.into_flattened(),
                    vec![D],
                ),
                (
                    "def_grad",
                    fields.def_grad.into_flattened().into_flattened(),
                    vec![D, D],
                ),
                ("b_e", tensors(fields.b_e), vec![3, 3]),
                ("sigma", tensors(fields.sigma), vec![3, 3]),
                ("half_length", fields.half_length.into_flattened(), vec![D]),
                (
                    "half_length0",
                    fields.half_length0.into_flattened(),
                    vec![D],
                ),
                ("centroid", fields.centroid.into_flattened(), vec![D]),
                ("volume0", fields.volume0, Vec::new()),
                ("mass", fields.mass, Vec::new()),
                ("pore_pressure", fields.pore_pressure, Vec::new()),
                ("excess", fields.excess, Vec::new()),
                ("ratios", ratios.into_flattened(), vec![3]),
                ("eps_p_eq", history, Vec::new()),
            ],
        }
    }

    /// Hands the arrays over to Python.
    pub(crate) fn into_dict(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let dict = PyDict::new(py);
        let n = self.particles;
        for (name, values, shape) in self.numbers {
            let shape: Vec<usize> = std::iter::once(n).chain(shape).collect();
            dict.set_item(name, shaped(py, values, shape)?)?;
        }
        for (name, values) in self.counts {
            dict.set_item(name, shaped(py, values, vec![n])?)?;
        }
        dict.set_item("regime", shaped(py, self.regime, vec![n])?)?;
        Ok(dict)
    }
}

fn shaped<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    shape: Vec<usize>,
) -> PyResult<Bound<'_, PyAny>> {
    let flat = PyArray1::from_vec(py, values);
    Ok(if shape.len() == 1 {
        flat.into_any()
    } else {
        flat.reshape(shape)?.into_any()
    })
}

/// Tables as (name, header, array with a row a row).
pub(crate) fn tables(py: Python<'_>, tables: Vec<Table>) -> PyResult<Vec<Bound<'_, PyAny>>> {
    tables
        .into_iter()
        .map(|table| {
            let shape = vec![table.rows.len(), table.header.len()];
            let values = shaped(py, table.rows.concat(), shape)?;
            let whole = (table.name, table.header, values).into_pyobject(py)?;
            Ok(whole.into_any())
        })
        .collect()
}
