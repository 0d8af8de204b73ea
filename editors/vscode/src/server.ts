// The server: started, stopped, and asked to run its commands.

import { accessSync, constants, statSync } from "node:fs";
import * as path from "node:path";
import * as vscode from "vscode";
import { LanguageClient, State } from "vscode-languageclient/node";
import { findBinary } from "./binary";
import { Results } from "./results";
import { Status } from "./status";

/** One server for all models of a window. */
export class Server {
  private client: LanguageClient | undefined;
  private readonly status = new Status();
  private readonly results = new Results();

  constructor(private readonly extensionFolder: string) {}

  /** Starts it, if there is one; else the status bar says what is missing. */
  async start(): Promise<void> {
    const found = findBinary({
      setting: vscode.workspace.getConfiguration("fdcc").get<string>("path", ""),
      search: process.env.PATH ?? "",
      bundled: path.join(this.extensionFolder, "out"),
      windows: process.platform === "win32",
      runs,
    });
    if ("problem" in found) return this.status.missing(found.problem);
    this.status.starting();
    const client = new LanguageClient("fdcc", "fdc", { command: found.command, args: ["lsp"] }, {
      documentSelector: [{ language: "fdc" }],
      // Commands come from the palette and from the lines above a model; what they print is shown for both.
      middleware: { executeCommand: (command, args, next) => this.results.show(next(command, args)) },
    });
    this.client = client;
    client.onDidChangeState(({ newState }) => {
      // One that is being replaced has nothing to say any more.
      if (this.client !== client) return;
      if (newState === State.Running) this.status.running(client.initializeResult?.serverInfo?.version ?? "");
      if (newState === State.Stopped) this.status.stopped("Its last words are in the output channel `fdc`.");
    });
    // What goes wrong is told by the client itself and by the change of its state.
    await client.start().catch(() => undefined);
  }

  /** Stops it. */
  async stop(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    await client?.dispose().catch(() => undefined);
  }

  /** Starts it anew, for example after an update. */
  async restart(): Promise<void> {
    await this.stop();
    await this.start();
  }

  /** Lets it run one of its commands on the model that is being edited. */
  async run(command: string): Promise<void> {
    const document = vscode.window.activeTextEditor?.document;
    if (document?.languageId !== "fdc") return void vscode.window.showInformationMessage("Open a model first.");
    if (!this.client?.isRunning()) return void vscode.window.showErrorMessage("The server of fdcc does not run.");
    await vscode.commands.executeCommand(command, document.uri.toString());
  }

  /** For the end of the window. */
  async dispose(): Promise<void> {
    await this.stop();
    this.status.dispose();
    this.results.dispose();
  }
}

function runs(file: string): boolean {
  try {
    accessSync(file, constants.X_OK);
    return statSync(file).isFile();
  } catch {
    return false;
  }
}
