// What the page does with its time, noted from inside: frames, tasks, answers to inputs, what workers were given.
(() => {
  const fresh = () => ({
    frames: 0, frame: 0, frame_at: 0, task: 0, task_at: 0, answers: 0, answer: 0, answer_at: 0, tasks: 0,
    since: performance.now(),
  });
  let watch = fresh();
  let reacted = null;
  let wanted = null;
  let first = null;
  window.hysteron_watch = {
    begin() { watch = fresh(); },
    read: () => watch,
    // From now on: when is a frame of another page drawn?
    expect(page) { wanted = `"page":"${page}"`; reacted = null; },
    // When the first frame was there, and when the one that was expected; null for not yet.
    reacted: () => [first, reacted],
  };
  // The app says its state in every frame that it makes: most of them when the browser asks for a frame, those of a
  // click at once. The browser paints both when it has asked.
  let state = null, made = false, asked = null, begin = 0;
  const work = () => {
    const time = performance.now() - begin;
    if (time > watch.frame) [watch.frame, watch.frame_at] = [time, begin - watch.since];
  };
  Object.defineProperty(window, "hysteron_state", {
    get: () => state,
    set: (text) => { state = text; made = true; work(); },
  });
  for (const kind of ["pointermove", "pointerdown", "pointerup", "keydown"]) {
    window.addEventListener(kind, (event) => {
      begin = performance.now();
      asked ??= event.timeStamp;
    }, { capture: true });
  }
  const request = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) => request((now) => {
    begin = performance.now();
    draw(now);
    if (!made) return;
    made = false;
    const end = performance.now();
    watch.frames += 1;
    first ??= end;
    work();
    if (asked !== null) {
      watch.answers += 1;
      if (end - asked > watch.answer) [watch.answer, watch.answer_at] = [end - asked, asked - watch.since];
      asked = null;
    }
    if (wanted !== null && state.includes(wanted)) {
      reacted = end;
      wanted = null;
    }
  });
  // The browser tells of tasks above 50 ms only: that is what is asked.
  new PerformanceObserver((list) => {
    for (const { duration, startTime } of list.getEntries()) {
      if (duration > watch.task) [watch.task, watch.task_at] = [duration, startTime - watch.since];
    }
  }).observe({ type: "longtask" });
  const Started = window.Worker;
  window.Worker = class extends Started {
    postMessage(...what) {
      super.postMessage(...what);
      // What a worker is begun with is no task.
      if (!(what[0] instanceof WebAssembly.Module)) watch.tasks += 1;
    }
  };
})();
