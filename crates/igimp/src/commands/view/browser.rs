//! Opens the browser of the user, where there is one.

use std::process::{Command, Stdio};

/// Asks the desktop to open an address; without a desktop the address was printed, and that is all.
pub(super) fn open(address: &str) {
    let Some(mut command) = opener() else {
        return;
    };
    command
        .arg(address)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    if let Ok(mut child) = command.spawn() {
        // Some openers last as long as the browser; all are waited for, so that none is left behind.
        std::thread::spawn(move || child.wait());
    }
}

fn opener() -> Option<Command> {
    if cfg!(target_os = "windows") {
        let mut command = Command::new("rundll32");
        command.arg("url.dll,FileProtocolHandler");
        return Some(command);
    }
    if cfg!(target_os = "macos") {
        return Some(Command::new("open"));
    }
    // Without a display, `xdg-open` may take the terminal for a browser of text.
    let has_display = ["DISPLAY", "WAYLAND_DISPLAY"]
        .iter()
        .any(|name| std::env::var_os(name).is_some_and(|value| !value.is_empty()));
    has_display.then(|| Command::new("xdg-open"))
}
