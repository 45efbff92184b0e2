// Pages of all kinds of analyses, of scenes that go wrong, and of names that look like markup.

import { readFileSync, writeFileSync } from "node:fs";

import { check, equal, makePage, near, outputFolder, settle, test, writeScene } from "./page_test.mjs";

const markup = "<script>window.broken = true</script><img src=x onerror='window.broken = true'>";
const rods = {
  catena: 1, name: markup, gravity: [0, -9.81], parameters: { P: 0 },
  bodies: {
    "a": { mass: 1, rod: { from: [0, 0], to: [0, -1] } },
    "b<i>": { mass: 1, rod: { from: [0, -1], to: [0, -2] } },
  },
  constraints: [
    { type: "revolute", name: "O", i: "ground", j: "a.from" },
    { type: "revolute", name: "A</script>", i: "a.to", j: "b<i>.from" },
  ],
  forces: [
    { type: "torsion_spring", i: "ground", j: "a", k: 5 },
    { type: "torsion_spring", i: "a", j: "b<i>", k: 5 },
    { type: "point_force", name: "push", i: "b<i>.to", force: ["P", 0] },
  ],
  analyses: [
    { type: "check" }, { type: "equilibrium" }, { type: "modes" },
    { type: "path", parameter: "P", to: 30, outputs: ["b<i>.to.x", "a.angle"] },
    { type: "dynamics", until: 2, every: 0.02, from: "initial", set: { P: 5 },
      events: [{ name: "low", when: "a.angle", value: -1.3 }] },
  ],
};
const empty = { catena: 1, name: "empty" };
const single = { catena: 1, name: "single", bodies: { stone: { mass: 1, inertia: 1 } },
                 analyses: [{ type: "dynamics", until: 1 }] };
// A crank that is too long for its rod, whose end keeps its height: the driver gets stuck on the way.
const stuck = {
  catena: 1, name: "stuck",
  bodies: { crank: { rod: { from: [0, 0], to: [1, 0] } }, rod: { rod: { from: [1, 0], to: [1.5, 0.5] } } },
  constraints: [{ type: "revolute", name: "O", i: "ground", j: "crank.from" },
                { type: "revolute", name: "A", i: "crank.to", j: "rod.from" },
                { type: "absolute_y", i: "rod.to", value: 0.5 }],
  drivers: [{ type: "absolute_angle", name: "drive", i: "crank", value: { polynomial: [0, 1] } }],
  analyses: [{ type: "kinematics", until: 6, every: 0.05 }],
};

const pages = Object.fromEntries(Object.entries({ rods, empty, single, stuck })
    .map(([name, content]) => [name, makePage(writeScene(name, content), name)]));
equal(pages.rods.exit, 0, `rods: ${pages.rods.said}`);
equal(pages.stuck.exit, 1, "exit code of a run that ended early");
const wrong = makePage(writeScene("wrong", { catena: 1, bodies: { a: { mas: 1 } } }), "wrong");
equal(wrong.exit, 3, "exit code of a wrong scene");
check(wrong.said.includes("did you mean"), `what is said of it: ${wrong.said}`);

const noNumber = "return document.body.innerText.includes('NaN')";

await test({}, async (page) => {
  await page.open(pages.rods.page);
  await settle(page);
  equal(await page.run("return document.getElementById('scene-name').textContent"), markup, "a name with markup");
  equal(await page.run("return window.broken === undefined"), true, "no script of a name was run");
  const types = rods.analyses.map((analysis) => analysis.type);
  for (const [k, type] of types.entries()) {
    await page.run(`catena.showAnalysis(${k})`);
    for (const tab of ["plots", "report", "table", "points"]) {
      await page.run(`catena.showTab("${tab}")`);
      await settle(page);
      equal(await page.run(noNumber), false, `NaN in ${tab} of ${type}`);
    }
    await page.run(`catena.showTab("${["modes", "equilibrium", "check"].includes(type) ? "report" : "plots"}")`);
    await settle(page);
    await page.screenshot(`${outputFolder}/rods_${type}.png`);
  }

  // Modes: each swings; the equilibrium shows its softest one.
  for (const type of ["modes", "equilibrium"]) {
    await page.run(`catena.showAnalysis(${types.indexOf(type)}); catena.showShape(0); catena.player.pause()`);
    const spread = await page.run(`
      const at = (clock) => (catena.motion.moveTo(clock, 0.1), Array.from(catena.motion.pose.q));
      const [rest, out] = [at(0), at(0.5)];
      const moved = (k) => Math.hypot(out[3 * k] - rest[3 * k], out[3 * k + 1] - rest[3 * k + 1]);
      return Math.max(...catena.data.bodies.map((_, body) => moved(body)));`);
    near(spread, 0.1, 1e-6, `largest displacement of a swing of ${type}`);
  }

  // A path: the pose under the cursor is that of the row.
  await page.run(`catena.showAnalysis(${types.indexOf("path")}); catena.goToRow(3)`);
  await settle(page);
  const [pose, columnValue] = await page.run(`
    const body = catena.data.bodies.indexOf("a");
    const column = catena.table.find("a.angle");
    catena.motion.moveTo(catena.player.clock, 0);
    return [catena.motion.pose.q[3 * body + 2], catena.table.values(column)[3]];`);
  near(pose, columnValue, 1e-5, "a.angle at row 3 of the path");

  await page.run(`catena.showAnalysis(${types.indexOf("dynamics")})`);
  check((await page.run("return document.querySelectorAll('#marks button').length")) > 0, "events on the time bar");

  // Analyses that no page knows yet: rows of a sweep, and of something without a name here.
  for (const type of ["sweep", "other"]) {
    const unknown = `${outputFolder}/${type}.html`;
    const text = readFileSync(pages.rods.page, "utf8");
    check(text.includes('"type":"path"'), "the data name the type of an analysis");
    writeFileSync(unknown, text.replace('"type":"path"', `"type":"${type}"`));
    await page.open(unknown);
    await page.run(`catena.showAnalysis(${types.indexOf("path")}); catena.showTab("plots")`);
    await settle(page);
    check((await page.run("return document.querySelectorAll('.plot canvas').length")) > 0, `plots of ${type}`);
    equal(await page.run("return catena.plots.parallel !== null"), type === "sweep", `parallel axes of ${type}`);
    await page.screenshot(`${outputFolder}/${type}.png`);
    await page.run('catena.showTab("table")');
    check((await page.run("return document.querySelectorAll('#panel tr').length")) > 3, `table of ${type}`);
  }

  for (const name of ["empty", "single", "stuck"]) {
    await page.open(pages[name].page);
    await settle(page);
    equal(await page.run(noNumber), false, `NaN on the page of ${name}`);
    await page.screenshot(`${outputFolder}/${name}.png`);
  }
  const status = await page.run("return document.getElementById('status').textContent");
  check(/^(lock_up|singular|not_assembled|bifurcation): ./.test(status), `status of the run that got stuck: ${status}`);
  check((await page.run("return catena.motion.count")) > 5, "poses up to where it got stuck");
});
