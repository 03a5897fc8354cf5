//! Requests: what is sent, what may be followed, which failures are worth another attempt.

use std::io::Read;
use std::time::Duration;

use ureq::http::{Response, header};
use ureq::{Agent, Body, ResponseExt};

use super::address::{Address, is_loopback};
use super::{FetchError, FetchLimits, LONGEST_WAIT, Progress};

/// Redirects that are followed: a moved service, its new name, and https for http, with room to spare.
const MOST_REDIRECTS: u32 = 5;
/// Bytes read at a time.
const CHUNK_BYTES: usize = 1 << 16;

/// A connection to one service.
pub(super) struct Client<'a> {
    agent: Agent,
    loopback: bool,
    /// What is fetched at most.
    pub(super) limits: &'a FetchLimits,
    /// Told how it goes.
    pub(super) progress: &'a mut dyn FnMut(Progress),
}

/// Ask for the rest of what has arrived in part.
pub(super) struct Rest {
    /// Bytes that are there.
    pub(super) from: u64,
    /// What says that the rest is of the same picture: `ETag` or `Last-Modified`.
    pub(super) validator: String,
}

impl<'a> Client<'a> {
    pub(super) fn new(
        address: &Address,
        limits: &'a FetchLimits,
        progress: &'a mut dyn FnMut(Progress),
    ) -> Self {
        let timeout = Some(limits.timeout);
        let config = Agent::config_builder()
            .user_agent(concat!("muybridge/", env!("CARGO_PKG_VERSION")))
            .https_only(!address.is_loopback())
            .http_status_as_error(false)
            .max_redirects(MOST_REDIRECTS)
            .timeout_resolve(timeout)
            .timeout_connect(timeout)
            .timeout_recv_response(timeout)
            .timeout_per_read(timeout)
            .timeout_per_write(timeout);
        // A proxy is for what leaves this computer.
        let config = if address.is_loopback() { config.proxy(None) } else { config };
        Self { agent: config.build().into(), loopback: address.is_loopback(), limits, progress }
    }

    /// Attempts something until it succeeds, fails for good, or has been attempted often enough.
    pub(super) fn persist<T>(
        &mut self,
        mut attempt: impl FnMut(&mut Self) -> Result<T, FetchError>,
    ) -> Result<T, FetchError> {
        let mut back_off = self.limits.first_wait;
        for _ in 1..self.limits.attempts {
            let error = match attempt(self) {
                Ok(value) => return Ok(value),
                Err(error) => error,
            };
            let Some(wait) = error.wait_before_retry(back_off) else { return Err(error) };
            (self.progress)(Progress::Waiting { wait, cause: error.to_string() });
            std::thread::sleep(wait);
            back_off = back_off.saturating_mul(2).min(LONGEST_WAIT);
        }
        attempt(self)
    }

    /// Asks once for an address; any answer but success is an error.
    pub(super) fn get(&self, url: &str, rest: Option<&Rest>) -> Result<Answer, FetchError> {
        let mut request = self.agent.get(url);
        if let Some(rest) = rest {
            request = request.header(header::RANGE, format!("bytes={}-", rest.from));
            request = request.header(header::IF_RANGE, &rest.validator);
        }
        let timeout = self.limits.timeout;
        let response = request.call().map_err(|error| failure(url, 0, timeout, error))?;
        let arrived_at = response.get_uri();
        if arrived_at.scheme_str() != Some("https") && !(self.loopback && is_loopback(arrived_at)) {
            return Err(unencrypted(url, &arrived_at.to_string()));
        }
        let answer = Answer { url: url.into(), response, timeout };
        match answer.response.status().as_u16() {
            200 => Ok(answer),
            206 if rest.is_some() => Ok(answer),
            status => Err(FetchError::Status { url: url.into(), status, retry_after: answer.retry_after() }),
        }
    }

    /// Asks for an address and keeps the answer in memory; as [`Answer::receive`].
    pub(super) fn get_bytes(&self, url: &str, already_and_most: [u64; 2]) -> Result<Vec<u8>, FetchError> {
        let mut bytes = Vec::new();
        self.get(url, None)?.receive(already_and_most, |chunk, _| {
            bytes.extend_from_slice(chunk);
            Ok(())
        })?;
        Ok(bytes)
    }
}

/// An answer whose content is still to come.
pub(super) struct Answer {
    url: String,
    response: Response<Body>,
    timeout: Duration,
}

impl Answer {
    fn header(&self, name: header::HeaderName) -> Option<&str> {
        self.response.headers().get(name)?.to_str().ok()
    }

    /// `Retry-After` in seconds; its other form, a date, would need a clock and is left to the back-off.
    fn retry_after(&self) -> Option<Duration> {
        self.header(header::RETRY_AFTER)?.trim().parse().ok().map(Duration::from_secs)
    }

    /// What tells this content from an older one of the same address. A weak `ETag` does not, byte for byte.
    pub(super) fn validator(&self) -> Option<&str> {
        let tag = self.header(header::ETAG).filter(|tag| !tag.starts_with("W/"));
        tag.or_else(|| self.header(header::LAST_MODIFIED))
    }

    /// Whether it is a part and not the whole.
    pub(super) fn is_partial(&self) -> bool {
        self.response.status() == 206
    }

    /// Whether it is the part that was asked for.
    pub(super) fn is_rest(&self, rest: &Rest) -> bool {
        let range = self.header(header::CONTENT_RANGE).unwrap_or_default();
        self.is_partial()
            && range.starts_with(&format!("bytes {}-", rest.from))
            && self.validator().is_none_or(|validator| validator == rest.validator)
    }

    /// Bytes to come, where the server says.
    pub(super) fn length(&self) -> Option<u64> {
        self.response.body().content_length()
    }

    /// Hands the content on piece by piece, with the number of bytes there are after each; `already` were there before.
    ///
    /// # Errors
    /// When the connection fails, there are more than `most` bytes (said by the server or not), or `keep` fails.
    pub(super) fn receive(
        mut self,
        [already, most]: [u64; 2],
        mut keep: impl FnMut(&[u8], u64) -> Result<(), FetchError>,
    ) -> Result<(), FetchError> {
        let length = self.length().unwrap_or(0);
        let Self { url, timeout, .. } = self;
        let too_many = || FetchError::TooManyBytes { url: url.clone(), most };
        if already.saturating_add(length) > most {
            return Err(too_many());
        }
        let mut received = already;
        let mut reader = self.response.body_mut().as_reader();
        let mut chunk = vec![0; CHUNK_BYTES];
        loop {
            let count = match reader.read(&mut chunk) {
                Ok(0) => return Ok(()),
                Ok(count) => count,
                Err(error) => return Err(failure(&url, received, timeout, error.into())),
            };
            received += count as u64;
            if received > most {
                return Err(too_many());
            }
            keep(&chunk[..count], received)?;
        }
    }
}

/// What a failure of the HTTP library means.
fn failure(url: &str, received: u64, timeout: Duration, error: ureq::Error) -> FetchError {
    use std::io::ErrorKind as Kind;
    let url = url.to_string();
    match error {
        ureq::Error::Timeout(_) => FetchError::TimedOut { url, after: timeout },
        ureq::Error::TooManyRedirects => {
            FetchError::Redirects { url, fault: format!("more than {MOST_REDIRECTS} redirects") }
        }
        ureq::Error::RequireHttpsOnly(to) => unencrypted(&url, &to),
        ureq::Error::Io(error) => match error.kind() {
            Kind::TimedOut | Kind::WouldBlock => FetchError::TimedOut { url, after: timeout },
            Kind::UnexpectedEof | Kind::ConnectionReset | Kind::ConnectionAborted | Kind::BrokenPipe => {
                FetchError::Interrupted { url, received, cause: error.to_string() }
            }
            _ => FetchError::Unreachable { url, cause: error.to_string() },
        },
        // A header or a chunk that makes no sense.
        ureq::Error::Protocol(error) => FetchError::Interrupted { url, received, cause: error.to_string() },
        error => FetchError::Unreachable { url, cause: error.to_string() },
    }
}

fn unencrypted(url: &str, to: &str) -> FetchError {
    FetchError::Redirects { url: url.into(), fault: format!("redirected to {to}, which is not encrypted") }
}

#[cfg(test)]
mod tests {
    use std::io::{Error, ErrorKind};

    use super::*;

    #[test]
    fn failures_say_what_happened_and_what_to_do() {
        let cases = [
            (ureq::Error::HostNotFound, "cannot be reached (host not found); check", false),
            (
                ureq::Error::Io(ErrorKind::ConnectionRefused.into()),
                "cannot be reached (connection refused)",
                false,
            ),
            (ureq::Error::Io(Error::other("failed to lookup address")), "(failed to lookup address)", false),
            (ureq::Error::Timeout(ureq::Timeout::PerRead), "no data within 9 s", true),
            (
                ureq::Error::Io(ErrorKind::ConnectionReset.into()),
                "broke off after 7 bytes (connection reset)",
                true,
            ),
            (ureq::Error::TooManyRedirects, "more than 5 redirects", false),
            (
                ureq::Error::RequireHttpsOnly("http://b".into()),
                "redirected to http://b, which is not encrypted",
                false,
            ),
            (ureq::Error::Tls("bad certificate"), "cannot be reached (bad certificate)", false),
        ];
        for (error, words, again) in cases {
            let failure = failure("https://a/x", 7, Duration::from_secs(9), error);
            let message = failure.to_string();
            assert!(message.starts_with("https://a/x: ") && message.contains(words), "{message}");
            assert_eq!(failure.wait_before_retry(Duration::ZERO).is_some(), again, "{message}");
        }
    }
}
