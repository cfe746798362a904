// Python in a worker: see worker.js.

export class Python {
  constructor() {
    // resolves to what describe_page() of the runner returns
    this.ready = this.start();
  }

  async start() {
    const code = new Blob([await (await fetch('worker.js')).text()], {type: 'text/javascript'});
    this.worker = new Worker(URL.createObjectURL(code));
    return this.ask({base: new URL('.', location.href).href});
  }

  ask(message) {
    return new Promise((resolve, reject) => {
      this.reject = reject;
      this.worker.onmessage = ({data}) => data.error ? reject(new Error(data.error)) : resolve(data);
      this.worker.onerror = ({message: text}) => reject(new Error(text));
      this.worker.postMessage(message);
    });
  }

  // Returns the value of a choice that is given as text.
  async choose(name, text) {
    return (await this.ask({choose: [name, text]})).value;
  }

  // Returns the frames of a run.
  async run(request) {
    return JSON.parse((await this.ask({request: JSON.stringify(request)})).frames);
  }

  // Ends the worker, since nothing can interrupt what it computes.
  end(reason) {
    this.worker.terminate();
    this.reject(new Error(reason));
  }
}
