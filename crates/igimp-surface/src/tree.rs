//! Facets by place: boxes around ever smaller groups of them.

/// Groups are not divided any further.
const LEAVES: usize = 4;

/// Two facets are as near as each other if their distances differ by no more than this share \[-\].
const TIE: f64 = 1e-6;

/// A tree of boxes around facets. Its result does not depend on how it is built.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tree<const D: usize> {
    /// The facets, those of a group next to each other.
    facets: Vec<usize>,
    /// The whole at first, both parts of a group behind it.
    groups: Vec<Group<D>>,
}

/// A group of facets.
#[derive(Clone, Debug, PartialEq)]
struct Group<const D: usize> {
    lower: [f64; D],
    upper: [f64; D],
    /// Its facets in the list of the tree.
    from: usize,
    to: usize,
    /// Both of its parts, if it has any.
    parts: Option<[usize; 2]>,
}

impl<const D: usize> Group<D> {
    /// Its distance from a point, squared \[length²\].
    fn distance2(&self, x: &[f64; D]) -> f64 {
        (0..D)
            .map(|axis| {
                let off = (self.lower[axis] - x[axis]).max(x[axis] - self.upper[axis]);
                off.max(0.0).powi(2)
            })
            .sum()
    }
}

impl<const D: usize> Tree<D> {
    /// The tree of facets with their corners.
    pub(crate) fn new(facets: Vec<(usize, [[f64; D]; D])>) -> Self {
        let mut tree = Self {
            facets: Vec::with_capacity(facets.len()),
            groups: Vec::new(),
        };
        let mut facets = facets;
        tree.divide(&mut facets);
        tree
    }

    /// Adds a group and its parts; returns its number.
    fn divide(&mut self, facets: &mut [(usize, [[f64; D]; D])]) -> usize {
        let (mut lower, mut upper) = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
        for corner in facets.iter().flat_map(|(_, corners)| corners) {
            for axis in 0..D {
                lower[axis] = lower[axis].min(corner[axis]);
                upper[axis] = upper[axis].max(corner[axis]);
            }
        }
        let group = self.groups.len();
        let from = self.facets.len();
        self.groups.push(Group {
            lower,
            upper,
            from,
            to: from + facets.len(),
            parts: None,
        });
        if facets.len() <= LEAVES {
            self.facets.extend(facets.iter().map(|(facet, _)| *facet));
            return group;
        }
        let longest = (0..D)
            .max_by(|&a, &b| (upper[a] - lower[a]).total_cmp(&(upper[b] - lower[b])))
            .unwrap_or(0);
        let middle = |corners: &[[f64; D]; D]| corners.iter().map(|x| x[longest]).sum::<f64>();
        facets.sort_by(|a, b| {
            let place = middle(&a.1).total_cmp(&middle(&b.1));
            place.then(a.0.cmp(&b.0))
        });
        let (first, second) = facets.split_at_mut(facets.len() / 2);
        let parts = [self.divide(first), self.divide(second)];
        self.groups[group].parts = Some(parts);
        group
    }

    /// Moves all of it.
    pub(crate) fn shift(&mut self, by: &[f64; D]) {
        for group in &mut self.groups {
            for axis in 0..D {
                group.lower[axis] += by[axis];
                group.upper[axis] += by[axis];
            }
        }
    }

    /// The facets of which one is nearest to a point, all that tie with it among them, in ascending order;
    /// `distance` tells how far off a facet is \[length\].
    pub(crate) fn near(&self, x: &[f64; D], distance: impl Fn(usize) -> f64) -> Vec<usize> {
        let mut least = f64::INFINITY;
        let mut found = Vec::new();
        let mut open = vec![0];
        while let Some(group) = open.pop() {
            let group = &self.groups[group];
            if group.distance2(x).sqrt() > (1.0 + TIE) * least {
                continue;
            }
            match group.parts {
                None => {
                    for &facet in &self.facets[group.from..group.to] {
                        let off = distance(facet);
                        least = least.min(off);
                        found.push((off, facet));
                    }
                }
                Some(parts) => {
                    // The nearer part is looked at first.
                    let far = parts.map(|part| self.groups[part].distance2(x));
                    let [a, b] = parts;
                    open.extend(if far[0] <= far[1] { [b, a] } else { [a, b] });
                }
            }
        }
        let mut near: Vec<usize> = found
            .into_iter()
            .filter(|(off, _)| *off <= (1.0 + TIE) * least)
            .map(|(_, facet)| facet)
            .collect();
        near.sort_unstable();
        near
    }

    /// The facets whose boxes, or those of their groups, come as near to a point as `reach` \[length\], in
    /// ascending order.
    pub(crate) fn within(&self, x: &[f64; D], reach: f64) -> Vec<usize> {
        let mut found = Vec::new();
        let mut open = vec![0];
        while let Some(group) = open.pop() {
            let group = &self.groups[group];
            if group.distance2(x) > reach * reach {
                continue;
            }
            match group.parts {
                None => found.extend(&self.facets[group.from..group.to]),
                Some(parts) => open.extend(parts),
            }
        }
        found.sort_unstable();
        found
    }
}
