// The real server, spoken to with the library of the protocol that VS Code uses. The variable FDCC says where it is.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import protocol from "vscode-languageserver-protocol/node";

const manifest = JSON.parse(readFileSync(new URL("../package.json", import.meta.url), "utf8"));
const skip = process.env.FDCC === undefined && "FDCC is not set";
const uri = "file:///block.fdc";
const broken = "model block\nparam μ = 0.3\nstate v start 0\ndynamics { v' = -μ*w }\n";
const whole = "model block\ntime t in [0, 1]\nstate v start 0\ncontrol w\ndynamics { v' = w }\nend v == 1\nminimize integral(w^2)\n";

async function connected(use, text = broken) {
  const server = spawn(process.env.FDCC, ["lsp"], { stdio: ["pipe", "pipe", "inherit"] });
  const ended = new Promise((resolve) => server.on("exit", resolve));
  const connection = protocol.createProtocolConnection(server.stdout, server.stdin);
  connection.listen();
  const capabilities = { general: { positionEncodings: ["utf-16"] }, textDocument: { diagnostic: {}, semanticTokens: {} } };
  const answer = await connection.sendRequest("initialize", { processId: process.pid, rootUri: null, capabilities });
  await connection.sendNotification("initialized", {});
  const textDocument = { uri, languageId: "fdc", version: 1, text };
  await connection.sendNotification("textDocument/didOpen", { textDocument });
  await use(connection, answer.capabilities);
  await connection.sendRequest("shutdown");
  await connection.sendNotification("exit");
  assert.equal(await ended, 0);
}

test("a mistake is told at its place, and the server ends when it is told to", { skip }, async () => {
  await connected(async (connection) => {
    const report = await connection.sendRequest("textDocument/diagnostic", { textDocument: { uri } });
    const mistake = report.items.find(({ code }) => code === "FDC0101");
    assert.deepEqual(mistake.range, { start: { line: 3, character: 19 }, end: { line: 3, character: 20 } });
    assert.match(mistake.codeDescription.href, /FDC0101/);
  });
});

test("every kind of word that the server tells apart has a colour", { skip }, async () => {
  await connected(async (_, { semanticTokensProvider }) => {
    const usual = ["variable", "function", "parameter", "property"];
    const own = manifest.contributes.semanticTokenTypes.map(({ id }) => id);
    assert.deepEqual([...usual, ...own].sort(), [...semanticTokensProvider.legend.tokenTypes].sort());
    const coloured = Object.keys(manifest.contributes.semanticTokenScopes[0].scopes);
    assert.deepEqual(coloured.sort(), own.sort());
  });
});

test("a model is solved as it stands, and the answer is what the command prints", { skip }, async () => {
  await connected(async (connection, { executeCommandProvider }) => {
    assert.deepEqual([...executeCommandProvider.commands].sort(), ["fdcc.report", "fdcc.simulate", "fdcc.solve"]);
    const params = { command: "fdcc.solve", arguments: [uri] };
    const { exitCode, output } = await connection.sendRequest("workspace/executeCommand", params);
    assert.equal(exitCode, 0);
    // The shortest way from 0 to 1 in a time of 1 is a straight line.
    assert.match(output, /objective 1$/m);
  }, whole);
});
