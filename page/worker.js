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
from rbx1_nav.extras.page.runner import choose, describe_page, run_request
with open('config.json') as file:
    config = json.load(file)
describe_page(config)`));
}

function call(name, ...values) {
  return python.globals.get(name)(python.globals.get('config'), ...values);
}

onmessage = async ({data}) => {
  try {
    postMessage(data.base ? await load(data.base) : data.choose ? {value: call('choose', ...data.choose)}
      : {frames: call('run_request', data.request)});
  } catch (error) {
    postMessage({error: String(error).trim().split('\n').pop().replace('ValueError: ', '')});
  }
};
