//! Fronts: pivots eliminated together, and sizes that add up over fronts.

use std::ops::Range;

use crate::multifrontal::dense::layout::Layout;

/// One dense elimination: `pivots` unknowns, coupled to `border` later ones.
pub(crate) struct Front {
    /// Position of the first pivot in the order of elimination.
    pub(crate) first: usize,
    /// Number of unknowns eliminated.
    pub(crate) pivots: usize,
    /// Number of later unknowns that they are coupled to.
    pub(crate) border: usize,
    /// Ranks of the nodes that are eliminated.
    pub(crate) columns: Range<usize>,
    /// Later nodes: a range of [`Plan::borders`].
    pub(crate) rows: Range<usize>,
    /// The front that it contributes to, or [`NO_FRONT`].
    pub(crate) parent: usize,
    /// First front of the subtree, whose fronts are contiguous and end with this one.
    pub(crate) subtree: usize,
    /// The fronts that contribute to this one: a range of [`Plan::children`].
    pub(crate) children: Range<usize>,
    /// Unknowns of the border that the parent does not eliminate: what falls on them waits for the parent.
    pub(crate) passed_on: usize,
    /// Which of the two stacks holds its contribution: a front and its parent use different ones, so that each
    /// stays last in, first out.
    pub(crate) stack: usize,
    /// Where in that stack it lies, for each shape of contributions.
    pub(crate) contribution: [Range<usize>; 2],
}

impl Front {
    /// Position of the first unknown after the pivots.
    pub(crate) fn end(&self) -> usize {
        self.first + self.pivots
    }

    /// The share of the front in the common arrays.
    pub(crate) fn extent(&self) -> Extent {
        Extent {
            pivots: self.pivots,
            squares: self.pivots * self.pivots,
            halves: Layout::lower(self.pivots).entries(),
            panels: self.pivots * self.border,
            outer: 0,
        }
    }
}

/// Sizes that add up over fronts.
#[derive(Clone, Copy, Default)]
pub(crate) struct Extent {
    /// Unknowns eliminated.
    pub(crate) pivots: usize,
    /// Entries of the pivot blocks.
    pub(crate) squares: usize,
    /// Entries of their lower halves, as they are stored.
    pub(crate) halves: usize,
    /// Entries of the blocks below the pivots.
    pub(crate) panels: usize,
    /// Unknowns of the borders by which tasks are coupled to those above.
    pub(crate) outer: usize,
}
