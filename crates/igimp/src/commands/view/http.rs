//! As much of HTTP as one page needs: the head of a request, bounded in length and time, and a
//! response that ends the connection.

use std::fs::File;
use std::io::{self, Read as _, Write as _};
use std::net::{Shutdown, TcpStream};
use std::time::{Duration, Instant};

/// Longest head of a request \[bytes\]; that of a browser has about one thousand.
const LONGEST_HEAD: usize = 8192;

/// Time to send a request, and to take up a part of the response.
const PATIENCE: Duration = Duration::from_secs(5);

/// Most that a client may send behind the head before the connection is cut \[bytes\].
const MOST_IGNORED: u64 = 65_536;

/// How a request is answered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Status {
    Ok,
    BadRequest,
    Forbidden,
    NotFound,
    MethodNotAllowed,
    TooLong,
}

impl Status {
    fn line(self) -> &'static str {
        match self {
            Self::Ok => "200 OK",
            Self::BadRequest => "400 Bad Request",
            Self::Forbidden => "403 Forbidden",
            Self::NotFound => "404 Not Found",
            Self::MethodNotAllowed => "405 Method Not Allowed",
            Self::TooLong => "431 Request Header Fields Too Large",
        }
    }
}

/// A request.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Request {
    pub(super) method: String,
    /// The target as sent, with its percent signs.
    pub(super) path: String,
    pub(super) host: String,
}

/// The body of a response.
#[derive(Debug)]
pub(super) enum Body {
    Text(String),
    /// So many bytes of a file.
    File(File, u64),
}

/// The head of a request; the inner error is how to refuse it.
pub(super) fn read(stream: &mut TcpStream) -> io::Result<Result<Request, Status>> {
    let deadline = Instant::now() + PATIENCE;
    let mut head = Vec::new();
    let mut part = [0; 1024];
    loop {
        let left = deadline.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(io::ErrorKind::TimedOut.into());
        }
        stream.set_read_timeout(Some(left))?;
        let length = stream.read(&mut part)?;
        if length == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        head.extend_from_slice(&part[..length]);
        if let Some(end) = head.windows(4).position(|four| four == b"\r\n\r\n") {
            if end > LONGEST_HEAD {
                return Ok(Err(Status::TooLong));
            }
            return Ok(parse(&head[..end]).ok_or(Status::BadRequest));
        }
        if head.len() > LONGEST_HEAD {
            return Ok(Err(Status::TooLong));
        }
    }
}

/// The request of a head without its empty line.
fn parse(head: &[u8]) -> Option<Request> {
    let text = std::str::from_utf8(head).ok()?;
    let mut lines = text.split("\r\n");
    let mut words = lines.next()?.split(' ');
    let (method, path, version) = (words.next()?, words.next()?, words.next()?);
    if words.next().is_some() || !version.starts_with("HTTP/1.") {
        return None;
    }
    let mut host = None;
    for line in lines {
        let (name, value) = line.split_once(':')?;
        // A second host is a trick.
        if name.eq_ignore_ascii_case("host") && host.replace(value.trim()).is_some() {
            return None;
        }
    }
    Some(Request {
        method: method.to_owned(),
        path: path.to_owned(),
        host: host?.to_owned(),
    })
}

/// Sends a response, without its body if only the head was asked for, and ends the connection.
pub(super) fn respond(
    stream: &mut TcpStream,
    status: Status,
    headers: &[(&str, &str)],
    body: Body,
    head_only: bool,
) -> io::Result<()> {
    stream.set_write_timeout(Some(PATIENCE))?;
    let length = match &body {
        Body::Text(text) => text.len() as u64,
        Body::File(_, length) => *length,
    };
    let mut head = format!(
        "HTTP/1.1 {}\r\nContent-Length: {length}\r\nConnection: close\r\n",
        status.line()
    );
    for (name, value) in headers {
        head.extend([name, ": ", value, "\r\n"]);
    }
    head += "\r\n";
    stream.write_all(head.as_bytes())?;
    match body {
        _ if head_only => {}
        Body::Text(text) => stream.write_all(text.as_bytes())?,
        Body::File(file, length) => {
            io::copy(&mut file.take(length), stream)?;
        }
    }
    stream.shutdown(Shutdown::Write)?;
    // Bytes that were sent and never read would tear down the connection before the response is taken up.
    stream.set_read_timeout(Some(Duration::from_millis(500)))?;
    let _ = io::copy(&mut stream.take(MOST_IGNORED), &mut io::sink());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_are_read_strictly() {
        let read = |text: &str| parse(text.as_bytes()).map(|request| (request.path, request.host));
        let found = read("GET /a%20b HTTP/1.1\r\nhOST:  127.0.0.1:80 \r\nAccept: */*");
        assert_eq!(found, Some(("/a%20b".into(), "127.0.0.1:80".into())));
        for wrong in [
            "",
            "GET / HTTP/1.1",
            "GET / HTTP/2\r\nHost: a",
            "GET / b HTTP/1.1\r\nHost: a",
            "GET /\r\nHost: a",
            "GET / HTTP/1.1\r\nHost: a\r\nHost: b",
            "GET / HTTP/1.1\r\nHost: a\r\nno colon",
        ] {
            assert_eq!(read(wrong), None, "{wrong}");
        }
    }
}
