//! Boxes sorted into bins, so that those around a point are found at once.

use super::Boxes;

/// Width of a bin in mean widths of the boxes.
const WIDTH: f64 = 2.0;
/// Share of the boxes at either end of an axis that does not decide how far the bins reach.
const FEW: f64 = 0.002;
/// Most bins by box.
const MOST: usize = 4;

/// Which boxes touch which bin. Boxes beyond the bins are in the outermost ones.
pub(super) struct Bins<'a> {
    boxes: Boxes<'a>,
    low: [f64; 3],
    width: [f64; 3],
    count: [usize; 3],
    /// Where the boxes of a bin begin among the members.
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl<'a> Bins<'a> {
    /// # Panics
    /// If there are not as many least as largest corners, or 2³² of them.
    pub(super) fn of(boxes: Boxes<'a>) -> Self {
        assert_eq!(boxes.low.len(), boxes.high.len(), "a box has two corners");
        let finite: Vec<usize> = (0..boxes.low.len())
            .filter(|&k| boxes.is_finite(k))
            .collect();
        let mut bins = Self {
            boxes,
            low: [0.0; 3],
            width: [1.0; 3],
            count: [1; 3],
            starts: Vec::new(),
            members: Vec::new(),
        };
        if !finite.is_empty() {
            for axis in 0..3 {
                bins.lay_out(axis, &finite);
            }
        }
        // Bodies of many small parts far from each other: wider bins rather than many empty ones.
        let all = |count: [usize; 3]| count.map(|count| count as f64).iter().product::<f64>();
        while all(bins.count) > (MOST * finite.len() + 64) as f64 {
            for axis in 0..3 {
                bins.width[axis] *= 2.0;
                bins.count[axis] = bins.count[axis].div_ceil(2);
            }
        }
        bins.sort(&finite);
        bins
    }

    fn lay_out(&mut self, axis: usize, finite: &[usize]) {
        let boxes = self.boxes;
        let mut centres: Vec<f64> = finite.iter().map(|&k| boxes.centre(k)[axis]).collect();
        let last = centres.len() - 1;
        let few = (FEW * last as f64) as usize;
        let mut at = |place: usize| *centres.select_nth_unstable_by(place, f64::total_cmp).1;
        let (low, high) = (at(few), at(last - few));
        let widths = finite.iter().map(|&k| 2.0 * boxes.half(k)[axis]);
        let mean = widths.sum::<f64>() / finite.len() as f64;
        let width = (WIDTH * mean).max(1e-9 * (high - low));
        if width > 0.0 {
            self.low[axis] = low - 0.5 * mean;
            self.width[axis] = width;
            self.count[axis] = ((high - low + mean) / width).ceil().max(1.0) as usize;
        }
    }

    /// Place of a coordinate among the bins of an axis; the cast takes places below to the first.
    fn place(&self, axis: usize, x: f64) -> usize {
        let place = ((x - self.low[axis]) / self.width[axis]).floor() as usize;
        place.min(self.count[axis] - 1)
    }

    fn bin(&self, place: [usize; 3]) -> usize {
        (place[2] * self.count[1] + place[1]) * self.count[0] + place[0]
    }

    /// Calls for every bin that a box touches.
    fn touched(&self, k: usize, mut call: impl FnMut(usize)) {
        let (low, high) = (&self.boxes.low[k], &self.boxes.high[k]);
        let ends =
            [0, 1, 2].map(|axis| [self.place(axis, low[axis]), self.place(axis, high[axis])]);
        for z in ends[2][0]..=ends[2][1] {
            for y in ends[1][0]..=ends[1][1] {
                for x in ends[0][0]..=ends[0][1] {
                    call(self.bin([x, y, z]));
                }
            }
        }
    }

    fn sort(&mut self, finite: &[usize]) {
        let mut starts = vec![0_u32; self.count.iter().product::<usize>() + 1];
        for &k in finite {
            self.touched(k, |bin| starts[bin + 1] += 1);
        }
        for bin in 1..starts.len() {
            starts[bin] += starts[bin - 1];
        }
        let mut next = starts.clone();
        let mut members = vec![0; starts.last().map_or(0, |&last| last as usize)];
        for &k in finite {
            let number = u32::try_from(k).expect("fewer than 2^32 boxes");
            self.touched(k, |bin| {
                members[next[bin] as usize] = number;
                next[bin] += 1;
            });
        }
        (self.starts, self.members) = (starts, members);
    }

    /// Whether a point lies in a box other than `k`.
    pub(super) fn is_covered(&self, point: &[f64; 3], k: usize) -> bool {
        let mut others = self.others(point, k);
        others.any(|other| self.boxes.holds(other, point))
    }

    /// Whether both ends of a diagonal lie in one box other than `k`, and so all that is between them;
    /// `middle` is halfway.
    pub(super) fn is_within_one(&self, ends: &[[f64; 3]; 2], middle: &[f64; 3], k: usize) -> bool {
        let mut others = self.others(middle, k);
        others.any(|other| ends.iter().all(|end| self.boxes.holds(other, end)))
    }

    /// The boxes of the bin of a point other than `k`.
    fn others(&self, point: &[f64; 3], k: usize) -> impl Iterator<Item = usize> {
        let bin = self.bin([0, 1, 2].map(|axis| self.place(axis, point[axis])));
        let members = self.starts[bin] as usize..self.starts[bin + 1] as usize;
        let others = self.members[members].iter().map(|&other| other as usize);
        others.filter(move |&other| other != k)
    }
}
