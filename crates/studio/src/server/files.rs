//! What is large goes by HTTP: uploads come, geometry goes.

use super::closed::say;
use super::{Studio, UPLOAD};
use crate::ask::Uploaded;
use axum::body::{Body, to_bytes};
use axum::http::{HeaderValue, Response, StatusCode};
use std::sync::{Arc, Mutex, PoisonError};

/// The most uploads that are kept, and all of them together, bytes: the oldest goes when another comes.
const MOST_UPLOADS: usize = 32;
const MOST_BYTES: usize = 1 << 30;

/// Files that the page has sent: kept in memory, and nowhere saved.
#[derive(Debug, Default)]
pub struct Uploads(Mutex<Kept>);

#[derive(Debug, Default)]
struct Kept {
    next: u64,
    /// The oldest first.
    files: Vec<(String, String, Arc<[u8]>)>,
}

impl Uploads {
    /// Keeps a file, and answers its id.
    fn keep(&self, name: String, bytes: Arc<[u8]>) -> String {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.next += 1;
        let id = kept.next.to_string();
        kept.files.push((id.clone(), name, bytes));
        let too_much = |files: &[(String, String, Arc<[u8]>)]| {
            let bytes: usize = files.iter().map(|(.., bytes)| bytes.len()).sum();
            files.len() > 1 && (files.len() > MOST_UPLOADS || bytes > MOST_BYTES)
        };
        while too_much(&kept.files) {
            kept.files.remove(0);
        }
        id
    }
}

/// Takes an upload.
pub async fn upload(studio: &Studio, name: &str, body: Body) -> Response<Body> {
    let Some(name) = decoded(name) else {
        return say(StatusCode::BAD_REQUEST, "an upload has the name of a file, without folders");
    };
    let Ok(bytes) = to_bytes(body, UPLOAD).await else {
        let why = "the upload is larger than 256 MB, or was broken off: put the file into the folder instead";
        return say(StatusCode::PAYLOAD_TOO_LARGE, why);
    };
    let answer = Uploaded {
        bytes: bytes.len() as u64,
        upload: studio.uploads.keep(name, Arc::from(&bytes[..])),
    };
    let mut response = Response::new(Body::from(serde_json::json!(answer).to_string()));
    response.headers_mut().insert("content-type", HeaderValue::from_static("application/json"));
    response
}

/// A name of a file from a path, where `%20` is a blank.
fn decoded(name: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(name.len());
    let mut rest = name.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => {
                let mut digit = || (rest.next()? as char).to_digit(16);
                let (high, low) = (digit()?, digit()?);
                (high * 16 + low) as u8
            }
            byte => byte,
        });
    }
    let name = String::from_utf8(bytes).ok()?;
    let is_name = !name.is_empty()
        && name.len() <= 255
        && ![".", ".."].contains(&&*name)
        && !name.contains(['/', '\\'])
        && !name.contains(char::is_control);
    is_name.then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_upload_has_a_name_without_folders() {
        assert_eq!(decoded("a%20b.cls").as_deref(), Some("a b.cls"));
        assert_eq!(decoded("%C4%8De.cls").as_deref(), Some("če.cls"));
        for wrong in ["", "%", "%2", "%zz", "%2e%2e", "a%2Fb", "a/b", "a%5cb", "a%00", "%ff", "%0a"]
        {
            assert_eq!(decoded(wrong), None, "{wrong}");
        }
    }
}
