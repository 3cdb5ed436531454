//! Hands a file to the user: a dialog natively, a download on the web.

#[cfg(not(target_arch = "wasm32"))]
use std::{
    io::{self, Write as _},
    path::{Path, PathBuf},
    time::Instant,
};

use std::sync::mpsc::Sender;
use std::time::Duration;

use hysteron_core::message::Message;
use hysteron_core::msg;

/// A dialog that ends within this time was never shown: nobody closes one so fast.
pub const AT_ONCE: Duration = Duration::from_millis(300);

/// Files of one name that are kept beside each other, at most.
#[cfg(not(target_arch = "wasm32"))]
const MOST_OF_A_NAME: usize = 1000;

/// A file to be saved.
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    /// Suggested name, with its ending.
    pub name: String,
    /// What kind of file it is, for the dialog.
    pub kind: &'static str,
    /// Its media type.
    pub media: &'static str,
    /// Its content.
    pub text: String,
}

/// A file that was given away: its name and its bytes.
pub type GivenFile = (String, Vec<u8>);

/// A file of any content.
struct File {
    name: String,
    #[cfg_attr(
        target_arch = "wasm32",
        expect(dead_code, reason = "a download has no dialog")
    )]
    kind: &'static str,
    #[cfg_attr(
        not(target_arch = "wasm32"),
        expect(dead_code, reason = "only a browser asks for it")
    )]
    media: &'static str,
    bytes: Vec<u8>,
}

/// Lets the user save `document`; a sentence says so or why not. Nothing is said where the user changes
/// their mind.
pub fn save(ctx: &egui::Context, document: Document, said: &Sender<Message>) {
    let file = File {
        name: document.name,
        kind: document.kind,
        media: document.media,
        bytes: document.text.into_bytes(),
    };
    save_file(ctx, file, said);
}

/// Lets the user save a picture of pixels, in the same way.
pub fn save_png(ctx: &egui::Context, name: &str, bytes: Vec<u8>, said: &Sender<Message>) {
    let file = File {
        name: format!("{name}.png"),
        kind: "Picture",
        media: "image/png",
        bytes,
    };
    save_file(ctx, file, said);
}

#[cfg(not(target_arch = "wasm32"))]
fn save_file(ctx: &egui::Context, document: File, said: &Sender<Message>) {
    let (ctx, said) = (ctx.clone(), said.clone());
    let ending = document
        .name
        .rsplit_once('.')
        .map_or_else(String::new, |(_, e)| e.to_owned());
    let dialog = rfd::AsyncFileDialog::new()
        .add_filter(document.kind, &[ending])
        .set_file_name(&document.name);
    std::thread::spawn(move || {
        pollster::block_on(async {
            let asked = Instant::now();
            let text = match dialog.save_file().await {
                Some(file) => {
                    let name = file.file_name();
                    match file.write(&document.bytes).await {
                        Ok(()) => msg!("Saved as {}.", Message::name(name)),
                        Err(error) => {
                            let cause = Message::name(error.to_string());
                            msg!("{} cannot be written: {}", Message::name(name), cause)
                        }
                    }
                }
                None if asked.elapsed() < AT_ONCE => unasked(&document),
                None => return,
            };
            // Where the page is gone there is nobody to tell.
            let _ = said.send(text);
            ctx.request_repaint();
        });
    });
}

/// Saves a file where no dialog can be shown; a sentence says where, or why not.
#[cfg(not(target_arch = "wasm32"))]
fn unasked(document: &File) -> Message {
    let home = std::env::home_dir().map(|home| home.join("Downloads"));
    let folder = home.filter(|folder| folder.is_dir());
    let folder = folder.or_else(|| std::env::current_dir().ok());
    match keep(&folder.unwrap_or_default(), &document.name, &document.bytes) {
        Ok(path) => msg!(
            "No dialog can be shown here: saved as {}.",
            Message::name(path.display().to_string())
        ),
        Err(error) => msg!(
            "No dialog can be shown here, and {} cannot be written: {}",
            Message::name(&document.name),
            Message::name(error.to_string())
        ),
    }
}

/// Writes a file under this name, or with a number behind it where there is one already.
#[cfg(not(target_arch = "wasm32"))]
fn keep(folder: &Path, name: &str, bytes: &[u8]) -> io::Result<PathBuf> {
    let (stem, ending) = name.rsplit_once('.').unwrap_or((name, ""));
    let numbered = (2..MOST_OF_A_NAME).map(|n| format!("{stem}-{n}.{ending}"));
    for name in std::iter::once(name.to_owned()).chain(numbered) {
        let path = folder.join(name);
        match std::fs::File::create_new(&path) {
            Ok(mut file) => return file.write_all(bytes).map(|()| path),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

#[cfg(target_arch = "wasm32")]
fn save_file(ctx: &egui::Context, document: File, said: &Sender<Message>) {
    let name = document.name.clone();
    let text = match download(&document) {
        Ok(()) => msg!("{} is downloaded.", Message::name(name)),
        Err(_) => msg!("The browser refuses to save {}.", Message::name(name)),
    };
    let _ = said.send(text);
    ctx.request_repaint();
}

#[cfg(target_arch = "wasm32")]
fn download(document: &File) -> Result<(), wasm_bindgen::JsValue> {
    use wasm_bindgen::JsCast as _;
    let page = web_sys::window()
        .and_then(|w| w.document())
        .ok_or(wasm_bindgen::JsValue::NULL)?;
    let bytes = js_sys::Uint8Array::from(document.bytes.as_slice());
    let parts = js_sys::Array::of1(&bytes);
    let kind = web_sys::BlobPropertyBag::new();
    kind.set_type(document.media);
    let blob = web_sys::Blob::new_with_u8_array_sequence_and_options(&parts, &kind)?;
    let address = web_sys::Url::create_object_url_with_blob(&blob)?;
    let link = page
        .create_element("a")?
        .dyn_into::<web_sys::HtmlAnchorElement>()?;
    link.set_href(&address);
    link.set_download(&document.name);
    link.click();
    web_sys::Url::revoke_object_url(&address)
}

#[cfg(test)]
mod tests {
    use super::keep;

    #[test]
    fn a_file_that_is_there_stays_as_it_is() {
        let folder = std::env::temp_dir().join(format!("hysteron-keep-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let names = ["first", "second"].map(|text| {
            let path = keep(&folder, "loop.csv", text.as_bytes()).unwrap();
            assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
            path.file_name().unwrap().to_owned()
        });
        assert_eq!(names, ["loop.csv", "loop-2.csv"]);
        assert!(keep(&folder.join("nowhere"), "loop.csv", b"").is_err());
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
