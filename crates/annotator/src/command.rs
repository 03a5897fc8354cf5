//! Every command of the program: its name, its menu, its default keys. Menus, keys, the command list and the key editor are
//! all made from this one table.

use egui::{Key, KeyboardShortcut, Modifiers};

/// A menu of the menu bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Menu {
    /// Opening, saving, exchange.
    File,
    /// Undo, and what acts on the selected point.
    Edit,
    /// What is drawn.
    View,
    /// Panels and their order.
    Plate,
    /// Skeleton and points.
    Pose,
    /// Footfalls and the fit.
    Gait,
    /// Driving the horse.
    Ride,
    /// Motion from footprints.
    Footprints,
    /// Help and settings.
    Help,
}

impl Menu {
    /// All menus in the order of the bar, with their titles.
    pub const ALL: [(Self, &'static str); 9] = [
        (Self::File, "File"),
        (Self::Edit, "Edit"),
        (Self::View, "View"),
        (Self::Plate, "Plate"),
        (Self::Pose, "Pose"),
        (Self::Gait, "Gait"),
        (Self::Ride, "Ride"),
        (Self::Footprints, "Footprints"),
        (Self::Help, "Help"),
    ];
}

/// Where a command acts, and its keys with it: the same key may do one thing on the pages of a plate and another on the
/// Ride page or on the Footprints page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// On every page.
    Everywhere,
    /// On the pages of a plate.
    Plate,
    /// On the Ride page.
    Ride,
    /// On the Footprints page.
    Footprints,
}

impl Scope {
    /// Whether there is a page on which both act.
    pub fn meets(self, other: Self) -> bool {
        self == other || self == Self::Everywhere || other == Self::Everywhere
    }
}

/// What the table says of a command.
#[derive(Clone, Copy, Debug)]
pub struct Description {
    /// Name in the settings file; never changes.
    pub id: &'static str,
    /// Name for people.
    pub title: &'static str,
    /// Where it is found.
    pub menu: Menu,
    /// Keys unless the person chose others.
    pub keys: &'static [KeyboardShortcut],
}

const fn plain(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

const fn shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::SHIFT, key)
}

const fn command(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}

const fn command_shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), key)
}

macro_rules! commands {
    ($($(#[$about:meta])* $name:ident, $id:literal, $title:literal, $menu:ident, [$($key:expr),*];)*) => {
        /// A command.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Command {
            $($(#[$about])* $name,)*
        }

        impl Command {
            /// All commands in the order of their menus.
            pub const ALL: &'static [Self] = &[$(Self::$name),*];

            /// What the table says of it.
            pub fn description(self) -> Description {
                match self {
                    $(Self::$name => Description {
                        id: $id,
                        title: $title,
                        menu: Menu::$menu,
                        keys: const { &[$($key),*] },
                    },)*
                }
            }
        }
    };
}

commands! {
    /// A file dialog for a plate, an annotation or a picture.
    Open, "open", "Open…", File, [command(Key::O)];
    /// The catalogue of plates.
    Browse, "browse", "Browse plates…", File, [command(Key::B)];
    /// Writes both files.
    Save, "save", "Save", File, [command(Key::S)];
    /// Writes the annotation under another name.
    SaveAs, "save-as", "Save as…", File, [command_shift(Key::S)];
    /// Points from a file of another tool.
    Import, "import", "Import points…", File, [];
    /// Points into files of other tools.
    Export, "export", "Export points…", File, [command(Key::E)];
    /// Closes the plate.
    Close, "close", "Close plate", File, [command(Key::W)];
    /// Ends the program.
    Quit, "quit", "Quit", File, [command(Key::Q)];

    /// Takes the last step back.
    Undo, "undo", "Undo", Edit, [command(Key::Z)];
    /// Brings back the step taken back.
    Redo, "redo", "Redo", Edit, [command_shift(Key::Z), command(Key::Y)];
    /// The selected point is seen.
    Visible, "visible", "Point is visible", Edit, [plain(Key::V)];
    /// The selected point is guessed.
    Occluded, "occluded", "Point is occluded", Edit, [plain(Key::O)];
    /// The selected point is not there.
    Absent, "absent", "Point is absent", Edit, [plain(Key::X)];
    /// The selected point is forgotten.
    DeletePoint, "delete-point", "Delete point", Edit, [plain(Key::Delete), plain(Key::Backspace)];
    /// Moves the selected point.
    NudgeLeft, "nudge-left", "Nudge left", Edit, [plain(Key::ArrowLeft)];
    /// Moves the selected point.
    NudgeRight, "nudge-right", "Nudge right", Edit, [plain(Key::ArrowRight)];
    /// Moves the selected point.
    NudgeUp, "nudge-up", "Nudge up", Edit, [plain(Key::ArrowUp)];
    /// Moves the selected point.
    NudgeDown, "nudge-down", "Nudge down", Edit, [plain(Key::ArrowDown)];
    /// Moves the selected point a tenth.
    NudgeLeftFine, "nudge-left-fine", "Nudge left, fine", Edit, [shift(Key::ArrowLeft)];
    /// Moves the selected point a tenth.
    NudgeRightFine, "nudge-right-fine", "Nudge right, fine", Edit, [shift(Key::ArrowRight)];
    /// Moves the selected point a tenth.
    NudgeUpFine, "nudge-up-fine", "Nudge up, fine", Edit, [shift(Key::ArrowUp)];
    /// Moves the selected point a tenth.
    NudgeDownFine, "nudge-down-fine", "Nudge down, fine", Edit, [shift(Key::ArrowDown)];

    /// Splitting and order.
    PagePlate, "page-plate", "Plate page", View, [plain(Key::F1)];
    /// Scale, position, time.
    PageCalibrate, "page-calibrate", "Calibrate page", View, [plain(Key::F2)];
    /// Points and skeleton.
    PagePose, "page-pose", "Pose page", View, [plain(Key::F3)];
    /// Footfalls and numbers.
    PageGait, "page-gait", "Gait page", View, [plain(Key::F4)];
    /// The fitted stride, moving.
    PagePlay, "page-play", "Play page", View, [plain(Key::F5)];
    /// A horse to drive.
    PageRide, "page-ride", "Ride page", View, [plain(Key::F6)];
    /// Prints that become motion.
    PageFootprints, "page-footprints", "Footprints page", View, [plain(Key::F7)];
    /// The panel after this one; around the stride.
    NextPanel, "next-panel", "Next panel", View, [plain(Key::Period), plain(Key::PageDown)];
    /// The panel before this one.
    PreviousPanel, "previous-panel", "Previous panel", View, [plain(Key::Comma), plain(Key::PageUp)];
    /// All panels at once, or one.
    ContactSheet, "contact-sheet", "Contact sheet", View, [plain(Key::A)];
    /// The whole panel in the window.
    ZoomToFit, "zoom-to-fit", "Zoom to the whole panel", View, [plain(Key::Num0)];
    /// Closer.
    ZoomIn, "zoom-in", "Zoom in", View, [plain(Key::Plus), plain(Key::Equals)];
    /// Farther.
    ZoomOut, "zoom-out", "Zoom out", View, [plain(Key::Minus)];
    /// The glass beside the pointer.
    Magnifier, "magnifier", "Magnifier", View, [plain(Key::M)];
    /// Skeletons of the neighbouring panels.
    GhostSkeletons, "ghost-skeletons", "Neighbours' skeletons", View, [plain(Key::G)];
    /// The photograph of the panel before, over this one.
    GhostPhotograph, "ghost-photograph", "Neighbour's photograph", View, [shift(Key::G)];
    /// Paths of the hooves over the stride.
    HoofTrails, "hoof-trails", "Hoof trails", View, [plain(Key::H)];
    /// The fit over the photograph.
    ShowFit, "show-fit", "Fitted skeleton and residuals", View, [plain(Key::R)];
    /// Photograph alone while it is off.
    ShowMarks, "show-marks", "Points and lines", View, [plain(Key::Space)];
    /// Light or dark.
    Theme, "theme", "Light or dark", View, [];

    /// Proposes the panels.
    SplitAutomatically, "split", "Find panels", Plate, [];
    /// A new panel.
    AddPanel, "add-panel", "Add a panel", Plate, [];
    /// Takes the panel away.
    DeletePanel, "delete-panel", "Delete this panel", Plate, [];
    /// Changes places with the panel before.
    PanelEarlier, "panel-earlier", "Move panel earlier", Plate, [plain(Key::OpenBracket)];
    /// Changes places with the panel after.
    PanelLater, "panel-later", "Move panel later", Plate, [plain(Key::CloseBracket)];
    /// The rows of the plate run from right to left.
    MirrorOrder, "mirror-order", "Mirror the reading order", Plate, [];
    /// The last panel becomes the first.
    ReverseOrder, "reverse-order", "Reverse the order of time", Plate, [];
    /// The animal faces the other way.
    FlipFacing, "flip-facing", "Turn the facing round", Plate, [];
    /// Finds the ground of every panel that has none.
    FindGround, "find-ground", "Find the ground lines", Plate, [];

    /// Click by click in a drawn order.
    ToolGuided, "tool-guided", "Place points, guided", Pose, [plain(Key::P)];
    /// The selected point where one clicks.
    ToolFree, "tool-free", "Place points, freely", Pose, [shift(Key::P)];
    /// The skeleton, by its joints.
    ToolSkeleton, "tool-skeleton", "Drag the skeleton", Pose, [plain(Key::K)];
    /// The next point in the drawn order.
    NextPoint, "next-point", "Next point", Pose, [plain(Key::N)];
    /// The point before.
    PreviousPoint, "previous-point", "Previous point", Pose, [shift(Key::N)];
    /// The same point of the other side.
    OtherSide, "other-side", "Same point, other side", Pose, [plain(Key::S)];
    /// Pose of the panel before.
    CopyPrevious, "copy-previous", "Copy the previous panel's pose", Pose, [plain(Key::C)];
    /// Points tracked from the panels before (or after).
    ProposeTracked, "propose-tracked", "Propose by tracking", Pose, [plain(Key::T)];
    /// Points between the panels before and after.
    ProposeInterpolated, "propose-interpolated", "Propose by interpolation", Pose, [plain(Key::I)];
    /// Points of the fit.
    ProposeFitted, "propose-fitted", "Propose from the fit", Pose, [plain(Key::F)];
    /// Near and off legs of one pair.
    SwapFore, "swap-fore", "Swap near and off, forelegs", Pose, [];
    /// Near and off legs of one pair.
    SwapHind, "swap-hind", "Swap near and off, hindlegs", Pose, [];
    /// Near and off of the whole panel.
    SwapPanel, "swap-panel", "Swap near and off, all legs", Pose, [];
    /// All points of the panel.
    ClearPanel, "clear-panel", "Delete all points of this panel", Pose, [];
    /// Starts or ends a blind second pass.
    SecondPass, "second-pass", "Blind second pass", Pose, [];

    /// Stance, swing, unknown.
    ToggleNearFore, "toggle-near-fore", "Near fore down or up", Gait, [plain(Key::Num1)];
    /// Stance, swing, unknown.
    ToggleOffFore, "toggle-off-fore", "Off fore down or up", Gait, [plain(Key::Num2)];
    /// Stance, swing, unknown.
    ToggleNearHind, "toggle-near-hind", "Near hind down or up", Gait, [plain(Key::Num3)];
    /// Stance, swing, unknown.
    ToggleOffHind, "toggle-off-hind", "Off hind down or up", Gait, [plain(Key::Num4)];
    /// Fits now.
    FitNow, "fit", "Fit the stride", Gait, [command(Key::F)];
    /// Fits whenever something changed.
    FitAlways, "fit-always", "Fit while working", Gait, [];
    /// The worst point.
    WorstPoint, "worst-point", "Go to the worst point", Gait, [plain(Key::W)];
    /// Moves, or stops.
    PlayStride, "play", "Play or pause", Gait, [plain(Key::Enter)];

    /// A mile per hour more.
    RideFaster, "ride-faster", "Faster by 1 mph", Ride, [plain(Key::ArrowUp), plain(Key::W)];
    /// A mile per hour less.
    RideSlower, "ride-slower", "Slower by 1 mph", Ride, [plain(Key::ArrowDown), plain(Key::S)];
    /// A step of 15 degrees; held, a turn.
    RideLeft, "ride-left", "Left rein: tap for 15°, hold to turn", Ride, [plain(Key::ArrowLeft), plain(Key::A)];
    /// A step of 15 degrees; held, a turn.
    RideRight, "ride-right", "Right rein: tap for 15°, hold to turn", Ride, [plain(Key::ArrowRight), plain(Key::D)];
    /// Stands.
    RideHalt, "ride-halt", "Halt", Ride, [plain(Key::H)];
    /// The speed chooses the gait.
    RideAutomatic, "ride-automatic", "Gait as the speed asks", Ride, [plain(Key::Num0)];
    /// This gait.
    RideWalk, "ride-walk", "Walk", Ride, [plain(Key::Num1)];
    /// This gait.
    RideAmble, "ride-amble", "Amble", Ride, [plain(Key::Num2)];
    /// This gait.
    RideTrot, "ride-trot", "Trot", Ride, [plain(Key::Num3)];
    /// This gait.
    RideRack, "ride-rack", "Rack", Ride, [plain(Key::Num4)];
    /// This gait.
    RideCanter, "ride-canter", "Canter", Ride, [plain(Key::Num5)];
    /// This gait.
    RideGallop, "ride-gallop", "Gallop", Ride, [plain(Key::Num6)];
    /// As the turn asks, left, right.
    RideLead, "ride-lead", "Next lead", Ride, [plain(Key::L)];
    /// One leap.
    RideLeap, "ride-leap", "Leap", Ride, [plain(Key::Space)];
    /// Stops time, or lets it go on.
    RidePause, "ride-pause", "Pause or go on", Ride, [plain(Key::P)];
    /// A sixtieth of a second later.
    RideStepForward, "ride-step-forward", "Single step forward", Ride, [plain(Key::Period)];
    /// A sixtieth of a second earlier.
    RideStepBack, "ride-step-back", "Single step back", Ride, [plain(Key::Comma)];
    /// Side, three-quarter, front, follow.
    RideCamera, "ride-camera", "Next camera", Ride, [plain(Key::C)];
    /// From the beginning.
    RideReset, "ride-reset", "Begin again", Ride, [plain(Key::R)];
    /// Back to the plate, or to the first page.
    RideLeave, "ride-leave", "Leave the Ride page", Ride, [plain(Key::Escape)];

    /// Takes the last step back.
    FootprintsUndo, "footprints-undo", "Undo a change of the track", Footprints, [command(Key::Z)];
    /// Brings back the step taken back.
    FootprintsRedo, "footprints-redo", "Redo a change of the track", Footprints, [command_shift(Key::Z), command(Key::Y)];
    /// The next foot, where the track goes on.
    FootprintsAdd, "footprints-add", "Add a print", Footprints, [plain(Key::Insert), plain(Key::Plus)];
    /// Prints, or a point of the path.
    FootprintsDelete, "footprints-delete", "Delete what is selected", Footprints, [plain(Key::Delete), plain(Key::Backspace)];
    /// All prints.
    FootprintsSelectAll, "footprints-select-all", "Select all prints", Footprints, [command(Key::A)];
    /// The print after this one.
    FootprintsNextPrint, "footprints-next", "Select the next print", Footprints, [plain(Key::N), plain(Key::PageDown)];
    /// The print before this one.
    FootprintsPreviousPrint, "footprints-previous", "Select the previous print", Footprints, [shift(Key::N), plain(Key::PageUp)];
    /// A centimetre.
    FootprintsNudgeLeft, "footprints-nudge-left", "Move prints left by 1 cm", Footprints, [plain(Key::ArrowLeft)];
    /// A centimetre.
    FootprintsNudgeRight, "footprints-nudge-right", "Move prints right by 1 cm", Footprints, [plain(Key::ArrowRight)];
    /// A centimetre.
    FootprintsNudgeUp, "footprints-nudge-up", "Move prints up by 1 cm", Footprints, [plain(Key::ArrowUp)];
    /// A centimetre.
    FootprintsNudgeDown, "footprints-nudge-down", "Move prints down by 1 cm", Footprints, [plain(Key::ArrowDown)];
    /// Each click is a point, or not any more.
    FootprintsPath, "footprints-path", "Draw a path", Footprints, [plain(Key::D)];
    /// Along the path; or those that lie there become the track's own.
    FootprintsLay, "footprints-lay", "Lay prints along the path", Footprints, [plain(Key::L)];
    /// Time passes, or stands.
    FootprintsPlay, "footprints-play", "Play or pause the motion", Footprints, [plain(Key::P), plain(Key::Enter)];
    /// A sixtieth of a second later.
    FootprintsStepForward, "footprints-step-forward", "A moment later", Footprints, [plain(Key::Period)];
    /// A sixtieth of a second earlier.
    FootprintsStepBack, "footprints-step-back", "A moment earlier", Footprints, [plain(Key::Comma)];
    /// The first moment.
    FootprintsBegin, "footprints-begin", "To the beginning", Footprints, [plain(Key::Home)];
    /// The whole track.
    FootprintsShowAll, "footprints-show-all", "Show the whole track", Footprints, [plain(Key::Num0)];
    /// Closer.
    FootprintsZoomIn, "footprints-zoom-in", "Look closer at the plan", Footprints, [plain(Key::Equals)];
    /// Farther.
    FootprintsZoomOut, "footprints-zoom-out", "See more of the plan", Footprints, [plain(Key::Minus)];
    /// Side, three-quarter, front, follow.
    FootprintsCamera, "footprints-camera", "Next camera of the figure", Footprints, [plain(Key::C)];
    /// A bird among trees, or its end.
    FootprintsWander, "footprints-wander", "Let a bird wander, or end its walk", Footprints, [plain(Key::W)];
    /// The walk so far, to be edited.
    FootprintsKeepWalk, "footprints-keep-walk", "Keep the walk as a track", Footprints, [plain(Key::K)];
    /// A track to begin with.
    FootprintsNewBird, "footprints-new-bird", "New: walking bird", Footprints, [];
    /// A track to begin with.
    FootprintsNewStairs, "footprints-new-stairs", "New: dinosaur on stairs", Footprints, [];
    /// A track to begin with.
    FootprintsNewLeaps, "footprints-new-leaps", "New: a turn and leaps", Footprints, [];
    /// A track to begin with.
    FootprintsNewRunner, "footprints-new-runner", "New: running human", Footprints, [];
    /// A track to begin with.
    FootprintsNewTimed, "footprints-new-timed", "New: bird, timed by its distances", Footprints, [];
    /// A track to begin with.
    FootprintsNewPath, "footprints-new-path", "New: human along a path", Footprints, [];
    /// A track to begin with.
    FootprintsNewTrot, "footprints-new-trot", "New: horse in trot along a path", Footprints, [];
    /// A track to begin with.
    FootprintsNewRiver, "footprints-new-river", "New: stepping stones across a river", Footprints, [];
    /// Nothing yet.
    FootprintsNewEmpty, "footprints-new-empty", "New: no prints", Footprints, [];
    /// Ends what is under way, then the tool, then the selection, then the page.
    FootprintsLeave, "footprints-leave", "Step out of the Footprints page", Footprints, [plain(Key::Escape)];

    /// All commands by name.
    Palette, "palette", "All commands…", Help, [command_shift(Key::P), command(Key::P)];
    /// Which key does what.
    Keys, "keys", "Keys…", Help, [command(Key::Comma)];
    /// A short tour.
    Tour, "tour", "Tour", Help, [];
    /// A drawn plate to try things on.
    OpenSpecimen, "specimen", "Open a specimen plate", Help, [];
}

impl Command {
    /// The command of this name in the settings.
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|command| command.description().id == id)
    }

    /// Where it acts.
    pub fn scope(self) -> Scope {
        let everywhere = matches!(
            self,
            Self::PagePlate
                | Self::PageCalibrate
                | Self::PagePose
                | Self::PageGait
                | Self::PagePlay
                | Self::PageRide
                | Self::PageFootprints
                | Self::Theme
        );
        match self.description().menu {
            _ if everywhere => Scope::Everywhere,
            Menu::File | Menu::Help => Scope::Everywhere,
            Menu::Ride => Scope::Ride,
            Menu::Footprints => Scope::Footprints,
            Menu::Edit | Menu::View | Menu::Plate | Menu::Pose | Menu::Gait => Scope::Plate,
        }
    }

    /// Whether a key that is held down does it again and again.
    pub fn repeats(self) -> bool {
        let steps =
            matches!(self, Self::RideFaster | Self::RideSlower | Self::RideStepForward | Self::RideStepBack);
        let once = matches!(
            self,
            Self::FootprintsPlay | Self::FootprintsWander | Self::FootprintsPath | Self::FootprintsLeave
        );
        steps || (self.scope() != Scope::Ride && !once)
    }

    /// Name for people.
    pub fn title(self) -> &'static str {
        self.description().title
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn names_and_default_keys_are_each_used_once() {
        let ids: BTreeSet<_> = Command::ALL.iter().map(|c| c.description().id).collect();
        let titles: BTreeSet<_> = Command::ALL.iter().map(|c| c.title()).collect();
        assert_eq!((ids.len(), titles.len()), (Command::ALL.len(), Command::ALL.len()));
        for (at, command) in Command::ALL.iter().enumerate() {
            for other in Command::ALL[..at].iter().filter(|other| other.scope().meets(command.scope())) {
                let clash = command.description().keys.iter().find(|k| other.description().keys.contains(k));
                assert_eq!(clash, None, "of {command:?} and {other:?}");
            }
        }
        assert_eq!(Command::from_id("undo"), Some(Command::Undo));
    }
}
