//! A body as named arrays of numbers, and back.

use igimp_assembly::{AssemblyError, LoadPoint, ParticleFields, Particles};
use igimp_material::{History, Ratios};
use igimp_solver::Body;

use crate::fields::regime;
use crate::npy::{Array, Values};

/// The arrays of a body by name.
pub(super) fn of_body<const D: usize>(body: &Body<D>) -> Vec<(&'static str, Array)> {
    let ParticleFields {
        x,
        displacement,
        def_grad,
        b_e,
        sigma,
        half_length,
        half_length0,
        centroid,
        volume0,
        mass,
        pore_pressure,
        excess,
        number,
        law,
        ratios,
        history,
        regime,
    } = &*body.particles;
    let n = x.len();
    let number = number.iter().map(|&number| number as u64).collect();
    let law = law.iter().map(|&law| law as u64).collect();
    let eps_p_eq: Vec<f64> = history
        .iter()
        .map(|History { eps_p_eq }| *eps_p_eq)
        .collect();
    let regime = regime.iter().map(|&regime| regime::code(regime)).collect();
    let ratios: Vec<_> = ratios
        .iter()
        .map(|own| [own.strength, own.friction, own.stiffness])
        .collect();
    let points: Vec<_> = body.load_points.iter().map(|point| point.x).collect();
    let forces: Vec<_> = body.load_points.iter().map(|point| point.force).collect();
    let loads = body.load_points.iter().map(|point| point.load as u64);
    let loads = Values::U64(loads.collect());
    vec![
        ("x", vectors(x)),
        ("displacement", vectors(displacement)),
        ("def_grad", tensors(def_grad)),
        ("b_e", tensors(b_e)),
        ("sigma", tensors(sigma)),
        ("half_length", vectors(half_length)),
        ("half_length0", vectors(half_length0)),
        ("centroid", vectors(centroid)),
        ("volume0", scalars(volume0)),
        ("mass", scalars(mass)),
        ("pore_pressure", scalars(pore_pressure)),
        ("excess", scalars(excess)),
        ("number", Array::new(&[n], Values::U64(number))),
        ("law", Array::new(&[n], Values::U64(law))),
        (
            "ratios",
            Array::new(&[n, 3], Values::F64(ratios.into_flattened())),
        ),
        ("eps_p_eq", scalars(&eps_p_eq)),
        ("regime", Array::new(&[n], Values::U8(regime))),
        ("load_point_x", vectors(&points)),
        ("load_point_force", vectors(&forces)),
        ("load_point_load", Array::new(&[points.len()], loads)),
    ]
}

/// The body of numbers of particles and load points, from the bytes of its array files.
///
/// An error is the name of an array and why it does not serve.
pub(super) fn to_body<const D: usize>(
    [n, m]: [usize; 2],
    bytes: impl Fn(&'static str) -> Result<Vec<u8>, String>,
) -> Result<Body<D>, (&'static str, String)> {
    let array = |name: &'static str, shape: &[usize]| {
        bytes(name)
            .and_then(|bytes| Array::from_bytes(&bytes).map_err(|error| error.to_string()))
            .and_then(|array| {
                if array.shape() == shape {
                    Ok(array)
                } else {
                    let found = array.shape();
                    Err(format!("its shape is {found:?} instead of {shape:?}"))
                }
            })
            .map_err(|why| (name, why))
    };
    let reals = |name: &'static str, shape: &[usize]| match array(name, shape)?.values() {
        Values::F64(values) => Ok(values.clone()),
        _ => Err((name, "its numbers are not of type <f8".to_owned())),
    };
    let vectors = |name, count| Ok(rows::<D>(&reals(name, &[count, D])?));
    let gradients = |name| Ok(squares::<D>(&reals(name, &[n, D, D])?));
    let spatial = |name| Ok(squares::<3>(&reals(name, &[n, 3, 3])?));
    let indices = |name: &'static str, count: usize| match array(name, &[count])?.values() {
        Values::U64(values) => Ok(values.iter().map(|&k| k as usize).collect::<Vec<_>>()),
        _ => Err((name, "its numbers are not of type <u8".to_owned())),
    };
    let regime = match array("regime", &[n])?.values() {
        Values::U8(codes) => codes
            .iter()
            .map(|&code| {
                let unknown = || ("regime", format!("{code} is the code of no regime"));
                regime::from_code(code).ok_or_else(unknown)
            })
            .collect::<Result<_, _>>()?,
        _ => return Err(("regime", "its numbers are not of type |u1".to_owned())),
    };
    let fields = ParticleFields {
        x: vectors("x", n)?,
        displacement: vectors("displacement", n)?,
        def_grad: gradients("def_grad")?,
        b_e: spatial("b_e")?,
        sigma: spatial("sigma")?,
        half_length: vectors("half_length", n)?,
        half_length0: vectors("half_length0", n)?,
        centroid: vectors("centroid", n)?,
        volume0: reals("volume0", &[n])?,
        mass: reals("mass", &[n])?,
        pore_pressure: reals("pore_pressure", &[n])?,
        excess: reals("excess", &[n])?,
        number: indices("number", n)?,
        law: indices("law", n)?,
        ratios: rows::<3>(&reals("ratios", &[n, 3])?)
            .into_iter()
            .map(|[strength, friction, stiffness]| Ratios {
                strength,
                friction,
                stiffness,
            })
            .collect(),
        history: reals("eps_p_eq", &[n])?
            .into_iter()
            .map(|eps_p_eq| History { eps_p_eq })
            .collect(),
        regime,
    };
    let particles =
        Particles::from_fields(fields).map_err(|error| (array_of(&error), error.to_string()))?;
    let finite = |name: &'static str| {
        let values: Vec<[f64; D]> = vectors(name, m)?;
        match values
            .iter()
            .position(|value| !value.iter().all(|v| v.is_finite()))
        {
            Some(point) => Err((name, format!("load point {point} is not finite"))),
            None => Ok(values),
        }
    };
    let load_points = finite("load_point_x")?
        .into_iter()
        .zip(finite("load_point_force")?)
        .zip(indices("load_point_load", m)?)
        .map(|((x, force), load)| LoadPoint { x, force, load })
        .collect();
    Ok(Body {
        particles,
        load_points,
        rigid: Vec::new(),
        reinforcement: Vec::new(),
    })
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

fn scalars(values: &[f64]) -> Array {
    Array::new(&[values.len()], Values::F64(values.to_vec()))
}

fn vectors<const N: usize>(values: &[[f64; N]]) -> Array {
    Array::new(
        &[values.len(), N],
        Values::F64(values.as_flattened().to_vec()),
    )
}

fn tensors<const N: usize>(values: &[[[f64; N]; N]]) -> Array {
    let flat = values.as_flattened().as_flattened().to_vec();
    Array::new(&[values.len(), N, N], Values::F64(flat))
}

/// Numbers of an array of rows of N.
fn rows<const N: usize>(values: &[f64]) -> Vec<[f64; N]> {
    values.as_chunks::<N>().0.to_vec()
}

/// Numbers of an array of N × N tensors.
fn squares<const N: usize>(values: &[f64]) -> Vec<[[f64; N]; N]> {
    rows::<N>(values).as_chunks::<N>().0.to_vec()
}
