//! The horse in real time.

mod bearing;
mod clip;
mod command;
mod deciding;
mod feet;
mod footing;
mod gait_choice;
mod ground;
mod horse;
mod leap_clip;
mod leaping;
mod mixture;
mod own_gait;
mod posing;
mod reach;
mod readout;
mod repertoire;
mod retarget;
mod rig;
mod state;
mod step;
mod stillness;
mod terrain;
mod track;
mod warp;

pub use command::{Command, Leap, TURN_STEP_RAD, Turn};
pub use ground::{FlatGround, Ground, Surface};
pub use horse::Horse;
pub use own_gait::OwnGait;
pub use reach::{LegReach, ReachMiss, ToeAim};
pub use readout::{ChangeReadout, Readout};
pub use repertoire::Repertoire;
pub use state::HorseState;
