//! What is large goes by HTTP: uploads come, geometry goes.

use super::closed::say;
use super::{Studio, UPLOAD};
use crate::ask::Uploaded;
use crate::geometry;
use crate::sight::{self, View};
use app::Source;
use axum::body::{Body, to_bytes};
use axum::extract::Request;
use axum::http::header::CONTENT_LENGTH;
use axum::http::{HeaderValue, Response, StatusCode};
use program::{Diagnostic, Digest, Rule};
use std::sync::{Arc, Mutex, PoisonError};

/// The most uploads that are kept, and all of them together, bytes: the oldest goes when another comes.
const MOST_UPLOADS: usize = 32;
const MOST_BYTES: usize = 512 << 20;

/// The most bytes of several chunks in one answer, where it has more than one.
const MOST_SEVERAL: usize = 16 << 20;

/// Files that the page has sent: kept in memory, and nowhere saved.
#[derive(Debug, Default)]
pub struct Uploads(Mutex<Vec<Kept>>);

/// A file that is kept.
#[derive(Debug)]
struct Kept {
    id: String,
    name: String,
    bytes: Arc<Vec<u8>>,
}

impl Uploads {
    /// Keeps a file, and answers its id: the digest of its name and bytes. What was made of an upload is of that file alone, also
    /// for another server.
    fn keep(&self, name: String, bytes: Vec<u8>) -> String {
        let id = Digest::of([name.as_bytes(), &bytes[..]]);
        let bytes = Arc::new(bytes);
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.retain(|file| file.id != id);
        kept.push(Kept { id: id.clone(), name, bytes });
        let too_much = |files: &[Kept]| {
            let bytes: usize = files.iter().map(|file| file.bytes.len()).sum();
            files.len() > 1 && (files.len() > MOST_UPLOADS || bytes > MOST_BYTES)
        };
        while too_much(&kept) {
            kept.remove(0);
        }
        id
    }

    /// The file of this id.
    ///
    /// # Errors
    /// There is none, or no more.
    pub fn find(&self, id: &str) -> Result<Source, Box<Diagnostic>> {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let found = kept.iter().find(|file| file.id == id);
        let Kept { name, bytes, .. } = found.ok_or_else(|| {
            let message = "this upload is not kept here: newer ones have taken its place, or the studio was started anew";
            Diagnostic::error(Rule::StudioLimit, message).help("drop the file again")
        })?;
        Ok(Source::Memory { name: name.into(), bytes: Arc::clone(bytes) })
    }
}

/// Takes an upload.
pub async fn upload(studio: &Studio, name: &str, request: Request) -> Response<Body> {
    let Some(name) = decoded(name) else {
        return say(StatusCode::BAD_REQUEST, "an upload has the name of a file, without folders");
    };
    let length = request.headers().get(CONTENT_LENGTH);
    let length = length.and_then(|length| length.to_str().ok()?.parse::<usize>().ok());
    let is_too_large = length.is_some_and(|length| length > UPLOAD);
    // One at a time: no more memory is taken than by one.
    let _turn = studio.uploading.lock().await;
    let body = if is_too_large { None } else { to_bytes(request.into_body(), UPLOAD).await.ok() };
    let Some(bytes) = body else {
        let why = "the upload is larger than 256 MB, or was broken off: put the file into the folder instead";
        return say(StatusCode::PAYLOAD_TOO_LARGE, why);
    };
    let length = bytes.len() as u64;
    let upload = studio.uploads.keep(name.clone(), bytes.into());
    let answer = Uploaded { upload, name, bytes: length };
    let mut response = Response::new(Body::from(serde_json::json!(answer).to_string()));
    response.headers_mut().insert("content-type", HeaderValue::from_static("application/json"));
    response
}

/// Answers the geometry or the rows of a job: `geometry/REVISION/index`, `geometry/REVISION/LEVEL/CHUNK` (or `FROM-TO` for
/// CHUNK), `geometry/REVISION/sight/...`, `moves/REVISION/CHUNK`.
pub async fn drawn(studio: Arc<Studio>, path: String) -> Response<Body> {
    // Whoever does not wait any longer has gone away: then this ends.
    let waited = Arc::new(());
    let waits = Arc::downgrade(&waited);
    let goes_on = move || waits.strong_count() > 0;
    // Chunks are made when they are asked for.
    let made = tokio::task::spawn_blocking(move || octets(&studio, &path, &goes_on)).await;
    drop(waited);
    match made.ok().flatten() {
        Some(bytes) => {
            let mut response = Response::new(Body::from(bytes));
            let octets = HeaderValue::from_static("application/octet-stream");
            response.headers_mut().insert("content-type", octets);
            // A revision never changes.
            let kept = HeaderValue::from_static("private, max-age=86400, immutable");
            response.headers_mut().insert("cache-control", kept);
            response
        }
        None => {
            say(StatusCode::NOT_FOUND, "this program is not open any more, or has no such part")
        }
    }
}

fn octets(studio: &Studio, path: &str, goes_on: &dyn Fn() -> bool) -> Option<Vec<u8>> {
    let parts: Vec<&str> = path.split('/').collect();
    let job = studio.jobs.find(parts.get(1)?.parse().ok()?).ok()?;
    match parts[..] {
        ["geometry", _, "index"] => Some(job.geometry().index()),
        ["geometry", _, "sight", size, place, hidden, moves] => {
            let view = View::read(size, place, hidden, moves)?;
            // One at a time: each takes a processor, and memory for its cells.
            let _turn = studio.looking.lock().unwrap_or_else(PoisonError::into_inner);
            sight::sight((job.walk(), job.geometry()), &view, goes_on)
        }
        ["geometry", _, level, chunks] => {
            let (geometry, walk) = (job.geometry(), job.walk());
            let level = level.parse().ok()?;
            let vertices = |chunk: usize| geometry.vertices(walk, level, chunk);
            match chunks.split_once('-') {
                None => vertices(chunks.parse().ok()?),
                Some((from, to)) => {
                    let (from, to): (usize, usize) = (from.parse().ok()?, to.parse().ok()?);
                    geometry::several((from..to).map_while(vertices), MOST_SEVERAL)
                }
            }
        }
        ["moves", _, chunk] => geometry::rows(job.walk(), chunk.parse().ok()?),
        _ => None,
    }
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

    #[test]
    fn the_oldest_upload_goes_when_too_many_come() {
        let uploads = Uploads::default();
        let keep = |name: String| uploads.keep(name, b"x".to_vec());
        let ids: Vec<String> = (0..=MOST_UPLOADS).map(|name| keep(name.to_string())).collect();
        assert!(uploads.find(&ids[0]).unwrap_err().rule == "studio-limit");
        assert_eq!(uploads.find(&ids[1]).unwrap().read().unwrap(), &b"x"[..]);
    }

    #[test]
    fn an_upload_is_known_by_its_name_and_its_bytes() {
        let (one, other) = (Uploads::default(), Uploads::default());
        let keep = |uploads: &Uploads, name: &str, bytes: &[u8]| {
            uploads.keep(name.to_owned(), bytes.to_vec())
        };
        let id = keep(&one, "a.cls", b"x");
        assert_eq!(keep(&other, "a.cls", b"x"), id);
        for (name, bytes) in [("a.cls", &b"y"[..]), ("b.cls", b"x"), ("a.cl", b"sx")] {
            assert_ne!(keep(&other, name, bytes), id);
        }
        // Dropped again it is kept once, as the newest.
        keep(&one, "b.cls", b"x");
        keep(&one, "a.cls", b"x");
        assert_eq!(one.0.lock().unwrap().len(), 2);
        assert_eq!(one.0.lock().unwrap()[1].id, id);
    }
}
