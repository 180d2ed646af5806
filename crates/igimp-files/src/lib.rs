//! Data that a case file takes from files beside it, put into its tree: polygons and layer lines from CSV and
//! DXF, properties of materials and pore pressures from CSV, surfaces from STL, ESRI ASCII grids and CSV.
//!
//! From then on the tree carries the points themselves, each with its unit: what is built, explained and fingerprinted
//! does not depend on the files any more.

pub mod bytes;
mod columns;
mod dxf;
mod elevation;
mod history;
mod named;
mod outline;
mod raster;
mod record;
mod stl;

use std::path::Path;

use igimp_schema::diagnostic::Problems;
use igimp_schema::tree::Node;

pub use named::text_of;

/// Puts the data of files into the tree of the case file of this name; relative names start at the folder of the case.
///
/// Files that cannot be used are listed among the problems, each at the place of its name in the case file.
pub fn read(tree: &mut Node, case: &Path, problems: &mut Problems) {
    let folder = case.parent().unwrap_or(Path::new(""));
    let materials = tree.get_mut("materials").and_then(Node::entries_mut);
    for material in materials.into_iter().flatten() {
        for property in material.node.entries_mut().into_iter().flatten() {
            raster::resolve(&mut property.node, &property.key, folder, problems);
        }
    }
    if let Some(conditions) = tree.get_mut("water") {
        for condition in conditions.items_mut() {
            pressures(condition, folder, problems);
            history::of_faces(condition, folder, problems);
            let bodies = condition.get_mut("bodies").map(Node::items_mut);
            for body in bodies.into_iter().flatten() {
                pressures(body, folder, problems);
            }
        }
    }
    let stages = tree.get_mut("stages").map(Node::items_mut);
    for stage in stages.into_iter().flatten() {
        if let Some(motion) = stage.get_mut("ground_motion") {
            record::resolve(motion, folder, problems);
        }
    }
    let loads = tree.get_mut("loads").map(Node::items_mut);
    for load in loads.into_iter().flatten() {
        shape(load, folder, problems);
    }
    let rigid = tree.get_mut("rigid").map(Node::items_mut);
    for body in rigid.into_iter().flatten() {
        shape(body, folder, problems);
    }
    if let Some(bodies) = tree.get_mut("bodies") {
        for body in bodies.items_mut() {
            shape(body, folder, problems);
            let taken = body.get_mut("minus").map(Node::items_mut);
            for taken in taken.into_iter().flatten() {
                shape(taken, folder, problems);
            }
        }
    }
}

/// The shape of a body, or of the face that a load covers.
fn shape(of: &mut Node, folder: &Path, problems: &mut Problems) {
    for key in ["polygon", "plan"] {
        if let Some(polygon) = of.get_mut(key) {
            outline::resolve(polygon, folder, problems);
        }
    }
    let heights = of.get_mut("between").map(Node::items_mut);
    for height in heights.into_iter().flatten() {
        elevation::resolve(height, folder, problems);
    }
    if let Some(surface) = of.get_mut("surface") {
        stl::resolve(surface, folder, problems);
    }
}

/// The pore pressures, or the table, of a condition of the water, or of a body in it.
fn pressures(of: &mut Node, folder: &Path, problems: &mut Problems) {
    if let Some(points) = of.get_mut("u") {
        raster::resolve(points, "u", folder, problems);
    }
    if let Some(surface) = of.get_mut("surface") {
        elevation::resolve(surface, folder, problems);
    }
}
