// Service worker: keeps all files of the page, so that it works offline. The build lists them with their hashes.

const HASHES = 'FILES';
const CACHE = `page-${Object.values(HASHES).map(hash => hash.slice(0, 2)).join('')}`;

self.oninstall = event => {
  self.skipWaiting();
  // no-cache: a file that the browser has loaded is compared, not loaded again
  const files = ['./', ...Object.keys(HASHES)].map(path => new Request(path, {cache: 'no-cache'}));
  event.waitUntil(caches.open(CACHE).then(cache => cache.addAll(files)));
};

self.onactivate = event => event.waitUntil(caches.keys().then(names => Promise.all(
  [self.clients.claim(), ...names.filter(name => name !== CACHE).map(name => caches.delete(name))])));

self.onfetch = event => event.respondWith(
  caches.match(event.request, {cacheName: CACHE, ignoreSearch: true}).then(found => found || fetch(event.request)));
