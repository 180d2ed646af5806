//! The background grid, the variant of the method, and supports.

use super::MOST_THINGS;
use super::declare::{choices, table};
use crate::tree::read::At;

table! {
    GRID: Grid, "Fixed background grid, and the variant of the method.";
    extent: group(EXTENT: Extent);
    wishes: group(WISHES: Wishes);
    mixed_cells: apart(choice(MixedCells)), default "\"own\"",
        "stiffness of particles in cells that several soils share";
    refine: apart(whole(1, 64)), default "1", "every cell is cut into so many in each direction";
    method: group(METHOD: Method);
}

table! {
    EXTENT: Extent, "Extent of the grid and size of its cells.";
    cell: either(quantity(Length, Positive), table(CELL: Cell)), required "\"0.5 m\"",
        "size of a cell, one length or x and y";
    domain: table(DOMAIN: Domain), required "{ x = [\"0 m\", \"60 m\"], y = [\"0 m\", \"22 m\"] }",
        "extent of the grid; leave room for the motion";
}

table! {
    WISHES: Wishes, "What is wanted of the lines of the grid.";
    lines: table(LINES: Lines), default "{}", "places that grid lines go through";
    fit: choice(Fit), derived "\"none\", and \"bodies\" with rigid bodies", "edges that grid lines are fitted to", in_plane,
        choice(Fit), derived "\"none\"", "edges that grid lines are fitted to", in_space;
    zones: table(ZONES: Zones), default "{}", "stretches of finer cells";
    growth: number(Positive), default "1.3",
        "ratio of neighbouring cells beside zones and thin layers; from 1.05 to 2";
}

table! {
    METHOD: Method, "The variant of the method.";
    basis: choice(Basis), default "\"gimp\"", "how a particle sees the grid";
    locking: choice(Locking), default "\"shared-strain\"", "what is done against locking";
    kinematics: choice(Kinematics), default "\"finite\"", "measure of strain";
    domain_update: choice(DomainUpdate), derived "\"stretch\", and \"scaled-moments\" where all rigid bodies are circles that soil may part from",
        "how particle domains follow the deformation";
    small_cuts: table(SMALL_CUTS: SmallCuts), default "{}", "nodes that a body only touches at a corner";
}

table! {
    CELL: Cell, "Size of a cell by direction.";
    x: quantity(Length, Positive), required "\"0.5 m\"", "width";
    y: quantity(Length, Positive), required "\"0.5 m\"", "height; in space depth";
    z: quantity(Length, Positive), required "\"0.5 m\"", "height", in_space;
}

table! {
    LINES: Lines,
    "Places that grid lines go through. Between them the cells are as near to `cell` as equal division allows.";
    x: list(length, 0, MOST_THINGS), default "[]", "places of upright lines";
    y: list(length, 0, MOST_THINGS), default "[]", "places of level lines, in space of upright ones";
    z: list(length, 0, MOST_THINGS), default "[]", "places of level planes", in_space;
}

choices! {
    /// Edges that grid lines are fitted to.
    Fit;
    None "none", "lines are where cell, lines and zones put them";
    Layers "layers", "level lines move onto the level edges of soil: layer boundaries and surfaces";
    Bodies "bodies", "upright sides of rigid bodies stand in the middle of a cell, their level sides on lines";
    All "all", "both";
}

choices! {
    /// Stiffness of particles in cells that several soils share.
    MixedCells;
    Own "own", "that of the particle's own soil";
    Mean "mean",
        "the inverse of the mean compliance of the cell, as it is filled; strength stays the particle's own";
}

table! {
    ZONES: Zones, "Stretches of finer cells; beside them cells grow by `growth` up to `cell`.";
    x: list(table(ZONE: Zone), 0, MOST_THINGS), default "[]", "stretches of narrower cells";
    y: list(table(ZONE: Zone), 0, MOST_THINGS), default "[]",
        "stretches of lower cells, in space of cells that are less deep";
    z: list(table(ZONE: Zone), 0, MOST_THINGS), default "[]", "stretches of lower cells", in_space;
}

table! {
    ZONE: Zone, "A stretch of finer cells across the whole grid.";
    from: length, required "\"9 m\"", "where it begins";
    to: length, required "\"12 m\"", "where it ends";
    cell: quantity(Length, Positive), required "\"0.25 m\"", "size of its cells, in its own direction";
}

table! {
    DOMAIN: Domain,
    "Extent of the grid. Without lines, zones and fit it is a whole number of cells in each direction.";
    x: pair(length), required "[\"0 m\", \"60 m\"]", "from left to right";
    y: pair(length), required "[\"0 m\", \"22 m\"]", "from bottom to top", in_plane,
        pair(length), required "[\"0 m\", \"30 m\"]", "from front to back", in_space;
    z: pair(length), required "[\"0 m\", \"22 m\"]", "from bottom to top", in_space;
}

choices! {
    /// How a particle sees the grid.
    Basis;
    Gimp "gimp", "generalised interpolation (iGIMP)";
    Linear "linear", "plain material point method (iMPM)";
}

choices! {
    /// Measures against locking.
    Locking;
    None "none", "nothing";
    BBar "b-bar", "the dilatation is that of the cells, as in the paper";
    SharedStrain "shared-strain", "b-bar, and most of the distortion is that of the cells too where soil yields";
}

choices! {
    /// Measures of strain.
    Kinematics;
    Finite "finite", "Hencky strain, exact under rotation";
    Small "small", "small strain over a step";
}

choices! {
    /// How particle domains follow the deformation.
    DomainUpdate;
    Fixed "fixed", "half-lengths stay as seeded";
    DiagonalF "diagonal-f", "diagonal of the deformation gradient F";
    Stretch "stretch", "diagonal of the stretch U, free of rotation";
    RootJ "root-j", "square root of det F";
    Moments "moments", "second moments of the deformed domain, as in run-outs and in motion";
    ScaledMoments "scaled-moments", "the same, scaled to the volume of the domain";
}

table! {
    SMALL_CUTS: SmallCuts, "Treatment of nodes that carry next to no soil.";
    below: number(NotNegative), derived "1e-4, and 0.05 with rigid bodies",
        "share of a cell's volume below which a node is a small cut; 0 switches off", in_plane,
        number(NotNegative), derived "1e-3",
            "share of a cell's volume below which a node is a small cut; 0 switches off", in_space;
    remedy: choice(Remedy), derived "\"tie\", and \"extrapolate\" with rigid bodies",
        "what happens to such a node", in_plane,
        choice(Remedy), derived "\"tie\"", "what happens to such a node", in_space;
    ghost_penalty: number(NotNegative), default "0",
        "penalty on jumps of the gradient across faces of boundary cells; 0 switches off";
}

choices! {
    /// What happens to a small cut.
    Remedy;
    Tie "tie", "it moves with the nearest node that carries soil";
    Extrapolate "extrapolate", "its displacement goes on linearly from the nearest cell full of soil";
    Drop "drop", "its displacement is zero";
}

choices! {
    /// Supports at a side of the grid.
    Side;
    Roller "roller", "no displacement across the side";
    Fixed "fixed", "no displacement";
    Free "free", "no support";
}

table! {
    BOUNDARIES: Boundaries<D>, "Supports at the sides of the grid, and in boxes.";
    left: choice(Side), default "\"roller\"", "side of the lowest x";
    right: choice(Side), default "\"roller\"", "side of the highest x";
    front: choice(Side), default "\"roller\"", "side of the lowest y", in_space;
    back: choice(Side), default "\"roller\"", "side of the highest y", in_space;
    bottom: choice(Side), default "\"fixed\"", "side of the lowest y, in space of the lowest z";
    top: choice(Side), default "\"free\"", "side of the highest y, in space of the highest z";
    boxes: each(table(BOX: FixedBox<D>), 0, MOST_THINGS), default "[]", "boxes in which nodes are held";
}

impl<const D: usize> Boundaries<D> {
    /// The lower and the upper side by axis.
    pub fn by_axis(&self) -> Option<[[&At<Side>; 2]; D]> {
        let mut sides = [[&self.left, &self.right]; D];
        if let (Some(front), Some(back), 3) = (&self.front, &self.back, D) {
            sides[1] = [front, back];
        } else if D == 3 {
            return None;
        }
        sides[D - 1] = [&self.bottom, &self.top];
        Some(sides)
    }
}

choices! {
    /// Displacements that a box holds.
    FixedAxis;
    X "x", "displacement in x";
    Y "y", "displacement in y";
    Z "z", "displacement in z, in space";
}

table! {
    BOX: FixedBox<D>, "A box whose nodes, edges included, are held.";
    name: name, required "\"wall\"", "name";
    from: point, required "[\"0 m\", \"0 m\"]", "one corner";
    to: point, required "[\"1 m\", \"5 m\"]", "the opposite corner";
    fix: list(choice(FixedAxis), 1, 2), default "[\"x\", \"y\"]", "what is held", in_plane,
        list(choice(FixedAxis), 1, 3), default "[\"x\", \"y\", \"z\"]", "what is held", in_space;
}
