//! Whether a motion has come to rest (theory, eq. 68b).

use serde::{Deserialize, Serialize};

/// How many times the share at rest motion has still, where it begins to come to rest \[-\].
const LOUD: f64 = 10.0;

/// How long it has to stay at rest, over the time in which it came there \[-\].
const STAYS: f64 = 1.5;

/// Since when motion is calm. A body that swings has no speed where it turns: its kinetic energy falls from ten times a small share of the
/// largest to that share, and stays below, for times as 2.16 to 2.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Calm {
    /// When kinetic energy last was ten times the share at rest, or more \[s\].
    loud: f64,
    /// Since when it is below that share \[s\].
    quiet: Option<f64>,
}

impl Calm {
    /// Takes the kinetic energy at a time \[s\], over that at rest; whether the body rests.
    pub fn take(&mut self, time: f64, over_rest: f64) -> bool {
        if over_rest >= LOUD {
            self.loud = time;
        }
        if over_rest >= 1.0 {
            self.quiet = None;
            return false;
        }
        let since = *self.quiet.get_or_insert(time);
        time - since >= STAYS * (since - self.loud)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// When a motion of this kinetic energy has come to rest at a share of the largest, by samples that are so far apart \[s\]; none within
    /// 100 s.
    fn rests(apart: f64, share: f64, energy: impl Fn(f64) -> f64) -> Option<f64> {
        let (mut calm, mut most) = (Calm::default(), 0.0_f64);
        let times = (1..).map(|k| f64::from(k) * apart);
        let mut times = times.take_while(|time| *time < 100.0);
        times.find(|&time| {
            most = most.max(energy(time));
            calm.take(time, energy(time) / most / share)
        })
    }

    /// GOAL: a body that swings without end does not rest where it turns, and one that slows down does.
    /// ORACLE: sin² is never at rest, whatever share counts as rest; speed that falls evenly is none from its end on; one that decays has
    /// fallen to a millionth of its energy in 6.9 time constants.
    #[test]
    fn a_turning_point_is_no_rest() {
        for share in [1e-6, 1e-4, 1e-2, 0.1] {
            for apart in [0.0011, 0.013, 0.05] {
                let swings = |time: f64| time.sin().powi(2);
                assert_eq!(rests(apart, share, swings), None, "{share} {apart}");
            }
        }
        let slows = |time: f64| (1.0 - time).max(0.0).powi(2);
        let rest = rests(1e-3, 1e-3, slows).unwrap();
        assert!((0.97..1.15).contains(&rest), "{rest}");
        let decays = |time: f64| (-2.0 * time).exp();
        let rest = rests(0.01, 1e-6, decays).unwrap();
        assert!((6.9..9.0).contains(&rest), "{rest}");
    }
}
