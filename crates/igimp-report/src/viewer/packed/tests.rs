use igimp_results::vtu::{DataArray, UnstructuredGrid, padded};

use super::*;

/// n³ boxes of width 1 with a scalar and a vector.
fn cube(n: usize) -> UnstructuredGrid {
    let kind = CellKind::Hexahedron;
    let places: Vec<[usize; 3]> = (0..n * n * n)
        .map(|k| [k % n, k / n % n, k / (n * n)])
        .collect();
    let corner = |place: &[usize; 3]| {
        let place = *place;
        let corners = kind.corners().iter();
        corners
            .map(move |upper| padded(&[0, 1, 2].map(|k| (place[k] + usize::from(upper[k])) as f64)))
    };
    let points: Vec<[f64; 3]> = places.iter().flat_map(corner).collect();
    let heights: Vec<f64> = places.iter().map(|place| place[2] as f64).collect();
    UnstructuredGrid {
        connectivity: (0..points.len()).collect(),
        points,
        kind,
        point_data: Vec::new(),
        cell_data: vec![
            DataArray::vectors(
                "u <x> [m]",
                &places
                    .iter()
                    .map(|p| p.map(|i| i as f64))
                    .collect::<Vec<_>>(),
            ),
            DataArray::scalars("p [Pa]", heights),
            DataArray::integers("particle", (0..places.len() as i32).collect()),
        ],
        field_data: Vec::new(),
    }
}

fn json(grid: &UnstructuredGrid, keep: Keep) -> serde_json::Value {
    serde_json::from_str(&packed(&grid.to_xml(), keep, None).unwrap()).unwrap()
}

/// The bytes of an array as they were before they were sorted.
fn unpacked(array: &serde_json::Value, width: usize) -> Vec<u8> {
    use std::io::Read as _;
    let data = BASE64.decode(array["data"].as_str().unwrap()).unwrap();
    let mut sorted = Vec::new();
    flate2::read::ZlibDecoder::new(&data[..])
        .read_to_end(&mut sorted)
        .unwrap();
    let count = sorted.len() / width;
    (0..sorted.len())
        .map(|k| sorted[k % width * count + k / width])
        .collect()
}

#[test]
fn a_small_body_is_whole() {
    let page = json(&cube(4), Keep::MUCH);
    assert_eq!(
        (&page["dimension"], &page["count"]),
        (&3.into(), &64.into())
    );
    assert!(page["planes"].is_null());
    assert_eq!(page["fields"][0]["name"], "u <x> [m]");
    let numbers = unpacked(&page["fields"][1], 4);
    let last = f32::from_le_bytes(*numbers.last_chunk().unwrap());
    assert!((last - 3.0).abs() < 1e-6);
    // The length of a vector has a range of its own.
    assert_eq!(page["fields"][0]["range"].as_array().unwrap().len(), 4);
    let faces = unpacked(&page["places"][2], 1);
    assert_eq!(faces.iter().map(|mask| mask.count_ones()).sum::<u32>(), 96);
    assert!(
        !packed(&cube(4).to_xml(), Keep::MUCH, None)
            .unwrap()
            .contains('<')
    );
}

#[test]
fn a_large_body_has_its_skin_and_some_planes() {
    let keep = Keep {
        rounded: true,
        boxes: 5200,
    };
    let page = json(&cube(20), keep);
    assert_eq!(page["particles"], 8000);
    let count = page["count"].as_u64().unwrap();
    // 20³ − 18³ boxes of the skin, and one plane of each direction between two layers of boxes.
    assert!((2168..5200).contains(&count), "{count}");
    assert_eq!(page["planes"][0].as_array().unwrap().len(), 1);
    let range = &page["fields"][1]["range"][0];
    assert_eq!(
        (range[0].as_f64(), range[1].as_f64()),
        (Some(0.0), Some(19.0))
    );
}

#[test]
fn numbers_are_rounded_to_their_range() {
    let ends = [[-1.0, 3.0]];
    let array = rounded("x", &[-1.0, 3.0, 0.5, f64::NAN], &ends);
    let array = serde_json::to_value(&array).unwrap();
    let bytes = unpacked(&array, 2);
    let pairs = bytes.as_chunks::<2>().0.iter();
    let stored: Vec<u16> = pairs.map(|pair| u16::from_le_bytes(*pair)).collect();
    assert_eq!((stored[0], stored[1], stored[3]), (0, 65_534, u16::MAX));
    let read = -1.0 + f64::from(stored[2]) * array["step"][0].as_f64().unwrap();
    assert!((read - 0.5).abs() < 4.0 / 65_534.0);
}

#[test]
fn far_places_keep_their_digits() {
    let far = 5_812_345.25;
    let array = exact("low", 3, &[far, 0.0, 1.0, far + 0.125, 0.0, 1.0]);
    assert!((array.low[0] - far).abs() < 1e-9);
    let array = serde_json::to_value(&array).unwrap();
    let bytes = unpacked(&array, 4);
    let second = f32::from_le_bytes(*bytes[12..].first_chunk().unwrap());
    assert!((second - 0.125).abs() < 1e-9);
}

#[test]
fn unreadable_data_are_nothing() {
    let text = cube(2).to_xml();
    assert!(packed("", Keep::MUCH, None).is_none());
    assert!(packed(&text.replace("AQ", "@@"), Keep::MUCH, None).is_none());
    let none = UnstructuredGrid {
        points: Vec::new(),
        connectivity: Vec::new(),
        cell_data: Vec::new(),
        ..cube(1)
    };
    assert_eq!(json(&none, Keep::MUCH)["count"], 0);
}

/// GOAL: without the bodies of the case, and in space, there are no pieces.
#[test]
fn pieces_are_those_of_the_plane() {
    let page = json(&cube(2), Keep::MUCH);
    let names: Vec<&str> = page["places"]
        .as_array()
        .unwrap()
        .iter()
        .map(|array| array["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["low", "high", "faces", "lie", "moves"]);
}
