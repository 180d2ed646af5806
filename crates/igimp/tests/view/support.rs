//! Folders with results, views of them, and the browser that looks at them.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::PathBuf;
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

/// Elastic soil under its own weight, a frame a step.
pub(crate) const BLOCK: &str = "igimp = 1\n[case]\ntitle = \"a <b>block</b>\"\ngravity = \"9.81 m/s2\"\n\
    [grid]\ncell = \"0.5 m\"\ndomain = { x = [\"0 m\", \"2 m\"], y = [\"0 m\", \"4 m\"] }\n\
    [materials.clay]\nmodel = \"elastic\"\nunit_weight = \"18 kN/m3\"\n\
    young = \"10 MPa\"\npoisson = 0.0\n\
    [[bodies]]\nname = \"block\"\nmaterial = \"clay\"\npoints_per_cell = 4\n\
    polygon = [[\"0 m\", \"0 m\"], [\"2 m\", \"0 m\"], [\"2 m\", \"2 m\"], [\"0 m\", \"2 m\"]]\n\
    [boundaries]\nleft = \"roller\"\nright = \"roller\"\nbottom = \"fixed\"\n\
    [[stages]]\nname = \"own weight\"\ntype = \"gravity\"\nsteps = 3\n\
    [[monitors]]\nname = \"top ü\"\npoint = [\"0.875 m\", \"1.875 m\"]\nrecord = [\"displacement\", \"sigma_yy\"]\n\
    [[curves]]\nname = \"settlement\"\nx = { of = \"step\", label = \"step [-]\" }\n\
    y = { of = \"top ü.displacement\", label = \"u [m]\" }\n\
    [output]\nfolder = \"results\"\nparaview = { every = 1 }\nfigures = []\n";

/// A folder of its own for a test, gone when dropped.
pub(crate) struct Folder(pub(crate) PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("igimp-view-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        std::fs::write(path.join("case.toml"), BLOCK).unwrap();
        Self(path)
    }

    pub(crate) fn with_results(name: &str, more: &[&str]) -> Self {
        let folder = Self::new(name);
        let mut words = vec!["run", "case.toml", "--quiet", "--threads", "1"];
        words.extend(more);
        let run = folder.igimp(&words);
        let printed = String::from_utf8_lossy(&run.stderr).into_owned();
        assert!(run.status.success(), "{printed}");
        folder
    }

    pub(crate) fn igimp(&self, words: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_igimp"));
        command.args(words).current_dir(&self.0).output().unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// A view that goes on until it is dropped.
pub(crate) struct View {
    program: Child,
    pub(crate) port: u16,
    pub(crate) token: String,
}

impl View {
    pub(crate) fn of(folder: &Folder, results: &str) -> Self {
        Self::with(folder, &[results])
    }

    pub(crate) fn with(folder: &Folder, words: &[&str]) -> Self {
        let mut program = Command::new(env!("CARGO_BIN_EXE_igimp"))
            .args(["view", "--no-open"])
            .args(words)
            .current_dir(&folder.0)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let mut printed = BufReader::new(program.stdout.take().unwrap());
        printed.read_line(&mut line).unwrap();
        let rest = line.trim().strip_prefix("http://127.0.0.1:").unwrap();
        let (port, rest) = rest.split_once('/').unwrap();
        Self {
            port: port.parse().unwrap(),
            token: rest.strip_suffix('/').unwrap().to_owned(),
            program,
        }
    }

    pub(crate) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.port, self.token)
    }

    /// The whole response to bytes as they are; nothing where the connection was just cut.
    pub(crate) fn send(&self, bytes: &[u8]) -> String {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(30)))
            .unwrap();
        let _ = stream.write_all(bytes);
        let mut text = Vec::new();
        let _ = stream.read_to_end(&mut text);
        String::from_utf8(text).unwrap()
    }

    /// The status, the headers and the body of a request.
    pub(crate) fn ask(&self, method: &str, path: &str, host: &str) -> (u16, String, String) {
        let request = format!("{method} {path} HTTP/1.1\r\nHost: {host}\r\n\r\n");
        let response = self.send(request.as_bytes());
        let (head, body) = response.split_once("\r\n\r\n").unwrap();
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        (status, head.to_owned(), body.to_owned())
    }

    /// A file inside the address of the page.
    pub(crate) fn get(&self, name: &str) -> (u16, String, String) {
        let host = format!("127.0.0.1:{}", self.port);
        self.ask("GET", &format!("/{}/{name}", self.token), &host)
    }

    /// Interrupts the view as Ctrl-C does; its exit code.
    pub(crate) fn interrupt(mut self) -> Option<i32> {
        let id = self.program.id().to_string();
        let sent = Command::new("kill").args(["-INT", &id]).status();
        assert!(sent.unwrap().success());
        self.program.wait().unwrap().code()
    }
}

impl Drop for View {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

/// Elastic soil in space under its own weight.
pub(crate) const CUBE: &str = "igimp = 1\n[case]\ntitle = \"a cube\"\nanalysis = \"3d\"\ngravity = \"9.81 m/s2\"\n\
    [grid]\ncell = \"0.5 m\"\n\
    domain = { x = [\"0 m\", \"2 m\"], y = [\"0 m\", \"2 m\"], z = [\"0 m\", \"3 m\"] }\n\
    [materials.clay]\nmodel = \"elastic\"\nunit_weight = \"18 kN/m3\"\n\
    young = \"10 MPa\"\npoisson = 0.0\n\
    [[bodies]]\nname = \"cube\"\nmaterial = \"clay\"\npoints_per_cell = 8\n\
    box = { from = [\"0 m\", \"0 m\", \"0 m\"], to = [\"2 m\", \"2 m\", \"2 m\"] }\n\
    [[stages]]\nname = \"own weight\"\ntype = \"gravity\"\nsteps = 2\n\
    [output]\nfolder = \"results\"\nparaview = { every = 1 }\nfigures = [\"displacement\", \"sigma_zz\"]\n";

/// A folder with the results of a case of its own.
pub(crate) fn results_of(name: &str, case: &str, more: &[&str]) -> Folder {
    let folder = Folder::new(name);
    std::fs::write(folder.0.join("case.toml"), case).unwrap();
    let mut words = vec!["run", "case.toml", "--quiet", "--out", "results"];
    words.extend(more);
    let run = folder.igimp(&words);
    let printed = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(run.status.success(), "{printed}");
    folder
}

/// A browser without a window, if one is installed.
pub(crate) fn browser() -> Option<&'static str> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let found = names.into_iter().find(|name| {
        let version = Command::new(name).arg("--version").output();
        version.is_ok_and(|output| output.status.success())
    });
    if found.is_none() {
        println!("skipped: there is no chromium");
    }
    found
}

/// The page of a view as it stands after some seconds, opened with wishes.
pub(crate) fn looked_at(browser: &str, folder: &Folder, view: &View, wishes: &str) -> String {
    dumped(browser, folder, &format!("{}#{wishes}", view.address()), 15)
}

/// A page as it stands after so many seconds of its own clock, which does not wait for pauses.
pub(crate) fn dumped(browser: &str, folder: &Folder, address: &str, seconds: u32) -> String {
    let profile = folder.0.join("profile");
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--dump-dom"])
        .arg(format!("--virtual-time-budget={seconds}000"))
        .arg("--window-size=390,900")
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(address)
        .output()
        .unwrap();
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// An attribute of the element with an id.
pub(crate) fn attribute(page: &str, id: &str, name: &str) -> String {
    let (before, after) = page.split_once(&format!("id=\"{id}\"")).unwrap();
    let start = before.rfind('<').unwrap();
    let end = after.find('>').unwrap();
    let tag = format!("{}{}", &before[start..], &after[..end]);
    let (_, value) = tag
        .split_once(&format!(" {name}=\""))
        .unwrap_or_else(|| panic!("no {name} in {tag}"));
    value.split_once('"').unwrap().0.to_owned()
}
