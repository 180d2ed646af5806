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
    BODY_WATER: BodyWater, "A body with a pore pressure of its own: one of `level`, `line`, `r_u`, `u` and `dry`.";
    body: reference("body"), required "\"clay\"", "the body";
    tables: part(TABLES: WaterTables);
    pressures: part(PRESSURES: WaterPressures);
}

table! {
    SEEPAGE: Seepage,
    "Seepage, steady or in time: the free surface and the pressures are computed, in the ground as it is drawn when the condition first holds. \
     What nothing is said of is closed where it is upright, hangs over or is the base, and a seepage face where it rises.";
    free_water: list(pair(length), 1, MANY), optional "`of_water` or boxes of `faces` say it",
        "levels of free water from left to right, x and height; where they stand above the ground they are ponds. Level beyond the ends";
    of_water: reference("water condition"), optional "`free_water` or boxes of `faces` say it",
        "another condition whose water table is that of the free water";
    faces: each(table(SEEPAGE_FACE: SeepageFace), 0, MOST_THINGS), default "[]",
        "what holds on faces of the ground within boxes; the last that holds a face counts";
    regions: each(table(SEEPAGE_REGION: SeepageRegion), 0, MOST_THINGS), default "[]",
        "wells, drains and cut-off walls: what holds within boxes of the ground; the last that holds a point counts";
    sections: each(table(SEEPAGE_SECTION: SeepageSection), 0, MOST_THINGS), default "[]",
        "sections whose discharge is wanted";
    confined: flag, default "false", "whether all pores are full: no free surface";
    fall: quantity(Length, Positive), optional "the height of the tallest cell",
        "height about the free surface over which permeability falls";
    floor: number(Share), default "1e-3", "share of the permeability that dry soil keeps";
    start_from: reference("water condition"), optional "the flow is steady",
        "condition whose computed, steady flow is that at the time 0; the flow is followed in time from there";
    times: list(quantity(Time, Positive), 1, MOST_THINGS), optional "`time` says it, or the flow is steady",
        "times after the start; each makes a condition of its own, called by the name and the time, as in `drawdown at 5 d`";
    time: quantity(Time, Positive), optional "`times` says it, or the flow is steady", "time after the start, of this one condition";
}

table! {
    HEADS: Heads, "A head in time, linear between its samples and constant beyond.";
    file: text, optional "`time` and `values` say it",
        "a CSV file with the columns time and value, such as `time [d], value [m]`; its path from the case file";
    time: list(quantity(Time, NotNegative), 1, MANY), optional "`file` says it", "times of the samples, ascending";
    values: list(length, 1, MANY), optional "`file` says it", "heads at these times";
}

table! {
    RAINS: Rains, "Rain in time, linear between its samples and constant beyond.";
    file: text, optional "`time` and `values` say it",
        "a CSV file with the columns time and value, such as `time [d], value [mm/h]`; its path from the case file";
    time: list(quantity(Time, NotNegative), 1, MANY), optional "`file` says it", "times of the samples, ascending";
    values: list(quantity(Velocity, NotNegative), 1, MANY), optional "`file` says it", "rain at these times, by area in plan";
}

table! {
    SEEPAGE_FACE: SeepageFace,
    "Faces of the ground within a box: one of `head`, `inflow`, `recharge`, `open` and `closed`.";
    name: name, required "\"upstream\"", "name";
    from: list(length, 2, 3), required "[\"0 m\", \"0 m\"]", "one corner of the box";
    to: list(length, 2, 3), required "[\"0 m\", \"8 m\"]", "the opposite corner";
    head: either(length, table(HEADS: Heads)), optional "another key says it",
        "level of the water before them, or levels in time; above it they are as if nothing were said";
    inflow: quantity(Velocity, Any), optional "another key says it", "water that enters by area; negative leaves";
    recharge: either(quantity(Velocity, NotNegative), table(RAINS: Rains)), optional "another key says it",
        "rain by area in plan, or in time; what cannot enter runs off, and water may come out";
    open: flag, optional "another key says it", "water comes out and none enters: a seepage face, a filter";
    closed: flag, optional "another key says it", "no water passes";
}

table! {
    SEEPAGE_REGION: SeepageRegion,
    "A box of the ground: one of `head`, `drain`, `discharge` and `permeability`.";
    name: name, required "\"well\"", "name";
    from: list(length, 2, 3), required "[\"10 m\", \"2 m\"]", "one corner of the box";
    to: list(length, 2, 3), required "[\"11 m\", \"3 m\"]", "the opposite corner";
    head: length, optional "another key says it", "head that is kept there";
    drain: flag, optional "another key says it", "water leaves where its pressure would be positive, and none enters";
    discharge: quantity(DischargePerLength, Any), optional "another key says it",
        "water that is pumped out of all of it; negative enters", per_metre,
        quantity(Discharge, Any), optional "another key says it",
        "water that is pumped out of all of it; negative enters", whole;
    permeability: quantity(Velocity, Positive), optional "another key says it", "permeability there: a core, a cut-off wall";
}

table! {
    SEEPAGE_SECTION: SeepageSection, "A section across an axis: its corners have one coordinate in common.";
    name: name, required "\"axis\"", "name";
    from: list(length, 2, 3), required "[\"20 m\", \"0 m\"]", "one corner";
    to: list(length, 2, 3), required "[\"20 m\", \"8 m\"]", "the opposite corner";
}

table! {
    WATER: Water,
    "A condition of the water: one of `level`, `line`, in space `surface`, `inside` with `outside`, `r_u`, `u`, `seepage` and `dry`. The first holds from the \
     start, the others from the stages that name them.";
    name: name_apart, required "\"full\"", "name";
    tables: part(TABLES: WaterTables);
    inside: length, optional "another key says it",
        "level of the table within the ground, with `outside`: drawdown; where the ground lies lower, the table follows it";
    outside: length, optional "another key says it", "level of the free water outside, with `inside`";
    pressures: part(PRESSURES: WaterPressures);
    seepage: table(SEEPAGE: Seepage), optional "another key says it", "seepage that is computed";
    pond: flag, derived "true with `level` and `outside`, false otherwise",
        "whether water above the ground is meant: a pond that presses on it";
    carried: flag, default "false", "whether soil carries the pressure of the place where it started along";
    bodies: each(table(BODY_WATER: BodyWater), 0, MOST_THINGS), default "[]", "bodies with a pressure of their own";
}
