//! The records of a run: curves and the histories at monitors, one row per recorded moment.

use igimp_assembly::{Particles, SharedLaw};
use igimp_geometry::SeedError;
use igimp_model::{Case, CheckTime, Field, Quantity, StageKind};
use igimp_results::measure::{nearest, place::Place};
use igimp_results::summary::EnergySummary;
use igimp_results::tables::table::Table;

use super::moment::{Moment, kinetic_energy, moment_columns};
use crate::error::CaseError;
use crate::run::model::reduced;
use crate::run::{reinforcement, rigid};

/// The tables of a run, and the material points that its monitors watch.
#[derive(Debug)]
pub(crate) struct Records {
    /// By curve of the case.
    pub(crate) curves: Vec<Table>,
    /// By monitor of the case.
    pub(crate) monitors: Vec<Table>,
    /// By rigid body of the case.
    pub(crate) rigid: Vec<Table>,
    /// Where the work of stages that take time went.
    pub(crate) energy: Table,
    /// The material point that each monitor follows.
    pub(crate) watched: Vec<Place>,
    /// By check of the case: the largest value of its quantity in its stage so far; not a number before.
    pub(crate) peaks: Vec<f64>,
    /// Middle of the interval of the factor of safety found last \[-\].
    pub(crate) factor_of_safety: f64,
    /// By condition of the water: the outflow of its flow, then the inflow through each section; empty without one
    /// \[m²/s; m³/s in space\].
    discharges: Vec<Vec<f64>>,
    laws: Vec<SharedLaw>,
    /// Particles of all bodies, also of those that come later.
    seeded: usize,
}

/// Bodies hold a place up to this share of a cell beside it \[-\].
const BESIDE: f64 = 1e-6;

/// The place of a monitor. One that stands where a body that construction places or removes meets one that is there all along is of
/// the latter: the crest of a cut is that of the ground.
fn watched<const D: usize>(
    case: &Case<D>,
    particles: &Particles<D>,
    point: &[f64; D],
) -> Option<Place> {
    let mut changes = vec![false; case.bodies.len()];
    for stage in &case.stages {
        if let StageKind::Construction(works) = &stage.kind {
            for &body in works.place.iter().chain(&works.remove) {
                changes[body] = true;
            }
        }
    }
    let reach = BESIDE
        * case
            .grid
            .smallest_cell()
            .into_iter()
            .fold(f64::INFINITY, f64::min);
    let ends = [-reach, reach].map(|by| point.map(|x| x + by));
    let holds = |body: &usize| case.bodies[*body].region.within(ends[0], ends[1]).volume > 0.0;
    let (goes, stays): (Vec<usize>, Vec<usize>) = (0..case.bodies.len())
        .filter(holds)
        .partition(|&body| changes[body]);
    let of_those_that_stay = |&particle: &usize| {
        let x = particles.x[particle];
        stays
            .iter()
            .any(|&body| case.bodies[body].region.encloses(x))
    };
    let distance = |particle: usize| {
        let pairs = std::iter::zip(&particles.x[particle], point);
        pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f64>()
    };
    let found = if goes.is_empty() || stays.is_empty() {
        nearest(particles, point, f64::INFINITY)
    } else {
        (0..particles.len())
            .filter(of_those_that_stay)
            .min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
    };
    found.map(|particle| Place::near(particles, particle, point, case.materials.len()))
}

impl Records {
    /// Empty tables; monitors stand in the undeformed bodies.
    pub(crate) fn new<const D: usize>(
        case: &Case<D>,
        laws: &[SharedLaw],
        particles: &Particles<D>,
    ) -> Result<Self, CaseError> {
        let curves = case
            .curves
            .iter()
            .map(|curve| Table::new(&*curve.name, &[&curve.x.label, &curve.y.label]))
            .collect();
        let monitors = case
            .monitors
            .iter()
            .map(|monitor| {
                let fields = monitor.record.iter().map(|&field| field.header());
                Table {
                    name: monitor.name.clone(),
                    header: moment_columns(case).chain(fields).collect(),
                    rows: Vec::new(),
                }
            })
            .collect();
        let rigid = case.rigid.iter().map(|part| rigid_table(case, &part.name));
        let watched = case
            .monitors
            .iter()
            .map(|monitor| {
                watched(case, particles, &monitor.point)
                    .ok_or(CaseError::Seed(SeedError::EmptyBody))
            })
            .collect::<Result<_, _>>()?;
        Ok(Self {
            curves,
            monitors,
            rigid: rigid.collect(),
            energy: energy_table(case.per_metre()),
            watched,
            peaks: vec![f64::NAN; case.checks.len()],
            factor_of_safety: f64::NAN,
            discharges: Vec::new(),
            laws: laws.to_vec(),
            seeded: particles.len(),
        })
    }

    /// The same with the discharges of flows.
    pub(crate) fn with_discharges(mut self, discharges: Vec<Vec<f64>>) -> Self {
        self.discharges = discharges;
        self
    }

    /// How many particles the case has numbers for.
    pub(crate) fn seeded(&self) -> usize {
        self.seeded
    }

    /// How many laws particles number.
    pub(crate) fn law_count(&self) -> usize {
        self.laws.len()
    }

    /// The laws at the strength that acts; full strength where none can be made of it.
    fn laws_at<const D: usize>(&self, case: &Case<D>, moment: &Moment<'_, D>) -> Vec<SharedLaw> {
        reduced(case, &self.laws, &moment.controls.srf).unwrap_or_else(|_| self.laws.clone())
    }

    /// A field at the material point of a monitor; not a number while that is not there.
    fn at_monitor<const D: usize>(
        &self,
        monitor: usize,
        field: Field,
        moment: &Moment<'_, D>,
        laws: &[SharedLaw],
    ) -> f64 {
        self.watched[monitor].field(field, moment.particles, laws, moment.grid)
    }

    /// A quantity of a moment, in SI units.
    pub(crate) fn quantity<const D: usize>(
        &self,
        case: &Case<D>,
        of: Quantity,
        moment: &Moment<'_, D>,
    ) -> f64 {
        let controls = moment.controls;
        match of {
            Quantity::Settlement(_) => controls.settlement,
            Quantity::Reaction(_) => moment.resistance,
            Quantity::Rigid(body, of) => rigid::quantity(case, controls, moment.rigid, body, of),
            Quantity::Reinforcement(member, of) => {
                reinforcement::quantity(controls, moment.reinforcement, member, of)
            }
            Quantity::LoadFactor(load) => controls.factors[load],
            Quantity::Monitor(monitor, field) => {
                self.at_monitor(monitor, field, moment, &self.laws_at(case, moment))
            }
            Quantity::LargestDisplacement => moment.largest_displacement(),
            Quantity::GravityFactor => controls.gravity,
            Quantity::HorizontalFactor => controls.acceleration[0],
            Quantity::ReductionFactor => controls.reduction(),
            Quantity::Step => moment.number as f64,
            Quantity::PlasticShare => moment.plastic_share,
            Quantity::FactorOfSafety => self.factor_of_safety,
            Quantity::Discharge(water, section) => {
                let flow = self.discharges.get(water);
                let number = section.map_or(0, |section| section + 1);
                flow.and_then(|flow| flow.get(number))
                    .copied()
                    .unwrap_or(f64::NAN)
            }
            Quantity::Time => controls.time,
            Quantity::KineticEnergy => kinetic_energy(moment.particles, moment.rigid),
            Quantity::Top => (moment.particles.x.iter().enumerate())
                .map(|(k, x)| x[D - 1] + moment.particles.drawn_half_length(k)[D - 1])
                .fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// Takes a moment into the peaks of the checks that look for one in its stage.
    fn raise_peaks<const D: usize>(&mut self, case: &Case<D>, moment: &Moment<'_, D>) {
        let last = case.stages.len() - 1;
        for (k, check) in case.checks.iter().enumerate() {
            if check.at == CheckTime::Peak && check.stage.unwrap_or(last) == moment.stage {
                // The larger of two as they are told, and the number where only one is one.
                let value = self.quantity(case, check.of, moment);
                let is_turned = check.divide_by < 0.0;
                let peak = &mut self.peaks[k];
                *peak = if is_turned {
                    peak.min(value)
                } else {
                    peak.max(value)
                };
            }
        }
    }

    /// Records a moment: the rows for the curves and the monitors that it belongs to, which are
    /// also kept. The moment before a later stage belongs to the curves of that stage alone.
    pub(crate) fn record<const D: usize>(
        &mut self,
        case: &Case<D>,
        moment: &Moment<'_, D>,
    ) -> Rows {
        let reopens = moment.number == 0 && moment.stage > 0;
        self.raise_peaks(case, moment);
        let mut rows = Rows {
            curves: vec![None; case.curves.len()],
            monitors: Vec::new(),
            rigid: vec![None; case.rigid.len()],
            energy: moment.energy.map(|energy| energy_row(moment, energy)),
            peaks: self.peaks.clone(),
        };
        for (k, curve) in case.curves.iter().enumerate() {
            let belongs = match curve.stage {
                Some(stage) => stage == moment.stage,
                None => !reopens,
            };
            if !belongs {
                continue;
            }
            let row = [&curve.x, &curve.y]
                .map(|axis| self.quantity(case, axis.of, moment) / axis.divide_by)
                .to_vec();
            self.curves[k].push(row.clone());
            rows.curves[k] = Some(row);
        }
        for (k, monitor) in case.monitors.iter().enumerate().filter(|_| !reopens) {
            let laws = self.laws_at(case, moment);
            let mut row = moment.row(case);
            let recorded = monitor.record.iter();
            row.extend(recorded.map(|&field| self.at_monitor(k, field, moment, &laws)));
            self.monitors[k].push(row.clone());
            rows.monitors.push(row);
        }
        self.energy.rows.extend(rows.energy.clone());
        for body in moment.controls.placed().filter(|_| !reopens) {
            let row = rigid_row(case, moment, body);
            self.rigid[body].push(row.clone());
            rows.rigid[body] = Some(row);
        }
        rows
    }
}

/// The rows of one moment.
#[derive(Debug)]
pub(crate) struct Rows {
    /// By curve; none where the curve does not record the stage.
    pub(crate) curves: Vec<Option<Vec<f64>>>,
    /// By monitor.
    pub(crate) monitors: Vec<Vec<f64>>,
    /// By rigid body; none where it is not there.
    pub(crate) rigid: Vec<Option<Vec<f64>>>,
    /// Where the work of its stage went so far, of a stage that takes time.
    pub(crate) energy: Option<Vec<f64>>,
    /// By check: the peak so far.
    pub(crate) peaks: Vec<f64>,
}

/// An empty table of energy.
fn energy_table(per_metre: &str) -> Table {
    let moment = ["stage", "step", "time_[s]"].map(str::to_owned);
    let parts = EnergySummary::default().parts();
    let parts = parts
        .iter()
        .map(|(name, _)| format!("{name}_[J{per_metre}]"));
    Table {
        name: "energy".to_owned(),
        header: moment.into_iter().chain(parts).collect(),
        rows: Vec::new(),
    }
}

/// The row of a moment in the table of energy.
fn energy_row<const D: usize>(moment: &Moment<'_, D>, energy: &EnergySummary) -> Vec<f64> {
    let place = [
        moment.stage as f64 + 1.0,
        moment.number as f64,
        moment.controls.time,
    ];
    let parts = energy.parts();
    let parts = parts.iter().map(|(_, value)| *value);
    place.into_iter().chain(parts).collect()
}

/// An empty history of a rigid body.
fn rigid_table<const D: usize>(case: &Case<D>, name: &str) -> Table {
    let place = ["x_[m]", "y_[m]", "z_[m]"].into_iter().take(D);
    let labels = rigid::recorded(case).into_iter().map(|(label, _)| label);
    let header = moment_columns(case).chain(place.map(str::to_owned));
    Table {
        name: name.to_owned(),
        header: header.chain(labels).collect(),
        rows: Vec::new(),
    }
}

/// The row of a rigid body that is there.
pub(crate) fn rigid_row<const D: usize>(
    case: &Case<D>,
    moment: &Moment<'_, D>,
    index: usize,
) -> Vec<f64> {
    let (controls, bodies) = (moment.controls, moment.rigid);
    let slot = controls.placed().take_while(|&k| k < index).count();
    let mut row = moment.row(case);
    row.extend(bodies[slot].pose.origin);
    let recorded = rigid::recorded(case).into_iter();
    row.extend(recorded.map(|(_, of)| rigid::quantity(case, controls, bodies, index, of)));
    row
}
