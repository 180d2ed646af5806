//! Bodies in space: boxes, prisms, cylinders, spheres, closed surfaces, layers of ground.

use super::MANY;
use super::declare::{choices, table};
use super::outline::{OUTLINE, Outline};

table! {
    SHAPE: Shape, "A shape in space.";
    cuboid as "box": table(CUBOID: Cuboid), optional "another shape is stated", "box with its sides along the axes";
    polygon: either(list(pair(length), 3, MANY), table(OUTLINE: Outline)), optional "another shape is stated",
        "corners of a polygon in x and z, either way round, or where they come from; `across` makes it a slice";
    across: pair(length), optional "`polygon` is not stated", "from where to where on y the polygon reaches";
    plan: either(list(pair(length), 3, MANY), table(OUTLINE: Outline)), optional "another shape is stated",
        "corners of a polygon in plan, x and y, either way round, or where they come from; `between` says how high";
    between: pair_each(either(length, table(TERRAIN: Terrain))), optional "`plan` is not stated",
        "bottom and top over the plan: levels z, or surfaces of the ground";
    cylinder: table(CYLINDER: Cylinder), optional "another shape is stated", "circular cylinder along an axis";
    sphere: table(SPHERE: Sphere), optional "another shape is stated", "sphere";
    surface: table(SURFACE: Surface), optional "another shape is stated", "closed surface of triangles";
}

table! {
    HOLLOW: Hollow, "A solid that is taken out of a body.";
    shape: part(SHAPE: Shape);
}

table! {
    CUBOID: Cuboid, "A box with its sides along the axes.";
    from: point_in_space, required "[\"0 m\", \"0 m\", \"0 m\"]", "one corner";
    to: point_in_space, required "[\"4 m\", \"2 m\", \"1 m\"]", "the opposite corner";
}

choices! {
    /// Directions of axes.
    Axis;
    X "x", "to the right";
    Y "y", "to the back";
    Z "z", "up";
}

table! {
    CYLINDER: Cylinder, "A circular cylinder along an axis.";
    axis: choice(Axis), default "\"z\"", "direction of its axis";
    centre: pair(length), required "[\"2 m\", \"1 m\"]",
        "centre of its circle by the two other axes, in their order";
    radius: quantity(Length, Positive), required "\"0.5 m\"", "radius";
    between: pair(length), required "[\"0 m\", \"1 m\"]", "from where to where on its axis";
}

table! {
    SPHERE: Sphere, "A sphere.";
    centre: point_in_space, required "[\"2 m\", \"1 m\", \"0.5 m\"]", "centre";
    radius: quantity(Length, Positive), required "\"0.5 m\"", "radius";
}

table! {
    SURFACE: Surface, "A closed surface: an STL file, or corners and the triangles between them.";
    file: text, optional "`vertices` and `triangles` say it",
        "an STL file, ASCII or binary; its path from the case file";
    unit: text, optional "`vertices` have units of their own", "unit of length of the file";
    vertices: list(point_in_space, 4, MANY), optional "`file` says it", "corners";
    triangles: list(triple(whole(0, MANY as i64)), 4, MANY), optional "`file` says it",
        "three numbers of vertices each, from 0, counter-clockwise as seen from outside";
}

table! {
    TERRAIN: Terrain,
    "A surface of the ground: an ESRI ASCII grid, points from a CSV file, points, or heights on lines.";
    raster: text, optional "another key says it", "an ESRI ASCII grid; its path from the case file";
    points: either(text, list(point_in_space, 3, MANY)), optional "another key says it",
        "a CSV file with the columns x, y and z, or points; those that fill no rectangle are joined by Delaunay's \
         triangles in plan";
    unit: text, optional "the header says it, as in `x [ft]`", "unit of length of the file";
    x: list(length, 2, MANY), optional "another key says it", "lines of heights, ascending";
    y: list(length, 2, MANY), optional "another key says it", "lines of heights, ascending";
    rows: list(list(length, 2, MANY), 2, MANY), optional "another key says it", "heights by y, then by x";
    holes: apart(list(pair(whole(0, MANY as i64)), 0, MANY)), default "[]",
        "columns and rows, from 0, where no height is known";
}
