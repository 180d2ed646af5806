//! Shows a run as it goes: a bar of the whole run on a terminal, lines elsewhere, nothing when quiet.

use std::io::IsTerminal;
use std::time::Duration;

use igimp_cases::run::{Event, Listener};
use igimp_model::AnyCase;
use igimp_study::narration::lines::{self, Lines};
use igimp_study::narration::progress::Whole;
use igimp_text::{on_a_line, on_lines};
use indicatif::{ProgressBar, ProgressStyle};

use crate::output;

/// Positions of the bar.
const LENGTH: u64 = 1000;
const TEMPLATE: &str = "{prefix}  [{bar:24}] {percent:>3} %  {wide_msg} eta {eta}";

/// Shows a run.
#[derive(Debug)]
pub(crate) enum Progress {
    /// Nothing is shown.
    Quiet,
    /// One line a step on standard output.
    Plain(Lines),
    /// A bar on standard error; the lines of stages and trials above it.
    Bar(ProgressBar, Lines, Whole),
}

impl Progress {
    /// The way that suits where the output goes.
    pub(crate) fn new(quiet: bool, case: &AnyCase) -> Self {
        if quiet {
            Self::Quiet
        } else if std::io::stdout().is_terminal() && std::io::stderr().is_terminal() {
            let bar = ProgressBar::new(LENGTH);
            if let Ok(style) = ProgressStyle::with_template(TEMPLATE) {
                bar.set_style(style.progress_chars("=> "));
            }
            bar.enable_steady_tick(Duration::from_secs(1));
            Self::Bar(bar, Lines::default(), Whole::of(case))
        } else {
            Self::Plain(Lines::default())
        }
    }

    /// Takes the bar away, so that the verdict stands alone.
    pub(crate) fn finish(&self) {
        if let Self::Bar(bar, ..) = self {
            bar.finish_and_clear();
        }
    }
}

impl<const D: usize> Listener<D> for Progress {
    fn on_event(&mut self, event: &Event<'_, D>) {
        match self {
            Self::Quiet => {}
            Self::Plain(lines) => {
                if let Some(line) = lines.line(event) {
                    // A log that cannot be written any more does not end the run.
                    let _ = output::say(&line);
                }
            }
            Self::Bar(bar, lines, whole) => {
                show(bar, lines, event);
                bar.set_position((whole.after(event) * LENGTH as f64) as u64);
            }
        }
    }
}

fn show<const D: usize>(bar: &ProgressBar, lines: &mut Lines, event: &Event<'_, D>) {
    let line = lines.line(event);
    match event {
        Event::Step {
            number,
            progress,
            report,
        } => {
            let text = lines::step(*number, lines.steps, *progress, report);
            bar.set_message(on_a_line(&text).into_owned());
        }
        Event::Cut { error } => {
            let text = format!("smaller step: {}", error.failure);
            bar.set_message(on_a_line(&text).into_owned());
        }
        _ => {
            if let Some(line) = line {
                bar.println(on_lines(&line));
            }
        }
    }
    if let Event::StageStarted {
        stage, of, name, ..
    } = event
    {
        let text = format!("{}/{of} {name}", stage + 1);
        bar.set_prefix(on_a_line(&text).into_owned());
        bar.set_message("");
    }
}
