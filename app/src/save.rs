//! Hands a file to the user: a dialog natively, a download on the web.

use std::sync::mpsc::Sender;

/// A file to be saved.
pub struct Document {
    /// Suggested name, with its ending.
    pub name: String,
    /// What kind of file it is, for the dialog.
    #[cfg_attr(
        target_arch = "wasm32",
        expect(dead_code, reason = "a download has no dialog")
    )]
    pub kind: &'static str,
    /// Its media type.
    #[cfg_attr(
        not(target_arch = "wasm32"),
        expect(dead_code, reason = "only a browser asks for it")
    )]
    pub media: &'static str,
    /// Its content.
    pub text: String,
}

/// Lets the user save `document`; a sentence says so or why not. Nothing is said where the user changes
/// their mind.
#[cfg(not(target_arch = "wasm32"))]
pub fn save(ctx: &egui::Context, document: Document, said: &Sender<String>) {
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
            let text = match file.write(document.text.as_bytes()).await {
                Ok(()) => format!("Saved as {name}."),
                Err(error) => format!("{name} cannot be written: {error}"),
            };
            // Where the page is gone there is nobody to tell.
            let _ = said.send(text);
            ctx.request_repaint();
        });
    });
}

/// Lets the browser download `document`.
#[cfg(target_arch = "wasm32")]
pub fn save(ctx: &egui::Context, document: Document, said: &Sender<String>) {
    let name = document.name.clone();
    let text = match download(&document) {
        Ok(()) => format!("{name} is downloaded."),
        Err(_) => format!("The browser refuses to save {name}."),
    };
    let _ = said.send(text);
    ctx.request_repaint();
}

#[cfg(target_arch = "wasm32")]
fn download(document: &Document) -> Result<(), wasm_bindgen::JsValue> {
    use wasm_bindgen::JsCast as _;
    let page = web_sys::window()
        .and_then(|w| w.document())
        .ok_or(wasm_bindgen::JsValue::NULL)?;
    let parts = js_sys::Array::of1(&document.text.as_str().into());
    let kind = web_sys::BlobPropertyBag::new();
    kind.set_type(document.media);
    let blob = web_sys::Blob::new_with_str_sequence_and_options(&parts, &kind)?;
    let address = web_sys::Url::create_object_url_with_blob(&blob)?;
    let link = page
        .create_element("a")?
        .dyn_into::<web_sys::HtmlAnchorElement>()?;
    link.set_href(&address);
    link.set_download(&document.name);
    link.click();
    web_sys::Url::revoke_object_url(&address)
}
