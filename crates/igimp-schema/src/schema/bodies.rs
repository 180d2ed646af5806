//! Bodies.

use super::declare::table;
use super::outline::{OUTLINE, Outline};
use super::solids::{HOLLOW, Hollow, SHAPE, Shape};
use super::{MANY, MOST_THINGS};

table! {
    BODY: Body, "A polygon of one material, filled with particles.";
    name: name_apart, required "\"soil\"", "name";
    material: apart(reference("material")), required "\"clay\"", "name of the material";
    points_per_cell: apart(whole_of(1, 4, 9, 16, 25)), default "4", "particles per cell, a square number", in_plane,
        apart(whole_of(1, 8, 27, 64)), default "8", "particles per cell, a cube number", in_space;
    shape: group_in_space(SHAPE: Shape);
    minus: apart(each(table(HOLLOW: Hollow), 0, MOST_THINGS)), default "[]",
        "solids that are taken out of it, each with the keys of a shape", in_space;
    polygon: apart(either(list(pair(length), 3, MANY), table(OUTLINE: Outline))),
        required "[[\"0 m\", \"0 m\"], [\"8 m\", \"0 m\"], [\"8 m\", \"5 m\"], [\"0 m\", \"5 m\"]]",
        "corners in order, either way round, or where they come from", in_plane;
}
