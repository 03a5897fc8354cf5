//! What a step of the horse costs, against playing a stride of the database and against a plain cross-fade.
//!
//! `cargo bench -p muybridge-core --bench ride`

use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

use muybridge_core::{
    BONE_COUNT, Command, Database, FlatGround, Gait, Ground, Horse, HorseState, MPS_PER_MPH, Pose,
    Repertoire, Skeleton, SpeedBlend, Turn,
};

/// Sixty steps a second, as in a game.
const STEP_S: f32 = 1.0 / 60.0;
/// Steps in which every horse comes to its gait and speed.
const SETTLING: usize = 60 * 20;
/// A crowd that stays in the cache, and one that does not.
const HERDS: [usize; 2] = [100, 5000];
/// Most that is wanted of each, ns per step.
const WANTED_NS: [f64; 2] = [2000.0, 4000.0];
/// Most that a step within a change may cost, against one without.
const WANTED_CHANGE: f64 = 1.5;
/// Most that a horse's state may take, bytes.
const WANTED_STATE: usize = 2048;
/// Share of the herd that must be changing for a round to count.
const LEAST_CHANGING: f64 = 0.9;
const GAITS: [Gait; 6] = [Gait::Walk, Gait::Amble, Gait::Trot, Gait::Rack, Gait::Canter, Gait::Gallop];

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Median over rounds of the time of one of `count` equal parts of a round, ns.
fn per_part_ns(rounds: usize, count: usize, mut round: impl FnMut()) -> f64 {
    let time = |_| {
        let start = Instant::now();
        round();
        start.elapsed().as_secs_f64() * 1e9 / count as f64
    };
    median((0..rounds).map(time).collect())
}

/// A gait, and a speed in its range that differs from horse to horse.
fn command(number: usize, shift: usize) -> Command {
    let gait = GAITS[(number + shift) % GAITS.len()];
    let [low, high] = gait.speed_range_mph().unwrap_or([1.0, 1.0]);
    let share = (number * 37 % 101) as f64 / 100.0;
    let speed_m_s = ((low + share * (high - low)) * MPS_PER_MPH) as f32;
    Command { speed_m_s, gait: Some(gait), ..Command::default() }
}

/// Horses of mixed gaits and speeds, each settled in its own.
fn herd(repertoire: &Arc<Repertoire>, count: usize) -> Vec<Horse> {
    // A hundred are settled and the others are copies of them, each a few steps farther on.
    let settled = |number: usize| {
        let mut horse = Horse::of(Arc::clone(repertoire), number as u64);
        (0..SETTLING).for_each(|_| {
            horse.step(&command(number, 0), STEP_S, &FlatGround);
        });
        horse
    };
    let first: Vec<Horse> = (0..HERDS[0].min(count)).map(settled).collect();
    let copy = |number: usize| {
        let kind = number % first.len();
        let mut horse = first[kind].clone();
        (0..number / first.len()).for_each(|_| {
            horse.step(&command(kind, 0), STEP_S, &FlatGround);
        });
        horse
    };
    (0..count).map(copy).collect()
}

fn step_all(horses: &mut [Horse], commands: &[Command], ground: &impl Ground) {
    for (horse, command) in horses.iter_mut().zip(commands) {
        black_box(horse.step(black_box(command), STEP_S, ground));
    }
}

fn hills(x_m: f32, z_m: f32) -> f32 {
    0.5 * (0.1 * x_m).sin() * (0.07 * z_m).cos()
}

/// Median ns per step of a herd on a ground, timed a hundred horses at a time so that other programs' turns on the core stay out of
/// the median, and all of the herd in between.
fn stepping_ns(horses: &mut [Horse], commands: &[Command], ground: &impl Ground) -> f64 {
    let rounds = 300_000 / horses.len();
    let mut times = Vec::new();
    for _ in 0..rounds {
        for (part, commands) in horses.chunks_mut(HERDS[0]).zip(commands.chunks(HERDS[0])) {
            let start = Instant::now();
            step_all(part, commands, ground);
            times.push(start.elapsed().as_secs_f64() * 1e9 / part.len() as f64);
        }
    }
    median(times)
}

/// ns per step of a settled herd.
fn settled_ns(repertoire: &Arc<Repertoire>, count: usize) -> f64 {
    let commands: Vec<Command> = (0..count).map(|number| command(number % HERDS[0], 0)).collect();
    stepping_ns(&mut herd(repertoire, count), &commands, &FlatGround)
}

/// ns per step of a herd that turns on hills.
fn turning_ns(repertoire: &Arc<Repertoire>, count: usize) -> f64 {
    let turning = |number: usize| Command { turn: Turn::Rate(0.2), ..command(number, 0) };
    let commands: Vec<Command> = (0..count).map(turning).collect();
    stepping_ns(&mut herd(repertoire, count), &commands, &hills)
}

/// ns per step while (nearly) all of a herd change their gait, and how many rounds there were of those.
fn changing_ns(repertoire: &Arc<Repertoire>, count: usize) -> (f64, usize) {
    let mut rounds = Vec::new();
    for shift in 1..GAITS.len() {
        let mut horses = herd(repertoire, count);
        let commands: Vec<Command> = (0..count).map(|number| command(number, shift)).collect();
        for _ in 0..SETTLING {
            let start = Instant::now();
            step_all(&mut horses, &commands, &FlatGround);
            let took_ns = start.elapsed().as_secs_f64() * 1e9 / count as f64;
            let changing = horses.iter().filter(|horse| horse.readout().change.is_some()).count();
            if changing as f64 >= LEAST_CHANGING * count as f64 {
                rounds.push(took_ns);
            }
        }
    }
    let count = rounds.len();
    (median(rounds), count)
}

/// The database between two speeds as the horses of a herd want it.
fn blends(database: &Database, shift: usize) -> Vec<SpeedBlend<'_>> {
    let blend = |number: usize| {
        let Command { speed_m_s, gait, .. } = command(number, shift);
        database.at_speed(gait?, speed_m_s)
    };
    (0..HERDS[0]).filter_map(blend).collect()
}

/// ns for a pose of the database between two speeds.
fn playing_ns(database: &Database) -> f64 {
    let (blends, mut phase) = (blends(database, 0), 0.0);
    per_part_ns(600, blends.len(), || {
        phase += 0.013;
        for blend in &blends {
            black_box(blend.pose(black_box(phase)));
        }
    })
}

/// ns for a pose's joints.
fn joints_ns(skeleton: &Skeleton) -> f64 {
    let (pose, count) = (Pose::standing(skeleton), HERDS[0]);
    per_part_ns(600, count, || {
        (0..count).for_each(|_| {
            black_box(black_box(&pose).joints(skeleton));
        });
    })
}

/// What a change amounts to that knows nothing of legs: two gaits' poses at one phase, mixed angle by angle.
fn cross_fade(from: &Pose, to: &Pose, share: f32) -> Pose {
    let mix = |a: f32, b: f32| a + share * (b - a);
    Pose {
        root_in_world: from.root_in_world.lerp(to.root_in_world, share),
        world_from_root: from.world_from_root.slerp(to.world_from_root, share),
        bends_rad: std::array::from_fn::<f32, BONE_COUNT, _>(|i| mix(from.bends_rad[i], to.bends_rad[i])),
        scapula_slides_m: std::array::from_fn(|i| mix(from.scapula_slides_m[i], to.scapula_slides_m[i])),
        ..Pose::default()
    }
}

/// ns for a cross-fade.
fn cross_fading_ns(database: &Database) -> f64 {
    let pairs: Vec<_> = blends(database, 0).into_iter().zip(blends(database, 1)).collect();
    let mut phase = 0.0;
    per_part_ns(600, pairs.len(), || {
        phase += 0.013;
        for (from, to) in &pairs {
            let phase = black_box(phase);
            black_box(cross_fade(&from.pose(phase), &to.pose(phase), 0.4));
        }
    })
}

fn held(is_held: bool) -> &'static str {
    if is_held { "held" } else { "MISSED" }
}

/// Sizes, and the time to make a repertoire.
fn report_making(database: &Database, skeleton: &Skeleton) -> Option<Arc<Repertoire>> {
    let mut made = None;
    let mut times: Vec<Duration> = Vec::new();
    let mut heap_bytes = 0;
    for _ in 0..5 {
        let start = Instant::now();
        let info = allocation_counter::measure(|| made = Repertoire::new(database, skeleton).ok());
        times.push(start.elapsed());
        heap_bytes = heap_bytes.max(info.bytes_current);
    }
    times.sort();
    println!("a repertoire is made in {:.1?} (median of {})", times[times.len() / 2], times.len());
    println!(
        "  its size: {} bytes, and {:.0} kB on the heap, shared by all horses of a build",
        size_of::<Repertoire>(),
        heap_bytes as f64 / 1000.0
    );
    let state = size_of::<HorseState>();
    println!(
        "a horse's state: {state} bytes, a horse: {} bytes (state at most {WANTED_STATE}: {})",
        size_of::<Horse>(),
        held(state <= WANTED_STATE)
    );
    made.map(Arc::new)
}

fn main() {
    let (database, skeleton) = (Database::embedded(), Skeleton::reference());
    let Some(repertoire) = report_making(&database, &skeleton) else {
        println!("the embedded database makes no repertoire");
        return;
    };
    let (playing, fading) = (playing_ns(&database), cross_fading_ns(&database));
    println!("a pose of the database at a speed: {playing:.0} ns");
    println!("a plain cross-fade of two such poses: {fading:.0} ns");
    println!("a pose's joints, which no line here includes: {:.0} ns", joints_ns(&skeleton));
    let steps = HERDS.map(|count| settled_ns(&repertoire, count));
    for ((count, ns), wanted) in HERDS.into_iter().zip(steps).zip(WANTED_NS) {
        println!(
            "a step of one of {count} horses: {ns:.0} ns, {:.2} times a pose (at most {wanted} ns: {})",
            ns / playing,
            held(ns <= wanted)
        );
    }
    let turning = turning_ns(&repertoire, HERDS[0]);
    println!(
        "a step while turning on hills: {turning:.0} ns, {:.2} times one on the flat",
        turning / steps[0]
    );
    report_changing(&repertoire, steps[0], fading);
}

fn report_changing(repertoire: &Arc<Repertoire>, step: f64, fading: f64) {
    let (changing, rounds) = changing_ns(repertoire, HERDS[0]);
    let ratio = changing / step;
    println!(
        "a step while all of {} change gait: {changing:.0} ns, {:.2} times a cross-fade (median of {rounds} rounds)",
        HERDS[0],
        changing / fading
    );
    println!("  {ratio:.2} times a step without (at most {WANTED_CHANGE}: {})", held(ratio <= WANTED_CHANGE));
}
