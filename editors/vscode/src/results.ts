// What solving and simulating print.

import * as vscode from "vscode";

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
      void vscode.window.showErrorMessage((error as Error).message);
    }
  }

  dispose(): void {
    this.channel.dispose();
  }
}
