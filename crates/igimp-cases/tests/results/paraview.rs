//! GOAL: files for ParaView and numpy open there, with the numbers that were meant.
//! ORACLE: VTK, PyVista, meshio and numpy, where they are installed; else these tests say that
//! they were skipped.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use igimp_assembly::{Interface, ParticleFields, ParticleSeed, Particles, RigidBody, Surface};
use igimp_material::Regime;
use igimp_model::{RigidInterface, RigidPart, RigidShape, RigidShear};
use igimp_results::checkpoint::{self, Checkpoint, Meta};
use igimp_results::npy::{Array, Values};
use igimp_results::paraview::particles::{Extras, of_grid, of_particles};
use igimp_results::paraview::pvd::{Collection, GRID, PARTICLES, RIGID};
use igimp_results::rigid::{Standing, cells as cells_of_bodies};
use igimp_results::vtu::{CellKind, DataArray, UnstructuredGrid};
use igimp_shape::{Axis, Grid};
use igimp_solver::Body;
use serde_json::{Value, json};

/// An empty folder of the build.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

/// Runs a script of `tests/vtk` on a folder; false when its packages are not installed.
fn run_script(script: &str, packages: &str, folder: &Path) -> bool {
    let import = format!("import {packages}");
    let found = Command::new("python3").args(["-c", &import]).output();
    if !found.is_ok_and(|output| output.status.success()) {
        println!("skipped: python3 cannot import {packages}");
        return false;
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/vtk")
        .join(script);
    let output = Command::new("python3")
        .arg(&script)
        .arg(folder)
        .output()
        .unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(
        output.status.success(),
        "{}{}",
        text(&output.stdout),
        text(&output.stderr)
    );
    println!("{}", text(&output.stdout));
    true
}

/// A block of `side`^D particles that nearly fill cells of size 1, with a state made of sines.
fn particles<const D: usize>(side: usize) -> Particles<D> {
    let n = side.pow(D as u32);
    let number = |k: usize, entry: usize| ((k * 31 + entry) as f64).sin();
    let tensor = |k: usize| {
        let t: [[f64; 3]; 3] =
            std::array::from_fn(|row| std::array::from_fn(|column| number(k, 3 * row + column)));
        std::array::from_fn(|row| {
            std::array::from_fn(|column| 1e5 * (t[row][column] + t[column][row]))
        })
    };
    let position = |k: usize| {
        std::array::from_fn(|axis| {
            (k / side.pow(axis as u32) % side) as f64 + 0.1 * number(k, axis)
        })
    };
    let seed = ParticleSeed {
        x: [0.0; D],
        half_length: [0.5; D],
        volume: 1.0,
        density: 1.0,
        law: 0,
        centroid: [0.0; D],
    };
    Particles::from_fields(ParticleFields {
        x: (0..n).map(position).collect(),
        displacement: (0..n)
            .map(|k| std::array::from_fn(|axis| number(k, 20 + axis)))
            .collect(),
        def_grad: (0..n)
            .map(|k| {
                std::array::from_fn(|row| {
                    std::array::from_fn(|column| {
                        f64::from(u8::from(row == column)) + 0.1 * number(k, 30 + 3 * row + column)
                    })
                })
            })
            .collect(),
        b_e: (0..n).map(tensor).collect(),
        sigma: (0..n).map(tensor).collect(),
        half_length: vec![[0.25; D]; n],
        half_length0: vec![[0.5; D]; n],
        centroid: vec![[0.0; D]; n],
        volume0: vec![1.0; n],
        mass: vec![2.0; n],
        pore_pressure: (0..n).map(|k| 5e4 * number(k, 60).abs()).collect(),
        excess: (0..n).map(|k| 1e4 * number(k, 61)).collect(),
        // Bodies came and went: numbers have gaps, and do not rise.
        number: (0..n).map(|k| 3 * (n - k)).collect(),
        law: (0..n).map(|k| k % 4).collect(),
        eps_p_eq: (0..n).map(|k| number(k, 50).abs()).collect(),
        regime: (0..n)
            .map(|k| [Regime::Elastic, Regime::Smooth, Regime::Apex][k % 3])
            .collect(),
        // Further columns are as they are seeded.
        ..(*Particles::new(&vec![seed; n]).unwrap()).clone()
    })
    .unwrap()
}

/// Numbers for the readers, and the total area or volume of the cells.
fn expected(grid: &UnstructuredGrid, time: f64, size: f64) -> Value {
    let array = |array: &DataArray| {
        let (kind, values) = match array.values() {
            Values::F64(values) => ("double", json!(values)),
            Values::I32(values) => ("int", json!(values)),
            other => panic!("not written here: {other:?}"),
        };
        json!({
            "name": array.name(),
            "components": array.components(),
            "component_names": array.component_names(),
            "type": kind,
            "values": values,
        })
    };
    let arrays = |arrays: &[DataArray]| arrays.iter().map(array).collect::<Vec<_>>();
    let cell_type = match grid.kind {
        CellKind::Line => 3,
        CellKind::Triangle => 5,
        CellKind::Quad => 9,
        CellKind::Hexahedron => 12,
    };
    json!({
        "points": grid.points,
        "cells": grid.cell_count(),
        "cell_type": cell_type,
        "connectivity": grid.connectivity,
        "point_data": arrays(&grid.point_data),
        "cell_data": arrays(&grid.cell_data),
        "time": time,
        "size": size,
    })
}

fn axis(cells: usize) -> Axis {
    Axis::uniform(-1.0, 0.5, cells).unwrap()
}

/// A rectangle of 2 m by 1 m whose corners are rounded, turned and pressed against something.
fn rectangle() -> (RigidPart<2>, RigidBody<2>) {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
    let interface = RigidInterface {
        shear: RigidShear::Rough,
        tension: igimp_assembly::Tension::None,
    };
    let part = RigidPart {
        name: "plate".into(),
        shape: Arc::new(RigidShape::Polygon(corners.to_vec())),
        reference: [1.0, 0.0],
        centre_of_mass: [1.0, 0.5],
        interfaces: vec![interface; 4],
        stiffness: 10.0,
        rounding: 0.5,
        weight: 0.0,
        force_factor: 1.0,
        grid_follows: false,
        from_start: false,
        most_penetration: 0.1,
    };
    let local = corners.map(|[x, y]| [x - 1.0, y]);
    let surface = Surface::polygon(&local, 0.1, 0.4).unwrap();
    let mut body = RigidBody::new(surface, vec![Interface::rough(); 4], [1.0, 0.0]);
    body.pose = body.pose.moved(&[0.5, -0.25], &[0.3, 0.0, 0.0]);
    for (k, knot) in body.contact.knots.iter_mut().enumerate().take(4) {
        knot.pressure = 1e3 * (k as f64 + 1.0);
        knot.shear = [-0.5 * knot.pressure, 0.0];
        knot.area = 0.1;
        knot.gap = -1e-3;
        knot.is_closed = true;
        knot.slips = k == 0;
    }
    (part, body)
}

/// A grid without points.
fn nothing() -> UnstructuredGrid {
    UnstructuredGrid {
        points: Vec::new(),
        kind: CellKind::Quad,
        connectivity: Vec::new(),
        point_data: Vec::new(),
        cell_data: Vec::new(),
        field_data: Vec::new(),
    }
}

#[test]
fn vtk_pyvista_and_meshio_read_what_is_written() {
    let folder = folder("paraview");
    // Tensors of 50² particles take 15 blocks; 64² particles make blocks that are exactly full.
    let (small, plane, full, space) = (
        particles::<2>(2),
        particles::<2>(50),
        particles::<2>(64),
        particles::<3>(4),
    );
    let utilisation: Vec<f64> = (0..plane.len()).map(|k| k as f64 / 2500.0).collect();
    let everything = Extras {
        materials: None,
        axisymmetric: false,
        carried: &[],
        utilisation: Some(&utilisation),
        def_grad: true,
        pore_water: true,
        motion: true,
    };
    let none = Extras::default();
    let mut of_plane = Collection::create(&folder, PARTICLES).unwrap();
    let mut of_background = Collection::create(&folder, GRID).unwrap();
    let mut grids = serde_json::Map::new();
    let mut add = |collection: &mut Collection, time: f64, grid: &UnstructuredGrid, size: f64| {
        let path = collection.add(time, "stage", grid).unwrap();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        grids.insert(name, expected(grid, time, size));
    };
    for (time, particles, extras) in [
        (0.0, &small, &none),
        (1.0 / 3.0, &plane, &everything),
        (0.7, &full, &none),
    ] {
        let area = 0.25 * particles.len() as f64;
        add(&mut of_plane, time, &of_particles(particles, extras), area);
    }
    let volume = 0.125 * space.len() as f64;
    add(&mut of_plane, 2.0, &of_particles(&space, &none), volume);
    let background = Grid::new([axis(60), axis(40)]);
    let u: Vec<[f64; 2]> = (0..background.node_count())
        .map(|node| [(node as f64).cos(), 1e-3])
        .collect();
    let cells = of_grid(&background, Some(&u));
    add(&mut of_background, 1e-12, &cells, 30.0 * 20.0);
    let cells = of_grid(&Grid::new([axis(3), axis(2), axis(4)]), None);
    add(&mut of_background, 0.1, &cells, 3.0);
    let (part, body) = rectangle();
    let plate = cells_of_bodies(&[Standing {
        index: 0,
        part: &part,
        body: &body,
    }]);
    let mut of_bodies = Collection::create(&folder, RIGID).unwrap();
    // The outline as the case has it, corners included: 2 (2 + 1) metres around.
    add(&mut of_bodies, 1.0, &plate, 6.0);
    let of_plate = plate.cell_count();
    let nothing = nothing();
    nothing
        .clone()
        .at_time(5.0)
        .write(&folder.join("nothing.vtu"))
        .unwrap();
    grids.insert("nothing.vtu".into(), expected(&nothing, 5.0, 0.0));
    let expected = json!({
        "grids": grids,
        "collections": {
            "particles.pvd": {
                "times": [0.0, 1.0 / 3.0, 0.7, 2.0],
                "cells": [4, 2500, 4096, 64],
            },
            "grid.pvd": { "times": [1e-12, 0.1], "cells": [2400, 24] },
            "rigid.pvd": { "times": [1.0], "cells": [of_plate] },
        },
    });
    fs::write(folder.join("expected.json"), expected.to_string()).unwrap();
    run_script("read_vtu.py", "vtk, pyvista, meshio", &folder);
}

/// GOAL: with water the arrays name total and effective stress, and total stress is effective stress less the pore pressure;
/// without it nothing is written of pores.
#[test]
fn total_and_effective_stress_are_arrays_of_their_own() {
    let soil = particles::<2>(5);
    let extras = Extras {
        pore_water: true,
        ..Extras::default()
    };
    let wet = of_particles(&soil, &extras);
    let of = |grid: &UnstructuredGrid, name: &str| {
        let array = grid.cell_data.iter().find(|array| array.name() == name);
        array.map(|array| match array.values() {
            Values::F64(values) => values.clone(),
            other => panic!("{other:?}"),
        })
    };
    let total = of(&wet, "sigma [Pa], tension +").unwrap();
    let effective = of(&wet, "sigma_eff [Pa], tension +").unwrap();
    let (u, excess) = (
        of(&wet, "u [Pa], compression +").unwrap(),
        of(&wet, "u_excess [Pa], compression +").unwrap(),
    );
    let p = ["p", "p_eff"].map(|name| of(&wet, &format!("{name} [Pa], compression +")).unwrap());
    for k in 0..soil.len() {
        assert_eq!(excess[k].to_bits(), soil.excess[k].to_bits());
        for entry in 0..6 {
            let by = if entry < 3 { u[k] } else { 0.0 };
            let found = effective[6 * k + entry] - total[6 * k + entry];
            assert!((found - by).abs() < 1e-9 * 1e5, "{found} {by}");
        }
        assert!((p[0][k] - p[1][k] - u[k]).abs() < 1e-9 * 1e5);
    }
    let dry = of_particles(&soil, &Extras::default());
    let names = |grid: &UnstructuredGrid| grid.cell_data.len();
    assert_eq!(names(&wet), names(&dry) + 4);
    assert_eq!(of(&dry, "u [Pa], compression +"), None);
}

/// GOAL: traction of soil on a body points into it, and along it where soil slips.
/// ORACLE: pressure p and shear −p/2 on the soil along the base of a plate turned by 0.3: the body feels
/// p upwards and p/2 to its right.
#[test]
fn tractions_turn_with_the_body() {
    let (part, body) = rectangle();
    let standing = Standing {
        index: 0,
        part: &part,
        body: &body,
    };
    let grid = cells_of_bodies(&[standing]);
    let of = |name: &str| {
        let mut arrays = grid.point_data.iter();
        match arrays.find(|array| array.name() == name).unwrap().values() {
            Values::F64(values) => values.clone(),
            other => panic!("{other:?}"),
        }
    };
    let (pressure, traction) = (
        of("contact pressure [Pa], compression +"),
        of("traction on body [Pa]"),
    );
    // The first point is a corner, which carries nothing.
    let pressures = [pressure[0], pressure[1], pressure[2]];
    assert_eq!(
        pressures.map(f64::to_bits),
        [0.0, 1e3, 2e3].map(f64::to_bits)
    );
    let (sin, cos) = 0.3_f64.sin_cos();
    for k in [1, 2] {
        let p = pressure[k];
        let expected = [-p * sin + 0.5 * p * cos, p * cos + 0.5 * p * sin];
        for axis in 0..2 {
            assert!((traction[3 * k + axis] - expected[axis]).abs() < 1e-9 * p);
        }
    }
    let table = standing.table("plate__1-push".into(), false);
    let whole = standing.table("plate__1-push".into(), true);
    assert_eq!(
        [&table, &whole].map(|table| table.header[7].as_str()),
        ["contact_[m]", "contact_[m2]"]
    );
    let along: Vec<f64> = table.rows.iter().take(2).map(|row| row[1]).collect();
    assert!(
        (along[0] - 0.1).abs() < 1e-12 && along[1] > along[0],
        "{along:?}"
    );
}

#[test]
fn numpy_reads_and_writes_checkpoints() {
    let folder = folder("numpy");
    let body = Body::new(particles::<2>(6));
    let path = checkpoint::write(
        &folder.join("checkpoint"),
        "end",
        &[("current", &body)],
        &Meta::new("case", json!({ "factor": 0.1 + 0.2 })),
        1,
    )
    .unwrap();
    if !run_script("numpy_arrays.py", "numpy", &folder) {
        return;
    }
    let changed: Checkpoint<2> = checkpoint::read(&path, Some("case")).unwrap();
    assert_eq!(changed.meta.data["factor"], json!(0.1 + 0.2));
    let particles = &changed.states[0].1.particles;
    assert_eq!(particles.x, body.particles.x);
    for (changed, sigma) in particles.sigma.iter().zip(&body.particles.sigma) {
        assert_eq!(*changed, sigma.map(|row| row.map(|entry| 2.0 * entry)));
    }
    let read = |name: &str| Array::read(&folder.join(name));
    assert_eq!(
        read("i32.npy").unwrap(),
        Array::new(&[2, 3], Values::I32((-3..3).collect()))
    );
    assert_eq!(
        read("nothing.npy").unwrap(),
        Array::new(&[0, 2], Values::F64(Vec::new()))
    );
    assert_eq!(
        read("number.npy").unwrap(),
        Array::new(&[], Values::F64(vec![2.5]))
    );
    for refused in ["f32.npy", "fortran.npy"] {
        assert!(read(refused).is_err(), "{refused}");
    }
}
