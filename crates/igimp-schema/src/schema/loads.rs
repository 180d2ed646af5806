//! Loads.

use super::MANY;
use super::declare::{choices, table, variants};
use super::outline::{OUTLINE, Outline};

table! {
    CIRCLE: Circle, "A circle in plan.";
    centre: pair(length), required "[\"2 m\", \"2 m\"]", "centre, x and y";
    radius: quantity(Length, Positive), required "\"1 m\"", "radius";
}

choices! {
    /// Contact of soil and a rigid footing.
    FootingInterface;
    Rough "rough", "soil sticks to base and shaft";
    Smooth "smooth", "soil slides along base and shaft";
}

choices! {
    /// Which way a pressure acts.
    PressureDirection;
    Normal "normal", "across the segment, into the soil";
    Down "down", "along gravity";
}

variants! {
    LOAD: Load<D> of LoadForm, "A load that stages apply.", "type", "kind of load";
    named "\"footing\"";
    "rigid-footing" => RigidFooting(FOOTING: Footing<D>),
    "pressure" => Pressure(PRESSURE: Pressure<D>),
    "patch" => Patch(PATCH: Patch),
    "point" => Point(POINT_LOAD: PointLoad<D>),
}

table! {
    FOOTING: Footing<D>, "A level rigid footing, pushed down by displacement stages. The grid follows.";
    from: point, required "[\"0 m\", \"5 m\"]", "one end of the base";
    to: point, required "[\"1 m\", \"5 m\"]", "the other end, at the same level";
    interface: choice(FootingInterface), default "\"rough\"", "between soil and footing";
    reaction_factor: number(Positive), default "1", "factor on the reported reaction, 2 for half a footing";
}

table! {
    PRESSURE: Pressure<D>,
    "A dead pressure on a segment of the surface, in space on a level or upright rectangle, raised by load stages.";
    from: point, required "[\"0 m\", \"5 m\"]", "one end, in space one corner";
    to: point, required "[\"2 m\", \"5 m\"]", "the other end, in space the opposite corner";
    pressure: quantity(Stress, Any), required "\"100 kPa\"", "pressure at factor 1, positive into the soil";
    direction: choice(PressureDirection), default "\"normal\"", "which way it acts";
}

table! {
    PATCH: Patch,
    "In space: a dead pressure down on a level circle or polygon, raised by load stages. What of it lies beyond \
     the grid is left out, as behind a plane of symmetry.";
    circle: table(CIRCLE: Circle), optional "`plan` says it", "the circle that it covers";
    plan: either(list(pair(length), 3, MANY), table(OUTLINE: Outline)), optional "`circle` says it",
        "corners of the polygon that it covers, x and y, either way round";
    level: length, required "\"5 m\"", "height z of the surface on which it lies";
    pressure: quantity(Stress, Any), required "\"100 kPa\"", "pressure at factor 1, positive downwards";
}

table! {
    POINT_LOAD: PointLoad<D>, "A dead force at a point, raised by load stages.";
    at: point, required "[\"2 m\", \"5 m\"]", "where";
    force: vector(quantity(ForcePerLength, Any)), required "[\"0 kN/m\", \"-10 kN/m\"]",
        "force at factor 1, x and y, per metre run", in_plane,
        vector(quantity(Force, Any)), required "[\"0 kN\", \"0 kN\", \"-10 kN\"]",
            "force at factor 1, x, y and z", in_space;
}
