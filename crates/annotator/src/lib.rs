//! The window in which a person turns a plate into an annotation.
//!
//! Everything but the window itself is in this library and needs only an `egui::Ui`: tests drive it without a display.
//! [`app`] is the program, [`session`] an open plate, [`command`] the table of all commands, [`views`] the pages.

pub mod anatomy;
pub mod app;
pub mod browser;
pub mod canvas;
pub mod colors;
pub mod command;
pub mod derived;
pub mod exchange;
pub mod figure;
pub mod fit_state;
pub mod footprints;
pub mod job;
pub mod key_editor;
pub mod keys;
pub mod opening;
pub mod palette;
pub mod panels;
pub mod picture;
pub mod proposal;
pub mod ride;
pub mod second_pass;
pub mod session;
pub mod settings;
pub mod specimen;
pub mod toast;
pub mod tour;
pub mod views;
