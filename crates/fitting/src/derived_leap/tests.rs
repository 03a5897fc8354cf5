//! What a rider would look at in the derived leap.
use super::*;
use muybridge_core::Database;

#[test]
fn scratch() {
    let reference = Skeleton::reference();
    let database = Database::from_json(&std::fs::read_to_string(format!("/tmp/w/leap/g{}.json", muybridge_core::CURVE_SAMPLES)).unwrap()).unwrap();
    for gallop in database.strides.iter().filter(|s| s.gait == Gait::Gallop && s.provenance.kind() == "captured") {
        let stride = leap(gallop, &reference);
        let Some(stride) = stride else { println!("NONE {}", gallop.id); continue };
        println!("{} {} {} {:?} {:?} {:?}", stride.id, stride.speed_m_s, stride.stride_time_s, stride.contacts, stride.prints_m, stride.provenance);
        println!("{:?}", crate::database_checks::worst_foot_errors(&stride, &reference));
        let skeleton = stride.skeleton(&reference);
        for (name, st) in [("leap", &stride), ("gallop", gallop)] { let v: Vec<String> = (0..28).map(|b| { let c = &st.curves.bends_rad[b]; let n = c.len(); let m = (0..n).map(|k| (c[(k+1)%n]-c[k]).abs()).fold(0.0, f32::max) * n as f32 / st.stride_time_s; format!("{m:.0}") }).collect(); println!("{name} rad/s {}", v.join(" ")); }
        if std::env::var("FEET").is_ok() { for limb in Limb::ALL { let c = stride.contacts[limb.index()]; print!("{limb:?} ");
            for k in -4..(c.duty_factor()*96.0*2.0).round() as i32+5 { let ph=c.strike_phase + k as f32/192.0; let t = stride.pose(ph).joints(&skeleton).toe(limb); print!("{:.1}/{:.1} ", 1e3*(t.x-stride.prints_m[limb.index()]), 1e3*t.y); } println!(); } }
        let fence = Fence::under(&stride, &skeleton, FENCE);
        println!("fence {fence:?} {:?}", Limb::ALL.map(|l| fence.cleared_by_m(&stride, &skeleton, l)));
        let mut d = Database { schema: 2, generator: "x".into(), laws: vec![], strides: vec![stride.clone()] };
        for dev in crate::database_checks::check_database(&d, &reference) { println!("  {dev}"); }
        d.strides.push(gallop.clone());
        let _ = std::fs::create_dir_all("/tmp/w/leap");
        let frames: Vec<_> = (0..480).map(|k| {
            let p = stride.pose(k as f32 / 480.0);
            let j = p.joints(&skeleton);
            let c = p.centre_of_mass(&skeleton);
            serde_json::json!({"bases": j.bases.map(|v| [v.x, v.y]), "tips": j.tips.map(|v| [v.x, v.y]), "com":[c.x,c.y], "down": stride.support(k as f32/480.0), "dock":[j.dock.x,j.dock.y]})
        }).collect();
        std::fs::write(format!("/tmp/w/leap/{}.json", stride.id), serde_json::json!({"frames":frames,"T":stride.stride_time_s,"L":stride.stride_length_m(),"fence":[fence.x_m,fence.height_m], "curves": {"height":stride.curves.height_m,"surge":stride.curves.surge_m,"pitch":stride.curves.pitch_rad,"bends":stride.curves.bends_rad}}).to_string()).unwrap();
    }
}
