// By keys alone, and by fingers: what a mouse does can be done without one.

import { check, equal, makePage, near, outputFolder, scene, settle, test } from "./page_test.mjs";

const made = makePage(scene("crank_rocker"), "keys");
const [left, right, up, enter, alt, shift] = ["\uE012", "\uE014", "\uE013", "\uE007", "\uE00A", "\uE008"];

/** Keys while another is held. */
const held = (page, modifier, keys) => page.post("/actions", { actions: [{
  type: "key", id: "keys",
  actions: [{ type: "keyDown", value: modifier },
            ...[...keys].flatMap((value) => [{ type: "keyDown", value }, { type: "keyUp", value }]),
            { type: "keyUp", value: modifier }],
}] });

/** Fingers that go from places to places. */
const fingers = (page, paths) => page.post("/actions", { actions: paths.map(([from, to], k) => ({
  type: "pointer", id: `finger${k}`, parameters: { pointerType: "touch" },
  actions: [{ type: "pointerMove", duration: 0, x: Math.round(from[0]), y: Math.round(from[1]) },
            { type: "pointerDown", button: 0 },
            { type: "pointerMove", duration: 100, x: Math.round(to[0]), y: Math.round(to[1]) },
            { type: "pointerUp", button: 0 }],
})) });

await test({ reducedMotion: true }, async (page) => {
  await page.open(made.page);
  await page.run("catena.showAnalysis(catena.data.analyses.findIndex(({ type }) => type === 'kinematics'))");
  await settle(page);
  const get = (what) => page.run(`return ${what}`);
  const camera = () => get("[catena.stage.camera.x, catena.stage.camera.y, catena.stage.camera.scale]");

  await page.keys(right + right);
  near(await get("catena.player.clock"), await get("catena.motion.t[2]"), 1e-9, "two rows on");
  await held(page, shift, right);
  near(await get("catena.player.clock"), await get("catena.motion.t[12]"), 1e-9, "ten rows on");
  await page.keys(" ");
  equal(await get("catena.player.playing"), true, "space plays");
  await page.keys(" ");
  equal(await get("catena.player.playing"), false, "and stops");
  const speed = await get("catena.player.speed");
  await page.keys("]");
  check((await get("catena.player.speed")) > speed, "faster");
  await page.keys("[l");
  equal(await get("catena.player.loop"), false, "no loop");

  const before = await camera();
  await page.keys("+");
  near((await camera())[2] / before[2], 1.25, 1e-9, "zoom");
  await held(page, alt, left + up);
  const moved = await camera();
  check(moved[0] < before[0] && moved[1] > before[1], `pan by keys: ${before} to ${moved}`);
  await page.keys("f");
  near((await camera())[2], before[2], 1e-9, "everything is seen again");

  // Bodies and elements one after the other, described as by a pointer; the plot of their columns.
  await page.keys(".");
  await settle(page);
  check((await get("document.getElementById('hover').innerText")).startsWith("crank body"), "the first body");
  await page.keys("..");
  await settle(page);
  const said = await get("document.getElementById('hover').innerText");
  check(said.startsWith("rocker body") && said.includes("rad"), `the third body with its values: ${said}`);
  await page.screenshot(`${outputFolder}/chosen.png`);
  const plots = await get("catena.plots.views.length");
  await page.keys(enter);
  equal(await get("catena.plots.views.length"), plots + 1, "its plot");
  await page.keys(",");
  await settle(page);
  check((await get("document.getElementById('hover').innerText")).startsWith("coupler body"), "the one before");

  // A plot that has the focus.
  const axis = () => get("[catena.plots.views[0].plot.axisX.first, catena.plots.views[0].plot.axisX.last]");
  const whole = await axis();
  await page.run("catena.plots.views[0].canvas.focus()");
  await page.keys("+");
  const close = await axis();
  near((whole[1] - whole[0]) / (close[1] - close[0]), 1.3, 1e-9, "zoom of a plot");
  await held(page, alt, right);
  check((await axis())[0] > close[0], "pan of a plot");
  await page.keys("f");
  equal((await axis()).join(), whole.join(), "all of the plot");
  near((await camera())[2], before[2], 1e-9, "the mechanism stays as it is");

  // Every button, list and plot can be reached by the tab key, and shows that it was.
  const reach = await get(`[...document.querySelectorAll("button, select, input, canvas[role=img]")]
      .filter((e) => e.offsetParent && e.tabIndex < 0).length`);
  equal(reach, 0, "what the tab key does not reach");

  // Fingers: one pans, two zoom about their middle.
  const box = await get("catena.stage.canvas.getBoundingClientRect().toJSON()");
  const [x, y] = [box.left + box.width / 2, box.top + box.height / 2];
  await page.run("document.activeElement.blur()");
  await fingers(page, [[[x, y], [x + 60, y]]]);
  near((await camera())[0], before[0] - 60 / before[2], 2 / before[2], "one finger pans");
  await page.keys("f");
  await fingers(page, [[[x - 40, y], [x - 120, y]], [[x + 40, y], [x + 120, y]]]);
  const ratio = (await camera())[2] / before[2];
  check(ratio > 2 && ratio < 4, `two fingers zoom: ${ratio}`);
  await page.keys("f");
  await page.run("catena.plots.views[0].canvas.scrollIntoView({ block: 'center' })");
  const plot = await get("catena.plots.views[0].canvas.getBoundingClientRect().toJSON()");
  const [px, py] = [plot.left + plot.width / 2, plot.top + plot.height / 2];
  await fingers(page, [[[px - 20, py], [px - 60, py]], [[px + 20, py], [px + 60, py]]]);
  const pinched = await axis();
  check(pinched[1] - pinched[0] < 0.7 * (whole[1] - whole[0]), `two fingers zoom a plot: ${whole} to ${pinched}`);
});
