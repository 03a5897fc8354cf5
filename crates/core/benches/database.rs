//! How long the embedded motion database takes to read, against reading the same text without making anything of it.
//!
//! `cargo bench -p muybridge-core`

use std::time::{Duration, Instant};

use muybridge_core::{CURVE_SAMPLES, Database};

const ROUNDS: usize = 200;
/// Longest that is wanted.
const WANTED: Duration = Duration::from_millis(2);

fn median(mut run: impl FnMut()) -> Duration {
    let mut times: Vec<Duration> = (0..ROUNDS)
        .map(|_| {
            let start = Instant::now();
            run();
            start.elapsed()
        })
        .collect();
    times.sort();
    times[ROUNDS / 2]
}

fn main() {
    let text = include_str!("../data/motion.json");
    let load = median(|| drop(std::hint::black_box(Database::embedded())));
    let bare = median(|| drop(std::hint::black_box(serde_json::from_str::<serde_json::Value>(text))));
    let strides = Database::embedded().strides.len();
    println!("{strides} strides of {CURVE_SAMPLES} samples, {:.0} kB", text.len() as f64 / 1000.0);
    println!(
        "load {load:.2?}, {:.2} times as long as the bare text ({bare:.2?})",
        load.as_secs_f64() / bare.as_secs_f64()
    );
    println!("wanted at most {WANTED:?}: {}", if load <= WANTED { "held" } else { "MISSED" });
}
