//! A body as named arrays of numbers, and back.

use igimp_assembly::{
    AssemblyError, ColumnKind, ColumnValues, LoadPoint, ParticleFields, Particles,
};
use igimp_solver::Body;

use crate::npy::{Array, Values};

/// The arrays of a body by name.
pub(super) fn of_body<const D: usize>(body: &Body<D>) -> Vec<(&'static str, Array)> {
    let n = body.particles.len();
    let columns = (*body.particles).clone().into_columns().into_iter();
    let mut arrays: Vec<(&'static str, Array)> = columns
        .map(|column| {
            let values = match column.values {
                ColumnValues::F64(values) => Values::F64(values),
                ColumnValues::U64(values) => Values::U64(values),
                ColumnValues::U8(values) => Values::U8(values),
            };
            (column.name, Array::new(&shape(n, column.shape), values))
        })
        .collect();
    let points: Vec<_> = body.load_points.iter().map(|point| point.x).collect();
    let forces: Vec<_> = body.load_points.iter().map(|point| point.force).collect();
    let loads = body.load_points.iter().map(|point| point.load as u64);
    let loads = Values::U64(loads.collect());
    arrays.extend([
        ("load_point_x", vectors(&points)),
        ("load_point_force", vectors(&forces)),
        ("load_point_load", Array::new(&[points.len()], loads)),
    ]);
    arrays
}

/// The shape of a column of `n` particles.
fn shape(n: usize, of_one: &[usize]) -> Vec<usize> {
    [&[n], of_one].concat()
}

/// The body of numbers of particles and load points, from the bytes of its array files, of which optional ones may be none.
///
/// An error is the name of an array and why it does not serve.
pub(super) fn to_body<const D: usize>(
    [n, m]: [usize; 2],
    bytes: impl Fn(&'static str) -> Result<Option<Vec<u8>>, String>,
) -> Result<Body<D>, (&'static str, String)> {
    let array = |name: &'static str, shape: &[usize]| {
        let Some(bytes) = bytes(name)? else {
            return Ok(None);
        };
        let array = Array::from_bytes(&bytes).map_err(|error| error.to_string())?;
        if array.shape() == shape {
            Ok(Some(array.into_values()))
        } else {
            let found = array.shape();
            Err(format!("its shape is {found:?} instead of {shape:?}"))
        }
    };
    let fields = ParticleFields::from_columns(n, |column| {
        match (array(column.name, &shape(n, column.shape))?, column.kind) {
            (Some(Values::F64(values)), ColumnKind::F64) => Ok(Some(ColumnValues::F64(values))),
            (Some(Values::U64(values)), ColumnKind::U64) => Ok(Some(ColumnValues::U64(values))),
            (Some(Values::U8(values)), ColumnKind::U8) => Ok(Some(ColumnValues::U8(values))),
            (None, _) if column.is_optional => Ok(None),
            (None, _) => Err(MISSING.to_owned()),
            (Some(_), kind) => Err(other_kind(kind)),
        }
    })?;
    let particles =
        Particles::from_fields(fields).map_err(|error| (array_of(&error), error.to_string()))?;
    let load_points = load_points(m, |name, shape| {
        array(name, shape).and_then(|values| values.ok_or_else(|| MISSING.to_owned()))
    })?;
    Ok(Body {
        particles,
        load_points,
        rigid: Vec::new(),
        reinforcement: Vec::new(),
        free_fields: Vec::new(),
    })
}

/// The load points of a body, from their arrays by name and shape.
fn load_points<const D: usize>(
    m: usize,
    array: impl Fn(&'static str, &[usize]) -> Result<Values, String>,
) -> Result<Vec<LoadPoint<D>>, (&'static str, String)> {
    let finite = |name: &'static str| match array(name, &[m, D]).map_err(|why| (name, why))? {
        Values::F64(values) => {
            let rows = values.as_chunks::<D>().0.to_vec();
            let is_finite = |row: &[f64; D]| row.iter().all(|value| value.is_finite());
            match rows.iter().position(|row| !is_finite(row)) {
                Some(point) => Err((name, format!("load point {point} is not finite"))),
                None => Ok(rows),
            }
        }
        _ => Err((name, other_kind(ColumnKind::F64))),
    };
    let (x, force) = (finite("load_point_x")?, finite("load_point_force")?);
    let name = "load_point_load";
    let Values::U64(loads) = array(name, &[m]).map_err(|why| (name, why))? else {
        return Err((name, other_kind(ColumnKind::U64)));
    };
    let points = std::iter::zip(x, force).zip(loads);
    Ok(points
        .map(|((x, force), load)| LoadPoint {
            x,
            force,
            load: load as usize,
        })
        .collect())
}

/// The message for an array that a checkpoint lacks.
const MISSING: &str = "meta.json does not list it";

/// The message for numbers of another type.
fn other_kind(kind: ColumnKind) -> String {
    let kind = match kind {
        ColumnKind::F64 => "<f8",
        ColumnKind::U64 => "<u8",
        ColumnKind::U8 => "|u1",
    };
    format!("its numbers are not of type {kind}")
}

/// The array that a particle is refused for.
fn array_of(error: &AssemblyError) -> &'static str {
    match error {
        AssemblyError::InvalidParticle {
            field: "det def_grad",
            ..
        } => "def_grad",
        AssemblyError::InvalidParticle { field, .. } => field,
        _ => "x",
    }
}

fn vectors<const N: usize>(values: &[[f64; N]]) -> Array {
    Array::new(
        &[values.len(), N],
        Values::F64(values.as_flattened().to_vec()),
    )
}
