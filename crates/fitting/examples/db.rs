//! scratch
use muybridge_fitting::*;
fn main() {
    let sk = muybridge_core::Skeleton::reference();
    let t = std::time::Instant::now();
    let f = pipeline::fit_plate(
        std::path::Path::new("annotations/sallie-gardner-1878.json"),
        &sk,
        &weights::Weights::default(),
    )
    .unwrap_or_else(|e| panic!("{e}"));
    println!(
        "{:?} warnings {:?} froude {:.2} L {:?}",
        t.elapsed(),
        f.warnings,
        f.froude(),
        f.stride_length_m()
    );
    for l in motion_database::gait_laws(std::slice::from_ref(&f)) {
        println!(
            "{:?} {:?} a {:.4} b {:.4} n {} {:?}",
            l.law.gait,
            l.law.law,
            l.law.curve.a,
            l.law.curve.b,
            l.law.n,
            l.law.provenance.kind()
        );
    }
    let db = motion_database::build_database(std::slice::from_ref(&f), &sk);
    println!(
        "{:?} strides {:?}",
        t.elapsed(),
        db.strides.iter().map(|s| format!("{} {:.3}s", s.id, s.stride_time_s)).collect::<Vec<_>>()
    );
    let s = muybridge_capture::to_stable_json(&db);
    println!("{} bytes", s.len());
    muybridge_capture::write_json(std::path::Path::new("crates/core/data/motion.json"), &db).unwrap();
    for s in &db.strides {
        let k = s.skeleton(&sk);
        let mut worst = 0f32;
        let mut hi = 0f32;
        for limb in muybridge_core::Limb::ALL {
            let c = s.contacts[limb.index()];
            for i in 0..400 {
                let ph = i as f32 / 400.;
                if c.contains(ph) {
                    let since = (ph - c.strike_phase).rem_euclid(1.0);
                    let p = s.pose(c.strike_phase + since).joints(&k).toe(limb);
                    worst = worst.max((p.x - s.prints_m[limb.index()]).abs());
                    hi = hi.max(p.y.abs());
                }
            }
        }
        println!("{} slip {:.4} sink {:.4}", s.id, worst, hi);
    }
}
