//! Rigid bodies that soil touches, and how stages move them.

use super::declare::{choices, table, variants};
use super::solids::{Axis, SURFACE, Surface};
use super::{MANY, MOST_THINGS};

choices! {
    /// Shear along an interface.
    Interface;
    Smooth "smooth", "soil slides along without shear";
    Rough "rough", "soil sticks while it touches";
}

table! {
    LIMITED: Limited, "Shear along an interface up to adhesion and friction.";
    friction: number(NotNegative), optional "`angle` says it, or there is none", "coefficient of friction";
    angle: quantity(Angle, NotNegative), optional "`friction` says it, or there is none", "angle of friction";
    adhesion: quantity(Stress, NotNegative), optional "`adhesion_share` says it, or there is none",
        "shear that is carried without pressure, while soil touches";
    adhesion_share: number(NotNegative), optional "`adhesion` says it, or there is none",
        "the same as a share of the undrained strength, or the cohesion, of the soil that touches";
}

choices! {
    /// When soil is pulled off.
    Tension;
    None "none", "soil that is pulled lets go";
    Bonded "bonded", "soil that touched never lets go";
}

choices! {
    /// Sides of rigid bodies.
    SideName;
    Bottom "bottom", "lower side of a rectangle";
    Right "right", "right side of a rectangle";
    Top "top", "upper side of a rectangle";
    Left "left", "left side of a rectangle";
    Face "face", "the side of a wall from `from` to `to`";
    Front "front", "front of a box";
    Back "back", "back of a box";
    Shaft "shaft", "shaft of a cylinder or a cone";
    Tip "tip", "face of the tip of a cone";
    Start "start", "lower end of a level cylinder";
    End "end", "its other end";
}

table! {
    SIDE: Side, "A side of a rigid body that is unlike the others.";
    side: either(whole(1, MANY as i64), choice(SideName)), required "\"bottom\"",
        "which: by name, or by the number of the corner that it begins with, from 1";
    interface: either(choice(Interface), table(LIMITED: Limited)), optional "that of the body", "along the side";
    tension: choice(Tension), optional "that of the body", "when soil is pulled off";
    tension_limit: quantity(Stress, Positive), optional "that of the body",
        "tension at which a side lets go for good";
}

variants! {
    RIGID: RigidBody<D> of RigidShape, "A rigid body that soil touches, slides along and leaves.", "type", "shape";
    named "\"footing\"";
    "rectangle" => Rectangle(RIGID_RECTANGLE: RigidRectangle<D>),
    "polygon" => Polygon(RIGID_POLYGON: RigidPolygon),
    "circle" => Circle(RIGID_CIRCLE: RigidCircle<D>),
    "wall" => Wall(RIGID_WALL: RigidWall<D>),
    "box" => Box(RIGID_BOX: RigidBox<D>),
    "cylinder" => Cylinder(RIGID_CYLINDER: RigidCylinder<D>),
    "sphere" => Sphere(RIGID_SPHERE: RigidSphere<D>),
    "cone" => Cone(RIGID_CONE: RigidCone<D>),
    "surface" => Surface(RIGID_SURFACE: RigidSurface),
    after RIGID_COMMON: RigidCommon<D>;
}

table! {
    RIGID_RECTANGLE: RigidRectangle<D>, "A level rectangle. Its sides are bottom, right, top, left.";
    from: point, required "[\"0 m\", \"5 m\"]", "one corner";
    to: point, required "[\"1 m\", \"6 m\"]", "the opposite corner";
}

table! {
    RIGID_POLYGON: RigidPolygon, "A polygon. Its sides are numbered from 1 by the corners that they begin with.";
    corners: list(pair(length), 3, MANY), required "[[\"0 m\", \"5 m\"], [\"1 m\", \"7 m\"], [\"-1 m\", \"7 m\"]]",
        "corners in order, either way round";
}

table! {
    RIGID_CIRCLE: RigidCircle<D>, "A circle: a pipe, a bar, a pile in section. It has one side.";
    centre: point, required "[\"0 m\", \"5.5 m\"]", "centre";
    radius: quantity(Length, Positive), required "\"0.5 m\"", "radius";
}

table! {
    RIGID_WALL: RigidWall<D>, "A wall by its face. It lies to the left of the way from one end to the other.";
    from: point, required "[\"0 m\", \"0 m\"]", "one end of the face";
    to: point, required "[\"0 m\", \"5 m\"]", "the other end";
    thickness: quantity(Length, Positive), required "\"1 m\"", "thickness";
}

table! {
    RIGID_BOX: RigidBox<D>,
    "In space: a box with its sides along the axes. Its sides are left, right, front, back, bottom, top.";
    from: point, required "[\"0 m\", \"0 m\", \"5 m\"]", "one corner";
    to: point, required "[\"1 m\", \"1 m\", \"6 m\"]", "the opposite corner";
}

table! {
    RIGID_CYLINDER: RigidCylinder<D>,
    "In space: a cylinder along an axis. Its sides are bottom, shaft, top; of a level one start, shaft, end.";
    axis: choice(Axis), default "\"z\"", "direction of its axis";
    middle: point, required "[\"0 m\", \"0 m\", \"5.5 m\"]", "its middle";
    radius: quantity(Length, Positive), required "\"0.5 m\"", "radius";
    length: quantity(Length, Positive), required "\"1 m\"", "length along its axis";
}

table! {
    RIGID_SPHERE: RigidSphere<D>, "In space: a sphere. It has one side.";
    centre: point, required "[\"0 m\", \"0 m\", \"5.5 m\"]", "centre";
    radius: quantity(Length, Positive), required "\"0.5 m\"", "radius";
}

table! {
    RIGID_CONE: RigidCone<D>,
    "In space: a cone with its tip down, and a shaft above it. Its sides are tip, shaft, top.";
    tip: point, required "[\"0 m\", \"0 m\", \"5 m\"]", "its tip";
    radius: quantity(Length, Positive), required "\"0.25 m\"", "radius of its upper end";
    height: quantity(Length, Positive), required "\"0.43 m\"", "height of the cone";
    shaft: quantity(Length, NotNegative), default "\"0 m\"", "length of the shaft";
}

table! {
    RIGID_SURFACE: RigidSurface, "In space: a closed surface of triangles. It has one side.";
    surface: table(SURFACE: Surface), required "{ file = \"pile.stl\", unit = \"m\" }", "the surface";
}

table! {
    RIGID_COMMON: RigidCommon<D>, "Keys of every rigid body.";
    reference: point,
        optional "the middle of the base of a rectangle, of the face of a wall, of the extent of others",
        "point of which displacement and forces are printed; a circle has its centre", in_plane;
    interface: either(choice(Interface), table(LIMITED: Limited)), default "\"rough\"", "along all its sides";
    tension: choice(Tension), default "\"none\"", "when soil is pulled off";
    tension_limit: quantity(Stress, Positive), optional "as `tension` says",
        "tension at which a side lets go for good";
    sides: each(table(SIDE: Side), 0, MOST_THINGS), default "[]", "sides that are unlike the others";
    weight: quantity(ForcePerLength, NotNegative), default "\"0 kN/m\"",
        "own weight of the whole body, at its centre of mass; acts with gravity", per_metre,
        quantity(Force, NotNegative), default "\"0 kN\"",
            "own weight of the whole body, at its centre of mass; acts with gravity", whole;
    centre_of_mass: point, optional "the centroid of the body, as if it were uniform",
        "point at which its weight acts, of revolution on the axis; moments of inertia about it are those of a uniform body about its centroid";
    force_factor: number(Positive), default "1",
        "whole body over the part that is modelled, 2 for half a body: forces are those of the whole";
    from_start: flag, default "false",
        "whether it is there from the start, held, rather than from the first stage that names it";
    grid_follows: flag, default "false",
        "whether the rows of the grid go down with it; its lowest place lies on a row";
    rounding: number(NotNegative), default "0.3",
        "radius of its corners in cells; soil slips off a rounding, which carries nothing";
    stiffness: number(Positive), default "30", "stiffness of contact, in Young's moduli per cell";
    most_penetration: number(Positive), default "0.1", "penetration that ends the run, as a share of the cell";
}

choices! {
    /// Components of the motion of a rigid body.
    Component;
    X "x", "displacement in x";
    Y "y", "displacement in y";
    Rotation "rotation", "rotation, in plane strain";
    Z "z", "displacement in z, in space";
    RotationX "rotation_x", "rotation about x, in space";
    RotationY "rotation_y", "rotation about y, in space";
    RotationZ "rotation_z", "rotation about z, in space";
}

table! {
    MOVE: Move,
    "How a rigid body moves in a stage. What is not mentioned goes on as before: held, or under its force.";
    body: reference("rigid body"), required "\"footing\"", "which";
    x: length, optional "as before; held at first", "further displacement in x";
    y: length, optional "as before; held at first", "further displacement in y, in plane strain negative downwards";
    z: length, optional "as before; held at first", "further displacement in z, negative downwards", in_space;
    rotation: quantity(Angle, Any), optional "as before; held at first",
        "further rotation, anticlockwise", in_plane;
    rotation_x: quantity(Angle, Any), optional "as before; held at first", "further rotation about x", in_space;
    rotation_y: quantity(Angle, Any), optional "as before; held at first", "further rotation about y", in_space;
    rotation_z: quantity(Angle, Any), optional "as before; held at first", "further rotation about z", in_space;
    force_x: quantity(ForcePerLength, Any), optional "as before",
        "force on it in x at the end of the stage", per_metre,
        quantity(Force, Any), optional "as before", "force on it in x at the end of the stage", whole;
    force_y: quantity(ForcePerLength, Any), optional "as before",
        "force on it in y at the end of the stage, negative downwards, beside its weight", per_metre,
        quantity(Force, Any), optional "as before",
            "force on it in y at the end of the stage; of revolution negative downwards, beside its weight", whole;
    moment: quantity(MomentPerLength, Any), optional "as before",
        "moment on it about its reference point at the end of the stage, anticlockwise", in_plane;
    force_z: quantity(Force, Any), optional "as before",
        "force on it in z at the end of the stage, negative downwards, beside its weight", in_space;
    moment_x: quantity(Moment, Any), optional "as before",
        "moment on it about x through its reference point at the end of the stage", in_space;
    moment_y: quantity(Moment, Any), optional "as before", "moment on it about y", in_space;
    moment_z: quantity(Moment, Any), optional "as before", "moment on it about z", in_space;
    free: list(choice(Component), 0, 6), default "[]",
        "components that no force and no moment holds by the end of the stage";
}
