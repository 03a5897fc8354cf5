use image::*;
use muybridge_capture::Facing;
use muybridge_imaging::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let (from, to): (u64, u64) = (args[2].parse().unwrap(), args[3].parse().unwrap());
    let (mut panels, mut right, mut plates, mut plates_right) = (0, 0, 0, 0);
    let mut silent = 0; let mut doubtful_right = 0;
    let mut time = 0.0;
    let mut all = vec![];
    for seed in from..to {
        let style = specimen::SpecimenStyle::random(seed);
        let cells = style.columns * style.rows;
        let poses = if seed % 7 == 3 { (cells - 1).max(2) } else { cells };
        let motion = specimen::swung_legs(poses as usize, if seed % 2 == 0 { Facing::Left } else { Facing::Right });
        let s = specimen::draw(&motion, &style);
        let t = std::time::Instant::now();
        let found = split::split(&s.picture);
        let dt = t.elapsed().as_secs_f64();
        time += dt;
        let truth: Vec<[[f64; 2]; 4]> = s.truth.panels.iter().map(|p| p.quad_px).collect();
        let ious: Vec<f64> = truth.iter().enumerate().map(|(i, t)| if found.panels.len() == truth.len() { split::iou(t, &found.panels[i].quad_px) } else { found.panels.iter().map(|p| split::iou(t, &p.quad_px)).fold(0.0, f64::max) }).collect();
        let ok = found.panels.len() == truth.len() && ious.iter().all(|v| *v >= 0.95);
        plates += 1; plates_right += usize::from(ok);
        panels += truth.len(); right += ious.iter().filter(|v| **v >= 0.95).count();
        let certain = found.is_certain();
        if !ok && certain { silent += 1; }
        if ok && !certain { doubtful_right += 1; }
        let min = ious.iter().copied().fold(1.0, f64::min);
        all.extend(ious.iter().copied());
        let least_seen = found.panels.iter().map(|p| p.confidence).fold(1.0, f64::min);
        if !ok || !certain {
            println!("seed {seed} {}x{} {:?} tilt {:.1} fold {} shadow {:?} gutter {:.0?} panel {:.0?} mount {:.0} wall {:.0} page {:.0} grain {:.1}: found {}/{} min {:.3} least seen {:.2} {:.2}s {}", style.rows, style.columns, style.mount, style.tilt_deg, style.fold, style.shadowed_panel, style.gutter_px, style.panel_px, style.tones.mount, style.tones.wall, style.tones.page, style.grain_sd, found.panels.len(), truth.len(), min, least_seen, dt, if ok { "RIGHT" } else if certain { "SILENT" } else { "wrong" });
            for d in &found.doubts { println!("      {d}"); }
        }
        if !ok || (args.len() > 4) {
            let mut c = DynamicImage::ImageLuma8(s.picture).to_rgb8();
            let mut draw = |q: &[[f64; 2]; 4], col| for i in 0..4 {
                let a = q[i]; let b = q[(i + 1) % 4];
                imageproc::drawing::draw_line_segment_mut(&mut c, (a[0] as f32 - 0.5, a[1] as f32 - 0.5), (b[0] as f32 - 0.5, b[1] as f32 - 0.5), Rgb(col));
            };
            for t in &truth { draw(t, [0, 255, 0]); }
            for p in &found.panels { draw(&p.quad_px, [255, 0, 0]); }
            c.save(format!("{}/spec{seed}.png", args[1])).unwrap();
        }
    }
    all.sort_by(f64::total_cmp);
    let q = |f: f64| all[((all.len() - 1) as f64 * f) as usize];
    println!("plates {plates_right}/{plates} panels {right}/{panels} silent {silent} doubtful though right {doubtful_right}; iou 0.5% {:.3} 1% {:.3} 5% {:.3} 50% {:.3}; {:.3} s each", q(0.005), q(0.01), q(0.05), q(0.5), time / plates as f64);
}
