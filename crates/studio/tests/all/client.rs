//! A client by raw sockets: what a browser does, and what none does.

use serde_json::{Value, json};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use toolpost_studio::message::{self, Array, Frame};
use toolpost_studio::server::ReadOptions;
use toolpost_studio::{Server, Settings};

/// A server in a thread of its own, and the folder that it works in, which lies in another one.
pub struct Studio {
    pub outside: tempfile::TempDir,
    pub port: u16,
    pub token: String,
}

impl Studio {
    /// One whose folder has the examples of the project.
    pub fn new() -> Studio {
        Studio::with(None)
    }

    /// The same, with options.
    pub fn with(options: Option<ReadOptions>) -> Studio {
        Studio::started(Settings { options, ..Settings::default() }, |_| {})
    }

    /// The same, with settings for it and what else is in the folder.
    pub fn started(settings: Settings, fill: impl FnOnce(&Path)) -> Studio {
        let outside = tempfile::tempdir().unwrap();
        let own = outside.path().join("own");
        std::fs::create_dir(&own).unwrap();
        for name in ["dome.cls", "lean.cls"] {
            std::fs::copy(root().join("examples").join(name), own.join(name)).unwrap();
        }
        std::fs::write(outside.path().join("secret.cls"), "secret").unwrap();
        fill(&own);
        let server = Server::bind(&Settings { folder: own, ..settings }).unwrap();
        let (port, link) = (server.port(), server.link());
        std::thread::spawn(move || server.run());
        let token = link.split_once('#').unwrap().1.to_owned();
        Studio { outside, port, token }
    }

    pub fn own(&self) -> PathBuf {
        self.outside.path().join("own")
    }

    pub fn stream(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(120))).unwrap();
        stream
    }

    /// Sends a request as it is written, and answers status, head and body.
    pub fn raw(&self, request: &[u8]) -> (u16, String, Vec<u8>) {
        let mut stream = self.stream();
        let _ = stream.write_all(request);
        answer(&mut stream)
    }

    /// A request with the token, and further headers.
    pub fn request(&self, line: &str, headers: &str, body: &[u8]) -> (u16, String, Vec<u8>) {
        let head = format!(
            "{line} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nx-toolpost-token: {}\r\nContent-Length: {}\r\nConnection: close\r\n{headers}\r\n",
            self.port,
            self.token,
            body.len()
        );
        self.raw(&[head.as_bytes(), body].concat())
    }

    /// The octets of a path.
    pub fn get(&self, path: &str) -> Vec<u8> {
        let (status, _, body) = self.request(&format!("GET {path}"), "", b"");
        assert_eq!(status, 200, "{path}: {}", String::from_utf8_lossy(&body));
        body
    }

    /// A socket that has brought the token.
    pub fn socket(&self) -> Socket {
        let mut socket = self.silent_socket();
        socket.send(&json!({ "token": self.token }), &[]);
        socket
    }

    /// A socket that has said nothing yet.
    pub fn silent_socket(&self) -> Socket {
        let mut stream = self.stream();
        stream.write_all(self.upgrade("").as_bytes()).unwrap();
        let mut head = Vec::new();
        while !head.ends_with(b"\r\n\r\n") {
            let mut byte = [0];
            stream.read_exact(&mut byte).unwrap();
            head.push(byte[0]);
        }
        let head = String::from_utf8(head).unwrap();
        assert!(head.starts_with("HTTP/1.1 101 "), "{head}");
        Socket { stream, next: 0 }
    }

    /// The request of a socket.
    pub fn upgrade(&self, headers: &str) -> String {
        format!(
            "GET /socket HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
             Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n{headers}\r\n",
            self.port
        )
    }
}

/// The folder of the project.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Reads an answer up to the end of the connection.
pub fn answer(stream: &mut TcpStream) -> (u16, String, Vec<u8>) {
    let mut bytes = Vec::new();
    let _ = stream.read_to_end(&mut bytes);
    let end = bytes.windows(4).position(|window| window == b"\r\n\r\n").unwrap_or(bytes.len());
    let head = String::from_utf8_lossy(&bytes[..end]).into_owned();
    let status = head.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap_or(0);
    let body = bytes.get(end + 4..).unwrap_or_default().to_vec();
    (status, head, body)
}

/// What a socket says.
#[derive(Debug)]
pub enum Said {
    Frame(Frame),
    /// It was closed with this code.
    Closed(u16),
    /// The connection has ended.
    Gone,
}

/// A socket.
pub struct Socket {
    pub stream: TcpStream,
    next: u32,
}

impl Socket {
    pub fn send(&mut self, head: &Value, arrays: &[Array]) {
        self.send_bytes(2, &message::write(head, arrays));
    }

    /// Sends a message of a kind (1: text, 2: binary), masked by zeros.
    pub fn send_bytes(&mut self, kind: u8, bytes: &[u8]) {
        self.send_piece(0x80 | kind, bytes.len() as u64, bytes);
    }

    /// Sends a piece of a message with this first byte, which says that it has so many bytes.
    pub fn send_piece(&mut self, first: u8, length: u64, bytes: &[u8]) {
        let mut frame = vec![first, 0x80 | 127];
        frame.extend(length.to_be_bytes());
        frame.extend([0; 4]);
        let _ = self.stream.write_all(&frame).and_then(|()| self.stream.write_all(bytes));
    }

    /// The next message.
    pub fn next(&mut self) -> Said {
        let mut head = [0; 2];
        if self.stream.read_exact(&mut head).is_err() {
            return Said::Gone;
        }
        let mut exact = |count: usize| {
            let mut bytes = vec![0; count];
            self.stream.read_exact(&mut bytes).unwrap();
            bytes
        };
        let length = match head[1] {
            126 => u64::from(u16::from_be_bytes(exact(2).try_into().unwrap())),
            127 => u64::from_be_bytes(exact(8).try_into().unwrap()),
            length => u64::from(length),
        };
        let body = exact(length as usize);
        match head[0] & 15 {
            8 => Said::Closed(u16::from_be_bytes([body[0], body[1]])),
            2 => Said::Frame(message::read(&body).unwrap()),
            _ => self.next(),
        }
    }

    pub fn ask(&mut self, ask: &str, params: Value, arrays: &[Array]) -> u32 {
        self.next += 1;
        self.send(&json!({ "id": self.next, "ask": ask, "params": params }), arrays);
        self.next
    }

    /// Asks, and answers what was done, or the stop.
    pub fn answer(&mut self, ask: &str, params: Value, arrays: &[Array]) -> Result<Frame, Value> {
        let id = self.ask(ask, params, arrays);
        self.answer_of(id)
    }

    /// What an ask is answered; progress and other answers are left out.
    pub fn answer_of(&mut self, id: u32) -> Result<Frame, Value> {
        let begun = Instant::now();
        loop {
            assert!(begun.elapsed() < Duration::from_secs(120), "no answer");
            match self.next() {
                Said::Frame(mut frame)
                    if frame.head["id"] == id && !frame.head.contains_key("event") =>
                {
                    return match frame.head.remove("stop") {
                        Some(stop) => Err(stop),
                        None => Ok(frame),
                    };
                }
                Said::Frame(_) => {}
                other => panic!("{other:?}"),
            }
        }
    }

    /// Asks for what is done.
    pub fn done(&mut self, ask: &str, params: Value) -> Value {
        self.answer(ask, params, &[]).unwrap().head.remove("done").unwrap()
    }

    /// Asks for what is refused, and answers the rule.
    pub fn refused(&mut self, ask: &str, params: Value) -> String {
        let stop = self.answer(ask, params, &[]).unwrap_err();
        stop["findings"][0]["rule"].as_str().unwrap().to_owned()
    }

    /// A job of a source of the folder.
    pub fn post(&mut self, source: &str, machine: &str) -> Value {
        self.done("post", json!({ "source": { "file": source }, "machine": machine }))
    }
}
