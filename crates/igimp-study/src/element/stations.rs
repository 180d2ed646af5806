//! Where a test stops: after every step, and at every measurement, so that nothing between steps is interpolated.

use igimp_material::Principal;
use igimp_solver::element::{COMPONENTS, Control, ElementPath, StepLost};

/// Stops that are nearer to each other than this share of a leg are the same \[-\].
const SAME: f64 = 1e-9;

/// A path with its stops. A way is the number of legs that were followed, with the share of the last one.
#[derive(Clone, Debug)]
pub(super) struct Stations {
    /// A leg from stop to stop; the path as it was, where nothing is measured.
    pub(super) path: ElementPath,
    /// Steps of a leg.
    pub(super) steps: usize,
    /// The ways of the states, from the start.
    pub(super) ways: Vec<f64>,
    /// Whether the legs are those of the path.
    is_whole: bool,
}

impl Stations {
    /// Those of a path from a stress, with so many steps a leg and stops on the way.
    pub(super) fn new(path: ElementPath, sigma: &Principal, steps: usize, stops: &[f64]) -> Self {
        let regular = |k: usize| k as f64 / steps as f64;
        let mut ways: Vec<f64> = (0..=path.legs.len() * steps).map(regular).collect();
        if stops.is_empty() || steps == 0 {
            return Self {
                path,
                steps,
                ways,
                is_whole: true,
            };
        }
        let far = |way: &f64| {
            let nearest = regular((way * steps as f64).round() as usize);
            (way - nearest).abs() > SAME
        };
        ways.extend(stops.iter().filter(|way| far(way)));
        ways.sort_by(f64::total_cmp);
        ways.dedup_by(|next, before| *next - *before <= SAME);
        let ends = ends(&path, sigma);
        let legs = (ways[1..].iter()).map(|way| at(&ends, *way)).collect();
        Self {
            path: ElementPath {
                controls: path.controls,
                legs,
            },
            steps: 1,
            ways,
            is_whole: false,
        }
    }

    /// How long its legs take, where one of the path takes this long \[s\].
    pub(super) fn durations(&self, leg: f64) -> Vec<f64> {
        if self.is_whole {
            vec![leg; self.path.legs.len()]
        } else {
            let parts = self.ways.windows(2);
            parts.map(|ends| leg * (ends[1] - ends[0])).collect()
        }
    }

    /// The state of a way.
    pub(super) fn state_at(&self, way: f64) -> usize {
        let next = self.ways.partition_point(|at| *at < way);
        let before = next.saturating_sub(1);
        let off = |k: usize| {
            self.ways
                .get(k)
                .map_or(f64::INFINITY, |at| (at - way).abs())
        };
        if off(before) < off(next) {
            before
        } else {
            next
        }
    }

    /// A step that was lost, on the legs of the path as it was.
    pub(super) fn on_path(&self, lost: StepLost) -> StepLost {
        if self.is_whole {
            return lost;
        }
        let (from, to) = (self.ways[lost.leg], self.ways[lost.leg + 1]);
        let leg = (to.ceil() as usize).max(1) - 1;
        StepLost {
            leg,
            share: from + lost.share * (to - from) - leg as f64,
            law: lost.law,
        }
    }
}

/// Prescribed values at the start and at the ends of the legs.
fn ends(path: &ElementPath, sigma: &Principal) -> Vec<[f64; COMPONENTS]> {
    let initial: [f64; COMPONENTS] = std::array::from_fn(|c| match path.controls[c] {
        Control::Stress => sigma.get(c).copied().unwrap_or(0.0),
        Control::Strain | Control::AsXx => 0.0,
    });
    let legs = path.legs.iter().map(|leg| {
        std::array::from_fn(|c| {
            if path.controls[c] == Control::Stress && leg[c].is_nan() {
                initial[c]
            } else {
                leg[c]
            }
        })
    });
    std::iter::once(initial).chain(legs).collect()
}

/// Prescribed values on a way.
fn at(ends: &[[f64; COMPONENTS]], way: f64) -> [f64; COMPONENTS] {
    let leg = (way.ceil() as usize).clamp(1, ends.len() - 1);
    let share = way - (leg - 1) as f64;
    std::array::from_fn(|c| ends[leg - 1][c] + share * (ends[leg][c] - ends[leg - 1][c]))
}
