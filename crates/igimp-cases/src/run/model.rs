//! From a case to the solver's model: grid, particles, laws, supports, loads.

mod seeding;

use std::sync::Arc;

use igimp_assembly::{
    AssemblyError, Constraints, Geometry, LoadPoint, Method, Particles, PoreStiffness, PoreWater,
    SharedLaw, StepConditions, StepLoads, Water,
};
use igimp_linear::LinearSolver;
use igimp_model::{Case, Drainage, LoadKind, Material, OfCase, Side};
use igimp_results::fields;
use igimp_results::measure::soil_ends;
use igimp_results::model_size::ModelSize;
use igimp_shape::{Grid, ShapeError};
use igimp_solver::{Body, MarchSettings, NewtonSettings};

use super::footing::{self, Footing};
use super::state::{Controls, State};
use super::water::seepage::{Flows, Followed};
use super::water::{GroundWater, Seeded};
use crate::error::CaseError;
use igimp_estimate::factor_memory::FactorMemory;

/// Load points per cell along a loaded segment.
const POINTS_PER_CELL: f64 = 4.0;

/// Everything about a case that stays during a run.
#[derive(Debug)]
pub struct Model<'c, const D: usize> {
    /// The case.
    pub case: &'c Case<D>,
    /// Laws of full strength: one for each material in their order, then again one for each material for every set of parameters that
    /// vary, and for every change that cells with several soils ask for.
    pub laws: Vec<SharedLaw>,
    footing: Option<Footing>,
    /// The rigid body that the rows of the grid follow, and the row of its lowest side.
    followed: Option<(usize, usize)>,
    /// How far each rigid body stands above the soil beneath it as the case has both \[m\].
    pub(crate) gaps: Vec<f64>,
    /// By condition of the case.
    water: Vec<Arc<GroundWater<D>>>,
    /// Flows that were followed in time.
    pub(crate) courses: Vec<Followed>,
    /// The seeds of the particles.
    pub(crate) seeded: Arc<Seeded<D>>,
    /// The particles of bodies that stages place.
    pub(crate) later: Option<Particles<D>>,
    /// Memory allowed for the factors of its linear systems.
    pub(crate) factors: FactorMemory,
}

impl<'c, const D: usize> Model<'c, D> {
    /// The model of a case, and its undeformed, stress-free state.
    ///
    /// # Errors
    /// [`CaseError`] for impossible parts.
    pub fn new(case: &'c Case<D>) -> Result<(Self, State<D>), CaseError> {
        Self::with_water(case, None)
    }

    /// The same with water that is known, so that no flow is solved for again.
    fn with_water(
        case: &'c Case<D>,
        water: Option<&[Arc<GroundWater<D>>]>,
    ) -> Result<(Self, State<D>), CaseError> {
        let mut model = Self {
            case,
            laws: Vec::new(),
            footing: Footing::of(case)?,
            followed: footing::followed(case)?,
            gaps: Vec::new(),
            water: Vec::new(),
            courses: Vec::new(),
            seeded: Arc::default(),
            later: None,
            factors: FactorMemory::of(case)?,
        };
        let grid = model.grid(0.0)?;
        let cell = model.cell_height()?;
        model.laws = (case.materials.iter())
            .map(|material| material.law_on(cell))
            .collect::<Result<Vec<_>, _>>()?;
        let (mut particles, seeded) = seeding::seeded(case, (&grid, cell), &mut model.laws)?;
        let seeded = Arc::new(seeded);
        if let Some(known) = water {
            model.water = known.to_vec();
        } else {
            let flows = Flows::of(case)?;
            model.water = std::iter::zip(0.., &flows.by_condition)
                .map(|(index, flow)| GroundWater::of(case, index, flow.as_ref(), &seeded))
                .map(Arc::new)
                .collect();
            model.courses = flows.courses;
        }
        if case.bodies.iter().any(|part| !part.from_start) {
            let is_first = |particle: usize| case.bodies[seeded.body[particle]].from_start;
            model.later = Some(particles.keeping(|particle| !is_first(particle))?);
            particles = particles.keeping(is_first)?;
        }
        model.seeded = seeded;
        let mut body = Body::new(particles);
        body.load_points = load_points(case);
        let mut controls = Controls::none(case);
        controls.water = (!case.water.is_empty()).then_some(0);
        model.place_from_start(&mut body, &mut controls)?;
        if body.particles.resolve_overlap(&body.rigid) > 0 {
            body.particles.reset_displacements();
        }
        let below = |part| super::rigid::gap_below(part, &body.particles);
        model.gaps = case.rigid.iter().map(below).collect();
        Ok((model, State { body, controls }))
    }

    /// Places the structures that are there from the start.
    fn place_from_start(
        &self,
        body: &mut Body<D>,
        controls: &mut Controls,
    ) -> Result<(), CaseError> {
        let case = self.case;
        for (index, part) in case.rigid.iter().enumerate() {
            if part.from_start {
                let made = super::rigid::made(case, index, self.laws.len())?;
                body.rigid.push(made);
                controls.rigid[index].placed = true;
            }
        }
        for (index, part) in case.reinforcement.iter().enumerate() {
            if part.from_start {
                let made = super::reinforcement::made(case, part);
                body.reinforcement.push(made);
                controls.reinforcement[index].installed = true;
            }
        }
        Ok(())
    }

    /// Least height of the cells \[m\].
    ///
    /// # Errors
    /// As [`Self::grid`].
    pub(crate) fn cell_height(&self) -> Result<f64, CaseError> {
        let upward = &self.grid(0.0)?.axes[D - 1];
        let heights = (0..upward.cell_count()).map(|cell| upward.spacing(cell));
        Ok(heights.fold(f64::INFINITY, f64::min))
    }

    /// Least side of the cells \[m\].
    ///
    /// # Errors
    /// As [`Self::grid`].
    pub(crate) fn smallest_side(&self) -> Result<f64, CaseError> {
        let sides = self.case.grid.smallest_cell().into_iter();
        Ok(sides.fold(self.cell_height()?, f64::min))
    }

    /// The method of the case on a geometry.
    pub(crate) fn method(&self, geometry: Geometry) -> Method {
        Method {
            geometry,
            ..self.case.method.clone()
        }
    }

    /// The undeformed, stress-free state of the bodies that are there in a state, of the materials that they have there.
    pub(crate) fn undeformed(&self, state: &State<D>) -> Result<State<D>, CaseError> {
        let (model, mut base) = Model::with_water(self.case, Some(&self.water))?;
        let there = &state.body.particles;
        if let Some(later) = &model.later {
            base.body.particles = base.body.particles.joined_by(later);
        }
        let mut place = vec![None; self.seeded.body.len()];
        for (particle, &number) in there.number.iter().enumerate() {
            place[number] = Some(particle);
        }
        let all = &base.body.particles;
        let kept = all.keeping(|particle| place[all.number[particle]].is_some())?;
        let mut fields = (*kept).clone();
        for particle in 0..fields.x.len() {
            if let Some(at) = place[fields.number[particle]] {
                fields.law[particle] = there.law[at];
                fields.ratios[particle] = there.ratios[at];
                fields.mass[particle] = there.mass[at];
            }
        }
        base.body.particles = Particles::from_fields(fields)?;
        Ok(base)
    }

    /// The size of the model that begins with a body.
    pub fn size(&self, body: &Body<D>) -> ModelSize {
        let particles = &body.particles;
        let there = |stage: usize| {
            let bodies = self.case.bodies_after(stage);
            let indices = self.seeded.body.iter();
            indices.filter(|&&body| bodies[body]).count()
        };
        let most = (0..self.case.stages.len()).map(there).max();
        ModelSize {
            dimensions: D,
            axisymmetric: self.case.method.section.is_axisymmetric(),
            particles: most.unwrap_or(0).max(particles.len()),
            cells: self.case.grid.cells().iter().product(),
            unknowns: 0,
            weight: particles.mass.iter().sum::<f64>() * self.case.gravity,
            volume: particles.volume0.iter().sum(),
        }
    }

    /// The way down of the rigid footing or rigid body that the grid follows \[m\].
    pub fn lowered(&self, controls: &Controls) -> f64 {
        match self.followed {
            Some((body, _)) => controls.rigid[body].track.lowered,
            None => controls.settlement,
        }
    }

    /// The background grid when its followed body has sunk so far \[m\].
    ///
    /// # Errors
    /// [`ShapeError`] for cells that make no grid.
    pub fn grid(&self, lowered: f64) -> Result<Grid<D>, ShapeError> {
        let mut grid = self.case.grid.grid()?;
        let row = match (&self.footing, self.followed) {
            (Some(footing), _) if lowered > 0.0 => footing.row(),
            (None, Some((_, row))) if lowered != 0.0 => row,
            _ => return Ok(grid),
        };
        grid.axes[D - 1] = footing::rows(&self.case.grid.axes[D - 1], row, lowered)?;
        Ok(grid)
    }

    /// The conditions of a step between two controls, with so much `drag` \[1/s²\], on the grid of the
    /// settlement that the step begins with.
    ///
    /// # Errors
    /// [`AssemblyError`] when the grid or the reduced laws cannot be made.
    pub fn conditions(
        &self,
        from: &Controls,
        to: &Controls,
        drag: f64,
    ) -> Result<StepConditions<D>, AssemblyError> {
        self.conditions_on(self.grid(self.lowered(from)), (from, to), drag)
    }

    /// The same on another grid.
    pub(crate) fn conditions_on(
        &self,
        grid: Result<Grid<D>, ShapeError>,
        (from, to): (&Controls, &Controls),
        drag: f64,
    ) -> Result<StepConditions<D>, AssemblyError> {
        let grid = grid.map_err(|source| AssemblyError::Grid { source })?;
        let mut constraints = self.supports(&grid, &[])?;
        if let Some(footing) = self.footing.as_ref().filter(|_| to.settlement > 0.0) {
            footing.push(&grid, &mut constraints, from.settlement - to.settlement)?;
        }
        StepConditions::new(
            grid,
            constraints,
            StepLoads {
                gravity: to.body_force::<D>().map(|share| share * self.case.gravity),
                factors: to.factors.clone(),
                drag,
            },
            self.laws_reduced_by(&to.srf)?,
        )?
        .with_motions(super::rigid::motions(self.case, from, to))?
        .with_reinforcement(super::reinforcement::controls(self.case, to))?
        .with_water(self.water(to))
    }

    /// A condition of the water; none: dry.
    pub(crate) fn ground_water(&self, condition: usize) -> Option<&Arc<GroundWater<D>>> {
        self.water.get(condition)
    }

    /// Water in the pores of a step that ends with these controls.
    fn water(&self, to: &Controls) -> Water<D> {
        let stiffness = |material: &Material| match material.drainage {
            Drainage::Undrained { stiffness, .. } if !to.drained => stiffness,
            _ => PoreStiffness::default(),
        };
        let water = to.water.and_then(|condition| self.ground_water(condition));
        Water {
            given: water.map(|water| Arc::clone(water) as Arc<dyn PoreWater<D>>),
            factor: to.gravity,
            stiffness: (0..self.laws.len())
                .map(|law| stiffness(self.case.material_of(law)))
                .collect(),
        }
    }

    /// The laws at reduced strength; `srf` has a strength reduction factor for each \[-\].
    ///
    /// # Errors
    /// [`AssemblyError::Material`] for a factor that makes no law.
    pub fn laws_reduced_by(&self, srf: &[f64]) -> Result<Vec<SharedLaw>, AssemblyError> {
        reduced(self.case, &self.laws, srf)
    }

    /// Resistance of the footing, compression positive, times its reaction factor \[N/m\].
    pub fn footing_resistance(&self, grid: &Grid<D>, reactions: &[[f64; D]]) -> f64 {
        self.footing
            .as_ref()
            .map_or(0.0, |footing| footing.resistance(grid, reactions))
    }

    /// The supports of a grid, without those of some of its walls: by axis, and whether it is the upper end.
    ///
    /// # Errors
    /// As [`Constraints::fix_wall`].
    pub(crate) fn supports(
        &self,
        grid: &Grid<D>,
        without: &[(usize, bool)],
    ) -> Result<Constraints<D>, AssemblyError> {
        let mut constraints = Constraints::free(grid);
        let boundaries = &self.case.boundaries;
        for (normal, sides) in boundaries.sides.iter().enumerate() {
            for (side, upper) in std::iter::zip(sides, [false, true]) {
                if without.contains(&(normal, upper)) {
                    continue;
                }
                for axis in 0..D {
                    if *side == Side::Fixed || (*side == Side::Roller && axis == normal) {
                        constraints.fix_wall(grid, normal, upper, axis)?;
                    }
                }
            }
        }
        let reach = self.case.grid.smallest_cell().map(|cell| 1e-6 * cell);
        for held in &boundaries.boxes {
            for node in 0..grid.node_count() {
                let x = grid.node_position(node);
                let inside = (0..D).all(|axis| {
                    held.lower[axis] - reach[axis] <= x[axis]
                        && x[axis] <= held.upper[axis] + reach[axis]
                });
                for axis in (0..D).filter(|&axis| inside && held.fix[axis]) {
                    constraints.prescribe(node, axis, 0.0)?;
                }
            }
        }
        Ok(constraints)
    }

    /// Sizes and tolerances of a march of so many steps.
    pub fn march_settings(&self, steps: usize) -> MarchSettings {
        let solver = &self.case.solver;
        MarchSettings {
            steps,
            cuts: solver.cuts,
            cut_factor: solver.cut_factor,
            newton: NewtonSettings {
                tolerance: solver.tolerance,
                max_iterations: solver.max_iterations,
                ..NewtonSettings::default()
            },
            ..MarchSettings::steps(steps)
        }
    }

    /// Coordinates of the lines of the undeformed grid along each axis \[m\]; none where there is no grid.
    fn lines(&self) -> Vec<Vec<f64>> {
        self.grid(0.0).map_or_else(
            |_| Vec::new(),
            |grid| (grid.axes.iter().map(|axis| axis.nodes().to_vec())).collect(),
        )
    }

    /// The case's linear solver, or the one that a program gave.
    pub fn solver(&self) -> Box<dyn LinearSolver> {
        match &self.case.given_solver {
            Some(given) => (given.make)(&OfCase {
                settings: &self.case.solver,
                factor_bytes: self.factors.bytes,
                lines: self.lines(),
            }),
            None => self.case.solver.linear.build_within(self.factors.bytes),
        }
    }
}

/// Laws of a case at strengths divided by these factors, by material.
pub(crate) fn reduced<const D: usize>(
    case: &Case<D>,
    laws: &[SharedLaw],
    srf: &[f64],
) -> Result<Vec<SharedLaw>, AssemblyError> {
    let mut all: Vec<SharedLaw> = Vec::with_capacity(laws.len());
    for (number, law) in laws.iter().enumerate() {
        let material = case.number_of_material(number);
        all.push(if srf[material].total_cmp(&1.0).is_eq() {
            Arc::clone(law)
        } else if material < number && Arc::ptr_eq(law, &laws[material]) {
            Arc::clone(&all[material])
        } else {
            law.reduced(srf[material])
                .map_err(|source| AssemblyError::Law { source })?
        });
    }
    Ok(all)
}

/// The points that carry pressures and forces, each under the number of its load.
fn load_points<const D: usize>(case: &Case<D>) -> Vec<LoadPoint<D>> {
    let mut points = Vec::new();
    for (load, kind) in case.loads.iter().map(|load| &load.kind).enumerate() {
        match kind {
            LoadKind::RigidFooting { .. } => {}
            &LoadKind::Pressure { from, to, traction } => {
                let cells = case.grid.axes.iter().enumerate();
                let cells = cells.map(|(k, axis)| axis.smallest_between(from[k], to[k]));
                let cell = cells.fold(f64::INFINITY, f64::min);
                let count =
                    |length: f64| (POINTS_PER_CELL * length / cell).ceil().max(1.0) as usize;
                let way: [f64; D] = std::array::from_fn(|axis| to[axis] - from[axis]);
                points.extend(if D == 2 {
                    let count = count(fields::length(&way));
                    let part = way.map(|way| way / count as f64);
                    let edge = LoadPoint::along_edge(from, to, traction, count, load).into_iter();
                    edge.map(|point| point.around(case.method.section, &part))
                        .collect()
                } else {
                    let counts = way.map(|length| count(length.abs()));
                    LoadPoint::on_rectangle(from, to, traction, counts, load)
                });
            }
            LoadKind::Patch {
                plan,
                level,
                traction,
            } => {
                let (lower, upper) = plan.bounds((&case.grid.lower(), &case.grid.upper()));
                let cells = case.grid.axes.iter().take(2).enumerate();
                let cells = cells.map(|(k, axis)| axis.smallest_between(lower[k], upper[k]));
                let cell = cells.fold(f64::INFINITY, f64::min);
                let counts = [0, 1].map(|axis| {
                    let side = upper[axis] - lower[axis];
                    (POINTS_PER_CELL * side / cell).ceil().max(1.0) as usize
                });
                points.extend(
                    plan.parts((lower, upper), counts)
                        .into_iter()
                        .map(|(area, at)| LoadPoint {
                            x: std::array::from_fn(|axis| match axis {
                                2 => *level,
                                _ => at[axis],
                            }),
                            force: traction.map(|value| value * area),
                            load,
                        }),
                );
            }
            &LoadKind::Point { at, force } => points.push(LoadPoint { x: at, force, load }),
        }
    }
    points
}

/// The displacement γH²/E \[m\] (theory, eq. 32a); none for bodies without weight.
pub(crate) fn displacement_scale<const D: usize>(
    model: &Model<'_, D>,
    state: &State<D>,
) -> Option<f64> {
    let particles = &state.body.particles;
    let weight = particles.mass.iter().sum::<f64>() * model.case.gravity;
    let volume: f64 = particles.volume0.iter().sum();
    let soft: f64 = (particles.volume0.iter().enumerate())
        .map(|(particle, volume)| volume / particles.young(particle, &model.laws))
        .sum();
    let scale = weight / volume * height(state).powi(2) * soft / volume;
    (scale > 0.0).then_some(scale)
}

/// Height of the soil \[m\].
pub(crate) fn height<const D: usize>(state: &State<D>) -> f64 {
    let particles = &state.body.particles;
    let levels = || (0..particles.len()).flat_map(|k| soil_ends(particles, k, D - 1));
    levels().fold(f64::NEG_INFINITY, f64::max) - levels().fold(f64::INFINITY, f64::min)
}
