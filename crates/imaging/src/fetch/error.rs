//! Why a plate cannot be fetched, in words that say what to do.

use std::path::PathBuf;
use std::time::Duration;

use muybridge_capture::FileError;

use super::LONGEST_WAIT;

/// Why a plate cannot be fetched. Every message names the address, the cause, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum FetchError {
    /// The address given is not that of an image service, or not one to be trusted.
    #[error(
        "{address}: {fault}; give the base address of a IIIF image service, such as https://iiif.example.org/PLATE"
    )]
    Address {
        /// What was given.
        address: String,
        /// What is wrong with it.
        fault: &'static str,
    },
    /// No connection: offline, no such host, refused, or no secure connection.
    #[error(
        "{url}: cannot be reached ({cause}); check the network connection and the address, then fetch again"
    )]
    Unreachable {
        /// The address asked.
        url: String,
        /// Cause.
        cause: String,
    },
    /// Connected, but no data came.
    #[error(
        "{url}: no data within {} s; check the network connection and fetch again later (parts that have arrived are kept)",
        after.as_secs_f64()
    )]
    TimedOut {
        /// The address asked.
        url: String,
        /// How long was waited.
        after: Duration,
    },
    /// The connection broke, or what came over it makes no sense.
    #[error(
        "{url}: the answer broke off after {received} bytes ({cause}); fetch again to go on with what has arrived"
    )]
    Interrupted {
        /// The address asked.
        url: String,
        /// Bytes that had arrived.
        received: u64,
        /// Cause.
        cause: String,
    },
    /// The server answers that it will not or cannot.
    #[error("{url}: the server answers {}; {}", status_text(*status), advice(*status, *retry_after))]
    Status {
        /// The address asked.
        url: String,
        /// HTTP status.
        status: u16,
        /// How long the server asks to wait.
        retry_after: Option<Duration>,
    },
    /// Redirects that do not end, or lead to an address that is not to be trusted.
    #[error("{url}: {fault}; check the address in a browser, and give the one it ends at")]
    Redirects {
        /// The address asked.
        url: String,
        /// What is wrong.
        fault: String,
    },
    /// The service does not describe itself as the IIIF Image API says.
    #[error(
        "{url}: no description of a IIIF image ({fault}); \
             check that the address is that of a IIIF Image API service, version 2 or 3"
    )]
    NotIiif {
        /// Address of the description.
        url: String,
        /// What is wrong with it.
        fault: String,
    },
    /// Something else than the picture asked for.
    #[error(
        "{url}: {found} instead of the picture; nothing of it is kept; \
             open the address in a browser to see what the server sends"
    )]
    WrongContent {
        /// The address asked.
        url: String,
        /// What came.
        found: String,
    },
    /// The picture ends before its end.
    #[error(
        "{url}: the picture is cut short after {bytes} bytes; nothing of it is kept; \
             fetch again later, and tell the holder if it stays so"
    )]
    CutShort {
        /// The address asked.
        url: String,
        /// Bytes that came.
        bytes: u64,
    },
    /// More bytes than are fetched.
    #[error("{url}: more than the {} MB that are fetched; nothing of it is kept; \
             raise the limit if the picture is as it should be", *most as f64 / 1e6)]
    TooManyBytes {
        /// The address asked.
        url: String,
        /// Limit.
        most: u64,
    },
    /// More pixels than are fetched.
    #[error("{url}: {width} x {height} pixels are more than the {} megapixels that are fetched; \
             nothing of it is kept; raise the limit if the picture is as it should be", *most as f64 / 1e6)]
    TooManyPixels {
        /// The address asked.
        url: String,
        /// Width, px.
        width: u64,
        /// Height, px.
        height: u64,
        /// Limit, px.
        most: u64,
    },
    /// Another program is fetching the same plate.
    #[error("{}: being fetched by another run; wait for it to end, or stop it", path.display())]
    Busy {
        /// The part file that it writes.
        path: PathBuf,
    },
    /// A file of the cache cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
}

impl FetchError {
    /// How long to wait before the same is asked again; none when asking again is no use, or the server asks for
    /// more patience than [`LONGEST_WAIT`].
    pub(super) fn wait_before_retry(&self, back_off: Duration) -> Option<Duration> {
        let wait = match self {
            Self::TimedOut { .. } | Self::Interrupted { .. } | Self::CutShort { .. } => back_off,
            Self::Status { status: 408 | 429 | 500 | 502..=504 | 506..=599, retry_after, .. } => {
                retry_after.unwrap_or(back_off).max(back_off)
            }
            _ => return None,
        };
        (wait <= LONGEST_WAIT).then_some(wait)
    }

    /// Whether the server may offer the picture by another address of the same service.
    pub(super) fn is_not_offered(&self) -> bool {
        matches!(self, Self::Status { status: 400 | 403 | 404 | 405 | 413 | 501, .. })
    }

    /// Whether what has arrived until now is no use to a later fetch.
    pub(super) fn discredits_parts(&self) -> bool {
        matches!(
            self,
            Self::WrongContent { .. }
                | Self::CutShort { .. }
                | Self::TooManyBytes { .. }
                | Self::TooManyPixels { .. }
        )
    }
}

/// Bytes of unknown content that a message shows.
const SHOWN_BYTES: usize = 40;

/// The beginning of content that is not what it should be, for a message.
pub(super) fn beginning(content: &[u8]) -> String {
    let start = String::from_utf8_lossy(&content[..content.len().min(SHOWN_BYTES)]);
    format!("{} bytes beginning with {start:?}", content.len())
}

fn status_text(status: u16) -> String {
    let name = ureq::http::StatusCode::from_u16(status).ok().and_then(|code| code.canonical_reason());
    name.map_or_else(|| status.to_string(), |name| format!("{status} {name}"))
}

fn advice(status: u16, retry_after: Option<Duration>) -> String {
    match (status, retry_after) {
        (429 | 500..=599, Some(wait)) => format!("fetch again in {} s", wait.as_secs()),
        (401, _) => "it wants a login; fetch the plate in a browser, or from another holder".into(),
        (403, _) => "it refuses to hand the plate out; fetch it in a browser, or from another holder".into(),
        (404 | 410, _) => "there is no such plate; check the address in the catalogue".into(),
        (408 | 429 | 500 | 502..=504 | 506..=599, _) => {
            "it is busy or out of order; fetch again later".into()
        }
        _ => "it does not answer as an image service should; check the address in a browser".into(),
    }
}
