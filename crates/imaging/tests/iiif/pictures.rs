//! The right picture from every kind of service.

use muybridge_imaging::fetch::{Progress, stored};

use crate::iiif_server::{Fault, Server, Service};
use crate::{Cache, LIMITS, WHOLE, difference, gray, picture};

#[test]
fn a_whole_picture_is_kept_byte_for_byte() {
    for (version, path) in [(2, "full/full/0/default.jpg"), (3, WHOLE)] {
        let server = Server::start(picture(), Service { version, ..Service::default() });
        let mut cache = Cache::new();
        assert_eq!(stored(&cache.target(), LIMITS.pixels).unwrap(), None);
        let fetched = cache.fetch(&server).unwrap();
        assert_eq!(std::fs::read(&fetched.plate.path).unwrap(), server.whole_jpeg());
        assert_eq!(cache.files(), ["plate-616.jpg"]);
        assert_eq!(server.paths(), ["info.json", path]);
        assert_eq!(server.requests()[1].user_agent, concat!("muybridge/", env!("CARGO_PKG_VERSION")));
        assert_eq!(fetched.url, format!("{}/{path}", server.address()));
        assert_eq!((fetched.plate.width_px, fetched.plate.height_px, fetched.tiles), (300, 200, 0));
        assert_eq!(fetched.full_px, [300, 200]);
        assert_eq!(stored(&cache.target(), LIMITS.pixels).unwrap(), Some(fetched.plate.clone()));
        let bytes = fetched.plate.bytes;
        assert_eq!(cache.told.first(), Some(&Progress::Described { width_px: 300, height_px: 200 }));
        assert_eq!(cache.told.last(), Some(&Progress::Bytes { received: bytes, total: Some(bytes) }));
    }
}

#[test]
fn a_limited_server_is_asked_for_tiles() {
    let paths = [
        (2, Some(128), "256,128,44,72/44,/0/default.jpg", 6),
        (3, Some(128), "256,128,44,72/44,72/0/default.jpg", 6),
        // No tiles listed: regions as large as the limit.
        (3, None, "150,150,150,50/150,50/0/default.jpg", 4),
    ];
    for (version, tile_px, last, tiles) in paths {
        let server = Server::start(
            picture(),
            Service { version, tile_px, max_width: Some(150), ..Service::default() },
        );
        let mut cache = Cache::new();
        let fetched = cache.fetch(&server).unwrap();
        assert_eq!(cache.files(), ["plate-616.png"]);
        assert_eq!(server.paths().last().unwrap(), last);
        assert_eq!((fetched.tiles, fetched.full_px), (tiles, [300, 200]));
        assert!(difference(&gray(&fetched.plate.path), &picture()) < 1.0);
        assert_eq!(stored(&cache.target(), LIMITS.pixels).unwrap(), Some(fetched.plate.clone()));
        let Some(Progress::Tiles { done, total, bytes }) = cache.told.last() else { panic!() };
        assert_eq!((*done, *total), (tiles, tiles));
        assert!(*bytes > 10_000);
        // Equal answers, equal bytes.
        assert_eq!(Cache::new().fetch(&server).unwrap().plate.sha256, fetched.plate.sha256);
    }
}

#[test]
fn a_server_of_ready_made_tiles_is_asked_for_those() {
    for version in [2, 3] {
        let service = Service { version, tile_px: Some(64), tiles_only: true, ..Service::default() };
        let server = Server::start(picture(), service);
        let mut cache = Cache::new();
        let fetched = cache.fetch(&server).unwrap();
        assert_eq!(fetched.tiles, 5 * 4);
        assert_eq!(cache.files(), ["plate-616.png"]);
        assert!(difference(&gray(&fetched.plate.path), &picture()) < 1.0);
    }
}

#[test]
fn a_silently_smaller_picture_is_not_enough_where_tiles_are_listed() {
    let service = Service { silently_at_most: Some(90), tile_px: Some(100), ..Service::default() };
    let server = Server::start(picture(), service.clone());
    let mut cache = Cache::new();
    let fetched = cache.fetch(&server).unwrap();
    assert_eq!((fetched.plate.width_px, fetched.tiles), (300, 6));
    assert_eq!(cache.files(), ["plate-616.png"]);
    // Without tiles the smaller one is all there is, and the answer says so.
    let server = Server::start(picture(), Service { tile_px: None, ..service });
    let fetched = cache.fetch(&server).unwrap();
    assert_eq!((fetched.plate.width_px, fetched.plate.height_px, fetched.full_px), (90, 60, [300, 200]));
    assert_eq!(cache.files(), ["plate-616.jpg"], "the earlier form is gone");
}

#[test]
fn a_size_that_is_offered_is_found() {
    // A server of version 2.1 that has given up `full`, and one of ready-made sizes.
    let cases = [
        (&["full/full/"][..], "full/max/0/default.jpg", 300),
        (&["full/full/", "full/max/"], "full/90,/0/default.jpg", 90),
    ];
    for (refused, path, width) in cases {
        let info = r#"{"@context": "http://iiif.io/api/image/2/context.json", "width": 300, "height": 200,
            "profile": "http://iiif.io/api/image/2/level0.json",
            "sizes": [{"width": 30, "height": 20}, {"width": 90, "height": 60}]}"#;
        let service = Service { version: 2, info: Some(info.into()), ..Service::default() };
        let server = Server::start_with_faults(picture(), service, |request| {
            refused.iter().any(|start| request.path.starts_with(start)).then_some(Fault::Status(404))
        });
        let fetched = Cache::new().fetch(&server).unwrap();
        assert_eq!(fetched.url, format!("{}/{path}", server.address()));
        assert_eq!((fetched.plate.width_px, fetched.full_px), (width, [300, 200]));
    }
}
