// Puts a new object where one clicks: of the chosen class, of its usual size.

import { TEXT } from "../text";
import type { Desk, Tool } from "./tool";

const FIRST_OBJECT = 5; // ids from here are objects, below is structure

export function whyNoObject(classId: number): string {
  return classId >= FIRST_OBJECT ? "" : TEXT.why.notAnObject;
}

export function addTool(desk: Desk): Tool {
  const { app } = desk;
  return {
    id: "add",
    cursor: "copy",
    hover: (at) => {
      if (at) desk.marks.circle("add", [at.x, at.y], 9);
      else desk.marks.clear("add");
    },
    press: (from) => {
      const point = app.view.pointAt(from.x, from.y);
      return {
        move: () => undefined,
        end: () => {
          const { classId } = app.store.get().options;
          const why = whyNoObject(classId) || (point ? "" : TEXT.why.noPlace);
          if (why || !point) app.toast(why, "error");
          else void app.do({ op: "add_object", class_id: classId, at_m: point });
        },
        cancel: () => undefined,
      };
    },
    stop: () => desk.marks.clear("add"),
  };
}
