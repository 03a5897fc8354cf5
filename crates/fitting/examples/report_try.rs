//! scratch
use muybridge_fitting::*;
fn main() {
    let sk = muybridge_core::Skeleton::reference();
    let mut fits = Vec::new();
    let mut failures = Vec::new();
    for path in std::env::args().skip(2) {
        match pipeline::fit_plate(std::path::Path::new(&path), &sk, &weights::Weights::default()) {
            Ok(fit) => fits.push(fit),
            Err(e) => failures.push(e.to_string()),
        }
    }
    let out = std::env::args().nth(1).unwrap_or_default();
    let page = report::html(&fits, &motion_database::gait_laws(&fits), &failures, &sk);
    println!("{} bytes", page.len());
    muybridge_capture::write_atomically(std::path::Path::new(&out), page.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
}
