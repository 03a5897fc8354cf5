use muybridge_imaging::*;
fn main() {
    let p = std::env::args().nth(1).unwrap();
    let t = std::time::Instant::now();
    let g = load_gray(std::path::Path::new(&p), LoadLimits::default()).unwrap();
    let a = t.elapsed().as_secs_f64();
    let s = split::split(&g);
    println!("{} panels, load {a:.2} split {:.2}", s.panels.len(), t.elapsed().as_secs_f64() - a);
}
