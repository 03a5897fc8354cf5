//! Steps that can be taken back and brought again.

use super::draft::{Draft, Part};

/// One step: what to put in place to undo and to redo it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Step {
    pub(crate) label: String,
    pub(crate) undo: Vec<Part>,
    pub(crate) redo: Vec<Part>,
}

impl Step {
    /// The step from one state to another; none when they are the same.
    pub(crate) fn between(label: &str, before: &Draft, after: &Draft) -> Option<Self> {
        let redo = before.difference(after);
        (!redo.is_empty()).then(|| Self { label: label.into(), undo: after.difference(before), redo })
    }
}

/// All steps, and how many of them are in effect.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    steps: Vec<Step>,
    done: usize,
}

impl History {
    /// Adds a step; what had been undone can no longer be redone.
    pub(crate) fn push(&mut self, step: Step) {
        self.steps.truncate(self.done);
        self.steps.push(step);
        self.done += 1;
    }

    pub(crate) fn undo_label(&self) -> Option<&str> {
        self.done.checked_sub(1).map(|at| self.steps[at].label.as_str())
    }

    pub(crate) fn redo_label(&self) -> Option<&str> {
        self.steps.get(self.done).map(|step| step.label.as_str())
    }

    pub(crate) fn undo(&mut self, draft: &mut Draft) -> Option<String> {
        self.done = self.done.checked_sub(1)?;
        draft.apply(&self.steps[self.done].undo);
        Some(self.steps[self.done].label.clone())
    }

    pub(crate) fn redo(&mut self, draft: &mut Draft) -> Option<String> {
        let step = self.steps.get(self.done)?;
        draft.apply(&step.redo);
        self.done += 1;
        Some(step.label.clone())
    }
}
