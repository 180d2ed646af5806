//! Motion of the ground during an earthquake, as a record of acceleration or of velocity.

/// How far intervals of an even record may differ, over the interval \[-\].
const ROUND_OFF: f64 = 1e-6;

/// The record of a motion of the ground along an axis, and how it reaches the soil.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundMotion {
    /// Times of its samples, ascending \[s\].
    pub times: Vec<f64>,
    /// Acceleration \[m/s²\], or velocity \[m/s\] where [`Self::is_velocity`], at these times; linear between them.
    pub values: Vec<f64>,
    /// Whether values are velocities.
    pub is_velocity: bool,
    /// The axis along which the ground moves.
    pub axis: usize,
    /// The ground below the soil.
    pub base: Base,
}

/// The ground below soil that is shaken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// Rock that moves by the record, whatever the soil does.
    Rigid,
    /// An elastic half-space whose outcrop would move by the record: waves that come down go on into it.
    Compliant,
}

/// A part of a record over which acceleration is linear.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Beginning \[s\].
    pub start: f64,
    /// Duration \[s\].
    pub duration: f64,
    /// Acceleration at the beginning and at the end \[m/s²\].
    pub acceleration: [f64; 2],
}

impl GroundMotion {
    /// The parts of the record over which acceleration is linear, in order.
    pub fn pieces(&self) -> impl Iterator<Item = Piece> + '_ {
        let samples = self.times.windows(2).zip(self.values.windows(2));
        samples.map(|(times, values)| {
            let duration = times[1] - times[0];
            let slope = (values[1] - values[0]) / duration;
            Piece {
                start: times[0],
                duration,
                acceleration: if self.is_velocity {
                    [slope; 2]
                } else {
                    [values[0], values[1]]
                },
            }
        })
    }

    /// Velocity of the ground at a time, from rest before the record \[m/s\].
    pub fn velocity(&self, time: f64) -> f64 {
        let mut velocity = 0.0;
        for piece in self.pieces().take_while(|piece| piece.start < time) {
            let reached = (time - piece.start).min(piece.duration);
            let [a, b] = piece.acceleration;
            let at = a + reached / piece.duration * (b - a);
            velocity += 0.5 * (a + at) * reached;
        }
        velocity
    }

    /// The interval between samples, the median one where they are not even \[s\].
    pub fn interval(&self) -> f64 {
        let mut all: Vec<f64> = self.pieces().map(|piece| piece.duration).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(f64::INFINITY)
    }

    /// The longest step that may begin at a time, where `usual` is the longest one anywhere \[s\]: no longer than the shortest
    /// interval between samples that it touches, or up to where that one begins.
    pub fn longest_step(&self, at: f64, usual: f64) -> f64 {
        let near = ROUND_OFF * usual;
        let mut longest = usual;
        for piece in self.pieces() {
            if piece.start >= at + longest {
                break;
            }
            if piece.start + piece.duration > at + near {
                longest = longest.min(piece.duration.max(piece.start - at));
            }
        }
        // Intervals of a record that is even differ by round-off.
        if longest > usual - near {
            usual
        } else {
            longest
        }
    }

    /// How many steps the record asks for up to a time \[s\]: one for its usual interval, and one for each that is shorter.
    pub fn steps(&self, until: f64) -> f64 {
        let usual = self.interval();
        let begun = self.pieces().take_while(|piece| piece.start < until);
        let shorter = begun.filter(|piece| piece.duration < (1.0 - ROUND_OFF) * usual);
        shorter.fold(until / usual, |all, p| all + 1.0 - p.duration / usual)
    }

    /// The same of the record up to a time \[s\].
    fn pieces_until(&self, until: f64) -> impl Iterator<Item = Piece> + '_ {
        let begun = self.pieces().take_while(move |piece| piece.start < until);
        begun.map(move |piece| {
            let [a, b] = piece.acceleration;
            let duration = piece.duration.min(until - piece.start);
            let end = a + duration / piece.duration * (b - a);
            Piece {
                duration,
                acceleration: [a, if duration < piece.duration { end } else { b }],
                ..piece
            }
        })
    }

    /// The largest acceleration by magnitude up to a time \[m/s²\].
    pub fn peak(&self, until: f64) -> f64 {
        let all = self
            .pieces_until(until)
            .flat_map(|piece| piece.acceleration);
        all.fold(0.0, |most: f64, a| most.max(a.abs()))
    }

    /// The displacement by which a rigid block slides on ground that moves by the record, by Newmark's method \[m\]: it slides
    /// one way, where the acceleration of the ground against that way is above the one that it yields at, and until its
    /// velocity against the ground is gone. Between samples motion is integrated exactly (theory, eqs. 76 and 77).
    ///
    /// `yield_acceleration` \[m/s²\] is that of the force that moves it: positive along the axis, negative against it. The block
    /// slides on after the record until it rests, and no longer than up to the time `until` \[s\].
    pub fn sliding(&self, yield_acceleration: f64, until: f64) -> f64 {
        let limit = yield_acceleration.abs();
        if limit == 0.0 {
            return f64::INFINITY;
        }
        let (mut velocity, mut way) = (0.0, 0.0);
        for piece in self.pieces_until(until) {
            // The force of inertia acts against the acceleration of the ground.
            let [a, b] = (piece.acceleration).map(|a| -a * yield_acceleration.signum() - limit);
            slide(piece.duration, [a, b], &mut velocity, &mut way);
        }
        let shaken = self.times.last().copied().unwrap_or(0.0);
        let span = (velocity / limit).min((until - shaken).max(0.0));
        way + span * (velocity - 0.5 * limit * span)
    }
}

/// Slides on over a part in which the acceleration against the ground would be linear \[m/s²\].
fn slide(duration: f64, [a, b]: [f64; 2], velocity: &mut f64, way: &mut f64) {
    let mut at = 0.0;
    let slope = (b - a) / duration;
    // Rest and sliding alternate three times at most within a part, for a linear acceleration changes its sign once.
    for _ in 0..4 {
        if at >= duration {
            return;
        }
        let now = a + slope * at;
        if *velocity <= 0.0 && (now < 0.0 || now == 0.0 && slope <= 0.0) {
            // At rest until the acceleration becomes positive.
            *velocity = 0.0;
            let begins = if slope > 0.0 { -a / slope } else { duration };
            at = begins.max(at);
            continue;
        }
        let left = duration - at;
        let span = first_rest(*velocity, now, slope).min(left);
        *way += span * (*velocity + span * (0.5 * now + span * slope / 6.0));
        *velocity += span * (now + 0.5 * span * slope);
        if span < left {
            *velocity = 0.0;
        }
        at += span;
    }
}

/// The first time > 0 at which v + a t + s t²/2 is zero; infinite without one.
fn first_rest(v: f64, a: f64, s: f64) -> f64 {
    if s == 0.0 {
        return if a < 0.0 { -v / a } else { f64::INFINITY };
    }
    let squared = a * a - 2.0 * s * v;
    if squared < 0.0 {
        return f64::INFINITY;
    }
    let root = squared.sqrt();
    let far = -(a + root.copysign(a));
    let roots = [far / s, if far == 0.0 { 0.0 } else { 2.0 * v / far }];
    roots
        .into_iter()
        .filter(|t| *t > 0.0)
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    const G: f64 = 9.81;

    fn record(times: Vec<f64>, values: Vec<f64>) -> GroundMotion {
        GroundMotion {
            times,
            values,
            is_velocity: false,
            axis: 0,
            base: Base::Rigid,
        }
    }

    /// GOAL: the displacement of a block under a rectangular pulse. ORACLE: Newmark (1965): ½ (A − N) g t₀² A/N; A = 0.4, N = 0.1
    /// and t₀ = 0.3 s give 0.52974 m. The same from a record of velocity, against the axis, and not in the other direction.
    #[test]
    fn a_block_slides_under_a_rectangular_pulse() {
        let expected = 0.5 * 0.3 * G * 0.09 * 4.0;
        assert!((expected - 0.52974_f64).abs() < 5e-6);
        let edge = 1e-12;
        let pulse = |sign: f64| {
            let a = sign * 0.4 * G;
            record(vec![0.0, edge, 0.3, 0.3 + edge], vec![0.0, a, a, 0.0])
        };
        assert!((pulse(-1.0).sliding(0.1 * G, f64::INFINITY) - expected).abs() < 1e-9);
        assert!((pulse(1.0).sliding(-0.1 * G, f64::INFINITY) - expected).abs() < 1e-9);
        assert!(pulse(1.0).sliding(0.1 * G, f64::INFINITY).abs() < 1e-12);
        assert!(pulse(-1.0).sliding(0.41 * G, f64::INFINITY).abs() < 1e-12);
        let by_velocity = GroundMotion {
            is_velocity: true,
            ..record(
                vec![0.0, 0.3, 1.0],
                vec![0.0, -0.3 * 0.4 * G, -0.3 * 0.4 * G],
            )
        };
        assert!((by_velocity.sliding(0.1 * G, f64::INFINITY) - expected).abs() < 1e-12);
    }

    /// GOAL: the block moves as long as it is watched, within the record and after it.
    /// ORACLE: constant acceleration by hand: (A − N) g t²/2 in the pulse, from t₀ on against N g.
    #[test]
    fn a_block_is_watched_up_to_a_time() {
        let a = -0.4 * G;
        let pulse = record(vec![0.0, 0.3, 0.3 + 1e-12, 0.5], vec![a, a, 0.0, 0.0]);
        let way = |until: f64| {
            let (within, after) = (until.min(0.3), (until - 0.3).max(0.0));
            let velocity = 0.3 * G * within;
            0.5 * velocity * within + velocity * after - 0.05 * G * after * after
        };
        for until in [0.1, 0.2, 0.3, 0.4, 0.7, 1.1] {
            let found = pulse.sliding(0.1 * G, until);
            assert!((found - way(until)).abs() < 1e-9, "{until}: {found}");
        }
        // At rest after (A − N) t₀/N.
        assert!((pulse.sliding(0.1 * G, 2.0) - way(1.2)).abs() < 1e-9);
        let triangle = record(vec![0.0, 1.0, 2.0], vec![0.0, 2.0, 0.0]);
        assert!((triangle.peak(0.25) - 0.5).abs() < 1e-15);
    }

    /// GOAL: sliding under a sine pulse. ORACLE: closed form: from t₁ with sin ω t₁ = N/A the velocity is
    /// A g (cos ω t₁ − cos ω t)/ω − N g (t − t₁); it is integrated once more to the time where it vanishes, within the pulse here.
    #[test]
    fn a_block_slides_under_a_sine_pulse() {
        let (amplitude, omega) = (0.3 * G, 2.0 * std::f64::consts::PI);
        let count = 20_000;
        let times: Vec<f64> = (0..=count)
            .map(|k| f64::from(k) / f64::from(count))
            .collect();
        let values = times
            .iter()
            .map(|t| -amplitude * (omega * t).sin())
            .collect();
        let record = record(times, values);
        for share in [0.3_f64, 0.6, 0.9] {
            let limit = share * amplitude;
            let begins = share.asin() / omega;
            let velocity = |t: f64| {
                amplitude * ((omega * begins).cos() - (omega * t).cos()) / omega
                    - limit * (t - begins)
            };
            let (mut low, mut high) = (0.5 - begins, 1.0);
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if velocity(middle) > 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            let (ends, span) = (low, low - begins);
            let expected = amplitude
                * ((omega * begins).cos() * span / omega
                    - ((omega * ends).sin() - (omega * begins).sin()) / omega.powi(2))
                - 0.5 * limit * span * span;
            let found = record.sliding(limit, f64::INFINITY);
            assert!(
                (found / expected - 1.0).abs() < 1e-6,
                "{share}: {found} {expected}"
            );
        }
    }

    /// GOAL: the velocity of a record. ORACLE: the triangle by hand.
    #[test]
    fn a_record_is_linear_between_its_samples() {
        let triangle = record(vec![0.5, 1.0, 1.5], vec![0.0, 2.0, 0.0]);
        for (time, velocity) in [
            (0.2, 0.0),
            (0.75, 0.125),
            (1.0, 0.5),
            (1.5, 1.0),
            (3.0, 1.0),
        ] {
            assert!((triangle.velocity(time) - velocity).abs() < 1e-15);
        }
        assert!(
            (triangle.interval() - 0.5).abs() < 1e-15
                && (triangle.peak(f64::INFINITY) - 2.0).abs() < 1e-15
        );
    }

    // GOAL: no step passes over a sample that stands closer to others than the usual interval, and the quiet rest stays cheap.
    // CASE: samples each second with four at 0.05 s among them; an even record whose times are rounded.
    // ORACLE: the intervals by hand; the median for the even record, to the bit.
    #[test]
    fn steps_go_by_the_intervals_that_they_touch() {
        let times = vec![0.0, 1.0, 2.0, 2.4, 2.45, 2.5, 2.55, 3.0, 4.0, 5.0, 6.0];
        let wavelet = record(times.clone(), vec![0.0; times.len()]);
        let usual = wavelet.interval();
        for (at, longest) in [
            (0.0, 1.0),
            (1.2, 0.8),
            (2.0, 0.4),
            (2.38, 0.05),
            (2.4, 0.05),
            (2.52, 0.05),
            (2.55, 0.45),
            (3.5, 1.0),
            (9.0, 1.0),
        ] {
            let found = wavelet.longest_step(at, usual);
            assert!((found - longest).abs() < 1e-12, "{at}: {found}");
        }
        assert!((wavelet.steps(6.0) - (6.0 + 5.0 - 0.4 - 0.15 - 0.45)).abs() < 1e-12);
        let even: Vec<f64> = (0..400).map(|k| f64::from(k) * 0.005).collect();
        let even = record(even.clone(), vec![0.0; even.len()]);
        let usual = even.interval();
        for k in 0..1000 {
            let found = even.longest_step(0.0021 * f64::from(k), usual);
            assert_eq!(found.to_bits(), usual.to_bits());
        }
        assert_eq!(even.steps(2.0).to_bits(), (2.0 / usual).to_bits());
    }
}
