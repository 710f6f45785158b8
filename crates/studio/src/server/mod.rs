//! The server: who is answered ([`closed`]), the socket, and files by HTTP.

mod asks;
pub mod closed;
mod files;
mod memory;
mod metered;
mod run;
mod socket;

use crate::ask::{Command, Field, FileOrUpload, Given, Limits, MachineKind, Of};
use crate::folder::{Folder, SECRET};
use crate::inputs::Inputs;
use crate::job::{Options, Sources};
use crate::jobs::{Jobs, MOST_JOBS};
use crate::machines::Any;
use crate::message::{self, Array};
use crate::page;
use app::helper::Launcher;
use app::{Source, Stop};
use axum::body::Body;
use axum::extract::Request;
use axum::http::{Method, Response, StatusCode};
use closed::{Names, Token, brings, guarded, say};
use geom::ending::{Ended, Helper};
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use metered::{Metered, Trusted};
use program::{Diagnostic, Rule};
use run::{First, Left};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::convert::Infallible;
use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicU64;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use tokio::runtime::{Builder, Runtime};
use tokio::sync::Semaphore;
use tokio::task::AbortHandle;

/// How many connections are open at the same time. Another one takes the place of the one that has said nothing for the longest time; where
/// all have said what they want, it waits.
const CONNECTIONS: usize = 128;

/// How many sockets are open at the same time.
const SOCKETS: usize = 16;

/// The largest upload, bytes.
const UPLOAD: usize = 256 << 20;

/// The most files of a folder that is a board, and all of them together, bytes.
const BOARD_FILES: usize = 1000;
const BOARD_BYTES: u64 = 256 << 20;

/// How long a connection may take to say what it wants, and a request to be answered.
const PATIENCE: (Duration, Duration) = (Duration::from_secs(3), Duration::from_secs(60));

/// What the server takes.
const LIMITS: Limits = Limits {
    upload: UPLOAD as u64,
    frame: message::MOST_BYTES as u64,
    jobs: MOST_JOBS as u32,
    sockets: SOCKETS as u32,
};

/// What a server is started with.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// The folder in which it reads and writes.
    pub folder: PathBuf,
    /// What is opened at once: the path of a file in the folder, or of a folder with a board.
    pub source: Option<String>,
    /// The machine that is picked for it.
    pub machine: Option<String>,
    /// The port that it listens on; `None` for that of the folder, or any other where that is taken.
    pub port: Option<u16>,
    /// The forms of the commands' own options.
    pub form: Option<Form>,
    /// What such options, names without dashes and values, mean; `None`: there are none.
    pub options: Option<ReadOptions>,
    /// What starts processes for steps of work that cannot be ended otherwise; `None`: these go on to their end.
    pub helper: Option<Launcher>,
}

/// Makes a form of the options of a command.
pub type Form = fn(Command) -> Vec<Field>;

/// Reads options of a command as the command line does.
/// A board may have a file with more of them.
pub type ReadOptions = fn(Command, &[(String, String)], Option<&More>) -> Result<Options, Stop>;

/// A file with more options of a board.
#[derive(Clone, Debug)]
pub struct More {
    /// The file.
    pub file: Source,
    /// Whether the options name it; otherwise it lies beside the board.
    pub is_asked: bool,
}

/// The option that names it.
pub const SETTINGS: &str = "settings";

/// The port of a folder, the same each time: another port is another origin for the browser, and what a tab kept of an edit is not
/// found there. Below those that systems give away themselves (Linux from 32768, IANA from 49152).
fn port_of(folder: &Path) -> u16 {
    // FNV-1a, which stays what it is.
    let hash =
        folder.as_os_str().as_encoded_bytes().iter().fold(0x811c_9dc5, |hash: u32, byte| {
            (hash ^ u32::from(*byte)).wrapping_mul(0x0100_0193)
        });
    20_000 + (hash % 12_000) as u16
}

/// A server that listens.
#[derive(Debug)]
pub struct Server {
    runtime: Runtime,
    listener: TcpListener,
    port: u16,
    studio: Arc<Studio>,
}

/// What a page asks, without a socket and one ask after the other.
#[derive(Debug)]
pub struct Session(Arc<Studio>);

impl Session {
    /// Opens the folder.
    ///
    /// # Errors
    /// It cannot be opened, or the system gives no random numbers.
    pub fn open(settings: &Settings) -> Result<Session, Stop> {
        let folder = Folder::open(&settings.folder)?;
        Ok(Session(Studio::open(settings, folder, 0)?))
    }

    /// What an ask of a page is answered, until it is ended: the head's `done`, and arrays.
    ///
    /// # Errors
    /// As the page gets them.
    pub fn answer(
        &self,
        ask: &str,
        params: Map<String, Value>,
        arrays: Vec<Array>,
        ended: &Ended,
    ) -> Result<(Value, Vec<Array>), Stop> {
        let asks::Answer { done, arrays } =
            asks::answer(&self.0, ask, params, arrays, 0, (&(), ended))?;
        Ok((done, arrays))
    }
}

/// What all its connections share.
#[derive(Debug)]
pub(crate) struct Studio {
    folder: Folder,
    source: Option<Given>,
    machine: Option<String>,
    token: Token,
    names: Names,
    sockets: Arc<Semaphore>,
    uploads: files::Uploads,
    /// Held by the one whose upload is being taken.
    uploading: tokio::sync::Mutex<()>,
    /// Held by the one for whom a view is looked at.
    looking: Mutex<()>,
    /// How many pages there were.
    pages: AtomicU64,
    /// Which page that is open keeps a draft, by the names of the drafts.
    drafting: Mutex<BTreeMap<String, u64>>,
    jobs: Jobs,
    /// The work that the command line names, until somebody asks for it or for another.
    first: Mutex<Option<First>>,
    left: Left,
    /// Of each page that is open, what its last work was made of that gave no job.
    stopped: Mutex<BTreeMap<u64, Arc<Inputs>>>,
    runs: memory::Runs,
    /// The file that leads the browser here, until a page has come.
    leads: Mutex<Option<String>>,
    form: Option<Form>,
    options: Option<ReadOptions>,
    helper: Option<Arc<dyn Helper>>,
}

impl Studio {
    /// What the connections of a server at a port share.
    ///
    /// # Errors
    /// The system gives no token.
    fn open(settings: &Settings, folder: Folder, port: u16) -> Result<Arc<Studio>, Stop> {
        // A server that was killed while it saved.
        app::files::sweep_idle(folder.path());
        let no_token = |error: getrandom::Error| {
            let message = format!("the system gives no token: {error}");
            Diagnostic::error(Rule::StudioPort, message)
        };
        let token = Token::new().map_err(no_token)?;
        let own = getrandom::u32().map_err(no_token)?;
        let given = |path: String| match folder.is_folder(&path) {
            true => Given::Folder(path),
            false => Given::File(path),
        };
        Ok(Arc::new(Studio {
            source: settings.source.clone().map(given),
            folder,
            machine: settings.machine.clone(),
            token,
            names: Names::of(port),
            sockets: Arc::new(Semaphore::new(SOCKETS)),
            uploads: files::Uploads::default(),
            uploading: tokio::sync::Mutex::default(),
            looking: Mutex::default(),
            pages: AtomicU64::default(),
            drafting: Mutex::default(),
            jobs: Jobs::new(own),
            first: Mutex::default(),
            left: Left::default(),
            stopped: Mutex::default(),
            runs: memory::Runs::default(),
            leads: Mutex::default(),
            form: settings.form,
            options: settings.options,
            helper: settings.helper.clone().map(|helper| Arc::new(helper) as _),
        }))
    }

    /// Which page that is open keeps a draft.
    fn drafting(&self) -> MutexGuard<'_, BTreeMap<String, u64>> {
        self.drafting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The work that the command line names, where nobody has asked for it or for another yet.
    fn first(&self) -> MutexGuard<'_, Option<First>> {
        self.first.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Of each page that is open, what its last work was made of that gave no job.
    fn stopped(&self) -> MutexGuard<'_, BTreeMap<u64, Arc<Inputs>>> {
        self.stopped.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn leads(&self) -> MutexGuard<'_, Option<String>> {
        self.leads.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A page has come.
    fn is_reached(&self) {
        if let Some(name) = self.leads().take() {
            self.folder.drop_secret(&name);
        }
    }

    /// What options mean.
    fn options(
        &self,
        command: Command,
        given: &[(String, String)],
        more: Option<&More>,
    ) -> Result<Options, Stop> {
        match self.options {
            Some(read) => read(command, given, more.filter(|_| command == Command::Pcb)),
            None if given.is_empty() => Ok(Options::default()),
            None => Err(Diagnostic::error(Rule::StudioAsk, "there are no options here").into()),
        }
    }

    /// What programs are made of, read.
    fn sources(&self, given: &Given, inputs: &Inputs) -> Result<Sources, Stop> {
        Ok(match given {
            Given::File(path) => {
                let bytes = inputs.read(&self.folder, path, Of::Source)?;
                Sources::One(Source::memory(path, bytes))
            }
            Given::Upload(id) => Sources::One(self.uploads.find(id)?),
            Given::Uploads(ids) => {
                let each = ids.iter().map(|id| self.uploads.find(id));
                let mut files = each.collect::<Result<Vec<Source>, _>>()?;
                // What says how a board is made is no file of it.
                files.retain(|file| !app::pcb::SETTINGS.contains(&&*file.name()));
                Sources::Several(files)
            }
            Given::Folder(path) => {
                inputs.look(&self.folder, Path::new(path.trim_matches('/')), Of::Source);
                let read = |path: &str| inputs.read(&self.folder, path, Of::Source);
                let files = self.folder.read_all(path, BOARD_FILES, BOARD_BYTES, read)?;
                let name =
                    path.trim_matches('/').rsplit('/').next().filter(|name| !name.is_empty());
                let name = name.map_or_else(|| self.folder.name(), str::to_owned);
                let files = files.into_iter().map(|(path, bytes)| Source::memory(path, bytes));
                Sources::Folder(name, files.collect())
            }
        })
    }

    /// The file with options of a board: the one that its options name, or one that lies beside it or is one of its files.
    fn more(
        &self,
        given: &Given,
        options: &[(String, String)],
        inputs: &Inputs,
    ) -> Result<Option<More>, Stop> {
        let read = |path: String| {
            let bytes = inputs.read(&self.folder, &path, Of::Source)?;
            Ok::<Source, Stop>(Source::memory(path, bytes))
        };
        if let Some((_, path)) = options.iter().find(|(name, _)| name == SETTINGS) {
            return Ok(Some(More { file: read(path.clone())?, is_asked: true }));
        }
        let beside = |file| More { file, is_asked: false };
        let folder = match given {
            Given::Uploads(ids) => {
                let files: Vec<Source> =
                    ids.iter().filter_map(|id| self.uploads.find(id).ok()).collect();
                let of = |name| files.iter().find(|file| file.name() == name).cloned();
                return Ok(app::pcb::SETTINGS.into_iter().find_map(of).map(beside));
            }
            Given::Upload(_) => return Ok(None),
            Given::Folder(path) => path.trim_end_matches('/'),
            Given::File(path) => path.rsplit_once('/').map_or("", |(folder, _)| folder),
        };
        let path = |name: &str| match folder {
            "" => name.to_owned(),
            folder => format!("{folder}/{name}"),
        };
        let mut paths = app::pcb::SETTINGS.into_iter().map(path);
        let found = paths.find(|path| {
            let is_there = self.folder.has(path);
            if !is_there {
                // When it comes, it counts.
                inputs.look(&self.folder, Path::new(path), Of::Source);
            }
            is_there
        });
        Ok(found.map(read).transpose()?.map(beside))
    }

    /// What writes the programs of something.
    fn command(&self, given: &Given, machine: Option<&Any>) -> Result<Command, Stop> {
        Ok(match (self.looked_at(given)?, machine) {
            (Some(sources), _) => sources.command(machine),
            (None, Some(Any::Fires(_))) => Command::Glass,
            (None, _) => Command::Pcb,
        })
    }

    /// Of which kinds a machine can take the source.
    fn kinds(&self, given: &Given) -> Result<Vec<MachineKind>, Stop> {
        Ok(match self.looked_at(given)? {
            Some(sources) => sources.kinds(),
            // The files of a board, or bodies.
            None => vec![MachineKind::Mill, MachineKind::Robot, MachineKind::Glass],
        })
    }

    /// Something, to say what it is: a file of the folder is read where its name does not say it. `None`: a folder, which is not read for that.
    fn looked_at(&self, given: &Given) -> Result<Option<Sources>, Stop> {
        match given {
            Given::Folder(_) => Ok(None),
            Given::File(path) if app::pcb::is_named_board(Path::new(path)).is_some() => {
                self.folder.check(path)?;
                Ok(Some(Sources::One(Source::File(path.into()))))
            }
            Given::File(_) | Given::Upload(_) | Given::Uploads(_) => {
                Ok(Some(self.sources(given, &Inputs::default())?))
            }
        }
    }

    /// A file of the folder or an upload, read.
    fn source(&self, source: &FileOrUpload) -> Result<Source, Stop> {
        match source {
            FileOrUpload::File(path) => Ok(Source::memory(path, self.folder.read(path)?)),
            FileOrUpload::Upload(id) => Ok(self.uploads.find(id)?),
        }
    }
}

impl Server {
    /// Opens the folder and the port.
    ///
    /// # Errors
    /// One of them cannot be opened.
    pub fn bind(settings: &Settings) -> Result<Server, Stop> {
        let refused = |what: &str, error: &dyn std::fmt::Display| {
            let message = format!("{what}: {error}");
            Diagnostic::error(Rule::StudioPort, message)
        };
        let folder = Folder::open(&settings.folder)?;
        let listen = |port| {
            let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
            listener.set_nonblocking(true)?;
            let port = listener.local_addr()?.port();
            Ok((listener, port))
        };
        let listening = match settings.port {
            Some(port) => listen(port),
            None => listen(port_of(folder.path())).or_else(|_: std::io::Error| listen(0)),
        };
        let (listener, port) = listening.map_err(|error| {
            let port = settings.port.unwrap_or(0);
            refused(&format!("port {port} of 127.0.0.1 cannot be opened"), &error)
        })?;
        let runtime = Builder::new_current_thread().enable_all().max_blocking_threads(64).build();
        let runtime = runtime.map_err(|error| refused("the server cannot start", &error))?;
        let studio = Studio::open(settings, folder, port)?;
        Ok(Server { runtime, listener, port, studio })
    }

    /// The port that it listens on.
    pub fn port(&self) -> u16 {
        self.port
    }

    /// The link that the browser opens. What is behind `#` is sent to nobody; the page brings it with every request.
    pub fn link(&self) -> String {
        format!("http://127.0.0.1:{}/#{}", self.port, self.studio.token.as_str())
    }

    /// Opens the page in the browser of the system, where it has one. Everybody on the computer may read what a browser is started with, so
    /// that is not the link but a file that leads to it, which this user alone may read; it is gone as soon as a page has come, or with
    /// [`app::files::remove_left`].
    ///
    /// # Errors
    /// Why it was not opened.
    pub fn show(&self) -> Result<(), String> {
        let number = getrandom::u64().map_err(|error| error.to_string())?;
        let name = format!("open-{number:016x}{SECRET}");
        let link = self.link();
        let text = format!(
            "<!doctype html>\n<meta charset=\"utf-8\">\n<meta name=\"referrer\" content=\"no-referrer\">\n\
             <meta http-equiv=\"refresh\" content=\"0; url={link}\">\n<title>Toolpost studio</title>\n<a href=\"{link}\">Toolpost studio</a>\n"
        );
        let studio = &self.studio;
        let path = studio.folder.keep_secret(&name, &text).map_err(|error| error.to_string())?;
        *studio.leads() = Some(name);
        open::that_detached(path).map_err(|error| error.to_string())
    }

    /// Begins the work that the settings name, and answers until the process ends.
    pub fn run(self) -> ! {
        let Server { runtime, listener, studio, .. } = self;
        First::begin(&studio);
        runtime.block_on(async move {
            tokio::spawn(memory::give_back(Arc::clone(&studio)));
            let listener = tokio::net::TcpListener::from_std(listener);
            serve(listener.expect("a socket that listens and does not block"), studio).await
        })
    }
}

/// Takes connections, so many at the same time.
async fn serve(listener: tokio::net::TcpListener, studio: Arc<Studio>) -> ! {
    let connections = Arc::new(Semaphore::new(CONNECTIONS));
    let silent = Silent::default();
    let mut last = 0;
    loop {
        let stream = match listener.accept().await {
            Ok((stream, _)) => stream,
            Err(_) => {
                // Too many open files, or a connection that is gone already.
                tokio::time::sleep(Duration::from_millis(20)).await;
                continue;
            }
        };
        if connections.available_permits() == 0 {
            silent.drop_first();
        }
        let Ok(permit) = Arc::clone(&connections).acquire_owned().await else { continue };
        let _ = stream.set_nodelay(true);
        last += 1;
        let (number, studio, all) = (last, Arc::clone(&studio), silent.clone());
        let connection = tokio::spawn(async move {
            let speaks = all.clone();
            let trusted = Trusted::default();
            let stream = Metered::new(stream, trusted.clone());
            let service = service_fn(move |mut request: hyper::Request<Incoming>| {
                speaks.remove(number);
                request.extensions_mut().insert(trusted.clone());
                answer(Arc::clone(&studio), request)
            });
            let connection = http1::Builder::new()
                .timer(TokioTimer::new())
                .header_read_timeout(PATIENCE.0)
                .max_headers(64)
                .max_buf_size(64 << 10)
                .serve_connection(TokioIo::new(stream), service)
                .with_upgrades();
            let _ = connection.await;
            all.remove(number);
            drop(permit);
        });
        silent.add(number, connection.abort_handle());
    }
}

/// The connections that have not said yet what they want, by their numbers.
#[derive(Clone, Default)]
struct Silent(Arc<Mutex<BTreeMap<u64, AbortHandle>>>);

impl Silent {
    fn all(&self) -> MutexGuard<'_, BTreeMap<u64, AbortHandle>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn add(&self, number: u64, connection: AbortHandle) {
        self.all().insert(number, connection);
    }

    fn remove(&self, number: u64) {
        self.all().remove(&number);
    }

    /// Ends the oldest.
    fn drop_first(&self) {
        if let Some((_, connection)) = self.all().pop_first() {
            connection.abort();
        }
    }
}

/// Answers a request.
async fn answer(
    studio: Arc<Studio>,
    request: hyper::Request<Incoming>,
) -> Result<Response<Body>, Infallible> {
    let request = request.map(Body::new);
    let response = match studio.names.refuses(&request) {
        Some((status, why)) => say(status, why),
        None => match tokio::time::timeout(PATIENCE.1, route(studio, request)).await {
            Ok(response) => response,
            Err(_) => say(StatusCode::REQUEST_TIMEOUT, "the request took longer than a minute"),
        },
    };
    Ok(guarded(response))
}

/// Who answers a request.
async fn route(studio: Arc<Studio>, request: Request) -> Response<Body> {
    let path = request.uri().path().to_owned();
    let path = path.trim_start_matches('/');
    let is_get = request.method() == Method::GET;
    if path == "socket" && is_get {
        return socket::upgrade(studio, request).await;
    }
    if let Some((kind, bytes)) = page::file(path).filter(|_| is_get) {
        let mut response = Response::new(Body::from(bytes));
        let kind = axum::http::HeaderValue::from_static(kind);
        response.headers_mut().insert("content-type", kind);
        return response;
    }
    if path.is_empty() && is_get {
        return say(StatusCode::NOT_FOUND, Rule::StudioPage.meaning());
    }
    if !brings(&studio.token, &request) {
        return say(StatusCode::UNAUTHORIZED, "the token of the link is missing or wrong");
    }
    if let Some(trusted) = request.extensions().get::<Trusted>() {
        trusted.set();
    }
    if path.starts_with("geometry/") || path.starts_with("moves/") {
        return match is_get {
            true => files::drawn(studio, path.to_owned()).await,
            false => say(StatusCode::METHOD_NOT_ALLOWED, "geometry is asked for by GET"),
        };
    }
    match path.strip_prefix("upload/") {
        Some(name) if request.method() == Method::PUT => {
            files::upload(&studio, name, request).await
        }
        Some(_) => say(StatusCode::METHOD_NOT_ALLOWED, "uploads are sent by PUT"),
        None => say(StatusCode::NOT_FOUND, "there is nothing of this name"),
    }
}
