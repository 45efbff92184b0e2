// The tab with what the analysis says of itself: outcome, warnings, named results, lists of modes and critical points.

import { Analysis, Design, FieldRecord, Measure, PageData } from "./contract";
import { DataRow, dataTable } from "./data_table";
import { make } from "./dom";
import { Motion } from "./motion";
import { short } from "./ticks";
import { Units } from "./units";

const mostRecords = 200;

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

/** Rows of named members. Those that the page knows to be instants are marked so: they are in SI. */
function recordTable(records: FieldRecord[], chosen: (record: FieldRecord) => void): HTMLElement {
  const keys = [...new Set(records.flatMap((record) => Object.keys(record)))];
  const rows = records.slice(0, mostRecords)
      .map((record) => ({ cells: keys.map((key) => show(record[key])), action: () => chosen(record) }));
  return dataTable(keys.map((key) => (key === "t" ? "t [s]" : key)), rows);
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
    return { cells: cells.slice(0, head.length), chosen: k === present, action: () => chosen(k) };
  });
  return dataTable(head, rows);
}

/** What the analysis measured, with derivatives by parameters where they were asked for. */
function measureTable(measures: Measure[], units: Units, goToTime: (t: number) => void): HTMLElement[] {
  if (measures.length === 0) return [];
  const parameters = [...new Set(measures.flatMap((measure) => Object.keys(measure.gradient ?? {})))];
  const timed = measures.some((measure) => measure.t !== undefined);
  const seconds = units.of("s");
  const head = ["measure", "value", ...(timed ? [`t [${seconds.unit}]`] : []), ...parameters.map((name) => `d/d(${name})`)];
  const rows = measures.map(({ name, value, unit, t, gradient }) => {
    // Derivatives are by parameters in SI.
    const slope = (parameter: string) => {
      const derivative = gradient?.[parameter];
      return typeof derivative === "number" ? short(units.of(unit).factor * derivative) : show(derivative);
    };
    const cells = [name, value === null ? show(value) : units.text(value, unit),
                   ...(timed ? [t === undefined ? show(t) : short(seconds.factor * t)] : []), ...parameters.map(slope)];
    return { cells, action: t === undefined ? undefined : () => goToTime(t) };
  });
  return [make("h2", {}, "measures"), dataTable(head, rows)];
}

/** Parameters and measures of the start and of what was found, side by side. */
function comparison(designs: Design[], units: Units): HTMLElement[] {
  if (designs.length < 2) return [];
  const measures = (design: Design) => design.analyses.flatMap((analysis) => analysis.measures);
  const rows: DataRow[] = Object.keys(designs[0].values)
      .map((name) => ({ cells: [name, ...designs.map(({ values }) => show(values[name]))] }));
  for (const { name, unit } of measures(designs[designs.length - 1])) {
    const value = (design: Design) => measures(design).find((measure) => measure.name === name)?.value ?? null;
    const cells = designs.map(value).map((number) => (number === null ? "–" : units.text(number, unit)));
    rows.push({ cells: [name, ...cells] });
  }
  const outcomes = designs.map(({ analyses }) => analyses.find(({ status }) => status !== "ok")?.status ?? "ok");
  if (outcomes.some((outcome) => outcome !== "ok")) rows.push({ cells: ["status", ...outcomes] });
  return [make("h2", {}, "before and after"), dataTable(["", ...designs.map(({ name }) => name)], rows)];
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
  return [make("h2", {}, "parameters, SI"), list];
}

/** All analyses of the run, how they ended and what was said of them. */
function analysisList(data: PageData, present: Analysis, chosen: (number: number) => void): HTMLElement[] {
  if (data.analyses.length < 2) return [];
  const rows = data.analyses.map((analysis, k) => {
    const warnings = analysis.warnings.length;
    const cells = [`${k + 1} ${analysis.type}`, analysis.status, warnings > 0 ? `${warnings} warnings` : ""];
    return { cells, chosen: analysis === present, action: () => chosen(k) };
  });
  return [make("h2", {}, "analyses"), dataTable([], rows)];
}

export function reportPanel(data: PageData, analysis: Analysis, motion: Motion, actions: ReportActions): HTMLElement {
  const { names, shape, units } = motion;
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
      fact(name === "energy" ? "energy [J]" : name.replace(/_/g, " "), value);
    }
  }
  if (analysis.seconds > 0) fact("computed in", `${short(analysis.seconds)} s`);
  root.append(facts);
  if (analysis.shapes.length > 0) {
    root.append(make("h2", {}, analysis.type === "equilibrium" ? "softest mode" : "shapes"),
                modeTable(analysis, shape, (k) => actions.showShape(k)));
  }
  root.append(...measureTable(analysis.measures, units, (t) => actions.goToTime(t)));
  if (analysis.type === "optimise") root.append(...comparison(analysis.designs ?? [], units));
  root.append(...tables, ...analysisList(data, analysis, (k) => actions.showAnalysis(k)),
              ...parameters(data, analysis));
  if (units.any)
    root.append(make("p", { class: "note" }, "Plots, tables and measures are in the units asked for; other named results are in SI."));
  if (data.description) root.append(make("h2", {}, "scene"), make("p", {}, data.description));
  for (const note of data.notes) root.append(make("p", { class: "note" }, note));
  root.append(make("p", { class: "note" }, `catena ${data.version}`));
  return root;
}
