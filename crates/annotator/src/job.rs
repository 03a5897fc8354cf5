//! Work in the background: a thread, its answer, and a repaint when it is there.

use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// Work under way.
#[derive(Debug)]
pub struct Job<T> {
    /// What is being done, for people.
    pub what: String,
    answer: Receiver<T>,
}

impl<T: Send + 'static> Job<T> {
    /// Starts work in a thread of its own; the window is painted again when it ends.
    pub fn start(
        what: impl Into<String>,
        context: &egui::Context,
        work: impl FnOnce() -> T + Send + 'static,
    ) -> Self {
        let (sender, answer) = channel();
        let context = context.clone();
        let thread = std::thread::Builder::new().name("work".into());
        // Without a thread the sender is dropped, and `poll` says so.
        let _ = thread.spawn(move || {
            // The window may be gone by now; then nobody wants the answer.
            sender.send(work()).ok();
            context.request_repaint();
        });
        Self { what: what.into(), answer }
    }

    /// The answer, once; an error in words when the work stopped without one.
    pub fn poll(&self) -> Option<Result<T, String>> {
        match self.answer.try_recv() {
            Ok(answer) => Some(Ok(answer)),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err(format!("{}: stopped unexpectedly", self.what))),
        }
    }

    /// Waits for the answer.
    ///
    /// # Errors
    /// In words, when the work stopped without one.
    pub fn wait(self) -> Result<T, String> {
        self.answer.recv().map_err(|_| format!("{}: stopped unexpectedly", self.what))
    }
}

/// The answer of a job that may be under way; the place is empty afterwards.
pub fn take_answer<T: Send + 'static>(job: &mut Option<Job<T>>) -> Option<Result<T, String>> {
    let answer = job.as_ref()?.poll()?;
    *job = None;
    Some(answer)
}
