//! The state of a run between two steps: the body, and the controls that acted on it last.

use igimp_model::{COMPONENTS, Case};
use igimp_solver::Body;
use serde::{Deserialize, Serialize};

/// Controls of the body: everything that a stage can change.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Controls {
    /// Multiple of gravity \[-\].
    pub gravity: f64,
    /// Pseudo-static force over the weight, to the right, backwards and upwards \[-\].
    pub acceleration: [f64; 3],
    /// Factor by load \[-\].
    pub factors: Vec<f64>,
    /// Settlement of the rigid footing \[m\].
    pub settlement: f64,
    /// Strength reduction factor by material \[-\].
    pub srf: Vec<f64>,
    /// By rigid body of the case.
    pub rigid: Vec<RigidControls>,
    /// The condition of the water, by index; none: dry.
    pub water: Option<usize>,
    /// Whether all soil drains, so that no excess pore pressure comes or goes.
    pub drained: bool,
    /// By member of reinforcement of the case.
    pub reinforcement: Vec<ReinforcementControls>,
    /// Time since the first stage that takes some \[s\].
    #[serde(default)]
    pub time: f64,
    /// Duration of the last step; zero where statics came after it, and as a stage begins \[s\].
    #[serde(default)]
    pub last_step: f64,
    /// Tracks of the nodes of walls that a motion has let go.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub walls: Vec<WallTrack>,
}

/// The track of a node of a wall behind which the ground goes on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WallTrack {
    /// The node of the grid.
    pub node: usize,
    /// The components of displacement that a support held and the motion has let go.
    #[serde(default)]
    pub is_released: [bool; 3],
    /// Force of the support that the wall replaces \[N/m; N in space\].
    pub force: [f64; 3],
    /// Displacement since then \[m\].
    pub displacement: [f64; 3],
}

impl WallTrack {
    /// The same after a step by nodal displacements \[m\].
    fn moved<const D: usize>(&self, u: &[[f64; D]]) -> Self {
        let mut moved = self.clone();
        for (value, by) in moved.displacement.iter_mut().zip(&u[self.node]) {
            *value += by;
        }
        moved
    }
}

/// Controls of a member of reinforcement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ReinforcementControls {
    /// Whether it is there.
    pub installed: bool,
    /// Tension that a jack holds, in the stage that stresses it \[N/m\].
    pub jack: Option<f64>,
}

impl ReinforcementControls {
    fn towards(&self, end: &Self, t: f64) -> Self {
        let jack = end.jack.map(|to| between(self.jack.unwrap_or(to), to, t));
        Self { jack, ..*end }
    }
}

/// Controls of a rigid body, and its motion by them, by component.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RigidControls {
    /// Whether it is there.
    pub placed: bool,
    /// How far each component was moved by prescription so far \[m, rad\].
    pub moved: [f64; COMPONENTS],
    /// The force \[N/m\] or moment \[N\] on the whole body of each component that is not held.
    pub loaded: [Option<f64>; COMPONENTS],
    /// Its motion so far.
    pub track: RigidTrack,
}

/// A rigid body's motion so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RigidTrack {
    /// Displacement of the reference point \[m\] and rotation \[rad\] since it was placed, or since
    /// displacements were reset.
    pub displacement: [f64; COMPONENTS],
    /// Force \[N/m\] and moment about the reference point \[N\] on the whole body from outside.
    pub force: [f64; COMPONENTS],
    /// How far the reference point stands below where the case has it \[m\].
    pub lowered: f64,
}

impl RigidControls {
    fn towards(&self, end: &Self, t: f64) -> Self {
        Self {
            placed: end.placed,
            moved: std::array::from_fn(|k| between(self.moved[k], end.moved[k], t)),
            loaded: std::array::from_fn(|k| {
                let to = end.loaded[k]?;
                Some(between(self.loaded[k].unwrap_or(to), to, t))
            }),
            track: self.track,
        }
    }
}

fn between(a: f64, b: f64, t: f64) -> f64 {
    if t >= 1.0 { b } else { a + t * (b - a) }
}

impl Controls {
    /// Nothing acts, and strength is whole.
    pub(crate) fn none<const D: usize>(case: &Case<D>) -> Self {
        Self {
            gravity: 0.0,
            acceleration: [0.0; 3],
            factors: vec![0.0; case.loads.len()],
            settlement: 0.0,
            srf: vec![1.0; case.materials.len()],
            rigid: vec![RigidControls::default(); case.rigid.len()],
            reinforcement: vec![ReinforcementControls::default(); case.reinforcement.len()],
            water: None,
            drained: false,
            time: 0.0,
            last_step: 0.0,
            walls: Vec::new(),
        }
    }

    /// The controls a share `t` of the way to `end`.
    pub(crate) fn towards(&self, end: &Self, t: f64) -> Self {
        let all = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| between(*a, *b, t)).collect();
        Self {
            gravity: between(self.gravity, end.gravity, t),
            acceleration: std::array::from_fn(|k| {
                between(self.acceleration[k], end.acceleration[k], t)
            }),
            factors: all(&self.factors, &end.factors),
            settlement: between(self.settlement, end.settlement, t),
            srf: all(&self.srf, &end.srf),
            rigid: std::iter::zip(&self.rigid, &end.rigid)
                .map(|(from, end)| from.towards(end, t))
                .collect(),
            reinforcement: std::iter::zip(&self.reinforcement, &end.reinforcement)
                .map(|(from, end)| from.towards(end, t))
                .collect(),
            water: end.water,
            drained: end.drained,
            time: between(self.time, end.time, t),
            last_step: self.last_step,
            walls: self.walls.clone(),
        }
    }

    /// The members of reinforcement that are there, in the order in which the state has them.
    pub fn installed(&self) -> impl Iterator<Item = usize> + '_ {
        let members = self.reinforcement.iter().enumerate();
        members.filter(|(_, part)| part.installed).map(|(k, _)| k)
    }

    /// The force on a body of unit weight by gravity and pseudo-static acceleration, along the axes \[-\] (theory,
    /// eq. 37d).
    pub(crate) fn body_force<const D: usize>(&self) -> [f64; D] {
        let [horizontal, across, vertical] = self.acceleration;
        let mut force = [across; D];
        force[0] = horizontal;
        force[D - 1] = vertical - self.gravity;
        force
    }

    /// The rigid bodies that are there, in the order in which the state has them.
    pub fn placed(&self) -> impl Iterator<Item = usize> + '_ {
        let bodies = self.rigid.iter().enumerate();
        bodies.filter(|(_, part)| part.placed).map(|(body, _)| body)
    }

    /// The same with the motion that others have come to: tracks of rigid bodies and walls, and the duration of the last step.
    #[must_use]
    pub(crate) fn moved_as(mut self, last: &Self) -> Self {
        for (body, as_last) in std::iter::zip(&mut self.rigid, &last.rigid) {
            body.track = as_last.track;
        }
        self.walls.clone_from(&last.walls);
        self.last_step = last.last_step;
        self
    }

    /// The tracks of walls after a step by nodal displacements \[m\].
    pub(crate) fn walls_after<const D: usize>(&self, u: &[[f64; D]]) -> Vec<WallTrack> {
        self.walls.iter().map(|wall| wall.moved(u)).collect()
    }

    /// The largest strength reduction factor of any material \[-\].
    pub(crate) fn reduction(&self) -> f64 {
        self.srf.iter().copied().fold(1.0, |a: f64, b| {
            if (b - 1.0).abs() > (a - 1.0).abs() {
                b
            } else {
                a
            }
        })
    }
}

/// A body and its last controls.
#[derive(Clone, Debug)]
pub struct State<const D: usize> {
    /// The body. Of the rigid bodies and reinforcement of the case it has those that are there
    /// ([`Controls::placed`], [`Controls::installed`]).
    pub body: Body<D>,
    /// Its controls.
    pub controls: Controls,
}

impl<const D: usize> State<D> {
    /// Takes all motion from the body, and the tracks of walls that a motion had let go.
    pub(crate) fn rest(&mut self) {
        self.body.rest();
        self.controls.walls.clear();
    }

    /// The same without motion.
    #[must_use]
    pub(crate) fn at_rest(&self) -> Self {
        let mut state = self.clone();
        state.rest();
        state
    }
}

/// Acceleration of gravity that turns unit weights of a case with this one into densities \[m/s²\]: that of the earth where
/// the case has none.
pub(crate) fn gravity_of_weights(gravity: f64) -> f64 {
    if gravity > 0.0 { gravity } else { 9.81 }
}
