use std::io::Read as _;

use super::*;

/// Header and content of a compressed array, read as VTK does.
fn uncompressed(text: &str) -> (Vec<u64>, Vec<u8>) {
    let numbers = |bytes: &[u8]| -> Vec<u64> {
        let (chunks, rest) = bytes.as_chunks::<8>();
        assert!(rest.is_empty());
        chunks
            .iter()
            .map(|&chunk| u64::from_le_bytes(chunk))
            .collect()
    };
    let characters = |bytes: usize| bytes.div_ceil(3) * 4;
    let count = &BASE64.decode(&text[..12]).unwrap()[..8];
    let length = characters(8 * (3 + numbers(count)[0] as usize));
    let header = numbers(&BASE64.decode(&text[..length]).unwrap());
    let blocks = BASE64.decode(&text[length..]).unwrap();
    let (mut start, mut bytes) = (0, Vec::new());
    for size in &header[3..] {
        let end = start + *size as usize;
        let before = bytes.len();
        flate2::read::ZlibDecoder::new(&blocks[start..end])
            .read_to_end(&mut bytes)
            .unwrap();
        assert!(bytes.len() - before <= BLOCK);
        start = end;
    }
    assert_eq!(start, blocks.len());
    (header, bytes)
}

#[test]
fn blocks_are_whole_but_for_the_last() {
    for (length, blocks, last) in [
        (1, 1, 1),
        (BLOCK - 1, 1, BLOCK - 1),
        (BLOCK, 1, 0),
        (BLOCK + 8, 2, 8),
        (3 * BLOCK, 3, 0),
        (3 * BLOCK + 1, 4, 1),
    ] {
        let bytes: Vec<u8> = (0..length).map(|k| (k * k / 7) as u8).collect();
        let mut text = String::new();
        push_compressed(&mut text, &bytes);
        let (header, back) = uncompressed(&text);
        assert_eq!(header[..3], [blocks, BLOCK as u64, last as u64]);
        assert_eq!(header.len() as u64, 3 + blocks);
        assert!(back == bytes);
    }
}

fn one_quad() -> UnstructuredGrid {
    UnstructuredGrid {
        points: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
        kind: CellKind::Quad,
        connectivity: vec![0, 1, 2, 3],
        point_data: Vec::new(),
        cell_data: vec![
            DataArray::scalars("a < b & \"c\" [-]", vec![1.0]),
            DataArray::symmetric(
                "sigma",
                &[[[1.0, 2.0, 3.0], [2.0, 4.0, 5.0], [3.0, 5.0, 6.0]]],
            ),
        ],
        field_data: Vec::new(),
    }
    .at_time(0.5)
}

/// The text without its numbers.
fn outline(grid: &UnstructuredGrid) -> String {
    let text = grid.to_xml();
    let tags = text.lines().filter(|line| line.starts_with('<'));
    tags.collect::<Vec<_>>().join("\n")
}

#[test]
fn the_outline_is_that_of_vtk() {
    insta::assert_snapshot!(outline(&one_quad()), @r#"
    <?xml version="1.0"?>
    <VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor">
    <UnstructuredGrid>
    <FieldData>
    <DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="binary">
    </DataArray>
    </FieldData>
    <Piece NumberOfPoints="4" NumberOfCells="1">
    <PointData>
    </PointData>
    <CellData>
    <DataArray type="Float64" Name="a &lt; b &amp; &quot;c&quot; [-]" format="binary">
    </DataArray>
    <DataArray type="Float64" Name="sigma" NumberOfComponents="6" ComponentName0="XX" ComponentName1="YY" ComponentName2="ZZ" ComponentName3="XY" ComponentName4="YZ" ComponentName5="XZ" format="binary">
    </DataArray>
    </CellData>
    <Points>
    <DataArray type="Float64" Name="Points" NumberOfComponents="3" ComponentName0="X" ComponentName1="Y" ComponentName2="Z" format="binary">
    </DataArray>
    </Points>
    <Cells>
    <DataArray type="Int64" Name="connectivity" format="binary">
    </DataArray>
    <DataArray type="Int64" Name="offsets" format="binary">
    </DataArray>
    <DataArray type="UInt8" Name="types" format="binary">
    </DataArray>
    </Cells>
    </Piece>
    </UnstructuredGrid>
    </VTKFile>
    "#);
}

#[test]
fn empty_arrays_are_text() {
    let mut grid = one_quad();
    grid.connectivity.clear();
    grid.cell_data.clear();
    let text = grid.to_xml();
    assert!(text.contains("Name=\"offsets\" format=\"ascii\">\n\n</DataArray>"));
    assert!(text.contains("NumberOfPoints=\"4\" NumberOfCells=\"0\""));
}

#[test]
#[should_panic(expected = "`q` in PointData")]
fn arrays_of_a_wrong_length_are_refused() {
    let mut grid = one_quad();
    grid.point_data = vec![DataArray::scalars("q", vec![0.0; 3])];
    let _ = grid.to_xml();
}

#[test]
#[should_panic(expected = "points that are there")]
fn cells_without_their_points_are_refused() {
    let mut grid = one_quad();
    grid.points.pop();
    let _ = grid.to_xml();
}
