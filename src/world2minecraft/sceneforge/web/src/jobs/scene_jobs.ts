// Long work on the scene, in every tab: a bar that says how far it is, with a way to cancel it.

import { registerStagePart, type App } from "../ui/slots";
import type { JobState } from "../wire";
import { progressLine, type ProgressLine } from "./progress";

const STAGES = new Set(["scene", "planes", "pieces", "doubts"]); // those of jobs/background_job.py
const SOONEST_MS = 400; // what is over sooner needs no bar

export function registerSceneJobs(): void {
  registerStagePart({ id: "scene-jobs", mount });
}

function mount(host: HTMLElement, app: App): void {
  const lines = new Map<string, ProgressLine>();
  const due = new Map<string, number>();
  const end = (id: string): void => {
    clearTimeout(due.get(id));
    due.delete(id);
    lines.get(id)?.node.remove();
    lines.delete(id);
  };
  const begin = (job: JobState): void => {
    const line = progressLine(job.title, () => app.connection.cancel(job.id));
    lines.set(job.id, line);
    due.set(job.id, window.setTimeout(() => host.append(line.node), SOONEST_MS));
  };
  app.connection.onJob((job) => {
    if (!STAGES.has(job.stage)) return;
    if (job.state !== "running") end(job.id);
    else {
      if (!lines.has(job.id)) begin(job);
      lines.get(job.id)?.show(job);
    }
  });
}
