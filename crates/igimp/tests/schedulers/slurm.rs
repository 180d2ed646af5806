//! A real Slurm of one node, started for a test on the loopback: an array job, one task of it killed, one stopped by
//! its time limit, and the rest submitted again. Tasks of several ranks in the same way, one rank of them killed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::study::{Study, is_there, printed, wait};

/// Controller, node daemon and munge in a folder, ended when dropped.
struct Slurm {
    folder: PathBuf,
}

impl Slurm {
    /// A Slurm, if one is asked for and there; `needs` says why.
    fn asked_for(needs: &str) -> Option<Self> {
        let programs = ["slurmctld", "slurmd", "sbatch", "munged"];
        let is_asked = std::env::var_os("IGIMP_SLURM").is_some();
        if is_asked && programs.iter().all(|name| is_there(name)) {
            return Some(Self::start(
                Path::new(env!("CARGO_TARGET_TMPDIR")).join("slurm"),
            ));
        }
        println!(
            "skipped: IGIMP_SLURM=1 with slurmctld, slurmd, sbatch and munged runs it ({needs})"
        );
        None
    }

    fn start(folder: PathBuf) -> Self {
        let _ = fs::remove_dir_all(&folder);
        for part in ["state", "spool", "munge"] {
            fs::create_dir_all(folder.join(part)).unwrap();
        }
        let slurm = Self { folder };
        let text = |line: &str| {
            let output = Command::new("sh").args(["-c", line]).output().unwrap();
            String::from_utf8(output.stdout).unwrap().trim().to_owned()
        };
        let (host, user) = (text("hostname -s"), text("id -un"));
        let at = slurm.folder.display();
        let conf = format!(
            "ClusterName=one\nSlurmctldHost={host}(127.0.0.1)\nSlurmUser={user}\nSlurmdUser={user}\n\
             AuthType=auth/munge\nAuthInfo=socket={at}/munge/socket\n\
             SlurmctldPort=16817\nSlurmdPort=16818\n\
             StateSaveLocation={at}/state\nSlurmdSpoolDir={at}/spool\n\
             SlurmctldPidFile={at}/slurmctld.pid\nSlurmdPidFile={at}/slurmd.pid\n\
             SlurmctldLogFile={at}/slurmctld.log\nSlurmdLogFile={at}/slurmd.log\n\
             ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\nSwitchType=switch/none\nMpiDefault=none\n\
             ReturnToService=2\nMinJobAge=3600\nSchedulerParameters=batch_sched_delay=1,sched_interval=2\n\
             SelectType=select/cons_tres\nSelectTypeParameters=CR_Core_Memory\n\
             JobAcctGatherType=jobacct_gather/none\nAccountingStorageType=accounting_storage/none\n\
             NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=2000 State=UNKNOWN\n\
             PartitionName=all Nodes={host} Default=YES MaxTime=INFINITE State=UP\n"
        );
        fs::write(slurm.folder.join("slurm.conf"), conf).unwrap();
        let munge = slurm.folder.join("munge");
        let munge = munge.display();
        let started = text(&format!(
            "chmod 700 {munge}; head -c 1024 /dev/urandom > {munge}/key; chmod 600 {munge}/key; \
             munged --force --key-file={munge}/key --socket={munge}/socket --log-file={munge}/log \
             --pid-file={munge}/pid --seed-file={munge}/seed && echo started"
        ));
        assert_eq!(started, "started", "munged");
        for daemon in [&["slurmctld", "-c"][..], &["slurmd"]] {
            let conf = slurm.folder.join("slurm.conf");
            let output = Command::new(daemon[0])
                .args(&daemon[1..])
                .arg("-f")
                .arg(conf)
                .output()
                .unwrap();
            assert!(output.status.success(), "{daemon:?}: {}", printed(&output));
        }
        wait("idle node", || {
            slurm.says(&["sinfo", "-h", "-o", "%t"]).contains("idle")
        });
        slurm
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(words[0]);
        command.args(&words[1..]);
        command.env("SLURM_CONF", self.folder.join("slurm.conf"));
        command
    }

    fn says(&self, words: &[&str]) -> String {
        printed(&self.command(words).output().unwrap())
    }

    /// Submits from the folder of a study; the number of the job.
    ///
    /// Tasks find programs in the folder that `IGIMP_MPI` names, if it names one.
    fn submit(&self, study: &Study, more: &[&str]) -> String {
        let mut words = vec!["sbatch", "--parsable"];
        words.extend(more);
        words.push("out/slurm.sh");
        let mut command = self.command(&words);
        let path = std::env::var_os("PATH").unwrap_or_default();
        let folders = std::env::var_os("IGIMP_MPI").map(PathBuf::from).into_iter();
        let path = std::env::join_paths(folders.chain(std::env::split_paths(&path))).unwrap();
        command.env("PATH", path).current_dir(&study.folder.0);
        let output: Output = command.output().unwrap();
        assert!(output.status.success(), "{}", printed(&output));
        String::from_utf8(output.stdout).unwrap().trim().to_owned()
    }

    fn wait_until_empty(&self) {
        wait("end of the jobs", || {
            self.says(&["squeue", "-h"]).trim().is_empty()
        });
    }

    /// State and exit code of a task of an array, as the controller remembers them.
    fn end_of(&self, job: &str, task: usize) -> String {
        let text = self.says(&["scontrol", "show", "job", &format!("{job}_{task}")]);
        let of = |name: &str| {
            let mut words = text.split_whitespace();
            let found = words.find_map(|word| word.strip_prefix(name));
            found.unwrap_or_default().to_owned()
        };
        format!("{} {}", of("JobState="), of("ExitCode="))
    }
}

impl Drop for Slurm {
    fn drop(&mut self) {
        for pid in ["slurmd.pid", "slurmctld.pid", "munge/pid"] {
            if let Ok(number) = fs::read_to_string(self.folder.join(pid)) {
                let _ = Command::new("kill").arg(number.trim()).status();
            }
        }
    }
}

#[test]
fn an_array_of_slurm_loses_nothing() {
    let Some(slurm) = Slurm::asked_for("four minutes") else {
        return;
    };
    // The last takes longer than its time limit.
    let steps = [300, 4000, 300, 30_000];
    let study = Study::new("slurm with blanks", steps);
    let output = study.igimp(&["sweep", "study.toml", "--to", "slurm"]);
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    // A minute is the least that Slurm knows; of the notice it is late or early by half of that.
    let job = slurm.submit(&study, &["--time=1", "--signal=B:TERM@5"]);
    study.wait_for_push(2);
    let killed = slurm.says(&["scancel", "--signal=KILL", "--batch", &format!("{job}_2")]);
    assert_eq!(killed, "");
    study.wait_for_push(4);
    let first_stages = [2, 4].map(|task| study.first_stage_of(task));
    slurm.wait_until_empty();
    assert_eq!(slurm.end_of(&job, 1), "COMPLETED 0:0");
    assert_eq!(slurm.end_of(&job, 2), "FAILED 0:9");
    assert_eq!(slurm.end_of(&job, 3), "COMPLETED 0:0");
    assert_eq!(slurm.end_of(&job, 4), "FAILED 3:0");
    let output = study.igimp(&["collect", "study.toml"]);
    let text = printed(&output);
    assert!(
        text.contains("running") && text.contains("interrupted"),
        "{text}"
    );
    let output = study.igimp(&["sweep", "study.toml", "--to", "slurm"]);
    let text = printed(&output);
    assert!(
        text.starts_with("2 of 4 tasks are not done: 2,4\n"),
        "{text}"
    );
    // Submitted twice by mistake: tasks begun twice are computed once.
    let jobs = [slurm.submit(&study, &[]), slurm.submit(&study, &[])];
    slurm.wait_until_empty();
    for job in &jobs {
        for task in [2, 4] {
            assert_eq!(slurm.end_of(job, task), "COMPLETED 0:0");
        }
    }
    assert_eq!([2, 4].map(|task| study.first_stage_of(task)), first_stages);
    study.is_as(&Study::left_alone("slurm-alone", steps));
}

/// The displacement that a monitor of a task ends with \[m\].
fn end_of_monitor(study: &Study, task: usize) -> f64 {
    let path = study.path(&format!("out/task-{task:04}/monitors/top.csv"));
    let text = fs::read_to_string(path).unwrap();
    let last = text.lines().last().unwrap().rsplit(',').next();
    last.unwrap().parse().unwrap()
}

// GOAL: tasks of several ranks end as those of one, though a rank is killed and another is asked to end.
// ORACLE: `igimp sweep` left alone, to 1e-9 of a displacement with ten digits.
#[test]
fn tasks_of_several_ranks_lose_nothing() {
    if std::env::var_os("IGIMP_MPI").is_none() {
        println!(
            "skipped: IGIMP_MPI, the folder of igimp-mpi, and IGIMP_SLURM=1 run it (two minutes)"
        );
        return;
    }
    let Some(slurm) = Slurm::asked_for("two minutes") else {
        return;
    };
    let steps = [60, 2000, 60, 4000];
    let study = Study::new("slurm-ranks", steps);
    let to_slurm = ["sweep", "study.toml", "--to", "slurm", "--ranks", "2"];
    let output = study.igimp(&to_slurm);
    assert_eq!(output.status.code(), Some(0), "{}", printed(&output));
    let job = slurm.submit(&study, &[]);
    study.wait_for_push(2);
    let second = "igimp-mpi run study.toml --task 2 ";
    let killed = Command::new("pkill")
        .args(["-KILL", "-n", "-f", second])
        .status();
    assert!(killed.unwrap().success());
    study.wait_for_push(4);
    // The signal of Slurm to the ranks before their time is up.
    let asked = slurm.says(&["scancel", "--signal=TERM", &format!("{job}_4")]);
    assert_eq!(asked, "");
    slurm.wait_until_empty();
    assert_eq!(slurm.end_of(&job, 1), "COMPLETED 0:0");
    assert!(
        slurm.end_of(&job, 2).starts_with("FAILED 1"),
        "{}",
        slurm.end_of(&job, 2)
    );
    assert_eq!(slurm.end_of(&job, 3), "COMPLETED 0:0");
    assert_eq!(slurm.end_of(&job, 4), "FAILED 3:0");
    let first_stages = [2, 4].map(|task| study.first_stage_of(task));
    let output = study.igimp(&to_slurm);
    assert!(printed(&output).starts_with("2 of 4 tasks are not done: 2,4\n"));
    let job = slurm.submit(&study, &[]);
    slurm.wait_until_empty();
    for task in [2, 4] {
        assert_eq!(slurm.end_of(&job, task), "COMPLETED 0:0");
    }
    assert_eq!([2, 4].map(|task| study.first_stage_of(task)), first_stages);
    let alone = Study::left_alone("slurm-ranks-alone", steps);
    for task in 1..=4 {
        let [a, b] = [&study, &alone].map(|study| end_of_monitor(study, task));
        assert!((a / b - 1.0).abs() < 1e-9, "{task}: {a} {b}");
    }
}
