//! Which key does which command; every one can be chosen anew.

use std::collections::BTreeMap;

use egui::{Key, KeyboardShortcut, Modifiers};

use crate::command::{Command, Scope};

/// Keys as chosen: the table's own where nothing else was chosen.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KeyMap {
    chosen: BTreeMap<Command, Vec<KeyboardShortcut>>,
}

impl KeyMap {
    /// The map of a settings file: keys in words by the name of the command. Names and keys that do not exist are left out.
    pub fn from_words(words: &BTreeMap<String, Vec<String>>) -> Self {
        let chosen = words.iter().filter_map(|(id, keys)| {
            Some((Command::from_id(id)?, keys.iter().filter_map(|key| from_words(key)).collect()))
        });
        Self { chosen: chosen.collect() }
    }

    /// The same map in words.
    pub fn to_words(&self) -> BTreeMap<String, Vec<String>> {
        let words = self.chosen.iter().map(|(command, keys)| {
            (command.description().id.to_string(), keys.iter().map(to_words).collect())
        });
        words.collect()
    }

    /// Keys of a command.
    pub fn keys(&self, command: Command) -> &[KeyboardShortcut] {
        self.chosen.get(&command).map_or(command.description().keys, Vec::as_slice)
    }

    /// The first key of a command in words; empty when it has none.
    pub fn shown(&self, command: Command) -> String {
        self.keys(command).first().map(to_words).unwrap_or_default()
    }

    /// The command that a key does on the pages of a plate or on the Ride page.
    pub fn command(&self, key: &KeyboardShortcut, on: Scope) -> Option<Command> {
        let acts = |command: &Command| command.scope().meets(on) && self.keys(*command).contains(key);
        Command::ALL.iter().copied().find(acts)
    }

    /// Gives a command one key; the commands that had it where this one acts lose it, and the first of them is returned.
    pub fn choose(&mut self, command: Command, key: KeyboardShortcut) -> Option<Command> {
        let has = |other: &Command| *other != command && self.keys(*other).contains(&key);
        let losers: Vec<Command> = meeting(command).filter(has).collect();
        for other in &losers {
            let left = self.keys(*other).iter().copied().filter(|k| *k != key).collect();
            self.chosen.insert(*other, left);
        }
        self.chosen.insert(command, vec![key]);
        losers.first().copied()
    }

    /// Gives a command its default keys again, as far as no other command has been given them.
    pub fn reset(&mut self, command: Command) {
        self.chosen.remove(&command);
        let taken = |key: &KeyboardShortcut| {
            let mut chosen = meeting(command).filter_map(|other| self.chosen.get(&other));
            chosen.any(|keys| keys.contains(key))
        };
        let free: Vec<_> = command.description().keys.iter().copied().filter(|key| !taken(key)).collect();
        if free.len() < command.description().keys.len() {
            self.chosen.insert(command, free);
        }
    }

    /// All default keys again.
    pub fn reset_all(&mut self) {
        self.chosen.clear();
    }
}

/// Commands that act where this one does, itself among them.
fn meeting(command: Command) -> impl Iterator<Item = Command> {
    Command::ALL.iter().copied().filter(move |other| other.scope().meets(command.scope()))
}

/// `Ctrl+Shift+Z`.
pub fn to_words(key: &KeyboardShortcut) -> String {
    let Modifiers { alt, shift, command, ctrl, .. } = key.modifiers;
    let modifiers = [(command || ctrl, "Ctrl+"), (alt, "Alt+"), (shift, "Shift+")];
    let held: String = modifiers.iter().filter(|(held, _)| *held).map(|(_, name)| *name).collect();
    held + key_name(key.logical_key)
}

/// What stands on the key; arrows by their names.
fn key_name(key: Key) -> &'static str {
    match key {
        Key::ArrowDown | Key::ArrowLeft | Key::ArrowRight | Key::ArrowUp => key.name(),
        _ => key.symbol_or_name(),
    }
}

/// The key of such words.
fn from_words(words: &str) -> Option<KeyboardShortcut> {
    let mut modifiers = Modifiers::NONE;
    let mut rest = words;
    for (name, modifier) in
        [("Ctrl+", Modifiers::COMMAND), ("Alt+", Modifiers::ALT), ("Shift+", Modifiers::SHIFT)]
    {
        if let Some(after) = rest.strip_prefix(name) {
            (rest, modifiers) = (after, modifiers.plus(modifier));
        }
    }
    Some(KeyboardShortcut::new(modifiers, Key::from_name(rest)?))
}

/// Whether a key only changes what others mean: Ctrl+L begins with one.
fn is_modifier(key: Key) -> bool {
    use Key as K;
    matches!(
        key,
        K::ShiftLeft
            | K::ShiftRight
            | K::ControlLeft
            | K::ControlRight
            | K::AltLeft
            | K::AltRight
            | K::SuperLeft
            | K::SuperRight
    )
}

/// The key of an input event, with the modifiers that keys are told apart by.
pub fn pressed(event: &egui::Event) -> Option<KeyboardShortcut> {
    let egui::Event::Key { key, pressed: true, modifiers, .. } = event else { return None };
    if is_modifier(*key) {
        return None;
    }
    let mut held = Modifiers::NONE;
    for (is_held, modifier) in [
        (modifiers.command || modifiers.ctrl, Modifiers::COMMAND),
        (modifiers.alt, Modifiers::ALT),
        (modifiers.shift && key.name() != "Plus", Modifiers::SHIFT),
    ] {
        if is_held {
            held = held.plus(modifier);
        }
    }
    Some(KeyboardShortcut::new(held, *key))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_go_through_words_and_back() {
        for key in Command::ALL.iter().flat_map(|command| command.description().keys) {
            assert_eq!(from_words(&to_words(key)), Some(*key));
        }
        assert_eq!(to_words(&Command::Redo.description().keys[0]), "Ctrl+Shift+Z");
        assert_eq!(from_words("Ctrl+Nonsense"), None);
    }

    #[test]
    fn a_modifier_alone_is_no_key_to_choose() {
        let event = |key, modifiers| egui::Event::Key {
            key,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers,
        };
        assert_eq!(pressed(&event(Key::ControlLeft, Modifiers::CTRL)), None);
        let key = pressed(&event(Key::L, Modifiers::CTRL | Modifiers::SHIFT)).unwrap();
        assert_eq!(to_words(&key), "Ctrl+Shift+L");
        assert_eq!(to_words(&KeyboardShortcut::new(Modifiers::NONE, Key::OpenBracket)), "[");
    }

    #[test]
    fn a_key_does_one_command_only() {
        let mut map = KeyMap::default();
        let key = map.keys(Command::Undo)[0];
        assert_eq!(map.choose(Command::Palette, key), Some(Command::Undo));
        assert_eq!(map.command(&key, Scope::Plate), Some(Command::Palette));
        assert_eq!(map.keys(Command::Undo), []);
        assert_eq!(KeyMap::from_words(&map.to_words()), map);
        map.reset(Command::Undo);
        assert_eq!(map.keys(Command::Undo), [], "its default is taken");
        map.reset_all();
        assert_eq!(map.command(&key, Scope::Plate), Some(Command::Undo));
    }

    #[test]
    fn the_ride_page_and_the_plate_have_keys_of_their_own() {
        let mut map = KeyMap::default();
        let p = KeyboardShortcut::new(Modifiers::NONE, Key::P);
        assert_eq!(map.command(&p, Scope::Ride), Some(Command::RidePause));
        assert_eq!(map.command(&p, Scope::Plate), Some(Command::ToolGuided));
        let v = KeyboardShortcut::new(Modifiers::NONE, Key::V);
        assert_eq!(map.command(&v, Scope::Ride), None);
        assert_eq!(map.choose(Command::RideHalt, v), None, "the plate's own V stays");
        assert_eq!(map.choose(Command::Save, v), Some(Command::Visible));
        assert_eq!((map.keys(Command::Visible), map.keys(Command::RideHalt)), ([].as_slice(), [].as_slice()));
        assert_eq!(map.command(&v, Scope::Ride), Some(Command::Save));
    }
}
