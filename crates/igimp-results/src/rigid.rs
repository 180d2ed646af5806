//! Rigid bodies in the results: contact at the nodes of their surfaces, as tables and for ParaView.

use igimp_assembly::{ContactNode, RigidBody};
use igimp_model::{RigidPart, RigidShape, in_plane};

use crate::tables::table::Table;
use crate::vtu::{CellKind, DataArray, UnstructuredGrid, padded};

/// A rigid body that is there.
#[derive(Clone, Copy, Debug)]
pub struct Standing<'a, const D: usize> {
    /// Its number in the case, from 0.
    pub index: usize,
    /// The body as the case describes it.
    pub part: &'a RigidPart<D>,
    /// Its place, and the state of its contact.
    pub body: &'a RigidBody<D>,
}

/// Columns of a table of contact, of which one has a unit of its own ([`CONTACT`]). Shear is that on the soil along the surface, anticlockwise about the body.
const HEADER: [&str; 10] = [
    "side",
    "distance_[m]",
    "x_[m]",
    "y_[m]",
    "pressure_[Pa]_compression_+",
    "shear_on_soil_[Pa]_anticlockwise_+",
    "gap_[m]",
    CONTACT[0],
    "closed_[-]",
    "slips_[-]",
];

/// Extent that soil covers: a length by the metre run, and the area of a whole body.
const CONTACT: [&str; 2] = ["contact_[m]", "contact_[m2]"];

/// A point of the outline of a body in space, with contact if it is a contact node.
struct Place<'a> {
    /// Side, from 0.
    side: usize,
    /// In the frame of the body \[m\].
    local: [f64; 2],
    x: [f64; 2],
    /// Out of the body.
    normal: [f64; 2],
    contact: Option<&'a ContactNode>,
}

impl<'a> Standing<'a, 2> {
    /// Corner of a polygon at which a side begins, in the frame of the body.
    fn corner(&self, side: usize) -> Option<[f64; 2]> {
        let Some(RigidShape::Polygon(corners)) = self.part.shape.in_plane() else {
            return None;
        };
        let corner = corners[side % corners.len()];
        Some([0, 1].map(|axis| corner[axis] - self.part.reference[axis]))
    }

    /// How far along its side a place of the surface is, from the corner that the side begins with, or
    /// around a circle from the point that was rightmost at the start \[m\].
    fn distance(&self, place: &Place<'_>) -> f64 {
        let local = place.local;
        match (self.part.shape.in_plane(), self.corner(place.side)) {
            (Some(RigidShape::Circle { radius, .. }), _) => {
                radius * local[1].atan2(local[0]).rem_euclid(std::f64::consts::TAU)
            }
            (_, Some(corner)) => (local[0] - corner[0]).hypot(local[1] - corner[1]),
            (_, None) => f64::NAN,
        }
    }

    /// The normal of a side at a place, in the frame of the body.
    fn normal(&self, side: usize, local: [f64; 2]) -> [f64; 2] {
        let (Some(from), Some(to)) = (self.corner(side), self.corner(side + 1)) else {
            let length = local[0].hypot(local[1]).max(f64::MIN_POSITIVE);
            return local.map(|x| x / length);
        };
        let along = [to[0] - from[0], to[1] - from[1]];
        let length = self.sense() * along[0].hypot(along[1]);
        [along[1] / length, -along[0] / length]
    }

    /// 1 if the corners go round anticlockwise, else −1.
    fn sense(&self) -> f64 {
        match self.part.shape.in_plane() {
            Some(RigidShape::Polygon(corners)) => {
                let next = corners.iter().cycle().skip(1);
                let pairs = std::iter::zip(corners, next);
                let doubled: f64 = pairs.map(|(p, q)| p[0] * q[1] - p[1] * q[0]).sum();
                doubled.signum()
            }
            _ => 1.0,
        }
    }

    /// The contact nodes side by side, in the order of the outline.
    fn contact_nodes(&self) -> Vec<Place<'a>> {
        let body = self.body;
        let nodes = body.surface.knots();
        std::iter::zip(nodes, &body.contact.knots)
            .map(|((local, side), contact)| Place {
                side,
                local,
                x: body.pose.into_space(&local),
                normal: body.pose.direction(&self.normal(side, local)),
                contact: Some(contact),
            })
            .collect()
    }

    /// The whole outline: contact nodes, and the corners between the sides.
    fn outline(&self) -> Vec<Place<'a>> {
        let mut outline: Vec<Place<'a>> = Vec::new();
        for node in self.contact_nodes() {
            if outline.last().is_none_or(|last| last.side != node.side) {
                outline.extend(self.corner(node.side).map(|local| Place {
                    side: node.side,
                    local,
                    x: self.body.pose.into_space(&local),
                    normal: node.normal,
                    contact: None,
                }));
            }
            outline.push(node);
        }
        outline
    }

    /// Contact at the nodes of its surface, side by side, as a table.
    fn table_of_sides(&self, name: String, is_whole: bool) -> Table {
        let header = HEADER.map(|column| match column {
            column if is_whole && column == CONTACT[0] => CONTACT[1],
            column => column,
        });
        let mut table = Table::new(name, &header);
        for place in self.contact_nodes() {
            let Some(contact) = place.contact else {
                continue;
            };
            table.push(vec![
                place.side as f64 + 1.0,
                self.distance(&place),
                place.x[0],
                place.x[1],
                contact.pressure,
                contact.shear[0],
                gap(contact),
                contact.area,
                f64::from(u8::from(contact.is_closed)),
                f64::from(u8::from(contact.slips)),
            ]);
        }
        table
    }
}

/// Columns of a table of contact in space.
const HEADER_IN_SPACE: [&str; 10] = [
    "side",
    "x_[m]",
    "y_[m]",
    "z_[m]",
    "pressure_[Pa]_compression_+",
    "shear_[Pa]",
    "gap_[m]",
    CONTACT[1],
    "closed_[-]",
    "slips_[-]",
];

impl<'a, const D: usize> Standing<'a, D> {
    /// Of a body in the plane.
    fn in_plane(&self) -> Option<Standing<'a, 2>> {
        Some(Standing {
            index: self.index,
            part: in_plane(self.part)?,
            body: in_plane(self.body)?,
        })
    }

    /// Contact at the nodes of its surface, side by side, as a table; of a `whole` body, not of a metre run.
    pub fn table(&self, name: String, is_whole: bool) -> Table {
        if let Some(body) = self.in_plane() {
            return body.table_of_sides(name, is_whole);
        }
        let mut table = Table::new(name, &HEADER_IN_SPACE);
        let nodes = self.body.surface.knots();
        for ((local, side), contact) in std::iter::zip(nodes, &self.body.contact.knots) {
            let mut row = vec![side as f64 + 1.0];
            row.extend(self.body.pose.into_space(&local));
            row.extend([
                contact.pressure,
                contact.shear[0].hypot(contact.shear[1]),
                gap(contact),
                contact.area,
                f64::from(u8::from(contact.is_closed)),
                f64::from(u8::from(contact.slips)),
            ]);
            table.push(row);
        }
        table
    }
}

/// Rigid bodies for ParaView: in the plane their outlines as lines between contact nodes, and their corners; in
/// space the triangles between their contact nodes.
pub fn cells<const D: usize>(standing: &[Standing<'_, D>]) -> UnstructuredGrid {
    if D == 2 {
        let in_plane: Vec<Standing<'_, 2>> =
            standing.iter().filter_map(Standing::in_plane).collect();
        return outlines(&in_plane);
    }
    let mut points = Vec::new();
    let mut contact: Vec<ContactNode> = Vec::new();
    let (mut bodies, mut sides) = (Vec::new(), Vec::new());
    for rigid in standing {
        let Some(body) = in_plane::<RigidBody<D>, RigidBody<3>>(rigid.body) else {
            continue;
        };
        for (corners, shares, side) in body.surface.facets() {
            for (corner, shares) in std::iter::zip(corners, shares) {
                points.push(body.pose.into_space(&corner));
                contact.push(at_corner(shares, &body.contact.knots));
                bodies.push(rigid.index as i32);
                sides.push(side as i32 + 1);
            }
        }
    }
    let scalars = |name: &str, of: &dyn Fn(&ContactNode) -> f64| {
        DataArray::scalars(name, contact.iter().map(of).collect())
    };
    let flags = |name: &str, of: &dyn Fn(&ContactNode) -> bool| {
        DataArray::integers(name, contact.iter().map(|c| i32::from(of(c))).collect())
    };
    UnstructuredGrid {
        kind: CellKind::Triangle,
        connectivity: (0..points.len()).collect(),
        point_data: vec![
            scalars("contact pressure [Pa], compression +", &|c| c.pressure),
            scalars("shear [Pa]", &|c| c.shear[0].hypot(c.shear[1])),
            scalars("gap [m]", &gap),
            flags("closed", &|c| c.is_closed),
            flags("slips", &|c| c.slips),
            DataArray::integers("body", bodies),
            DataArray::integers("side", sides),
        ],
        points,
        cell_data: Vec::new(),
        field_data: Vec::new(),
    }
}

/// Contact at a corner of a triangle, of the contact nodes that share it.
fn at_corner(shares: &[(usize, f64)], nodes: &[ContactNode]) -> ContactNode {
    let mut at = ContactNode::default();
    for &(node, share) in shares {
        let contact = &nodes[node];
        at.pressure += share * contact.pressure;
        at.shear[0] += share * contact.shear[0].hypot(contact.shear[1]);
        at.gap += share * contact.gap;
        at.area += share * contact.area;
        at.is_closed |= contact.is_closed;
        at.slips |= contact.slips;
    }
    at
}

/// The gap; not a number where no soil is near.
fn gap(contact: &ContactNode) -> f64 {
    if contact.area > 0.0 {
        contact.gap
    } else {
        f64::NAN
    }
}

/// The outlines of rigid bodies as lines between points: their contact nodes, and their corners.
fn outlines(standing: &[Standing<'_, 2>]) -> UnstructuredGrid {
    let mut connectivity = Vec::new();
    let mut places: Vec<(usize, Place<'_>)> = Vec::new();
    for body in standing {
        let (first, outline) = (places.len(), body.outline());
        let count = outline.len();
        connectivity.extend((0..count).flat_map(|k| [first + k, first + (k + 1) % count]));
        places.extend(outline.into_iter().map(|place| (body.index, place)));
    }
    let none = ContactNode::default();
    let contact = |place: &Place<'_>| *place.contact.unwrap_or(&none);
    let numbers = |of: &dyn Fn(&Place<'_>) -> f64| -> Vec<f64> {
        places.iter().map(|(_, place)| of(place)).collect()
    };
    let integers = |of: &dyn Fn(usize, &Place<'_>) -> usize| -> Vec<i32> {
        let all = places.iter();
        all.map(|(body, place)| of(*body, place) as i32).collect()
    };
    let traction = |place: &Place<'_>| {
        let ([x, y], node) = (place.normal, contact(place));
        let (p, shear) = (node.pressure, node.shear[0]);
        [-p * x + shear * y, -p * y - shear * x]
    };
    let tractions: Vec<[f64; 2]> = places.iter().map(|(_, place)| traction(place)).collect();
    let is_closed = |place: &Place<'_>| usize::from(contact(place).is_closed);
    UnstructuredGrid {
        points: places.iter().map(|(_, place)| padded(&place.x)).collect(),
        kind: CellKind::Line,
        connectivity,
        point_data: vec![
            DataArray::scalars(
                "contact pressure [Pa], compression +",
                numbers(&|place| contact(place).pressure),
            ),
            DataArray::scalars(
                "shear on soil [Pa], anticlockwise +",
                numbers(&|place| contact(place).shear[0]),
            ),
            DataArray::vectors("traction on body [Pa]", &tractions),
            DataArray::scalars("gap [m]", numbers(&|place| gap(&contact(place)))),
            DataArray::integers("closed", integers(&|_, place| is_closed(place))),
            DataArray::integers(
                "slips",
                integers(&|_, place| usize::from(contact(place).slips)),
            ),
            DataArray::integers("body", integers(&|body, _| body)),
            DataArray::integers("side", integers(&|_, place| place.side + 1)),
        ],
        cell_data: Vec::new(),
        field_data: Vec::new(),
    }
}
