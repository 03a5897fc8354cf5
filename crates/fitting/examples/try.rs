//! scratch
use muybridge_capture::*;
use muybridge_core::*;
use muybridge_fitting::{chain::*, observation::*, stride_fit::*, weights::*};
fn main() {
    let plate = Plate::load(std::path::Path::new("annotations/sallie-gardner-1878.json"))
        .unwrap_or_else(|e| panic!("{e}"));
    let cal = calibrate(&plate.manifest, &plate.annotation).unwrap();
    println!("parallax {:?}", cal.parallax);
    for d in &cal.disagreements {
        println!("{} {:?} {:?} {:.1}% {:.1} sigma", d.quantity, d.used, d.other, d.percent(), d.sigmas());
    }
    println!("withers {:?} speed {:?} interval {:?}", cal.withers_height_m, cal.speed_m_s, cal.interval_s);
    let w = Weights::default();
    let sk = Skeleton::reference();
    let obs = StrideObservation::new(&plate, &cal, &w);
    println!(
        "times {:?}",
        obs.panels.iter().map(|p| (p.camera.time_s * 1e4).round() / 1e4).collect::<Vec<_>>()
    );
    let t = std::time::Instant::now();
    let f = fit_stride(&sk, &obs, StrideTime { seconds: 0.415, sd_s: 0.0 }, &w);
    println!(
        "one fit {:?} steps {} cost {} conv {}",
        t.elapsed(),
        f.optimum.steps,
        f.optimum.cost,
        f.optimum.converged
    );
    let f = fit_stride_of_unknown_time(&sk, &obs, &w);
    println!(
        "search {:?} T {:?} cost {} phases {:?} order {:?}",
        t.elapsed(),
        f.stride_time,
        f.optimum.cost,
        f.problem.phases,
        f.problem.order
    );
    for i in 0..=20 {
        let s = 0.36 + 0.005 * i as f64;
        let g = refit_stride(&sk, &obs, StrideTime { seconds: s, sd_s: 0. }, &w, &f);
        print!("{:.3}:{:.1} ", s, g.optimum.cost);
    }
    println!();
    let r = f.residuals_of(&obs);
    println!(
        "rms px {:.2} m {:.4} withers {:.3}",
        rms(r.iter().map(|r| r.px())),
        rms(r.iter().map(|r| r.metres())),
        f.withers_height_m(&sk)
    );
    for kp in Keypoint::all() {
        let v: Vec<_> = r.iter().filter(|r| r.keypoint == kp).collect();
        println!(
            "{:18} {:5.2} {}",
            kp.name(),
            rms(v.iter().map(|r| r.px())),
            v.iter().map(|r| format!("{:5.1}", r.px())).collect::<Vec<_>>().join(" ")
        );
    }
    for b in 0..18 {
        let bb = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 18, 19, 20, 21, 22][b];
        println!(
            "{:12} ref {:.3} fit {:.3} {:+.2}",
            sk.bones[bb].name,
            sk.bones[bb].length_m,
            f.problem.bone_length_m(bb, f.shared()),
            f.shared()[b]
        );
    }
    println!("dock {:+.3} scale {:+.3}", f.shared()[18], f.shared()[19]);
    ho(&f, &w, &sk);
    bends(&f);
    cont(&f);
    // dump
    let ks = f.kinematics();
    let mut out = String::from("{");
    for (slot, k) in ks.iter().enumerate() {
        let p = obs.panels[f.problem.order[slot]].camera.panel;
        out += &format!("{}\"{}\":[", if slot > 0 { "," } else { "" }, p);
        for b in 0..28 {
            let cam = &obs.panels[f.problem.order[slot]].camera;
            let d = depth_m(&Chain::new(&sk), Attachment::Tip(b), obs.facing);
            let [a, t] = k.bone(b);
            let q = cam.plate_from_world([a[0], a[1], d]);
            let r = cam.plate_from_world([t[0], t[1], d]);
            out += &format!("{}[{},{},{},{}]", if b > 0 { "," } else { "" }, q[0], q[1], r[0], r[1]);
        }
        out += "]";
    }
    out += "}";
    std::fs::write("/tmp/w/fit.json", out).unwrap();
}
fn ho(f: &StrideFit, w: &Weights, sk: &Skeleton) {
    let t = std::time::Instant::now();
    let h = muybridge_fitting::held_out::held_out_errors(sk, f, w);
    let v: Vec<f64> = h.iter().map(|r| r.metres() / 1.527 * 100.).collect();
    println!(
        "heldout {:?} n {} median {:.2}% p90 {:.2}%",
        t.elapsed(),
        v.len(),
        muybridge_fitting::held_out::quantile(&v, 0.5),
        muybridge_fitting::held_out::quantile(&v, 0.9)
    );
    for kp in Keypoint::all() {
        let v: Vec<f64> = h.iter().filter(|r| r.keypoint == kp).map(|r| r.metres() * 100. / 1.527).collect();
        if !v.is_empty() {
            println!(
                "{:18} {}",
                kp.name(),
                v.iter().map(|r| format!("{:5.1}", r)).collect::<Vec<_>>().join(" ")
            );
        }
    }
}
fn bends(f: &StrideFit) {
    for limb in Limb::ALL {
        println!("{:?}", limb);
        for slot in 0..f.problem.layout.panels {
            let p = f.pose(slot);
            let o = &f.observation.panels[f.problem.order[slot]];
            let b = 3 + limb.first_bone();
            let d = |i: usize| p[b + i].to_degrees();
            let abs: f64 = p[2]
                + if limb.index() < 2 { p[3] + p[4] + p[5] + p[6] } else { 0.0 }
                + p[b]
                + p[b + 1]
                + p[b + 2]
                + p[b + 3];
            println!(
                "  ph {:.2} panel {:2} {:?} root {:6.1} upper {:6.1} mid {:6.1} cannon {:6.1} hoof {:6.1}  cannonabs {:6.1}",
                f.problem.phases[slot],
                o.camera.panel,
                o.contacts[limb.index()],
                d(0),
                d(1),
                d(2),
                d(3),
                d(4),
                abs.to_degrees()
            );
        }
    }
    for slot in 0..f.problem.layout.panels {
        let p = f.pose(slot);
        let a: f64 = (p[2] + (3..11).map(|i| p[i]).sum::<f64>()).to_degrees();
        println!(
            "head abs {:.1} pitch {:.1} spine {:?}",
            a,
            p[2].to_degrees(),
            (3..11).map(|i| (p[i].to_degrees()).round()).collect::<Vec<_>>()
        );
    }
}
fn cont(f: &StrideFit) {
    let c = muybridge_fitting::contacts::find_contacts(f, &[], 1.527).unwrap();
    let t = f.stride_time.seconds;
    for x in &c {
        println!(
            "{:?} strike {:.3}±{:.3} off {:.3}±{:.3} stance {:.4}s ±{:.4} duty {:.3}",
            x.limb,
            x.strike.phase,
            x.strike.sd,
            x.lift_off.phase,
            x.lift_off.sd,
            x.duty_factor() * t,
            x.duty_factor_sd() * t,
            x.duty_factor()
        );
    }
    let g = muybridge_fitting::gait_analysis::GaitAnalysis::new(c, [t, f.stride_time.sd_s]);
    println!(
        "{:?} lead {:?} order {:?} duty {:.3} lag {:.3} susp {:?} support {:?} fore {:?} hind {:?}",
        g.implied,
        g.lead,
        g.footfall_order(),
        g.hind_duty_factor(),
        g.lateral_lag(),
        g.suspensions,
        g.support_s(),
        g.stance_s(Pair::Fore),
        g.stance_s(Pair::Hind)
    );
}
