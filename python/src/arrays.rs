//! Particles as arrays. The memory of the engine is handed over to numpy, not copied.

use igimp_assembly::{Column, ColumnValues, ParticleFields};
use igimp_results::tables::table::Table;
use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The columns of the particles of a body, named as the files of a checkpoint.
#[derive(Debug, Default)]
pub(crate) struct Arrays {
    particles: usize,
    columns: Vec<Column>,
}

impl Arrays {
    /// Takes the columns of particles over.
    pub(crate) fn of<const D: usize>(fields: ParticleFields<D>) -> Self {
        Self {
            particles: fields.x.len(),
            columns: fields.into_columns(),
        }
    }

    /// Hands the arrays over to Python.
    pub(crate) fn into_dict(self, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let dict = PyDict::new(py);
        for column in self.columns {
            let shape = [&[self.particles], column.shape].concat();
            let array = match column.values {
                ColumnValues::F64(values) => shaped(py, values, shape)?,
                ColumnValues::U64(values) => shaped(py, values, shape)?,
                ColumnValues::U8(values) => shaped(py, values, shape)?,
            };
            dict.set_item(column.name, array)?;
        }
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
