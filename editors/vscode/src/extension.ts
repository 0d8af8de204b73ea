// The extension: a server, and the commands that reach it.

import * as vscode from "vscode";
import { Server } from "./server";

let server: Server | undefined;

/** Called when the first model is opened. */
export async function activate(context: vscode.ExtensionContext): Promise<void> {
  const it = new Server(context.extensionPath);
  server = it;
  const command = (name: string, run: () => Promise<void>) =>
    context.subscriptions.push(vscode.commands.registerCommand(`fdc.${name}`, run));
  for (const name of ["solve", "simulate", "report"]) command(name, () => it.run(`fdcc.${name}`));
  command("restart", () => it.restart());
  context.subscriptions.push(
    vscode.workspace.onDidChangeConfiguration(async (change) => {
      if (change.affectsConfiguration("fdcc.path")) await it.restart();
    }),
  );
  await it.start();
}

/** Called when the window is closed. */
export async function deactivate(): Promise<void> {
  await server?.dispose();
}
