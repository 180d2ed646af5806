//! A folder with the files that a case reads.

use std::fs;
use std::path::PathBuf;

use igimp_input::CaseFile;

/// A folder of its own, which is gone when the test ends.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(name: &str, files: &[(&str, &str)]) -> Self {
        let path = std::env::temp_dir().join(format!("igimp-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        let folder = Self(path);
        for (name, text) in files {
            folder.write(name, text);
        }
        folder
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).unwrap();
    }

    pub(crate) fn read(&self, text: &str) -> Result<CaseFile, String> {
        let case = self.0.join("case.toml");
        fs::write(&case, text).unwrap();
        CaseFile::read(&case, &[]).map_err(|error| error.to_string())
    }

    /// Errors, warnings and remedies, the folder's path aside.
    pub(crate) fn printed(&self, text: &str) -> String {
        let printed = match self.read(text) {
            Ok(file) => file.warnings(),
            Err(error) => error,
        };
        let lines = printed.lines().filter(|line| {
            line.starts_with("error") || line.starts_with("warning") || line.contains("= help")
        });
        let path = format!("{}/", self.0.display());
        let lines = lines.map(|line| line.trim().replace(&path, ""));
        lines.collect::<Vec<_>>().join("\n")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}
