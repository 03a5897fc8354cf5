//! Reading the plate's pictures in a thread of their own.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};

use muybridge_imaging::{LoadLimits, load_rgb};

use super::pyramid::Pyramid;

/// What is known of one picture file.
#[derive(Clone, Debug, Default)]
pub enum ImageState {
    /// Not read yet.
    #[default]
    Waiting,
    /// Ready to be drawn.
    Ready(Arc<Pyramid>),
    /// Cannot be read; the text says which file, why, and what to do.
    Failed(String),
}

/// The pictures of a plate (one, or one per panel), read one after the other in a thread.
/// When it is dropped, the thread ends after the picture it is reading.
#[derive(Debug)]
pub struct PlateImages {
    states: Vec<ImageState>,
    arriving: Receiver<(usize, ImageState)>,
    wanted: Arc<AtomicUsize>,
}

impl PlateImages {
    /// Starts to read the files in order, beginning with number `first`; `wake` is called in the thread after each.
    pub fn load(paths: Vec<PathBuf>, first: usize, wake: impl Fn() + Send + 'static) -> Self {
        let (sender, arriving) = channel();
        let wanted = Arc::new(AtomicUsize::new(first));
        let states = vec![ImageState::Waiting; paths.len()];
        let asked = Arc::clone(&wanted);
        let thread = std::thread::Builder::new().name("plate images".to_owned());
        // Without a thread the sender is dropped, and `poll` says so.
        let _ = thread.spawn(move || read_all(&paths, &asked, &sender, &wake));
        Self { states, arriving, wanted }
    }

    /// Takes what has been read since the last call; true when there was something.
    pub fn poll(&mut self) -> bool {
        let mut changed = false;
        loop {
            match self.arriving.try_recv() {
                Ok((index, state)) => self.states[index] = state,
                Err(TryRecvError::Empty) => return changed,
                Err(TryRecvError::Disconnected) => return self.give_up_waiting() || changed,
            }
            changed = true;
        }
    }

    /// The picture that is looked at: it is read next, and those after it follow.
    pub fn want(&self, index: usize) {
        self.wanted.store(index, Ordering::Relaxed);
    }

    /// All pictures in the order of the paths.
    pub fn states(&self) -> &[ImageState] {
        &self.states
    }

    /// A picture that has been read.
    pub fn ready(&self, index: usize) -> Option<&Arc<Pyramid>> {
        match self.states.get(index)? {
            ImageState::Ready(pyramid) => Some(pyramid),
            ImageState::Waiting | ImageState::Failed(_) => None,
        }
    }

    /// The thread has ended: nothing else will come.
    fn give_up_waiting(&mut self) -> bool {
        let waiting = self.states.iter_mut().filter(|state| matches!(state, ImageState::Waiting));
        let text = "reading the picture stopped unexpectedly; open the plate again";
        waiting.map(|state| *state = ImageState::Failed(text.to_owned())).count() > 0
    }
}

fn read_all(paths: &[PathBuf], wanted: &AtomicUsize, sender: &Sender<(usize, ImageState)>, wake: &dyn Fn()) {
    let mut left: Vec<usize> = (0..paths.len()).collect();
    while !left.is_empty() {
        let wanted = wanted.load(Ordering::Relaxed);
        // The first at or after the wanted one, else the first of all.
        let next = left.iter().position(|&index| index >= wanted).unwrap_or(0);
        let index = left.remove(next);
        let state = match load_rgb(&paths[index], LoadLimits::default()) {
            Ok(picture) => ImageState::Ready(Arc::new(Pyramid::new(picture))),
            Err(error) => ImageState::Failed(error.to_string()),
        };
        if sender.send((index, state)).is_err() {
            return;
        }
        wake();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::RgbImage;
    use std::sync::mpsc::RecvTimeoutError;
    use std::time::Duration;

    /// Polls until every picture has arrived, and gives the order in which they did.
    fn arrivals(paths: Vec<PathBuf>, first: usize) -> (PlateImages, Vec<usize>) {
        let (wake, woken) = channel();
        let mut images = PlateImages::load(paths, first, move || {
            let _ = wake.send(());
        });
        let mut order = Vec::new();
        loop {
            let gone = woken.recv_timeout(Duration::from_secs(20)) == Err(RecvTimeoutError::Disconnected);
            while let Ok((index, state)) = images.arriving.try_recv() {
                images.states[index] = state;
                order.push(index);
            }
            if gone {
                return (images, order);
            }
        }
    }

    #[test]
    fn pictures_come_in_order_from_the_wanted_one_on_and_errors_as_text() {
        let folder = tempfile::tempdir().unwrap();
        let path = |i: u32| folder.path().join(format!("{i}.png"));
        for i in [0, 1, 3] {
            RgbImage::new(10 + i, 5).save(path(i)).unwrap();
        }
        let (mut images, order) = arrivals((0..4).map(path).collect(), 2);
        assert_eq!(order, [2, 3, 0, 1]);
        assert_eq!(images.ready(3).unwrap().size_px(), [13, 5]);
        assert!(matches!(&images.states()[2], ImageState::Failed(text) if text.contains("2.png")));
        assert!(!images.poll() && images.ready(2).is_none() && images.ready(9).is_none());
    }

    #[test]
    fn a_thread_that_dies_is_told_and_no_picture_is_waited_for_in_vain() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        RgbImage::new(3, 3).save(&path).unwrap();
        let mut images = PlateImages::load(vec![path.clone(), path], 0, || panic!("a wake-up that panics"));
        for _ in 0..2000 {
            images.poll();
            if !matches!(images.states()[1], ImageState::Waiting) {
                break;
            }
            std::thread::sleep(Duration::from_millis(5));
        }
        assert!(
            matches!(&images.states()[1], ImageState::Failed(text) if text.contains("open the plate again"))
        );
        assert!(images.ready(0).is_some());
    }
}
