//! Measurements: those that come with the app, and those that a user opens.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// A drifting test that comes with the app.
pub struct BuiltIn {
    pub id: &'static str,
    pub story: &'static str,
    deflated: &'static [u8],
}

pub const BUILT_IN: [BuiltIn; 2] = [
    BuiltIn {
        id: "drive-03",
        story: "A drifting test on a rig with dry friction. The load was measured as well, for comparison.",
        deflated: include_bytes!(concat!(env!("OUT_DIR"), "/drive-03.deflate")),
    },
    BuiltIn {
        id: "drive-10",
        story: "The same on a rig without dry friction and with half of the gap.",
        deflated: include_bytes!(concat!(env!("OUT_DIR"), "/drive-10.deflate")),
    },
];

impl BuiltIn {
    /// Its text.
    pub fn csv(&self) -> Vec<u8> {
        miniz_oxide::inflate::decompress_to_vec(self.deflated).unwrap_or_default()
    }
}

/// A file that is being read elsewhere: its name, and its bytes or why there are none.
type Arrival = (String, Result<Vec<u8>, String>);

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
    pub fn open_dialog(&self, ctx: &egui::Context) {
        let (sender, ctx) = (self.0.clone(), ctx.clone());
        let dialog = rfd::AsyncFileDialog::new().add_filter("Measurement", &["csv", "txt", "tsv"]);
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
