//! Every frame of a ride for other programs: JSON and CSV.

use std::io::Write;

use muybridge_core::{BODY_BONE_COUNT, BONE_COUNT, Limb, Pose, Skeleton};
use serde_json::{Value, json};

use super::ride::{Frame, Ride};

/// Schema version of the JSON document.
const PLAYED_SCHEMA: u32 = 1;

/// One document with all frames, a line each.
pub(super) fn write_json(
    out: &mut impl Write,
    ride: &mut Ride,
    duration_s: f64,
    frame_s: f64,
) -> anyhow::Result<()> {
    let skeleton = ride.horse.skeleton();
    let head = json!({
        "schema": PLAYED_SCHEMA,
        "name": ride.script().name,
        "frames_per_s": 1.0 / frame_s,
        "skeleton": skeleton.name,
        "withers_height_m": skeleton.withers_height_m,
        "bones": bone_names(skeleton),
        "limbs": Limb::ALL.map(Limb::abbreviation),
    });
    // The head without its closing brace: the frames follow.
    let head = head.to_string();
    write!(out, "{},\n\"frames\": [", head.trim_end_matches('}'))?;
    each_frame(ride, duration_s, frame_s, |index, frame| {
        out.write_all(if index == 0 { b"\n" } else { b",\n" })?;
        serde_json::to_writer(&mut *out, &record(frame))?;
        Ok(())
    })?;
    writeln!(out, "\n]}}")?;
    Ok(())
}

fn record(frame: &Frame) -> Value {
    let readout = &frame.readout;
    json!({
        "time_s": micro(frame.time_s),
        "gait": readout.gait,
        "lead": readout.lead,
        "standing": readout.is_standing,
        "change": readout.change.map(|change| json!({ "from": change.from, "share": change.share })),
        "speed_m_s": readout.speed_m_s,
        "heading_rad": micro(readout.heading_rad),
        "turn_rate_rad_s": readout.turn_rate_rad_s,
        "stride_time_s": readout.stride_time_s,
        "strides": micro(readout.strides),
        "on_ground": readout.on_ground,
        "prints_m": readout.prints.map(|print| print.to_array().map(micro)),
        "pose": frame.pose,
    })
}

/// A table with a line for each frame.
pub(super) fn write_csv(
    out: &mut impl Write,
    ride: &mut Ride,
    duration_s: f64,
    frame_s: f64,
) -> anyhow::Result<()> {
    write!(out, "time_s,gait,lead,changing_from,change_share,speed_m_s,heading_deg")?;
    for limb in Limb::ALL {
        write!(out, ",{}_down", limb.abbreviation())?;
    }
    write!(out, ",root_x_m,root_y_m,root_z_m,root_qx,root_qy,root_qz,root_qw")?;
    let bones = bone_names(ride.horse.skeleton());
    let limbs = Limb::ALL.map(|limb| limb.abbreviation().to_string());
    let columns = [
        ("bend_rad", &bones[..]),
        ("lateral_bend_rad", &bones[..BODY_BONE_COUNT]),
        ("scapula_slide_m", &limbs[..2]),
        ("turn_rad", &limbs[..]),
        ("abduction_rad", &limbs[..]),
    ];
    for (what, names) in columns {
        for name in names {
            write!(out, ",{name}_{what}")?;
        }
    }
    writeln!(out)?;
    each_frame(ride, duration_s, frame_s, |_, frame| write_line(out, frame))
}

fn write_line(out: &mut impl Write, frame: &Frame) -> anyhow::Result<()> {
    let readout = &frame.readout;
    let (from, share) =
        readout.change.map(|change| (change.from.name(), format!("{:.4}", change.share))).unwrap_or_default();
    write!(
        out,
        "{:.6},{},{},{from},{share},{:.5},{:.5}",
        frame.time_s,
        frame.doing(),
        frame.lead().unwrap_or_default(),
        readout.speed_m_s,
        readout.heading_rad.to_degrees(),
    )?;
    for down in readout.on_ground {
        write!(out, ",{}", u8::from(down))?;
    }
    for number in numbers(&frame.pose) {
        write!(out, ",{number:.6}")?;
    }
    writeln!(out)?;
    Ok(())
}

/// All numbers of a pose in the order of the columns.
fn numbers(pose: &Pose) -> impl Iterator<Item = f32> {
    let root = pose.root_in_world.to_array().into_iter().chain(pose.world_from_root.to_array());
    root.chain(pose.bends_rad)
        .chain(pose.lateral_bends_rad)
        .chain(pose.scapula_slides_m)
        .chain(pose.limb_turns_rad)
        .chain(pose.abductions_rad)
}

/// Names of the bones, those of the legs with the leg before them: `LF_humerus`.
fn bone_names(skeleton: &Skeleton) -> Vec<String> {
    (0..BONE_COUNT)
        .map(|index| {
            let name = &skeleton.bones[index].name;
            Skeleton::limb_of(index).map_or(name.clone(), |limb| format!("{}_{name}", limb.abbreviation()))
        })
        .collect()
}

/// The frame at the start and one after each `frame_s`.
fn each_frame(
    ride: &mut Ride,
    duration_s: f64,
    frame_s: f64,
    mut write: impl FnMut(u64, &Frame) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    let steps = (duration_s / frame_s).round() as u64;
    for index in 0..=steps {
        write(index, &ride.frame())?;
        if index < steps {
            ride.advance(frame_s);
        }
    }
    Ok(())
}

/// A number to six decimals, as much as any place or time here is known.
fn micro(number: f64) -> f64 {
    (number * 1e6).round() / 1e6
}
