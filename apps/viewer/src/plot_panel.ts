// The tab with the plots: which columns, zoom, files.

import { columnChooser, mostListed } from "./column_chooser";
import { button, make } from "./dom";
import { save, saveCanvas } from "./files";
import { listenToPointers } from "./gestures";
import { SvgPainter } from "./painter";
import { ParallelPlot } from "./parallel_plot";
import { Plot, PlotMark } from "./plot";
import { PlotPicture } from "./plot_picture";
import { rowNumber, Table } from "./table";
import { css, Theme } from "./theme";

interface View {
  plot: Plot;
  picture: PlotPicture;
  canvas: HTMLCanvasElement;
  legend: HTMLElement;
}

export class PlotPanel {
  private views: View[] = [];
  private table!: Table;
  private marks: PlotMark[] = [];
  private unstable: boolean[] | null = null;
  private cursor = -1;
  private parallel: PlotPicture | null = null;

  constructor(private readonly root: HTMLElement, public theme: Theme,
              private readonly chosen: (row: number) => void, private readonly stepDesign: (by: number) => void) {}

  show(table: Table, marks: PlotMark[], unstable: boolean[] | null): void {
    this.table = table;
    this.marks = marks;
    this.unstable = unstable;
    this.views = [];
    this.parallel = null;
    this.root.replaceChildren();
    if (table.names.length === 0 || table.rows === 0) {
      this.root.append(make("p", { class: "note" }, "This analysis has no rows to plot."));
      return;
    }
    const adder = button("+ plot", "add a plot", () => this.add(this.usualX, table.numeric(2).slice(-1), true));
    this.root.append(make("div", {}, adder));
    if (table.analysis.type === "sweep") this.parallel = this.addParallel();
    for (const { x, ys } of this.firstPlots()) this.add(x, ys, false);
  }

  private addParallel(): PlotPicture | null {
    const plot = new ParallelPlot(this.table);
    if (!plot.worthwhile) return null;
    const what = "parallel coordinates; arrow keys go from design to design";
    const canvas = make("canvas", { tabindex: "0", role: "img", "aria-label": what });
    canvas.addEventListener("click", (event) => {
      const box = canvas.getBoundingClientRect();
      this.chosen(this.table.numberOf(plot.rowNear(event.clientX - box.left, event.clientY - box.top)));
    });
    const steps: Record<string, number> = {
      ArrowLeft: -1, ArrowUp: -1, ArrowRight: 1, ArrowDown: 1, Home: -Infinity, End: Infinity,
    };
    canvas.addEventListener("keydown", (event) => {
      if (steps[event.key] === undefined || event.altKey || event.ctrlKey || event.metaKey) return;
      this.stepDesign(steps[event.key]);
      event.stopPropagation();
      event.preventDefault();
    });
    this.root.append(make("div", { class: "plot" }, canvas));
    return new PlotPicture(plot, canvas);
  }

  /** Over what columns are shown unless their reader wants something else. */
  private get usualX(): number {
    if (this.table.analysis.type === "optimise") return rowNumber;
    return this.table.analysis.type === "sweep" && this.table.numeric(2).length > 1 ? 1 : 0;
  }

  /** Columns of one unit together, at most three plots; of a path the load over the first displacement; of an
   * optimisation its objective, then the variables; of a sweep each measure over the first parameter. */
  private firstPlots(): { x: number; ys: number[] }[] {
    const { table, usualX } = this;
    const { type } = table.analysis;
    if (type === "path" && table.names.length > 1) return [{ x: 1, ys: [0] }];
    if (table.rows === 1) return [];
    const numeric = table.numeric(mostListed);
    if (type === "optimise") {
      const objective = table.find("objective");
      return [{ x: usualX, ys: [objective] }, { x: usualX, ys: numeric.filter((c) => c < objective).slice(0, 6) }];
    }
    if (type === "sweep") {
      const parameters = Object.keys(table.analysis.designs?.[0]?.values ?? {}).length || 1;
      const measures = numeric.filter((c) => c > parameters).slice(0, 3);
      if (measures.length > 0) return measures.map((c) => ({ x: usualX, ys: [c] }));
    }
    const groups = new Map<string, number[]>();
    for (const c of numeric.slice(1)) {
      const list = groups.get(table.unit(c)) ?? [];
      if (list.length < 6) list.push(c);
      groups.set(table.unit(c), list);
    }
    const plots = [...groups.values()].slice(0, 3).map((ys) => ({ x: 0, ys }));
    return plots.length > 0 ? plots : [{ x: 0, ys: [0] }];
  }

  /** A plot of the columns of one body or element, in front of the others. */
  showColumnsOf(name: string): void {
    const ys = this.table.names.map((column, k) => (column.startsWith(name + ".") ? k : -1))
        .filter((k) => k > 0 && this.table.hasNumbers(k));
    if (ys.length === 0 || this.table.rows < 2) return;
    this.add(this.usualX, ys.slice(0, 6), true);
  }

  private add(x: number, ys: number[], first: boolean): void {
    const plot = new Plot(this.table, x, ys, this.marks, this.unstable);
    plot.scatter = this.isScattered(x);
    const canvas = make("canvas", { tabindex: "0", role: "img", "aria-label": "plot" });
    const view: View = { plot, picture: new PlotPicture(plot, canvas), canvas,
                         legend: make("div", { class: "legend" }) };
    const box = make("div", { class: "plot" });
    box.append(view.legend, view.canvas, this.tools(view, box));
    this.listen(view);
    if (first && this.views.length > 0) {
      this.root.children[0].after(box);
      this.views.unshift(view);
    } else {
      this.root.append(box);
      this.views.push(view);
    }
    this.drawView(view);
  }

  /** Rows of analyses the page does not know, and of sweeps, need not follow each other along x. */
  private isScattered(x: number): boolean {
    if (this.table.analysis.type !== "sweep" && this.table.analysis.type !== "modes") return false;
    return x <= 0 || this.table.rows > 2;
  }

  private tools(view: View, box: HTMLElement): HTMLElement {
    const { plot } = view;
    const x = make("select", { title: "horizontal axis", "aria-label": "horizontal axis" });
    for (const k of [...this.table.numeric(mostListed), rowNumber]) x.append(new Option(this.table.name(k), String(k)));
    x.value = String(plot.x);
    x.addEventListener("change", () => {
      plot.x = Number(x.value);
      plot.resetZoom();
      this.drawView(view);
    });
    const toggle = (label: string, title: string, change: () => boolean) => {
      const element = button(label, title, () => {
        element.setAttribute("aria-pressed", String(change()));
        plot.resetZoom();
        this.drawView(view);
      });
      element.setAttribute("aria-pressed", "false");
      return element;
    };
    const name = () => {
      const columns = plot.ys.slice(0, 3).map((y) => this.table.names[y]);
      return (columns.join("-") || "plot").replace(/[^\w.-]+/g, "_");
    };
    const columns = button("columns", "which columns", () => {
      const open = box.querySelector(".chooser");
      if (open) open.remove();
      else box.append(columnChooser(plot, () => (plot.resetZoom(), this.drawView(view))));
    });
    return make("div", { class: "tools" }, x, columns,
                toggle("log x", "logarithmic horizontal axis", () => (plot.logX = !plot.logX)),
                toggle("log y", "logarithmic vertical axis", () => (plot.logY = !plot.logY)),
                button("⤢", "show all (double click)", () => (plot.resetZoom(), this.drawView(view))),
                button("CSV", "save these columns as CSV",
                       () => save(`${name()}.csv`, this.table.csv([...new Set([plot.x, ...plot.ys])]), "text/csv")),
                button("PNG", "save as PNG", () => saveCanvas(`${name()}.png`, view.picture.onPaper(this.theme, this.cursor))),
                button("SVG", "save as SVG", () => save(`${name()}.svg`, this.svg(plot), "image/svg+xml")),
                button("✕", "remove this plot", () => {
                  this.views = this.views.filter((other) => other !== view);
                  box.remove();
                }));
  }

  private listen(view: View): void {
    const { plot, canvas } = view;
    const changed = () => this.drawView(view);
    const reset = () => (plot.resetZoom(), changed());
    const zoom = (factor: number, x: number, y: number) => (plot.zoom(factor, x, y), changed());
    const pan = (dx: number, dy: number) => (plot.pan(dx, dy), changed());
    listenToPointers(canvas, {
      zoom, pan, reset,
      click: (x, y) => {
        const row = plot.rowNear(x, y);
        if (row >= 0) this.chosen(this.table.numberOf(row));
      },
    });
    const step = 30;
    const keys: Record<string, () => void> = {
      "+": () => zoom(1.3, plot.width / 2, plot.height / 2),
      "-": () => zoom(1 / 1.3, plot.width / 2, plot.height / 2),
      "f": reset,
    };
    const withAlt: Record<string, () => void> = {
      ArrowLeft: () => pan(step, 0), ArrowRight: () => pan(-step, 0),
      ArrowUp: () => pan(0, step), ArrowDown: () => pan(0, -step),
    };
    canvas.addEventListener("keydown", (event) => {
      const action = (event.altKey ? withAlt : keys)[event.key];
      if (!action || event.ctrlKey || event.metaKey) return;
      action();
      event.stopPropagation();
      event.preventDefault();
    });
  }

  /** The cursor stands at this row of the analysis. */
  moveCursor(row: number): void {
    const kept = this.table && row >= 0 ? this.table.rowAt(row) : -1;
    if (kept === this.cursor) return;
    this.cursor = kept;
    for (const view of this.views) view.picture.showCursor(this.theme, kept), this.showLegend(view);
    this.parallel?.showCursor(this.theme, kept);
  }

  draw(): void {
    for (const view of this.views) this.drawView(view);
    this.parallel?.draw(this.theme, this.cursor);
  }

  private drawView(view: View): void {
    view.picture.draw(this.theme, this.cursor);
    this.showLegend(view);
  }

  private showLegend({ plot, legend }: View): void {
    legend.replaceChildren(...plot.legend(this.cursor).map((entry, k) => {
      const mark = make("i");
      mark.style.background = this.theme.line(k);
      const shown = entry.unit ? `${entry.name} = ${entry.value} ${entry.unit}` : `${entry.name} = ${entry.value}`;
      return make("span", {}, mark, shown);
    }));
  }

  private svg(plot: Plot): string {
    const painter = new SvgPainter(Math.round(plot.width), plot.height, css(this.theme.paper));
    plot.draw(painter, this.theme);
    plot.drawCursor(painter, this.theme, this.cursor);
    return painter.finish();
  }
}
