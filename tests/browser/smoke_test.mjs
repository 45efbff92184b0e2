// One page: it opens without an error, shows the mechanism and moves it.

import { check, equal, makePage, outputFolder, scene, settle, test } from "./page_test.mjs";

const made = makePage(scene("crank_rocker"), "crank_rocker");
equal(made.exit, 0, `catena view: ${made.said}`);
check(made.bytes <= 350e3, `the page of a four-bar has ${made.bytes} bytes, and should have 350 kB at most`);

await test({}, async (page) => {
  await page.open(made.page);
  await settle(page);
  const name = await page.run("return document.getElementById('scene-name').textContent");
  equal(name, "crank-rocker", "name of the scene");
  const inked = () => page.run(`
    const canvas = document.getElementById("mechanism");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let sum = 0;
    for (let k = 3; k < data.length; k += 4) if (data[k] > 0) sum = (sum * 31 + k) % 1000003;
    return sum;`);
  const first = await inked();
  check(first > 0, "the mechanism is drawn");
  const t = await page.run("return catena.player.clock");
  await page.runAsync("const done = arguments[0]; setTimeout(() => done(true), 400)");
  check((await page.run("return catena.player.clock")) !== t, "the clock runs");
  check((await inked()) !== first, "the mechanism moves");
  await page.screenshot(`${outputFolder}/smoke.png`);
});
