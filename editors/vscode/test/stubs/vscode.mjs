// As much of VS Code as the extension touches. What it does is noted in `globalThis.seen`.

const seen = globalThis.seen;

export const LanguageStatusSeverity = { Information: 0, Warning: 1, Error: 2 };

export const languages = {
  createLanguageStatusItem: (id, selector) => (seen.status = { id, selector, dispose: () => (seen.status.disposed = true) }),
};

export const workspace = {
  getConfiguration: (section) => ({ get: (key, otherwise) => seen.settings[`${section}.${key}`] ?? otherwise }),
  onDidChangeConfiguration: (listener) => ((seen.changed = listener), { dispose() {} }),
};

export const window = {
  get activeTextEditor() {
    return seen.editor;
  },
  showInformationMessage: async (text) => void seen.messages.push(text),
  createOutputChannel: () => (seen.channel = { replace: (text) => (seen.printed = text), show() {}, dispose() {} }),
  showErrorMessage: async (text) => void seen.messages.push(text),
};

export const commands = {
  executeCommand: (name, ...args) => seen.commands[name](...args),
  registerCommand: (name, run) => ((seen.commands[name] = run), { dispose() {} }),
};
