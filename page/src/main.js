// Starts the viewer on the scene that is in the page, or that a session serves.
import { App } from './app.js';
import { Live } from './live.js';
import { Scene } from './scene.js';
import { fromBase64, unpack } from './unpack.js';

/** Blocks of a scene that stands in the page; each is taken once. */
const fromPage = (prefix) => async (name) => {
  const element = document.getElementById(prefix + name);
  if (!element) return null;
  const text = element.textContent;
  element.remove();
  return unpack(fromBase64(text));
};

async function start() {
  const app = new App();
  window.hextwist = app;  // for tests and for who looks
  if (document.getElementById('skin')) {
    const scene = await Scene.open(fromPage(''));
    const before = document.getElementById('before-skin') ? fromPage('before-') : null;
    let opened = null;
    await app.open(scene, { before: before && (() => (opened ??= Scene.open(before))) });
  } else if (location.protocol.startsWith('http')) {
    await new Live(app).start();
  } else {
    app.say('there is no mesh in this page');
  }
  app.ready = true;
}

start().catch((error) => {
  document.getElementById('status').value = error.message;
  console.error(error);
});
