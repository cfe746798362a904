// Runs Python: loads Pyodide and the package's core, then answers each request with the frames of a run. The page
// starts this file as a blob, because a blob has the Content-Security-Policy of the page.

let python = null;

async function load(base) {
  importScripts(`${base}pyodide/pyodide.js`);
  const [runtime, core] = await Promise.all([
    loadPyodide({indexURL: `${base}pyodide/`}),
    fetch(`${base}core.zip`).then(answer => answer.arrayBuffer())]);
  runtime.unpackArchive(core, 'zip');
  python = runtime;
  return JSON.parse(runtime.runPython(`
import json
from rbx1_nav.exercise.methods import OF_PAGE
from rbx1_nav.extras.page.runner import SCRIPT, run_request
with open('config.json') as file:
    config = json.load(file)
json.dumps({'surfaces': list(config['surfaces']),
            'titles': {SCRIPT: SCRIPT, **{name: each.title for name, each in OF_PAGE.items()}}})`));
}

onmessage = async ({data}) => {
  try {
    postMessage(data.base ? await load(data.base)
      : {frames: python.globals.get('run_request')(python.globals.get('config'), data.request)});
  } catch (error) {
    postMessage({error: String(error).trim().split('\n').pop()});
  }
};
