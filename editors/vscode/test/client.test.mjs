// The logic of the extension, with stubs in place of VS Code and of the library of the protocol.

import assert from "node:assert/strict";
import { chmodSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, beforeEach, test } from "node:test";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const manifest = JSON.parse(readFileSync(here("../package.json"), "utf8"));
const alias = { vscode: here("stubs/vscode.mjs"), "vscode-languageclient/node": here("stubs/client.mjs") };

async function load(source) {
  const options = { bundle: true, write: false, format: "esm", platform: "node", alias, entryPoints: [here(source)] };
  const { outputFiles } = await build(options);
  // A comment that differs makes it a module of its own, with its own state.
  return import(`data:text/javascript,${encodeURIComponent(outputFiles[0].text)}//${Math.random()}`);
}

const folder = mkdtempSync(join(tmpdir(), "fdcc-"));
after(() => rmSync(folder, { recursive: true }));

function executable(...path) {
  const file = join(folder, ...path);
  mkdirSync(join(file, ".."), { recursive: true });
  writeFileSync(file, "");
  chmodSync(file, 0o755);
  return file;
}

const inPath = executable("bin", "fdcc");
const bundled = executable("extension", "out", "fdcc");
const extensionPath = join(folder, "extension");
const document = () => ({ languageId: "fdc", uri: "file:///car.fdc" });

beforeEach(() => {
  const nothing = { commands: {}, settings: {}, clients: [], requests: [], messages: [] };
  globalThis.seen = { ...nothing, editor: { document: document() } };
  process.env.PATH = join(folder, "bin");
});

async function activated() {
  const extension = await load("../src/extension.ts");
  await extension.activate({ extensionPath, subscriptions: [] });
  return extension;
}

test("the command is what the setting says, else in PATH, else in the extension", async () => {
  const { findBinary } = await load("../src/binary.ts");
  const files = ["/set/fdcc", "/a/fdcc", "/b/fdcc", "/ext/out/fdcc"];
  const world = { setting: "", search: "/none::/a:/b", bundled: "/ext/out", windows: false };
  const find = (change, there = files) =>
    findBinary({ ...world, ...change, runs: (file) => there.includes(file) });
  assert.deepEqual(find({ setting: "/set/fdcc" }), { command: "/set/fdcc" });
  assert.deepEqual(find({}), { command: "/a/fdcc" });
  assert.deepEqual(find({ search: "/none" }), { command: "/ext/out/fdcc" });
  assert.match(find({ setting: "/wrong" }).problem, /no command `\/wrong`/);
  assert.match(find({}, []).problem, /cargo install/);
  const windows = { search: "C:\\a;C:\\b", windows: true };
  assert.deepEqual(find(windows, ["C:\\b\\fdcc.exe"]), { command: "C:\\b\\fdcc.exe" });
});

test("opening a model starts the server that is found, and the status bar shows its version", async () => {
  await activated();
  const [client] = seen.clients;
  assert.deepEqual(client.server, { command: inPath, args: ["lsp"] });
  assert.deepEqual(client.options.documentSelector, [{ language: "fdc" }]);
  assert.equal(seen.status.text, "fdcc 9.8.7");
  assert.equal(seen.status.busy, false);
});

test("a command in the extension serves where there is no other", async () => {
  process.env.PATH = "";
  await activated();
  assert.equal(seen.clients[0].server.command, bundled);
});

test("without a command the status bar says what to do", async () => {
  seen.settings["fdcc.path"] = join(folder, "nowhere");
  await activated();
  assert.equal(seen.clients.length, 0);
  assert.equal(seen.status.text, "fdcc is missing");
  assert.match(seen.status.detail, /nowhere/);
  assert.deepEqual(seen.status.command.arguments, ["fdcc.path"]);
});

test("changing the setting starts the other server; other settings do not matter", async () => {
  await activated();
  await seen.changed({ affectsConfiguration: () => false });
  assert.equal(seen.clients.length, 1);
  seen.settings["fdcc.path"] = bundled;
  await seen.changed({ affectsConfiguration: (name) => name === "fdcc.path" });
  assert.equal(seen.clients[0].disposed, true);
  assert.equal(seen.clients[1].server.command, bundled);
  assert.equal(seen.status.text, "fdcc 9.8.7");
});

test("a server that ends or does not start is told", async () => {
  await activated();
  seen.clients[0].become(1);
  assert.equal(seen.status.text, "fdcc has stopped");
  seen.refuses = true;
  await seen.commands["fdc.restart"]();
  assert.equal(seen.clients.length, 2);
});

test("commands are run by the server, and what they print is shown", async () => {
  await activated();
  seen.answer = () => ({ exitCode: 0, log: "iterations", output: "objective 5.55" });
  for (const name of ["solve", "simulate", "report"]) {
    await seen.commands[`fdc.${name}`]();
    assert.deepEqual(seen.requests.at(-1), { name: `fdcc.${name}`, args: ["file:///car.fdc"] });
    assert.equal(seen.printed, "iterations\nobjective 5.55");
  }
  seen.answer = () => { throw new Error("this model has mistakes; mend them first"); };
  await seen.commands["fdc.solve"]();
  seen.answer = () => { throw Object.assign(new Error("cancelled"), { code: -32800 }); };
  await seen.commands["fdc.solve"]();
  assert.deepEqual(seen.messages, ["this model has mistakes; mend them first"]);
});

test("commands without a model or a server say so", async () => {
  await activated();
  seen.editor = undefined;
  await seen.commands["fdc.solve"]();
  seen.editor = { document: document() };
  await (await activatedWithout()).commands["fdc.solve"]();
  assert.deepEqual(seen.messages, ["Open a model first.", "The server of fdcc does not run."]);
});

async function activatedWithout() {
  seen.settings["fdcc.path"] = join(folder, "nowhere");
  await activated();
  return seen;
}

test("closing the window ends the server", async () => {
  const extension = await activated();
  await extension.deactivate();
  assert.equal(seen.clients[0].disposed, true);
  assert.equal(seen.status.disposed, true);
});

test("the manifest offers just the commands that there are, and its files exist", async () => {
  await activated();
  const offered = manifest.contributes.commands.map(({ command }) => command).sort();
  const own = Object.keys(seen.commands).filter((name) => name.startsWith("fdc."));
  assert.deepEqual(offered, own.sort());
  const { languages, grammars, snippets } = manifest.contributes;
  const files = [languages[0].configuration, ...[...grammars, ...snippets].map(({ path }) => path)];
  for (const file of files) JSON.parse(readFileSync(here(`../${file}`), "utf8"));
});
