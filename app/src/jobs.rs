//! Runs tasks off the thread that draws: on a thread natively, in a worker on the web.

use std::sync::Arc;

use hysteron_core::effect::EffectId;
use hysteron_core::measurement::Measurement;
use hysteron_core::message::Message;
use hysteron_core::user_model::UserModel;

pub use hysteron_work::tasks::News;
use hysteron_work::tasks::{StepTask, Task};
pub use platform::Runs;

/// A running task; dropping it cancels it.
pub struct Job<T: Task = StepTask>(platform::Job<T::Report>);

impl<T: Runs> Job<T> {
    /// Runs a task; the window is redrawn whenever it says something.
    pub fn run(ctx: &egui::Context, task: T) -> Self {
        Self(platform::start(ctx.clone(), task))
    }

    /// What has happened since the last call.
    pub fn news(&mut self) -> Vec<News<T::Report>> {
        self.0.news()
    }

    /// What it has come to, once it has ended. Until then `progress` is told the share that is done, and what it is
    /// doing.
    pub fn end(
        &mut self,
        mut progress: impl FnMut(f64, Message),
    ) -> Option<Result<T::Report, Message>> {
        self.news().into_iter().find_map(|news| match news {
            News::Progress(share, text) => {
                progress(share, text);
                None
            }
            News::Report(report) => Some(Ok(*report)),
            News::Failed(text) => Some(Err(text)),
        })
    }
}

/// [`Job::end`] of the job in a place, which is free then.
pub fn ended<T: Runs>(
    place: &mut Option<Job<T>>,
    progress: impl FnMut(f64, Message),
) -> Option<Result<T::Report, Message>> {
    let end = place.as_mut()?.end(progress)?;
    *place = None;
    Some(end)
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

    use hysteron_work::tasks::News;
    pub use hysteron_work::work::Work as Runs;

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
    use std::cell::{Cell, RefCell};
    use std::rc::Rc;

    use hysteron_core::message::Message;
    use hysteron_core::msg;
    use js_sys::{Array, Uint8Array};
    use wasm_bindgen::prelude::*;
    use web_sys::{ErrorEvent, MessageEvent, Worker, WorkerOptions, WorkerType};

    pub use hysteron_work::tasks::Task as Runs;
    use hysteron_work::tasks::{News, READY};
    use hysteron_work::wire::{pack, unpack};

    thread_local! {
        /// A worker that has finished its task: the next one need not wait for another to start.
        static IDLE: Cell<Option<Worker>> = const { Cell::new(None) };
    }

    /// What is called with what a worker says, and where it fails.
    type Handlers = (
        Closure<dyn FnMut(MessageEvent)>,
        Closure<dyn FnMut(ErrorEvent)>,
    );

    pub struct Job<R> {
        worker: Option<Worker>,
        news: Rc<RefCell<Vec<News<R>>>>,
        finished: Rc<Cell<bool>>,
        _handlers: Option<Handlers>,
    }

    pub fn start<T: Runs>(ctx: egui::Context, task: T) -> Job<T::Report> {
        let news = Rc::new(RefCell::new(Vec::new()));
        let finished = Rc::new(Cell::new(false));
        let idle = IDLE.take();
        let (found, worker) = (idle.is_some(), idle.map_or_else(start_worker, Some));
        let Some(worker) = worker else {
            news.borrow_mut()
                .push(News::Failed("the browser refuses to start a worker".into()));
            return Job {
                worker,
                news,
                finished,
                _handlers: None,
            };
        };
        let (inbox, outbox, repaint) = (Rc::clone(&news), worker.clone(), ctx.clone());
        let (done, mut waiting) = (Rc::clone(&finished), Some(task));
        if found && let Some(task) = waiting.take() {
            give(&worker, &task, &news);
        }
        let on_message = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
            let data = event.data();
            if data == READY {
                // For the task, or for another after it.
                match waiting.take() {
                    Some(task) => give(&outbox, &task, &inbox),
                    None => done.set(true),
                }
            } else {
                let said = unpack(&Uint8Array::new(&data).to_vec());
                inbox
                    .borrow_mut()
                    .push(said.unwrap_or_else(|error| News::Failed(Message::name(error))));
            }
            repaint.request_repaint();
        });
        let (inbox, repaint) = (Rc::clone(&news), ctx);
        let on_error = Closure::<dyn FnMut(ErrorEvent)>::new(move |event: ErrorEvent| {
            inbox.borrow_mut().push(News::Failed(msg!(
                "the worker stopped: {}",
                Message::name(event.message())
            )));
            repaint.request_repaint();
        });
        worker.set_onmessage(Some(on_message.as_ref().unchecked_ref()));
        worker.set_onerror(Some(on_error.as_ref().unchecked_ref()));
        Job {
            worker: Some(worker),
            news,
            finished,
            _handlers: Some((on_message, on_error)),
        }
    }

    /// Starts a worker on the page's own module: nothing more is loaded or compiled.
    fn start_worker() -> Option<Worker> {
        let options = WorkerOptions::new();
        options.set_type(WorkerType::Module);
        let worker = Worker::new_with_options("./worker.js", &options).ok()?;
        worker.post_message(&wasm_bindgen::module()).ok()?;
        Some(worker)
    }

    /// Hands a task to a worker that listens.
    fn give<T: Runs>(worker: &Worker, task: &T, news: &RefCell<Vec<News<T::Report>>>) {
        match pack(task) {
            Ok(bytes) => {
                let bytes = Uint8Array::from(bytes.as_slice());
                let message = Array::of2(&JsValue::from_str(T::NAME), &bytes);
                let moved = Array::of1(&bytes.buffer());
                // It is there: it has spoken.
                let _ = worker.post_message_with_transfer(&message, &moved);
            }
            Err(error) => news.borrow_mut().push(News::Failed(Message::name(error))),
        }
    }

    impl<R> Job<R> {
        pub fn news(&mut self) -> Vec<News<R>> {
            std::mem::take(&mut *self.news.borrow_mut())
        }
    }

    impl<R> Drop for Job<R> {
        fn drop(&mut self) {
            let Some(worker) = self.worker.take() else {
                return;
            };
            worker.set_onmessage(None);
            worker.set_onerror(None);
            // One is kept; another, or one that still works, is not.
            let surplus = if self.finished.get() {
                IDLE.replace(Some(worker))
            } else {
                Some(worker)
            };
            if let Some(worker) = surplus {
                worker.terminate();
            }
        }
    }
}
