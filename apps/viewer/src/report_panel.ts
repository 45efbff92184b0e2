// The tab with what the analysis says of itself: outcome, warnings, named results, lists of modes and critical points.

import { Analysis, FieldRecord, Measure, PageData } from "./contract";
import { make } from "./dom";
import { Motion } from "./motion";
import { short } from "./ticks";

function show(value: unknown): string {
  if (typeof value === "number") return short(value);
  if (typeof value === "boolean") return value ? "yes" : "no";
  if (value === null || value === undefined) return "–";
  if (typeof value === "object" && !Array.isArray(value)) {
    return Object.entries(value).map(([key, member]) => `${key} = ${show(member)}`).join(", ") || "none";
  }
  if (Array.isArray(value)) {
    const shown = value.slice(0, 12).map(show).join(", ");
    return value.length > 12 ? `${shown}, … (${value.length})` : shown || "none";
  }
  return String(value);
}

function isRecords(value: unknown): value is FieldRecord[] {
  return Array.isArray(value) && value.length > 0 && typeof value[0] === "object" && value[0] !== null;
}

function recordTable(records: FieldRecord[], chosen: (record: FieldRecord) => void): HTMLElement {
  const keys = [...new Set(records.flatMap((record) => Object.keys(record)))];
  const rows = records.slice(0, 200).map((record) => {
    const row = make("tr", { tabindex: "0" }, ...keys.map((key) => make("td", {}, show(record[key]))));
    row.addEventListener("click", () => chosen(record));
    row.addEventListener("keydown", (event) => event.key === "Enter" && chosen(record));
    return row;
  });
  return make("div", { class: "scroll" },
              make("table", {}, make("tr", {}, ...keys.map((key) => make("th", {}, key))), ...rows));
}

function modeTable(analysis: Analysis, present: number, chosen: (mode: number) => void): HTMLElement {
  const omega2 = (analysis.fields.omega2 ?? []) as number[];
  const loads = (analysis.fields.loads ?? []) as number[];
  const head = loads.length > 0    ? ["shape", "load"]
               : omega2.length > 0 ? ["mode", "omega² [1/s²]", "frequency [Hz]"]
                                   : ["mode"];
  const rows = analysis.shapes.map((_, k) => {
    const squared = omega2[k];
    const frequency = squared === undefined ? "" : squared >= 0 ? short(Math.sqrt(squared) / (2 * Math.PI)) : "grows";
    const cells = loads.length > 0 ? [String(k + 1), show(loads[k])] : [String(k + 1), show(squared), frequency];
    const row = make("tr", { tabindex: "0", class: k === present ? "chosen" : "" },
                     ...cells.slice(0, head.length).map((c) => make("td", {}, c)));
    row.addEventListener("click", () => chosen(k));
    row.addEventListener("keydown", (event) => event.key === "Enter" && chosen(k));
    return row;
  });
  return make("div", { class: "scroll" },
              make("table", {}, make("tr", {}, ...head.map((h) => make("th", {}, h))), ...rows));
}

/** What the analysis measured, with derivatives by parameters where they were asked for. */
function measureTable(measures: Measure[], goToTime: (t: number) => void): HTMLElement[] {
  if (measures.length === 0) return [];
  const parameters = [...new Set(measures.flatMap((measure) => Object.keys(measure.gradient ?? {})))];
  const timed = measures.some((measure) => measure.t !== undefined);
  const head = ["measure", "value", ...(timed ? ["t [s]"] : []), ...parameters.map((name) => `d/d(${name})`)];
  const rows = measures.map((measure) => {
    const cells = [measure.name, `${show(measure.value)} ${measure.unit === "1" ? "" : measure.unit}`,
                   ...(timed ? [show(measure.t)] : []), ...parameters.map((name) => show(measure.gradient?.[name]))];
    const row = make("tr", { tabindex: "0" }, ...cells.map((cell) => make("td", {}, cell)));
    const go = () => measure.t !== undefined && goToTime(measure.t);
    row.addEventListener("click", go);
    row.addEventListener("keydown", (event) => event.key === "Enter" && go());
    return row;
  });
  return [make("h2", {}, "measures"),
          make("div", { class: "scroll" },
               make("table", {}, make("tr", {}, ...head.map((h) => make("th", {}, h))), ...rows))];
}

export interface ReportActions {
  showAnalysis(number: number): void;
  showShape(shape: number): void;
  goToRow(row: number): void;
  goToTime(t: number): void;
}

function parameters(data: PageData, analysis: Analysis): HTMLElement[] {
  const names = Object.entries({ ...data.parameters, ...analysis.set });
  if (names.length === 0) return [];
  const list = make("dl");
  for (const [name, value] of names.slice(0, 100)) list.append(make("dt", {}, name), make("dd", {}, show(value)));
  return [make("h2", {}, "parameters"), list];
}

/** All analyses of the run, how they ended and what was said of them. */
function analysisList(data: PageData, present: Analysis, chosen: (number: number) => void): HTMLElement[] {
  if (data.analyses.length < 2) return [];
  const rows = data.analyses.map((analysis, k) => {
    const warnings = analysis.warnings.length;
    const cells = [`${k + 1} ${analysis.type}`, analysis.status, warnings > 0 ? `${warnings} warnings` : ""];
    const row = make("tr", { tabindex: "0", class: analysis === present ? "chosen" : "" },
                     ...cells.map((c) => make("td", {}, c)));
    row.addEventListener("click", () => chosen(k));
    row.addEventListener("keydown", (event) => event.key === "Enter" && chosen(k));
    return row;
  });
  return [make("h2", {}, "analyses"), make("div", { class: "scroll" }, make("table", {}, ...rows))];
}

export function reportPanel(data: PageData, motion: Motion, actions: ReportActions): HTMLElement {
  const { analysis, names, shape } = motion;
  const root = make("div");
  const facts = make("dl");
  const fact = (name: string, value: unknown) => facts.append(make("dt", {}, name), make("dd", {}, show(value)));
  if (analysis.message) root.append(make("p", { class: analysis.status === "ok" ? "" : "warning" }, analysis.message));
  for (const warning of analysis.warnings) root.append(make("p", { class: "warning" }, `⚠ ${warning}`));
  fact("status", analysis.status);
  fact("bodies, elements", `${names.bodies.length}, ${names.elements.name.length}`);
  fact("gravity [m/s²]", `${short(data.gravity[0])}, ${short(data.gravity[1])}`);
  if (analysis.dof !== undefined) fact("degrees of freedom", analysis.dof);
  if (analysis.mobility !== undefined) fact("without drivers", analysis.mobility);
  if (analysis.redundant.length > 0) fact("redundant", analysis.redundant);
  const tables: HTMLElement[] = [];
  for (const [name, value] of Object.entries(analysis.fields)) {
    if (isRecords(value)) {
      tables.push(make("h2", {}, name), recordTable(value, (record) => {
        if (typeof record.row === "number") actions.goToRow(record.row);
        else if (typeof record.t === "number") actions.goToTime(record.t);
      }));
    } else {
      fact(name.replace(/_/g, " "), value);
    }
  }
  fact("computed in", `${short(analysis.seconds)} s`);
  root.append(facts);
  if (analysis.shapes.length > 0) {
    root.append(make("h2", {}, analysis.type === "equilibrium" ? "softest mode" : "shapes"),
                modeTable(analysis, shape, (k) => actions.showShape(k)));
  }
  root.append(...measureTable(analysis.measures, (t) => actions.goToTime(t)), ...tables, ...analysisList(data, analysis, (k) => actions.showAnalysis(k)),
              ...parameters(data, analysis));
  if (data.description) root.append(make("h2", {}, "scene"), make("p", {}, data.description));
  for (const note of data.notes) root.append(make("p", { class: "note" }, note));
  root.append(make("p", { class: "note" }, `catena ${data.version}`));
  return root;
}
