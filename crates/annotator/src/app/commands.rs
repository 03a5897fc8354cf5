//! Doing commands, and saying why one cannot be done now.

use egui::Context;

use super::dialogs::{After, Dialog};
use super::{Annotator, Command};
use crate::command::Scope;
use crate::exchange::ExchangeWindow;
use crate::key_editor::KeyEditor;
use crate::palette::Palette;
use crate::session::{Page, Session, Tool};
use crate::settings::Theme;
use crate::tour::Tour;

impl Annotator {
    /// Why a command cannot act now; none when it can.
    pub fn why_not(&self, command: Command) -> Option<&'static str> {
        use Command as C;
        let always = matches!(
            command,
            C::Open
                | C::Browse
                | C::Quit
                | C::Theme
                | C::PageRide
                | C::PageFootprints
                | C::FitAlways
                | C::Palette
                | C::Keys
                | C::Tour
        );
        if always || (command == C::OpenSpecimen && self.places.state.is_some()) {
            return None;
        }
        match (command.scope(), self.scope()) {
            (Scope::Ride, _) => return self.ride.why_not(command),
            (Scope::Footprints, _) => return self.footprints.why_not(command),
            (Scope::Plate, Scope::Ride) => return Some("Leave the Ride page first"),
            (Scope::Plate, Scope::Footprints) => return Some("Leave the Footprints page first"),
            (_, Scope::Footprints) if matches!(command, C::Save | C::SaveAs) => return None,
            _ => {}
        }
        let Some(session) = &self.session else { return Some("Open a plate first") };
        session_why_not(session, command)
    }

    /// Whether a command that switches something is on; none for other commands.
    pub(super) fn is_on(&self, command: Command) -> Option<bool> {
        use Command as C;
        let session = self.session.as_ref()?;
        let shown = &session.shown;
        Some(match command {
            C::ContactSheet => shown.sheet,
            C::Magnifier => shown.magnifier,
            C::GhostSkeletons => shown.ghost_skeletons,
            C::GhostPhotograph => shown.ghost_photograph,
            C::HoofTrails => shown.hoof_trails,
            C::ShowFit => shown.fit,
            C::ShowMarks => shown.marks,
            C::FitAlways => self.settings.fit_always,
            C::ToolGuided => session.tool == Tool::Guided,
            C::ToolFree => session.tool == Tool::Free,
            C::ToolSkeleton => session.tool == Tool::Skeleton,
            C::SecondPass => session.second_pass.is_some(),
            _ => return None,
        })
    }

    /// Does a command, or says why it cannot be done.
    pub fn run(&mut self, context: &Context, command: Command) {
        if let Some(why_not) = self.why_not(command) {
            self.messages.trouble(format!("{}: {why_not}", command.title()));
            return;
        }
        // A field that is being typed in may not be there any more after a change of page.
        if let Some(session) = &mut self.session {
            session.commit();
        }
        if self.run_on_tracks(context, command)
            || self.run_on_program(context, command)
            || self.ride.run(command)
        {
            return;
        }
        let Some(session) = &mut self.session else { return };
        self.ride.close();
        self.footprints.close();
        if !run_on_view(session, command) {
            session.run(context, command, &mut self.messages);
        }
    }

    /// Commands of the program; false when it is one of the open plate's.
    fn run_on_program(&mut self, context: &Context, command: Command) -> bool {
        use Command as C;
        match command {
            C::Open => self.pick_file(context),
            C::Browse => self.browse(),
            C::Save => self.save(context, false, After::Stay),
            C::SaveAs => self.ask_save_as(),
            C::Import => self.exchange = self.session.as_ref().map(ExchangeWindow::import),
            C::Export => self.exchange = self.session.as_ref().map(ExchangeWindow::export),
            C::Close => self.leave(context, After::Close),
            C::Quit => self.leave(context, After::Quit),
            C::Theme => self.switch_theme(context),
            C::FitAlways => {
                self.settings.fit_always = !self.settings.fit_always;
                self.write_settings();
            }
            C::Palette => self.palette = Some(Palette::default()),
            C::Keys => self.key_editor = Some(KeyEditor::default()),
            C::Tour => {
                self.ride.close();
                self.footprints.close();
                self.tour = Some(Tour::default());
            }
            C::PageRide => {
                self.footprints.close();
                self.ride.open(context);
            }
            C::OpenSpecimen => self.leave(context, After::OpenSpecimen),
            C::SecondPass => self.second_pass(context),
            _ => return false,
        }
        true
    }

    fn switch_theme(&mut self, context: &Context) {
        let dark = context.global_style().visuals.dark_mode;
        self.settings.theme = if dark { Theme::Light } else { Theme::Dark };
        self.apply_theme(context);
        self.write_settings();
    }

    /// Leaves the open plate for something else, after asking about unsaved work.
    pub(super) fn leave(&mut self, context: &Context, after: After) {
        if !matches!(after, After::Open(_) | After::OpenSpecimen) && self.has_unsaved_work() {
            self.dialog = Some(Dialog::Unsaved(after));
        } else {
            self.go_on(context, after);
        }
    }
}

fn session_why_not(session: &Session, command: Command) -> Option<&'static str> {
    use Command as C;
    let no_panel = session.panel_place().is_none();
    let selected_point = || {
        let keypoint = session.selected?;
        session.panel_annotation()?.keypoints.get(keypoint)
    };
    match command {
        C::Undo => session.document.undo_label().is_none().then_some("There is nothing to undo"),
        C::Redo => session.document.redo_label().is_none().then_some("There is nothing to redo"),
        C::Visible | C::Occluded | C::Absent if session.selected.is_none() => Some("Select a point first"),
        C::DeletePoint if selected_point().is_none() => Some("Select a placed point first"),
        C::NudgeLeft | C::NudgeRight | C::NudgeUp | C::NudgeDown
            if selected_point().and_then(muybridge_capture::Placed::place).is_none() =>
        {
            Some("Select a placed point first")
        }
        C::NudgeLeftFine | C::NudgeRightFine | C::NudgeUpFine | C::NudgeDownFine
            if selected_point().and_then(muybridge_capture::Placed::place).is_none() =>
        {
            Some("Select a placed point first")
        }
        C::PagePlate
        | C::Save
        | C::SaveAs
        | C::Close
        | C::SplitAutomatically
        | C::AddPanel
        | C::ShowMarks
        | C::FlipFacing
        | C::ContactSheet => None,
        C::ZoomIn | C::ZoomOut if session.page == Page::Plate => {
            Some("Zoom with the wheel on the Plate page")
        }
        _ if no_panel => Some("Find or draw the panels of this plate first"),
        C::GhostPhotograph
        | C::ProposeTracked
        | C::ProposeInterpolated
        | C::ProposeFitted
        | C::ShowFit
        | C::WorstPoint
        | C::CopyPrevious
            if session.second_pass.is_some() =>
        {
            Some("Not in a blind second pass: it would not be blind")
        }
        C::ProposeFitted | C::WorstPoint | C::PlayStride | C::PagePlay if session.fit.latest().is_none() => {
            Some("There is no fit yet; the Gait page says what is missing")
        }
        C::SecondPass => super::second_pass_commands::why_not(session),
        C::ProposeTracked => session.why_not_track(),
        C::ProposeInterpolated => session.why_not_interpolate(),
        C::CopyPrevious => session.why_not_copy(),
        C::FindGround if session.picture_is_missing() => Some("The photograph is not read yet"),
        C::SwapFore | C::SwapHind | C::SwapPanel | C::ClearPanel
            if session.panel_annotation().is_none_or(|panel| panel.keypoints.iter().next().is_none()) =>
        {
            Some("This panel has no points")
        }
        _ => None,
    }
}

/// Commands that change what is looked at; false for all others.
fn run_on_view(session: &mut Session, command: Command) -> bool {
    use Command as C;
    let shown = &mut session.shown;
    if matches!(command, C::PagePlate | C::PageCalibrate | C::PagePose | C::PageGait) {
        session.play.is_playing = false;
    }
    match command {
        C::PagePlate => session.page = Page::Plate,
        C::PageCalibrate => session.page = Page::Calibrate,
        C::PagePose => session.page = Page::Pose,
        C::PageGait => session.page = Page::Gait,
        C::PagePlay => session.page = Page::Play,
        C::ContactSheet => shown.sheet = !shown.sheet,
        C::Magnifier => shown.magnifier = !shown.magnifier,
        C::GhostSkeletons => shown.ghost_skeletons = !shown.ghost_skeletons,
        C::GhostPhotograph => shown.ghost_photograph = !shown.ghost_photograph,
        C::HoofTrails => shown.hoof_trails = !shown.hoof_trails,
        C::ShowFit => shown.fit = !shown.fit,
        C::ShowMarks => shown.marks = !shown.marks,
        C::ZoomToFit => {
            session.zoom.reset();
            session.plate_view = None;
        }
        C::ZoomIn => session.zoom.zoom_by(1.25),
        C::ZoomOut => session.zoom.zoom_by(0.8),
        C::NextPanel | C::PreviousPanel => {
            let steps = if command == C::NextPanel { 1 } else { -1 };
            if let Some(panel) = session.panel_after(steps) {
                session.go_to(panel);
            }
        }
        _ => return false,
    }
    true
}
