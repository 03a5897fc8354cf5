//! The report as its reader meets it: well formed, complete, self-contained.

use std::path::Path;
use std::sync::OnceLock;

use muybridge_core::{Database, Gait, Skeleton};

use super::html;
use crate::gait_laws::{Evidence, gait_laws};
use crate::motion_database::build_database;
use crate::pipeline::{PlateFit, fit_plate};
use crate::weights::Weights;

/// A plate whose title would break a page that does not escape it. Fitted once for all tests.
pub(super) fn plate() -> &'static PlateFit {
    static PLATE: OnceLock<PlateFit> = OnceLock::new();
    PLATE.get_or_init(|| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../annotations/sallie-gardner-1878.json");
        let mut fit = fit_plate(&path, &Skeleton::reference(), &Weights::default()).unwrap();
        fit.plate.manifest.title = "Sallie <Gardner> & \"friends\"".into();
        fit.plate.manifest.animal = "S. <&> G.".into();
        fit
    })
}

/// The database of that plate.
pub(super) fn database() -> Database {
    static DATABASE: OnceLock<Database> = OnceLock::new();
    let fits = std::slice::from_ref(plate());
    let build = || build_database(&Evidence { fits, ..Evidence::default() }, &Skeleton::reference());
    DATABASE.get_or_init(build).clone()
}

fn page() -> String {
    let fits = std::slice::from_ref(plate());
    html(
        fits,
        &gait_laws(&Evidence { fits, ..Evidence::default() }),
        &database(),
        &["bad-plate.json: panel 3: <marks> & ground".into()],
        &Skeleton::reference(),
    )
}

/// Every tag closed in the right order, attributes quoted, no stray brackets or ampersands.
fn check_well_formed(page: &str) {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = page.strip_prefix("<!DOCTYPE html>").unwrap();
    while let Some(at) = rest.find('<') {
        assert!(!rest[..at].contains('>'), "stray bracket near {}", &rest[..at]);
        for reference in rest[..at].split('&').skip(1) {
            let name = reference.split(';').next().unwrap();
            assert!(
                reference.contains(';') && name.len() < 8 && !name.contains(' '),
                "stray ampersand: {reference}"
            );
        }
        let end = at + rest[at..].find('>').unwrap();
        let tag = &rest[at + 1..end];
        assert!(tag.matches('"').count().is_multiple_of(2) && !tag.contains('<'), "{tag}");
        let name = tag.trim_start_matches('/').split([' ', '/']).next().unwrap();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "near {}", &rest[..at]);
        } else if !tag.ends_with('/') {
            open.push(name);
        }
        rest = &rest[end + 1..];
        if name == "style" && !tag.starts_with('/') {
            rest = &rest[rest.find("</style>").unwrap()..];
        }
    }
    assert!(open.is_empty(), "left open: {open:?}");
}

#[test]
fn page_is_well_formed_with_and_without_plates() {
    check_well_formed(&page());
    let (nothing, skeleton) = (Evidence::default(), Skeleton::reference());
    let (laws, empty) = (gait_laws(&nothing), build_database(&nothing, &skeleton));
    check_well_formed(&html(&[], &laws, &empty, &["nothing < fitted".into()], &skeleton));
    check_well_formed(&html(&[], &[], &empty, &[], &skeleton));
}

#[test]
fn text_from_files_is_escaped() {
    let page = page();
    assert!(page.contains("Sallie &lt;Gardner&gt; &amp; &quot;friends&quot;"));
    assert!(page.contains("bad-plate.json: panel 3: &lt;marks&gt; &amp; ground"));
    assert!(!page.contains("<Gardner>") && !page.contains("S. <&> G."));
}

#[test]
fn page_loads_nothing_from_elsewhere() {
    let page = page();
    for reference in page.split("href=\"").skip(1) {
        assert!(reference.starts_with('#'), "{}", &reference[..40]);
    }
    for loader in ["src=", "url(", "@import", "<script", "<link", "<iframe", "<object"] {
        assert!(!page.contains(loader), "{loader}");
    }
}

#[test]
fn links_lead_somewhere_and_anchors_are_unique() {
    let page = page();
    let ids: Vec<&str> = page.split(" id=\"").skip(1).filter_map(|s| s.split('"').next()).collect();
    for (i, id) in ids.iter().enumerate() {
        assert!(!ids[..i].contains(id), "{id} twice");
    }
    for link in page.split("href=\"#").skip(1).filter_map(|s| s.split('"').next()) {
        assert!(ids.contains(&link), "{link}");
    }
}

#[test]
fn same_fits_give_the_same_bytes() {
    assert_eq!(page(), page());
}

#[test]
fn every_gait_with_a_law_has_its_section_with_two_plots() {
    let page = page();
    for gait in Gait::ALL.into_iter().filter(|gait| *gait != Gait::Leap) {
        let start = page.find(&format!("<section id=\"gait-{gait}\">")).unwrap();
        let section = &page[start..start + page[start..].find("</section>").unwrap()];
        assert_eq!(section.matches("<svg").count(), 2, "{gait}");
    }
    assert!(!page.contains("gait-leap"));
}

#[test]
fn numbers_are_finite_and_plots_drawn() {
    let page = page();
    assert!(!page.contains("NaN") && !page.contains("was not drawn"));
    assert!(!page.split(['>', ' ']).any(|word| word == "inf"));
}
