//! GOAL: `igimp view` shows a results folder to the browser of this computer, and nothing of it to
//! anybody else.
//! ORACLE: the tables of the run. The page itself is tried in a headless browser where there is one.
#![cfg(unix)]

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// Elastic soil under its own weight, a frame a step.
const BLOCK: &str = "igimp = 1\n[case]\ntitle = \"a <b>block</b>\"\ngravity = \"9.81 m/s2\"\n\
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
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("igimp-view-{name}-{}", std::process::id()));
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).unwrap();
        std::fs::write(path.join("case.toml"), BLOCK).unwrap();
        Self(path)
    }

    fn with_results(name: &str, more: &[&str]) -> Self {
        let folder = Self::new(name);
        let mut words = vec!["run", "case.toml", "--quiet", "--threads", "1"];
        words.extend(more);
        let run = folder.igimp(&words);
        let said = String::from_utf8_lossy(&run.stderr).into_owned();
        assert!(run.status.success(), "{said}");
        folder
    }

    fn igimp(&self, words: &[&str]) -> Output {
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
struct View {
    program: Child,
    port: u16,
    token: String,
}

impl View {
    fn of(folder: &Folder, results: &str) -> Self {
        Self::with(folder, &[results])
    }

    fn with(folder: &Folder, words: &[&str]) -> Self {
        let mut program = Command::new(env!("CARGO_BIN_EXE_igimp"))
            .args(["view", "--no-open"])
            .args(words)
            .current_dir(&folder.0)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let mut said = BufReader::new(program.stdout.take().unwrap());
        said.read_line(&mut line).unwrap();
        let rest = line.trim().strip_prefix("http://127.0.0.1:").unwrap();
        let (port, rest) = rest.split_once('/').unwrap();
        Self {
            port: port.parse().unwrap(),
            token: rest.strip_suffix('/').unwrap().to_owned(),
            program,
        }
    }

    fn address(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.port, self.token)
    }

    /// The whole response to bytes as they are; nothing where the connection was just cut.
    fn send(&self, bytes: &[u8]) -> String {
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
    fn ask(&self, method: &str, path: &str, host: &str) -> (u16, String, String) {
        let request = format!("{method} {path} HTTP/1.1\r\nHost: {host}\r\n\r\n");
        let response = self.send(request.as_bytes());
        let (head, body) = response.split_once("\r\n\r\n").unwrap();
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        (status, head.to_owned(), body.to_owned())
    }

    /// A file inside the address of the page.
    fn get(&self, name: &str) -> (u16, String, String) {
        let host = format!("127.0.0.1:{}", self.port);
        self.ask("GET", &format!("/{}/{name}", self.token), &host)
    }

    /// Interrupts the view as Ctrl-C does; its exit code.
    fn interrupt(mut self) -> Option<i32> {
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

#[test]
fn the_page_and_the_results_are_served() {
    let folder = Folder::with_results("serves", &[]);
    let view = View::of(&folder, "results");
    let (status, head, page) = view.get("");
    assert_eq!(status, 200);
    assert!(
        page.contains("<canvas") && page.contains("class Viewer"),
        "{page}"
    );
    assert!(
        !page.contains("http://")
            || page.matches("http://").count()
                == page.matches("http://www.w3.org/2000/svg").count()
    );
    let left = [
        "NONCE",
        "/* style.css */",
        "/* viewer.js */",
        "<!-- soil.html -->",
        "/* viewer.css */",
        "/* page.js */",
    ];
    assert!(left.iter().all(|mark| !page.contains(mark)));
    for header in [
        "Content-Security-Policy: default-src 'none'; connect-src 'self'",
        "X-Content-Type-Options: nosniff",
        "Cache-Control: no-store",
        "Referrer-Policy: no-referrer",
    ] {
        assert!(head.contains(header), "{head}");
    }
    let (status, _, index) = view.get("index.json");
    assert_eq!(status, 200);
    let index: serde_json::Value = serde_json::from_str(&index).unwrap();
    assert_eq!(index["title"], "a <b>block</b>");
    assert_eq!(index["stages"][0]["moments"], 3);
    assert_eq!(
        index["stage_of_curve"]["curves/settlement.csv"],
        serde_json::Value::Null
    );
    let files = index["files"].as_object().unwrap();
    assert!(files.contains_key("monitors/top ü.csv"), "{files:?}");
    // Every file that is named is given whole, and the same as on the disk.
    for name in files.keys() {
        let address = name.replace(' ', "%20").replace('ü', "%C3%BC");
        let (status, _, text) = view.get(&address);
        assert_eq!(status, 200, "{name}");
        let disk = std::fs::read_to_string(folder.0.join("results").join(name)).unwrap();
        assert!(text == disk, "{name}");
    }
    let localhost = format!("localhost:{}", view.port);
    let path = format!("/{}/curves/settlement.csv", view.token);
    let (status, head, body) = view.ask("HEAD", &path, &localhost);
    assert_eq!((status, body.as_str()), (200, ""));
    assert!(head.contains("Content-Length: ") && !head.contains("Content-Length: 0"));
    // A frame that comes while the page is looked at.
    let frames = folder.0.join("results/paraview");
    std::fs::copy(
        frames.join("particles_0001.vtu"),
        frames.join("particles_0099.vtu"),
    )
    .unwrap();
    assert!(view.get("index.json").2.contains("particles_0099.vtu"));
    assert_eq!(view.interrupt(), Some(0));
}

/// Ways out of the results folder, and files in it that are not shown.
const NOT_SHOWN: [&str; 24] = [
    "../secret.csv",
    "curves/../../secret.csv",
    "curves/..%2f..%2fsecret.csv",
    "curves/%2e%2e/%2e%2e/secret.csv",
    "curves/%252e%252e/secret.csv",
    "curves/..%5c..%5csecret.csv",
    "curves//settlement.csv",
    "curves/./settlement.csv",
    "curves/settlement.csv%00",
    "curves/settlement.csv?x",
    "curves/link.csv",
    "curves/notes.txt",
    "curves/.hidden.csv",
    "curves/pipe.csv",
    "curves/",
    "curves",
    "monitors/top%20%C3%BC.csv",
    "case.toml",
    "summary.json",
    ".igimp",
    "checkpoint/stage-01-end/meta.json",
    "/etc/passwd",
    "%2fetc%2fpasswd",
    "%",
];

/// GOAL: no way leads to anything but the files that are shown; what is refused has no body.
#[test]
fn foreign_hosts_paths_and_methods_get_nothing() {
    let folder = Folder::with_results("refuses", &[]);
    std::fs::write(folder.0.join("secret.csv"), "secret").unwrap();
    let results = folder.0.join("results");
    std::fs::write(results.join("curves/notes.txt"), "secret").unwrap();
    std::fs::write(results.join("curves/.hidden.csv"), "secret").unwrap();
    let link = |to: &Path, name: &str| std::os::unix::fs::symlink(to, results.join(name)).unwrap();
    link(&folder.0.join("secret.csv"), "curves/link.csv");
    let _ = std::fs::rename(results.join("monitors"), folder.0.join("elsewhere"));
    link(&folder.0.join("elsewhere"), "monitors");
    let pipe = Command::new("mkfifo")
        .arg(results.join("curves/pipe.csv"))
        .status();
    assert!(pipe.unwrap().success());
    let view = View::of(&folder, "results");
    let own = format!("127.0.0.1:{}", view.port);
    let nothing = |(status, head, body): (u16, String, String), wanted: u16, what: &str| {
        assert_eq!((status, body.as_str()), (wanted, ""), "{what}");
        assert!(head.contains("Content-Length: 0"), "{what}: {head}");
    };
    let token = &view.token;
    let wrong = format!("/{}/", "0".repeat(token.len()));
    for path in [
        "/",
        "/index.json",
        "/favicon.ico",
        "//",
        &wrong,
        &format!("/{token}"),
        &format!("/{}/", &token[1..]),
    ] {
        nothing(view.ask("GET", path, &own), 404, path);
    }
    for name in NOT_SHOWN {
        nothing(view.get(name), 404, name);
    }
    let absolute = view.ask("GET", &format!("{}index.json", view.address()), &own);
    nothing(absolute, 400, "a request to a proxy");
    let page = format!("/{token}/");
    for host in [
        "example.com".to_owned(),
        format!("example.com:{}", view.port),
        format!("127.0.0.1.example.com:{}", view.port),
        "127.0.0.1".to_owned(),
        "127.0.0.1:1".to_owned(),
        format!("[::1]:{}", view.port),
    ] {
        nothing(view.ask("GET", &page, &host), 403, &host);
    }
    for method in ["POST", "PUT", "DELETE", "OPTIONS", "TRACE", "get"] {
        nothing(view.ask(method, &page, &own), 405, method);
    }
    let two = format!("GET {page} HTTP/1.1\r\nHost: {own}\r\nHost: {own}\r\n\r\n");
    for request in [
        &*two,
        &format!("GET {page} HTTP/1.1\r\n\r\n"),
        "nonsense\r\n\r\n",
    ] {
        let response = view.send(request.as_bytes());
        assert!(response.starts_with("HTTP/1.1 400 "), "{response}");
    }
    let long = format!(
        "GET /{} HTTP/1.1\r\nHost: {own}\r\n\r\n",
        "a".repeat(1 << 20)
    );
    let response = view.send(long.as_bytes());
    assert!(!response.contains("200 OK"));
    // Clients that never ask are cut off after some seconds, and keep nobody out meanwhile.
    let clock = Instant::now();
    let idle: Vec<TcpStream> = (0..12)
        .map(|_| TcpStream::connect(("127.0.0.1", view.port)).unwrap())
        .collect();
    assert_eq!(view.get("").0, 200);
    assert!(clock.elapsed() < Duration::from_secs(4));
    drop(idle);
    assert_eq!(view.interrupt(), Some(0));
}

#[test]
fn folders_without_frames_and_of_several_runs_are_told_apart() {
    let folder = Folder::with_results(
        "folders",
        &["--set", "output.paraview={ every = \"never\" }"],
    );
    let view = View::of(&folder, "results");
    let index: serde_json::Value = serde_json::from_str(&view.get("index.json").2).unwrap();
    assert_eq!(index["never"], true);
    drop(view);
    let said = |words: &[&str]| {
        let output = folder.igimp(words);
        let text = String::from_utf8(output.stderr).unwrap();
        (output.status.code().unwrap(), text)
    };
    std::fs::create_dir_all(folder.0.join("study")).unwrap();
    for name in ["mesh-2", "mesh-1"] {
        let words = [
            "run",
            "case.toml",
            "--quiet",
            "--out",
            &format!("study/{name}"),
        ];
        assert!(folder.igimp(&words).status.success());
    }
    insta::assert_snapshot!(said(&["view", "study"]).1, @r"
    error: study holds the results of several runs
      help: look at one of them:
        igimp view study/mesh-1
        igimp view study/mesh-2
    ");
    std::fs::create_dir_all(folder.0.join("empty")).unwrap();
    let (code, text) = said(&["view", "empty"]);
    assert_eq!(code, 2);
    insta::assert_snapshot!(text, @r"
    error: there are no results of a run in empty
      help: give the folder that `igimp run` names in its last line
    ");
    assert_eq!(said(&["view", "none"]).0, 4);
}

/// A browser without a window, if one is installed.
fn browser() -> Option<&'static str> {
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
fn looked_at(browser: &str, folder: &Folder, view: &View, wishes: &str) -> String {
    dumped(browser, folder, &format!("{}#{wishes}", view.address()), 15)
}

/// A page as it stands after so many seconds of its own clock, which does not wait for pauses.
fn dumped(browser: &str, folder: &Folder, address: &str, seconds: u32) -> String {
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
fn attribute(page: &str, id: &str, name: &str) -> String {
    let (before, after) = page.split_once(&format!("id=\"{id}\"")).unwrap();
    let start = before.rfind('<').unwrap();
    let end = after.find('>').unwrap();
    let tag = format!("{}{}", &before[start..], &after[..end]);
    let (_, value) = tag
        .split_once(&format!(" {name}=\""))
        .unwrap_or_else(|| panic!("no {name} in {tag}"));
    value.split_once('"').unwrap().0.to_owned()
}

/// GOAL: the page loads, the slider moves, and the value under the pointer is that of the table.
#[test]
fn the_page_works_in_a_browser() {
    let Some(browser) = browser() else {
        return;
    };
    let folder = Folder::with_results("browser", &[]);
    let table = std::fs::read_to_string(folder.0.join("results/monitors/top ü.csv")).unwrap();
    let number = |row: usize, column: usize| -> f64 {
        let line = table.lines().nth(row + 1).unwrap();
        line.split(',').nth(column).unwrap().parse().unwrap()
    };
    let view = View::of(&folder, "results");
    // The monitor stands in the middle of a particle; compression is positive in tables alone.
    // Each look starts a browser: every frame once, and both fields.
    let displacement = ("displacement%20[m],%20length", 3, 1.0);
    let stress = ("sigma%20[Pa],%20tension%20%2B,%20yy", 4, -1.0);
    for (frame, (field, column, sign)) in [
        (1, displacement),
        (2, stress),
        (3, displacement),
        (3, stress),
    ] {
        let wishes = format!("frame={frame}&field={field}&hover=0.9,1.85");
        let page = looked_at(browser, &folder, &view, &wishes);
        let value: f64 = attribute(&page, "found", "data-value").parse().unwrap();
        let expected = sign * number(frame, column);
        assert!(
            (value - expected).abs() <= 1e-6 * expected.abs(),
            "frame {frame}, {field}: {value} for {expected}"
        );
        let label = attribute(&page, "slider", "aria-valuetext");
        assert_eq!(
            label,
            format!("Frame {frame} of 4: stage 1 “own weight”, step {frame}")
        );
        assert!(
            page.contains("a &lt;b&gt;block&lt;/b&gt;"),
            "the title is text"
        );
        // The cursor of curve and monitor is on the row of the frame.
        assert_eq!(page.matches(&format!("data-row=\"{frame}\"")).count(), 3);
    }
    // Played from the first frame to the last, with the particle that was pointed at.
    let page = looked_at(browser, &folder, &view, "frame=1&hover=0.9,1.85&play=1");
    assert!(attribute(&page, "slider", "aria-valuetext").starts_with("Frame 4 of 4"));
    let value: f64 = attribute(&page, "found", "data-value").parse().unwrap();
    assert!((value - number(3, 3)).abs() <= 1e-6 * number(3, 3));
}

/// GOAL: rigid bodies are drawn as their frames have them, with their histories beside; tables of contact
/// along their sides are no histories.
#[test]
fn rigid_bodies_are_drawn_where_they_stand() {
    let Some(browser) = browser() else {
        return;
    };
    let folder = Folder::new("bodies");
    let case = include_str!("../../igimp-cases/tests/data/two_bodies.toml");
    std::fs::write(folder.0.join("case.toml"), case).unwrap();
    let run = folder.igimp(&["run", "case.toml", "--quiet", "--out", "results"]);
    assert!(run.status.success());
    let view = View::of(&folder, "results");
    for frame in [1, 3] {
        let name = format!("results/paraview/rigid_{frame:04}.vtu");
        let text = std::fs::read_to_string(folder.0.join(name)).unwrap();
        let page = looked_at(browser, &folder, &view, &format!("frame={frame}"));
        let lines = attribute(&page, "canvas", "data-lines");
        assert!(
            text.contains(&format!("NumberOfCells=\"{lines}\"")),
            "{lines}"
        );
        assert_eq!(lines == "0", frame == 1);
        assert!(page.contains("footing: ") && !page.contains("__3-load"));
    }
}

/// GOAL: frames that come while the page is looked at are taken up.
#[test]
fn the_page_follows_a_run() {
    let Some(browser) = browser() else {
        return;
    };
    let folder = Folder::with_results("live", &[]);
    let view = View::of(&folder, "results");
    let frames = folder.0.join("results/paraview");
    let page = std::thread::scope(|scope| {
        // A thousand questions for new frames, which take longer than the pause below.
        let page = scope.spawn(|| dumped(browser, &folder, &view.address(), 2000));
        std::thread::sleep(Duration::from_millis(1500));
        std::fs::copy(
            frames.join("particles_0001.vtu"),
            frames.join("particles_0005.vtu"),
        )
        .unwrap();
        let collection = frames.join("particles.pvd");
        let text = std::fs::read_to_string(&collection).unwrap();
        let line = "<DataSet timestep=\"4\" group=\"\" part=\"0\" file=\"particles_0005.vtu\"/>\n";
        let text = text.replace("</Collection>", &format!("{line}</Collection>"));
        std::fs::write(collection, text).unwrap();
        page.join().unwrap()
    });
    let label = attribute(&page, "slider", "aria-valuetext");
    assert!(label.starts_with("Frame 5 of 5"), "{label}");
}

#[test]
fn the_page_says_how_to_get_frames() {
    let Some(browser) = browser() else {
        return;
    };
    let folder = Folder::with_results(
        "no-frames",
        &["--set", "output.paraview={ every = \"never\" }"],
    );
    let view = View::of(&folder, "results");
    let page = looked_at(browser, &folder, &view, "");
    assert!(page.contains("This run writes no frames"), "{page}");
    assert!(
        page.contains("class=\"curve\""),
        "the curves are there all the same"
    );
}

/// GOAL: a report holds its frames, unless the last cannot be read or its file is a link.
#[test]
fn a_report_holds_its_frames() {
    let folder = Folder::with_results("report", &[]);
    let results = folder.0.join("results");
    let report = || {
        assert!(folder.igimp(&["report", "results"]).status.success());
        std::fs::read_to_string(results.join("report.html")).unwrap()
    };
    let frame = results.join("paraview/particles_0004.vtu");
    let text = std::fs::read_to_string(&frame).unwrap();
    let page = report();
    assert_eq!(page.matches("class=\"held-frame\"").count(), 4);
    assert!(page.contains("data-label=\"Frame 4 of 4, after "));
    if let Some(browser) = browser() {
        let address = format!("file://{}#soil", results.join("report.html").display());
        let page = dumped(browser, &folder, &address, 15);
        assert!(page.contains("<p id=\"bar-label\" class=\"soft\">displacement length [mm]</p>"));
        let (_, ticks) = page.split_once("id=\"ticks\">").unwrap();
        assert!(ticks.starts_with("<span"), "the scale was drawn");
    }
    // A name that would end the script is a text within it.
    let name = "Name=\"mass [kg/m]\"";
    let other = text.replace(
        name,
        "Name=\"&lt;/SCRIPT&gt;&lt;script&gt;alert(1)&lt;/script&gt;\"",
    );
    assert_ne!(text, other);
    std::fs::write(&frame, other).unwrap();
    let page = report();
    assert!(page.contains("\\u003c/SCRIPT>\\u003cscript>alert") && !page.contains("<script>alert"));
    std::fs::write(&frame, " ".repeat(3_100_000)).unwrap();
    assert!(!report().contains("A closer look"));
    std::fs::remove_file(&frame).unwrap();
    std::os::unix::fs::symlink(folder.0.join("case.toml"), &frame).unwrap();
    assert!(!report().contains("A closer look"));
}

/// GOAL: a frame is packed for the page, and only frames are.
#[test]
fn frames_are_packed_for_the_page() {
    let folder = Folder::with_results("packed", &[]);
    let view = View::of(&folder, "results");
    let (status, _, text) = view.get("packed/paraview/particles_0002.vtu");
    assert_eq!(status, 200);
    let frame: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(
        (&frame["dimension"], &frame["kind"]),
        (&2.into(), &"boxes".into())
    );
    for name in [
        "packed/paraview/particles.pvd",
        "packed/monitors/top%20%C3%BC.csv",
        "packed/../case.toml",
        "packed/",
    ] {
        assert_eq!(view.get(name).0, 404, "{name}");
    }
}

/// Elastic soil in space under its own weight.
const CUBE: &str = "igimp = 1\n[case]\ntitle = \"a cube\"\nanalysis = \"3d\"\ngravity = \"9.81 m/s2\"\n\
    [grid]\ncell = \"0.5 m\"\n\
    domain = { x = [\"0 m\", \"2 m\"], y = [\"0 m\", \"2 m\"], z = [\"0 m\", \"3 m\"] }\n\
    [materials.clay]\nmodel = \"elastic\"\nunit_weight = \"18 kN/m3\"\n\
    young = \"10 MPa\"\npoisson = 0.0\n\
    [[bodies]]\nname = \"cube\"\nmaterial = \"clay\"\npoints_per_cell = 8\n\
    box = { from = [\"0 m\", \"0 m\", \"0 m\"], to = [\"2 m\", \"2 m\", \"2 m\"] }\n\
    [[stages]]\nname = \"own weight\"\ntype = \"gravity\"\nsteps = 2\n\
    [output]\nfolder = \"results\"\nparaview = { every = 1 }\nfigures = [\"displacement\", \"sigma_zz\"]\n";

/// GOAL: a run in space has its pictures, and its page shows the six sides of the body and cuts it.
/// ORACLE: 8³ particles have 6 · 8² faces outside; the level of a particle in the middle settles by γ (H z − z²/2) / E.
#[test]
fn a_run_in_space_is_shown() {
    let folder = Folder::new("space");
    std::fs::write(folder.0.join("case.toml"), CUBE).unwrap();
    let cuts =
        "output.cuts=[{ across = \"y\", at = \"0.6 m\" }, { across = \"z\", at = \"1.1 m\" }]";
    let run = folder.igimp(&["run", "case.toml", "--quiet", "--set", cuts]);
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(run.status.success(), "{said}");
    let figures = folder.0.join("results/figures");
    for field in ["displacement", "sigma_zz"] {
        for what in ["space", "cut-y", "cut-z"] {
            let name = format!("{what}-1-own-weight-{field}.png");
            assert!(figures.join(&name).is_file(), "{name}");
        }
    }
    let report = std::fs::read_to_string(folder.0.join("results/report.html")).unwrap();
    assert!(report.contains("in the plane z = 1.1 m: the domains that it crosses."));
    assert_eq!(report.matches("class=\"held-frame\"").count(), 3);
    let Some(browser) = browser() else {
        return;
    };
    let view = View::of(&folder, "results");
    let page = looked_at(
        browser,
        &folder,
        &view,
        "cut=1,0.55&view=front&hover=0.5,0.5",
    );
    assert_eq!(attribute(&page, "canvas", "data-faces"), "384");
    // A plane that dips by 45° through the middle of the cube crosses it in a rectangle of 2 m by 2√2 m.
    let slanted = looked_at(browser, &folder, &view, "cut=3,0.5,1,0,45&view=front");
    if attribute(&slanted, "canvas", "data-by") == "webgl2" {
        let area = attribute(&slanted, "canvas", "data-cut-area");
        let area: f64 = area.parse().unwrap();
        assert!((area - 4.0 * 2.0_f64.sqrt()).abs() < 0.01 * area, "{area}");
    }
    // From half of the scale on, which runs from the lowest layer's 1 − (15/16)² to the highest one's 1 − (1/16)²: z/H > 0.34, the upper
    // five of eight layers.
    let upper = looked_at(browser, &folder, &view, "least=50");
    assert_eq!(attribute(&upper, "canvas", "data-particles"), "320");
    assert_eq!(attribute(&upper, "canvas", "data-faces"), "3072");
    let value: f64 = attribute(&page, "found", "data-value").parse().unwrap();
    let (_, text) = page.split_once("m: displacement length ").unwrap();
    let z: f64 = page
        .split_once(") m: displacement")
        .unwrap()
        .0
        .rsplit(", ")
        .next()
        .unwrap()
        .parse()
        .unwrap();
    let settled = 18e3 * (2.0 * z - 0.5 * z * z) / 10e6;
    assert!(
        (value - settled).abs() < 0.02 * settled,
        "{value} for {settled}: {text:.20}"
    );
}

/// Elastic soil that falls freely under 10 m/s², by Newmark's method, which is exact there; a frame every 0.1 s.
const FALL: &str = "igimp = 1\n[case]\ntitle = \"a fall\"\ngravity = \"10 m/s2\"\n\
    [grid]\ncell = \"1 m\"\ndomain = { x = [\"0 m\", \"4 m\"], y = [\"0 m\", \"8 m\"] }\n\
    [materials.clay]\nmodel = \"elastic\"\nunit_weight = \"20 kN/m3\"\nyoung = \"10 MPa\"\npoisson = 0.3\n\
    [[bodies]]\nname = \"block\"\nmaterial = \"clay\"\npoints_per_cell = 4\n\
    polygon = [[\"1 m\", \"4 m\"], [\"3 m\", \"4 m\"], [\"3 m\", \"6 m\"], [\"1 m\", \"6 m\"]]\n\
    [[stages]]\nname = \"fall\"\ntype = \"dynamic\"\nduration = \"0.4 s\"\nscheme = \"newmark\"\nsteps = 4\n\
    [output]\nfolder = \"results\"\nfigures = [\"speed\"]\n";

/// A folder with the results of a case of its own.
fn results_of(name: &str, case: &str, more: &[&str]) -> Folder {
    let folder = Folder::new(name);
    std::fs::write(folder.0.join("case.toml"), case).unwrap();
    let mut words = vec!["run", "case.toml", "--quiet", "--out", "results"];
    words.extend(more);
    let run = folder.igimp(&words);
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(run.status.success(), "{said}");
    folder
}

/// GOAL: frames of a motion say their times and have its fields, on the page and in the report; the report draws the energy.
/// ORACLE: a body that falls freely has the speed g t.
#[test]
fn a_motion_is_shown_with_its_times() {
    let folder = results_of("motion", FALL, &[]);
    let report = std::fs::read_to_string(folder.0.join("results/report.html")).unwrap();
    for (frame, time) in [(1, "0"), (3, "0.2"), (5, "0.4")] {
        let label = format!("data-label=\"Frame {frame} of 5, t = {time} s, stage “fall”\"");
        assert!(report.contains(&label), "{label}");
    }
    assert!(report.contains("data-seconds=\"0.4\""));
    assert!(report.contains("Energy of stage “fall” over time"));
    assert!(report.contains("Speed |v| at the end of stage “fall”, at t = 0.4 s."));
    let Some(browser) = browser() else {
        return;
    };
    let view = View::of(&folder, "results");
    for (frame, seconds) in [(1, 0.0), (3, 0.2), (5, 0.4)] {
        let wishes = format!(
            "frame={frame}&field=velocity%20[m/s],%20length&hover=2.1,{}&arrows=velocity%20[m/s]",
            5.1 - 5.0 * seconds * seconds
        );
        let page = looked_at(browser, &folder, &view, &wishes);
        let value: f64 = attribute(&page, "found", "data-value").parse().unwrap();
        assert!(
            (value - 10.0 * seconds).abs() < 1e-5,
            "{value} at {seconds} s"
        );
        let label = attribute(&page, "slider", "aria-valuetext");
        assert!(
            label.starts_with(&format!("Frame {frame} of 5: t = {seconds} s, ")),
            "{label}"
        );
        assert!(
            page.contains(">speed [m/s]<"),
            "the length of a velocity has its name"
        );
        assert_eq!(attribute(&page, "canvas", "data-pieces"), "16");
        if seconds > 0.0 {
            assert!(
                attribute(&page, "canvas", "data-arrows")
                    .parse::<usize>()
                    .unwrap()
                    > 10
            );
        }
    }
    // Four seconds or more at first: 0.4 s are shown ten times slower.
    let page = looked_at(browser, &folder, &view, "frame=1&play=1");
    assert!(!page.contains("id=\"pace-label\" hidden"));
    assert!(attribute(&page, "slider", "aria-valuetext").starts_with("Frame 5 of 5"));
}

/// GOAL: a section across a body has the stress of its weight; the edges of the body are drawn.
/// ORACLE: γ times the depth, within half a particle of 0.25 m.
#[test]
fn a_section_is_drawn_by_hand() {
    let Some(browser) = browser() else {
        return;
    };
    let folder = Folder::with_results("section", &[]);
    let view = View::of(&folder, "results");
    let field = "sigma%20[Pa],%20tension%20%2B,%20yy";
    let wishes = format!("frame=3&field={field}&section=1.1,1.7,1.1,0.3");
    let page = looked_at(browser, &folder, &view, &wishes);
    for (end, depth) in [("data-first", 0.3), ("data-last", 1.7)] {
        let value: f64 = attribute(&page, "section", end).parse().unwrap();
        assert!(
            (value + 18e3 * depth).abs() < 0.5 * 0.25 * 18e3,
            "{end}: {value}"
        );
    }
    assert_eq!(attribute(&page, "section", "data-places"), "201");
    assert_eq!(attribute(&page, "canvas", "data-edges"), "1");
    assert!(page.contains("sigma yy [kPa], tension + along A–B, from (1.1, 1.7) to (1.1, 0.3) m"));
}

/// GOAL: a run that ends with a search opens on the way in which the body fails, with the nails where they are.
#[test]
fn a_search_opens_on_its_mechanism() {
    let Some(browser) = browser() else {
        return;
    };
    let case = include_str!("../../igimp-input/cases/nailed_cut.toml");
    let folder = results_of(
        "mechanism",
        case,
        &[
            "--set",
            "grid.cell=0.5 m",
            "--set",
            "checks.0.between=[1, 2]",
        ],
    );
    let view = View::of(&folder, "results");
    let page = looked_at(browser, &folder, &view, "");
    let label = attribute(&page, "slider", "aria-valuetext");
    assert!(label.starts_with("factor of safety: "), "{label}");
    let bars: usize = attribute(&page, "canvas", "data-members").parse().unwrap();
    assert!(bars > 10, "{bars}");
    let page = looked_at(browser, &folder, &view, "frame=1");
    assert!(attribute(&page, "slider", "aria-valuetext").starts_with("Frame 1 of "));
}

/// GOAL: the water table of a stage is drawn over its frames.
#[test]
fn water_tables_are_drawn() {
    let water = "[[water]]\nname = \"table\"\nline = [[\"0 m\", \"1 m\"], [\"2 m\", \"1.5 m\"]]\n[boundaries]";
    let case = BLOCK.replace("[boundaries]", water);
    let folder = results_of("water", &case, &[]);
    let view = View::of(&folder, "results");
    let index: serde_json::Value = serde_json::from_str(&view.get("index.json").2).unwrap();
    assert_eq!(
        index["water"],
        serde_json::json!([[[[0.0, 1.0], [2.0, 1.5]]]])
    );
    let Some(browser) = browser() else {
        return;
    };
    let page = looked_at(browser, &folder, &view, "frame=2");
    assert_eq!(attribute(&page, "canvas", "data-water"), "1");
}

/// GOAL: in space the free surface of a computed flow is drawn over its frames, and stands out where the cut meets it.
/// ORACLE: a pond over the cube stands at its level throughout.
#[test]
fn water_in_space_is_drawn() {
    let case = CUBE
        .replace("unit_weight = \"18 kN/m3\"", "unit_weight = \"18 kN/m3\"\nsaturated_unit_weight = \"20 kN/m3\"\npermeability = \"1e-6 m/s\"")
        .replace("[[stages]]", "[[water]]\nname = \"pool\"\n[water.seepage]\nfree_water = [[\"0 m\", \"2.5 m\"], [\"2 m\", \"2.5 m\"]]\n\n[[stages]]")
        .replace("figures = [\"displacement\", \"sigma_zz\"]", "figures = []");
    let folder = results_of("water-in-space", &case, &[]);
    let view = View::of(&folder, "results");
    let index: serde_json::Value = serde_json::from_str(&view.get("index.json").2).unwrap();
    let surface = &index["water"][0][0];
    let places = serde_json::json!([0.0, 0.5, 1.0, 1.5, 2.0]);
    assert_eq!((&surface["x"], &surface["y"]), (&places, &places));
    let levels: Vec<f64> = (surface["z"].as_array().unwrap().iter())
        .flat_map(|row| row.as_array().unwrap())
        .filter_map(serde_json::Value::as_f64)
        .collect();
    assert_eq!(levels.len(), 25);
    let off = |level: &f64| (level - 2.5).abs();
    assert!(levels.iter().all(|level| off(level) < 1e-6), "{levels:?}");
    let Some(browser) = browser() else {
        return;
    };
    let page = looked_at(browser, &folder, &view, "frame=2&cut=1,0.55");
    assert_eq!(attribute(&page, "canvas", "data-water"), "1");
    let met: usize = attribute(&page, "canvas", "data-water-cut")
        .parse()
        .unwrap();
    assert!(met >= 4, "{met}");
}

/// GOAL: two runs stand side by side, each with its own files, and what is chosen in the first is chosen in the second.
/// ORACLE: the third of four frames, of both.
#[test]
fn two_runs_stand_side_by_side() {
    let folder = Folder::with_results("beside", &[]);
    let softer = ["--set", "materials.clay.young=5 MPa", "--out", "softer"];
    let run = folder.igimp(&[&["run", "case.toml", "--quiet"], &softer[..]].concat());
    assert!(run.status.success());
    let view = View::with(&folder, &["results", "--beside", "softer"]);
    let (status, head, page) = view.get("");
    assert_eq!(status, 200);
    assert!(head.contains("frame-src 'self'") && head.contains("frame-ancestors 'none'"));
    assert!(!page.contains("NONCE"));
    for (run, name) in [(1, "results"), (2, "softer")] {
        let (_, head, _) = view.get(&format!("{run}/"));
        assert!(head.contains("frame-ancestors 'self'"), "{head}");
        let index = view.get(&format!("{run}/index.json")).2;
        let index: serde_json::Value = serde_json::from_str(&index).unwrap();
        assert_eq!(index["folder"], name);
        assert_eq!(view.get(&format!("{run}/curves/settlement.csv")).0, 200);
    }
    for name in [
        "index.json",
        "3/index.json",
        "1/../2/index.json",
        "curves/settlement.csv",
    ] {
        assert_eq!(view.get(name).0, 404, "{name}");
    }
    let Some(browser) = browser() else {
        return;
    };
    let page = looked_at(browser, &folder, &view, "frame=3");
    for run in ["data-run1", "data-run2"] {
        let (_, label) = page.split_once(&format!("{run}=\"")).unwrap();
        assert!(label.starts_with("Frame 3 of 4"), "{label:.40}");
    }
}
