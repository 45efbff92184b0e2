// Ropes on the page: along tangents and arcs, as in the figures of `catena draw`, and found by the pointer.

import { check, draw, equal, makePage, near, outputFolder, scene, settle, test } from "./page_test.mjs";

const path = scene("tackle");
const made = makePage(path, "tackle");
equal(made.exit, 0, `tackle: ${made.said}`);
const [small, large] = [0.1, 0.3];  // wheels of the drum, which turns about the origin, m

/** Corners of the longest paths, in m about the middle of the drum, which is the largest circle. */
function ropesOf(svg) {
  const circles = [...svg.matchAll(/<circle cx="([-0-9.]+)" cy="([-0-9.]+)" r="([-0-9.]+)"/g)]
      .map((found) => found.slice(1).map(Number));
  const [x, y, r] = circles.reduce((a, b) => (b[2] > a[2] ? b : a));
  const scale = r / large;
  const ropes = [];
  for (const [, data] of svg.matchAll(/<path d="([^"]*)"/g)) {
    for (const part of data.split("M").slice(1)) {
      const corners = [...part.matchAll(/(-?[0-9.]+) (-?[0-9.]+)/g)]
          .map(([, px, py]) => [(Number(px) - x) / scale, (y - Number(py)) / scale]);
      const long = corners.some((p, k) => k > 0 && Math.hypot(p[0] - corners[k - 1][0], p[1] - corners[k - 1][1]) > 0.4);
      if (long) ropes.push(corners);
    }
  }
  return { ropes, scale };
}

await test({ reducedMotion: true }, async (page) => {
  await page.open(made.page);
  await settle(page);
  const dynamics = await page.run("return catena.data.analyses.findIndex(({ type }) => type === 'dynamics')");
  for (const [row, t] of [[0, 0], [5, 0.25], [10, 0.5]]) {
    await page.run(`catena.goToRow(${row})`);
    await settle(page);
    const shown = ropesOf(await page.run("return catena.stage.svg(catena.player.clock)"));
    const drawn = ropesOf(draw(path, "--at", String(t), "--analysis", String(dynamics + 1)));
    equal(shown.ropes.length, 2, `ropes on the page at ${t}`);
    equal(drawn.ropes.length, 2, `ropes of catena draw at ${t}`);
    const rounding = 0.02 / shown.scale + 0.02 / drawn.scale;
    shown.ropes.forEach((rope, k) => {
      equal(rope.length, drawn.ropes[k].length, `corners of rope ${k} at ${t}`);
      const away = rope.map(([x, y], n) => Math.hypot(x - drawn.ropes[k][n][0], y - drawn.ropes[k][n][1]));
      check(Math.max(...away) < rounding, `rope ${k} of page and figure at ${t}: ${Math.max(...away)} m apart`);
    });
    // The weight hangs by the left of the large wheel, the load by the right of the small one.
    const [pull, lift] = shown.ropes.map((rope) => rope[rope.length - 1]);
    near(Math.hypot(...pull), large, rounding, `the weight's rope touches the large wheel at ${t}`);
    near(Math.hypot(...lift), small, rounding, `the load's rope touches the small wheel at ${t}`);
    check(pull[0] < 0 && lift[0] > 0, `on their sides at ${t}: ${pull}, ${lift}`);
  }
  await page.screenshot(`${outputFolder}/tackle.png`);

  // The pointer finds a rope where it is drawn: in the middle of the weight's straight part.
  const [x, y, name] = await page.run(`
    const { camera, canvas, shapes } = catena.stage;
    const rope = [...shapes.ropes.values()][0].at(catena.motion.pose);
    const box = canvas.getBoundingClientRect();
    return [box.left + camera.toPageX((rope[0] + rope[2]) / 2), box.top + camera.toPageY((rope[1] + rope[3]) / 2),
            catena.motion.names.elements.name[shapes.element[[...shapes.ropes.keys()][0]]]];`);
  equal(name, "pull", "the first rope");
  await page.point(x, y);
  await settle(page);
  check((await page.run("return document.getElementById('hover').innerText")).startsWith("pull rope"),
        "what is said of the rope under the pointer");
});
