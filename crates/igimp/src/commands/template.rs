//! `igimp new`.

use igimp_input::shipped::{SHIPPED, find, nearest};
use igimp_study::narration::table;

use crate::arguments::New;
use crate::error::{Exit, ProgramError};
use crate::output;

pub(crate) fn new(arguments: &New) -> Result<Exit, ProgramError> {
    let Some(name) = arguments.template.as_deref().filter(|_| !arguments.list) else {
        output::print(&format!("{}\nigimp new NAME > NAME.toml\n", list()))?;
        return Ok(Exit::Done);
    };
    let Some(shipped) = find(name) else {
        let near =
            nearest(name).map_or_else(String::new, |near| format!("did you mean `{near}`?\n"));
        return Err(ProgramError::usage(
            format!("there is no template `{name}`"),
            near + list().trim_end(),
        ));
    };
    output::print(shipped.text)?;
    Ok(Exit::Done)
}

/// The templates, a line each.
fn list() -> String {
    let rows: Vec<Vec<String>> = SHIPPED
        .iter()
        .map(|case| vec![case.name.to_owned(), case.summary.to_owned()])
        .collect();
    format!("templates:\n{}", table(&rows))
}
