// Designs: an optimisation before and after, a sweep's design at a click.

import { check, equal, makePage, near, outputFolder, scene, settle, test, writeScene } from "./page_test.mjs";

// A bar on a pin whose end is held at a height: its angle is asin(height / length); short bars do not reach it.
const bar = {
  catena: 1, parameters: { length: 2, height: 1 },
  bodies: { bar: { mass: 1, rod: { from: [0, 0], to: ["length", 0] } } },
  constraints: [{ type: "revolute", name: "O", i: "ground", j: "bar.from" },
                { type: "absolute_y", i: "bar.to", value: "height" }],
};
const turned = { type: "kinematics", at: 0, measures: { turned: { final: "bar.angle" } } };
const lengths = Array.from({ length: 11 }, (_, k) => 0.8 + 0.2 * k);
const sweep = makePage(writeScene("sweep", {
  ...bar, name: "swept", analyses: [{ type: "sweep", over: { length: lengths, height: [1, 1.1] }, of: turned }],
}), "sweep");
equal(sweep.exit, 0, `sweep: ${sweep.said}`);
const found = makePage(scene("path_generation"), "path_generation");
equal(found.exit, 0, `path_generation: ${found.said}`);

await test({ reducedMotion: true }, async (page) => {
  await page.open(found.page);
  await settle(page);
  equal(await page.run("return catena.entries.map((entry) => entry.label).join()"),
        "1 optimise,1 start: kinematics,1 best: kinematics", "what can be chosen");
  equal(await page.run("return catena.stage.behind.name"), "start", "behind the best design is the start");
  const axes = await page.run("return catena.plots.views.map(({ plot }) => plot.table.name(plot.x)).join()");
  equal(axes, "iterate,iterate", "the history is over its iterates");

  // Both mechanisms stand where their parameters put them, at the same time.
  await page.run("catena.player.moveTo(1.5)");
  await settle(page);
  const drawn = await page.run(`
    const { designs } = catena.data.analyses[0];
    const { behind, drawing } = catena.stage;
    const of = (motion) => Array.from(motion.pose.q);
    return { best: of(catena.motion), start: of(behind.motion), values: designs.map(({ values }) => values) };`);
  for (const [name, q, { crank }] of [["start", drawn.start, drawn.values[0]], ["best", drawn.best, drawn.values[1]]]) {
    near(q[2], 1.5, 2e-3, `angle of the crank of ${name}`);
    check(crank > 0.2 && crank < 0.6, `crank of ${name}: ${crank}`);
  }
  near(drawn.values[1].crank, 0.4, 1e-3, "the crank that was sought");
  const ink = () => page.run(`
    catena.stage.draw(catena.player.clock);
    const { canvas } = catena.stage;
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let inked = 0;
    for (let k = 3; k < data.length; k += 4) if (data[k] > 0) ++inked;
    return inked;`);
  const both = await ink();
  await page.screenshot(`${outputFolder}/before_and_after.png`);
  await page.keys("b");
  check((await ink()) < both, "the key b leaves the other design out");
  equal(await page.run("return document.getElementById('behind').checked"), false, "and says so");
  await page.keys("b");
  check((await page.run("return catena.stage.svg(1.5)")).includes('<g opacity="0.35">'), "both are in the SVG");

  await page.run('catena.showTab("report")');
  await settle(page);
  const report = await page.run("return document.getElementById('panel').innerText");
  check(/before and after/.test(report) && /crank\s+0\.42\s+0\.4\b/.test(report), `both side by side: ${report}`);
  await page.screenshot(`${outputFolder}/optimise_report.png`);

  // The analyses of both designs, each with its rows and the other one behind.
  for (const [k, name, other] of [[1, "start", "best"], [2, "best", "start"]]) {
    await page.run(`catena.showEntry(catena.entries[${k}]); catena.showTab("plots"); catena.goToRow(3)`);
    await settle(page);
    equal(await page.run("return catena.stage.behind.name"), other, `behind ${name}`);
    const [x, column] = await page.run(`
      const { pose } = catena.motion;
      const { points } = catena.motion.names;
      const k = points.name.indexOf("pen");
      const x = catena.table.values(catena.table.find("coupler.pen.x"));
      return [pose.pointX(points.body[k], points.at[2 * k], points.at[2 * k + 1]), x[3]];`);
    near(x, column, 1e-5, `the pen of ${name} at row 3`);
  }
  await page.screenshot(`${outputFolder}/best.png`);

  // A sweep: the mechanism is that of the design whose row was chosen.
  await page.open(sweep.page);
  await settle(page);
  equal(await page.run("return catena.plots.views.map(({ plot }) => plot.table.name(plot.x)).join()"), "length",
        "measures are over the first parameter");
  for (const row of [20, 4, 13]) {
    await page.run(`catena.goToRow(${row})`);
    await settle(page);
    const length = lengths[Math.floor(row / 2)];
    const height = row % 2 === 0 ? 1 : 1.1;
    near(await page.run("return catena.motion.pose.q[2]"), Math.asin(height / length), 1e-5, `angle in row ${row}`);
    const said = await page.run("return document.getElementById('design').textContent");
    check(said.startsWith(`design ${row + 1} of 22, length = `), `what is said of row ${row}: ${said}`);
    equal(await page.run("return catena.plots.cursor"), row, `the cursor is at row ${row}`);
  }
  await page.screenshot(`${outputFolder}/sweep.png`);
  // By pointer, on the scatter.
  const [x, y] = await page.run(`
    const [{ plot, canvas }] = catena.plots.views;
    canvas.scrollIntoView();
    const box = canvas.getBoundingClientRect();
    const px = plot.pageX(plot.axisX, catena.table.values(plot.x)[16]);
    const py = plot.pageY(plot.axisY, catena.table.values(plot.ys[0])[16]);
    return [box.left + px, box.top + py];`);
  await page.point(x, y, true);
  await settle(page);
  equal(await page.run("return catena.designRow"), 16, "the design that was clicked");
  // By keys alone: the parallel axes are reached by tab, arrows go from design to design.
  await page.run("catena.plots.root.querySelector('canvas[aria-label^=parallel]').focus()");
  equal(await page.run("return document.activeElement.getAttribute('aria-label').split(';')[0]"), "parallel coordinates",
        "the parallel axes have the focus");
  const clock = await page.run("return catena.player.clock");
  const [left, right, home, end] = ["\uE012", "\uE014", "\uE011", "\uE010"];
  for (const [key, row] of [[right, 17], [right, 18], [left, 17], [end, 21], [right, 21], [left, 20]]) {
    await page.keys(key);
    await settle(page);
    equal(await page.run("return catena.designRow"), row, `the design after ${key.charCodeAt(0)}`);
    equal(await page.run("return catena.plots.cursor"), row, "the line that is lit");
  }
  equal(await page.run("return catena.player.clock"), clock, "the motion stays where it is");
  check((await page.run("return getComputedStyle(document.activeElement).outlineStyle")) !== "none", "the focus shows");
  await page.screenshot(`${outputFolder}/parallel_focus.png`);
  await page.keys(home);
  await settle(page);
  const first = await page.run("return catena.designRow");
  check(first >= 0 && first <= 4, `the first design that can be seen: ${first}`);
  // A design that does not assemble: the mechanism stays as it was given, and nothing breaks.
  await page.run("catena.goToRow(0)");
  await settle(page);
  equal(await page.run("return document.body.innerText.includes('NaN')"), false, "NaN at a design that failed");
});
