// The library of the protocol, without a server behind it.

const seen = globalThis.seen;

export const LSPErrorCodes = { RequestCancelled: -32800 };
export const State = { Stopped: 1, Running: 2, Starting: 3 };

export class LanguageClient {
  constructor(id, name, server, options) {
    Object.assign(this, { id, name, server, options, listeners: [], disposed: false });
    seen.clients.push(this);
  }

  onDidChangeState(listener) {
    this.listeners.push(listener);
  }

  become(newState) {
    for (const listener of this.listeners) listener({ newState });
  }

  async start() {
    if (seen.refuses) throw new Error("it does not start");
    // As the library does, with the commands that the server offers.
    const ask = async (name, args) => (seen.requests.push({ name, args }), seen.answer());
    for (const name of ["fdcc.solve", "fdcc.simulate", "fdcc.report"]) {
      seen.commands[name] = (...args) => this.options.middleware.executeCommand(name, args, ask);
    }
    this.initializeResult = { serverInfo: { name: "fdcc", version: "9.8.7" } };
    this.become(State.Running);
  }

  async dispose() {
    this.disposed = true;
    this.become(State.Stopped);
  }

  isRunning() {
    return !this.disposed;
  }
}
