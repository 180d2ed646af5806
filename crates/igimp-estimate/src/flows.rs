//! Cost of the flows of a case that are computed before its first stage.
//!
//! Fitted to dams of 400 to 100 000 heads in the plane and of 1 300 to 30 000 in space: time and memory grow little faster than the heads.
//! Upright dams take half as long as is said here, a sloping one with a drain twice as long. A flow in time takes steps that its error
//! chooses; their number is that of the sloping dam as it drains, some 10 from one time to the next on coarse cells, and more on fine ones.

use igimp_model::{Case, PoreSource};

/// A steady flow, in the plane and in space \[s per head\].
const STEADY: [f64; 2] = [3.2e-5, 1e-4];
/// A step in time, in the plane and in space \[s per head\].
const STEP: [f64; 2] = [4e-5, 1.5e-4];
/// Steps in time from one moment to the next.
const STEPS: f64 = 15.0;
/// Equations, factors and the ground of a flow, in the plane and in space \[bytes per head\].
const BYTES: [f64; 2] = [1.8e3, 4e3];

/// The cost of the flows of a case.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Flows {
    /// All of them on one thread of the reference computer \[s\].
    pub seconds: f64,
    /// The most that one takes \[bytes\].
    pub bytes: f64,
}

impl Flows {
    /// Those of a case with soil about so many nodes.
    pub(super) fn of<const D: usize>(case: &Case<D>, nodes: usize) -> Self {
        let [mut steady, mut moments] = [0.0; 2];
        for condition in &case.water {
            if let PoreSource::Seepage(flow) = &condition.source {
                match flow.in_time {
                    Some(_) => moments += 1.0,
                    None => steady += 1.0,
                }
            }
        }
        if steady == 0.0 {
            return Self::default();
        }
        let (heads, of) = (nodes as f64, D - 2);
        Self {
            seconds: heads * (steady * STEADY[of] + moments * STEPS * STEP[of]),
            bytes: heads * BYTES[of],
        }
    }
}

#[cfg(test)]
mod tests {
    use igimp_input::shipped::find;

    use super::*;

    /// GOAL: flows are counted, steady ones and moments in time, and nothing where none is computed. ORACLE: by hand.
    #[test]
    fn flows_are_counted() {
        let flows = |name: &str, nodes: usize| {
            let file = find(name).unwrap().case_file::<String>([]).unwrap();
            Flows::of::<2>(file.case(), nodes)
        };
        assert_eq!(flows("dam_drawdown", 1000), Flows::default());
        let steady = flows("dam_seepage", 1000);
        assert!((steady.seconds - 0.032).abs() < 1e-12 && (steady.bytes - 1.8e6).abs() < 1e-3);
        // Of its flows one is followed through four moments.
        let in_time = flows("rapid_drawdown", 1000);
        let moments = 4.0 * STEPS * STEP[0] * 1000.0;
        let steady = (in_time.seconds - moments) / 0.032;
        assert!(
            (steady - steady.round()).abs() < 1e-9 && steady > 0.5,
            "{steady}"
        );
    }
}
