// Units other than those of the SI, and arrows of many bodies.

import { check, equal, makePage, near, outputFolder, scene, settle, test, writeScene } from "./page_test.mjs";

const plain = makePage(scene("crank_rocker"), "plain");
const made = makePage(scene("crank_rocker"), "units", "--units", "angle=deg, length=mm,time=ms");
equal(made.exit, 0, `catena view --units: ${made.said}`);
const count = 700;
const many = makePage(writeScene("many", {
  catena: 1, name: "many", gravity: [0, -9.81],
  replicate: [{ count, bodies: { "b{k}": { mass: 1, inertia: 1, position: ["=k", 0], velocity: ["=k/700", 1] } } }],
  analyses: [{ type: "dynamics", until: 1, every: 0.25 }],
}), "many");

await test({ reducedMotion: true }, async (page) => {
  const values = {};
  for (const [name, { page: file }] of [["plain", plain], ["made", made]]) {
    await page.open(file);
    const kinematics = "catena.data.analyses.findIndex((analysis) => analysis.type === 'kinematics')";
    await page.run(`catena.showAnalysis(${kinematics}); catena.goToRow(20)`);
    await settle(page);
    values[name] = await page.run(`
      const { table, motion } = catena;
      const at = (column) => table.values(table.find(column))[20];
      return { t: at("t"), angle: at("rocker.angle"), pen: at("coupler.pen.x"), clock: catena.player.clock,
               csv: table.csv([0, table.find("rocker.angle")]).split("\\r\\n")[21] };`);
  }
  const { plain: si, made: shown } = values;
  near(shown.t, 1000 * si.t, 1e-9, "t in ms");
  near(shown.angle, (si.angle * 180) / Math.PI, 1e-9, "the rocker's angle in degrees");
  near(shown.pen, 1000 * si.pen, 1e-9, "the pen in mm");
  near(shown.clock, si.clock, 1e-12, "the clock runs as ever");
  near(Number(shown.csv.split(",")[1]), (si.angle * 180) / Math.PI, 1e-9, "the angle in a saved file");
  const text = (id) => page.run(`return document.getElementById("${id}").innerText`);
  check(/^t = 174\.53 ms$/.test(await text("clock-text")), `the clock: ${await text("clock-text")}`);
  check(/ mm$/.test(await text("scale-bar")), `the bar of lengths: ${await text("scale-bar")}`);
  check((await text("stage-tools")).includes("mm/ms"), `the longest arrow: ${await text("stage-tools")}`);
  await page.run("catena.plots.showColumnsOf('coupler.pen')");
  const figures = await page.run("return catena.plots.views.map(({ plot }) => catena.plots.svg(plot)).join()");
  for (const said of ["t [ms]", "[deg]", "[mm]"]) check(figures.includes(said), `an axis with ${said}`);
  check(!figures.includes("[rad]") && !figures.includes("t [s]"), "no axis in SI");
  await page.run("catena.choice.step(1)");
  await settle(page);
  check(/centroid .* mm\s/.test(await text("hover")) && (await text("hover")).includes("deg"),
        `what is said of a body: ${await text("hover")}`);
  await page.screenshot(`${outputFolder}/units.png`);
  for (const tab of ["report", "table"]) {
    await page.run(`catena.showTab("${tab}")`);
    await settle(page);
    await page.screenshot(`${outputFolder}/units_${tab}.png`);
  }
  check((await text("panel")).includes("rocker.angle [deg]"), "the table's head");

  // More arrows than can be seen: those of the body that is chosen, all of them close by.
  await page.open(many.page);
  await page.run("catena.stage.shownArrows.add('velocities'); catena.redraw()");
  const arrows = () => page.run(`
    const svg = catena.stage.svg(catena.player.clock);
    const colour = getComputedStyle(document.querySelector(".swatch")).backgroundColor;
    const hex = "#" + colour.match(/\\d+/g).slice(0, 3).map((c) => Number(c).toString(16).padStart(2, "0")).join("");
    return svg.split('fill="' + hex + '"').length - 1;`);
  await settle(page);
  equal(await arrows(), 0, "arrows where they are too many");
  check((await text("stage-tools")).includes("many arrows"), "and why");
  await page.screenshot(`${outputFolder}/many.png`);
  await page.run("catena.choice.step(1); catena.choice.step(1)");
  equal(await arrows(), 1, "the arrow of what is chosen");
  await page.run("const { camera } = catena.stage; camera.zoom(12, camera.width / 2, camera.height / 2); catena.redraw()");
  await settle(page);
  const close = await arrows();
  check(close > 10 && close < 200, `arrows close by: ${close}`);
  check(!(await text("stage-tools")).includes("many arrows"), "nothing to be said close by");
});
