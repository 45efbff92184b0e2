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

// A bar on a pin whose end is held at a height: short bars do not reach it.
const bar = {
  catena: 1, name: "swept", parameters: { length: 2, height: 1 },
  bodies: { bar: { mass: 1, rod: { from: [0, 0], to: ["length", 0] } } },
  constraints: [{ type: "revolute", i: "ground", j: "bar.from" }, { type: "absolute_y", i: "bar.to", value: "height" }],
};
const turned = { type: "kinematics", at: 0, measures: { turned: { final: "bar.angle" } } };
const swept = {
  ...bar,
  analyses: [{ type: "sweep", over: { length: [2, 0.9], height: [1, 1.4] }, of: turned }, { type: "check" },
             { type: "sensitivity", parameters: ["length"], of: turned }],
};
// Bodies that go by 1 m/s along x, two or four of them.
const repeated = {
  catena: 1, name: "repeated", parameters: { n: 2 },
  replicate: [{
    count: "n", bodies: { "b{k}": { position: ["=k", 0] } },
    drivers: [{ type: "absolute_x", i: "b{k}", value: { polynomial: ["=k", 1] } },
              { type: "absolute_y", i: "b{k}", value: 0 }, { type: "absolute_angle", i: "b{k}", value: 0 }],
  }],
  analyses: [{ type: "kinematics", until: 2, every: 0.5 },
             { type: "kinematics", until: 2, every: 0.5, from: "initial", set: { n: 4 } }],
};
const unorderedTimes = [2, 0, 3, 1];
const unordered = { ...repeated, name: "unordered", analyses: [{ type: "kinematics", at: unorderedTimes }] };

const pages = Object.fromEntries(Object.entries({ rods, empty, single, stuck, swept, repeated, unordered })
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

  // An analysis that no page knows: its rows are shown as those of any other.
  const unknown = `${outputFolder}/other.html`;
  const text = readFileSync(pages.rods.page, "utf8");
  check(text.includes('"type":"path"'), "the data name the type of an analysis");
  writeFileSync(unknown, text.replace('"type":"path"', '"type":"other"'));
  await page.open(unknown);
  await page.run(`catena.showAnalysis(${types.indexOf("path")}); catena.showTab("plots")`);
  await settle(page);
  check((await page.run("return document.querySelectorAll('.plot canvas').length")) > 0, "plots of other");
  equal(await page.run("return catena.plots.parallel !== null"), false, "parallel axes of other");
  await page.run('catena.showTab("table")');
  check((await page.run("return document.querySelectorAll('#panel tr').length")) > 3, "table of other");

  // A sweep: its designs on parallel axes, failed ones by the name of their status, its counts as words.
  await page.open(pages.swept.page);
  await page.run("catena.showAnalysis(0)");
  for (const tab of ["plots", "report", "table"]) {
    await page.run(`catena.showTab("${tab}")`);
    await settle(page);
    equal(await page.run(noNumber), false, `NaN in ${tab} of the sweep`);
    await page.screenshot(`${outputFolder}/sweep_${tab}.png`);
  }
  check((await page.run("return document.getElementById('panel').innerText")).includes("not_assembled"),
        "the table names the status of a design");
  const axes = await page.run("return catena.plots.parallel.plot.columns.map((c) => catena.table.names[c])");
  equal(axes.join(), "length,height,turned", "parallel axes of the sweep");
  equal(await page.run("return catena.table.csv([0, catena.table.find('status')]).split('\\r\\n')[1]"), "1,ok",
        "the status in a CSV file");
  await page.run('catena.showTab("report")');
  const report = await page.run("return document.getElementById('panel').innerText");
  check(report.includes("not_assembled = 2"), `how many designs failed: ${report}`);
  check(!report.includes("[object"), "objects in the report are told by their members");
  // Where the next analysis has no rows, nothing of the sweep stays.
  await page.run("catena.showAnalysis(1)");
  equal(await page.run("return catena.plots.parallel"), null, "parallel axes of check");

  // Measures with derivatives.
  await page.run('catena.showAnalysis(2); catena.showTab("report")');
  const measured = await page.run("return document.getElementById('panel').innerText");
  check(/turned\s+0\.5236 rad/.test(measured) && measured.includes("d/d(length)"), `measures: ${measured}`);

  // Another number of bodies: names, poses and drawing are those of the analysis.
  await page.open(pages.repeated.page);
  for (const [analysis, bodies] of [[0, 2], [1, 4]]) {
    await page.run(`catena.showAnalysis(${analysis}); catena.player.pause(); catena.player.moveTo(1)`);
    await settle(page);
    equal(await page.run("return catena.motion.names.bodies.length"), bodies, "bodies of the analysis");
    const places = await page.run("return Array.from(catena.motion.pose.q)");
    for (let k = 0; k < bodies; ++k) {
      near(places[3 * k], k + 1 + 1, 1e-6, `x of body ${k + 1} of ${bodies} at 1 s`);
      near(places[3 * k + 1], 0, 1e-6, `y of body ${k + 1} of ${bodies} at 1 s`);
    }
    equal(await page.run(noNumber), false, "NaN with other bodies");
  }

  // Instants in any order: the clock goes through them as time does, rows stay those of the list.
  await page.open(pages.unordered.page);
  await settle(page);
  const [begin, end] = await page.run("return [catena.motion.begin, catena.motion.end]");
  equal(`${begin} ${end}`, "0 3", "the clock of a list of instants");
  for (const [row, t] of unorderedTimes.entries()) {
    await page.run(`catena.goToRow(${row})`);
    near(await page.run("return catena.player.clock"), t, 1e-12, `instant of row ${row}`);
    await settle(page);
    near(await page.run("return catena.motion.pose.q[0]"), 1 + t, 1e-6, `x at row ${row}`);
    equal(await page.run("return catena.plots.cursor"), row, `the cursor is at row ${row}`);
  }
  await page.run("catena.player.moveTo(0.5)");
  await settle(page);
  near(await page.run("return catena.motion.pose.q[0]"), 1.5, 1e-6, "x half way between two instants");
  await page.run("catena.player.moveTo(0); catena.player.step(1)");
  equal(await page.run("return catena.player.clock"), 1, "one step on in time");

  // A plot is drawn once, however far its cursor moves; a slider keeps its arrows, the time bar goes by rows.
  await page.run("catena.showTab('plots')");
  await settle(page);
  const before = await page.run("return catena.plots.views.map((view) => view.picture.drawn).join()");
  await page.run("catena.player.moveTo(2.5)");
  await settle(page);
  equal(await page.run("return catena.plots.views.map((view) => view.picture.drawn).join()"), before,
        "drawings of plots while the cursor moves");
  await page.run("catena.player.moveTo(1); document.getElementById('clock').focus()");
  await page.keys("\uE014");
  equal(await page.run("return catena.player.clock"), 2, "the time bar goes on by a row");
  await page.run(`
    const slider = Object.assign(document.createElement("input"), { type: "range", min: 0, max: 10, value: 5 });
    document.body.append(slider);
    slider.focus();`);
  await page.keys("\uE014");
  equal(await page.run("return catena.player.clock"), 2, "the arrows of another slider move no clock");
  equal(await page.run("return document.activeElement.value"), "6", "but the slider");

  for (const name of ["empty", "single", "stuck"]) {
    await page.open(pages[name].page);
    await settle(page);
    equal(await page.run(noNumber), false, `NaN on the page of ${name}`);
    await page.screenshot(`${outputFolder}/${name}.png`);
    const nothing = (await page.run("return document.getElementById('stage').innerText")).includes("no bodies");
    equal(nothing, name === "empty", `that there is nothing to draw is said on the page of ${name}`);
  }
  // A long message leaves the name of the scene its room.
  check((await page.run("const h = document.querySelector('h1'); return h.scrollWidth <= h.clientWidth + 1")),
        "the name of the scene beside a long message");
  const status = await page.run("return document.getElementById('status').textContent");
  check(/^(lock_up|singular|not_assembled|bifurcation): ./.test(status), `status of the run that got stuck: ${status}`);
  check((await page.run("return catena.motion.count")) > 5, "poses up to where it got stuck");
});
