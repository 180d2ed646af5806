//! Job files of schedulers: a batch script for Slurm, a job file for HyperQueue.

use std::fmt::Write as _;
use std::path::PathBuf;

use igimp_estimate::{readable, time};
use igimp_report::pictures::file_name;
use igimp_results::atomic::write_whole;
use igimp_schema::syntax::toml_text;
use igimp_text::on_a_line;

use super::{Resources, Sweep, SweepError, Task};

/// Most tasks of an array of Slurm: its `MaxArraySize` is 1001 where nobody changed it, and numbers stay below that.
const ARRAY: usize = 1000;
/// A task is asked to end so long before its time is up, and saves what it has \[s\].
const NOTICE: u32 = 120;

/// The command that a scheduler starts, quoted for a shell.
#[derive(Clone, Debug)]
pub struct Words {
    /// The program.
    pub program: String,
    /// The sweep file, as seen from where the tasks run.
    pub sweep: String,
    /// The folder where the tasks run.
    pub folder: PathBuf,
    /// Ranks of a task; with more than one the program is `igimp-mpi`.
    pub ranks: usize,
}

impl Words {
    /// Lines for `sbatch` on where a task runs, and on how it is asked to end; and the words that start its program.
    fn of_slurm(&self, threads: usize) -> [String; 3] {
        let ranks = self.ranks;
        if ranks == 1 {
            return [
                format!("--nodes=1 --ntasks=1 --cpus-per-task={threads}"),
                format!("--signal=B:TERM@{NOTICE}"),
                String::new(),
            ];
        }
        // Without B the signal is for the ranks: the first ends the run, the others wait for it.
        [
            format!("--ntasks={ranks} --cpus-per-task={threads}"),
            format!("--signal=TERM@{NOTICE}"),
            "srun --mpi=pmix --cpu-bind=none --kill-on-bad-exit=1 ".to_owned(),
        ]
    }
}

/// A file for a scheduler.
#[derive(Clone, Debug)]
pub struct Script {
    /// Where it was written.
    pub path: PathBuf,
    /// The commands that submit it, as the words before and after the path; several if one array cannot hold all tasks.
    pub submit: Vec<[String; 2]>,
}

impl Sweep {
    /// Writes `slurm.sh` into the folder of all tasks: an array job of these tasks.
    ///
    /// # Errors
    /// [`SweepError::Case`] if it cannot be written.
    pub fn write_slurm(
        &self,
        tasks: &[&Task],
        demand: &Resources,
        words: &Words,
    ) -> Result<Script, SweepError> {
        let path = self.folder.join("slurm.sh");
        let arrays = arrays(tasks);
        let [first, ..] = &arrays[..] else {
            return Ok(Script {
                path,
                submit: Vec::new(),
            });
        };
        let folder = quoted_directive(&words.folder.display().to_string());
        let outputs = words.folder.join(&self.folder).join("slurm-%A_%a.out");
        let outputs = outputs.display().to_string();
        // A percent sign of the folder itself is written twice.
        let (before, name) = outputs.split_at(outputs.len() - "slurm-%A_%a.out".len());
        let outputs = quoted_directive(&(before.replace('%', "%%") + name));
        let mut text = String::from("#!/bin/sh\n");
        text += &self.head(demand);
        let minutes = demand.minutes();
        let [place, signal, starter] = words.of_slurm(demand.threads);
        let _ = write!(
            text,
            "#SBATCH --job-name={}\n#SBATCH --array={}\n#SBATCH {place}\n\
             #SBATCH --mem={}M\n#SBATCH --time={minutes}\n\
             # Before its time is up the task is asked to end, and saves what it has.\n\
             #SBATCH {signal}\n\
             # What a lost node ran is put into the queue again.\n#SBATCH --requeue --open-mode=append\n\
             #SBATCH --chdir={folder}\n#SBATCH --output={outputs}\n\
             exec {starter}{} run {} --task $((${{1:-{}}} + SLURM_ARRAY_TASK_ID)) --resume --threads {} --quiet\n",
            self.name(),
            first.1,
            demand.mebibytes(),
            words.program,
            words.sweep,
            first.0,
            demand.threads,
        );
        write_whole(&path, text)?;
        let alone = arrays.len() == 1;
        let submit = arrays.iter().map(|(offset, numbers)| {
            if alone {
                ["sbatch".to_owned(), String::new()]
            } else {
                [format!("sbatch --array={numbers}"), format!(" {offset}")]
            }
        });
        Ok(Script {
            path,
            submit: submit.collect(),
        })
    }

    /// Writes `hyperqueue.toml` into the folder of all tasks: a job of these tasks.
    ///
    /// # Errors
    /// [`SweepError::Case`] if it cannot be written.
    pub fn write_hyperqueue(
        &self,
        tasks: &[&Task],
        demand: &Resources,
        words: &Words,
    ) -> Result<Script, SweepError> {
        let path = self.folder.join("hyperqueue.toml");
        let log = |end: &str| {
            let log = format!("hyperqueue-%{{TASK_ID}}.{end}");
            let log = words.folder.join(&self.folder).join(log);
            toml_text::quoted(&log.display().to_string())
        };
        let command = format!(
            "exec {} run {} --task \"$HQ_TASK_ID\" --resume --threads {} --quiet",
            words.program, words.sweep, demand.threads
        );
        let text = format!(
            "{}name = {}\n\n[[array]]\nids = \"{}\"\ncwd = {}\n\
             command = [\"/bin/sh\", \"-c\", {}]\nstdout = {}\nstderr = {}\n\n\
             [[array.request]]\nresources = {{ \"cpus\" = {}, \"mem\" = {} }}\ntime_request = \"{}m\"\n",
            self.head(demand),
            toml_text::quoted(&self.name()),
            numbers(tasks),
            toml_text::quoted(&words.folder.display().to_string()),
            toml_text::quoted(&command),
            log("out"),
            log("err"),
            demand.threads,
            demand.mebibytes(),
            demand.minutes(),
        );
        write_whole(&path, text)?;
        Ok(Script {
            path,
            submit: vec![["hq job submit-file".to_owned(), String::new()]],
        })
    }

    /// Comments on the origin of a file, and on the resources that it asks for.
    fn head(&self, demand: &Resources) -> String {
        let file = self.file.display().to_string();
        format!(
            "# Tasks of {} that were not done when this was written. A task that is done by now is left\n\
             # alone, and one that was stopped goes on where it was: this may be submitted again.\n\
             # Memory: 1.5 times the estimate of task {}, {}. Time: 5 min and 3 times the estimate of\n\
             # task {}, {} on the computer that wrote this.\n",
            on_a_line(&file),
            demand.memory.task,
            readable(demand.memory.estimate),
            demand.time.task,
            time::readable(demand.time.estimate),
        )
    }

    fn name(&self) -> String {
        let stem = self.file.file_stem().unwrap_or_default();
        file_name(&stem.to_string_lossy())
    }
}

/// Numbers of tasks as schedulers read them: `1-4,7`.
pub fn numbers(tasks: &[&Task]) -> String {
    ranges(tasks.iter().map(|task| task.number))
}

fn ranges(numbers: impl Iterator<Item = usize>) -> String {
    let mut ranges: Vec<[usize; 2]> = Vec::new();
    for number in numbers {
        match ranges.last_mut() {
            Some([_, last]) if *last + 1 == number => *last = number,
            _ => ranges.push([number, number]),
        }
    }
    let texts = ranges.iter().map(|[first, last]| {
        if first == last {
            first.to_string()
        } else {
            format!("{first}-{last}")
        }
    });
    texts.collect::<Vec<_>>().join(",")
}

/// Chunks of a Slurm array: the index offset and the index list of each.
fn arrays(tasks: &[&Task]) -> Vec<(usize, String)> {
    let offset = |task: &&Task| (task.number - 1) / ARRAY * ARRAY;
    let groups = tasks.chunk_by(|a, b| offset(a) == offset(b));
    let arrays = groups.map(|group| {
        let offset = offset(&group[0]);
        (
            offset,
            ranges(group.iter().map(|task| task.number - offset)),
        )
    });
    arrays.collect()
}

/// A value of a line for `sbatch`, which knows quotes and backslashes.
fn quoted_directive(text: &str) -> String {
    let escaped = on_a_line(text).replace('\\', "\\\\").replace('"', "\\\"");
    format!("\"{escaped}\"")
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn task(number: usize) -> Task {
        Task {
            number,
            values: Vec::new(),
            settings: Vec::new(),
            folder: Path::new("study").join(number.to_string()),
        }
    }

    #[test]
    fn numbers_are_ranges() {
        let tasks = [1, 2, 3, 5, 7, 8].map(task);
        let tasks: Vec<&Task> = tasks.iter().collect();
        assert_eq!(numbers(&tasks), "1-3,5,7-8");
        assert_eq!(numbers(&[]), "");
    }

    #[test]
    fn an_array_has_no_number_beyond_those_of_slurm() {
        let tasks = [999, 1000, 1001, 1003, 2500].map(task);
        let tasks: Vec<&Task> = tasks.iter().collect();
        assert_eq!(
            arrays(&tasks),
            [
                (0, "999-1000".to_owned()),
                (1000, "1,3".to_owned()),
                (2000, "500".to_owned())
            ]
        );
    }

    #[test]
    fn several_ranks_are_started_and_asked_to_end_together() {
        let words = |ranks| Words {
            program: String::new(),
            sweep: String::new(),
            folder: PathBuf::new(),
            ranks,
        };
        let [place, signal, starter] = words(4).of_slurm(2);
        assert_eq!(place, "--ntasks=4 --cpus-per-task=2");
        assert_eq!(signal, "--signal=TERM@120");
        assert!(starter.starts_with("srun "), "{starter}");
        assert_eq!(words(1).of_slurm(2)[2], "");
    }

    #[test]
    fn a_directive_keeps_blanks_and_quotes() {
        assert_eq!(quoted_directive("/a b"), "\"/a b\"");
        assert_eq!(quoted_directive("/a\"b\\"), "\"/a\\\"b\\\\\"");
    }
}
