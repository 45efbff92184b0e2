// 10^5 bodies x 200 frames: size of the page, time to write it, pictures a second where software draws them.

import { check, equal, makePage, outputFolder, settle, test, writeScene, scene } from "./page_test.mjs";
import { readFileSync } from "node:fs";

const bodies = 100001;
const text = readFileSync(scene("linkage_100000"), "utf8");
const content = JSON.parse(text.replace(/^\s*\/\/.*$/gm, ""));
content.analyses = [{ type: "kinematics", until: 6, every: 0.030150753768844 }];
const path = writeScene("large", content);
const made = makePage(path, "large");
equal(made.exit, 0, `catena view: ${made.said}`);
check(made.bytes <= 80e6, `the page has ${made.bytes} bytes, and should have 80 MB at most`);
check(made.said.includes("poses are in this page"), `that poses were left out is said: ${made.said}`);

await test({}, async (page) => {
  await page.open(made.page);
  await settle(page);
  equal(await page.run("return catena.data.bodies.length"), bodies, "bodies");
  // Of three measurements the best: other work on the machine takes pictures away and adds none.
  let rate = 0;
  for (let measurement = 0; measurement < 3; ++measurement) {
    rate = Math.max(rate, await page.runAsync(`
      const done = arguments[0];
      catena.player.play();
      const first = catena.stage.pictures, start = performance.now();
      setTimeout(() => done((catena.stage.pictures - first) / ((performance.now() - start) / 1000)), 3000);`));
  }
  console.log(`${(made.bytes / 1e6).toFixed(1)} MB, ${rate.toFixed(1)} pictures a second`);
  check(rate >= 5, `${rate} pictures a second, and should be 5 at least`);
  await page.run("catena.player.pause()");
  await page.screenshot(`${outputFolder}/large.png`);
  // Close by, a canvas draws the few links in sight as in any other page.
  await page.run(`
    const { camera } = catena.stage;
    const { q } = catena.motion.pose;
    camera.x = q[0]; camera.y = q[1]; camera.scale = 60;
    catena.redraw();`);
  await settle(page);
  const inked = await page.run(`
    const canvas = document.getElementById("mechanism");
    return canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data.some((value) => value > 0)`);
  equal(inked, true, "links close by are drawn");
  await page.screenshot(`${outputFolder}/large_close.png`);
});
