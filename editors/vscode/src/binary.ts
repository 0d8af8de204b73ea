// Where the `fdcc` command is: what the setting says, else in PATH, else in the extension.

import * as path from "node:path";

/** What is asked of the outside world. */
export interface World {
  /** The setting `fdcc.path`; empty if it is not set. */
  setting: string;
  /** The variable PATH. */
  search: string;
  /** The folder of the extension in which a command may have been put. */
  bundled: string;
  /** Whether commands end with `.exe` and folders are parted by `;`. */
  windows: boolean;
  /** Whether there is a file that can be run. */
  runs(file: string): boolean;
}

/** A command, or what to tell the user. */
export type Found = { command: string } | { problem: string };

/** Finds the command. A setting that leads nowhere is told, not passed over: it was made on purpose. */
export function findBinary(world: World): Found {
  if (world.setting !== "") {
    const problem = `There is no command \`${world.setting}\`; correct the setting \`fdcc.path\`, or empty it.`;
    return world.runs(world.setting) ? { command: world.setting } : { problem };
  }
  const name = world.windows ? "fdcc.exe" : "fdcc";
  const { delimiter, join } = world.windows ? path.win32 : path.posix;
  const folders = [...world.search.split(delimiter).filter((folder) => folder !== ""), world.bundled];
  const command = folders.map((folder) => join(folder, name)).find(world.runs);
  const problem = "There is no command `fdcc` in PATH; install it with `cargo install --path cli`, or say where it is in the setting `fdcc.path`.";
  return command === undefined ? { problem } : { command };
}
