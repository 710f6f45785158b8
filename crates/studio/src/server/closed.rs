//! Who is answered: requests that name this server as their host, come from no other page, and bring the token.

use axum::body::Body;
use axum::extract::Request;
use axum::http::header::{HOST, HeaderName, HeaderValue, ORIGIN};
use axum::http::{self, Method, Response, StatusCode};

/// The header in which requests bring the token.
pub const TOKEN: HeaderName = HeaderName::from_static("x-toolpost-token");

const FETCH_SITE: HeaderName = HeaderName::from_static("sec-fetch-site");
const FETCH_MODE: HeaderName = HeaderName::from_static("sec-fetch-mode");
const FETCH_DEST: HeaderName = HeaderName::from_static("sec-fetch-dest");

/// What is said with every answer. `style-src` needs no exception: the page's editor sets its styles as constructed sheets.
const HEADERS: [(&str, &str); 6] = [
    (
        "content-security-policy",
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; font-src 'self'; connect-src 'self'; \
         worker-src 'self'; frame-ancestors 'none'; base-uri 'none'; form-action 'none'",
    ),
    ("x-content-type-options", "nosniff"),
    ("referrer-policy", "no-referrer"),
    ("cross-origin-opener-policy", "same-origin"),
    ("cross-origin-resource-policy", "same-origin"),
    ("cache-control", "no-store"),
];

/// 256 bits of the system in hexadecimal digits: who has them is answered.
#[derive(Clone, PartialEq, Eq)]
pub struct Token(String);

impl Token {
    /// A new one.
    ///
    /// # Errors
    /// The system has none to give.
    pub fn new() -> Result<Token, getrandom::Error> {
        let mut bytes = [0; 32];
        getrandom::fill(&mut bytes)?;
        Ok(Token(bytes.iter().map(|byte| format!("{byte:02x}")).collect()))
    }

    /// As it stands in the link.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Whether somebody has brought it. How long that takes does not depend on how much of it is right.
    pub fn is(&self, brought: &[u8]) -> bool {
        let own = self.0.as_bytes();
        let pairs = own.iter().zip(brought.iter().chain(std::iter::repeat(&0)));
        let differs = pairs.fold(0, |differs, (a, b)| std::hint::black_box(differs | (a ^ b)));
        differs == 0 && own.len() == brought.len()
    }
}

/// Not to be printed by mistake.
impl std::fmt::Debug for Token {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Token(..)")
    }
}

/// The names of this server, never those that a request brings.
#[derive(Clone, Debug)]
pub struct Names {
    hosts: [String; 2],
    origins: [String; 2],
}

impl Names {
    /// Of a server at this port.
    pub fn of(port: u16) -> Names {
        let hosts = ["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}"));
        let origins = hosts.clone().map(|host| format!("http://{host}"));
        Names { hosts, origins }
    }

    /// Why a request is not answered, whoever brings it.
    pub fn refuses<B>(&self, request: &http::Request<B>) -> Option<(StatusCode, &'static str)> {
        let headers = request.headers();
        let is_one = |name: HeaderName, known: &[String]| {
            let mut given = headers.get_all(name).iter();
            match (given.next(), given.next()) {
                (None, _) => None,
                (Some(value), None) => Some(known.iter().any(|known| value == known)),
                (Some(_), Some(_)) => Some(false),
            }
        };
        // RFC 9112 3.2.2: a target with a host counts before the header.
        let target = request.uri().authority();
        let is_target = target.is_none_or(|target| self.hosts.iter().any(|own| target == own));
        if is_one(HOST, &self.hosts) != Some(true) || !is_target {
            let why = "this server is called 127.0.0.1 or localhost, with its port";
            return Some((StatusCode::MISDIRECTED_REQUEST, why));
        }
        if is_one(ORIGIN, &self.origins) == Some(false) {
            return Some((StatusCode::FORBIDDEN, "another page has sent this request"));
        }
        let own = ["same-origin", "none"].map(str::to_owned);
        // A window may be led to the page, as the file that the browser is started with does: it gives nothing without the token.
        let is = |name: HeaderName, value: &str| is_one(name, &[value.to_owned()]) == Some(true);
        let is_page = request.method() == Method::GET && request.uri().path() == "/";
        let is_window = || is(FETCH_MODE, "navigate") && is(FETCH_DEST, "document");
        if is_one(FETCH_SITE, &own) == Some(false) && !(is_page && is_window()) {
            return Some((StatusCode::FORBIDDEN, "another site has sent this request"));
        }
        None
    }
}

/// Whether a request brings the token.
pub fn brings(token: &Token, request: &Request) -> bool {
    request.headers().get(TOKEN).is_some_and(|brought| token.is(brought.as_bytes()))
}

/// An answer in words.
pub fn say(status: StatusCode, text: impl Into<String>) -> Response<Body> {
    let mut response = Response::new(Body::from(text.into() + "\n"));
    *response.status_mut() = status;
    let plain = HeaderValue::from_static("text/plain; charset=utf-8");
    response.headers_mut().insert("content-type", plain);
    response
}

/// An answer with what is said with every one; what it says itself stays.
pub fn guarded(mut response: Response<Body>) -> Response<Body> {
    for (name, value) in HEADERS {
        response.headers_mut().entry(name).or_insert(HeaderValue::from_static(value));
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_is_brought_whole() {
        let token = Token::new().unwrap();
        assert_eq!(token.as_str().len(), 64);
        assert!(token.is(token.as_str().as_bytes()));
        assert_ne!(token.as_str(), Token::new().unwrap().as_str());
        let longer = format!("{}0", token.as_str());
        let zeros = [token.as_str().as_bytes(), &[0]].concat();
        for wrong in [&b""[..], &token.as_str().as_bytes()[..63], longer.as_bytes(), &zeros] {
            assert!(!token.is(wrong));
        }
        assert_eq!(format!("{token:?}"), "Token(..)");
    }
}
