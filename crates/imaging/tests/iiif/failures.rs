//! Servers that are away, refuse, lie or send too much: a clear message, and nothing left behind.

use std::time::{Duration, Instant};

use image::GrayImage;
use muybridge_imaging::fetch::{FetchError, FetchLimits, Progress};

use crate::iiif_server::{Fault, Request, Server, Service};
use crate::{Cache, LIMITS, WHOLE, assert_fails, at, first, picture};

#[test]
fn a_server_out_of_order_is_asked_again() {
    for fault in [Fault::Status(500), Fault::Status(503), Fault::CutAfter(0), Fault::ShortBy(2)] {
        let server = Server::start_with_faults(picture(), Service::default(), first(2, WHOLE, fault));
        let mut cache = Cache::new();
        let fetched = cache.fetch(&server).unwrap();
        assert_eq!(std::fs::read(&fetched.plate.path).unwrap(), server.whole_jpeg());
        let waits = cache.told.iter().filter_map(|progress| match progress {
            Progress::Waiting { wait, .. } => Some(wait.as_millis()),
            _ => None,
        });
        assert_eq!(waits.collect::<Vec<_>>(), [5, 10], "the wait doubles");
    }
    let server =
        Server::start_with_faults(picture(), Service::default(), first(1, "info.json", Fault::Status(502)));
    Cache::new().fetch(&server).unwrap();
}

#[test]
fn a_server_that_asks_for_patience_gets_it_within_reason() {
    let server =
        Server::start_with_faults(picture(), Service::default(), first(1, WHOLE, Fault::RetryAfter(429, 1)));
    let begin = Instant::now();
    Cache::new().fetch(&server).unwrap();
    assert!(begin.elapsed() >= Duration::from_secs(1));
    let cache = assert_fails(
        Service::default(),
        at(WHOLE, Fault::RetryAfter(429, 3600)),
        [WHOLE, "429 Too Many Requests; fetch again in 3600 s"],
    );
    assert_eq!(cache.waits(), 0);
}

#[test]
fn a_redirect_is_followed_and_a_loop_is_not() {
    let target = Server::start(picture(), Service::default());
    let to = format!("{}/{WHOLE}", target.address());
    let server = Server::start_with_faults(picture(), Service::default(), at(WHOLE, Fault::Redirect(to)));
    let mut cache = Cache::new();
    let fetched = cache.fetch(&server).unwrap();
    assert_eq!(std::fs::read(&fetched.plate.path).unwrap(), target.whole_jpeg());
    assert_eq!(target.paths(), [WHOLE]);
    for path in ["info.json", WHOLE] {
        let to = Fault::Redirect(format!("/iiif/plate/{path}"));
        let cache = assert_fails(
            Service::default(),
            at(path, to),
            [path, "more than 5 redirects; check the address"],
        );
        assert_eq!(cache.waits(), 0);
    }
    // An address that leads to this computer, but is not known to.
    if cfg!(target_os = "linux") {
        let to = Fault::Redirect(target.address().replace("127.0.0.1", "0.0.0.0"));
        assert_fails(Service::default(), at(WHOLE, to), [WHOLE, "which is not encrypted; check the address"]);
    }
}

#[test]
fn refusals_are_told_at_once() {
    for (status, words) in [
        (401, "401 Unauthorized; it wants a login"),
        (403, "403 Forbidden; it refuses"),
        (404, "404 Not Found; there is no such plate"),
        (418, "418 I'm a teapot; it does not answer"),
        (501, "501 Not Implemented; it does not answer"),
    ] {
        for path in ["info.json", WHOLE] {
            let fault = Fault::Status(status);
            let faults = move |request: &Request| {
                (request.path == path || (path == WHOLE && request.path.starts_with("full")))
                    .then(|| fault.clone())
            };
            assert_eq!(assert_fails(Service::default(), faults, [path, words]).waits(), 0);
        }
    }
    let cache = assert_fails(
        Service::default(),
        at(WHOLE, Fault::Status(500)),
        [WHOLE, "busy or out of order; fetch again"],
    );
    assert_eq!(cache.waits(), 2);
}

#[test]
fn no_server_is_said_to_be_out_of_reach() {
    let server = Server::start(picture(), Service::default());
    let closed = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let refused = format!("http://{closed}/iiif/plate");
    let mut cache = Cache::new();
    let message = cache.fetch_within(&refused, &LIMITS).unwrap_err().to_string();
    assert!(message.contains(&refused) && message.contains("cannot be reached"), "{message}");
    assert!(message.contains("check the network connection"), "{message}");
    assert!(cache.files().is_empty() && cache.waits() == 0);
    // Not encrypted and not on this computer, and no address at all: not asked.
    for address in [server.address().replace("127.0.0.1", "0.0.0.0"), "616".into()] {
        let message = cache.fetch_within(&address, &LIMITS).unwrap_err().to_string();
        assert!(message.contains(&address) && message.contains("https://"), "{message}");
    }
    assert!(server.requests().is_empty());
}

#[test]
fn wrong_content_leaves_nothing() {
    let html = || Fault::Content("text/html", b"<!DOCTYPE html><title>Please log in</title>".into());
    assert_fails(
        Service::default(),
        at(WHOLE, html()),
        [WHOLE, "no JPEG picture but 43 bytes beginning with \"<!DOCTYPE html>"],
    );
    assert_fails(
        Service::default(),
        at("info.json", html()),
        ["info.json", "beginning with \"<!DOCTYPE html>"],
    );
    assert_fails(
        Service::default(),
        at(WHOLE, Fault::Content("image/jpeg", Vec::new())),
        [WHOLE, "no JPEG picture but 0 bytes"],
    );
    // Cut short, and the server says that this is all.
    assert_fails(Service::default(), at(WHOLE, Fault::ShortBy(2)), [WHOLE, "cut short after"]);
    let square = Server::start(GrayImage::new(100, 100), Service::default()).whole_jpeg();
    let other = Fault::Content("image/jpeg", square);
    assert_fails(
        Service::default(),
        at(WHOLE, other.clone()),
        [WHOLE, "100 x 100 px, where 300 x 200 px are described"],
    );
    const TILE: &str = "128,128,128,72/128,72/0/default.jpg";
    let tiled = Service { tile_px: Some(128), max_width: Some(150), ..Service::default() };
    assert_fails(tiled.clone(), at(TILE, other), [TILE, "a tile of 100 x 100 px, not 128 x 72 px"]);
    assert_fails(tiled, at(TILE, html()), [TILE, "no JPEG picture"]);
}

#[test]
fn what_is_too_much_leaves_nothing() {
    let limits = "more than the 10 MB that are fetched";
    assert_fails(Service::default(), at(WHOLE, Fault::Length(1 << 40)), [WHOLE, limits]);
    assert_fails(Service::default(), at(WHOLE, Fault::Endless), [WHOLE, limits]);
    assert_fails(
        Service::default(),
        at("info.json", Fault::Endless),
        ["info.json", "more than 1000000 bytes"],
    );
    let info = |size: &str| Service {
        info: Some(format!(r#"{{"type": "ImageService3", "profile": "level2", {size}}}"#)),
        ..Service::default()
    };
    let huge = info(r#""width": 100000, "height": 100000"#);
    assert_fails(huge, |_| None, ["info.json", "100000 x 100000 pixels are more than the 10 megapixels"]);
    let endless = info(r#""width": 18446744073709551615, "height": 1"#);
    assert_fails(endless, |_| None, ["info.json", "megapixels"]);
    let dust = info(
        r#""width": 3000, "height": 3000, "maxWidth": 2000, "tiles": [{"width": 1, "scaleFactors": [1]}]"#,
    );
    assert_fails(dust, |_| None, ["info.json", "9000000 tiles"]);
    // The description is modest, the picture is not.
    let modest = info(r#""width": 30, "height": 20"#);
    let server = Server::start(picture(), modest);
    let mut cache = Cache::new();
    let error = cache.fetch_within(&server.address(), &FetchLimits { pixels: 50_000, ..LIMITS }).unwrap_err();
    assert!(matches!(error, FetchError::TooManyPixels { width: 300, height: 200, .. }), "{error}");
    assert!(cache.files().is_empty());
    // All tiles together.
    let tiled = Service { tile_px: Some(128), max_width: Some(150), ..Service::default() };
    let server = Server::start(picture(), tiled);
    let limit = server.whole_jpeg().len() as u64 / 2;
    let error = cache.fetch_within(&server.address(), &FetchLimits { bytes: limit, ..LIMITS }).unwrap_err();
    assert!(matches!(error, FetchError::TooManyBytes { .. }), "{error}");
    assert!(server.paths().len() > 2 && cache.files().is_empty());
}
