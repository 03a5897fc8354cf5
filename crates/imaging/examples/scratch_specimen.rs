//! Scratch.
use muybridge_imaging::specimen::*;
use muybridge_capture::*;
use muybridge_core::*;
fn sallie() -> SpecimenMotion {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let plate = Plate::load(&root.join("annotations/sallie-gardner-1878.json")).unwrap();
    let cal = calibrate(&plate.manifest, &plate.annotation).unwrap();
    let facing = Facing::Right;
    let sk = Skeleton::reference();
    let mut poses = vec![];
    for cam in &cal.stride {
        let p = plate.annotation.panels.iter().find(|p| p.panel == cam.panel).unwrap();
        let lat = |i: usize| f64::from(sk.bones[i].lateral_m);
        let z = |i: usize| lat(i) - 0.12;
        let at = |k: Keypoint, z: f64| cam.world_from_plate(p.keypoints.place(k).unwrap_or([0.0, 0.0]), z);
        let body = |b| at(Keypoint::Body(b), -0.12);
        let (croup, back, withers, poll, muzzle, dock) = (body(BodyPoint::Croup), body(BodyPoint::Back), body(BodyPoint::Withers), body(BodyPoint::Poll), body(BodyPoint::Muzzle), body(BodyPoint::Dock));
        let mix = |a: [f64;3], b: [f64;3], s: f64, up: f64| [a[0]+(b[0]-a[0])*s, a[1]+(b[1]-a[1])*s+up, a[2]];
        let mut bones = [[[0.0;3];2]; BONE_COUNT];
        let s1 = mix(croup, back, 0.5, 0.0); let s3 = mix(back, withers, 0.5, 0.0);
        let n1 = mix(withers, poll, 0.33, -0.02); let n2 = mix(withers, poll, 0.67, 0.0);
        let chain = [croup, s1, back, s3, withers, n1, n2, poll, muzzle];
        for i in 0..8 { bones[i] = [chain[i], chain[i+1]]; }
        for limb in Limb::ALL {
            let f = limb.first_bone();
            let mut base = if limb.pair() == Pair::Fore { [withers[0]-0.02, withers[1]-0.12, 0.0] } else { croup };
            for (j, joint) in [LimbJoint::Root, LimbJoint::Upper, LimbJoint::Middle, LimbJoint::Fetlock, LimbJoint::Hoof].into_iter().enumerate() {
                let k = Keypoint::Limb(facing.near_off(limb.side()), limb.pair(), joint);
                let tip = at(k, z(f + j));
                bones[f + j] = [base, tip];
                base = tip;
            }
        }
        let down = Limb::ALL.map(|l| p.contacts.of(facing.near_off(l.side()), l.pair()) == StanceLabel::Stance);
        poses.push(PosedHorse { time_s: cam.time_s, bones, croup, dock, down });
    }
    SpecimenMotion { gait: Gait::Gallop, facing, withers_height_m: 1.6, speed_m_s: 16.0, closes_after_panels: None, poses, hurdle: None }
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let dir = "/tmp/w/i3/specimen/";
    let what = args[1].as_str();
    let save = |name: &str, s: &Specimen| {
        s.picture.save(format!("{dir}{name}.png")).unwrap();
        println!("{name}: {:?} jpeg {} KB", s.picture.dimensions(), encode(s).len() / 1000);
        std::fs::write(format!("{dir}{name}.json"), serde_json::to_string(&s.truth).unwrap()).unwrap();
    };
    match what {
        "random" => {
            let n: u64 = args[2].parse().unwrap();
            let start = std::time::Instant::now();
            for seed in 0..n {
                let style = SpecimenStyle::random(seed);
                let m = swung_legs(30, if seed % 2 == 0 { Facing::Right } else { Facing::Left });

                let s = draw(&m, &style);
                if seed < 12 && args.len() > 3 { save(&format!("r{seed}"), &s); }
            }
            println!("{:?}", start.elapsed());
        }
        "big" => {
            let mut style = SpecimenStyle { columns: 2, rows: 2, panel_px: [700.0, 480.0], grid: Grid::Full, grid_spacing_m: 0.05, shading: 0.8, upright_numbers: false, ..Default::default() };
            style.tones.wall = 190.0; style.tones.grid = 170.0;
            let mut m = swung_legs(12, Facing::Right);
            m.poses.truncate(8); m.poses.drain(0..2);
            save("big", &draw(&m, &style));
        }
        "leap" => {
            let mut m = sallie();
            m.gait = Gait::Leap;
            let n = m.poses.len();
            let mid = m.poses[5].croup[0] + 0.9;
            for (i, p) in m.poses.iter_mut().enumerate() {
                let u = (i as f64 - 5.0) / 3.0;
                let lift = (0.9 * (1.0 - u * u)).max(0.0);
                if lift > 0.0 { p.down = [false; 4]; }
                let up = |q: &mut [f64; 3]| q[1] += lift;
                p.bones.iter_mut().flatten().for_each(up);
                up(&mut p.croup); up(&mut p.dock);
            }
            m.poses.truncate(n);
            m.hurdle = Some(Hurdle { x_m: mid, height_m: 1.0 });
            save("leap", &draw(&m, &SpecimenStyle { rider: true, shadowed_panel: Some(4), fold: true, ..Default::default() }));
        }
        "swung" => {
            save("swung", &draw(&swung_legs(12, Facing::Right), &SpecimenStyle::default()));
            save("swung_dw", &draw(&swung_legs(12, Facing::Right), &SpecimenStyle::dark_wall()));save("swung_al", &draw(&swung_legs(12, Facing::Left), &SpecimenStyle::animal_locomotion()));
        }
        "sallie" => {
            let m = sallie();
            let rider = args.len() > 2;
            save("sallie", &draw(&m, &SpecimenStyle { rider, ..Default::default() }));
            save("sallie_al", &draw(&m, &SpecimenStyle { rider, ..SpecimenStyle::animal_locomotion() }));
            save("sallie_cmp", &draw(&m, &SpecimenStyle { rider, panel_px: [540.0, 360.0], ..Default::default() }));
            // Large
            save("sallie_big", &draw(&m, &SpecimenStyle { rider, columns: 2, rows: 2, panel_px: [700.0, 480.0], ..SpecimenStyle::animal_locomotion() }));
        }
        _ => {}
    }
}
