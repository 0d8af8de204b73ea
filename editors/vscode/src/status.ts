// What the status bar says of the server.

import * as vscode from "vscode";

/** The item in the status bar of models. */
export class Status {
  private readonly item = vscode.languages.createLanguageStatusItem("fdcc", { language: "fdc" });

  constructor() {
    this.item.name = "fdc language server";
  }

  /** The server is being started. */
  starting(): void {
    this.show("fdcc", vscode.LanguageStatusSeverity.Information, undefined, true);
  }

  /** The server runs. */
  running(version: string): void {
    const restart = { title: "Restart", command: "fdc.restart" };
    this.show(`fdcc ${version}`.trim(), vscode.LanguageStatusSeverity.Information, restart);
  }

  /** There is no server; what to do about it. */
  missing(problem: string): void {
    const settings = { title: "Open Setting", command: "workbench.action.openSettings", arguments: ["fdcc.path"] };
    this.show("fdcc is missing", vscode.LanguageStatusSeverity.Error, settings);
    this.item.detail = problem;
  }

  /** The server has ended. */
  stopped(why: string): void {
    const restart = { title: "Restart", command: "fdc.restart" };
    this.show("fdcc has stopped", vscode.LanguageStatusSeverity.Error, restart);
    this.item.detail = why;
  }

  dispose(): void {
    this.item.dispose();
  }

  private show(text: string, severity: vscode.LanguageStatusSeverity, command?: vscode.Command, busy = false): void {
    Object.assign(this.item, { text, severity, command, busy, detail: undefined });
  }
}
