// What solving and simulating print.

import * as vscode from "vscode";
import { LSPErrorCodes } from "vscode-languageclient/node";

/** The answer of the server to one of its commands: what `fdcc` wrote to its two streams. */
interface Printed {
  output?: string;
  log?: string;
}

/** The channel in which results are read. */
export class Results {
  private readonly channel = vscode.window.createOutputChannel("fdc results");

  /** Shows what a command prints, or why it did not run. */
  async show(running: PromiseLike<Printed | null | undefined>): Promise<void> {
    try {
      const printed = await running;
      const text = [printed?.log, printed?.output].filter(Boolean).join("\n");
      if (text === "") return;
      this.channel.replace(text);
      this.channel.show(true);
    } catch (error) {
      // Whoever calls a command off need not be told.
      const { code, message } = error as Error & { code?: number };
      if (code !== LSPErrorCodes.RequestCancelled) void vscode.window.showErrorMessage(message);
    }
  }

  dispose(): void {
    this.channel.dispose();
  }
}
