//! The socket: first the token, then asks and their answers.

use super::asks::{self, Answer, wrong};
use super::closed::say;
use super::metered::Trusted;
use super::{SOCKETS, Studio};
use crate::ask::{Cancel, Done, Hello, Progress, Stop, Stopped, Verdict, Walked};
use crate::drawing::Piece;
use crate::job::Waits;
use crate::message::{self, Array, Frame};
use crate::walk::KINDS;
use axum::body::Body;
use axum::extract::ws::{CloseFrame, Message, WebSocket, WebSocketUpgrade};
use axum::extract::{FromRequestParts, Request};
use axum::http::{Response, StatusCode};
use axum::response::IntoResponse;
use geom::ending::Ended;
use program::{Diagnostic, Rule};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tokio::sync::mpsc::{UnboundedSender, unbounded_channel};
use tokio::time::timeout;

/// How long the first frame may take, and the page to read an answer.
const PATIENCE: (Duration, Duration) = (Duration::from_secs(3), Duration::from_secs(30));

/// The codes with which a socket is closed.
const NO_TOKEN: u16 = 4401;
const BROKEN: u16 = 4400;

/// How long it is between two words of how far a step is.
const BETWEEN: Duration = Duration::from_millis(100);

/// How many asks of a page wait for their answers at the same time.
const MOST_ASKS: usize = 64;

/// Makes a socket of a request.
pub async fn upgrade(studio: Arc<Studio>, request: Request) -> Response<Body> {
    let Ok(place) = Arc::clone(&studio.sockets).try_acquire_owned() else {
        let why = format!("{SOCKETS} pages are open already: close one");
        return say(StatusCode::SERVICE_UNAVAILABLE, why);
    };
    let (mut parts, _) = request.into_parts();
    let trusted = parts.extensions.get::<Trusted>().cloned().unwrap_or_default();
    match WebSocketUpgrade::from_request_parts(&mut parts, &()).await {
        Ok(upgrade) => upgrade
            .max_message_size(message::MOST_BYTES)
            .max_frame_size(message::MOST_BYTES)
            .on_upgrade(async move |socket| {
                talk(studio, trusted, socket).await;
                drop(place);
            }),
        Err(refused) => refused.into_response(),
    }
}

/// Talks with a page until it goes.
async fn talk(studio: Arc<Studio>, trusted: Trusted, mut socket: WebSocket) {
    let first = timeout(PATIENCE.0, next(&mut socket)).await;
    let token = match first {
        Ok(Some(Ok(frame))) => of_head::<Hello>(frame.head).ok().map(|hello| hello.token),
        _ => None,
    };
    if !token.is_some_and(|token| studio.token.is(token.as_bytes())) {
        return close(socket, NO_TOKEN, "the first message is the token of the link").await;
    }
    trusted.set();
    studio.is_reached();
    let (answers, mut to_send) = unbounded_channel();
    let number = studio.pages.fetch_add(1, Ordering::Relaxed);
    let page = Arc::new(Page { studio, number, answers, running: Mutex::default() });
    // However this ends, nobody waits for what is being done.
    let _ends = EndsAll(&page);
    loop {
        tokio::select! {
            frame = next(&mut socket) => match frame {
                Some(Ok(frame)) => take(&page, frame),
                Some(Err(why)) => return close(socket, BROKEN, why).await,
                None => return,
            },
            Some(frame) = to_send.recv() => {
                match timeout(PATIENCE.1, socket.send(Message::Binary(frame.into()))).await {
                    Ok(Ok(())) => {}
                    _ => return,
                }
            }
        }
    }
}

/// The next frame; nothing where the page has gone.
async fn next(socket: &mut WebSocket) -> Option<Result<Frame, &'static str>> {
    loop {
        return match socket.recv().await? {
            Ok(Message::Binary(bytes)) => Some(message::read(&bytes)),
            Ok(Message::Text(_)) => Some(Err("is a text, and frames are binary")),
            Ok(Message::Ping(_) | Message::Pong(_)) => continue,
            Ok(Message::Close(_)) | Err(_) => None,
        };
    }
}

async fn close(mut socket: WebSocket, code: u16, why: &'static str) {
    let frame = CloseFrame { code, reason: why.into() };
    let _ = timeout(PATIENCE.0, socket.send(Message::Close(Some(frame)))).await;
}

/// A page that has brought the token.
struct Page {
    studio: Arc<Studio>,
    /// Its number among all pages.
    number: u64,
    answers: UnboundedSender<Vec<u8>>,
    /// What is being done for it, by the ids of the asks: whether that makes a job, and how it is ended.
    running: Mutex<BTreeMap<u32, (bool, Ended)>>,
}

/// Ends all work for a page that has gone; its drafts are whoever's goes on with them.
struct EndsAll<'a>(&'a Page);

impl Drop for EndsAll<'_> {
    fn drop(&mut self) {
        self.0.running().values().for_each(|(_, ended)| ended.end());
        self.0.studio.drafting().retain(|_, page| *page != self.0.number);
        self.0.studio.stopped().remove(&self.0.number);
    }
}

/// What was walked, with the arrays `index` and `vertices`.
type Shown = (Walked, [Vec<u8>; 2]);

/// Tells a page how far an ask has come.
struct Tells<'a> {
    page: &'a Page,
    id: u32,
    /// The step, and when something was told last.
    last: Mutex<(&'static str, Instant)>,
    /// What was walked since the last word of that, and when that was: the first chunk is shown as soon as it is there.
    walked: Mutex<(Option<Shown>, Option<Instant>)>,
}

impl<'a> Tells<'a> {
    fn new(page: &'a Page, id: u32) -> Tells<'a> {
        let now = Instant::now();
        Tells { page, id, last: Mutex::new(("", now)), walked: Mutex::default() }
    }

    /// Tells what was walked.
    fn show(&self, walked: Option<Shown>) {
        if let Some((walked, [index, vertices])) = walked {
            let arrays = [Array::text("index", index), Array::text("vertices", vertices)];
            let _ = self.page.answers.send(message::write(&walked, &arrays));
        }
    }

    /// Tells what was walked and not told yet.
    fn show_rest(&self) {
        let rest = self.walked.lock().unwrap_or_else(PoisonError::into_inner).0.take();
        self.show(rest);
    }

    fn tell(&self, step: &'static str, part: Option<f64>) {
        let progress = Progress { event: "progress", id: self.id, step, part };
        let _ = self.page.answers.send(message::write(&progress, &[]));
    }
}

impl Waits for Tells<'_> {
    fn step(&self, step: &'static str) {
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = (step, Instant::now());
        self.tell(step, None);
    }

    fn reached(&self, part: f64) {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if last.1.elapsed() > BETWEEN {
            last.1 = Instant::now();
            self.tell(last.0, Some(part));
        }
    }

    fn walked(&self, file: &str, piece: Piece) {
        let mut walked = self.walked.lock().unwrap_or_else(PoisonError::into_inner);
        let (begun, last) = &mut *walked;
        // Several programs may be proven at the same time.
        let others = begun.take_if(|(begun, _)| begun.file != file);
        let (told, [index, vertices]) = begun.get_or_insert_with(|| {
            let (event, file, chunk) = ("walked", file.to_owned(), piece.chunk);
            let kinds = KINDS.to_vec();
            let told = Walked { event, id: self.id, file, chunk, moves: 0, time_s: 0.0, kinds };
            (told, [Vec::new(), Vec::new()])
        });
        (told.moves, told.time_s) = (piece.moves, piece.seconds);
        index.extend(piece.index);
        vertices.extend(piece.vertices);
        self.show(others);
        if last.is_none_or(|last| last.elapsed() > BETWEEN) {
            *last = Some(Instant::now());
            self.show(begun.take());
        }
    }
}

/// An ask.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Ask {
    id: u32,
    ask: String,
    #[serde(default)]
    params: Map<String, Value>,
}

/// Takes a frame of a page: an ask, or the end of one.
fn take(page: &Arc<Page>, frame: Frame) {
    let Frame { head, arrays } = frame;
    if head.contains_key("cancel") {
        return match of_head::<Cancel>(head) {
            Ok(Cancel { cancel }) => page.end(cancel),
            Err(why) => page.stop(0, wrong(&why)),
        };
    }
    let id = head.get("id").and_then(Value::as_u64).and_then(|id| u32::try_from(id).ok());
    let Some(id) = id else {
        return page.stop(0, wrong("the message has no id"));
    };
    let Ask { id, ask, params } = match of_head(head) {
        Ok(ask) => ask,
        Err(why) => return page.stop(id, wrong(&why)),
    };
    let ended = match page.begin(id, asks::makes_job(&ask)) {
        Ok(ended) => ended,
        Err(found) => return page.stop(id, (*found).into()),
    };
    let page = Arc::clone(page);
    tokio::task::spawn_blocking(move || {
        let tells = Tells::new(&page, id);
        let answer =
            || asks::answer(&page.studio, &ask, params, arrays, page.number, (&tells, &ended));
        let answer = catch_unwind(AssertUnwindSafe(answer));
        page.running().remove(&id);
        match answer {
            Ok(Ok(Answer { done, arrays })) => {
                tells.show_rest();
                let _ = page.answers.send(message::write(&Done { id, done }, &arrays));
            }
            Ok(Err(stop)) => page.stop(id, stop),
            Err(_) => {
                let found = Diagnostic::error(Rule::StudioAsk, "the studio has failed at this");
                let help = "this is a mistake of Toolpost: report it with the file, and use the command meanwhile";
                page.stop(id, found.help(help).into());
            }
        }
    });
}

impl Page {
    fn running(&self) -> MutexGuard<'_, BTreeMap<u32, (bool, Ended)>> {
        self.running.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Begins an ask. One that makes a job ends the others that do.
    fn begin(&self, id: u32, makes_job: bool) -> Result<Ended, Box<Diagnostic>> {
        let mut running = self.running();
        if running.len() >= MOST_ASKS {
            let found =
                Diagnostic::error(Rule::StudioLimit, format!("{MOST_ASKS} asks wait already"));
            return Err(found.help("ask again when they are answered").into());
        }
        if running.contains_key(&id) {
            return Err(
                Diagnostic::error(Rule::StudioAsk, "an ask of this id waits already").into()
            );
        }
        let older = running.values().filter(|(does, _)| makes_job && *does);
        older.for_each(|(_, ended)| ended.end());
        let ended = Ended::default();
        running.insert(id, (makes_job, ended.clone()));
        Ok(ended)
    }

    /// Ends an ask, where it is not answered yet.
    fn end(&self, id: u32) {
        if let Some((_, ended)) = self.running().get(&id) {
            ended.end();
        }
    }

    fn stop(&self, id: u32, stop: app::Stop) {
        let app::Stop { verdict, findings } = stop;
        let findings =
            findings.into_iter().map(|found| self.studio.folder.finding(found)).collect();
        let stop = Stop { verdict: Verdict::from(verdict), findings };
        let _ = self.answers.send(message::write(&Stopped { id, stop }, &[]));
    }
}

/// A head as one of the types of [`crate::ask`].
pub fn of_head<T: DeserializeOwned>(head: Map<String, Value>) -> Result<T, String> {
    serde_json::from_value(Value::Object(head)).map_err(|error| error.to_string())
}
