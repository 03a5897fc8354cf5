use muybridge_core::*;
use muybridge_fitting::{chain::*, layout::*, synthetic::*};
#[test]
fn explore() {
    for seed in 0..20 {
        let s = SyntheticStride::new(seed, 24);
        let mut low = [9f64; 4];
        let mut at = [0; 4];
        for p in 0..24 {
            let k = s.kinematics(p);
            for l in Limb::ALL {
                let [_, y] = k.place(Attachment::Tip(l.hoof_bone()));
                if !s.down[p][l.index()] && y < low[l.index()] {
                    low[l.index()] = y;
                    at[l.index()] = p;
                }
            }
        }
        print!("seed {seed} lowest swing {low:.3?} at {at:?} root y {:.2} ", s.poses[0][1]);
        for b in 0..28 {
            let v: Vec<f64> = s.poses.iter().map(|p| p[BENDS + b].to_degrees()).collect();
            let (lo, hi) = (v.iter().cloned().fold(999., f64::min), v.iter().cloned().fold(-999., f64::max));
            let [l, h] = s.horse.bones[b].limits_rad.map(|v| v.to_degrees() as f64);
            if lo < l || hi > h {
                print!(" {b}{}:{lo:.0}..{hi:.0} of {l:.0}..{h:.0}", s.horse.bones[b].name);
            }
            if seed < 2 && b >= 8 {
                print!(
                    "\n  {b} {} {}",
                    s.horse.bones[b].name,
                    v.iter().map(|v| format!("{v:.0}")).collect::<Vec<_>>().join(" ")
                );
            }
        }
        println!();
    }
}
