//! Reinforcement: anchors, nails and geotextiles.

use super::MANY;
use super::declare::{table, variants};

variants! {
    REINFORCEMENT: Member<D> of MemberForm,
    "A member that pulls and neither bends nor pushes. In plane strain all forces are per metre run: those of one, \
     over the spacing. In space it is one anchor or nail.", "type", "kind of reinforcement";
    named "\"nail 1\"";
    "anchor" => Anchor(ANCHOR: Anchor<D>),
    "nail" => Nail(NAIL: Nail<D>),
    "geotextile" => Geotextile(GEOTEXTILE: Geotextile<D>),
    after REINFORCEMENT_COMMON: MemberCommon;
}

table! {
    ANCHOR: Anchor<D>, "A ground anchor: a head, a free length without bond, and a bonded length at its end.";
    ends: part(ENDS: Ends<D>);
    bonded_length: quantity(Length, Positive), required "\"4 m\"", "length at its end that is bonded to the soil";
    head_capacity: quantity(ForcePerLength, NotNegative), derived "its capacity",
        "force that its head carries", in_plane,
        quantity(Force, NotNegative), derived "its capacity", "force that its head carries", in_space;
    plate: part(PLATE: Plate);
    prestress: quantity(ForcePerLength, Positive), optional "it begins without tension",
        "tension at which it is locked off at the end of the stage that installs it", in_plane,
        quantity(Force, Positive), optional "it begins without tension",
            "tension at which it is locked off at the end of the stage that installs it", in_space;
}

table! {
    NAIL: Nail<D>, "A soil nail, bonded over its whole length.";
    ends: part(ENDS: Ends<D>);
    head_capacity: quantity(ForcePerLength, NotNegative), default "\"0 kN/m\"",
        "force that the plate at its head carries", in_plane,
        quantity(Force, NotNegative), default "\"0 kN\"", "force that the plate at its head carries", in_space;
    plate: part(PLATE: Plate);
}

table! {
    GEOTEXTILE: Geotextile<D>, "In plane strain: a geotextile or geogrid, bonded over its whole length.";
    points: list(point, 2, MANY), required "[[\"0 m\", \"3 m\"], [\"12 m\", \"3 m\"]]",
        "its line, from one end to the other";
    head_capacity: quantity(ForcePerLength, NotNegative), derived "its capacity on a side of the grid that is a roller, else \"0 kN/m\"",
        "force that holds it at its first point, as by a facing", in_plane;
    end_capacity: quantity(ForcePerLength, NotNegative), derived "its capacity on a side of the grid that is a roller, else \"0 kN/m\"",
        "force that holds it at its last point", in_plane;
}

table! {
    REINFORCEMENT_COMMON: MemberCommon, "Keys of every member.";
    stiffness: quantity(ForcePerLength, Positive), required "\"20 MN/m\"", "axial stiffness EA", in_plane,
        quantity(Force, Positive), required "\"40 MN\"", "axial stiffness EA", in_space;
    capacity: quantity(ForcePerLength, Positive), required "\"100 kN/m\"",
        "tension that it carries at most", in_plane,
        quantity(Force, Positive), required "\"200 kN\"", "tension that it carries at most", in_space;
    bond: quantity(Stress, NotNegative), required "\"30 kPa\"",
        "pull-out resistance per metre of its length: of a geotextile, that of both faces", in_plane,
        quantity(ForcePerLength, NotNegative), required "\"60 kN/m\"",
            "pull-out resistance per metre of its length", in_space;
    reduce_bond: flag, default "false",
        "whether a strength reduction divides the bond too; capacities are left alone";
}

table! {
    ENDS: Ends<D>, "Where a member begins and ends.";
    head: point, required "[\"10 m\", \"6 m\"]", "where its head is";
    end: point, required "[\"2 m\", \"4 m\"]", "where it ends in the ground";
}

table! {
    PLATE: Plate, "The plate at the head of a member.";
    width as "plate": quantity(Length, NotNegative), default "\"0 m\"",
        "width of the plate or facing on which the force at its head spreads, along the edge of the soil there; in \
         space the side of a square on the surface there";
}
