use igimp_assembly::{LoadPoint, ParticleFields, ParticleSeed, Particles};
use igimp_material::{Ratios, Regime};
use serde_json::json;

use super::*;
use crate::npy::{Array, Values};
use crate::scratch::Scratch;

/// A body of `n` particles with numbers that no decimal form would keep.
pub(crate) fn body(n: usize) -> Body<2> {
    let number = |k: usize, entry: usize| ((k * 17 + entry) as f64 + 0.1).sin() * 1e-3;
    let vector = |k, first| std::array::from_fn::<f64, 2, _>(|a| number(k, first + a));
    let tensor = |k, first| {
        std::array::from_fn::<[f64; 3], 3, _>(|a| {
            std::array::from_fn(|b| number(k, first + 3 * a + b))
        })
    };
    let by_particle = |of: &dyn Fn(usize) -> f64| (0..n).map(of).collect::<Vec<f64>>();
    // Further columns are as they are seeded.
    let seed = |k: usize| ParticleSeed {
        x: [0.0; 2],
        half_length: vector(k, 26).map(f64::abs),
        volume: 1.0,
        density: 1.0,
        law: 0,
        centroid: [0.0; 2],
    };
    let seeds: Vec<_> = (0..n).map(seed).collect();
    let seeded = (*Particles::new(&seeds).unwrap()).clone();
    let fields = ParticleFields {
        x: (0..n).map(|k| vector(k, 0)).collect(),
        displacement: (0..n).map(|_| [-0.0, f64::MIN_POSITIVE / 8.0]).collect(),
        def_grad: (0..n)
            .map(|k| {
                let ([a, b], [c, d]) = (vector(k, 2), vector(k, 4));
                [[1.0 + a, b], [c, 1.0 + d]]
            })
            .collect(),
        b_e: (0..n).map(|k| tensor(k, 6)).collect(),
        sigma: (0..n).map(|k| tensor(k, 15)).collect(),
        half_length: (0..n).map(|k| vector(k, 24).map(f64::abs)).collect(),
        centroid: (0..n).map(|k| vector(k, 27).map(f64::sin)).collect(),
        volume0: by_particle(&|k| number(k, 28).abs()),
        mass: by_particle(&|k| number(k, 29).abs()),
        pore_pressure: by_particle(&|k| number(k, 45)),
        excess: by_particle(&|k| number(k, 46)),
        number: (0..n).map(|k| 2 * k + 1).collect(),
        law: (0..n).map(|k| k % 3).collect(),
        ratios: (0..n)
            .map(|k| Ratios {
                strength: number(k, 44).abs(),
                friction: number(k, 45).abs(),
                stiffness: 1.0 / 3.0,
            })
            .collect(),
        eps_p_eq: by_particle(&|k| number(k, 30)),
        internal: (0..n)
            .map(|k| std::array::from_fn(|a| number(k, 47 + a)))
            .collect(),
        regime: (0..n)
            .map(|k| [Regime::Elastic, Regime::Apex, Regime::TensionApex][k % 3])
            .collect(),
        ..seeded
    };
    let mut body = Body::new(Particles::from_fields(fields).unwrap());
    body.load_points = (1..n)
        .map(|k| LoadPoint {
            x: vector(k, 40),
            force: vector(k, 42),
            load: k,
        })
        .collect();
    body
}

pub(crate) fn meta() -> Meta {
    Meta::new(sha256(b"case"), json!({ "stage": 1, "factor": 0.1 + 0.2 }))
}

/// Every bit of a body.
fn bits(body: &Body<2>) -> Vec<Vec<u8>> {
    arrays::of_body(body)
        .iter()
        .map(|(_, array)| array.to_bytes())
        .collect()
}

fn write_one(folder: &Path, name: &str, particles: usize) -> PathBuf {
    write(folder, name, &[("current", &body(particles))], &meta(), 2).unwrap()
}

fn particles(path: &Path) -> usize {
    read::<2>(path, None).unwrap().states[0].1.particles.len()
}

#[test]
fn states_come_back_to_the_bit() {
    let scratch = Scratch::new();
    let folder = scratch.path().join("checkpoint");
    let (current, stable) = (body(7), body(1));
    let numbers = [0.1 + 0.2, 1e-310, f64::MAX, 123_456_789.123_456_79, -0.0];
    let meta = Meta::new(sha256(b""), json!(numbers));
    let states = [("current", &current), ("stable", &stable)];
    let path = write(&folder, "load-0010", &states, &meta, 3).unwrap();
    assert_eq!(path, folder.join("load-0010"));
    let back = read::<2>(&path, Some(&sha256(b""))).unwrap();
    assert_eq!(back.meta, meta);
    assert_eq!(back.states[0].0, "current");
    assert_eq!(back.states[1].0, "stable");
    assert_eq!(bits(&back.states[0].1), bits(&current));
    assert_eq!(bits(&back.states[1].1), bits(&stable));
    assert!(back.states[1].1.load_points.is_empty());
    assert_eq!(scratch.names("checkpoint"), ["load-0010"]);
}

/// ORACLE: the files on disk.
#[test]
fn in_memory_and_on_disk_are_the_same() {
    let scratch = Scratch::new();
    let (current, stable) = (body(3), body(1));
    let states = [("current", &current), ("stable", &stable)];
    let path = write(scratch.path(), "a", &states, &meta(), 1).unwrap();
    let files = to_files("a", 1, &states, &meta()).unwrap();
    assert_eq!(files.len(), 43);
    for (file, bytes) in &files {
        assert_eq!(&fs::read(path.join(file)).unwrap(), bytes, "{file}");
    }
    let back = from_files::<2>(&path, &files, None).unwrap();
    assert_eq!(back.meta, meta());
    assert_eq!(bits(&back.states[0].1), bits(&current));
    assert_eq!(bits(&back.states[1].1), bits(&stable));
    let mut files = files;
    files.remove("stable/x.npy");
    insta::assert_snapshot!(
        scratch.hide(&from_files::<2>(&path, &files, None).unwrap_err()),
        @"the checkpoint in DIR/a is damaged: stable/x.npy: there is no such file"
    );
    files.clear();
    insta::assert_snapshot!(
        scratch.hide(&from_files::<2>(&path, &files, None).unwrap_err()),
        @"DIR/a is not a checkpoint of igimp: it has no meta.json"
    );
}

/// ORACLE: FIPS 180-4 test vector.
#[test]
fn the_checksum_is_sha_256() {
    assert_eq!(
        sha256(b"abc"),
        "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    );
}

#[test]
fn the_newest_is_the_last_written() {
    let scratch = Scratch::new();
    let folder = scratch.path().join("checkpoint");
    assert_eq!(newest(&folder).unwrap(), None);
    let first = write_one(&folder, "z", 1);
    let second = write_one(&folder, "a", 2);
    fs::create_dir(folder.join("something-else")).unwrap();
    assert_eq!(newest(&folder).unwrap(), Some(second));
    assert_eq!(named(&folder, "z").unwrap(), Some(first.clone()));
    assert_eq!(named(&folder, "y").unwrap(), None);
    write_one(&folder, "z", 3);
    assert_eq!(newest(&folder).unwrap(), Some(first.clone()));
    assert_eq!(particles(&first), 3);
    assert_eq!(scratch.names("checkpoint"), ["a", "something-else", "z"]);
}

#[test]
fn a_family_is_kept_small() {
    let scratch = Scratch::new();
    for step in [5, 10, 15, 20] {
        write_one(scratch.path(), &format!("1-load-{step:04}"), 1);
        write_one(scratch.path(), &format!("2-load-{step:04}"), 1);
    }
    write_one(scratch.path(), "1-load-end", 1);
    assert_eq!(
        scratch.names(""),
        [
            "1-load-0015",
            "1-load-0020",
            "1-load-end",
            "2-load-0015",
            "2-load-0020"
        ]
    );
    let states = [("current", &body(1))];
    write(scratch.path(), "1-load-0025", &states, &meta(), 0).unwrap();
    assert!(!scratch.path().join("1-load-0020").exists());
    assert!(scratch.path().join("1-load-0025").exists());
}

#[test]
fn later_ones_are_discarded() {
    let scratch = Scratch::new();
    let middle = ["a", "b", "c"].map(|name| write_one(scratch.path(), name, 1))[1].clone();
    discard_after(&middle).unwrap();
    assert_eq!(scratch.names(""), ["a", "b"]);
    assert_eq!(newest(scratch.path()).unwrap(), Some(middle));
}

/// GOAL: wherever a write is cut off by a kill, a whole checkpoint is found and the next write
/// tidies up.
#[test]
fn a_kill_leaves_the_old_or_the_new() {
    let scratch = Scratch::new();
    let folder = scratch.path().join("checkpoint");
    let old = write_one(&folder, "end", 1);
    let previous = folder.join("end.previous");
    let temporary = folder.join(".tmp-end");

    // While the new one is written.
    fs::create_dir_all(temporary.join("current")).unwrap();
    fs::write(temporary.join("current/x.npy"), "half").unwrap();
    assert_eq!(newest(&folder).unwrap(), Some(old.clone()));
    write_one(&folder, "end", 2);
    assert_eq!(scratch.names("checkpoint"), ["end"]);

    // Between the two renames.
    let new = write_one(&scratch.path().join("other"), "end", 3);
    fs::rename(&new, &temporary).unwrap();
    fs::rename(&old, &previous).unwrap();
    assert_eq!(newest(&folder).unwrap(), Some(previous.clone()));
    assert_eq!(named(&folder, "end").unwrap(), Some(previous.clone()));
    assert_eq!(particles(&previous), 2);
    write_one(&folder, "end", 4);
    assert_eq!(scratch.names("checkpoint"), ["end"]);

    // After them, before the old one is gone.
    fs::rename(&old, &previous).unwrap();
    let latest = write_one(&folder, "last", 5);
    fs::rename(&latest, &old).unwrap();
    assert_eq!(newest(&folder).unwrap(), Some(old.clone()));
    assert_eq!(named(&folder, "end").unwrap(), Some(old.clone()));
    assert_eq!(particles(&old), 5);
    write_one(&folder, "end", 6);
    assert_eq!(scratch.names("checkpoint"), ["end"]);

    // While an old one is removed.
    fs::create_dir(folder.join(".tmp-end-removed")).unwrap();
    write_one(&folder, "next", 1);
    assert_eq!(scratch.names("checkpoint"), ["end", "next"]);
}

#[test]
fn a_damaged_one_is_passed_over() {
    let scratch = Scratch::new();
    let first = write_one(scratch.path(), "a", 1);
    let second = write_one(scratch.path(), "b", 1);
    let third = write_one(scratch.path(), "c", 1);
    fs::write(third.join("meta.json"), "{\"format\": \"igimp ch").unwrap();
    fs::write(second.join("current/x.npy"), "x").unwrap();
    assert_eq!(newest(scratch.path()).unwrap(), Some(first.clone()));
    fs::remove_file(first.join("current/mass.npy")).unwrap();
    insta::assert_snapshot!(
        scratch.hide(&newest(scratch.path()).unwrap_err()),
        @"the checkpoint in DIR/b is damaged: current/x.npy: it has 1 bytes instead of 144"
    );
}

/// GOAL: a column that no particle uses takes no file, and a checkpoint without it is read.
#[test]
fn columns_at_their_start_are_not_written() {
    let scratch = Scratch::new();
    let mut fields = (*body(2).particles).clone();
    fields.internal = vec![[0.0; _]; 2];
    let idle = Body::new(Particles::from_fields(fields).unwrap());
    let path = write(scratch.path(), "a", &[("current", &idle)], &meta(), 1).unwrap();
    assert!(!path.join("current/internal.npy").exists());
    let read = super::read::<2>(&path, None).unwrap();
    assert_eq!(*read.states[0].1.particles, *idle.particles);
}

/// GOAL: one changed, missing or further byte in any file is noticed.
#[test]
fn every_damage_is_noticed() {
    let scratch = Scratch::new();
    let path = write_one(scratch.path(), "a", 2);
    let arrays: Vec<PathBuf> = fs::read_dir(path.join("current"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    assert_eq!(arrays.len(), 21);
    for array in arrays {
        let whole = fs::read(&array).unwrap();
        let mut flipped = whole.clone();
        *flipped.last_mut().unwrap() ^= 1;
        let longer = [&whole[..], &[0]].concat();
        for bytes in [&flipped[..], &longer, &whole[1..], &[]] {
            fs::write(&array, bytes).unwrap();
            let error = read::<2>(&path, None).unwrap_err();
            assert!(matches!(error, CheckpointError::Damaged { .. }), "{error}");
        }
        fs::write(&array, whole).unwrap();
    }
    let file = path.join("meta.json");
    let whole = fs::read(&file).unwrap();
    for length in (0..whole.len() - 1).step_by(7) {
        fs::write(&file, &whole[..length]).unwrap();
        let error = read::<2>(&path, None).unwrap_err();
        assert!(matches!(error, CheckpointError::Damaged { .. }), "{error}");
    }
    for at in 0..whole.len() {
        let mut flipped = whole.clone();
        flipped[at] ^= 1;
        fs::write(&file, &flipped).unwrap();
        assert!(read::<2>(&path, None).is_err(), "byte {at}");
    }
    fs::write(&file, whole).unwrap();
    read::<2>(&path, None).unwrap();
}

/// A manifest that vouches for itself.
fn sealed(mut manifest: serde_json::Value) -> String {
    manifest["sha256"] = "".into();
    seal(&manifest.to_string())
}

/// GOAL: meta.json and arrays that agree with each other but make no body are refused.
#[test]
fn a_forged_state_is_refused() {
    let scratch = Scratch::new();
    let path = write_one(scratch.path(), "a", 2);
    let forge = |array: &str, bytes: &[u8]| {
        let file = path.join("meta.json");
        let text = fs::read(&file).unwrap();
        let mut value: serde_json::Value = serde_json::from_slice(&text).unwrap();
        value["states"][0]["files"][array] =
            json!({ "bytes": bytes.len(), "sha256": sha256(bytes) });
        fs::write(&file, sealed(value)).unwrap();
        let array = path.join("current").join(array).with_extension("npy");
        let before = fs::read(&array).unwrap();
        fs::write(&array, bytes).unwrap();
        let message = scratch.hide(&read::<2>(&path, None).unwrap_err());
        fs::write(&array, before).unwrap();
        fs::write(&file, text).unwrap();
        message
    };
    insta::assert_snapshot!(
        forge("regime", &Array::new(&[2], Values::U8(vec![0, 77])).to_bytes()),
        @"the checkpoint in DIR/a is damaged: current/regime.npy: 77 is the code of no regime"
    );
    insta::assert_snapshot!(
        forge("sigma", &Array::new(&[2], Values::F64(vec![0.0; 2])).to_bytes()),
        @"the checkpoint in DIR/a is damaged: current/sigma.npy: its shape is [2] instead of [2, 3, 3]"
    );
    insta::assert_snapshot!(
        forge("mass", &Array::new(&[2], Values::I32(vec![0; 2])).to_bytes()),
        @"the checkpoint in DIR/a is damaged: current/mass.npy: its numbers are not of type <f8"
    );
    let mut b_e = vec![0.5; 18];
    b_e[13] = f64::NAN;
    insta::assert_snapshot!(
        forge("b_e", &Array::new(&[2, 3, 3], Values::F64(b_e)).to_bytes()),
        @"the checkpoint in DIR/a is damaged: current/b_e.npy: particle 1: b_e is NaN, but must be finite"
    );
    insta::assert_snapshot!(
        forge("def_grad", &Array::new(&[2, 2, 2], Values::F64(vec![1.0; 8])).to_bytes()),
        @"the checkpoint in DIR/a is damaged: current/def_grad.npy: particle 0: det def_grad is 0, but must be positive and finite"
    );
    let force = Array::new(&[1, 2], Values::F64(vec![1.0, f64::INFINITY]));
    insta::assert_snapshot!(
        forge("load_point_force", &force.to_bytes()),
        @"the checkpoint in DIR/a is damaged: current/load_point_force.npy: load point 0 is not finite"
    );
    insta::assert_snapshot!(
        forge("law", b"no array"),
        @"the checkpoint in DIR/a is damaged: current/law.npy: this is not a .npy file"
    );
    let file = path.join("meta.json");
    let text = fs::read_to_string(&file).unwrap();
    for (from, to) in [
        ("\"current\"", "\"../a\""),
        ("\"particles\": 2", "\"particles\": 0"),
    ] {
        assert!(text.contains(from));
        let value = serde_json::from_str(&text.replace(from, to)).unwrap();
        fs::write(&file, sealed(value)).unwrap();
        let error = read::<2>(&path, None).unwrap_err();
        assert!(matches!(error, CheckpointError::Damaged { .. }), "{error}");
    }
}

#[test]
fn refusals_say_what_to_do() {
    let scratch = Scratch::new();
    let path = write_one(scratch.path(), "a", 1);
    let refusal = |expected| scratch.hide(&read::<2>(&path, expected).unwrap_err());
    insta::assert_snapshot!(
        refusal(Some("0")),
        @"the checkpoint in DIR/a belongs to another case or to other input; run without --resume and --from-stage to begin afresh"
    );
    let mut other = meta();
    other.program = "igimp 0.0.7".into();
    write::<2>(scratch.path(), "a", &[], &other, 1).unwrap();
    insta::assert_snapshot!(
        refusal(None).replace(PROGRAM, "igimp VERSION"),
        @"the checkpoint in DIR/a was written by igimp 0.0.7, and this is igimp VERSION; resume with that version, or run without --resume to begin afresh"
    );
    let file = path.join("meta.json");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(
        &file,
        text.replace("\"format_version\": 5", "\"format_version\": 6"),
    )
    .unwrap();
    insta::assert_snapshot!(
        refusal(None),
        @"the checkpoint in DIR/a has format version 6; this program reads version 5"
    );
    fs::write(&file, "{}").unwrap();
    insta::assert_snapshot!(
        refusal(None),
        @"DIR/a is not a checkpoint of igimp: its meta.json says nothing of igimp"
    );
    fs::remove_file(&file).unwrap();
    insta::assert_snapshot!(
        refusal(None),
        @"DIR/a is not a checkpoint of igimp: it has no meta.json"
    );
    let error = write::<2>(scratch.path(), "../x", &[], &meta(), 1).unwrap_err();
    insta::assert_snapshot!(
        error,
        @"`../x` cannot name a checkpoint or a state: only letters a to z, digits, `-` and `_`"
    );
}
