//! GOAL: the geometry that the page computes to draw: contours of the plane and of space, and the edges of rigid bodies.
//! ORACLE: fields whose contours are known, run through the scripts of the page in a browser.

use igimp_report::viewer;

use crate::support::{Folder, browser, dumped};

/// Numbers that lines of script leave in `found`, by the scripts of the page.
fn found(name: &str, script: &str) -> Option<serde_json::Value> {
    let browser = browser()?;
    let folder = Folder::new(name);
    let page = folder.0.join("page.html");
    let text = format!(
        "<!DOCTYPE html><body><script>\"use strict\";\n{}\n{script}\n\
         document.body.dataset.found = JSON.stringify(found);</script></body>",
        viewer::script()
    );
    std::fs::write(&page, text).unwrap();
    let dump = dumped(browser, &folder, &format!("file://{}", page.display()), 5);
    let (_, text) = dump.split_once("data-found=\"").expect("the script ran");
    let (text, _) = text.split_once('"').unwrap();
    Some(serde_json::from_str(&text.replace("&quot;", "\"")).unwrap())
}

/// Square pieces over the unit square with the values of a function at their middles, and the length of a line.
const SQUARES: &str = "function squares(n, f) {
  const [corners, ends, whose, centres, values] = [[], [], [], [], []];
  for (let k = 0; k < n * n; k += 1) {
    const [i, j] = [k % n, Math.floor(k / n)];
    for (const [a, b] of [[0, 0], [1, 0], [1, 1], [0, 1]]) corners.push((i + a) / n, (j + b) / n);
    ends.push(corners.length / 2);
    whose.push(k);
    centres.push((i + 0.5) / n, (j + 0.5) / n);
    values.push(f((i + 0.5) / n, (j + 0.5) / n));
  }
  return [{ corners, ends, whose }, values, centres];
}
const long = (line) => line.reduce((sum, p, k) => (k ? sum + Math.hypot(p[0] - line[k - 1][0], p[1] - line[k - 1][1]) : 0), 0);
";

/// Contours of a plane are straight and go from side to side; those of a cone are circles, and their error falls by four with
/// the size of the pieces; a jump between two soils has no contour.
#[test]
fn contours_of_the_plane_are_those_of_the_field() {
    let script = format!(
        "{SQUARES}
const cone = (x, y) => Math.hypot(x - 0.5, y - 0.5);
const plane = contoursOf(...squares(8, (x, y) => 2 * x + y), [0.1, 1.5, 2.95], null);
const circle = (n) => contoursOf(...squares(n, cone), [0.3], null)[0].lines;
const jump = squares(8, (x) => (x < 0.5 ? 0 : 1));
const soil = jump[1].map((value) => value);
const found = {{
  counts: plane.map(({{ lines }}) => lines.length),
  lengths: plane.map(({{ lines }}) => long(lines[0])),
  off: Math.max(...plane.flatMap(({{ level, lines }}) => lines.flat().map(([x, y]) => Math.abs(2 * x + y - level)))),
  circles: [16, 32].map((n) => [circle(n).length, long(circle(n)[0]) / (0.6 * Math.PI) - 1]),
  jump: [null, soil].map((point) => contoursOf(...jump, [0.5], point)[0].lines.length),
}};"
    );
    let Some(found) = found("contours", &script) else {
        return;
    };
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    assert_eq!(found["counts"], serde_json::json!([1, 1, 1]));
    // Through 2x + y = 0.1, 1.5 and 2.95: from one side of the square to another.
    let half_root = 0.5 * 5.0_f64.sqrt();
    for (k, share) in [0.1, 1.0, 0.05].into_iter().enumerate() {
        let length = number(&found["lengths"][k]);
        assert!((length - share * half_root).abs() < 1e-9, "{length}");
    }
    assert!(number(&found["off"]) < 1e-12);
    let error = |k: usize| number(&found["circles"][k][1]);
    assert_eq!(found["circles"][0][0], 1);
    assert!(
        error(0).abs() < 0.004 && error(0) > 3.5 * error(1),
        "{found}"
    );
    assert_eq!(found["jump"], serde_json::json!([1, 0]));
}

/// A linear field has its own values where corners of boxes meet; a cube of 12 triangles has 12 edges, whichever way its faces
/// are cut, and a ball none.
#[test]
fn corners_of_boxes_and_edges_of_rigid_bodies() {
    let script = "
const [n, low, high, values] = [5, [], [], []];
for (let k = 0; k < n ** 3; k += 1) {
  const point = [k % n, Math.floor(k / n) % n, Math.floor(k / n ** 2)];
  low.push(...point);
  high.push(...point.map((x) => x + 1));
  values.push(point[0] + 2 * point[1] - point[2] + 1);
}
const corners = cornerValues({ low, high, count: n ** 3 }, values);
let off = 0;
corners.forEach((value, at) => {
  const [box, k] = [at >> 3, at & 7];
  const place = [k & 1, (k >> 1) & 1, k >> 2].map((upper, axis) => (upper ? high : low)[3 * box + axis]);
  if (place.some((x) => x === 0 || x === n)) return;
  off = Math.max(off, Math.abs(value - place[0] - 2 * place[1] + place[2]));
});
const quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
const corner = (k) => [2 * (k & 1), 2 * ((k >> 1) & 1), 2 * (k >> 2)];
const cube = quads.flatMap(([a, b, c, d]) => [a, b, c, a, c, d].flatMap(corner));
const around = (i, j) => [Math.sin((i * Math.PI) / 12) * Math.cos((j * Math.PI) / 12), Math.sin((i * Math.PI) / 12) * Math.sin((j * Math.PI) / 12), Math.cos((i * Math.PI) / 12)].map((x) => Math.round(1e9 * x) / 1e9 + 0);
const ball = [];
for (let i = 0; i < 12; i += 1) for (let j = 0; j < 24; j += 1) {
  const [a, b, c, d] = [around(i, j), around(i + 1, j), around(i + 1, (j + 1) % 24), around(i, (j + 1) % 24)];
  if (i < 11) ball.push(...a, ...b, ...c);
  if (i > 0) ball.push(...a, ...c, ...d);
}
const found = { off, edges: creasesOf(cube).length / 6, length: lengthOf(creasesOf(cube)), ball: creasesOf(ball).length };
";
    let Some(found) = found("corners", script) else {
        return;
    };
    assert!(found["off"].as_f64().unwrap() < 1e-5);
    assert_eq!(found["edges"], 12);
    assert!((found["length"].as_f64().unwrap() - 24.0).abs() < 1e-9);
    assert_eq!(found["ball"], 0);
}

/// Values of contours in space stand on lines that are seen: those of a field that rises with z go around the two sides of a cube that
/// look at the eye, and along the face of a cut in place of the side that it takes away. BAND: 1e-9 of their length.
#[test]
fn contours_in_space_are_written_where_they_are_seen() {
    let script = "
const [n, low, high, corners, faces] = [4, [], [], [], { box: [], face: [] }];
for (let k = 0; k < n ** 3; k += 1) {
  const point = [k % n, Math.floor(k / n) % n, Math.floor(k / n ** 2)];
  low.push(...point);
  high.push(...point.map((x) => x + 1));
  for (let j = 0; j < 8; j += 1) corners.push(point[2] + (j >> 2) - 0.5);
  point.forEach((x, axis) => [0, n - 1].forEach((end, side) => {
    if (x !== end) return;
    faces.box.push(k);
    faces.face.push(2 * axis + side);
  }));
}
const scene = { boxes: { low, high, faces, count: n ** 3 }, surface: { corners }, camera: new Camera(3), isLeftOut: () => false };
const place = scene.camera.layout(600, { low: [0, 0, 0], high: [n, n, n] });
const length = (points) => points.reduce((sum, p, k) => (k ? sum + Math.hypot(p[0] - points[k - 1][0], p[1] - points[k - 1][1]) : 0), 0);
const along = (y, z) => length([[0, y, z], [n, y, z], [n, n, z]].map((point) => projected(place, scene.camera, point)));
const off = (cut, y) => crossingsInSight({ ...scene, cut }, place, 3).map((point, level) => point.reduce((sum, { from, to }) => sum + length([from, to]), 0) / along(y, level + 0.5) - 1);
const found = [off(null, 0), off({ axis: 1, normal: [0, -1, 0], offset: -1.5 }, 1.5)].flat();
";
    let Some(found) = found("levels", script) else {
        return;
    };
    let shares = found.as_array().unwrap();
    assert_eq!(shares.len(), 6);
    for share in shares {
        assert!(share.as_f64().unwrap().abs() < 1e-9, "{found}");
    }
}
