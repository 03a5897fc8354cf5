//! What has arrived is not fetched again, and what is there is not lost.

use std::time::Duration;

use muybridge_imaging::fetch::{FetchError, FetchLimits, stored};

use crate::iiif_server::{Fault, Request, Server, Service};
use crate::{Cache, LIMITS, WHOLE, assert_fails, at, difference, first, gray, picture};

#[test]
fn a_broken_download_goes_on_where_it_broke() {
    let server =
        Server::start_with_faults(picture(), Service::default(), first(1, WHOLE, Fault::CutAfter(10_000)));
    let mut cache = Cache::new();
    let fetched = cache.fetch(&server).unwrap();
    assert_eq!(std::fs::read(&fetched.plate.path).unwrap(), server.whole_jpeg());
    assert_eq!(cache.files(), ["plate-616.jpg"]);
    let [_, broken, rest] = &server.requests()[..] else { panic!() };
    assert_eq!((broken.sent, rest.range_from), (10_000, Some(10_000)));
    assert_eq!(broken.sent + rest.sent, server.whole_jpeg().len());
    assert_eq!(cache.waits(), 1);
}

#[test]
fn a_later_fetch_goes_on_from_the_part() {
    let faults = |request: &Request| match (request.path.as_str(), request.earlier) {
        (WHOLE, 0) => Some(Fault::CutAfter(10_000)),
        (WHOLE, 1) => Some(Fault::CutAfter(7)),
        (WHOLE, 2) => Some(Fault::Silence),
        _ => None,
    };
    let server = Server::start_with_faults(picture(), Service::default(), faults);
    let mut cache = Cache::new();
    let limits = FetchLimits { timeout: Duration::from_millis(500), ..LIMITS };
    let error = cache.fetch_within(&server.address(), &limits).unwrap_err();
    assert!(matches!(error, FetchError::TimedOut { .. }), "{error}");
    assert!(
        error.to_string().contains(WHOLE) && error.to_string().contains("no data within 0.5 s"),
        "{error}"
    );
    assert_eq!(cache.files(), ["plate-616.part", "plate-616.part.json"]);
    let fetched = cache.fetch(&server).unwrap();
    assert_eq!(server.requests().last().unwrap().range_from, Some(10_007));
    assert_eq!(std::fs::read(&fetched.plate.path).unwrap(), server.whole_jpeg());
    assert_eq!(cache.files(), ["plate-616.jpg"]);
}

#[test]
fn a_part_of_something_else_is_not_gone_on_from() {
    let right = format!("\"{}\"", Server::start(picture(), Service::default()).whole_jpeg().len());
    let cases = [
        (right.as_str(), 5, Some(5), "the content differs"),
        ("\"1\"", 5, Some(5), "the validator differs"),
        // The server says 416.
        ("\"1\"", 100_000, Some(100_000), "longer than the picture"),
    ];
    for (validator, length, range, why) in cases {
        let server = Server::start(picture(), Service::default());
        let mut cache = Cache::new();
        std::fs::create_dir(cache.folder.path().join("cache")).unwrap();
        muybridge_capture::write_atomically(&cache.target().with_extension("part"), &vec![7; length])
            .unwrap();
        let url = format!("{}/{WHOLE}", server.address());
        let origin = format!("{{\"url\": {url:?}, \"validator\": {validator:?}}}");
        muybridge_capture::write_atomically(&cache.target().with_extension("part.json"), origin.as_bytes())
            .unwrap();
        let fetched = cache.fetch(&server).unwrap();
        assert_eq!(server.requests()[1].range_from, range, "{why}");
        assert_eq!(std::fs::read(&fetched.plate.path).unwrap(), server.whole_jpeg(), "{why}");
        assert_eq!(cache.files(), ["plate-616.jpg"]);
    }
}

#[test]
fn a_server_that_cannot_resume_starts_over() {
    let service = Service { resumes: false, ..Service::default() };
    let server =
        Server::start_with_faults(picture(), service.clone(), first(1, WHOLE, Fault::CutAfter(10_000)));
    let mut cache = Cache::new();
    cache.fetch(&server).unwrap();
    assert!(server.requests().iter().all(|request| request.range_from.is_none()));
    assert_eq!(server.requests().last().unwrap().sent, server.whole_jpeg().len());
    // Without a validator a part is no use later.
    assert_fails(service, at(WHOLE, Fault::CutAfter(10_000)), [WHOLE, "broke off after 10000 bytes"]);
}

#[test]
fn tiles_that_have_arrived_are_not_fetched_again() {
    const SECOND: &str = "128,0,128,128/128,128/0/default.jpg";
    let service = Service { tile_px: Some(128), max_width: Some(150), ..Service::default() };
    let server = Server::start_with_faults(picture(), service, first(3, SECOND, Fault::CutAfter(100)));
    let mut cache = Cache::new();
    let message = cache.fetch(&server).unwrap_err().to_string();
    assert!(message.contains(SECOND) && message.contains("fetch again to go on"), "{message}");
    assert_eq!(cache.files(), ["plate-616.tiles"]);
    let fetched = cache.fetch(&server).unwrap();
    assert!(difference(&gray(&fetched.plate.path), &picture()) < 1.0);
    let first_tile = server.paths().iter().filter(|path| path.starts_with("0,0,")).count();
    assert_eq!(first_tile, 1);
    assert_eq!(cache.files(), ["plate-616.png"]);
}

#[test]
fn a_part_that_another_run_writes_is_left_alone() {
    let server = Server::start(picture(), Service::default());
    let mut cache = Cache::new();
    std::fs::create_dir(cache.folder.path().join("cache")).unwrap();
    let other = std::fs::File::create(cache.target().with_extension("part")).unwrap();
    other.lock().unwrap();
    let message = cache.fetch(&server).unwrap_err().to_string();
    assert!(message.contains("plate-616.part: being fetched by another run; wait"), "{message}");
    assert_eq!(cache.files(), ["plate-616.part"]);
    drop(other);
    cache.fetch(&server).unwrap();
    assert_eq!(cache.files(), ["plate-616.jpg"]);
}

#[test]
fn a_failure_leaves_the_picture_that_was_there() {
    let server = Server::start_with_faults(picture(), Service::default(), |request| {
        (request.path == "info.json" && request.earlier > 0).then_some(Fault::Status(404))
    });
    let mut cache = Cache::new();
    let fetched = cache.fetch(&server).unwrap();
    cache.fetch(&server).unwrap_err();
    assert_eq!(cache.files(), ["plate-616.jpg"]);
    assert_eq!(stored(&cache.target(), LIMITS.pixels).unwrap(), Some(fetched.plate.clone()));
    // A damaged one counts as none.
    let jpeg = std::fs::read(&fetched.plate.path).unwrap();
    muybridge_capture::write_atomically(&fetched.plate.path, &jpeg[..jpeg.len() - 100]).unwrap();
    assert_eq!(stored(&cache.target(), LIMITS.pixels).unwrap(), None);
}
