//! Seepage of a case: steady, or followed in time.

use std::sync::Arc;

use igimp_model::{Case, Ground, InTime, PoreSource, SeepageCase};
use igimp_seepage::{
    Conditions, Course, Scale, Seepage, SeepageBody, SeepageError, WaterBalance, march, solve,
};

use crate::error::CaseError;

/// The flows of a case.
#[derive(Debug)]
pub(crate) struct Flows<const D: usize> {
    /// By condition of the water; none where nothing is computed.
    pub(crate) by_condition: Vec<Option<Arc<Seepage<D>>>>,
    pub(crate) courses: Vec<Followed>,
}

/// How the permeability of a material varies from place to place; none: it does not.
type Varied<'c, const D: usize> = Option<Box<dyn Fn(&[f64; D]) -> f64 + Sync + 'c>>;

/// The same by material.
fn varied<'c, const D: usize>(case: &'c Case<D>, ground: &'c Ground<D>) -> Vec<Varied<'c, D>> {
    let of = |material: &'c igimp_model::Material| -> Varied<'c, D> {
        material.profiles.permeability.as_ref()?;
        Some(Box::new(|place: &[f64; D]| {
            material.permeability_ratio_at(place, ground)
        }))
    };
    case.materials.iter().map(of).collect()
}

/// A flow that was followed in time.
#[derive(Clone, Debug)]
pub(crate) struct Followed {
    /// The conditions that are moments of it, by time.
    pub(crate) conditions: Vec<usize>,
    /// The balance of water after each step.
    pub(crate) balance: Vec<WaterBalance>,
    /// Steps that were taken back.
    pub(crate) cuts: usize,
}

impl<const D: usize> Flows<D> {
    /// Solves for all of them, the steady ones first.
    ///
    /// # Errors
    /// [`CaseError::Seepage`] and [`CaseError::NoPermeability`].
    pub(crate) fn of(case: &Case<D>) -> Result<Self, CaseError> {
        let mut found = Self {
            by_condition: vec![None; case.water.len()],
            courses: Vec::new(),
        };
        let ground = case.ground();
        let varied = varied(case, &ground);
        let stated = |index: usize| match &case.water[index].source {
            PoreSource::Seepage(flow) => Some(&**flow),
            _ => None,
        };
        let mut left: Vec<(usize, &SeepageCase, &InTime)> = Vec::new();
        for index in 0..case.water.len() {
            let Some(flow) = stated(index) else { continue };
            match &flow.in_time {
                Some(in_time) => left.push((index, flow, in_time)),
                None => {
                    found.by_condition[index] = Some(Arc::new(solved(case, index, flow, &varied)?));
                }
            }
        }
        left.sort_by(|a, b| a.2.time.total_cmp(&b.2.time));
        while let Some(&(_, first, at)) = left.first() {
            let is_of_it = |other: &(usize, &SeepageCase, &InTime)| {
                (&other.1.conditions, &other.1.free_water) == (&first.conditions, &first.free_water)
                    && (other.2.start, &other.2.histories) == (at.start, &at.histories)
            };
            let (moments, others): (Vec<_>, Vec<_>) = left.into_iter().partition(is_of_it);
            left = others;
            found.follow(case, &moments, &varied)?;
        }
        Ok(found)
    }

    /// Follows a flow through its moments, the earliest first.
    fn follow(
        &mut self,
        case: &Case<D>,
        moments: &[(usize, &SeepageCase, &InTime)],
        varied: &[Varied<'_, D>],
    ) -> Result<(), CaseError> {
        let [.., (last, flow, in_time)] = moments else {
            return Ok(());
        };
        let mut times: Vec<f64> = moments.iter().map(|(.., at)| at.time).collect();
        times.dedup();
        let course = Course {
            histories: in_time.histories.clone(),
            times,
        };
        let Some(start) = self.by_condition[in_time.start].clone() else {
            return Ok(());
        };
        // The ground is that of the start.
        let bodies = bodies(case, (*last, in_time.start), varied)?;
        let (conditions, free) = given(case, flow);
        let grid = case.grid.grid()?;
        let found = march(&grid, &bodies, (&start, &conditions), &free, &course);
        let found = found.map_err(|source| {
            // The moment that it was on its way to.
            let next = match source {
                SeepageError::Stuck { time } => moments.iter().find(|(.., at)| at.time > time),
                _ => None,
            };
            let water = next.map_or(*last, |(index, ..)| *index);
            CaseError::Seepage {
                water: case.water[water].name.clone(),
                source,
            }
        })?;
        let states: Vec<Arc<Seepage<D>>> = found.states.into_iter().map(Arc::new).collect();
        for (index, _, at) in moments {
            let state = course.times.iter().position(|time| *time >= at.time);
            self.by_condition[*index] = state.map(|state| Arc::clone(&states[state]));
        }
        self.courses.push(Followed {
            conditions: moments.iter().map(|(index, ..)| *index).collect(),
            balance: found.balance,
            cuts: found.cuts,
        });
        Ok(())
    }
}

/// Solves for the steady flow of the condition of that index, in the ground as the case draws it.
fn solved<const D: usize>(
    case: &Case<D>,
    condition: usize,
    flow: &SeepageCase,
    varied: &[Varied<'_, D>],
) -> Result<Seepage<D>, CaseError> {
    let bodies = bodies(case, (condition, condition), varied)?;
    let (conditions, free) = given(case, flow);
    solve(&case.grid.grid()?, &bodies, &conditions, &free).map_err(|source| CaseError::Seepage {
        water: case.water[condition].name.clone(),
        source,
    })
}

/// The bodies that are there for a condition, through the ground of another.
fn bodies<'c, const D: usize>(
    case: &'c Case<D>,
    (condition, ground): (usize, usize),
    varied: &'c [Varied<'c, D>],
) -> Result<Vec<SeepageBody<'c, D>>, CaseError> {
    let bodies = case.bodies_of_water(ground);
    for (_, material) in &bodies {
        let material = &case.materials[*material];
        if material.permeability.is_none() {
            return Err(CaseError::NoPermeability {
                water: case.water[condition].name.clone(),
                material: material.name.clone(),
            });
        }
    }
    let body = |(region, soil): (_, usize)| SeepageBody {
        region,
        soil,
        scale: varied[soil].as_deref().map(|f| -> Scale<'c, D> { f }),
    };
    Ok(bodies.into_iter().map(body).collect())
}

/// The data of a flow: its conditions, and the level of free water by place.
fn given<'a, const D: usize>(
    case: &Case<D>,
    flow: &'a SeepageCase,
) -> (
    Conditions<D>,
    impl Fn(&[f64; D]) -> Option<f64> + Sync + use<'a, D>,
) {
    let free = |place: &[f64; D]| {
        let level = flow.free_water.as_ref()?.table(place)?;
        level.is_finite().then_some(level)
    };
    let conditions = flow.with_soils(&case.materials, case.water_unit_weight);
    (conditions, free)
}
