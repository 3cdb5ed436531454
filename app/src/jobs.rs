//! Long computations off the thread that draws: a thread natively, a worker on the web.

use std::sync::Arc;

use hysteron_core::criticism::StepReport;
use hysteron_core::effect::EffectId;
use hysteron_core::measurement::Measurement;

/// What a job says while it runs.
#[derive(Debug)]
pub enum News {
    /// Share done and what it is doing.
    Progress(f64, String),
    /// The result.
    Report(Box<StepReport>),
    /// Why there is none.
    Failed(String),
}

/// A running step; dropping it cancels it.
pub struct Job(platform::Job);

impl Job {
    /// Criticises the baseline with `effects` on `measurement`.
    pub fn start(
        ctx: &egui::Context,
        measurement: &Arc<Measurement>,
        effects: &[EffectId],
    ) -> Self {
        Self(platform::Job::start(
            ctx.clone(),
            Arc::clone(measurement),
            effects.to_vec(),
        ))
    }

    /// What has happened since the last call.
    pub fn news(&mut self) -> Vec<News> {
        self.0.news()
    }
}

#[cfg(not(target_arch = "wasm32"))]
mod platform {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::sync::mpsc::{Receiver, channel};

    use hysteron_core::criticism::{Progress, StepJob};
    use hysteron_core::effect::EffectId;
    use hysteron_core::measurement::Measurement;

    use super::News;

    pub struct Job {
        news: Receiver<News>,
        cancelled: Arc<AtomicBool>,
    }

    impl Job {
        pub fn start(
            ctx: egui::Context,
            measurement: Arc<Measurement>,
            effects: Vec<EffectId>,
        ) -> Self {
            let (sender, news) = channel();
            let cancelled = Arc::new(AtomicBool::new(false));
            let stop = Arc::clone(&cancelled);
            std::thread::spawn(move || {
                let mut job = match StepJob::new(&measurement, &effects) {
                    Ok(job) => job,
                    Err(error) => {
                        let _ = sender.send(News::Failed(error.to_string()));
                        return ctx.request_repaint();
                    }
                };
                while !stop.load(Ordering::Relaxed) {
                    let (news, done) = match job.advance() {
                        Progress::Running { fraction, text } => {
                            (News::Progress(fraction, text), false)
                        }
                        Progress::Done(report) => (News::Report(Box::new(report)), true),
                    };
                    if sender.send(news).is_err() {
                        return;
                    }
                    ctx.request_repaint();
                    if done {
                        return;
                    }
                }
            });
            Self { news, cancelled }
        }

        pub fn news(&mut self) -> Vec<News> {
            self.news.try_iter().collect()
        }
    }

    impl Drop for Job {
        fn drop(&mut self) {
            self.cancelled.store(true, Ordering::Relaxed);
        }
    }
}

#[cfg(target_arch = "wasm32")]
mod platform {
    use std::cell::RefCell;
    use std::rc::Rc;
    use std::sync::Arc;

    use hysteron_core::effect::EffectId;
    use hysteron_core::measurement::Measurement;
    use wasm_bindgen::prelude::*;
    use web_sys::{ErrorEvent, MessageEvent, Worker, WorkerOptions, WorkerType};

    use super::News;
    use crate::worker_protocol::{Reply, Request};

    pub struct Job {
        worker: Option<Worker>,
        news: Rc<RefCell<Vec<News>>>,
        _handlers: Option<(
            Closure<dyn FnMut(MessageEvent)>,
            Closure<dyn FnMut(ErrorEvent)>,
        )>,
    }

    impl Job {
        pub fn start(
            ctx: egui::Context,
            measurement: Arc<Measurement>,
            effects: Vec<EffectId>,
        ) -> Self {
            let news = Rc::new(RefCell::new(Vec::new()));
            let options = WorkerOptions::new();
            options.set_type(WorkerType::Module);
            let Ok(worker) = Worker::new_with_options("./worker.js", &options) else {
                news.borrow_mut().push(News::Failed(
                    "the browser refuses to start a worker".to_owned(),
                ));
                return Self {
                    worker: None,
                    news,
                    _handlers: None,
                };
            };
            let request = Request::Step {
                measurement: Box::new((*measurement).clone()),
                effects,
            };
            let (inbox, outbox, repaint) = (Rc::clone(&news), worker.clone(), ctx.clone());
            let on_message = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
                let Some(text) = event.data().as_string() else {
                    return;
                };
                match serde_json::from_str(&text) {
                    Ok(Reply::Ready) => {
                        if let Ok(text) = serde_json::to_string(&request) {
                            // The worker is there: it has just spoken.
                            let _ = outbox.post_message(&JsValue::from_str(&text));
                        }
                    }
                    Ok(Reply::Progress { fraction, text }) => {
                        inbox.borrow_mut().push(News::Progress(fraction, text))
                    }
                    Ok(Reply::Report { report }) => inbox.borrow_mut().push(News::Report(report)),
                    Ok(Reply::Error { text }) => inbox.borrow_mut().push(News::Failed(text)),
                    Err(error) => inbox.borrow_mut().push(News::Failed(error.to_string())),
                }
                repaint.request_repaint();
            });
            let (inbox, repaint) = (Rc::clone(&news), ctx);
            let on_error = Closure::<dyn FnMut(ErrorEvent)>::new(move |event: ErrorEvent| {
                inbox.borrow_mut().push(News::Failed(format!(
                    "the worker stopped: {}",
                    event.message()
                )));
                repaint.request_repaint();
            });
            worker.set_onmessage(Some(on_message.as_ref().unchecked_ref()));
            worker.set_onerror(Some(on_error.as_ref().unchecked_ref()));
            Self {
                worker: Some(worker),
                news,
                _handlers: Some((on_message, on_error)),
            }
        }

        pub fn news(&mut self) -> Vec<News> {
            std::mem::take(&mut *self.news.borrow_mut())
        }
    }

    impl Drop for Job {
        fn drop(&mut self) {
            if let Some(worker) = &self.worker {
                worker.terminate();
            }
        }
    }
}
