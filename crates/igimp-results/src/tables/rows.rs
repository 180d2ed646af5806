//! Tables that grow by a row a step, on disk at once, and that a resumed run continues to the same
//! bytes that an uninterrupted run writes.

use std::fs::{self, File};
use std::io::{self, BufRead as _, BufReader, Read as _, Write as _};
use std::path::{Path, PathBuf};

use super::cells::{cell, number, text_of};
use crate::atomic::{at, create, temporary_name};
use crate::checkpoint::sha256;
use crate::error::ResultsError;
use crate::tables::table::Table;

/// A CSV file that is appended to.
#[derive(Debug)]
pub struct RowWriter {
    path: PathBuf,
    file: File,
    columns: Vec<String>,
    rows: usize,
}

impl RowWriter {
    /// An empty table with its header; earlier contents are gone.
    ///
    /// # Errors
    /// [`ResultsError::File`].
    pub fn create(path: &Path, header: &[String]) -> Result<Self, ResultsError> {
        let mut file = create(path).map_err(at(path))?;
        file.write_all(&text_line(path, header)?)
            .map_err(at(path))?;
        Ok(Self {
            path: path.to_path_buf(),
            file,
            columns: header.to_vec(),
            rows: 0,
        })
    }

    /// Goes on after the first `rows` rows of a file; the rest is cut off, also a line
    /// that was written in part.
    ///
    /// The rows are kept in a new file: links to the old one keep its contents. Without
    /// rows to keep the file is made anew.
    ///
    /// # Errors
    /// [`ResultsError::File`]; [`ResultsError::Unusable`] when the file has another header or fewer rows.
    pub fn resume(path: &Path, header: &[String], rows: usize) -> Result<Self, ResultsError> {
        if rows == 0 {
            return Self::create(path, header);
        }
        let (file, end) = kept(path, header, rows)?;
        Ok(Self {
            path: path.to_path_buf(),
            file: beginning(path, file, end).map_err(at(path))?,
            columns: header.to_vec(),
            rows,
        })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Appends a row, formatted as by [`Table::write_csv`].
    ///
    /// # Errors
    /// [`ResultsError::File`].
    ///
    /// # Panics
    /// If the row is not as long as the header.
    pub fn push(&mut self, row: &[f64]) -> Result<(), ResultsError> {
        let entries = row.iter().enumerate();
        let entries: Vec<String> = entries
            .map(|(k, value)| number(&self.columns[k], *value))
            .collect();
        self.push_text(&entries)
    }

    /// Appends a row of texts, which are quoted where need be.
    ///
    /// # Errors
    /// [`ResultsError::File`].
    ///
    /// # Panics
    /// If the row is not as long as the header.
    pub fn push_text(&mut self, row: &[String]) -> Result<(), ResultsError> {
        assert_eq!(
            row.len(),
            self.columns.len(),
            "a row has one entry a column"
        );
        let line = text_line(&self.path, row)?;
        // One write without a buffer: a reader sees the row as soon as it is pushed.
        self.file.write_all(&line).map_err(at(&self.path))?;
        self.rows += 1;
        Ok(())
    }

    /// Number of rows below the header.
    pub fn len(&self) -> usize {
        self.rows
    }

    /// Whether there is only the header.
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// Waits until the disk has every row: before a checkpoint that counts on them.
    ///
    /// # Errors
    /// [`ResultsError::File`].
    pub fn sync(&self) -> Result<(), ResultsError> {
        self.file.sync_data().map_err(at(&self.path))
    }
}

/// Asks whether [`RowWriter::resume`] can go on after the first `rows` rows of a file; nothing is changed.
///
/// # Errors
/// [`ResultsError::File`]; [`ResultsError::Unusable`] when the file has another header or fewer rows.
pub fn holds(path: &Path, header: &[String], rows: usize) -> Result<(), ResultsError> {
    match rows {
        0 => Ok(()),
        rows => kept(path, header, rows).map(|_| ()),
    }
}

/// Fingerprint of the header and the first `rows` rows of a file; none where they are not there.
///
/// # Errors
/// [`ResultsError::File`].
pub fn digest(path: &Path, rows: usize) -> Result<Option<String>, ResultsError> {
    let bytes = match fs::read(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        bytes => bytes.map_err(at(path))?,
    };
    let mut ends = (0..bytes.len()).filter(|&k| bytes[k] == b'\n');
    Ok(ends.nth(rows).map(|end| sha256(&bytes[..=end])))
}

/// A file with the header and the first `rows` rows of a table, and where they end in it.
fn kept(path: &Path, header: &[String], rows: usize) -> Result<(File, u64), ResultsError> {
    let unusable = |why: String| ResultsError::Unusable {
        path: path.to_path_buf(),
        why,
    };
    let file = File::open(path).map_err(at(path))?;
    let mut lines = Lines::new(&file);
    if lines.next_line().map_err(at(path))? != Some(&text_line(path, header)?[..]) {
        return Err(unusable("its header is not the one of this case".into()));
    }
    for kept in 0..rows {
        if lines.next_line().map_err(at(path))?.is_none() {
            return Err(unusable(format!("it holds {kept} of {rows} rows")));
        }
    }
    let end = lines.end;
    Ok((file, end))
}

/// Reads a table back, with the name of its file; a last line that was written in part is left
/// out.
///
/// # Errors
/// [`ResultsError::File`]; [`ResultsError::Unusable`] for rows that are not numbers, or not as many as
/// the header has columns.
pub fn read(path: &Path) -> Result<Table, ResultsError> {
    let unusable = |why: String| ResultsError::Unusable {
        path: path.to_path_buf(),
        why,
    };
    let mut text = std::fs::read(path).map_err(at(path))?;
    let whole = text
        .iter()
        .rposition(|&byte| byte == b'\n')
        .map_or(0, |last| last + 1);
    text.truncate(whole);
    let mut reader = csv::Reader::from_reader(&text[..]);
    let header = reader
        .headers()
        .map_err(|error| unusable(error.to_string()))?
        .iter()
        .map(|entry| text_of(entry).to_owned())
        .collect();
    let rows = reader
        .records()
        .enumerate()
        .map(|(row, record)| {
            let record = record.map_err(|error| unusable(error.to_string()))?;
            record
                .iter()
                .map(|entry| {
                    let number = entry.parse::<f64>();
                    number
                        .map_err(|_| unusable(format!("`{entry}` in row {} is no number", row + 1)))
                })
                .collect()
        })
        .collect::<Result<_, _>>()?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    Ok(Table {
        name: name.into_owned(),
        header,
        rows,
    })
}

/// A new file with the first bytes of the one that has the name, in its place and open at its end.
fn beginning(path: &Path, mut old: File, bytes: u64) -> io::Result<File> {
    io::Seek::rewind(&mut old)?;
    let temporary = temporary_name(path);
    let mut file = create(&temporary)?;
    io::copy(&mut old.take(bytes), &mut file)?;
    file.sync_data()?;
    fs::rename(&temporary, path)?;
    Ok(file)
}

fn text_line(path: &Path, header: &[String]) -> Result<Vec<u8>, ResultsError> {
    let mut line = csv::Writer::from_writer(Vec::new());
    line.write_record(header.iter().map(|entry| cell(entry).into_owned()))
        .map_err(|source| ResultsError::Table {
            path: path.to_path_buf(),
            source,
        })?;
    line.into_inner()
        .map_err(|error| at(path)(error.into_error()))
}

/// Whole lines of a file, and where they end.
struct Lines<'a> {
    reader: BufReader<&'a File>,
    line: Vec<u8>,
    end: u64,
}

impl<'a> Lines<'a> {
    fn new(file: &'a File) -> Self {
        Self {
            reader: BufReader::new(file),
            line: Vec::new(),
            end: 0,
        }
    }

    /// The next line with its line feed; none when it has no line feed.
    fn next_line(&mut self) -> io::Result<Option<&[u8]>> {
        self.line.clear();
        let length = self.reader.read_until(b'\n', &mut self.line)?;
        if self.line.last() != Some(&b'\n') {
            return Ok(None);
        }
        self.end += length as u64;
        Ok(Some(&self.line))
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::scratch::Scratch;

    fn header() -> Vec<String> {
        ["settlement [m], down +", "pressure \"p\" [Pa]"]
            .map(str::to_owned)
            .to_vec()
    }

    fn row(k: usize) -> [f64; 2] {
        [(k as f64).sqrt(), -1e3 / (k as f64 + 1.0)]
    }

    #[test]
    fn rows_are_on_disk_at_once_and_as_a_table_writes_them() {
        let scratch = Scratch::new();
        let path = scratch.path().join("grown.csv");
        let mut rows = RowWriter::create(&path, &header()).unwrap();
        let mut table = Table::new("whole", &[]);
        table.header = header();
        for k in 0..5 {
            rows.push(&row(k)).unwrap();
            table.push(row(k).to_vec());
            table.write_csv(scratch.path()).unwrap();
            let whole = fs::read(scratch.path().join("whole.csv")).unwrap();
            assert_eq!(fs::read(&path).unwrap(), whole);
        }
        rows.sync().unwrap();
        assert_eq!((rows.len(), rows.is_empty()), (5, false));
    }

    /// GOAL: a run that was killed anywhere and resumed leaves the bytes of one that was not.
    #[test]
    fn a_resumed_table_ends_byte_equal() {
        let scratch = Scratch::new();
        let (one, other) = (scratch.path().join("a.csv"), scratch.path().join("b.csv"));
        let mut rows = RowWriter::create(&one, &header()).unwrap();
        for k in 0..6 {
            rows.push(&row(k)).unwrap();
        }
        let whole = fs::read(&one).unwrap();
        let ends: Vec<usize> = (0..whole.len())
            .filter(|&k| whole[k] == b'\n')
            .map(|k| k + 1)
            .collect();
        for killed_at in 0..=whole.len() {
            let complete = ends.iter().filter(|&&end| end <= killed_at).count();
            for kept in 0..complete.max(1) {
                fs::write(&other, &whole[..killed_at]).unwrap();
                let mut rows = RowWriter::resume(&other, &header(), kept).unwrap();
                assert_eq!(rows.len(), kept);
                for k in kept..6 {
                    rows.push(&row(k)).unwrap();
                }
                assert_eq!(fs::read(&other).unwrap(), whole, "{killed_at} {kept}");
            }
        }
    }

    #[test]
    fn a_table_that_does_not_fit_is_refused() {
        let scratch = Scratch::new();
        let path = scratch.path().join("curve.csv");
        let mut rows = RowWriter::create(&path, &header()).unwrap();
        rows.push(&[1.0, 2.0]).unwrap();
        let error = RowWriter::resume(&path, &header(), 3).unwrap_err();
        insta::assert_snapshot!(
            scratch.hide(&error),
            @"cannot go on with DIR/curve.csv: it holds 1 of 3 rows"
        );
        let error = RowWriter::resume(&path, &header()[..1], 1).unwrap_err();
        insta::assert_snapshot!(
            scratch.hide(&error),
            @"cannot go on with DIR/curve.csv: its header is not the one of this case"
        );
        let missing = scratch.path().join("none.csv");
        let error = RowWriter::resume(&missing, &header(), 1).unwrap_err();
        insta::assert_snapshot!(scratch.hide(&error), @"cannot access DIR/none.csv");
    }

    #[test]
    fn a_table_is_read_back_to_the_digits_written() {
        let scratch = Scratch::new();
        let path = scratch.path().join("curve.csv");
        let mut rows = RowWriter::create(&path, &header()).unwrap();
        rows.push(&[1.0 / 3.0, f64::NAN]).unwrap();
        rows.push(&[-2.5e-30, 0.0]).unwrap();
        rows.file.write_all(b"1.0,2").unwrap();
        let table = read(&path).unwrap();
        assert_eq!((&table.name[..], &table.header), ("curve", &header()));
        assert_eq!(table.rows.len(), 2);
        table.write_csv(scratch.path()).unwrap();
        drop(rows);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.ends_with("3.333333333e-1,NaN\n-2.500000000e-30,0.000000000e0\n"));
        fs::write(&path, "a,b\n1,2\n3,x\n").unwrap();
        insta::assert_snapshot!(
            scratch.hide(&read(&path).unwrap_err()),
            @"cannot go on with DIR/curve.csv: `x` in row 2 is no number"
        );
    }
}
