// The page as a whole: which analysis is shown, what happens at keys and buttons.

import { Choice } from "./choice";
import { Analysis, Design, PageData } from "./contract";
import { button, byId, make, setIcon } from "./dom";
import { entriesOf, Entry, posedOf } from "./entries";
import { listenToKeys } from "./keys";
import { marksOf, unstableRows } from "./marks";
import { Motion } from "./motion";
import { PlotPanel } from "./plot_panel";
import { Player } from "./player";
import { pointPanel } from "./point_panel";
import { reportPanel } from "./report_panel";
import { Stage } from "./stage";
import { drawScaleBar, makeStageTools } from "./stage_tools";
import { Table } from "./table";
import { tablePanel } from "./table_panel";
import { Theme } from "./theme";
import { short } from "./ticks";
import { pointsOf, Trace } from "./traces";
import { Units } from "./units";

type Tab = "plots" | "report" | "table" | "points";
const tabs: Tab[] = ["plots", "report", "table", "points"];

export class Page {
  motion!: Motion;
  table!: Table;
  readonly entries: Entry[];
  entry!: Entry;
  /** The row of the design that is shown, where the poses are those of a design. */
  designRow = -1;
  /** Rows that belong to the poses shown: the table, unless the poses are those of a design. */
  poseTable!: Table;
  readonly stage: Stage;
  readonly player: Player;
  readonly plots: PlotPanel;
  private readonly plotRoot = make("div");
  private readonly panel = byId("panel");
  private tab: Tab = "plots";
  private waiting = false;
  readonly choice: Choice;

  constructor(readonly data: PageData) {
    const theme = new Theme(matchMedia("(prefers-color-scheme: dark)").matches);
    document.documentElement.dataset.theme = theme.dark ? "dark" : "light";
    document.title = `${data.scene} – catena`;
    byId("scene-name").textContent = data.scene;
    this.stage = new Stage(theme, () => this.redraw(), (shape, x, y) => this.choice.pointAt(shape, x, y),
                           (shape) => this.choice.choose(shape));
    this.choice = new Choice(this);
    this.player = new Player(() => this.redraw());
    this.plots = new PlotPanel(this.plotRoot, theme, (row) => this.goToRow(row), (by) => this.stepDesign(by));
    this.entries = entriesOf(data);
    this.makeChoices();
    listenToKeys(this);
    setIcon(byId("theme"), "theme");
    byId("theme").addEventListener("click", () => this.toggleTheme());
    addEventListener("resize", () => (this.stage.fit(), this.plots.draw()));
    this.showAnalysis(this.firstAnalysis());
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches || location.hash.includes("paused");
    if (!still) this.player.play();
  }

  /** The last one that goes through poses, else the last with shapes to swing in, else the last. */
  private firstAnalysis(): number {
    const { analyses } = this.data;
    const last = (fits: (analysis: Analysis) => boolean) =>
      analyses.map((analysis) => fits(this.entryOf(analysis).moving)).lastIndexOf(true);
    const moving = last(({ poses, shapes }) => poses.count > (shapes.length > 0 ? 2 : 1));
    const swinging = last(({ shapes }) => shapes.length > 0);
    return moving >= 0 ? moving : swinging >= 0 ? swinging : analyses.length - 1;
  }

  private entryOf(analysis: Analysis | undefined): Entry {
    return this.entries.find((entry) => entry.analysis === analysis) ?? this.entries[0];
  }

  private makeChoices(): void {
    const choice = byId<HTMLSelectElement>("analysis");
    this.entries.forEach(({ label }, k) => choice.append(new Option(label, String(k))));
    choice.addEventListener("change", () => this.showEntry(this.entries[Number(choice.value)]));
    for (const tab of tabs) {
      const element = button(tab, tab, () => this.showTab(tab));
      element.setAttribute("role", "tab");
      byId("tabs").append(element);
    }
  }

  /** An analysis of the run, by its number from 0. */
  showAnalysis(number: number): void {
    this.showEntry(this.entryOf(this.data.analyses[number]));
  }

  showEntry(entry: Entry): void {
    const { analysis } = entry;
    this.entry = entry;
    byId<HTMLSelectElement>("analysis").value = String(this.entries.indexOf(entry));
    this.table = new Table(analysis, new Units(this.data.units));
    this.choice.clear();
    this.designRow = analysis.designs?.find(({ analyses }) => analyses.includes(entry.moving))?.row ?? -1;
    this.showMotion(entry.moving);
    this.stage.traces = this.firstTraces();
    const bad = analysis.status !== "ok";
    byId("status").textContent = bad ? `${analysis.status}: ${analysis.message}` : analysis.status;
    byId("status").title = analysis.message;
    byId("status").className = bad ? "bad" : "";
    this.plots.show(this.table, this.isOwnMotion ? marksOf(this.motion) : [], unstableRows(analysis, this.table));
    // A single row is no line, but what the analysis says of it is worth reading.
    this.showTab(this.table.rows < 2 && this.tab === "plots" ? "report" : this.tab);
    this.stage.fit();
  }

  /** Puts the mechanism of an analysis on the stage. */
  private showMotion(analysis: Analysis): void {
    const { behind } = this.entry;
    const designs = behind ? [] : this.entry.analysis.designs ?? [];
    const others = designs.map(posedOf).filter((posed): posed is Analysis => posed !== null);
    this.motion = new Motion(this.data, analysis);
    this.poseTable = this.isOwnMotion ? this.table : new Table(analysis, this.motion.units);
    this.stage.show(this.motion, behind && { name: behind.name, motion: new Motion(this.data, behind.analysis) },
                    others.map((other) => new Motion(this.data, other)));
    makeStageTools(this);
    this.player.show(this.motion);
    this.makeMarks();
  }

  /** Whether the poses are those of the rows, not of a design. */
  private get isOwnMotion(): boolean {
    return this.motion.analysis === this.entry.analysis;
  }

  /** The designs of a sweep whose mechanism can be seen. */
  private get seenDesigns(): Design[] {
    return (this.entry.analysis.designs ?? []).filter((design) => design.row !== undefined && posedOf(design));
  }

  /** To the next design that can be seen, or the one before; to the last or the first by infinity. */
  private stepDesign(by: number): void {
    const rows = this.seenDesigns.map(({ row }) => row ?? 0);
    if (rows.length === 0) return;
    const next = rows.indexOf(this.designRow) + by;
    this.goToRow(rows[Math.min(rows.length - 1, Math.max(0, next))]);
  }

  /** The design of this row of a sweep; the nearest one where not all are there. */
  private showDesign(row: number): void {
    const seen = this.seenDesigns;
    const away = (of: number | undefined) => Math.abs((of ?? Infinity) - row);
    const nearest = seen.reduce((a, b) => (away(b.row) < away(a.row) ? b : a), seen[0]);
    const moving = nearest && posedOf(nearest);
    if (!moving) return;
    const { playing } = this.player;
    const { timed, end } = this.motion;
    const { clock } = this.player;
    this.designRow = nearest.row ?? -1;
    this.showMotion(moving);
    if (this.motion.timed === timed && this.motion.end === end) this.player.moveTo(clock);
    if (playing) this.player.play();
  }

  /** What is said on the stage of the design that is shown. */
  get designName(): string {
    const { designs } = this.entry.analysis;
    const shown = designs?.find(({ analyses }) => analyses.includes(this.motion.analysis));
    if (!shown || this.entry.behind) return shown?.name ?? "";
    const values = Object.entries(shown.values).slice(0, 4).map(([name, value]) => `${name} = ${short(value)}`);
    return [`${shown.name} of ${this.table.rows}`, ...values].join(", ");
  }

  /** Points that are outputs of any analysis, body.point.x among its columns, are traced from the start. */
  private firstTraces(): Trace[] {
    const all = this.entries.flatMap(({ analysis, moving }) => [...analysis.columns, ...moving.columns]);
    const names = new Set(all.map((column) => column.name));
    return pointsOf(this.motion).filter((point) => names.has(`${point.name}.x`) && names.has(`${point.name}.y`)).slice(0, 3);
  }

  private makeMarks(): void {
    const { begin, end } = this.motion;
    byId("marks").replaceChildren(...(this.motion.count > 1 ? marksOf(this.motion) : []).slice(0, 200).map((mark) => {
      const clock = mark.t ?? this.motion.clockOfRow(mark.row);
      const when = mark.t === undefined ? `row ${mark.row}` : `t = ${this.motion.units.text(mark.t, "s")}`;
      const title = `${mark.label} at ${when}`;
      const element = button("", title, () => (this.player.pause(), this.player.moveTo(clock)));
      element.style.left = `${end > begin ? (100 * (clock - begin)) / (end - begin) : 0}%`;
      return element;
    }));
  }

  goToRow(row: number): void {
    if (!this.isOwnMotion) {
      this.showDesign(row);
      this.redraw();
      return;
    }
    this.player.pause();
    this.motion.shape = this.motion.count > 1 ? -1 : this.motion.shape;
    this.player.moveTo(this.motion.clockOfRow(row));
  }

  showShape(shape: number): void {
    this.motion.shape = shape;
    this.player.show(this.motion);
    this.player.play();
    this.showTab("report");
  }

  showTab(tab: Tab): void {
    this.tab = tab;
    for (const [k, element] of [...byId("tabs").children].entries())
      element.setAttribute("aria-selected", String(tabs[k] === tab));
    const { analysis } = this.entry;
    if (tab === "plots") this.panel.replaceChildren(this.plotRoot);
    if (tab === "table") this.panel.replaceChildren(tablePanel(this.table, analysis.type, (row) => this.goToRow(row)));
    if (tab === "points") this.panel.replaceChildren(pointPanel(this, pointsOf(this.motion)));
    if (tab === "report") {
      this.panel.replaceChildren(reportPanel(this.data, this.entry.analysis, this.motion, {
        showAnalysis: (number) => this.showAnalysis(number),
        showShape: (shape) => this.showShape(shape),
        goToRow: (row) => this.goToRow(row),
        goToTime: (t) => (this.player.pause(), this.player.moveTo(t)),
      }));
    }
    this.plots.draw();
  }

  toggleTheme(): void {
    const theme = new Theme(!this.stage.theme.dark);
    document.documentElement.dataset.theme = theme.dark ? "dark" : "light";
    this.stage.setTheme(theme);
    this.plots.theme = theme;
    makeStageTools(this);
    this.plots.draw();
    this.redraw();
  }

  /** Once before the browser shows the next picture, however often something changes. */
  redraw(): void {
    if (this.waiting || !this.motion) return;
    this.waiting = true;
    requestAnimationFrame(() => this.draw());
  }

  draw(): void {
    this.waiting = false;
    this.stage.draw(this.player.clock);
    const row = this.motion.rowNumber(this.motion.nearestPose(this.player.clock));
    this.plots.moveCursor(this.isOwnMotion ? row : this.designRow);
    drawScaleBar(this.stage.camera.scale, this.motion.units);
  }
}
