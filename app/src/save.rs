//! Hands a file to the user: a dialog natively, a download on the web.

use std::sync::mpsc::Sender;

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
pub fn save(ctx: &egui::Context, document: Document, said: &Sender<String>) {
    let file = File {
        name: document.name,
        kind: document.kind,
        media: document.media,
        bytes: document.text.into_bytes(),
    };
    save_file(ctx, file, said);
}

/// Lets the user save a picture of pixels, in the same way.
pub fn save_png(ctx: &egui::Context, name: &str, bytes: Vec<u8>, said: &Sender<String>) {
    let file = File {
        name: format!("{name}.png"),
        kind: "Picture",
        media: "image/png",
        bytes,
    };
    save_file(ctx, file, said);
}

#[cfg(not(target_arch = "wasm32"))]
fn save_file(ctx: &egui::Context, document: File, said: &Sender<String>) {
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
            let Some(file) = dialog.save_file().await else {
                return;
            };
            let name = file.file_name();
            let text = match file.write(&document.bytes).await {
                Ok(()) => format!("Saved as {name}."),
                Err(error) => format!("{name} cannot be written: {error}"),
            };
            // Where the page is gone there is nobody to tell.
            let _ = said.send(text);
            ctx.request_repaint();
        });
    });
}

#[cfg(target_arch = "wasm32")]
fn save_file(ctx: &egui::Context, document: File, said: &Sender<String>) {
    let name = document.name.clone();
    let text = match download(&document) {
        Ok(()) => format!("{name} is downloaded."),
        Err(_) => format!("The browser refuses to save {name}."),
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
