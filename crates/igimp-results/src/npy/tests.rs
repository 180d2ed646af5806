use proptest::prelude::*;

use super::*;
use crate::scratch::Scratch;

/// A file with a header as given.
fn file(header: &str, numbers: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(numbers);
    bytes
}

fn message(bytes: &[u8]) -> String {
    Array::from_bytes(bytes).unwrap_err().to_string()
}

/// ORACLE: what `numpy.save` 2.4 writes for `numpy.array([[1.5, -2], [3, 4]])`.
#[test]
fn bytes_are_those_of_numpy() {
    let array = Array::new(&[2, 2], Values::F64(vec![1.5, -2.0, 3.0, 4.0]));
    let mut expected = b"\x93NUMPY\x01\x00v\x00\
        {'descr': '<f8', 'fortran_order': False, 'shape': (2, 2), }"
        .to_vec();
    expected.resize(127, b' ');
    expected.push(b'\n');
    for value in [1.5_f64, -2.0, 3.0, 4.0] {
        expected.extend(value.to_le_bytes());
    }
    assert_eq!(array.to_bytes(), expected);
}

#[test]
fn arrays_come_back() {
    let scratch = Scratch::new();
    let path = scratch.path().join("a.npy");
    let extremes = vec![f64::MIN_POSITIVE / 4.0, -0.0, f64::MAX, f64::NEG_INFINITY];
    for array in [
        Array::new(&[4], Values::F64(extremes)),
        Array::new(&[0, 2], Values::F64(Vec::new())),
        Array::new(&[], Values::I32(vec![-7])),
        Array::new(&[2, 1, 2], Values::I32(vec![i32::MIN, -1, 0, i32::MAX])),
        Array::new(&[1, 2], Values::U64(vec![0, u64::MAX])),
        Array::new(&[3], Values::U8(vec![0, 9, 255])),
    ] {
        array.write(&path).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!(
            (bytes.len() - array.values().to_bytes().len()) % 64,
            0,
            "the numbers are aligned"
        );
        let back = Array::read(&path).unwrap();
        assert_eq!(back, array);
        assert_eq!(back.to_bytes(), bytes);
    }
}

#[test]
fn other_spellings_of_a_header_are_understood() {
    let expected = Array::new(&[3], Values::U8(vec![1, 2, 3]));
    for header in [
        "{'shape': (3,), 'fortran_order': False, 'descr': '|u1'}",
        "{\"descr\":\"|u1\",\"fortran_order\":False,\"shape\":(3,)}\n",
        " { 'descr' : '|u1' , 'fortran_order' : False , 'shape' : ( 3 , ) , } ",
    ] {
        assert_eq!(
            Array::from_bytes(&file(header, &[1, 2, 3])).unwrap(),
            expected
        );
    }
}

#[test]
fn what_is_not_understood_is_refused() {
    insta::assert_snapshot!(message(b"PK\x03\x04"), @"this is not a .npy file");
    insta::assert_snapshot!(
        message(b"\x93NUMPY\x02\x00"),
        @"format version 2.0; only 1.0 is read"
    );
    insta::assert_snapshot!(
        message(b"\x93NUMPY\x01\x00\xff\xff{"),
        @"the file ends within its header"
    );
    insta::assert_snapshot!(
        message(&file("{'descr': '>f4', 'fortran_order': False, 'shape': (1,), }", &[0; 4])),
        @"numbers of type `>f4`; only `<f8`, `<u8`, `<i4` and `|u1` are read"
    );
    insta::assert_snapshot!(
        message(&file("{'descr': '<f8', 'fortran_order': True, 'shape': (1,), }", &[0; 8])),
        @"the array is in Fortran order; save numpy.ascontiguousarray(a) instead"
    );
    insta::assert_snapshot!(
        message(&file("{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2), }", &[0; 40])),
        @"the shape [3, 2] does not fit the 40 bytes of numbers"
    );
}

#[test]
fn absurd_headers_are_refused_without_reserving_memory() {
    let huge = "{'descr': '<f8', 'fortran_order': False, 'shape': (4611686018427387904, 4), }";
    let zero = "{'descr': '<f8', 'fortran_order': False, 'shape': (9223372036854775807, 0, 0), }";
    for header in [huge, zero] {
        assert!(matches!(
            Array::from_bytes(&file(header, &[])),
            Err(NpyError::Length { .. })
        ));
    }
    let many = format!(
        "{{'descr': '<f8', 'fortran_order': False, 'shape': ({}), }}",
        "1,".repeat(65)
    );
    for header in [
        "",
        "{",
        "{}",
        "{'descr': '<f8', 'fortran_order': False}",
        "{'descr': '<f8', 'fortran_order': 0, 'shape': ()}",
        "{'descr': '<f8', 'descr': '<f8', 'fortran_order': False, 'shape': ()}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1L,)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (-1,)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': 1}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': ()} x",
        "{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': ()}",
        "{'a': __import__('os'), 'fortran_order': False, 'shape': ()}",
        many.as_str(),
    ] {
        let error = Array::from_bytes(&file(header, &[0; 8])).unwrap_err();
        assert!(
            matches!(error, NpyError::Header { .. }),
            "{header}: {error}"
        );
    }
}

#[test]
fn a_file_is_named() {
    let scratch = Scratch::new();
    let path = scratch.path().join("x.npy");
    std::fs::write(&path, "no").unwrap();
    let error = Array::read(&path).unwrap_err();
    insta::assert_snapshot!(scratch.hide(&error), @"cannot read the array DIR/x.npy");
}

proptest! {
    /// GOAL: no bytes make the reader panic.
    #[test]
    fn random_bytes_are_refused(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        prop_assert!(Array::from_bytes(&bytes).is_err());
        let mut headed = b"\x93NUMPY\x01\x00".to_vec();
        headed.extend(&bytes);
        prop_assert!(Array::from_bytes(&headed).is_err());
    }

    /// GOAL: a damaged file is refused or is another array of the same bytes, without a panic.
    #[test]
    fn damaged_files_do_no_harm(
        values in prop::collection::vec(any::<i32>(), 0..20),
        place in 0_usize..200,
        byte in any::<u8>(),
        cut in 0_usize..220,
    ) {
        let mut bytes = Array::new(&[values.len()], Values::I32(values)).to_bytes();
        let end = bytes.len();
        if cut < end {
            prop_assert!(Array::from_bytes(&bytes[..cut]).is_err());
        }
        bytes[place % end] = byte;
        let _ = Array::from_bytes(&bytes);
        let _ = Array::from_bytes(&bytes[..cut.min(end)]);
    }

    /// GOAL: headers of random symbols of the format do not make the reader panic.
    #[test]
    fn random_headers_are_read_or_refused(header in "[{}()':, 0-9a-zA-Z<|]{0,80}") {
        let _ = Array::from_bytes(&file(&header, &[0; 8]));
    }

    #[test]
    fn random_arrays_come_back(
        rows in 0_usize..7,
        columns in 0_usize..4,
        seed in any::<u64>(),
    ) {
        let values = (0..rows * columns).map(|k| f64::from_bits(
            (seed ^ k as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15)
        )).collect();
        let array = Array::new(&[rows, columns], Values::F64(values));
        let back = Array::from_bytes(&array.to_bytes()).unwrap();
        prop_assert_eq!(back.shape(), &[rows, columns]);
        prop_assert_eq!(back.to_bytes(), array.to_bytes());
    }
}
