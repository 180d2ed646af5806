//! Frames of particles read back as fields, in the printed sign: for pictures of a run.

use igimp_model::Field;
use igimp_schema::field::InFrames;

use crate::fields::length;
use crate::vtu::CellKind;
use crate::vtu::read::Frame;

/// The particles of a frame: where they are, how they are deformed, and which they are.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameParticles<const D: usize> {
    /// Centres of the domains \[m\].
    pub x: Vec<[f64; D]>,
    /// Deformation gradients \[-\].
    pub def_grad: Vec<[[f64; D]; D]>,
    /// The numbers that particles keep.
    pub number: Vec<usize>,
}

impl<const D: usize> FrameParticles<D> {
    /// The particles of a frame; none of a frame in another dimension, and of one that cannot be read.
    pub fn of(frame: &Frame<'_>) -> Option<Self> {
        if frame.cells == 0 {
            return Some(Self {
                x: Vec::new(),
                def_grad: Vec::new(),
                number: Vec::new(),
            });
        }
        // The cell of a particle, with the corner opposite the first.
        let (kind, opposite) = if D == 2 {
            (CellKind::Quad, 2)
        } else {
            (CellKind::Hexahedron, 6)
        };
        if frame.kind()? != kind {
            return None;
        }
        let count = kind.corners().len();
        let corners = frame.corners(count)?;
        let middle = |cell: &[[f64; 3]]| -> [f64; D] {
            std::array::from_fn(|a| 0.5 * (cell[0][a] + cell[opposite][a]))
        };
        let gradients = array(frame, "deformation gradient [-]", 9)?;
        let gradient = |entries: &[f64; 9]| -> [[f64; D]; D] {
            std::array::from_fn(|i| std::array::from_fn(|j| entries[3 * i + j]))
        };
        let number = |&number: &f64| (number >= 0.0).then_some(number as usize);
        let numbers = array(frame, "particle", 1)?;
        Some(Self {
            x: corners.chunks_exact(count).map(middle).collect(),
            def_grad: gradients.as_chunks::<9>().0.iter().map(gradient).collect(),
            number: numbers.iter().map(number).collect::<Option<_>>()?,
        })
    }
}

/// The numbers of an array of a frame.
fn array(frame: &Frame<'_>, name: &str, components: usize) -> Option<Vec<f64>> {
    let arrays = frame.arrays("CellData");
    let array = arrays.iter().find(|array| array.name == name)?;
    (array.components == components).then(|| array.numbers(frame.cells))?
}

/// A component of an array, times a factor; zero stays without a sign.
fn component(
    frame: &Frame<'_>,
    (name, components): (&str, usize),
    component: usize,
    sign: f64,
) -> Option<Vec<f64>> {
    let numbers = array(frame, name, components)?;
    let values = numbers.iter().skip(component).step_by(components);
    Some(values.map(|value| 0.0 + sign * value).collect())
}

/// The values of a field by particle, as [`fields::values`](crate::fields::values) gives them in SI units, compression
/// positive; none where the frame does not have the field.
///
/// Strength, friction and stiffness are in frames of soil whose particles carry values of their own. Without water total and
/// effective stress are the same, and there is no pore pressure.
pub fn values(frame: &Frame<'_>, field: Field) -> Option<Vec<f64>> {
    let of_frame = match field.in_frames() {
        InFrames::Scalar(name) => component(frame, (name, 1), 0, 1.0),
        InFrames::Component(name, axis) => component(frame, (name, 3), axis, 1.0),
        InFrames::Length(name) => array(frame, name, 3)
            .map(|numbers| numbers.as_chunks::<3>().0.iter().map(length).collect()),
        InFrames::Tension(name, place) => component(frame, (name, 6), place, -1.0),
        InFrames::Middle(axis) => centres(frame, axis),
    };
    of_frame.or_else(|| match field {
        Field::U | Field::UExcess => Some(vec![0.0; frame.cells]),
        _ => values(frame, field.of_total()?),
    })
}

/// A coordinate of the centres of the domains.
fn centres(frame: &Frame<'_>, axis: usize) -> Option<Vec<f64>> {
    let kind = frame.kind()?;
    let corners = kind.corners().len();
    // The corner opposite the first.
    let opposite = if kind == CellKind::Quad { 2 } else { 6 };
    let points = frame.corners(corners)?;
    let cells = points.chunks_exact(corners);
    let middle = |cell: &[[f64; 3]]| 0.5 * (cell[0][axis] + cell[opposite][axis]);
    Some(cells.map(middle).collect())
}

#[cfg(test)]
mod tests {
    use igimp_assembly::{ParticleFields, Particles};
    use igimp_shape::Axis;

    use super::*;
    use crate::checkpoint::tests::body;
    use crate::fields;
    use crate::paraview::particles::{Extras, of_particles};
    use crate::scratch::Scratch;

    /// GOAL: a field that is read back from a frame is the field of the particles, and so are their places.
    /// ORACLE: the fields of the particles themselves; of what a frame does not hold there is nothing.
    #[test]
    fn frames_are_read_back_as_fields() {
        let mut arrays: ParticleFields<2> = (*body(7).particles).clone();
        for k in 0..7 {
            arrays.velocity[k] = [0.5 * k as f64, -1.5];
            arrays.acceleration[k] = [-9.81, 0.25 * k as f64];
        }
        let particles = Particles::from_fields(arrays).unwrap();
        let share: Vec<f64> = (0..7).map(|k| f64::from(k) / 7.0).collect();
        let extras = Extras {
            utilisation: Some(&share),
            def_grad: true,
            pore_water: true,
            motion: true,
            ..Extras::default()
        };
        let scratch = Scratch::new();
        let path = scratch.path().join("frame.vtu");
        of_particles(&particles, &extras).write(&path).unwrap();
        let text = std::fs::read_to_string(path).unwrap();
        let frame = Frame::of(&text).unwrap();
        for &field in Field::ALL.iter().filter(|field| field.exists_in(2)) {
            let read = values(&frame, field);
            match field {
                Field::Strength | Field::Friction | Field::Young => assert_eq!(read, None),
                Field::Utilisation => assert_eq!(read.as_deref(), Some(&share[..])),
                _ => {
                    let expected = fields::values(field, &particles, &[]);
                    let read = read.unwrap_or_else(|| panic!("no {field:?}"));
                    for (a, b) in std::iter::zip(read, expected) {
                        assert!(
                            (a - b).abs() <= 1e-12 * b.abs().max(1e-9),
                            "{field:?}: {a} {b}"
                        );
                    }
                }
            }
        }
        let read = FrameParticles::<2>::of(&frame).unwrap();
        assert_eq!(read.number, particles.number);
        assert_eq!(read.def_grad, particles.def_grad);
    }

    #[test]
    fn a_grid_is_no_frame_of_particles() {
        let axis = || Axis::uniform(0.0, 1.0, 2).unwrap();
        let grid = igimp_shape::Grid::new([axis(), axis()]);
        let scratch = Scratch::new();
        let path = scratch.path().join("grid.vtu");
        let cells = crate::paraview::particles::of_grid(&grid, None);
        cells.write(&path).unwrap();
        let text = std::fs::read_to_string(path).unwrap();
        let frame = Frame::of(&text).unwrap();
        assert_eq!(FrameParticles::<2>::of(&frame), None);
        assert_eq!(values(&frame, Field::Speed), None);
        assert_eq!(values(&frame, Field::X), Some(vec![0.5, 1.5, 0.5, 1.5]));
    }
}
