//! GOAL: the server gives away the page and the files that it shows, and nothing else.
//! ORACLE: the files on the disk.

use std::net::TcpStream;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use crate::support::{Folder, View};

/// GOAL: a run in statics that states nothing of frames is a film in the view. CASE: a block under its weight in twelve steps.
/// ORACLE: a frame for each step, the last at the end of the stage; with `every = "stage"` that one alone.
#[test]
fn a_run_is_a_film_without_a_key() {
    let served = |name: &str, every: &str| -> Vec<String> {
        let frames = format!("output.paraview={{ {every} }}");
        let settings = ["--set", "stages.0.steps=12", "--set", &frames];
        let folder = Folder::with_results(name, &settings);
        let view = View::of(&folder, "results");
        let (status, _, index) = view.get("index.json");
        assert_eq!(status, 200);
        let index: serde_json::Value = serde_json::from_str(&index).unwrap();
        let frames = index["frames"].as_object().unwrap();
        for name in frames.keys() {
            let name = name.replace("paraview/", "packed/paraview/");
            assert_eq!(view.get(&name).0, 200, "{name}");
        }
        let when = |frame: &serde_json::Value| frame["when"].as_str().unwrap().to_owned();
        frames.values().map(when).collect()
    };
    let steps: Vec<String> = (1..=12).map(|step| format!("step {step}")).collect();
    assert_eq!(served("film", ""), steps);
    assert_eq!(served("no-film", "every = \"stage\""), ["step 12"]);
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
    let place = &index["frames"]["paraview/particles_0002.vtu"];
    assert_eq!(place["stage"], 0);
    assert_eq!(place["when"], "step 2");
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

/// GOAL: no way leads to anything but the files that are shown; a refusal has no body.
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
    let here = format!("127.0.0.1:{}", view.port);
    let nothing = |(status, head, body): (u16, String, String), wanted: u16, label: &str| {
        assert_eq!((status, body.as_str()), (wanted, ""), "{label}");
        assert!(head.contains("Content-Length: 0"), "{label}: {head}");
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
        nothing(view.ask("GET", path, &here), 404, path);
    }
    for name in NOT_SHOWN {
        nothing(view.get(name), 404, name);
    }
    let absolute = view.ask("GET", &format!("{}index.json", view.address()), &here);
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
        nothing(view.ask(method, &page, &here), 405, method);
    }
    let two = format!("GET {page} HTTP/1.1\r\nHost: {here}\r\nHost: {here}\r\n\r\n");
    for request in [
        &*two,
        &format!("GET {page} HTTP/1.1\r\n\r\n"),
        "nonsense\r\n\r\n",
    ] {
        let response = view.send(request.as_bytes());
        assert!(response.starts_with("HTTP/1.1 400 "), "{response}");
    }
    let long = format!(
        "GET /{} HTTP/1.1\r\nHost: {here}\r\n\r\n",
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
fn folders_without_frames_and_of_several_runs_differ() {
    let folder = Folder::with_results(
        "folders",
        &["--set", "output.paraview={ every = \"never\" }"],
    );
    let view = View::of(&folder, "results");
    let index: serde_json::Value = serde_json::from_str(&view.get("index.json").2).unwrap();
    assert_eq!(index["never"], true);
    drop(view);
    let printed = |words: &[&str]| {
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
    insta::assert_snapshot!(printed(&["view", "study"]).1, @r"
    error: study holds the results of several runs
      help: look at one of them:
        igimp view study/mesh-1
        igimp view study/mesh-2
    ");
    std::fs::create_dir_all(folder.0.join("empty")).unwrap();
    let (code, text) = printed(&["view", "empty"]);
    assert_eq!(code, 2);
    insta::assert_snapshot!(text, @r"
    error: there are no results of a run in empty
      help: give the folder that `igimp run` names in its last line
    ");
    assert_eq!(printed(&["view", "none"]).0, 4);
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
