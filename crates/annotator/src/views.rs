//! The pages of the window.

pub mod calibrate_page;
pub mod figure_box;
pub mod footfall_bar;
pub mod footprints_page;
pub mod gait_page;
pub mod plate_page;
pub mod play_page;
pub mod pose_page;
pub mod ride_page;
pub mod sheet;
pub mod strip;
pub mod tabs;
pub mod welcome;
