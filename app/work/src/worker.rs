//! The page's worker: it computes off the page's main thread, in the page's module, which is there already.

use hysteron_core::message::Message;
use js_sys::{Array, Uint8Array};
use wasm_bindgen::prelude::*;
use web_sys::{DedicatedWorkerGlobalScope, MessageEvent};

use crate::tasks::{
    DiscoveryTask, ExperimentTask, GapTask, HandTask, LoopTask, MapTask, MeasuredTask, MysteryTask,
    News, OnOffTask, READY, ReadTask, RevealTask, ScenarioTask, ServoTask, StepTask, Task as _,
    TuneTask,
};
use crate::wire::{pack, unpack};
use crate::work::Work;

/// Share of progress below which nothing new is said.
const PROGRESS_STEP: f64 = 0.01;

/// Answers the tasks that the page gives, for as long as the worker lives.
pub fn listen() {
    let scope: DedicatedWorkerGlobalScope = js_sys::global().unchecked_into();
    let answer = scope.clone();
    let handler = Closure::<dyn FnMut(MessageEvent)>::new(move |event: MessageEvent| {
        let Ok(message) = event.data().dyn_into::<Array>() else {
            return;
        };
        if let Err(error) = work(&answer, &message) {
            send(&answer, &News::<()>::Failed(Message::name(error)));
        }
        ready(&answer);
    });
    scope.set_onmessage(Some(handler.as_ref().unchecked_ref()));
    handler.forget();
    ready(&scope);
}

fn ready(scope: &DedicatedWorkerGlobalScope) {
    // A page that is gone needs no answer; here and below.
    let _ = scope.post_message(&JsValue::from_str(READY));
}

fn send<R: serde::Serialize>(scope: &DedicatedWorkerGlobalScope, news: &News<R>) {
    if let Ok(bytes) = pack(news) {
        let bytes = Uint8Array::from(bytes.as_slice());
        let moved = Array::of1(&bytes.buffer());
        let _ = scope.post_message_with_transfer(&bytes, &moved);
    }
}

/// A message is the task's name and the task; one line for each kind of task.
fn work(scope: &DedicatedWorkerGlobalScope, message: &Array) -> Result<(), String> {
    let name = message.get(0).as_string().unwrap_or_default();
    let task = Uint8Array::new(&message.get(1)).to_vec();
    match name.as_str() {
        ReadTask::NAME => run::<ReadTask>(scope, &task),
        StepTask::NAME => run::<StepTask>(scope, &task),
        DiscoveryTask::NAME => run::<DiscoveryTask>(scope, &task),
        ExperimentTask::NAME => run::<ExperimentTask>(scope, &task),
        HandTask::NAME => run::<HandTask>(scope, &task),
        MapTask::NAME => run::<MapTask>(scope, &task),
        GapTask::NAME => run::<GapTask>(scope, &task),
        MysteryTask::NAME => run::<MysteryTask>(scope, &task),
        RevealTask::NAME => run::<RevealTask>(scope, &task),
        TuneTask::NAME => run::<TuneTask>(scope, &task),
        LoopTask::NAME => run::<LoopTask>(scope, &task),
        OnOffTask::NAME => run::<OnOffTask>(scope, &task),
        ServoTask::NAME => run::<ServoTask>(scope, &task),
        ScenarioTask::NAME => run::<ScenarioTask>(scope, &task),
        MeasuredTask::NAME => run::<MeasuredTask>(scope, &task),
        _ => Err(format!("no task is called {name}")),
    }
}

fn run<T: Work>(scope: &DedicatedWorkerGlobalScope, task: &[u8]) -> Result<(), String> {
    let mut said = -1.0;
    unpack::<T>(task)?.run(&mut |news| {
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
