//! Particles and background grid as pictures for ParaView: a cell for each GIMP domain, a cell for
//! each cell of the grid.

use igimp_assembly::Particles;
use igimp_material::Tensor;
use igimp_schema::field::arrays;
use igimp_shape::Grid;

use crate::fields::{deviatoric_stress, mean_pressure};
use crate::vtu::{CellKind, DataArray, UnstructuredGrid, padded};

/// Optional arrays beside the state of the particles.
#[allow(
    clippy::struct_excessive_bools,
    reason = "each says of one group of arrays whether it is there"
)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extras<'a> {
    /// Utilisation of the strength by particle \[-\].
    pub utilisation: Option<&'a [f64]>,
    /// Material parameters that vary by particle, by the names of their arrays.
    pub carried: &'a [(String, Vec<f64>)],
    /// How many materials there are, through which laws are numbered once or several times; none: each has one law.
    pub materials: Option<usize>,
    /// Whether the deformation gradient is written.
    pub def_grad: bool,
    /// Whether effective stress and pore pressure are written beside total stress.
    pub pore_water: bool,
    /// Whether volumes and masses are those of a body of revolution, and not of a slice.
    pub axisymmetric: bool,
    /// Whether velocity and acceleration are written: of bodies that move in time.
    pub motion: bool,
}

/// The domains x ± l_p of the particles with their state: quads with z = 0 in the plane,
/// hexahedra in space.
///
/// Cells carry displacement, Cauchy stress σ (total), p, q, plastic strain, number of the material (from 0,
/// in the order of the case), code of the regime ([`Regime::code`](igimp_material::Regime::code)), number that the particle keeps, volume
/// and mass; with pore water effective stress σ′, p′, pore pressure u and its excess besides, in motion velocity and
/// acceleration.
///
/// # Panics
/// If the utilisation, or a property, is not given for every particle.
pub fn of_particles<const D: usize>(
    particles: &Particles<D>,
    extras: &Extras<'_>,
) -> UnstructuredGrid {
    let kind = CellKind::of_dimension(D);
    let points = corners(particles, kind);
    let n = particles.len();
    let by_particle = |of: &dyn Fn(usize) -> f64| (0..n).map(of).collect();
    let integers = |of: &dyn Fn(usize) -> usize| (0..n).map(|k| of(k) as i32).collect();
    let effective = &particles.sigma;
    let sigma: Vec<Tensor> = (0..n).map(|k| particles.total_stress(k)).collect();
    let regime = |k: usize| usize::from(particles.regime[k].code());
    let material = |k: usize| (extras.materials).map_or(particles.law[k], |n| particles.law[k] % n);
    // A slice of one metre in plane strain.
    let per = if D == 2 && !extras.axisymmetric {
        "/m"
    } else {
        ""
    };
    let mut cell_data = vec![
        DataArray::vectors(arrays::DISPLACEMENT, &particles.displacement),
        DataArray::symmetric(arrays::TOTAL, &sigma),
        DataArray::scalars(
            "p [Pa], compression +",
            by_particle(&|k| mean_pressure(&sigma[k])),
        ),
        DataArray::scalars("q [Pa]", by_particle(&|k| deviatoric_stress(&effective[k]))),
        DataArray::scalars("plastic strain [-]", particles.eps_p_eq.clone()),
        DataArray::integers("material", integers(&material)),
        DataArray::integers("regime", integers(&regime)),
        DataArray::integers("particle", integers(&|k| particles.number[k])),
        DataArray::scalars(
            format!("volume [m3{per}]"),
            by_particle(&|k| particles.volume(k)),
        ),
        DataArray::scalars(format!("mass [kg{per}]"), particles.mass.clone()),
    ];
    if extras.pore_water {
        let excess = &particles.excess;
        cell_data.extend([
            DataArray::symmetric(arrays::EFFECTIVE, effective),
            DataArray::scalars(
                "p_eff [Pa], compression +",
                by_particle(&|k| mean_pressure(&effective[k])),
            ),
            DataArray::scalars(
                "u [Pa], compression +",
                by_particle(&|k| particles.pore_pressure[k] + excess[k]),
            ),
            DataArray::scalars("u_excess [Pa], compression +", excess.clone()),
        ]);
    }
    if extras.motion {
        cell_data.extend(of_motion(particles));
    }
    if let Some(utilisation) = extras.utilisation {
        assert_eq!(utilisation.len(), n, "every particle has a utilisation");
        cell_data.push(DataArray::scalars("utilisation [-]", utilisation.to_vec()));
    }
    for (name, values) in extras.carried {
        assert_eq!(values.len(), n, "every particle has `{name}`");
        cell_data.push(DataArray::scalars(name.clone(), values.clone()));
    }
    if extras.def_grad {
        let def_grad: Vec<Tensor> = (0..n).map(|k| particles.whole_def_grad(k)).collect();
        cell_data.push(DataArray::tensors("deformation gradient [-]", &def_grad));
    }
    UnstructuredGrid {
        connectivity: (0..points.len()).collect(),
        points,
        kind,
        point_data: Vec::new(),
        cell_data,
        field_data: Vec::new(),
    }
}

/// Velocity and acceleration.
fn of_motion<const D: usize>(particles: &Particles<D>) -> [DataArray; 2] {
    [
        DataArray::vectors(arrays::VELOCITY, &particles.velocity),
        DataArray::vectors(arrays::ACCELERATION, &particles.acceleration),
    ]
}

/// The corners of the domains, particle after particle.
fn corners<const D: usize>(particles: &Particles<D>, kind: CellKind) -> Vec<[f64; 3]> {
    let domains = particles.x.iter().enumerate();
    domains
        .flat_map(|(particle, x)| {
            let half_length = particles.drawn_half_length(particle);
            kind.corners().iter().map(move |is_upper| {
                padded(&std::array::from_fn::<_, D, _>(|axis| {
                    let l = half_length[axis];
                    x[axis] + if is_upper[axis] { l } else { -l }
                }))
            })
        })
        .collect()
}

/// The cells of the background grid, with the displacement of its nodes in the last step if given.
///
/// # Panics
/// If the displacement is not given for every node.
pub fn of_grid<const D: usize>(grid: &Grid<D>, u: Option<&[[f64; D]]>) -> UnstructuredGrid {
    let kind = CellKind::of_dimension(D);
    let points = (0..grid.node_count())
        .map(|node| padded(&grid.node_position(node)))
        .collect();
    let connectivity = (0..grid.cell_count())
        .flat_map(|cell| {
            let place = grid.cell_place(cell);
            kind.corners().iter().map(move |is_upper| {
                grid.node_index(std::array::from_fn(|axis| {
                    place[axis] + usize::from(is_upper[axis])
                }))
            })
        })
        .collect();
    let step_displacement = u.map(|u| {
        assert_eq!(u.len(), grid.node_count(), "every node has a displacement");
        DataArray::vectors("step displacement [m]", u)
    });
    UnstructuredGrid {
        points,
        kind,
        connectivity,
        point_data: step_displacement.into_iter().collect(),
        cell_data: Vec::new(),
        field_data: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_cmp, reason = "numbers that are exact in binary")]

    use igimp_assembly::ParticleSeed;
    use igimp_shape::Axis;

    use super::*;
    use crate::checkpoint::tests::body;
    use crate::npy::Values;

    fn values(grid: &UnstructuredGrid, name: &str) -> Values {
        let array = grid.cell_data.iter().find(|array| array.name() == name);
        array.unwrap().values().clone()
    }

    fn seeds<const D: usize>() -> Particles<D> {
        let seed = ParticleSeed {
            x: [1.0; D],
            half_length: std::array::from_fn(|axis| [0.5, 0.25, 0.125][axis]),
            volume: 2.0,
            density: 3.0,
            law: 4,
            centroid: [0.0; _],
        };
        Particles::new(&[seed]).unwrap()
    }

    #[test]
    fn a_domain_is_a_quad_in_the_plane() {
        let grid = of_particles(&seeds::<2>(), &Extras::default());
        assert_eq!((grid.kind, grid.cell_count()), (CellKind::Quad, 1));
        assert_eq!(
            grid.points,
            [[0.5, 0.75], [1.5, 0.75], [1.5, 1.25], [0.5, 1.25]].map(|x| padded(&x))
        );
        assert_eq!(values(&grid, "volume [m3/m]"), Values::F64(vec![2.0]));
        assert_eq!(values(&grid, "mass [kg/m]"), Values::F64(vec![6.0]));
        assert_eq!(values(&grid, "material"), Values::I32(vec![4]));
    }

    // GOAL: single particles that stretch without end leave no towers in frames.
    // ORACLE: by hand: six times 0.25 m to either side of y = 1 m, in place of 500 m.
    #[test]
    fn a_domain_without_end_is_cut() {
        let mut fields = seeds::<2>().into_fields();
        fields.half_length[0][1] = 500.0;
        let particles = Particles::from_fields(fields).unwrap();
        let points = of_particles(&particles, &Extras::default()).points;
        assert_eq!(points[0], padded(&[0.5, -0.5]));
        assert_eq!(points[2], padded(&[1.5, 2.5]));
    }

    #[test]
    fn a_domain_is_a_hexahedron_in_space() {
        let extras = Extras {
            utilisation: Some(&[0.75]),
            carried: &[("strength [Pa]".to_owned(), vec![5e3])],
            def_grad: true,
            ..Extras::default()
        };
        let grid = of_particles(&seeds::<3>(), &extras);
        assert_eq!((grid.kind, grid.cell_count()), (CellKind::Hexahedron, 1));
        assert_eq!(grid.points.len(), 8);
        assert_eq!(grid.points[0], [0.5, 0.75, 0.875]);
        assert_eq!(grid.points[3], [0.5, 1.25, 0.875]);
        assert_eq!(grid.points[6], [1.5, 1.25, 1.125]);
        assert_eq!(values(&grid, "utilisation [-]"), Values::F64(vec![0.75]));
        assert_eq!(values(&grid, "strength [Pa]"), Values::F64(vec![5e3]));
        assert_eq!(values(&grid, "volume [m3]"), Values::F64(vec![2.0]));
    }

    /// ORACLE: p = −(σ₁+σ₂+σ₃)/3 and q² = ½ Σ (σ_a − σ_b)² + 3 Σ τ².
    #[test]
    fn invariants_are_those_of_the_books() {
        let sigma = [[-3.0, 1.0, 0.0], [1.0, -6.0, 0.0], [0.0, 0.0, -9.0]];
        assert_eq!(mean_pressure(&sigma), 6.0);
        let square: f64 = 0.5 * (9.0 + 9.0 + 36.0) + 3.0;
        assert!((deviatoric_stress(&sigma) - square.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn states_are_written_as_they_are() {
        let body = body(5);
        let particles = &body.particles;
        let extras = Extras {
            def_grad: true,
            ..Extras::default()
        };
        let grid = of_particles(particles, &extras);
        let sigma = &particles.total_stress(0);
        let Values::F64(written) = values(&grid, "sigma [Pa], tension +") else {
            panic!()
        };
        assert_eq!(written.len(), 30);
        assert_eq!(
            written[..6],
            [
                sigma[0][0],
                sigma[1][1],
                sigma[2][2],
                sigma[0][1],
                sigma[1][2],
                sigma[0][2]
            ]
        );
        let def_grad = &particles.def_grad[0];
        let Values::F64(written) = values(&grid, "deformation gradient [-]") else {
            panic!()
        };
        assert_eq!(
            written[..9],
            [
                def_grad[0][0],
                def_grad[0][1],
                0.0,
                def_grad[1][0],
                def_grad[1][1],
                0.0,
                0.0,
                0.0,
                1.0
            ]
        );
        assert_eq!(values(&grid, "regime"), Values::I32(vec![0, 4, 9, 0, 4]));
        assert_eq!(values(&grid, "particle"), Values::I32(vec![1, 3, 5, 7, 9]));
    }

    #[test]
    fn grids_keep_their_numbering() {
        let axis = |spacing, cells| Axis::uniform(0.0, spacing, cells).unwrap();
        let plane = Grid::new([axis(1.0, 2), axis(0.5, 1)]);
        let u: Vec<[f64; 2]> = (0..6).map(|k| [f64::from(k), 0.0]).collect();
        let grid = of_grid(&plane, Some(&u));
        assert_eq!(grid.points[4], [1.0, 0.5, 0.0]);
        assert_eq!(grid.connectivity, [0, 1, 4, 3, 1, 2, 5, 4]);
        assert_eq!(grid.point_data[0].name(), "step displacement [m]");
        let space = Grid::new([axis(1.0, 1), axis(1.0, 1), axis(1.0, 1)]);
        let grid = of_grid(&space, None);
        assert_eq!(grid.connectivity, [0, 1, 3, 2, 4, 5, 7, 6]);
        assert!(grid.point_data.is_empty());
    }
}
