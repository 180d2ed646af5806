//! One pass over the particles: from nodal step displacements to stress, internal force and, when
//! it is asked for, the tangent matrix. Nothing is kept of a particle's tangent: it goes straight
//! into the matrix.

use std::ops::Range;

use igimp_linear::Pattern;
use igimp_material::{ConstitutiveModel, PointContext, ReturnMap, TangentKind};
use igimp_shape::Support;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::Trial;
use crate::contributions::consolidation::WaterOfParticle;
use crate::contributions::nonlocal::{SpatialRates, StrainOfParticle};
use crate::equations::blocks::BlockTable;
use crate::equations::kinematics::{
    Linearisation, ParticleState, ParticleTrial, Straining, answered, strained,
};
use crate::equations::linearised::{Linearised, Moduli};
use crate::equations::mirror::mirror;
use crate::equations::patch::Patch;
use crate::equations::scatter::Rows;
use crate::equations::scatter::scalar::ScalarColumns;
use crate::equations::scatter::water::scatter_in_space;
use crate::equations::system::System;
use crate::error::AssemblyError;
use crate::method::Kinematics;
use crate::step::hoops::{Around, Hoop};
use crate::step::strips::split;

/// Scratch of one task.
#[derive(Debug, Default)]
pub(crate) struct Scratch<const D: usize> {
    pub(crate) linearised: Linearised<D>,
    pub(crate) scalar: ScalarColumns<D>,
    pub(crate) rows: Rows,
    pub(crate) patch: Patch<D>,
}

/// The part of a pass that belongs to one strip.
struct StripTask<'a, const D: usize> {
    slots: Range<usize>,
    particles: &'a mut [ParticleTrial<D>],
    first_node: usize,
    f_int: &'a mut [[f64; D]],
    /// The first scalar of its nodes, and the forces of all of them.
    first_scalar: usize,
    f_of_scalars: &'a mut [[f64; D]],
    /// Where the values of the strip begin, and the values; none when no tangent is asked for.
    values: Option<(usize, &'a mut [f64])>,
}

impl<const D: usize> System<'_, D> {
    /// Sets `trial`, and the stored `values` of the tangent if any, to nodal step displacements
    /// `u`.
    pub(crate) fn pass(
        &self,
        u: &[[f64; D]],
        kind: TangentKind,
        trial: &mut Trial<D>,
        mut values: Option<&mut [f64]>,
    ) -> Result<(), AssemblyError> {
        trial
            .particles
            .resize(self.particles.len(), ParticleTrial::at_rest());
        trial.f_int.clear();
        trial.f_int.resize(u.len(), [0.0; D]);
        if let Some(values) = &mut values {
            values.fill(0.0);
        }
        let answers = self.answers(u)?;
        for parity in 0..2 {
            let strips = self.stencils.strips().of_parity(parity);
            let slots = strips.clone().map(|(_, slots)| slots.clone());
            let nodes = strips.clone().map(|(nodes, _)| nodes.clone());
            let stored = nodes.clone().map(|nodes| self.values_of(&nodes));
            let values: Vec<Option<(usize, &mut [f64])>> = match &mut values {
                Some(values) => std::iter::zip(stored.clone(), split(values, stored))
                    .map(|(range, slice)| Some((range.start, slice)))
                    .collect(),
                None => nodes.clone().map(|_| None).collect(),
            };
            let (of_grid, of_scalars) = (trial.f_int).split_at_mut(self.unknowns.first_scalar());
            let f_int = split(of_grid, nodes.clone());
            let scalars = nodes.clone().map(|nodes| self.unknowns.scalars_of(&nodes));
            let first_scalars = scalars.clone().map(|scalars| scalars.start);
            let f_of_scalars = split(of_scalars, scalars).into_iter();
            let particles = split(&mut trial.particles, slots);
            let forces = f_int.into_iter().zip(first_scalars.zip(f_of_scalars));
            let parts = strips.zip(particles).zip(forces).zip(values);
            let tasks: Vec<StripTask<'_, D>> = parts
                .map(
                    |((((nodes, slots), particles), forces), values)| StripTask {
                        slots: slots.clone(),
                        particles,
                        first_node: nodes.start,
                        f_int: forces.0,
                        first_scalar: forces.1.0,
                        f_of_scalars: forces.1.1,
                        values,
                    },
                )
                .collect();
            let failures: Vec<Option<(usize, AssemblyError)>> = tasks
                .into_par_iter()
                .map_init(Scratch::default, |scratch, strip| {
                    self.pass_strip(u, kind, &answers, strip, scratch).err()
                })
                .collect();
            let failures = failures.into_iter().flatten();
            if let Some((_, error)) = failures.min_by_key(|&(particle, _)| particle) {
                return Err(error);
            }
        }
        if let Some(values) = values.filter(|_| D == 3 && self.symmetric_particles) {
            mirror(&self.pattern, values);
        }
        Ok(())
    }

    /// The particles of one strip; the particle that fails and why.
    #[inline]
    fn pass_strip(
        &self,
        u: &[[f64; D]],
        kind: TangentKind,
        answers: &[Option<ReturnMap>],
        mut strip: StripTask<'_, D>,
        scratch: &mut Scratch<D>,
    ) -> Result<(), (usize, AssemblyError)> {
        let order = &self.stencils.order()[strip.slots];
        let (arch, kinematics) = (Arch::new(), self.method.kinematics_of_step());
        let mut end_of_patch = 0;
        for (slot, (&particle, trial)) in order.iter().zip(strip.particles).enumerate() {
            let particle = particle as usize;
            let (supports, hoops) = self.stencils.with_hoops(particle);
            let answer = answers.get(particle).and_then(Option::as_ref);
            let point = self
                .evaluate_with((particle, supports, hoops), u, kind, answer, trial)
                .map_err(|error| (particle, error))?;
            let volume = self.reference_volume(particle);
            let around = self.around((supports, hoops), u);
            scratch.linearised.push((supports, around), &point);
            let forces = scratch.linearised.forces(&point, volume);
            for (support, force) in supports.iter().zip(forces) {
                let sum = &mut strip.f_int[support.node - strip.first_node];
                for axis in 0..D {
                    sum[axis] += force[axis];
                }
            }
            if around.is_some() {
                let forces = scratch.linearised.hoop_forces(&point, volume);
                for (support, force) in supports.iter().zip(forces) {
                    strip.f_int[support.node - strip.first_node][0] += force;
                }
            }
            let water = self
                .beside
                .consolidation
                .of_particle(particle, (supports, hoops), u);
            if let Some(water) = &water {
                water.add_forces(strip.first_scalar, strip.f_of_scalars);
            }
            let strain = self.strain_of_particle(particle, &point, u);
            if let Some(strain) = &strain {
                strain.add_forces(supports, strip.first_scalar, strip.f_of_scalars);
            }
            let Some((start, values)) = &mut strip.values else {
                continue;
            };
            if let Some(water) = water.as_ref().filter(|_| D == 3) {
                scatter_in_space(
                    water,
                    supports,
                    (&self.table, &self.pattern),
                    (*start, values),
                );
            }
            if D == 3 && slot == end_of_patch {
                let next = order[slot..].iter();
                let next = next.map(|&particle| self.stencils.of(particle as usize));
                let (grid, near) = (&self.conditions.grid, self.table.near);
                let patch = &mut scratch.patch;
                end_of_patch += patch.begin(grid, near, next, self.symmetric_particles);
            }
            arch.dispatch(Addition {
                supports,
                point: &point,
                water: water.as_ref(),
                strain: strain.as_ref(),
                volume,
                kinematics,
                ends_patch: slot + 1 == end_of_patch,
                scratch,
                matrix: (&self.table, &self.pattern),
                values: (*start, values),
            });
        }
        Ok(())
    }

    /// One particle at nodal step displacements `u`.
    #[inline]
    pub(crate) fn evaluate_particle(
        &self,
        particle: usize,
        u: &[[f64; D]],
        kind: TangentKind,
        trial: &mut ParticleTrial<D>,
    ) -> Result<Linearisation<D>, AssemblyError> {
        let (supports, hoops) = self.stencils.with_hoops(particle);
        self.evaluate_with((particle, supports, hoops), u, kind, None, trial)
    }

    /// The same where the answer of its law may be known.
    #[inline]
    fn evaluate_with(
        &self,
        (particle, supports, hoops): (usize, &[Support<D>], &[Hoop]),
        u: &[[f64; D]],
        kind: TangentKind,
        known: Option<&ReturnMap>,
        trial: &mut ParticleTrial<D>,
    ) -> Result<Linearisation<D>, AssemblyError> {
        let material = |source| AssemblyError::Material { particle, source };
        let kinematics = self.method.kinematics_of_step();
        let rise = (self.nonlocal).rise(self.particles.law[particle], supports, u);
        let context = PointContext {
            duration: self.conditions.duration(),
            nonlocal_rise: rise.unwrap_or(0.0),
            ..PointContext::STATIC
        };
        let ask = |law: &dyn ConstitutiveModel| {
            let (state, straining) = self.strain_particle((particle, supports, hoops), u)?;
            let history = self.particles.history(particle);
            let answer = match known {
                Some(answer) => *answer,
                None => law
                    .return_map(straining.principal(), &history, &context)
                    .map_err(material)?,
            };
            let mut point = answered(state, straining, law, &answer, (kind, kinematics), trial)?;
            if rise.is_some() {
                let elastic = match kind {
                    TangentKind::Elastic => 1.0,
                    TangentKind::Consistent => 0.0,
                    TangentKind::Regularised { elastic } => elastic,
                };
                let rates = SpatialRates::of(&answer.nonlocal, &point.lifted.frame, elastic);
                point.nonlocal = Some(rates);
            }
            Ok(point)
        };
        let laws = &self.conditions.laws;
        let asked = self.particles.ask_law(particle, laws, ask);
        asked.map_err(material)?
    }

    /// The nonlocal strain of a particle at nodal values `u`; none where strength does not see it.
    #[inline]
    pub(crate) fn strain_of_particle<'c>(
        &'c self,
        particle: usize,
        point: &'c Linearisation<D>,
        u: &[[f64; D]],
    ) -> Option<StrainOfParticle<'c, D>> {
        let rates = point.nonlocal.as_ref()?;
        let supports = (self.stencils.of(particle), rates);
        let volumes = [
            self.particles.volume(particle),
            self.reference_volume(particle),
        ];
        let law = self.particles.law[particle];
        self.nonlocal.of_particle(law, supports, u, volumes)
    }

    /// One particle as nodal step displacements `u` strain it.
    #[inline]
    pub(crate) fn strain_particle(
        &self,
        (particle, supports, hoops): (usize, &[Support<D>], &[Hoop]),
        u: &[[f64; D]],
    ) -> Result<(ParticleState<'_>, Straining<D>), AssemblyError> {
        let unknown = self.beside.consolidation.pressure(particle, u);
        let state = ParticleState {
            particle,
            b_e: &self.particles.b_e[particle],
            pores: (self.loads.pores).response(self.particles, self.method, (particle, unknown)),
        };
        let reach = (supports, hoops);
        Ok((state, strained(state, reach, u, self.method)?))
    }

    /// How the supports of a particle stretch it around the axis at nodal step displacements `u`; none unless the section is
    /// axisymmetric.
    #[inline]
    pub(crate) fn around<'h>(
        &self,
        (supports, hoops): (&[Support<D>], &'h [Hoop]),
        u: &[[f64; D]],
    ) -> Option<Around<'h>> {
        if hoops.is_empty() {
            return None;
        }
        let push = match self.method.kinematics_of_step() {
            Kinematics::FiniteStrain => {
                let strain = Hoop::strain(supports, hoops, u);
                Hoop::UNSTRETCHED.plus(1.0, strain).reciprocal()
            }
            Kinematics::SmallStrain => Hoop::UNSTRETCHED,
        };
        Some(Around { hoops, push })
    }

    /// The stored values of the columns of some nodes.
    fn values_of(&self, nodes: &Range<usize>) -> Range<usize> {
        let first = |node: usize| self.pattern.first_value[self.unknowns.blocks_before(node)];
        first(nodes.start)..first(nodes.end)
    }
}

/// The tangent of one particle on its way into the matrix, with wider instructions where the processor has them.
struct Addition<'a, const D: usize> {
    supports: &'a [Support<D>],
    point: &'a Linearisation<D>,
    /// Its water, where that flows.
    water: Option<&'a WaterOfParticle<'a, D>>,
    /// Its nonlocal strain, where strength sees that.
    strain: Option<&'a StrainOfParticle<'a, D>>,
    volume: f64,
    kinematics: Kinematics,
    /// Whether it is the last one of its patch.
    ends_patch: bool,
    scratch: &'a mut Scratch<D>,
    matrix: (&'a BlockTable<D>, &'a Pattern),
    /// Where the values of the strip begin, and the values.
    values: (usize, &'a mut [f64]),
}

impl<const D: usize> WithSimd for Addition<'_, D> {
    type Output = ();

    #[allow(
        clippy::inline_always,
        reason = "compiled for the instructions of the caller"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Scratch {
            linearised,
            scalar,
            rows,
            patch,
        } = self.scratch;
        if D == 3 {
            // Processors with vectors fuse products and sums; without, fusing would be slow.
            let fuses = S::F64_LANES > 1;
            let moduli = Moduli::of(self.point, self.volume, self.kinematics);
            patch.take(self.supports, linearised, moduli);
            if self.ends_patch {
                patch.sum(fuses);
                patch.scatter(self.matrix, self.values);
            }
        } else {
            let nodes = self.supports.iter().map(|support| support.node);
            linearised.linearise_particle(self.point, self.volume, self.kinematics);
            if let Some(water) = self.water {
                scalar.set_water(water, self.supports);
            } else if let Some(strain) = self.strain {
                scalar.set_strain(strain, self.supports, linearised);
            }
            if self.water.is_some() || self.strain.is_some() {
                rows.set(nodes, self.matrix.0, true);
                let columns = (linearised, scalar);
                rows.scatter_with_scalar(self.supports, self.matrix, columns, self.values);
            } else {
                rows.set(nodes, self.matrix.0, false);
                rows.scatter(self.supports, self.matrix, linearised, self.values);
            }
        }
    }
}
