//! Surfaces of the ground from surveys: ESRI ASCII grids, and CSV with the columns x, y and z.

use std::iter::Peekable;
use std::path::Path;

use igimp_schema::diagnostic::Problems;
use igimp_schema::quantity::Dimension;
use igimp_schema::text::clip;
use igimp_schema::tree::{Entry, Node, Value};

use crate::columns::columns;
use crate::named::{LARGEST, Named, Trouble, quantity, text_of, unit_beside, unit_of};

/// Most points.
const MOST: usize = 100_000;
/// The columns of a CSV file.
const COLUMNS: [&str; 3] = ["x", "y", "z"];

/// Puts the heights in place of the file that has them, in a table that names one in `raster` or `points`.
pub(crate) fn resolve(surface: &mut Node, folder: &Path, problems: &mut Problems) {
    let named = |key: &'static str| {
        let value = surface.get(key)?;
        value.text().map(|_| (key, value))
    };
    let Some((key, value)) = named("raster").or_else(|| named("points")) else {
        return;
    };
    let Some(file) = Named::new(value, folder) else {
        surface.value = Value::Invalid;
        return;
    };
    surface.value = match table(&file, surface, key) {
        Ok(entries) => Value::Table(entries),
        Err(trouble) => {
            file.report(value, trouble, problems);
            Value::Invalid
        }
    };
}

fn table(file: &Named, like: &Node, key: &str) -> Result<Vec<Entry>, Trouble> {
    let written = like.entries().iter().filter(|entry| entry.node.written);
    let mut others = written.map(|entry| entry.key.as_str());
    if let Some(other) = others.find(|other| ![key, "unit"].contains(other)) {
        return Err(Trouble::new(
            format_args!("the surface is stated by `{key}` and by `{other}`"),
            "keep one of them",
        ));
    }
    let text = text_of(&file.path, LARGEST)
        .map_err(|error| Trouble::new(error, "its path starts from the case file"))?;
    let stated = ("unit", like.text_at("unit"));
    if key == "points" {
        return scattered(&text, stated, like);
    }
    let grid = EsriGrid::parse(&text)?;
    let unit = unit_beside(like)?;
    let length = |x: f64| quantity(x, &unit, Dimension::Length, like);
    let list = |items| Node::written(Value::List(items), like.place);
    let lines = |start: f64, cell: f64, count: usize| {
        let lines = (0..count).map(|k| length(start + k as f64 * cell));
        lines.collect::<Result<Vec<_>, _>>().map(list)
    };
    let (mut rows, mut holes) = (Vec::new(), Vec::new());
    for (j, row) in grid.heights.chunks(grid.columns).rev().enumerate() {
        let mut heights = Vec::with_capacity(row.len());
        for (i, height) in row.iter().enumerate() {
            if height.is_none() {
                let place = [i, j].map(|at| Node::written(Value::Integer(at as i64), like.place));
                holes.push(list(place.to_vec()));
            }
            heights.push(length(height.unwrap_or(0.0))?);
        }
        rows.push(list(heights));
    }
    let entry = |key: &str, node| Entry {
        key: key.to_owned(),
        key_place: like.place,
        node,
    };
    let count = grid.heights.len() / grid.columns;
    Ok(vec![
        entry("x", lines(grid.first[0], grid.cell[0], grid.columns)?),
        entry("y", lines(grid.first[1], grid.cell[1], count)?),
        entry("rows", list(rows)),
        entry("holes", list(holes)),
    ])
}

/// The points of a CSV file.
fn scattered(text: &str, stated: (&str, Option<&str>), like: &Node) -> Result<Vec<Entry>, Trouble> {
    let found = columns(text, &COLUMNS)?;
    if found.rows.len() > MOST {
        return Err(too_many(found.rows.len()));
    }
    let units = [0, 1, 2].map(|column| {
        let header = found.units[column].as_deref();
        unit_of(stated, (COLUMNS[column], header), Dimension::Length)
    });
    let [x, y, z] = units;
    let units = [x?, y?, z?];
    let point = |row: &Vec<f64>| {
        let lengths = std::iter::zip(row, &units);
        let lengths = lengths.map(|(&value, unit)| quantity(value, unit, Dimension::Length, like));
        let lengths = lengths.collect::<Result<Vec<_>, _>>()?;
        Ok(Node::written(Value::List(lengths), like.place))
    };
    let points = found
        .rows
        .iter()
        .map(point)
        .collect::<Result<Vec<_>, Trouble>>()?;
    Ok(vec![Entry {
        key: "points".to_owned(),
        key_place: like.place,
        node: Node::written(Value::List(points), like.place),
    }])
}

fn too_many(count: usize) -> Trouble {
    Trouble::new(
        format_args!("it has {count} points; at most {MOST} are possible"),
        "take fewer of them, or only those around the grid domain",
    )
}

/// An ESRI ASCII grid: a head of keys and values, then rows from north to south.
#[derive(Debug, PartialEq)]
struct EsriGrid {
    columns: usize,
    /// The point of the lowest row and the first column.
    first: [f64; 2],
    cell: [f64; 2],
    /// Rows from north to south.
    heights: Vec<Option<f64>>,
}

/// The help for a head without one of its keys.
const HEAD: &str = "the head of an ESRI ASCII grid has ncols, nrows, xllcorner or xllcenter, yllcorner or yllcenter, cellsize, and NODATA_value if there are holes";

/// The head of an ESRI ASCII grid: key, value and line.
struct Head(Vec<(String, f64, usize)>);

impl Head {
    /// Takes the head off the lines of a file.
    fn take<'t>(
        lines: &mut Peekable<impl Iterator<Item = (&'t str, usize)>>,
    ) -> Result<Self, Trouble> {
        let mut head = Vec::new();
        while let Some(&(line, at)) = lines.peek() {
            let mut words = line.split_whitespace();
            let key = words.next().unwrap_or("").to_lowercase();
            if !key.starts_with(|first: char| first.is_ascii_alphabetic()) || key == "nan" {
                if key.is_empty() && head.is_empty() {
                    lines.next();
                    continue;
                }
                break;
            }
            let value = words.next().and_then(number);
            let (Some(value), None) = (value, words.next()) else {
                let message = format!("line {at}, `{}`, is not a key and a number", clip(line, 40));
                return Err(Trouble::new(message, HEAD));
            };
            head.push((key, value, at));
            lines.next();
        }
        Ok(Self(head))
    }

    fn find(&self, keys: &[&str]) -> Option<(&str, f64, usize)> {
        let found = self.0.iter().find(|(key, ..)| keys.contains(&key.as_str()));
        found.map(|(key, value, at)| (key.as_str(), *value, *at))
    }

    fn needed(&self, keys: &[&str]) -> Result<(&str, f64, usize), Trouble> {
        let missing = || Trouble::new(format_args!("its head has no {}", keys.join(" or ")), HEAD);
        self.find(keys).ok_or_else(missing)
    }

    fn count(&self, key: &str) -> Result<usize, Trouble> {
        let (_, value, at) = self.needed(&[key])?;
        if value >= 2.0 && value.fract() == 0.0 && value <= MOST as f64 {
            return Ok(value as usize);
        }
        let message = format!("line {at}: {key} is {value}");
        Err(Trouble::new(
            message,
            format_args!("a grid has from 2 to {MOST} of them"),
        ))
    }

    /// Size of a cell along an axis, and the middle of its first cell.
    fn axis(&self, axis: usize) -> Result<[f64; 2], Trouble> {
        let (key, size, at) = self.needed(&["cellsize", ["dx", "dy"][axis]])?;
        if size <= 0.0 {
            let message = format!("line {at}: {key} is {size}");
            return Err(Trouble::new(message, "a cell has a positive size"));
        }
        let keys = [["xllcorner", "xllcenter"], ["yllcorner", "yllcenter"]][axis];
        let (key, start, _) = self.needed(&keys)?;
        // Heights are those of the middles of cells.
        let first = if key == keys[0] {
            start + 0.5 * size
        } else {
            start
        };
        Ok([size, first])
    }
}

impl EsriGrid {
    fn parse(text: &str) -> Result<Self, Trouble> {
        let mut lines = text.lines().zip(1..).peekable();
        let head = Head::take(&mut lines)?;
        let (columns, rows) = (head.count("ncols")?, head.count("nrows")?);
        if columns * rows > MOST {
            return Err(too_many(columns * rows));
        }
        let [[dx, x], [dy, y]] = [head.axis(0)?, head.axis(1)?];
        let none = head.find(&["nodata_value"]).map(|(_, value, _)| value);
        let mut heights = Vec::with_capacity(columns * rows);
        for (line, at) in lines {
            for word in line.split_whitespace() {
                let Some(height) = number(word) else {
                    let message = format!("line {at}: `{}` is no height", clip(word, 20));
                    return Err(Trouble::new(message, "every height is a number"));
                };
                let is_none = none.is_some_and(|none| height.total_cmp(&none).is_eq());
                heights.push((!is_none).then_some(height));
            }
        }
        if heights.len() != columns * rows {
            return Err(Trouble::new(
                format_args!(
                    "it has {} heights, and {columns} columns and {rows} rows make {}",
                    heights.len(),
                    columns * rows
                ),
                "the file seems to be cut off, or its head to be of another one",
            ));
        }
        Ok(Self {
            columns,
            first: [x, y],
            cell: [dx, dy],
            heights,
        })
    }
}

fn number(word: &str) -> Option<f64> {
    word.parse().ok().filter(|value: &f64| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::EsriGrid;

    const GRID: &str = "ncols 3\nnrows 2\nXLLCORNER 100\nyllcenter -50\ncellsize 10\nNODATA_value -9999\n1 2 3\n4 -9999 6.5\n";

    fn message(text: &str) -> String {
        EsriGrid::parse(text)
            .err()
            .map_or(String::new(), |trouble| trouble.message)
    }

    #[test]
    fn an_esri_grid_is_read() {
        let expected = EsriGrid {
            columns: 3,
            first: [105.0, -50.0],
            cell: [10.0, 10.0],
            heights: vec![Some(1.0), Some(2.0), Some(3.0), Some(4.0), None, Some(6.5)],
        };
        assert_eq!(EsriGrid::parse(GRID).ok(), Some(expected));
        // Rows may be broken anywhere, and cells be oblong.
        let broken = GRID
            .replace("1 2 3\n4 ", "1\n2 3 4\n")
            .replace("cellsize 10", "dx 10\ndy 5");
        let read = EsriGrid::parse(&broken).ok();
        assert_eq!(read.map(|grid| grid.cell), Some([10.0, 5.0]));
    }

    #[test]
    fn what_is_wrong_has_its_line() {
        for (from, to, expected) in [
            ("nrows 2\n", "", "its head has no nrows"),
            (
                "nrows 2",
                "nrows two",
                "line 2, `nrows two`, is not a key and a number",
            ),
            ("ncols 3", "ncols 2.5", "line 1: ncols is 2.5"),
            ("cellsize 10", "cellsize 0", "line 5: cellsize is 0"),
            (
                "2 3\n",
                "2\n",
                "it has 5 heights, and 3 columns and 2 rows make 6",
            ),
            ("6.5", "6,5", "line 8: `6,5` is no height"),
            (
                "ncols 3",
                "ncols 70000",
                "it has 140000 points; at most 100000 are possible",
            ),
        ] {
            assert_eq!(message(&GRID.replace(from, to)), expected);
        }
    }
}
