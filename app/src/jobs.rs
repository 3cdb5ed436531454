//! Runs tasks off the thread that draws: on a thread natively, in a worker on the web.

use std::sync::Arc;

use hysteron_core::effect::EffectId;
use hysteron_core::measurement::Measurement;
use hysteron_core::user_model::UserModel;

pub use crate::tasks::News;
use crate::tasks::{StepTask, Task};

/// A running task; dropping it cancels it.
pub struct Job<T: Task = StepTask>(platform::Job<T::Report>);

impl<T: platform::Runs> Job<T> {
    /// Runs a task; the window is redrawn whenever it says something.
    pub fn run(ctx: &egui::Context, task: T) -> Self {
        Self(platform::start(ctx.clone(), task))
    }

    /// What has happened since the last call.
    pub fn news(&mut self) -> Vec<News<T::Report>> {
        self.0.news()
    }
}

impl Job {
    /// Criticises the baseline, or the user's `model`, with `effects` on `measurement`.
    pub fn start(
        ctx: &egui::Context,
        measurement: &Arc<Measurement>,
        effects: &[EffectId],
        model: Option<&UserModel>,
    ) -> Self {
        Self::run(
            ctx,
            StepTask {
                measurement: Box::new((**measurement).clone()),
                effects: effects.to_vec(),
                model: model.cloned(),
            },
        )
    }
}

#[cfg(not(target_arch = "wasm32"))]
mod platform {
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::sync::mpsc::{Receiver, channel};

    use crate::tasks::News;
    pub use crate::work::Work as Runs;

    pub struct Job<R> {
        news: Receiver<News<R>>,
        cancelled: Arc<AtomicBool>,
    }

    pub fn start<T: Runs>(ctx: egui::Context, task: T) -> Job<T::Report> {
        let (sender, news) = channel();
        let cancelled = Arc::new(AtomicBool::new(false));
        let stop = Arc::clone(&cancelled);
        std::thread::spawn(move || {
            task.run(&mut |news| {
                let heard = sender.send(news).is_ok();
                ctx.request_repaint();
                heard && !stop.load(Ordering::Relaxed)
            });
        });
        Job { news, cancelled }
    }

    impl<R> Job<R> {
        pub fn news(&mut self) -> Vec<News<R>> {
            self.news.try_iter().collect()
        }
    }

    impl<R> Drop for Job<R> {
        fn drop(&mut self) {
            self.cancelled.store(true, Ordering::Relaxed);
        }
    }
}

#[cfg(target_arch = "wasm32")]
mod platform {
    use std::cell::RefCell;
    use std::rc::Rc;

    use wasm_bindgen::prelude::*;
    use web_sys::{ErrorEvent, MessageEvent, Worker, WorkerOptions, WorkerType};

    use crate::tasks::News;
    pub use crate::tasks::Task as Runs;

    pub struct Job<R> {
        worker: Option<Worker>,
        news: Rc<RefCell<Vec<News<R>>>>,
        _handlers: Option<(
            Closure<dyn FnMut(MessageEvent)>,
            Closure<dyn FnMut(ErrorEvent)>,
        )>,
    }

    pub fn start<T: Runs>(ctx: egui::Context, task: T) -> Job<T::Report> {
        let news = Rc::new(RefCell::new(Vec::new()));
        let options = WorkerOptions::new();
        options.set_type(WorkerType::Module);
        let Ok(worker) = Worker::new_with_options("./worker.js", &options) else {
            news.borrow_mut().push(News::Failed(
                "the browser refuses to start a worker".to_owned(),
            ));
            return Job {
                worker: None,
                news,
                _handlers: None,
            };
        };
        let (inbox, outbox, repaint) = (Rc::clone(&news), worker.clone(), ctx.clone());
        let on_message = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
            let Some(text) = event.data().as_string() else {
                return;
            };
            if text == crate::tasks::READY {
                if let Ok(text) = serde_json::to_string(&(T::NAME, &task)) {
                    // The worker is there: it has just spoken.
                    let _ = outbox.post_message(&JsValue::from_str(&text));
                }
                return;
            }
            let said =
                serde_json::from_str(&text).unwrap_or_else(|error| News::Failed(error.to_string()));
            inbox.borrow_mut().push(said);
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
        Job {
            worker: Some(worker),
            news,
            _handlers: Some((on_message, on_error)),
        }
    }

    impl<R> Job<R> {
        pub fn news(&mut self) -> Vec<News<R>> {
            std::mem::take(&mut *self.news.borrow_mut())
        }
    }

    impl<R> Drop for Job<R> {
        fn drop(&mut self) {
            if let Some(worker) = &self.worker {
                worker.terminate();
            }
        }
    }
}
