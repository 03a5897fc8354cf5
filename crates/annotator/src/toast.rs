//! Messages that come and go at the lower edge, and stay in a list.

use egui::{Align2, Area, Color32, Context, Frame, Id, RichText, vec2};

/// Seconds a message stays: time to read two lines.
const SHOWN_S: f64 = 6.0;
/// Messages shown at once.
const AT_ONCE: usize = 4;
/// Messages that are kept to be looked up.
const KEPT: usize = 200;

/// Longest message, characters: a damaged file may hold a word of megabytes, which would be quoted.
const LONGEST: usize = 3000;

/// How much a message matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// Something was done.
    Note,
    /// Something could not be done.
    Trouble,
}

/// One message.
#[derive(Clone, Debug)]
pub struct Message {
    /// The text.
    pub text: String,
    /// How much it matters.
    pub weight: Weight,
    until_s: Option<f64>,
}

/// All messages.
#[derive(Debug, Default)]
pub struct Messages {
    messages: Vec<Message>,
}

impl Messages {
    /// Says that something was done.
    pub fn note(&mut self, text: impl Into<String>) {
        self.add(text.into(), Weight::Note);
    }

    /// Says that something could not be done, and why.
    pub fn trouble(&mut self, text: impl Into<String>) {
        self.add(text.into(), Weight::Trouble);
    }

    fn add(&mut self, text: String, weight: Weight) {
        let text = shortened(text);
        // The same again replaces the first: a held key must not fill the window.
        self.messages.retain(|message| message.text != text);
        self.messages.push(Message { text, weight, until_s: None });
        let surplus = self.messages.len().saturating_sub(KEPT);
        self.messages.drain(..surplus);
    }

    /// All messages, oldest first.
    pub fn all(&self) -> &[Message] {
        &self.messages
    }

    /// Draws those that are still to be seen.
    pub fn show(&mut self, context: &Context) {
        let now_s = context.input(|input| input.time);
        for message in &mut self.messages {
            message.until_s.get_or_insert(now_s + SHOWN_S);
        }
        let is_shown = |message: &&Message| message.until_s.is_some_and(|until_s| until_s > now_s);
        let shown: Vec<Message> = self.messages.iter().filter(is_shown).cloned().collect();
        let latest = &shown[shown.len().saturating_sub(AT_ONCE)..];
        let Some(next_s) = latest.iter().filter_map(|message| message.until_s).reduce(f64::min) else {
            return;
        };
        context.request_repaint_after(std::time::Duration::from_secs_f64((next_s - now_s).max(0.05)));
        let area = Area::new(Id::unique("messages")).interactable(false);
        area.anchor(Align2::LEFT_BOTTOM, vec2(12.0, -170.0)).show(context, |ui| {
            for message in latest {
                let color = match message.weight {
                    Weight::Note => ui.visuals().text_color(),
                    Weight::Trouble => trouble_color(ui.visuals().dark_mode),
                };
                Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_max_width(620.0);
                    ui.label(RichText::new(&message.text).color(color));
                });
            }
        });
    }
}

/// Beginning and end of what is too long: which file it is about, and what to do.
fn shortened(text: String) -> String {
    let count = text.chars().count();
    if count <= LONGEST {
        return text;
    }
    let beginning: String = text.chars().take(LONGEST / 2).collect();
    let end: String = text.chars().skip(count - LONGEST / 2).collect();
    format!("{beginning} … {end}")
}

/// Red that is readable on the background.
pub fn trouble_color(dark: bool) -> Color32 {
    if dark { Color32::from_rgb(255, 140, 120) } else { Color32::from_rgb(170, 30, 10) }
}
