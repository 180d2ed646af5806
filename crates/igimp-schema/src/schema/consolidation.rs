//! Stages in which water flows out of soil.

use super::MOST_THINGS;
use super::declare::table;
use super::ground_motion::Wall;

table! {
    CONSOLIDATION: Consolidation,
    "Time in which water flows out of soil whose `drainage` is coupled; what the stage changes it changes evenly over it.";
    duration: quantity(Time, Positive), required "\"90 d\"", "how long it lasts";
    open_faces: flag, default "true", "whether water leaves at the free faces of soil";
    open_sides: list(choice(Wall), 0, 6), default "[]", "sides of the grid where water leaves; the others are sealed";
    drains: each(table(DRAIN: Drain), 0, MOST_THINGS), default "[]", "boxes of the ground where water leaves: wells, wicks, layers of sand";
    longest_step: quantity(Time, Positive), optional "the error in time alone chooses", "longest step of time";
}

table! {
    DRAIN: Drain, "A box of the ground where water leaves.";
    from: list(length, 2, 3), required "[\"4 m\", \"0 m\"]", "one corner of the box";
    to: list(length, 2, 3), required "[\"4.2 m\", \"6 m\"]", "the opposite corner";
}
