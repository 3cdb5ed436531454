// Keeps the page for visits without a network. Every build has its own store: the files of one build are
// never mixed with those of another. A new build takes over when the last window of the old one is closed.
// Stores belong to the host: the folder in their name tells those of another Hysteron on it apart.
const OURS = `hysteron ${new URL(self.registration.scope).pathname} `;
const STORE = OURS + "VERSION";
const FILES = FILE_LIST;

self.addEventListener("install", (event) => {
  // The browser's own cache may still have files of the build before: it asks the server whether each is the newest,
  // and what the page has just loaded is not loaded again.
  const fresh = FILES.map((file) => new Request(file, { cache: "no-cache" }));
  event.waitUntil(caches.open(STORE).then((store) => store.addAll(fresh)));
});

self.addEventListener("activate", (event) => {
  event.waitUntil((async () => {
    const old = (await caches.keys()).filter((name) => name.startsWith(OURS) && name !== STORE);
    await Promise.all(old.map((name) => caches.delete(name)));
    await self.clients.claim();
  })());
});

self.addEventListener("fetch", (event) => {
  if (event.request.method !== "GET") return;
  event.respondWith((async () => {
    const store = await caches.open(STORE);
    return (await store.match(event.request, { ignoreSearch: true })) || fetch(event.request);
  })());
});
