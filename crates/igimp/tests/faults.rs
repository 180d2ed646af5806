//! GOAL: faults of users and machines cost time and no result: a signal at any moment, a full
//! disk, a folder that cannot be written, file times that make no sense, another number of threads.
//! CASE: a coarse slope under gravity, its factor of safety, and its run-out.
//! ORACLE: every byte of the same run left alone, times aside.

mod run_support;

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant, SystemTime};

use run_support::{Folder, differing};

/// Interruptions by a signal in a test run; `IGIMP_KILLS` asks for more.
const KILLS: usize = 6;

/// Random numbers in \[0, 1) (Vigna's splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((bits ^ (bits >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Whether a checkpoint is being written into a results folder.
fn is_writing(out: &Path) -> bool {
    let entries = fs::read_dir(out.join("checkpoint"));
    entries.into_iter().flatten().flatten().any(|entry| {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        name.starts_with(".tmp-") && !name.ends_with("-removed")
    })
}

/// Whether a process that was started is still there.
fn lives(child: &mut Child) -> bool {
    child.try_wait().unwrap().is_none()
}

/// How a run is interrupted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Signal {
    Kill,
    Int,
    Term,
    Hup,
}

impl Signal {
    fn send(self, child: &mut Child) {
        let word = match self {
            Self::Kill => return child.kill().unwrap(),
            Self::Int => "-INT",
            Self::Term => "-TERM",
            Self::Hup => "-HUP",
        };
        // The process may have ended by itself meanwhile.
        let _ = Command::new("kill")
            .args([word, &child.id().to_string()])
            .stderr(Stdio::null())
            .status();
    }
}

/// Interrupts a run after a time, or at its next write of a checkpoint from then on; whether it was
/// alive then, and how it ended.
fn interrupt(
    child: &mut Child,
    signal: Signal,
    after: Duration,
    at_write: Option<&Path>,
) -> (bool, ExitStatus) {
    let clock = Instant::now();
    while clock.elapsed() < after && lives(child) {
        std::thread::sleep(Duration::from_micros(200));
    }
    if let Some(out) = at_write {
        while lives(child) && !is_writing(out) {
            std::hint::spin_loop();
        }
    }
    let alive = lives(child);
    signal.send(child);
    (alive, child.wait().unwrap())
}

/// Interrupts runs at random moments; all of them have to end with the files of one that was left alone.
fn interrupted_runs_end_with_the_same_files(signal: Signal, least: usize) {
    let folder = Folder::new(&format!("interrupted-{signal:?}"));
    let clock = Instant::now();
    let (code, printed) = folder.end("whole", &[]);
    let mut whole = clock.elapsed();
    assert_eq!(code, Some(0), "{printed}");
    let expected = folder.everything("whole");
    assert!(folder.tables("whole").len() >= 4, "{:?}", expected.keys());
    let wanted = std::env::var("IGIMP_KILLS").map_or(least, |kills| kills.parse().unwrap());
    let mut random = Random(0x5EED + signal as u64);
    let (mut kills, mut within_a_write, mut twice, mut runs) = (0, 0, 0, 0);
    while kills < wanted {
        assert!(runs < 10 * wanted, "{kills} interruptions in {runs} runs");
        let out = format!("interrupted-{runs}");
        let path = folder.0.join(&out);
        let mut hits = 0;
        // Interrupted twice on its way: the second time while it goes on.
        for more in [&[][..], &["--resume"]] {
            let mut child = folder.run(&out, more).spawn().unwrap();
            let moment = whole.mul_f64(random.next());
            let at_write = (random.next() < 0.5).then_some(&*path);
            let clock = Instant::now();
            let (alive, status) = interrupt(&mut child, signal, moment, at_write);
            if !alive && more.is_empty() {
                // The computer has become quicker since the time of a whole run was taken.
                whole = whole.min(clock.elapsed());
            }
            hits += usize::from(alive);
            within_a_write += usize::from(is_writing(&path));
            if signal != Signal::Kill {
                // No code: the signal came before the program had begun.
                let code = status.code();
                assert!(matches!(code, Some(0 | 3) | None), "run {runs}: {status}");
                assert!(!is_writing(&path), "run {runs}: a checkpoint in part");
                if code.is_none() {
                    assert!(!path.join("convergence.csv").exists(), "run {runs}: killed");
                }
            }
        }
        runs += 1;
        kills += hits;
        twice += usize::from(hits == 2);
        let (code, printed) = folder.end(&out, &["--resume"]);
        assert_eq!(code, Some(0), "run {runs}: {printed}");
        let found = folder.everything(&out);
        assert_eq!(
            differing(&expected, &found),
            Vec::<PathBuf>::new(),
            "run {runs}"
        );
        fs::remove_dir_all(&path).unwrap();
    }
    println!(
        "{signal:?}: {kills} interruptions of living processes in {runs} runs, {twice} runs interrupted \
         twice, {within_a_write} within the writing of a checkpoint: all files equal"
    );
}

#[test]
fn a_run_killed_at_any_moment_ends_with_the_same_files() {
    interrupted_runs_end_with_the_same_files(Signal::Kill, KILLS);
}

#[cfg(unix)]
#[test]
fn a_run_with_a_signal_saves_and_goes_on_to_the_same_files() {
    for signal in [Signal::Int, Signal::Term, Signal::Hup] {
        interrupted_runs_end_with_the_same_files(signal, KILLS / 3);
    }
}

/// A terminal that is closed sends its signal more than once.
#[cfg(unix)]
#[test]
fn a_signal_that_comes_twice_at_once_does_not_keep_a_run_from_saving() {
    let folder = Folder::new("twice");
    let mut child = folder.run("out", &[]).spawn().unwrap();
    while lives(&mut child) && !folder.0.join("out/checkpoint/stage-01-end").exists() {
        std::thread::sleep(Duration::from_millis(1));
    }
    Signal::Hup.send(&mut child);
    Signal::Term.send(&mut child);
    assert_eq!(child.wait().unwrap().code(), Some(3));
}

#[test]
fn a_run_killed_after_the_step_that_ends_its_stage_does_not_take_another() {
    let folder = Folder::new("killed-at-rest");
    let every_step = ["--set", "output.checkpoint.every=1"];
    let (code, printed) = folder.end("run", &every_step);
    assert_eq!(code, Some(0), "{printed}");
    let expected = folder.everything("run");
    let checkpoints = folder.0.join("run/checkpoint");
    fs::remove_dir_all(checkpoints.join("stage-03-end")).unwrap();
    let left = fs::read_dir(&checkpoints).unwrap().flatten();
    let steps = left.filter(|entry| entry.file_name().to_string_lossy().starts_with("step-"));
    assert!(steps.count() > 0, "the step at which the slope rests");
    let (code, printed) = folder.end("run", &[&every_step[..], &["--resume"]].concat());
    assert_eq!(code, Some(0), "{printed}");
    assert_eq!(
        differing(&expected, &folder.everything("run")),
        Vec::<PathBuf>::new()
    );
}

#[test]
fn threads_do_not_change_a_byte() {
    let folder = Folder::new("threads");
    let run = |threads: &str| {
        let out = format!("on-{threads}");
        let (code, printed) = folder.end(&out, &["--threads", threads]);
        assert_eq!(code, Some(0), "{printed}");
        folder.everything(&out)
    };
    let one = run("1");
    let arrays = one
        .keys()
        .filter(|path| path.extension().is_some_and(|e| e == "npy"));
    assert!(arrays.count() >= 45, "the ends of three stages");
    for threads in ["2", "3", "7"] {
        assert_eq!(
            differing(&one, &run(threads)),
            Vec::<PathBuf>::new(),
            "{threads} threads"
        );
    }
}

/// Sets the times of a file or folder and of all below it.
fn set_times(path: &Path, time: SystemTime) {
    if path.is_dir() {
        for entry in fs::read_dir(path).unwrap() {
            set_times(&entry.unwrap().path(), time);
        }
    }
    File::open(path)
        .and_then(|file| file.set_modified(time))
        .unwrap();
}

/// A clock that jumped leaves files from the future or from long ago, in an order that is not that in
/// which they were written.
#[test]
fn file_times_that_make_no_sense_change_nothing() {
    let folder = Folder::new("clock");
    let (code, printed) = folder.end("whole", &[]);
    assert_eq!(code, Some(0), "{printed}");
    let expected = folder.everything("whole");
    let saved = |out: &str| {
        let mut saved: Vec<PathBuf> = fs::read_dir(folder.0.join(out).join("checkpoint"))
            .into_iter()
            .flatten()
            .map(|entry| entry.unwrap().path())
            .collect();
        saved.sort();
        saved
    };
    for backwards in [true, false] {
        let out = format!("jumped-{backwards}");
        let mut child = folder.run(&out, &[]).spawn().unwrap();
        while lives(&mut child) && saved(&out).len() < 4 {
            std::thread::sleep(Duration::from_micros(500));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        let (past, future) = (SystemTime::UNIX_EPOCH, Duration::from_secs(4_000_000_000));
        let everything = if backwards { past } else { past + future };
        set_times(&folder.0.join(&out), everything);
        for (age, path) in saved(&out).iter().rev().enumerate() {
            let years = Duration::from_secs(31_557_600 * (1 + age as u64));
            set_times(
                path,
                if backwards {
                    past + years
                } else {
                    past + future - years
                },
            );
        }
        let (code, printed) = folder.end(&out, &["--resume"]);
        assert_eq!(code, Some(0), "{printed}");
        let found = folder.everything(&out);
        assert_eq!(differing(&expected, &found), Vec::<PathBuf>::new());
    }
}

/// Runs a script as `sh` in a mount namespace of its own, where the system allows that; its standard
/// output. `$0` is the program.
#[cfg(target_os = "linux")]
fn with_mounts(folder: &Folder, script: &str) -> Option<String> {
    let unshared = |words: &[&str]| {
        let mut command = Command::new("unshare");
        command
            .args(["-m", "--"])
            .args(words)
            .current_dir(&folder.0);
        command.output()
    };
    let can = unshared(&[
        "sh",
        "-c",
        "mkdir -p probe && mount -t tmpfs -o size=64k tmpfs probe",
    ]);
    if !can.is_ok_and(|output| output.status.success()) {
        println!("skipped: no mounts without being root");
        return None;
    }
    let output = unshared(&["sh", "-c", script, env!("CARGO_BIN_EXE_igimp")]).unwrap();
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{printed}{errors}");
    Some(printed)
}

/// The words of a run as a shell reads them.
fn quoted(out: &str, more: &[&str]) -> String {
    format!(" '{}'", Folder::words(out, more).join("' '"))
}

/// A disk that runs full at some moment, and is then made larger.
#[cfg(target_os = "linux")]
#[test]
fn a_run_on_a_full_disk_goes_on_when_there_is_room() {
    let folder = Folder::new("full-disk");
    let (code, printed) = folder.end("whole", &[]);
    assert_eq!(code, Some(0), "{printed}");
    let expected = folder.everything("whole");
    let (afresh, resumed) = (quoted("disk/out", &[]), quoted("disk/out", &["--resume"]));
    let mut full = 0;
    for size in ["100k", "300k", "600k", "1000k", "1500k"] {
        let script = format!(
            "mkdir -p disk copy-{size} && mount -t tmpfs -o size={size} tmpfs disk || exit 9\n\
             \"$0\"{afresh} 2>&1; echo \"code $?\"\n\
             mount -o remount,size=200m disk || exit 9\n\
             \"$0\"{resumed} 2>&1 || exit 8\n\
             cp -r disk/out copy-{size}/"
        );
        let Some(printed) = with_mounts(&folder, &script) else {
            return;
        };
        if printed.contains("code 4") {
            full += 1;
            assert!(
                printed.contains("cannot ") && printed.contains(" disk/out/"),
                "{printed}"
            );
            assert!(
                printed.contains("because: No space left on device"),
                "{printed}"
            );
        } else {
            assert!(printed.contains("code 0"), "{printed}");
        }
        let found = folder.everything(&format!("copy-{size}/out"));
        assert_eq!(
            differing(&expected, &found),
            Vec::<PathBuf>::new(),
            "{size}"
        );
    }
    assert!(full >= 3, "the disk was full {full} times");
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_that_cannot_be_written_is_named_before_anything_is_computed() {
    let folder = Folder::new("read-only");
    for out in ["/proc/results", "slope.toml/results"] {
        let (code, printed) = folder.end(out, &[]);
        assert_eq!(code, Some(4), "{printed}");
        assert!(
            printed.starts_with(&format!("error: cannot access {out}")),
            "{printed}"
        );
        assert!(printed.contains("because: "), "{printed}");
    }
    let (code, printed) = folder.end("kept/out", &[]);
    assert_eq!(code, Some(0), "{printed}");
    let before = folder.everything("kept/out");
    let script = format!(
        "mount --bind kept kept && mount -o remount,ro,bind kept || exit 9\n\
         \"$0\"{} 2>&1; echo \"code $?\"\n\"$0\"{} 2>&1; echo \"code $?\"\n\
         \"$0\"{} 2>&1; echo \"code $?\"",
        quoted("kept/out", &[]),
        quoted("kept/out", &["--resume"]),
        quoted("kept/new", &[])
    );
    let Some(printed) = with_mounts(&folder, &script) else {
        return;
    };
    assert_eq!(printed.matches("code 4").count(), 3, "{printed}");
    assert_eq!(
        printed.matches("error: cannot access kept/").count(),
        3,
        "{printed}"
    );
    assert_eq!(
        printed.matches("because: Read-only file system").count(),
        3,
        "{printed}"
    );
    assert_eq!(
        differing(&before, &folder.everything("kept/out")),
        Vec::<PathBuf>::new()
    );
}
