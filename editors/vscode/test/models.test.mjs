// The TextMate grammar sees the same items as the compiler in every model, and has a scope for every word.
// The models are written out by `cargo run -p fdcc-tests --example editor_texts target/editors/models`.

import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { test } from "node:test";
import oniguruma from "vscode-oniguruma";
import textmate from "vscode-textmate";

const require = createRequire(import.meta.url);
const here = (path) => new URL(path, import.meta.url);
const models = here("../../../target/editors/models/");

// Of Markdown as much as is needed here: nothing.
const grammars = {
  "source.fdc": "../syntaxes/fdc.tmLanguage.json",
  "markdown.fdc.codeblock": "../syntaxes/markdown.tmLanguage.json",
  "text.html.markdown": "stubs/markdown.json",
};
await oniguruma.loadWASM(readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm")).buffer);
const registry = new textmate.Registry({
  onigLib: Promise.resolve({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  }),
  loadGrammar: async (scope) => grammars[scope] && JSON.parse(readFileSync(here(grammars[scope]), "utf8")),
  getInjections: (scope) => (scope === "text.html.markdown" ? ["markdown.fdc.codeblock"] : undefined),
});
const fdc = await registry.loadGrammar("source.fdc");

// All tokens of a text: the innermost scope, the text, and the place in bytes.
function tokens(text, grammar = fdc) {
  const found = [];
  let state = textmate.INITIAL;
  let start = 0;
  for (const line of text.split("\n")) {
    const result = grammar.tokenizeLine(line, state);
    state = result.ruleStack;
    for (const { startIndex, endIndex, scopes } of result.tokens) {
      const at = start + Buffer.byteLength(line.slice(0, startIndex));
      found.push({ scope: scopes.at(-1), text: line.slice(startIndex, endIndex), at });
    }
    start += Buffer.byteLength(line) + 1;
  }
  return found;
}

const names = readdirSync(models).filter((name) => name.endsWith(".fdc"));
const read = (name) => readFileSync(new URL(name, models), "utf8");

test("items are those of the compiler", () => {
  assert(names.length > 500, "write the models out first");
  const differ = names.filter((name) => {
    const items = tokens(read(name)).filter((token) => token.scope === "keyword.other.item.fdc");
    return items.map(({ at, text }) => `${at} ${text}\n`).join("") !== read(name.replace(/fdc$/, "words"));
  });
  assert.deepEqual(differ, []);
});

test("every word and every number has a scope", () => {
  for (const name of names) {
    const bare = tokens(read(name)).filter(({ scope, text }) => scope === "source.fdc" && /[^\s(){}[\]]/.test(text));
    assert.deepEqual(bare, [], name);
  }
});

test("models in Markdown have their colours, and what follows has none", async () => {
  const markdown = await registry.loadGrammar("text.html.markdown");
  const found = tokens("a state\n\n```fdc more\nstate x\n```\n\na state\n", markdown);
  const items = found.filter(({ scope }) => scope === "keyword.other.item.fdc");
  assert.deepEqual(items.map(({ at, text }) => [at, text]), [[21, "state"]]);
});
