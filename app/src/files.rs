//! Files that a user opens: by a dialog, by dropping them on the window, by the command line, or once more, natively
//! and on the web.

#[cfg(not(target_arch = "wasm32"))]
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use hysteron_core::measurement::Kind;
use hysteron_core::message::Message;
use hysteron_core::user_model::UserModel;

use crate::recent::Recent;
use crate::save::AT_ONCE;
use hysteron_work::content::Content;
use hysteron_work::enclosed::Enclosed;
use hysteron_work::reading::Reading;

/// A file that has been read.
pub struct Arrival {
    /// Its name.
    pub name: String,
    /// Its bytes, or why there are none.
    pub bytes: Result<Vec<u8>, String>,
    /// What it does not say itself, where it was opened before.
    pub reading: Reading,
}

/// What a dialog asks for: in words, and by the endings of names.
#[derive(Clone, Copy, Debug)]
pub struct Filter {
    words: &'static str,
    endings: &'static [&'static str],
}

/// A measurement.
pub const MEASUREMENT: Filter = Filter {
    words: "Measurement",
    endings: &["csv", "txt", "tsv", "mat"],
};

/// A relay test: a measurement, or the log of an auto-tuner.
pub const TEST: Filter = Filter {
    words: "Relay test",
    endings: &["csv", "txt", "tsv", "mat", "log"],
};

/// What the user knows of a model.
pub const MODEL: Filter = Filter {
    words: "Model",
    endings: &["toml"],
};

/// A loop in a file.
pub const SCENARIO: Filter = Filter {
    words: "Scenario",
    endings: &["toml"],
};

/// What to do where no dialog can be shown.
const NO_DIALOG: &str = "No dialog can be shown here: drop the file on this window.";

/// A file that is being read elsewhere, and how to find it again.
struct Read {
    name: String,
    /// Where it is, empty in a browser; nothing where it came from no place to which one can go back.
    path: Option<String>,
    bytes: Result<Vec<u8>, String>,
    reading: Reading,
}

impl Read {
    /// A file that says itself what it holds, as far as is known.
    fn new(name: String, path: String, bytes: Result<Vec<u8>, String>) -> Self {
        Self {
            name,
            path: Some(path),
            bytes,
            reading: Reading::default(),
        }
    }
}

/// A file that is named on the command line: it is opened like one that is dropped.
#[cfg(not(target_arch = "wasm32"))]
#[derive(Debug)]
pub struct Given(PathBuf);

#[cfg(not(target_arch = "wasm32"))]
impl Given {
    /// The file at `path`, which is found from elsewhere too the next time.
    pub fn new(path: &Path) -> Self {
        Self(std::path::absolute(path).unwrap_or_else(|_| path.to_owned()))
    }
}

#[cfg(not(target_arch = "wasm32"))]
impl egui::DroppedFile for Given {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|e| e.to_string())
    }
}

/// Files of the user's that are held for undo and redo.
const MOST_HELD: usize = 8;

/// A measurement that can be opened by its name: one that comes with the app, or that was open in this session.
#[derive(Clone)]
pub struct Held {
    /// Its name.
    pub name: String,
    /// What it is of.
    pub kind: Kind,
    /// What is in it.
    pub content: Content,
    /// What it does not say itself.
    pub reading: Reading,
}

impl From<&Enclosed> for Held {
    fn from(file: &Enclosed) -> Self {
        Self {
            name: file.id.to_owned(),
            kind: file.kind,
            content: file.content(),
            reading: Reading::default(),
        }
    }
}

/// Where files come in: those that are dropped, asked for, or given.
#[derive(Clone)]
pub struct Entrance {
    sender: Sender<Read>,
    /// Why none can be asked for.
    refused: Sender<Message>,
}

/// The way into a page for files, and what it has taken of them.
pub struct Door {
    /// Where they come in.
    pub entrance: Entrance,
    /// What the page does with a file that is held over the window.
    pub drop_hint: &'static str,
    /// How names of files end that it takes; `None`: it takes any.
    only: Option<&'static str>,
    opened: Receiver<Recent>,
}

impl Door {
    /// A door for files alone whose names end so.
    #[must_use]
    pub fn only(self, ending: &'static str) -> Self {
        Self {
            only: Some(ending),
            ..self
        }
    }

    /// Whether it takes a file of this name; `None` where one is asked for, whatever it is called.
    pub fn takes(&self, name: Option<&str>) -> bool {
        let fits = |ending: &str| name.is_some_and(|n| n.to_ascii_lowercase().ends_with(ending));
        self.only.is_none_or(fits)
    }

    /// Files that the page has taken since the last call.
    pub fn opened(&self) -> Vec<Recent> {
        self.opened.try_iter().collect()
    }
}

/// Files on their way.
pub struct Files {
    /// Where they come in.
    pub entrance: Entrance,
    receiver: Receiver<Read>,
    refused: Receiver<Message>,
    /// The last one that has arrived: nobody knows yet whether it is what its page takes.
    arrived: Option<Recent>,
    /// Where it is said which ones were taken.
    opened: Option<Sender<Recent>>,
    /// What was open, the last one first.
    held: Vec<Held>,
    /// Models that were open, by their names, the last one first.
    models: Vec<(String, UserModel)>,
}

impl Default for Files {
    fn default() -> Self {
        let ((sender, receiver), (refused, why)) = (channel(), channel());
        Self {
            entrance: Entrance { sender, refused },
            receiver,
            refused: why,
            arrived: None,
            opened: None,
            held: Vec::new(),
            models: Vec::new(),
        }
    }
}

impl Files {
    /// The way in; a file that is held over the window is met with this hint.
    pub fn door(&mut self, drop_hint: &'static str) -> Door {
        let (sender, opened) = channel();
        self.opened = Some(sender);
        Door {
            entrance: self.entrance.clone(),
            drop_hint,
            only: None,
            opened,
        }
    }

    /// The next file that has been read.
    pub fn arrived(&mut self) -> Option<Arrival> {
        let read = self.receiver.try_recv().ok()?;
        let bytes = read.bytes.as_ref().ok().zip(read.path.as_ref());
        self.arrived = bytes.map(|(b, path)| Recent::new(&read.name, path, b));
        Some(Arrival {
            name: read.name,
            bytes: read.bytes,
            reading: read.reading,
        })
    }

    /// Where the file of this name comes from, while it is not known yet whether it will be taken.
    pub fn origin(&mut self, name: &str) -> Option<Recent> {
        self.arrived.take_if(|r| r.name == name)
    }

    /// What is taken next comes from there.
    pub fn comes_from(&mut self, origin: Option<Recent>) {
        self.arrived = origin;
    }

    /// The file of this name was what its page takes: it may be opened again, and read in the same way.
    pub fn taken(&mut self, name: &str, reading: &Reading) {
        let taken = self.arrived.take_if(|r| r.name == name);
        if let (Some(taken), Some(opened)) = (taken, &self.opened) {
            // Where the app is gone there is nobody to tell.
            let _ = opened.send(taken.read_as(reading));
        }
    }

    /// Holds a file that is open, so that it can be gone back to.
    pub fn hold(&mut self, file: Held) {
        self.held.retain(|h| h.name != file.name);
        self.held.insert(0, file);
        self.held.truncate(MOST_HELD);
    }

    /// The file of this name that was open before in this session.
    pub fn held(&self, name: &str) -> Option<&Held> {
        self.held.iter().find(|h| h.name == name)
    }

    /// Holds a model that is open.
    pub fn hold_model(&mut self, name: &str, model: &UserModel) {
        self.models.retain(|(n, _)| n != name);
        self.models.insert(0, (name.to_owned(), model.clone()));
        self.models.truncate(MOST_HELD);
    }

    /// The model of this name that was open before in this session.
    pub fn held_model(&self, name: &str) -> Option<&UserModel> {
        self.models.iter().find(|(n, _)| n == name).map(|(_, m)| m)
    }

    /// Why no file could be asked for, once.
    pub fn refused(&mut self) -> Option<Message> {
        self.refused.try_recv().ok()
    }
}

impl Entrance {
    /// Takes the bytes of a file that lies nowhere.
    pub fn open(&self, name: &str, bytes: &[u8]) {
        // A page that is gone needs no file.
        let _ = self.sender.send(Read {
            name: name.to_owned(),
            path: None,
            bytes: Ok(bytes.to_vec()),
            reading: Reading::default(),
        });
    }

    /// Reads a file that was opened before.
    pub fn reopen(&self, ctx: &egui::Context, recent: &Recent) {
        let (sender, ctx, recent) = (self.sender.clone(), ctx.clone(), recent.clone());
        let read = move || {
            let bytes = recent.read();
            let Recent {
                name,
                path,
                reading,
                ..
            } = recent;
            // A page that is gone needs no file.
            let _ = sender.send(Read {
                name,
                path: Some(path),
                bytes,
                reading,
            });
            ctx.request_repaint();
        };
        #[cfg(not(target_arch = "wasm32"))]
        std::thread::spawn(read);
        #[cfg(target_arch = "wasm32")]
        read();
    }

    /// Reads a file that was dropped on the window.
    pub fn open_dropped(&self, ctx: &egui::Context, file: &egui::DroppedFileHandle) {
        let name = file
            .path()
            .file_name()
            .map_or_else(|| "file".into(), |n| n.to_string_lossy().into_owned());
        let path = file.path().to_string_lossy().into_owned();
        let (sender, ctx, file) = (self.sender.clone(), ctx.clone(), Arc::clone(file));
        #[cfg(not(target_arch = "wasm32"))]
        std::thread::spawn(move || {
            let bytes = file.bytes();
            let _ = sender.send(Read::new(name, path, bytes));
            ctx.request_repaint();
        });
        #[cfg(target_arch = "wasm32")]
        wasm_bindgen_futures::spawn_local(async move {
            let bytes = file.bytes_async().await;
            let _ = sender.send(Read::new(name, path, bytes));
            ctx.request_repaint();
        });
    }

    /// Asks for a file.
    pub fn open_dialog(&self, ctx: &egui::Context, filter: Filter) {
        let (sender, refused, ctx) = (self.sender.clone(), self.refused.clone(), ctx.clone());
        let dialog = rfd::AsyncFileDialog::new().add_filter(filter.words, filter.endings);
        let pick = async move {
            let asked = web_time::Instant::now();
            let picked = dialog.pick_file().await;
            // The dialog of a browser is always there.
            if picked.is_none() && !cfg!(target_arch = "wasm32") && asked.elapsed() < AT_ONCE {
                let _ = refused.send(NO_DIALOG.into());
                ctx.request_repaint();
            }
            if let Some(file) = picked {
                let bytes = Ok(file.read().await);
                #[cfg(not(target_arch = "wasm32"))]
                let path = file.path().to_string_lossy().into_owned();
                #[cfg(target_arch = "wasm32")]
                let path = String::new();
                let name = file.file_name();
                let _ = sender.send(Read::new(name, path, bytes));
                ctx.request_repaint();
            }
        };
        #[cfg(target_arch = "wasm32")]
        wasm_bindgen_futures::spawn_local(pick);
        #[cfg(not(target_arch = "wasm32"))]
        std::thread::spawn(move || pollster::block_on(pick));
    }
}
