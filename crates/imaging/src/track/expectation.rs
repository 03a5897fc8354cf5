//! temp all in one
use image::GrayImage;
use muybridge_capture::{BodyPoint, Keypoint, LimbJoint, NearOff};
use muybridge_core::{Limb, Pair, Side, Skeleton};

use super::chain::{Bend, Chain, Link, Posture};
use super::frame::{Frame, Place};
use super::template::{Extent, Segment, Template};
use super::trunk::TrunkMotion;
use super::{PanelPoints, Tracked};
use crate::PanelView;

const JOINTS: [LimbJoint; 5] =
    [LimbJoint::Root, LimbJoint::Upper, LimbJoint::Middle, LimbJoint::Fetlock, LimbJoint::Hoof];

type Places = [Option<Place>; 26];

fn apart(a: Place, b: Place) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
fn minus(a: Place, b: Place) -> Place {
    [a[0] - b[0], a[1] - b[1]]
}
fn wrapped(angle: f64) -> f64 {
    angle.sin().atan2(angle.cos())
}

fn body(p: BodyPoint) -> Keypoint {
    Keypoint::Body(p)
}

fn height_px(known: &[PanelPoints]) -> Option<f64> {
    let last = known.last()?;
    let w = last.points.place(body(BodyPoint::Withers))?;
    let d = last.points.place(body(BodyPoint::Dock))?;
    Some(apart(w, d) / 0.9)
}

pub(super) fn track(known: &[PanelPoints], next: &PanelView, next_silhouette: Option<&GrayImage>, truth: Option<&muybridge_capture::Keypoints>) -> Option<Vec<Tracked>> {
    let tt = std::time::Instant::now();
    let height = height_px(known)?;
    let last = known.last()?;
    let w = last.points.place(body(BodyPoint::Withers))?;
    let d = last.points.place(body(BodyPoint::Dock))?;
    let mirrored = w[0] < d[0];
    let frames: Vec<Frame> = known.iter().map(|p| Frame::new(p.view, p.silhouette, height, mirrored)).collect();
    let places: Vec<Places> = known
        .iter()
        .zip(&frames)
        .map(|(p, f)| {
            let mut places: Places = [None; 26];
            for k in Keypoint::all() {
                places[k.index()] = p.points.place(k).map(|at| f.place(at));
            }
            places
        })
        .collect();
    let states: Vec<[bool; 26]> = known.iter().map(|p| std::array::from_fn(|i| Keypoint::all().nth(i).and_then(|k| p.points.get(k)).is_some_and(|s| s.state == muybridge_capture::KeypointState::Visible))).collect();
    let next = Frame::new(next, next_silhouette, height, mirrored);
    let n = known.len() - 1;
    let trunk = trunk_segment(&places[n])?;
    let mut expected = vec![[0.0, 0.0]];
    if n > 0 && let Some(before) = trunk_segment(&places[n - 1]) {
        expected.push(minus(trunk.to, before.to));
    }
    if knob("PROF", 0.0) > 0.0 { eprintln!("frames {:.3}", tt.elapsed().as_secs_f64()); }
    let t0 = std::time::Instant::now();
    let motion = TrunkMotion::find(&frames[n], &next, trunk, &expected);
    if knob("PROF", 0.0) > 0.0 { eprintln!("trunk {:.3}", t0.elapsed().as_secs_f64()); }
    let mut out = Vec::new();
    for p in [BodyPoint::Withers, BodyPoint::Back, BodyPoint::Croup, BodyPoint::Dock] {
        if let Some(place) = places[n][body(p).index()] {
            out.push((body(p), motion.apply(place), motion.likeness, [0.0; 4]));
        }
    }
    let neck = [body(BodyPoint::Withers), body(BodyPoint::Poll), body(BodyPoint::Muzzle)];
    let mut chains = vec![neck.to_vec()];
    for pair in [Pair::Fore, Pair::Hind] {
        for side in [NearOff::Near, NearOff::Off] {
            chains.push(JOINTS.iter().map(|j| Keypoint::Limb(side, pair, *j)).collect());
        }
    }
    let mut all: Vec<(Vec<Keypoint>, Chain, Vec<Posture>)> = Vec::new();
    for (number, keypoints) in chains.iter().enumerate() {
        let keypoints: Vec<Keypoint> =
            keypoints.iter().copied().filter(|k| places[n][k.index()].is_some()).collect();
        if keypoints.len() < 2 {
            continue;
        }
        let chain = expect(&frames, &places, &states, &keypoints, &motion, &chains, number);
        let postures = chain.find(&next.coarse, &next.fine);
        if !postures.is_empty() {
            all.push((keypoints, chain, postures));
        }
    }
    let t0 = std::time::Instant::now();
    let chosen = choose(&all);
    if knob("PROF", 0.0) > 0.0 { eprintln!("choose {:.3}", t0.elapsed().as_secs_f64()); }
    if let Some(truth) = truth {
        for (number, (keypoints, chain, postures)) in all.iter().enumerate().skip(1) {
            let true_joints: Vec<Place> = keypoints.iter().filter_map(|k| truth.place(*k)).map(|p| next.place(p)).collect();
            if true_joints.len() < keypoints.len() { continue; }
            let s = Segment { from: true_joints[0], to: true_joints[1] };
            let mut traced = vec![[s.angle(); 2]];
            traced.extend(&true_joints[1..]);
            let t = chain.refine(&next.fine, &traced);
            let c = &postures[chosen[number].0];
            let (e, et) = (apart(*c.joints.last().unwrap(), *true_joints.last().unwrap()), apart(*t.joints.last().unwrap(), *true_joints.last().unwrap()));
            if e > 0.04 {
                let ang = |j: &[Place]| -> Vec<String> { j.windows(2).zip(&chain.links).map(|(w, l)| format!("{:.0}", (wrapped(Segment { from: w[0], to: w[1] }.angle() - l.angle)).to_degrees())).collect() };
                let nearest = postures.iter().map(|p| apart(*p.joints.last().unwrap(), *true_joints.last().unwrap())).fold(9.0, f64::min);
                eprintln!("   {} err {:.2} score {:.1} l {:.2?} off {:?}; true-start err {et:.2} score {:.1} l {:.2?} off {:?}; truth off {:?} nearest hyp {nearest:.2}", keypoints.last().unwrap(), e, c.score, c.likeness, ang(&c.joints), t.score, t.likeness, ang(&t.joints), ang(&true_joints));
            }
        }
    }
    for (number, (keypoints, _, postures)) in all.iter().enumerate() {
        let (which, share) = chosen[number];
        let posture = &postures[which];
        for (i, k) in keypoints.iter().enumerate() {
            if number == 0 && i == 0 {
                continue;
            }
            let l = if i > 0 { posture.likeness[i - 1] } else { 0.0 };
            out.push((*k, posture.joints[i], share, [share, l, posture.certainty, posture.score]));
        }
    }
    Some(
        out.into_iter()
            .map(|(keypoint, place, quality, debug)| Tracked { keypoint, at_px: next.plate_px(place), quality, debug })
            .collect(),
    )
}

fn trunk_segment(places: &Places) -> Option<Segment> {
    let from = places[body(BodyPoint::Dock).index()]?;
    let to = places[body(BodyPoint::Withers).index()]?;
    Some(Segment { from, to })
}

fn segments(places: &Places, keypoints: &[Keypoint]) -> Vec<Segment> {
    keypoints
        .windows(2)
        .filter_map(|w| Some(Segment { from: places[w[0].index()]?, to: places[w[1].index()]? }))
        .collect()
}

fn expect(
    frames: &[Frame],
    places: &[Places],
    states: &[[bool; 26]],
    keypoints: &[Keypoint],
    motion: &TrunkMotion,
    chains: &[Vec<Keypoint>],
    number: usize,
) -> Chain {
    let n = places.len() - 1;
    let root = places[n][keypoints[0].index()].unwrap_or_default();
    let limb = number > 0;
    let links = (1..keypoints.len()).map(|i| {
        let (a, b) = (keypoints[i - 1].index(), keypoints[i].index());
        let segment = |panel: usize| Some(Segment { from: places[panel][a]?, to: places[panel][b]? });
        let now = segment(n).unwrap_or(Segment { from: root, to: root });
        let turn = (n > 0).then(|| segment(n - 1)).flatten().map_or(0.0, |s| wrapped(now.angle() - s.angle()));
        let lengths: Vec<f64> = (0..=n).filter_map(segment).map(|s| s.length()).collect();
        let length = lengths.iter().sum::<f64>() / lengths.len() as f64;
        let kind = match keypoints[i] {
            Keypoint::Body(_) => 4,
            Keypoint::Limb(_, _, LimbJoint::Root | LimbJoint::Upper) => 0,
            Keypoint::Limb(_, _, LimbJoint::Middle) => 1,
            Keypoint::Limb(_, _, LimbJoint::Fetlock) => 2,
            Keypoint::Limb(_, _, LimbJoint::Hoof) => 3,
        };
        let keep = [0.3, 0.5, 0.65, 0.3, 0.3][kind];
        let sd = [20.0f64, 24.0, 27.0, 100.0, 8.0][kind].to_radians();
        let reach = [50.0f64, 60.0, 70.0, 150.0, 20.0][kind].to_radians();
        let half = [0.09, 0.08, 0.06 * knob("H2", 1.0), 0.06 * knob("H3", 1.0), 0.15][kind];
        let end = [0.0, 0.0, 0.0, knob("END", 0.06), 0.05][kind];
        let extent = Extent { ends: [0.0, end], sides: [half, half] };
        let pair = match keypoints[i] { Keypoint::Limb(_, p, _) => p, Keypoint::Body(_) => Pair::Fore };
        let horse = Skeleton::reference();
        let first = Limb::new(pair, Side::Left).first_bone();
        let bone = |j: usize| &horse.bones[first + j];
        let adjacent = limb && keypoints.len() == 5;
        let bend_limits = if adjacent && i > 1 { let [l, h] = bone(i).limits_rad.map(f64::from); [-h, -l] } else { [-4.0, 4.0] };
        let mut bends = Vec::new();
        if adjacent && i == 4 {
            let f = &horse.fetlock;
            let c = if pair == Pair::Fore { f.fore } else { f.hind };
            let before = Segment { from: places[n][a - 1].unwrap_or_default(), to: now.from };
            let upper = 0.0;
            let swing = f64::from(c.swing_bend_rad) + f64::from(c.per_upper_bend) * upper - f64::from(c.per_cannon_bend * bone(3).rest_bend_rad);
            bends.push(Bend { share: 0.3, bend: wrapped(now.angle() - before.angle()), per_turn: 0.0, sd: knob("HSD", 0.45) });
            bends.push(Bend { share: 0.4, bend: -swing, per_turn: f64::from(c.per_cannon_bend), sd: knob("SWSD", 0.35) });
            bends.push(Bend { share: 0.3, bend: -f64::from(f.stance_bend_rad), per_turn: 0.0, sd: f64::from(f.stance_sd_rad) });
        }
        let others = |panel: usize, own: usize| -> Vec<Segment> {
            chains
                .iter()
                .enumerate()
                .filter(|(other, _)| limb && *other != own && *other > 0)
                .flat_map(|(_, c)| segments(&places[panel], c))
                .collect()
        };
        let bank = knob("BANK", 0.0) as usize;
        let mut sources: Vec<(usize, usize, usize, usize)> = vec![(n, number, a, b)];
        if limb {
            let (onumber, shift) = if (number - 1) % 2 == 0 { (number + 1, 5) } else { (number - 1, usize::MAX - 4) };
            let (oa, ob) = (a.wrapping_add(shift), b.wrapping_add(shift));
            if n > 0 && bank & 1 > 0 { sources.push((n - 1, number, a, b)); }
            if bank & 2 > 0 { sources.push((n, onumber, oa, ob)); }
            if n > 0 && bank & 4 > 0 { sources.push((n - 1, onumber, oa, ob)); }
        }
        let seen = |&(panel, _, a, b): &(usize, usize, usize, usize)| [a, b].iter().all(|i| states[panel][*i]);
        if bank & 8 > 0 && sources.iter().any(seen) { sources.retain(seen); }
        let templates = |fine: bool| -> Vec<Template> {
            sources
                .iter()
                .filter_map(|&(panel, own, a, b)| {
                    let s = Segment { from: places[panel][a]?, to: places[panel][b]? };
                    let (level, step) = if fine { (&frames[panel].fine, 2.5) } else { (&frames[panel].coarse, 1.4) };
                    Some(Template::new(level, s, extent, step, &others(panel, own)))
                })
                .collect()
        };
        Link {
            length,
            length_sd: if kind == 3 { 0.12 } else { 0.07 },
            angle: now.angle() + keep * turn + motion.pitch,
            angle_sd: sd,
            bend_limits,
            bends,
            reach,
            weight: knob("K", 1.0) * [8.0 * knob("W0", 1.0), 14.0, 16.0, 14.0 * knob("W3", 1.0), 16.0][kind],
            coarse: templates(false),
            fine: templates(true),
            knobs: [knob("SD", 1.0), knob("NU", 1000.0)],
        }
    });
    let links = links.collect();
    let standing = if let (Some(Keypoint::Limb(_, _, LimbJoint::Hoof)), true) = (keypoints.last(), n > 0) {
        let k = keypoints[keypoints.len() - 1].index();
        let t = |p: usize| trunk_segment(&places[p]).map(|s| s.to);
        let lowest = places.iter().flat_map(|p| p.iter().flatten()).map(|p| p[1]).fold(0.0, f64::max);
        match (places[n][k], places[n - 1][k], t(n), t(n - 1)) {
            (Some(now), Some(before), Some(t1), Some(t0)) if now[1] > lowest - 0.08 => {
                let step = minus(minus(now, t1), minus(before, t0));
                let p = motion.apply(now);
                Some([p[0] + step[0], p[1]])
            }
            _ => None,
        }
    } else {
        None
    };
    Chain { root: motion.apply(root), root_sd: if limb { 0.035 } else { 0.02 }, links, standing }
}

/// What b pays for its segments that lie on a's.
fn overlap(a: &Posture, b: &Posture, chain: &Chain) -> f64 {
    let hidden = knob("HID", 0.2);
    let width = knob("OW", 0.05);
    let mut cost = 0.0;
    for i in 0..b.likeness.len() {
        if i == 0 { continue; }
        let s = Segment { from: b.joints[i], to: b.joints[i + 1] };
        let covered = (1..=4).filter(|t| {
            let t = f64::from(*t) / 4.0;
            let p = [s.from[0] + t * (s.to[0] - s.from[0]), s.from[1] + t * (s.to[1] - s.from[1])];
            a.joints.windows(2).skip(1).any(|w| Segment { from: w[0], to: w[1] }.distance(p) < width)
        });
        cost += covered.count() as f64 / 4.0 * (chain.links[i].weight * (b.likeness[i] - hidden)).max(0.0);
    }
    cost
}

fn choose(all: &[(Vec<Keypoint>, Chain, Vec<Posture>)]) -> Vec<(usize, f64)> {
    let limbs: Vec<usize> = (0..all.len()).filter(|i| matches!(all[*i].0[0], Keypoint::Limb(..))).collect();
    let mut pair = vec![vec![Vec::new(); all.len()]; all.len()];
    for &a in &limbs {
        for &b in limbs.iter().filter(|b| **b > a) {
            pair[a][b] = all[a].2.iter().map(|p| all[b].2.iter().map(|q| overlap(p, q, &all[b].1).min(overlap(q, p, &all[a].1))).collect::<Vec<f64>>()).collect();
        }
    }
    let mut combos: Vec<Vec<usize>> = vec![vec![]];
    for &l in &limbs {
        combos = combos.into_iter().flat_map(|c| (0..all[l].2.len()).map(move |k| { let mut c = c.clone(); c.push(k); c })).collect();
    }
    let score = |c: &Vec<usize>| {
        let mut s = 0.0;
        for (i, &l) in limbs.iter().enumerate() {
            s += all[l].2[c[i]].score;
            for (j, &m) in limbs.iter().enumerate().skip(i + 1) {
                s -= pair[l][m][c[i]][c[j]];
            }
        }
        s
    };
    let scores: Vec<f64> = combos.iter().map(score).collect();
    let (best, top) = scores.iter().enumerate().fold((0, f64::NEG_INFINITY), |b, (i, s)| if *s > b.1 { (i, *s) } else { b });
    let total: f64 = scores.iter().map(|s| (s - top).exp()).sum();
    (0..all.len()).map(|l| match limbs.iter().position(|m| *m == l) {
        Some(i) => {
            let k = combos[best][i];
            let near = |o: usize| apart(*all[l].2[o].joints.last().unwrap(), *all[l].2[k].joints.last().unwrap()) < 0.03;
            let share: f64 = combos.iter().zip(&scores).filter(|(c, _)| near(c[i])).map(|(_, s)| (s - top).exp()).sum();
            (k, share / total)
        }
        None => (all[l].2.iter().enumerate().fold((0, f64::NEG_INFINITY), |b, (i, p)| if p.score > b.1 { (i, p.score) } else { b }).0, 0.5),
    }).collect()
}

pub(super) fn knob(name: &str, default: f64) -> f64 {
    use std::sync::{LazyLock, Mutex};
    static K: LazyLock<Mutex<std::collections::BTreeMap<String, f64>>> = LazyLock::new(|| Mutex::new(Default::default()));
    *K.lock().unwrap().entry(name.to_string()).or_insert_with(|| std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(default))
}
