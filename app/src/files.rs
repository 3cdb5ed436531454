//! Files that a user opens: by a dialog or by dropping them on the window, natively and on the web.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// A file that is being read elsewhere: its name, and its bytes or why there are none.
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

/// Files on their way.
pub struct Files(Sender<Arrival>, Receiver<Arrival>);

impl Default for Files {
    fn default() -> Self {
        let (sender, receiver) = channel();
        Self(sender, receiver)
    }
}

impl Files {
    /// The next file that has been read.
    pub fn arrived(&self) -> Option<Arrival> {
        self.1.try_recv().ok()
    }

    /// Reads a file that was dropped on the window.
    pub fn open_dropped(&self, ctx: &egui::Context, file: &egui::DroppedFileHandle) {
        let name = file
            .path()
            .file_name()
            .map_or_else(|| "file".into(), |n| n.to_string_lossy().into_owned());
        let (sender, ctx, file) = (self.0.clone(), ctx.clone(), Arc::clone(file));
        #[cfg(not(target_arch = "wasm32"))]
        std::thread::spawn(move || {
            // A page that is gone needs no file.
            let _ = sender.send((name, file.bytes()));
            ctx.request_repaint();
        });
        #[cfg(target_arch = "wasm32")]
        wasm_bindgen_futures::spawn_local(async move {
            let bytes = file.bytes_async().await;
            let _ = sender.send((name, bytes));
            ctx.request_repaint();
        });
    }

    /// Asks for a file.
    pub fn open_dialog(&self, ctx: &egui::Context, filter: Filter) {
        let (sender, ctx) = (self.0.clone(), ctx.clone());
        let dialog = rfd::AsyncFileDialog::new().add_filter(filter.words, filter.endings);
        let pick = async move {
            if let Some(file) = dialog.pick_file().await {
                let bytes = file.read().await;
                let _ = sender.send((file.file_name(), Ok(bytes)));
                ctx.request_repaint();
            }
        };
        #[cfg(target_arch = "wasm32")]
        wasm_bindgen_futures::spawn_local(pick);
        #[cfg(not(target_arch = "wasm32"))]
        std::thread::spawn(move || pollster::block_on(pick));
    }
}
