// A four-bar's page against the results of the same scene: traces, plots, scrubbing, stepping, files, keys.

import { check, draw, equal, makePage, near, outputFolder, results, scene, settle, test } from "./page_test.mjs";

const path = scene("crank_rocker");
const made = makePage(path, "four_bar");
const run = results(path, "--outputs", "coupler.pen.x,coupler.pen.y,rocker.angle");
const kinematics = run.analyses.findIndex((analysis) => analysis.type === "kinematics");
const { columns, rows } = run.analyses[kinematics];
const circlesOf = (svg) => [...svg.matchAll(/<circle cx="([-0-9.]+)" cy="([-0-9.]+)"/g)]
    .map((found) => ({ x: Number(found[1]), y: Number(found[2]) }));
const column = (name) => rows.map((row) => row[columns.indexOf(name)]);

await test({ reducedMotion: true }, async (page) => {
  await page.open(made.page);
  await page.run(`catena.showAnalysis(${kinematics})`);
  await settle(page);
  equal(await page.run("return catena.player.playing"), false, "nothing moves where motion is to be reduced");

  // The path on the canvas: where the columns say that the pen is there must be ink of the path.
  const traces = await page.run("return catena.stage.traces.map((trace) => trace.name)");
  check(traces.includes("coupler.pen"), `the pen is traced: ${traces}`);
  const [xs, ys] = [column("coupler.pen.x"), column("coupler.pen.y")];
  const missed = await page.run(`
    const [xs, ys] = arguments;
    const { camera, canvas } = catena.stage;
    const context = canvas.getContext("2d");
    // The mechanism crosses the path: the path is drawn alone.
    context.clearRect(0, 0, canvas.width, canvas.height);
    const drawn = catena.stage.painter.draw;
    catena.stage.painter.draw = () => undefined;
    catena.stage.draw(0);
    const ratio = canvas.width / camera.width;
    const missed = xs.filter((x, k) => {
      const px = Math.round(ratio * ((x - camera.x) * camera.scale + camera.width / 2));
      const py = Math.round(ratio * (camera.height / 2 - (ys[k] - camera.y) * camera.scale));
      const { data } = context.getImageData(px - 1, py - 1, 3, 3);
      return !data.some((value, n) => n % 4 === 3 && value > 60);
    });
    catena.stage.painter.draw = drawn;
    return missed.length;`, xs, ys);
  equal(missed, 0, "places of the pen off its path by more than a pixel");

  // Poses: rows of the columns, by scrubbing and by steps.
  for (const row of [0, 7, Math.floor(rows.length / 2), rows.length - 1]) {
    await page.run(`catena.goToRow(${row})`);
    const [x, y] = await page.run(`
      const { pose } = catena.motion;
      const trace = catena.stage.traces.find((t) => t.name === "coupler.pen");
      catena.motion.moveTo(catena.player.clock, 0);
      return [pose.pointX(trace.body, trace.u, trace.v), pose.pointY(trace.body, trace.u, trace.v)];`);
    near(x, xs[row], 1e-6, `pen.x at row ${row}`);
    near(y, ys[row], 1e-6, `pen.y at row ${row}`);
  }
  await page.keys("\uE011");  // home
  await page.keys("\uE014\uE014\uE014");  // right
  near(await page.run("return catena.player.clock"), rows[3][0], 1e-12, "three steps");
  await page.run(`
    const bar = document.getElementById("clock");
    bar.value = 500;
    bar.dispatchEvent(new Event("input"));`);
  const middle = (rows[0][0] + rows.at(-1)[0]) / 2;
  near(await page.run("return catena.player.clock"), middle, 1e-9, "scrubbing to the middle");
  await page.keys(" ");
  equal(await page.run("return catena.player.playing"), true, "the space bar plays");
  await page.keys(" ");
  equal(await page.run("return catena.player.playing"), false, "and pauses");

  // The page and `catena draw` show the same picture: every circle at the same place but for scale and shift.
  const pose = rows[7][columns.indexOf("t")];
  await page.run("catena.goToRow(7)");
  const pagePicture = circlesOf(await page.run("return catena.stage.svg(catena.player.clock)"));
  const drawn = circlesOf(draw(path, "--at", String(pose), "--analysis", String(kinematics + 1)));
  // The page marks where traced points are as well.
  const marks = await page.run("return catena.stage.traces.length");
  equal(pagePicture.length - marks, drawn.length, "circles of the page and of catena draw");
  const far = drawn.length - 1;
  const scaleOf = (list) => Math.hypot(list[far].x - list[0].x, list[far].y - list[0].y);
  const scale = scaleOf(drawn) / scaleOf(pagePicture);
  drawn.forEach((circle, k) => {
    near(circle.x - drawn[0].x, scale * (pagePicture[k].x - pagePicture[0].x), 0.03, `x of circle ${k}`);
    near(circle.y - drawn[0].y, scale * (pagePicture[k].y - pagePicture[0].y), 0.03, `y of circle ${k}`);
  });

  // What goes into files.
  const csv = await page.run("return catena.table.csv(catena.table.names.map((_, k) => k))");
  const lines = csv.trim().split("\r\n");
  equal(lines.length, rows.length + 1, "lines of the CSV");
  const svg = await page.run("return catena.stage.svg(0)");
  check(svg.startsWith("<svg") && svg.endsWith("</svg>\n") && !svg.includes("NaN"), "the picture as SVG");
  const plotted = await page.run("return catena.plots.svg(catena.plots.views[0].plot)");
  check(plotted.includes("<path") && !plotted.includes("NaN"), "a plot as SVG");

  // The pointer: over the middle of the rocker its name and values come up.
  await page.run("catena.goToRow(0)");
  await settle(page);
  const at = await page.run(`
    const { camera, canvas } = catena.stage;
    const body = catena.data.bodies.indexOf("rocker");
    const box = canvas.getBoundingClientRect();
    const { q } = catena.motion.pose;
    return [box.left + camera.toPageX(q[3 * body]), box.top + camera.toPageY(q[3 * body + 1])];`);
  await page.point(...at);
  await settle(page);
  const said = await page.run("return document.getElementById('hover').innerText");
  check(said.includes("rocker") && said.includes("centroid"), `what is said of the rocker: ${said}`);
  const plots = await page.run("return catena.plots.views.length");
  await page.point(...at, true);
  equal(await page.run("return catena.plots.views.length"), plots + 1, "a click adds a plot of the rocker's columns");

  await page.keys("d");
  await settle(page);
  await page.screenshot(`${outputFolder}/four_bar_dark.png`);
  await page.keys("d");
  for (const tab of ["2", "3", "4", "1"]) {
    await page.keys(tab);
    await settle(page);
    await page.screenshot(`${outputFolder}/four_bar_tab${tab}.png`);
  }
});
