use image::*;
use muybridge_imaging::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    for p in &args[2..] {
        let g = load_gray(std::path::Path::new(p), LoadLimits::default()).unwrap();
        let t = std::time::Instant::now();
        let s = split::split(&g);
        println!("{p}: {} panels {:.3}s", s.panels.len(), t.elapsed().as_secs_f64());
        let mut c = DynamicImage::ImageLuma8(g).to_rgb8();
        for q in &s.panels {
            println!("  r{} c{} {:?} confidence {:.2}", q.row, q.column, q.quad_px.map(|p| p.map(|v| v.round())), q.confidence);
            for i in 0..4 {
                let a = q.quad_px[i]; let b = q.quad_px[(i + 1) % 4];
                imageproc::drawing::draw_line_segment_mut(&mut c, (a[0] as f32-0.5, a[1] as f32-0.5), (b[0] as f32-0.5, b[1] as f32-0.5), Rgb([255, 0, 0]));
            }
        }
        for d in &s.doubts { println!("   {d}"); }
        let name = p.replace('/', "_").replace(".jpg", "").replace(".png", "");
        c.save(format!("{}/{}.png", args[1], &name[name.len().saturating_sub(30)..])).unwrap();
    }
}
