//! An image service on this computer that speaks the IIIF Image API, versions 2 and 3, over HTTP/1.1, and misbehaves
//! on demand. Needs the crates `image` and `std` only, so that other tests can include it by path.

#![allow(
    dead_code,
    clippy::unwrap_used,
    reason = "each test that includes this uses part of it, and stops at a fault"
)]

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Cursor, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use image::GrayImage;
use image::codecs::jpeg::JpegEncoder;
use image::imageops::{self, FilterType};

/// Path of the service on the server.
const BASE: &str = "/iiif/plate";

/// What the service offers.
#[derive(Clone, Debug)]
pub(crate) struct Service {
    /// 2 or 3.
    pub(crate) version: u32,
    /// `maxWidth` of the description; larger answers are refused.
    pub(crate) max_width: Option<u32>,
    /// Side of the tiles in the description.
    pub(crate) tile_px: Option<u32>,
    /// Ready-made tiles only (level 0): no whole picture, no other region.
    pub(crate) tiles_only: bool,
    /// The whole picture comes at most this wide, and the description does not say so.
    pub(crate) silently_at_most: Option<u32>,
    /// Answers carry an `ETag`, and `Range` is heeded.
    pub(crate) resumes: bool,
    /// `info.json` instead of the right one.
    pub(crate) info: Option<String>,
}

impl Default for Service {
    /// Version 3, any region and size.
    fn default() -> Self {
        Self {
            version: 3,
            max_width: None,
            tile_px: None,
            tiles_only: false,
            silently_at_most: None,
            resumes: true,
            info: None,
        }
    }
}

/// A request as it came.
#[derive(Clone, Debug)]
pub(crate) struct Request {
    /// Path below the service: `info.json`, `full/max/0/default.jpg`.
    pub(crate) path: String,
    /// How many requests for the same path came before.
    pub(crate) earlier: usize,
    /// First byte asked for by `Range`.
    pub(crate) range_from: Option<usize>,
    /// `User-Agent`.
    pub(crate) user_agent: String,
    /// Bytes of content sent.
    pub(crate) sent: usize,
}

/// What the server does instead of answering well.
#[derive(Clone, Debug)]
pub(crate) enum Fault {
    /// An error status.
    Status(u16),
    /// An error status with `Retry-After` in seconds.
    RetryAfter(u16, u64),
    /// A redirect to an address or path.
    Redirect(String),
    /// Another content with status 200.
    Content(&'static str, Vec<u8>),
    /// The connection is closed after so many bytes of the right content.
    CutAfter(usize),
    /// The right content cut short, its length given as if that were all.
    ShortBy(usize),
    /// A `Content-Length` as given, and nothing after it.
    Length(u64),
    /// Chunks without end.
    Endless,
    /// No answer until the client goes away.
    Silence,
}

type Faults = dyn Fn(&Request) -> Option<Fault> + Send + Sync;

struct Shared {
    picture: GrayImage,
    service: Service,
    faults: Box<Faults>,
    address: SocketAddr,
    requests: Mutex<Vec<Request>>,
    stop: AtomicBool,
}

/// A running server; it stops when dropped.
pub(crate) struct Server {
    shared: Arc<Shared>,
}

impl Server {
    /// Starts a service of a picture that does all right.
    pub(crate) fn start(picture: GrayImage, service: Service) -> Self {
        Self::start_with_faults(picture, service, |_| None)
    }

    /// Starts a service that misbehaves where `faults` says so.
    pub(crate) fn start_with_faults(
        picture: GrayImage,
        service: Service,
        faults: impl Fn(&Request) -> Option<Fault> + Send + Sync + 'static,
    ) -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let shared = Arc::new(Shared {
            picture,
            service,
            faults: Box::new(faults),
            address: listener.local_addr().unwrap(),
            requests: Mutex::default(),
            stop: AtomicBool::new(false),
        });
        let server = Self { shared: Arc::clone(&shared) };
        std::thread::spawn(move || {
            for stream in listener.incoming() {
                if shared.stop.load(Ordering::SeqCst) {
                    break;
                }
                let (Ok(stream), shared) = (stream, Arc::clone(&shared)) else { continue };
                // An error is a client that went away.
                std::thread::spawn(move || shared.serve(&stream));
            }
        });
        server
    }

    /// Base address of the service.
    pub(crate) fn address(&self) -> String {
        format!("http://{}{BASE}", self.shared.address)
    }

    /// All requests until now.
    pub(crate) fn requests(&self) -> Vec<Request> {
        self.shared.requests.lock().unwrap().clone()
    }

    /// Paths of all requests until now, below the service.
    pub(crate) fn paths(&self) -> Vec<String> {
        self.requests().into_iter().map(|request| request.path).collect()
    }

    /// The whole picture as the server sends it at full size.
    pub(crate) fn whole_jpeg(&self) -> Vec<u8> {
        jpeg(&self.shared.picture)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.shared.stop.store(true, Ordering::SeqCst);
        // Wakes the listener.
        let _ = TcpStream::connect(self.shared.address);
    }
}

/// JPEG of best quality.
fn jpeg(picture: &GrayImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    picture.write_with_encoder(JpegEncoder::new_with_quality(&mut bytes, 100)).unwrap();
    bytes.into_inner()
}

impl Shared {
    /// Serves one connection until the client or a fault ends it.
    fn serve(&self, stream: &TcpStream) -> std::io::Result<()> {
        stream.set_read_timeout(Some(Duration::from_secs(10)))?;
        // Head and content are written one after the other.
        stream.set_nodelay(true)?;
        let mut reader = BufReader::new(stream);
        while let Some(request) = self.read(&mut reader)? {
            let index = {
                let mut requests = self.requests.lock().unwrap();
                requests.push(request.clone());
                requests.len() - 1
            };
            let (head, body) = self.answer(&request);
            let fault = (self.faults)(&request);
            let goes_on = send(stream, head, body, fault, |sent| {
                self.requests.lock().unwrap()[index].sent = sent;
            })?;
            if !goes_on {
                break;
            }
        }
        stream.shutdown(Shutdown::Both)
    }

    fn read(&self, reader: &mut impl BufRead) -> std::io::Result<Option<Request>> {
        let mut line = String::new();
        reader.read_line(&mut line)?;
        let Some(path) = line.split(' ').nth(1) else { return Ok(None) };
        let path = path.strip_prefix(BASE).map_or(path, |rest| rest.trim_start_matches('/')).to_string();
        let mut headers = BTreeMap::new();
        loop {
            let mut line = String::new();
            reader.read_line(&mut line)?;
            let Some((name, value)) = line.trim().split_once(':') else { break };
            headers.insert(name.to_lowercase(), value.trim().to_string());
        }
        let earlier = self.requests.lock().unwrap().iter().filter(|request| request.path == path).count();
        let range = headers
            .get("range")
            .and_then(|value| value.strip_prefix("bytes=")?.strip_suffix('-')?.parse().ok());
        let user_agent = headers.get("user-agent").cloned().unwrap_or_default();
        Ok(Some(Request { path, earlier, range_from: range, user_agent, sent: 0 }))
    }

    /// Status line with headers but the length, and content.
    fn answer(&self, request: &Request) -> (String, Vec<u8>) {
        if request.path == "info.json" {
            let info = self.service.info.clone().unwrap_or_else(|| self.info());
            return ("HTTP/1.1 200 OK\r\nContent-Type: application/ld+json\r\n".into(), info.into());
        }
        let Some(picture) = self.picture(&request.path) else {
            return (
                "HTTP/1.1 404 Not Found\r\nContent-Type: text/plain\r\n".into(),
                b"no such picture".into(),
            );
        };
        let body = jpeg(&picture);
        let (mut status, mut more, mut from) = ("200 OK", String::new(), 0);
        if self.service.resumes {
            more = format!("ETag: \"{}\"\r\nAccept-Ranges: bytes\r\n", body.len());
            if let Some(start) = request.range_from.filter(|start| *start < body.len()) {
                more += &format!("Content-Range: bytes {start}-{}/{}\r\n", body.len() - 1, body.len());
                (status, from) = ("206 Partial Content", start);
            } else if request.range_from.is_some() {
                return ("HTTP/1.1 416 Range Not Satisfiable\r\n".into(), Vec::new());
            }
        }
        (format!("HTTP/1.1 {status}\r\nContent-Type: image/jpeg\r\n{more}"), body[from..].to_vec())
    }

    fn info(&self) -> String {
        let Service { version, max_width, tile_px, tiles_only, .. } = self.service;
        let (width, height) = self.picture.dimensions();
        let level = if tiles_only { 0 } else { 2 };
        let tiles = tile_px.map_or(String::new(), |side| {
            format!(r#", "tiles": [{{"width": {side}, "scaleFactors": [1, 2, 4]}}]"#)
        });
        let most = max_width.map_or(String::new(), |width| format!(r#""maxWidth": {width}"#));
        let common =
            format!(r#""protocol": "http://iiif.io/api/image", "width": {width}, "height": {height}{tiles}"#);
        // The address it gives for itself is wrong, as behind a proxy.
        if version == 2 {
            format!(
                r#"{{"@context": "http://iiif.io/api/image/2/context.json", "@id": "http://10.0.0.1/plate",
                "profile": ["http://iiif.io/api/image/2/level{level}.json", {{{most}}}], {common}}}"#
            )
        } else {
            let most = if most.is_empty() { most } else { format!(", {most}") };
            format!(
                r#"{{"@context": "http://iiif.io/api/image/3/context.json", "id": "http://10.0.0.1/plate",
                "type": "ImageService3", "profile": "level{level}", {common}{most}}}"#
            )
        }
    }

    /// The picture at a path `region/size/0/default.jpg`.
    fn picture(&self, path: &str) -> Option<GrayImage> {
        let [region, size, "0", "default.jpg"] = path.split('/').collect::<Vec<_>>()[..] else { return None };
        let (full_width, full_height) = self.picture.dimensions();
        let numbers = |text: &str| text.split(',').map(|n| n.parse().ok()).collect::<Option<Vec<u32>>>();
        let [x, y, width, height] = match region {
            "full" => [0, 0, full_width, full_height],
            region => numbers(region)?.try_into().ok()?,
        };
        if x + width > full_width || y + height > full_height || width == 0 || height == 0 {
            return None;
        }
        let is_whole = region == "full";
        let side = self.service.tile_px.unwrap_or(1);
        let is_tile = x % side == 0
            && y % side == 0
            && width == side.min(full_width - x)
            && height == side.min(full_height - y);
        let largest = self.service.max_width.unwrap_or(u32::MAX).min(width);
        let wanted = match (self.service.version, size) {
            (2, "full") => width,
            (2 | 3, "max") => largest,
            (2, size) => size.strip_suffix(',')?.parse().ok()?,
            (_, size) => numbers(size)?.first().copied().filter(|_| size.contains(','))?,
        };
        if wanted > largest
            || (self.service.tiles_only && !(is_tile && wanted == width && size.contains(',')))
        {
            return None;
        }
        let wanted =
            if is_whole { wanted.min(self.service.silently_at_most.unwrap_or(wanted)) } else { wanted };
        let part = imageops::crop_imm(&self.picture, x, y, width, height).to_image();
        let scaled_height = (f64::from(height) * f64::from(wanted) / f64::from(width)).round() as u32;
        Some(if wanted == width {
            part
        } else {
            imageops::resize(&part, wanted, scaled_height, FilterType::Triangle)
        })
    }
}

/// Sends an answer, or the fault instead; whether the connection can go on.
fn send(
    mut stream: &TcpStream,
    mut head: String,
    mut body: Vec<u8>,
    fault: Option<Fault>,
    sent: impl FnOnce(usize),
) -> std::io::Result<bool> {
    let mut announced = None;
    match fault {
        None => {}
        Some(Fault::Status(status)) => {
            (head, body) = (format!("HTTP/1.1 {status} Fault\r\n"), b"sorry".into());
        }
        Some(Fault::RetryAfter(status, wait)) => {
            (head, body) = (format!("HTTP/1.1 {status} Fault\r\nRetry-After: {wait}\r\n"), Vec::new());
        }
        Some(Fault::Redirect(to)) => {
            (head, body) = (format!("HTTP/1.1 302 Found\r\nLocation: {to}\r\n"), Vec::new());
        }
        Some(Fault::Content(kind, content)) => {
            (head, body) = (format!("HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\n"), content);
        }
        Some(Fault::CutAfter(bytes)) => {
            announced = Some(body.len() as u64);
            body.truncate(bytes);
        }
        Some(Fault::ShortBy(bytes)) => body.truncate(body.len().saturating_sub(bytes)),
        Some(Fault::Length(length)) => (announced, body) = (Some(length), Vec::new()),
        Some(Fault::Endless) => return send_without_end(stream),
        Some(Fault::Silence) => {
            stream.read_exact(&mut [0])?;
            return Ok(false);
        }
    }
    sent(body.len());
    let length = announced.unwrap_or(body.len() as u64);
    stream.write_all(format!("{head}Content-Length: {length}\r\n\r\n").as_bytes())?;
    stream.write_all(&body)?;
    Ok(body.len() as u64 == length)
}

/// Chunks until the client goes away.
fn send_without_end(mut stream: &TcpStream) -> std::io::Result<bool> {
    stream.write_all(b"HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n")?;
    let chunk = [b"1000\r\n".as_slice(), &[0xff; 0x1000], b"\r\n"].concat();
    loop {
        stream.write_all(&chunk)?;
    }
}
