//! The page's worker: it computes off the page's main thread. It uses the core and no interface, so
//! that its module stays small.

#[cfg(target_arch = "wasm32")]
#[path = "../worker_protocol.rs"]
mod protocol;

#[cfg(not(target_arch = "wasm32"))]
fn main() {
    println!("This is the worker of the web page; the app is `hysteron`.");
}

#[cfg(target_arch = "wasm32")]
fn main() {
    web::listen();
}

#[cfg(target_arch = "wasm32")]
mod web {
    use hysteron_core::criticism::{Progress, StepJob};
    use wasm_bindgen::prelude::*;
    use web_sys::{DedicatedWorkerGlobalScope, MessageEvent};

    use crate::protocol::{Reply, Request};

    /// Share of progress below which nothing new is said.
    const PROGRESS_STEP: f64 = 0.01;

    pub fn listen() {
        let scope: DedicatedWorkerGlobalScope = js_sys::global().unchecked_into();
        let answer = scope.clone();
        let handler = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
            let Some(text) = event.data().as_string() else {
                return;
            };
            let reply = match serde_json::from_str(&text) {
                Ok(request) => work(&answer, request),
                Err(error) => Reply::Error {
                    text: error.to_string(),
                },
            };
            send(&answer, &reply);
        });
        scope.set_onmessage(Some(handler.as_ref().unchecked_ref()));
        handler.forget();
        send(&scope, &Reply::Ready);
    }

    fn send(scope: &DedicatedWorkerGlobalScope, reply: &Reply) {
        if let Ok(text) = serde_json::to_string(reply) {
            // A page that is gone needs no answer.
            let _ = scope.post_message(&JsValue::from_str(&text));
        }
    }

    fn work(scope: &DedicatedWorkerGlobalScope, request: Request) -> Reply {
        let Request::Step {
            measurement,
            effects,
        } = request;
        let mut job = match StepJob::new(&measurement, &effects) {
            Ok(job) => job,
            Err(error) => {
                return Reply::Error {
                    text: error.to_string(),
                };
            }
        };
        let mut said = -1.0;
        loop {
            match job.advance() {
                Progress::Done(report) => {
                    return Reply::Report {
                        report: Box::new(report),
                    };
                }
                Progress::Running { fraction, text } => {
                    if (fraction - said).abs() > PROGRESS_STEP {
                        said = fraction;
                        send(scope, &Reply::Progress { fraction, text });
                    }
                }
            }
        }
    }
}
