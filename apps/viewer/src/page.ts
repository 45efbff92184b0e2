// The page as a whole: which analysis is shown, what happens at keys and buttons.

import { Analysis, PageData } from "./contract";
import { button, byId, make, setIcon } from "./dom";
import { describe } from "./hover";
import { listenToKeys } from "./keys";
import { Highlight, nothing } from "./mechanism";
import { Motion } from "./motion";
import { PlotMark } from "./plot";
import { PlotPanel } from "./plot_panel";
import { Player } from "./player";
import { pointPanel } from "./point_panel";
import { reportPanel } from "./report_panel";
import { Stage, Trace } from "./stage";
import { drawScaleBar, makeStageTools } from "./stage_tools";
import { Table } from "./table";
import { tablePanel } from "./table_panel";
import { Theme } from "./theme";
import { short } from "./ticks";
import { unanalysed } from "./unanalysed";

type Tab = "plots" | "report" | "table" | "points";
const tabs: Tab[] = ["plots", "report", "table", "points"];

export class Page {
  motion!: Motion;
  table!: Table;
  readonly stage: Stage;
  readonly player: Player;
  readonly plots: PlotPanel;
  private readonly plotRoot = make("div");
  private readonly panel = byId("panel");
  private tab: Tab = "plots";
  private waiting = false;
  private selected: Highlight = nothing;

  constructor(readonly data: PageData) {
    const theme = new Theme(matchMedia("(prefers-color-scheme: dark)").matches);
    document.documentElement.dataset.theme = theme.dark ? "dark" : "light";
    document.title = `${data.scene} – catena`;
    byId("scene-name").textContent = data.scene;
    this.stage = new Stage(theme, () => this.redraw(), (shape, x, y) => this.hover(shape, x, y),
                           (shape) => this.select(shape < 0 ? nothing : this.stage.ownerOf(shape)));
    this.player = new Player(() => this.redraw());
    this.plots = new PlotPanel(this.plotRoot, theme, (row) => this.goToRow(row));
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
    const last = (fits: (analysis: Analysis) => boolean) => analyses.map(fits).lastIndexOf(true);
    const moving = last(({ poses, shapes }) => poses.count > (shapes.length > 0 ? 2 : 1));
    const swinging = last(({ shapes }) => shapes.length > 0);
    return moving >= 0 ? moving : swinging >= 0 ? swinging : analyses.length - 1;
  }

  private makeChoices(): void {
    const choice = byId<HTMLSelectElement>("analysis");
    this.data.analyses.forEach((analysis, k) => {
      const outcome = analysis.status === "ok" ? "" : `: ${analysis.status}`;
      choice.append(new Option(`${k + 1} ${analysis.type}${outcome}`, String(k)));
    });
    if (this.data.analyses.length === 0) choice.append(new Option("none: as given", "-1"));
    choice.addEventListener("change", () => this.showAnalysis(Number(choice.value)));
    for (const tab of tabs) {
      const element = button(tab, tab, () => this.showTab(tab));
      element.setAttribute("role", "tab");
      byId("tabs").append(element);
    }
  }

  showAnalysis(number: number): void {
    const analysis = this.data.analyses[number] ?? unanalysed();
    byId<HTMLSelectElement>("analysis").value = String(number);
    this.motion = new Motion(this.data, analysis);
    this.table = new Table(analysis);
    this.selected = nothing;
    this.stage.show(this.motion);
    this.stage.traces = this.firstTraces();
    makeStageTools(this);
    const bad = analysis.status !== "ok";
    byId("status").textContent = bad ? `${analysis.status}: ${analysis.message}` : analysis.status;
    byId("status").title = analysis.message;
    byId("status").className = bad ? "bad" : "";
    this.player.show(this.motion);
    this.makeMarks();
    this.plots.show(this.table, this.marks(), this.unstableRows());
    this.showTab(this.table.rows > 1 ? this.tab : this.motion.shapes.length > 0 ? "report" : this.tab);
    this.stage.fit();
  }

  /** Points that are outputs of any analysis, body.point.x among its columns, are traced from the start. */
  private firstTraces(): Trace[] {
    const names = new Set(this.data.analyses.flatMap((analysis) => analysis.columns.map((column) => column.name)));
    return this.allPoints().filter((point) => names.has(`${point.name}.x`) && names.has(`${point.name}.y`)).slice(0, 3);
  }

  private allPoints(): Trace[] {
    const { points, bodies } = this.motion.names;
    return points.body.map((body, k) => ({
      body, u: points.at[2 * k], v: points.at[2 * k + 1], name: `${bodies[body]}.${points.name[k]}`,
    }));
  }

  /** Events, singular instants, critical points: what happens at a row or an instant. */
  private marks(): (PlotMark & { t?: number })[] {
    const marks: (PlotMark & { t?: number })[] = [];
    for (const key of ["events", "singular", "critical"]) {
      const records = this.motion.analysis.fields[key];
      if (!Array.isArray(records)) continue;
      for (const record of records as Record<string, unknown>[]) {
        const t = typeof record.t === "number" ? record.t : undefined;
        const row = typeof record.row === "number" ? record.row : t === undefined ? 0 : this.rowAtTime(t);
        const words = [record.name, record.kind].filter((word) => typeof word === "string");
        marks.push({ row, t, label: words.join(" ").replace(/_/g, " ") || key });
      }
    }
    return marks;
  }

  private rowAtTime(t: number): number {
    return this.motion.timed ? this.motion.rowNumber(this.motion.poseAt(t)) : 0;
  }

  private makeMarks(): void {
    const { begin, end } = this.motion;
    byId("marks").replaceChildren(...(this.motion.count > 1 ? this.marks() : []).slice(0, 200).map((mark) => {
      const clock = mark.t ?? this.motion.clockOfRow(mark.row);
      const when = mark.t === undefined ? `row ${mark.row}` : `t = ${short(mark.t)} s`;
      const title = `${mark.label} at ${when}`;
      const element = button("", title, () => (this.player.pause(), this.player.moveTo(clock)));
      element.style.left = `${end > begin ? (100 * (clock - begin)) / (end - begin) : 0}%`;
      return element;
    }));
  }

  private unstableRows(): boolean[] | null {
    const negative = this.motion.analysis.fields.negative_modes;
    if (!Array.isArray(negative)) return null;
    return Array.from({ length: this.table.rows }, (_, k) => Number(negative[this.table.numberOf(k)] ?? 0) > 0);
  }

  goToRow(row: number): void {
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
    const { analysis } = this.motion;
    if (tab === "plots") this.panel.replaceChildren(this.plotRoot);
    if (tab === "table") this.panel.replaceChildren(tablePanel(this.table, analysis.type, (row) => this.goToRow(row)));
    if (tab === "points") this.panel.replaceChildren(pointPanel(this, this.allPoints()));
    if (tab === "report") {
      this.panel.replaceChildren(reportPanel(this.data, this.motion, {
        showAnalysis: (number) => this.showAnalysis(number),
        showShape: (shape) => this.showShape(shape),
        goToRow: (row) => this.goToRow(row),
        goToTime: (t) => (this.player.pause(), this.player.moveTo(t)),
      }));
    }
    this.plots.draw();
  }

  private hover(shape: number, x: number, y: number): void {
    const box = byId("hover");
    this.stage.lit = shape >= 0 ? this.stage.ownerOf(shape) : this.selected;
    box.hidden = shape < 0;
    if (shape >= 0) {
      const row = this.table.rowAt(this.motion.rowNumber(this.motion.nearestPose(this.player.clock)));
      box.replaceChildren(...describe(this.motion, this.table, row, this.stage.ownerOf(shape)));
      box.style.left = `${Math.min(x + 14, this.stage.camera.width - 200)}px`;
      box.style.top = `${Math.min(y + 14, this.stage.camera.height - 80)}px`;
    }
    this.redraw();
  }

  private select(owner: Highlight): void {
    this.selected = owner;
    this.stage.lit = owner;
    const { elements, bodies } = this.motion.names;
    const name = owner.element >= 0 ? elements.name[owner.element] : bodies[owner.body];
    if (name !== undefined) this.plots.showColumnsOf(name);
    this.redraw();
  }

  toggleTheme(): void {
    const theme = new Theme(!this.stage.theme.dark);
    document.documentElement.dataset.theme = theme.dark ? "dark" : "light";
    this.stage.setTheme(theme);
    this.plots.theme = theme;
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
    this.plots.moveCursor(this.motion.rowNumber(this.motion.nearestPose(this.player.clock)));
    drawScaleBar(this.stage.camera.scale);
  }
}
