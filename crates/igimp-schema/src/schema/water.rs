//! Conditions of the water.

use super::declare::{schema, table};
use super::materials::{Points, points};
use super::solids::{TERRAIN, Terrain};
use super::{MANY, MOST_THINGS};

table! {
    TABLES: WaterTables, "Where a water table is.";
    level: length, optional "another key says it", "level of a table that is level everywhere";
    line: list(pair(length), 2, MANY), optional "another key says it",
        "points of the water table from left to right, x and height; it is level beyond its ends, and in space the \
         same for every y";
    surface: table(TERRAIN: Terrain), optional "another key says it", "surface that is the water table", in_space;
}

table! {
    PRESSURES: WaterPressures, "Where pore pressure comes from without a table.";
    r_u: number(Any), optional "another key says it",
        "pore pressure as a share of the weight of the ground above, from 0 to 1";
    u: table(PORE_PRESSURES: Points), optional "another key says it",
        "pore pressure by points in the plane, as a seepage analysis gives it";
    dry: flag, optional "another key says it", "no pore pressure";
}

points! {
    schema PORE_PRESSURES,
    "Pore pressures by points in the plane, in space by x and height for every y: `raster`, or `x`, `y` and \
     `rows`. Less than none counts as none.",
    quantity(Stress, Any)
}

table! {
    OWN: OwnWater, "A body with a pore pressure of its own: one of `level`, `line`, `r_u`, `u` and `dry`.";
    body: reference("body"), required "\"clay\"", "the body";
    tables: part(TABLES: WaterTables);
    pressures: part(PRESSURES: WaterPressures);
}

table! {
    WATER: Water,
    "A condition of the water: one of `level`, `line`, in space `surface`, `inside` with `outside`, `r_u`, `u` and `dry`. The first holds from the \
     start, the others from the stages that name them.";
    name: name_apart, required "\"full\"", "name";
    tables: part(TABLES: WaterTables);
    inside: length, optional "another key says it",
        "level of the table within the ground, with `outside`: drawdown; where the ground lies lower, the table follows it";
    outside: length, optional "another key says it", "level of the free water outside, with `inside`";
    pressures: part(PRESSURES: WaterPressures);
    pond: flag, derived "true with `level` and `outside`, false otherwise",
        "whether water above the ground is meant: a pond that presses on it";
    carried: flag, default "false", "whether soil carries the pressure of the place where it started along";
    bodies: each(table(OWN: OwnWater), 0, MOST_THINGS), default "[]", "bodies with a pressure of their own";
}
