//! Files that a user opens: by a dialog, by dropping them on the window, or once more, natively and on the web.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

use crate::recent::Recent;

/// A file that has been read: its name, and its bytes or why there are none.
pub type Arrival = (String, Result<Vec<u8>, String>);

/// What a dialog asks for: in words, and by the endings of names.
#[derive(Clone, Copy, Debug)]
pub struct Filter {
    words: &'static str,
    endings: &'static [&'static str],
}

/// A measurement.
pub const MEASUREMENT: Filter = Filter {
    words: "Measurement",
    endings: &["csv", "txt", "tsv"],
};

/// What the user knows of a model.
pub const MODEL: Filter = Filter {
    words: "Model",
    endings: &["toml"],
};

/// Why no page takes a file of MATLAB: it has neither units nor a mapping of its columns.
pub fn refused(name: &str, bytes: &[u8]) -> Option<String> {
    let matlab = name.to_ascii_lowercase().ends_with(".mat") || bytes.starts_with(b"MATLAB ");
    matlab.then(|| {
        format!(
            "{name} is a file of MATLAB, which does not say what its columns are. Say it on the command line: \
             hysteron diagnose {name} --map ...; or save the file as CSV."
        )
    })
}

/// A file that is being read elsewhere, and how to find it again.
struct Read {
    name: String,
    path: String,
    bytes: Result<Vec<u8>, String>,
}

/// Files on their way.
pub struct Files {
    sender: Sender<Read>,
    receiver: Receiver<Read>,
    /// The last one that has arrived: nobody knows yet whether it is what its page takes.
    arrived: Option<Recent>,
    opened: Vec<Recent>,
}

impl Default for Files {
    fn default() -> Self {
        let (sender, receiver) = channel();
        Self {
            sender,
            receiver,
            arrived: None,
            opened: Vec::new(),
        }
    }
}

impl Files {
    /// The next file that has been read.
    pub fn arrived(&mut self) -> Option<Arrival> {
        let read = self.receiver.try_recv().ok()?;
        let bytes = read.bytes.as_ref().ok();
        self.arrived = bytes.map(|b| Recent::new(&read.name, &read.path, b));
        Some((read.name, read.bytes))
    }

    /// The file of this name was what its page takes: it may be opened again.
    pub fn taken(&mut self, name: &str) {
        self.opened.extend(self.arrived.take_if(|r| r.name == name));
    }

    /// What has been opened since it was last asked for.
    pub fn opened(&mut self) -> Vec<Recent> {
        std::mem::take(&mut self.opened)
    }

    /// Reads a file that was opened before.
    pub fn reopen(&self, ctx: &egui::Context, recent: &Recent) {
        let (sender, ctx, recent) = (self.sender.clone(), ctx.clone(), recent.clone());
        let read = move || {
            let bytes = recent.read();
            let Recent { name, path, .. } = recent;
            // A page that is gone needs no file.
            let _ = sender.send(Read { name, path, bytes });
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
            let _ = sender.send(Read { name, path, bytes });
            ctx.request_repaint();
        });
        #[cfg(target_arch = "wasm32")]
        wasm_bindgen_futures::spawn_local(async move {
            let bytes = file.bytes_async().await;
            let _ = sender.send(Read { name, path, bytes });
            ctx.request_repaint();
        });
    }

    /// Asks for a file.
    pub fn open_dialog(&self, ctx: &egui::Context, filter: Filter) {
        let (sender, ctx) = (self.sender.clone(), ctx.clone());
        let dialog = rfd::AsyncFileDialog::new().add_filter(filter.words, filter.endings);
        let pick = async move {
            if let Some(file) = dialog.pick_file().await {
                let bytes = Ok(file.read().await);
                #[cfg(not(target_arch = "wasm32"))]
                let path = file.path().to_string_lossy().into_owned();
                #[cfg(target_arch = "wasm32")]
                let path = String::new();
                let name = file.file_name();
                let _ = sender.send(Read { name, path, bytes });
                ctx.request_repaint();
            }
        };
        #[cfg(target_arch = "wasm32")]
        wasm_bindgen_futures::spawn_local(pick);
        #[cfg(not(target_arch = "wasm32"))]
        std::thread::spawn(move || pollster::block_on(pick));
    }
}
