//! The page's worker: it computes off the page's main thread. It uses the core and no interface, so
//! that its module stays small.

#[cfg(target_arch = "wasm32")]
#[path = "../tasks.rs"]
mod tasks;

#[cfg(target_arch = "wasm32")]
#[path = "../work.rs"]
mod work;

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
    use wasm_bindgen::prelude::*;
    use web_sys::{DedicatedWorkerGlobalScope, MessageEvent};

    use crate::tasks::{
        ExperimentTask, GapTask, MapTask, MysteryTask, News, READY, RevealTask, StepTask,
        Task as _, TuneTask,
    };
    use crate::work::Work;

    /// Share of progress below which nothing new is said.
    const PROGRESS_STEP: f64 = 0.01;

    pub fn listen() {
        let scope: DedicatedWorkerGlobalScope = js_sys::global().unchecked_into();
        let answer = scope.clone();
        let handler = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
            let Some(text) = event.data().as_string() else {
                return;
            };
            if let Err(error) = work(&answer, &text) {
                send(&answer, &News::<()>::Failed(error.to_string()));
            }
        });
        scope.set_onmessage(Some(handler.as_ref().unchecked_ref()));
        handler.forget();
        let _ = scope.post_message(&JsValue::from_str(READY));
    }

    fn send<R: serde::Serialize>(scope: &DedicatedWorkerGlobalScope, news: &News<R>) {
        if let Ok(text) = serde_json::to_string(news) {
            // A page that is gone needs no answer.
            let _ = scope.post_message(&JsValue::from_str(&text));
        }
    }

    /// A message is the task's name and the task; one line for each kind of task.
    fn work(scope: &DedicatedWorkerGlobalScope, text: &str) -> Result<(), serde_json::Error> {
        let (name, task): (String, serde_json::Value) = serde_json::from_str(text)?;
        match name.as_str() {
            StepTask::NAME => run::<StepTask>(scope, task),
            ExperimentTask::NAME => run::<ExperimentTask>(scope, task),
            MapTask::NAME => run::<MapTask>(scope, task),
            GapTask::NAME => run::<GapTask>(scope, task),
            MysteryTask::NAME => run::<MysteryTask>(scope, task),
            RevealTask::NAME => run::<RevealTask>(scope, task),
            TuneTask::NAME => run::<TuneTask>(scope, task),
            _ => Err(serde::de::Error::custom(format!(
                "no task is called {name}"
            ))),
        }
    }

    fn run<T: Work>(
        scope: &DedicatedWorkerGlobalScope,
        task: serde_json::Value,
    ) -> Result<(), serde_json::Error> {
        let mut said = -1.0;
        serde_json::from_value::<T>(task)?.run(&mut |news| {
            if let News::Progress(fraction, _) = &news {
                if (fraction - said).abs() <= PROGRESS_STEP {
                    return true;
                }
                said = *fraction;
            }
            send(scope, &news);
            true
        });
        Ok(())
    }
}
