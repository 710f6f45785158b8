//! The socket: first the token, then asks and their answers.

use super::closed::say;
use super::{LIMITS, SOCKETS, Studio};
use crate::ask::{
    Done, DraftName, DraftParams, FolderParams, Hello, Listing, Nothing, Opened, Stop, Stopped,
    Verdict,
};
use crate::machines;
use crate::message::{self, Array, Frame};
use axum::body::Body;
use axum::extract::ws::{CloseFrame, Message, WebSocket, WebSocketUpgrade};
use axum::extract::{FromRequestParts, Request};
use axum::http::{Response, StatusCode};
use axum::response::IntoResponse;
use program::{Diagnostic, Rule};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::Semaphore;
use tokio::sync::mpsc::{UnboundedSender, unbounded_channel};
use tokio::time::timeout;

/// How long the first frame may take, and the page to read an answer.
const PATIENCE: (Duration, Duration) = (Duration::from_secs(3), Duration::from_secs(30));

/// The codes with which a socket is closed.
const NO_TOKEN: u16 = 4401;
const BROKEN: u16 = 4400;

/// How many asks of a page wait for their answers at the same time.
const MOST_ASKS: usize = 64;

/// Makes a socket of a request.
pub async fn upgrade(studio: Arc<Studio>, request: Request) -> Response<Body> {
    let Ok(place) = Arc::clone(&studio.sockets).try_acquire_owned() else {
        let why = format!("{SOCKETS} pages are open already: close one");
        return say(StatusCode::SERVICE_UNAVAILABLE, why);
    };
    let (mut parts, _) = request.into_parts();
    match WebSocketUpgrade::from_request_parts(&mut parts, &()).await {
        Ok(upgrade) => upgrade
            .max_message_size(message::MOST_BYTES)
            .max_frame_size(message::MOST_BYTES)
            .on_upgrade(async move |socket| {
                talk(studio, socket).await;
                drop(place);
            }),
        Err(refused) => refused.into_response(),
    }
}

/// Talks with a page until it goes.
async fn talk(studio: Arc<Studio>, mut socket: WebSocket) {
    let first = timeout(PATIENCE.0, next(&mut socket)).await;
    let token = match first {
        Ok(Some(Ok(frame))) => of_head::<Hello>(frame.head).ok().map(|hello| hello.token),
        _ => None,
    };
    if !token.is_some_and(|token| studio.token.is(token.as_bytes())) {
        return close(socket, NO_TOKEN, "the first message is the token of the link").await;
    }
    let (answers, mut to_send) = unbounded_channel();
    let page = Arc::new(Page { studio, answers, waiting: Arc::new(Semaphore::new(MOST_ASKS)) });
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
    answers: UnboundedSender<Vec<u8>>,
    /// How many asks more may wait.
    waiting: Arc<Semaphore>,
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

/// What an ask is answered: a head and arrays.
struct Answer {
    done: Value,
    arrays: Vec<Array>,
}

impl Answer {
    fn of(done: impl Serialize) -> Result<Answer, app::Stop> {
        Answer::with(done, Vec::new())
    }

    fn with(done: impl Serialize, arrays: Vec<Array>) -> Result<Answer, app::Stop> {
        let done = serde_json::to_value(done).map_err(|error| wrong(&error.to_string()))?;
        Ok(Answer { done, arrays })
    }
}

/// Takes a frame of a page: an ask, or the end of one.
fn take(page: &Arc<Page>, frame: Frame) {
    let id = frame.head.get("id").and_then(Value::as_u64).and_then(|id| u32::try_from(id).ok());
    let Some(id) = id else {
        return page.stop(0, wrong("the message has no id"));
    };
    let ask = match of_head::<Ask>(frame.head) {
        Ok(ask) => ask,
        Err(why) => return page.stop(id, wrong(&why)),
    };
    let Ok(place) = Arc::clone(&page.waiting).try_acquire_owned() else {
        let found = Diagnostic::error(Rule::StudioLimit, format!("{MOST_ASKS} asks wait already"));
        return page.stop(id, found.help("ask again when they are answered").into());
    };
    let page = Arc::clone(page);
    tokio::task::spawn_blocking(move || {
        let answer = || page.answer(&ask.ask, ask.params, frame.arrays);
        let answer = std::panic::catch_unwind(std::panic::AssertUnwindSafe(answer));
        match answer {
            Ok(Ok(Answer { done, arrays })) => {
                let _ = page.answers.send(message::write(&Done { id: ask.id, done }, &arrays));
            }
            Ok(Err(stop)) => page.stop(ask.id, stop),
            Err(_) => {
                let found = Diagnostic::error(Rule::StudioAsk, "the studio has failed at this");
                let help = "this is a mistake of Toolpost: report it with the file, and use the command meanwhile";
                page.stop(ask.id, found.help(help).into());
            }
        }
        drop(place);
    });
}

impl Page {
    fn stop(&self, id: u32, stop: app::Stop) {
        let app::Stop { verdict, findings } = stop;
        let findings = findings.into_iter().map(Into::into).collect();
        let stop = Stop { verdict: Verdict::from(verdict), findings };
        let _ = self.answers.send(message::write(&Stopped { id, stop }, &[]));
    }

    /// Answers an ask.
    fn answer(
        &self,
        ask: &str,
        params: Map<String, Value>,
        arrays: Vec<Array>,
    ) -> Result<Answer, app::Stop> {
        let studio = &*self.studio;
        let folder = &studio.folder;
        let mut frame = Frame { head: params, arrays };
        let params = std::mem::take(&mut frame.head);
        match ask {
            "open" => {
                none(params)?;
                Answer::of(Opened {
                    version: env!("CARGO_PKG_VERSION"),
                    folder: folder.name(),
                    source: studio.source.clone(),
                    machine: studio.machine.clone(),
                    drafts: folder.drafts(),
                    limits: LIMITS,
                })
            }
            "folder" => {
                let FolderParams { path } = read(params)?;
                let (entries, is_whole) = folder.list(&path)?;
                Answer::of(Listing { entries, is_whole })
            }
            "machines" => {
                none(params)?;
                Answer::of(machines::list(folder))
            }
            "drafts" => {
                none(params)?;
                Answer::of(folder.drafts())
            }
            "draft" => {
                let DraftParams { name, of } = read(params)?;
                let text = frame.take_text("text").ok_or_else(|| wrong("`text` is missing"))?;
                folder.keep_draft(&name, &of, &text)?;
                Answer::of(Nothing {})
            }
            "draft_text" => {
                let DraftName { name } = read(params)?;
                let text = folder.text_of_draft(&name)?;
                Answer::with(Nothing {}, vec![Array::text("text", text)])
            }
            "drop_draft" => {
                let DraftName { name } = read(params)?;
                folder.drop_draft(&name)?;
                Answer::of(Nothing {})
            }
            _ => {
                let asks = "open, folder, machines, drafts, draft, draft_text, drop_draft";
                Err(wrong(&format!("there is no ask `{ask}`; there are {asks}")))
            }
        }
    }
}

/// The parameters of an ask.
fn read<T: DeserializeOwned>(params: Map<String, Value>) -> Result<T, app::Stop> {
    of_head(params).map_err(|why| wrong(&why))
}

/// Checks that an ask has no parameters.
fn none(params: Map<String, Value>) -> Result<(), app::Stop> {
    if params.is_empty() { Ok(()) } else { Err(wrong("this ask has no parameters")) }
}

fn of_head<T: DeserializeOwned>(head: Map<String, Value>) -> Result<T, String> {
    serde_json::from_value(Value::Object(head)).map_err(|error| error.to_string())
}

fn wrong(why: &str) -> app::Stop {
    let why: String = why.chars().take(300).collect();
    Diagnostic::error(Rule::StudioAsk, why).into()
}
