//! The program as a whole: one frame of it, and what happens between frames.

mod commands;
mod dialogs;
mod file_commands;
mod menus;
mod places;
mod pose_commands;
mod propose_commands;
mod second_pass_commands;
mod track_commands;

use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::{CentralPanel, Context, Panel, Ui};

use crate::browser::Browser;
use crate::exchange::ExchangeWindow;
use crate::job::{Job, take_answer};
use crate::key_editor::KeyEditor;
use crate::opening::{Opened, open};
use crate::palette::{Chosen, Palette};
use crate::session::{Page, Session};
use crate::settings::{Settings, Theme};
use crate::toast::Messages;
use crate::tour::Tour;
use crate::views;
use dialogs::{After, Dialog};
pub use places::Places;

use crate::command::{Command, Scope};
use crate::views::footprints_page::FootprintsPage;
use crate::views::ride_page::RidePage;

/// What a page may use of the program besides its plate.
pub struct PageContext<'a> {
    /// Settings, the keys among them.
    pub settings: &'a mut Settings,
    /// Messages.
    pub messages: &'a mut Messages,
    /// Commands to be done after the frame's drawing.
    pub commands: &'a mut Vec<Command>,
}

/// The program.
pub struct Annotator {
    /// Folders.
    pub places: Places,
    /// What is remembered.
    pub settings: Settings,
    /// Messages.
    pub messages: Messages,
    /// The open plate.
    pub session: Option<Session>,
    /// The Ride page, which needs no plate.
    pub ride: RidePage,
    /// The Footprints page, which needs no plate either.
    pub footprints: FootprintsPage,
    palette: Option<Palette>,
    key_editor: Option<KeyEditor>,
    browser: Option<Browser>,
    exchange: Option<ExchangeWindow>,
    tour: Option<Tour>,
    dialog: Option<Dialog>,
    opening: Option<Job<Result<Opened, String>>>,
    picking: Option<Job<(Option<PathBuf>, Duration)>>,
    may_close: bool,
}

impl Annotator {
    /// Starts with a plate to open, or with what was left unsaved, or, the first time, with a specimen and the tour.
    pub fn new(context: &Context, places: Places, path: Option<&Path>) -> Self {
        let settings = Settings::read(places.state.as_deref());
        let mut annotator = Self {
            messages: Messages::default(),
            session: None,
            ride: RidePage::default(),
            footprints: FootprintsPage::default(),
            palette: None,
            key_editor: None,
            browser: None,
            exchange: None,
            tour: None,
            dialog: None,
            opening: None,
            picking: None,
            may_close: false,
            settings,
            places,
        };
        annotator.apply_theme(context);
        let left = annotator.places.journals().map(|j| muybridge_capture::waiting(&j)).unwrap_or_default();
        if let Some(path) = path {
            annotator.open(context, path);
        } else if !left.is_empty() {
            annotator.dialog = Some(Dialog::Recover(left));
        } else if !annotator.settings.tour_seen {
            annotator.open_specimen(context);
            annotator.tour = Some(Tour::default());
        }
        annotator.mention_tracks_left();
        annotator
    }

    fn apply_theme(&self, context: &Context) {
        context.set_theme(match self.settings.theme {
            Theme::System => egui::ThemePreference::System,
            Theme::Light => egui::ThemePreference::Light,
            Theme::Dark => egui::ThemePreference::Dark,
        });
    }

    /// One frame.
    pub fn ui(&mut self, ui: &mut Ui) {
        let context = ui.ctx().clone();
        self.finish_background_work(&context);
        self.take_dropped_files(&context);
        let mut commands = Vec::new();
        if !self.is_asking() {
            self.take_keys(&context, &mut commands);
        }
        let menu_bar = Panel::top("menu bar").show(ui, |ui| self.menu_bar(ui, &mut commands));
        if let Some(path) = menu_bar.inner {
            self.leave(&context, After::Open(path));
        }
        if let Some(session) = &mut self.session {
            session.before_frame(&context, self.settings.fit_always);
        }
        let Self { settings, messages, session, ride, footprints, .. } = self;
        if footprints.is_open() {
            let mut page = PageContext { settings, messages, commands: &mut commands };
            footprints.show(ui, session.is_some(), &mut page);
        } else if ride.is_open() {
            let mut page = PageContext { settings, messages, commands: &mut commands };
            ride.show(ui, session.as_mut(), &mut page);
        } else if let Some(session) = session {
            plate_ui(ui, session, &mut PageContext { settings, messages, commands: &mut commands });
        } else {
            let welcome = |ui: &mut Ui| views::welcome::show(ui, &self.settings, &mut commands);
            if let Some(path) = CentralPanel::default().show(ui, welcome).inner {
                self.open(&context, &path);
            }
        }
        self.windows(&context, &mut commands);
        for command in commands {
            self.run(&context, command);
        }
        self.watch_closing(&context);
        self.messages.show(&context);
    }

    /// Where commands act now.
    fn scope(&self) -> Scope {
        match (self.footprints.is_open(), self.ride.is_open()) {
            (true, _) => Scope::Footprints,
            (false, true) => Scope::Ride,
            (false, false) => Scope::Plate,
        }
    }

    /// Whether something is open that has the keys to itself.
    fn is_asking(&self) -> bool {
        self.dialog.is_some() || self.palette.is_some() || self.key_editor.is_some()
    }

    /// Keys that no text field takes.
    fn take_keys(&mut self, context: &Context, commands: &mut Vec<Command>) {
        if context.egui_wants_keyboard_input() {
            return;
        }
        let on = self.scope();
        let pressed: Vec<_> = context.input(|input| {
            let key = |event| Some((crate::keys::pressed(event)?, is_repeated(event)));
            input.events.iter().filter_map(key).collect()
        });
        for (key, is_repeated) in pressed {
            if let Some(command) = self.settings.keys.command(&key, on) {
                // Otherwise the focus of the keyboard moves, too.
                context.input_mut(|input| input.consume_key(key.modifiers, key.logical_key));
                if command.repeats() || !is_repeated {
                    commands.push(command);
                }
            }
        }
    }

    fn windows(&mut self, context: &Context, commands: &mut Vec<Command>) {
        if let Some(mut palette) = self.palette.take() {
            match palette.show(context, &self.settings.keys, |command| self.why_not(command)) {
                Chosen::Nothing => self.palette = Some(palette),
                Chosen::Closed => {}
                Chosen::Command(command) => commands.push(command),
            }
        }
        if let Some(editor) = &mut self.key_editor
            && !editor.show(context, &mut self.settings.keys)
        {
            self.key_editor = None;
            self.write_settings();
        }
        if let Some(browser) = &mut self.browser {
            let (open_path, stays) = browser.show(context, &mut self.messages);
            if !stays {
                self.browser = None;
            }
            if let Some(path) = open_path {
                self.leave(context, After::Open(path));
            }
        }
        if let (Some(window), Some(session)) = (&mut self.exchange, &mut self.session)
            && !window.show(context, session, &mut self.messages)
        {
            self.exchange = None;
        }
        if let Some(tour) = &mut self.tour
            && !tour.show(context, self.session.as_mut())
        {
            self.tour = None;
            self.settings.tour_seen = true;
            self.write_settings();
        }
        self.show_dialog(context);
    }

    fn finish_background_work(&mut self, context: &Context) {
        match take_answer(&mut self.opening) {
            Some(Ok(Ok(opened))) => self.take_opened(context, opened),
            Some(Ok(Err(trouble)) | Err(trouble)) => self.messages.trouble(trouble),
            None => {}
        }
        if let Some(Ok(picked)) = take_answer(&mut self.picking) {
            self.take_picked(context, picked);
        }
        if let Some(session) = &mut self.session {
            session.finish_background_work(&mut self.messages);
        }
    }

    fn take_dropped_files(&mut self, context: &Context) {
        let dropped = context.input(|input| input.raw.dropped_files.clone());
        let Some(last) = dropped.last().map(|file| file.path().to_path_buf()) else { return };
        if dropped.len() > 1 {
            let (count, name) = (dropped.len(), last.display());
            self.messages.trouble(format!(
                "{count} files were dropped, and only {name} is opened; put the frames of a plate into a folder and drop that"
            ));
        }
        self.leave(context, After::Open(last));
    }

    /// Starts to open a path; the plate that is open stays until the other one is there.
    pub fn open(&mut self, context: &Context, path: &Path) {
        let (path, journals) = (path.to_path_buf(), self.places.journals());
        let what = format!("Opening {}", path.display());
        self.opening = Some(Job::start(what, context, move || open(&path, journals.as_deref())));
    }

    /// Waits until what is being opened is there: for programs without a window.
    pub fn wait_until_open(&mut self, context: &Context) {
        if let Some(job) = self.opening.take() {
            match job.wait() {
                Ok(Ok(opened)) => self.take_opened(context, opened),
                Ok(Err(trouble)) | Err(trouble) => self.messages.trouble(trouble),
            }
        }
    }

    fn take_opened(&mut self, context: &Context, opened: Opened) {
        match opened {
            Opened::Document(document, troubles) => {
                troubles.into_iter().for_each(|trouble| self.messages.trouble(trouble));
                if self.has_unsaved_work() {
                    self.dialog = Some(Dialog::Unsaved(After::Show(document)));
                } else {
                    self.show_document(context, *document);
                }
            }
            Opened::Track(track, path) => self.offer_track(context, *track, &path),
            Opened::Waiting(waiting) => self.dialog = Some(Dialog::Recover(vec![waiting])),
            Opened::Folder(folder) => self.browser = Some(Browser::new(&folder)),
        }
    }

    fn show_document(&mut self, context: &Context, document: muybridge_capture::Document) {
        let path = match document.annotation_path() {
            path if path.exists() => path,
            _ => document.manifest_path(),
        };
        if path.exists() {
            self.settings.remember(path);
            self.write_settings();
        }
        self.close_session();
        let mut session = Session::new(document, context);
        if session.draft().annotation.annotator.is_empty() && !self.settings.annotator.is_empty() {
            let name = self.settings.annotator.clone();
            session.edit("Annotator", |draft| draft.annotation.annotator = name);
        }
        self.session = Some(session);
        self.ride.close();
        self.footprints.close();
    }

    /// Whether the open plate has changes that are not saved, what is being typed or dragged among them.
    fn has_unsaved_work(&mut self) -> bool {
        self.session.as_mut().is_some_and(|session| {
            session.commit();
            session.document.is_changed()
        })
    }

    /// Closes the open plate. Its journal stays where it has changes, and is offered again.
    fn close_session(&mut self) {
        if !self.has_unsaved_work() {
            self.discard_session();
        }
        (self.session, self.exchange) = (None, None);
    }

    /// Closes the open plate and forgets its changes: the person has said so.
    fn discard_session(&mut self) {
        if let Some(session) = self.session.take() {
            session.document.close();
        }
    }

    fn write_settings(&mut self) {
        if let Err(trouble) = self.settings.write() {
            self.messages.trouble(format!("Settings are not kept: {trouble}"));
        }
    }
}

/// Whether a key's event only says that it is still down.
fn is_repeated(event: &egui::Event) -> bool {
    matches!(event, egui::Event::Key { repeat: true, .. })
}

/// The pages of an open plate.
fn plate_ui(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    Panel::top("pages").show(ui, |ui| views::tabs::show(ui, session, page));
    Panel::bottom("strip").resizable(false).show(ui, |ui| views::strip::show(ui, session, page));
    Panel::right("inspector").default_size(310.0).size_range(260.0..=460.0).show(ui, |ui| {
        let scroll = egui::ScrollArea::vertical().id_salt(session.page as usize).auto_shrink(false);
        scroll.show(ui, |ui| match session.page {
            Page::Plate => views::plate_page::inspector(ui, session, page),
            Page::Calibrate => views::calibrate_page::inspector(ui, session, page),
            Page::Pose => views::pose_page::inspector(ui, session, page),
            Page::Gait => views::gait_page::inspector(ui, session, page),
            Page::Play => views::play_page::inspector(ui, session, page),
        });
    });
    let sheet = session.shown.sheet && session.panel_place().is_some();
    CentralPanel::no_frame().show(ui, |ui| match (sheet, session.page) {
        (true, _) => views::sheet::show(ui, session, page),
        (_, Page::Plate) => views::plate_page::canvas(ui, session, page),
        (_, Page::Calibrate) => views::calibrate_page::canvas(ui, session, page),
        (_, Page::Pose | Page::Gait) => views::pose_page::canvas(ui, session, page),
        (_, Page::Play) => views::play_page::canvas(ui, session, page),
    });
}
