//! The server of `igimp view`: which requests are answered, and how.

use std::fmt::Write as _;
use std::io;
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::sync::Arc;
use std::time::Duration;

use igimp_report::viewer;

use super::http::{self, Body, Request, Status};
use super::results::Results;
use crate::error::ProgramError;

/// Connections that are held at the same time. A browser makes six, and may leave some open without asking for anything: they
/// end by themselves, and keep nobody else out. Beyond this many, new ones are cut.
const MOST_CONNECTIONS: usize = 256;

/// The page; its parts take the place of the comments that name them.
const PAGE: &str = include_str!("page/page.html");
const PARTS: [(&str, &str); 5] = [
    ("<!-- soil.html -->", viewer::SECTION),
    ("/* viewer.css */", viewer::STYLE),
    ("/* style.css */", include_str!("page/style.css")),
    ("/* curves.js */", include_str!("page/curves.js")),
    ("/* page.js */", include_str!("page/page.js")),
];

/// The page of two runs, which has the page of each in a frame.
const BOTH: &str = include_str!("page/both.html");

/// Before the name of a frame that is asked for as the page takes it.
const PACKED: &str = "packed/";

/// Sent with every response: nothing is cached, guessed, or handed to other sites.
const HEADERS: [(&str, &str); 5] = [
    ("Cache-Control", "no-store"),
    ("X-Content-Type-Options", "nosniff"),
    ("Referrer-Policy", "no-referrer"),
    ("Cross-Origin-Resource-Policy", "same-origin"),
    ("Cross-Origin-Opener-Policy", "same-origin"),
];

/// A server on the loopback address.
#[derive(Debug)]
pub(super) struct Server {
    listener: TcpListener,
    site: Site,
}

/// State shared by the threads of the server.
#[derive(Debug)]
struct Site {
    port: u16,
    token: String,
    results: Results,
    /// Those of another run beside it; addresses then begin with the number of the run.
    beside: Option<Results>,
}

impl Server {
    /// Takes a free port of 127.0.0.1 and thinks of a token.
    pub(super) fn bind(results: Results, beside: Option<Results>) -> Result<Self, ProgramError> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).map_err(network)?;
        let port = listener.local_addr().map_err(network)?.port();
        let site = Site {
            port,
            token: random()?,
            results,
            beside,
        };
        Ok(Self { listener, site })
    }

    /// The address of the page, token included.
    pub(super) fn address(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.site.port, self.site.token)
    }

    /// Begins to serve, in threads that last as long as the program.
    pub(super) fn start(self) -> Result<(), ProgramError> {
        let Self { listener, site } = self;
        let site = Arc::new(site);
        let accept = move || {
            loop {
                match listener.accept() {
                    Ok((stream, _)) => serve_apart(&site, stream),
                    // Out of file handles, say: no reason to spin.
                    Err(_) => std::thread::sleep(Duration::from_millis(100)),
                }
            }
        };
        std::thread::Builder::new().spawn(accept).map_err(network)?;
        Ok(())
    }
}

/// Serves a connection in a thread of its own, or cuts it where there are too many.
fn serve_apart(site: &Arc<Site>, mut stream: TcpStream) {
    if Arc::strong_count(site) > MOST_CONNECTIONS {
        return;
    }
    let site = Arc::clone(site);
    // Of a client that goes away there is nothing to tell; without room for a thread the connection is cut.
    let _ = std::thread::Builder::new().spawn(move || drop(site.serve(&mut stream)));
}

impl Site {
    fn serve(&self, stream: &mut TcpStream) -> io::Result<()> {
        let request = http::read(stream)?;
        let head_only = matches!(&request, Ok(request) if request.method == "HEAD");
        let answer = request.and_then(|request| self.answer(&request));
        let (status, kind, policy, body) = match answer {
            Ok(Answer { kind, policy, body }) => (Status::Ok, Some(kind), policy, body),
            Err(status) => (status, None, None, Body::Text(String::new())),
        };
        let mut headers = HEADERS.to_vec();
        headers.push((
            "Content-Security-Policy",
            policy.as_deref().unwrap_or("default-src 'none'"),
        ));
        headers.extend(kind.map(|kind| ("Content-Type", kind)));
        http::respond(stream, status, &headers, body, head_only)
    }

    /// The response to a request, or its refusal.
    fn answer(&self, request: &Request) -> Result<Answer, Status> {
        if !["GET", "HEAD"].contains(&&*request.method) {
            return Err(Status::MethodNotAllowed);
        }
        // A page of another host that found the port by a trick with names still sends its own.
        let is_here = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{}", self.port));
        if !is_here.contains(&request.host) {
            return Err(Status::Forbidden);
        }
        let inside = request.path.strip_prefix('/').ok_or(Status::BadRequest)?;
        let (token, name) = inside.split_once('/').ok_or(Status::NotFound)?;
        if !is_same(token, &self.token) {
            return Err(Status::NotFound);
        }
        let (results, name) = match (&self.beside, name.split_once('/')) {
            (None, _) => (&self.results, name),
            (Some(_), None) if name.is_empty() => return both().ok_or(Status::NotFound),
            (Some(_), Some(("1", rest))) => (&self.results, rest),
            (Some(beside), Some(("2", rest))) => (beside, rest),
            _ => return Err(Status::NotFound),
        };
        match name {
            "" => page(self.beside.is_some()).ok_or(Status::NotFound),
            "index.json" => Ok(Answer {
                kind: "application/json",
                policy: None,
                body: Body::Text(results.index()),
            }),
            _ if name.starts_with(PACKED) => {
                let frame = results.packed(&name[PACKED.len()..]);
                Ok(Answer {
                    kind: "application/json",
                    policy: None,
                    body: Body::Text(frame.ok_or(Status::NotFound)?),
                })
            }
            _ => {
                let (file, length, kind) = results.file(name).ok_or(Status::NotFound)?;
                Ok(Answer {
                    kind,
                    policy: None,
                    body: Body::File(file, length),
                })
            }
        }
    }
}

/// A response that is no refusal.
struct Answer {
    kind: &'static str,
    /// The sources that a page may load from, for a page.
    policy: Option<String>,
    body: Body,
}

/// The page, whose script and style are those with a number that is used once; it may stand `beside` another one in ours.
fn page(beside: bool) -> Option<Answer> {
    let nonce = random().ok()?;
    let mut text = PAGE.replace("NONCE", &nonce);
    for (mark, part) in PARTS {
        text = text.replace(mark, part);
    }
    text = text.replace("/* viewer.js */", &viewer::script());
    let policy = format!(
        "default-src 'none'; connect-src 'self'; img-src data:; script-src 'nonce-{nonce}'; \
         style-src 'nonce-{nonce}'; base-uri 'none'; form-action 'none'; frame-ancestors {}",
        if beside { "'self'" } else { "'none'" }
    );
    Some(Answer {
        kind: "text/html; charset=utf-8",
        policy: Some(policy),
        body: Body::Text(text),
    })
}

/// The page of two runs.
fn both() -> Option<Answer> {
    let nonce = random().ok()?;
    let policy = format!(
        "default-src 'none'; frame-src 'self'; img-src data:; script-src 'nonce-{nonce}'; style-src 'nonce-{nonce}'; \
         base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    );
    Some(Answer {
        kind: "text/html; charset=utf-8",
        policy: Some(policy),
        body: Body::Text(BOTH.replace("NONCE", &nonce)),
    })
}

/// 128 random bits in hexadecimal digits.
fn random() -> Result<String, ProgramError> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes).map_err(|error| {
        ProgramError::usage(format!("the system gives no random numbers: {error}"), "")
    })?;
    Ok(bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    }))
}

/// Whether two texts are equal, in a time that does not tell how far they are.
fn is_same(one: &str, other: &str) -> bool {
    one.len() == other.len()
        && std::iter::zip(one.bytes(), other.bytes()).fold(0, |all, (a, b)| all | (a ^ b)) == 0
}

fn network(error: io::Error) -> ProgramError {
    ProgramError::File {
        path: "127.0.0.1".into(),
        source: error,
    }
}
