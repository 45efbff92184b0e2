// What stands for an analysis in a scene without any: the given configuration.

import { Analysis } from "./contract";

export function unanalysed(): Analysis {
  const empty = { type: "float64" as const, data: "" };
  return {
    type: "none", status: "ok", message: "The scene has no analyses: it is shown as it is given.", warnings: [],
    seconds: 0, redundant: [], set: {}, fields: {}, measures: [], drawing: 0, rows: { count: 0, total: 0, stride: 1 }, columns: [],
    poses: {
      count: 0, total: 0, stride: 1, arrows: true, t: empty,
      frames: { type: "float32", step: [1, 1, 1], base: empty, data: "" },
    },
    shapes: [],
  };
}
